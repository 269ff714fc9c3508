/* Sensors on a state drawn at random, against integrals by rules and lists of nodes written anew, on any
 * number of ranks. Prints TAP from rank 0. */
#include "diagnostics/sensor.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "domain/element.h"
#include "quadrature.h"
#include "reference/reference.h"
#include "solver/tile.h"
#include "support/random_state.h"
#include "support/tap_memory.h"

enum { SEED = 23, SENSORS = 6, COLUMNS = SENSORS * RG_SENSOR_VALUES * RG_SENSOR_MEASURES, SAMPLES = 2 };

#define ALL_VALUES                                                                                           \
    "values: [ux, uy, uz, vx, vy, vz, sxx, syy, szz, syz, sxz, sxy, von_mises, pressure], "                  \
    "measures: [mean, min, max, integral]"

static const char sensors[] = "output.sensors=["
                              "{name: all, " ALL_VALUES "}, "
                              "{name: low, where: z < 2.1e-3 && y > 0, " ALL_VALUES "}, "
                              "{name: steel, material: steel, " ALL_VALUES "}, "
                              "{name: top, set: z+, " ALL_VALUES "}, "
                              "{name: left, where: nx < -0.5 && y > 0, " ALL_VALUES "}, "
                              "{name: skin, where: abs(nx) + abs(ny) + abs(nz) > 0, " ALL_VALUES "}]";

/* ---- The same by other ways ---- */

/* A point of a part: barycentric coordinates in its element, and its share of the integral. */
typedef struct {
    double l[4], weight;
} place;

/* What a sensor finds; the stress of the element, at the points of the Gauss rule, is of this rank alone. */
typedef struct {
    double weight, sum, least, most;
} wanted;

static double corner_middle(double x[4][3], int c, int without) {
    double sum = 0;
    for (int k = 0; k < 4; k++) {
        sum += k == without ? 0 : x[k][c];
    }
    return sum / (without < 0 ? 4 : 3);
}

/* Whether sensor `which` looks at an element (face < 0), or at its face opposite to corner `face`. */
static bool looks(const random_state *r, int which, rg_gid e, int face) {
    double x[4][3], y[3];
    mesh_corners(r->mesh, e, x);
    for (int c = 0; c < 3; c++) {
        y[c] = corner_middle(x, c, face);
    }
    const double *origin = r->input->mesh.origin, *size = r->input->mesh.size;
    bool on_top = y[2] > origin[2] + size[2] * (1 - 1e-9), on_left = y[0] < origin[0] + size[0] * 1e-9;
    bool surface = on_top || on_left || y[2] < origin[2] + size[2] * 1e-9 ||
                   y[0] > origin[0] + size[0] * (1 - 1e-9) || y[1] < origin[1] + size[1] * 1e-9 ||
                   y[1] > origin[1] + size[1] * (1 - 1e-9);
    const bool of_element[3] = {true, y[2] < 2.1e-3 && y[1] > 0, mesh_material(r, e) == 1};
    const bool of_face[3] = {on_top, on_left && y[1] > 0, surface};
    return face < 0 ? which < 3 && of_element[which] : which >= 3 && of_face[which - 3];
}

static double measure(const random_state *r, rg_gid e, int face) {
    double x[4][3], edge[3][3], cross[3];
    mesh_corners(r->mesh, e, x);
    int k[3], n = 0, from = face == 3 ? 2 : 3;
    for (int i = 0; i < 4; i++) {
        if (i != from && n < 3) {
            k[n++] = i;
        }
    }
    n = 0;
    for (int i = 0; i < 3; i++) {
        for (int c = 0; c < 3 && k[i] != face; c++) {
            edge[n][c] = x[k[i]][c] - x[from][c];
        }
        n += k[i] != face;
    }
    rg_reference_cross(edge[0], edge[1], cross);
    return face < 0 ? fabs(rg_reference_dot(edge[2], cross)) / 6 : sqrt(rg_reference_dot(cross, cross)) / 2;
}

/* Rules that are exact for quadratic functions, by points inside. */
static int rule(int face, place out[4]) {
    int points = 0;
    for (int k = 0; k < 4; k++) {
        if (k != face) {
            place *p = &out[points++];
            for (int i = 0; i < 4; i++) {
                double other = face < 0 ? RG_GAUSS_A : i == face ? 0 : 1.0 / 6;
                p->l[i] = i != k ? other : face < 0 ? RG_GAUSS_B : 2.0 / 3;
            }
            p->weight = face < 0 ? 0.25 : 1.0 / 3;
        }
    }
    return points;
}

static double motion(rg_gid e, int node, int value) {
    return value < 3 ? drawn_u(SEED, e, node, value) : drawn_now(SEED, e, node, value - 3);
}

