/* Each regime of the interface by hand: one flat face, uniform tractions and jumps, on every set of kernels,
 * inside a tile and as a tile-boundary face seen from either side. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "support/face_bench.h"
#include "support/kernel_input.h"
#include "support/precision.h"

enum { ALL = FACE_BENCH_ALL };

#define AREA  FACE_BENCH_AREA /* m^2 */
#define SIGMA 4e8             /* strength (Pa) */
#define DELTA 1.6e-7          /* delta_c (m) */
#define ISO   FACE_BENCH_ISO  /* penalty per area (Pa/m) */
#define NORM  FACE_BENCH_NORM
#define STIFF (ISO + NORM)
#define EPS   (RG_ONSET * SIGMA / STIFF) /* first opening (m) */
#define FIRST (1 - EPS / DELTA)          /* traction just after the switch, in strengths */
#define GC    (SIGMA * DELTA / 2)
#define ONSET (0.3 * SIGMA / STIFF) /* first opening of a conserving activation of onset 0.3 (m) */
#define LEFT  0.8659099260315706    /* sqrt(1 - 2 * 2.0016e-8/DELTA) */
#define EASED 0.40824829046386296   /* sqrt(1 - 0.25/0.3) */
#define TIME  FACE_BENCH_TIME

/* Vectors are (normal, tangential); tractions and energies per area. */
typedef struct {
    const char *name;
    double beta;
    rg_activation activation;
    rg_contact contact;
    bool strong; /* infinite strength */
    double
        beta_s; /* of a conserving activation; where lift and penalty are alike it gives back t . [u] alone */
    bool broken, unlinked;     /* before */
    double opening, origin[2]; /* before */
    double given;              /* at the switch of a conserving activation (m) */
    double pull[2], jump[2];   /* what the point feels */
    double traction[2];        /* expected from here on */
    bool is_broken, is_unlinked;
    double new_opening, new_origin[2];
    double energy[RG_E_INTERFACE];
} scenario;

#define SECANT(opening) (SIGMA * (1 / (opening)-1 / DELTA))

