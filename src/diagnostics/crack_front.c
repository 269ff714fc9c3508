#include "diagnostics/crack_front.h"

#include <float.h>
#include <math.h>
#include <omp.h>
#include <string.h>

#include "base/error.h"
#include "base/exact_sum.h"
#include "base/mem.h"
#include "base/vector.h"
#include "domain/element.h"
#include "domain/face.h"
#include "quadrature.h"
#include "solver/selection.h"
#include "solver/tile.h"

/* What is summed at a front: J L; weights of the opening's points, times 1, r, r^2; apparent K of the three
 * modes, times 1 and r. */
enum { MODES = 3, RELEASE = 0, WEIGHT = 1, APPARENT = 4, SUMS = APPARENT + 2 * MODES, STRESS = 6 };

#define PI 3.14159265358979323846

/* How far from the crack's plane, over the outer radius, a face may be that lies in it. */
#define IN_PLANE 1e-6

static const char *const value_name[RG_FRONT_VALUES] = {
#define NAME(NAME, word, meaning) word,
    RG_FRONT_VALUE(NAME)
#undef NAME
};

typedef struct {
    const rg_crack_front_input *in;
    double axis[3][3];           /* unit vectors: direction, normal, along the front */
    double length;               /* under the weight (m) */
    double plane_strain, shear;  /* E/(1 - nu^2) and mu of its solid (Pa) */
    int tip;                     /* of crack_tips that it moves with; -1: it rests */
    rg_selected elements, faces; /* at the start, on all ranks; of faces both sides count */
} front;

typedef struct {
    rg_lid slot;
    int16_t front;
} entry;

struct rg_crack_fronts {
    const rg_case *input;
    const rg_domain *domain;
    MPI_Comm comm;
    int count, threads, columns, samples;
    bool move;
    front *front;
    double *shift;      /* [count]: how far each has moved along its direction (m) */
    size_t *tile_begin; /* entries of tile t, ascending by slot: from tile_begin[t] on */
    entry *entry;
    double mass[RG_NODES][RG_NODES]; /* over rho V */
    rg_exact_sum *now;               /* [threads][count][SUMS]: of the present state */
    rg_exact_sum *sum;               /* [capacity][count][SUMS] */
    double *row;                     /* [capacity][columns] */
};

/* ---- Place and weight ---- */

/* Place about a front: along its direction, its normal and itself (m). */
static void place_at(const front *f, double shift, const double x[3], double out[3]) {
    double away[3];
    rg_vector_subtract(x, f->in->at, away);
    for (int k = 0; k < 3; k++) {
        out[k] = rg_vector_dot(f->axis[k], away);
    }
    out[0] -= shift;
}

static double along_weight(const front *f, double place) {
    double length = f->in->length;
    return length > 0 ? fmax(0, 1 - 2 * fabs(place) / length) : 1;
}

static double weight_about(const front *f, const double place[3]) {
    double r = hypot(place[0], place[1]), inner = f->in->radius.inner, outer = f->in->radius.outer;
    return fmin(1, fmax(0, (outer - r) / (outer - inner)));
}

/* The weight at the corners of an element; whether it is anywhere. */
static bool find_weights(const front *f, double shift, const double *corner, double q[4]) {
    bool any = false;
    for (int c = 0; c < 4; c++) {
        double place[3];
        place_at(f, shift, corner + 3 * c, place);
        q[c] = weight_about(f, place) * along_weight(f, place[2]);
        any |= q[c] > 0;
    }
    return any;
}

/* ---- The domain integral ---- */

typedef double matrix[3][3];

/* w = u,e q at the nodes: between linear fields a field of the element. */
static void find_shift(matrix gradient[4], const double e[3], const double q[4], double w[RG_NODES][3]) {
    for (int n = 0; n < RG_NODES; n++) {
        int one = rg_node_end[n][0], two = rg_node_end[n][1];
        for (int i = 0; i < 3; i++) {
            w[n][i] = 0.25 * (q[one] + q[two]) *
                      (rg_vector_dot(gradient[one][i], e) + rg_vector_dot(gradient[two][i], e));
        }
    }
}

/* a . M b over rho V. */
static double in_mass(const rg_crack_fronts *r, double a[RG_NODES][3], double b[RG_NODES][3]) {
    double sum = 0;
    for (int m = 0; m < RG_NODES; m++) {
        for (int n = 0; n < RG_NODES; n++) {
            sum += r->mass[m][n] * rg_vector_dot(a[m], b[n]);
        }
    }
    return sum;
}

