#include "solver/strength.h"

#include <math.h>
#include <stdio.h>

#include "base/error.h"
#include "base/hash.h"
#include "base/mem.h"
#include "base/first_bad.h"
#include "cohesive/facts.h"

/* What a face has. */
typedef struct {
    bool breaks, open;
    int set;                                       /* whose they are; -1: the interface's */
    double opens_at;                               /* s; 0: an open face is so from the start */
    double strength, energy, beta, friction, rise; /* before they differ at random (Pa, J/m^2) */
    double modulus, area;                          /* of Weibull's distribution (m^2); modulus 0: none */
    int64_t seed;
} properties;

/* Strength and critical opening of a face over those of the law. */
typedef struct {
    double strength, opening;
} factors;

/* Expressions of the interface and of each set, by whose number the first bad one is found. */
enum { ANY = -1 };

enum { WHERE, STRENGTH, ENERGY, BETA, FRICTION, RISE, EXPRESSIONS };

/* Looks at the faces, one after the other. */
typedef struct {
    const rg_solver *s;
    double work;       /* of separation, over strength times opening */
    int (*between)[2]; /* [sets]: materials that a set names, the lower first, or ANY; of others nothing */
    bool **groups;     /* [sets]: groups of faces that are in its set of the mesh; NULL: it names none */
    int64_t *claimed;  /* [sets]: faces that each has */
    rg_first_bad bad;  /* where an expression is not what it must be; which: that of `bad_number` */
} search;

/* Of expression `which` of set i; i = -1: of the interface. */
static int64_t bad_number(int i, int which) {
    return (int64_t)(i + 1) * EXPRESSIONS + which;
}

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
        if (rg_face_set_is_any(&c->interface.set[i])) {
            f->between[i][0] = ANY;
        } else if (c->interface.set[i].between != NULL) {
            int a = rg_case_find_material(c, c->interface.set[i].between[0]);
            int b = rg_case_find_material(c, c->interface.set[i].between[1]);
            f->between[i][0] = a < b ? a : b;
            f->between[i][1] = a < b ? b : a;
        }
    }
}

/* Those of a set of the mesh that an entry names; the mesh file has been asked, the box has none inside. */
static void find_groups(search *f) {
    const rg_case *c = f->s->input;
    for (int i = 0; i < c->interface.sets; i++) {
        const char *name = c->interface.set[i].set;
        int32_t set = name == NULL ? -1 : rg_sets_find(&f->s->part->surface, name);
        if (name != NULL && set < 0) {
            rg_speak(f->s->comm);
            rg_fatal(RG_USAGE, "%s: interface.sets[%d].set: the mesh has no set named '%s'", c->path, i,
                     name);
        }
        f->groups[i] = name == NULL ? NULL : rg_sets_groups_in(&f->s->part->surface, set);
    }
}

/* The element and the face that interface i of tile t has on its first side; what the mesh says of the face
 * is the same on both. */
static size_t first_side(const search *f, const rg_tile *t, size_t i, size_t *face) {
    size_t link = (size_t)f->s->domain->side[0][i];
    *face = link % RG_FACES;
    return t->begin * RG_LANES + link / RG_FACES;
}

static bool is_in_groups(const search *f, const bool *groups, const rg_tile *t, size_t i) {
    size_t face, slot = first_side(f, t, i, &face);
    int32_t group = f->s->domain->set[4 * slot + face];
    return group >= 0 && groups[group];
}

/* Whether the materials on both sides of interface i are the two that set `number` names, or anything
 * differs.
 */
static bool lies_between(const search *f, int number, const rg_tile *t, size_t i) {
    static const uint16_t alone[2] = {0, 0};
    if (f->between[number][0] == ANY) {
        size_t face, slot = first_side(f, t, i, &face);
        return (f->s->domain->across[slot] >> face & 1) != 0;
    }
    const uint16_t *beside = f->s->domain->beside != NULL ? f->s->domain->beside[i] : alone;
    return f->between[number][0] == beside[0] && f->between[number][1] == beside[1];
}

/* Whether a set has interface i of tile t. */
static bool has(search *f, int number, const rg_tile *t, size_t i, const double middle[3],
                const double normal[3]) {
    const rg_face_set *set = &f->s->input->interface.set[number];
    if (f->groups[number] != NULL && !is_in_groups(f, f->groups[number], t, i)) {
        return false;
    }
    double here = set->where == NULL ? 1 : rg_expr_face_value(set->where, middle, normal);
    if (!isfinite(here)) {
        rg_first_bad_note(&f->bad, bad_number(number, WHERE), middle, here);
    }
    return here != 0 && (set->between == NULL || lies_between(f, number, t, i));
}

