/* Random but valid input for the kernels: a jittered box of tetrahedra with real links and geometry, random
 * fields of small strain, and broken faces picked by hash. Every rank has its own. */
#ifndef RG_BENCH_PROBLEM_H
#define RG_BENCH_PROBLEM_H

#include "domain/domain.h"
#include "micro/bench.h"

/* Strain of a material with a history. */
typedef enum {
    BENCH_ROUGH,
    BENCH_QUIET,
    BENCH_CRACKING,
    BENCH_FLOWING,
    BENCH_CRUSHED,
    BENCH_STATES
} bench_state;

typedef struct {
    rg_material material[RG_MATERIAL_MODELS];
    double density;
    rg_cohesive law;
    rg_domain *domain;
    rg_real *pull, *itraction, *ipull; /* in: bulk force, corner tractions, interface force */
    rg_real *u, *velocity, *crack;     /* in and out */
    rg_real *history;                  /* of the material, in and out: room for the longest one */
    uint8_t *cracked, *broken, *unlinked, *active;
    rg_real *force, *traction, *stiffening, *iforce; /* out */
    double *energy, *cauchy, *kinetic, *ienergy;     /* out */
} bench_problem;

/* For the number of threads that OpenMP is set to; memory lies with the thread that uses it. Free with
 * bench_problem_free. */
bench_problem *bench_problem_make(bench_size size, bool quick);

/* Back to the start: fields random, `percent` of the faces broken at all their points, the history virgin,
 * outputs not numbers (so that a value left out shows). In states other than BENCH_ROUGH all elements have
 * about the same strain: none to speak of; a tension in which cracks grow, slowly; a compression in which the
 * solid flows, which both go on for as long as one cares to time them; a compression in which it flows and
 * cracks grow, until they close. */
void bench_problem_reset(bench_problem *p, int percent, bench_state state);

/* Gives blocks [begin, end) of a metal, or of a crushed ceramic, the history back with which they go on: at a
 * strain to which a metal has flowed it does not flow again. A call that is timed includes this, some 2 % of
 * it.
 */
void bench_problem_restore(bench_problem *p, rg_material_model model, bench_state state, size_t begin,
                           size_t end);

void bench_problem_free(bench_problem *p);

/* What the cost model has to know of a mesh: `flags` with padding, broken blocks and unlinked faces
 * filled in. */
rg_cost_variant bench_mesh_state(const rg_domain *d, const uint8_t *active, const uint8_t *unlinked,
                                 rg_cost_variant flags, bool by_interface);

/* Faces of element block `b` with unlinked points in some lane; `unlinked` of the block's tile. */
int bench_unlinked_faces(const rg_domain *d, const uint8_t *unlinked, size_t b);

/* Whether interface i of tile t is among the `percent` that are broken: the same for both copies of a
 * tile-boundary face.
 */
bool bench_is_broken(const rg_domain *d, const rg_tile *t, size_t i, int percent);

/* Uniform in [-1, 1), by field, element and place in it. */
double bench_noise(uint64_t field, rg_gid element, int place);

#endif
