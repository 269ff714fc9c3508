/* Rules of the case file that the materials make. */
#include <math.h>
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

#define PARAMETER_KEY(NAME, key, ...) key,
static const char *const parameter_key[] = {RG_MATERIAL_PARAMETERS(PARAMETER_KEY)};

/* Parameters of which neither has a use without the other; 0 counts as not given. */
static const int pairs[][2] = {
    {RG_PARAMETER_SOFTENING_POWER, RG_PARAMETER_MELTING_TEMPERATURE},
    {RG_PARAMETER_HEAT_FRACTION, RG_PARAMETER_HEAT_CAPACITY},
    {RG_PARAMETER_CAP_PRESSURE, RG_PARAMETER_CAP_RATIO},
    {RG_PARAMETER_CAP_PRESSURE, RG_PARAMETER_COMPACTION},
    {RG_PARAMETER_CAP_PRESSURE, RG_PARAMETER_COMPACTION_PRESSURE},
};
/* The first one is below the second one. */
static const int orders[][2] = {
    {RG_PARAMETER_ROOM_TEMPERATURE, RG_PARAMETER_MELTING_TEMPERATURE},
    {RG_PARAMETER_HUGONIOT_PRESSURE, RG_PARAMETER_HUGONIOT_LIMIT},
    {RG_PARAMETER_CRUSH_PRESSURE, RG_PARAMETER_LOCK_PRESSURE},
};
/* At most so much. */
static const struct {
    int parameter;
    double most;
} limits[] = {
    {RG_PARAMETER_HEAT_FRACTION, 1},
    {RG_PARAMETER_BULKING, 1},
    {RG_PARAMETER_FRICTION_ANGLE, 89},
    {RG_PARAMETER_COMPACTION, 0.99},
};

/* A share that relaxes needs a time, and all of them leave something. */
static void check_relaxation(rg_check *ck, int first_share) {
    const rg_material_check *m = &ck->material;
    const rg_node *last = NULL;
    int at = first_share;
    double sum = 0;
    for (int i = 0; i < RG_VE_ELEMENTS; i++) {
        int share = first_share + i, time = RG_PARAMETER_RELAXATION_TIME_1 + i;
        if (m->given[share] == NULL) {
            continue;
        }
        sum += m->of->parameter[share];
        last = m->given[share];
        at = share;
        if (m->of->parameter[share] > 0 && m->of->parameter[time] == 0 && !m->bad[time]) {
            wrong(ck, last->key_at, parameter_key[share], NULL, "not used without %s%s", m->path,
                  parameter_key[time]);
        }
    }
    if (sum >= 1) {
        wrong(ck, last->at, parameter_key[at], last->text, "the shares that relax come to %g: not below 1",
              sum);
    }
}

static void check_pair(rg_check *ck, const int pair[2]) {
    const rg_material_check *m = &ck->material;
    for (int k = 0; k < 2; k++) {
        int here = pair[k], other = pair[1 - k];
        if (m->given[here] != NULL && m->of->parameter[here] > 0 && m->of->parameter[other] == 0 &&
            !m->bad[other]) {
            wrong(ck, m->given[here]->key_at, parameter_key[here], NULL, "not used without %s%s", m->path,
                  parameter_key[other]);
        }
    }
}

static void check_order(rg_check *ck, const int order[2]) {
    const rg_material_check *m = &ck->material;
    const rg_node *high = m->given[order[1]];
    double low = m->of->parameter[order[0]];
    if (high != NULL && !m->bad[order[0]] && m->of->parameter[order[1]] <= low) {
        wrong(ck, high->at, parameter_key[order[1]], high->text, "not above %s%s, %g", m->path,
              parameter_key[order[0]], low);
    }
}

/* Flow spends no less than it takes, and the cap begins under pressure: pb > R k. */
static void check_cone(rg_check *ck) {
    const rg_material_check *m = &ck->material;
    const double *given = m->of->parameter;
    const rg_node *dilation = m->given[RG_PARAMETER_DILATION_ANGLE],
                  *cap = m->given[RG_PARAMETER_CAP_PRESSURE];
    double least = given[RG_PARAMETER_CAP_RATIO] * rg_dp_strength(given);
    if (m->bad[RG_PARAMETER_FRICTION_ANGLE]) {
        return;
    }
    if (dilation != NULL && given[RG_PARAMETER_DILATION_ANGLE] > given[RG_PARAMETER_FRICTION_ANGLE]) {
        wrong(ck, dilation->at, parameter_key[RG_PARAMETER_DILATION_ANGLE], dilation->text,
              "above %sfriction_angle, %g", m->path, given[RG_PARAMETER_FRICTION_ANGLE]);
    }
    if (cap != NULL && given[RG_PARAMETER_CAP_PRESSURE] > 0 && given[RG_PARAMETER_CAP_PRESSURE] <= least) {
        wrong(ck, cap->at, parameter_key[RG_PARAMETER_CAP_PRESSURE], cap->text,
              "the cap would begin under tension: not above cap_ratio times the strength without pressure, "
              "%g Pa",
              least);
    }
}