/* Value of an expression at a face, or the number. */
static double value_of(search *look, int64_t which, double number, const rg_expr *at, const double middle[3],
                       const double normal[3]) {
    if (at == NULL || rg_expr_is_number(at)) {
        return number;
    }
    double value = rg_expr_face_value(at, middle, normal);
    bool may_vanish = which % EXPRESSIONS >= BETA;
    if (!isfinite(value) || value < 0 || (value <= 0 && !may_vanish)) {
        rg_first_bad_note(&look->bad, which, middle, value);
    }
    return value;
}

/* Those of the last set that has the face, and of the interface where it says nothing. */
static properties find_properties(search *look, const rg_tile *t, size_t face, const double *x[RG_FCORNERS],
                                  const double normal[3]) {
    const rg_case *c = look->s->input;
    const rg_face_set *set = &(const rg_face_set){0};
    int number = -1;
    double middle[3];
    for (int k = 0; k < 3; k++) {
        middle[k] = (x[0][k] + x[1][k] + x[2][k]) / 3;
    }
    for (int i = 0; i < c->interface.sets; i++) {
        if (has(look, i, t, face, middle, normal)) {
            look->claimed[i]++;
            set = &c->interface.set[i];
            number = i;
        }
    }
    const struct {
        double own, interface;
        const rg_expr *own_at, *interface_at;
    } of[EXPRESSIONS] = {
        [STRENGTH] = {set->strength, c->interface.strength, set->strength_at, c->interface.strength_at},
        [ENERGY] = {set->energy, c->interface.energy, set->energy_at, c->interface.energy_at},
        [BETA] = {set->beta, look->s->model->law.beta, set->beta_at, NULL},
        [FRICTION] = {set->friction, c->interface.friction, set->friction_at, NULL},
        [RISE] = {set->rise, c->interface.rise.exponent, set->rise_at, NULL},
    };
    double value[EXPRESSIONS] = {0};
    for (int k = STRENGTH; k < EXPRESSIONS; k++) {
        bool own = of[k].own_at != NULL;
        value[k] = value_of(look, bad_number(own ? number : -1, k), own ? of[k].own : of[k].interface,
                            own ? of[k].own_at : of[k].interface_at, middle, normal);
    }
    bool random = set->modulus > 0;
    return (properties){.breaks = set->breaking != RG_BREAKING_NEVER,
                        .open = set->open,
                        .set = number,
                        .opens_at = set->opens_at,
                        .strength = value[STRENGTH],
                        .energy = value[ENERGY],
                        .beta = value[BETA],
                        .friction = value[FRICTION],
                        .rise = value[RISE],
                        .modulus = random ? set->modulus : c->interface.weibull.modulus,
                        .area = random ? set->area : c->interface.weibull.area,
                        .seed = random && set->seed > 0 ? set->seed : c->interface.weibull.seed};
}

/* sigma = sigma_0 (-(A_0/A) ln(1 - U))^(1/m): the weakest link of a face of area A (Weibull 1939; Zhou &
 * Molinari 2004). */
static void apply_weibull(const properties *p, rg_keep keep, const double *x[RG_FCORNERS], double area,
                          factors *f) {
    double u = face_uniform(p->seed, x);
    double w = pow(-p->area / area * log1p(-u), 1 / p->modulus);
    f->strength *= w;
    f->opening /= keep == RG_KEEP_ENERGY ? w : 1;
}

/* Of a face that never breaks the strength is infinite, also of one that opens at a time; of one that is open
 * it is 0. */
static factors factors_of(const search *look, const properties *p, const double *x[RG_FCORNERS],
                          double area) {
    const rg_cohesive *law = &look->s->model->law;
    if (!p->breaks || p->opens_at > 0) {
        return (factors){INFINITY, 1};
    }
    if (p->open) {
        return (factors){0, 1};
    }
    factors f = {p->strength / law->strength,
                 look->work > 0 ? p->energy / (look->work * p->strength) / law->opening : 1};
    if (p->modulus > 0) {
        apply_weibull(p, look->s->input->interface.weibull.keep, x, area, &f);
    }
    return f;
}

