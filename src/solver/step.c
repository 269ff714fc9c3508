#include "solver/step.h"

#include <math.h>
#include <omp.h>
#include <string.h>

#include "base/interrupt.h"
#include "base/mem.h"
#include "partition/material.h"
#include "solver/ahead.h"
#include "solver/exposure.h"
#include "solver/initial.h"
#include "solver/law.h"
#include "solver/step_limiter.h"
#include "solver/stepper.h"
#include "solver/tile.h"

/* ---- One tile ---- */

/* Where the forces go: velocity += dt M^-1 f. */
typedef struct {
    rg_real *velocity;
    double dt;
    bool move;      /* the step goes on: drift and publish at once */
    bool observe;   /* `step_velocity` is wanted everywhere */
    bool constrain; /* prescribed motions, loads and bodies act */
    bool advance;   /* the history of the material goes on by the step that led here: once for each state */
    bool hold;      /* no face breaks */
    double stretch; /* cohesive laws have the same first slope up to openings so many times as large; 0: 1 */
    bool load;      /* of what acts from outside, loads alone do */
    bool apart;     /* velocity is that of elements that do not know yet that they share nodes */
} impulse;

/* Where the velocity at the present time goes; NULL: it is not wanted. */
static rg_real *step_velocity_of(const rg_solver *s, size_t tile, const impulse *p) {
    return !p->apart && (p->observe || s->watched[tile]) ? s->step_velocity : NULL;
}

/* Tells the elements beside broken points, so that the lift leaves those points out. */
static void mark_cracked(rg_solver *s, const rg_tile *t, size_t begin, size_t end) {
    for (size_t b = begin; b < end; b++) {
        for (size_t i = b * RG_LANES; s->active[b] && i < (b + 1) * RG_LANES; i++) {
            for (int k = 0; s->broken[i] && k < (b < t->sbegin ? 2 : 1); k++) {
                s->cracked[t->begin + (size_t)s->domain->side[k][i] / (RG_FACES * RG_LANES)] = 1;
            }
        }
    }
}

static void tile_kick(rg_solver *s, size_t tile, const rg_workspace *w, const impulse *p, rg_sweep sweep) {
    const rg_tile *t = &s->domain->tile[tile];
    size_t at = t->begin * RG_NODE_BLOCK;
    rg_real *step_velocity = step_velocity_of(s, tile, p);
    rg_kick_args args = {.mass = s->input->mass,
                         .sweep = sweep,
                         .contact = s->model->law.contact,
                         .dt = p->dt,
                         .geom = s->domain->geom + t->begin * RG_GEOM_BLOCK,
                         .force = w->force,
                         .iforce = w->iforce,
                         .turn = w->turn,
                         .broken = s->broken + t->ibegin * RG_LANES,
                         .interface = s->domain->interface + t->begin * RG_LINK_BLOCK,
                         .velocity = p->velocity + at,
                         .step_velocity = step_velocity == NULL ? NULL : step_velocity + at,
                         .dt_now = 0.5 * s->dt};
    for (size_t begin = 0, end; begin < rg_tile_eblocks(t); begin = end) {
        end = rg_run_end(s->domain, t, begin);
        args.density = rg_block_material(s, t, begin)->density;
        while (sweep == RG_SWEEP_BOUNDARY && begin < end && !s->domain->rim[t->begin + begin]) {
            begin++; /* no tile-boundary face */
        }
        s->kernels->kick(&args, begin, end);
    }
}

/* Loads and bodies. */
static void push(rg_solver *s, size_t tile, const impulse *p) {
    rg_push k = {p->dt, 0.5 * s->dt, p->velocity, step_velocity_of(s, tile, p)};
    rg_loads_push(s->loads, tile, &k);
    rg_bodies_touch(s->bodies, tile, s->u, &k, s->body_clear);
}

/* Largest value; not a number if one is not (a maximum forgets it). */
static rg_real largest(const rg_real *x, size_t count) {
    rg_real m = 0, bad = 0;
    for (size_t i = 0; i < count; i++) {
        m = x[i] > m ? x[i] : m;
        bad += 0 * x[i];
    }
    return m + bad;
}

