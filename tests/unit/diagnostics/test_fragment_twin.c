/* Fragments of a state cracked at random, and overlaps of debris thrown together, against searches of all
 * pairs in the whole mesh and integrals of high order, on any number of ranks. Prints TAP from rank 0. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/hash.h"
#include "base/mem.h"
#include "diagnostics/fragment.h"
#include "diagnostics/overlap.h"
#include "domain/element.h"
#include "reference/reference.h"
#include "solver/tile.h"
#include "support/random_state.h"
#include "support/tap_memory.h"

/* Of the seeds the latter half make debris. */
enum { SEEDS = 4, THROWS = 40 };
static uint64_t seed_of(int k) {
    return k % SEEDS < SEEDS / 2 ? (uint64_t)(k % SEEDS) : RANDOM_DEBRIS + (uint64_t)(k % SEEDS);
}

#define EXACT 1e-11 /* of sums of some thousand terms, each rounded */

static bool near(double found, double wanted, double scale) {
    bool good = fabs(found - wanted) <= EXACT * scale;
    if (!good) {
        printf("# %.17g, not %.17g: %.2g\n", found, wanted, fabs(found - wanted) / scale);
    }
    return good;
}

/* ---- fragments of the whole mesh ---- */

static bool face_holds(const random_state *r, uint64_t seed, rg_gid face) {
    for (int q = 0; q < RG_POINTS; q++) {
        if ((drawn_broken(seed, face) >> q & 1) == 0 || drawn_damage(seed, face, q) < 1) {
            return true;
        }
    }
    (void)r;
    return false;
}

/* Whether a face carries an interface: all do, but of shared nodes those alone that lie in the plane of the
 * case. */
static bool carries(const random_state *r, rg_gid face) {
    if (r->solver->conforming_faces == NULL) {
        return true;
    }
    double x[4][3], middle[3] = {0, 0, 0};
    mesh_corners(r->mesh, face / 4, x);
    for (int a = 0; a < 3; a++) {
        for (int c = 0; c < 3; c++) {
            middle[c] += x[rg_face_node[face % 4][a]][c] / 3;
        }
    }
    return rg_expr_face_value(r->input->interface.faces, middle, (double[3]){0, 0, 0}) != 0;
}

/* The smallest number in the fragment of each element: spread until nothing changes. */
static void find_ids(const random_state *r, uint64_t seed, rg_gid *id) {
    const rg_mesh *m = r->mesh;
    for (rg_gid e = 0; e < m->elements; e++) {
        id[e] = e;
    }
    for (bool changed = true; changed;) {
        changed = false;
        for (rg_gid k = 0; k < 4 * m->elements; k++) {
            rg_gid other = m->neighbour[k], face = face_key(m, k / 4, (int)(k % 4));
            if (other >= 0 && id[other] < id[k / 4] && (!carries(r, face) || face_holds(r, seed, face))) {
                id[k / 4] = id[other];
                changed = true;
            }
        }
    }
}

static void current_corners(const random_state *r, uint64_t seed, rg_gid e, double x[4][3]) {
    mesh_corners(r->mesh, e, x);
    for (int k = 0; k < 12; k++) {
        x[k / 3][k % 3] += drawn_u(seed, e, k / 3, k % 3);
    }
}

static bool parts_good(const random_state *r, uint64_t seed, const rg_gid *id, const rg_fragment_parts *p) {
    const rg_domain *d = r->solver->domain;
    uint8_t *here = RG_NEW(uint8_t, (size_t)r->mesh->elements);
    bool good = true;
    size_t members = 0, fragments = 0;
    for (size_t slot = 0; slot < d->blocks * RG_LANES; slot++) {
        if (d->id[slot] < 0) {
            good = p->of[slot] == -1 && good;
            continue;
        }
        rg_gid wanted = id[d->id[slot]];
        good = p->of[slot] >= 0 && p->label[p->of[slot]].id == wanted && good;
        fragments += !here[wanted];
        here[wanted] = 1;
    }
    good = p->count == fragments && p->start[0] == 0 && good;
    for (size_t k = 0; good && k < p->count; k++) {
        double x[4][3];
        rg_gid whole = 0, own = (rg_gid)(p->start[k + 1] - p->start[k]);
        for (rg_gid e = 0; e < r->mesh->elements; e++) {
            whole += id[e] == p->label[k].id;
        }
        good = (k == 0 || p->label[k].id > p->label[k - 1].id) && p->shared[k] == (own < whole) && good;
        current_corners(r, seed, p->label[k].id, x);
        for (int c = 0; c < 3; c++) {
            double middle = (x[0][c] + x[1][c] + x[2][c] + x[3][c]) / 4;
            good = fabs(p->label[k].anchor[c] - middle) < 1e-17 && good;
        }
        for (size_t i = p->start[k]; i < p->start[k + 1]; i++) {
            good = p->of[p->member[i]] == (rg_lid)k &&
                   (i == p->start[k] || p->member[i] > p->member[i - 1]) && good;
            members++;
        }
    }
    rg_free(here);
    return good && members == d->elements;
}

