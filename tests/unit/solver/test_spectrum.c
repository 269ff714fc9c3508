/* The largest frequency, by which the time step is chosen, against that of the twin (step_twin.h): a Lanczos
 * iteration of the test's own on the scalar kernels, over the whole mesh, with faces intact, broken and
 * closed, or cohesive; on any number of ranks. Prints TAP from rank 0. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/hash.h"
#include "base/mem.h"
#include "case/read.h"
#include "cohesive/facts.h"
#include "partition/patch.h"
#include "solver/setup.h"
#include "solver/spectrum.h"
#include "support/step_cases.h"
#include "support/step_twin.h"
#include "support/tap.h"

enum { VECTORS = 60 };

/* What solver/spectrum.c adds, and what its iteration may leave: measured at most 1.1e-4. */
#define MARGIN 0.02
#define SHORT  3e-4

static const char cube[] =
    "mesh: {cells: [2, 2, 2], size: [2e-4, 2e-4, 2e-4], jitter: 0.2}\n"
    "material: {name: glass, model: linear-elastic, young: 260e9, poisson: 0.21, density: 3690}\n"
    "interface: {law: linear, strength: 400e6, energy: 10}\n"
    "time: {end: 1}\n"
    "output: {fields: []}\n";

#define LAYERS                                                                                               \
    "materials=[{name: metal, model: linear-elastic, young: 100e9, poisson: 0.3, density: 900, where: 'z > " \
    "1e-4'}]"

static const variant subjects[] = {
    {"default", {NULL}},
    {"large and heavy", {"mesh.size=[2, 2, 2]"}}, /* 3e4 kg in place of 3e-8 */
    {"lumped", {"mass=lumped"}},
    {"lumped, no law", {"mass=lumped", "interface={law: none}"}},
    {"stiff penalty", {"interface.beta_s=12", "interface.penalty=isotropic"}},
    {"flux", {"interface.contact=flux", "mass=lumped"}},
    {"friction", {"interface.friction=0.5"}},
    {"conserving potential", {"interface.activation=conserving", "interface.contact=potential"}},
    {"viscosity", {"viscosity={linear: 0.3, quadratic: 1.2}"}},
    {"two materials", {LAYERS}},
    {"exponential", {"interface.form=intrinsic", "interface.law=exponential", "interface.energy=1e-2"}},
    {"weak faces",
     {"interface.form=intrinsic", "interface.law=xu-needleman", "interface.energy=1e-2",
      "interface.sets=[{where: 'nz > 0.5', strength: 1200e6}, {where: 'z < 1e-4', strength: 200e6}]"}},
    {"shared nodes", {"interface.form=continuous", "mass=lumped", "interface.faces=abs(nz) > 0.5"}},
    {"shared nodes alone", {"interface={form: continuous, law: none}", "mass=lumped", LAYERS}},
};

/* ---- The twin's operator ---- */

enum { INTACT, CLOSED, COHESIVE, STATES };
static const char *const state_name[] = {"intact", "broken and closed", "cohesive and closed"};

/* Faces that hold; that carry nothing but contact, which does not let go; or the law's own slopes besides. */
static void set_faces(twin *w, int state, double stiffest) {
    rg_cohesive was = w->law;
    size_t islots = w->iblocks * RG_LANES;
    memset(w->broken, state == INTACT ? 0 : (1 << RG_POINTS) - 1, islots);
    memset(w->unlinked, state == INTACT ? 0 : (1 << RG_POINTS) - 1, islots);
    w->crack_stride = RG_CRACK_BLOCK;
    for (size_t i = 0; i < islots; i++)
        for (int q = 0; q < RG_POINTS; q++)
            w->crack[rg_crack_index(i, q, RG_CRACK_OPENING)] = 2;
    w->law = (rg_cohesive){.law = RG_LAW_LINEAR, /* failed */
                           .strength = state == INTACT ? INFINITY : 1,
                           .opening = 1,
                           .separation = 1,
                           .beta = was.beta,
                           .contact = RG_CONTACT_LINEAR,
                           .form = was.form,
                           .slope = was.slope * stiffest,
                           .sliding = was.sliding == RG_SLIDING_FREE ? RG_SLIDING_FREE : RG_SLIDING_STUCK};
    rg_real *scale = w->scale;
    w->scale = NULL;
    rg_free(scale);
}

/* out = M q, 0 where there is no element. */
static void inertia(const twin *w, const double *q, double *out) {
    memset(out, 0, w->blocks * RG_NODE_BLOCK * sizeof *out);
    for (size_t k = 0; k < w->elements * RG_NODES * RG_NODES; k++) {
        size_t e = k / (RG_NODES * RG_NODES), s = w->slot[e];
        int i = (int)(k % (RG_NODES * RG_NODES)) / RG_NODES, j = (int)(k % RG_NODES);
        double mass =
            w->material[w->of[e]].density * w->geom[rg_geom_index(s, RG_GEOM_VOLUME)] * w->mass[i][j];
        for (int c = 0; c < 3; c++)
            out[rg_node_index(s, i, c)] += mass * q[rg_node_index(s, j, c)];
    }
}

