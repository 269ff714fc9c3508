/* What snapshots give the writer, of a state drawn at random, against the numbers of the mesh, on any number
 * of ranks. The writer is the test's own. Prints TAP from rank 0. */
#include "output/snapshot.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/mem.h"
#include "case/expr.h"
#include "diagnostics/crack_surface.h"
#include "domain/element.h"
#include "reference/reference.h"
#include "solver/step.h"
#include "solver/tile.h"
#include "solver/stepper.h"
#define FATAL_ONLY RG_USAGE
#include "support/fatal.h"
#include "support/random_state.h"
#include "support/tap.h"

enum { SEED = 23, ELEMENTS = 144, MOST_FIELDS = 20 };

/* ---- the end of a run ---- */

void rg_warn(const char *format, ...) {
    (void)format;
}

/* ---- a writer that keeps what it is given ---- */

typedef struct {
    char name[40], unit[10];
    enum rg_center center;
    int components;
    bool exact;
    double *data; /* of this rank's elements, or triangles */
} kept_field;

struct rg_writer {
    rg_writer_style style;
    int64_t total, first, count, triangles;
    double *points, *triangle;
    kept_field field[MOST_FIELDS];
    int fields, cracks; /* of the volume; from there on of the crack */
    int64_t step;
    double time;
    int ended, synced, closed, resumed;
    size_t windows;
};

static rg_writer kept;

/* All records of a source. */
static double *take(const rg_cell_source *x, size_t count) {
    double *all = RG_NEW(double, count * x->values + 1), *window = RG_NEW(double, x->cells * x->values + 1);
    size_t n = 0;
    for (size_t k = 0; k < x->windows; k++) {
        size_t here = x->get(x->of, k, window);
        if (here > x->cells || n + here > count) {
            printf("Bail out! too many cells\n");
            MPI_Abort(MPI_COMM_WORLD, 1);
        }
        memcpy(all + n * x->values, window, here * x->values * sizeof *all);
        n += here;
    }
    if (n != count) {
        printf("# %zu cells, not %zu\n", n, count);
        all[0] = NAN;
    }
    kept.windows = x->windows;
    rg_free(window);
    return all;
}

static void forget(void) {
    for (int k = 0; k < kept.fields; k++) {
        rg_free(kept.field[k].data);
    }
    rg_free(kept.points);
    rg_free(kept.triangle);
    memset(&kept, 0, sizeof kept);
}

rg_writer *rg_writer_open(const char *dir, MPI_Comm comm, rg_writer_style style, int64_t total, int64_t first,
                          int64_t count, const rg_cell_source *x) {
    (void)dir;
    (void)comm;
    forget();
    kept = (rg_writer){.style = style, .total = total, .first = first, .count = count};
    kept.points = take(x, (size_t)count);
    return &kept;
}

rg_writer *rg_writer_resume(const char *dir, MPI_Comm comm, rg_writer_style style, int64_t total,
                            int64_t first, int64_t count, const rg_writer_mark *mark) {
    (void)dir;
    (void)comm;
    forget();
    kept = (rg_writer){
        .style = style, .total = total, .first = first, .count = count, .resumed = (int)mark->crack};
    return &kept;
}

rg_writer_mark rg_writer_stand(const rg_writer *w) {
    return (rg_writer_mark){w->synced, 8, 9};
}

void rg_writer_sync(rg_writer *w) {
    w->synced++;
}

void rg_writer_frame(rg_writer *w, int64_t step, double time) {
    w->step = step;
    w->time = time;
}

static kept_field *add(const char *name, const char *unit, enum rg_center center, int components,
                       bool exact) {
    kept_field *f = &kept.field[kept.fields++];
    *f = (kept_field){.center = center, .components = components, .exact = exact};
    snprintf(f->name, sizeof f->name, "%s", name);
    snprintf(f->unit, sizeof f->unit, "%s", unit);
    return f;
}

