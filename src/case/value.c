/* Single values: text of the case file to numbers, choices, texts and expressions. */
#include "case/check.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/mem.h"
#include "case/expr.h"
#include "case/table.h"

void rg_value_wrong(rg_check *ck, const rg_key *key, const rg_node *node, const char *path,
                    const char *nearest, const char *what) {
    char value[64], allowed[512];
    if (node->kind == RG_NODE_BAD) {
        return;
    }
    rg_subject subject = {.key = path,
                          .value = rg_node_is_null(node) ? NULL : rg_node_line(node, value, sizeof value),
                          .allowed = rg_key_allowed(key, allowed, sizeof allowed),
                          .nearest = nearest};
    rg_problem_add(ck->problems, node->at, &subject, "%s", rg_node_is_null(node) ? "no value" : what);
}

/* ---- numbers ---- */

static bool is_special(const char *text) {
    static const char *const special[] = {"nan", "inf", "infinity"};
    text += text[0] == '+' || text[0] == '-' ? 1 : 0;
    text += text[0] == '.' ? 1 : 0;
    for (int i = 0; i < 3; i++) {
        if (strcasecmp(text, special[i]) == 0) {
            return true;
        }
    }
    return false;
}

/* What keeps the node from being a number, or NULL. */
static const char *not_a_number(const rg_node *node, bool *integer) {
    *integer = false;
    if (node->kind != RG_NODE_SCALAR) {
        return "not a number";
    }
    if (!rg_is_number(node->text, integer)) {
        return node->plain && is_special(node->text) ? "not finite" : "not a number";
    }
    return node->plain ? NULL : "a text (in quotes), not a number";
}

static bool in_range(const rg_key *key, double v) {
    bool above = key->low_open ? v > key->low : v >= key->low;
    return above && (key->high_open ? v < key->high : v <= key->high);
}

static const char *read_real(const rg_key *key, const rg_node *node, double *out) {
    bool integer = false;
    const char *wrong = not_a_number(node, &integer);
    if (wrong != NULL) {
        return wrong;
    }
    *out = strtod(node->text, NULL);
    if (!isfinite(*out)) {
        return "not finite";
    }
    return in_range(key, *out) ? NULL : "out of range";
}

static const char *read_integer(const rg_key *key, const rg_node *node, int64_t *out) {
    bool integer = false;
    const char *wrong = not_a_number(node, &integer);
    if (wrong != NULL) {
        return wrong;
    }
    if (!integer) {
        return "not an integer";
    }
    errno = 0;
    long long v = strtoll(node->text, NULL, 10);
    *out = v;
    return errno == 0 && in_range(key, (double)v) ? NULL : "out of range";
}

static bool read_number(rg_check *ck, const rg_key *key, const rg_node *node, const char *path, void *value,
                        int i) {
    const char *wrong = key->type == RG_KEY_INTEGER ? read_integer(key, node, (int64_t *)value + i)
                                                    : read_real(key, node, (double *)value + i);
    if (wrong != NULL) {
        rg_value_wrong(ck, key, node, path, NULL, wrong);
    }
    return wrong == NULL;
}

static bool read_numbers(rg_check *ck, const rg_key *key, const rg_node *node, const char *path,
                         void *value) {
    if (key->count == 1) {
        return read_number(ck, key, node, path, value, 0);
    }
    if (node->kind != RG_NODE_LIST || node->children != key->count) {
        rg_value_wrong(ck, key, node, path, NULL,
                       node->kind == RG_NODE_LIST ? "wrong number of entries" : "not a list");
        return false;
    }
    rg_key single = *key;
    single.count = 1;
    bool good = true;
    for (int i = 0; i < key->count; i++) {
        char *item = rg_text_format("%s[%d]", path, i);
        good = read_number(ck, &single, &node->child[i], item, value, i) && good;
        rg_free(item);
    }
    return good;
}

/* ---- words ---- */

/* YAML takes plain true, 12 or ~ for a truth value, a number or null. */
static const char *not_a_text(const rg_node *node) {
    bool integer = false;
    if (node->kind != RG_NODE_SCALAR || rg_node_is_null(node) || node->text[0] == '\0') {
        return "not a text";
    }
    bool truth = strcmp(node->text, "true") == 0 || strcmp(node->text, "false") == 0;
    bool other = rg_is_number(node->text, &integer) || truth;
    return node->plain && other ? "not a text (put it in quotes to make it one)" : NULL;
}

