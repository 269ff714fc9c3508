/* Rules for the loads of a case: one of each entry, on one part of the body. */
#include <string.h>

#include "base/mem.h"
#include "case/entry.h"

#define KINDS RG_LOADS(RG_LOAD_KEY, ", ")

static const char *const word[] = {
#define WORD(NAME, key, unit) key,
    RG_LOADS(WORD, )
#undef WORD
};

static bool one_kind(const rg_entry *e, rg_load_input *load) {
    int first = -1;
    for (int k = 0; k < RG_LOAD_KINDS; k++) {
        const rg_node *node = rg_entry_given(e, word[k]);
        if (node != NULL && first >= 0) {
            char *what = rg_text_format("%s and %s both given", word[first], word[k]);
            rg_entry_wrong(e, NULL, node->key_at, (rg_subject){.allowed = "exactly one of " KINDS}, what);
            rg_free(what);
            return false;
        }
        first = node != NULL ? k : first;
    }
    if (first < 0) {
        rg_entry_wrong(e, NULL, e->item->at, (rg_subject){.allowed = "exactly one of " KINDS},
                       "missing a load");
        return false;
    }
    load->kind = (rg_load_kind)first;
    return true;
}

static void check_part(const rg_entry *e, const rg_load_input *load) {
    const rg_node *set = rg_entry_given(e, "set"), *where = rg_entry_given(e, "where");
    bool inside = rg_load_is_inside(load);
    const rg_node *cracks = rg_entry_given(e, "cracks");
    if (cracks != NULL && load->kind != RG_LOAD_PRESSURE) {
        rg_entry_wrong(e, "cracks", cracks->key_at, (rg_subject){0}, "not used: it belongs to a pressure");
        return;
    }
    if (load->cracks && e->ck->c->interface.law == RG_LAW_NONE) {
        rg_entry_wrong(e, "cracks", cracks->at, (rg_subject){.value = "true"},
                       "nothing opens, because interface.law is none");
        return;
    }
    if (inside && set != NULL) {
        rg_entry_wrong(e, "set", set->key_at, (rg_subject){0},
                       load->kind == RG_LOAD_ACCELERATION
                           ? "not used: an acceleration acts on elements, which `where` selects"
                           : "not used: centrifugal forces act on elements, which `where` selects");
    } else if (inside && where != NULL && rg_expr_uses_normal(load->where)) {
        rg_entry_wrong(e, "where", where->at, (rg_subject){0}, "depends on a normal, which only faces have");
    } else if (!inside && (set != NULL) == (where != NULL) && !(load->cracks && set == NULL)) {
        rg_entry_wrong(e, NULL, set != NULL ? where->key_at : e->item->at,
                       (rg_subject){.allowed = "exactly one of set, where"},
                       set != NULL ? "set and where both given" : "missing set or where");
    }
}

static void check_axis(const rg_entry *e, const rg_load_input *load) {
    const rg_node *axis = rg_entry_given(e, "centrifugal.axis"),
                  *speed = rg_entry_given(e, "centrifugal.speed");
    if (load->kind != RG_LOAD_CENTRIFUGAL) {
        return;
    }
    const char *missing = speed == NULL ? "centrifugal.speed" : axis == NULL ? "centrifugal.axis" : NULL;
    if (missing != NULL) {
        rg_entry_wrong(e, missing, e->item->at, (rg_subject){.allowed = axis == NULL ? "3 numbers" : NULL},
                       "missing");
    } else if (load->axis[0] == 0 && load->axis[1] == 0 && load->axis[2] == 0) {
        char value[64];
        rg_entry_wrong(e, "centrifugal.axis", axis->at,
                       (rg_subject){.value = rg_node_line(axis, value, sizeof value)}, "has no direction");
    }
}

void rg_load_rule(rg_check *ck, const rg_node *list, int i, const char *path, bool good) {
    rg_load_input *load = &ck->c->load[i];
    rg_entry e = {ck, &list->child[i], path};
    if (load->name != NULL) {
        rg_name_rule(ck, e.item, path, load->name);
    }
    if (e.item->kind != RG_NODE_MAPPING || !one_kind(&e, load) || !good) {
        return;
    }
    check_part(&e, load);
    check_axis(&e, load);
    if (load->until > 0 && load->until <= load->from) {
        rg_entry_wrong(&e, "until", rg_entry_given(&e, "until")->at, (rg_subject){0}, "not after `from`");
    }
}
