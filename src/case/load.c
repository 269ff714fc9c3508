/* Rules for the loads of a case: one of each entry, on one part of the body. */
#include <string.h>

#include "base/mem.h"
#include "case/check.h"

#define KINDS RG_LOADS(RG_LOAD_KEY, ", ")

static const char *const word[] = {
#define WORD(NAME, key, unit) key,
    RG_LOADS(WORD, )
#undef WORD
};

typedef struct {
    rg_check *ck;
    const rg_node *item;
    const char *path;
} entry;

static const rg_node *given(const entry *e, const char *key) {
    return rg_node_find(e->item, key, strlen(key));
}

static void wrong(const entry *e, const char *key, rg_place at, const char *allowed, const char *what) {
    char *path = key == NULL ? rg_text_format("%s", e->path) : rg_text_format("%s.%s", e->path, key);
    rg_problem_add(e->ck->problems, at, &(rg_subject){.key = path, .allowed = allowed}, "%s", what);
    rg_free(path);
}

static bool one_kind(const entry *e, rg_load_input *load) {
    int first = -1;
    for (int k = 0; k < RG_LOAD_KINDS; k++) {
        const rg_node *node = given(e, word[k]);
        if (node != NULL && first >= 0) {
            char *what = rg_text_format("%s and %s both given", word[first], word[k]);
            wrong(e, NULL, node->key_at, "exactly one of " KINDS, what);
            rg_free(what);
            return false;
        }
        first = node != NULL ? k : first;
    }
    if (first < 0) {
        wrong(e, NULL, e->item->at, "exactly one of " KINDS, "missing a load");
        return false;
    }
    load->kind = (rg_load_kind)first;
    return true;
}

static void check_part(const entry *e, const rg_load_input *load) {
    const rg_node *set = given(e, "set"), *where = given(e, "where");
    bool inside = load->kind == RG_LOAD_ACCELERATION;
    if (inside && set != NULL) {
        wrong(e, "set", set->key_at, NULL,
              "not used: an acceleration acts on elements, which `where` selects");
    } else if (inside && where != NULL && rg_expr_uses_normal(load->where)) {
        wrong(e, "where", where->at, NULL, "depends on a normal, which only faces have");
    } else if (!inside && (set != NULL) == (where != NULL)) {
        wrong(e, NULL, set != NULL ? where->key_at : e->item->at, "exactly one of set, where",
              set != NULL ? "set and where both given" : "missing set or where");
    }
}

void rg_load_rule(rg_check *ck, const rg_node *list, int i, const char *path, bool good) {
    rg_load_input *load = &ck->c->load[i];
    entry e = {ck, &list->child[i], path};
    if (load->name != NULL) {
        rg_name_rule(ck, e.item, path, load->name);
    }
    if (e.item->kind != RG_NODE_MAPPING || !one_kind(&e, load) || !good) {
        return;
    }
    check_part(&e, load);
    if (load->until > 0 && load->until <= load->from) {
        wrong(&e, "until", given(&e, "until")->at, NULL, "not after `from`");
    }
}
