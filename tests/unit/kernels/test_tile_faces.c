/* Tile-boundary faces on every set of kernels: a face computed as a tile-boundary face from either side has
 * the bits that it has inside a tile, and an element does not feel which of its faces are tile-boundary
 * faces.
 *
 * A cut takes the input's body and turns some of its faces into two tile-boundary faces each, both in the
 * same tile; what they know of each other comes through send, receive and send_tractions alone. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/hash.h"
#include "support/kernel_input.h"
#include "support/precision.h"

enum {
    NONE = -1,
    ROW = 5, /* first row of the tile among all rows */
    MOST_IBLOCKS = 2 * INPUT_IBLOCKS + 2,
    MOST_ISLOTS = MOST_IBLOCKS * RG_LANES,
    MOST_ROWS = ROW + MOST_ISLOTS,
    NODE_VALUES = INPUT_EBLOCKS * RG_NODE_BLOCK,
};

/* Interface numbers of the cut body: copy[i] are those of the input's interface i, one inside the tile and
 * NONE, or the tile-boundary faces on the minus and on the plus side. */
typedef struct {
    const input *in;
    size_t inside, iblocks; /* blocks */
    size_t rows;            /* of tile-boundary faces */
    int copy[INPUT_INTERFACES][2];
    int32_t *neighbour, *interface, *side[2];
    rg_real *igeom, *ipull, *crack, *force, *turn;
    uint8_t *broken, *unlinked, *active;
    rg_real *all_rows, *tractions, *ghost;
} cut;

static size_t whole_blocks(size_t n) {
    return (n + RG_LANES - 1) / RG_LANES;
}

static bool is_tile_face(const cut *c, size_t i) {
    return c->copy[i][1] != NONE;
}

/* Numbers faces; every `every`-th one at random becomes a tile-boundary face, all for 1, none for 0. The
 * tile-boundary faces of the plus side lie behind those of the minus side in reverse order, so that both
 * sides meet other lanes. */
static void number(cut *c, uint64_t every) {
    size_t inside = 0, tile_faces = 0;
    for (size_t i = 0; i < INPUT_INTERFACES; i++) {
        bool tile_face = every > 0 && rg_hash(3, i) % every == 0;
        c->copy[i][0] = (int)(tile_face ? tile_faces : inside);
        c->copy[i][1] = tile_face ? 0 : NONE;
        *(tile_face ? &tile_faces : &inside) += 1;
    }
    c->inside = whole_blocks(inside);
    c->rows = whole_blocks(2 * tile_faces) * RG_LANES;
    c->iblocks = c->inside + whole_blocks(2 * tile_faces);
    for (size_t i = 0; i < INPUT_INTERFACES; i++)
        if (is_tile_face(c, i)) {
            int first = (int)(c->inside * RG_LANES), k = c->copy[i][0];
            c->copy[i][0] = first + k;
            c->copy[i][1] = first + (int)(2 * tile_faces) - 1 - k;
        }
}

static void allocate(cut *c) {
    c->neighbour = input_alloc(INPUT_ESLOTS * RG_FACES * sizeof(int32_t));
    c->interface = input_alloc(INPUT_ESLOTS * RG_FACES * sizeof(int32_t));
    for (int k = 0; k < 2; k++)
        c->side[k] = input_alloc(MOST_ISLOTS * sizeof(int32_t));
    c->igeom = input_alloc(MOST_IBLOCKS * RG_IGEOM_BLOCK * sizeof(rg_real));
    c->ipull = input_alloc(MOST_IBLOCKS * RG_IFORCE_BLOCK * sizeof(rg_real));
    c->crack = input_alloc(MOST_IBLOCKS * RG_CRACK_BLOCK * sizeof(rg_real));
    c->force = input_alloc(MOST_IBLOCKS * RG_IFORCE_BLOCK * sizeof(rg_real));
    c->turn = input_alloc(MOST_IBLOCKS * RG_IFORCE_BLOCK * sizeof(rg_real));
    c->broken = input_alloc(MOST_ISLOTS);
    c->unlinked = input_alloc(MOST_ISLOTS);
    c->active = input_alloc(MOST_IBLOCKS);
    c->all_rows = input_alloc(MOST_ROWS * RG_TRACE_ROW * sizeof(rg_real));
    c->tractions = input_alloc(MOST_ROWS * RG_TILE_FACE_ROW * sizeof(rg_real));
    c->ghost = input_alloc(MOST_IBLOCKS * RG_GHOST_BLOCK * sizeof(rg_real));
}