void rg_writer_volume(rg_writer *w, size_t fields, const rg_volume_field *field,
                      const rg_cell_source *source) {
    double *record = take(source, (size_t)w->count);
    for (size_t k = 0; k < fields; k++) {
        const rg_volume_field *from = &field[k];
        kept_field *f = add(from->name, from->unit, from->center, from->components, from->exact);
        size_t width = (size_t)from->components * (from->center == RG_CENTER_NODE ? 10 : 1);
        f->data = RG_NEW(double, (size_t)w->count *width + 1);
        for (size_t i = 0; i < (size_t)w->count * width; i++) {
            f->data[i] = record[i / width * source->values + from->from + i % width];
        }
    }
    rg_free(record);
    w->cracks = w->fields;
}

void rg_writer_surface(rg_writer *w, int64_t count, const double *x) {
    w->triangles = count;
    w->triangle = RG_NEW(double, (size_t)(9 * count) + 1);
    memcpy(w->triangle, x, (size_t)(9 * count) * sizeof *x);
}

void rg_writer_surface_field(rg_writer *w, const char *name, const char *unit, int components,
                             const double *data) {
    kept_field *f = add(name, unit, RG_CENTER_CELL, components, false);
    f->data = RG_NEW(double, (size_t)w->triangles + 1);
    memcpy(f->data, data, (size_t)w->triangles * sizeof *data);
}

void rg_writer_frame_end(rg_writer *w) {
    w->ended++;
}

void rg_writer_close(rg_writer *w) {
    w->closed++;
}

static const double *field_of(const char *name) {
    for (int k = 0; k < kept.fields; k++) {
        if (strcmp(kept.field[k].name, name) == 0) {
            return kept.field[k].data;
        }
    }
    printf("# no field %s\n", name);
    return NULL;
}

/* The fields in one line. */
static const char *fields_line(void) {
    static char line[2000];
    line[0] = '\0';
    for (int k = 0; k < kept.fields; k++) {
        const kept_field *f = &kept.field[k];
        size_t used = strlen(line);
        snprintf(line + used, sizeof line - used, "%s%s %s %s%d%s;", k == kept.cracks ? "| " : "", f->name,
                 f->unit, f->center == RG_CENTER_NODE ? "node" : "cell", f->components, f->exact ? "!" : "");
    }
    return line;
}

/* ---- what is known of all elements ---- */

typedef struct {
    double cauchy[ELEMENTS][RG_GAUSS][6], internal[ELEMENTS][RG_GAUSS][RG_INTERNAL], owner[ELEMENTS],
        fragment[ELEMENTS], temperature[ELEMENTS];
} known;

/* Of `heat`. */
static double prescribed(const double x[3], double t) {
    return 300 + 2e4 * x[2] - 1e4 * x[0] + 1e9 * t;
}

static void know_tile(const random_state *r, const rg_tile *t, const rg_fragment_parts *p, known *all) {
    static _Alignas(64) double cauchy[RG_GAUSS * 6 * RG_LANES], internal[RG_GAUSS * RG_INTERNAL * RG_LANES];
    const rg_solver *s = r->solver;
    rg_tile_receive(s, t, s->work);
    for (size_t slot = t->begin * RG_LANES; slot < t->end * RG_LANES; slot++) {
        rg_gid id = s->domain->id[slot];
        if (id < 0) {
            continue;
        }
        size_t block = slot / RG_LANES - t->begin, lane = slot % RG_LANES;
        rg_bulk_args bulk = rg_tile_bulk(s, t, s->work, block);
        bool history = rg_material_history(bulk.material.model) > 0;
        rg_bulk_state_args args = {.bulk = &bulk, .cauchy = cauchy, .internal = history ? internal : NULL};
        rg_reference_bulk_state(&args, block, block + 1);
        for (size_t k = 0; k < RG_GAUSS * 6; k++) {
            all->cauchy[id][k / 6][k % 6] = cauchy[k * RG_LANES + lane];
        }
        for (size_t k = 0; history && k < RG_GAUSS * RG_INTERNAL; k++) {
            all->internal[id][k / RG_INTERNAL][k % RG_INTERNAL] = internal[k * RG_LANES + lane];
        }
        rg_material_model model = bulk.material.model;
        for (int g = 0; g < RG_GAUSS; g++) {
            double x[3], own = internal[(g * RG_INTERNAL + RG_INTERNAL_TEMPERATURE) * RG_LANES + (int)lane];
            rg_gauss_position(s->domain->corner + 12 * slot, g, x);
            all->temperature[id] += (model == RG_MATERIAL_JOHNSON_COOK ? own : prescribed(x, s->time)) / 4;
        }
        all->owner[id] = s->rank;
        all->fragment[id] = (double)p->label[p->of[slot]].id;
    }
}

