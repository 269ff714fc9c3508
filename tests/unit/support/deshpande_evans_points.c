/* One instruction set's loops over points; compiled once per set, as the kernels are. */
#include "support/deshpande_evans_points.h"

#include "isa.h"
#include "material/deshpande_evans.h"

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

/* Up to RG_GAUSS blocks at once, as the kernel takes the points of an element. */
static void step(const points *p, bool advance, size_t block, int n, size_t lane) {
    rg_vec F[RG_GAUSS][3][3], P[RG_GAUSS][3][3], history[RG_GAUSS][RG_DE_HISTORY];
    rg_de_result result[RG_GAUSS];
    for (int g = 0; g < n; g++) {
        size_t b = block + (size_t)g;
        load(p->F + b * 9 * RG_LANES + lane, 9, F[g][0]);
        load(p->history + b * RG_DE_HISTORY * RG_LANES + lane, RG_DE_HISTORY, history[g]);
    }
    rg_de_points(p->constants, advance, n, F, history, P, result);
    for (int g = 0; g < n; g++) {
        size_t b = block + (size_t)g;
        const rg_de_result *r = &result[g];
        store(p->history + b * RG_DE_HISTORY * RG_LANES + lane, RG_DE_HISTORY, history[g]);
        store(p->P + b * 9 * RG_LANES + lane, 9, P[g][0]);
        store(p->result + b * POINT_RESULT * RG_LANES + lane, POINT_RESULT,
              (rg_vec[]){r->stiffening, r->energy, r->plastic, r->damage});
    }
}

static void all_points(const points *p, bool advance, size_t blocks) {
    for (size_t b = 0; b < blocks; b += RG_GAUSS) {
        int n = blocks - b < RG_GAUSS ? (int)(blocks - b) : RG_GAUSS;
        for (size_t lane = 0; lane < RG_LANES; lane += RG_VLEN) {
            step(p, advance, b, n, lane);
        }
    }
}

void RG_ISA_NAME(points_step)(const points *p, size_t blocks) {
    all_points(p, true, blocks);
}

void RG_ISA_NAME(points_at_rest)(const points *p, size_t blocks) {
    all_points(p, false, blocks);
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
