#include "case/tree.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/mem.h"

char *rg_text_copy(const char *text, size_t size) {
    char *copy = RG_NEW(char, size + 1);
    for (size_t i = 0; i < size; i++) { /* of no bytes, `text` may be NULL */
        copy[i] = text[i];
    }
    return copy;
}

char *rg_text_format(const char *format, ...) {
    va_list args;
    va_start(args, format);
    int length = vsnprintf(NULL, 0, format, args);
    va_end(args);
    char *text = RG_NEW(char, (size_t)length + 1);
    va_start(args, format);
    vsnprintf(text, (size_t)length + 1, format, args);
    va_end(args);
    return text;
}

void rg_text_add(char *text, size_t size, const char *format, ...) {
    size_t used = strlen(text);
    va_list args;
    va_start(args, format);
    vsnprintf(text + used, size - used, format, args);
    va_end(args);
}

rg_node *rg_node_find(const rg_node *mapping, const char *key, size_t length) {
    for (int i = 0; i < mapping->children; i++) {
        const char *name = mapping->child[i].key;
        if (name != NULL && strlen(name) == length && strncmp(name, key, length) == 0) {
            return &mapping->child[i];
        }
    }
    return NULL;
}

rg_node *rg_node_append(rg_node *parent) {
    parent->child = rg_realloc(parent->child, (size_t)parent->children + 1, sizeof *parent->child);
    rg_node *node = &parent->child[parent->children++];
    *node = (rg_node){.kind = RG_NODE_BAD};
    return node;
}

void rg_node_copy(const rg_node *from, rg_node *to) {
    *to = (rg_node){.kind = from->kind, .at = from->at, .key_at = from->key_at, .plain = from->plain};
    to->key = from->key != NULL ? rg_text_copy(from->key, strlen(from->key)) : NULL;
    to->text = from->text != NULL ? rg_text_copy(from->text, strlen(from->text)) : NULL;
    for (int i = 0; i < from->children; i++) {
        rg_node_copy(&from->child[i], rg_node_append(to));
    }
}

bool rg_node_is_null(const rg_node *node) {
    return node->kind == RG_NODE_SCALAR && node->plain &&
           (node->text[0] == '\0' || strcmp(node->text, "~") == 0 || strcmp(node->text, "null") == 0);
}

void rg_node_clear(rg_node *node) {
    for (int i = 0; i < node->children; i++) {
        rg_node_clear(&node->child[i]);
    }
    rg_free(node->child);
    rg_free(node->key);
    rg_free(node->text);
    *node = (rg_node){.kind = RG_NODE_BAD};
}

/* ---- one line of YAML ---- */

typedef struct {
    char *text;
    size_t used, size;
} line_buffer;

static void put(line_buffer *line, const char *text) {
    size_t room = line->size - 1 - line->used, length = strlen(text);
    size_t copied = length < room ? length : room;
    memcpy(line->text + line->used, text, copied);
    line->used += copied;
    line->text[line->used] = '\0';
}

static void put_node(line_buffer *line, const rg_node *node) {
    if (node->kind == RG_NODE_SCALAR) {
        const char *quote = node->plain ? "" : "\"";
        put(line, quote);
        put(line, node->text);
        put(line, quote);
        return;
    }
    bool mapping = node->kind == RG_NODE_MAPPING;
    put(line, mapping ? "{" : "[");
    for (int i = 0; i < node->children; i++) {
        put(line, i > 0 ? ", " : "");
        if (mapping) {
            put(line, node->child[i].key);
            put(line, ": ");
        }
        put_node(line, &node->child[i]);
    }
    put(line, mapping ? "}" : "]");
}

const char *rg_node_line(const rg_node *node, char *line, size_t size) {
    line_buffer buffer = {.text = line, .size = size};
    line[0] = '\0';
    put_node(&buffer, node);
    if (buffer.used == size - 1) {
        memcpy(line + size - 4, "...", 4);
    }
    return line;
}

/* ---- overrides ---- */

/* The mapping's child named by the first `length` bytes of `key`, made if there is none. */
static rg_node *descend(rg_node *mapping, const char *key, size_t length, rg_place at) {
    rg_node *node = rg_node_find(mapping, key, length);
    if (node == NULL) {
        node = rg_node_append(mapping);
        node->key = rg_text_copy(key, length);
        node->key_at = at;
        node->kind = RG_NODE_SCALAR;
        node->plain = true;
        node->text = rg_text_copy("", 0);
    }
    return node;
}

/* Makes an empty section a mapping, so that it can take a key. */
static bool become_mapping(rg_node *node, rg_place at) {
    if (rg_node_is_null(node)) {
        rg_free(node->text);
        node->text = NULL;
        node->kind = RG_NODE_MAPPING;
        node->at = at;
    }
    return node->kind == RG_NODE_MAPPING;
}

static void replace(rg_node *node, rg_node *value) {
    char *key = node->key;
    rg_place key_at = node->key_at;
    node->key = NULL;
    rg_node_clear(node);
    *node = *value;
    node->key = key;
    node->key_at = key_at;
}

/* True if key[0..length) is made of words with single dots between them. */
static bool is_path(const char *key, size_t length) {
    char before = '.';
    for (size_t i = 0; i < length; i++) {
        if (key[i] == '.' && before == '.') {
            return false;
        }
        before = key[i];
    }
    return before != '.';
}

/* Puts `value` at the dotted path key[0..length) and takes it over. Returns what is wrong, or NULL. */
static const char *graft(rg_node *root, const char *key, size_t length, rg_node *value) {
    rg_node *node = root;
    for (const char *part = key;;) {
        size_t rest = (size_t)(key + length - part);
        const char *dot = memchr(part, '.', rest);
        size_t size = dot == NULL ? rest : (size_t)(dot - part);
        if (!become_mapping(node, value->at)) {
            return "cannot be set: what it belongs to is not a mapping of keys";
        }
        node = descend(node, part, size, value->at);
        if (dot == NULL) {
            break;
        }
        part = dot + 1;
    }
    if (node->at.set != NULL) {
        return "set twice";
    }
    replace(node, value);
    return NULL;
}

void rg_tree_override(rg_problems *problems, rg_node *root, const char *set) {
    const char *equals = strchr(set, '=');
    rg_place at = {.line = 1, .column = 1, .set = set};
    if (equals == NULL || !is_path(set, (size_t)(equals - set))) {
        rg_problem_add(problems, at, &(rg_subject){0}, "expected --set section.key=value");
        return;
    }
    rg_node value = {.kind = RG_NODE_BAD};
    rg_yaml_parse(problems, equals + 1, strlen(equals + 1), set, &value);
    if (value.kind == RG_NODE_BAD || root->kind == RG_NODE_BAD) {
        rg_node_clear(&value);
        return;
    }
    const char *what = graft(root, set, (size_t)(equals - set), &value);
    if (what != NULL) {
        char *key = rg_text_copy(set, (size_t)(equals - set));
        rg_problem_add(problems, at, &(rg_subject){.key = key}, "%s", what);
        rg_free(key);
        rg_node_clear(&value);
    }
}
