#include "solver/strength.h"

#include <math.h>

#include "base/error.h"
#include "base/hash.h"
#include "base/mem.h"
#include "base/first_bad.h"
#include "cohesive/facts.h"

/* Strength and critical opening of a face over those of the law. */
typedef struct {
    double strength, opening;
} factors;

/* Looks at the faces, one after the other. */
typedef struct {
    const rg_solver *s;
    double work;       /* of separation, over strength times opening */
    int (*between)[2]; /* [sets]: materials that a set names, the lower first; of others nothing */
    int64_t *claimed;  /* [sets]: faces that each has */
    rg_first_bad bad;  /* where an expression is not finite */
} search;

/* Corners of an interface, as its first side has them; both sides have the same bits. */
static void corners(const rg_solver *s, const rg_tile *t, size_t i, const double *x[RG_FCORNERS]) {
    int32_t link = s->domain->side[0][i];
    const double *corner = s->domain->corner + 12 * (t->begin * RG_LANES + (size_t)link / RG_FACES);
    for (int k = 0; k < RG_FCORNERS; k++) {
        x[k] = corner + 3 * rg_face_node[link % RG_FACES][k];
    }
}

/* Uniform in (0, 1). A sum over the corners, so that their order does not matter. */
static double face_uniform(int64_t seed, const double *x[RG_FCORNERS]) {
    uint64_t sum = 0;
    for (int k = 0; k < RG_FCORNERS; k++) {
        uint64_t h = (uint64_t)seed;
        for (int c = 0; c < 3; c++) {
            h = rg_hash_double(h, x[k][c] + 0.0); /* one zero */
        }
        sum += h;
    }
    return rg_hash_uniform(rg_hash((uint64_t)seed, sum)) + 0x1p-54;
}

static void find_materials(search *f) {
    const rg_case *c = f->s->input;
    for (int i = 0; i < c->interface.sets; i++) {
        if (c->interface.set[i].between != NULL) {
            int a = rg_case_find_material(c, c->interface.set[i].between[0]);
            int b = rg_case_find_material(c, c->interface.set[i].between[1]);
            f->between[i][0] = a < b ? a : b;
            f->between[i][1] = a < b ? b : a;
        }
    }
}

/* Whether the materials on both sides of interface i are the two that set `number` names. */
static bool lies_between(const search *f, int number, size_t i) {
    static const uint8_t alone[2] = {0, 0};
    const uint8_t *beside = f->s->domain->beside != NULL ? f->s->domain->beside[i] : alone;
    return f->between[number][0] == beside[0] && f->between[number][1] == beside[1];
}

/* Whether a set has interface i. */
static bool has(search *f, int number, size_t i, const double middle[3], const double normal[3]) {
    const rg_face_set *set = &f->s->input->interface.set[number];
    double here = set->where == NULL ? 1 : rg_expr_face_value(set->where, middle, normal);
    if (!isfinite(here)) {
        rg_first_bad_note(&f->bad, number, middle, here);
    }
    return here != 0 && (set->between == NULL || lies_between(f, number, i));
}

/* The last set that has the face. */
static void apply_sets(search *look, size_t face, const double *x[RG_FCORNERS], const double normal[3],
                       factors *f) {
    const rg_case *c = look->s->input;
    const rg_cohesive *law = &look->s->model->law;
    double middle[3];
    for (int k = 0; k < 3; k++) {
        middle[k] = (x[0][k] + x[1][k] + x[2][k]) / 3;
    }
    for (int i = 0; i < c->interface.sets; i++) {
        const rg_face_set *set = &c->interface.set[i];
        if (has(look, i, face, middle, normal)) {
            look->claimed[i]++;
            double strength = set->strength > 0 ? set->strength : c->interface.strength;
            double energy = set->energy > 0 ? set->energy : c->interface.energy;
            f->strength = strength / law->strength;
            f->opening = look->work > 0 ? energy / (look->work * strength) / law->opening : 1;
        }
    }
}