static const scenario scenarios[] = {
    {.name = "intact: traction plus penalty",
     .beta = 1,
     .pull = {1e8, 1e8},
     .jump = {1e-9, 2e-9},
     .traction = {1e8 + STIFF * 1e-9, 1e8 + ISO * 2e-9},
     .energy = {(ISO * 5e-18 + NORM * 1e-18) / 2}},
    {.name = "just below the criterion",
     .beta = 1,
     .pull = {0.999 * SIGMA, 0},
     .traction = {0.999 * SIGMA, 0}},
    {.name = "breaks in tension",
     .beta = 1,
     .pull = {1.001 * SIGMA, 0},
     .jump = {1e-8, 3e-9},
     .traction = {SIGMA * FIRST, 0},
     .is_broken = true,
     .is_unlinked = true,
     .new_opening = EPS,
     .new_origin = {1e-8 - EPS, 3e-9},
     .energy = {0, SIGMA *FIRST *EPS / 2, 0, GC *EPS / DELTA}},
    {.name = "shear below the criterion",
     .beta = 2,
     .pull = {0, 1.999 * SIGMA},
     .traction = {0, 1.999 * SIGMA}},
    {.name = "breaks in shear",
     .beta = 2,
     .pull = {0, 2.001 * SIGMA},
     .traction = {0, 2 * SIGMA *FIRST},
     .is_broken = true,
     .is_unlinked = true,
     .new_opening = EPS,
     .new_origin = {0, -EPS / 2},
     .energy = {0, SIGMA *FIRST *EPS / 2, 0, GC *EPS / DELTA}},
    {.name = "breaks in tension and shear",
     .beta = 0.5,
     .pull = {0.8008 * SIGMA, 0.3003 * SIGMA},
     .traction = {0.8 * SIGMA * FIRST, 0.3 * SIGMA *FIRST},
     .is_broken = true,
     .is_unlinked = true,
     .new_opening = EPS,
     .new_origin = {-0.8 * EPS, -1.2 * EPS},
     .energy = {0, SIGMA *FIRST *EPS / 2, 0, GC *EPS / DELTA}},
    {.name = "small beta: little shear breaks",
     .beta = 0.4,
     .pull = {0, 0.41 * SIGMA},
     .traction = {0, 0.4 * SIGMA *FIRST},
     .is_broken = true,
     .is_unlinked = true,
     .new_opening = EPS,
     .new_origin = {0, -2.5 * EPS},
     .energy = {0, SIGMA *FIRST *EPS / 2, 0, GC *EPS / DELTA}},
    {.name = "breaks in shear under compression",
     .beta = 1,
     .pull = {-0.5 * SIGMA, 1.2 * SIGMA},
     .traction = {0, SIGMA *FIRST},
     .is_broken = true,
     .is_unlinked = true,
     .new_opening = EPS,
     .new_origin = {0, -EPS},
     .energy = {0, SIGMA *FIRST *EPS / 2, 0, GC *EPS / DELTA}},
    {.name = "compression does not count",
     .beta = 1,
     .pull = {-3 * SIGMA, 0.9 * SIGMA},
     .traction = {-3 * SIGMA, 0.9 * SIGMA}},
    {.name = "normal criterion ignores shear",
     .beta = 0,
     .pull = {0.9 * SIGMA, 3 * SIGMA},
     .traction = {0.9 * SIGMA, 3 * SIGMA}},
    {.name = "normal criterion",
     .beta = 0,
     .pull = {1.1 * SIGMA, 3 * SIGMA},
     .jump = {1e-9, 2e-9},
     .traction = {SIGMA * FIRST, 0},
     .is_broken = true,
     .is_unlinked = true,
     .new_opening = EPS,
     .new_origin = {1e-9 - EPS, 2e-9},
     .energy = {0, SIGMA *FIRST *EPS / 2, 0, GC *EPS / DELTA}},
    {.name = "infinite strength", .beta = 1, .strong = true, .pull = {1e12, 1e12}, .traction = {1e12, 1e12}},
    {.name = "conserving activation, no jump",
     .beta = 2,
     .activation = RG_ACTIVATION_CONSERVING,
     .pull = {0, 2.001 * SIGMA},
     .traction = {0, 2 * SIGMA},
     .is_broken = true,
     .is_unlinked = true,
     .new_origin = {0, -ONSET / 2}},
    {.name = "conserving activation, jump along the traction", /* W(1e-8) = 1.001 SIGMA u */
     .beta = 1,
     .activation = RG_ACTIVATION_CONSERVING,
     .pull = {1.001 * SIGMA, 0},
     .jump = {1e-8 * (1 - 0.5e-8 / DELTA) / 1.001, 3e-9},
     .traction = {SIGMA * (1 - 1e-8 / DELTA), 0},
     .is_broken = true,
     .is_unlinked = true,
     .new_opening = 1e-8,
     .new_origin = {1e-8 * (1 - 0.5e-8 / DELTA) / 1.001 - 1e-8 - ONSET, 3e-9},
     .energy = {0, SIGMA *(1 - 1e-8 / DELTA) * 1e-8 / 2, 0, GC * 1e-8 / DELTA}},
    {.name = "conserving activation, jump against the traction", /* delta_0 = onset/2 */
     .beta = 1,
     .activation = RG_ACTIVATION_CONSERVING,
     .pull = {1.001 * SIGMA, 0},
     .jump = {-0.375 * ONSET / 1.001, 0},
     .traction = {SIGMA / 2, 0},
     .is_broken = true,
     .is_unlinked = true,
     .new_origin = {-0.375 * ONSET / 1.001 - ONSET / 2, 0},
     .energy = {0, -SIGMA * 0.375 * ONSET, 0, 0}},
    {.name = "conserving activation, penalty given back", /* g = 1.6016e-8 + 0.3125 STIFF 1.6e-8^2/SIGMA */
     .beta = 1,
     .activation = RG_ACTIVATION_CONSERVING,
     .beta_s = 4,
     .pull = {1.001 * SIGMA, 0},
     .jump = {1.6e-8, 0},
     .traction = {SIGMA * LEFT, 0},
     .is_broken = true,
     .is_unlinked = true,
     .new_opening = DELTA * (1 - LEFT),
     .new_origin = {1.6e-8 - DELTA * (1 - LEFT) - ONSET, 0},
     .energy = {0, SIGMA *LEFT *DELTA *(1 - LEFT) / 2, 0, GC *(1 - LEFT)}},
    {.name = "conserving activation, jump that takes all of the energy",
     .beta = 1,
     .activation = RG_ACTIVATION_CONSERVING,
     .pull = {1.001 * SIGMA, 0},
     .jump = {0.6 * DELTA, 0},
     .is_broken = true,
     .is_unlinked = true,
     .new_opening = DELTA,
     .new_origin = {-0.4 * DELTA - ONSET, 0},
     .energy = {0, 0, 0, GC, SIGMA *(0.6006 - 0.5) * DELTA}},
    {.name = "conserving activation, jump far against the traction",
     .beta = 1,
     .activation = RG_ACTIVATION_CONSERVING,
     .pull = {1.001 * SIGMA, 0},
     .jump = {-2 * ONSET, 0},
     .is_broken = true,
     .is_unlinked = true,
     .new_origin = {-2 * ONSET, 0},
     .energy = {0, -SIGMA * 2.002 * ONSET, 0, 0}},          /* an onset of its own, 4.004 ONSET */
    {.name = "conserving activation, shear under pressure", /* g = -(SIGMA/2)^2/(2 STIFF SIGMA) */
     .beta = 1,
     .activation = RG_ACTIVATION_CONSERVING,
     .pull = {-0.5 * SIGMA, 1.001 * SIGMA},
     .traction = {-0.5 * SIGMA, SIGMA *EASED},
     .is_broken = true,
     .is_unlinked = true,
     .new_origin = {0.5 * SIGMA / STIFF, -ONSET *EASED},
     .energy = {0, -SIGMA * 0.125 * SIGMA / STIFF, 0.125 * SIGMA *SIGMA / STIFF, 0}},
    {.name = "conserving activation, normal criterion: shear that is dropped opens",
     .beta = 0,
     .activation = RG_ACTIVATION_CONSERVING,
     .pull = {1.001 * SIGMA, 2 * SIGMA},
     .jump = {0, 0.5e-8 * (1 - 0.5e-8 / DELTA)},
     .traction = {SIGMA * (1 - 1e-8 / DELTA), 0},
     .is_broken = true,
     .is_unlinked = true,
     .new_opening = 1e-8,
     .new_origin = {-1e-8 - ONSET, 0.5e-8 * (1 - 0.5e-8 / DELTA)},
     .energy = {0, SIGMA *(1 - 1e-8 / DELTA) * 1e-8 / 2, 0, GC * 1e-8 / DELTA}},
    {.name = "conserving, loading",
     .beta = 1,
     .activation = RG_ACTIVATION_CONSERVING,
     .broken = true,
     .unlinked = true,
     .opening = 3e-8,
     .jump = {4e-8 + ONSET, 0},
     .traction = {SIGMA * 0.75, 0},
     .is_broken = true,
     .is_unlinked = true,
     .new_opening = 4e-8,
     .energy = {0, SIGMA * 0.75 * 4e-8 / 2, 0, GC / 4}},
    {.name = "conserving, loading from an onset of its own", /* 2 ONSET */
     .beta = 1,
     .activation = RG_ACTIVATION_CONSERVING,
     .broken = true,
     .unlinked = true,
     .opening = 3e-8,
     .given = -ONSET,
     .jump = {4e-8 + 2 * ONSET, 0},
     .traction = {SIGMA * 0.75, 0},
     .is_broken = true,
     .is_unlinked = true,
     .new_opening = 4e-8,
     .energy = {0, SIGMA * 0.75 * 4e-8 / 2, 0, GC / 4}},
    {.name = "conserving, half unloaded, aside",
     .beta = 2,
     .activation = RG_ACTIVATION_CONSERVING,
     .broken = true,
     .unlinked = true,
     .opening = 4e-8,
     .jump = {0, (4e-8 + ONSET) / 4},
     .traction = {0, 2 * SIGMA * 0.75 / 2},
     .is_broken = true,
     .is_unlinked = true,
     .new_opening = 4e-8,
     .energy = {0, SIGMA * 0.75 / 2 * ((4e-8 + ONSET) / 4 - ONSET), 0, GC / 4}},
    {.name = "conserving, closed",
     .beta = 1,
     .activation = RG_ACTIVATION_CONSERVING,
     .broken = true,
     .unlinked = true,
     .opening = 4e-8,
     .jump = {-1e-9, 0},
     .traction = {-STIFF * 1e-9, 0},
     .is_broken = true,
     .is_unlinked = true,
     .new_opening = 4e-8,
     .energy = {0, -SIGMA * 0.75 / 2 * ONSET, STIFF * 1e-18 / 2, GC / 4}},
    {.name = "conserving, failed",
     .beta = 1,
     .activation = RG_ACTIVATION_CONSERVING,
     .broken = true,
     .unlinked = true,
     .opening = 1e-8,
     .given = 0.7 * DELTA,
     .jump = {DELTA + ONSET, 0},
     .is_broken = true,
     .is_unlinked = true,
     .new_opening = DELTA,
     .energy = {0, 0, 0, GC, SIGMA * 0.2 * DELTA}},
    {.name = "total activation",
     .beta = 1,
     .activation = RG_ACTIVATION_TOTAL,
     .pull = {1.1 * SIGMA, 0},
     .jump = {4e-8, 3e-8},
     .traction = {SECANT(5e-8) * 4e-8, SECANT(5e-8) * 3e-8},
     .is_broken = true,
     .is_unlinked = true,
     .new_opening = 5e-8,
     .energy = {0, SECANT(5e-8) * 25e-16 / 2, 0, GC * 5e-8 / DELTA}},
    {.name = "total activation, closed, penalty",
     .beta = 1,
     .activation = RG_ACTIVATION_TOTAL,
     .pull = {1.1 * SIGMA, 0},
     .jump = {-1e-9, 2e-8},
     .traction = {-STIFF * 1e-9, SECANT(2e-8) * 2e-8},
     .is_broken = true,
     .is_unlinked = true,
     .new_opening = 2e-8,
     .energy = {0, SECANT(2e-8) * 4e-16 / 2, STIFF * 1e-18 / 2, GC * 2e-8 / DELTA}},
    {.name = "total activation, closed, flux",
     .beta = 1,
     .activation = RG_ACTIVATION_TOTAL,
     .contact = RG_CONTACT_FLUX,
     .pull = {1.1 * SIGMA, 0},
     .jump = {-1e-9, 2e-9},
     .traction = {1.1 * SIGMA - STIFF * 1e-9, ISO * 2e-9},
     .is_broken = true,
     .energy = {(ISO * 5e-18 + NORM * 1e-18) / 2}},
    {.name = "loading",
     .beta = 1,
     .broken = true,
     .unlinked = true,
     .opening = 2e-8,
     .origin = {1e-9, -1e-9},
     .pull = {5 * SIGMA, 0},
     .jump = {4.1e-8, 2.9e-8},
     .traction = {SECANT(5e-8) * 4e-8, SECANT(5e-8) * 3e-8},
     .is_broken = true,
     .is_unlinked = true,
     .new_opening = 5e-8,
     .new_origin = {1e-9, -1e-9},
     .energy = {0, SECANT(5e-8) * 25e-16 / 2, 0, GC * 5e-8 / DELTA}},
    {.name = "loading, normal law",
     .beta = 0,
     .broken = true,
     .unlinked = true,
     .opening = 1e-8,
     .jump = {4e-8, 9e-8},
     .traction = {SECANT(4e-8) * 4e-8, 0},
     .is_broken = true,
     .is_unlinked = true,
     .new_opening = 4e-8,
     .energy = {0, SECANT(4e-8) * 16e-16 / 2, 0, GC * 4e-8 / DELTA}},
    {.name = "unloading, shear weighted",
     .beta = 2,
     .broken = true,
     .unlinked = true,
     .opening = 1e-7,
     .jump = {3e-8, 2e-8},
     .traction = {SECANT(1e-7) * 3e-8, SECANT(1e-7) * 4 * 2e-8},
     .is_broken = true,
     .is_unlinked = true,
     .new_opening = 1e-7,
     .energy = {0, SECANT(1e-7) * 25e-16 / 2, 0, GC * 1e-7 / DELTA}},
    {.name = "failed",
     .beta = 1,
     .broken = true,
     .unlinked = true,
     .opening = 2e-7,
     .jump = {3e-8, 2e-8},
     .is_broken = true,
     .is_unlinked = true,
     .new_opening = 2e-7,
     .energy = {0, 0, 0, GC}},
    {.name = "failed and closed",
     .beta = 1,
     .broken = true,
     .unlinked = true,
     .opening = 1.6e-7,
     .origin = {2e-9, 0},
     .jump = {1e-9, 5e-8},
     .traction = {-STIFF * 1e-9, 0},
     .is_broken = true,
     .is_unlinked = true,
     .new_opening = 1.6e-7,
     .new_origin = {2e-9, 0},
     .energy = {0, 0, STIFF * 1e-18 / 2, GC}},
    {.name = "closed and sliding",
     .beta = 2,
     .broken = true,
     .unlinked = true,
     .opening = 1e-7,
     .jump = {-2e-9, 3e-8},
     .traction = {-STIFF * 2e-9, SECANT(1e-7) * 4 * 3e-8},
     .is_broken = true,
     .is_unlinked = true,
     .new_opening = 1e-7,
     .energy = {0, SECANT(1e-7) * 36e-16 / 2, STIFF * 4e-18 / 2, GC * 1e-7 / DELTA}},
    {.name = "linear contact acts on an open point",
     .beta = 1,
     .contact = RG_CONTACT_LINEAR,
     .broken = true,
     .unlinked = true,
     .opening = 1e-7,
     .jump = {4e-8, 0},
     .traction = {(SECANT(1e-7) + STIFF) * 4e-8, 0},
     .is_broken = true,
     .is_unlinked = true,
     .new_opening = 1e-7,
     .energy = {0, SECANT(1e-7) * 16e-16 / 2, STIFF * 16e-16 / 2, GC * 1e-7 / DELTA}},
    {.name = "closes under flux",
     .beta = 1,
     .contact = RG_CONTACT_FLUX,
     .broken = true,
     .unlinked = true,
     .opening = 1e-8,
     .origin = {2e-9, 0},
     .pull = {-1e8, 2e8},
     .jump = {1e-9, 9e-8},
     .traction = {-1e8 + STIFF * 1e-9, 2e8 + ISO * 9e-8},
     .is_broken = true,
     .new_opening = 1e-8,
     .new_origin = {2e-9, 0},
     .energy = {(ISO * (1e-18 + 81e-16) + NORM * 1e-18) / 2, 0, 0, GC * 1e-8 / DELTA}},
    {.name = "opens again under flux",
     .beta = 1,
     .contact = RG_CONTACT_FLUX,
     .broken = true,
     .opening = 1e-7,
     .pull = {1e8, 2e8},
     .jump = {4e-8, 3e-8},
     .traction = {SECANT(1e-7) * 4e-8, SECANT(1e-7) * 3e-8},
     .is_broken = true,
     .is_unlinked = true,
     .new_opening = 1e-7,
     .energy = {0, SECANT(1e-7) * 25e-16 / 2, 0, GC * 1e-7 / DELTA}},
};

