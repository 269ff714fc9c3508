/* Contact of debris drawn at random, against all pairs of faces of the whole mesh, with the faces that stand
 * for them by quadrature and the forces by their virtual work, on any number of ranks; with friction, from
 * one state to the next, over searches and a checkpoint; with damping. Prints TAP from rank 0. */
#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "contact/contact.h"
#include "domain/element.h"
#include "partition/material.h"
#include "reference/reference.h"
#include "solver/exposure.h"
#include "solver/tile.h"
#include "support/near.h"
#include "support/random_state.h"
#include "support/tap_memory.h"

enum { SEED = 41 };
static const double DT = 3e-9, DT_NOW = 1.1e-9;

/* As contact.c has them: of the height of an element. */
static const rg_search by = {.penalty = 4, .skin = 2e-3, .reach = 0.5};
static const double FAT = 0.2;

/* ---- What is drawn besides the state ---- */

static uint8_t drawn_exposure(rg_gid face) {
    double x = drawn(SEED, DRAW_OTHER, face, 0);
    return x < -0.6 ? RG_UNEXPOSED : x < -0.4 ? RG_SEPARATED : x < 0.5 ? RG_EXPOSED : RG_NEWLY_EXPOSED;
}

/* Of a side, by the number of its face (m). */
static double drawn_sunk(rg_gid side) {
    double x = drawn(SEED, DRAW_OTHER, side, 1);
    return x < 0 ? 0 : 8e-6 * x;
}

/* ---- The faces of the whole mesh ---- */

typedef struct {
    rg_exposed_face is;
    bool newly;
    double sunk, mean[RG_FNODES][3]; /* part of each node in the corners, in the order of the face's nodes */
    int order[3];                    /* corner i, of the face's nodes */
    double rate[2][9];               /* of the corners, before the kick and after it (m/s) */
    double impedance;                /* of its solid (Pa s/m) */
} body_face;

typedef double nodal[RG_NODES][3];

typedef double grip[RG_GRIP];

typedef struct {
    int faces, pairs, touching;
    body_face *face;
    double fat, energy, *depth_of; /* [face]: beyond the skin (m) */
    double *pressed;               /* [face]: largest stiffness of pairs that touch (Pa/m) */
    nodal *force;                  /* [element] (N) */
    double *felt;                  /* [element]: sum of the sizes (N) */
    grip *grips;                   /* [face][face], or NULL: no friction */
    double *heat;                  /* [element] (J) */
    double damping, *settled;      /* (s/m), [element]: and its heat in the half step after the kick (J) */
    char words[200];
} twin;

/* u^ of a unit displacement of each node: int l_i (u^ - u) = 0 by a rule of degree 4. */
static void project(double mean[RG_FNODES][3]) {
    memset(mean, 0, RG_FNODES * sizeof *mean);
    for (int q = 0; q < RG_POINTS; q++) {
        double l[3], N[RG_FNODES], weight = rg_reference_face_point(q, l);
        rg_reference_face_shape(l, N);
        for (int n = 0; n < RG_FNODES; n++) {
            for (int i = 0; i < 3; i++) { /* inverse of (I + 1 1')/12: 12 (I - 1 1'/4), and sum l = 1 */
                mean[n][i] += 12 * weight * (l[i] - 0.25) * N[n];
            }
        }
    }
}

/* (b - a) x (c - a). */
static void twice_area(const double a[3], const double b[3], const double c[3], double out[3]) {
    double p[3], q[3];
    for (int k = 0; k < 3; k++) {
        p[k] = b[k] - a[k];
        q[k] = c[k] - a[k];
    }
    rg_reference_cross(p, q, out);
}

/* Which state it is, and how far elements have got since the first (m). */
static int moves;

static double moved_u(rg_gid e, int node, int c) {
    double u = drawn_u(SEED, e, node, c);
    for (int i = 1; i <= moves; i++) {
        u = (double)(rg_real)(u + 1e-6 * drawn(SEED + (uint64_t)i, DRAW_OTHER, e, 10 + c));
    }
    return u;
}

/* Corners by ascending place in the element, the last two exchanged where they would run round the inward
 * normal. */
