/* The tet10 kernel: internal force, face tractions, energy and stress at the lifted gradient F + R.
 *
 * Included by one source per material (element/material_point.h), whose functions are compiled into the
 * loops. */
#ifndef RG_BULK_H
#define RG_BULK_H

#include "element/material_point.h"
#include "element/tet10_gradient.h"
#include "isa.h"

enum { HISTORY_VALUES = RG_HISTORY == 0 ? 1 : RG_HISTORY };

#ifndef RG_TOGETHER
#define RG_TOGETHER 1
RG_INLINE void material_steps(const rg_bulk_args *args, rg_vec H[][3][3], rg_vec history[][HISTORY_VALUES],
                              rg_vec P[][3][3], rg_point out[]) {
    material_step(args, H[0], history[0], P[0], out);
}
#endif

enum { HISTORY_ROWS = RG_HISTORY == 0 ? 0 : RG_GAUSS * RG_HISTORY + RG_RELEASED };

RG_INLINE rg_real *history_of(const rg_bulk_args *args, size_t block, int lane) {
    return HISTORY_ROWS == 0 ? NULL : args->history + block * args->history_stride + lane;
}

RG_INLINE void load_history(const rg_real *from, int g, rg_vec history[]) {
    for (int k = 0; k < RG_HISTORY; k++) {
        history[k] = rg_load(from + (g * RG_HISTORY + k) * RG_LANES);
    }
}

RG_INLINE void store_history(rg_real *to, int g, const rg_vec history[]) {
    for (int k = 0; k < RG_HISTORY; k++) {
        rg_store(to + (g * RG_HISTORY + k) * RG_LANES, history[k]);
    }
}

/* Adds to what the element has set free. */
RG_INLINE void store_released(rg_real *to, const rg_vec released[RG_RELEASED]) {
    for (int k = 0; k < RG_RELEASED; k++) {
        rg_real *at = to + (RG_GAUSS * RG_HISTORY + k) * RG_LANES;
        rg_store(at, rg_load(at) + released[k]);
    }
}

/* Solids that heat expands by e = expansion times the rise of temperature. With F = (1 + e) Fe the stored
 * energy is W(Fe) per volume of reference, P = Pe/(1 + e), and the expansion feels the force dW/de = -P:F/(1
 * + e). What heat brings in is the sum of that times de, by the trapezoidal rule, whose end points are those
 * of the steps. */
RG_INLINE rg_real *thermal_of(const rg_bulk_args *args, size_t block, int lane) {
    return args->thermal == NULL ? NULL : args->thermal + block * RG_THERMAL_BLOCK + lane;
}

/* H of Fe from that of F. */
RG_INLINE void take_expansion(const rg_real *thermal, int g, rg_vec H[3][3]) {
    rg_vec e = rg_load(thermal + (RG_THERMAL_EXPANSION + g) * RG_LANES), part = 1.0 / (1.0 + e);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            H[i][j] = (i == j ? H[i][j] - e : H[i][j]) * part;
        }
    }
}

RG_INLINE rg_vec grown_volume(const rg_real *thermal, int g) {
    rg_vec length = 1.0 + rg_load(thermal + (RG_THERMAL_EXPANSION + g) * RG_LANES);
    return length * length * length;
}

/* P of F and `stiffening` from those of Fe, whose H is given; the force dW/de. */
RG_INLINE rg_vec put_expansion(const rg_real *thermal, int g, rg_vec H[3][3], rg_vec P[3][3],
                               rg_vec *stiffening) {
    rg_vec e = rg_load(thermal + (RG_THERMAL_EXPANSION + g) * RG_LANES), part = 1.0 / (1.0 + e), power = {0};
    for (int i = 0; i < 3; i++) {
        power += P[i][i] + rg_dot(P[i], H[i]);
        for (int j = 0; j < 3; j++) {
            P[i][j] *= part;
        }
    }
    *stiffening *= part * part;
    return -part * power;
}

/* The work of a step that ends with this force at point g, unless none has led here. */
RG_INLINE rg_vec expansion_work(rg_real *thermal, int g, rg_vec force, bool advance) {
    rg_real *now = thermal + (RG_THERMAL_EXPANSION + g) * RG_LANES;
    rg_real *last = thermal + (RG_THERMAL_LAST + g) * RG_LANES;
    rg_real *before = thermal + (RG_THERMAL_FORCE + g) * RG_LANES;
    rg_vec work = 0.5 * (force + rg_load(before)) * (rg_load(now) - rg_load(last));
    rg_store(last, rg_load(now));
    rg_store(before, force);
    return advance ? work : rg_splat(0.0);
}