static void expect(const rg_kernels *set, const char *name, const char *what, double got, double expected,
                   double tolerance) {
    if (!(fabs(got - expected) <= tolerance))
        fail_msg("%s, %s: %s is %.17g instead of %.17g", set->name, name, what, got, expected);
}

/* A uniform traction loads the three mid-edges with a third each, the corners with nothing. */
static void expect_force(const rg_kernels *set, const scenario *s, const face_bench *b, size_t i,
                         const double t[3]) {
    for (int k = 0; k < RG_FNODES * 3; k++) {
        double expected = k / 3 < 3 ? 0 : AREA * t[k % 3] / 3;
        double scale = AREA * fmax(SIGMA, fmax(fabs(t[0]), fabs(t[2])));
        expect(set, s->name, "force", b->force[rg_iforce_index(i, k / 3, k % 3)], expected,
               TOLERANCE * scale);
    }
}

static void expect_point(const rg_kernels *set, const scenario *s, const face_bench *b, size_t i, int q,
                         double up) {
    const rg_real *crack = &b->crack[rg_crack_index(i, q, 0)];
    if (!s->is_broken)
        return;
    expect(set, s->name, "opening", crack[RG_CRACK_OPENING * RG_LANES], s->new_opening, TOLERANCE * DELTA);
    expect(set, s->name, "time", crack[RG_CRACK_TIME * RG_LANES], s->broken ? 0 : (rg_real)TIME, 0);
    const double origin[3] = {s->new_origin[1], 0, up * s->new_origin[0]};
    for (int c = 0; c < 3; c++)
        expect(set, s->name, "origin", crack[(RG_CRACK_ORIGIN + c) * RG_LANES], origin[c], TOLERANCE * DELTA);
}