static body_face make_face(const random_state *r, rg_gid e, int k) {
    double x[4][3], normal[3];
    mesh_corners(r->mesh, e, x);
    rg_gid inner = face_key(r->mesh, e, k);
    const rg_material *m = &r->solver->model->material[mesh_material(r, e)];
    body_face f = {.is = {.id = 4 * e + k,
                          .former = inner >= 0,
                          .modulus = rg_material_modulus(m),
                          .material = mesh_material(r, e),
                          .shear = m->mu},
                   .newly = inner >= 0 && drawn_exposure(inner) == RG_NEWLY_EXPOSED,
                   .sunk = inner >= 0 ? drawn_sunk(4 * e + k) : 0,
                   .order = {0, 1, 2},
                   .impedance = sqrt(m->density * rg_material_modulus(m))};
    const int *node = rg_face_node[k];
    int opposite = 6 - node[0] - node[1] - node[2];
    twice_area(x[node[0]], x[node[1]], x[node[2]], normal);
    double out = 0, area = sqrt(rg_reference_dot(normal, normal)) / 2;
    for (int c = 0; c < 3; c++) {
        out += normal[c] * (x[node[0]][c] - x[opposite][c]);
    }
    if (out < 0) {
        f.order[1] = 2;
        f.order[2] = 1;
    }
    f.is.height = 3 * tet_volume(x) / area;
    project(f.mean);
    for (int i = 0; i < 3; i++) {
        for (int c = 0; c < 3; c++) {
            double sum = 0;
            for (int n = 0; n < RG_FNODES; n++) {
                double part = f.mean[n][f.order[i]];
                sum += part * moved_u(e, node[n], c);
                f.rate[0][3 * i + c] += part * drawn_velocity(SEED, e, node[n], c);
                f.rate[1][3 * i + c] += part * drawn_now(SEED, e, node[n], c);
            }
            f.is.rest[3 * i + c] = x[node[f.order[i]]][c];
            f.is.corner[3 * i + c] = f.is.rest[3 * i + c] + sum;
        }
    }
    return f;
}

static void list_faces(const random_state *r, twin *t) {
    t->face = RG_NEW(body_face, 4 * (size_t)r->mesh->elements);
    for (rg_gid k = 0; k < 4 * r->mesh->elements; k++) {
        rg_gid inner = face_key(r->mesh, k / 4, (int)(k % 4));
        if (inner < 0 || drawn_exposure(inner) >= RG_EXPOSED) {
            t->face[t->faces++] = make_face(r, k / 4, (int)(k % 4));
            t->fat += FAT * t->face[t->faces - 1].is.height;
        }
    }
    t->fat /= t->faces;
}

/* Adds what the corners of a face feel to the nodes of its element, by the work of their motion. */
static void feel(twin *t, const body_face *f, const double force[9]) {
    rg_gid e = f->is.id / 4;
    double sum[3] = {0, 0, 0};
    for (int i = 0; i < 3; i++) {
        for (int c = 0; c < 3; c++) {
            for (int n = 0; n < RG_FNODES; n++) {
                t->force[e][rg_face_node[f->is.id % 4][n]][c] += f->mean[n][f->order[i]] * force[3 * i + c];
            }
            sum[c] += force[3 * i + c];
        }
    }
    t->felt[e] += sqrt(rg_reference_dot(sum, sum));
}

/* Coulomb's coefficients of glass (0) and steel (1), as the case below has them, until a pair slides and
 * while it does. */
static const double FRICTION[2][2][2] = {{{0.3, 0.1}, {0.2, 0.05}}, {{0.2, 0.05}, {0, 0}}};

/* Work of damping in both half steps: half of it for either element, and what it changes by as a face gets
 * faster for that of the face. */
static void damp(twin *t, const body_face *const f[2], const double drag[18]) {
    double first[2] = {0, 0}, change[2] = {0, 0};
    for (int n = 0; n < 18; n++) {
        first[n / 9] -= DT_NOW * drag[n] * f[n / 9]->rate[0][n % 9];
        change[n / 9] -= DT_NOW * drag[n] * (f[n / 9]->rate[1][n % 9] - f[n / 9]->rate[0][n % 9]);
    }
    for (int k = 0; k < 2; k++) {
        t->heat[f[k]->is.id / 4] += 0.5 * (first[0] + first[1]);
        t->settled[f[k]->is.id / 4] += 0.5 * (first[0] + first[1]) + change[k];
    }
}

