/* summary.json and its words to the letter, of a run of the test's own. */
#include <math.h>
#include <mpi.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "diagnostics/state_hash.h"
#include "output/summary.h"
#include "solver/stepper.h"
#include "partition/material.h"

/* ---- stand-ins: what is asked of the state ---- */

static rg_halo *const first_halo = (rg_halo *)(uintptr_t)16, *const traction_halo = (rg_halo *)(uintptr_t)32,
                      *const node_halo = (rg_halo *)(uintptr_t)64;
static int halos_asked;
static double first_fracture;

uint64_t __wrap_rg_state_hash(const rg_solver *s);
double __wrap_rg_first_fracture(const rg_solver *s);
rg_halo *__wrap_rg_assembly_halo(const rg_assembly *a);
rg_phases_report __wrap_rg_phases_gather(const rg_phases *p, const rg_domain *d, rg_halo *const halo[],
                                         int halos, MPI_Comm comm);
void __wrap_rg_phases_write(const rg_phases_report *r, FILE *out);

uint64_t __wrap_rg_state_hash(const rg_solver *s) {
    (void)s;
    return UINT64_C(0x123456789abcdef);
}

double __wrap_rg_first_fracture(const rg_solver *s) {
    (void)s;
    return first_fracture;
}

rg_halo *__wrap_rg_assembly_halo(const rg_assembly *a) {
    (void)a;
    return node_halo;
}

rg_phases_report __wrap_rg_phases_gather(const rg_phases *p, const rg_domain *d, rg_halo *const halo[],
                                         int halos, MPI_Comm comm) {
    (void)p;
    (void)d;
    (void)comm;
    halos_asked = halos;
    assert_ptr_equal(halo[0], first_halo);
    assert_ptr_equal(halo[1], traction_halo);
    assert_true(halos == 2 || halo[2] == node_halo);
    return (rg_phases_report){.phase = {[RG_PHASE_WAIT] = {0.5, 0.75, 1.25}, [RG_PHASE_PACK] = {7, 8, 9}}};
}

void __wrap_rg_phases_write(const rg_phases_report *r, FILE *out) {
    fprintf(out, "  \"phases\": %g,\n", r->phase[RG_PHASE_PACK].most);
}

/* ---- a run ---- */

static char place[] = "/tmp/test_summary.XXXXXX", path[64], name[] = "bar";
static rg_other_material other = {.is = {.name = (char[]){"steel"}, .model = RG_MATERIAL_J2}};
static rg_body_input ball = {.name = (char[]){"ball"}}, wall = {.name = (char[]){"wall"}};
static rg_body body[2];
static rg_bodies bodies;
static rg_case input;
static rg_part part;
static rg_kernels kernels = {.name = "x86-64-v9"};
static rg_model model;
static rg_solver solver;
static rg_ledger ledger;
static rg_summary summary;
static rg_fragment_table fragments;

static int set_up(void **state) {
    (void)state;
    snprintf(path, sizeof path, "%s/summary.json", mkdtemp(place) == NULL ? "" : place);
    return 0;
}

static int tear_down(void **state) {
    (void)state;
    remove(path);
    return rmdir(place);
}

static rg_stepper stepper;

static int fresh(void **state) {
    (void)state;
    stepper = (rg_stepper){.halo_u = {first_halo, NULL}, .halo_t = traction_halo};
    first_fracture = 1.5e-7;
    input = (rg_case){.name = name, .others = 1, .other = &other, .output = {.dir = place}};
    part = (rg_part){.quality = {1.25, 1.5, 70, 3, 2.5}};
    body[0] = (rg_body){.input = &ball, .seen = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, 0}};
    body[1] = (rg_body){.input = &wall, .seen = {{11, 12, 13}, {14, 15, 16}, {17, INFINITY, 19}, 0}};
    bodies = (rg_bodies){.count = 2, .body = body};
    model = (rg_model){.materials = 2};
    solver = (rg_solver){.input = &input,
                         .ranks = 3,
                         .threads = 5,
                         .kernels = &kernels,
                         .part = &part,
                         .stepper = &stepper,
                         .bodies = &bodies,
                         .model = &model,
                         .limiting = 77,
                         .limiting_state = "closed",
                         .exchange_seconds = 0.0625,
                         .time = 2.5e-7,
                         .dt = 1.5e-9,
                         .step = 120};
    ledger = (rg_ledger){.largest = 8.5,
                         .change = 8.5 * 0.00390625,
                         .unresolved = {0.125, 9, {1.5, 2.5, 3.5}},
                         .last = {.spent = 0.53125,
                                  .dissipated = 0.5,
                                  .plastic = 0.25,
                                  .damage = 0.125,
                                  .viscous = 0.0625,
                                  .friction = 0.03125,
                                  .unresolved = 0.75,
                                  .broken_area = 1.5,
                                  .failed_area = 1.25,
                                  .momentum = {21, 22, 23},
                                  .angular_momentum = {31, 32, 33}}};
    static int64_t of_material[] = {900, 100};
    summary = (rg_summary){.estimate = {.elements = 1000,
                                        .interfaces = 2000,
                                        .dofs = 30000,
                                        .of_material = of_material,
                                        .dt_critical = 4e-9,
                                        .bytes_per_element = 3456},
                           .first_step = 20,
                           .partitions = 2,
                           .dt_first = 2e-9,
                           .setup_seconds = 0.25,
                           .loop_seconds = 8,
                           .output_seconds = 4,
                           .checkpoints = 6,
                           .checkpoint_seconds = 1.5,
                           .checkpoint_median = 0.375,
                           .failure = ""};
    fragments = (rg_fragment_table){.overlap_time = INFINITY};
    return 0;
}