/* Position of the node's text among the key's choices. */
static bool read_choice(rg_check *ck, const rg_key *key, const rg_node *node, const char *path, int *choice) {
    if (node->kind != RG_NODE_SCALAR) {
        rg_value_wrong(ck, key, node, path, NULL, "not one of the allowed words");
        return false;
    }
    for (int i = 0; key->choice[i] != NULL; i++) {
        if (strcmp(node->text, key->choice[i]) == 0) {
            *choice = i;
            return true;
        }
    }
    rg_value_wrong(ck, key, node, path, rg_nearest(node->text, key->choice), "not one of the allowed words");
    return false;
}

static bool read_flags(rg_check *ck, const rg_key *key, const rg_node *node, const char *path,
                       unsigned *flags) {
    *flags = 0;
    if (node->kind != RG_NODE_LIST) {
        rg_value_wrong(ck, key, node, path, NULL, "not a list");
        return false;
    }
    bool good = true;
    for (int i = 0; i < node->children; i++) {
        char *item = rg_text_format("%s[%d]", path, i);
        int choice = 0;
        bool known = read_choice(ck, key, &node->child[i], item, &choice);
        unsigned bit = known ? 1U << choice : 0;
        bool twice = (*flags & bit) != 0;
        if (twice) {
            rg_value_wrong(ck, key, &node->child[i], item, NULL, "given twice");
        }
        good = good && known && !twice;
        *flags |= bit;
        rg_free(item);
    }
    return good;
}

static bool read_text(rg_check *ck, const rg_key *key, const rg_node *node, const char *path, void *value) {
    int choice = 0;
    rg_key any = *key;
    any.choice = NULL;
    if (key->choice != NULL && ck->usage[RG_GROUP_BOX] != RG_UNUSED) { /* the file's sets are its own */
        if (!read_choice(ck, key, node, path, &choice)) {
            return false;
        }
    } else if (not_a_text(node) != NULL) {
        rg_value_wrong(ck, &any, node, path, NULL, not_a_text(node));
        return false;
    }
    rg_pointer_set(value, rg_text_copy(node->text, strlen(node->text)));
    return true;
}

/* ---- lists of any length ---- */

typedef bool read_item(rg_check *ck, const rg_key *key, const rg_node *node, const char *path, void *value);

static bool read_real_item(rg_check *ck, const rg_key *key, const rg_node *node, const char *path,
                           void *value) {
    return read_number(ck, key, node, path, value, 0);
}

/* Makes the array that the key's pointer in `base` leads to, with an item of `size` bytes for each entry. */
static bool read_items(rg_check *ck, const rg_key *key, const rg_node *node, const char *path, char *base,
                       size_t size, read_item *read) {
    if (node->kind != RG_NODE_LIST || node->children == 0) {
        rg_value_wrong(ck, key, node, path, NULL,
                       node->kind == RG_NODE_LIST ? "an empty list" : "not a list");
        return false;
    }
    rg_key single = *key;
    single.count = 1;
    single.type = key->type == RG_KEY_REALS ? RG_KEY_REAL : RG_KEY_TEXT;
    char *items = rg_alloc((size_t)node->children, size);
    rg_pointer_set(base + key->offset, items);
    memcpy(base + key->offset_count, &node->children, sizeof node->children);
    bool good = true;
    for (int i = 0; i < node->children; i++) {
        char *item = rg_text_format("%s[%d]", path, i);
        good = read(ck, &single, &node->child[i], item, items + (size_t)i * size) && good;
        rg_free(item);
    }
    return good;
}

/* The word any stands for a list of it. */
static bool read_texts(rg_check *ck, const rg_key *key, const rg_node *node, const char *path, char *base) {
    rg_node item = *node, list = {.kind = RG_NODE_LIST, .at = node->at, .children = 1, .child = &item};
    bool any = node->kind == RG_NODE_SCALAR && strcmp(node->text, "any") == 0;
    return read_items(ck, key, any ? &list : node, path, base, sizeof(char *), read_text);
}

static bool read_reals(rg_check *ck, const rg_key *key, const rg_node *node, const char *path, char *base) {
    if (!read_items(ck, key, node, path, base, sizeof(double), read_real_item)) {
        return false;
    }
    const double *value = rg_pointer_get(base + key->offset);
    for (int i = 1; i < node->children; i++) {
        if (value[i] <= value[i - 1]) {
            rg_value_wrong(ck, key, node, path, NULL, "not ascending");
            return false;
        }
    }
    return true;
}

/* ---- expressions and the output interval ---- */

