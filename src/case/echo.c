/* Writes a case with all values used, as a case file that reads back to the same case. */
#include <inttypes.h>
#include <string.h>

#include "base/files.h"
#include "case/echo.h"
#include "case/expr.h"
#include "case/key.h"
#include "case/table.h"
#include "library.h"

/* Double quotes, because only they can hold any text. */
static void write_text(FILE *out, const char *text) {
    fputc('"', out);
    for (; *text != '\0'; text++) {
        unsigned char byte = (unsigned char)*text;
        if (byte == '"' || byte == '\\') {
            fprintf(out, "\\%c", byte);
        } else if (byte < 0x20 || byte == 0x7f) {
            fprintf(out, "\\x%02x", byte);
        } else {
            fputc(byte, out);
        }
    }
    fputc('"', out);
}

static void write_numbers(FILE *out, const rg_key *key, const void *value) {
    fputs(key->count > 1 ? "[" : "", out);
    for (int i = 0; i < key->count; i++) {
        fputs(i > 0 ? ", " : "", out);
        if (key->type == RG_KEY_INTEGER) {
            fprintf(out, "%lld", (long long)((const int64_t *)value)[i]);
        } else {
            fprintf(out, "%.17g", ((const double *)value)[i]);
        }
    }
    fputs(key->count > 1 ? "]" : "", out);
}

static void write_reals(FILE *out, const double *value, int count) {
    for (int i = 0; i < count; i++) {
        fprintf(out, "%s%.17g", i > 0 ? ", " : "[", value[i]);
    }
    fputc(']', out);
}

static void write_texts(FILE *out, char *const text[], int count) {
    for (int i = 0; i < count; i++) {
        fputs(i > 0 ? ", " : "[", out);
        write_text(out, text[i]);
    }
    fputc(']', out);
}

static int list_length(const rg_key *key, const void *base) {
    int count = 0;
    memcpy(&count, (const char *)base + key->offset_count, sizeof count);
    return count;
}

static void write_flags(FILE *out, const rg_key *key, unsigned flags) {
    const char *join = "";
    fputc('[', out);
    for (int i = 0; key->choice[i] != NULL; i++) {
        if ((flags >> i & 1U) != 0) {
            fprintf(out, "%s%s", join, key->choice[i]);
            join = ", ";
        }
    }
    fputc(']', out);
}

static void write_expr(FILE *out, const rg_expr *e) {
    if (rg_expr_is_number(e)) {
        fputs(rg_expr_text(e), out);
    } else {
        write_text(out, rg_expr_text(e));
    }
}

static void write_face_value(FILE *out, const rg_key *key, const void *base) {
    const rg_expr *e = rg_pointer_get((const char *)base + key->offset_expr);
    if (e == NULL || rg_expr_is_number(e)) {
        write_numbers(out, key, (const char *)base + key->offset);
    } else {
        write_expr(out, e);
    }
}

static void write_interval(FILE *out, const rg_case *c) {
    if (c->output.interval_steps > 0) {
        fprintf(out, "%lld # steps", (long long)c->output.interval_steps);
    } else {
        fprintf(out, "%.17g # s", c->output.interval_time);
    }
}

/* The material that has the key. */
static const rg_user_input *user_of(const rg_key *key, const void *base) {
    return &((const rg_material_input *)(const void *)((const char *)base + key->input))->user;
}

/* Parameters of a library and their values; returns how many. */
static int parameters_of(const rg_key *key, const void *base, const rg_user_parameter **list,
                         const double **value) {
    if (key->of_material) {
        const rg_user_values *is = &user_of(key, base)->is;
        *list = is->library->facts->parameter;
        *value = is->parameter;
        return is->library->facts->parameters;
    }
    const rg_case *c = base;
    *list = c->interface.user.is->facts->parameter;
    *value = c->interface.shape[RG_LAW_USER];
    return c->interface.user.is->facts->parameters;
}

static void write_parameters(FILE *out, const rg_key *key, const void *base) {
    const rg_user_parameter *list = NULL;
    const double *value = NULL;
    int count = parameters_of(key, base, &list, &value);
    for (int i = 0; i < count; i++) {
        fprintf(out, "%s%s: ", i == 0 ? "{" : ", ", list[i].name);
        write_numbers(out, &(rg_key){.type = RG_KEY_REAL, .count = 1}, &value[i]);
    }
    fputc('}', out);
}

void rg_key_write(FILE *out, const rg_key *as_model, const void *base) {
    const rg_key here = rg_key_here(as_model, base), *key = &here;
    const void *value = (const char *)base + key->offset;
    int choice = 0;
    switch (key->type) {
    case RG_KEY_REAL:
    case RG_KEY_INTEGER:
        write_numbers(out, key, value);
        break;
    case RG_KEY_CHOICE:
        memcpy(&choice, value, sizeof choice);
        fputs(key->choice[choice], out);
        break;
    case RG_KEY_FLAGS:
        write_flags(out, key, *(const unsigned *)value);
        break;
    case RG_KEY_TEXT:
        write_text(out, rg_pointer_get(value));
        break;
    case RG_KEY_TEXTS:
        write_texts(out, rg_pointer_get(value), list_length(key, base));
        break;
    case RG_KEY_REALS:
        write_reals(out, rg_pointer_get(value), list_length(key, base));
        break;
    case RG_KEY_EXPR:
        write_expr(out, rg_pointer_get(value));
        break;
    case RG_KEY_FACE:
        write_face_value(out, key, base);
        break;
    case RG_KEY_BOOL:
        fputs(*(const bool *)value ? "true" : "false", out);
        break;
    case RG_KEY_INTERVAL:
        write_interval(out, base);
        break;
    case RG_KEY_LIBRARY:
        write_text(out, rg_pointer_get(value));
        fprintf(out, " # %016" PRIx64, ((const rg_library_input *)value)->hash);
        break;
    case RG_KEY_PARAMETERS:
        write_parameters(out, key, base);
        break;
    case RG_KEY_TABLES:
        rg_tables_write(out, value);
        break;
    case RG_KEY_LIST:
        break;
    }
}