/* Bulk viscosity, on the forces of the bulk, of blocks that are of one material. */
static void add_viscosity(rg_solver *s, const rg_tile *t, const rg_bulk_args *bulk, size_t begin,
                          size_t end) {
    double b1 = s->input->viscosity.linear, b2 = s->input->viscosity.quadratic,
           speed = rg_material_dilatational(&bulk->material);
    double xi = s->damping * b1;
    rg_viscosity_args args = {.bulk = bulk,
                              .velocity = s->velocity + t->begin * RG_NODE_BLOCK,
                              .linear = b1 * speed,
                              .quadratic = b2 * b2,
                              .damping = xi,
                              .damping_rate = s->damping * b2 * b2 / speed,
                              .allowed = sqrt(1 + xi * xi) - xi,
                              .dt = s->dt,
                              .heat = s->heat + t->begin * RG_LANES};
    s->kernels->viscosity(&args, begin, end);
}

static rg_interface_args interfaces_of(const rg_solver *s, const rg_tile *t, const rg_workspace *w,
                                       const impulse *p) {
    rg_interface_args args = rg_tile_interfaces(s, t, w);
    args.law.strength = p->hold ? INFINITY : args.law.strength;
    if (p->stretch > 0) {
        args.law.strength *= p->stretch;
        args.law.opening *= p->stretch;
        args.law.separation *= p->stretch;
    }
    return args;
}

/* The element sweep: elements and the interfaces inside; what they compute stays in the cache. */
static void element_sweep(rg_solver *s, size_t tile, const rg_workspace *w, const impulse *p) {
    const rg_tile *t = &s->domain->tile[tile];
    size_t blocks = rg_tile_eblocks(t);
    rg_bulk_args bulk = rg_tile_bulk(s, t, w, 0);
    bulk.advance = p->advance;
    rg_interface_args interface = interfaces_of(s, t, w, p);
    rg_trace_args traces = rg_tile_traces(s, t, w, false);
    rg_ahead_of_elements(s, t);
    if (p->constrain) {
        rg_heating_tile(s, tile);
    }
    if (p->apart) {
        memset(p->velocity + t->begin * RG_NODE_BLOCK, 0, blocks * RG_NODE_BLOCK * sizeof *p->velocity);
    }
    s->kernels->receive(&traces, 0, rg_tile_face_blocks(t));
    for (size_t begin = 0, end; begin < blocks; begin = end) {
        end = rg_run_end(s->domain, t, begin);
        bulk.material = *rg_block_ready(s, t, begin);
        s->kernels->bulk(&bulk, begin, end);
        if (s->prestress != NULL) {
            rg_prestress_args before = {&bulk, s->prestress + t->begin * RG_PRESTRESS_BLOCK};
            s->kernels->prestress(&before, begin, end);
        }
        if (s->heat != NULL && p->constrain) {
            add_viscosity(s, t, &bulk, begin, end);
        }
    }
    s->kernels->send_tractions(&traces, 0, rg_tile_face_blocks(t));
    s->kernels->interface(&interface, 0, rg_tile_inner_blocks(t));
    mark_cracked(s, t, t->ibegin, t->sbegin);
    if (p->constrain) {
        rg_loads_find(s->loads, tile, s);
        rg_absorbing_note(s->absorbing, tile, s->velocity);
    }
    tile_kick(s, tile, w, p, RG_SWEEP_ELEMENT);
    if (p->constrain) {
        push(s, tile, p);
    } else if (p->load) {
        rg_loads_find(s->loads, tile, s);
        rg_loads_push(s->loads, tile, &(rg_push){p->dt, 0, p->velocity, NULL});
        rg_bodies_touch(s->bodies, tile, s->u, &(rg_push){p->dt, 0, p->velocity, NULL}, s->body_clear);
    }
    s->tile_stiffening[tile] = largest(bulk.stiffening, blocks * RG_LANES);
}

