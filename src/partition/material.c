#include "partition/material.h"

#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "base/principal.h"
#include "base/stiffness.h"
#include "base/vector.h"
#include "case/user.h"

static void set_young(rg_material *m, double young, double nu) {
    m->lambda = young * nu / ((1 + nu) * (1 - 2 * nu));
    m->mu = young / (2 * (1 + nu));
}

static void set_ceramic(rg_material *m, const rg_material_input *in) {
    rg_deshpande_evans *p = &m->of.deshpande_evans.parameters;
    *p = in->deshpande_evans;
    p->poisson = in->poisson;
    p->density = in->density;
    p->yield_stress = in->parameter[RG_PARAMETER_YIELD_STRESS];
    p->single_pi = in->interaction == RG_INTERACTION_DERIVED;
    m->mu = p->shear;
    m->lambda = 2 * p->shear * p->poisson / (1 - 2 * p->poisson);
}

/* ---- An anisotropic solid ---- */

static bool any_of(const double *x, int count) {
    for (int i = 0; i < count; i++) {
        if (x[i] != 0) {
            return true;
        }
    }
    return false;
}

static void unit(double v[3]) {
    double length = sqrt(rg_vector_dot(v, v));
    for (int k = 0; k < 3; k++) {
        v[k] /= length;
    }
}

/* Its axes; false: those of the mesh. */
static bool find_axes(const rg_anisotropic_input *in, double axis[3][3]) {
    if (any_of(in->axis[0], 3)) {
        memcpy(axis[0], in->axis[0], sizeof axis[0]);
        unit(axis[0]);
        rg_vector_cross(axis[0], in->axis[1], axis[2]);
        unit(axis[2]);
        rg_vector_cross(axis[2], axis[0], axis[1]);
        return true;
    }
    rg_stiffness_axes(in->angles, axis);
    return any_of(in->angles, 3);
}

/* Of crystals that differ by their orientation alone the range is sought but once. */
static bool same_constants(const rg_anisotropic_input *a, const rg_anisotropic_input *b) {
    return memcmp(a->stiffness, b->stiffness, sizeof a->stiffness) == 0 &&
           memcmp(a->young, b->young, sizeof a->young) == 0 &&
           memcmp(a->poisson, b->poisson, sizeof a->poisson) == 0 &&
           memcmp(a->shear, b->shear, sizeof a->shear) == 0;
}

/* `like`: one made before of the same constants, or NULL. */
static void set_anisotropic(rg_material *m, const rg_anisotropic_input *in, const rg_material *like) {
    rg_anisotropic *a = &m->of.anisotropic;
    double bulk, axis[3][3];
    if (any_of(in->stiffness, RG_STIFFNESS)) {
        memcpy(a->stiffness, in->stiffness, sizeof a->stiffness);
    } else {
        rg_stiffness_orthotropic(in->young, in->poisson, in->shear, a->stiffness, &bulk);
    }
    if (like != NULL) {
        a->stiffest = like->of.anisotropic.stiffest;
        a->softest = like->of.anisotropic.softest;
    } else {
        rg_stiffness_range range = rg_stiffness_over_directions(a->stiffness);
        a->stiffest = range.stiffest;
        a->softest = range.softest;
    }
    rg_stiffness_mean(a->stiffness, &bulk, &m->mu);
    m->lambda = bulk - 2 * m->mu / 3;
    if (find_axes(in, axis)) {
        rg_stiffness_turn(a->stiffness, (const double(*)[3])axis);
    }
}

/* ---- Any ---- */

static rg_material make(const rg_material_input *in, const rg_material *like) {
    rg_material m = {.model = in->model, .density = in->density};
    if (m.model == RG_MATERIAL_USER) {
        m = rg_user_material_of(in);
    } else if (m.model == RG_MATERIAL_ANISOTROPIC) {
        set_anisotropic(&m, &in->anisotropic, like);
    } else if (m.model == RG_MATERIAL_MOONEY_RIVLIN) {
        memcpy(m.of.parameter, in->parameter, sizeof m.of.parameter);
        m.mu = 2 * (in->parameter[RG_PARAMETER_C10] + in->parameter[RG_PARAMETER_C01]);
        m.lambda = in->parameter[RG_PARAMETER_BULK] - 2 * m.mu / 3;
    } else if (m.model == RG_MATERIAL_OGDEN) {
        memcpy(m.of.parameter, in->parameter, sizeof m.of.parameter);
        for (int p = 0; p < RG_OGDEN_TERMS; p++) {
            m.mu += 0.5 * in->parameter[RG_PARAMETER_MU_1 + p] * in->parameter[RG_PARAMETER_ALPHA_1 + p];
        }
        m.lambda = in->parameter[RG_PARAMETER_BULK] - 2 * m.mu / 3;
    } else if ((rg_material_inside(m.model) & RG_TAKES_YOUNG) != 0) {
        set_young(&m, in->young, in->poisson);
        memcpy(m.of.parameter, in->parameter, sizeof m.of.parameter);
    } else {
        set_ceramic(&m, in);
    }
    rg_material_prepare(&m, 1); /* no step has been taken; at rest its size does not matter */
    return m;
}