static void check_scenario(const rg_kernels *set, const scenario *s, double up, face_view v) {
    const rg_cohesive law = {.strength = s->strong ? INFINITY : SIGMA,
                             .opening = DELTA,
                             .beta = s->beta,
                             .activation = s->activation,
                             .onset = 0.3,
                             .beta_s = s->beta_s > 0 ? s->beta_s : 1.5,
                             .contact = s->contact};
    const double pull[3] = {s->pull[1], 0, up * s->pull[0]}, jump[3] = {s->jump[1], 0, up * s->jump[0]};
    const double traction[3] = {s->traction[1], 0, up * s->traction[0]};
    face_bench b;
    face_bench_make(&b, law, up, v);
    face_bench_load(&b, pull, jump);
    memset(b.broken, s->broken ? ALL : 0, RG_LANES);
    memset(b.unlinked, s->unlinked ? ALL : 0, RG_LANES);
    b.active = s->broken;
    for (size_t k = 0; k < RG_LANES * RG_POINTS; k++) {
        rg_real *crack = &b.crack[rg_crack_index(k / RG_POINTS, (int)(k % RG_POINTS), 0)];
        crack[RG_CRACK_OPENING * RG_LANES] = (rg_real)s->opening;
        crack[RG_CRACK_GIVEN * RG_LANES] = (rg_real)s->given;
        crack[RG_CRACK_ORIGIN * RG_LANES] = (rg_real)s->origin[1];
        crack[(RG_CRACK_ORIGIN + 2) * RG_LANES] = (rg_real)(up * s->origin[0]);
    }
    face_bench_run(&b, set);
    expect(set, s->name, "active", b.active, s->is_broken, 0);
    for (size_t i = 0; i < RG_LANES; i++) {
        expect(set, s->name, "broken", b.broken[i], s->is_broken ? ALL : 0, 0);
        expect(set, s->name, "unlinked", b.unlinked[i], s->is_unlinked ? ALL : 0, 0);
        expect_force(set, s, &b, i, traction);
        for (int q = 0; q < RG_POINTS; q++)
            expect_point(set, s, &b, i, q, up);
        for (size_t k = 0; k < RG_E_INTERFACE; k++)
            expect(set, s->name, "energy", b.energy[k * RG_LANES + i], AREA * s->energy[k],
                   TOLERANCE * AREA * GC);
    }
}