static void cut_free(cut *c) {
    void *blocks[] = {c->neighbour, c->interface, c->side[0],   c->side[1], c->igeom,
                      c->ipull,     c->crack,     c->force,     c->broken,  c->unlinked,
                      c->active,    c->all_rows,  c->tractions, c->ghost,   c->turn};
    for (size_t k = 0; k < sizeof blocks / sizeof *blocks; k++)
        free(blocks[k]);
}

/* Geometry and state of the input's interface in slot s, to interface `to`. */
static void copy_interface(cut *c, size_t s, size_t to) {
    const input *in = c->in;
    for (int k = 0; k < RG_IGEOM; k++)
        c->igeom[rg_igeom_index(to, k)] = in->igeom[rg_igeom_index(s, k)];
    for (int k = 0; k < RG_IFORCE_ROW; k++)
        c->ipull[rg_iforce_index(to, k / 3, k % 3)] = in->ipull[rg_iforce_index(s, k / 3, k % 3)];
    for (int k = 0; k < RG_POINTS * RG_CRACK; k++)
        c->crack[rg_crack_index(to, k / RG_CRACK, k % RG_CRACK)] =
            in->crack[rg_crack_index(s, k / RG_CRACK, k % RG_CRACK)];
    c->broken[to] = in->broken[s];
    c->unlinked[to] = in->unlinked[s];
    c->active[to / RG_LANES] |= in->broken[s] != 0;
}

static void link_inside(cut *c, size_t s, size_t to) {
    for (int side = 0; side < 2; side++) {
        int32_t own = c->in->side[side][s];
        c->side[side][to] = own;
        c->interface[rg_link_index((size_t)own / 4, own % 4)] = rg_link(to, side, 4);
    }
}

static void link_tile_faces(cut *c, size_t s, const int copy[2]) {
    size_t first = c->inside * RG_LANES;
    for (int side = 0; side < 2; side++) {
        int32_t own = c->in->side[side][s];
        size_t here = (size_t)copy[side], there = (size_t)copy[1 - side];
        c->side[0][here] = own;
        c->side[1][here] = rg_link(ROW + there - first, side, 2);
        c->interface[rg_link_index((size_t)own / 4, own % 4)] = rg_link(here, RG_TILE_FACE + side, 4);
        c->neighbour[rg_link_index((size_t)own / 4, own % 4)] = rg_neighbour_link(here - first, RG_GHOST);
    }
}

static cut cut_make(const input *in, uint64_t every) {
    cut c = {.in = in};
    number(&c, every);
    allocate(&c);
    memcpy(c.neighbour, in->neighbour, INPUT_ESLOTS * RG_FACES * sizeof(int32_t));
    for (size_t k = 0; k < INPUT_ESLOTS * RG_FACES; k++)
        c.interface[k] = RG_NO_INTERFACE;
    for (size_t k = 0; k < c.rows; k++) /* padding: element 0's face, its own row */
        c.side[1][c.inside * RG_LANES + k] = rg_link(ROW + k, 0, 2);
    for (size_t i = 0; i < INPUT_INTERFACES; i++) {
        size_t s = in->slot[i];
        for (int k = 0; k < (is_tile_face(&c, i) ? 2 : 1); k++)
            copy_interface(&c, s, (size_t)c.copy[i][k]);
        if (is_tile_face(&c, i))
            link_tile_faces(&c, s, c.copy[i]);
        else
            link_inside(&c, s, (size_t)c.copy[i][0]);
    }
    return c;
}

/* ---- Arguments ---- */

static rg_trace_args trace_args(const cut *c) {
    return (rg_trace_args){
        .u = c->in->u,
        .traction = c->in->traction,
        .side = c->side[0] + c->inside * RG_LANES,
        .other = c->side[1] + c->inside * RG_LANES,
        .rows = c->all_rows,
        .own_rows = c->all_rows + ROW * RG_TRACE_ROW,
        .own_tractions = c->tractions + ROW * RG_TILE_FACE_ROW,
        .ghost = c->ghost,
    };
}

static void exchange(const rg_kernels *set, const cut *c) {
    const rg_trace_args args = trace_args(c);
    set->send(&args, 0, c->iblocks - c->inside);
    set->send_tractions(&args, 0, c->iblocks - c->inside);
    set->receive(&args, 0, c->iblocks - c->inside);
}

