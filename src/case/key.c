#include "case/key.h"

#include <math.h>
#include <stdint.h>
#include <string.h>
#include <strings.h>

#include "base/mem.h"
#include "case/expr.h"
#include "case/tree.h"
#include "cohesive/facts.h"

/* ---- words ---- */

/* Each appends to `text`. */

/* "number > 0 and < 0.5", "integer >= 1" */
static void range_words(const rg_key *key, char *text, size_t size) {
    if (key->type == RG_KEY_REALS) {
        rg_text_add(text, size, "ascending list, each ");
    } else if (key->count > 1) {
        rg_text_add(text, size, "[%s], each ", key->entries != NULL ? key->entries : "x, y, z");
    }
    rg_text_add(text, size, "%s", key->type == RG_KEY_INTEGER ? "integer" : "number");
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

/* A section stands for its keys. */
static void list_words(const rg_key_table *entry, char *text, size_t size) {
    const char *join = "list of {", *last = "";
    for (int i = 0; i < entry->keys && !entry->key[i].of_material; i++) {
        const char *name = entry->key[i].name;
        int length = (int)strcspn(name, ".");
        bool another = i > 0 && entry->key[i - 1].group == RG_GROUP_PRESCRIBED;
        if (name[length] == '\0' || strncmp(name, last, (size_t)length + 1) != 0) {
            join = another ? " or " : join;
            rg_text_add(text, size, "%s%.*s", join, length, name);
            join = ", ";
        }
        last = name;
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
    case RG_KEY_FACE:
        range_words(key, text, size);
        rg_text_add(text, size, ", or expression in x, y, z, nx, ny, nz");
        break;
    case RG_KEY_BOOL:
        rg_text_add(text, size, "true or false");
        break;
    case RG_KEY_INTERVAL:
        rg_text_add(text, size, "integer >= 1 (steps), or number > 0 and < 1 (simulated seconds)");
        break;
    case RG_KEY_LIBRARY:
        rg_text_add(text, size, "path of a library that rhegma material compiled");
        break;
    case RG_KEY_PARAMETERS:
        rg_text_add(text, size, "mapping of names to numbers");
        break;
    case RG_KEY_TABLES:
        rg_text_add(text, size,
                    "mapping of names to: list of [argument, value], ascending; path of a CSV file; "
                    "or {points or file, smooth: true or false}");
        break;
    case RG_KEY_LIST:
        list_words(key->entry, text, size);
        break;
    }
}

const char *rg_key_allowed(const rg_key *key, char *text, size_t size) {
    text[0] = '\0';
    type_words(key, text, size);
    if (key->as != NULL) {
        char models[256];
        rg_models_words(&(rg_key){.models = key->as_models}, models, sizeof models);
        rg_text_add(text, size, "; of %s ", models);
        type_words(key->as, text, size);
    }
    if (key->unit != NULL) {
        rg_text_add(text, size, " (%s)", key->unit);
    }
    return text;
}

void rg_models_words(const rg_key *key, char *text, size_t size) {
    const char *join = "";
    unsigned all = (1U << RG_MATERIAL_MODELS) - 1, others = all & ~key->models;
    unsigned rest = others & (others - 1); /* without the first one */
    bool few = others != 0 && (rest & (rest - 1)) == 0 && key->models != 0;
    text[0] = '\0';
    if (few) { /* one or two are not among them */
        join = "all but ";
        others |= ~key->models & RG_MATERIAL_BIT_USER;
    }
    for (int m = 0; m <= RG_MATERIAL_USER; m++) {
        if (((few ? others : key->models) >> m & 1U) != 0) {
            rg_text_add(text, size, "%s%s", join, rg_material_word((rg_material_model)m));
            join = ", ";
        }
    }
}

const char *rg_law_word(rg_law law) {
    return law == RG_LAW_NONE ? "none" : rg_law_facts_of(law, (double[RG_LAW_SHAPE]){0}, 1).word;
}

bool rg_key_has_default(const rg_key *key) {
    return key->need != RG_NEED_REQUIRED && key->alternative == RG_NO_ALTERNATIVE &&
           !(key->group == RG_GROUP_COMPONENT && key->type == RG_KEY_CHOICE);
}

const char *rg_key_default(const rg_key *key, char *text, size_t size) {
    const char *words = key->absent;
    text[0] = '\0';
    if (key->alternative != RG_NO_ALTERNATIVE) {
        rg_text_add(text, size, "this or ");
    }
    if (key->need == RG_NEED_REQUIRED) {
        words = "required";
    } else if (words == NULL && key->type == RG_KEY_CHOICE) {
        words = key->choice[(int)key->fallback];
    }
    if (words != NULL) {
        rg_text_add(text, size, "%s", words);
    } else {
        rg_text_add(text, size, key->count == 3 ? "[%g, %g, %g]" : "%.10g", key->fallback, key->fallback,
                    key->fallback);
    }
    return text;
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

rg_key rg_key_here(const rg_key *key, const void *base) {
    rg_key here = *key;
    if (key->as != NULL && (key->as_models >> material_of(key, base)->model & 1U) != 0) {
        here = *key->as;
        here.name = key->name;
        here.unit = key->unit;
        here.meaning = key->meaning;
        here.of_material = true;
        here.models = key->models;
        here.input = key->input;
        here.offset += key->input;
    }
    here.as = NULL;
    return here;
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
    case RG_GROUP_RISE:
        return ((const rg_case *)base)->interface.rise.rate > 0;
    case RG_GROUP_HEAT:
        return ((const rg_case *)base)->temperature.value != NULL;
    case RG_GROUP_RELAX:
        return ((const rg_case *)base)->start == RG_START_RELAX;
    case RG_GROUP_STRESS_RUN:
        return ((const rg_case *)base)->stress_of.run != NULL;
    case RG_GROUP_CONTACT:
        return ((const rg_case *)base)->contact.model == RG_CONTACT_GENERAL;
    case RG_GROUP_LAW:
        return ((const rg_case *)base)->interface.law == key->law;
    case RG_GROUP_LINE:
        return rg_boundary_is_along_line(base);
    case RG_GROUP_COMPONENT:
        return rg_boundary_has_component(base);
    case RG_GROUP_RIGID:
        return !rg_boundary_damps(base) && ((const rg_boundary *)base)->prescribed == RG_PRESCRIBED_ANGLE;
    case RG_GROUP_MOTION:
        return !rg_boundary_damps(base);
    case RG_GROUP_PRESCRIBED:
        return ((const rg_boundary *)base)->prescribed == key->prescribed;
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

const char *rg_key_part(const rg_key *key, const char *section, size_t *size) {
    size_t before = strlen(section);
    if (strncmp(key->name, section, before) != 0) {
        return NULL;
    }
    *size = strcspn(key->name + before, ".");
    return key->name + before;
}

const char *rg_keys_in(const rg_key_table *table, const char *section, char *text, size_t size) {
    const char *last = "", *join = "";
    size_t length = 0, before = 0;
    text[0] = '\0';
    for (int i = 0; i < table->keys; i++) {
        const char *part = rg_key_part(&table->key[i], section, &length);
        if (part != NULL && (length != before || strncmp(last, part, length) != 0)) {
            rg_text_add(text, size, "%s%.*s", join, (int)length, part);
            join = ", ";
            last = part;
            before = length;
        }
    }
    return text;
}

/* ---- suggestions ---- */

static size_t last_part(const char *name, size_t length) {
    while (length > 0 && name[length - 1] != '.') {
        length--;
    }
    return length;
}

enum { FAR = 1000 };

static int count_dots(const char *name, size_t length) {
    int dots = 0;
    for (size_t i = 0; i < length; i++) {
        dots += name[i] == '.' ? 1 : 0;
    }
    return dots;
}

/* Whether the known path known[0..m), which lies in another section than `name`, may have been meant: a key
 * that is at the wrong place, but of that very name; or one without its section, unless that is itself in
 * one. */
static bool may_be_elsewhere(const char *name, const char *known, size_t m) {
    size_t n = strlen(name), i = last_part(name, n), j = last_part(known, m);
    bool same = n - i == m - j && strncasecmp(name + i, known + j, n - i) == 0;
    bool below = strncasecmp(name, known, i) == 0;
    int dots = count_dots(known, m);
    return i == 0 ? dots <= 1 : same && (below || dots <= count_dots(name, n));
}

/* How far `name` is from the known path known[0..m). The last part counts most: a key at the wrong place is
 * near, and so is one that begins like a known one (poisson_ratio). */
static size_t key_distance(const char *name, const char *known, size_t m) {
    size_t n = strlen(name), i = last_part(name, n), j = last_part(known, m);
    size_t shorter = n - i < m - j ? n - i : m - j;
    bool begins = shorter >= 3 && strncasecmp(name + i, known + j, shorter) == 0;
    size_t whole = rg_edit_distance(name, n, known, m);
    size_t last = begins && n - i != m - j ? 1 : rg_edit_distance(name + i, n - i, known + j, m - j);
    bool same_section = i == j && strncasecmp(name, known, i) == 0;
    if ((last >= n - i && last >= m - j) || (!same_section && !may_be_elsewhere(name, known, m))) {
        return FAR; /* nothing in common */
    }
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
        if (key->type == RG_KEY_TEXT || key->type == RG_KEY_REALS || key->type == RG_KEY_LIBRARY) {
            rg_free(rg_pointer_get(value));
        } else if (key->type == RG_KEY_EXPR) { /* may be shared by two keys of a group */
            rg_expr_free(rg_pointer_get(value));
            rg_pointer_set(value, NULL);
        } else if (key->type == RG_KEY_FACE) {
            rg_expr_free(rg_pointer_get((char *)base + key->offset_expr));
        } else if (key->type == RG_KEY_LIST) {
            free_list(key, base);
        } else if (key->type == RG_KEY_TEXTS) {
            free_texts(key, base);
        } else if (key->type == RG_KEY_TABLES) {
            rg_curves_free(value);
        }
    }
}
