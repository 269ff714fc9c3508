#include "solver/spectrum.h"

#include <math.h>
#include <string.h>

#include "base/hash.h"
#include "base/mem.h"
#include "partition/material.h"
#include "partition/patch.h"
#include "solver/law.h"
#include "solver/setup.h"
#include "solver/step.h"
#include "solver/tile.h"

enum { MAX_ITERATIONS = 80, CHECK_EVERY = 8, POWER_ITERATIONS = 60 };

#define TOLERANCE 1e-3 /* relative change of omega^2 between two checks */
#define EXHAUSTED (sizeof(rg_real) == sizeof(double) ? 1e-10 : 1e-5) /* beta, rounding apart from 0 */
/* Relative, added to omega^2: the patch stays below the whole mesh, most on nearly regular meshes with lumped
 * mass, the iteration below its limit (tests/unit/partition/test_patch.c bounds both), and faces closed here
 * and there exceed all closed by a little. */
#define MARGIN    2e-2
#define AMPLITUDE 1e-7 /* displacement over element height: linear to 1e-6, clear of rounding to 1e-9 */

/* ---- Vectors: arrays laid out like the velocity ---- */

static size_t values(const rg_solver *s) {
    return s->domain->blocks * RG_NODE_BLOCK;
}

/* Inner product a . M b, exact sum over elements. */
static double mass_dot(rg_solver *s, const rg_real *a, const rg_real *b) {
    const rg_domain *d = s->domain;
    rg_exact_sum sum = {0};
#pragma omp parallel
    {
        rg_exact_sum mine = {0};
        _Alignas(64) rg_real both[RG_NODE_BLOCK];
        double energy[2][RG_LANES];
#pragma omp for schedule(static)
        for (size_t block = 0; block < d->blocks; block++) {
            for (int sign = 0; sign < 2; sign++) { /* a.Mb = (|a + b|^2 - |a - b|^2)/4 */
                for (size_t i = 0; i < RG_NODE_BLOCK; i++) {
                    size_t at = block * RG_NODE_BLOCK + i;
                    both[i] = sign == 0 ? a[at] + b[at] : a[at] - b[at];
                }
                rg_kinetic_args args = {.density = rg_material_of(s, block * RG_LANES)->density,
                                        .mass = s->input->mass,
                                        .geom = d->geom + block * RG_GEOM_BLOCK,
                                        .velocity = both,
                                        .energy = energy[sign]};
                s->kernels->kinetic(&args, 0, 1);
            }
            for (int l = 0; l < RG_LANES; l++) {
                rg_exact_add(&mine, 0.5 * (energy[0][l] - energy[1][l]));
            }
        }
#pragma omp critical
        rg_exact_merge(&sum, &mine);
    }
    rg_exact_allreduce(&sum, 1, s->comm);
    return rg_exact_value(&sum);
}

static double largest_entry(rg_solver *s, const rg_real *a) {
    double m = 0;
#pragma omp parallel for schedule(static) reduction(max : m)
    for (size_t i = 0; i < values(s); i++) {
        m = fabs(a[i]) > m ? fabs(a[i]) : m;
    }
    MPI_Allreduce(MPI_IN_PLACE, &m, 1, MPI_DOUBLE, MPI_MAX, s->comm);
    return m;
}

/* y <- a y + b x */
static void combine(rg_solver *s, double a, rg_real *y, double b, const rg_real *x) {
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < values(s); i++) {
        y[i] = (rg_real)(a * y[i] + b * x[i]);
    }
}

/* Elements at the cut of a patch are held at rest: the vectors are then those of the whole mesh that vanish
 * outside, and the largest frequency a lower bound of the whole mesh's. */
static void hold_cut(rg_solver *s, rg_real *q) {
#pragma omp parallel for schedule(static)
    for (size_t slot = 0; slot < s->domain->blocks * RG_LANES; slot++) {
        const int32_t *set = s->domain->set + 4 * slot;
        if (set[0] == RG_PATCH_CUT || set[1] == RG_PATCH_CUT || set[2] == RG_PATCH_CUT ||
            set[3] == RG_PATCH_CUT) {
            for (int k = 0; k < 3 * RG_NODES; k++) {
                q[rg_node_index(slot, k / 3, k % 3)] = 0;
            }
        }
    }
}