static void tile_drift(rg_solver *s, size_t tile, const rg_workspace *w) {
    const rg_tile *t = &s->domain->tile[tile];
    size_t at = t->begin * RG_NODE_BLOCK;
    rg_drift_args args = {s->dt_next, s->velocity + at, s->u + at};
    s->kernels->drift(&args, 0, rg_tile_eblocks(t));
    rg_constraints_drift(s->constraints, tile, s->u);
    rg_ties_drift(s->ties, tile, s->time, s->dt_next, s->u);
    if (s->contacts != NULL) {
        rg_contacts_place(s->contacts, tile, s->u, s->velocity, s->contact_sunk);
        rg_contacts_settle(s->contacts, tile, 0.5 * s->dt_next, s->contact_heat);
    }
    rg_trace_args traces = rg_tile_traces(s, t, w, true);
    s->kernels->send(&traces, 0, rg_tile_face_blocks(t));
}

/* The velocities of a tile are complete. */
static void tile_finish(rg_solver *s, size_t tile, const rg_workspace *w, const impulse *p) {
    if (p->constrain) {
        rg_ties_kick(s->ties, tile, s->time, s->dt, s->dt_next, p->velocity, step_velocity_of(s, tile, p));
        rg_loads_book(s->loads, tile, s->u, p->velocity);
        rg_absorbing_book(s->absorbing, tile, p->velocity);
    }
    if (s->watched[tile] && p->constrain) {
        s->watch(s->watch_context, s, tile, w);
    }
    if (p->move) {
        tile_drift(s, tile, w);
    }
}

/* So they are but for what bodies do to nodes tied to them, which takes all tiles (finish_tied). */
static void tile_complete(rg_solver *s, size_t tile, const rg_workspace *w, const impulse *p) {
    if (p->constrain) {
        rg_push damp = {p->dt, 0.5 * s->dt, p->velocity, step_velocity_of(s, tile, p)};
        rg_absorbing_damp(s->absorbing, tile, &damp);
        rg_constraints_kick(s->constraints, tile, s->u, p->velocity, step_velocity_of(s, tile, p));
        rg_ties_gather(s->ties, tile, s->time, s->u, p->velocity, step_velocity_of(s, tile, p));
    }
    if (!(p->constrain && rg_ties_any(s->ties))) {
        tile_finish(s, tile, w, p);
    }
}

/* The boundary sweep: tile-boundary faces, once the tractions of all tiles are known. */
static void boundary_sweep(rg_solver *s, size_t tile, const rg_workspace *w, const impulse *p) {
    const rg_tile *t = &s->domain->tile[tile];
    rg_interface_args interface = interfaces_of(s, t, w, p);
    rg_ahead_of_boundary(s, t);
    rg_tile_receive(s, t, w);
    s->kernels->interface(&interface, rg_tile_inner_blocks(t), rg_tile_iblocks(t));
    mark_cracked(s, t, t->sbegin, t->iend);
    if (s->tile_opening_rate != NULL && p->constrain) {
        s->tile_opening_rate[tile] = rg_tile_opening_rate(s, t);
    }
    tile_kick(s, tile, w, p, RG_SWEEP_BOUNDARY);
    if (s->contacts != NULL && p->constrain) {
        rg_push k = {p->dt, 0.5 * s->dt, p->velocity, step_velocity_of(s, tile, p)};
        rg_contact_record to = {s->contact_impulse, s->contact_heat, s->contact_touches, s->contact_touching,
                                s->contact_sunk};
        rg_contacts_push(s->contacts, tile, &k, 0.5 * (s->dt + s->dt_next), &to);
        rg_contact_forces_book(s->contact_forces, s->contacts, tile);
    }
    if (p->apart) {
        rg_assembly_sum(s->assembly, tile, p->velocity);
    } else {
        tile_complete(s, tile, w, p);
    }
}

