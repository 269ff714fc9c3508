/* Every set of kernels against the scalar reference, on random input, and bit for bit against itself: a
 * result must not depend on the block or lane an element sits in, nor on what its neighbours in the block do.
 */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "support/figures.h"
#include "support/kernel_input.h"
#include "support/precision.h"

/* All that the kernels write. */
typedef struct {
    rg_real *force, *traction, *stiffening;
    double *energy, *cauchy, *kinetic, *lumped_kinetic, *scaled_kinetic, *ienergy;
    rg_real *velocity, *u, *now, *lumped_velocity, *lumped_u, *lumped_now, *scaled_velocity, *scaled_u,
        *scaled_now;
    rg_real *iforce, *turn, *crack;
    uint8_t *broken, *unlinked, *active;
} output;

/* One output field: `rows` values for each element or interface, of which every `kinds`-th is of the same
 * kind. */
typedef struct {
    const char *name;
    size_t offset, size; /* size: of a value, which is a real or a double */
    size_t rows, kinds;
    bool element;
} field;

#define FIELD(name, rows, kinds, element)                                                                    \
    { #name, offsetof(output, name), sizeof *((output *)0)->name, rows, kinds, element }

enum { FIELDS = 21, TRACTION_FIELD = 1, TURN_FIELD = 8, CRACK_FIELD = 15 };

static const field fields[FIELDS] = {
    FIELD(force, 30, 1, true),
    FIELD(traction, 36, 1, true),
    FIELD(stiffening, 1, 1, true),
    FIELD(energy, 1, 1, true),
    FIELD(cauchy, 24, 1, true),
    FIELD(kinetic, 1, 1, true),
    FIELD(lumped_kinetic, 1, 1, true),
    FIELD(iforce, 18, 1, false),
    FIELD(turn, 18, 1, false),
    FIELD(velocity, 30, 1, true),
    FIELD(u, 30, 1, true),
    FIELD(lumped_velocity, 30, 1, true),
    FIELD(lumped_u, 30, 1, true),
    FIELD(now, 30, 1, true),
    FIELD(lumped_now, 30, 1, true),
    FIELD(crack, RG_POINTS *RG_CRACK, RG_CRACK, false),
    FIELD(ienergy, RG_E_INTERFACE, RG_E_INTERFACE, false),
    FIELD(scaled_kinetic, 1, 1, true),
    FIELD(scaled_velocity, 30, 1, true),
    FIELD(scaled_u, 30, 1, true),
    FIELD(scaled_now, 30, 1, true),
};

static void *values(const output *out, int f) {
    void *p;
    memcpy(&p, (const char *)out + fields[f].offset, sizeof p);
    return p;
}

static double value(const output *out, int f, size_t k) {
    const void *p = values(out, f);
    return fields[f].size == sizeof(double) ? ((const double *)p)[k] : (double)((const float *)p)[k];
}

static size_t field_blocks(int f) {
    return fields[f].element ? INPUT_EBLOCKS : INPUT_IBLOCKS;
}

static size_t row_index(int f, size_t slot, size_t row) {
    if (f == TRACTION_FIELD) /* rows, not lanes (layout.h) */
        return slot * fields[f].rows + row;
    return (slot / RG_LANES * fields[f].rows + row) * RG_LANES + slot % RG_LANES;
}

static void *copy(const void *from, size_t bytes) {
    return memcpy(input_alloc(bytes), from, bytes);
}

/* Fields that are only written start from a value that no kernel gives; the others from the input. */
static output output_make(const input *in) {
    const size_t node_bytes = INPUT_EBLOCKS * RG_NODE_BLOCK * sizeof(rg_real);
    output out;
    for (int f = 0; f < FIELDS; f++) {
        size_t n = field_blocks(f) * fields[f].rows * RG_LANES;
        void *p = input_alloc(n * fields[f].size);
        memset(p, 0xc5, n * fields[f].size);
        memcpy((char *)&out + fields[f].offset, &p, sizeof p);
    }
    memcpy(out.velocity, in->velocity, node_bytes);
    memcpy(out.u, in->u, node_bytes);
    memcpy(out.lumped_velocity, in->velocity, node_bytes);
    memcpy(out.lumped_u, in->u, node_bytes);
    memcpy(out.scaled_velocity, in->velocity, node_bytes);
    memcpy(out.scaled_u, in->u, node_bytes);
    memcpy(out.crack, in->crack, INPUT_IBLOCKS * RG_CRACK_BLOCK * sizeof(rg_real));
    out.broken = copy(in->broken, INPUT_ISLOTS);
    out.unlinked = copy(in->unlinked, INPUT_ISLOTS);
    out.active = copy(in->active, INPUT_IBLOCKS);
    return out;
}

static void output_free(output *out) {
    for (int f = 0; f < FIELDS; f++)
        free(values(out, f));
    free(out->broken);
    free(out->unlinked);
    free(out->active);
}

typedef struct {
    size_t begin, end;
} range;

static const range all_elements = {0, INPUT_EBLOCKS}, all_interfaces = {0, INPUT_IBLOCKS};

/* Rows of state outputs count from the first block of the range; here they go to the block's own place. */
static void run_elements(const rg_kernels *set, const input *in, range r, output *out) {
    rg_bulk_args bulk = input_bulk_args(in, out->force, out->traction, out->stiffening);
    rg_bulk_state_args state = {.bulk = &bulk,
                                .energy = out->energy + r.begin * RG_LANES,
                                .cauchy = out->cauchy + r.begin * 24 * RG_LANES};
    rg_kinetic_args kinetic = {in->material.density, false, in->geom, in->velocity,
                               out->kinetic + r.begin * RG_LANES};
    rg_kick_args kick = {
        .density = in->material.density,
        .dt = 1e-10,
        .geom = in->geom,
        .force = in->pull,
        .iforce = in->ipull,
        .contact = in->law.contact,
        .turn = in->ipull,
        .broken = in->broken,
        .interface = in->interface,
        .velocity = out->velocity,
        .step_velocity = out->now,
        .dt_now = 5e-11,
    };
    rg_drift_args drift = {2e-10, out->velocity, out->u};
    set->bulk(&bulk, r.begin, r.end);
    set->bulk_state(&state, r.begin, r.end);
    set->kinetic(&kinetic, r.begin, r.end);
    set->kick(&kick, r.begin, r.end);
    set->drift(&drift, r.begin, r.end);
    for (int k = 0; k < 2; k++) {
        kinetic.mass = kick.mass = k == 0 ? RG_MASS_LUMPED : RG_MASS_SCALED;
        kinetic.energy = (k == 0 ? out->lumped_kinetic : out->scaled_kinetic) + r.begin * RG_LANES;
        kick.velocity = k == 0 ? out->lumped_velocity : out->scaled_velocity;
        kick.step_velocity = k == 0 ? out->lumped_now : out->scaled_now;
        drift = (rg_drift_args){2e-10, kick.velocity, k == 0 ? out->lumped_u : out->scaled_u};
        set->kinetic(&kinetic, r.begin, r.end);
        set->kick(&kick, r.begin, r.end);
        set->drift(&drift, r.begin, r.end);
    }
}

/* Interface energies are those of the input's state. */
static void run_interfaces(const rg_kernels *set, const input *in, range r, output *out) {
    rg_interface_args before =
        input_interface_args(in, in->broken, in->unlinked, in->active, in->crack, out->iforce);
    rg_interface_args args =
        input_interface_args(in, out->broken, out->unlinked, out->active, out->crack, out->iforce);
    args.turn = out->turn;
    rg_interface_state_args state = {&before, out->ienergy + r.begin * RG_E_INTERFACE * RG_LANES};
    set->interface_state(&state, r.begin, r.end);
    set->interface(&args, r.begin, r.end);
}

static output run(const rg_kernels *set, const input *in) {
    output out = output_make(in);
    run_elements(set, in, all_elements, &out);
    run_interfaces(set, in, all_interfaces, &out);
    return out;
}

static _Noreturn void fail_at(const char *set, const char *what, size_t place, double got, double expected) {
    fail_msg("%s: %s[%zu] is %.17g instead of %.17g", set, what, place, got, expected);
    abort();
}

/* Crack state and turning forces mean something only where a point is broken. */
static bool is_meaningful(const output *out, int f, size_t block, size_t row, size_t lane) {
    if (f == TURN_FIELD)
        return out->broken[block * RG_LANES + lane] != 0;
    return f != CRACK_FIELD || (out->broken[block * RG_LANES + lane] >> row / RG_CRACK & 1);
}

/* Size of turning forces: those of the faces times sliding over edge, some 1e-7 over 1e-4. Where no face has
 * slid under pressure they are what rounding leaves of that. */
static double turning(const output *ref) {
    double largest = 0;
    for (size_t k = 0; k < INPUT_IBLOCKS * RG_IFORCE_BLOCK; k++)
        largest = fmax(largest, fabs((double)ref->iforce[k]));
    return 1e-3 * largest;
}

/* Of all that is compared here, in shares of the largest value of its kind. */
static figure twin = {"kernels of every instruction set against the scalar reference", .bound = TOLERANCE,
                      .why = ROUNDING};

static void compare_kind(const char *set, int f, size_t kind, const output *out, const output *ref) {
    const size_t rows = fields[f].rows;
    double scale = f == TURN_FIELD ? turning(ref) : 0;
    for (int pass = 0; pass < 2; pass++) /* the scale, then the comparison */
        for (size_t k = 0; k < field_blocks(f) * rows * RG_LANES; k++) {
            size_t row = k / RG_LANES % rows, block = k / RG_LANES / rows;
            if (row % fields[f].kinds != kind || !is_meaningful(ref, f, block, row, k % RG_LANES))
                continue;
            if (pass == 0)
                scale = fmax(scale, fabs(value(ref, f, k)));
            else if (!(fabs(value(out, f, k) - value(ref, f, k)) <= TOLERANCE * scale))
                fail_at(set, fields[f].name, k, value(out, f, k), value(ref, f, k));
            else if (scale > 0)
                raise_figure(&twin, value(out, f, k), value(ref, f, k), scale);
        }
}

static void compare(const char *set, const output *out, const output *ref) {
    for (size_t s = 0; s < INPUT_ISLOTS; s++) {
        if (out->broken[s] != ref->broken[s])
            fail_at(set, "broken", s, out->broken[s], ref->broken[s]);
        if (out->unlinked[s] != ref->unlinked[s])
            fail_at(set, "unlinked", s, out->unlinked[s], ref->unlinked[s]);
    }
    assert_memory_equal(out->active, ref->active, INPUT_IBLOCKS);
    for (int f = 0; f < FIELDS; f++)
        for (size_t kind = 0; kind < fields[f].kinds; kind++)
            compare_kind(set, f, kind, out, ref);
}

/* How often each regime was met, by what the reference did. */
typedef struct {
    int switched[PULLS];
    int crack[CRACKS];
    int closed_flux;
} tally;

static void count_broken(const input *in, const output *ref, size_t i, int q, tally *t) {
    const size_t s = in->slot[i], k = rg_crack_index(s, q, RG_CRACK_OPENING);
    bool grew = ref->crack[k] > in->crack[k], failed = ref->crack[k] >= in->law.opening;
    bool contact = ref->ienergy[row_index(CRACK_FIELD + 1, s, RG_E_CONTACT)] > 0;
    switch (input_crack_of(in, i, q)) {
    case CRACK_LOADING:
        assert_true(grew);
        t->crack[CRACK_LOADING] += !failed;
        break;
    case CRACK_UNLOADING:
        assert_false(grew || failed);
        t->crack[CRACK_UNLOADING]++;
        break;
    case CRACK_CLOSED:
        assert_true(in->law.contact == RG_CONTACT_FLUX ? !(ref->unlinked[s] >> q & 1) : contact);
        t->crack[CRACK_CLOSED]++;
        t->closed_flux += in->law.contact == RG_CONTACT_FLUX;
        break;
    default:
        assert_true(failed);
        t->crack[CRACK_FAILED]++;
    }
}

static void count(const input *in, const output *ref, tally *t) {
    for (size_t i = 0; i < INPUT_INTERFACES; i++)
        for (int q = 0; q < RG_POINTS; q++) {
            const size_t s = in->slot[i];
            input_pull pull = input_pull_of(in, i);
            bool after = ref->broken[s] >> q & 1;
            if (in->broken[s] >> q & 1) {
                count_broken(in, ref, i, q, t);
                continue;
            }
            assert_int_equal(after, pull == PULL_NORMAL || (pull > PULL_NORMAL && in->law.beta > 0));
            t->switched[pull] += after;
        }
}

static rg_material_model model = RG_MATERIAL_NEO_HOOKEAN; /* of the inputs made next */

static input *make_broken(input_kind kind, rg_cohesive law, uint64_t order, double probability) {
    input *in = input_make(kind, law, 7, order);
    input_set_model(in, model);
    input_break(in, probability);
    return in;
}

static void compare_sets(const input *in, tally *t) {
    const rg_kernels *sets[INPUT_SETS];
    int n = input_sets(sets, INPUT_SETS);
    output ref = run(&rg_kernels_reference, in);
    count(in, &ref, t);
    for (int f = 0; f < FIELDS; f++)
        for (size_t k = 0; k < field_blocks(f) * fields[f].rows * RG_LANES; k++)
            assert_true(isfinite(value(&ref, f, k)));
    for (int k = 0; k < n; k++) {
        output out = run(sets[k], in);
        compare(sets[k]->name, &out, &ref);
        output_free(&out);
    }
    output_free(&ref);
}

static void test_against_reference(void **state) {
    static const double probability[3] = {0, 0.3, 1};
    tally t = {0};
    (void)state;
    for (int kind = 0; kind < 2; kind++)
        for (int law = 0; law < INPUT_LAWS; law++)
            for (int p = 0; p < 3; p++) {
                input *in = make_broken((input_kind)kind, input_laws[law], 11, probability[p]);
                compare_sets(in, &t);
                input_free(in);
            }
    for (int k = PULL_NORMAL; k < PULLS; k++)
        assert_true(t.switched[k] > 100);
    for (int k = 0; k < CRACKS; k++)
        assert_true(t.crack[k] > 100);
    assert_true(t.closed_flux > 100);
}

static void assert_same_bits(const char *set, int f, const output *a, size_t sa, const output *b, size_t sb) {
    for (size_t row = 0; row < fields[f].rows; row++) {
        double x = value(a, f, row_index(f, sa, row)), y = value(b, f, row_index(f, sb, row));
        if (is_meaningful(a, f, sa / RG_LANES, row, sa % RG_LANES) && memcmp(&x, &y, sizeof x) != 0)
            fail_at(set, fields[f].name, row, x, y);
    }
}

static void check_lane(const rg_kernels *set, input_kind kind, rg_cohesive law) {
    input *in[2];
    output out[2];
    for (int k = 0; k < 2; k++) {
        in[k] = make_broken(kind, law, (uint64_t)k * 5, 0.3);
        out[k] = run(set, in[k]);
    }
    for (size_t i = 0; i < INPUT_INTERFACES; i++) {
        size_t a = in[0]->slot[i], b = in[1]->slot[i];
        assert_int_equal(out[0].broken[a], out[1].broken[b]);
        assert_int_equal(out[0].unlinked[a], out[1].unlinked[b]);
    }
    for (int f = 0; f < FIELDS; f++) {
        const size_t *first = fields[f].element ? in[0]->element : in[0]->slot;
        const size_t *second = fields[f].element ? in[1]->element : in[1]->slot;
        for (size_t k = 0; k < (fields[f].element ? INPUT_ELEMENTS : INPUT_INTERFACES); k++)
            assert_same_bits(set->name, f, &out[0], first[k], &out[1], second[k]);
    }
    for (int k = 0; k < 2; k++) {
        output_free(&out[k]);
        input_free(in[k]);
    }
}

/* A result does not depend on the lane and block it is computed in. */
static void test_lane_independence(void **state) {
    (void)state;
    input_for_each_case(check_lane);
}

static bool is_whole(const input *in, size_t s) {
    for (int f = 0; f < RG_FACES; f++)
        if (input_unlinked(in, s, f))
            return false;
    return true;
}

static void check_neighbours(const rg_kernels *set, input_kind kind, rg_cohesive law) {
    input *whole = make_broken(kind, law, 3, 0), *cracked = make_broken(kind, law, 3, 0.05);
    output a = run(set, whole), b = run(set, cracked);
    int elements = 0, interfaces = 0;
    for (int f = 0; f < FIELDS; f++)
        for (size_t s = 0; s < field_blocks(f) * RG_LANES; s++)
            if (fields[f].element && is_whole(cracked, s) && cracked->cracked[s / RG_LANES]) {
                assert_same_bits(set->name, f, &a, s, &b, s);
                elements++;
            } else if (!fields[f].element && !cracked->broken[s] && cracked->active[s / RG_LANES]) {
                assert_same_bits(set->name, f, &a, s, &b, s);
                interfaces++;
            }
    assert_true(elements > 10 * FIELDS && interfaces > 30);
    output_free(&a);
    output_free(&b);
    input_free(whole);
    input_free(cracked);
}

/* A whole element or interface gives the same bits whether or not others in its block are broken. */
static void test_neighbour_independence(void **state) {
    (void)state;
    input_for_each_case(check_neighbours);
}

static void check_hint(const rg_kernels *set, input_kind kind, rg_cohesive law) {
    input *in = make_broken(kind, law, 3, 0.05);
    output a = run(set, in);
    memset(in->cracked, 1, INPUT_EBLOCKS);
    output b = run(set, in);
    for (int f = 0; f < FIELDS; f++)
        for (size_t s = 0; s < field_blocks(f) * RG_LANES; s++)
            assert_same_bits(set->name, f, &a, s, &b, s);
    output_free(&a);
    output_free(&b);
    input_free(in);
}

/* Marking a whole block as cracked changes nothing. */
static void test_cracked_is_a_hint(void **state) {
    (void)state;
    input_for_each_case(check_hint);
}

static void check_range(const rg_kernels *set, input_kind kind, rg_cohesive law) {
    const range some = {2, 5};
    input *in = make_broken(kind, law, 3, 0.3);
    output full = run(set, in), none = output_make(in), part = output_make(in);
    run_elements(set, in, some, &part);
    run_interfaces(set, in, some, &part);
    for (size_t block = 0; block < INPUT_IBLOCKS; block++) {
        const output *expected = block >= some.begin && block < some.end ? &full : &none;
        const size_t s = block * RG_LANES;
        assert_memory_equal(&part.broken[s], &expected->broken[s], RG_LANES);
        assert_memory_equal(&part.unlinked[s], &expected->unlinked[s], RG_LANES);
        assert_int_equal(part.active[block], expected->active[block]);
        for (int f = 0; f < FIELDS; f++)
            for (size_t lane = 0; block < field_blocks(f) && lane < RG_LANES; lane++)
                assert_same_bits(set->name, f, &part, s + lane, expected, s + lane);
    }
    output_free(&full);
    output_free(&none);
    output_free(&part);
    input_free(in);
}

/* Blocks outside the range are left alone. */
static void test_range(void **state) {
    (void)state;
    input_for_each_case(check_range);
}

static void check_state(const rg_kernels *set, input_kind kind, rg_cohesive law) {
    input *in = make_broken(kind, law, 3, 0.3);
    output before = output_make(in);
    rg_bulk_args bulk = input_bulk_args(in, NULL, NULL, NULL);
    rg_interface_args args = input_interface_args(in, in->broken, in->unlinked, in->active, in->crack, NULL);
    set->bulk_state(&(rg_bulk_state_args){.bulk = &bulk, .energy = before.energy}, 0, INPUT_EBLOCKS);
    set->bulk_state(&(rg_bulk_state_args){.bulk = &bulk, .cauchy = before.cauchy}, 0, INPUT_EBLOCKS);
    set->interface_state(&(rg_interface_state_args){&args, before.ienergy}, 0, INPUT_IBLOCKS);
    assert_memory_equal(before.broken, in->broken, INPUT_ISLOTS);
    assert_memory_equal(before.unlinked, in->unlinked, INPUT_ISLOTS);
    assert_memory_equal(before.active, in->active, INPUT_IBLOCKS);
    assert_memory_equal(before.crack, in->crack, INPUT_IBLOCKS * RG_CRACK_BLOCK * sizeof(rg_real));
    output out = run(set, in);
    assert_memory_equal(before.energy, out.energy, INPUT_ESLOTS * sizeof(double));
    assert_memory_equal(before.cauchy, out.cauchy, INPUT_ESLOTS * 24 * sizeof(double));
    output_free(&before);
    output_free(&out);
    input_free(in);
}

/* State kernels change nothing; that of the bulk takes either of its outputs alone. */
static void test_state_reads_only(void **state) {
    (void)state;
    input_for_each_case(check_state);
}

/* Bulk of the input alone; the caller frees the result. */
static output run_bulk(const rg_kernels *set, const input *in, rg_gradient gradient) {
    output out = output_make(in);
    rg_bulk_args args = input_bulk_args(in, out.force, out.traction, out.stiffening);
    args.gradient = gradient;
    set->bulk(&args, 0, INPUT_EBLOCKS);
    return out;
}

static void check_nan(const rg_kernels *set, input_kind kind, rg_cohesive law) {
    input *in = make_broken(kind, law, 3, 0);
    const size_t e = in->element[40];
    int spread = 0;
    in->u[rg_node_index(e, 7, 1)] = NAN;
    for (rg_gradient gradient = RG_GRADIENT_OWN; gradient <= RG_GRADIENT_LIFTED; gradient++) {
        output ref = run_bulk(&rg_kernels_reference, in, gradient), out = run_bulk(set, in, gradient);
        assert_true(isnan(out.stiffening[e]));
        for (size_t s = 0; s < INPUT_ESLOTS; s++) {
            assert_int_equal(isnan(out.stiffening[s]) != 0, isnan(ref.stiffening[s]) != 0);
            spread += isnan(out.stiffening[s]) != 0;
        }
        output_free(&ref);
        output_free(&out);
    }
    assert_true(spread > 2);
    input_free(in);
}

/* A displacement that is not a number shows in the stiffening of its element, and of those it is lifted into.
 */
static void test_nan(void **state) {
    (void)state;
    input_for_each_case(check_nan);
}

static void check_inverted(const rg_kernels *set, input_kind kind, rg_cohesive law) {
    input *in = make_broken(kind, law, 3, 0);
    const size_t e = in->element[40];
    output before = run_bulk(set, in, false);
    for (int a = 0; a < RG_NODES; a++) /* mirror the deformed element */
        in->u[rg_node_index(e, a, 0)] = (rg_real)(-2 * in->x[40][a][0] - in->u[rg_node_index(e, a, 0)]);
    output after = run_bulk(set, in, false);
    for (size_t s = 0; s < INPUT_ESLOTS; s++)
        if (s == e)
            assert_true(isnan(after.stiffening[s]));
        else
            assert_memory_equal(&after.stiffening[s], &before.stiffening[s], sizeof(rg_real));
    output_free(&before);
    output_free(&after);
    input_free(in);
}

/* An element turned inside out has no stiffening; all others are as before. */
static void test_inverted(void **state) {
    (void)state;
    input_for_each_case(check_inverted);
}

static void check_unbreakable(const rg_kernels *set, input_kind kind, rg_cohesive law) {
    rg_real shared[RG_CRACK_BLOCK] __attribute__((aligned(64))) = {0}, untouched[RG_CRACK_BLOCK] = {0};
    law.strength = INFINITY;
    input *in = make_broken(kind, law, 3, 0);
    output out = output_make(in), ref = output_make(in);
    rg_interface_args args =
        input_interface_args(in, out.broken, out.unlinked, out.active, shared, out.iforce);
    args.crack_stride = 0;
    set->interface(&args, 0, INPUT_IBLOCKS);
    set->interface_state(&(rg_interface_state_args){&args, out.ienergy}, 0, INPUT_IBLOCKS);
    args.force = ref.iforce;
    rg_kernels_reference.interface(&args, 0, INPUT_IBLOCKS);
    rg_kernels_reference.interface_state(&(rg_interface_state_args){&args, ref.ienergy}, 0, INPUT_IBLOCKS);
    compare(set->name, &out, &ref);
    assert_memory_equal(shared, untouched, sizeof shared);
    for (size_t s = 0; s < INPUT_ISLOTS; s++)
        assert_int_equal(out.broken[s] | out.unlinked[s], 0);
    output_free(&out);
    output_free(&ref);
    input_free(in);
}

/* With infinite strength nothing breaks, and one crack state is enough for all blocks. */
static void test_unbreakable(void **state) {
    (void)state;
    input_for_each_case(check_unbreakable);
}

/* The other elastic solids: against the reference, in any place, whatever is asked for, and where there is no
 * valid deformation. */
static void test_other_solids(void **state) {
    const rg_kernels *sets[INPUT_SETS];
    int n = input_sets(sets, INPUT_SETS), solids = 0;
    (void)state;
    for (model = RG_MATERIAL_NEO_HOOKEAN + 1; model < RG_MATERIAL_MODELS; model++)
        for (int kind = 0; kind < 2 && rg_material_history(model) == 0 && rg_material_exists(model); kind++) {
            tally t = {0};
            input *in = make_broken((input_kind)kind, input_laws[0], 11, 0.3);
            compare_sets(in, &t);
            input_free(in);
            for (int k = 0; k < n; k++) {
                check_lane(sets[k], (input_kind)kind, input_laws[0]);
                check_state(sets[k], (input_kind)kind, input_laws[0]);
                check_nan(sets[k], (input_kind)kind, input_laws[0]);
                check_inverted(sets[k], (input_kind)kind, input_laws[0]);
            }
            solids++;
        }
    model = RG_MATERIAL_NEO_HOOKEAN;
    assert_true(solids >= 6);
}

static void test_worst(void **state) {
    (void)state;
    assert_true(twin.found > 0 && state_figure(twin));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_against_reference),
        cmocka_unit_test(test_lane_independence),
        cmocka_unit_test(test_neighbour_independence),
        cmocka_unit_test(test_cracked_is_a_hint),
        cmocka_unit_test(test_range),
        cmocka_unit_test(test_state_reads_only),
        cmocka_unit_test(test_nan),
        cmocka_unit_test(test_inverted),
        cmocka_unit_test(test_unbreakable),
        cmocka_unit_test(test_other_solids),
        cmocka_unit_test(test_worst),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