/* P m, P = J s F^-T the first Piola-Kirchhoff stress of Cauchy's s (xx, yy, zz, yz, xz, xy). */
static void pull(const double s[STRESS], matrix F, const double m[3], double out[3]) {
    double n[3] = {0, 0, 0};
    for (int i = 0; i < 3; i++) {
        double cofactor[3];
        rg_vector_cross(F[(i + 1) % 3], F[(i + 2) % 3], cofactor);
        n[i] = rg_vector_dot(cofactor, m);
    }
    out[0] = s[0] * n[0] + s[5] * n[1] + s[4] * n[2];
    out[1] = s[5] * n[0] + s[1] * n[1] + s[3] * n[2];
    out[2] = s[4] * n[0] + s[3] * n[1] + s[2] * n[2];
}

/* What the kernels know of a block. */
typedef struct {
    size_t block;
    _Alignas(64) double cauchy[RG_GAUSS * STRESS * RG_LANES], energy[RG_LANES];
} block_state;

/* int P_ij u_i,e q,j dV */
static double stress_work(const block_state *b, size_t lane, double volume, matrix gradient[4],
                          const double e[3], const double fall[3]) {
    double sum = 0;
    for (size_t g = 0; g < RG_GAUSS; g++) {
        matrix F;
        double s[STRESS], pulled[3], slide[3];
        for (int i = 0; i < 3; i++) {
            for (int j = 0; j < 3; j++) {
                F[i][j] = i == j;
                for (size_t c = 0; c < 4; c++) {
                    F[i][j] += (c == g ? RG_GAUSS_B : RG_GAUSS_A) * gradient[c][i][j];
                }
            }
        }
        for (size_t k = 0; k < STRESS; k++) {
            s[k] = b->cauchy[(g * STRESS + k) * RG_LANES + lane];
        }
        pull(s, F, fall, pulled);
        for (int i = 0; i < 3; i++) {
            slide[i] = rg_vector_dot(F[i], e) - e[i];
        }
        sum += 0.25 * volume * rg_vector_dot(pulled, slide);
    }
    return sum;
}

static double release_of(const rg_crack_fronts *r, const rg_solver *s, const entry *at, const double q[4],
                         const block_state *b) {
    size_t slot = (size_t)at->slot;
    const double *e = r->front[at->front].axis[0];
    double slope[4][3], fall[3] = {0, 0, 0}, w[RG_NODES][3], v[RG_NODES][3], a[RG_NODES][3];
    matrix gradient[4];
    double mass = rg_element_mass(s->domain, s->model->material, slot),
           volume = (double)s->domain->geom[rg_geom_index(slot, RG_GEOM_VOLUME)];
    rg_barycentric_slopes(s->domain->corner + 12 * slot, slope);
    for (int c = 0; c < 4; c++) {
        for (int j = 0; j < 3; j++) {
            fall[j] += q[c] * slope[c][j];
        }
    }
    for (int n = 0; n < RG_NODES; n++) {
        for (int i = 0; i < 3; i++) {
            size_t k = rg_node_index(slot, n, i);
            v[n][i] = s->step_velocity[k];
            a[n][i] = ((double)s->velocity[k] - v[n][i]) / (0.5 * s->dt_next); /* the half step to come */
        }
    }
    double stored = b->energy[slot % RG_LANES], kinetic = 0.5 * mass * in_mass(r, v, v);
    rg_corner_gradients(s->u, slot, slope, gradient);
    find_shift(gradient, e, q, w);
    double sum = stress_work(b, slot % RG_LANES, volume, gradient, e, fall) -
                 (stored + kinetic) * rg_vector_dot(e, fall) + mass * in_mass(r, w, a);
    rg_corner_gradients(s->step_velocity, slot, slope, gradient);
    find_shift(gradient, e, q, w);
    return sum - mass * in_mass(r, w, v);
}

/* ---- The opening behind the front ---- */

/* Whether a face lies in the plane of the crack. */
static bool in_plane(const front *f, const double *corner, int face) {
    bool in = true;
    for (int k = 0; k < RG_FCORNERS; k++) {
        double place[3];
        place_at(f, 0, corner + 3 * rg_face_node[face][k], place);
        in &= fabs(place[1]) <= IN_PLANE * f->in->radius.outer;
    }
    return in;
}

