/* Tips of cracks that are driven through a body point by point, against all points of all faces of the whole
 * mesh, on any number of ranks. Prints TAP from rank 0. */
#include "diagnostics/crack_tip.h"

#include <math.h>
#include <string.h>

#include "reference/reference.h"
#include "solver/tile.h"
#include "support/random_state.h"
#include "support/tap_memory.h"

enum { TIPS = 3, SAMPLES = 12, COLUMNS = 2 * TIPS };

static const char tips[] = "output.crack_tips=[{name: run, direction: [3, 0, 4], distance: 0.4e-3}, "
                           "{name: back, where: y > 0, direction: [0, 2, 0], distance: 1e-4}, "
                           "{name: never, where: z > 3.5e-3, direction: [1, 0, 0]}]";
static const double along[TIPS][3] = {{0.6, 0, 0.8}, {0, 1, 0}, {1, 0, 0}};
static const double distance[TIPS] = {0.4e-3, 1e-4, 0};

static double time_of(int sample) {
    return 1e-7 * (1 + sample + 0.01 * sample * sample);
}

/* Separated are points up to a plane that moves; those of the last quarter of the body never. */
static bool separated(const double x[3], int sample) {
    return x[2] + 0.6 * x[1] < 0.6e-3 + 0.25e-3 * sample && x[2] < 3.3e-3;
}

/* Place of reference of point q of a face (m). */
static void place(const random_state *r, rg_gid e, int face, int q, double x[3]) {
    double corner[4][3], l[3];
    mesh_corners(r->mesh, e, corner);
    rg_reference_face_point(q, l);
    for (int c = 0; c < 3; c++) {
        x[c] = 0;
        for (int k = 0; k < 3; k++) {
            x[c] += l[k] * corner[rg_face_node[face][k]][c];
        }
    }
}

/* Some that have not separated are broken all the same. */
static void drive(const random_state *r, int sample) {
    rg_solver *s = r->solver;
    const rg_domain *d = s->domain;
    memset(s->active, 1, d->iblocks);
    memset(s->broken, 0, d->iblocks * RG_LANES);
    for (size_t n = 0; n < d->tiles; n++) {
        const rg_tile *t = &d->tile[n];
        for (size_t i = t->ibegin * RG_LANES; i < t->iend * RG_LANES; i++) {
            double normal[3], x[3];
            int32_t link = d->side[0][i];
            rg_gid e = rg_interface_area(d, i, normal) > 0
                           ? d->id[t->begin * RG_LANES + (size_t)link / RG_FACES]
                           : -1;
            for (int q = 0; e >= 0 && q < RG_POINTS; q++) {
                place(r, e, link % RG_FACES, q, x);
                bool apart = separated(x, sample), broken = apart || q % 2 == 0;
                s->broken[i] |= (uint8_t)(broken << q);
                *rg_crack_value(s, i, q, RG_CRACK_OPENING) =
                    (rg_real)((apart ? 1.01 : 0.99) * rg_separation(s, i, q));
            }
        }
    }
}

/* Whether tip k looks at a face between elements. */
static bool looks(const random_state *r, int k, rg_gid e, int face) {
    double corner[4][3], middle[3] = {0, 0, 0};
    mesh_corners(r->mesh, e, corner);
    for (int i = 0; i < 9; i++) {
        middle[i % 3] += corner[rg_face_node[face][i / 3]][i % 3] / 3;
    }
    return r->mesh->neighbour[4 * e + face] >= 0 && (k == 0 || (k == 1 ? middle[1] > 0 : middle[2] > 3.5e-3));
}

static double furthest(const random_state *r, int k, int sample) {
    double most = NAN;
    for (rg_gid n = 0; n < 4 * r->mesh->elements; n++) {
        for (int q = 0; looks(r, k, n / 4, (int)(n % 4)) && q < RG_POINTS; q++) {
            double x[3];
            place(r, n / 4, (int)(n % 4), q, x);
            if (separated(x, sample)) {
                most = fmax(most, rg_reference_dot(along[k], x));
            }
        }
    }
    return most;
}

static void want(const random_state *r, double row[SAMPLES][COLUMNS]) {
    for (int k = 0; k < TIPS; k++) {
        int taken = -1;
        double speed = 0;
        for (int i = 0; i < SAMPLES; i++) {
            double tip = furthest(r, k, i);
            row[i][2 * k] = tip;
            if (!isnan(tip) && taken < 0) {
                taken = i;
            } else if (!isnan(tip) && tip > row[taken][2 * k] && tip - row[taken][2 * k] >= distance[k]) {
                speed = (tip - row[taken][2 * k]) / (time_of(i) - time_of(taken));
                taken = i;
            }
            row[i][2 * k + 1] = speed;
        }
    }
}

