/* The tables of a case: read from the case file or from CSV files beside it, and written. */
#include "case/table.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "case/read.h"

/* One table being read. */
typedef struct {
    rg_check *ck;
    const rg_key *key;
    rg_curve *curve;
    size_t room;
} table;

static bool wrong(const table *t, const rg_node *node, const char *path, const char *what) {
    rg_value_wrong(t->ck, t->key, node, path, NULL, what);
    return false;
}

/* ---- points in the case file ---- */

static bool read_number(const table *t, const rg_node *node, const char *path, int k, double *value) {
    bool integer = false;
    bool number = node->kind == RG_NODE_SCALAR && node->plain && rg_is_number(node->text, &integer);
    *value = number ? strtod(node->text, NULL) : 0;
    if (number && isfinite(*value)) {
        return true;
    }
    char *item = rg_text_format("%s[%d]", path, k);
    wrong(t, node, item, number ? "not finite" : "not a number");
    rg_free(item);
    return false;
}

static bool read_point(table *t, const rg_node *node, const char *path) {
    double value[2] = {0, 0};
    if (node->kind != RG_NODE_LIST || node->children != 2) {
        return wrong(t, node, path, "not a pair [argument, value]");
    }
    bool good = true;
    for (int k = 0; k < 2; k++) {
        good = read_number(t, &node->child[k], path, k, &value[k]) && good;
    }
    const rg_curve *c = t->curve;
    if (good && c->points > 0 && !(value[0] > c->point[c->points - 1][0])) {
        return wrong(t, node, path, "its argument is not above the one before");
    }
    if (good) {
        rg_curve_add(t->curve, &t->room, value[0], value[1]);
    }
    return good;
}

static bool read_points(table *t, const rg_node *node, const char *path) {
    if (node->kind != RG_NODE_LIST || node->children < 2) {
        return wrong(t, node, path,
                     node->kind == RG_NODE_LIST ? "fewer than two points" : "not a list of points");
    }
    bool good = true;
    for (int i = 0; i < node->children; i++) {
        char *item = rg_text_format("%s[%d]", path, i);
        good = read_point(t, &node->child[i], item) && good;
        rg_free(item);
    }
    return good;
}

/* ---- points in a file, relative to the case file ---- */

static bool read_file(table *t, const rg_node *node, const char *path) {
    if (node->kind != RG_NODE_SCALAR || rg_node_is_null(node) || node->text[0] == '\0') {
        return wrong(t, node, path, "not the path of a CSV file");
    }
    size_t size = 0;
    char *file = rg_path_beside_case(t->ck, node->text);
    char *text = rg_case_file(file, &size);
    char *what = text == NULL ? rg_text_format("cannot be read: %s", strerror(errno))
                              : rg_curve_parse(t->curve, text, size);
    if (what != NULL) {
        wrong(t, node, path, what);
    }
    bool good = what == NULL;
    rg_free(text);
    rg_free(file);
    rg_free(what);
    return good;
}

/* ---- tables ---- */

static bool read_smooth(const table *t, const rg_node *node, const char *path, bool *smooth) {
    return rg_bool_read(node, smooth) || wrong(t, node, path, "neither true nor false");
}

/* {points or file, smooth} */
static bool read_mapping(table *t, const rg_node *node, const char *path) {
    static const char *const words[] = {"points", "file", "smooth", NULL};
    int sources = 0;
    bool good = true, smooth = false;
    for (int i = 0; i < node->children; i++) {
        const rg_node *child = &node->child[i];
        char *item = rg_text_format("%s.%s", path, child->key);
        rg_subject subject = {
            .key = item, .allowed = "points, file, smooth", .nearest = rg_nearest(child->key, words)};
        if (rg_node_find(node, child->key, strlen(child->key)) != child) {
            rg_problem_add(t->ck->problems, child->key_at, &subject, "given twice");
            good = false;
        } else if (strcmp(child->key, "smooth") == 0) {
            good = read_smooth(t, child, item, &smooth) && good;
        } else if (strcmp(child->key, "points") == 0 || strcmp(child->key, "file") == 0) {
            bool list = child->key[0] == 'p';
            good = (++sources > 1 || (list ? read_points : read_file)(t, child, item)) && good;
        } else {
            rg_problem_add(t->ck->problems, child->key_at, &subject, "unknown key");
            good = false;
        }
        rg_free(item);
    }
    if (sources != 1) {
        return wrong(t, node, path, sources == 0 ? "has no points" : "points and file both given");
    }
    if (good && smooth) {
        rg_curve_smooth(t->curve);
    }
    return good;
}

