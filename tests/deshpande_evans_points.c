/* One instruction set's loops over points; compiled once per set, as the kernels are. */
#include "deshpande_evans_points.h"

#include "deshpande_evans.h"
#include "isa.h"

void RG_ISA_NAME(points_step)(const points *p, size_t blocks);
void RG_ISA_NAME(points_at_rest)(const points *p, size_t blocks);
void RG_ISA_NAME(points_hencky)(const double *b, double *e, size_t blocks);
void RG_ISA_NAME(points_math)(math_function f, double exponent, const double *x, double *y, size_t blocks);

static void load(const double *from, int count, rg_vec out[]) {
    for (int k = 0; k < count; k++) {
        out[k] = rg_load(from + k * RG_LANES);
    }
}

static void store(double *to, int count, const rg_vec in[]) {
    for (int k = 0; k < count; k++) {
        rg_store(to + k * RG_LANES, in[k]);
    }
}

void RG_ISA_NAME(points_step)(const points *p, size_t blocks) {
    for (size_t b = 0; b < blocks; b++) {
        for (size_t lane = 0; lane < RG_LANES; lane += RG_VLEN) {
            rg_vec F[3][3], P[3][3], history[RG_DE_HISTORY];
            load(p->F + b * 9 * RG_LANES + lane, 9, F[0]);
            load(p->history + b * RG_DE_HISTORY * RG_LANES + lane, RG_DE_HISTORY, history);
            rg_de_result r = rg_de_step(p->constants, F, history, P);
            store(p->history + b * RG_DE_HISTORY * RG_LANES + lane, RG_DE_HISTORY, history);
            store(p->P + b * 9 * RG_LANES + lane, 9, P[0]);
            store(p->result + b * POINT_RESULT * RG_LANES + lane, POINT_RESULT,
                  (rg_vec[]){r.stiffening, r.energy, r.plastic, r.damage});
        }
    }
}

void RG_ISA_NAME(points_at_rest)(const points *p, size_t blocks) {
    for (size_t b = 0; b < blocks; b++) {
        for (size_t lane = 0; lane < RG_LANES; lane += RG_VLEN) {
            rg_vec F[3][3], P[3][3], history[RG_DE_HISTORY];
            load(p->F + b * 9 * RG_LANES + lane, 9, F[0]);
            load(p->history + b * RG_DE_HISTORY * RG_LANES + lane, RG_DE_HISTORY, history);
            rg_de_result r = rg_de_at_rest(p->constants, F, history, P);
            store(p->P + b * 9 * RG_LANES + lane, 9, P[0]);
            rg_store(p->result + (b * POINT_RESULT + POINT_ENERGY) * RG_LANES + lane, r.energy);
        }
    }
}

void RG_ISA_NAME(points_hencky)(const double *b, double *e, size_t blocks) {
    for (size_t k = 0; k < blocks; k++) {
        for (size_t lane = 0; lane < RG_LANES; lane += RG_VLEN) {
            rg_vec in[6], out[6];
            load(b + k * 6 * RG_LANES + lane, 6, in);
            rg_hencky_deviator(in, out);
            store(e + k * 6 * RG_LANES + lane, 6, out);
        }
    }
}

void RG_ISA_NAME(points_math)(math_function f, double exponent, const double *x, double *y, size_t blocks) {
    for (size_t k = 0; k < blocks * RG_LANES; k += RG_VLEN) {
        rg_vec v = rg_load(x + k);
        rg_store(y + k, f == MATH_EXP     ? rg_exp(v)
                        : f == MATH_EXPM1 ? rg_expm1(v)
                        : f == MATH_LOG1P ? rg_log1p(v)
                                          : rg_pow(v, exponent));
    }
}
