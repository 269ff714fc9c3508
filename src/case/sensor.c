/* Rules for the sensors of a case, each on one part of the body, for forces of contact, and for the tips and
 * fronts of cracks. */
#include <math.h>
#include <string.h>

#include "base/vector.h"
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

static void check_one_part(const rg_entry *e) {
    static const char *const keys[] = {"set", "where", "between"};
    const rg_node *last = NULL;
    int given = 0;
    for (int i = 0; i < 3; i++) {
        const rg_node *node = rg_entry_given(e, keys[i]);
        last = node != NULL ? node : last;
        given += node != NULL;
    }
    if (given != 1) {
        rg_entry_wrong(e, NULL, last != NULL ? last->key_at : e->item->at,
                       (rg_subject){.allowed = "exactly one of set, where, between"},
                       given == 0 ? "missing set, where or between" : "more than one given");
    }
}

void rg_contact_force_rule(rg_check *ck, const rg_node *list, int i, const char *path, bool good) {
    const rg_contact_force_input *force = &ck->c->output.contact[i];
    rg_entry e = {ck, &list->child[i], path};
    const rg_node *between = good ? rg_entry_given(&e, "between") : NULL;
    if (force->name != NULL) {
        rg_name_rule(ck, e.item, path, force->name);
    }
    if (good) {
        check_one_part(&e);
    }
    if (between != NULL) {
        rg_between_rule(ck, between, force->names, force->between, false, path);
    }
    if (between != NULL && force->names == 2 && strcmp(force->between[0], force->between[1]) == 0) {
        rg_entry_wrong(&e, "between", between->at, (rg_subject){.allowed = "names of two materials"},
                       "what a material does to itself adds up to nothing");
    }
}

/* Whether a vector has a direction. */
static bool check_direction(const rg_entry *e, const char *key, const double d[3]) {
    bool good = d[0] != 0 || d[1] != 0 || d[2] != 0;
    if (!good) {
        const rg_node *node = rg_entry_given(e, key);
        char value[64];
        rg_entry_wrong(e, key, node->at, (rg_subject){.value = rg_node_line(node, value, sizeof value)},
                       "has no direction");
    }
    return good;
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
    const rg_node *where = rg_entry_given(&e, "where");
    check_direction(&e, "direction", tip->direction);
    if (where != NULL && rg_entry_given(&e, "set") != NULL) {
        rg_entry_wrong(&e, NULL, where->key_at, (rg_subject){.allowed = "at most one of set, where"},
                       "set and where both given");
    }
}

static const rg_crack_tip_input *tip_of(const rg_case *c, const char *name) {
    for (int k = 0; k < c->output.crack_tips; k++) {
        if (c->output.crack_tip[k].name != NULL && strcmp(c->output.crack_tip[k].name, name) == 0) {
            return &c->output.crack_tip[k];
        }
    }
    return NULL;
}

/* Along whose direction its tip is looked for tells how far along its own. */
static void check_tip(const rg_entry *e, const rg_crack_front_input *front) {
    const rg_crack_tip_input *tip = tip_of(e->ck->c, front->tip);
    const rg_node *node = rg_entry_given(e, "tip");
    if (tip == NULL) {
        rg_entry_wrong(e, "tip", node->at, (rg_subject){.value = front->tip},
                       "no such tip in output.crack_tips");
    } else if (!(rg_vector_dot(tip->direction, front->direction) > 0)) {
        rg_entry_wrong(e, "tip", node->at, (rg_subject){.value = front->tip},
                       "that tip is looked for against the direction of this front");
    }
}

void rg_crack_front_rule(rg_check *ck, const rg_node *list, int i, const char *path, bool good) {
    rg_crack_front_input *front = &ck->c->output.crack_front[i];
    rg_entry e = {ck, &list->child[i], path};
    if (e.item->kind == RG_NODE_MAPPING && rg_entry_given(&e, "values") == NULL) {
        front->values = 1u << RG_FRONT_RELEASE | 1u << RG_FRONT_INTENSITY;
    }
    if (front->name != NULL) {
        rg_name_rule(ck, e.item, path, front->name);
    }
    if (e.item->kind != RG_NODE_MAPPING || !good) {
        return;
    }
    const double *d = front->direction, *n = front->normal;
    bool lines = check_direction(&e, "direction", d);
    lines &= check_direction(&e, "normal", n);
    check_words(&e, "values", front->values);
    if (lines && !(fabs(rg_vector_dot(d, n)) <= 1e-6 * sqrt(rg_vector_dot(d, d) * rg_vector_dot(n, n)))) {
        rg_entry_wrong(&e, "normal", rg_entry_given(&e, "normal")->at, (rg_subject){.value = NULL},
                       "not at right angles to the direction");
    }
    if (!(front->radius.inner < front->radius.outer)) {
        rg_entry_wrong(&e, "radius", rg_entry_given(&e, "radius")->at, (rg_subject){.value = NULL},
                       "inner is not below outer");
    }
    if (front->symmetric && (front->values & (1u << RG_FRONT_SLIDING | 1u << RG_FRONT_TEARING)) != 0) {
        rg_entry_wrong(&e, "values", rg_entry_given(&e, "values")->at, (rg_subject){.allowed = "J, K, KI"},
                       "a symmetric half tells of opening alone");
    }
    if (front->tip != NULL) {
        check_tip(&e, front);
    }
}
