/* Probes and the autopsy on a state drawn at random, against interpolation and geometry written anew, on any
 * number of ranks. Prints TAP from rank 0. */
#include "diagnostics/probe.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"
#include "base/mem.h"
#include "diagnostics/autopsy.h"
#include "domain/element.h"
#include "quadrature.h"
#include "reference/reference.h"
#include "solver/tile.h"
#include "support/fatal.h"
#include "support/random_state.h"
#include "support/tap.h"

enum { SEED = 17, PROBES = 3, BODIES = 2, COLUMNS = 1 + 12 * PROBES + 9 * BODIES, SAMPLES = 259 };

/* ---- the end of a run ---- */

void rg_warn(const char *format, ...) {
    (void)format;
}

/* ---- probes ---- */

static char place[200];

static const char *in(const char *name) {
    static char path[300];
    snprintf(path, sizeof path, "%s/%s", place, name);
    return path;
}

static random_state make(const char *probes, MPI_Comm comm) {
    char dir[300];
    snprintf(dir, sizeof dir, "output.dir=%s", place);
    const char *change[] = {dir, probes};
    random_state r = random_state_make(2, change, comm);
    random_state_draw(&r, SEED);
    return r;
}

/* Barycentric coordinates by ratios of volumes; whether x is inside, or on the surface. */
static bool holds(const rg_mesh *mesh, rg_gid e, const double at[3], double l[4]) {
    double x[4][3], smallest = 1;
    mesh_corners(mesh, e, x);
    rg_barycentric(x[0], at, l);
    for (int k = 0; k < 4; k++) {
        smallest = fmin(smallest, l[k]);
    }
    return smallest >= -1e-9;
}

/* First element that holds a point, and how many do. */
static rg_gid first_of(const rg_mesh *mesh, const double at[3], double l[4], int *several) {
    rg_gid first = -1;
    *several = 0;
    for (rg_gid e = mesh->elements - 1; e >= 0; e--) {
        double here[4];
        if (holds(mesh, e, at, here)) {
            first = e;
            memcpy(l, here, sizeof here);
            ++*several;
        }
    }
    return first;
}

/* Cauchy stress of element e at barycentric point l: what is linear and has the values of the Gauss points
 * there. On the rank that has the element; else zero. */
static void stress_of(const random_state *r, rg_gid e, const double l[4], double out[6]) {
    const rg_solver *s = r->solver;
    memset(out, 0, 6 * sizeof *out);
    for (size_t k = 0; k < s->domain->tiles; k++) {
        const rg_tile *t = &s->domain->tile[k];
        for (size_t slot = t->begin * RG_LANES; slot < t->end * RG_LANES; slot++) {
            if (s->domain->id[slot] != e) {
                continue;
            }
            _Alignas(64) double cauchy[RG_GAUSS * 6 * RG_LANES];
            size_t block = slot / RG_LANES - t->begin;
            rg_tile_receive(s, t, s->work);
            rg_bulk_args bulk = rg_tile_bulk(s, t, s->work, block);
            rg_bulk_state_args args = {.bulk = &bulk, .cauchy = cauchy};
            rg_reference_bulk_state(&args, block, block + 1);
            for (int c = 0; c < 6; c++) {
                double sum = 0, value[RG_GAUSS];
                for (int g = 0; g < RG_GAUSS; g++) {
                    value[g] = cauchy[(g * 6 + c) * RG_LANES + (int)(slot % RG_LANES)];
                    sum += value[g];
                }
                for (int g = 0; g < RG_GAUSS; g++) { /* corner values (v - a sum)/(b - a), interpolated */
                    out[c] += l[g] * (value[g] - RG_GAUSS_A * sum) / RG_GAUSS_BA;
                }
            }
        }
    }
}

static double time_of(int sample) {
    return 1e-9 * (sample + 0.1);
}

