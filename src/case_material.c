/* Rules of the case file that the material makes. */
#include "case_check.h"
#include "material.h"

void rg_model_rule(rg_check *ck, const rg_node *node) {
    if (!rg_material_exists(ck->c->material.model)) {
        rg_subject subject = {.key = "material.model", .value = node->text};
        rg_problem_add(ck->problems, node->at, &subject,
                       "needs double precision, and this program is built with -Dprecision=single");
    }
}

/* 0 counts as not given. */
void rg_saturation_rule(rg_check *ck, const rg_node *node) {
    static const char *const key[2] = {"material.saturation_stress", "material.saturation_rate"};
    const double *given = ck->c->material.parameter, yield = given[RG_PARAMETER_YIELD_STRESS];
    double stress = given[RG_PARAMETER_SATURATION_STRESS], rate = given[RG_PARAMETER_SATURATION_RATE];
    if (!ck->saturates) {
        return;
    }
    if (stress > 0 && stress < yield) {
        rg_subject subject = {.key = key[0], .value = ck->saturation->text};
        rg_problem_add(ck->problems, ck->saturation->at, &subject, "below material.yield_stress, %g Pa",
                       yield);
    }
    if ((stress > 0) != (rate > 0)) {
        int alone = rate > 0;
        rg_subject subject = {.key = key[alone]};
        rg_problem_add(ck->problems, (alone ? node : ck->saturation)->key_at, &subject, "not used without %s",
                       key[1 - alone]);
    }
}

void rg_flaw_rule(rg_check *ck) {
    const rg_deshpande_evans *p = &ck->c->material.deshpande_evans;
    double damage = ck->density == NULL ? 0 : rg_de_initial_damage(p);
    if (damage >= p->damage_max) {
        rg_subject subject = {.key = "material.flaw_density", .value = ck->density->text};
        rg_problem_add(ck->problems, ck->density->at, &subject,
                       "the damage to begin with, 4/3 pi (alpha flaw_radius)^3 flaw_density, is %.4g: not "
                       "below damage_max, %g",
                       damage, p->damage_max);
    }
}

void rg_fields_rule(rg_check *ck, const rg_key *key, const rg_node *node) {
    unsigned *fields = &ck->c->output.fields, possible = rg_material_possible_fields(ck->c->material.model);
    if (node == NULL) {
        *fields = rg_material_default_fields(ck->c->material.model);
    }
    for (int i = 0; key->choice[i] != NULL; i++) {
        if ((*fields & ~possible) >> i & 1U) {
            rg_subject subject = {.key = "output.fields", .value = key->choice[i]};
            rg_problem_add(ck->problems, node->at, &subject, "material.model has no such field");
        }
    }
}