static void meet(twin *t, int a, int b, rg_contact_pair *pair) {
    const body_face *const f[2] = {&t->face[a], &t->face[b]};
    double corner[18], box[12], sunk[2] = {f[0]->sunk, f[1]->sunk}, force[18], energy, depth, heat = 0;
    double rate[18], drag[18] = {0}, stiffer = 0;
    const double *friction = FRICTION[f[0]->is.material][f[1]->is.material];
    if (friction[0] > 0) {
        memcpy(pair->friction, friction, sizeof pair->friction);
        pair->shear =
            pair->stiffness * (f[0]->is.shear + f[1]->is.shear) / (f[0]->is.modulus + f[1]->is.modulus);
    }
    for (int k = 0; k < 2; k++) {
        memcpy(corner + 9 * k, f[k]->is.corner, sizeof f[k]->is.corner);
        memcpy(rate + 9 * k, f[k]->rate[0], sizeof f[k]->rate[0]);
        rg_contact_box(corner + 9 * k, box + 6 * k);
        pair->face[k] = k;
    }
    pair->impedance = 0.25 * (f[0]->impedance + f[1]->impedance) / 2;
    rg_contact_args args = {.corner = corner,
                            .box = box,
                            .sunk = sunk,
                            .pair = pair,
                            .force = force,
                            .energy = &energy,
                            .depth = &depth,
                            .grip = t->grips == NULL ? NULL : t->grips[a * t->faces + b],
                            .heat = &heat,
                            .rate = t->damping > 0 ? rate : NULL,
                            .damping = t->damping,
                            .dt = DT,
                            .drag = drag,
                            .stiffer = &stiffer};
    rg_reference_contact(&args, 0, 1);
    t->heat[f[0]->is.id / 4] += 0.5 * heat;
    t->heat[f[1]->is.id / 4] += 0.5 * heat;
    t->depth_of[a] = fmax(t->depth_of[a], depth - pair->skin);
    t->depth_of[b] = fmax(t->depth_of[b], depth - pair->skin);
    if (!(energy > 0)) {
        return;
    }
    if (t->touching++ == 0) {
        double middle[3];
        for (int c = 0; c < 3; c++) {
            middle[c] = (corner[c] + corner[3 + c] + corner[6 + c]) / 3;
        }
        snprintf(t->words, sizeof t->words,
                 "elements %" PRId64 " and %" PRId64 " lie in each other at (%.6g, %.6g, %.6g)",
                 f[0]->is.id / 4, f[1]->is.id / 4, middle[0], middle[1], middle[2]);
    }
    t->energy += energy;
    t->pressed[a] = fmax(t->pressed[a], fmax(pair->stiffness, stiffer));
    t->pressed[b] = fmax(t->pressed[b], fmax(pair->stiffness, stiffer));
    feel(t, f[0], force);
    feel(t, f[1], force + 9);
    damp(t, f, drag);
}

/* grips: as twin.grips, in and out; *grips is made where it is NULL. */
static twin make_twin(const random_state *r, grip **grips, double damping) {
    twin t = {.damping = damping};
    size_t elements = (size_t)r->mesh->elements;
    list_faces(r, &t);
    if (grips != NULL && *grips == NULL) {
        *grips = RG_NEW(grip, (size_t)(t.faces * t.faces));
    }
    t.grips = grips == NULL ? NULL : *grips;
    t.heat = RG_NEW(double, elements);
    t.settled = RG_NEW(double, elements);
    t.depth_of = RG_NEW(double, (size_t)t.faces);
    t.pressed = RG_NEW(double, (size_t)t.faces);
    t.force = RG_NEW(nodal, elements);
    t.felt = RG_NEW(double, elements);
    for (int a = 0; a < t.faces; a++) {
        for (int b = a + 1; b < t.faces; b++) {
            rg_contact_pair pair;
            if (t.face[a].is.id / 4 != t.face[b].is.id / 4 &&
                rg_search_may_touch(&by, &t.face[a].is, &t.face[b].is, &pair)) {
                t.pairs++;
                meet(&t, a, b, &pair);
            }
        }
    }
    return t;
}

static void free_twin(twin *t) {
    void *blocks[] = {t->face, t->depth_of, t->pressed, t->force, t->felt, t->heat, t->settled};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) {
        rg_free(blocks[i]);
    }
}

/* ---- The solver's ---- */

/* Where the solver keeps by how much face k of an element has sunk; NULL on the surface. */
static rg_real *sunk_at(const rg_solver *s, const rg_tile *t, size_t slot, int k, size_t *interface) {
    int32_t link = s->domain->interface[rg_link_index(slot, k)];
    if (link < 0 || rg_surface_has(s->domain, slot, k)) {
        return NULL;
    }
    *interface = t->ibegin * RG_LANES + (size_t)link / 4;
    return &s->contact_sunk[(*interface / RG_LANES * 2 + (size_t)(link % 2)) * RG_LANES +
                            *interface % RG_LANES];
}

typedef void visitor(const random_state *r, rg_real *sunk, size_t interface, rg_gid side, void *context);

