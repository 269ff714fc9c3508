/* The registry of keys as a JSON Schema. */
#include <math.h>

#include "base/mem.h"
#include "case/reference.h"
#include "case/tree.h"

/* ---- JSON ---- */

typedef struct {
    FILE *out;
    int depth;
    bool first; /* nothing stands yet in the object or list that is open */
} writer;

/* Begins a member of an object, or an item of a list (`name` NULL). */
static void begin(writer *w, const char *name) {
    fprintf(w->out, "%s%s%*s", w->first ? "" : ",", w->depth > 0 ? "\n" : "", 2 * w->depth, "");
    w->first = false;
    if (name != NULL) {
        fprintf(w->out, "\"%s\": ", name);
    }
}

static void open_group(writer *w, const char *name, char bracket) {
    begin(w, name);
    fputc(bracket, w->out);
    w->depth++;
    w->first = true;
}

static void close_group(writer *w, char bracket) {
    w->depth--;
    if (!w->first) {
        fprintf(w->out, "\n%*s", 2 * w->depth, "");
    }
    fputc(bracket, w->out);
    w->first = false;
}

/* No text of the registry has a character that would have to be escaped (a test holds that). */
static void put_text(writer *w, const char *name, const char *text) {
    begin(w, name);
    fprintf(w->out, "\"%s\"", text);
}

static void put_number(writer *w, const char *name, double value) {
    begin(w, name);
    fprintf(w->out, "%.17g", value);
}

static void put_false(writer *w, const char *name) {
    begin(w, name);
    fputs("false", w->out);
}

static void put_words(writer *w, const char *name, const char *const words[], int count) {
    open_group(w, name, '[');
    for (int i = 0; i < count; i++) {
        put_text(w, NULL, words[i]);
    }
    close_group(w, ']');
}

/* ---- single values ---- */

static int length(const char *const words[]) {
    int count = 0;
    while (words[count] != NULL) {
        count++;
    }
    return count;
}

/* Which only numbers have to keep. */
static void put_bounds(writer *w, const rg_key *range) {
    if (isfinite(range->low)) {
        put_number(w, range->low_open ? "exclusiveMinimum" : "minimum", range->low);
    }
    if (isfinite(range->high)) {
        put_number(w, range->high_open ? "exclusiveMaximum" : "maximum", range->high);
    }
}

static void put_range(writer *w, const char *type, const rg_key *range) {
    put_text(w, "type", type);
    put_bounds(w, range);
}

static void put_enum(writer *w, const rg_key *key) {
    int count = length(key->choice);
    put_words(w, "enum", key->choice, count);
    if (key->choice_meaning != NULL) { /* shown by editors, no matter to validators */
        put_words(w, "enumDescriptions", key->choice_meaning, count);
    }
}

/* Any text; a set may be one of the mesh file too, so the sides of the box are but offered. */
static void put_any_text(writer *w, const rg_key *key) {
    if (key->choice == NULL) {
        put_text(w, "type", "string");
        return;
    }
    open_group(w, "anyOf", '[');
    open_group(w, NULL, '{');
    put_enum(w, key);
    close_group(w, '}');
    open_group(w, NULL, '{');
    put_text(w, "type", "string");
    close_group(w, '}');
    close_group(w, ']');
}

static void put_interval(writer *w) {
    const rg_key steps = {.low = 1, .high = INFINITY};
    const rg_key seconds = {.low = 0, .low_open = true, .high = 1, .high_open = true};
    open_group(w, "anyOf", '[');
    open_group(w, NULL, '{');
    put_range(w, "integer", &steps);
    close_group(w, '}');
    open_group(w, NULL, '{');
    put_range(w, "number", &seconds);
    close_group(w, '}');
    close_group(w, ']');
}