static const char *read_summary(void) {
    static char text[8000];
    FILE *f = fopen(path, "r");
    assert_non_null(f);
    text[fread(text, 1, sizeof text - 1, f)] = '\0';
    fclose(f);
    return text;
}

static const char run_lines[] =
    "{\n  \"case\": \"bar\",\n  \"elements\": 1000,\n  \"interfaces\": 2000,\n  \"dofs\": 30000,\n  "
    "\"materials\": [\n"
    "  {\n  \"name\": \"material\",\n  \"elements\": 900,\n  \"model\": \"neo-hookean\"},\n"
    "  {\n  \"name\": \"steel\",\n  \"elements\": 100,\n  \"model\": \"j2\"}],\n"
    "  \"ranks\": 3,\n  \"threads\": 5,\n  \"partitions\": 2,\n  \"imbalance\": 1.25,\n  \"cost_imbalance\": "
    "1.5,\n"
    "  \"cut_faces\": 70,\n  \"neighbours_max\": 3,\n  \"instruction_set\": \"x86-64-v9\",\n  \"precision\": "
    "\"" RG_PRECISION
    "\",\n  \"steps\": 120,\n  \"restarted_from_step\": 20,\n  \"time_end\": 2.4999999999999999e-07,\n"
    "  \"dt_critical\": 4.0000000000000002e-09,\n  \"dt_first\": 2.0000000000000001e-09,\n"
    "  \"dt_last\": 1.5e-09,\n  \"limiting_element\": 77,\n  \"limiting_state\": \"closed\",\n  \"setup_s\": "
    "0.25,\n"
    "  \"wall_s\": 12,\n  \"output_s\": 4,\n  \"checkpoints\": 6,\n  \"checkpoint_s\": 1.5,\n  "
    "\"checkpoint_median_s\": 0.375,\n"
    "  \"halo_wait_s\": 1.25,\n  \"us_per_tet_step\": 1200,\n  \"exchange_alone_s\": 0.0625,\n  \"phases\": "
    "9,\n"
    "  \"energy_error_rel\": 0.00390625,\n  \"energy_error_dissipated\": 0.0625,\n  \"energy_largest_J\": "
    "8.5,\n  \"dissipated_J\": 0.5,\n  "
    "\"plastic_J\": 0.25,\n"
    "  \"damage_J\": 0.125,\n  \"viscous_J\": 0.0625,\n  \"friction_J\": 0.03125,\n  \"unresolved_J\": "
    "0.75,\n  \"unresolved_most_J\": 0.125,\n  \"unresolved_most_at\": [1.5, 2.5, 3.5],\n"
    "  \"first_fracture_time_s\": 1.4999999999999999e-07,\n  \"broken_area_m2\": 1.5,\n  \"failed_area_m2\": "
    "1.25,\n";
static const char body_lines[] =
    "  \"momentum\": [21, 22, 23],\n  \"angular_momentum\": [31, 32, 33],\n  \"status\": \"completed\",\n  "
    "\"bodies\": [\n"
    "  {\n  \"position\": [1, 2, 3],\n  \"velocity\": [4, 5, 6],\n  \"force\": [7, 8, 9],\n  \"name\": "
    "\"ball\"},\n"
    "  {\n  \"position\": [11, 12, 13],\n  \"velocity\": [14, 15, 16],\n  \"force\": [17, null, 19],\n  "
    "\"name\": \"wall\"}],\n"
    "  \"overlaps\": 0,\n  \"bytes_per_tet\": 3456,\n  \"state_hash\": \"0123456789abcdef\",\n  "
    "\"revision\": \"";