/* Solids whose axes, the rows of Q, differ from element to element: W of them is W(Q F Q^T), so P = Q^T P(Q F
 * Q^T) Q, of a material that defines RG_TURNED. */
#ifdef RG_TURNED
enum { TURNED = 1 };
#else
enum { TURNED = 0 };
#endif

RG_INLINE const rg_real *turn_of(const rg_bulk_args *args, size_t block, int lane) {
    return TURNED == 0 || args->turn == NULL ? NULL : args->turn + block * RG_TURN_BLOCK + lane;
}

RG_INLINE void load_turn(const rg_real *turn, rg_vec Q[3][3]) {
    for (int k = 0; k < RG_TURN; k++) {
        Q[k / 3][k % 3] = rg_load(turn + k * RG_LANES);
    }
}

/* T becomes Q T Q^T. */
RG_INLINE void take_turn(const rg_real *turn, rg_vec T[3][3]) {
    rg_vec Q[3][3], half[3][3];
    load_turn(turn, Q);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            half[i][j] = rg_dot(T[i], Q[j]);
        }
    }
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            T[i][j] = Q[i][0] * half[0][j] + Q[i][1] * half[1][j] + Q[i][2] * half[2][j];
        }
    }
}

/* T becomes Q^T T Q. */
RG_INLINE void put_turn(const rg_real *turn, rg_vec T[3][3]) {
    rg_vec Q[3][3], half[3][3];
    load_turn(turn, Q);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            half[i][j] = T[i][0] * Q[0][j] + T[i][1] * Q[1][j] + T[i][2] * Q[2][j];
        }
    }
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            T[i][j] = Q[0][i] * half[0][j] + Q[1][i] * half[1][j] + Q[2][i] * half[2][j];
        }
    }
}

/* thermal: NULL where nothing expands; turn: NULL where nothing has axes of its own. */
RG_INLINE void bulk_vector(const rg_bulk_args *args, size_t block, int lane, rg_gradient gradient,
                           rg_real *thermal, const rg_real *turn) {
    element e;
    load_element(&e, args, block, lane, gradient);
    vec3 common[4], q[4][RG_GAUSS], Q[4] = {{{0}}};
    common_derivatives(&e, gradient, common);
    rg_real *past = history_of(args, block, lane);
    rg_vec stiffening = {0}, bad = {0}, weight = 0.25 * e.volume, released[RG_RELEASED] = {{0}}, heated = {0};
    for (int first = 0; first < RG_GAUSS; first += RG_TOGETHER) {
        rg_vec H[RG_TOGETHER][3][3] = {{{{0}}}}, P[RG_TOGETHER][3][3], history[RG_TOGETHER][HISTORY_VALUES];
        rg_point point[RG_TOGETHER];
        for (int i = 0; i < RG_TOGETHER; i++) {
            displacement_gradient(&e, gradient, common, first + i, H[i]);
            if (thermal != NULL) {
                take_expansion(thermal, first + i, H[i]);
            }
            if (turn != NULL) {
                take_turn(turn, H[i]);
            }
            load_history(past, first + i, history[i]);
        }
        material_steps(args, H, history, P, point);
        for (int i = 0; i < RG_TOGETHER; i++) {
            if (turn != NULL) {
                put_turn(turn, P[i]);
            }
            if (thermal != NULL) {
                rg_vec force = put_expansion(thermal, first + i, H[i], P[i], &point[i].stiffening);
                heated += weight * expansion_work(thermal, first + i, force, args->advance);
            }
            stiffening = rg_max(stiffening, point[i].stiffening);
            bad += 0.0 * point[i].stiffening; /* a maximum forgets what is not a number */
            if (RG_HISTORY > 0 && args->advance) {
                store_history(past, first + i, history[i]);
                for (int k = 0; k < RG_RELEASED; k++) {
                    released[k] += weight * point[i].released[k];
                }
            }
            project_stress(&e, weight, P[i], first + i, q, Q);
        }
    }
    if (RG_HISTORY > 0 && args->advance) {
        store_released(past, released);
    }
    if (thermal != NULL) {
        rg_real *work = thermal + RG_THERMAL_WORK * RG_LANES;
        rg_store(work, rg_load(work) + heated);
    }
    store_force(q, Q, args->force + block * RG_NODE_BLOCK + lane, false);
    store_traction(q, Q, args->traction + (block * RG_LANES + (size_t)lane) * RG_TRACTION_ROW);
    rg_store(args->stiffening + block * RG_LANES + lane, stiffening + bad);
}

#define BULK_KERNEL(kernel) RG_ISA_NAME(RG_PASTE(kernel, RG_MATERIAL))