/* Visits the sides of the interfaces of elements here. */
static void visit(const random_state *r, visitor *see, void *context) {
    const rg_domain *d = r->solver->domain;
    for (size_t n = 0; n < d->tiles; n++) {
        const rg_tile *t = &d->tile[n];
        for (size_t k = 4 * t->begin * RG_LANES; k < 4 * t->end * RG_LANES; k++) {
            size_t interface = 0;
            rg_gid e = d->id[k / 4];
            rg_real *sunk = e < 0 ? NULL : sunk_at(r->solver, t, k / 4, (int)(k % 4), &interface);
            if (sunk != NULL) {
                see(r, sunk, interface, 4 * e + (rg_gid)(k % 4), context);
            }
        }
    }
}

static void draw_side(const random_state *r, rg_real *sunk, size_t interface, rg_gid side, void *context) {
    (void)context;
    *sunk = (rg_real)drawn_sunk(side);
    r->solver->exposed[interface] = drawn_exposure(face_key(r->mesh, side / 4, (int)(side % 4)));
}

static void place(const random_state *r, bool rub) {
    const rg_solver *s = r->solver;
    for (size_t t = 0; t < s->domain->tiles; t++) {
        rg_contacts_place(s->contacts, t, s->u, s->velocity, s->contact_sunk);
    }
    rg_halo *halo = rg_contacts_halo(s->contacts);
    rg_halo_pack(halo);
    rg_halo_start(halo);
    rg_halo_finish(halo);
#pragma omp parallel
    rg_contacts_meet(s->contacts, s->kernels, rub ? DT : 0);
}

typedef struct {
    const twin *t;
    bool sunk, newly;
} sides;

static const body_face *face_of(const twin *t, rg_gid id, int *at) {
    for (*at = 0; *at < t->faces; ++*at) {
        if (t->face[*at].is.id == id) {
            return &t->face[*at];
        }
    }
    return NULL;
}

/* Lengths of 1e-6 m between corners at 1e-3. */
#define LENGTH 3e-18

static void judge_pushed(const random_state *r, rg_real *sunk, size_t interface, rg_gid side, void *context) {
    sides *of = context;
    int at;
    (void)r, (void)interface;
    const body_face *f = face_of(of->t, side, &at);
    double wanted = drawn_sunk(side);
    if (f != NULL) {
        wanted = fmin(wanted, of->t->depth_of[at]);
    }
    of->sunk = of->sunk && near(*sunk, wanted, LENGTH);
}

static void judge_newly(const random_state *r, rg_real *sunk, size_t interface, rg_gid side, void *context) {
    sides *of = context;
    int at;
    (void)r, (void)interface;
    const body_face *f = face_of(of->t, side, &at);
    of->newly = of->newly && (f == NULL || !f->newly || near(*sunk, of->t->depth_of[at], LENGTH));
}

/* Of forces: where faces lie 1e-8 m in each other, their places of 1e-3 m are known to 1e-11 of that. */
#define ROUNDED 2e-11

/* M dv = dt f, and the impulse, of the elements here. */
static bool pushed_well(const random_state *r, const twin *t, const rg_real *v, double dt) {
    const rg_domain *d = r->solver->domain;
    bool good = true;
    for (size_t slot = 0; good && slot < d->blocks * RG_LANES; slot++) {
        rg_gid e = d->id[slot];
        double x[4][3];
        if (e < 0) {
            continue;
        }
        mesh_corners(r->mesh, e, x);
        double mass = r->solver->model->material[mesh_material(r, e)].density * tet_volume(x);
        for (int k = 0; good && k < 3 * RG_NODES; k++) {
            double found = 0;
            for (int b = 0; b < RG_NODES; b++) {
                found += mass * rg_mass_entry(r->input->mass, k / 3, b) * v[rg_node_index(slot, b, k % 3)];
            }
            good = near(found / dt, t->force[e][k / 3][k % 3], ROUNDED * (t->felt[e] + 1));
        }
    }
    return good;
}

/* found[slot] over `of` is wanted[element], to rounding of the forces over a length. */
static bool values_good(const random_state *r, const twin *t, const double *found, double of,
                        const double *wanted, double length) {
    const rg_domain *d = r->solver->domain;
    bool good = true;
    for (size_t slot = 0; good && slot < d->blocks * RG_LANES; slot++) {
        rg_gid e = d->id[slot];
        good = e < 0 || near(found[slot] / of, wanted[e], ROUNDED * (t->felt[e] + 1) * length);
    }
    return good;
}

static bool touches_good(const random_state *r, const twin *t) {
    const rg_domain *d = r->solver->domain;
    bool good = true;
    for (size_t slot = 0; good && slot < d->blocks * RG_LANES; slot++) {
        bool touches = d->id[slot] >= 0 && t->felt[d->id[slot]] > 0;
        good = r->solver->contact_touches[slot] == touches &&
               r->solver->contact_touching[slot] == (touches ? RG_TOUCH_AFRESH : 0);
    }
    return good;
}

