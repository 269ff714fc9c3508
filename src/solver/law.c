#include "solver/law.h"

#include <math.h>
#include <string.h>

#include "cohesive/facts.h"
#include "solver/tile.h"

static rg_law_facts facts_of(const rg_cohesive *law) {
    return rg_law_facts_of(law->law, law->shape, law->beta);
}

void rg_law_stiffness(const rg_cohesive *law, double slope[2]) {
    rg_law_facts facts = facts_of(law);
    for (int k = 0; k < 2; k++) {
        slope[k] = facts.slope[k] * law->strength / law->opening;
    }
}

/* Whether some face may rub. */
static bool has_friction(const rg_case *c) {
    bool rubs = c->interface.friction > 0;
    for (int i = 0; i < c->interface.sets; i++) {
        const rg_face_set *set = &c->interface.set[i];
        rubs =
            rubs || set->friction > 0 || (set->friction_at != NULL && !rg_expr_is_number(set->friction_at));
    }
    return rubs;
}

double rg_law_number(double number, const rg_expr *at) {
    return at == NULL || rg_expr_is_number(at) ? number : 1;
}

/* The critical opening of a law without work of separation means nothing: any does. */
rg_cohesive rg_law_make(const rg_case *c) {
    if (c->interface.law == RG_LAW_NONE) {
        return (rg_cohesive){.strength = INFINITY,
                             .opening = 1,
                             .separation = 1,
                             .beta = c->interface.beta,
                             .form = c->interface.form};
    }
    rg_cohesive law = {.law = c->interface.law,
                       .strength = rg_law_number(c->interface.strength, c->interface.strength_at),
                       .beta = c->interface.beta,
                       .form = c->interface.form,
                       .criterion = c->interface.criterion,
                       .activation = c->interface.activation,
                       .onset = c->interface.onset * fmax(1, c->interface.beta * c->interface.beta),
                       .beta_s = c->interface.beta_s,
                       .contact = c->interface.contact,
                       .shear = c->interface.shear,
                       .sliding = has_friction(c) ? RG_SLIDING_COULOMB : RG_SLIDING_FREE,
                       .friction = c->interface.friction,
                       .rise = c->interface.rise};
    law.user = c->interface.user.is;
    memcpy(law.shape, c->interface.shape[law.law], sizeof law.shape);
    rg_law_facts facts = facts_of(&law);
    if ((facts.forms & RG_NORMAL_MEASURE) != 0) {
        law.beta = 0;
    }
    double energy = rg_law_number(c->interface.energy, c->interface.energy_at);
    law.opening = facts.work > 0 ? energy / (facts.work * law.strength) : 1;
    law.separation = facts.separation * law.opening;
    if (law.form == RG_FORM_INTRINSIC) {
        double slope[2];
        rg_law_stiffness(&law, slope);
        law.slope = slope[0];
    }
    return law;
}

double rg_law_steps(const rg_cohesive *law) {
    return (facts_of(law).forms & RG_LIMITS_STEP) != 0 ? law->shape[RG_LIMITER_STEPS] : 0;
}

/* Of pure opening; the files of the laws say where that is (kernels/cohesive/). */
double rg_law_top(const rg_cohesive *law) {
    double top = INFINITY; /* over the critical opening */
    switch (law->law) {
    case RG_LAW_BILINEAR:
        top = law->shape[0];
        break;
    case RG_LAW_TVERGAARD:
    case RG_LAW_POLYNOMIAL:
        top = 1. / 3;
        break;
    case RG_LAW_NEEDLEMAN:
        top = 9 / (16 * exp(1));
        break;
    case RG_LAW_EXPONENTIAL:
    case RG_LAW_XU_NEEDLEMAN:
        top = 1;
        break;
    default: /* none that starts with a slope and has one */
        break;
    }
    return top / facts_of(law).separation;
}

size_t rg_crack_stride(const rg_cohesive *law) {
    size_t friction = law->sliding == RG_SLIDING_COULOMB ? RG_FRICTION_BLOCK : 0;
    size_t bond = law->shear == RG_SHEAR_FADING ? RG_BOND_BLOCK : 0;
    size_t loan = law->criterion == RG_CRITERION_MOHR_COULOMB ? RG_LOAN_BLOCK : 0;
    size_t rise = law->rise.rate > 0 ? RG_RISE_BLOCK : 0;
    return RG_CRACK_BLOCK + (size_t)facts_of(law).memory * RG_POINTS * RG_LANES + bond + rise + loan +
           friction;
}

/* Breaks a face whose elements are of tile t and opens it beyond full separation. */
static void open_face(rg_solver *s, const rg_tile *t, size_t i) {
    const rg_domain *d = s->domain;
    s->broken[i] = s->unlinked[i] = (1 << RG_POINTS) - 1;
    s->active[i / RG_LANES] = 1;
    for (int q = 0; q < RG_POINTS; q++) {
        *rg_crack_value(s, i, q, RG_CRACK_OPENING) = (rg_real)(2 * s->model->law.separation);
    }
    for (int k = 0; k < (i < t->sbegin * RG_LANES ? 2 : 1); k++) {
        s->cracked[t->begin + (size_t)d->side[k][i] / (RG_FACES * RG_LANES)] = 1;
    }
}

static void open_faces(rg_solver *s) {
    const rg_domain *d = s->domain;
    for (size_t t = 0; t < d->tiles && s->model->scale != NULL; t++) {
        for (size_t i = d->tile[t].ibegin * RG_LANES; i < d->tile[t].iend * RG_LANES; i++) {
            if (rg_face_is_open(s, i)) {
                open_face(s, &d->tile[t], i);
            }
        }
    }
}

void rg_law_open_until(rg_solver *s, double time) {
    for (size_t k = 0; k < s->model->openings; k++) {
        const rg_opening *o = &s->model->opening[k];
        if (o->at > time) {
            continue;
        }
        s->model->scale[o->face / RG_LANES * 2 * RG_LANES + o->face % RG_LANES] = 0;
        if (s->broken[o->face] == 0) { /* else a checkpoint has it so */
            open_face(s, &s->domain->tile[o->tile], o->face);
            for (int q = 0; q < RG_POINTS; q++) {
                *rg_crack_value(s, o->face, q, RG_CRACK_TIME) = (rg_real)s->time;
            }
        }
    }
}

void rg_law_start(rg_solver *s) {
    open_faces(s);
    if (s->model->law.form != RG_FORM_INTRINSIC) {
        return;
    }
    const rg_domain *d = s->domain;
    memset(s->broken, (1 << RG_POINTS) - 1, d->iblocks * RG_LANES);
    memset(s->unlinked, (1 << RG_POINTS) - 1, d->iblocks * RG_LANES);
    memset(s->active, 1, d->iblocks);
    memset(s->cracked, 1, d->blocks);
}
