#include "micro/problem.h"

#include <math.h>
#include <mpi.h>
#include <omp.h>
#include <string.h>

#include "base/hash.h"
#include "base/mem.h"
#include "cost/solids.h"
#include "domain/element.h"

#define CELL     1e-4 /* edge of a cube of six tetrahedra (m) */
#define ROUGH    1e-7 /* displacement (m): strains of about 1e-2 */
#define SMOOTH   1e-9 /* the same, beside a homogeneous strain */
#define STEP     1e-9 /* s, of the ceramic */
#define SPEED    1.0  /* velocity (m/s) */
#define PULL     0.1  /* nodal and corner forces (N): tractions well below the strength */
#define STRENGTH 400e6
#define LAMBDA   77.8e9 /* alumina */
#define MU       107.4e9
#define DENSITY  3690.0
#define OPENING  1.7e-7 /* m */

enum { KEY_U = 1, KEY_VELOCITY, KEY_PULL, KEY_TRACTION, KEY_IPULL, KEY_BREAK, KEY_CRACK };

const char *const bench_size_name[BENCH_SIZES] = {"cache", "memory"};

double bench_noise(uint64_t field, rg_gid element, int place) {
    return 2 * rg_hash_uniform(rg_hash(rg_hash(field, (uint64_t)element), (uint64_t)place)) - 1;
}

bool bench_is_broken(const rg_domain *d, const rg_tile *t, size_t i, int percent) {
    int32_t own = d->side[0][i];
    const double *corner = d->corner + 12 * (t->begin * RG_LANES + (size_t)own / RG_FACES);
    uint64_t h = KEY_BREAK;
    for (int k = 0; k < 9; k++) {
        uint64_t bits;
        memcpy(&bits, &corner[3 * rg_face_node[own % RG_FACES][k / 3] + k % 3], sizeof bits);
        h = rg_hash(h, bits);
    }
    return 100 * rg_hash_uniform(h) < percent;
}

/* In the cache: 252 tetrahedra a thread. Beyond: more than 200,000 (some 8,000 if `quick`). */
static rg_domain *make_domain(bench_size size, bool quick, const rg_interface_material *m) {
    const int64_t side = quick ? 11 : 33;
    const int64_t small[3] = {7, 3, 2 * omp_get_max_threads()}, large[3] = {side, side, side};
    const int64_t *cells = size == BENCH_MEMORY ? large : small;
    double origin[3] = {0, 0, 0}, extent[3];
    for (int c = 0; c < 3; c++) {
        extent[c] = CELL * (double)cells[c];
    }
    rg_mesh *mesh = rg_mesh_box(cells, origin, extent, 0.1, 1);
    rg_part *part = rg_part_distribute(mesh, (int)mesh->elements, MPI_COMM_SELF); /* one tile */
    rg_mesh_free(mesh);
    rg_domain *d = rg_domain_build(part, NULL, 0, m);
    rg_part_free(part);
    return d;
}

/* Values of a block. */
static size_t longest_history(void) {
    int most = 0;
    for (rg_material_model k = 0; k < RG_MATERIAL_MODELS; k++) {
        int here = rg_material_history(k);
        most = here > most ? here : most;
    }
    return rg_history_block(most);
}

static void allocate(bench_problem *p) {
    size_t blocks = p->domain->blocks, faces = p->domain->iblocks + 1;
    p->pull = RG_NEW(rg_real, blocks * RG_NODE_BLOCK);
    p->u = RG_NEW(rg_real, blocks * RG_NODE_BLOCK);
    p->velocity = RG_NEW(rg_real, blocks * RG_NODE_BLOCK);
    p->force = RG_NEW(rg_real, blocks * RG_NODE_BLOCK);
    p->itraction = RG_NEW(rg_real, blocks * RG_TRACTION_BLOCK);
    p->traction = RG_NEW(rg_real, blocks * RG_TRACTION_BLOCK);
    p->stiffening = RG_NEW(rg_real, blocks * RG_LANES);
    p->energy = RG_NEW(double, blocks *RG_LANES);
    p->kinetic = RG_NEW(double, blocks *RG_LANES);
    p->cauchy = RG_NEW(double, blocks *RG_GAUSS * 6 * RG_LANES);
    p->cracked = RG_NEW(uint8_t, blocks);
    p->ipull = RG_NEW(rg_real, faces * RG_IFORCE_BLOCK);
    p->iforce = RG_NEW(rg_real, faces * RG_IFORCE_BLOCK);
    p->history = RG_NEW(rg_real, blocks * longest_history());
    p->crack = RG_NEW(rg_real, faces * RG_CRACK_BLOCK);
    p->ienergy = RG_NEW(double, faces *RG_E_INTERFACE *RG_LANES);
    p->broken = RG_NEW(uint8_t, faces * RG_LANES);
    p->unlinked = RG_NEW(uint8_t, faces * RG_LANES);
    p->active = RG_NEW(uint8_t, faces);
}

