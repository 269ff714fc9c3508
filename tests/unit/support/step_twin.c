#include "support/step_twin.h"

#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "support/step_twin_geometry.h"

/* ---- Prescribed motion ---- */

static const rg_boundary *holder(const twin *w, size_t e, int n, int c) {
    int b = w->held[3 * (RG_NODES * e + (size_t)n) + (size_t)c];
    return b < 0 ? NULL : &w->input->boundary[b];
}

static double told(const twin *w, const rg_boundary *b, size_t e, int n, double time) {
    double x[3];
    position(w, e, n, x);
    return rg_expr_value(b->value, x, time);
}

/* Solves a symmetric positive definite system in place, x: right side in, solution out. */
static void solve(int n, double a[RG_NODES][RG_NODES], double x[RG_NODES]) {
    for (int k = 0; k < n; k++)
        for (int i = k + 1; i < n; i++) {
            double factor = a[i][k] / a[k][k];
            for (int j = k; j < n; j++)
                a[i][j] -= factor * a[k][j];
            x[i] -= factor * x[k];
        }
    for (int k = n - 1; k >= 0; k--) {
        for (int j = k + 1; j < n; j++)
            x[k] -= a[k][j] * x[j];
        x[k] /= a[k][k];
    }
}

/* Brings the held nodes of component c of an element from `v` to `target`. Impulses act on them alone, so the
 * free ones follow by M_ff dv_f = -M_fc dv_c. Returns the work of the impulses at the mean of `before` and
 * `target`. */
static double correct(const twin *w, size_t e, int c, const double *before, const double *target,
                      rg_real *v) {
    double a[RG_NODES][RG_NODES], change[RG_NODES], x[RG_NODES], work = 0;
    int open[RG_NODES], n = 0;
    double mass = w->material[w->of[e]].density * volume_of(w, e);
    for (int k = 0; k < RG_NODES; k++) {
        rg_real *at = &v[rg_node_index(w->slot[e], k, c)];
        change[k] = holder(w, e, k, c) == NULL ? 0 : target[k] - *at;
        if (holder(w, e, k, c) == NULL)
            open[n++] = k;
        else
            *at = (rg_real)target[k];
    }
    for (int i = 0; i < n; i++) {
        x[i] = 0;
        for (int k = 0; k < RG_NODES; k++)
            x[i] -= w->mass[open[i]][k] * change[k];
        for (int j = 0; j < n; j++)
            a[i][j] = w->mass[open[i]][open[j]];
    }
    solve(n, a, x);
    for (int i = 0; i < n; i++) {
        change[open[i]] = x[i];
        v[rg_node_index(w->slot[e], open[i], c)] += (rg_real)x[i];
    }
    for (int i = 0; i < RG_NODES; i++)
        for (int k = 0; k < RG_NODES && holder(w, e, i, c) != NULL; k++)
            work += mass * w->mass[i][k] * change[k] * (before[i] + target[i]) / 2;
    return work;
}

static void hold(twin *w, size_t e, int c) {
    twin_hold *h = &w->hold[3 * e + (size_t)c];
    double present[RG_NODES] = {0}, target[RG_NODES] = {0}, half = w->dt_next / 2;
    bool any = false;
    for (int n = 0; n < RG_NODES; n++) {
        const rg_boundary *b = holder(w, e, n, c);
        if (b == NULL)
            continue;
        any = true;
        if (b->prescribed == RG_PRESCRIBED_DISPLACEMENT) {
            double next = told(w, b, e, n, w->time + w->dt_next);
            target[n] = (next - h->place[n]) / w->dt_next;
            h->place[n] = next;
            present[n] = (told(w, b, e, n, w->time + half) - told(w, b, e, n, w->time - half)) / w->dt_next;
        } else {
            target[n] = told(w, b, e, n, w->time + half);
            present[n] = told(w, b, e, n, w->time);
        }
    }
    if (any) {
        h->work_now = h->work + correct(w, e, c, h->before, present, w->step_velocity);
        h->work += correct(w, e, c, h->before, target, w->velocity);
        memcpy(h->before, target, sizeof target);
    }
}

/* ---- Rigid bodies ---- */

