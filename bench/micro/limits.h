/* Loops that show what an instruction set can do, compiled once per set with RG_ISA defined. */
#ifndef RG_BENCH_LIMITS_H
#define RG_BENCH_LIMITS_H

#include <stddef.h>

#include "layout.h"

enum {
    BENCH_CHAINS = 12
}; /* independent multiply-adds: two units of four to five cycles, registers for all */

#define BENCH_ISA(isa)                                                                                       \
    double bench_peak_##isa(long rounds, double factor); /* returns flops; 2 per lane, chain and round */    \
    void bench_triad_##isa(rg_real *a, const rg_real *b, const rg_real *c, double s, size_t words)

BENCH_ISA(v4);
BENCH_ISA(v3);
BENCH_ISA(v2);
BENCH_ISA(generic);

#endif
