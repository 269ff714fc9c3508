/* Rules for the sensors of a case, each on one part of the body, and for the tips of cracks. */
#include <string.h>

#include "case/entry.h"

static void check_part(const rg_entry *e) {
    static const char *const keys[] = {"set", "where", "material"};
    const rg_node *first = NULL;
    for (int i = 0; i < 3; i++) {
        const rg_node *node = rg_entry_given(e, keys[i]);
        if (node != NULL && first != NULL) {
            rg_entry_wrong(e, NULL, node->key_at,
                           (rg_subject){.allowed = "at most one of set, where, material"},
                           "more than one given");
            return;
        }
        first = node != NULL ? node : first;
    }
    const rg_node *material = rg_entry_given(e, "material");
    if (material != NULL && material->kind == RG_NODE_SCALAR &&
        rg_case_find_material(e->ck->c, material->text) < 0) {
        rg_entry_wrong(e, "material", material->at, (rg_subject){.value = material->text},
                       "no such material");
    }
}

/* A list that is empty asks for nothing. */
static void check_words(const rg_entry *e, const char *key, unsigned bits) {
    const rg_node *node = rg_entry_given(e, key);
    if (node != NULL && bits == 0) {
        rg_entry_wrong(e, key, node->at, (rg_subject){.value = "[]"}, "nothing is to be recorded");
    }
}

void rg_sensor_rule(rg_check *ck, const rg_node *list, int i, const char *path, bool good) {
    rg_sensor_input *sensor = &ck->c->output.sensor[i];
    rg_entry e = {ck, &list->child[i], path};
    if (e.item->kind == RG_NODE_MAPPING && rg_entry_given(&e, "measures") == NULL) {
        sensor->measures = 1u << RG_SENSOR_MEAN;
    }
    if (sensor->name != NULL) {
        rg_name_rule(ck, e.item, path, sensor->name);
    }
    if (e.item->kind == RG_NODE_MAPPING && good) {
        check_part(&e);
        check_words(&e, "values", sensor->values);
        check_words(&e, "measures", sensor->measures);
    }
}

void rg_crack_tip_rule(rg_check *ck, const rg_node *list, int i, const char *path, bool good) {
    const rg_crack_tip_input *tip = &ck->c->output.crack_tip[i];
    rg_entry e = {ck, &list->child[i], path};
    if (tip->name != NULL) {
        rg_name_rule(ck, e.item, path, tip->name);
    }
    if (e.item->kind != RG_NODE_MAPPING || !good) {
        return;
    }
    const rg_node *direction = rg_entry_given(&e, "direction"), *where = rg_entry_given(&e, "where");
    const double *d = tip->direction;
    if (d[0] == 0 && d[1] == 0 && d[2] == 0) {
        char value[64];
        rg_entry_wrong(&e, "direction", direction->at,
                       (rg_subject){.value = rg_node_line(direction, value, sizeof value)},
                       "has no direction");
    }
    if (where != NULL && rg_entry_given(&e, "set") != NULL) {
        rg_entry_wrong(&e, NULL, where->key_at, (rg_subject){.allowed = "at most one of set, where"},
                       "set and where both given");
    }
}