/* Pores close under more than crush_pressure, against less than the elastic solid bears, and leave one that
 * is no softer: then no step of theirs gives energy back. */
static void check_pores(rg_check *ck) {
    const rg_material_check *m = &ck->material;
    const double *given = m->of->parameter;
    static const int needed[] = {RG_PARAMETER_CRUSH_PRESSURE, RG_PARAMETER_LOCK_PRESSURE,
                                 RG_PARAMETER_LOCK_STRAIN, RG_PARAMETER_BULK_1};
    double bulk = m->of->young / (3 - 6 * m->of->poisson);
    bool good = m->of->model == RG_MATERIAL_HOLMQUIST_JOHNSON_COOK && bulk > 0;
    for (size_t k = 0; k < sizeof needed / sizeof *needed; k++) {
        good = good && m->given[needed[k]] != NULL && !m->bad[needed[k]];
    }
    if (!good || given[RG_PARAMETER_LOCK_PRESSURE] <= given[RG_PARAMETER_CRUSH_PRESSURE]) {
        return;
    }
    const rg_node *stiff = m->given[RG_PARAMETER_BULK_1], *lock = m->given[RG_PARAMETER_LOCK_PRESSURE],
                  *strain = m->given[RG_PARAMETER_LOCK_STRAIN];
    rg_hjc_pores pores = rg_hjc_pores_of(given, bulk);
    if (given[RG_PARAMETER_BULK_1] < bulk) {
        wrong(ck, stiff->at, parameter_key[RG_PARAMETER_BULK_1], stiff->text,
              "below the bulk modulus of the elastic solid, %.6g Pa", bulk);
    } else if (isnan(pores.range)) {
        wrong(ck, lock->at, parameter_key[RG_PARAMETER_LOCK_PRESSURE], lock->text,
              "bulk_1, bulk_2 and bulk_3 do not come to it before the dense solid is pressed to half");
    } else if (pores.range <= 0 || pores.rise > bulk) {
        wrong(ck, strain->at, parameter_key[RG_PARAMETER_LOCK_STRAIN], strain->text,
              "too small: the way from crush_pressure to lock_pressure would be stiffer than the elastic "
              "solid");
    }
}

/* Each term of Ogden's solid stiffens it; there is one. */
static void check_ogden(rg_check *ck) {
    const rg_material_check *m = &ck->material;
    bool some = false, good = true;
    if (m->of->model != RG_MATERIAL_OGDEN) {
        return;
    }
    for (int p = 0; p < RG_OGDEN_TERMS; p++) {
        int mu = RG_PARAMETER_MU_1 + p, alpha = RG_PARAMETER_ALPHA_1 + p;
        double product = m->of->parameter[mu] * m->of->parameter[alpha];
        const rg_node *given = m->given[mu] != NULL ? m->given[mu] : m->given[alpha];
        good = good && !m->bad[mu] && !m->bad[alpha];
        some = some || product > 0;
        if (given != NULL && good && product <= 0) {
            wrong(ck, given->key_at, parameter_key[mu], NULL, "not a number of the sign of %s%s, neither 0",
                  m->path, parameter_key[alpha]);
            good = false;
        }
    }
    if (!some && good && m->block != NULL) {
        wrong(ck, m->block->at, "mu_1", NULL, "missing, and %smu_2 and %smu_3 too", m->path, m->path);
    }
}

void rg_parameters_rule(rg_check *ck) {
    const rg_material_check *m = &ck->material;
    for (size_t k = 0; k < sizeof pairs / sizeof *pairs; k++) {
        check_pair(ck, pairs[k]);
    }
    for (size_t k = 0; k < sizeof orders / sizeof *orders; k++) {
        check_order(ck, orders[k]);
    }
    check_relaxation(ck, RG_PARAMETER_SHEAR_FRACTION_1);
    check_relaxation(ck, RG_PARAMETER_BULK_FRACTION_1);
    for (size_t k = 0; k < sizeof limits / sizeof *limits; k++) {
        int at = limits[k].parameter;
        if (m->given[at] != NULL && m->of->parameter[at] > limits[k].most) {
            wrong(ck, m->given[at]->at, parameter_key[at], m->given[at]->text, "more than %g",
                  limits[k].most);
        }
    }
    check_cone(ck);
    check_ogden(ck);
    check_pores(ck);
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
                           1U << i == RG_FIELD_CONTACT ? "not written, because contact.model is interfaces"
                           : ck->c->others > 0         ? "no material has such a field"
                                                       : "material.model has no such field");
        }
    }
}
