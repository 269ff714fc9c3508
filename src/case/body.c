/* Rules for the bodies of a case: which values each shape and motion needs. */
#include <string.h>

#include "base/mem.h"
#include "case/entry.h"

/* The key where it is needed, and nowhere else. Returns whether to look at its value. */
static bool only_where(const rg_entry *e, const char *key, bool needed, const char *who) {
    const rg_node *node = rg_entry_given(e, key);
    if (needed != (node != NULL)) {
        char *what = rg_text_format("%s: %s", needed ? "missing" : "not used", who);
        rg_entry_wrong(e, key, needed ? e->item->at : node->key_at, (rg_subject){0}, what);
        rg_free(what);
    }
    return needed && node != NULL;
}

static void check_direction(const rg_entry *e, const char *key, bool needed, const double v[3],
                            const char *who) {
    if (only_where(e, key, needed, who) && v[0] == 0 && v[1] == 0 && v[2] == 0) {
        char value[64];
        const rg_node *node = rg_entry_given(e, key);
        rg_entry_wrong(e, key, node->at, (rg_subject){.value = rg_node_line(node, value, sizeof value)},
                       "has no direction");
    }
}

static void check_shape(const rg_entry *e, const rg_body_input *b) {
    only_where(e, "radius", b->shape != RG_SHAPE_PLANE,
               b->shape == RG_SHAPE_PLANE ? "a plane has none" : "spheres and cylinders have one");
    check_direction(e, "normal", b->shape == RG_SHAPE_PLANE, b->normal, "it belongs to a plane");
    check_direction(e, "axis", b->shape == RG_SHAPE_CYLINDER, b->axis, "it belongs to a cylinder");
}

/* A free body has a mass; only a sphere has a volume from which to get it. */
static void check_mass(const rg_entry *e, const rg_body_input *b) {
    const rg_node *mass = rg_entry_given(e, "mass"), *density = rg_entry_given(e, "density");
    bool sphere = b->shape == RG_SHAPE_SPHERE, free = b->motion == RG_MOTION_FREE;
    if (density != NULL && (!free || !sphere)) {
        rg_entry_wrong(e, "density", density->key_at, (rg_subject){0},
                       free ? "not used: only a sphere has a volume; give its mass"
                            : "not used: the motion is prescribed");
    }
    if (mass != NULL && (!free || (density != NULL && sphere))) {
        rg_entry_wrong(e, "mass", mass->key_at, (rg_subject){0},
                       free ? "given together with density" : "not used: the motion is prescribed");
    }
    if (free && mass == NULL && density == NULL) {
        rg_entry_wrong(e, "mass", e->item->at, (rg_subject){0},
                       sphere ? "missing: a free body has a mass, or a sphere a density"
                              : "missing: a free body has a mass");
    }
}

static void check_velocity(const rg_entry *e, const rg_body_input *b) {
    const rg_node *velocity = rg_entry_given(e, "velocity");
    for (int c = 0; c < 3 && b->motion == RG_MOTION_FREE; c++) {
        if (b->velocity[c] != NULL && rg_expr_uses_time(b->velocity[c])) {
            char key[] = {'v', 'e', 'l', 'o', 'c', 'i', 't', 'y', '.', "xyz"[c], '\0'};
            rg_entry_wrong(e, key, velocity->at, (rg_subject){.value = rg_expr_text(b->velocity[c])},
                           "depends on t, but a free body has it at the start alone");
        }
    }
}

void rg_body_rule(rg_check *ck, const rg_node *list, int i, const char *path, bool good) {
    const rg_body_input *b = &ck->c->body[i];
    rg_entry e = {ck, &list->child[i], path};
    if (b->name != NULL) {
        rg_name_rule(ck, e.item, path, b->name);
    }
    if (good) {
        check_shape(&e, b);
        check_mass(&e, b);
        check_velocity(&e, b);
    }
}