static void wanted_row(const random_state *r, double row[COLUMNS]) {
    row[0] = time_of(0);
    double local[6];
    int several;
    for (int p = 0; p < PROBES; p++) {
        double l[4], N[RG_NODES], *to = row + 1 + 12 * p;
        rg_gid e = first_of(r->mesh, r->input->output.probe[p].at, l, &several);
        rg_shape(l, N);
        memset(to, 0, 12 * sizeof *to);
        for (int n = 0; n < RG_NODES; n++) {
            for (int c = 0; c < 3; c++) {
                to[c] += N[n] * drawn_u(SEED, e, n, c);
                to[3 + c] += N[n] * drawn_now(SEED, e, n, c);
            }
        }
        stress_of(r, e, l, local);
        MPI_Allreduce(local, to + 6, 6, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    }
    for (int b = 0; b < BODIES; b++) {
        const rg_body_seen *seen = &r->solver->bodies->body[b].seen;
        memcpy(row + 1 + 12 * PROBES + 9 * b, seen->x, sizeof seen->x);
        memcpy(row + 4 + 12 * PROBES + 9 * b, seen->v, sizeof seen->v);
        memcpy(row + 7 + 12 * PROBES + 9 * b, seen->force, sizeof seen->force);
    }
}

/* Calls the watcher as the solver does: for each watched tile. */
static void watch(random_state *r) {
    rg_solver *s = r->solver;
    for (size_t t = 0; t < s->domain->tiles; t++) {
        if (s->watched[t]) {
            rg_tile_receive(s, &s->domain->tile[t], s->work);
            s->watch(s->watch_context, s, t, s->work);
        }
    }
}

static const char header[] = "time,a_ux,a_uy,a_uz,a_vx,a_vy,a_vz,a_sxx,a_syy,a_szz,a_syz,a_sxz,a_sxy,b_ux,b_"
                             "uy,b_uz,b_vx,b_vy,b_vz,b_sxx,b_syy,b_szz,"
                             "b_syz,b_sxz,b_sxy,c_ux,c_uy,c_uz,c_vx,c_vy,c_vz,c_sxx,c_syy,c_szz,c_syz,c_sxz,"
                             "c_sxy,ball_x,ball_y,ball_z,ball_vx,"
                             "ball_vy,ball_vz,ball_fx,ball_fy,ball_fz,wall_x,wall_y,wall_z,wall_vx,wall_vy,"
                             "wall_vz,wall_fx,wall_fy,wall_fz\n";

static int64_t table_size(void) {
    struct stat s;
    return stat(in("history.csv"), &s) == 0 ? s.st_size : -1;
}

/* Whether history.csv has the header, and a line of these values; rank 0. */
static bool table_good(const double wanted[COLUMNS]) {
    FILE *f = fopen(in("history.csv"), "r");
    char line[2000];
    bool good = f != NULL && fgets(line, sizeof line, f) != NULL && strcmp(line, header) == 0 &&
                fgets(line, sizeof line, f) != NULL;
    char *at = line;
    for (int k = 0; good && k < COLUMNS; k++) {
        static const double apart[] = {1e-18, 1e-13, 1}; /* of displacement, velocity and stress */
        int kind = (k - 1) % 12 / 3;
        double x = strtod(at, &at), most = k == 0 || k > 12 * PROBES ? 0 : apart[kind < 2 ? kind : 2];
        good = fabs(x - wanted[k]) <= most && *at++ == (k + 1 < COLUMNS ? ',' : '\n');
        if (!good) {
            printf("# column %d: %.17g, not %.17g\n", k, x, wanted[k]);
        }
    }
    good = good && *at == '\0' && fgets(line, sizeof line, f) == NULL;
    if (f != NULL) {
        fclose(f);
    }
    return good;
}

/* Whether it has a row for each sample, each with the values of the first; rank 0. */
static bool rows_good(void) {
    FILE *f = fopen(in("history.csv"), "r");
    char first[2000] = "", line[2000];
    bool good = f != NULL && fgets(line, sizeof line, f) != NULL;
    int rows = 0;
    for (; good && fgets(line, sizeof line, f) != NULL; rows++) {
        char *comma = strchr(line, ',');
        if (rows == 0) {
            strcpy(first, comma);
        }
        good = strtod(line, NULL) == time_of(rows) && strcmp(first, comma) == 0;
    }
    if (f != NULL) {
        fclose(f);
    }
    return good && rows == SAMPLES;
}

static void check_probes(void) {
    static const char probes[] =
        "output.probes=[{name: a, at: [0.71e-3, 0.23e-3, 2.35e-3]}, {name: b, at: [0.3e-3, -0.7e-3, "
        "1.1e-3]}, {name: c, at: [1.27e-3, 0.9e-3, 3.7e-3]}]";
    random_state r = make(probes, MPI_COMM_WORLD);
    double wanted[COLUMNS], l[4];
    int several;
    first_of(r.mesh, r.input->output.probe[1].at, l, &several);
    report(several > 1, "probes", "a vertex is of several elements");
    wanted_row(&r, wanted);
    rg_probes *p = rg_probes_find(r.solver);
    rg_probes_open(p, r.solver);
    watch(&r);
    rg_probes_next(p, time_of(0));
    int64_t length = rg_probes_sync(p);
    report(rank != 0 || table_good(wanted), "probes", "displacement, velocity, stress, and bodies");
    MPI_Allreduce(MPI_IN_PLACE, &length, 1, MPI_INT64_T, MPI_MAX, MPI_COMM_WORLD);
    rg_probes_next(p, 7); /* a line that the run which goes on does not have */
    rg_probes_close(p);
    report(rank != 0 || table_size() > length, "probes", "the end of a run keeps what it has sampled");
    p = rg_probes_find(r.solver);
    rg_probes_reopen(p, r.solver, length);
    for (int k = 1; k < SAMPLES; k++) { /* more than are kept at a time */
        watch(&r);
        rg_probes_next(p, time_of(k));
    }
    rg_probes_flush(p);
    rg_probes_flush(p);
    report((rg_probes_sync(p) > length * SAMPLES * 3 / 4) == (rank == 0), "probes", "length of the table");
    report(rank != 0 || rows_good(), "probes", "one row for each sample, also behind a restart");
    rg_probes_close(p);
    random_state_free(&r);
}

static void check_nothing_to_record(void) {
    char dir[300];
    snprintf(dir, sizeof dir, "output.dir=%s", place);
    remove(in("history.csv"));
    MPI_Barrier(MPI_COMM_WORLD);
    const char *change[] = {dir, "output.probes=[]", "bodies=[]"};
    random_state r = random_state_make(3, change, MPI_COMM_WORLD);
    rg_probes *p = rg_probes_find(r.solver);
    rg_probes_open(p, r.solver);
    for (int k = 0; k < 300; k++) {
        rg_probes_next(p, 1);
    }
    bool good = rg_probes_sync(p) == 0;
    rg_probes_close(p);
    p = rg_probes_find(r.solver);
    rg_probes_reopen(p, r.solver, 0);
    rg_probes_close(p);
    report(good && access(in("history.csv"), F_OK) != 0, "probes", "no table without any");
    random_state_free(&r);
}

/* Whether looking for the probes ends the run with these last words. */
static bool refused(const rg_solver *s, const char *words) {
    said[0] = '\0';
    expect_fatal = true;
    if (setjmp(escape) == 0) {
        rg_probes_find(s);
    }
    expect_fatal = false;
    return strcmp(said, words) == 0 && fatal_status == RG_USAGE;
}

static void check_outside(void) {
    bool good = true;
    if (rank == 0) {
        random_state r = make("output.probes=[{name: a, at: [0.71e-3, 0.23e-3, 2.35e-3]}]", MPI_COMM_SELF);
        r.input->output.probe[0].at[2] = 4.1e-3;
        good = refused(r.solver,
                       "random.yaml: output.probes[0].at: [0.00071, 0.00023, 0.0041]: no element of the "
                       "mesh contains it");
        char file[] = "part.h5";
        r.input->mesh.file = file;
        good =
            refused(r.solver, "random.yaml: output.probes[0].at: [0.00071, 0.00023, 0.0041]: no element of "
                              "part.h5 contains it") &&
            good;
        r.input->mesh.file = NULL;
        random_state_free(&r);
    }
    report(good, "probes", "one outside");
}

static void check_full_disk(void) {
    bool good = true;
    if (rank == 0) {
        random_state r = make("output.probes=[{name: a, at: [0.71e-3, 0.23e-3, 2.35e-3]}]", MPI_COMM_SELF);
        remove(in("history.csv"));
        good = symlink("/dev/full", in("history.csv")) == 0;
        rg_probes *p = rg_probes_find(r.solver);
        rg_probes_open(p, r.solver);
        rg_probes_next(p, 1);
        said[0] = '\0';
        expect_fatal = true;
        if (setjmp(escape) == 0) {
            rg_probes_flush(p);
        }
        expect_fatal = false;
        good = good && fatal_status == RG_FAILURE &&
               strcmp(said, "history.csv: cannot be written: No space left on device") == 0;
        remove(in("history.csv"));
        random_state_free(&r);
    }
    report(good, "probes", "a full disk");
}

/* ---- autopsies ---- */

/* Deformation gradient of element e at l, from differences of the place of points, exact for quadratics. */
static double jacobian(const rg_mesh *mesh, rg_gid e, const double l[4]) {
    double x[4][3], to[3][3], from[3][3], cross[3];
    mesh_corners(mesh, e, x);
    for (int k = 0; k < 3; k++) { /* along edges from corner 3 */
        for (int c = 0; c < 3; c++) {
            from[k][c] = x[k][c] - x[3][c];
            to[k][c] = from[k][c];
        }
        for (int side = -1; side <= 1; side += 2) {
            double at[4], N[RG_NODES];
            memcpy(at, l, sizeof at);
            at[k] += 0.25 * side;
            at[3] -= 0.25 * side;
            rg_shape(at, N);
            for (int n = 0; n < RG_NODES; n++) {
                for (int c = 0; c < 3; c++) {
                    to[k][c] += 2 * side * N[n] * drawn_u(SEED, e, n, c);
                }
            }
        }
    }
    rg_reference_cross(to[1], to[2], cross);
    double now = rg_reference_dot(to[0], cross);
    rg_reference_cross(from[1], from[2], cross);
    return now / rg_reference_dot(from[0], cross);
}

/* 3 times inradius over circumradius, by areas, volume and products of opposite edges. */
static double quality(const rg_mesh *mesh, rg_gid e) {
    double x[4][3], edge[4][4], area = 0, cross[3], d[3][3];
    mesh_corners(mesh, e, x);
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 4; j++) {
            for (int c = 0; c < 3; c++) {
                d[0][c] = x[j][c] - x[i][c];
            }
            edge[i][j] = sqrt(rg_reference_dot(d[0], d[0]));
        }
    }
    for (int f = 0; f < 4; f++) { /* Heron */
        double a = edge[(f + 1) % 4][(f + 2) % 4], b = edge[(f + 2) % 4][(f + 3) % 4],
               c = edge[(f + 3) % 4][(f + 1) % 4];
        double s = (a + b + c) / 2;
        area += sqrt(s * (s - a) * (s - b) * (s - c));
    }
    for (int k = 0; k < 9; k++) {
        d[k / 3][k % 3] = x[k / 3 + 1][k % 3] - x[0][k % 3];
    }
    rg_reference_cross(d[1], d[2], cross);
    double volume = fabs(rg_reference_dot(d[0], cross)) / 6;
    double p = edge[0][1] * edge[2][3], q = edge[0][2] * edge[1][3], r = edge[0][3] * edge[1][2];
    double sphere = sqrt((p + q + r) * (p + q - r) * (p - q + r) * (-p + q + r)) / (24 * volume);
    return 3 * (3 * volume / area) / sphere;
}

