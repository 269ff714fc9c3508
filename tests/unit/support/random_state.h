/* A state of a run drawn at random by the numbers of elements and faces, so that every rank knows all of it:
 * a jittered box of two materials, far from the origin, with cracks, friction, viscous heat, histories,
 * bodies and prescribed motions. */
#ifndef RG_TEST_RANDOM_STATE_H
#define RG_TEST_RANDOM_STATE_H

#include <stdbool.h>

#include "mesh/mesh.h"
#include "solver/solver.h"
#include "solver/state.h"

typedef struct {
    rg_case *input;
    rg_mesh *mesh; /* the whole one, on every rank */
    rg_solver *solver;
} random_state;

/* Fields at rest. `change`: overrides of the case (case/case.h). Collective. */
random_state random_state_make(int changes, const char *const change[], MPI_Comm comm);
void random_state_free(random_state *r);

/* Draws all that the solver's registry of state (solver/state.h) holds, and `step_velocity`, and publishes
 * the traces. `seed` tells states apart. Collective. */
void random_state_draw(random_state *r, uint64_t seed);

/* From this seed on most faces have failed, so that the body is debris. */
enum { RANDOM_DEBRIS = 1000 };

/* What is drawn, in [-1, 1), by the kind of value, an element or face, and a number. */
typedef enum {
    DRAW_U,
    DRAW_NOW,
    DRAW_VELOCITY,
    DRAW_HISTORY,
    DRAW_HEAT,
    DRAW_BITS,
    DRAW_UNLINKED,
    DRAW_DAMAGE,
    DRAW_ORIGIN,
    DRAW_TIME,
    DRAW_FRICTION,
    DRAW_CONSTRAINT,
    DRAW_BODY,
    DRAW_RUN,
    DRAW_GIVEN,
    DRAW_OTHER
} draw_kind;
double drawn(uint64_t seed, draw_kind kind, int64_t of, int64_t number);

/* As they are drawn: displacement (m) and velocities (m/s) of a node, in the middle of the step and at its
 * time; value `row` (layout.h) of the history of a material with so many values per point; heat (J); broken
 * points of a face as bits, damage of a point, time (s) at which it switched, value k (layout.h) of its
 * friction. */
double drawn_u(uint64_t seed, rg_gid id, int node, int component);
double drawn_velocity(uint64_t seed, rg_gid id, int node, int component);
double drawn_now(uint64_t seed, rg_gid id, int node, int component);
double drawn_history(uint64_t seed, rg_gid id, int values, int row);
double drawn_heat(uint64_t seed, rg_gid id);
uint8_t drawn_broken(uint64_t seed, rg_gid face);
double drawn_damage(uint64_t seed, rg_gid face, int point);
double drawn_time(uint64_t seed, rg_gid face, int point);
double drawn_friction(uint64_t seed, rg_gid face, int point, int k);

/* The number of a face between two elements: 4 times the lower one's number plus its local face; -1 on the
 * surface. */
rg_gid face_key(const rg_mesh *mesh, rg_gid id, int face);

/* The same of an interface of tile t. */
rg_gid interface_key(const random_state *r, const rg_tile *t, size_t i);

/* Reference corners of an element (m). */
void mesh_corners(const rg_mesh *mesh, rg_gid id, double x[4][3]);

/* A copy of a field of nodes; the caller frees it with rg_free. */
rg_real *copy_field(const rg_solver *s, const rg_real *from);

/* Where node n of an element is at rest (m). */
void mesh_node(const rg_mesh *mesh, rg_gid id, int n, double at[3]);

/* Volume of a tetrahedron (m^3). */
double tet_volume(double x[4][3]);

/* Material of an element, as the case has it; its mass (kg). */
int mesh_material(const random_state *r, rg_gid id);
double mesh_mass(const random_state *r, rg_gid id);

#endif