/* Fields that are filled, NULL where all faces are alike. */
typedef struct {
    rg_real *scale, *beta, *friction, *rise;
    double stiffest; /* as in rg_model, of this rank */
    rg_opening *opening;
    size_t openings;
    rg_exact_sum *open_area; /* [sets]: of faces that are open, now or later; NULL: no set has any */
    int64_t *open_faces;
} fields;

static void add_opening(fields *to, const rg_opening *o) {
    to->opening = rg_realloc(to->opening, to->openings + 1, sizeof *o);
    to->opening[to->openings++] = *o;
}

static void fill_face(search *look, const rg_tile *t, size_t i, fields *to) {
    double normal[3], area = rg_interface_area(look->s->domain, i, normal);
    factors f = {1, 1};
    properties p = {.breaks = false};
    if (area > 0) { /* not in padding */
        const double *x[RG_FCORNERS];
        corners(look->s, t, i, x);
        for (int c = 0; c < 3; c++) {
            normal[c] /= area;
        }
        p = find_properties(look, t, i, x, normal);
        f = factors_of(look, &p, x, area);
    }
    to->scale[i / RG_LANES * 2 * RG_LANES + i % RG_LANES] = (rg_real)f.strength;
    to->scale[(i / RG_LANES * 2 + 1) * RG_LANES + i % RG_LANES] = (rg_real)f.opening;
    if (to->beta != NULL) {
        to->beta[i] = (rg_real)p.beta;
    }
    if (to->friction != NULL) {
        to->friction[i] = (rg_real)p.friction;
    }
    if (to->rise != NULL) {
        to->rise[i] = (rg_real)p.rise;
    }
    if (p.breaks && p.open && p.opens_at > 0) {
        add_opening(to, &(rg_opening){(size_t)(t - look->s->domain->tile), i, p.set, p.opens_at});
    }
    if (p.breaks && p.open && look->s->domain->counted[i]) {
        rg_exact_add(&to->open_area[p.set], area);
        to->open_faces[p.set]++;
    }
    if (p.breaks && !p.open) {
        to->stiffest = fmax(to->stiffest, f.strength / f.opening);
    }
}

/* Ends the run where a set has no face at all: a plane that the mesh does not have, or a slip of the pen. */
static void refuse_empty_sets(const search *look) {
    const rg_case *c = look->s->input;
    MPI_Allreduce(MPI_IN_PLACE, look->claimed, c->interface.sets, MPI_INT64_T, MPI_SUM, look->s->comm);
    for (int i = 0; i < c->interface.sets; i++) {
        const rg_face_set *set = &c->interface.set[i];
        if (look->claimed[i] == 0) {
            rg_speak(look->s->comm);
            const char *named = set->set == NULL || set->where != NULL ? "" : set->set;
            rg_fatal(RG_USAGE, "%s: interface.sets[%d]: no face is in it%s%s", c->path, i,
                     set->where != NULL        ? ", where: "
                     : set->set != NULL        ? " that lies between elements, set: "
                     : rg_face_set_is_any(set) ? " between volume sets or materials"
                                               : " between its materials",
                     set->where != NULL ? rg_expr_text(set->where) : named);
        }
    }
}

/* Ends the run at the first expression that is not what it must be. */
static void refuse_bad_values(search *look) {
    static const char *const key[] = {"where", "strength", "energy", "beta", "friction", "rise"};
    const rg_case *c = look->s->input;
    const rg_first_bad *bad = &look->bad;
    if (!rg_first_bad_lowest(&look->bad, look->s->comm)) {
        return;
    }
    int set = (int)(bad->which / EXPRESSIONS) - 1, which = (int)(bad->which % EXPRESSIONS);
    const rg_face_set *of = set < 0 ? NULL : &c->interface.set[set];
    const rg_expr *at[] = {of == NULL ? NULL : of->where,
                           of == NULL ? c->interface.strength_at : of->strength_at,
                           of == NULL ? c->interface.energy_at : of->energy_at,
                           of == NULL ? NULL : of->beta_at,
                           of == NULL ? NULL : of->friction_at,
                           of == NULL ? NULL : of->rise_at};
    char place[32] = "";
    if (of != NULL) {
        snprintf(place, sizeof place, ".sets[%d]", set);
    }
    rg_speak(look->s->comm);
    const char *wrong = !isfinite(bad->value) ? "finite" : which >= BETA ? "0 or positive" : "positive";
    rg_fatal(RG_USAGE, "%s: interface%s.%s: %s is not %s at (%g, %g, %g)", c->path, place, key[which],
             rg_expr_text(at[which]), wrong, bad->x[0], bad->x[1], bad->x[2]);
}

