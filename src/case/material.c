/* Rules of the case file that the materials make. */
#include <stdarg.h>
#include <string.h>

#include "base/mem.h"
#include "case/check.h"

static const char name_letters[] = "letters, digits, _ and -; unique among materials";

/* ---- the block of one material ---- */

/* A problem of the key `word` of ck->material. */
__attribute__((format(printf, 5, 6))) static void wrong(rg_check *ck, rg_place at, const char *word,
                                                        const char *value, const char *what, ...) {
    char *key = rg_text_format("%s%s", ck->material.path, word), text[256];
    va_list arguments;
    va_start(arguments, what);
    vsnprintf(text, sizeof text, what, arguments);
    va_end(arguments);
    rg_problem_add(ck->problems, at, &(rg_subject){.key = key, .value = value}, "%s", text);
    rg_free(key);
}

void rg_model_rule(rg_check *ck, const rg_node *node) {
    if (!rg_material_exists(ck->material.of->model)) {
        wrong(ck, node->at, "model", node->text,
              "needs double precision, and this program is built with -Dprecision=single");
    }
}

/* 0 counts as not given. */
void rg_saturation_rule(rg_check *ck, const rg_node *node) {
    static const char *const key[2] = {"saturation_stress", "saturation_rate"};
    const rg_material_check *m = &ck->material;
    const double *given = m->of->parameter, yield = given[RG_PARAMETER_YIELD_STRESS];
    double stress = given[RG_PARAMETER_SATURATION_STRESS], rate = given[RG_PARAMETER_SATURATION_RATE];
    if (!m->saturates) {
        return;
    }
    if (stress > 0 && stress < yield) {
        wrong(ck, m->saturation->at, key[0], m->saturation->text, "below %syield_stress, %g Pa", m->path,
              yield);
    }
    if ((stress > 0) != (rate > 0)) {
        int alone = rate > 0;
        wrong(ck, (alone ? node : m->saturation)->key_at, key[alone], NULL, "not used without %s%s", m->path,
              key[1 - alone]);
    }
}

void rg_flaw_rule(rg_check *ck) {
    const rg_material_check *m = &ck->material;
    const rg_deshpande_evans *p = &m->of->deshpande_evans;
    double damage = m->density == NULL ? 0 : rg_de_initial_damage(p);
    if (damage >= p->damage_max) {
        wrong(ck, m->density->at, "flaw_density", m->density->text,
              "the damage to begin with, 4/3 pi (alpha flaw_radius)^3 flaw_density, is %.4g: not below "
              "damage_max, %g",
              damage, p->damage_max);
    }
}

void rg_material_name_rule(rg_check *ck, const rg_node *node) {
    if (!rg_is_name(node->text)) {
        rg_subject subject = {.key = "material.name", .value = node->text, .allowed = name_letters};
        rg_problem_add(ck->problems, node->at, &subject, "not a name");
    }
}

/* ---- the list of materials: names, and where each is ---- */

static void check_name(rg_check *ck, const rg_node *item, int i) {
    const rg_node *node = rg_node_find(item, "name", strlen("name"));
    const char *name = ck->c->other[i].is.name;
    if (node == NULL || name == NULL) {
        return;
    }
    int first = rg_case_find_material(ck->c, name);
    const char *what = !rg_is_name(name) ? "not a name"
                       : first <= i      ? "the name of an earlier material"
                                         : NULL;
    if (what != NULL) {
        char *key = rg_text_format("%sname", ck->material.path);
        rg_subject subject = {.key = key, .value = name, .allowed = name_letters};
        rg_problem_add(ck->problems, node->at, &subject, "%s", what);
        rg_free(key);
    }
}

static void check_place(rg_check *ck, const rg_node *item, const char *path) {
    const rg_node *set = rg_node_find(item, "set", strlen("set"));
    const rg_node *where = rg_node_find(item, "where", strlen("where"));
    if ((set == NULL) == (where == NULL)) {
        rg_subject subject = {.key = path, .allowed = "exactly one of set, where"};
        rg_problem_add(ck->problems, set == NULL ? item->at : set->key_at, &subject,
                       set == NULL ? "missing set or where" : "set and where both given");
    } else if (set != NULL && ck->usage[RG_GROUP_BOX] != RG_UNUSED) {
        wrong(ck, set->key_at, "set", set->text,
              "a mesh file has volume sets, the built-in box has none; say where");
    }
}

void rg_material_rule(rg_check *ck, const rg_node *list, int i, const char *path) {
    const rg_node *item = &list->child[i];
    if (item->kind == RG_NODE_MAPPING) {
        check_name(ck, item, i);
        check_place(ck, item, path);
    }
    if (i + 1 == RG_MAX_MATERIALS) {
        rg_problem_add(ck->problems, item->at, &(rg_subject){.key = path}, "more than %d materials",
                       RG_MAX_MATERIALS);
    }
}

/* ---- what they put out ---- */

void rg_fields_rule(rg_check *ck, const rg_key *key, const rg_node *node) {
    unsigned *fields = &ck->c->output.fields, possible = rg_case_possible_fields(ck->c);
    if (node == NULL) {
        *fields = rg_case_default_fields(ck->c);
    }
    for (int i = 0; key->choice[i] != NULL; i++) {
        if ((*fields & ~possible) >> i & 1U) {
            rg_subject subject = {.key = "output.fields", .value = key->choice[i]};
            rg_problem_add(ck->problems, node->at, &subject,
                           ck->c->others > 0 ? "no material has such a field"
                                             : "material.model has no such field");
        }
    }
}