/* All scenarios, with the normal along and against z. */
static void test_scenarios(void **state) {
    const rg_kernels *sets[INPUT_SETS];
    int n = input_sets(sets, INPUT_SETS);
    (void)state;
    for (int k = 0; k < n; k++)
        for (size_t s = 0; s < sizeof scenarios / sizeof scenarios[0]; s++)
            for (int v = 0; v < VIEWS; v++) {
                check_scenario(sets[k], &scenarios[s], 1, (face_view)v);
                check_scenario(sets[k], &scenarios[s], -1, (face_view)v);
            }
}

/* Whether a traction (per reference area) breaks the face after a deformation of the mid-surface: the same
 * answer in every face_view. */
static bool breaks(const rg_kernels *set, double beta, const double g[3][3], const double pull[3]) {
    static const double no_jump[3] = {0};
    int broken = 0;
    for (int v = 0; v < VIEWS; v++) {
        face_bench b;
        face_bench_make(&b, (rg_cohesive){.strength = SIGMA, .opening = DELTA, .beta = beta}, 1,
                        (face_view)v);
        face_bench_deform(&b, g);
        face_bench_load(&b, pull, no_jump);
        face_bench_run(&b, set);
        for (size_t i = 0; i < RG_LANES; i++)
            assert_true(b.broken[i] == (b.active ? ALL : 0));
        broken += b.active;
    }
    assert_true(broken == 0 || broken == VIEWS);
    return broken > 0;
}