/* Force on the elements here with a number below that, with its moment, and the sum of its sizes. */
static double part_force(const random_state *r, const twin *t, rg_gid below, double force[3],
                         double moment[3]) {
    const rg_domain *d = r->solver->domain;
    double size = 0;
    for (size_t slot = 0; slot < d->blocks * RG_LANES; slot++) {
        rg_gid e = d->id[slot];
        for (int n = 0; e >= 0 && e < below && n < RG_NODES; n++) {
            double x[3], turn[3], *f = t->force[e][n];
            rg_node_position(d->corner + 12 * slot, n, x);
            for (int k = 0; k < 3; k++) {
                x[k] += r->solver->u[rg_node_index(slot, n, k)];
                force[k] += f[k];
                size += fabs(f[k]);
            }
            rg_reference_cross(x, f, turn);
            for (int k = 0; k < 3; k++) {
                moment[k] += turn[k];
            }
        }
    }
    return size;
}

/* Of half of the body: faces by bits, and what each element is told to bear. */
static void check_parts(const random_state *r, const twin *t) {
    const rg_solver *s = r->solver;
    const rg_domain *d = s->domain;
    uint8_t *faces = RG_NEW(uint8_t, d->blocks * RG_LANES + 1);
    double found[6] = {0}, wanted[6] = {0}, pressure = 0;
    rg_gid half = r->mesh->elements / 2;
    double size = part_force(r, t, half, wanted, wanted + 3);
    bool good = true, presses = false;
    for (size_t slot = 0; slot < d->blocks * RG_LANES; slot++) {
        double traction[3];
        rg_gid e = d->id[slot];
        faces[slot] = e >= 0 && e < half ? 15 : 0;
        rg_contacts_traction(s->contacts, slot, &pressure, traction);
        bool touches = e >= 0 && t->felt[e] > 0;
        bool felt = traction[0] != 0 || traction[1] != 0 || traction[2] != 0;
        good = good && felt == (pressure > 0) && (touches || !felt);
        presses = presses || pressure > 0;
    }
    for (size_t n = 0; n < d->tiles; n++) {
        rg_contacts_force(s->contacts, n, &(rg_contact_choice){faces, -1, -1}, found, found + 3);
    }
    for (int k = 0; k < 6; k++) { /* places of 3e-3 m */
        good = good && near(found[k], wanted[k], ROUNDED * (size + 1) * (k < 3 ? 1 : 3e-3));
    }
    report(good && presses, "contact", "force on a part of the solid, and its moment");
    rg_free(faces);
}

static void check_forces(const random_state *r, const twin *t, const char *of) {
    const rg_solver *s = r->solver;
    size_t slots = s->domain->blocks * RG_LANES, values = 3 * RG_NODES * slots;
    rg_real *v = RG_NEW(rg_real, values), *w = RG_NEW(rg_real, values);
    double *impulse = RG_NEW(double, slots), *heat = t->grips == NULL ? NULL : RG_NEW(double, slots);
    rg_push push = {.dt = DT, .dt_now = DT_NOW, .velocity = v, .step_velocity = w};
    rg_contact_record to = {impulse, heat, s->contact_touches, s->contact_touching, s->contact_sunk};
    for (size_t n = 0; n < s->domain->tiles; n++) {
        rg_contacts_push(s->contacts, n, &push, DT, &to);
    }
    report(pushed_well(r, t, v, DT) && pushed_well(r, t, w, DT_NOW), of, "forces on elements");
    report(values_good(r, t, impulse, DT, t->felt, 1), of, "impulse");
    if (t->grips == NULL) {
        report(touches_good(r, t), of, "elements that begin to touch");
        for (size_t n = 0; n < s->domain->tiles; n++) {
            rg_contacts_push(s->contacts, n, &push, DT, &to);
        }
        report(touches_good(r, t), of, "and go on to");
    }
    if (heat != NULL) {
        report(values_good(r, t, heat, 1, t->heat, 1e-6), of, "heat");
    }
    rg_free(heat);
    rg_free(impulse);
    rg_free(v);
    rg_free(w);
}

static void check_sums(const random_state *r, const twin *t) {
    const rg_solver *s = r->solver;
    rg_exact_sum energy = {0};
    for (size_t n = 0; n < s->domain->tiles; n++) {
        rg_contacts_energy(s->contacts, n, &energy);
    }
    rg_exact_allreduce(&energy, 1, MPI_COMM_WORLD);
    report(near(rg_exact_value(&energy), t->energy, 1e-13 * t->energy), "contact", "energy, each pair once");
    int64_t touching = rg_contacts_touching(s->contacts);
    MPI_Allreduce(MPI_IN_PLACE, &touching, 1, MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD);
    report(touching == t->touching && touching > 100 && rg_contacts_any(s->contacts), "contact",
           "pairs that touch");
    char words[200] = "";
    bool told = rg_contacts_overlap(s->contacts, words, sizeof words);
    report(told && strcmp(words, t->words) == 0, "contact", "the lowest pair is told");
}