static known *know(const random_state *r, const rg_fragment_parts *p) {
    known *all = RG_NEW(known, 1);
    for (size_t t = 0; t < r->solver->domain->tiles; t++) {
        know_tile(r, &r->solver->domain->tile[t], p, all);
    }
    MPI_Allreduce(MPI_IN_PLACE, all, sizeof *all / sizeof(double), MPI_DOUBLE, MPI_SUM, r->solver->comm);
    return all;
}

/* ---- comparisons, element by element; row i of this rank is of element id[i] ---- */

static bool near(double found, double wanted, double apart) {
    bool good = fabs(found - wanted) <= apart || found == wanted;
    if (!good) {
        printf("# %.17g, not %.17g\n", found, wanted);
    }
    return good;
}

/* Local node at a place of an element, which output has put at another number. */
static int node_at(double x[4][3], const double *place) {
    for (int n = 0; n < RG_NODES; n++) {
        double at[3];
        rg_node_position(x[0], n, at);
        if (at[0] == place[0] && at[1] == place[1] && at[2] == place[2]) {
            return n;
        }
    }
    return -1;
}

static double handedness(const double *x) {
    double e[3][3], cross[3];
    for (int k = 0; k < 9; k++) {
        e[k / 3][k % 3] = x[3 * (k / 3 + 1) + k % 3] - x[k % 3];
    }
    rg_reference_cross(e[1], e[2], cross);
    return rg_reference_dot(e[0], cross);
}

static bool nodes_good(const random_state *r, const rg_gid *id, int64_t count, const double *points) {
    static const int edge[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};
    const double *u = field_of("displacement"), *v = field_of("velocity");
    bool good = u != NULL && v != NULL;
    for (int64_t i = 0; good && i < count; i++) {
        const double *x = points + 30 * i;
        double corner[4][3];
        mesh_corners(r->mesh, id[i], corner);
        good = handedness(x) > 0;
        for (int k = 0; k < 18; k++) {
            const int *ends = edge[k / 3];
            good = near(x[12 + k], (x[3 * ends[0] + k % 3] + x[3 * ends[1] + k % 3]) / 2, 1e-18) && good;
        }
        for (int n = 0; good && n < RG_NODES; n++) {
            int from = node_at(corner, x + 3 * n);
            good = from >= 0 && (n < 4) == (from < 4);
            for (int c = 0; good && c < 3; c++) {
                good = u[30 * i + 3 * n + c] == drawn_u(SEED, id[i], from, c) &&
                       v[30 * i + 3 * n + c] == drawn_now(SEED, id[i], from, c);
            }
        }
    }
    return good;
}

static bool principal_good(const double s[6], const double *value, double scale) {
    double a = value[0], b = value[1], c = value[2];
    double det = s[0] * (s[1] * s[2] - s[3] * s[3]) - s[5] * (s[5] * s[2] - s[3] * s[4]) +
                 s[4] * (s[5] * s[3] - s[1] * s[4]);
    double two = s[0] * s[1] + s[1] * s[2] + s[2] * s[0] - s[3] * s[3] - s[4] * s[4] - s[5] * s[5];
    return a >= b && b >= c && near(a + b + c, s[0] + s[1] + s[2], 1e-11 * scale) &&
           near(a * b + b * c + c * a, two, 1e-11 * scale * scale) &&
           near(a * b * c, det, 1e-11 * scale * scale * scale);
}