/* [argument, value], two or more. */
static void put_points(writer *w, const char *name) {
    open_group(w, name, '{');
    put_text(w, "type", "array");
    put_number(w, "minItems", 2);
    open_group(w, "items", '{');
    put_text(w, "type", "array");
    put_number(w, "minItems", 2);
    put_number(w, "maxItems", 2);
    open_group(w, "items", '{');
    put_text(w, "type", "number");
    close_group(w, '}');
    close_group(w, '}');
    close_group(w, '}');
}

/* Of any name: points, a path, or one of them with `smooth`. */
static void put_tables(writer *w) {
    put_text(w, "type", "object");
    open_group(w, "additionalProperties", '{');
    open_group(w, "anyOf", '[');
    put_points(w, NULL);
    open_group(w, NULL, '{');
    put_text(w, "type", "string");
    close_group(w, '}');
    open_group(w, NULL, '{');
    put_text(w, "type", "object");
    open_group(w, "properties", '{');
    put_points(w, "points");
    open_group(w, "file", '{');
    put_text(w, "type", "string");
    close_group(w, '}');
    open_group(w, "smooth", '{');
    put_text(w, "type", "boolean");
    close_group(w, '}');
    close_group(w, '}');
    put_false(w, "additionalProperties");
    close_group(w, '}');
    close_group(w, ']');
    close_group(w, '}');
}

static void put_table(writer *w, const rg_key_table *table, const char *section);

/* Of one entry where the key takes a list. */
static void put_single(writer *w, const rg_key *key) {
    switch (key->type) {
    case RG_KEY_REAL:
    case RG_KEY_REALS:
        put_range(w, "number", key);
        break;
    case RG_KEY_INTEGER:
        put_range(w, "integer", key);
        break;
    case RG_KEY_CHOICE:
    case RG_KEY_FLAGS:
        put_enum(w, key);
        break;
    case RG_KEY_PARAMETERS:
        put_text(w, "type", "object");
        open_group(w, "additionalProperties", '{');
        put_text(w, "type", "number");
        close_group(w, '}');
        break;
    case RG_KEY_LIBRARY:
    case RG_KEY_TEXT:
    case RG_KEY_TEXTS:
        put_any_text(w, key);
        break;
    case RG_KEY_EXPR:
        put_words(w, "type", (const char *const[]){"number", "string"}, 2);
        break;
    case RG_KEY_FACE:
        put_words(w, "type", (const char *const[]){"number", "string"}, 2);
        put_bounds(w, key);
        break;
    case RG_KEY_BOOL:
        put_text(w, "type", "boolean");
        break;
    case RG_KEY_INTERVAL:
        put_interval(w);
        break;
    case RG_KEY_TABLES:
        put_tables(w);
        break;
    case RG_KEY_LIST:
        put_table(w, key->entry, "");
        break;
    }
}

/* How many entries a list has: so many numbers, some, or any number of them. */
static void put_length(writer *w, const rg_key *key) {
    if (key->count > 1) {
        put_number(w, "minItems", key->count);
        put_number(w, "maxItems", key->count);
    } else if (key->type == RG_KEY_TEXTS || key->type == RG_KEY_REALS) {
        put_number(w, "minItems", 1);
    } else if (key->type == RG_KEY_FLAGS) {
        begin(w, "uniqueItems");
        fputs("true", w->out);
    }
}

static void describe(writer *w, const rg_key *key) {
    char absent[256], *text;
    rg_key_default(key, absent, sizeof absent);
    text = rg_text_format("%s%s%s%s; %s%s", key->meaning, key->unit != NULL ? " (" : "",
                          key->unit != NULL ? key->unit : "", key->unit != NULL ? ")" : "",
                          rg_key_has_default(key) ? "default: " : "", absent);
    put_text(w, "description", text);
    rg_free(text);
}

static void put_value(writer *w, const rg_key *key) {
    bool list = key->count > 1 || key->type == RG_KEY_FLAGS || key->type == RG_KEY_TEXTS ||
                key->type == RG_KEY_REALS || key->type == RG_KEY_LIST;
    if (list) {
        put_text(w, "type", "array");
        put_length(w, key);
        open_group(w, "items", '{');
        put_single(w, key);
        close_group(w, '}');
    } else {
        put_single(w, key);
    }
}