/* sigma = sigma_0 (-(A_0/A) ln(1 - U))^(1/m): the weakest link of a face of area A (Weibull 1939; Zhou &
 * Molinari 2004). */
static void apply_weibull(const rg_case *c, const double *x[RG_FCORNERS], double area, factors *f) {
    double u = face_uniform(c->interface.weibull.seed, x);
    double w = pow(-c->interface.weibull.area / area * log1p(-u), 1 / c->interface.weibull.modulus);
    f->strength *= w;
    f->opening /= c->interface.weibull.keep == RG_KEEP_ENERGY ? w : 1;
}

static factors factors_of(search *look, const rg_tile *t, size_t i) {
    const rg_solver *s = look->s;
    factors f = {1, 1};
    double normal[3], area = rg_interface_area(s->domain, i, normal);
    if (area > 0) { /* not in padding */
        const double *x[RG_FCORNERS];
        corners(s, t, i, x);
        for (int c = 0; c < 3; c++) {
            normal[c] /= area;
        }
        apply_sets(look, i, x, normal, &f);
        if (s->input->interface.weibull.modulus > 0) {
            apply_weibull(s->input, x, area, &f);
        }
    }
    return f;
}

/* Ends the run where a set has no face at all: a plane that the mesh does not have, or a slip of the pen. */
static void refuse_empty_sets(const search *look) {
    const rg_case *c = look->s->input;
    MPI_Allreduce(MPI_IN_PLACE, look->claimed, c->interface.sets, MPI_INT64_T, MPI_SUM, look->s->comm);
    for (int i = 0; i < c->interface.sets; i++) {
        const rg_face_set *set = &c->interface.set[i];
        if (look->claimed[i] == 0) {
            rg_speak(look->s->comm);
            rg_fatal(RG_USAGE, "%s: interface.sets[%d]: no face is in it%s%s", c->path, i,
                     set->where != NULL ? ", where: " : " between its materials",
                     set->where != NULL ? rg_expr_text(set->where) : "");
        }
    }
}

void rg_strength_make(const rg_solver *s, rg_model *m) {
    const rg_case *c = s->input;
    const rg_domain *d = s->domain;
    if (c->interface.law == RG_LAW_NONE || (c->interface.sets == 0 && !(c->interface.weibull.modulus > 0))) {
        return;
    }
    double stiffest = 0;
    search look = {.s = s,
                   .work = rg_law_facts_of(m->law.law, m->law.shape, m->law.beta).work,
                   .between = rg_alloc((size_t)c->interface.sets + 1, sizeof *look.between),
                   .claimed = RG_NEW(int64_t, (size_t)c->interface.sets + 1),
                   .bad = {.which = RG_NOWHERE}};
    const rg_first_bad *bad = &look.bad;
    find_materials(&look);
    rg_real *scale = RG_NEW(rg_real, d->iblocks * 2 * RG_LANES);
    m->scale = scale;
    for (size_t t = 0; t < d->tiles; t++) { /* expressions are not for threads */
        for (size_t i = d->tile[t].ibegin * RG_LANES; i < d->tile[t].iend * RG_LANES; i++) {
            factors f = factors_of(&look, &d->tile[t], i);
            scale[i / RG_LANES * 2 * RG_LANES + i % RG_LANES] = (rg_real)f.strength;
            scale[(i / RG_LANES * 2 + 1) * RG_LANES + i % RG_LANES] = (rg_real)f.opening;
            stiffest = fmax(stiffest, f.strength / f.opening);
        }
    }
    rg_free(look.between);
    if (rg_first_bad_lowest(&look.bad, s->comm)) {
        rg_speak(s->comm);
        rg_fatal(RG_USAGE, "%s: interface.sets[%d].where: %s is not finite at (%g, %g, %g)", c->path,
                 (int)bad->which, rg_expr_text(c->interface.set[bad->which].where), bad->x[0], bad->x[1],
                 bad->x[2]);
    }
    refuse_empty_sets(&look);
    rg_free(look.claimed);
    MPI_Allreduce(&stiffest, &m->stiffest, 1, MPI_DOUBLE, MPI_MAX, s->comm);
}