static bool stresses_good(const known *all, const rg_gid *id, int64_t count) {
    const double *stress = field_of("stress"), *mean = field_of("mean_stress"),
                 *principal = field_of("principal_stress"), *triaxiality = field_of("triaxiality");
    bool good = stress != NULL && mean != NULL && principal != NULL && triaxiality != NULL;
    for (int64_t i = 0; good && i < count; i++) {
        double s[6], scale = 0, square = 0;
        for (int k = 0; k < 6; k++) {
            s[k] = 0;
            for (int g = 0; g < RG_GAUSS; g++) {
                s[k] += all->cauchy[id[i]][g][k] / 4;
                scale = fmax(scale, fabs(all->cauchy[id[i]][g][k]));
            }
        }
        for (int k = 0; k < 6; k++) {
            good = near(stress[6 * i + k], s[k], 1e-11 * scale) && good;
        }
        double m = (s[0] + s[1] + s[2]) / 3;
        for (int k = 0; k < 3; k++) { /* von Mises by differences */
            double d = s[k] - s[(k + 1) % 3];
            square += d * d / 2 + 3 * s[3 + k] * s[3 + k];
        }
        good = near(mean[i], m, 1e-11 * scale) && near(triaxiality[i], m / sqrt(square), 1e-9) &&
               principal_good(s, principal + 3 * i, scale) && good;
    }
    return good;
}

static bool internals_good(const known *all, const rg_gid *id, int64_t count) {
    const double *damage = field_of("damage"), *regime = field_of("regime"),
                 *plastic = field_of("plastic_strain"), *volume = field_of("plastic_volume"),
                 *bulking = field_of("bulking_pressure"), *temperature = field_of("temperature");
    bool good = damage != NULL && regime != NULL && plastic != NULL && volume != NULL && bulking != NULL &&
                temperature != NULL;
    for (int64_t i = 0; good && i < count; i++) {
        double mean[RG_INTERNAL] = {0}, most = 0;
        for (int g = 0; g < RG_GAUSS; g++) {
            for (int k = 0; k < RG_INTERNAL; k++) {
                mean[k] += all->internal[id[i]][g][k] / 4;
            }
            most = fmax(most, all->internal[id[i]][g][RG_INTERNAL_REGIME]);
        }
        good = near(damage[i], mean[RG_INTERNAL_DAMAGE], 1e-12) && regime[i] == most &&
               near(plastic[i], mean[RG_INTERNAL_PLASTIC], 1e-12) &&
               near(volume[i], mean[RG_INTERNAL_VOLUME], 1e-12) &&
               near(bulking[i], mean[RG_INTERNAL_BULKING], 1e-12) &&
               near(temperature[i], all->temperature[id[i]], 1e-9);
    }
    return good;
}

static bool numbers_good(const random_state *r, const known *all, const rg_gid *id, int64_t count) {
    const double *owner = field_of("rank"), *fragment = field_of("fragment"),
                 *material = field_of("material");
    bool good = owner != NULL && fragment != NULL && material != NULL;
    for (int64_t i = 0; good && i < count; i++) {
        good = owner[i] == all->owner[id[i]] && fragment[i] == all->fragment[id[i]] &&
               material[i] == mesh_material(r, id[i]);
    }
    return good;
}

static bool in_region(const rg_expr *region, const double *x, int points) {
    double middle[3] = {0, 0, 0};
    for (int k = 0; k < 3 * points; k++) {
        middle[k % 3] += x[k] / points;
    }
    double value = region == NULL ? 1 : rg_expr_value(region, middle, 0);
    return isfinite(value) && value != 0;
}

static bool cracks_good(const random_state *r) {
    rg_crack_face *face;
    size_t count = rg_crack_surface(r->solver, &face);
    int64_t n = 0;
    bool good = true;
    for (size_t i = 0; i < count; i++) {
        if (!in_region(r->input->output.region, face[i].x[0], 3)) {
            continue;
        }
        double wanted[] = {face[i].opening, face[i].slip, face[i].damage, face[i].time, rank};
        good = n < kept.triangles && memcmp(kept.triangle + 9 * n, face[i].x, sizeof face[i].x) == 0 && good;
        for (int k = kept.cracks; good && k < kept.fields; k++) {
            good = kept.field[k].data[n] == wanted[k - kept.cracks];
        }
        n++;
    }
    rg_free(face);
    return good && n == kept.triangles;
}