static bool rows_good(const double *found, double wanted[SAMPLES][COLUMNS], int from, int to) {
    bool good = true;
    for (int i = from * COLUMNS; i < to * COLUMNS; i++) {
        double x = found[i - from * COLUMNS], y = wanted[i / COLUMNS][i % COLUMNS];
        bool near = (isnan(x) && isnan(y)) || fabs(x - y) <= (i % 2 == 0 ? 2e-18 : 1e-10);
        if (!near && good) {
            printf("# sample %d, column %d: %.17g, not %.17g\n", i / COLUMNS, i % COLUMNS, x, y);
        }
        good = good && near;
    }
    return good;
}

static void sample_to(const random_state *r, rg_crack_tips *p, int from, int to) {
    for (int i = from; i < to; i++) {
        drive(r, i);
        for (size_t t = 0; t < r->solver->domain->tiles; t++) {
            if (rg_crack_tips_want(p, t)) {
                rg_crack_tips_watch(p, r->solver, t);
            }
        }
        rg_crack_tips_next(p);
    }
}

static bool writes(const rg_crack_tips *p, void (*write)(const rg_crack_tips *p, FILE *out),
                   const char *text) {
    char found[500] = "";
    FILE *out = fmemopen(found, sizeof found, "w");
    write(p, out);
    fclose(out);
    return strcmp(found, text) == 0;
}

/* Twice the area of a face (m2), where it lies between elements; its middle. */
static double inner_area(const random_state *r, rg_gid e, int face, double middle[3]) {
    double corner[4][3], a[3], b[3], area2 = 0;
    bool inside = true;
    mesh_corners(r->mesh, e, corner);
    const int *node = rg_face_node[face];
    for (int c = 0; c < 3; c++) {
        double first = r->input->mesh.origin[c], last = first + r->input->mesh.size[c];
        middle[c] = (corner[node[0]][c] + corner[node[1]][c] + corner[node[2]][c]) / 3;
        inside = inside && middle[c] > first + 1e-9 && middle[c] < last - 1e-9;
        a[c] = corner[node[1]][c] - corner[node[0]][c];
        b[c] = corner[node[2]][c] - corner[node[0]][c];
    }
    for (int c = 0; c < 3; c++) {
        double n = a[(c + 1) % 3] * b[(c + 2) % 3] - a[(c + 2) % 3] * b[(c + 1) % 3];
        area2 += n * n;
    }
    return inside ? sqrt(area2) : 0;
}

/* What the tips are to tell: their faces, each of two elements. */
static void tell(const random_state *r, char *words, size_t size) {
    static const char *const name[TIPS] = {"run: along (0.6, 0, 0.8)", "back: along (0, 1, 0)",
                                           "never: along (1, 0, 0)"};
    size_t used = 0;
    for (int k = 0; k < TIPS; k++) {
        double area = 0, middle[3];
        int sides = 0;
        bool solid[2] = {false, false};
        for (rg_gid n = 0; n < RG_FACES * r->mesh->elements; n++) {
            double twice = inner_area(r, n / RG_FACES, (int)(n % RG_FACES), middle);
            if (twice > 0 && (k != 1 || middle[1] > 0) && (k != 2 || middle[2] > 3.5e-3)) {
                area += 0.25 * twice;
                sides++;
                solid[mesh_material(r, n / RG_FACES)] = true;
            }
        }
        used += (size_t)snprintf(words + used, size - used, "crack tip      %s, on %.4g m2, %d faces of %s\n",
                                 name[k], area, sides / 2,
                                 solid[0] && solid[1] ? "glass and steel"
                                 : solid[0]           ? "glass"
                                                      : "steel");
    }
}

static void check(const random_state *r) {
    char words[500];
    tell(r, words, sizeof words);
    static double wanted[SAMPLES][COLUMNS];
    double time[SAMPLES];
    enum { HALF = SAMPLES / 2 };
    want(r, wanted);
    for (int i = 0; i < SAMPLES; i++) {
        time[i] = time_of(i);
    }
    rg_crack_tips *p = rg_crack_tips_make(r->solver);
    report(
        rg_crack_tips_columns(p) == COLUMNS &&
            writes(p, rg_crack_tips_header, ",run_tip,run_speed,back_tip,back_speed,never_tip,never_speed") &&
            writes(p, rg_crack_tips_print, words),
        "tips", "columns and words");
    rg_crack_tips_open(p, HALF);
    sample_to(r, p, 0, HALF);
    bool good = rows_good(rg_crack_tips_collect(p, time), wanted, 0, HALF);
    sample_to(r, p, HALF, SAMPLES);
    good = rows_good(rg_crack_tips_collect(p, time + HALF), wanted, HALF, SAMPLES) && good;
    report(good, "tips", "places and speeds, also across two outputs");
    bool moves = wanted[SAMPLES - 1][1] > 0 && wanted[SAMPLES - 1][3] > 0 && isnan(wanted[0][0]) &&
                 isnan(wanted[SAMPLES - 1][4]);
    report(moves, "tips", "come late, move, and never come");
    rg_crack_tips_free(p);
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    const char *change[] = {tips, "bodies=[]"};
    random_state r = random_state_make(2, change, MPI_COMM_WORLD);
    check(&r);
    random_state_free(&r);
    return finish_with_nothing_left();
}