static rg_interface_args interface_args(const cut *c) {
    rg_interface_args args =
        input_interface_args(c->in, c->broken, c->unlinked, c->active, c->crack, c->force);
    args.first_tile_face = c->inside;
    args.ghost = c->ghost;
    args.own_tractions = c->tractions + ROW * RG_TILE_FACE_ROW;
    args.tractions = c->tractions;
    args.side[0] = c->side[0];
    args.side[1] = c->side[1];
    args.geom = c->igeom;
    args.turn = c->turn;
    return args;
}

static rg_bulk_args bulk_args(const cut *c, rg_real *force, rg_real *traction, rg_real *stiffening) {
    rg_bulk_args args = input_bulk_args(c->in, force, traction, stiffening);
    args.ghost = c->ghost;
    args.neighbour = c->neighbour;
    args.interface = c->interface;
    args.unlinked = c->unlinked;
    return args;
}

static _Noreturn void fail_at(const char *set, const char *what, size_t i, double got, double expected) {
    fail_msg("%s: %s of %zu is %.17g instead of %.17g", set, what, i, got, expected);
    abort();
}

static void same_bits(const char *set, const char *what, size_t i, double got, double expected) {
    if (memcmp(&got, &expected, sizeof got) != 0)
        fail_at(set, what, i, got, expected);
}

static input *make_broken(input_kind kind, rg_cohesive law) {
    input *in = input_make(kind, law, 7, 11);
    input_break(in, 0.3);
    return in;
}

/* ---- Interfaces ---- */

/* Results for all interfaces of a body, whole or cut. */
typedef struct {
    rg_real *force, *turn, *crack;
    double *energy;
    const uint8_t *broken, *unlinked;
} result;

/* Energies of the state before, then forces and the new state. */
static result run_interfaces(const rg_kernels *set, const rg_interface_args *args, size_t blocks) {
    double *energy = input_alloc(blocks * RG_LANES * RG_E_INTERFACE * sizeof *energy);
    set->interface_state(&(rg_interface_state_args){args, energy}, 0, blocks);
    set->interface(args, 0, blocks);
    return (result){args->force, args->turn, args->crack, energy, args->broken, args->unlinked};
}

static double energy_of(const result *r, size_t i, int k) {
    return r->energy[(i / RG_LANES * RG_E_INTERFACE + (size_t)k) * RG_LANES + i % RG_LANES];
}

/* Interface i of the one against interface j of the other, bit for bit. */
static void compare(const char *set, bool potential, const result *a, size_t i, const result *b, size_t j) {
    assert_int_equal(a->broken[i], b->broken[j]);
    assert_int_equal(a->unlinked[i], b->unlinked[j]);
    for (int k = 0; k < RG_IFORCE_ROW; k++)
        same_bits(set, "force", i, a->force[rg_iforce_index(i, k / 3, k % 3)],
                  b->force[rg_iforce_index(j, k / 3, k % 3)]);
    for (int k = 0; potential && a->broken[i] != 0 && k < RG_IFORCE_ROW; k++)
        same_bits(set, "turn", i, a->turn[rg_iforce_index(i, k / 3, k % 3)],
                  b->turn[rg_iforce_index(j, k / 3, k % 3)]);
    for (int k = 0; k < RG_E_INTERFACE; k++)
        same_bits(set, "energy", i, energy_of(a, i, k), energy_of(b, j, k));
    for (int k = 0; k < RG_POINTS * RG_CRACK; k++)
        if (a->broken[i] >> k / RG_CRACK & 1)
            same_bits(set, "crack", i, a->crack[rg_crack_index(i, k / RG_CRACK, k % RG_CRACK)],
                      b->crack[rg_crack_index(j, k / RG_CRACK, k % RG_CRACK)]);
}

