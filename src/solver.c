#include "solver.h"

#include <math.h>
#include <omp.h>
#include <string.h>

#include "element.h"
#include "error.h"
#include "mem.h"
#include "mesh_case.h"

/* Elements of a tile: about 0.5 MB of fields, so that the interfaces inside find their tractions in the
 * cache. */
enum { TILE_ELEMENTS = 256 };

/* ---- Set-up ---- */

static size_t displacement_index(int32_t link, int k) {
    return rg_node_index((size_t)link / RG_FACES, rg_face_node[link % RG_FACES][k / 3], k % 3);
}

static size_t traction_index(int32_t link, int k) {
    return rg_traction_index((size_t)link / RG_FACES, link % RG_FACES, k / 3, k % 3);
}

static void lame(const rg_case *c, double *lambda, double *mu) {
    double e = c->material.young, nu = c->material.poisson;
    *lambda = e * nu / ((1 + nu) * (1 - 2 * nu));
    *mu = e / (2 * (1 + nu));
}

static void allocate_fields(rg_solver *s) {
    const rg_domain *d = s->domain;
    size_t all = d->blocks + d->ghost_blocks, faces = d->iblocks + 1;
    s->u = RG_NEW(double, all *RG_NODE_BLOCK);
    s->velocity = RG_NEW(double, d->blocks *RG_NODE_BLOCK);
    s->scratch = RG_NEW(double, d->blocks *RG_NODE_BLOCK);
    s->force = RG_NEW(double, d->blocks *RG_NODE_BLOCK);
    s->traction = RG_NEW(double, all *RG_TRACTION_BLOCK);
    s->stiffening = RG_NEW(double, d->blocks *RG_LANES);
    s->tile_stiffening = RG_NEW(double, d->tiles + 1);
    s->iforce = RG_NEW(double, faces *RG_IFORCE_BLOCK);
    s->crack = RG_NEW(double, faces *RG_CRACK_BLOCK);
    s->cracked = RG_NEW(uint8_t, d->blocks + 1);
    s->broken = RG_NEW(uint8_t, faces * RG_LANES);
    s->unlinked = RG_NEW(uint8_t, faces * RG_LANES);
    s->active = RG_NEW(uint8_t, faces);
}

static void place_tile(rg_solver *s, const rg_tile *tile) {
    size_t b = tile->begin, n = tile->end - b, i = tile->ibegin, m = tile->iend - i;
    memset(s->u + b * RG_NODE_BLOCK, 0, n * RG_NODE_BLOCK * sizeof(double));
    memset(s->velocity + b * RG_NODE_BLOCK, 0, n * RG_NODE_BLOCK * sizeof(double));
    memset(s->scratch + b * RG_NODE_BLOCK, 0, n * RG_NODE_BLOCK * sizeof(double));
    memset(s->force + b * RG_NODE_BLOCK, 0, n * RG_NODE_BLOCK * sizeof(double));
    memset(s->traction + b * RG_TRACTION_BLOCK, 0, n * RG_TRACTION_BLOCK * sizeof(double));
    memset(s->iforce + i * RG_IFORCE_BLOCK, 0, m * RG_IFORCE_BLOCK * sizeof(double));
}

/* First touch: the pages go to the thread that will sweep the tile, in the loops of `pass`. */
static void place_fields(rg_solver *s) {
    const rg_domain *d = s->domain;
#pragma omp parallel
    {
#pragma omp for schedule(static)
        for (size_t t = 0; t < d->boundary_tiles; t++) {
            place_tile(s, &d->tile[t]);
        }
#pragma omp for schedule(static)
        for (size_t t = d->boundary_tiles; t < d->tiles; t++) {
            place_tile(s, &d->tile[t]);
        }
    }
}

