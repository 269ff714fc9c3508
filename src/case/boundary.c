/* Rules for the boundary of a case: one thing an entry, and one entry for each set and component. */
#include <string.h>

#include "base/mem.h"
#include "case/check.h"

#define KINDS RG_PRESCRIBED(RG_PRESCRIBED_KEY, ", ") ", absorbing"

static void wrong(rg_check *ck, const char *path, const char *key, rg_place at, const char *allowed,
                  const char *what) {
    char *full = rg_text_format("%s.%s", path, key);
    rg_problem_add(ck->problems, at, &(rg_subject){.key = full, .allowed = allowed}, "%s", what);
    rg_free(full);
}

static bool one_kind(rg_check *ck, const rg_node *item, const char *path, rg_boundary *b) {
    const char *first = NULL;
    rg_subject subject = {.key = path, .allowed = "exactly one of " KINDS};
    for (int k = 0; k < rg_boundary_table.keys; k++) {
        const rg_key *key = &rg_boundary_table.key[k];
        const rg_node *given = rg_node_find(item, key->name, strlen(key->name));
        if (key->alternative != RG_EXACTLY_ONE || given == NULL) {
            continue;
        }
        if (first != NULL) {
            rg_problem_add(ck->problems, given->key_at, &subject, "%s and %s both given", first, key->name);
            return false;
        }
        first = key->name;
        b->prescribed = key->prescribed;
    }
    if (first == NULL) {
        rg_problem_add(ck->problems, item->at, &subject,
                       "missing " RG_PRESCRIBED(RG_PRESCRIBED_KEY, " or ") " or absorbing");
    }
    return first != NULL;
}

/* The component is there where it is needed, and nowhere else. */
static bool check_component(rg_check *ck, const rg_node *item, const char *path, const rg_boundary *b) {
    const rg_node *node = rg_node_find(item, "component", strlen("component"));
    bool needed = rg_boundary_has_component(b);
    if (needed && node == NULL) {
        wrong(ck, path, "component", item->at, "x, y, z", "missing");
    } else if (!needed && node != NULL) {
        wrong(ck, path, "component", node->key_at, NULL,
              "not used: it belongs to a velocity or displacement");
    }
    return needed == (node != NULL);
}

static bool check_times(rg_check *ck, const rg_node *item, const char *path, const rg_boundary *b) {
    static const char *const keys[] = {"from", "until"};
    const rg_node *node[2];
    bool good = true;
    for (int i = 0; i < 2; i++) {
        node[i] = rg_node_find(item, keys[i], strlen(keys[i]));
        if (node[i] != NULL && b->absorbing) {
            wrong(ck, path, keys[i], node[i]->key_at, NULL, "not used: a side absorbs all the time");
            good = false;
        }
    }
    if (good && b->until > 0 && b->until <= b->from) {
        wrong(ck, path, "until", node[1]->at, NULL, "not after `from`");
        good = false;
    }
    return good;
}

static bool check_absorbing(rg_check *ck, const rg_node *item, const char *path, const rg_boundary *b) {
    const rg_node *node = rg_node_find(item, "absorbing", strlen("absorbing"));
    const rg_node *name = rg_node_find(item, "name", strlen("name"));
    if (node != NULL && !b->absorbing) {
        wrong(ck, path, "absorbing", node->at, "true", "prescribes nothing");
    } else if (node != NULL && name != NULL) {
        wrong(ck, path, "name", name->key_at, NULL, "not used: what leaves is `radiated` in energy.csv");
    }
    return node == NULL || (b->absorbing && name == NULL);
}

static const rg_node *same_motion(const rg_case *c, const rg_node *list, int i) {
    for (int j = 0; j < i; j++) {
        const rg_boundary *a = &c->boundary[j], *b = &c->boundary[i];
        if (b->component >= 0 && a->component == b->component && strcmp(a->set, b->set) == 0) {
            return &list->child[j];
        }
    }
    return NULL;
}

void rg_boundary_rule(rg_check *ck, const rg_node *list, int i, const char *path, bool good) {
    rg_boundary *b = &ck->c->boundary[i];
    const rg_node *item = &list->child[i];
    if (b->name != NULL) {
        rg_name_rule(ck, item, path, b->name);
    }
    good = item->kind == RG_NODE_MAPPING && one_kind(ck, item, path, b) && good;
    good = good && check_absorbing(ck, item, path, b) && check_times(ck, item, path, b) &&
           check_component(ck, item, path, b);
    if (!good || !rg_boundary_has_component(b)) {
        b->component = -1; /* equals no other */
        return;
    }
    const rg_node *first = same_motion(ck->c, list, i);
    if (first != NULL) {
        rg_problem_add(ck->problems, item->at, &(rg_subject){.key = path},
                       "set %s component %c is prescribed twice, first at line %d column %d", b->set,
                       "xyz"[b->component], first -> at.line, first->at.column);
    }
}
