/* Damping of a pair of faces that press, after Hunt & Crossley (1975): the force of its potential, -grad E,
 * by the factor 1 + q, with
 *
 *     q = (B/N) d', kept between -1 and 1,   B = min(c N, z area(P)),   N = dE/dd,   d' = (grad E . v)/N,
 *
 * d' the rate of depth, as the work of all corners has it, c in s/m, z an impedance. So the force never
 * pulls, is at most doubled, has both momenta, and takes grad E . v q = N d' q >= 0; nothing where the pair
 * moves as one. */
#ifndef RG_CONTACT_DAMPING_H
#define RG_CONTACT_DAMPING_H

#include "contact/pair.h"

RG_INLINE wide power_of(const rg_contact_args *args, const size_t pair[], int count, wide force[2][3][3]) {
    wide power = wide_splat(0);
    for (int k = 0; k < 2; k++) {
        for (int i = 0; i < 9; i++) {
            wide v = power;
            for (int l = 0; l < WIDE; l++) {
                size_t face = (size_t)args->pair[pair[l < count ? l : count - 1]].face[k];
                v[l] = args->rate[9 * face + (size_t)(3 * corner_of[k][i / 3] + i % 3)];
            }
            power += force[k][i / 3][i % 3] * v;
        }
    }
    return power;
}

/* Adds damping to the forces of the potential, of those that press. */
RG_INLINE void add_damping(const rg_contact_args *args, const size_t pair[], int count, const meeting *m,
                           const integral *sum, const handover *h, wide_mask presses, wide force[2][3][3]) {
    const wide zero = wide_splat(0), one = wide_splat(1);
    wide slope, weight = weight_of(m->facing, &slope) * h->share;
    wide normal = 0.5 * m->stiffness * weight * sum->slope[0], most = m->impedance * weight * sum->area;
    wide_mask pushes = presses & (wide_mask)(normal > 0);
    wide coefficient = args->damping * normal;
    coefficient = wide_select((wide_mask)(coefficient < most), coefficient, most);
    wide q = -coefficient * power_of(args, pair, count, force) / (normal * normal);
    q = wide_select((wide_mask)(q < 1), q, one);
    q = wide_where(pushes, wide_select((wide_mask)(q > -1), q, -one));
    wide stiffer = m->stiffness * (1 + wide_select((wide_mask)(q > 0), q, zero)) +
                   2 * coefficient / (weight * sum->area * args->dt);
    stiffer = wide_where(pushes, stiffer);
    for (int l = 0; l < count; l++) {
        args->stiffer[pair[l]] = stiffer[l];
    }
    for (int k = 0; k < 2; k++) {
        for (int i = 0; i < 9; i++) {
            wide drag = q * force[k][i / 3][i % 3];
            force[k][i / 3][i % 3] += drag;
            for (int l = 0; l < count; l++) {
                args->drag[18 * pair[l] + (size_t)(9 * k + 3 * corner_of[k][i / 3] + i % 3)] = drag[l];
            }
        }
    }
}

#endif