static void randomize(rg_solver *s, rg_real *q) {
    for (size_t slot = 0; slot < s->domain->blocks * RG_LANES; slot++) {
        rg_gid id = s->domain->id[slot];
        for (int k = 0; k < 3 * RG_NODES; k++) {
            uint64_t h = rg_hash(rg_hash(0, (uint64_t)id), (uint64_t)k);
            q[rg_node_index(slot, k / 3, k % 3)] = id < 0 ? 0 : (rg_real)(2 * rg_hash_uniform(h) - 1);
        }
    }
    if (s->assembly != NULL) {
        rg_assembly_mean(s->assembly, q);
    }
    hold_cut(s, q);
}

/* ---- Operator ---- */

typedef struct {
    rg_solver *s;
    const rg_material *material; /* of the element that a wave crosses in the shortest time */
    double height;               /* ... smallest of its kind (m) */
    double scale; /* frequencies are in units of c_d/height, so that numbers stay near 1 (1/s^2) */
} linear_operator;

/* w <- w + A q / scale, A = M^-1 K. Uses u. */
static void apply(const linear_operator *op, const rg_real *q, rg_real *w) {
    rg_solver *s = op->s;
    double amplitude = AMPLITUDE * op->height / largest_entry(s, q);
    combine(s, 0, s->u, amplitude, q);
    rg_solver_impulse(s, w, -1 / (amplitude * op->scale));
    hold_cut(s, w);
}

/* Largest eigenvalue of a symmetric tridiagonal matrix, by bisection on Sturm's sequence. */
static double largest_eigenvalue(const double *alpha, const double *beta, int n) {
    double low = alpha[0], high = alpha[0];
    for (int i = 0; i < n; i++) {
        double radius = (i > 0 ? fabs(beta[i - 1]) : 0) + (i + 1 < n ? fabs(beta[i]) : 0);
        low = fmax(low, alpha[i]);
        high = fmax(high, alpha[i] + radius);
    }
    while (high - low > 1e-12 * fabs(high)) {
        double x = 0.5 * (low + high), d = alpha[0] - x;
        bool below = d < 0;
        for (int i = 1; below && i < n; i++) { /* all pivots negative: x is above every eigenvalue */
            d = alpha[i] - x - beta[i - 1] * beta[i - 1] / d;
            below = d < 0;
        }
        *(below ? &high : &low) = x;
    }
    return high;
}

/* Coefficients of a Lanczos iteration that starts from a random vector. */
typedef struct {
    int n;
    double alpha[MAX_ITERATIONS], beta[MAX_ITERATIONS];
} lanczos;

static void swap(rg_real **a, rg_real **b) {
    rg_real *t = *a;
    *a = *b;
    *b = t;
}

/* One step: q_j in `q`, q_{j-1} in `before`; leaves q_{j+1} in `q` and q_j in `before`. False if the space is
 * full. */
static bool lanczos_step(const linear_operator *op, lanczos *z, int j, rg_real **q, rg_real **before) {
    rg_solver *s = op->s;
    combine(s, j > 0 ? -z->beta[j - 1] : 0, *before, 0, *q);
    apply(op, *q, *before);
    z->alpha[j] = mass_dot(s, *before, *q);
    combine(s, 1, *before, -z->alpha[j], *q);
    z->beta[j] = sqrt(fmax(0, mass_dot(s, *before, *before)));
    if (!(z->beta[j] > EXHAUSTED)) {
        return false;
    }
    combine(s, 1 / z->beta[j], *before, 0, *q);
    swap(q, before);
    return true;
}

static void first_vector(const linear_operator *op, rg_real *q, rg_real *before) {
    randomize(op->s, q);
    combine(op->s, 1 / sqrt(mass_dot(op->s, q, q)), q, 0, q);
    memset(before, 0, values(op->s) * sizeof *before);
}

