/* What a user's cohesive law computes, held against what the interface relies on: that it starts at the
 * strength, takes the work that it declares, ends, and dissipates what it does not store, never less than
 * before. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "case/user.h"

enum { STEPS = 4000 };

/* Bounds: of rounding; of an integral by so many steps. */
#define EXACT  (sizeof(rg_real) == sizeof(float) ? 1e-4 : 1e-9)
#define CLOSES (sizeof(rg_real) == sizeof(float) ? 1e-2 : 1e-3)

__attribute__((format(printf, 3, 4))) static bool refuse(char *why, size_t size, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(why, size, format, arguments);
    va_end(arguments);
    return false;
}

/* The law at so large an opening, in lane `lane`, beside others, which `seed` decides. */
static rg_user_law_point ask(const rg_cohesive *law, double strength, double opening, double largest,
                             int lane, int seed) {
    rg_user_law_point p[RG_LANES];
    for (int l = 0; l < RG_LANES; l++) {
        p[l] = (rg_user_law_point){.strength = strength,
                                   .opening = opening,
                                   .largest = l == lane ? largest
                                                        : opening * (1 + (l + seed) % RG_LANES) / RG_LANES};
    }
    law->user->points(law, p);
    return p[lane];
}

bool rg_user_law_check(const rg_cohesive *law, double strength, double opening, double *share, double *closed,
                       char *why, size_t size) {
    double declared = law->shape[RG_USER_WORK], end = law->shape[RG_USER_END];
    if (!(declared > 0 && end > 0 && isfinite(declared) && isfinite(end))) {
        return refuse(why, size, "declares a work of %g and an end of %g: both must be above 0", declared,
                      end);
    }
    double energy = declared * strength * opening, step = end * opening / STEPS, work = 0, before = 0;
    rg_user_law_point first = ask(law, strength, opening, 1e-9 * opening, 0, 0), last = first;
    double start = first.secant * first.largest / strength;
    if (!(fabs(start - 1) <= 1e-4)) {
        return refuse(why, size, "starts at %.6g of the strength, where it must start at the strength",
                      start);
    }
    *closed = 0;
    for (int n = 1; n <= STEPS; n++) {
        double largest = n * step;
        rg_user_law_point p = ask(law, strength, opening, largest, n % RG_LANES, n / RG_LANES),
                          again = ask(law, strength, opening, largest, (n + 1) % RG_LANES, 0);
        double traction = p.secant * largest;
        if (memcmp(&p, &again, sizeof p) != 0) {
            return refuse(why, size, "the same opening gives another traction in another lane");
        }
        if (!(p.secant >= 0 && p.secant <= last.secant * (1 + EXACT))) {
            return refuse(why, size,
                          "at an opening of %.4g times the critical one the secant is %.6g Pa/m, after %.6g: "
                          "it may neither grow nor be negative",
                          largest / opening, p.secant, last.secant);
        }
        if (!(p.dissipated >= last.dissipated - EXACT * energy)) {
            return refuse(why, size,
                          "at an opening of %.4g times the critical one it has dissipated %.6g J/m2, after "
                          "%.6g: it may not fall",
                          largest / opening, p.dissipated, last.dissipated);
        }
        work += (n == 1 ? strength + traction : before + traction) / 2 * step;
        *closed = fmax(*closed, fabs(work - traction * largest / 2 - p.dissipated) / energy);
        if (isnan(p.dissipated)) {
            *closed = NAN;
        }
        before = traction;
        last = p;
    }
    *share = work / energy;
    if (!(fabs(*share - 1) <= CLOSES)) {
        return refuse(why, size, "a monotonic opening takes %.6g of the work that it declares", *share);
    }
    if (!(*closed <= CLOSES)) {
        return refuse(why, size,
                      "what it dissipates and stores differs from the work of opening by %.3g of the energy, "
                      "more than %g",
                      *closed, CLOSES);
    }
    rg_user_law_point beyond = ask(law, strength, opening, 2 * end * opening, 1, 0);
    if (!(beyond.secant * end * opening <= EXACT * strength &&
          fabs(beyond.dissipated - last.dissipated) <= CLOSES * energy)) {
        return refuse(why, size,
                      "beyond its end it has a traction of %.3g of the strength and has dissipated %.6g of "
                      "the energy",
                      beyond.secant * 2 * end * opening / strength, beyond.dissipated / energy);
    }
    return true;
}