static bool breaks_stretched(const rg_kernels *set, double area_ratio, double pull) {
    const double g[3][3] = {{area_ratio, 0, 0}, {0, 1, 0}, {0, 0, 1}}, t[3] = {0, 0, pull * SIGMA};
    return breaks(set, 1, g, t);
}

/* The criterion takes the Cauchy stress: a stretched face needs more force, a shrunk one less, but never less
 * than half the strength on its reference area. */
static void test_current_area(void **state) {
    const rg_kernels *sets[INPUT_SETS];
    int n = input_sets(sets, INPUT_SETS);
    (void)state;
    for (int k = 0; k < n; k++) {
        assert_false(breaks_stretched(sets[k], 2, 1.99));
        assert_true(breaks_stretched(sets[k], 2, 2.01));
        assert_false(breaks_stretched(sets[k], 0.7, 0.69));
        assert_true(breaks_stretched(sets[k], 0.7, 0.71));
        assert_false(breaks_stretched(sets[k], 0.4, 0.49));
        assert_true(breaks_stretched(sets[k], 0.4, 0.51));
    }
}

/* The normal is that of the deformed mid-surface: here z turns to x. */
static void test_current_normal(void **state) {
    static const double g[3][3] = {{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}};
    static const double along[3] = {1.01 * SIGMA, 0, 0}, against[3] = {-9 * SIGMA, 0, 0};
    static const double across[3] = {0, 0, 9 * SIGMA};
    const rg_kernels *sets[INPUT_SETS];
    int n = input_sets(sets, INPUT_SETS);
    (void)state;
    for (int k = 0; k < n; k++) {
        assert_true(breaks(sets[k], 0, g, along));
        assert_false(breaks(sets[k], 0, g, against));
        assert_false(breaks(sets[k], 0, g, across));
        assert_true(breaks(sets[k], 1, g, across));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_scenarios),
        cmocka_unit_test(test_current_area),
        cmocka_unit_test(test_current_normal),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