/* The nodes that tiles share, once the sums of all of them are known; then the velocities. */
static void assemble(rg_solver *s, size_t tile, const rg_workspace *w, const impulse *p) {
    const rg_tile *t = &s->domain->tile[tile];
    size_t at = t->begin * RG_NODE_BLOCK, blocks = rg_tile_eblocks(t);
    rg_real *a = s->acceleration, *now = step_velocity_of(s, tile, p);
    rg_assembly_gather(s->assembly, tile, a);
    if (now != NULL) {
        memcpy(now + at, p->velocity + at, blocks * RG_NODE_BLOCK * sizeof *now);
        s->kernels->drift(&(rg_drift_args){0.5 * s->dt, a + at, now + at}, 0, blocks);
    }
    s->kernels->drift(&(rg_drift_args){p->dt, a + at, p->velocity + at}, 0, blocks);
    if (s->watched[tile]) {
        rg_tile_receive(s, t, w);
    }
    tile_complete(s, tile, w, p);
}

static void assemble_ready(rg_solver *s, size_t tile, const rg_workspace *w, const impulse *p) {
    if (!rg_assembly_waits(s->assembly, tile)) {
        assemble(s, tile, w, p);
    }
}

static void assemble_waiting(rg_solver *s, size_t tile, const rg_workspace *w, const impulse *p) {
    if (rg_assembly_waits(s->assembly, tile)) {
        assemble(s, tile, w, p);
    }
}

/* ---- Sweeps (inside a parallel region) ---- */

typedef void tile_work(rg_solver *s, size_t tile, const rg_workspace *w, const impulse *p);

static void sweep(rg_solver *s, tile_work *work, const impulse *p, size_t begin, size_t end, rg_halo *under) {
    const rg_workspace *w = &s->work[omp_get_thread_num()];
#pragma omp for schedule(static)
    for (size_t t = begin; t < end; t++) {
        double before = s->tile_seconds != NULL ? omp_get_wtime() : 0;
        work(s, t, w, p);
        if (s->tile_seconds != NULL) {
            s->tile_seconds[t] += omp_get_wtime() - before;
        }
        if (under != NULL && omp_get_thread_num() == 0) {
            rg_halo_poll(under);
        }
    }
}

static void mark(rg_solver *s, rg_phase phase) {
#pragma omp master
    rg_phases_mark(&s->phases, phase);
}

static void start(rg_solver *s, rg_halo *h) {
    rg_halo_pack(h);
    mark(s, RG_PHASE_PACK);
#pragma omp master
    rg_halo_start(h);
    mark(s, RG_PHASE_EXCHANGE);
}

static void finish(rg_solver *s, rg_halo *h) {
#pragma omp master
    rg_halo_finish(h);
    mark(s, RG_PHASE_WAIT);
#pragma omp barrier
}

/* The largest stiffening of all ranks, for a time step to come: known when the sweeps are over. */
static void start_stiffening(rg_solver *s) {
#pragma omp master
    {
        double here = largest(s->tile_stiffening, s->domain->tiles);
        s->stepper->here[0] = isfinite(here) ? here : INFINITY;
        s->stepper->here[1] = rg_interrupt_request();
        s->stepper->here[2] = s->contacts != NULL ? rg_contacts_moved(s->contacts) : 0;
        s->stepper->here[3] = s->stepper->separated;
        s->stepper->here[4] = s->contacts != NULL ? rg_contacts_omega2_now(s->contacts) : 0;
        s->stepper->here[5] = s->contacts != NULL ? rg_bodies_omega2_now(s->bodies) : 0;
        s->stepper->here[6] = s->loads != NULL ? rg_loads_omega2_now(s->loads) : 0;
        MPI_Iallreduce(s->stepper->here, s->stepper->anywhere, RG_STEP_MOSTS, MPI_DOUBLE, MPI_MAX, s->comm,
                       &s->stepper->stiffening_request);
    }
    mark(s, RG_PHASE_REDUCE);
}