static void put_key(writer *w, const char *name, const rg_key *key) {
    open_group(w, name, '{');
    describe(w, key);
    if (key->as != NULL) { /* some models take the one, some the other */
        const rg_key *const either[2] = {key, key->as};
        open_group(w, "anyOf", '[');
        for (int i = 0; i < 2; i++) {
            open_group(w, NULL, '{');
            put_value(w, either[i]);
            close_group(w, '}');
        }
        close_group(w, ']');
    } else {
        put_value(w, key);
    }
    close_group(w, '}');
}

/* ---- conditions ---- */

/* What a condition makes of a key: it has no say, or the key is used or not. */
typedef enum { NO_SAY, IS_USED, IS_UNUSED } effect;
typedef effect effect_of(const void *condition, const rg_key *key);

/* Keys of a section that are required, and those that must not be there, under a condition. */
static void put_consequence(writer *w, const char *name, const rg_key_table *table, const char *section,
                            effect_of *of, const void *condition) {
    size_t size = 0;
    const char *last = "";
    open_group(w, name, '{');
    open_group(w, "required", '[');
    for (int i = 0; i < table->keys; i++) {
        const rg_key *key = &table->key[i];
        const char *part = rg_key_part(key, section, &size);
        if (part != NULL && key->need == RG_NEED_REQUIRED && of(condition, key) == IS_USED) {
            put_text(w, NULL, part); /* of no section inside: their keys have defaults */
        }
    }
    close_group(w, ']');
    open_group(w, "properties", '{');
    for (int i = 0; i < table->keys; i++) {
        const char *part = rg_key_part(&table->key[i], section, &size);
        bool again = part != NULL && strcspn(last, ".") == size && strncmp(last, part, size) == 0;
        if (part != NULL && !again && of(condition, &table->key[i]) == IS_UNUSED) {
            char *child = rg_text_copy(part, size);
            put_false(w, child);
            rg_free(child);
            last = part;
        }
    }
    close_group(w, '}');
    close_group(w, '}');
}

/* "if" a key of the section is given, or is one of its choices (`word` NULL: is given at all). */
static void put_if(writer *w, const char *name, const char *word, bool also_absent) {
    open_group(w, "if", '{');
    if (word != NULL) {
        open_group(w, "properties", '{');
        open_group(w, name, '{');
        put_text(w, "const", word);
        close_group(w, '}');
        close_group(w, '}');
    }
    if (!also_absent) {
        put_words(w, "required", &name, 1);
    }
    close_group(w, '}');
}

/* What a model takes by `as` is not required. */
static effect of_model(const void *model, const rg_key *key) {
    unsigned bit = 1U << *(const int *)model;
    return key->models == 0 || (key->as_models & bit) != 0 ? NO_SAY
           : (key->models & bit) != 0                      ? IS_USED
                                                           : IS_UNUSED;
}

/* Keys that a solid must have, but for those that a preset gives. */
static const char *const without_preset[] = {"model", "density"};
enum { WITHOUT_PRESET = sizeof without_preset / sizeof *without_preset };

static bool is_material(const rg_key_table *table, const char *section) {
    return table == &rg_material_table || strcmp(section, "material.") == 0;
}

static bool may_be_of_preset(const rg_key_table *table, const char *section, const char *child) {
    bool found = false;
    for (int i = 0; i < WITHOUT_PRESET; i++) {
        found = found || strcmp(without_preset[i], child) == 0;
    }
    return found && is_material(table, section);
}

static void put_models(writer *w, const rg_key_table *table, const char *section) {
    for (int model = 0; model <= RG_MATERIAL_USER; model++) {
        open_group(w, NULL, '{');
        put_if(w, "model", rg_material_word((rg_material_model)model), false);
        put_consequence(w, "then", table, section, of_model, &model);
        close_group(w, '}');
    }
}