/* Node a of a face between corners, a point of the rule that takes quadratic fields exactly: how far it is
 * behind the front, or 0 where it is not between the radii, and its weight there. */
static double behind(const front *f, double shift, const double *corner, int face, int a, double *weight) {
    double x[3], place[3];
    rg_node_position(corner, rg_face_node[face][a], x);
    place_at(f, shift, x, place);
    *weight = along_weight(f, place[2]);
    return -place[0] >= f->in->radius.inner && -place[0] <= f->in->radius.outer ? -place[0] : 0;
}

static void add_opening(rg_crack_fronts *r, const rg_solver *s, const entry *e, int face, rg_exact_sum *sum) {
    const front *f = &r->front[e->front];
    const double *corner = s->domain->corner + 12 * (size_t)e->slot;
    double normal[3], area = rg_surface_area(corner, face, normal),
                      side = rg_vector_dot(normal, f->axis[1]) < 0 ? 1 : -1;
    /* K of the opening, the slip along the direction and that along the front, over displacement/sqrt(r) */
    const double stiff[MODES] = {f->plane_strain / 4, f->plane_strain / 4, f->shear / 2};
    static const int of_mode[MODES] = {1, 0, 2};
    for (int a = RG_FCORNERS; a < RG_FNODES; a++) {
        double weight, back = behind(f, r->shift[e->front], corner, face, a, &weight), u[3];
        if (!(back > 0)) {
            continue;
        }
        weight *= area / 3;
        for (int i = 0; i < 3; i++) {
            u[i] = s->u[rg_node_index((size_t)e->slot, rg_face_node[face][a], i)];
        }
        for (int k = 0; k < 3; k++) {
            rg_exact_add(&sum[WEIGHT + k], weight * (k == 0 ? 1 : k == 1 ? back : back * back));
        }
        for (int m = 0; m < MODES; m++) {
            double apparent = side * stiff[m] * sqrt(2 * PI / back) * rg_vector_dot(f->axis[of_mode[m]], u);
            rg_exact_add(&sum[APPARENT + 2 * m], weight * apparent);
            rg_exact_add(&sum[APPARENT + 2 * m + 1], weight * apparent * back);
        }
    }
}

/* K of a mode by least squares; nan without openings. */
static double intercept(const double sum[SUMS], int mode) {
    const double *w = sum + WEIGHT, *k = sum + APPARENT + (ptrdiff_t)2 * mode;
    return (w[2] * k[0] - w[1] * k[1]) / (w[0] * w[2] - w[1] * w[1]);
}

/* ---- A state ---- */

bool rg_crack_fronts_want(const rg_crack_fronts *r, size_t tile) {
    return r->tile_begin[tile] < r->tile_begin[tile + 1];
}

static void find_block(const rg_solver *s, const rg_workspace *w, const rg_tile *t, block_state *b) {
    rg_bulk_args bulk = rg_tile_bulk(s, t, w, b->block);
    rg_bulk_state_args args = {.bulk = &bulk, .energy = b->energy, .cauchy = b->cauchy};
    rg_tile_bulk_state(s, t, &args, b->block, b->block + 1);
}

void rg_crack_fronts_watch(rg_crack_fronts *r, const rg_solver *s, size_t tile, const rg_workspace *w) {
    const rg_tile *t = &s->domain->tile[tile];
    block_state state = {.block = SIZE_MAX};
    for (size_t i = r->tile_begin[tile]; i < r->tile_begin[tile + 1]; i++) {
        const entry *e = &r->entry[i];
        const front *f = &r->front[e->front];
        const double *corner = s->domain->corner + 12 * (size_t)e->slot;
        rg_exact_sum *sum = &r->now[(omp_get_thread_num() * r->count + e->front) * SUMS];
        size_t block = (size_t)e->slot / RG_LANES - t->begin;
        double q[4];
        if (find_weights(f, r->shift[e->front], corner, q)) {
            if (block != state.block) {
                state.block = block;
                find_block(s, w, t, &state);
            }
            rg_exact_add(&sum[RELEASE], release_of(r, s, e, q, &state));
        }
        for (int face = 0; face < RG_FACES; face++) {
            if (in_plane(f, corner, face)) {
                add_opening(r, s, e, face, sum);
            }
        }
    }
}