/* Fills blocks [begin, end) of `rows` values a lane. */
static void fill(rg_real *x, size_t begin, size_t end, int rows, uint64_t field, double size) {
    for (size_t b = begin; b < end; b++) {
        for (int r = 0; r < rows; r++) {
            for (size_t l = 0; l < RG_LANES; l++) {
                x[(b * (size_t)rows + (size_t)r) * RG_LANES + l] =
                    (rg_real)(size * bench_noise(field, (rg_gid)(b * RG_LANES + l), r));
            }
        }
    }
}

/* Adds to the displacement of all elements what the state's homogeneous strain makes of it. */
static void strain(bench_problem *p, size_t begin, size_t end, bench_state state) {
    static const double gradient[BENCH_STATES][3] = {[BENCH_CRACKING] = {4e-4, 4e-4, 4e-4},
                                                     [BENCH_FLOWING] = {-0.05, -0.05, -0.08},
                                                     [BENCH_CRUSHED] = {0, 0, -0.06}};
    for (size_t e = begin * RG_LANES; e < end * RG_LANES; e++) {
        for (int n = 0; n < RG_NODES; n++) {
            double x[3];
            rg_node_position(p->domain->corner + 12 * e, n, x);
            for (int c = 0; c < 3; c++) {
                p->u[rg_node_index(e, n, c)] += (rg_real)(gradient[state][c] * x[c]);
            }
        }
    }
}

/* Padding is at rest. */
static void rest(rg_real *x, const rg_domain *d, size_t begin, size_t end) {
    for (size_t e = begin * RG_LANES; e < end * RG_LANES; e++) {
        for (int k = 0; d->id[e] < 0 && k < RG_NODES * 3; k++) {
            x[rg_node_index(e, k / 3, k % 3)] = 0;
        }
    }
}

static void fill_inputs(bench_problem *p) {
#pragma omp parallel
    {
        size_t begin, end;
        bench_share(p->domain->blocks, &begin, &end);
        fill(p->pull, begin, end, RG_NODES * 3, KEY_PULL, PULL);
        fill(p->itraction, begin, end, RG_FACES * RG_FCORNERS * 3, KEY_TRACTION, PULL);
        bench_share(p->domain->iblocks, &begin, &end);
        fill(p->ipull, begin, end, RG_FNODES * 3, KEY_IPULL, PULL);
    }
}

static rg_material make_material(rg_material_model model) {
    rg_material m = {.model = model, .lambda = LAMBDA, .mu = MU, .density = DENSITY};
    if (model == RG_MATERIAL_DESHPANDE_EVANS) {
        m.of.deshpande_evans.parameters = rg_deshpande_evans_alumina();
    } else if (model == RG_MATERIAL_ANISOTROPIC) { /* no constant is 0, which may be how it is multiplied */
        for (int i = 0, at = 0; i < 6; i++) {
            for (int j = i; j < 6; j++, at++) {
                double isotropic = i < 3 && j < 3 ? LAMBDA + (i == j ? 2 * MU : 0) : i == j ? MU : 0;
                m.of.anisotropic.stiffness[at] = isotropic + 0.1 * MU * sin(1 + 7 * at);
            }
        }
        m.of.anisotropic.softest = m.of.anisotropic.stiffest = LAMBDA + 2 * MU;
    } else {
        memcpy(m.of.parameter, rg_cost_parameters, sizeof rg_cost_parameters);
        m.of.parameter[RG_PARAMETER_BULK] = LAMBDA + 2 * MU / 3;
        for (int p = 0; p < RG_OGDEN_TERMS; p++) {
            m.of.parameter[RG_PARAMETER_MU_1 + p] = MU / 3;
            m.of.parameter[RG_PARAMETER_ALPHA_1 + p] = 2;
        }
        m.of.parameter[RG_PARAMETER_C10] = 0.3 * MU;
        m.of.parameter[RG_PARAMETER_C01] = 0.2 * MU;
    }
    rg_material_prepare(&m, STEP);
    return m;
}