/* A default interval of a second or more cannot be written, since such numbers are no interval; left out, it
 * comes back as the same default. */
static bool has_interval(const rg_case *c) {
    return c->output.interval_steps > 0 || c->output.interval_time < 1;
}

/* Absent numbers are 0. */
static bool is_zero(const rg_key *key, const char *value) {
    static const char zero[RG_STIFFNESS * sizeof(double)];
    return memcmp(value, zero, (size_t)key->count * sizeof(double)) == 0; /* an int64_t is as large */
}

bool rg_key_present(const rg_key *as_model, const void *base) {
    const rg_key here = rg_key_here(as_model, base), *key = &here;
    int choice = 0;
    const char *value = (const char *)base + key->offset;
    if (!rg_key_used(key, base)) {
        return false;
    }
    if (key->type == RG_KEY_INTERVAL) {
        return has_interval(base);
    }
    if (key->type == RG_KEY_PARAMETERS) {
        const rg_user_parameter *list = NULL;
        const double *values = NULL;
        return parameters_of(key, base, &list, &values) > 0;
    }
    if (key->type == RG_KEY_TEXT || key->type == RG_KEY_EXPR || key->type == RG_KEY_LIBRARY) {
        return rg_pointer_get(value) != NULL;
    }
    if (key->type == RG_KEY_BOOL) {
        return *(const bool *)(const void *)value;
    }
    if (key->type == RG_KEY_TABLES) {
        return ((const rg_curves *)(const void *)value)->count > 0;
    }
    if (key->type == RG_KEY_CHOICE && key->need == RG_NEED_OPTIONAL) {
        memcpy(&choice, value, sizeof choice);
        return choice != 0;
    }
    if (key->type == RG_KEY_FACE && key->need == RG_NEED_OPTIONAL) {
        return rg_pointer_get((const char *)base + key->offset_expr) != NULL;
    }
    if (key->type == RG_KEY_TEXTS || key->type == RG_KEY_REALS) {
        return list_length(key, base) > 0;
    }
    return key->need != RG_NEED_OPTIONAL || key->type == RG_KEY_LIST || !is_zero(key, value);
}

static void write_indent(FILE *out, int indent, bool dash) {
    fprintf(out, "%*s%s", dash ? indent - 2 : indent, "", dash ? "- " : "");
}

/* Writes the sections that lead to `name` but not to `before`, the first with the dash of an entry if that is
 * still to come. Returns the indent of the key itself and, in *last, the last part of its name. */
static int write_sections(FILE *out, const char *before, const char *name, int indent, bool *dash,
                          const char **last) {
    bool same = true;
    for (const char *dot = strchr(name, '.'); dot != NULL; dot = strchr(name, '.')) {
        size_t length = (size_t)(dot - name);
        same = same && strncmp(before, name, length + 1) == 0;
        if (!same) {
            write_indent(out, indent, *dash);
            fprintf(out, "%.*s:\n", (int)length, name);
            *dash = false;
        }
        before += same ? length + 1 : 0;
        name = dot + 1;
        indent += 2;
    }
    *last = name;
    return indent;
}

static void write_table(FILE *out, const rg_key_table *table, const void *base, int indent, bool entry);

static void write_list(FILE *out, const rg_key *key, const char *base, int indent) {
    int count = list_length(key, base);
    const char *list = rg_pointer_get(base + key->offset);
    fputs(count == 0 ? " []\n" : "\n", out);
    for (int i = 0; i < count; i++) {
        write_table(out, key->entry, list + (size_t)i * key->entry->size, indent + 4, true);
    }
}

static void write_table(FILE *out, const rg_key_table *table, const void *base, int indent, bool entry) {
    const char *before = "";
    bool dash = entry;
    for (int i = 0; i < table->keys; i++) {
        const rg_key *key = &table->key[i];
        const char *last = NULL;
        if (!rg_key_present(key, base)) {
            continue;
        }
        int inner = write_sections(out, before, key->name, indent, &dash, &last);
        write_indent(out, inner, dash);
        fprintf(out, "%s:", last);
        if (key->type == RG_KEY_LIST) {
            write_list(out, key, base, inner);
        } else {
            fputc(' ', out);
            rg_key_write(out, key, base);
            fprintf(out, "%s%s\n", key->unit != NULL ? " # " : "", key->unit != NULL ? key->unit : "");
        }
        before = key->name;
        dash = false;
    }
}

void rg_case_echo(const rg_case *c, FILE *out) {
    write_table(out, &rg_case_table, c, 0, false);
}

void rg_case_write(const rg_case *c, int rank) {
    if (rank == 0) { /* whole or not at all: a restart may come from it */
        FILE *file = rg_replace_in(c->output.dir, "case.yaml");
        rg_case_echo(c, file);
        rg_replaced_in(file, c->output.dir, "case.yaml");
    }
}