/* What a solid must have and must not have, where no preset gives the rest. */
static void put_solid(writer *w, const rg_key_table *table, const char *section) {
    open_group(w, NULL, '{');
    put_if(w, "preset", NULL, false);
    open_group(w, "else", '{');
    put_words(w, "required", without_preset, WITHOUT_PRESET);
    open_group(w, "allOf", '[');
    put_models(w, table, section);
    close_group(w, ']');
    close_group(w, '}');
    close_group(w, '}');
}

/* A case of which one choice is made, and the groups of keys on which that decides. */
typedef struct {
    rg_case c;
    unsigned groups;
} choice;

static effect of_choice(const void *condition, const rg_key *key) {
    const choice *made = condition;
    return (made->groups >> key->group & 1U) == 0 ? NO_SAY : rg_key_used(key, &made->c) ? IS_USED : IS_UNUSED;
}

enum { OF_SWITCH = 1U << RG_GROUP_SWITCH | 1U << RG_GROUP_ONSET };

static void put_choices(writer *w, const char *name, unsigned groups) {
    const rg_key *key = rg_key_find(&rg_case_table, name);
    char *message = NULL;
    rg_expr *faces = rg_expr_new("1", &message);
    for (int i = 0; key->choice[i] != NULL; i++) {
        choice made = {.groups = groups};
        made.c.interface.faces = faces;
        made.c.interface.activation = RG_ACTIVATION_CONSERVING;
        memcpy((char *)&made.c + key->offset, &i, sizeof i);
        open_group(w, NULL, '{');
        put_if(w, strchr(name, '.') + 1, key->choice[i],
               key->need == RG_NEED_DEFAULT && key->fallback_of == NULL && i == (int)key->fallback);
        put_consequence(w, "then", &rg_case_table, "interface.", of_choice, &made);
        close_group(w, '}');
    }
    rg_expr_free(faces);
}

/* A group of keys, and whether they are used. */
typedef struct {
    rg_key_group group;
    bool used;
} fate;

static effect of_fate(const void *condition, const rg_key *key) {
    const fate *all = condition;
    return key->group != all->group ? NO_SAY : all->used ? IS_USED : IS_UNUSED;
}

/* The keys of a group are used `where` another key of the section is given, or just where it is not. */
static void put_presence(writer *w, const char *section, const char *name, rg_key_group group, bool where) {
    put_if(w, name, NULL, false);
    put_consequence(w, "then", &rg_case_table, section, of_fate, &(fate){group, where});
    put_consequence(w, "else", &rg_case_table, section, of_fate, &(fate){group, !where});
}

/* What follows in a section from the keys that are given in it. */
static void put_conditions(writer *w, const rg_key_table *table, const char *section) {
    bool material = is_material(table, section);
    bool interface = strcmp(section, "interface.") == 0;
    if (material || interface) {
        open_group(w, "allOf", '[');
    }
    if (material) {
        put_solid(w, table, section);
    } else if (interface) {
        put_choices(w, "interface.law",
                    1U << RG_GROUP_COHESIVE | 1U << RG_GROUP_ENERGY | 1U << RG_GROUP_SHEAR |
                        1U << RG_GROUP_LAW | OF_SWITCH);
        put_choices(w, "interface.form",
                    1U << RG_GROUP_FACES | 1U << RG_GROUP_INTERFACE | 1U << RG_GROUP_DG | OF_SWITCH);
        put_choices(w, "interface.activation", 1U << RG_GROUP_ONSET);
    } else if (strcmp(section, "mesh.") == 0) {
        put_presence(w, section, "file", RG_GROUP_BOX, false);
    } else if (strcmp(section, "interface.weibull.") == 0) {
        put_presence(w, section, "modulus", RG_GROUP_WEIBULL, true);
    } else if (strcmp(section, "interface.rise.") == 0) {
        put_presence(w, section, "rate", RG_GROUP_RISE, true);
    } else if (strcmp(section, "temperature.") == 0) {
        put_presence(w, section, "value", RG_GROUP_HEAT, true);
    }
    if (material || interface) {
        close_group(w, ']');
    }
}