static double depth(const rg_body_input *in, const twin_body *b, const double at[3], double normal[3]) {
    double r[3], along, length;
    subtract(at, b->x, r);
    along = rg_reference_dot(r, b->direction);
    if (in->shape == RG_SHAPE_PLANE) {
        memcpy(normal, b->direction, sizeof b->direction);
        return -along;
    }
    for (int c = 0; c < 3 && in->shape == RG_SHAPE_CYLINDER; c++)
        r[c] -= along * b->direction[c];
    length = sqrt(rg_reference_dot(r, r));
    for (int c = 0; c < 3; c++)
        normal[c] = r[c] / length;
    return in->radius - length;
}

static bool may_touch(const twin *w, const rg_body_input *in, size_t e, int f) {
    int set = w->mesh->set[4 * e + (size_t)f];
    bool named = in->sets == 0;
    for (int k = 0; k < in->sets; k++)
        named = named || (set >= 0 && strcmp(in->set[k], w->mesh->surface.name[set]) == 0);
    return named && w->mesh->neighbour[4 * e + (size_t)f] < 0;
}

/* Contact of body i with face f of element e: adds to the forces, if they are wanted, and returns the energy.
 */
static double touch(const twin *w, int i, size_t e, int f, rg_real *force, double sum[3]) {
    const rg_body_input *in = &w->input->body[i];
    const rg_material *m = &w->material[w->of[e]];
    double edge[2][3], area[3], size = area_vector(w, e, f, edge, area), energy = 0;
    double kappa = in->penalty * (m->lambda + 2 * m->mu) / (3 * volume_of(w, e) / size);
    for (int q = 0; q < RG_POINTS; q++) {
        double l[3], shape[RG_FNODES], at[3] = {0, 0, 0}, normal[3];
        double weight = rg_reference_face_point(q, l) * size;
        rg_reference_face_shape(l, shape);
        for (int a = 0; a < RG_FNODES; a++) {
            double x[3];
            position(w, e, rg_face_node[f][a], x);
            for (int c = 0; c < 3; c++)
                at[c] += shape[a] * (x[c] + w->u[rg_node_index(w->slot[e], rg_face_node[f][a], c)]);
        }
        double g = depth(in, &w->body[i], at, normal);
        if (g <= 0)
            continue;
        energy += weight * kappa * g * g / 2;
        for (int c = 0; c < 3 && force != NULL; c++) {
            sum[c] -= weight * kappa * g * normal[c];
            for (int a = 0; a < RG_FNODES; a++)
                force[rg_node_index(w->slot[e], rg_face_node[f][a], c)] +=
                    (rg_real)(shape[a] * weight * kappa * g * normal[c]);
        }
    }
    return energy;
}

static double touch_all(const twin *w, rg_real *force) {
    double energy = 0;
    for (int i = 0; i < w->input->bodies; i++) {
        memset(w->body[i].force, 0, force == NULL ? 0 : sizeof w->body[i].force);
        for (size_t e = 0; e < w->elements; e++)
            for (int f = 0; f < RG_FACES; f++)
                if (may_touch(w, &w->input->body[i], e, f))
                    energy += touch(w, i, e, f, force, w->body[i].force);
    }
    return energy;
}

static void kick_body(const twin *w, const rg_body_input *in, twin_body *b) {
    bool moved = in->motion == RG_MOTION_PRESCRIBED;
    b->work_now = b->work;
    memcpy(b->x_now, b->x, sizeof b->x);
    for (int c = 0; c < 3; c++) {
        double before = b->v[c], a = b->force[c] / b->mass;
        b->v_now[c] = moved ? body_velocity(in, c, w->time) : before + w->dt / 2 * a;
        b->v[c] =
            moved ? body_velocity(in, c, w->time + w->dt_next / 2) : before + (w->dt + w->dt_next) / 2 * a;
        b->work_now -= moved ? w->dt / 2 * before * b->force[c] : 0;
        b->work -= moved ? (w->dt * before + w->dt_next * b->v[c]) / 2 * b->force[c] : 0;
    }
}

/* ---- The step ---- */

static rg_bulk_args bulk_args(const twin *w, int m, bool advance) {
    return (rg_bulk_args){.material = w->material[m],
                          .gradient = w->gradient,
                          .u = w->u,
                          .geom = w->geom,
                          .neighbour = w->neighbour,
                          .interface = w->interface,
                          .cracked = w->cracked,
                          .unlinked = w->unlinked,
                          .history = w->history,
                          .history_stride = w->history_stride,
                          .advance = advance,
                          .force = w->force,
                          .traction = w->traction,
                          .stiffening = w->stiffening};
}