/* The input is advanced in place, after the cut has taken its state. */
static void check_interface(const rg_kernels *set, input_kind kind, rg_cohesive law) {
    for (uint64_t every = 1; every <= 2; every++) {
        input *in = make_broken(kind, law);
        cut c = cut_make(in, every);
        int tile_faces = 0, switched = 0;
        uint8_t before[INPUT_ISLOTS];
        memcpy(before, in->broken, sizeof before);
        rg_interface_args whole = input_interface_args(in, in->broken, in->unlinked, in->active, in->crack,
                                                       input_alloc(INPUT_IBLOCKS * RG_IFORCE_BLOCK * 8));
        whole.turn = input_alloc(INPUT_IBLOCKS * RG_IFORCE_BLOCK * 8);
        rg_interface_args parts = interface_args(&c);
        exchange(set, &c);
        result a = run_interfaces(set, &whole, INPUT_IBLOCKS), b = run_interfaces(set, &parts, c.iblocks);
        for (size_t i = 0; i < INPUT_INTERFACES; i++) {
            switched += in->broken[in->slot[i]] != before[in->slot[i]];
            for (int k = 0; k < 2 && c.copy[i][k] != NONE; k++) {
                compare(set->name, law.contact == RG_CONTACT_POTENTIAL, &a, in->slot[i], &b,
                        (size_t)c.copy[i][k]);
                assert_true(!in->broken[in->slot[i]] || c.active[c.copy[i][k] / RG_LANES]);
                tile_faces += is_tile_face(&c, i);
            }
        }
        assert_true(tile_faces > 100 && switched > 10);
        free(whole.force);
        free(whole.turn);
        free(a.energy);
        free(b.energy);
        cut_free(&c);
        input_free(in);
    }
}

/* Nodal force, crack state, masks and energies of a tile-boundary face, from its minus and from its plus
 * side, are those of the face inside a tile; so are those of the faces that remain inside. */
static void test_interface(void **state) {
    (void)state;
    input_for_each_case(check_interface);
}

/* ---- Rows ---- */

/* What the rows and ghosts of the cut must be, looked up in the whole body. */
static void check_ghosts(const char *set, const cut *c) {
    const input *in = c->in;
    for (size_t i = 0; i < INPUT_INTERFACES; i++)
        for (int k = 0; is_tile_face(c, i) && k < 2; k++) {
            size_t tile_face = (size_t)c->copy[i][k] - c->inside * RG_LANES;
            int32_t own = in->side[k][in->slot[i]], other = in->side[1 - k][in->slot[i]];
            for (int n = 0; n < RG_FNODES * 3; n++)
                same_bits(set, "ghost", tile_face, c->ghost[rg_iforce_index(tile_face, n / 3, n % 3)],
                          in->u[rg_node_index((size_t)other / 4, rg_face_node[other % 4][n / 3], n % 3)]);
            for (int n = 0; n < RG_TILE_FACE_ROW; n++)
                same_bits(set, "traction row", tile_face,
                          c->tractions[(ROW + tile_face) * RG_TILE_FACE_ROW + (size_t)n],
                          in->traction[rg_traction_index((size_t)own / 4, own % 4, n / 3, n % 3)]);
        }
}

static void spoil(rg_real *x, size_t n) {
    for (size_t k = 0; k < n; k++)
        x[k] = -12345;
}

static void check_rows(const rg_kernels *set, input_kind kind, rg_cohesive law) {
    input *in = make_broken(kind, law);
    cut c = cut_make(in, 2), ref = cut_make(in, 2);
    cut *both[2] = {&c, &ref};
    for (int k = 0; k < 2; k++) {
        spoil(both[k]->all_rows, MOST_ROWS * RG_TRACE_ROW);
        spoil(both[k]->tractions, MOST_ROWS * RG_TILE_FACE_ROW);
        spoil(both[k]->ghost, MOST_IBLOCKS * RG_GHOST_BLOCK);
        exchange(k ? &rg_kernels_reference : set, both[k]);
    }
    assert_memory_equal(c.all_rows, ref.all_rows, MOST_ROWS * RG_TRACE_ROW * sizeof(rg_real));
    assert_memory_equal(c.tractions, ref.tractions, MOST_ROWS * RG_TILE_FACE_ROW * sizeof(rg_real));
    assert_memory_equal(c.ghost, ref.ghost, MOST_IBLOCKS * RG_GHOST_BLOCK * sizeof(rg_real));
    check_ghosts(set->name, &c);
    cut_free(&c);
    cut_free(&ref);
    input_free(in);
}

/* Rows and ghosts have the reference's bits, which are those of the other side's fields. */
static void test_rows(void **state) {
    (void)state;
    input_for_each_case(check_rows);
}