void rg_crack_fronts_next(rg_crack_fronts *r, const rg_crack_tips *tips) {
    size_t row = (size_t)(r->count * SUMS), at = row * (size_t)r->samples++;
    for (size_t k = 0; k < row; k++) {
        r->sum[at + k] = r->now[k];
        for (int t = 1; t < r->threads; t++) {
            rg_exact_merge(&r->sum[at + k], &r->now[(size_t)t * row + k]);
        }
    }
    memset(r->now, 0, (size_t)r->threads * row * sizeof *r->now);
    for (int i = 0; r->move && i < r->count; i++) {
        const front *f = &r->front[i];
        double place = f->tip < 0 ? -DBL_MAX : rg_crack_tips_furthest(tips, f->tip);
        MPI_Allreduce(MPI_IN_PLACE, &place, 1, MPI_DOUBLE, MPI_MAX, r->comm);
        if (place > -DBL_MAX) {
            const double *along = rg_crack_tips_along(tips, f->tip);
            r->shift[i] = (place - rg_vector_dot(along, f->in->at)) / rg_vector_dot(along, f->axis[0]);
        }
    }
}

const double *rg_crack_fronts_collect(rg_crack_fronts *r) {
    int column = 0;
    rg_exact_allreduce(r->sum, r->samples * r->count * SUMS, r->comm);
    for (int i = 0; i < r->samples * r->count; i++) {
        const front *f = &r->front[i % r->count];
        double sum[SUMS], value[RG_FRONT_VALUES];
        for (int k = 0; k < SUMS; k++) {
            sum[k] = rg_exact_value(&r->sum[i * SUMS + k]);
        }
        double J = (f->in->symmetric ? 2 : 1) * sum[RELEASE] / f->length;
        value[RG_FRONT_RELEASE] = J;
        value[RG_FRONT_INTENSITY] = copysign(sqrt(f->plane_strain * fabs(J)), J);
        for (int m = 0; m < MODES; m++) {
            value[RG_FRONT_OPENING + m] = intercept(sum, m);
        }
        for (int v = 0; v < RG_FRONT_VALUES; v++) {
            if ((f->in->values >> v & 1) != 0) {
                r->row[column++] = value[v];
            }
        }
    }
    r->samples = 0;
    return r->row;
}

/* ---- Set-up ---- */

_Noreturn static void refuse(const rg_crack_fronts *r, int i, const char *why) {
    rg_speak(r->comm);
    rg_fatal(RG_USAGE, "%s: output.crack_fronts[%d]: %s", r->input->path, i, why);
}

static void find_axes(front *f) {
    const double *of[2] = {f->in->direction, f->in->normal};
    for (int k = 0; k < 2; k++) {
        double length = sqrt(rg_vector_dot(of[k], of[k]));
        for (int c = 0; c < 3; c++) {
            f->axis[k][c] = of[k][c] / length;
        }
    }
    rg_vector_cross(f->axis[0], f->axis[1], f->axis[2]);
}

static int find_tip(const rg_case *c, const char *name) {
    int k = 0;
    while (strcmp(c->output.crack_tip[k].name, name) != 0) {
        k++;
    }
    return k;
}

/* Whether an element may ever matter: is within the outer radius of the front where it is, or of one that
 * moves somewhere along its way. */
static bool is_near(const front *f, const double *corner) {
    double least[3], most[3], q[4], outer = f->in->radius.outer;
    for (int c = 0; c < 4; c++) {
        double place[3];
        place_at(f, 0, corner + 3 * c, place);
        for (int k = 0; k < 3; k++) {
            least[k] = c == 0 ? place[k] : fmin(least[k], place[k]);
            most[k] = c == 0 ? place[k] : fmax(most[k], place[k]);
        }
    }
    bool beside = f->tip >= 0 && least[1] < outer && most[1] > -outer &&
                  along_weight(f, least[2] > 0  ? least[2]
                                  : most[2] < 0 ? most[2]
                                                : 0) > 0;
    return beside || find_weights(f, 0, corner, q);
}

/* What is near a front at the start. */
typedef struct {
    uint8_t *elements, *faces; /* bits, as in solver/selection.h */
    int64_t leaves;
    double most[2]; /* place along the front, of either sign (m) */
    double solid[2];
} vicinity;

/* Whether the integral would have to go on over a face: on the surface and not along the direction, where the
 * weight changes. */