/* What a face adds to the squared frequency of its element by twice kappa: the largest eigenvalue of
 * Q M^-1 Q' m, m the mass matrix of the corners over the face's mass, by power iteration. */
static double face_omega2(const random_state *r, const body_face *f, double kappa) {
    rg_gid e = f->is.id / 4;
    const int *node = rg_face_node[f->is.id % 4];
    double x[4][3], normal[3], A[3][3] = {{0}}, v[3] = {1, 2, 4}, largest = 0;
    mesh_corners(r->mesh, e, x);
    twice_area(x[node[0]], x[node[1]], x[node[2]], normal);
    for (int k = 0; k < 9 * RG_FNODES * RG_FNODES; k++) {
        int i = k % 3, j = k / 3 % 3, a = k / 9 % RG_FNODES, b = k / 9 / RG_FNODES;
        A[i][j] += f->mean[a][i] * rg_inverse_mass_entry(r->input->mass, node[a], node[b]) * f->mean[b][j];
    }
    for (int pass = 0; pass < 200; pass++) {
        double mv[3], next[3], sum = v[0] + v[1] + v[2];
        for (int i = 0; i < 3; i++) {
            mv[i] = (v[i] + sum) / 12;
        }
        for (int i = 0; i < 3; i++) {
            next[i] = rg_reference_dot(A[i], mv);
        }
        largest = sqrt(rg_reference_dot(next, next) / rg_reference_dot(v, v));
        memcpy(v, next, sizeof v);
    }
    return kappa * sqrt(rg_reference_dot(normal, normal)) * largest / mesh_mass(r, e);
}

