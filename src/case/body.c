/* Rules for the bodies of a case: which values each shape and motion needs. */
#include <string.h>

#include "base/mem.h"
#include "base/principal.h"
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
    bool round = b->shape == RG_SHAPE_SPHERE || b->shape == RG_SHAPE_CYLINDER;
    only_where(e, "radius", round,
               round                        ? "spheres and cylinders have one"
               : b->shape == RG_SHAPE_PLANE ? "a plane has none"
                                            : "it belongs to spheres and cylinders");
    const rg_node *faces = rg_entry_given(e, "faces");
    if (b->shape == RG_SHAPE_NONE && faces != NULL) {
        rg_entry_wrong(e, "faces", faces->key_at, (rg_subject){0}, "not used: it touches nothing");
    }
    if (b->shape == RG_SHAPE_NONE && !rg_body_is_tied(b)) {
        rg_entry_wrong(e, "tied", e->item->at, (rg_subject){0},
                       "missing: a body that touches nothing has no other use");
    }
    const char *const times[] = {"tied_from", "tied_until"};
    for (int i = 0; i < 2; i++) {
        const rg_node *node = rg_entry_given(e, times[i]);
        if (node != NULL && !rg_body_is_tied(b)) {
            rg_entry_wrong(e, times[i], node->key_at, (rg_subject){0}, "not used: nothing is tied to it");
        }
    }
    if (b->tied_until > 0 && b->tied_until <= b->tied_from) {
        rg_entry_wrong(e, "tied_until", rg_entry_given(e, "tied_until")->at, (rg_subject){0},
                       "not after `tied_from`");
    }
    check_direction(e, "normal", b->shape == RG_SHAPE_PLANE, b->normal, "it belongs to a plane");
    check_direction(e, "axis", b->shape == RG_SHAPE_CYLINDER, b->axis, "it belongs to a cylinder");
}

/* A free body has a mass; only a sphere or a cylinder of a length has a volume from which to get it. */
static void check_mass(const rg_entry *e, const rg_body_input *b) {
    const rg_node *mass = rg_entry_given(e, "mass"), *density = rg_entry_given(e, "density"),
                  *length = rg_entry_given(e, "length");
    bool sphere = b->shape == RG_SHAPE_SPHERE, cylinder = b->shape == RG_SHAPE_CYLINDER,
         free = b->motion == RG_MOTION_FREE, volume = sphere || (cylinder && length != NULL);
    if (density != NULL && (!free || !volume)) {
        rg_entry_wrong(e, "density", density->key_at, (rg_subject){0},
                       !free ? "not used: the motion is prescribed"
                       : cylinder
                           ? "not used: only a cylinder of a length has a volume; give that, or its mass"
                           : "not used: only a sphere or a cylinder has a volume; give its mass");
    }
    if (length != NULL && (!cylinder || density == NULL)) {
        rg_entry_wrong(e, "length", length->key_at, (rg_subject){0},
                       "not used: it belongs to a cylinder with a density");
    }
    if (mass != NULL && (!free || (density != NULL && volume))) {
        rg_entry_wrong(e, "mass", mass->key_at, (rg_subject){0},
                       free ? "given together with density" : "not used: the motion is prescribed");
    }
    if (free && mass == NULL && density == NULL) {
        rg_entry_wrong(e, "mass", e->item->at, (rg_subject){0},
                       sphere || cylinder
                           ? "missing: a free body has a mass, or a sphere or cylinder a density"
                           : "missing: a free body has a mass");
    }
}

/* That of a heap of masses: all positive, and none larger than the two others together. */
static void check_inertia(const rg_entry *e, const rg_body_input *b) {
    const rg_node *inertia = rg_entry_given(e, "inertia");
    if (inertia == NULL) {
        return;
    }
    const char *wrong = b->motion == RG_MOTION_PRESCRIBED ? "not used: the motion is prescribed"
                        : b->density > 0                  ? "given together with density"
                                                          : NULL;
    if (wrong != NULL) {
        rg_entry_wrong(e, "inertia", inertia->key_at, (rg_subject){0}, wrong);
        return;
    }
    double value[3], axis[3][3];
    rg_principal_axes(b->inertia, value, axis);
    if (!(value[0] > 0) || value[2] > (value[0] + value[1]) * (1 + 1e-9)) {
        char text[128];
        rg_entry_wrong(
            e, "inertia", inertia->at,
            (rg_subject){.value = rg_node_line(inertia, text, sizeof text),
                         .allowed = "principal moments > 0, none larger than the sum of the others"},
            "no body has such an inertia");
    }
}

static void check_start(const rg_entry *e, const rg_body_input *b, const char *key, rg_expr *const value[3]) {
    const rg_node *node = rg_entry_given(e, key);
    for (int c = 0; c < 3 && b->motion == RG_MOTION_FREE; c++) {
        if (value[c] != NULL && rg_expr_uses_time(value[c])) {
            char *path = rg_text_format("%s.%c", key, "xyz"[c]);
            rg_entry_wrong(e, path, node->at, (rg_subject){.value = rg_expr_text(value[c])},
                           "depends on t, but a free body has it at the start alone");
            rg_free(path);
        }
    }
}

/* What makes a free body turn asks for an inertia. */
static void check_turn(const rg_entry *e, const rg_body_input *b) {
    if (b->motion == RG_MOTION_PRESCRIBED || rg_body_has_inertia(b)) {
        return;
    }
    const char *const keys[] = {"spin", "tied", "tied_where"};
    for (int i = 0; i < 3; i++) {
        const rg_node *node = rg_entry_given(e, keys[i]);
        if (node != NULL) {
            rg_entry_wrong(e, keys[i], node->key_at, (rg_subject){0},
                           "makes a free body turn, which needs its inertia, or a density");
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
        check_inertia(&e, b);
        check_start(&e, b, "velocity", b->velocity);
        check_start(&e, b, "spin", b->spin);
        check_turn(&e, b);
    }
}