static double lanczos_eigenvalue(const linear_operator *op, lanczos *z) {
    rg_real *q = op->s->velocity, *before = op->s->step_velocity;
    double last = 0;
    first_vector(op, q, before);
    for (z->n = 0; z->n < MAX_ITERATIONS;) {
        bool more = lanczos_step(op, z, z->n++, &q, &before);
        if (!more || z->n % CHECK_EVERY == 0) {
            double now = largest_eigenvalue(z->alpha, z->beta, z->n);
            if (!more || now - last < TOLERANCE * now) {
                return now;
            }
            last = now;
        }
    }
    return last;
}

/* Not symmetric: growth of the norm under repeated application. */
static double power_eigenvalue(const linear_operator *op) {
    rg_solver *s = op->s;
    rg_real *q = s->velocity, *w = s->step_velocity;
    double norm = 0, largest = 0;
    first_vector(op, q, w);
    for (int i = 0; i < POWER_ITERATIONS; i++) {
        memset(w, 0, values(s) * sizeof *w);
        apply(op, q, w);
        norm = sqrt(mass_dot(s, w, w));
        largest = i > POWER_ITERATIONS / 2 ? fmax(largest, norm) : norm;
        combine(s, 1 / norm, w, 0, q);
        swap(&q, &w);
    }
    return largest;
}

/* ---- The element that limits ---- */

/* Eigenvector of the tridiagonal matrix for its largest eigenvalue, by recurrence (well behaved for an
 * extreme one that has converged). */
static void tridiagonal_vector(const lanczos *z, double theta, double y[MAX_ITERATIONS]) {
    y[0] = 1;
    for (int j = 0; j + 1 < z->n; j++) {
        double left = j > 0 ? z->beta[j - 1] * y[j - 1] : 0;
        y[j + 1] = ((theta - z->alpha[j]) * y[j] - left) / z->beta[j];
    }
}

/* Element with the most of the squared vector; the lowest number among equals. */
static rg_gid dominant_element(rg_solver *s, const rg_real *x) {
    double most = -1;
    rg_gid id = -1;
    for (size_t slot = 0; slot < s->domain->blocks * RG_LANES; slot++) {
        double sum = 0;
        for (int k = 0; k < 3 * RG_NODES; k++) {
            double v = x[rg_node_index(slot, k / 3, k % 3)];
            sum += v * v;
        }
        rg_gid here = s->domain->id[slot];
        if (here >= 0 && (sum > most || (sum >= most && here < id))) {
            most = sum;
            id = here;
        }
    }
    double top = most;
    MPI_Allreduce(MPI_IN_PLACE, &top, 1, MPI_DOUBLE, MPI_MAX, s->comm);
    int64_t mine = most >= top ? id : INT64_MAX;
    MPI_Allreduce(MPI_IN_PLACE, &mine, 1, MPI_INT64_T, MPI_MIN, s->comm);
    return mine;
}

/* Repeats the iteration, which needs no stored vectors, and sums the Ritz vector. */
static rg_gid limiting_element(const linear_operator *op, const lanczos *known, double theta) {
    rg_solver *s = op->s;
    if (known->n == 0) { /* power iteration: its last vector is the eigenvector */
        power_eigenvalue(op);
        return dominant_element(s, s->velocity);
    }
    double y[MAX_ITERATIONS];
    rg_real *q = s->velocity, *before = s->step_velocity;
    rg_real *ritz = RG_NEW(rg_real, values(s));
    lanczos again = *known;
    tridiagonal_vector(known, theta, y);
    first_vector(op, q, before);
    for (int j = 0; j < known->n; j++) {
        combine(s, 1, ritz, y[j], q);
        if (j + 1 < known->n) {
            lanczos_step(op, &again, j, &q, &before);
        }
    }
    rg_gid id = dominant_element(s, ritz);
    rg_free(ritz);
    return id;
}

/* ---- States of the faces ---- */

typedef enum { INTACT, CLOSED, COHESIVE, STATES } state;
static const char *const state_name[] = {"intact", "broken and closed", "cohesive and closed"};

/* The linear model of a state of the faces: all materials neo-Hookean of the same elastic constants, or
 * anisotropic, which is linear at rest; faces alike, as the stiffest ones. One block of crack state serves
 * all. */