static void bind_kernels(rg_solver *s) {
    const rg_case *c = s->input;
    const rg_domain *d = s->domain;
    bool breaks = c->interface.law != RG_LAW_NONE;
    double lambda, mu;
    lame(c, &lambda, &mu);
    s->bulk = (rg_bulk_args){.material = {lambda, mu, c->material.density},
                             .lift = c->interface.form == RG_FORM_VARIATIONAL,
                             .u = s->u,
                             .geom = d->geom,
                             .neighbour = d->neighbour,
                             .interface = d->interface,
                             .cracked = s->cracked,
                             .unlinked = s->unlinked,
                             .force = s->force,
                             .traction = s->traction,
                             .stiffening = s->stiffening};
    s->interface =
        (rg_interface_args){.law = {.strength = breaks ? c->interface.strength : INFINITY,
                                    .opening = breaks ? 2 * c->interface.energy / c->interface.strength : 1,
                                    .beta = c->interface.beta,
                                    .total = c->interface.activation == RG_ACTIVATION_TOTAL,
                                    .flux = c->interface.contact == RG_CONTACT_FLUX},
                            .u = s->u,
                            .traction = s->traction,
                            .side = {d->side[0], d->side[1]},
                            .geom = d->igeom,
                            .broken = s->broken,
                            .unlinked = s->unlinked,
                            .active = s->active,
                            .crack = s->crack,
                            .crack_stride = RG_CRACK_BLOCK,
                            .force = s->iforce};
    s->update = (rg_update_args){.density = c->material.density,
                                 .lumped = c->mass == RG_MASS_LUMPED,
                                 .geom = d->geom,
                                 .force = s->force,
                                 .iforce = s->iforce,
                                 .interface = d->interface,
                                 .velocity = s->velocity,
                                 .u = s->u};
}

static rg_part *make_part(const rg_case *c, int rank, MPI_Comm comm) {
    rg_mesh *mesh = NULL;
    if (rank == 0) {
        mesh = rg_mesh_of_case(c);
    }
    rg_part *part = rg_part_distribute(mesh, comm);
    rg_mesh_free(mesh);
    return part;
}

rg_solver *rg_solver_make(const rg_case *input, MPI_Comm comm) {
    rg_solver *s = RG_NEW(rg_solver, 1);
    *s = (rg_solver){.input = input, .comm = comm, .threads = omp_get_max_threads(), .limiting = -1};
    MPI_Comm_rank(comm, &s->rank);
    MPI_Comm_size(comm, &s->ranks);
    s->kernels = rg_kernels_select();
    if (s->kernels == NULL && s->rank > 0) {
        MPI_Barrier(comm); /* rank 0 speaks and ends the job */
    }
    if (s->kernels == NULL) {
        rg_fatal(RG_USAGE, "RHEGMA_ISA names an instruction set that this machine does not have; there are "
                           "x86-64-v2, -v3, -v4");
    }
    s->part = make_part(input, s->rank, comm);
    double lambda, mu;
    lame(input, &lambda, &mu);
    rg_interface_material m = {lambda, mu, input->interface.beta_s, input->interface.penalty};
    s->domain = rg_domain_build(s->part, s->rank, &m, TILE_ELEMENTS);
    rg_free(s->part->element);
    s->part->element = NULL;
    s->halo_u = rg_halo_make(s->domain, 3 * RG_FNODES, displacement_index, 1, comm);
    s->halo_t = rg_halo_make(s->domain, 3 * RG_FCORNERS, traction_index, 2, comm);
    s->constraints = rg_constraints_make(input, s->domain, s->part);
    allocate_fields(s);
    place_fields(s);
    bind_kernels(s);
    return s;
}

/* ---- Passes (inside a parallel region) ---- */

/* Tells the elements beside broken points, so that the lift leaves those points out. */
static void mark_cracked(rg_solver *s, size_t begin, size_t end) {
    for (size_t b = begin; b < end; b++) {
        for (size_t i = b * RG_LANES; s->active[b] && i < (b + 1) * RG_LANES; i++) {
            for (int k = 0; s->broken[i] && k < 2; k++) {
                size_t block = (size_t)s->domain->side[k][i] / (RG_FACES * RG_LANES);
                if (block < s->domain->blocks) {
#pragma omp atomic write
                    s->cracked[block] = 1;
                }
            }
        }
    }
}