static double dot(const twin *w, const double *a, const double *b) {
    double sum = 0;
    for (size_t k = 0; k < w->blocks * RG_NODE_BLOCK; k++)
        sum += a[k] * b[k];
    return sum;
}

/* sqrt(q . M q); leaves M q in `work`. */
static double norm_of(const twin *w, const double *q, double *work) {
    inertia(w, q, work);
    return sqrt(dot(w, q, work));
}

/* out = M^-1 K q of the linear operator. */
static void apply(twin *w, const double *q, double *out) {
    size_t values = w->blocks * RG_NODE_BLOCK;
    double largest = 0;
    for (size_t k = 0; k < values; k++)
        largest = fmax(largest, fabs(q[k]));
    double size = 5e-8 * w->input->mesh.size[0] /
                  largest; /* a ten-millionth of an edge: linear, and clear of rounding */
    for (size_t k = 0; k < values; k++)
        w->u[k] = (rg_real)(size * q[k]);
    twin_accelerate(w);
    for (size_t k = 0; k < values; k++)
        out[k] = -w->acceleration[k] / size;
}

static void hold(const twin *w, const bool *held, double *q) {
    for (size_t k = 0; held != NULL && k < 3 * RG_NODES * w->elements; k++)
        if (held[k / (3 * RG_NODES)])
            q[rg_node_index(w->slot[k / (3 * RG_NODES)], (int)(k / 3) % RG_NODES, (int)k % 3)] = 0;
}

/* The largest eigenvalue of a tridiagonal matrix and its vector, by multiplication. */
static double top_of(int n, const double *alpha, const double *beta, double *y) {
    double value = 0, shift = 0;
    for (int i = 0; i < n; i++)
        y[i] = 1.0 / (i + 1);
    for (int i = 0; i < n; i++)
        shift = fmin(shift, alpha[i] - (i > 0 ? beta[i - 1] : 0) - beta[i]);
    for (int k = 0; k < 5000; k++) {
        double z[VECTORS], norm = 0;
        for (int i = 0; i < n; i++) {
            z[i] = (alpha[i] - shift) * y[i] + (i > 0 ? beta[i - 1] * y[i - 1] : 0) +
                   (i + 1 < n ? beta[i] * y[i + 1] : 0);
            norm += z[i] * z[i];
        }
        norm = sqrt(norm);
        for (int i = 0; i < n; i++)
            y[i] = z[i] / norm;
        value = norm + shift;
    }
    return value;
}

/* Lanczos with every vector kept and every new one made orthogonal to all: the largest eigenvalue and the
 * element with the most of its vector. Elements that are `held` (NULL: none) stay at rest. */
static double largest_eigenvalue(twin *w, const bool *held, rg_gid *element) {
    size_t values = w->blocks * RG_NODE_BLOCK;
    double *q = RG_NEW(double, (VECTORS + 2) * values), *work = q + (VECTORS + 1) * values;
    double alpha[VECTORS], beta[VECTORS], y[VECTORS], most = 0;
    int n = 0;
    for (size_t k = 0; k < RG_NODES * w->elements; k++)
        for (int c = 0; c < 3; c++) /* copies of a shared node alike */
            q[rg_node_index(w->slot[k / RG_NODES], (int)(k % RG_NODES), c)] =
                rg_hash_uniform(rg_hash(rg_hash(1, w->node[k]), (uint64_t)c)) - 0.5;
    hold(w, held, q);
    double norm = norm_of(w, q, work);
    for (size_t k = 0; k < values; k++)
        q[k] /= norm;
    while (n < VECTORS) {
        double *own = q + (size_t)n * values, *next = own + values;
        apply(w, own, next);
        hold(w, held, next);
        for (int pass = 0; pass < 2; pass++) { /* of Gram and Schmidt, as they wrote it: two are enough */
            inertia(w, next, work);
            alpha[n] = pass == 0 ? dot(w, own, work) : alpha[n];
            for (int j = 0; j <= n; j++) {
                double share = dot(w, q + (size_t)j * values, work);
                for (size_t k = 0; k < values; k++)
                    next[k] -= share * q[(size_t)j * values + k];
            }
        }
        beta[n] = norm_of(w, next, work);
        for (size_t k = 0; k < values; k++)
            next[k] /= beta[n];
        n++;
    }
    double value = top_of(n, alpha, beta, y);
    for (size_t e = 0; e < w->elements; e++) {
        double sum = 0;
        for (int i = 0; i < 3 * RG_NODES; i++) {
            double x = 0;
            for (int j = 0; j < n; j++)
                x += y[j] * q[(size_t)j * values + rg_node_index(w->slot[e], i / 3, i % 3)];
            sum += x * x;
        }
        if (sum > most) {
            most = sum;
            *element = (rg_gid)e;
        }
    }
    rg_free(q);
    return value;
}

