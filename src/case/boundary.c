/* Rules for the boundary of a case: one thing an entry, on one part of the surface, and at any time one entry
 * for each set and component. */
#include <string.h>

#include "base/mem.h"
#include "case/entry.h"

#define KINDS RG_PRESCRIBED(RG_PRESCRIBED_KEY, ", ") ", absorbing, dashpot"

static bool one_kind(const rg_entry *e, rg_boundary *b) {
    const char *first = NULL;
    rg_subject subject = {.allowed = "exactly one of " KINDS};
    for (int k = 0; k < rg_boundary_table.keys; k++) {
        const rg_key *key = &rg_boundary_table.key[k];
        const rg_node *given = rg_entry_given(e, key->name);
        if (key->alternative != RG_EXACTLY_ONE || given == NULL) {
            continue;
        }
        if (first != NULL) {
            char *what = rg_text_format("%s and %s both given", first, key->name);
            rg_entry_wrong(e, NULL, given->key_at, subject, what);
            rg_free(what);
            return false;
        }
        first = key->name;
        b->prescribed = key->prescribed;
    }
    if (first == NULL) {
        rg_entry_wrong(e, NULL, e->item->at, subject,
                       "missing " RG_PRESCRIBED(RG_PRESCRIBED_KEY, " or ") " or absorbing or dashpot");
    }
    return first != NULL;
}

static bool check_part(const rg_entry *e) {
    const rg_node *set = rg_entry_given(e, "set"), *where = rg_entry_given(e, "where");
    bool one = (set == NULL) != (where == NULL);
    if (!one) {
        rg_entry_wrong(e, NULL, set != NULL ? where->key_at : e->item->at,
                       (rg_subject){.allowed = "exactly one of set, where"},
                       set != NULL ? "set and where both given" : "missing set or where");
    }
    return one;
}

/* Reports keys that are there to no purpose. */
static bool refuse(const rg_entry *e, const char *const keys[], bool used, const char *why) {
    bool good = true;
    for (int i = 0; !used && keys[i] != NULL; i++) {
        const rg_node *node = rg_entry_given(e, keys[i]);
        if (node != NULL) {
            rg_entry_wrong(e, keys[i], node->key_at, (rg_subject){0}, why);
            good = false;
        }
    }
    return good;
}

/* The component or direction is there where it is needed, and nowhere else. */
static bool check_line(const rg_entry *e, const rg_boundary *b) {
    static const char *const keys[] = {"component", "direction", NULL};
    const rg_node *component = rg_entry_given(e, keys[0]), *direction = rg_entry_given(e, keys[1]);
    if (!rg_boundary_is_along_line(b)) {
        return refuse(e, keys, false, "not used: it belongs to a velocity or displacement");
    }
    if (component == NULL && direction == NULL) {
        rg_entry_wrong(e, "component", e->item->at, (rg_subject){.allowed = "x, y, z"}, "missing");
    } else if (component != NULL && direction != NULL) {
        rg_entry_wrong(e, NULL, direction->key_at, (rg_subject){.allowed = "one of component, direction"},
                       "component and direction both given");
    } else if (direction != NULL && rg_boundary_has_component(b)) {
        char value[64];
        rg_entry_wrong(e, "direction", direction->at,
                       (rg_subject){.value = rg_node_line(direction, value, sizeof value)},
                       "has no direction");
    } else {
        return true;
    }
    return false;
}

static bool check_axis(const rg_entry *e, const rg_boundary *b) {
    static const char *const keys[] = {"axis", "at", "translation", NULL};
    bool rigid = !rg_boundary_damps(b) && b->prescribed == RG_PRESCRIBED_ANGLE;
    const rg_node *axis = rg_entry_given(e, "axis");
    bool good = refuse(e, keys, rigid, "not used: it belongs to an angle");
    if (rigid && axis == NULL) {
        rg_entry_wrong(e, "axis", e->item->at, (rg_subject){.allowed = "3 numbers"},
                       "missing: an angle turns about it");
    } else if (rigid && b->axis[0] == 0 && b->axis[1] == 0 && b->axis[2] == 0) {
        char value[64];
        rg_entry_wrong(e, "axis", axis->at, (rg_subject){.value = rg_node_line(axis, value, sizeof value)},
                       "has no direction");
    } else {
        return good;
    }
    return false;
}

static bool check_times(const rg_entry *e, const rg_boundary *b) {
    static const char *const keys[] = {"from", "until", NULL};
    bool good = refuse(e, keys, !rg_boundary_damps(b), "not used: a side absorbs all the time");
    if (good && b->until > 0 && b->until <= b->from) {
        rg_entry_wrong(e, "until", rg_entry_given(e, "until")->at, (rg_subject){0}, "not after `from`");
        good = false;
    }
    return good;
}

/* Whether there is a motion or a side that absorbs. */
static bool check_absorbing(const rg_entry *e, const rg_boundary *b) {
    const rg_node *node = rg_entry_given(e, "absorbing"), *name = rg_entry_given(e, "name");
    if (node != NULL && !b->absorbing) {
        rg_entry_wrong(e, "absorbing", node->at, (rg_subject){.allowed = "true"}, "prescribes nothing");
    } else if (rg_boundary_damps(b) && name != NULL) {
        rg_entry_wrong(e, "name", name->key_at, (rg_subject){0},
                       "not used: what leaves is `radiated` in energy.csv");
    }
    return node == NULL || b->absorbing;
}

static const rg_node *same_motion(const rg_case *c, const rg_node *list, int i) {
    for (int j = 0; j < i; j++) {
        const rg_boundary *a = &c->boundary[j], *b = &c->boundary[i];
        if (b->component >= 0 && a->component == b->component && a->set != NULL && b->set != NULL &&
            strcmp(a->set, b->set) == 0 && rg_boundaries_meet(a, b)) {
            return &list->child[j];
        }
    }
    return NULL;
}

void rg_boundary_rule(rg_check *ck, const rg_node *list, int i, const char *path, bool good) {
    rg_boundary *b = &ck->c->boundary[i];
    rg_entry e = {ck, &list->child[i], path};
    if (b->name != NULL) {
        rg_name_rule(ck, e.item, path, b->name);
    }
    bool mapping = e.item->kind == RG_NODE_MAPPING, part = mapping && check_part(&e);
    good = mapping && one_kind(&e, b) && part && good;
    good = good && check_absorbing(&e, b);
    if (good) { /* all that is wrong with it */
        bool times = check_times(&e, b), line = check_line(&e, b), axis = check_axis(&e, b);
        good = times && line && axis;
    }
    if (!good || !rg_boundary_has_component(b)) {
        b->component = -1; /* equals no other */
        return;
    }
    const rg_node *first = same_motion(ck->c, list, i);
    if (first != NULL) {
        char *what = rg_text_format("set %s component %c is prescribed twice, first at line %d column %d",
                                    b->set, "xyz"[b->component], first -> at.line, first->at.column);
        rg_entry_wrong(&e, NULL, e.item->at, (rg_subject){0}, what);
        rg_free(what);
    }
}