/* Whether expressions know the word already: as a variable or constant, or a function of one or more. */
static bool is_known(const char *name) {
    static const char *const use[] = {"", "(1)", "(1, 1)"};
    bool known = false;
    for (int i = 0; i < 3; i++) {
        char *text = rg_text_format("%s%s", name, use[i]);
        char *message = NULL;
        rg_expr *e = rg_expr_new(text, &message);
        known = known || e != NULL;
        rg_expr_free(e);
        rg_free(message);
        rg_free(text);
    }
    return known;
}

static bool check_name(const table *t, const rg_node *node, const char *path) {
    static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";
    static const char allowed[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";
    const char *name = node->key;
    bool fit = strspn(name, letters) > 0 && strspn(name, allowed) == strlen(name);
    if (fit && !is_known(name)) {
        return true;
    }
    rg_subject subject = {.key = path, .allowed = "a letter, then letters, digits and _"};
    rg_problem_add(t->ck->problems, node->key_at, &subject,
                   fit ? "expressions know this word as their own" : "not a name for a function");
    return false;
}

static bool read_table(table *t, const rg_node *list, const rg_node *node, const char *path) {
    if (rg_node_find(list, node->key, strlen(node->key)) != node) {
        rg_problem_add(t->ck->problems, node->key_at, &(rg_subject){.key = path}, "given twice");
        return false;
    }
    bool good = check_name(t, node, path);
    switch (node->kind) {
    case RG_NODE_LIST:
        return read_points(t, node, path) && good;
    case RG_NODE_MAPPING:
        return read_mapping(t, node, path) && good;
    case RG_NODE_SCALAR:
        return read_file(t, node, path) && good;
    case RG_NODE_BAD:
        break;
    }
    return false;
}

bool rg_tables_read(rg_check *ck, const rg_key *key, const rg_node *node, const char *path, rg_curves *all) {
    if (node->kind != RG_NODE_MAPPING) {
        rg_value_wrong(ck, key, node, path, NULL, "not a mapping of names to tables");
        return false;
    }
    bool good = true;
    all->curve = RG_NEW(rg_curve, (size_t)node->children + 1);
    for (int i = 0; i < node->children; i++) {
        const rg_node *child = &node->child[i];
        table t = {.ck = ck, .key = key, .curve = &all->curve[all->count]};
        char *item = rg_text_format("%s.%s", path, child->key);
        if (read_table(&t, node, child, item)) {
            t.curve->name = rg_text_copy(child->key, strlen(child->key));
            all->count++;
        } else {
            rg_free(t.curve->point);
            *t.curve = (rg_curve){0};
            good = false;
        }
        rg_free(item);
    }
    return good;
}

void rg_tables_write(FILE *out, const rg_curves *all) {
    for (int i = 0; i < all->count; i++) {
        const rg_curve *c = &all->curve[i];
        fprintf(out, "%s%s: {points: [", i > 0 ? ", " : "{", c->name);
        for (size_t k = 0; k < c->points; k++) {
            fprintf(out, "%s[%.17g, %.17g]", k > 0 ? ", " : "", c->point[k][0], c->point[k][1]);
        }
        fprintf(out, "], smooth: %s}", c->slope != NULL ? "true" : "false");
    }
    fputc('}', out);
}
