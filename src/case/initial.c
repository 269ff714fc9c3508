/* Rules for the state at the start: where its sets are, and an axis with every angular velocity. */
#include <string.h>

#include "base/mem.h"
#include "case/entry.h"
#include "stressed.h"

void rg_rotation_rule(const rg_entry *e, const char *prefix, const rg_initial *is) {
    char *name[2] = {rg_text_format("%srotation.speed", prefix), rg_text_format("%srotation.axis", prefix)};
    const rg_node *speed = rg_entry_given(e, name[0]), *axis = rg_entry_given(e, name[1]);
    if (speed != NULL && axis == NULL) {
        rg_entry_wrong(e, name[1], speed->key_at, (rg_subject){.allowed = "3 numbers"},
                       "missing: a body turns about it");
    } else if (axis != NULL && speed == NULL) {
        rg_entry_wrong(e, name[1], axis->key_at, (rg_subject){0}, "not used without rotation.speed");
    } else if (axis != NULL && is->axis[0] == 0 && is->axis[1] == 0 && is->axis[2] == 0) {
        char value[64];
        rg_entry_wrong(e, name[1], axis->at, (rg_subject){.value = rg_node_line(axis, value, sizeof value)},
                       "has no direction");
    }
    rg_free(name[0]);
    rg_free(name[1]);
}

static void check_place(const rg_entry *e) {
    static const char *const keys[] = {"set", "material", "where"};
    const rg_node *first = NULL;
    for (int i = 0; i < 3; i++) {
        const rg_node *node = rg_entry_given(e, keys[i]);
        if (node != NULL && first != NULL) {
            rg_entry_wrong(e, NULL, node->key_at,
                           (rg_subject){.allowed = "exactly one of set, material, where"},
                           "more than one given");
        }
        first = node != NULL ? node : first;
    }
    const rg_node *set = rg_entry_given(e, "set"), *material = rg_entry_given(e, "material");
    if (first == NULL) {
        rg_entry_wrong(e, NULL, e->item->at, (rg_subject){.allowed = "exactly one of set, material, where"},
                       "missing set, material or where");
    } else if (set != NULL && e->ck->usage[RG_GROUP_BOX] != RG_UNUSED) {
        rg_entry_wrong(e, "set", set->at, (rg_subject){.value = set->text},
                       "a mesh file has volume sets, the built-in box has none; say where");
    } else if (material != NULL && material->kind == RG_NODE_SCALAR &&
               rg_case_find_material(e->ck->c, material->text) < 0) {
        rg_entry_wrong(e, "material", material->at, (rg_subject){.value = material->text},
                       "no such material");
    }
}

void rg_initial_set_rule(rg_check *ck, const rg_node *list, int i, const char *path, bool good) {
    rg_entry e = {ck, &list->child[i], path};
    if (e.item->kind == RG_NODE_MAPPING && good) {
        check_place(&e);
        rg_rotation_rule(&e, "", &ck->c->initial_set[i].is);
    }
}

static bool any_open(const rg_case *c) {
    bool open = false;
    for (int i = 0; i < c->interface.sets; i++) {
        open = open || c->interface.set[i].open;
    }
    return open;
}

/* Not every solid can take a stress (stressed.h). */
void rg_stress_rule(const rg_entry *e) {
    const rg_case *c = e->ck->c;
    if (c->stress_of.run != NULL && rg_initial_has_stress(&c->initial)) {
        const rg_node *run = rg_entry_given(e, "initial.stress.run");
        rg_entry_wrong(e, "initial.stress.run", run->at, (rg_subject){.value = run->text},
                       "not beside expressions for the same stress");
        return;
    }
    for (int i = 0; i <= c->others && rg_case_has_stress(c); i++) {
        rg_material_model model = rg_case_material(c, i)->model;
        if (rg_material_axes_vary(rg_case_material(c, i))) {
            char *what =
                rg_text_format("not with %s, whose axes differ from element to element: what the stress "
                               "has stored would not be known",
                               rg_case_material_name(c, i));
            rg_entry_wrong(e, "initial.stress", e->item->at, (rg_subject){0}, what);
            rg_free(what);
            return;
        }
        bool user = model == RG_MATERIAL_USER && rg_input_history(rg_case_material(c, i)) > 0;
        if (user || ((int)RG_STRESS_NONE >> model & 1) != 0) {
            char *what = rg_text_format(
                "not with %s, which is %s: %s", rg_case_material_name(c, i), rg_material_word(model),
                user ? "how a history of the user's own would begin with it is not known"
                : model == RG_MATERIAL_DESHPANDE_EVANS
                    ? "how far its cracks have grown would depend on how the stress came there"
                    : "how far its pores have closed would depend on how the stress came there");
            rg_entry_wrong(e, "initial.stress", e->item->at, (rg_subject){0}, what);
            rg_free(what);
            return;
        }
    }
}

/* Something has to expand; and what is stored in it would be taken for that of a crack. */
void rg_temperature_rule(const rg_entry *e) {
    const rg_case *c = e->ck->c;
    bool expands = false;
    for (int i = 0; i <= c->others; i++) {
        expands = expands || rg_case_material(c, i)->parameter[RG_PARAMETER_EXPANSION] > 0;
    }
    if (c->temperature.value != NULL && !expands) {
        rg_entry_wrong(e, "temperature.value", e->item->at, (rg_subject){0},
                       "has no use: no material has an expansion");
    } else if (c->temperature.value != NULL && c->output.crack_fronts > 0) {
        rg_entry_wrong(
            e, "temperature.value", e->item->at, (rg_subject){0},
            "not with output.crack_fronts: the energy that a crack sets free is not known in a field "
            "of temperature");
    }
}

void rg_start_rule(const rg_entry *e) {
    const rg_case *c = e->ck->c;
    bool moves = false, relaxes = c->start == RG_START_RELAX;
    for (int i = 0; i < c->bodies && relaxes; i++) {
        const rg_body_input *b = &c->body[i];
        moves = moves || b->motion == RG_MOTION_FREE || (rg_body_is_tied(b) && !(b->tied_from > 0));
    }
    rg_form form = c->interface.form;
    bool sticks = any_open(c) || form == RG_FORM_INTRINSIC;
    const char *wrong = NULL;
    if (form == RG_FORM_INCOMPLETE) {
        wrong = "not with form incomplete, whose forces have no potential: its tangent is not symmetric, and "
                "its energy grows";
    } else if (form == RG_FORM_INTRINSIC && relaxes) {
        wrong = "not with form intrinsic: on the way faces could pass the top of their law; static comes to "
                "rest without";
    } else if (moves) {
        wrong =
            "not with bodies that are free or tied, which its damping does not bring to rest: static does";
    } else if (sticks && c->interface.friction > 0) {
        wrong = "needs interface.friction 0 with open faces or form intrinsic: where they stick would depend "
                "on the way";
    }
    if (wrong != NULL && c->start != RG_START_INITIAL) {
        const rg_node *node = rg_entry_given(e, "start");
        rg_entry_wrong(e, "start", node->at, (rg_subject){.value = node->text}, wrong);
    }
}