bench_problem *bench_problem_make(bench_size size, bool quick) {
    const rg_material alumina = make_material(RG_MATERIAL_NEO_HOOKEAN);
    const rg_interface_material m = {1, &alumina, 4, RG_PENALTY_ELASTIC};
    bench_problem *p = RG_NEW(bench_problem, 1);
    p->density = DENSITY;
    for (rg_material_model k = 0; k < RG_MATERIAL_MODELS; k++) {
        p->material[k] = make_material(k);
    }
    p->law = (rg_cohesive){.strength = STRENGTH, .opening = OPENING, .beta = 1};
    p->domain = make_domain(size, quick, &m);
    allocate(p);
    fill_inputs(p);
    return p;
}

/* A broken point has an opening in any direction, so that about half are closed, a little below its largest
 * one. */
static void break_face(bench_problem *p, size_t i) {
    p->broken[i] = p->unlinked[i] = (1 << RG_POINTS) - 1;
    p->active[i / RG_LANES] = 1;
    for (int q = 0; q < RG_POINTS; q++) {
        double square = 0;
        for (int c = 0; c < 3; c++) {
            double w = OPENING * bench_noise(KEY_CRACK, (rg_gid)i, 3 * q + c);
            p->crack[rg_crack_index(i, q, RG_CRACK_ORIGIN + c)] = (rg_real)-w;
            square += w * w;
        }
        p->crack[rg_crack_index(i, q, RG_CRACK_OPENING)] = (rg_real)(1.1 * sqrt(square));
    }
}

static void reset_interfaces(bench_problem *p, size_t begin, size_t end, int percent) {
    const rg_domain *d = p->domain;
    memset(p->crack + begin * RG_CRACK_BLOCK, 0, (end - begin) * RG_CRACK_BLOCK * sizeof *p->crack);
    for (size_t i = begin * RG_LANES; i < end * RG_LANES; i++) {
        p->active[i / RG_LANES] = i % RG_LANES == 0 ? 0 : p->active[i / RG_LANES];
        p->broken[i] = p->unlinked[i] = 0;
        if (d->counted[i] && bench_is_broken(d, d->tile, i, percent)) {
            break_face(p, i);
        }
    }
}

/* Faces of element block `b` that have unlinked points in some lane. */
int bench_unlinked_faces(const rg_domain *d, const uint8_t *unlinked, size_t b) {
    int faces = 0;
    for (int f = 0; f < RG_FACES; f++) {
        uint8_t any = 0;
        for (int l = 0; l < RG_LANES; l++) {
            int32_t link = d->interface[b * RG_LINK_BLOCK + (size_t)(f * RG_LANES + l)];
            any |= link == RG_NO_INTERFACE ? 0 : unlinked[link / 4];
        }
        faces += any != 0;
    }
    return faces;
}

static void spoil(void *x, size_t size, size_t begin, size_t end, size_t per_block) {
    memset((char *)x + begin * per_block * size, 0xff, (end - begin) * per_block * size);
}