/* The forces on the bodies, likewise. */
static void start_bodies(rg_solver *s, const impulse *p) {
#pragma omp master
    if (p->constrain) {
        rg_bodies_sum(s->bodies);
    }
    mark(s, RG_PHASE_REDUCE);
}

/* Rows of faces in contact travel with the traces. */
static void start_traces(rg_solver *s, rg_halo *traces) {
    start(s, traces);
    if (s->contacts != NULL) {
        start(s, rg_contacts_halo(s->contacts));
    }
}

static void finish_traces(rg_solver *s, rg_halo *traces) {
    finish(s, traces);
    if (s->contacts != NULL) {
        finish(s, rg_contacts_halo(s->contacts));
    }
}

/* Forces between fragments, and how many pairs of faces touch on all ranks. */
static void meet(rg_solver *s, const impulse *p) {
    if (s->contacts == NULL || !p->constrain || !rg_contacts_any(s->contacts)) {
        return;
    }
    rg_contacts_meet(s->contacts, s->kernels, s->dt > 0 ? s->dt : s->dt_next);
#pragma omp master
    {
        s->stepper->touching = rg_contacts_touching(s->contacts);
        MPI_Iallreduce(&s->stepper->touching, &s->stepper->touching_anywhere, 1, MPI_INT64_T, MPI_SUM,
                       s->comm, &s->stepper->touching_request);
    }
    mark(s, RG_PHASE_COMPUTE);
}

static void finish_meeting(rg_solver *s) {
    MPI_Wait(&s->stepper->touching_request, MPI_STATUS_IGNORE);
    if (s->stepper->touching_anywhere > s->contacts_most) {
        s->contacts_most = s->stepper->touching_anywhere;
    }
}

/* Shared nodes, from what the elements made for themselves; rows of other ranks arrive under the tiles that
 * share no node with them. */
static void assemble_all(rg_solver *s, const impulse *p) {
    rg_halo *rows = rg_assembly_halo(s->assembly);
    start(s, rows);
    sweep(s, assemble_ready, p, 0, s->domain->tiles, rows);
    mark(s, RG_PHASE_JUMP);
    finish(s, rows);
    sweep(s, assemble_waiting, p, 0, s->domain->tiles, NULL);
    mark(s, RG_PHASE_JUMP);
}

static void tile_finish_tied(rg_solver *s, size_t tile, const rg_workspace *w, const impulse *p) {
    if (s->watched[tile]) {
        rg_tile_receive(s, &s->domain->tile[tile], w);
    }
    tile_finish(s, tile, w, p);
}

/* The bodies with what is tied to them, and that with them. */
static void finish_tied(rg_solver *s, const impulse *p) {
    if (!p->constrain || !rg_ties_any(s->ties)) {
        return;
    }
#pragma omp master
    {
        rg_ties_close(s->ties, s->time);
        rg_bodies_kick(s->bodies, s->time, s->dt, s->dt_next);
    }
#pragma omp barrier
    mark(s, RG_PHASE_REDUCE);
    sweep(s, tile_finish_tied, p, 0, s->domain->tiles, NULL);
    mark(s, RG_PHASE_JUMP);
}

/* With what contact between fragments adds: the most it has so far. A step that came and went with each touch
 * would cost energy at every change. And with what pressures add at present. */
static double stiffened(rg_solver *s, double stiffening) {
    double bodies = s->contacts != NULL ? s->stepper->anywhere[5] + s->bodies->born_omega2 : 0;
    double now = s->stepper->anywhere[4] + bodies;
    s->contact_omega2 = fmax(s->contact_omega2, now);
    double added = s->contact_omega2 + s->stepper->anywhere[6];
    return added > 0 && s->omega2 > 0 ? fmax(stiffening, 1) + added / s->omega2 : stiffening;
}

/* All forces. The traces of the displacement, sent at the end of the last drift, arrive under the first sweep
 * of the tiles that touch no other rank; the tractions under the second. */