/* ---- mappings ---- */

/* Keys of which an entry has exactly one, or at least one. */
static void put_alternatives(writer *w, const rg_key_table *table) {
    static const char *const words[] = {[RG_EXACTLY_ONE] = "oneOf", [RG_AT_LEAST_ONE] = "anyOf"};
    int last = 0;
    for (int i = 0; i < table->keys; i++) {
        const rg_key *key = &table->key[i];
        if (key->alternative == RG_NO_ALTERNATIVE) {
            continue;
        }
        if (last == 0) {
            open_group(w, words[key->alternative], '[');
        }
        char *name = rg_text_copy(key->name, strcspn(key->name, ".")); /* a section stands for its keys */
        open_group(w, NULL, '{');
        put_words(w, "required", (const char *const[]){name}, 1);
        close_group(w, '}');
        rg_free(name);
        last = 1;
    }
    if (last != 0) {
        close_group(w, ']');
    }
}

/* Whether a section must be there: a key in it must, whatever the others say. Of mesh it is one or the other.
 */
static bool is_needed(const rg_key_table *table, const char *section) {
    bool needed = false;
    for (int i = 0; i < table->keys; i++) {
        const rg_key *key = &table->key[i];
        bool settled = key->group == RG_GROUP_ALWAYS || key->group == RG_GROUP_BOX;
        needed = needed || (strncmp(key->name, section, strlen(section)) == 0 && settled &&
                            key->need == RG_NEED_REQUIRED);
    }
    return needed;
}

static void put_required(writer *w, const char *child, const char *inner, const rg_key_table *table,
                         const rg_key *key) {
    bool leaf = inner == NULL;
    bool alone = leaf && key->need == RG_NEED_REQUIRED && key->group == RG_GROUP_ALWAYS && key->models == 0;
    if (alone || (!leaf && is_needed(table, inner))) {
        put_text(w, NULL, child);
    }
}

/* One pass over what stands in a section: their values, or which are required. */
static void put_children(writer *w, const rg_key_table *table, const char *section, bool values) {
    char last[RG_LONGEST_WORD] = "";
    for (int i = 0; i < table->keys; i++) {
        const rg_key *key = &table->key[i];
        size_t size = 0;
        const char *part = rg_key_part(key, section, &size);
        if (part == NULL || (strncmp(last, part, size) == 0 && last[size] == '\0')) {
            continue;
        }
        snprintf(last, sizeof last, "%.*s", (int)size, part);
        char *inner = part[size] == '\0' ? NULL : rg_text_format("%s%s.", section, last);
        if (!values && !may_be_of_preset(table, section, last)) {
            put_required(w, last, inner, table, key);
        } else if (!values) {
            /* put_solid says when */
        } else if (inner == NULL) {
            put_key(w, last, key);
        } else {
            open_group(w, last, '{');
            put_table(w, table, inner);
            close_group(w, '}');
        }
        rg_free(inner);
    }
}

static void put_table(writer *w, const rg_key_table *table, const char *section) {
    put_text(w, "type", "object");
    open_group(w, "properties", '{');
    put_children(w, table, section, true);
    close_group(w, '}');
    open_group(w, "required", '[');
    put_children(w, table, section, false);
    close_group(w, ']');
    put_false(w, "additionalProperties");
    if (section[0] == '\0') {
        put_alternatives(w, table);
    }
    put_conditions(w, table, section);
}

void rg_schema_write(FILE *out) {
    writer w = {.out = out, .first = true};
    open_group(&w, NULL, '{');
    put_text(&w, "$schema", "http://json-schema.org/draft-07/schema#");
    put_text(&w, "title", "Case of Rhegma");
    put_table(&w, &rg_case_table, "");
    close_group(&w, '}');
    fputc('\n', out);
}