static void take(wanted *w, double value) {
    w->least = fmin(w->least, value);
    w->most = fmax(w->most, value);
}

static void take_motion(const random_state *r, rg_gid e, int face, int value, wanted *w) {
    static const int end[RG_NODES][2] = {{0, 0}, {1, 1}, {2, 2}, {3, 3}, {0, 1},
                                         {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};
    place at[4];
    double all = measure(r, e, face);
    for (int n = 0; n < RG_NODES; n++) {
        if (end[n][0] != face && end[n][1] != face) {
            take(w, motion(e, n, value));
        }
    }
    for (int k = rule(face, at) - 1; k >= 0; k--) {
        double N[RG_NODES];
        rg_shape(at[k].l, N);
        for (int n = 0; n < RG_NODES; n++) {
            w->sum += all * at[k].weight * N[n] * motion(e, n, value);
        }
    }
}

static double of_stress(const double t[6], int value) {
    if (value < RG_SENSOR_MISES) {
        return t[value - RG_SENSOR_SXX];
    }
    double mean = (t[0] + t[1] + t[2]) / 3, squares = 0;
    for (int k = 0; k < 3; k++) {
        squares += (t[k] - mean) * (t[k] - mean) + 2 * t[3 + k] * t[3 + k];
    }
    return value == RG_SENSOR_MISES ? sqrt(1.5 * squares) : -mean;
}

/* `gauss`: stress at the points of the rule. Of a face its values at the middles of the edges count. */
static void take_stress(const random_state *r, rg_gid e, int face, int value, double gauss[4][6], wanted *w) {
    double all = measure(r, e, face);
    for (int k = 0; k < 4; k++) {
        double t[6] = {0};
        if (k == face) {
            continue;
        }
        for (int c = 0; c < 6; c++) {
            double sum = gauss[0][c] + gauss[1][c] + gauss[2][c] + gauss[3][c];
            for (int g = 0; g < 4; g++) {
                double corner = (gauss[g][c] - RG_GAUSS_A * sum) / RG_GAUSS_BA;
                t[c] += face < 0 ? (g == k ? gauss[g][c] : 0) : g == k || g == face ? 0 : 0.5 * corner;
            }
        }
        double v = of_stress(t, value);
        take(w, v);
        w->sum += all * v / (face < 0 ? 4 : 3);
    }
}

static void stress_at_points(const rg_solver *s, const rg_tile *t, size_t slot, double out[4][6]) {
    _Alignas(64) double cauchy[RG_GAUSS * 6 * RG_LANES];
    size_t block = slot / RG_LANES - t->begin;
    rg_bulk_args bulk = rg_tile_bulk(s, t, s->work, block);
    rg_bulk_state_args args = {.bulk = &bulk, .cauchy = cauchy};
    rg_reference_bulk_state(&args, block, block + 1);
    for (size_t k = 0; k < RG_GAUSS * 6; k++) {
        out[k / 6][k % 6] = cauchy[k * RG_LANES + slot % RG_LANES];
    }
}

/* What is wanted of the elements here: [SENSORS][RG_SENSOR_VALUES]. */
static void look_here(const random_state *r, wanted (*w)[RG_SENSOR_VALUES]) {
    const rg_solver *s = r->solver;
    for (size_t k = 0; k < s->domain->tiles; k++) {
        const rg_tile *t = &s->domain->tile[k];
        rg_tile_receive(s, t, s->work);
        for (size_t slot = t->begin * RG_LANES; slot < t->end * RG_LANES; slot++) {
            rg_gid e = s->domain->id[slot];
            double gauss[4][6];
            if (e < 0) {
                continue;
            }
            stress_at_points(s, t, slot, gauss);
            for (int i = 0; i < SENSORS * 5 * RG_SENSOR_VALUES; i++) {
                int value = i % RG_SENSOR_VALUES, face = i / RG_SENSOR_VALUES % 5 - 1,
                    which = i / RG_SENSOR_VALUES / 5;
                if (looks(r, which, e, face)) {
                    wanted *of = &w[which][value];
                    of->weight += measure(r, e, face);
                    if (value < RG_SENSOR_SXX) {
                        take_motion(r, e, face, value, of);
                    } else {
                        take_stress(r, e, face, value, gauss, of);
                    }
                }
            }
        }
    }
}

static void want(const random_state *r, double row[COLUMNS]) {
    static wanted w[SENSORS][RG_SENSOR_VALUES];
    for (int i = 0; i < SENSORS * RG_SENSOR_VALUES; i++) {
        w[i / RG_SENSOR_VALUES][i % RG_SENSOR_VALUES] = (wanted){0, 0, DBL_MAX, -DBL_MAX};
    }
    look_here(r, w);
    for (int i = 0; i < SENSORS * RG_SENSOR_VALUES; i++) {
        wanted *of = &w[i / RG_SENSOR_VALUES][i % RG_SENSOR_VALUES];
        MPI_Allreduce(MPI_IN_PLACE, &of->weight, 2, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
        MPI_Allreduce(MPI_IN_PLACE, &of->least, 1, MPI_DOUBLE, MPI_MIN, MPI_COMM_WORLD);
        MPI_Allreduce(MPI_IN_PLACE, &of->most, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
        const double found[RG_SENSOR_MEASURES] = {of->sum / of->weight, of->least, of->most, of->sum};
        memcpy(row + RG_SENSOR_MEASURES * i, found, sizeof found);
    }
}

/* ---- Checks ---- */

/* Of displacements of 1e-5 m, velocities of 20 m/s, stresses of 1e10 Pa; sums are of some hundred terms. */
static double apart(int column) {
    int value = column / RG_SENSOR_MEASURES % RG_SENSOR_VALUES;
    double size = value < 3 ? 1e-5 : value < RG_SENSOR_SXX ? 20 : 1e10, most = 4e-14;
    int measure = column % RG_SENSOR_MEASURES, which = column / RG_SENSOR_MEASURES / RG_SENSOR_VALUES;
    return size * most * (measure != RG_SENSOR_INTEGRAL ? 1 : which < 3 ? 5e-9 : 1e-5);
}

static bool row_good(const double *found, const double *row) {
    bool good = true;
    for (int k = 0; k < COLUMNS; k++) {
        bool near = fabs(found[k] - row[k]) <= apart(k);
        if (!near && good) {
            printf("# column %d: %.17g, not %.17g; %.2g\n", k, found[k], row[k],
                   fabs(found[k] - row[k]) / apart(k));
        }
        good = good && near;
    }
    return good;
}

static void watch(const random_state *r, rg_sensors *p) {
    const rg_solver *s = r->solver;
    for (size_t t = 0; t < s->domain->tiles; t++) {
        if (rg_sensors_want(p, t)) {
            rg_tile_receive(s, &s->domain->tile[t], s->work);
            rg_sensors_watch(p, s, t, s->work);
        }
    }
    rg_sensors_next(p);
}

static void check_values(const random_state *r) {
    static double row[COLUMNS];
    rg_sensors *p = rg_sensors_make(r->solver);
    want(r, row);
    rg_sensors_open(p, SAMPLES);
    report(rg_sensors_columns(p) == COLUMNS, "sensors", "columns");
    for (int k = 0; k < SAMPLES; k++) {
        watch(r, p);
    }
    const double *found = rg_sensors_collect(p);
    bool good = row_good(found, row) && memcmp(found, found + COLUMNS, COLUMNS * sizeof *found) == 0;
    report(good, "sensors", "means, extremes and integrals, of two samples");
    watch(r, p);
    report(row_good(rg_sensors_collect(p), row), "sensors", "the same after the first samples are gone");
    rg_sensors_free(p);
}

/* What a sensor writes: `text` behind a header or a list of parts. */
static bool writes(const rg_sensors *p, void (*write)(const rg_sensors *p, FILE *out), const char *text) {
    char found[2000] = "";
    FILE *out = fmemopen(found, sizeof found, "w");
    write(p, out);
    fclose(out);
    bool good = strcmp(found, text) == 0;
    if (!good) {
        printf("# %s\n", found);
    }
    return good;
}

static void check_words(MPI_Comm comm) {
    const char *change[] = {"output.sensors=[{name: a, values: [pressure, uy], measures: [integral, min]}, "
                            "{name: b, set: x+, values: [sxy], measures: [max, mean]}]"};
    random_state r = random_state_make(1, change, comm);
    rg_sensors *p = rg_sensors_make(r.solver);
    bool good = rg_sensors_columns(p) == 6 && writes(p, rg_sensors_header,
                                                     ",a_uy_min,a_uy_integral,a_pressure_min,"
                                                     "a_pressure_integral,b_sxy_mean,b_sxy_max");
    report(good, "sensors", "only what is asked for has a column");
    report(writes(p, rg_sensors_print,
                  "sensor         a: 5.423e-09 m3, 144 elements of glass and steel\n"
                  "sensor         b: 4.93e-06 m2, 24 faces of glass and steel\n"),
           "sensors", "tell their parts");
    rg_sensors_free(p);
    random_state_free(&r);
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    const char *change[] = {sensors};
    random_state r = random_state_make(1, change, MPI_COMM_WORLD);
    random_state_draw(&r, SEED);
    check_values(&r);
    random_state_free(&r);
    check_words(MPI_COMM_WORLD);
    return finish_with_nothing_left();
}