static void evaluate(rg_solver *s, const impulse *whole) {
    impulse apart = *whole;
    const impulse *p = whole;
    if (s->assembly != NULL) {
        apart.velocity = s->acceleration;
        apart.dt = 1;
        apart.apart = true;
        p = &apart;
    }
    size_t outer = s->domain->boundary_tiles, all = s->domain->tiles;
    rg_halo *traces = s->stepper->halo_u[s->stepper->current],
            *next = s->stepper->halo_u[1 - s->stepper->current];
    rg_phases_begin(&s->phases);
#pragma omp parallel
    {
        sweep(s, element_sweep, p, outer, all, traces);
        mark(s, RG_PHASE_COMPUTE);
        finish_traces(s, traces);
        sweep(s, element_sweep, p, 0, outer, NULL);
        mark(s, RG_PHASE_COMPUTE);
        start(s, s->stepper->halo_t);
        meet(s, p);
        start_stiffening(s);
        start_bodies(s, p);
        sweep(s, boundary_sweep, p, outer, all, s->stepper->halo_t);
        mark(s, RG_PHASE_JUMP);
        finish(s, s->stepper->halo_t);
        sweep(s, boundary_sweep, p, 0, outer, NULL);
        mark(s, RG_PHASE_JUMP);
        if (s->assembly != NULL) {
            assemble_all(s, whole);
        }
        finish_tied(s, whole);
        if (p->move) {
            start_traces(s, next);
        }
    }
    MPI_Wait(&s->stepper->stiffening_request, MPI_STATUS_IGNORE);
    finish_meeting(s);
    s->stop_request = (int)s->stepper->anywhere[1];
    if (s->tile_opening_rate != NULL && p->constrain) {
        rg_step_limiter_agree(s);
    }
    if (p->constrain) {
        if (!rg_ties_any(s->ties)) {
            rg_bodies_kick(s->bodies, s->time, s->dt, s->dt_next);
        }
        rg_account_close(s->account);
    }
    s->stiffening_anywhere = stiffened(s, s->stepper->anywhere[0]);
    rg_phases_mark(&s->phases, RG_PHASE_REDUCE);
}

/* Sends the traces of the current displacement, once those of the last drift have arrived. */
static void publish(rg_solver *s) {
    const rg_domain *d = s->domain;
    rg_halo_finish(s->stepper->halo_u[s->stepper->current]);
    if (s->contacts != NULL) {
        rg_halo_finish(rg_contacts_halo(s->contacts));
    }
#pragma omp parallel
    {
        const rg_workspace *w = &s->work[omp_get_thread_num()];
#pragma omp for schedule(static)
        for (size_t t = 0; t < d->tiles; t++) {
            if (s->contacts != NULL) {
                rg_contacts_place(s->contacts, t, s->u, s->velocity, s->contact_sunk);
            }
            rg_trace_args traces = rg_tile_traces(s, &d->tile[t], w, false);
            s->kernels->send(&traces, 0, rg_tile_face_blocks(&d->tile[t]));
        }
        start_traces(s, s->stepper->halo_u[s->stepper->current]);
    }
}

void rg_solver_impulse(rg_solver *s, rg_real *velocity, double dt) {
    publish(s);
    evaluate(s, &(impulse){.velocity = velocity, .dt = dt});
}

void rg_solver_acceleration(rg_solver *s, rg_real *acceleration, bool loaded, double stretch) {
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < s->domain->blocks * RG_NODE_BLOCK; i++) {
        acceleration[i] = 0;
    }
    if (loaded) {
        rg_loads_set(s->loads, 0, 0, 0);
    } else {
        rg_loads_set_springs(s->loads);
    }
    publish(s);
    bool laws = s->model->law.form == RG_FORM_INTRINSIC;
    evaluate(
        s,
        &(impulse){
            .velocity = acceleration, .dt = 1, .hold = !laws, .stretch = laws ? stretch : 0, .load = true});
    rg_bodies_note(s->bodies);
}