/* What each set opens, on all ranks. */
static void share_open(fields *of, const rg_solver *s, rg_model *m) {
    int sets = s->input->interface.sets;
    if (of->open_area == NULL) {
        return;
    }
    double *area = RG_NEW(double, (size_t)sets);
    rg_exact_allreduce(of->open_area, sets, s->comm);
    MPI_Allreduce(MPI_IN_PLACE, of->open_faces, sets, MPI_INT64_T, MPI_SUM, s->comm);
    for (int i = 0; i < sets; i++) {
        area[i] = rg_exact_value(&of->open_area[i]);
    }
    rg_free(of->open_area);
    m->open_area = area;
    m->open_faces = of->open_faces;
}

/* Whether a set has faces that are open, now or later. */
static bool any_open(const rg_case *c) {
    bool any = false;
    for (int i = 0; i < c->interface.sets; i++) {
        any = any || c->interface.set[i].open;
    }
    return any;
}

static bool is_expression(const rg_expr *e) {
    return e != NULL && !rg_expr_is_number(e);
}

/* Whether faces differ; in what, beside strength and opening. */
static bool differ(const rg_case *c) {
    return c->interface.sets > 0 || c->interface.weibull.modulus > 0 ||
           is_expression(c->interface.strength_at) || is_expression(c->interface.energy_at);
}

static bool sets_have(const rg_case *c, size_t offset) {
    bool have = false;
    for (int i = 0; i < c->interface.sets; i++) {
        rg_expr *const *at = (void *)((char *)&c->interface.set[i] + offset);
        have = have || *at != NULL;
    }
    return have;
}

static rg_real *field_if(bool wanted, size_t count) {
    return wanted ? RG_NEW(rg_real, count) : NULL;
}

void rg_strength_make(const rg_solver *s, rg_model *m) {
    const rg_case *c = s->input;
    const rg_domain *d = s->domain;
    if (c->interface.law == RG_LAW_NONE || !differ(c)) {
        return;
    }
    size_t slots = d->iblocks * RG_LANES;
    search look = {.s = s,
                   .work = rg_law_facts_of(m->law.law, m->law.shape, m->law.beta).work,
                   .between = rg_alloc((size_t)c->interface.sets + 1, sizeof *look.between),
                   .groups = RG_NEW(bool *, (size_t)c->interface.sets + 1),
                   .claimed = RG_NEW(int64_t, (size_t)c->interface.sets + 1),
                   .bad = {.which = RG_NOWHERE}};
    fields to = {.scale = field_if(true, 2 * slots),
                 .beta = field_if(sets_have(c, offsetof(rg_face_set, beta_at)), slots),
                 .friction = field_if(sets_have(c, offsetof(rg_face_set, friction_at)), slots),
                 .rise = field_if(sets_have(c, offsetof(rg_face_set, rise_at)), slots)};
    if (any_open(c)) {
        to.open_area = RG_NEW(rg_exact_sum, (size_t)c->interface.sets);
        to.open_faces = RG_NEW(int64_t, (size_t)c->interface.sets);
    }
    find_materials(&look);
    find_groups(&look);
    for (size_t t = 0; t < d->tiles; t++) { /* expressions are not for threads */
        for (size_t i = d->tile[t].ibegin * RG_LANES; i < d->tile[t].iend * RG_LANES; i++) {
            fill_face(&look, &d->tile[t], i, &to);
        }
    }
    rg_free(look.between);
    for (int i = 0; i < c->interface.sets; i++) {
        rg_free(look.groups[i]);
    }
    rg_free(look.groups);
    refuse_bad_values(&look);
    refuse_empty_sets(&look);
    rg_free(look.claimed);
    m->scale = to.scale;
    m->opening = to.opening;
    m->openings = to.openings;
    share_open(&to, s, m);
    m->beta = to.beta;
    m->friction = to.friction;
    m->rise = to.rise;
    MPI_Allreduce(&to.stiffest, &m->stiffest, 1, MPI_DOUBLE, MPI_MAX, s->comm);
}
