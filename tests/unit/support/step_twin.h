/* The twin of the solver: a step of the whole body as plain loops over the elements and faces of the mesh,
 * with the scalar kernels. It knows no tiles, tile-boundary faces, rows, links between tiles, ranks or
 * threads, and reads nothing of what the solver has made of the case: materials, law, penalties, shared
 * nodes, prescribed motion and rigid bodies are worked out anew. */
#ifndef STEP_TWIN_H
#define STEP_TWIN_H

#include "diagnostics/ledger.h"
#include "mesh/mesh.h"

/* A rigid body: in the middle of a step, and as it is seen at the time of the forces. */
enum { TWIN_MATERIALS = 8 }; /* at most */

typedef struct {
    double mass, direction[3];
    double x[3], v[3], x_now[3], v_now[3], force[3];
    double work, work_now; /* of what moves it */
} twin_body;

/* What one component of an element's prescribed nodes must remember. */
typedef struct {
    double before[RG_NODES], place[RG_NODES]; /* velocity before the kick; prescribed displacement */
    double work, work_now;
} twin_hold;

typedef struct {
    const rg_case *input;
    const rg_mesh *mesh;
    rg_cohesive law;
    rg_gradient gradient;
    bool joined;                     /* joined: elements share nodes */
    double mass[RG_NODES][RG_NODES]; /* mass matrix of an element over its mass */
    rg_material material[TWIN_MATERIALS];
    size_t begin[TWIN_MATERIALS + 1]; /* blocks of each material */
    size_t elements, blocks, interfaces, iblocks;
    int *of;       /* [elements]: material */
    size_t *slot;  /* [elements]: where it lies, its number in the mesh being the index */
    int32_t *face; /* [elements][4]: its interface; -1: none */
    size_t *node;  /* [elements][10]: lowest copy 10 * element + node of the node that it is one of */
    int16_t *held; /* [elements][10][3]: the boundary that prescribes it; -1: none */
    size_t crack_stride, history_stride;
    rg_real *geom, *igeom, *scale;
    rg_real *u, *velocity, *step_velocity, *acceleration, *force, *traction, *stiffening, *iforce, *turn,
        *crack, *history;
    double *heat;
    uint8_t *broken, *unlinked, *active, *cracked;
    int32_t *neighbour, *interface, *side[2];
    twin_hold *hold; /* [elements][3] */
    twin_body *body;
    double damping; /* of the stiffest mode by viscosity.linear 1: given */
    double time, dt, dt_next;
    int64_t step;
} twin;

/* At rest. Keeps references to both. Free with twin_free. */
twin *twin_make(const rg_case *c, const rg_mesh *mesh);

/* Takes `u` and `velocity`, as they are, for the initial ones. */
void twin_start(twin *w);

/* As the solver's: from the forces of the state `u` to the velocity in the middle of a step `dt`; and on. */
void twin_kick(twin *w, double dt);
void twin_drift(twin *w);

/* `acceleration` of the state `u`; no history goes on. */
void twin_accelerate(twin *w);

/* The ledger between kick and drift, but for its error. */
rg_energy twin_energy(const twin *w);

/* Energy stored in each element, at its slot (J). */
void twin_bulk_energies(const twin *w, double *energy);

/* Time at which the first point broke; infinite if none has (s). */
double twin_first_fracture(const twin *w);

void twin_free(twin *w);

#endif