typedef struct {
    double x[3], volume, quality, jacobian, displacement, speed;
    int broken;
} wanted_finding;

static wanted_finding look(const random_state *r, rg_gid e) {
    wanted_finding f = {.quality = quality(r->mesh, e), .jacobian = INFINITY};
    double x[4][3];
    mesh_corners(r->mesh, e, x);
    for (int c = 0; c < 3; c++) {
        f.x[c] = (x[0][c] + x[1][c] + x[2][c] + x[3][c]) / 4;
    }
    for (int g = 0; g < 4; g++) {
        double l[4] = {RG_GAUSS_A, RG_GAUSS_A, RG_GAUSS_A, RG_GAUSS_A};
        l[g] = RG_GAUSS_B;
        f.jacobian = fmin(f.jacobian, jacobian(r->mesh, e, l));
    }
    for (int n = 0; n < RG_NODES; n++) {
        double u2 = 0, v2 = 0;
        for (int c = 0; c < 3; c++) {
            double v = 20 * drawn(SEED, DRAW_VELOCITY, e, 3 * n + c);
            u2 += drawn_u(SEED, e, n, c) * drawn_u(SEED, e, n, c);
            v2 += v * v;
        }
        f.displacement = fmax(f.displacement, sqrt(u2));
        f.speed = fmax(f.speed, sqrt(v2));
    }
    for (int k = 0; k < 4; k++) {
        rg_gid face = face_key(r->mesh, e, k);
        f.broken += face >= 0 && drawn_broken(SEED, face) != 0;
    }
    return f;
}