/* Solids that expand, in a function of its own: within the other one it would cost all solids a tenth, in
 * registers, of what they take. */
static __attribute__((noinline)) void heated_blocks(const rg_bulk_args *args, size_t begin, size_t end) {
    for (size_t b = begin; b < end; b++) {
        for (int lane = 0; lane < RG_LANES; lane += RG_VLEN) {
            bulk_vector(args, b, lane, args->gradient, thermal_of(args, b, lane), NULL);
        }
    }
}

#ifdef RG_TURNED
/* Likewise. */
static __attribute__((noinline)) void turned_blocks(const rg_bulk_args *args, size_t begin, size_t end) {
    for (size_t b = begin; b < end; b++) {
        for (int lane = 0; lane < RG_LANES; lane += RG_VLEN) {
            bulk_vector(args, b, lane, args->gradient, NULL, turn_of(args, b, lane));
        }
    }
}
#endif

void BULK_KERNEL(rg_bulk)(const rg_bulk_args *args, size_t begin, size_t end) {
    if (args->thermal != NULL) {
        heated_blocks(args, begin, end);
        return;
    }
#ifdef RG_TURNED
    if (args->turn != NULL) {
        turned_blocks(args, begin, end);
        return;
    }
#endif
    for (size_t b = begin; b < end; b++) {
        for (int lane = 0; lane < RG_LANES; lane += RG_VLEN) {
            if (args->gradient == RG_GRADIENT_LIFTED) {
                bulk_vector(args, b, lane, RG_GRADIENT_LIFTED, NULL, NULL);
            } else {
                bulk_vector(args, b, lane, RG_GRADIENT_OWN, NULL, NULL);
            }
        }
    }
}

/* Cauchy stress P F^T/J of one point. */
RG_INLINE void store_cauchy(double *out, rg_vec H[3][3], rg_point_state *s) {
    static const int first[6] = {0, 1, 2, 1, 0, 0}, second[6] = {0, 1, 2, 2, 2, 1};
    rg_vec F[3][3];
    rg_plus_identity(H, F);
    for (int k = 0; k < 6; k++) {
        rg_store_wide(out + k * RG_LANES, rg_dot(s->P[first[k]], F[second[k]]) / s->J);
    }
}

RG_INLINE void state_vector(const rg_bulk_state_args *args, size_t block, size_t row, int lane,
                            rg_gradient gradient) {
    element e;
    load_element(&e, args->bulk, block, lane, gradient);
    vec3 common[4];
    common_derivatives(&e, gradient, common);
    const rg_real *past = history_of(args->bulk, block, lane), *thermal = thermal_of(args->bulk, block, lane),
                  *turn = turn_of(args->bulk, block, lane);
    rg_vec energy = {0};
    for (int g = 0; g < RG_GAUSS; g++) {
        rg_vec H[3][3], history[RG_HISTORY + 1];
        rg_point_state s;
        size_t at = row * RG_GAUSS + (size_t)g;
        displacement_gradient(&e, gradient, common, g, H);
        if (thermal != NULL) {
            take_expansion(thermal, g, H);
        }
        if (turn != NULL) {
            take_turn(turn, H);
        }
        load_history(past, g, history);
        material_state(&args->bulk->material, H, history, args->cauchy != NULL, &s);
        energy += 0.25 * e.volume * s.energy;
        if (turn != NULL && args->cauchy != NULL) {
            put_turn(turn, H);
            put_turn(turn, s.P);
        }
        if (args->cauchy != NULL) {
            s.J *= thermal == NULL ? rg_splat(1.0) : grown_volume(thermal, g); /* P F^T = Pe Fe^T */
            store_cauchy(args->cauchy + at * 6 * RG_LANES + lane, H, &s);
        }
        for (int k = 0; RG_HISTORY > 0 && args->internal != NULL && k < RG_INTERNAL; k++) {
            rg_store_wide(args->internal + (at * RG_INTERNAL + (size_t)k) * RG_LANES + lane, s.internal[k]);
        }
    }
    if (args->energy != NULL) {
        rg_store_wide(args->energy + row * RG_LANES + lane, energy);
    }
}

void BULK_KERNEL(rg_bulk_state)(const rg_bulk_state_args *args, size_t begin, size_t end) {
    for (size_t b = begin; b < end; b++) {
        for (int lane = 0; lane < RG_LANES; lane += RG_VLEN) {
            if (args->bulk->gradient == RG_GRADIENT_LIFTED) {
                state_vector(args, b, b - begin, lane, RG_GRADIENT_LIFTED);
            } else {
                state_vector(args, b, b - begin, lane, RG_GRADIENT_OWN);
            }
        }
    }
}

#endif