/* ---- cases ---- */

/* Elements that are written, in global order; those of this rank begin at `first`. */
static int64_t chosen(const random_state *r, rg_gid *list) {
    int64_t n = 0;
    for (rg_gid e = 0; e < r->mesh->elements; e++) {
        double x[4][3];
        mesh_corners(r->mesh, e, x);
        if (in_region(r->input->output.region, x[0], 4)) {
            list[n++] = e;
        }
    }
    return n;
}

/* A rank's share: those of its slab of the global order. */
static void check_share(const char *name, const random_state *r, const rg_snapshots *w, const rg_gid *list,
                        int64_t total) {
    int64_t first = 0, count = 0;
    for (int64_t i = 0; i < total; i++) {
        int owner = rg_slab_owner(r->mesh->elements, r->solver->ranks, list[i]);
        first += owner < rank;
        count += owner == rank;
    }
    report(kept.total == total && kept.first == first && kept.count == count && w->total == total, name,
           "whose are which");
}

static const char all_fields[] =
    "output.fields=[displacement, velocity, stress, mean_stress, principal_stress, triaxiality, "
    "damage, regime, plastic_strain, crack, rank, fragment, material, plastic_volume, bulking_pressure, "
    "temperature]";
static const char rock[] =
    "materials=[{name: rock, where: \"x + z > 3.1e-3\", model: deshpande-evans, shear: 146e9, poisson: "
    "0.2, density: 3700, flaw_radius: 19e-6, flaw_density: 1e12, toughness: 3e6, yield_stress: 4e9}, "
    "{name: copper, where: \"x + z < 2.2e-3\", preset: copper-ofhc}, "
    "{name: ceramic, where: \"y < -0.3e-3\", preset: alumina-jh2}, "
    "{name: sand, where: \"y > 0.5e-3\", preset: berea-sandstone, expansion: 1e-5}]";
static const char heat[] = "temperature={value: \"300 + 2e4*z - 1e4*x + 1e9*t\", free: 290}";
static const char whole_line[] =
    "displacement m node3;velocity m/s node3;stress Pa cell6;mean_stress Pa cell1;principal_stress Pa "
    "cell3;damage 1 "
    "cell1;regime 1 cell1;plastic_strain 1 cell1;plastic_volume 1 cell1;bulking_pressure Pa cell1;"
    "temperature K cell1;triaxiality 1 cell1;rank 1 cell1!;fragment 1 "
    "cell1!;material 1 cell1!;| "
    "opening m cell1;slip m cell1;damage 1 cell1;time_of_failure s cell1;rank 1 cell1;";

static void check_all(const char *name, int changes, const char *const change[], rg_writer_style style) {
    random_state r = random_state_make(changes, change, MPI_COMM_WORLD);
    random_state_draw(&r, SEED);
    rg_slab *slab = NULL;
    rg_snapshots *w = rg_snapshots_open(r.solver, &slab);
    rg_gid *list = RG_NEW(rg_gid, (size_t)r.mesh->elements);
    int64_t total = chosen(&r, list);
    check_share(name, &r, w, list, total);
    const rg_gid *id = list + kept.first;
    double *points = kept.points;
    kept.points = NULL;
    rg_fragment_parts *parts = rg_fragments_find(r.solver);
    known *all = know(&r, parts);
    rg_snapshots_write(w, r.solver, parts);
    report(kept.step == r.solver->step && kept.time == r.solver->time && kept.ended == 1 &&
               kept.style.single == style.single && kept.style.deflate == style.deflate,
           name, "a frame");
    report(strcmp(fields_line(), whole_line) == 0, name, "fields, units, places");
    report(nodes_good(&r, id, kept.count, points), name, "nodes in the order of output");
    report(stresses_good(all, id, kept.count), name, "stresses");
    report(internals_good(all, id, kept.count), name, "internal variables");
    report(numbers_good(&r, all, id, kept.count), name, "ranks, fragments, materials");
    report(cracks_good(&r), name, "cracks");
    rg_writer_mark mark = rg_snapshots_sync(w);
    rg_snapshots_close(w);
    report(mark.frames == 1 && mark.volume == 8 && mark.crack == 9 && kept.closed == 1, name,
           "on the disk and closed");
    w = rg_snapshots_reopen(r.solver, &slab, &mark);
    report(kept.resumed == 9 && kept.style.single == style.single && kept.style.deflate == style.deflate,
           name, "reopened");
    check_share(name, &r, w, list, total);
    rg_snapshots_close(w);
    forget();
    rg_free(points);
    rg_free(all);
    rg_free(list);
    rg_fragment_parts_free(parts);
    rg_slab_free(slab);
    random_state_free(&r);
}