static void check_row_range(const rg_kernels *set, input_kind kind, rg_cohesive law) {
    enum { BEGIN = 2, END = 5 };
    input *in = make_broken(kind, law);
    cut full = cut_make(in, 1), some = cut_make(in, 1);
    const rg_trace_args args = trace_args(&some);
    exchange(set, &full);
    set->send(&args, 0, some.iblocks - some.inside); /* ghosts need all rows */
    set->receive(&args, BEGIN, END);
    set->send_tractions(&args, BEGIN, END);
    spoil(some.all_rows, MOST_ROWS * RG_TRACE_ROW);
    set->send(&args, BEGIN, END);
    for (size_t s = 0; s < full.rows; s++) {
        bool in_range = s / RG_LANES >= BEGIN && s / RG_LANES < END;
        for (size_t k = 0; k < RG_TRACE_ROW; k++) {
            size_t row = (ROW + s) * RG_TRACE_ROW + k, ghost = rg_iforce_index(s, (int)k / 3, (int)k % 3);
            same_bits(set->name, "row", s, some.all_rows[row], in_range ? full.all_rows[row] : -12345);
            same_bits(set->name, "ghost", s, some.ghost[ghost], in_range ? full.ghost[ghost] : 0);
        }
        for (size_t k = 0; k < RG_TILE_FACE_ROW; k++) {
            size_t row = (ROW + s) * RG_TILE_FACE_ROW + k;
            same_bits(set->name, "traction", s, some.tractions[row], in_range ? full.tractions[row] : 0);
        }
    }
    cut_free(&full);
    cut_free(&some);
    input_free(in);
}

/* Rows and ghosts of blocks outside the range are left alone. */
static void test_row_range(void **state) {
    (void)state;
    input_for_each_case(check_row_range);
}

/* ---- Bulk ---- */

enum { FORCE, TRACTION, STIFFENING, ENERGY, CAUCHY, BULK };

static const size_t bulk_values[BULK] = {NODE_VALUES, INPUT_EBLOCKS *RG_TRACTION_BLOCK, INPUT_ESLOTS,
                                         INPUT_ESLOTS, INPUT_ESLOTS * 24};
static const size_t bulk_size[BULK] = {sizeof(rg_real), sizeof(rg_real), sizeof(rg_real), sizeof(double),
                                       sizeof(double)};

static void run_bulk(const rg_kernels *set, rg_bulk_args args, void *out[BULK]) {
    for (int k = 0; k < BULK; k++)
        out[k] = input_alloc(bulk_values[k] * bulk_size[k]);
    args.force = out[FORCE];
    args.traction = out[TRACTION];
    args.stiffening = out[STIFFENING];
    set->bulk(&args, 0, INPUT_EBLOCKS);
    set->bulk_state(&(rg_bulk_state_args){.bulk = &args, .energy = out[ENERGY], .cauchy = out[CAUCHY]}, 0,
                    INPUT_EBLOCKS);
}

static void check_bulk(const rg_kernels *set, input_kind kind, rg_cohesive law) {
    static const char *const name[BULK] = {"force", "traction", "stiffening", "energy", "stress"};
    for (uint64_t every = 1; every <= 2; every++) {
        input *in = make_broken(kind, law);
        cut c = cut_make(in, every);
        void *a[BULK], *b[BULK];
        exchange(set, &c);
        run_bulk(set, input_bulk_args(in, NULL, NULL, NULL), a);
        run_bulk(set, bulk_args(&c, NULL, NULL, NULL), b);
        for (int k = 0; k < BULK; k++)
            if (memcmp(a[k], b[k], bulk_values[k] * bulk_size[k]) != 0)
                fail_msg("%s: %s of elements with ghosts has other bits", set->name, name[k]);
        for (int k = 0; k < BULK; k++) {
            free(a[k]);
            free(b[k]);
        }
        cut_free(&c);
        input_free(in);
    }
}

/* Elements whose neighbours are ghosts, some or all, have the same bits as with neighbours in the tile. */
static void test_bulk(void **state) {
    (void)state;
    input_for_each_case(check_bulk);
}

/* ---- Kick ---- */

typedef struct {
    rg_real *velocity, *now;
} motion;

static motion motion_make(const input *in) {
    motion m = {input_alloc(NODE_VALUES * sizeof(rg_real)), input_alloc(NODE_VALUES * sizeof(rg_real))};
    memcpy(m.velocity, in->velocity, NODE_VALUES * sizeof(rg_real));
    spoil(m.now, NODE_VALUES);
    return m;
}

static void motion_free(motion *m) {
    free(m->velocity);
    free(m->now);
}