/* Value of a key of autopsy.json; NaN for null. */
static double value_of(const char *text, const char *key) {
    char quoted[60];
    snprintf(quoted, sizeof quoted, "\n  \"%s\": ", key);
    const char *at = strstr(text, quoted);
    if (at == NULL) {
        printf("# no %s\n", key);
        return -12345;
    }
    at += strlen(quoted);
    return strncmp(at, "null", 4) == 0 ? NAN : strtod(at, NULL);
}

static bool same(double found, double wanted) {
    bool good = fabs(found - wanted) <= 1e-12 * fabs(wanted);
    if (!good) {
        printf("# %.17g, not %.17g\n", found, wanted);
    }
    return good;
}

static const char *read_json(void) {
    static char text[4000];
    FILE *f = fopen(in("autopsy.json"), "r");
    text[f == NULL ? 0 : fread(text, 1, sizeof text - 1, f)] = '\0';
    if (f != NULL) {
        fclose(f);
    }
    return text;
}

static int64_t slot_of(const rg_domain *d, rg_gid id) {
    for (size_t slot = 0; slot < d->blocks * RG_LANES; slot++) {
        if (d->id[slot] == id) {
            return (int64_t)slot;
        }
    }
    return -1;
}

static void set_stiffening(const rg_solver *s, rg_gid id, double value) {
    int64_t slot = slot_of(s->domain, id);
    if (slot >= 0) {
        s->stiffening[slot] = (rg_real)value;
    }
}