void rg_solver_loads(rg_solver *s, rg_real *acceleration) {
    size_t values = s->domain->blocks * RG_NODE_BLOCK;
    rg_real *springs = RG_NEW(rg_real, values + 1);
    memset(acceleration, 0, values * sizeof *acceleration);
    for (int k = 0; k < 2; k++) {
        if (k == 0) {
            rg_loads_set(s->loads, 0, 0, 0);
        } else {
            rg_loads_set_springs(s->loads);
        }
#pragma omp parallel for schedule(static)
        for (size_t t = 0; t < s->domain->tiles; t++) {
            rg_loads_find(s->loads, t, s);
            rg_loads_push(s->loads, t, &(rg_push){1, 0, k == 0 ? acceleration : springs, NULL});
        }
    }
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < values; i++) {
        acceleration[i] -= springs[i];
    }
    rg_free(springs);
}

void rg_solver_flow(rg_solver *s) {
    publish(s);
    evaluate(s, &(impulse){.velocity = s->step_velocity, .dt = 0, .hold = true, .advance = true});
}

/* ---- Time ---- */

/* The stiffening of the initial state, with faces that cannot break yet. */
static void measure(rg_solver *s) {
    bool hold = s->model->law.form != RG_FORM_INTRINSIC;
    double begin = MPI_Wtime();
    publish(s);
    evaluate(s, &(impulse){.velocity = s->step_velocity, .dt = 0, .hold = hold});
    s->pass_seconds = MPI_Wtime() - begin;
}

/* Finds the pairs that may touch, and lets them meet once: fragments must not lie in each other. */
static void start_contacts(rg_solver *s) {
    rg_exposure_mark(s);
    rg_exposure_take(s);
    rg_exposure_settle(s);
    rg_bodies_expose(s->bodies, s->exposed);
    rg_contacts_search(s->contacts, s->exposed, s->u);
    publish(s);
    rg_halo_finish(rg_contacts_halo(s->contacts));
#pragma omp parallel
    rg_contacts_meet(s->contacts, s->kernels, 0);
    rg_exposure_refuse_overlap(s);
}

void rg_solver_settle(rg_solver *s) {
    rg_constraints_start(s->constraints, s->u, s->velocity, s->comm);
    if (s->contacts != NULL) {
        start_contacts(s);
    }
    rg_loads_set(s->loads, 0, 0, 0);
#pragma omp parallel for schedule(static)
    for (size_t t = 0; t < s->domain->tiles; t++) {
        rg_loads_find(s->loads, t, s); /* what pressures add to the first step */
    }
    rg_loads_weigh(s->loads);
    measure(s);
}

void rg_solver_start(rg_solver *s) {
    rg_initial_fill(s);
    rg_heating_start(s);
    rg_ties_start(s->ties, s->u, s->velocity);
    rg_solver_settle(s);
}

void rg_solver_measure(rg_solver *s) {
    enum { PASSES = 5 };
    double best = INFINITY;
    for (int k = 0; k < PASSES; k++) {
        measure(s);
        best = fmin(best, s->pass_seconds);
    }
    s->pass_seconds = best;
}

void rg_solver_resume(rg_solver *s) {
    const rg_domain *d = s->domain;
    memset(s->active, 0, d->iblocks);
    memset(s->cracked, 0, d->blocks);
    rg_law_open_until(s, s->openings.until);
    for (size_t i = 0; i < d->iblocks * RG_LANES; i++) {
        s->active[i / RG_LANES] |= s->broken[i] != 0;
    }
    for (size_t t = 0; t < d->tiles; t++) {
        mark_cracked(s, &d->tile[t], d->tile[t].ibegin, d->tile[t].iend);
    }
    if (s->contacts != NULL) {
        s->stepper->separated = memchr(s->exposed, RG_SEPARATED, d->iblocks * RG_LANES) != NULL;
        rg_bodies_expose(s->bodies, s->exposed);
        rg_contacts_search(s->contacts, s->exposed, s->u);
    }
    rg_ties_resume(s->ties);
    publish(s);
}