static void interface_blocks(rg_solver *s, size_t begin, size_t end) {
    s->kernels->interface(&s->interface, begin, end);
    mark_cracked(s, begin, end);
}

static void update_tiles(rg_solver *s, size_t begin, size_t end) {
#pragma omp for schedule(static)
    for (size_t t = begin; t < end; t++) {
        s->kernels->update(&s->update, s->domain->tile[t].begin, s->domain->tile[t].end);
        if (s->constraints != NULL) {
            rg_constraints_apply(s->constraints, t, s->velocity, s->u, s->update.dt_displacement);
        }
    }
}

/* Largest value; not a number if one is not (a maximum forgets it). */
static double largest(const double *x, size_t count) {
    double m = 0, bad = 0;
    for (size_t i = 0; i < count; i++) {
        m = x[i] > m ? x[i] : m;
        bad += 0.0 * x[i];
    }
    return m + bad;
}

/* Bulk of a tile, then the interfaces inside it while its tractions are in the cache. */
static void sweep_tiles(rg_solver *s, size_t begin, size_t end, rg_halo *under) {
#pragma omp for schedule(static)
    for (size_t t = begin; t < end; t++) {
        const rg_tile *tile = &s->domain->tile[t];
        s->kernels->bulk(&s->bulk, tile->begin, tile->end);
        interface_blocks(s, tile->ibegin, tile->iend);
        s->tile_stiffening[t] =
            largest(s->stiffening + tile->begin * RG_LANES, (tile->end - tile->begin) * RG_LANES);
        if (under != NULL && omp_get_thread_num() == 0) {
            rg_halo_poll(under);
        }
    }
}

static void sweep_interfaces(rg_solver *s, size_t begin, size_t end, rg_halo *under) {
    enum { CHUNK = 32 };
#pragma omp for schedule(static)
    for (size_t b = begin; b < end; b += CHUNK) {
        interface_blocks(s, b, b + CHUNK < end ? b + CHUNK : end);
        if (under != NULL && omp_get_thread_num() == 0) {
            rg_halo_poll(under);
        }
    }
}

static void start(rg_halo *h) {
#pragma omp master
    rg_halo_start(h);
}

static void finish(rg_halo *h, double *field) {
#pragma omp master
    rg_halo_finish(h);
#pragma omp barrier
    rg_halo_unpack(h, field);
}

/* The largest stiffening of all ranks, for the next time step: known when the pass is over. */
static void start_stiffening(rg_solver *s) {
#pragma omp master
    {
        double here = largest(s->tile_stiffening, s->domain->tiles);
        s->stiffening_here = isfinite(here) ? here : INFINITY;
        MPI_Iallreduce(&s->stiffening_here, &s->stiffening_anywhere, 1, MPI_DOUBLE, MPI_MAX, s->comm,
                       &s->stiffening_request);
    }
}

/* One evaluation of all forces, preceded by the update of velocities and displacements if `update`. The first
 * message (traces of the displacement) runs under the interior elements, the second (tractions) under the
 * interfaces between tiles. */
static void pass(rg_solver *s, bool update) {
    const rg_domain *d = s->domain;
#pragma omp parallel
    {
        if (update) {
            update_tiles(s, 0, d->boundary_tiles);
        }
        rg_halo_pack(s->halo_u, s->u);
        start(s->halo_u);
        if (update) {
            update_tiles(s, d->boundary_tiles, d->tiles);
        }
        sweep_tiles(s, d->boundary_tiles, d->tiles, s->halo_u);
        finish(s->halo_u, s->u);
        sweep_tiles(s, 0, d->boundary_tiles, NULL);
        rg_halo_pack(s->halo_t, s->traction);
        start(s->halo_t);
        start_stiffening(s);
        sweep_interfaces(s, d->between_begin, d->shared_begin, s->halo_t);
        finish(s->halo_t, s->traction);
        sweep_interfaces(s, d->shared_begin, d->iblocks, NULL);
    }
    MPI_Wait(&s->stiffening_request, MPI_STATUS_IGNORE);
}

