/* Energy release rates and stress intensities at fronts, of a state drawn at random, against the integrals
 * over all elements and the openings of all faces of the whole mesh; on any number of ranks, by two threads.
 * Prints TAP from rank 0. */
#include "diagnostics/crack_front.h"

#include <math.h>
#include <omp.h>
#include <string.h>

#include "domain/element.h"
#include "solver/tile.h"
#include "support/near.h"
#include "support/random_state.h"
#include "support/tap_memory.h"

enum { MOST = 4, VALUES = RG_FRONT_VALUES, SAMPLES = 4 };
static const double STEP = 2e-9; /* to come (s) */

/* Elements whose gradients are their own, so that a draw needs no lift of the jumps. */
static const char own[] =
    "interface={form: intrinsic, law: needleman, strength: 400e6, energy: 34, contact: potential}";

/* ---- The fronts ---- */

typedef struct {
    double at[3], axis[3][3]; /* direction, normal, along the front */
    double inner, outer, length;
    bool symmetric;
    int values; /* bits */
    double shift;
} crack;

enum {
    J_ = 1 << RG_FRONT_RELEASE,
    K_ = 1 << RG_FRONT_INTENSITY,
    I_ = 1 << RG_FRONT_OPENING,
    II_ = 1 << RG_FRONT_SLIDING,
    III_ = 1 << RG_FRONT_TEARING
};

static const char of_one[] =
    "output.crack_fronts=["
    "{name: whole, at: [0.7e-3, 0.15e-3, 2.55e-3], direction: [0, -3, 0], normal: [0, 0, 2], "
    "radius: {inner: 0.15e-3, outer: 0.7e-3}, values: [J, K, KI, KII, KIII]}, "
    "{name: piece, at: [0.85e-3, 0.1e-3, 2.3e-3], direction: [0, 0, 5], normal: [-1, 0, 0], length: 0.9e-3, "
    "radius: {inner: 0.1e-3, outer: 0.5e-3}, values: [KIII, KII, J]}, "
    "{name: half, at: [0.8e-3, 0.2e-3, 1.1e-3], direction: [0, 1, 0], normal: [0, 0, 1], "
    "radius: {inner: 0.15e-3, outer: 0.65e-3}, symmetric: true, values: [KI, K]}, "
    "{name: goes, at: [0.7e-3, 0.15e-3, 2.55e-3], direction: [0, 1, 0], normal: [0, 0, 1], "
    "radius: {inner: 0.1e-3, outer: 0.65e-3}, tip: run, values: [J, KI]}]";
static const crack cracks_of_one[MOST] = {
    {{0.7e-3, 0.15e-3, 2.55e-3},
     {{0, -1, 0}, {0, 0, 1}, {-1, 0, 0}},
     0.15e-3,
     0.7e-3,
     0,
     false,
     J_ | K_ | I_ | II_ | III_,
     0},
    {{0.85e-3, 0.1e-3, 2.3e-3},
     {{0, 0, 1}, {-1, 0, 0}, {0, -1, 0}},
     0.1e-3,
     0.5e-3,
     0.9e-3,
     false,
     J_ | II_ | III_,
     0},
    {{0.8e-3, 0.2e-3, 1.1e-3}, {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}}, 0.15e-3, 0.65e-3, 0, true, I_ | K_, 0},
    {{0.7e-3, 0.15e-3, 2.55e-3}, {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}}, 0.1e-3, 0.65e-3, 0, false, J_ | I_, 0},
};

static const char of_two[] = "output.crack_fronts=[{name: a, at: [0.7e-3, 0.15e-3, 2.55e-3], direction: [0, "
                             "1, 0], normal: [0, 0, -1], "
                             "radius: {inner: 0.2e-3, outer: 0.6e-3}, values: [J]}]";
static const crack cracks_of_two[] = {
    {{0.7e-3, 0.15e-3, 2.55e-3}, {{0, 1, 0}, {0, 0, -1}, {-1, 0, 0}}, 0.2e-3, 0.6e-3, 0, false, J_, 0},
};

/* ---- Weights ---- */

static void place_of(const crack *f, const double x[3], double out[3]) {
    for (int k = 0; k < 3; k++) {
        out[k] = k == 0 ? -f->shift : 0;
        for (int c = 0; c < 3; c++) {
            out[k] += f->axis[k][c] * (x[c] - f->at[c]);
        }
    }
}