static rg_interface_args interface_args(const twin *w) {
    return (rg_interface_args){.law = w->law,
                               .time = w->time,
                               .step = w->dt,
                               .u = w->u,
                               .traction = w->traction,
                               .first_tile_face = w->iblocks,
                               .side = {w->side[0], w->side[1]},
                               .geom = w->igeom,
                               .scale = w->scale,
                               .broken = w->broken,
                               .unlinked = w->unlinked,
                               .active = w->active,
                               .crack = w->crack,
                               .crack_stride = w->crack_stride,
                               .force = w->iforce,
                               .turn = w->turn};
}

static void dampen(twin *w, int m, const rg_bulk_args *bulk) {
    double c = sqrt((w->material[m].lambda + 2 * w->material[m].mu) / w->material[m].density);
    double b1 = w->input->viscosity.linear, b2 = w->input->viscosity.quadratic, xi = w->damping * b1;
    rg_viscosity_args args = {.bulk = bulk,
                              .velocity = w->velocity,
                              .linear = b1 * c,
                              .quadratic = b2 * b2,
                              .damping = xi,
                              .damping_rate = w->damping * b2 * b2 / c,
                              .allowed = 1 / (sqrt(1 + xi * xi) + xi),
                              .dt = w->dt,
                              .heat = w->heat};
    rg_reference_viscosity(&args, w->begin[m], w->begin[m + 1]);
}

/* Accelerations of the elements, each for itself, from all forces. */
static void accelerate(twin *w) {
    memset(w->acceleration, 0, w->blocks * RG_NODE_BLOCK * sizeof(rg_real));
    for (int m = 0; m <= w->input->others; m++) {
        rg_kick_args args = {.density = w->material[m].density,
                             .mass = w->input->mass,
                             .dt = 1,
                             .geom = w->geom,
                             .force = w->force,
                             .iforce = w->iforce,
                             .contact = w->law.contact,
                             .turn = w->turn,
                             .broken = w->broken,
                             .interface = w->interface,
                             .velocity = w->acceleration};
        rg_reference_kick(&args, w->begin[m], w->begin[m + 1]);
    }
}

/* Copies of a node: sum of forces over sum of masses. */
static void share_nodes(twin *w) {
    double *sum = RG_NEW(double, 4 * RG_NODES * w->elements);
    for (int pass = 0; pass < 2; pass++)
        for (size_t k = 0; k < RG_NODES * w->elements; k++) {
            size_t e = k / RG_NODES;
            int n = (int)(k % RG_NODES);
            double mass = w->material[w->of[e]].density * volume_of(w, e) * (n < 4 ? 1.0 / 36 : 4.0 / 27);
            double *of = sum + 4 * w->node[k];
            of[3] += pass == 0 ? mass : 0;
            for (int c = 0; c < 3; c++) {
                rg_real *a = &w->acceleration[rg_node_index(w->slot[e], n, c)];
                of[c] += pass == 0 ? mass * *a : 0;
                *a = pass == 0 ? *a : (rg_real)(of[c] / of[3]);
            }
        }
    rg_free(sum);
}

static void evaluate(twin *w, bool advance) {
    for (int m = 0; m <= w->input->others; m++) {
        rg_bulk_args bulk = bulk_args(w, m, advance);
        rg_reference_bulk(&bulk, w->begin[m], w->begin[m + 1]);
        if (w->heat != NULL)
            dampen(w, m, &bulk);
    }
    rg_interface_args interface = interface_args(w);
    rg_reference_interface(&interface, 0, w->iblocks);
    touch_all(w, w->force);
    accelerate(w);
    if (w->joined)
        share_nodes(w);
}

void twin_accelerate(twin *w) {
    evaluate(w, false);
}