/* Largest sums over the faces of an element: of those that are pressed, and of all on the surface. */
static void check_frequencies(const random_state *r, const twin *t) {
    double most = 0, surface = 0, now = rg_contacts_omega2_now(r->solver->contacts);
    for (rg_gid e = 0; e < r->mesh->elements; e++) {
        double pressed = 0, whole = 0;
        for (int i = 0; i < t->faces; i++) {
            const body_face *f = &t->face[i];
            if (f->is.id / 4 == e) {
                pressed += face_omega2(r, f, t->pressed[i]);
                whole += f->is.former ? 0 : face_omega2(r, f, 4 * f->is.modulus / f->is.height);
            }
        }
        most = fmax(most, pressed);
        surface = fmax(surface, whole);
    }
    MPI_Allreduce(MPI_IN_PLACE, &now, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
    report(near(now, most, 1e-12 * most) && most > 0, "contact", "frequency of what is pressed");
    report(near(rg_contacts_omega2(r->solver->contacts), surface, 1e-12 * surface), "contact",
           "frequency if all of the surface were");
}

/* All is moved along y by a part of what faces may move between two searches. */
static void check_moved(const random_state *r, const twin *t) {
    const rg_solver *s = r->solver;
    bool good = near(rg_contacts_moved(s->contacts), 0, 1e-12);
    for (int pass = 1; pass < 3; pass++) {
        for (size_t slot = 0; slot < s->domain->blocks * RG_LANES; slot++) {
            for (int n = 0; n < RG_NODES; n++) {
                s->u[rg_node_index(slot, n, 1)] += (rg_real)(0.1 * t->fat);
            }
        }
        place(r, false);
        good = near(rg_contacts_moved(s->contacts), 0.1 * pass + 2 * 0.1, 1e-10) && good;
    }
    report(good, "contact", "knows how far faces have moved");
}

static void check(void) {
    const char *change[] = {"contact={model: general, penalty: 4}", "bodies=[]"};
    random_state r = random_state_make(2, change, MPI_COMM_WORLD);
    random_state_draw(&r, SEED);
    twin t = make_twin(&r, NULL, 0);
    visit(&r, draw_side, NULL);
    rg_contacts_search(r.solver->contacts, r.solver->exposed, r.solver->u);
    place(&r, false);
    sides of = {&t, true, true};
    check_sums(&r, &t);
    check_frequencies(&r, &t);
    check_parts(&r, &t);
    check_forces(&r, &t, "contact");
    visit(&r, judge_pushed, &of);
    rg_contacts_sink(r.solver->contacts, r.solver->exposed, r.solver->contact_sunk);
    visit(&r, judge_newly, &of);
    report(of.sunk, "contact", "what has sunk falls with its depth");
    report(of.newly, "contact", "newly exposed sides begin as far sunk as they are");
    check_moved(&r, &t);
    free_twin(&t);
    random_state_free(&r);
}

/* ---- Friction ---- */

/* The elements go on, each as a whole. */
static void move(const random_state *r) {
    const rg_solver *s = r->solver;
    moves++;
    for (size_t slot = 0; slot < s->domain->blocks * RG_LANES; slot++) {
        for (int k = 0; s->domain->id[slot] >= 0 && k < 3 * RG_NODES; k++) {
            s->u[rg_node_index(slot, k / 3, k % 3)] = (rg_real)moved_u(s->domain->id[slot], k / 3, k % 3);
        }
    }
}

/* The rows of all ranks, back to each of them. */
static void save_and_load(const random_state *r) {
    int64_t *key, *all_keys;
    double *value, *all;
    int rows = (int)rg_contacts_grips(r->solver->contacts, &key, &value), ranks, count[8], begin[9] = {0};
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    MPI_Allgather(&rows, 1, MPI_INT, count, 1, MPI_INT, MPI_COMM_WORLD);
    for (int i = 0; i < ranks; i++) {
        begin[i + 1] = begin[i] + count[i];
    }
    MPI_Datatype row;
    MPI_Type_contiguous(RG_GRIP_ROW, MPI_DOUBLE, &row);
    MPI_Type_commit(&row);
    all_keys = RG_NEW(int64_t, (size_t)begin[ranks] + 1);
    all = RG_NEW(double, RG_GRIP_ROW *((size_t)begin[ranks] + 1));
    MPI_Allgatherv(key, rows, MPI_INT64_T, all_keys, count, begin, MPI_INT64_T, MPI_COMM_WORLD);
    MPI_Allgatherv(value, rows, row, all, count, begin, row, MPI_COMM_WORLD);
    MPI_Type_free(&row);
    rg_contacts_take_grips(r->solver->contacts, (size_t)begin[ranks], all_keys, all);
    rg_free(key);
    rg_free(value);
    rg_free(all_keys);
    rg_free(all);
}

/* The spring of a pair that begins to slide ends where the forces attack: in a shallow overlap that is known
 * less well than places are. */
#define STRETCHED (6 * LENGTH)

/* Both sides of each pair that grips have a row, once each. */
static bool rows_good(const random_state *r, const twin *t) {
    int64_t *key;
    double *value;
    int rows = (int)rg_contacts_grips(r->solver->contacts, &key, &value), wanted = 0;
    bool good = true;
    for (int i = 0; i < rows; i++) {
        int a, b;
        const double *row = value + RG_GRIP_ROW * i;
        if (face_of(t, key[i], &a) == NULL || face_of(t, (rg_gid)row[0], &b) == NULL) {
            good = false;
            continue;
        }
        const double *of = t->grips[a < b ? a * t->faces + b : b * t->faces + a];
        good = good && of[RG_GRIP_STIFFNESS] > 0 && row[1 + RG_GRIP_SLIDES] == of[RG_GRIP_SLIDES];
        good = good && near(row[1 + RG_GRIP_STIFFNESS], of[RG_GRIP_STIFFNESS], 1e-9 * of[RG_GRIP_STIFFNESS]);
        good = good && near(row[1 + RG_GRIP_STRETCH], of[RG_GRIP_STRETCH], STRETCHED);
    }
    for (int i = 0; i < t->faces * t->faces; i++) {
        wanted += 2 * (t->grips[i][RG_GRIP_STIFFNESS] > 0);
    }
    rg_free(key);
    rg_free(value);
    MPI_Allreduce(MPI_IN_PLACE, &rows, 1, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
    return good && rows == wanted;
}

/* How many pairs hold and slide, in the twin. */
static void count_grips(const twin *t, int pressing[2]) {
    for (int i = 0; i < t->faces * t->faces; i++) {
        pressing[t->grips[i][RG_GRIP_SLIDES] > 0] += t->grips[i][RG_GRIP_STIFFNESS] > 0;
    }
}

#define ROUGH                                                                                                \
    "friction: 0.1, static_friction: 0.3, pairs: [{between: [glass, steel], friction: 0.9}, {between: "      \
    "[steel, steel], friction: 0}, {between: [steel, glass], friction: 0.05, static_friction: 0.2}]}"

static void check_friction(void) {
    const char *change[] = {"contact={model: general, penalty: 4, " ROUGH, "bodies=[]"};
    static const char *const of[] = {"friction, first", "friction, a step on", "friction, after a search",
                                     "friction, after a restart"};
    random_state r = random_state_make(2, change, MPI_COMM_WORLD);
    rg_solver *s = r.solver;
    grip *grips = NULL;
    int pressing[2] = {0, 0};
    random_state_draw(&r, SEED);
    visit(&r, draw_side, NULL);
    for (int i = 0; i < 4; i++) {
        if (i > 0) {
            move(&r);
        }
        if (i == 3) {
            save_and_load(&r);
        }
        if (i != 1) {
            rg_contacts_search(s->contacts, s->exposed, s->u);
        }
        twin t = make_twin(&r, &grips, 0);
        visit(&r, draw_side, NULL);
        place(&r, true);
        check_forces(&r, &t, of[i]);
        report(rows_good(&r, &t), of[i], "rows of a checkpoint");
        count_grips(&t, pressing);
        free_twin(&t);
    }
    report(pressing[0] > 100 && pressing[1] > 100, "friction", "pairs hold, and slide");
    rg_free(grips);
    random_state_free(&r);
    moves = 0;
}

/* ---- Damping ---- */

static void check_damping(void) {
    const char *change[] = {"contact={model: general, penalty: 4, damping: 0.05, " ROUGH, "bodies=[]"};
    random_state r = random_state_make(2, change, MPI_COMM_WORLD);
    rg_solver *s = r.solver;
    size_t slots = s->domain->blocks * RG_LANES;
    grip *grips = NULL;
    random_state_draw(&r, SEED);
    memset(s->contact_heat, 0, slots * sizeof *s->contact_heat);
    visit(&r, draw_side, NULL);
    rg_contacts_search(s->contacts, s->exposed, s->u);
    twin t = make_twin(&r, &grips, 0.05);
    place(&r, true);
    check_frequencies(&r, &t);
    check_forces(&r, &t, "damping");
    memcpy(s->velocity, s->step_velocity, slots * 3 * RG_NODES * sizeof *s->velocity);
    for (size_t n = 0; n < s->domain->tiles; n++) {
        rg_contacts_place(s->contacts, n, s->u, s->velocity, s->contact_sunk);
        rg_contacts_settle(s->contacts, n, DT_NOW, s->contact_heat);
    }
    report(values_good(&r, &t, s->contact_heat, 1, t.settled, 1e-6), "damping", "heat after the kick");
    rg_free(grips);
    free_twin(&t);
    random_state_free(&r);
}

/* ---- Which faces are exposed ---- */

static bool drawn_apart(rg_gid face) {
    bool apart = drawn_broken(SEED, face) == (1 << RG_POINTS) - 1;
    for (int q = 0; q < RG_POINTS; q++) {
        apart = apart && drawn_damage(SEED, face, q) >= 1;
    }
    return apart;
}

/* Whether the interfaces that have separated, and no others, are in a state; counts them. */
static bool all_are(const random_state *r, uint8_t state, int *count) {
    const rg_solver *s = r->solver;
    bool good = true;
    for (size_t n = 0; n < s->domain->tiles; n++) {
        const rg_tile *t = &s->domain->tile[n];
        for (size_t i = t->ibegin * RG_LANES; i < t->iend * RG_LANES; i++) {
            double normal[3];
            if (rg_interface_area(s->domain, i, normal) > 0) {
                bool apart = drawn_apart(interface_key(r, t, i));
                good = good && s->exposed[i] == (apart ? state : RG_UNEXPOSED);
                *count += apart;
            }
        }
    }
    return good;
}

static void check_exposure(const char *interface) {
    const char *change[] = {"contact={model: general, penalty: 4}", "bodies=[]", interface};
    random_state r = random_state_make(3, change, MPI_COMM_WORLD);
    rg_solver *s = r.solver;
    int count = 0;
    random_state_draw(&r, SEED);
    bool waiting = rg_exposure_mark(s), good = all_are(&r, RG_SEPARATED, &count) && waiting;
    rg_exposure_take(s);
    good = all_are(&r, RG_NEWLY_EXPOSED, &count) && good && !rg_exposure_mark(s);
    rg_exposure_settle(s);
    good = all_are(&r, RG_EXPOSED, &count) && good;
    MPI_Allreduce(MPI_IN_PLACE, &count, 1, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
    report(good && !rg_exposure_mark(s) && count > 60, interface,
           "faces that have separated are exposed, by and by");
    random_state_free(&r);
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    check();
    check_friction();
    check_damping();
    check_exposure("interface={law: linear, strength: 400e6, energy: 34}");
    check_exposure(
        "interface={form: intrinsic, law: needleman, strength: 400e6, energy: 34, contact: potential}");
    return finish_with_nothing_left();
}
