/* Loads of a case: forces from outside on faces of the surface and on elements.
 *
 * On a face, by its six points (solver/surface.h), f_a = int N_a t dA:
 *   traction, force   t per area of reference: dead, it keeps direction and size
 *   foundation        t = -k u per area of reference, of springs to the ground: a part of the critical
 * step and of a static start; what they store is a part of the body's energy
 *   pressure          t dA = -p x,1 cross x,2 by the face's own deformed tangents, p at the place of
 * reference. By Nanson this is -p J F^-T N dA with the F of the element at its face, but from six nodes in
 * place of ten, for any state of the element, and a polynomial that the rule takes exactly: on a closed
 * surface that moves as one the forces add up to nothing, and so do their moments. On an element an
 * acceleration a, interpolated between its nodes: f = M a, which moves them by just a, with any mass.
 * Centrifugal forces are such ones, speed^2 times the way from the axis to the present place of a node: of
 * the potential -speed^2 r^2/2 per mass, so that a body that moves out gets all that it gains, where those of
 * the place of reference would leave out what makes a rotor whirl. They soften what they act on and leave the
 * critical step.
 *
 * Inside cracks a pressure acts on the faces of both elements, each by its own tangents, times the share of
 * the face's points that have separated, as last known on both sides.
 *
 * Forces are those of the displacement and the time of the step; their work is in an account
 * (solver/account.h). */
#ifndef RG_LOAD_H
#define RG_LOAD_H

#include <mpi.h>
#include <stdbool.h>

#include "case/case.h"
#include "domain/domain.h"
#include "solver/account.h"
#include "solver/surface.h"

typedef struct rg_loads rg_loads;

/* The loads of a case on this rank, each with an item of the account. Ends the run with a message where a
 * load acts on nothing, a set is unknown or a value is not finite when the load begins. Keeps references to
 * `c`, `d`, `m`, the materials, and `account`. Collective; free with rg_loads_free. */
rg_loads *rg_loads_make(const rg_case *c, const rg_domain *d, const rg_part *part, const rg_material *m,
                        rg_account *account, int threads, MPI_Comm comm);

/* A step from `time`, dt_next long, after one of dt_last (s). One thread. */
void rg_loads_set(rg_loads *l, double time, double dt_last, double dt_next);

/* For a static start: foundations alone act, at t = 0. */
void rg_loads_set_springs(rg_loads *l);

/* The share of foundations in the largest squared frequency (1/s^2). */
double rg_loads_omega2(const rg_loads *l);

/* What the stiffness of pressures, which follow the surface, added to the squared frequency of elements of
 * this rank when their forces were last found: at most, to what is symmetric of it and where faces are flat
 * (1/s^2). */
double rg_loads_omega2_now(const rg_loads *l);

/* Calls `show` with all nodes of foundations that act, along each axis (solver/constraint.h). */
void rg_loads_show(const rg_loads *l, void (*show)(void *to, size_t slot, int node, const double line[3]),
                   void *to);

struct rg_solver;

/* The forces on a tile at displacement and cracks of the solver, and the work of the half step that led here,
 * by its velocity. Before its kick. */
void rg_loads_find(rg_loads *l, size_t tile, const struct rg_solver *s);

/* Kicks the velocities of a tile. After its kick. */
void rg_loads_push(const rg_loads *l, size_t tile, const rg_push *push);

/* The work of the half step to come, by the complete velocity, and the account of a displacement. */
void rg_loads_book(const rg_loads *l, size_t tile, const rg_real *u, const rg_real *velocity);

/* The total force of each load at the time that was set, once its forces are found: for its words.
 * Collective.
 */
void rg_loads_weigh(rg_loads *l);

/* Load i in words: "traction on 2.5e-09 m2, 2 faces of steel; (0, 0, 3) N at t = 0", the force once weighed.
 */
void rg_loads_describe(const rg_loads *l, int i, char *words, size_t size);

/* Work of all loads up to the present time (J), but of foundations that last, which store it. */
double rg_loads_work(const rg_loads *l);

/* What the foundations of a tile store at a displacement (J): adds it to `stored`, and that of those which
 * begin or end to `brief`, as what they bring and take away is work from outside. */
void rg_loads_energy(const rg_loads *l, size_t tile, const rg_real *u, rg_exact_sum *stored,
                     rg_exact_sum *brief);

/* Collective: whether a value was not finite in any step so far; then words[size] says which, where and when
 * first. */
bool rg_loads_told(const rg_loads *l, char *words, size_t size);

void rg_loads_free(rg_loads *l);

#endif