static bool json_good(const random_state *r, rg_gid e, double stiffening, const char *limit) {
    const char *text = read_json();
    const wanted_finding f = look(r, e);
    const rg_solver *s = r->solver;
    char end[300];
    snprintf(
        end, sizeof end,
        "  \"step_limited_by\": \"%s\",\n  \"spectrum_element\": 77,\n  \"spectrum_faces\": \"intact\"\n}\n",
        limit);
    bool finite = isfinite(stiffening);
    double found = value_of(text, "stiffening"), volume = value_of(text, "volume_m3");
    double x[4][3], edge[3][3], cross[3];
    mesh_corners(r->mesh, e, x);
    for (int k = 0; k < 9; k++) {
        edge[k / 3][k % 3] = x[k / 3 + 1][k % 3] - x[0][k % 3];
    }
    rg_reference_cross(edge[1], edge[2], cross);
    return strncmp(text, "{\n  \"reason\": \"it went wrong\",\n  \"step\": 41,\n", 45) == 0 &&
           value_of(text, "time_s") == 2.5e-7 && value_of(text, "dt_s") == s->dt &&
           (int64_t)value_of(text, "element") == e && same(value_of(text, "x_m"), f.x[0]) &&
           same(value_of(text, "y_m"), f.x[1]) && same(value_of(text, "z_m"), f.x[2]) &&
           same(volume, fabs(rg_reference_dot(edge[0], cross)) / 6) &&
           same(value_of(text, "quality"), f.quality) &&
           same(value_of(text, "smallest_jacobian"), f.jacobian) &&
           (finite ? found == stiffening : isnan(found)) &&
           same(value_of(text, "largest_displacement_m"), f.displacement) &&
           same(value_of(text, "largest_speed_m_s"), f.speed) && value_of(text, "broken_faces") == f.broken &&
           strcmp(text + strlen(text) - strlen(end), end) == 0;
}

static void autopsy(random_state *r, char words[RG_FAILURE_WORDS]) {
    strcpy(words, "it went wrong");
    rg_autopsy_add(words, r->solver, 41, 2.5e-7, 2e-7);
    MPI_Barrier(MPI_COMM_WORLD);
}