void rg_solver_forces(rg_solver *s) {
    pass(s, false);
}

/* ---- Time ---- */

/* Value of an initial expression, 0 where there is none. */
static double initial_value(const rg_expr *e, const char *key, int component, const double x[3]) {
    double value = e == NULL ? 0 : rg_expr_value(e, x, 0);
    if (!isfinite(value)) {
        rg_fatal(RG_USAGE, "initial.%s.%c: %s is not finite at (%g, %g, %g)", key, "xyz"[component],
                 rg_expr_text(e), x[0], x[1], x[2]);
    }
    return value;
}

static void set_initial(rg_solver *s) {
    const rg_case *c = s->input;
    for (size_t slot = 0; slot < s->domain->blocks * RG_LANES; slot++) {
        for (int n = 0; s->domain->id[slot] >= 0 && n < RG_NODES; n++) {
            double x[3];
            rg_node_position(s->domain->corner + 12 * slot, n, x);
            for (int k = 0; k < 3; k++) {
                s->u[rg_node_index(slot, n, k)] =
                    initial_value(c->initial.displacement[k], "displacement", k, x);
                s->velocity[rg_node_index(slot, n, k)] =
                    initial_value(c->initial.velocity[k], "velocity", k, x);
            }
        }
    }
}

void rg_solver_start(rg_solver *s) {
    set_initial(s);
    rg_constraints_start(s->constraints, s->u, s->velocity);
    s->interface.time = 0;
    rg_solver_forces(s);
}

void rg_solver_step(rg_solver *s, double dt) {
    bool first = s->step == 0;
    s->update.dt_velocity = first ? 0.5 * dt : 0.5 * (s->dt + dt);
    s->update.dt_displacement = dt;
    rg_constraints_set(s->constraints, s->time + 0.5 * dt, s->time + dt, dt);
    s->dt = dt;
    s->time += dt;
    s->step++;
    s->interface.time = s->time;
    pass(s, true);
}

/* Half a step's worth of force on top of the velocities of blocks [begin, end), in `scratch`. */
static void half_update(rg_solver *s, size_t begin, size_t end) {
    rg_update_args now = s->update;
    now.velocity = s->scratch;
    now.u = NULL;
    now.dt_velocity = s->step == 0 ? 0 : 0.5 * s->dt;
    size_t at = begin * RG_NODE_BLOCK;
    memcpy(s->scratch + at, s->velocity + at, (end - begin) * RG_NODE_BLOCK * sizeof(double));
    s->kernels->update(&now, begin, end);
}

static void half_constraints(rg_solver *s, size_t begin, size_t end, rg_exact_sum *work) {
    if (s->step > 0) { /* at the start the velocities are the initial ones */
        rg_constraints_peek(s->constraints, begin * RG_LANES, end * RG_LANES, s->time, s->scratch, work);
    }
}

void rg_solver_velocity_now(rg_solver *s, rg_exact_sum *work) {
    const rg_domain *d = s->domain;
#pragma omp parallel for schedule(static)
    for (size_t t = 0; t < d->tiles; t++) {
        half_update(s, d->tile[t].begin, d->tile[t].end);
    }
    half_constraints(s, 0, d->blocks, work);
}

void rg_solver_block_velocity_now(rg_solver *s, size_t block) {
    half_update(s, block, block + 1);
    half_constraints(s, block, block + 1, NULL);
}

void rg_solver_free(rg_solver *s) {
    if (s == NULL) {
        return;
    }
    void *blocks[] = {s->u,      s->velocity, s->scratch,    s->force,           s->traction,
                      s->iforce, s->crack,    s->stiffening, s->tile_stiffening, s->cracked,
                      s->broken, s->unlinked, s->active};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) {
        rg_free(blocks[i]);
    }
    rg_constraints_free(s->constraints);
    rg_halo_free(s->halo_u);
    rg_halo_free(s->halo_t);
    rg_domain_free(s->domain);
    rg_part_free(s->part);
    rg_free(s);
}