/* What a kick with a step `dt` ahead of it does. */
static impulse prepare(rg_solver *s, double dt) {
    s->dt_next = dt;
    for (int m = 0; s->dt > 0 && m < s->model->materials; m++) {
        rg_material_prepare(&s->stepper->material[m], s->dt);
    }
    rg_constraints_set(s->constraints, s->time, s->dt, dt);
    rg_loads_set(s->loads, s->time, s->dt, dt);
    rg_absorbing_set(s->absorbing, s->dt, dt);
    return (impulse){
        .velocity = s->velocity, .dt = 0.5 * (s->dt + dt), .constrain = true, .advance = s->dt > 0};
}

/* The pairs that may touch, found anew; once new faces count as exposed, how deep these are in others. */
static void search_contacts(rg_solver *s, bool exposed) {
    rg_halo_finish(rg_contacts_halo(s->contacts));
    rg_contacts_search(s->contacts, s->exposed, s->u);
    publish(s);
    if (exposed) {
        rg_halo_finish(rg_contacts_halo(s->contacts));
#pragma omp parallel
        rg_contacts_meet(s->contacts, s->kernels, 0);
        rg_contacts_sink(s->contacts, s->exposed, s->contact_sunk);
        rg_exposure_settle(s);
        rg_bodies_expose(s->bodies, s->exposed);
        publish(s);
    }
}

static void renew_contacts(rg_solver *s) {
    rg_stepper *m = s->stepper;
    bool exposed = m->anywhere[3] > 0;
    if (exposed) {
        rg_exposure_take(s);
        m->separated = false;
    }
    if (exposed || m->anywhere[2] >= 1) {
        search_contacts(s, exposed);
    }
    if (s->step % RG_EXPOSURE_EVERY == 0) {
        m->separated = rg_exposure_mark(s);
    }
}

/* The displacement has moved. */
static void advance(rg_solver *s) {
    rg_bodies_drift(s->bodies, s->dt_next);
    s->stepper->current = 1 - s->stepper->current;
    s->time += s->dt_next;
    s->dt = s->dt_next;
    s->step++;
    if (s->contacts != NULL) {
        renew_contacts(s);
    }
}

void rg_solver_kick(rg_solver *s, double dt) {
    impulse p = prepare(s, dt);
    p.observe = true;
    evaluate(s, &p);
}

void rg_solver_drift(rg_solver *s) {
    const rg_domain *d = s->domain;
    rg_phases_begin(&s->phases);
#pragma omp parallel
    {
        const rg_workspace *w = &s->work[omp_get_thread_num()];
#pragma omp for schedule(static)
        for (size_t t = 0; t < d->tiles; t++) {
            tile_drift(s, t, w);
        }
        mark(s, RG_PHASE_JUMP);
        start_traces(s, s->stepper->halo_u[1 - s->stepper->current]);
    }
    advance(s);
}

void rg_solver_step(rg_solver *s, double dt) {
    if (rg_ties_due(s->ties, s->time)) { /* which asks for velocities at its time */
        rg_solver_kick(s, dt);
        rg_solver_drift(s);
        return;
    }
    impulse p = prepare(s, dt);
    p.move = true;
    evaluate(s, &p);
    advance(s);
}

void rg_solver_exchange(rg_solver *s) {
#pragma omp parallel
    {
        start(s, s->stepper->halo_u[s->stepper->current]);
        finish(s, s->stepper->halo_u[s->stepper->current]);
        start(s, s->stepper->halo_t);
        finish(s, s->stepper->halo_t);
        if (s->assembly != NULL) {
            start(s, rg_assembly_halo(s->assembly));
            finish(s, rg_assembly_halo(s->assembly));
        }
    }
}

int rg_solver_halos(const rg_solver *s, rg_halo *halo[3]) {
    halo[0] = s->stepper->halo_u[0]; /* that of the next state sends as much */
    halo[1] = s->stepper->halo_t;
    if (s->assembly == NULL) {
        return 2;
    }
    halo[2] = rg_assembly_halo(s->assembly);
    return 3;
}
