#include "case/key.h"

#include <math.h>
#include <stdint.h>
#include <string.h>
#include <strings.h>

#include "base/mem.h"
#include "case/expr.h"
#include "case/tree.h"
#include "cohesive/facts.h"

#define CASE(member)   .offset = offsetof(rg_case, member)
#define CHOICE(list)   .type = RG_KEY_CHOICE, .choice = (list)
#define REAL           .type = RG_KEY_REAL, .count = 1
#define REAL3          .type = RG_KEY_REAL, .count = 3
#define INTEGER        .type = RG_KEY_INTEGER, .count = 1
#define INTEGER3       .type = RG_KEY_INTEGER, .count = 3
#define ANY            .low = -INFINITY, .high = INFINITY
#define FROM(a)        .low = (a), .high = INFINITY
#define ABOVE(a)       .low = (a), .low_open = true, .high = INFINITY
#define FROM_TO(a, b)  .low = (a), .high = (b)
#define REQUIRED       .need = RG_NEED_REQUIRED
#define OPTIONAL       .need = RG_NEED_OPTIONAL
#define DEFAULT(value) .need = RG_NEED_DEFAULT, .fallback = (value)
#define BOX            .group = RG_GROUP_BOX
#define GROUP(name)    .group = RG_GROUP_##name
#define ELASTIC        .models = 0 RG_MATERIALS(TAKES_YOUNG)
#define CERAMIC        .models = RG_MATERIAL_BIT_DESHPANDE_EVANS
#define MAY_CHANGE     .may_change = true /* on a restart */