void twin_kick(twin *w, double dt) {
    w->dt_next = dt;
    for (int m = 0; m <= w->input->others && w->dt > 0; m++)
        rg_material_prepare(&w->material[m], w->dt);
    evaluate(w, w->dt > 0);
    for (size_t k = 0; k < w->blocks * RG_NODE_BLOCK; k++) {
        w->step_velocity[k] = (rg_real)(w->velocity[k] + w->dt / 2 * w->acceleration[k]);
        w->velocity[k] += (rg_real)((w->dt + dt) / 2 * w->acceleration[k]);
    }
    for (size_t k = 0; k < 3 * w->elements; k++)
        hold(w, k / 3, (int)(k % 3));
    for (int i = 0; i < w->input->bodies; i++)
        kick_body(w, &w->input->body[i], &w->body[i]);
}

void twin_drift(twin *w) {
    for (size_t k = 0; k < w->blocks * RG_NODE_BLOCK; k++)
        w->u[k] += (rg_real)(w->dt_next * w->velocity[k]);
    for (int i = 0; i < w->input->bodies; i++)
        for (int c = 0; c < 3; c++)
            w->body[i].x[c] += w->dt_next * w->body[i].v[c];
    w->time += w->dt_next;
    w->dt = w->dt_next;
    w->step++;
}

/* ---- The ledger ---- */

void twin_bulk_energies(const twin *w, double *energy) {
    for (int m = 0; m <= w->input->others; m++) {
        rg_bulk_args bulk = bulk_args(w, m, false);
        rg_bulk_state_args state = {.bulk = &bulk, .energy = energy + w->begin[m] * RG_LANES};
        rg_reference_bulk_state(&state, w->begin[m], w->begin[m + 1]);
    }
}

static void add_released(const twin *w, size_t e, rg_energy *sum) {
    int history = rg_material_history(w->material[w->of[e]].model);
    if (history > 0) {
        size_t at = rg_history_index(w->slot[e], w->history_stride, (size_t)(RG_GAUSS * history));
        sum->plastic += w->history[at + RG_RELEASED_PLASTIC * RG_LANES];
        sum->damage += w->history[at + RG_RELEASED_DAMAGE * RG_LANES];
    }
}

static void add_elements(const twin *w, rg_energy *sum) {
    double *bulk = RG_NEW(double, w->blocks *RG_LANES), *kinetic = RG_NEW(double, w->blocks *RG_LANES),
           *kick = RG_NEW(double, w->blocks *RG_LANES);
    rg_real *change = RG_NEW(rg_real, w->blocks * RG_NODE_BLOCK);
    twin_bulk_energies(w, bulk);
    rg_kinetic_args args = {1, w->input->mass, w->geom, w->step_velocity, kinetic};
    rg_reference_kinetic(&args, 0, w->blocks);
    for (size_t i = 0; i < w->blocks * RG_NODE_BLOCK; i++)
        change[i] = (rg_real)(fmax(w->dt, w->dt_next) / w->dt_next) * (w->velocity[i] - w->step_velocity[i]);
    args.velocity = change;
    args.energy = kick;
    rg_reference_kinetic(&args, 0, w->blocks);
    for (size_t e = 0; e < w->elements; e++) {
        sum->half_kick += w->material[w->of[e]].density * kick[w->slot[e]];
        sum->bulk += bulk[w->slot[e]];
        sum->kinetic += w->material[w->of[e]].density * kinetic[w->slot[e]];
        sum->viscous += w->heat == NULL ? 0 : w->heat[w->slot[e]];
        add_released(w, e, sum);
    }
    rg_free(bulk);
    rg_free(kinetic);
    rg_free(kick);
    rg_free(change);
}

static void add_momentum(const twin *w, rg_energy *sum) {
    for (size_t k = 0; k < w->elements * RG_NODES * RG_NODES; k++) {
        size_t e = k / (RG_NODES * RG_NODES);
        int a = (int)(k % (RG_NODES * RG_NODES)) / RG_NODES, b = (int)(k % RG_NODES);
        double x[3], v[3], turn[3], mass = w->material[w->of[e]].density * volume_of(w, e) * w->mass[a][b];
        position(w, e, a, x);
        for (int c = 0; c < 3; c++) {
            x[c] += w->u[rg_node_index(w->slot[e], a, c)];
            v[c] = mass * w->step_velocity[rg_node_index(w->slot[e], b, c)];
            sum->momentum[c] += v[c];
        }
        rg_reference_cross(x, v, turn);
        for (int c = 0; c < 3; c++)
            sum->angular_momentum[c] += turn[c];
    }
}

