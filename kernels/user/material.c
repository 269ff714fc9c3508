/* The bulk kernel around a user's material, whose file RG_USER_SOURCE names: what `rhegma material` compiles
 * into a library. The user's functions go into the loops, as those of the program's own materials do. */
#include RG_USER_SOURCE

#ifdef RG_TOGETHER
#error "a material of a library takes one point at a time: material_step, not material_steps"
#endif
#ifndef RG_HISTORY
#error "RG_HISTORY is not defined: the values of history per point, 0 if there is none"
#endif

#undef material_step
#undef material_state
#define RG_MATERIAL user

RG_INLINE void material_step(const rg_bulk_args *args, rg_vec H[3][3], rg_vec history[], rg_vec P[3][3],
                             rg_point *out) {
    *out = (rg_point){0};
    rg_user_step(args, H, history, P, out);
}

RG_INLINE void material_state(const rg_material *m, rg_vec H[3][3], rg_vec history[], bool stress,
                              rg_point_state *out) {
    *out = (rg_point_state){0};
    rg_user_state(m, H, history, stress, out);
}

#include "element/bulk.h"

RG_INLINE rg_vec lanes_of(const double *first) {
    rg_vec v;
    for (int l = 0; l < RG_VLEN; l++) {
        v[l] = (rg_real)first[(size_t)l * sizeof(rg_user_point) / sizeof(double)];
    }
    return v;
}

RG_INLINE void put_lanes(double *first, rg_vec v) {
    for (int l = 0; l < RG_VLEN; l++) {
        first[(size_t)l * sizeof(rg_user_point) / sizeof(double)] = v[l];
    }
}

static void points_of_vector(const rg_bulk_args *args, rg_user_point *p) {
    rg_vec H[3][3], P[3][3], history[HISTORY_VALUES];
    rg_point out;
    rg_point_state state;
    for (int k = 0; k < 9; k++) {
        H[k / 3][k % 3] = lanes_of(&p->H[k / 3][k % 3]);
    }
    for (int k = 0; k < RG_HISTORY; k++) {
        history[k] = lanes_of(&p->history[k]);
    }
    material_step(args, H, history, P, &out);
    for (int k = 0; k < RG_HISTORY && args->advance; k++) {
        put_lanes(&p->history[k], history[k]);
    }
    for (int k = 0; k < RG_HISTORY; k++) { /* as stored */
        history[k] = lanes_of(&p->history[k]);
    }
    material_state(&args->material, H, history, true, &state);
    for (int k = 0; k < 9; k++) {
        put_lanes(&p->P[k / 3][k % 3], P[k / 3][k % 3]);
        put_lanes(&p->state_P[k / 3][k % 3], state.P[k / 3][k % 3]);
    }
    put_lanes(&p->stiffening, out.stiffening);
    put_lanes(&p->energy, state.energy);
    put_lanes(&p->J, state.J);
    for (int k = 0; k < RG_RELEASED; k++) {
        put_lanes(&p->released[k], out.released[k]);
    }
    for (int k = 0; k < RG_INTERNAL; k++) {
        put_lanes(&p->internal[k], state.internal[k]);
    }
}

static void points(const rg_material *m, bool advance, rg_user_point point[RG_LANES]) {
    rg_bulk_args args = {.material = *m, .advance = advance};
    for (int lane = 0; lane < RG_LANES; lane += RG_VLEN) {
        points_of_vector(&args, point + lane);
    }
}

extern const rg_user_material rg_user_here;
__attribute__((visibility("default"))) const rg_user_material rg_user_here = {
    .head = RG_USER_HEAD("material"),
    .facts = &rg_user_facts_here,
    .history = RG_HISTORY,
    .bulk = BULK_KERNEL(rg_bulk),
    .bulk_state = BULK_KERNEL(rg_bulk_state),
    .points = points,
};