static bool read_expr(rg_check *ck, const rg_key *key, const rg_node *node, const char *path, void *value) {
    if (node->kind != RG_NODE_SCALAR || rg_node_is_null(node) || (node->plain && is_special(node->text))) {
        rg_value_wrong(ck, key, node, path, NULL,
                       node->kind == RG_NODE_SCALAR ? "not finite" : "not a number or expression");
        return false;
    }
    char *message = NULL;
    rg_expr *e = rg_expr_with(node->text, &ck->c->tables, &message);
    if (e == NULL) {
        rg_value_wrong(ck, key, node, path, NULL, message);
        rg_free(message);
        return false;
    }
    if (!key->normal && rg_expr_uses_normal(e)) {
        rg_value_wrong(ck, key, node, path, NULL, "depends on a normal, which only faces have");
        rg_expr_free(e);
        return false;
    }
    if (key->no_time && rg_expr_uses_time(e)) {
        rg_value_wrong(ck, key, node, path, NULL, "depends on t, but this is the state at the start");
        rg_expr_free(e);
        return false;
    }
    if (key->no_place && rg_expr_uses_position(e)) {
        rg_value_wrong(ck, key, node, path, NULL, "depends on x, y or z, but this is the same everywhere");
        rg_expr_free(e);
        return false;
    }
    rg_expr_free(rg_pointer_get(value)); /* of the other key of the group, where both are wrongly given */
    rg_pointer_set(value, e);
    return true;
}

/* A number is in range at once; what an expression gives is looked at where the faces are known. */
static bool read_face_value(rg_check *ck, const rg_key *key, const rg_node *node, const char *path,
                            char *base) {
    bool integer = false;
    bool number = node->kind == RG_NODE_SCALAR && rg_is_number(node->text, &integer);
    if (number && !read_number(ck, key, node, path, base + key->offset, 0)) {
        return false;
    }
    return read_expr(ck, key, node, path, base + key->offset_expr);
}

bool rg_bool_read(const rg_node *node, bool *value) {
    bool plain = node->kind == RG_NODE_SCALAR && node->plain;
    *value = plain && strcmp(node->text, "true") == 0;
    return *value || (plain && strcmp(node->text, "false") == 0);
}

static bool read_bool(rg_check *ck, const rg_key *key, const rg_node *node, const char *path, bool *value) {
    bool good = rg_bool_read(node, value);
    if (!good) {
        rg_value_wrong(ck, key, node, path, NULL, "neither true nor false");
    }
    return good;
}

static bool read_interval(rg_check *ck, const rg_key *key, const rg_node *node, const char *path,
                          rg_case *c) {
    bool integer = false;
    const char *wrong = not_a_number(node, &integer);
    if (wrong == NULL) {
        rg_key steps = {.low = 1, .high = INFINITY};
        rg_key seconds = {.low = 0, .low_open = true, .high = 1, .high_open = true};
        wrong = integer ? read_integer(&steps, node, &c->output.interval_steps)
                        : read_real(&seconds, node, &c->output.interval_time);
    }
    if (wrong != NULL) {
        rg_value_wrong(ck, key, node, path, NULL, wrong);
    }
    return wrong == NULL;
}

bool rg_value_read(rg_check *ck, const rg_key *key, const rg_node *node, const char *path, void *base) {
    void *value = (char *)base + key->offset;
    switch (key->type) {
    case RG_KEY_REAL:
    case RG_KEY_INTEGER:
        return read_numbers(ck, key, node, path, value);
    case RG_KEY_CHOICE:
        return read_choice(ck, key, node, path, value);
    case RG_KEY_FLAGS:
        return read_flags(ck, key, node, path, value);
    case RG_KEY_TEXT:
        return read_text(ck, key, node, path, value);
    case RG_KEY_TEXTS:
        return read_texts(ck, key, node, path, base);
    case RG_KEY_REALS:
        return read_reals(ck, key, node, path, base);
    case RG_KEY_EXPR:
        return read_expr(ck, key, node, path, value);
    case RG_KEY_FACE:
        return read_face_value(ck, key, node, path, base);
    case RG_KEY_BOOL:
        return read_bool(ck, key, node, path, value);
    case RG_KEY_INTERVAL:
        return read_interval(ck, key, node, path, base);
    case RG_KEY_LIBRARY:
        return read_text(ck, key, node, path, value);
    case RG_KEY_PARAMETERS: /* which there are only the library knows: rg_user_rule */
        if (node->kind != RG_NODE_MAPPING) {
            rg_value_wrong(ck, key, node, path, NULL, "not a mapping of keys");
        }
        return node->kind == RG_NODE_MAPPING;
    case RG_KEY_TABLES:
        return rg_tables_read(ck, key, node, path, value);
    case RG_KEY_LIST:
        break;
    }
    return false;
}