static rg_kick_args kick_args(const input *in, const motion *m, rg_mass mass) {
    return (rg_kick_args){.density = in->material.density,
                          .mass = mass,
                          .dt = 1e-10,
                          .geom = in->geom,
                          .force = in->pull,
                          .iforce = in->ipull,
                          .contact = RG_CONTACT_POTENTIAL,
                          .turn = in->ipull, /* any forces do, on any faces */
                          .broken = in->broken,
                          .interface = in->interface,
                          .velocity = m->velocity,
                          .step_velocity = m->now,
                          .dt_now = 4e-11};
}

/* Both parts of the kick of the cut body. The second must do without the bulk's forces. */
static motion kick_cut(const rg_kernels *set, const cut *c, rg_mass mass, bool now) {
    motion m = motion_make(c->in);
    rg_kick_args args = kick_args(c->in, &m, mass);
    args.iforce = args.turn = c->ipull;
    args.broken = c->broken;
    args.interface = c->interface;
    args.step_velocity = now ? m.now : NULL;
    set->kick(&args, 0, INPUT_EBLOCKS);
    args.sweep = RG_SWEEP_BOUNDARY;
    args.force = NULL;
    set->kick(&args, 0, INPUT_EBLOCKS);
    return m;
}

static void assert_close(const char *set, const char *what, const rg_real *got, const rg_real *expected) {
    double scale = 0;
    for (size_t k = 0; k < NODE_VALUES; k++)
        scale = fmax(scale, fabs(expected[k]));
    for (size_t k = 0; k < NODE_VALUES; k++)
        if (!(fabs(got[k] - expected[k]) <= TOLERANCE * scale))
            fail_at(set, what, k, got[k], expected[k]);
}

/* The kick leads from v to v + dt a and to v + dt_now a. */
static void check_now(const char *set, const input *in, const motion *m) {
    rg_real *expected = input_alloc(NODE_VALUES * sizeof(rg_real));
    for (size_t k = 0; k < NODE_VALUES; k++)
        expected[k] = (rg_real)(in->velocity[k] + 0.4 * (m->velocity[k] - in->velocity[k]));
    assert_close(set, "now", m->now, expected);
    free(expected);
}

static void check_kick(const rg_kernels *set, uint64_t every, rg_mass mass) {
    input *in = make_broken(INPUT_SMALL, input_laws[0]);
    cut c = cut_make(in, every);
    motion whole = motion_make(in), parts = kick_cut(set, &c, mass, true);
    motion ref = kick_cut(&rg_kernels_reference, &c, mass, true), quiet = kick_cut(set, &c, mass, false);
    rg_kick_args args = kick_args(in, &whole, mass);
    set->kick(&args, 0, INPUT_EBLOCKS);
    assert_close(set->name, "velocity, one part against two", parts.velocity, whole.velocity);
    assert_close(set->name, "now, one part against two", parts.now, whole.now);
    assert_close(set->name, "velocity against reference", parts.velocity, ref.velocity);
    assert_close(set->name, "now against reference", parts.now, ref.now);
    check_now(set->name, in, &parts);
    assert_memory_equal(quiet.velocity, parts.velocity, NODE_VALUES * sizeof(rg_real));
    if (every == 0) { /* no tile-boundary faces: the second part changes nothing */
        assert_memory_equal(parts.velocity, whole.velocity, NODE_VALUES * sizeof(rg_real));
        assert_memory_equal(parts.now, whole.now, NODE_VALUES * sizeof(rg_real));
    }
    motion_free(&whole);
    motion_free(&parts);
    motion_free(&ref);
    motion_free(&quiet);
    cut_free(&c);
    input_free(in);
}

/* A kick in two parts is that in one part; `now` does not change it and agrees with it. */
static void test_kick(void **state) {
    const rg_kernels *sets[INPUT_SETS];
    int n = input_sets(sets, INPUT_SETS);
    (void)state;
    for (int k = 0; k < n; k++)
        for (uint64_t every = 0; every <= 20; every += every < 2 ? 1 : 18) /* none, all, half, few */
            for (rg_mass mass = RG_MASS_CONSISTENT; mass < (rg_mass)RG_MASSES; mass++)
                check_kick(sets[k], every, mass);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_interface), cmocka_unit_test(test_rows), cmocka_unit_test(test_row_range),
        cmocka_unit_test(test_bulk),      cmocka_unit_test(test_kick),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