void bench_problem_reset(bench_problem *p, int percent, bench_state state) {
    size_t history = longest_history();
#pragma omp parallel
    {
        size_t begin, end;
        bench_share(p->domain->iblocks, &begin, &end);
        reset_interfaces(p, begin, end, percent);
        spoil(p->iforce, sizeof *p->iforce, begin, end, RG_IFORCE_BLOCK);
        spoil(p->ienergy, sizeof *p->ienergy, begin, end, RG_E_INTERFACE * RG_LANES);
#pragma omp barrier
        bench_share(p->domain->blocks, &begin, &end);
        fill(p->u, begin, end, RG_NODES * 3, KEY_U, state == BENCH_ROUGH ? ROUGH : SMOOTH);
        strain(p, begin, end, state);
        memset(p->history + begin * history, 0, (end - begin) * history * sizeof *p->history);
        fill(p->velocity, begin, end, RG_NODES * 3, KEY_VELOCITY, SPEED);
        rest(p->u, p->domain, begin, end);
        spoil(p->force, sizeof *p->force, begin, end, RG_NODE_BLOCK);
        spoil(p->traction, sizeof *p->traction, begin, end, RG_TRACTION_BLOCK);
        spoil(p->stiffening, sizeof *p->stiffening, begin, end, RG_LANES);
        spoil(p->energy, sizeof *p->energy, begin, end, RG_LANES);
        spoil(p->kinetic, sizeof *p->kinetic, begin, end, RG_LANES);
        spoil(p->cauchy, sizeof *p->cauchy, begin, end, RG_GAUSS * 6 * RG_LANES);
        for (size_t b = begin; b < end; b++) {
            p->cracked[b] = bench_unlinked_faces(p->domain, p->unlinked, b) > 0;
        }
    }
}

rg_cost_variant bench_mesh_state(const rg_domain *d, const uint8_t *active, const uint8_t *unlinked,
                                 rg_cost_variant flags, bool by_interface) {
    rg_cost_variant v = flags;
    size_t faces = 0, broken = 0, tile_faces = 0;
    for (size_t t = 0; t < d->tiles; t++) {
        const rg_tile *tile = &d->tile[t];
        for (size_t b = tile->begin; b < tile->end; b++) {
            faces += (size_t)bench_unlinked_faces(d, unlinked + tile->ibegin * RG_LANES, b);
        }
        tile_faces += tile->iend - tile->sbegin;
    }
    for (size_t b = 0; b < d->iblocks; b++) {
        broken += active[b];
    }
    v.unlinked = (double)faces / (double)d->blocks;
    v.damaged = (double)broken / (double)d->iblocks;
    v.points = RG_POINTS;
    v.interfaces = (double)d->iblocks / (double)d->blocks;
    v.tile_faces = (double)tile_faces / (double)d->blocks;
    v.fill = by_interface ? (double)d->interfaces / (double)(d->iblocks * RG_LANES)
                          : (double)d->elements / (double)(d->blocks * RG_LANES);
    return v;
}

static void crush(bench_problem *p, size_t begin, size_t end) {
    static const double history[RG_DE_HISTORY] = {[RG_DE_GROWTH] = 0.34, [RG_DE_STRAIN] = 5e-4};
    size_t block = RG_LANES * rg_history_rows(RG_DE_HISTORY);
    for (size_t b = begin; b < end; b++) {
        for (size_t k = 0; k < RG_GAUSS * RG_DE_HISTORY * RG_LANES; k++) {
            p->history[b * block + k] = (rg_real)history[k / RG_LANES % RG_DE_HISTORY];
        }
    }
}

void bench_problem_restore(bench_problem *p, rg_material_model model, bench_state state, size_t begin,
                           size_t end) {
    if (state == BENCH_CRUSHED) {
        crush(p, begin, end);
    } else if (model != RG_MATERIAL_DESHPANDE_EVANS) { /* it would not flow again where it has flowed */
        size_t block = rg_history_block(rg_material_history(model));
        memset(p->history + begin * block, 0, (end - begin) * block * sizeof *p->history);
    }
}

void bench_problem_free(bench_problem *p) {
    void *blocks[] = {p->pull,   p->itraction, p->ipull,      p->u,      p->velocity,
                      p->crack,  p->cracked,   p->broken,     p->active, p->unlinked,
                      p->force,  p->traction,  p->stiffening, p->iforce, p->energy,
                      p->cauchy, p->kinetic,   p->ienergy,    p->history};
    for (size_t k = 0; k < sizeof blocks / sizeof *blocks; k++) {
        rg_free(blocks[k]);
    }
    rg_domain_free(p->domain);
    rg_free(p);
}