/* Of elements alike in their harm the lowest is named; of others the one that is stiffened most, and before
 * all those that are not finite. */
static void check_autopsy(void) {
    random_state r = make("output.probes=[]", MPI_COMM_WORLD);
    rg_solver *s = r.solver;
    char words[RG_FAILURE_WORDS], wanted[RG_FAILURE_WORDS];
    s->limiting = 77;
    s->limiting_state = "intact";
    s->stiffening_anywhere = 3;
    for (size_t slot = 0; slot < s->domain->blocks * RG_LANES; slot++) {
        s->stiffening[slot] = s->domain->id[slot] < 0 ? (rg_real)NAN : (rg_real)1.5;
    }
    rg_gid broken = 0; /* an element with some broken faces, not all and none */
    while (look(&r, broken).broken != 2) {
        broken++;
    }
    set_stiffening(s, broken, 7.25);
    autopsy(&r, words);
    report(rank != 0 || json_good(&r, broken, 7.25, "the stiffening of the element"), "autopsy",
           "the most stiffened");
    wanted_finding f = look(&r, broken);
    snprintf(wanted, sizeof wanted,
             "it went wrong at step 41, time 2.5e-07 s; dt %.4g s, limited by the stiffening of the element; "
             "worst: element %d "
             "at (%.4g, %.4g, %.4g) m; its quality is %.2g, its smallest J %.3g, its stiffening 7.25, 2 of "
             "its faces are "
             "broken; at rest element 77 sets the time step; last good output at 2e-07 s",
             s->dt, (int)broken, f.x[0], f.x[1], f.x[2], f.quality, f.jacobian);
    report(strcmp(words, wanted) == 0, "autopsy", "in words, on every rank");
    s->stiffening_anywhere = 1;
    set_stiffening(s, 143, 7.25);
    set_stiffening(s, 3, NAN);
    set_stiffening(s, 90, INFINITY);
    autopsy(&r, words);
    report(rank != 0 || json_good(&r, 3, NAN, "the spectrum at rest"), "autopsy",
           "the first that is not finite");
    set_stiffening(s, 3, 1.5);
    autopsy(&r, words);
    report(rank != 0 || json_good(&r, 90, INFINITY, "the spectrum at rest"), "autopsy",
           "one that is infinite");
    int64_t slot = slot_of(s->domain, 90);
    if (slot >= 0) {
        s->u[rg_node_index((size_t)slot, 5, 1)] = (rg_real)NAN;
        s->velocity[rg_node_index((size_t)slot, 9, 2)] = (rg_real)INFINITY;
    }
    autopsy(&r, words);
    const char *text = rank == 0 ? read_json() : "";
    report(rank != 0 || (isnan(value_of(text, "smallest_jacobian")) &&
                         isnan(value_of(text, "largest_displacement_m")) &&
                         isnan(value_of(text, "largest_speed_m_s"))),
           "autopsy", "fields that are not finite");
    for (rg_gid e = 0; e < 144; e++) { /* all alike */
        set_stiffening(s, e, e < 5 ? 1 : 2);
    }
    autopsy(&r, words);
    report(rank != 0 || (int64_t)value_of(read_json(), "element") == 5, "autopsy",
           "the lowest of those alike");
    char *full = words;
    memset(full, 'x', RG_FAILURE_WORDS - 4);
    full[RG_FAILURE_WORDS - 4] = '\0';
    rg_autopsy_add(full, s, 1, 1, 1);
    report(strlen(full) == RG_FAILURE_WORDS - 1, "autopsy", "words that find no room");
    random_state_free(&r);
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    snprintf(place, sizeof place, "/tmp/test_probe.XXXXXX");
    if (rank == 0 && mkdtemp(place) == NULL) {
        rg_fatal(RG_FAILURE, "cannot make %s", place);
    }
    MPI_Bcast(place, sizeof place, MPI_CHAR, 0, MPI_COMM_WORLD);
    check_probes();
    check_nothing_to_record();
    check_outside();
    check_full_disk();
    check_autopsy();
    if (rank == 0) {
        remove(in("history.csv"));
        remove(in("autopsy.json"));
        failures += rmdir(place) != 0;
    }
    return finish();
}