/* Of an operator that is not symmetric: largest and mean growth of the norm in a step. */
static void growth_of(twin *w, double *largest, double *mean) {
    enum { STEPS = 120 };
    size_t values = w->blocks * RG_NODE_BLOCK;
    double *q = RG_NEW(double, 3 * values), *work = q + 2 * values, sum = 0;
    for (size_t k = 0; k < 3 * RG_NODES * w->elements; k++)
        q[rg_node_index(w->slot[k / (3 * RG_NODES)], (int)(k / 3) % RG_NODES, (int)k % 3)] =
            rg_hash_uniform(rg_hash(1, k)) - 0.5;
    *largest = 0;
    for (int step = 0; step < STEPS; step++) {
        apply(w, q, q + values);
        double growth = norm_of(w, q + values, work) / norm_of(w, q, work);
        for (size_t k = 0; k < values; k++)
            q[k] = q[values + k] / growth;
        *largest = step >= STEPS / 2 ? fmax(*largest, growth) : 0;
        sum += step >= STEPS / 2 ? log(growth) : 0;
    }
    *mean = exp(sum / (STEPS / 2));
    rg_free(q);
}

/* ---- Verdict ---- */

/* Largest stiffness of faces over that of the law alone. */
static double stiffest_of(const twin *w) {
    double most = w->scale == NULL ? 1 : 0;
    for (size_t i = 0; i < w->interfaces && w->scale != NULL; i++) {
        const rg_real *scale = w->scale + i / RG_LANES * 2 * RG_LANES + i % RG_LANES;
        most = fmax(most, scale[0] / scale[RG_LANES]);
    }
    return most;
}

/* The worst state of the faces. */
static double worst_of(const rg_case *c, const rg_mesh *mesh, int *state, rg_gid *element) {
    double worst = 0;
    bool intrinsic = c->interface.form == RG_FORM_INTRINSIC;
    bool closes = c->interface.law != RG_LAW_NONE && c->interface.contact != RG_CONTACT_FLUX;
    for (int k = intrinsic ? COHESIVE : INTACT; k <= (intrinsic ? COHESIVE : closes ? CLOSED : INTACT); k++) {
        twin *w = twin_make(c, mesh);
        rg_gid here = -1;
        rg_cohesive law = w->law;
        double stiffest = stiffest_of(w);
        set_faces(w, k, stiffest);
        if (k == COHESIVE) { /* both slopes of the law, which the file of each law bounds */
            rg_law_facts facts = rg_law_facts_of(law.law, law.shape, law.beta);
            w->law.law = RG_LAW_FREE;
            w->law.shape[1] = facts.slope[1] * law.strength / law.opening * stiffest;
        }
        w->heat = NULL;
        double value = largest_eigenvalue(w, NULL, &here);
        if (value > worst) {
            worst = value;
            *state = k;
            *element = here;
        }
        twin_free(w);
    }
    return worst;
}

/* Half of sqrt(omega2) times the least time in which a dilatational wave crosses an element. */
static double damping_of(const rg_case *c, const rg_mesh *mesh, double omega2) {
    twin *w = twin_make(c, mesh);
    double least = INFINITY;
    for (size_t e = 0; e < w->elements; e++) {
        const rg_material *m = &w->material[w->of[e]];
        double sum[3] = {0, 0, 0};
        for (int k = 0; k < 4; k++) {
            double square = 0;
            for (int i = 0; i < 3; i++) {
                double g = k < 3 ? w->geom[rg_geom_index(w->slot[e], 3 * k + i)] : -sum[i];
                sum[i] += g;
                square += g * g;
            }
            least = fmin(least, 1 / sqrt(square) / sqrt((m->lambda + 2 * m->mu) / m->density));
        }
    }
    twin_free(w);
    return sqrt(omega2) * least / 2;
}

/* A solver is left as it was made: the linear ones have models and fields of their own. */
static bool at_rest(const rg_solver *s) {
    const rg_cohesive *law = &s->model->law;
    bool rest = true;
    for (size_t i = 0; i < s->domain->blocks * RG_NODE_BLOCK; i++)
        rest = rest && s->u[i] == 0 && s->velocity[i] == 0 && s->step_velocity[i] == 0;
    for (size_t i = 0; i < s->domain->iblocks * RG_LANES; i++)
        rest = rest && s->broken[i] == s->unlinked[i] &&
               s->broken[i] == (law->form == RG_FORM_INTRINSIC ? (1 << RG_POINTS) - 1 : 0) &&
               s->active[i / RG_LANES] == (law->form == RG_FORM_INTRINSIC);
    return rest;
}