/* Each field alone makes just that. */
static void check_single_fields(void) {
    static const char *const word[] = {
        "displacement", "velocity", "stress",         "mean_stress",    "principal_stress",
        "triaxiality",  "rank",     "fragment",       "material",       "crack",
        "damage",       "regime",   "plastic_strain", "plastic_volume", "bulking_pressure",
        "temperature"};
    const char *change[] = {rock, heat, all_fields};
    random_state r = random_state_make(3, change, MPI_COMM_WORLD);
    random_state_draw(&r, SEED);
    rg_fragment_parts *parts = rg_fragments_find(r.solver);
    static const unsigned bit[] = {1,    2,  4,  8,   16,  512,  1024,  2048,
                                   4096, 32, 64, 128, 256, 8192, 16384, 32768};
    bool good = true;
    rg_slab *slab = NULL;
    for (size_t k = 0; k < sizeof word / sizeof *word; k++) {
        r.input->output.fields = bit[k];
        rg_snapshots *w = rg_snapshots_open(r.solver, &slab);
        good = rg_snapshots_show_fragments(w) == (strcmp(word[k], "fragment") == 0) && good;
        rg_snapshots_write(w, r.solver, parts);
        bool crack = bit[k] == RG_FIELD_CRACK;
        good = kept.fields == (crack ? 4 : 1) &&
               strcmp(kept.field[0].name, crack ? "opening" : word[k]) == 0 && good;
        rg_snapshots_close(w);
    }
    report(good, "fields", "one at a time");
    r.input->output.fields = 0;
    forget();
    rg_snapshots *w = rg_snapshots_open(r.solver, &slab);
    rg_snapshots_write(w, r.solver, parts);
    rg_writer_mark mark = rg_snapshots_sync(w);
    good = kept.ended == 0 && kept.total == 0 && mark.frames == 0 && mark.volume == 0 && mark.crack == 0;
    rg_snapshots_close(w);
    w = rg_snapshots_reopen(r.solver, &slab, &mark);
    rg_snapshots_close(w);
    report(good && kept.closed == 0, "fields", "none");
    forget();
    rg_fragment_parts_free(parts);
    rg_slab_free(slab);
    random_state_free(&r);
}

static void check_rest(void) {
    const char *change[] = {"output.fields=[triaxiality, principal_stress]"};
    random_state r = random_state_make(1, change, MPI_COMM_WORLD);
    rg_solver_resume(r.solver);
    rg_halo_finish(r.solver->stepper->halo_u[r.solver->stepper->current]);
    rg_slab *slab = NULL;
    rg_snapshots *w = rg_snapshots_open(r.solver, &slab);
    rg_snapshots_write(w, r.solver, NULL);
    const double *found = field_of("triaxiality"), *principal = field_of("principal_stress");
    bool good = true;
    for (int64_t i = 0; i < kept.count; i++) {
        good = found[i] == 0 && principal[3 * i] == 0 && good;
    }
    report(good, "stresses", "none at rest");
    rg_snapshots_close(w);
    forget();
    rg_slab_free(slab);
    random_state_free(&r);
}