static double along(const crack *f, double z) {
    return f->length > 0 ? fmax(1 - fabs(z) / (0.5 * f->length), 0) : 1;
}

static double weight(const crack *f, const double x[3]) {
    double p[3];
    place_of(f, x, p);
    double r = sqrt(p[0] * p[0] + p[1] * p[1]);
    double about = r <= f->inner ? 1 : r >= f->outer ? 0 : 1 - (r - f->inner) / (f->outer - f->inner);
    return about * along(f, p[2]);
}

/* ---- The integral over an element ---- */

typedef struct {
    double x[4][3], slope[4][3], volume;
    double u[RG_NODES][3], v[RG_NODES][3], a[RG_NODES][3];
} element;

static void cross(const double a[3], const double b[3], double c[3]) {
    for (int k = 0; k < 3; k++) {
        c[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
    }
}

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static element get(const random_state *r, rg_gid e, uint64_t seed) {
    element it;
    mesh_corners(r->mesh, e, it.x);
    it.volume = tet_volume(it.x);
    for (int c = 0; c < 4; c++) { /* the height of corner c over the others is 1 there */
        double p[3], q[3], s[3], n[3];
        for (int k = 0; k < 3; k++) {
            p[k] = it.x[(c + 2) % 4][k] - it.x[(c + 1) % 4][k];
            q[k] = it.x[(c + 3) % 4][k] - it.x[(c + 1) % 4][k];
            s[k] = it.x[c][k] - it.x[(c + 1) % 4][k];
        }
        cross(p, q, n);
        for (int k = 0; k < 3; k++) {
            it.slope[c][k] = n[k] / dot(n, s);
        }
    }
    for (int k = 0; k < 3 * RG_NODES; k++) {
        it.u[k / 3][k % 3] = drawn_u(seed, e, k / 3, k % 3);
        it.v[k / 3][k % 3] = drawn_now(seed, e, k / 3, k % 3);
        it.a[k / 3][k % 3] = (drawn_velocity(seed, e, k / 3, k % 3) - it.v[k / 3][k % 3]) / (0.5 * STEP);
    }
    return it;
}

/* Gradient of a field of the nodes at barycentric coordinates l. */
static void gradient(const element *it, double f[RG_NODES][3], const double l[4], double out[3][3]) {
    memset(out, 0, 9 * sizeof(double));
    for (int n = 0; n < RG_NODES; n++) {
        int i = rg_node_end[n][0], j = rg_node_end[n][1];
        for (int k = 0; k < 9; k++) {
            double slope = i == j ? (4 * l[i] - 1) * it->slope[i][k % 3]
                                  : 4 * (l[i] * it->slope[j][k % 3] + l[j] * it->slope[i][k % 3]);
            out[k / 3][k % 3] += slope * f[n][k / 3];
        }
    }
}

/* The neo-Hookean solid: first Piola-Kirchhoff stress and energy per volume at a gradient. */
static double stress(const rg_material *m, double H[3][3], double P[3][3]) {
    double F[3][3], cofactor[3][3], square = 0;
    for (int k = 0; k < 9; k++) {
        F[k / 3][k % 3] = H[k / 3][k % 3] + (k % 4 == 0);
        square += F[k / 3][k % 3] * F[k / 3][k % 3];
    }
    for (int i = 0; i < 3; i++) {
        cross(F[(i + 1) % 3], F[(i + 2) % 3], cofactor[i]);
    }
    double J = dot(F[0], cofactor[0]);
    for (int k = 0; k < 9; k++) {
        P[k / 3][k % 3] = m->mu * F[k / 3][k % 3] + (m->lambda * log(J) - m->mu) * cofactor[k / 3][k % 3] / J;
    }
    return (0.5 * m->lambda * log(J) - m->mu) * log(J) + 0.5 * m->mu * (square - 3);
}

/* u,e q at the nodes. */
static void slid(const element *it, double f[RG_NODES][3], const double e[3], const double q[4],
                 double out[RG_NODES][3]) {
    for (int n = 0; n < RG_NODES; n++) {
        double l[4] = {0, 0, 0, 0}, slope[3][3], at = 0;
        l[rg_node_end[n][0]] += 0.5;
        l[rg_node_end[n][1]] += 0.5;
        gradient(it, f, l, slope);
        for (int c = 0; c < 4; c++) {
            at += l[c] * q[c];
        }
        for (int i = 0; i < 3; i++) {
            out[n][i] = at * dot(slope[i], e);
        }
    }
}

static double in_mass(rg_mass mass, double a[RG_NODES][3], double b[RG_NODES][3]) {
    double sum = 0;
    for (int k = 0; k < RG_NODES * RG_NODES; k++) {
        sum += rg_mass_entry(mass, k / RG_NODES, k % RG_NODES) * dot(a[k / RG_NODES], b[k % RG_NODES]);
    }
    return sum;
}

/* J L of an element, and the sum of the sizes of its terms. */
static double release(const random_state *r, const crack *f, rg_gid e, uint64_t seed, double *size) {
    element it = get(r, e, seed);
    const rg_material *m = &r->solver->model->material[mesh_material(r, e)];
    double q[4], fall[3] = {0, 0, 0}, w[RG_NODES][3], terms[5] = {0}, far = (5 - sqrt(5.0)) / 20;
    for (int c = 0; c < 4; c++) {
        q[c] = weight(f, it.x[c]);
        for (int k = 0; k < 3; k++) {
            fall[k] += q[c] * it.slope[c][k];
        }
    }
    for (int g = 0; g < 4; g++) {
        double l[4] = {far, far, far, far}, H[3][3], P[3][3];
        l[g] = 1 - 3 * far;
        gradient(&it, it.u, l, H);
        terms[1] -= it.volume / 4 * stress(m, H, P) * dot(f->axis[0], fall);
        for (int i = 0; i < 3; i++) {
            terms[0] += it.volume / 4 * dot(P[i], fall) * dot(H[i], f->axis[0]);
        }
    }
    double mass = m->density * it.volume;
    rg_mass of = r->input->mass;
    terms[2] = -0.5 * mass * in_mass(of, it.v, it.v) * dot(f->axis[0], fall);
    slid(&it, it.u, f->axis[0], q, w);
    terms[3] = mass * in_mass(of, it.a, w);
    slid(&it, it.v, f->axis[0], q, w);
    terms[4] = -mass * in_mass(of, it.v, w);
    double sum = 0;
    for (int k = 0; k < 5; k++) {
        sum += terms[k];
        *size += fabs(terms[k]);
    }
    return sum;
}

/* ---- Openings ---- */

/* Of K apparent a + b r over the faces behind the front in its plane, by area, the a of each mode: both sides
 * count. Returns on how many sides of faces. */
static int openings(const random_state *r, const crack *f, uint64_t seed, double K[3]) {
    const rg_material *m = &r->solver->model->material[0];
    double w[3] = {0, 0, 0}, k[3][2] = {{0, 0}, {0, 0}, {0, 0}};
    double young = m->mu * (3 * m->lambda + 2 * m->mu) / (m->lambda + m->mu),
           poisson = m->lambda / (2 * (m->lambda + m->mu));
    int sides = 0;
    for (rg_gid s = 0; s < 4 * r->mesh->elements; s++) {
        const int *node = rg_face_node[s % 4];
        double x[3], p[3], a[3], b[3], n[3];
        bool in = true, any = false;
        element it = get(r, s / 4, seed);
        for (int i = 0; i < 3; i++) {
            place_of(f, it.x[node[i]], p);
            in = in && fabs(p[1]) < 1e-9;
        }
        for (int i = 0; i < 3; i++) {
            a[i] = it.x[node[1]][i] - it.x[node[0]][i];
            b[i] = it.x[node[2]][i] - it.x[node[0]][i];
        }
        cross(a, b, n);
        place_of(f, it.x[6 - node[0] - node[1] - node[2]], p);
        double above = p[1] > 0 ? 1 : -1; /* where the element is */
        for (int i = 3; in && i < RG_FNODES; i++) {
            mesh_node(r->mesh, s / 4, node[i], x);
            place_of(f, x, p);
            double back = -p[0], by = along(f, p[2]) * sqrt(dot(n, n)) / 6, root = sqrt(2 * acos(-1) / back);
            if (back < f->inner || back > f->outer) {
                continue;
            }
            any = any || by > 0;
            double apparent[3] = {young / (1 - poisson * poisson) / 4 * dot(f->axis[1], it.u[node[i]]),
                                  young / (1 - poisson * poisson) / 4 * dot(f->axis[0], it.u[node[i]]),
                                  m->mu / 2 * dot(f->axis[2], it.u[node[i]])};
            for (int j = 0; j < 3; j++) {
                w[j] += by * pow(back, j);
                k[j][0] += by * root * above * apparent[j];
                k[j][1] += by * root * above * apparent[j] * back;
            }
        }
        sides += any;
    }
    for (int j = 0; j < 3; j++) {
        K[j] = (w[2] * k[j][0] - w[1] * k[j][1]) / (w[0] * w[2] - w[1] * w[1]);
    }
    return sides;
}

/* ---- Samples ---- */

/* Values that a front records, from `row` on; returns where the next one's begin. */
static const double *judge(const random_state *r, const crack *f, uint64_t seed, const double *row,
                           bool *good) {
    double size = 0, J = 0, value[VALUES], most[VALUES];
    const rg_material *m = &r->solver->model->material[0];
    for (rg_gid e = 0; e < r->mesh->elements; e++) {
        J += release(r, f, e, seed, &size);
    }
    double length = f->length > 0 ? 0.5 * f->length : 1.1e-3;
    J *= (f->symmetric ? 2 : 1) / length;
    openings(r, f, seed, value + RG_FRONT_OPENING);
    double K = sqrt(4 * m->mu * (m->lambda + m->mu) / (m->lambda + 2 * m->mu) * fabs(J));
    value[RG_FRONT_RELEASE] = J;
    value[RG_FRONT_INTENSITY] = J < 0 ? -K : K;
    for (int v = 0; v < VALUES; v++) {
        most[v] = v == RG_FRONT_RELEASE ? 1e-13 * size / length : 1e-12 * fabs(K) + 1e-12 * fabs(value[v]);
        if ((f->values >> v & 1) != 0) {
            *good = near(*row++, value[v], v >= RG_FRONT_OPENING ? 1e-10 * fabs(value[v]) : most[v]) && *good;
        }
    }
    return row;
}

/* Points have separated in the elements of low numbers. */
static void drive(const random_state *r, rg_gid below) {
    rg_solver *s = r->solver;
    const rg_domain *d = s->domain;
    memset(s->active, 1, d->iblocks);
    memset(s->broken, 0, d->iblocks * RG_LANES);
    for (size_t n = 0; n < d->tiles; n++) {
        const rg_tile *t = &d->tile[n];
        for (size_t i = t->ibegin * RG_LANES; i < t->iend * RG_LANES; i++) {
            double normal[3];
            rg_gid key = rg_interface_area(d, i, normal) > 0 ? interface_key(r, t, i) : INT64_MAX;
            for (int q = 0; key / 4 < below && q < RG_POINTS; q++) {
                s->broken[i] |= (uint8_t)(1 << q);
                *rg_crack_value(s, i, q, RG_CRACK_OPENING) = (rg_real)(1.01 * rg_separation(s, i, q));
            }
        }
    }
}

static void sample(const random_state *r, rg_crack_fronts *p, rg_crack_tips *tips) {
    const rg_solver *s = r->solver;
#pragma omp parallel for schedule(static, 1)
    for (size_t t = 0; t < s->domain->tiles; t++) {
        if (rg_crack_fronts_want(p, t)) {
            rg_crack_fronts_watch(p, s, t, &s->work[omp_get_thread_num()]);
        }
    }
    for (size_t t = 0; tips != NULL && t < s->domain->tiles; t++) {
        if (rg_crack_tips_want(tips, t)) {
            rg_crack_tips_watch(tips, s, t);
        }
    }
    if (tips != NULL) {
        rg_crack_tips_next(tips);
    }
    rg_crack_fronts_next(p, tips);
}

static bool writes(const rg_crack_fronts *p, void (*write)(const rg_crack_fronts *p, FILE *out),
                   const char *text) {
    char found[800] = "";
    FILE *out = fmemopen(found, sizeof found, "w");
    write(p, out);
    fclose(out);
    bool good = strcmp(found, text) == 0;
    if (!good) {
        printf("# %s\n", found);
    }
    return good;
}

/* Where a front that moves is in the next sample. */
static double shift_of(const rg_crack_tips *tips, const crack *f) {
    static const double direction[3] = {0, 0.8, 0.6};
    double furthest = rg_crack_tips_furthest(tips, 0);
    MPI_Allreduce(MPI_IN_PLACE, &furthest, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
    return (furthest - dot(direction, f->at)) / dot(direction, f->axis[0]);
}

static void check_one(void) {
    const char *change[] = {of_one,         "output.crack_tips=[{name: run, direction: [0, 4, 3]}]",
                            "materials=[]", "mesh.jitter=0",
                            "bodies=[]",    own};
    static const rg_gid below[SAMPLES] = {0, 60, 60, 110};
    random_state r = random_state_make(6, change, MPI_COMM_WORLD);
    crack f[MOST];
    char words[800] = "";
    memcpy(f, cracks_of_one, sizeof f);
    rg_crack_tips *tips = rg_crack_tips_make(r.solver);
    rg_crack_fronts *p = rg_crack_fronts_make(r.solver);
    for (int i = 0; i < MOST; i++) {
        static const char *const name[MOST] = {"whole", "piece", "half", "goes"};
        double none[3];
        int elements = 0, sides = openings(&r, &f[i], 1, none);
        for (rg_gid e = 0; e < r.mesh->elements; e++) {
            double x[4][3];
            mesh_corners(r.mesh, e, x);
            elements += fmax(fmax(weight(&f[i], x[0]), weight(&f[i], x[1])),
                             fmax(weight(&f[i], x[2]), weight(&f[i], x[3]))) > 0;
        }
        size_t used = strlen(words);
        snprintf(words + used, sizeof words - used,
                 "crack front    %s: %.4g m long, %d elements, %d sides of faces behind it\n", name[i],
                 f[i].length > 0 ? 0.5 * f[i].length : 1.1e-3, elements, sides);
    }
    report(rg_crack_fronts_columns(p) == 12 &&
               writes(p, rg_crack_fronts_header,
                      ",whole_J,whole_K,whole_KI,whole_KII,whole_KIII,piece_J,piece_KII,piece_KIII,half_K,"
                      "half_KI,goes_J,goes_KI") &&
               writes(p, rg_crack_fronts_print, words),
           "fronts", "columns and words");
    rg_crack_tips_open(tips, SAMPLES);
    rg_crack_fronts_open(p, 2);
    bool good = true, moves = false;
    for (int i = 0; i < SAMPLES; i += 2) {
        double shift[2];
        for (int k = i; k < i + 2; k++) {
            random_state_draw(&r, 10 + (uint64_t)k);
            r.solver->dt_next = STEP;
            drive(&r, below[k]);
            shift[k - i] = f[3].shift;
            sample(&r, p, tips);
            if (below[k] > 0) {
                f[3].shift = shift_of(tips, &f[3]);
                moves = moves || fabs(f[3].shift - shift[k - i]) > 1e-4;
            }
        }
        const double *row = rg_crack_fronts_collect(p);
        double next = f[3].shift;
        for (int k = i; k < i + 2; k++) {
            f[3].shift = shift[k - i];
            for (int j = 0; j < MOST; j++) {
                row = judge(&r, &f[j], 10 + (uint64_t)k, row, &good);
            }
        }
        f[3].shift = next;
    }
    report(good, "fronts", "integrals and openings");
    report(moves, "fronts", "one moves");
    rg_crack_fronts_free(p);
    rg_crack_tips_free(tips);
    random_state_free(&r);
}

static void check_two(void) {
    const char *change[] = {of_two,
                            "materials=[{name: steel, where: \"x + z > 3.1e-3\", model: neo-hookean, young: "
                            "210e9, poisson: 0.3, density: 7800}]",
                            "bodies=[]", own};
    random_state r = random_state_make(4, change, MPI_COMM_WORLD);
    rg_crack_fronts *p = rg_crack_fronts_make(r.solver);
    bool good = true;
    rg_crack_fronts_open(p, 1);
    random_state_draw(&r, 20);
    r.solver->dt_next = STEP;
    sample(&r, p, NULL);
    judge(&r, cracks_of_two, 20, rg_crack_fronts_collect(p), &good);
    report(good, "fronts", "in two solids, of a mesh that has no faces in the plane");
    rg_crack_fronts_free(p);
    random_state_free(&r);
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    omp_set_num_threads(2);
    check_one();
    check_two();
    return finish_with_nothing_left();
}
