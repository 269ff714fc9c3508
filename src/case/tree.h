/* The case file as a tree of nodes that know where they stand. */
#ifndef RG_CASE_TREE_H
#define RG_CASE_TREE_H

#include <stdbool.h>
#include <stddef.h>

#include "case/problem.h"

typedef enum {
    RG_NODE_SCALAR,
    RG_NODE_LIST,
    RG_NODE_MAPPING,
    RG_NODE_BAD, /* already reported: nobody complains about it again */
} rg_node_kind;

/* Node of the tree. Owns its key, text and children. */
typedef struct rg_node {
    rg_node_kind kind;
    rg_place at;
    char *key; /* in a mapping; else NULL */
    rg_place key_at;
    char *text; /* of a scalar */
    bool plain; /* scalar without quotes: may be a number; with quotes it is always a text */
    int children;
    struct rg_node *child;
} rg_node;

/* Parses YAML `text` of `size` bytes into `root` (a BAD node if it cannot be read) and reports what is wrong:
 * bad syntax, bytes that are not UTF-8 text, anchors, tags and keys that are not plain words. `set`: the
 * override the text comes from, NULL for the file. */
void rg_yaml_parse(rg_problems *problems, const char *text, size_t size, const char *set, rg_node *root);

/* Applies the override "a.b=value" to the tree: replaces or adds the node a.b. Reports what is wrong. */
void rg_tree_override(rg_problems *problems, rg_node *root, const char *set);

/* The child with `key` (its first `length` bytes), or NULL. */
rg_node *rg_node_find(const rg_node *mapping, const char *key, size_t length);

/* Appends an empty child and returns it; earlier pointers to children become invalid. */
rg_node *rg_node_append(rg_node *parent);

/* Makes `to`, which owns nothing, a copy of `from`. */
void rg_node_copy(const rg_node *from, rg_node *to);

/* No value at all: `key:` with nothing behind it, or null. */
bool rg_node_is_null(const rg_node *node);

/* The node as one line of YAML, shortened to fit `size` bytes. Returns `line`. */
const char *rg_node_line(const rg_node *node, char *line, size_t size);

/* Frees what the node owns, not the node itself. */
void rg_node_clear(rg_node *node);

/* A copy of text[0..size) as a string. Free with rg_free. */
char *rg_text_copy(const char *text, size_t size);

/* A new string from a format. Free with rg_free. */
char *rg_text_format(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Appends to the string in text[0..size) as much as it has room for. */
void rg_text_add(char *text, size_t size, const char *format, ...) __attribute__((format(printf, 3, 4)));

#endif