static bool leaves(const front *f, const rg_domain *d, size_t slot, int face) {
    const double *corner = d->corner + 12 * slot;
    double normal[3];
    if (!rg_surface_has(d, slot, face)) {
        return false;
    }
    rg_surface_area(corner, face, normal);
    bool any = false, whole = true;
    for (int k = 0; k < RG_FCORNERS; k++) {
        double place[3];
        place_at(f, 0, corner + 3 * rg_face_node[face][k], place);
        any |= weight_about(f, place) > 0;
        whole &= !(weight_about(f, place) < 1);
    }
    return any && !whole && fabs(rg_vector_dot(normal, f->axis[0])) > 1e-3;
}

static void look(const front *f, const rg_solver *s, size_t slot, vicinity *v) {
    const double *corner = s->domain->corner + 12 * slot;
    double q[4];
    if (find_weights(f, 0, corner, q)) {
        double solid = s->domain->material[slot / RG_LANES];
        v->elements[slot] = 1;
        v->solid[0] = fmax(v->solid[0], -solid);
        v->solid[1] = fmax(v->solid[1], solid);
        for (int c = 0; c < 4; c++) {
            double place[3];
            place_at(f, 0, corner + 3 * c, place);
            v->most[0] = fmax(v->most[0], -place[2]);
            v->most[1] = fmax(v->most[1], place[2]);
        }
    }
    for (int face = 0; face < RG_FACES; face++) {
        v->leaves += leaves(f, s->domain, slot, face);
        bool any = false;
        for (int a = RG_FCORNERS; in_plane(f, corner, face) && a < RG_FNODES; a++) {
            double weight, back = behind(f, 0, corner, face, a, &weight);
            any |= back > 0 && weight > 0;
        }
        v->faces[slot] |= (uint8_t)(any << face);
    }
}

static bool has_gas(const rg_case *c) {
    bool any = false;
    for (int i = 0; i < c->loads; i++) {
        any |= c->load[i].cracks;
    }
    return any;
}

/* Counts, extent and solid of a front, the same on all ranks. */
static void survey(rg_crack_fronts *r, const rg_solver *s, int i) {
    front *f = &r->front[i];
    const unsigned by_opening = 1u << RG_FRONT_OPENING | 1u << RG_FRONT_SLIDING | 1u << RG_FRONT_TEARING;
    const rg_domain *d = s->domain;
    vicinity v = {.elements = RG_NEW(uint8_t, d->blocks * RG_LANES + 1),
                  .faces = RG_NEW(uint8_t, d->blocks * RG_LANES + 1),
                  .most = {-DBL_MAX, -DBL_MAX},
                  .solid = {-DBL_MAX, -DBL_MAX}};
    for (size_t k = 0; k < r->tile_begin[d->tiles]; k++) {
        if (r->entry[k].front == i) {
            look(f, s, (size_t)r->entry[k].slot, &v);
        }
    }
    f->elements = rg_selection_measure(v.elements, true, s->input, d, r->comm);
    f->faces = rg_selection_measure(v.faces, false, s->input, d, r->comm);
    rg_free(v.elements);
    rg_free(v.faces);
    MPI_Allreduce(MPI_IN_PLACE, &v.leaves, 1, MPI_INT64_T, MPI_SUM, r->comm);
    MPI_Allreduce(MPI_IN_PLACE, v.most, 4, MPI_DOUBLE, MPI_MAX, r->comm);
    if (has_gas(s->input) && (f->in->values & ~by_opening) != 0) {
        refuse(r, i, "J does not know of a pressure inside cracks; values: KI, KII, KIII");
    }
    if (f->elements.count == 0) {
        refuse(r, i, "no element is within its outer radius");
    }
    if (v.leaves > 0) {
        refuse(r, i, "its outer radius passes a side of the body that is not parallel to the direction");
    }
    if ((f->in->values & by_opening) != 0 && f->faces.count == 0) {
        refuse(r, i, "no face in the plane of the crack lies between the radii behind the front");
    }
    const rg_material *m = &s->model->material[(size_t)v.solid[1]];
    if ((f->in->values & ~(1u << RG_FRONT_RELEASE)) != 0 &&
        (v.solid[0] + v.solid[1] > 0 || m->model == RG_MATERIAL_ANISOTROPIC)) {
        refuse(r, i, "stress intensity is known in one isotropic solid only; values: [J]");
    }
    f->length = f->in->length > 0 ? 0.5 * f->in->length : v.most[0] + v.most[1];
    f->shear = m->mu;
    f->plane_strain = 4 * m->mu * (m->lambda + m->mu) / (m->lambda + 2 * m->mu);
}