rg_material rg_material_make(const rg_material_input *in) {
    return make(in, NULL);
}

rg_material *rg_materials_of_case(const rg_case *c) {
    rg_material *all = RG_NEW(rg_material, (size_t)c->others + 1);
    for (int i = 0; i <= c->others; i++) {
        const rg_material_input *in = rg_case_material(c, i), *last = rg_case_material(c, i > 0 ? i - 1 : 0);
        bool like = i > 0 && last->model == RG_MATERIAL_ANISOTROPIC && in->model == last->model &&
                    same_constants(&in->anisotropic, &last->anisotropic);
        all[i] = make(in, like ? &all[i - 1] : NULL);
    }
    return all;
}

/* ---- What follows from it ---- */

double rg_material_modulus(const rg_material *m) {
    return m->model == RG_MATERIAL_ANISOTROPIC ? m->of.anisotropic.stiffest : m->lambda + 2 * m->mu;
}

/* Of the acoustic tensor A of an anisotropic solid, with a = n.A.n, b its part along n and across, B that
 * across n: a + |b| along n and |b| plus the larger eigenvalue of B across are no less, since
 * 2 x b.y <= |b| (x^2 + y.y). */
void rg_material_face(const rg_material *m, const double n[3], double *lambda, double *mu) {
    if (m->model != RG_MATERIAL_ANISOTROPIC) {
        *lambda = m->lambda;
        *mu = m->mu;
        return;
    }
    static const int first[6] = {0, 1, 2, 1, 0, 0}, second[6] = {0, 1, 2, 2, 2, 1};
    double A[6], across[6], eigen[3], axis[3][3], along, b[3];
    rg_stiffness_acoustic(m->of.anisotropic.stiffness, n, A);
    double An[3] = {A[0] * n[0] + A[5] * n[1] + A[4] * n[2], A[5] * n[0] + A[1] * n[1] + A[3] * n[2],
                    A[4] * n[0] + A[3] * n[1] + A[2] * n[2]};
    along = rg_vector_dot(An, n);
    for (int k = 0; k < 3; k++) {
        b[k] = An[k] - along * n[k];
    }
    for (int k = 0; k < 6; k++) { /* (1 - nn) A (1 - nn), of eigenvalue 0 along n */
        int i = first[k], j = second[k];
        across[k] = A[k] - An[i] * n[j] - n[i] * An[j] + along * n[i] * n[j];
    }
    rg_principal_axes(across, eigen, axis); /* right to rounding where two are alike */
    double coupled = sqrt(rg_vector_dot(b, b));
    *mu = eigen[2] + coupled;
    *lambda = along + coupled - 2 * *mu;
}

void rg_material_impedance(const rg_material *m, const double n[3], double z[6]) {
    static const int first[6] = {0, 1, 2, 1, 0, 0}, second[6] = {0, 1, 2, 2, 2, 1};
    double A[6], value[3], axis[3][3];
    if (m->model != RG_MATERIAL_ANISOTROPIC) {
        double along = rg_material_dilatational(m), across = rg_material_shear(m);
        for (int k = 0; k < 6; k++) {
            z[k] = (along - across) * n[first[k]] * n[second[k]] + (k < 3 ? across : 0);
        }
        return;
    }
    rg_stiffness_acoustic(m->of.anisotropic.stiffness, n, A);
    rg_principal_axes(A, value, axis);
    for (int k = 0; k < 6; k++) {
        z[k] = 0;
        for (int w = 0; w < 3; w++) {
            z[k] += sqrt(value[w] / m->density) * axis[w][first[k]] * axis[w][second[k]];
        }
    }
}

double rg_material_dilatational(const rg_material *m) {
    return sqrt(rg_material_modulus(m) / m->density);
}

double rg_material_shear(const rg_material *m) {
    return sqrt(m->mu / m->density);
}

double rg_material_slowest(const rg_material *m) {
    return m->model == RG_MATERIAL_ANISOTROPIC
               ? sqrt(rg_stiffness_over_directions(m->of.anisotropic.stiffness).slowest / m->density)
               : rg_material_shear(m);
}

bool rg_material_plastic_wave(const rg_material *m, double *limit, double *speed) {
    if (m->model != RG_MATERIAL_J2) {
        return false;
    }
    const double *given = m->of.parameter, first = given[RG_PARAMETER_YIELD_STRESS];
    double gain = fmax(given[RG_PARAMETER_SATURATION_STRESS] - first, 0);
    double slope = given[RG_PARAMETER_HARDENING] + gain * given[RG_PARAMETER_SATURATION_RATE];
    double tangent = m->mu * slope / (3 * m->mu + slope), bulk = m->lambda + 2 * m->mu / 3;
    *limit = first * (m->lambda + 2 * m->mu) / (2 * m->mu);
    *speed = sqrt((bulk + 4 * tangent / 3) / m->density);
    return true;
}