/* 18 values of a trace and 9 of a traction go over each face, which are doubles or half as long. */
static void document_to_the_letter(void **state) {
    (void)state;
    char wanted[8000];
    snprintf(wanted, sizeof wanted, "%s  \"halo_doubles_per_face\": %g,\n%s", run_lines,
             27 * (double)sizeof(rg_real) / 8, body_lines);
    rg_summary_write(&summary, &solver, &ledger, &fragments);
    const char *found = read_summary();
    assert_true(strlen(found) > strlen(wanted));
    char head[8000];
    snprintf(head, sizeof head, "%.*s", (int)strlen(wanted), found);
    assert_string_equal(head, wanted);
    assert_string_equal(found + strlen(found) - 4, "\"\n}\n");
    assert_int_equal(halos_asked, 2);
    assert_true(rg_completed(place));
}

static void other_runs(void **state) {
    (void)state;
    solver.assembly = (rg_assembly *)(uintptr_t)128;
    bodies.count = 0;
    model.materials = 1;
    solver.step = 20; /* none was done */
    summary.failure = "it \"broke\"";
    first_fracture = INFINITY;
    fragments.count = 2;
    ledger.last.spent = 0.084;
    ledger.change = 0;
    ledger.unresolved.value = 0;
    rg_summary_write(&summary, &solver, &ledger, &fragments);
    const char *found = read_summary();
    assert_int_equal(halos_asked, 3);
    assert_null(strstr(found, "bodies"));
    assert_null(strstr(found, "unresolved_most"));
    assert_null(strstr(found, "steel"));
    assert_non_null(strstr(found, "  \"model\": \"neo-hookean\"}],\n"));
    assert_non_null(strstr(found, "  \"us_per_tet_step\": 0,\n"));
    assert_non_null(strstr(found, "  \"status\": \"it \\\"broke\\\"\",\n"));
    assert_non_null(strstr(found, "  \"first_fracture_time_s\": null,\n"));
    assert_non_null(strstr(found, "\n  \"fragments\": 2,\n"));
    assert_non_null(strstr(found, "  \"energy_error_rel\": 0,\n  \"energy_error_dissipated\": null,\n"));
    assert_false(rg_completed(place));
}

static void other_ranks_write_nothing(void **state) {
    (void)state;
    remove(path);
    solver.rank = 1;
    rg_summary_write(&summary, &solver, &ledger, &fragments);
    assert_int_equal(access(path, F_OK), -1);
    assert_true(summary.halo_wait_seconds == 1.25 && summary.us_per_tet_step == 1200 &&
                summary.first_fracture == 1.5e-7);
    assert_false(rg_completed(place));
}

static void expect_words(const char *wanted) {
    char *found = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&found, &size);
    rg_summary_print(&summary, &solver, &ledger, out);
    fclose(out);
    assert_string_equal(found, wanted);
    free(found);
}

static void words(void **state) {
    (void)state;
    char wanted[1000];
    summary.us_per_tet_step = 0.123456;
    summary.first_fracture = 1.5e-7;
    summary.unresolved = (rg_peak){-0.25, 9, {0.5, 1, 2}};
    snprintf(
        wanted, sizeof wanted,
        "set-up 0.25 s, time loop 8.00 s, output 4.00 s: 0.123 us of core time per element and step\n"
        "energy error 0.0039 of the largest energy, 8.5 J; 0.062 of all that was dissipated, 0.5312 J\n"
        "0.75 J came free where faces broke beyond what their law can take: the mesh does not resolve them\n"
        "  most at one face: 0.25 J, at (0.5, 1, 2) m\n"
        "first fracture at 1.5e-07 s; failed 1.25 m2, broken 1.5 m2, dissipated 0.5 J\n"
        "ball: at (1, 2, 3) m, velocity (4, 5, 6) m/s\n"
        "wall: at (11, 12, 13) m, velocity (14, 15, 16) m/s\n"
        "results in %s\n",
        place);
    expect_words(wanted);
    summary.first_fracture = INFINITY;
    bodies.count = 0;
    ledger.last.unresolved = 0;
    summary.unresolved.value = 0;
    ledger.last.spent = 0.084; /* below a hundredth of the largest: too little to judge by */
    snprintf(wanted, sizeof wanted,
             "set-up 0.25 s, time loop 8.00 s, output 4.00 s: 0.123 us of core time per element and step\n"
             "energy error 0.0039 of the largest energy, 8.5 J\nresults in %s\n",
             place);
    expect_words(wanted);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(document_to_the_letter, fresh),
        cmocka_unit_test_setup(other_runs, fresh),
        cmocka_unit_test_setup(other_ranks_write_nothing, fresh),
        cmocka_unit_test_setup(words, fresh),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