static rg_case *read_subject(const variant *v) {
    int count = 0;
    while (count < OVERRIDES && v->override[count] != NULL)
        count++;
    rg_case *c = rg_case_read_text("cube", cube, sizeof cube - 1, count, v->override, stderr);
    if (c == NULL)
        abort();
    return c;
}

static void check(const variant *v) {
    int state = STATES;
    rg_case *c = read_subject(v);
    rg_mesh *mesh = make_mesh(c);
    rg_solver *s = rg_solver_make(c, MPI_COMM_WORLD);
    rg_gid element = -1;
    rg_spectrum(s);
    double worst = worst_of(c, mesh, &state, &element), part = s->omega2 / worst / (1 + MARGIN);
    report(part < 1 + 2e-5 && part > 1 - SHORT, v->name, "largest frequency");
    report(strcmp(s->limiting_state, state_name[state]) == 0, v->name, state_name[state]);
    report(s->limiting == element, v->name, "the element that limits it");
    report(fabs(s->damping / damping_of(c, mesh, s->omega2) - 1) < 1e-12, v->name, "damping");
    report(at_rest(s), v->name, "all is as before");
    if (s->model->scale != NULL) { /* also where the whole mesh, not a patch of it, is looked at */
        rg_spectrum_whole(s);
        report(at_rest(s), v->name, "all is as before, of the whole mesh");
    }
    if (rank == 0)
        printf("# %.6f of the largest eigenvalue, %g 1/s^2; element %lld\n", part, worst, (long long)element);
    rg_solver_free(s);
    rg_mesh_free(mesh);
    rg_case_free(c);
}

/* Elements at the cut of a patch stay at rest: here that which limits the body, and one more, by the first
 * and by the last of their faces. */
static void check_cut(void) {
    const variant v = {"cut", {"mass=lumped", "interface={law: none}"}};
    rg_case *c = read_subject(&v);
    rg_mesh *mesh = make_mesh(c);
    rg_gid worst = -1;
    twin *w = twin_make(c, mesh);
    set_faces(w, INTACT, 1);
    double whole = largest_eigenvalue(w, NULL, &worst);
    bool *held = RG_NEW(bool, (size_t)mesh->elements);
    rg_gid other = (worst + 24) % mesh->elements; /* in another block */
    held[worst] = held[other] = true;
    mesh->set[4 * worst + 3] = mesh->set[4 * other] = RG_PATCH_CUT;
    double expected = largest_eigenvalue(w, held, &worst);
    rg_part *part = rg_part_distribute(rank == 0 ? mesh : NULL, rank == 0 ? 16 : 0, MPI_COMM_WORLD);
    rg_solver *s = rg_solver_make_from_part(c, part, MPI_COMM_WORLD);
    rg_spectrum_whole(s);
    double found = s->omega2 / expected / (1 + MARGIN);
    report(expected < 0.99 * whole, v.name, "what is held no longer limits");
    report(found < 1 + 2e-5 && found > 1 - SHORT, v.name, "largest frequency");
    report(s->limiting == worst && !held[worst], v.name, "the element that limits it");
    if (rank == 0)
        printf("# %.6f of the largest eigenvalue, %.3f of that of the whole body\n", found, expected / whole);
    twin_free(w);
    rg_free(held);
    rg_solver_free(s);
    rg_mesh_free(mesh);
    rg_case_free(c);
}

/* The incomplete form is not symmetric while faces hold: the frequency is between what vectors grow by in the
 * mean and at most. */
static void check_incomplete(void) {
    const variant v = {"incomplete", {"interface={form: incomplete, law: none, beta_s: 20}"}};
    rg_case *c = read_subject(&v);
    rg_mesh *mesh = make_mesh(c);
    rg_solver *s = rg_solver_make(c, MPI_COMM_WORLD);
    twin *w = twin_make(c, mesh);
    double largest, mean;
    set_faces(w, INTACT, 1);
    growth_of(w, &largest, &mean);
    rg_spectrum(s);
    double found = s->omega2 / (1 + MARGIN);
    /* after sixty steps: 0.4 % short of it */
    report(found > mean * (1 - 1e-2) && found < largest * (1 + 1e-4), v.name, "largest frequency");
    if (rank == 0)
        printf("# %g, %g to %g 1/s^2; element %lld\n", found, mean, largest, (long long)s->limiting);
    twin_free(w);
    rg_solver_free(s);
    rg_mesh_free(mesh);
    rg_case_free(c);
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    for (size_t k = 0; k < sizeof subjects / sizeof *subjects; k++)
        check(&subjects[k]);
    check_cut();
    check_incomplete();
    return finish();
}