static rg_model linear_model(const rg_model *of, double stiffest, state which, rg_material *material) {
    rg_model m = *of;
    double slope[2];
    rg_law_stiffness(&of->law, slope);
    for (int i = 0; i < m.materials; i++) {
        material[i] = of->material[i];
        if (material[i].model != RG_MATERIAL_ANISOTROPIC) {
            material[i].model = RG_MATERIAL_NEO_HOOKEAN;
        }
    }
    m.material = material;
    m.scale = NULL;
    m.beta = m.friction = NULL;
    m.opening = NULL;
    m.open_area = NULL;
    m.open_faces = NULL;
    m.openings = 0;
    m.history_stride = m.crack_stride = 0;
    m.law.slope *= stiffest;
    m.law.opening = 1;
    m.law.strength = 1e300; /* never reached */
    m.law.criterion = RG_CRITERION_QUADRATIC;
    m.law.contact = RG_CONTACT_LINEAR; /* that of a potential too where nothing has slid */
    bool held = m.law.sliding != RG_SLIDING_FREE || m.law.shear != RG_SHEAR_RELEASED;
    m.law.sliding = held ? RG_SLIDING_STUCK : RG_SLIDING_FREE;
    m.law.shear = RG_SHEAR_RELEASED;
    m.law.law = RG_LAW_LINEAR; /* failed, so contact alone acts; and without memory */
    if (which == COHESIVE) { /* contact, no softer than the law, both ways; the law's own slope in sliding */
        m.law.law = RG_LAW_FREE;
        memcpy(m.law.shape, (double[RG_LAW_SHAPE]){0, slope[1] * stiffest}, sizeof m.law.shape);
    }
    return m;
}

/* Puts the faces into a state. */
static void set_faces(rg_solver *s, state which) {
    const rg_domain *d = s->domain;
    memset(s->broken, which != INTACT ? (1 << RG_POINTS) - 1 : 0, d->iblocks * RG_LANES);
    memset(s->unlinked, which != INTACT ? (1 << RG_POINTS) - 1 : 0, d->iblocks * RG_LANES);
    memset(s->active, which != INTACT, d->iblocks);
    memset(s->cracked, which != INTACT, d->blocks);
}

/* Smallest height of the elements of each material. */
static void smallest_heights(const rg_solver *s, double *h) {
    for (int m = 0; m < s->model->materials; m++) {
        h[m] = INFINITY;
    }
    for (size_t slot = 0; slot < s->domain->blocks * RG_LANES; slot++) {
        double sum[3] = {0, 0, 0};
        for (int k = 0; s->domain->id[slot] >= 0 && k < 4; k++) {
            double square = 0;
            for (int c = 0; c < 3; c++) {
                double g = k < 3 ? s->domain->geom[rg_geom_index(slot, RG_GEOM_GRAD + 3 * k + c)] : -sum[c];
                sum[c] += g;
                square += g * g;
            }
            double *least = &h[s->domain->material[slot / RG_LANES]];
            *least = fmin(*least, 1 / sqrt(square));
        }
    }
    MPI_Allreduce(MPI_IN_PLACE, h, s->model->materials, MPI_DOUBLE, MPI_MIN, s->comm);
}

/* In units of the smallest time in which a dilatational wave crosses an element. */
static linear_operator make_operator(rg_solver *s) {
    linear_operator op = {.s = s};
    double *h = RG_NEW(double, (size_t)s->model->materials), shortest = INFINITY;
    smallest_heights(s, h);
    for (int i = 0; i < s->model->materials; i++) {
        const rg_material *m = &s->model->material[i];
        double time = h[i] / rg_material_dilatational(m);
        if (time < shortest) {
            shortest = time;
            op.material = m;
            op.height = h[i];
            op.scale = rg_material_modulus(m) / m->density / (h[i] * h[i]);
        }
    }
    rg_free(h);
    return op;
}