static void add_cracks(const twin *w, rg_energy *sum) {
    double *energy = RG_NEW(double, w->iblocks *RG_E_INTERFACE *RG_LANES);
    rg_interface_args interface = interface_args(w);
    rg_reference_interface_state(&(rg_interface_state_args){&interface, energy}, 0, w->iblocks);
    double *part[] = {&sum->penalty, &sum->cohesive, &sum->contact, &sum->dissipated, &sum->unresolved};
    for (size_t k = 0; k < w->iblocks * RG_E_INTERFACE * RG_LANES; k++)
        *part[k / RG_LANES % RG_E_INTERFACE] += energy[k];
    for (size_t e = 0; e < w->elements; e++)
        for (int f = 0; f < RG_FACES; f++) {
            size_t i = (size_t)w->face[4 * e + (size_t)f];
            double edge[2][3], area[3], l[3], size = area_vector(w, e, f, edge, area);
            for (int q = 0; q < RG_POINTS && speaks(w, e, f) && w->face[4 * e + (size_t)f] >= 0; q++) {
                double parts = w->law.separation;
                parts *= w->scale == NULL ? 1 : w->scale[(i / RG_LANES * 2 + 1) * RG_LANES + i % RG_LANES];
                double largest = w->crack[i / RG_LANES * w->crack_stride +
                                          rg_crack_index(i % RG_LANES, q, RG_CRACK_OPENING)];
                bool broken = (w->broken[i] >> q & 1) != 0, failed = broken && largest >= parts;
                double here = rg_reference_face_point(q, l) * size;
                sum->broken_area += (w->law.form == RG_FORM_INTRINSIC ? failed : broken) ? here : 0;
                sum->failed_area += failed ? here : 0;
                if (broken && w->law.sliding == RG_SLIDING_COULOMB)
                    sum->friction += w->crack[rg_friction_index(i, q, RG_FRICTION_HEAT, w->crack_stride)];
            }
        }
    rg_free(energy);
}

double twin_first_fracture(const twin *w) {
    double first = INFINITY;
    for (size_t k = 0; k < w->interfaces * RG_POINTS; k++) {
        size_t i = k / RG_POINTS, block = i / RG_LANES * w->crack_stride;
        int q = (int)(k % RG_POINTS);
        double parts = w->law.separation;
        parts *= w->scale == NULL ? 1 : w->scale[(i / RG_LANES * 2 + 1) * RG_LANES + i % RG_LANES];
        bool broken = (w->broken[i] >> q & 1) != 0;
        if (w->law.form == RG_FORM_INTRINSIC)
            broken = w->crack[block + rg_crack_index(i % RG_LANES, q, RG_CRACK_OPENING)] >= parts;
        if (broken)
            first = fmin(first, w->crack[block + rg_crack_index(i % RG_LANES, q, RG_CRACK_TIME)]);
    }
    return first;
}

rg_energy twin_energy(const twin *w) {
    rg_energy sum = {.step = w->step, .time = w->time};
    add_elements(w, &sum);
    add_momentum(w, &sum);
    add_cracks(w, &sum);
    sum.contact += touch_all(w, NULL);
    double longer = w->dt > w->dt_next && w->dt_next > 0 ? w->dt / w->dt_next : 1;
    for (size_t k = 0; k < 3 * w->elements; k++)
        sum.external += w->hold[k].work_now;
    for (int i = 0; i < w->input->bodies; i++) {
        const twin_body *b = &w->body[i];
        double turn[3];
        bool moved = w->input->body[i].motion == RG_MOTION_PRESCRIBED;
        sum.external += b->work_now;
        rg_reference_cross(b->x, b->v_now, turn);
        for (int c = 0; c < 3 && !moved; c++) {
            sum.bodies += b->mass * b->v_now[c] * b->v_now[c] / 2;
            sum.half_kick += b->mass * pow(longer * (b->v[c] - b->v_now[c]), 2) / 2;
            sum.momentum[c] += b->mass * b->v_now[c];
            sum.angular_momentum[c] += b->mass * turn[c];
        }
    }
    sum.total = sum.kinetic + sum.bodies + sum.bulk + sum.penalty + sum.cohesive + sum.contact +
                sum.dissipated + sum.plastic + sum.damage + sum.viscous + sum.friction + sum.unresolved -
                sum.half_kick - sum.external;
    return sum;
}