#define TAKES_YOUNG(name, NAME, word, history, inside)                                                       \
    | ((inside)&RG_TAKES_YOUNG ? RG_MATERIAL_BIT_##NAME : 0)

/* In the order of the enums they set. */
#define MODEL_WORD(name, NAME, word, history, inside) word,
static const char *const models[] = {RG_MATERIALS(MODEL_WORD) NULL};
static const char *const interactions[] = {"thesis", "derived", NULL};
static const char *const forms[] = {"variational", "incomplete", "intrinsic", "continuous", NULL};
static const char *const penalties[] = {"elastic", "isotropic", NULL};
static const char *const laws[] = {
#define RG_LAW(NAME, name, word, ...) word,
#include "laws.h"
#undef RG_LAW
    "none", NULL};
static const char *const activations[] = {"continuous", "total", "conserving", NULL};
static const char *const contacts[] = {"penalty", "flux", "potential", NULL};
static const char *const precisions[] = {"double", "single", NULL};
static const char *const keeps[] = {"energy", "opening", NULL};
static const char *const masses[] = {"consistent", "lumped", NULL};
static const char *const shapes[] = {"sphere", "plane", "cylinder", NULL};
static const char *const motions[] = {"free", "prescribed", NULL};
static const char *const components[] = {"x", "y", "z", NULL};
static const char *const box_sets[] = {"x-", "x+", "y-", "y+", "z-", "z+", NULL};
static const char *const fields[] = {
    "displacement", "velocity",       "stress",      "mean_stress", "principal_stress", "crack",    "damage",
    "regime",       "plastic_strain", "triaxiality", "rank",        "fragment",         "material", NULL};
static const char *const fragments[] = {"each", "last", "none", NULL};

#define INITIAL(name_, unit_, member)                                                                        \
    { .name = (name_), .unit = (unit_), .type = RG_KEY_EXPR, OPTIONAL, .no_time = true, CASE(initial.member) }

/* clang-format off */
static const rg_key case_keys[] = {
    {.name = "mesh.file", .type = RG_KEY_TEXT, OPTIONAL, MAY_CHANGE, CASE(mesh.file)},
    {.name = "mesh.cells", INTEGER3, FROM_TO(1, 100000), REQUIRED, BOX, CASE(mesh.cells)},
    {.name = "mesh.size", .unit = "m", REAL3, ABOVE(0), REQUIRED, BOX, CASE(mesh.size)},
    {.name = "mesh.origin", .unit = "m", REAL3, ANY, DEFAULT(0), BOX, CASE(mesh.origin)},
    {.name = "mesh.jitter", REAL, FROM_TO(0, 0.3), DEFAULT(0), BOX, CASE(mesh.jitter)},
    {.name = "mesh.seed", INTEGER, FROM(0), DEFAULT(1), BOX, CASE(mesh.seed)},
    {.name = "mesh.weight", .type = RG_KEY_EXPR, OPTIONAL, .no_time = true, MAY_CHANGE, CASE(mesh.weight)},
    {.name = "mesh.rebalance", REAL, FROM(0), DEFAULT(0), MAY_CHANGE, CASE(mesh.rebalance)},

    {.name = "material.name", .type = RG_KEY_TEXT, OPTIONAL, CASE(material.name)},
#define KEY(word) "material." word
#define INPUT     offsetof(rg_case, material)
#include "case/material_keys.h"
    {.name = "materials", .type = RG_KEY_LIST, OPTIONAL, CASE(other), .entry = &rg_material_table,
     .offset_count = offsetof(rg_case, others)},

    {.name = "interface.form", CHOICE(forms), DEFAULT(RG_FORM_VARIATIONAL), CASE(interface.form)},
    {.name = "interface.faces", .type = RG_KEY_EXPR, OPTIONAL, .no_time = true, .normal = true, GROUP(FACES),
     CASE(interface.faces)},
    {.name = "interface.beta_s", REAL, ABOVE(0), DEFAULT(4), GROUP(INTERFACE), CASE(interface.beta_s)},
    {.name = "interface.penalty", CHOICE(penalties), DEFAULT(RG_PENALTY_ELASTIC), GROUP(DG),
     CASE(interface.penalty)},
    {.name = "interface.law", CHOICE(laws), REQUIRED, CASE(interface.law)},
    {.name = "interface.strength", .unit = "Pa", REAL, ABOVE(0), REQUIRED, GROUP(COHESIVE),
     CASE(interface.strength)},
    {.name = "interface.energy", .unit = "J/m2", REAL, ABOVE(0), REQUIRED, GROUP(ENERGY),
     CASE(interface.energy)},
    {.name = "interface.beta", REAL, FROM(0), DEFAULT(1), GROUP(SHEAR), CASE(interface.beta)},
    {.name = "interface.activation", CHOICE(activations), DEFAULT(RG_ACTIVATION_CONTINUOUS), GROUP(SWITCH),
     CASE(interface.activation)},
    {.name = "interface.onset", REAL, FROM_TO(0, 1), .low_open = true, DEFAULT(0.3), GROUP(ONSET),
     CASE(interface.onset)},
    {.name = "interface.contact", CHOICE(contacts), DEFAULT(RG_CONTACT_PENALTY), GROUP(COHESIVE),
     CASE(interface.contact)},
    {.name = "interface.friction", REAL, FROM(0), DEFAULT(0), GROUP(COHESIVE), CASE(interface.friction)},
#define RG_LAW_PARAMETER(NAME, index, word, unit_, low_, high_, fallback_)                                   \
    {.name = word, .unit = unit_, REAL, FROM_TO(low_, high_), DEFAULT(fallback_), GROUP(LAW),                \
     .law = RG_LAW_##NAME, CASE(interface.shape[RG_LAW_##NAME][index])},
#include "laws.h"
#undef RG_LAW_PARAMETER
    {.name = "interface.sets", .type = RG_KEY_LIST, OPTIONAL, GROUP(COHESIVE), CASE(interface.set), .entry = &rg_face_set_table,
     .offset_count = offsetof(rg_case, interface.sets)},
    {.name = "interface.weibull.modulus", REAL, ABOVE(0), OPTIONAL, GROUP(COHESIVE), CASE(interface.weibull.modulus)},
    {.name = "interface.weibull.area", .unit = "m2", REAL, ABOVE(0), REQUIRED, GROUP(WEIBULL),
     CASE(interface.weibull.area)},
    {.name = "interface.weibull.seed", INTEGER, FROM(0), DEFAULT(1), GROUP(WEIBULL), CASE(interface.weibull.seed)},
    {.name = "interface.weibull.keep", CHOICE(keeps), DEFAULT(RG_KEEP_ENERGY), GROUP(WEIBULL),
     CASE(interface.weibull.keep)},

    {.name = "viscosity.linear", REAL, FROM(0), DEFAULT(0), CASE(viscosity.linear)},
    {.name = "viscosity.quadratic", REAL, FROM(0), DEFAULT(0), CASE(viscosity.quadratic)},

    {.name = "mass", CHOICE(masses), DEFAULT(RG_DEFAULT_MASS), CASE(mass)},

    INITIAL("initial.displacement.x", "m", displacement[0]),
    INITIAL("initial.displacement.y", "m", displacement[1]),
    INITIAL("initial.displacement.z", "m", displacement[2]),
    INITIAL("initial.velocity.x", "m/s", velocity[0]),
    INITIAL("initial.velocity.y", "m/s", velocity[1]),
    INITIAL("initial.velocity.z", "m/s", velocity[2]),

    {.name = "boundary", .type = RG_KEY_LIST, OPTIONAL, CASE(boundary), .entry = &rg_boundary_table,
     .offset_count = offsetof(rg_case, boundaries)},

    {.name = "bodies", .type = RG_KEY_LIST, OPTIONAL, CASE(body), .entry = &rg_body_table,
     .offset_count = offsetof(rg_case, bodies)},

    {.name = "time.end", .unit = "s", REAL, ABOVE(0), REQUIRED, MAY_CHANGE, CASE(time.end)},
    {.name = "time.safety", REAL, FROM_TO(0, 1), .low_open = true, DEFAULT(RG_DEFAULT_SAFETY), MAY_CHANGE,
     CASE(time.safety)},
    {.name = "time.steps", INTEGER, FROM(1), OPTIONAL, MAY_CHANGE, CASE(time.steps)},
    {.name = "time.collapse", REAL, FROM_TO(0, 1), .high_open = true, DEFAULT(0.01), MAY_CHANGE, CASE(time.collapse)},

    {.name = "output.dir", .type = RG_KEY_TEXT, OPTIONAL, MAY_CHANGE, CASE(output.dir)},
    {.name = "output.interval", .type = RG_KEY_INTERVAL, OPTIONAL, MAY_CHANGE, CASE(output)},
    {.name = "output.times", .unit = "s", .type = RG_KEY_REALS, FROM(0), OPTIONAL, CASE(output.time),
     .offset_count = offsetof(rg_case, output.times)},
    {.name = "output.probes", .type = RG_KEY_LIST, OPTIONAL, CASE(output.probe), .entry = &rg_probe_table,
     .offset_count = offsetof(rg_case, output.probes)},
    {.name = "output.fields", .type = RG_KEY_FLAGS, .choice = fields, DEFAULT(0), MAY_CHANGE,
     CASE(output.fields)},
    {.name = "output.fragments", CHOICE(fragments), DEFAULT(RG_FRAGMENTS_EACH), CASE(output.fragments)},
    {.name = "output.region", .type = RG_KEY_EXPR, OPTIONAL, .no_time = true, CASE(output.region)},
    {.name = "output.precision", CHOICE(precisions), DEFAULT(RG_OUTPUT_DOUBLE), CASE(output.precision)},
    {.name = "output.compression", INTEGER, FROM_TO(0, 9), DEFAULT(0), MAY_CHANGE, CASE(output.compression)},
    {.name = "output.energy_limit", REAL, ABOVE(0), DEFAULT(0.05), MAY_CHANGE, CASE(output.energy_limit)},

    {.name = "checkpoint.steps", INTEGER, FROM(0), DEFAULT(0), MAY_CHANGE, CASE(checkpoint.steps)},
    {.name = "checkpoint.time", .unit = "s", REAL, FROM(0), DEFAULT(0), MAY_CHANGE, CASE(checkpoint.time)},
    {.name = "checkpoint.wall_time", .unit = "s", REAL, FROM(0), DEFAULT(0), MAY_CHANGE, CASE(checkpoint.wall_time)},
    {.name = "checkpoint.keep", INTEGER, FROM_TO(1, 1000), DEFAULT(2), MAY_CHANGE, CASE(checkpoint.keep)},
};

static const rg_key face_set_keys[] = {
    {.name = "where", .type = RG_KEY_EXPR, OPTIONAL, .no_time = true, .normal = true,
     .offset = offsetof(rg_face_set, where)},
    {.name = "between", .type = RG_KEY_TEXTS, OPTIONAL, .offset = offsetof(rg_face_set, between),
     .offset_count = offsetof(rg_face_set, names)},
    {.name = "strength", .unit = "Pa", REAL, ABOVE(0), OPTIONAL, .offset = offsetof(rg_face_set, strength)},
    {.name = "energy", .unit = "J/m2", REAL, ABOVE(0), OPTIONAL, .offset = offsetof(rg_face_set, energy)},
};

static const rg_key other_material_keys[] = {
    {.name = "name", .type = RG_KEY_TEXT, REQUIRED, .offset = offsetof(rg_other_material, is.name)},
    {.name = "set", .type = RG_KEY_TEXT, OPTIONAL, .offset = offsetof(rg_other_material, set)},
    {.name = "where", .type = RG_KEY_EXPR, OPTIONAL, .no_time = true, .offset = offsetof(rg_other_material, where)},
#define KEY(word) word
#define INPUT     offsetof(rg_other_material, is)
#include "case/material_keys.h"
};

static const rg_key boundary_keys[] = {
    {.name = "set", .type = RG_KEY_TEXT, .choice = box_sets, REQUIRED, .offset = offsetof(rg_boundary, set)},
    {.name = "component", CHOICE(components), REQUIRED, .offset = offsetof(rg_boundary, component)},
    {.name = "velocity", .unit = "m/s", .type = RG_KEY_EXPR, OPTIONAL, .group = RG_GROUP_VELOCITY,
     .offset = offsetof(rg_boundary, value)},
    {.name = "displacement", .unit = "m", .type = RG_KEY_EXPR, OPTIONAL, .group = RG_GROUP_DISPLACEMENT,
     .offset = offsetof(rg_boundary, value)},
};

#define BODY(member) .offset = offsetof(rg_body_input, member)
#define BODY_VELOCITY(name_, component)                                                                      \
    { .name = (name_), .unit = "m/s", .type = RG_KEY_EXPR, OPTIONAL, .no_place = true, BODY(velocity[component]) }

static const rg_key body_keys[] = {
    {.name = "name", .type = RG_KEY_TEXT, REQUIRED, BODY(name)},
    {.name = "shape", CHOICE(shapes), REQUIRED, BODY(shape)},
    {.name = "motion", CHOICE(motions), REQUIRED, BODY(motion)},
    {.name = "at", .unit = "m", REAL3, ANY, REQUIRED, BODY(at)},
    {.name = "radius", .unit = "m", REAL, ABOVE(0), OPTIONAL, BODY(radius)},
    {.name = "normal", REAL3, ANY, OPTIONAL, BODY(normal)},
    {.name = "axis", REAL3, ANY, OPTIONAL, BODY(axis)},
    {.name = "density", .unit = "kg/m3", REAL, ABOVE(0), OPTIONAL, BODY(density)},
    {.name = "mass", .unit = "kg", REAL, ABOVE(0), OPTIONAL, BODY(mass)},
    BODY_VELOCITY("velocity.x", 0),
    BODY_VELOCITY("velocity.y", 1),
    BODY_VELOCITY("velocity.z", 2),
    {.name = "faces", .type = RG_KEY_TEXTS, .choice = box_sets, OPTIONAL, BODY(set),
     .offset_count = offsetof(rg_body_input, sets)},
    {.name = "penalty", REAL, ABOVE(0), DEFAULT(4), BODY(penalty)},
};

static const rg_key probe_keys[] = {
    {.name = "name", .type = RG_KEY_TEXT, REQUIRED, .offset = offsetof(rg_probe, name)},
    {.name = "at", .unit = "m", REAL3, ANY, REQUIRED, .offset = offsetof(rg_probe, at)},
};
/* clang-format on */

#define TABLE(list, type)                                                                                    \
    { .key = (list), .keys = sizeof(list) / sizeof(list)[0], .size = sizeof(type) }

const rg_key_table rg_case_table = TABLE(case_keys, rg_case);
const rg_key_table rg_material_table = TABLE(other_material_keys, rg_other_material);
const rg_key_table rg_face_set_table = TABLE(face_set_keys, rg_face_set);
const rg_key_table rg_boundary_table = TABLE(boundary_keys, rg_boundary);
const rg_key_table rg_body_table = TABLE(body_keys, rg_body_input);
const rg_key_table rg_probe_table = TABLE(probe_keys, rg_probe);

_Static_assert(sizeof(case_keys) / sizeof(case_keys[0]) <= RG_MAX_KEYS, "RG_MAX_KEYS is too small");
_Static_assert(sizeof(rg_form) == sizeof(int), "choices are stored as int");

/* ---- words ---- */

/* Each appends to `text`. */

/* "number > 0 and < 0.5", "integer >= 1" */
static void range_words(const rg_key *key, char *text, size_t size) {
    const char *list = key->type == RG_KEY_REALS ? "ascending list, each " : "[x, y, z], each ";
    rg_text_add(text, size, "%s%s", key->count == 1 ? "" : list,
                key->type == RG_KEY_INTEGER ? "integer" : "number");
    if (isfinite(key->low)) {
        rg_text_add(text, size, " %s %g", key->low_open ? ">" : ">=", key->low);
    }
    if (isfinite(key->high)) { /* then the other is, too */
        rg_text_add(text, size, " and %s %.10g", key->high_open ? "<" : "<=", key->high);
    }
}

/* "none, linear" */
static void choice_words(const rg_key *key, char *text, size_t size) {
    const char *join = key->type == RG_KEY_FLAGS || key->type == RG_KEY_TEXTS ? "list from " : "";
    for (int i = 0; key->choice[i] != NULL; i++) {
        rg_text_add(text, size, "%s%s", join, key->choice[i]);
        join = ", ";
    }
}

static void list_words(const rg_key_table *entry, char *text, size_t size) {
    const char *join = "list of {";
    for (int i = 0; i < entry->keys && !entry->key[i].of_material; i++) {
        join = entry->key[i].group == RG_GROUP_DISPLACEMENT ? " or " : join;
        rg_text_add(text, size, "%s%s", join, entry->key[i].name);
        join = ", ";
    }
    rg_text_add(text, size, "%s}", entry == &rg_material_table ? ", and the keys of material" : "");
}

static void expr_words(const rg_key *key, char *text, size_t size) {
    rg_text_add(text, size, "number or expression in %s%s%s", key->no_place ? "" : "x, y, z",
                key->no_time    ? ""
                : key->no_place ? "t"
                                : ", t",
                key->normal ? ", nx, ny, nz" : "");
}

static void type_words(const rg_key *key, char *text, size_t size) {
    switch (key->type) {
    case RG_KEY_REAL:
    case RG_KEY_REALS:
    case RG_KEY_INTEGER:
        range_words(key, text, size);
        break;
    case RG_KEY_CHOICE:
    case RG_KEY_FLAGS:
        choice_words(key, text, size);
        break;
    case RG_KEY_TEXT:
    case RG_KEY_TEXTS:
        if (key->choice != NULL) {
            choice_words(key, text, size);
        } else {
            rg_text_add(text, size, "%s", key->type == RG_KEY_TEXT ? "text" : "list of texts");
        }
        break;
    case RG_KEY_EXPR:
        expr_words(key, text, size);
        break;
    case RG_KEY_INTERVAL:
        rg_text_add(text, size, "integer >= 1 (steps), or number > 0 and < 1 (simulated seconds)");
        break;
    case RG_KEY_LIST:
        list_words(key->entry, text, size);
        break;
    }
}

const char *rg_key_allowed(const rg_key *key, char *text, size_t size) {
    text[0] = '\0';
    type_words(key, text, size);
    if (key->unit != NULL) {
        rg_text_add(text, size, " (%s)", key->unit);
    }
    return text;
}

void rg_models_words(const rg_key *key, char *text, size_t size) {
    const char *join = "";
    text[0] = '\0';
    for (int m = 0; m < RG_MATERIAL_MODELS; m++) {
        if ((key->models >> m & 1U) != 0) {
            rg_text_add(text, size, "%s%s", join, models[m]);
            join = ", ";
        }
    }
}

/* ---- look-up ---- */

bool rg_group_used(rg_key_group group, const rg_case *c) {
    rg_law law = c->interface.law;
    rg_form form = c->interface.form;
    bool breaks = law != RG_LAW_NONE, faces = form != RG_FORM_CONTINUOUS || c->interface.faces != NULL;
    bool dg = faces && form != RG_FORM_INTRINSIC;
    rg_law_facts facts = breaks ? rg_law_facts_of(law, c->interface.shape[law], 1) : (rg_law_facts){0};
    switch (group) {
    case RG_GROUP_ENERGY:
        return facts.work > 0;
    case RG_GROUP_SHEAR:
        return breaks && (facts.forms & RG_NORMAL_MEASURE) == 0;
    case RG_GROUP_FACES:
        return form == RG_FORM_CONTINUOUS;
    case RG_GROUP_INTERFACE:
        return faces;
    case RG_GROUP_DG:
        return dg;
    case RG_GROUP_SWITCH:
        return breaks && dg;
    case RG_GROUP_ONSET:
        return breaks && dg && c->interface.activation == RG_ACTIVATION_CONSERVING;
    default:
        return breaks;
    }
}

/* The material in the structure `base` whose block has the key. */
static const rg_material_input *material_of(const rg_key *key, const void *base) {
    return (const rg_material_input *)(const void *)((const char *)base + key->input);
}

bool rg_key_used(const rg_key *key, const void *base) {
    if (key->models != 0 && (key->models >> material_of(key, base)->model & 1U) == 0) {
        return false;
    }
    switch (key->group) {
    case RG_GROUP_BOX:
        return ((const rg_case *)base)->mesh.file == NULL;
    case RG_GROUP_COHESIVE:
    case RG_GROUP_ENERGY:
    case RG_GROUP_SHEAR:
    case RG_GROUP_FACES:
    case RG_GROUP_INTERFACE:
    case RG_GROUP_DG:
    case RG_GROUP_SWITCH:
    case RG_GROUP_ONSET:
        return rg_group_used(key->group, base);
    case RG_GROUP_WEIBULL:
        return ((const rg_case *)base)->interface.weibull.modulus > 0;
    case RG_GROUP_LAW:
        return ((const rg_case *)base)->interface.law == key->law;
    case RG_GROUP_VELOCITY:
        return !((const rg_boundary *)base)->is_displacement;
    case RG_GROUP_DISPLACEMENT:
        return ((const rg_boundary *)base)->is_displacement;
    case RG_GROUP_ALWAYS:
    case RG_GROUPS:
        break;
    }
    return true;
}

const rg_key *rg_key_find(const rg_key_table *table, const char *name) {
    for (int i = 0; i < table->keys; i++) {
        if (strcmp(table->key[i].name, name) == 0) {
            return &table->key[i];
        }
    }
    return NULL;
}

bool rg_key_is_section(const rg_key_table *table, const char *name) {
    size_t length = strlen(name);
    for (int i = 0; i < table->keys; i++) {
        if (strncmp(table->key[i].name, name, length) == 0 && table->key[i].name[length] == '.') {
            return true;
        }
    }
    return false;
}

/* ---- suggestions ---- */

static size_t last_part(const char *name, size_t length) {
    while (length > 0 && name[length - 1] != '.') {
        length--;
    }
    return length;
}

enum { FAR = 1000 };

/* How far `name` is from the known path known[0..m). The last part counts most: a key at the wrong place is
 * near, and so is one that begins like a known one (poisson_ratio). */
static size_t key_distance(const char *name, const char *known, size_t m) {
    size_t n = strlen(name), i = last_part(name, n), j = last_part(known, m);
    size_t shorter = n - i < m - j ? n - i : m - j;
    bool begins = shorter >= 3 && strncasecmp(name + i, known + j, shorter) == 0;
    size_t whole = rg_edit_distance(name, n, known, m);
    size_t last = begins && n - i != m - j ? 1 : rg_edit_distance(name + i, n - i, known + j, m - j);
    if (last >= n - i && last >= m - j) {
        return FAR; /* nothing in common */
    }
    bool same_section = i == j && strncasecmp(name, known, i) == 0;
    last += same_section ? 0 : 1;
    return last < whole ? last : whole;
}

const char *rg_key_nearest(const rg_key_table *table, const char *name, char *text, size_t size) {
    size_t length = strlen(name);
    size_t best = (length - last_part(name, length)) / 3 + 2; /* beyond this nothing is near */
    const char *found = NULL;
    for (int i = 0; i < table->keys && length <= RG_LONGEST_WORD; i++) {
        const char *known = table->key[i].name;
        for (size_t end = 1; end <= strlen(known); end++) {
            bool whole = known[end] == '.' || known[end] == '\0';
            size_t distance = whole ? key_distance(name, known, end) : best;
            if (distance < best) {
                best = distance;
                snprintf(text, size, "%.*s", (int)end, known);
                found = text;
            }
        }
    }
    return found;
}

/* ---- freeing ---- */

static void free_texts(const rg_key *key, char *base) {
    char **list = rg_pointer_get(base + key->offset);
    int count = 0;
    memcpy(&count, base + key->offset_count, sizeof count);
    for (int i = 0; i < count; i++) {
        rg_free(list[i]);
    }
    rg_free(list);
}

static void free_list(const rg_key *key, char *base) {
    void *list = rg_pointer_get(base + key->offset);
    int count = 0;
    memcpy(&count, base + key->offset_count, sizeof count);
    for (int i = 0; i < count; i++) {
        rg_keys_free(key->entry, (char *)list + (size_t)i * key->entry->size);
    }
    rg_free(list);
}

void rg_keys_free(const rg_key_table *table, void *base) {
    for (int i = 0; i < table->keys; i++) {
        const rg_key *key = &table->key[i];
        void *value = (char *)base + key->offset;
        if (key->type == RG_KEY_TEXT || key->type == RG_KEY_REALS) {
            rg_free(rg_pointer_get(value));
        } else if (key->type == RG_KEY_EXPR) { /* may be shared by two keys of a group */
            rg_expr_free(rg_pointer_get(value));
            rg_pointer_set(value, NULL);
        } else if (key->type == RG_KEY_LIST) {
            free_list(key, base);
        } else if (key->type == RG_KEY_TEXTS) {
            free_texts(key, base);
        }
    }
}
