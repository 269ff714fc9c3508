/* Expansion by a prescribed temperature: of every point of every element against the expression written
 * anew, at the start and later; the scale of its accelerations; the message. On any number of ranks; prints
 * TAP from rank 0. */
#include "solver/heat.h"

#include <math.h>
#include <string.h>

#include "partition/material.h"
#include "support/fatal.h"
#include "support/near.h"
#include "support/random_state.h"
#include "support/tap_memory.h"

void rg_warn(const char *format, ...) {
    (void)format;
}

static const char glass[] = "material.expansion=8e-6";
static const char others[] =
    "materials=[{name: steel, where: \"x + z > 3.1e-3\", model: j2, young: 210e9, poisson: 0.3, density: "
    "7800, "
    "yield_stress: 1e9, expansion: 13e-6}, {name: copper, where: \"y > 0.6e-3\", model: anisotropic, "
    "density: "
    "8960, young: [60e9, 70e9, 80e9], poisson: [0.2, 0.25, 0.3], shear: [20e9, 30e9, 40e9]}]";

static double kelvin(const double x[3], double t) {
    return 350 + 2e5 * x[0] - 3e4 * x[2] + 1e9 * t * x[1] / 1e-3;
}

/* Place of a Gauss point, that of the rule of degree 2 near corner g. */
static void point_of(double corner[4][3], int g, double x[3]) {
    double far = (5 - sqrt(5.0)) / 20;
    for (int c = 0; c < 3; c++) {
        x[c] = 0;
        for (int i = 0; i < 4; i++) {
            x[c] += (i == g ? 1 - 3 * far : far) * corner[i][c];
        }
    }
}

static double expansion_of(int material) {
    return material == 0 ? 8e-6 : material == 1 ? 13e-6 : 0;
}

/* The last one that has the middle of the element. */
static int material_of(const random_state *r, rg_gid e) {
    double corner[4][3];
    mesh_corners(r->mesh, e, corner);
    double y = (corner[0][1] + corner[1][1] + corner[2][1] + corner[3][1]) / 4;
    return r->input->others == 2 && y > 0.6e-3 ? 2 : mesh_material(r, e);
}

/* Whether a row of the elements here, of four values, is that of the temperature at time t above 310 K. */
static bool is_at(const random_state *r, int row, double t) {
    const rg_solver *s = r->solver;
    bool good = true;
    for (size_t slot = 0; good && slot < s->domain->blocks * RG_LANES; slot++) {
        rg_gid e = s->domain->id[slot];
        double corner[4][3], x[3];
        for (int g = 0; g < RG_GAUSS && e >= 0; g++) {
            mesh_corners(r->mesh, e, corner);
            point_of(corner, g, x);
            double wanted = expansion_of(material_of(r, e)) * (kelvin(x, t) - 310),
                   found = s->thermal[slot / RG_LANES * RG_THERMAL_BLOCK + (size_t)(row + g) * RG_LANES +
                                      slot % RG_LANES];
            good = near(found, wanted, 1e-15) && good;
        }
    }
    return good;
}

/* A held element of side L and mass m, under a stress, pulls with L^2 |stress|: the accelerations, weighed
 * with the masses. */
static double scale_of(const random_state *r) {
    double sum = 0;
    for (rg_gid e = 0; e < r->mesh->elements; e++) {
        int k = material_of(r, e);
        const rg_material *m = &r->solver->model->material[k];
        double corner[4][3], x[3], square = 0;
        mesh_corners(r->mesh, e, corner);
        for (int g = 0; g < RG_GAUSS; g++) {
            point_of(corner, g, x);
            double pressure = 3 * (m->lambda + 2 * m->mu / 3) * expansion_of(k) * (kelvin(x, 0) - 310);
            square += 3 * pressure * pressure / RG_GAUSS;
        }
        sum += pow(tet_volume(corner), 4.0 / 3) * square / (m->density * tet_volume(corner));
    }
    return sqrt(sum);
}

static void check(const char *value, bool by_time) {
    const char *change[] = {value, glass, others, "bodies=[]"};
    random_state r = random_state_make(4, change, MPI_COMM_WORLD);
    rg_solver *s = r.solver;
    int models = 0;
    for (rg_gid e = 0; e < r.mesh->elements; e++) {
        models |= 1 << material_of(&r, e);
    }
    report(models == 7, value, "elements of each material");
    s->time = 0;
    rg_heating_start(s);
    report(is_at(&r, RG_THERMAL_EXPANSION, 0) && is_at(&r, RG_THERMAL_LAST, 0), value, "at the start");
    double scale = scale_of(&r);
    report(near(rg_heating_scale(s), scale, 1e-13 * scale), value, "scale of what it accelerates");
    s->time = 3e-8;
    for (size_t t = 0; t < s->domain->tiles; t += 2) {
        rg_heating_tile(s, t);
    }
    report(!by_time || !is_at(&r, RG_THERMAL_EXPANSION, 3e-8), value, "tile by tile");
    for (size_t t = 1; t < s->domain->tiles; t += 2) {
        rg_heating_tile(s, t);
    }
    report(is_at(&r, RG_THERMAL_EXPANSION, by_time ? 3e-8 : 0), value, "at a later time");
    report(is_at(&r, RG_THERMAL_LAST, 0), value, "what was before stays");
    random_state_free(&r);
}

static void check_without(void) {
    const char *change[] = {"bodies=[]"};
    random_state r = random_state_make(1, change, MPI_COMM_WORLD);
    rg_heating_start(r.solver);
    rg_heating_tile(r.solver, 0);
    report(r.solver->heating == NULL && !(fabs(rg_heating_scale(r.solver)) > 0), "heat", "without any");
    random_state_free(&r);
}

static bool before(const double a[3], const double b[3]) {
    int c = 0;
    while (c < 2 && !(fabs(a[c] - b[c]) > 0)) {
        c++;
    }
    return a[c] < b[c];
}

/* Told is the lowest of all points, on one rank. */
static void check_refused(void) {
    const char *change[] = {"temperature={value: 300 + log(z - 1.5e-3)}", glass, "bodies=[]"};
    char words[200];
    if (rank != 0) {
        report(true, "heat", "a temperature that is not finite");
        return;
    }
    random_state r = random_state_make(3, change, MPI_COMM_SELF);
    double lowest[3] = {INFINITY, 0, 0};
    for (rg_gid k = 0; k < RG_GAUSS * r.mesh->elements; k++) {
        double corner[4][3], x[3];
        mesh_corners(r.mesh, k / RG_GAUSS, corner);
        point_of(corner, (int)(k % RG_GAUSS), x);
        if (material_of(&r, k / RG_GAUSS) == 0 && x[2] < 1.5e-3 && before(x, lowest)) {
            memcpy(lowest, x, sizeof lowest);
        }
    }
    snprintf(words, sizeof words,
             "random.yaml: temperature.value: 300 + log(z - 1.5e-3) is not finite at (%g, %g, %g)", lowest[0],
             lowest[1], lowest[2]);
    expect_fatal = true;
    if (setjmp(escape) == 0) {
        rg_heating_start(r.solver);
    }
    expect_fatal = false;
    printf("# %s\n", said);
    report(fatal_status == RG_USAGE && strcmp(said, words) == 0, "heat", "a temperature that is not finite");
    random_state_free(&r);
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    check("temperature={value: 350 + 2e5*x - 3e4*z + 1e9*t*y/1e-3, free: 310}", true);
    check("temperature={value: 350 + 2e5*x - 3e4*z, free: 310}", false);
    check_without();
    check_refused();
    return finish_with_nothing_left();
}