/* A linear solver beside another one, with one block of crack state for all faces: failed ones. */
static rg_solver *linear_solver(const rg_solver *s, const rg_model *model) {
    rg_solver *l = rg_solver_beside(s, model);
    rg_free(l->crack);
    l->crack = RG_NEW(rg_real, RG_CRACK_BLOCK);
    for (size_t q = 0; q < RG_POINTS; q++) {
        for (size_t lane = 0; lane < RG_LANES; lane++) {
            l->crack[(q * RG_CRACK + RG_CRACK_OPENING) * RG_LANES + lane] = 2;
        }
    }
    return l;
}

/* What is found: members of rg_solver. */
typedef struct {
    double omega2, damping;
    rg_gid limiting;
    state state;
} limit;

/* Of the whole mesh of a solver, with faces that are `stiffest` times as stiff as the law. */
static limit find(const rg_solver *s, double stiffest) {
    bool intrinsic = s->model->law.form == RG_FORM_INTRINSIC;
    bool closes = s->input->interface.law != RG_LAW_NONE && s->input->interface.contact != RG_CONTACT_FLUX;
    state first = intrinsic ? COHESIVE : INTACT, last = intrinsic ? COHESIVE : closes ? CLOSED : INTACT;
    rg_material *material = RG_NEW(rg_material, (size_t)s->model->materials);
    rg_model model[STATES];
    for (state which = INTACT; which < STATES; which++) {
        model[which] = linear_model(s->model, stiffest, which, material);
    }
    rg_solver *l = linear_solver(s, &model[first]);
    linear_operator op = make_operator(l);
    lanczos run[STATES] = {{0}};
    double worst = 0;
    limit found = {.state = first};
    for (state which = first; which <= last; which++) {
        l->model = &model[which];
        set_faces(l, which);
        bool symmetric = s->input->interface.form != RG_FORM_INCOMPLETE || which != INTACT;
        double theta = symmetric ? lanczos_eigenvalue(&op, &run[which]) : power_eigenvalue(&op);
        if (theta > worst) {
            worst = theta;
            found.state = which;
        }
    }
    found.omega2 = worst * op.scale * (1 + MARGIN);
    found.damping = 0.5 * sqrt(found.omega2) * op.height / rg_material_dilatational(op.material);
    l->model = &model[found.state];
    set_faces(l, found.state);
    found.limiting = limiting_element(&op, &run[found.state], worst);
    rg_solver_free(l);
    rg_free(material);
    return found;
}

static void keep(rg_solver *s, const limit *found) {
    s->omega2 = found->omega2;
    s->damping = found->damping;
    s->limiting = found->limiting;
    s->limiting_state = state_name[found->state];
}

void rg_spectrum_whole(rg_solver *s) {
    limit found = find(s, s->model->stiffest);
    keep(s, &found);
}

/* ---- On the patch ---- */

/* Rank 0 finds the spectrum of the patch on its own: the patch is too small to share among ranks. */
static limit find_on_patch(rg_solver *s) {
    rg_case input = *s->input;
    input.boundaries = 0; /* their sets are not on the patch, and the operator is that of a free body */
    input.loads = 0;
    input.bodies = 0; /* what they add to it is known */
    rg_solver *local = rg_solver_make_from_part(&input, s->patch, MPI_COMM_SELF);
    s->patch = NULL;
    limit found = find(local, s->model->stiffest);
    found.limiting = local->part->original[found.limiting];
    rg_solver_free(local);
    return found;
}

/* What rank 0 found there, to all. */
static void share(limit *found, MPI_Comm comm) {
    int which = (int)found->state;
    MPI_Bcast(&found->omega2, 1, MPI_DOUBLE, 0, comm);
    MPI_Bcast(&found->damping, 1, MPI_DOUBLE, 0, comm);
    MPI_Bcast(&found->limiting, 1, MPI_INT64_T, 0, comm);
    MPI_Bcast(&which, 1, MPI_INT, 0, comm);
    found->state = (state)which;
}

void rg_spectrum(rg_solver *s) {
    if (s->assembly != NULL) {
        rg_spectrum_whole(s);
        rg_solver_touch(s);
    } else {
        limit found = {0};
        if (s->rank == 0) {
            found = find_on_patch(s);
        }
        share(&found, s->comm);
        keep(s, &found);
    }
    s->omega2 += s->bodies->omega2 + rg_loads_omega2(s->loads);
}