/* So many elements that they go in two windows. */
static void check_windows(void) {
    const char *change[] = {"mesh.cells=[15, 14, 14]",
                            "bodies=[]",
                            "boundary=[]",
                            "interface.friction=0",
                            "output.fields=[displacement, velocity]",
                            "output.region='sin(1e5*y) > -0.3'"};
    random_state r = random_state_make(6, change, MPI_COMM_WORLD);
    random_state_draw(&r, SEED);
    rg_slab *slab = NULL;
    rg_snapshots *w = rg_snapshots_open(r.solver, &slab);
    rg_gid *list = RG_NEW(rg_gid, (size_t)r.mesh->elements);
    int64_t total = chosen(&r, list);
    check_share("windows", &r, w, list, total);
    double *points = kept.points;
    kept.points = NULL;
    rg_snapshots_write(w, r.solver, NULL);
    report(nodes_good(&r, list + kept.first, kept.count, points), "windows", "nodes");
    report(kept.windows == (r.solver->ranks == 1 ? 2 : 1), "windows", "as many as needed");
    rg_snapshots_close(w);
    forget();
    rg_free(points);
    rg_free(list);
    rg_slab_free(slab);
    random_state_free(&r);
}

static bool refused(random_state *r, const char *region, const char *words) {
    rg_slab *slab = NULL;
    char *message = NULL;
    rg_expr_free(r->input->output.region);
    r->input->output.region = rg_expr_new(region, &message);
    said[0] = '\0';
    expect_fatal = true;
    if (setjmp(escape) == 0) {
        rg_snapshots_open(r->solver, &slab);
    }
    expect_fatal = false;
    if (strstr(said, words) != said) {
        printf("# %s\n", said);
    }
    return strstr(said, words) == said;
}

static void check_regions(void) {
    bool good = true;
    if (rank == 0) {
        random_state r = random_state_make(0, NULL, MPI_COMM_SELF);
        good = refused(&r, "sqrt(x - 0.5e-3)",
                       "random.yaml: output.region: sqrt(x - 0.5e-3) is not finite at (0.0004") &&
               refused(&r, "z > 5e-3", "random.yaml: output.region: z > 5e-3: no element is in it");
        random_state_free(&r);
    }
    report(good, "region", "that is none");
}

/* A face where the region's expression is infinite is not written. */
static void check_infinite_face(void) {
    bool good = true;
    if (rank == 0) {
        const char *change[] = {"output.fields=[crack]"};
        random_state r = random_state_make(1, change, MPI_COMM_SELF);
        random_state_draw(&r, SEED);
        rg_crack_face *face;
        size_t count = rg_crack_surface(r.solver, &face);
        double y = 0;
        for (int a = 0; a < 3; a++) {
            y += face[7].x[a][1] / 3;
        }
        char region[60], *message = NULL;
        snprintf(region, sizeof region, "1/(y - (%.17g))", y);
        r.input->output.region = rg_expr_new(region, &message);
        rg_slab *slab = NULL;
        rg_snapshots *w = rg_snapshots_open(r.solver, &slab);
        rg_snapshots_write(w, r.solver, NULL);
        good = kept.triangles == (int64_t)count - 1 && cracks_good(&r);
        rg_snapshots_close(w);
        forget();
        rg_free(face);
        rg_slab_free(slab);
        random_state_free(&r);
    }
    report(good, "region", "infinite at a face");
}

static void check_bytes(void) {
    rg_case c = {.output = {.fields = 0}};
    bool good = rg_snapshots_bytes(&c, 1000) == 0;
    c.output.fields = 1;
    good = rg_snapshots_bytes(&c, 1000) == 1000 * (4 + 16) + 4 * (4 << 20) && good;
    c.output.compression = 1;
    good = rg_snapshots_bytes(&c, 1000) == 1000 * (4 + 16) + 4 * 1000 * 240 && good;
    report(good, "snapshots", "memory");
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    const char *change[] = {all_fields,
                            rock,
                            heat,
                            "output.region='y < 0.45e-3'",
                            "output.precision=single",
                            "output.compression=4"};
    check_all("whole", 3, change, (rg_writer_style){false, 0});
    check_all("part", 6, change, (rg_writer_style){true, 4});
    check_single_fields();
    check_rest();
    check_windows();
    check_regions();
    check_infinite_face();
    check_bytes();
    return finish();
}