/* ---- integrals ---- */

static const double gauss_x[4] = {0.069431844202973712, 0.33000947820757187, 0.66999052179242813,
                                  0.93056815579702629};
static const double gauss_w[4] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                  0.17392742256872693};

typedef struct {
    int64_t elements;
    double mass, volume, kinetic, moment[3], momentum[3], angular[3],
        second[3][3]; /* about the origin `from` */
} integrals;

/* Point k of an element's mass, and its share: the nodes of a lumped one, else those of a rule that is exact.
 */
static double mass_point(rg_mass mass, int k, double l[4]) {
    static const int end[RG_NODES][2] = {{0, 0}, {1, 1}, {2, 2}, {3, 3}, {0, 1},
                                         {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};
    if (mass == RG_MASS_LUMPED) {
        for (int i = 0; i < 4; i++) {
            l[i] = 0.5 * (end[k][0] == i) + 0.5 * (end[k][1] == i);
        }
        return k < 4 ? 1. / 36 : 4. / 27;
    }
    double a = gauss_x[k % 4], b = gauss_x[k / 4 % 4], c = gauss_x[k / 16];
    l[0] = a;
    l[1] = (1 - a) * b;
    l[2] = (1 - a) * (1 - b) * c;
    l[3] = (1 - a) * (1 - b) * (1 - c);
    return 6 * gauss_w[k % 4] * gauss_w[k / 4 % 4] * gauss_w[k / 16] * (1 - a) * (1 - a) * (1 - b);
}

static void integrate(const random_state *r, uint64_t seed, rg_gid e, const double from[3], integrals *sum) {
    double x[4][3], density = r->solver->model->material[mesh_material(r, e)].density;
    mesh_corners(r->mesh, e, x);
    double volume = tet_volume(x);
    sum->elements++;
    sum->volume += volume;
    sum->mass += density * volume;
    for (int k = 0; k < (r->solver->input->mass == RG_MASS_LUMPED ? RG_NODES : 64); k++) {
        double l[4], N[RG_NODES], w = density * volume * mass_point(r->solver->input->mass, k, l);
        double at[3], v[3] = {0, 0, 0}, turn[3];
        rg_shape(l, N);
        for (int i = 0; i < 3; i++) {
            at[i] = l[0] * x[0][i] + l[1] * x[1][i] + l[2] * x[2][i] + l[3] * x[3][i] - from[i];
            for (int n = 0; n < RG_NODES; n++) {
                at[i] += N[n] * drawn_u(seed, e, n, i);
                v[i] += N[n] * drawn_now(seed, e, n, i);
            }
        }
        rg_reference_cross(at, v, turn);
        sum->kinetic += 0.5 * w * rg_reference_dot(v, v);
        for (int i = 0; i < 3; i++) {
            sum->moment[i] += w * at[i];
            sum->momentum[i] += w * v[i];
            sum->angular[i] += w * turn[i];
            for (int j = 0; j < 3; j++) {
                sum->second[i][j] += w * at[i] * at[j];
            }
        }
    }
}

/* Solves I x = b by Cramer's rule. */
static void solve(double I[3][3], const double b[3], double x[3]) {
    double column[3][3], cross[3];
    for (int k = 0; k < 9; k++) {
        column[k % 3][k / 3] = I[k / 3][k % 3];
    }
    rg_reference_cross(column[1], column[2], cross);
    double det = rg_reference_dot(column[0], cross);
    x[0] = rg_reference_dot(b, cross) / det;
    rg_reference_cross(b, column[2], cross);
    x[1] = rg_reference_dot(column[0], cross) / det;
    rg_reference_cross(column[1], b, cross);
    x[2] = rg_reference_dot(column[0], cross) / det;
}

/* Moments and axes of inertia, without knowing how they were found. */
static bool axes_good(const rg_fragment *f, double I[3][3]) {
    double trace = I[0][0] + I[1][1] + I[2][2];
    bool good = f->inertia[0] <= f->inertia[1] && f->inertia[1] <= f->inertia[2] && f->inertia[0] > 0;
    for (int k = 0; k < 3; k++) {
        const double *a = f->axis[k];
        double largest = 0, moment = 0;
        for (int c = 0; c < 3; c++) {
            double row = I[c][0] * a[0] + I[c][1] * a[1] + I[c][2] * a[2];
            good = near(row, f->inertia[k] * a[c], trace) && good;
            largest = fabs(a[c]) > fabs(largest) ? a[c] : largest;
            good = near(rg_reference_dot(a, f->axis[c]), c == k, 1) && good;
        }
        int p = (k + 1) % 3, q = (k + 2) % 3;
        moment = f->mass / 12 * (f->size[p] * f->size[p] + f->size[q] * f->size[q]);
        good = largest > 0 && near(moment, f->inertia[k], trace) && f->size[k] > 0 && good;
    }
    return good;
}

static bool fragment_good(const random_state *r, uint64_t seed, const rg_gid *id, const rg_fragment *f) {
    integrals sum = {0};
    double x[4][3], from[3], I[3][3], spin[3], turn[3], omega[3];
    current_corners(r, seed, f->id, x);
    for (int c = 0; c < 3; c++) {
        from[c] = (x[0][c] + x[1][c] + x[2][c] + x[3][c]) / 4;
    }
    for (rg_gid e = 0; e < r->mesh->elements; e++) {
        if (id[e] == f->id) {
            integrate(r, seed, e, from, &sum);
        }
    }
    bool good = f->elements == sum.elements && near(f->mass, sum.mass, sum.mass) &&
                near(f->volume, sum.volume, sum.volume) && near(f->kinetic, sum.kinetic, sum.kinetic);
    double trace = sum.second[0][0] + sum.second[1][1] + sum.second[2][2], arm[3], speed = 0;
    for (int c = 0; c < 3; c++) {
        arm[c] = sum.moment[c] / sum.mass;
        trace -= sum.mass * arm[c] * arm[c];
        speed += fabs(sum.momentum[c]);
    }
    rg_reference_cross(arm, sum.momentum, turn);
    for (int c = 0; c < 3; c++) {
        good = near(f->centroid[c], from[c] + arm[c], 1e-3) && near(f->momentum[c], sum.momentum[c], speed) &&
               good;
        spin[c] = sum.angular[c] - turn[c];
        for (int k = 0; k < 3; k++) {
            I[c][k] = (c == k ? trace : 0) - (sum.second[c][k] - sum.mass * arm[c] * arm[k]);
        }
    }
    solve(I, spin, omega);
    double rotational = 0.5 * rg_reference_dot(spin, omega);
    return axes_good(f, I) && near(f->rotational, rotational, sum.kinetic) && good;
}

static void check_fragments(const char *name, int changes, const char *const change[], int fewest) {
    random_state r = random_state_make(changes, change, MPI_COMM_WORLD);
    rg_gid *id = RG_NEW(rg_gid, (size_t)r.mesh->elements);
    bool parts = true, rows = true, order = true, several = false;
    int64_t count = 0, wanted = 0;
    for (int k = 0; k < SEEDS; k++) {
        uint64_t seed = seed_of(k);
        random_state_draw(&r, seed);
        find_ids(&r, seed, id);
        rg_fragment_parts *p = rg_fragments_find(r.solver);
        parts = parts_good(&r, seed, id, p) && parts;
        rg_fragment *row;
        size_t own = rg_fragments_measure(r.solver, p, &row);
        rg_gid ends[2] = {own > 0 ? row[0].id : -1, own > 0 ? row[own - 1].id : -1}, all[2 * 3];
        for (size_t i = 0; i < own; i++) {
            rows = id[row[i].id] == row[i].id && fragment_good(&r, seed, id, &row[i]) && rows;
            order = (i == 0 || row[i].id > row[i - 1].id) && order;
        }
        MPI_Allgather(ends, 2, MPI_INT64_T, all, 2, MPI_INT64_T, MPI_COMM_WORLD);
        rg_gid last = -1;
        for (int i = 0; i < r.solver->ranks; i++) { /* those of rank 0 first */
            order = (all[2 * i] < 0 || all[2 * i] > last) && order;
            last = all[2 * i] < 0 ? last : all[2 * i + 1];
        }
        int64_t total = (int64_t)own;
        MPI_Allreduce(MPI_IN_PLACE, &total, 1, MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD);
        count += total;
        for (rg_gid e = 0; e < r.mesh->elements; e++) {
            wanted += id[e] == e;
        }
        several = several || total > 1;
        rg_free(row);
        rg_fragment_parts_free(p);
    }
    report(parts, name, "which element is of which");
    report(rows, name, "what each of them is");
    report(order && count == wanted && wanted >= fewest && several, name, "each once, by number");
    rg_free(id);
    random_state_free(&r);
}

/* From 4096 elements on threads share a fragment: a box of 4374. */
static void check_large(void) {
    const char *change[] = {"mesh.cells=[9, 9, 9]", "bodies=[]", "boundary=[]", "interface.friction=0"};
    random_state r = random_state_make(4, change, MPI_COMM_WORLD);
    rg_fragment_parts *p = rg_fragments_find(r.solver);
    rg_fragment *row;
    size_t own = rg_fragments_measure(r.solver, p, &row);
    bool good = (own == 1) == (rank == 0);
    for (size_t i = 0; i < own; i++) {
        double steel = 0;
        for (rg_gid e = 0; e < r.mesh->elements; e++) {
            double x[4][3];
            mesh_corners(r.mesh, e, x);
            steel += mesh_material(&r, e) == 1 ? tet_volume(x) : 0;
        }
        double volume = 1.1e-3 * 1.7e-3 * 2.9e-3, mass = 2500 * volume + (7800 - 2500) * steel;
        good = row[i].id == 0 && row[i].elements == 4374 && near(row[i].volume, volume, volume) &&
               near(row[i].mass, mass, mass) && good;
    }
    report(good, "large", "one fragment of many elements");
    rg_free(row);
    rg_fragment_parts_free(p);
    random_state_free(&r);
}

/* ---- overlaps ---- */

/* Where a throw puts an element: pieces of a few elements fly apart, and into each other. */
static double thrown(uint64_t seed, rg_gid piece, int c, double spread) {
    double far = drawn(seed, DRAW_OTHER, piece, 11), sign = piece % 2 == 0 ? 1 : -1;
    return spread * drawn(seed, DRAW_OTHER, piece, c) + (far > 0.8 && c == (int)(seed % 3) ? 1e4 * sign : 0);
}

static bool inside(double x[4][3], const double point[3]) {
    double whole = tet_volume(x), sum = 0;
    for (int k = 0; k < 4; k++) {
        double y[4][3];
        memcpy(y, x, sizeof y);
        memcpy(y[k], point, sizeof y[k]);
        sum += tet_volume(y);
    }
    return sum <= whole * (1 + 1e-12);
}

static bool reaches(double a[4][3], double b[4][3]) {
    double middle[3], point[3];
    for (int c = 0; c < 3; c++) {
        middle[c] = (a[0][c] + a[1][c] + a[2][c] + a[3][c]) / 4;
    }
    bool found = inside(b, middle);
    for (int k = 0; k < 4; k++) {
        for (int c = 0; c < 3; c++) {
            point[c] = a[k][c] + (middle[c] - a[k][c]) / 4;
        }
        found = inside(b, point) || found;
    }
    return found;
}

/* Not searched: what is ten times as long as at rest, is nowhere, or lies beyond 2^20 cells. */
static bool lost(const rg_mesh *m, rg_gid e, double x[4][3], double cell) {
    double rest[4][3], size[2] = {0, 0};
    mesh_corners(m, e, rest);
    for (int c = 0; c < 3; c++) {
        for (int k = 0; k < 4; k++) {
            if (!(fabs(x[k][c]) < cell * 0x1p20)) {
                return true;
            }
        }
        for (int k = 0; k < 16; k++) {
            size[0] = fmax(size[0], x[k / 4][c] - x[k % 4][c]);
            size[1] = fmax(size[1], rest[k / 4][c] - rest[k % 4][c]);
        }
    }
    return size[0] > 10 * size[1];
}

static void search_all(const random_state *r, const rg_gid *id, double cell, double (*x)[4][3],
                       rg_gid pair[2]) {
    pair[0] = pair[1] = INT64_MAX;
    for (rg_gid a = 0; a < r->mesh->elements; a++) {
        for (rg_gid b = 0; b < a; b++) {
            rg_gid low = id[a] < id[b] ? id[a] : id[b], high = id[a] < id[b] ? id[b] : id[a];
            bool lower = low < pair[0] || (low == pair[0] && high < pair[1]);
            if (low != high && lower && !lost(r->mesh, a, x[a], cell) && !lost(r->mesh, b, x[b], cell) &&
                (reaches(x[a], x[b]) || reaches(x[b], x[a]))) {
                pair[0] = low;
                pair[1] = high;
            }
        }
    }
}

/* One in ten is blown up, up to twice what counts as torn; one in forty is nowhere. */
static double blown(uint64_t seed, rg_gid e) {
    double x = drawn(seed, DRAW_OTHER, e, 7);
    return x < -0.95 ? NAN : x > 0.8 ? 10 * (1 + drawn(seed, DRAW_OTHER, e, 8)) : 1;
}

static void throw(random_state * r, uint64_t seed, double spread, const rg_gid *id, double (*x)[4][3]) {
    for (rg_gid e = 0; e < r->mesh->elements; e++) {
        mesh_corners(r->mesh, e, x[e]);
        for (int k = 0; k < 12; k++) {
            double rest = x[e][k / 3][k % 3], middle = 0;
            for (int j = 0; j < 4; j++) {
                middle += r->mesh->x[3 * r->mesh->corner[4 * e + j] + k % 3] / 4;
            }
            x[e][k / 3][k % 3] =
                rest + thrown(seed, id[e], k % 3, spread) + (blown(seed, e) - 1) * (rest - middle);
        }
    }
    const rg_domain *d = r->solver->domain;
    for (size_t slot = 0; slot < d->blocks * RG_LANES; slot++) {
        for (int k = 0; k < 12 && d->id[slot] >= 0; k++) {
            size_t at = rg_node_index(slot, k / 3, k % 3);
            r->solver->u[at] = (rg_real)(x[d->id[slot]][k / 3][k % 3] - d->corner[12 * slot + (size_t)k]);
        }
    }
}

static void check_overlaps(void) {
    random_state r = random_state_make(0, NULL, MPI_COMM_WORLD);
    size_t n = (size_t)r.mesh->elements;
    rg_gid *id = RG_NEW(rg_gid, n);
    double(*x)[4][3] = rg_alloc(n, sizeof *x);
    int none = 0, found = 0, wrong = 0;
    for (uint64_t seed = 1; seed <= THROWS; seed++) {
        random_state_draw(&r, seed_of((int)seed));
        find_ids(&r, seed_of((int)seed), id);
        double spread = 1e-3 * exp2(20 * pow(drawn(seed, DRAW_OTHER, 0, 9), 4));
        double cell = 6e-4 * exp2(1.5 * drawn(seed, DRAW_OTHER, 0, 10));
        throw(&r, seed, spread, id, x);
        rg_fragment_parts *p = rg_fragments_find(r.solver);
        rg_gid pair[2], wanted[2];
        search_all(&r, id, cell, x, wanted);
        bool any = rg_overlap_find(r.solver, p, cell, pair);
        wrong += pair[0] != wanted[0] || pair[1] != wanted[1] || any != (wanted[0] < INT64_MAX);
        found += any;
        none += !any;
        rg_fragment_parts_free(p);
    }
    if (rank == 0) {
        printf("# %d with, %d without overlaps\n", found, none);
    }
    report(wrong == 0 && found >= THROWS / 4 && none >= THROWS / 8, "overlaps", "the lowest of all pairs");
    rg_free(x);
    rg_free(id);
    random_state_free(&r);
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    check_fragments("cracked", 0, NULL, 40);
    const char *shared[] = {"interface.form=continuous", "interface.faces='z > 1.4e-3 && z < 3.4e-3'",
                            "interface.friction=0", "boundary=[]"};
    check_fragments("shared nodes", 4, shared, 20);
    check_large();
    check_overlaps();
    return finish_with_nothing_left();
}