/* Visits what is near fronts in a tile: counts it and, with room for it, lists it. */
static size_t list_tile(const rg_crack_fronts *r, const rg_tile *t, entry *out) {
    size_t count = 0;
    for (size_t slot = t->begin * RG_LANES; slot < t->end * RG_LANES; slot++) {
        for (int i = 0; i < r->count && r->domain->id[slot] >= 0; i++) {
            if (is_near(&r->front[i], r->domain->corner + 12 * slot)) {
                if (out != NULL) {
                    out[count] = (entry){(rg_lid)slot, (int16_t)i};
                }
                count++;
            }
        }
    }
    return count;
}

static void list_all(rg_crack_fronts *r) {
    const rg_domain *d = r->domain;
    for (int pass = 0; pass < 2; pass++) {
        for (size_t t = 0, n = 0; t < d->tiles; t++) {
            n += list_tile(r, &d->tile[t], pass == 0 ? NULL : r->entry + n);
            r->tile_begin[t + 1] = n;
        }
        if (pass == 0) {
            r->entry = RG_NEW(entry, r->tile_begin[d->tiles] + 1);
        }
    }
}

rg_crack_fronts *rg_crack_fronts_make(const rg_solver *s) {
    rg_crack_fronts *r = RG_NEW(rg_crack_fronts, 1);
    int count = s->input->output.crack_fronts;
    *r = (rg_crack_fronts){.input = s->input,
                           .domain = s->domain,
                           .comm = s->comm,
                           .count = count,
                           .threads = s->threads,
                           .front = RG_NEW(front, (size_t)count + 1),
                           .shift = RG_NEW(double, (size_t)count + 1),
                           .tile_begin = RG_NEW(size_t, s->domain->tiles + 1)};
    for (int a = 0; a < RG_NODES; a++) {
        for (int b = 0; b < RG_NODES; b++) {
            r->mass[a][b] = rg_mass_entry(s->input->mass, a, b);
        }
    }
    for (int i = 0; i < count; i++) {
        front *f = &r->front[i];
        f->in = &s->input->output.crack_front[i];
        f->tip = f->in->tip == NULL ? -1 : find_tip(s->input, f->in->tip);
        r->move |= f->tip >= 0;
        find_axes(f);
        for (int v = 0; v < RG_FRONT_VALUES; v++) {
            r->columns += (f->in->values >> v & 1) != 0;
        }
    }
    list_all(r);
    for (int i = 0; i < count; i++) {
        survey(r, s, i);
    }
    return r;
}

void rg_crack_fronts_open(rg_crack_fronts *r, int capacity) {
    size_t row = (size_t)(r->count * SUMS), rows = (size_t)capacity;
    r->now = RG_NEW(rg_exact_sum, (size_t)r->threads * row + 1);
    r->sum = RG_NEW(rg_exact_sum, rows * row + 1);
    r->row = RG_NEW(double, rows *(size_t)r->columns + 1);
}

/* ---- Words ---- */

int rg_crack_fronts_columns(const rg_crack_fronts *r) {
    return r->columns;
}

void rg_crack_fronts_header(const rg_crack_fronts *r, FILE *out) {
    for (int i = 0; i < r->count; i++) {
        for (int v = 0; v < RG_FRONT_VALUES; v++) {
            if ((r->front[i].in->values >> v & 1) != 0) {
                fprintf(out, ",%s_%s", r->front[i].in->name, value_name[v]);
            }
        }
    }
}

void rg_crack_fronts_print(const rg_crack_fronts *r, FILE *out) {
    for (int i = 0; i < r->count; i++) {
        const front *f = &r->front[i];
        fprintf(out, "crack front    %s: %.4g m long, %lld elements%s, %lld sides of faces behind it%s\n",
                f->in->name, f->length, (long long)f->elements.count, f->elements.of,
                (long long)f->faces.count, f->faces.of);
    }
}

void rg_crack_fronts_register(rg_crack_fronts *r, rg_state *st) {
    if (r->move) {
        rg_state_add(st, "crack_fronts", RG_OF_RUN, RG_STATE_DOUBLE, r->count, r->shift);
    }
}

void rg_crack_fronts_free(rg_crack_fronts *r) {
    if (r != NULL) {
        void *blocks[] = {r->front, r->shift, r->tile_begin, r->entry, r->now, r->sum, r->row, r};
        for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) {
            rg_free(blocks[i]);
        }
    }
}
