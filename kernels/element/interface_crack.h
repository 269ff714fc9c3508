/* Broken points of a face: the bits that say which they are, the law's parameters there, and the state of
 * each (layout.h). Vectors of faces at once, as in element/interface_face.h. */
#ifndef RG_INTERFACE_CRACK_H
#define RG_INTERFACE_CRACK_H

#include "cohesive/cohesive.h"
#include "cohesive/facts.h"
#include "element/interface_face.h"

RG_INLINE rg_mask bit_mask(const uint8_t bits[RG_VLEN], int q) {
    rg_mask m;
    for (int l = 0; l < RG_VLEN; l++) {
        m[l] = -(rg_lane_int)((bits[l] >> q) & 1);
    }
    return m;
}

RG_INLINE void set_bits(uint8_t bits[RG_VLEN], int q, rg_mask m) {
    for (int l = 0; l < RG_VLEN; l++) {
        bits[l] = (uint8_t)((bits[l] & ~(1 << q)) | ((m[l] & 1) << q));
    }
}

/* Writes x where m is set; where nothing is set nothing is touched (untouched pages cost no memory). */
RG_INLINE void store_where(rg_real *p, rg_mask m, rg_vec x) {
    rg_store(p, rg_select(m, x, rg_load(p)));
}

RG_INLINE rg_real *crack_state(const interface *s, int q, int k) {
    return s->args->crack + s->block * s->args->crack_stride + (q * RG_CRACK + k) * RG_LANES + s->lane;
}

RG_INLINE rg_real *memory_state(const interface *s, int memory, int q, int k) {
    return s->args->crack + s->block * s->args->crack_stride + RG_CRACK_BLOCK + (q * memory + k) * RG_LANES +
           s->lane;
}

RG_INLINE rg_real *friction_state(const interface *s, int q, int k) {
    return s->args->crack + rg_friction_index(s->block * RG_LANES, q, k, s->args->crack_stride) + s->lane;
}

RG_INLINE rg_real *loan_state(const interface *s, int q) {
    return s->args->crack + rg_loan_index(s->block * RG_LANES, q, s->args->crack_stride) + s->lane;
}

/* Strength (k = 0) or critical opening (k = 1) of these faces, over that of the law. */
RG_INLINE rg_vec scale(const interface *s, int k) {
    return rg_load(s->args->scale + (s->block * 2 + (size_t)k) * RG_LANES + s->lane);
}

/* A property of these faces: of each, or, without a field of it, the same for all. */
RG_INLINE rg_vec of_face(const interface *s, const rg_real *field, double all) {
    return field == NULL ? rg_splat(all) : rg_load(field + s->block * RG_LANES + s->lane);
}

/* Parameters of the law on these faces. */
RG_INLINE void load_law(interface *s) {
    const rg_cohesive *law = &s->args->law;
    s->area = rg_sqrt(s->area_square);
    s->strength = rg_splat(law->strength);
    s->strong_area = s->area;
    s->opening = rg_splat(law->opening);
    s->inverse = rg_splat(1.0 / law->opening);
    s->contact = normal_penalty(s);
    s->beta2 = rg_splat(law->beta * law->beta);
    if (s->args->beta != NULL) {
        rg_vec beta = of_face(s, s->args->beta, 0);
        s->beta2 = beta * beta;
    }
    if (law->slope > 0 && s->args->scale == NULL) {
        s->contact = rg_max(s->contact, s->area * rg_splat(law->slope));
    }
    if (s->args->scale != NULL) {
        s->strength *= scale(s, 0);
        s->strong_area *= scale(s, 0);
        s->opening *= scale(s, 1);
        s->inverse = 1.0 / s->opening;
        s->contact = rg_max(s->contact, s->area * rg_splat(law->slope) * scale(s, 0) / scale(s, 1));
    }
}

/* Values that a point remembers of a law with RG_MIXED; 0 of others. */
RG_INLINE int mixed_memory(rg_law law) {
    static const int8_t memories[RG_LAW_USER + 1] = {
#define RG_LAW(NAME, name, word, meaning, forms, work, separation, normal_slope, shear_slope, memory)        \
    ((forms)&RG_MIXED) != 0 ? memory : 0,
#include "laws.h"
#undef RG_LAW
    };
    return memories[law];
}

/* Values that a point remembers of a law. */
RG_INLINE int law_memory(rg_law law) {
    static const int8_t memories[RG_LAW_USER + 1] = {
#define RG_LAW(NAME, name, word, meaning, forms, work, separation, normal_slope, shear_slope, memory) memory,
#include "laws.h"
#undef RG_LAW
    };
    return memories[law];
}

RG_INLINE rg_real *bond_state(const interface *s, int q, int k) {
    int before = law_memory(s->args->law.law) * RG_POINTS + q * RG_BOND + k;
    return s->args->crack + s->block * s->args->crack_stride + RG_CRACK_BLOCK + before * RG_LANES + s->lane;
}

/* Faces whose shear fades: those of beta = 0, where it is asked for. */
RG_INLINE rg_mask fading(const interface *s) {
    return s->args->law.shear == RG_SHEAR_FADING ? s->beta2 == 0.0 : (rg_mask){0};
}

/* Critical opening at a broken point (m); `mixed`: mixed_memory of the law. */
RG_INLINE rg_vec critical_opening(const interface *s, int q, int mixed) {
    return mixed == 0 ? s->opening : s->opening * (1.0 + rg_load(memory_state(s, mixed, q, 0)));
}

/* Effective opening of full separation there (m). */
RG_INLINE rg_vec separation(const interface *s, int q, int mixed) {
    return critical_opening(s, q, mixed) * rg_splat(s->args->law.separation / s->args->law.opening);
}

/* Damage of a broken point: largest opening over that of full separation, at most 1; 1 without such a one. */
RG_INLINE rg_vec point_damage(const interface *s, int q) {
    const rg_cohesive *law = &s->args->law;
    if (!(law->separation > 0)) {
        return rg_splat(1.0);
    }
    rg_vec share = rg_load(crack_state(s, q, RG_CRACK_OPENING)) / separation(s, q, mixed_memory(law->law));
    return rg_min(share, rg_splat(1.0));
}

/* Opening of a broken point: w = [u] - origin, split along n (section 6 of kernels/README.md). */
typedef struct {
    vec3 tangential;
    rg_vec normal, effective;
} point_opening;

/* w_n, w_t and delta of (3.16). */
RG_INLINE void crack_opening(const interface *s, int q, const vec3 n, point_opening *o) {
    vec3 w;
    for (int c = 0; c < 3; c++) {
        w[c] = s->jump[q][c] - rg_load(crack_state(s, q, RG_CRACK_ORIGIN + c));
    }
    o->normal = rg_dot(w, n);
    for (int c = 0; c < 3; c++) {
        o->tangential[c] = w[c] - o->normal * n[c];
    }
    rg_vec open = rg_max(o->normal, rg_splat(0.0));
    o->effective = rg_sqrt(s->beta2 * rg_dot(o->tangential, o->tangential) + open * open);
}

#endif
