#include "mesh/import/vtk_read.h"

#include <ctype.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/error.h"
#include "base/mem.h"
#include "mesh/import/vtk_grid.h"

typedef struct {
    const char *path;
    char *text; /* of the whole file, with a zero behind it */
    size_t size, at;
    bool binary;
    rg_vtk_grid grid;
    bool of_cells; /* the data that come now */
    size_t data;   /* how many of each array */
} reader;

enum { WORD = 256 };

static _Noreturn void refuse(const reader *r, const char *format, ...) __attribute__((format(printf, 2, 3)));

static void refuse(const reader *r, const char *format, ...) {
    char what[400];
    long line = 1;
    va_list args;
    va_start(args, format);
    vsnprintf(what, sizeof what, format, args);
    va_end(args);
    for (size_t i = 0; i < r->at && !r->binary; i++) {
        line += r->text[i] == '\n';
    }
    if (r->binary) {
        rg_fatal(RG_USAGE, "%s: at byte %zu: %s", r->path, r->at, what);
    }
    rg_fatal(RG_USAGE, "%s:%ld: %s", r->path, line, what);
}

/* ---- words and lines ---- */

static void load(reader *r) {
    if (!rg_vtk_load(r->path, &r->text, &r->size)) {
        refuse(r, "the file cannot be read to its end");
    }
}

static void skip_line(reader *r) {
    while (r->at < r->size && r->text[r->at++] != '\n') {
    }
}

/* The next word; false at the end of the file. */
static bool next_word(reader *r, char word[WORD]) {
    while (r->at < r->size && isspace((unsigned char)r->text[r->at])) {
        r->at++;
    }
    size_t length = 0;
    while (r->at + length < r->size && !isspace((unsigned char)r->text[r->at + length])) {
        length++;
    }
    if (length >= WORD) {
        refuse(r, "a word of more than %d bytes", WORD - 1);
    }
    memcpy(word, r->text + r->at, length);
    word[length] = '\0';
    r->at += length;
    return length > 0;
}

static void need_word(reader *r, char word[WORD]) {
    if (!next_word(r, word)) {
        refuse(r, "the file ends too early");
    }
}

static bool is(const char *word, const char *what) {
    return strcasecmp(word, what) == 0;
}

/* Takes the word if it is the next one; binary data are no words. */
static bool follows(reader *r, const char *what) {
    size_t at = r->at, length = strlen(what);
    while (at < r->size && isspace((unsigned char)r->text[at])) {
        at++;
    }
    bool found = strncasecmp(r->text + at, what, length) == 0 && isspace((unsigned char)r->text[at + length]);
    r->at = found ? at + length : r->at;
    return found;
}

static size_t need_count(reader *r) {
    char word[WORD], *end;
    need_word(r, word);
    unsigned long long value = strtoull(word, &end, 10);
    if (!isdigit((unsigned char)word[0]) || *end != '\0' ||
        value > r->size) { /* each takes a byte at least */
        refuse(r, "'%s' is no number of what this file could hold", word);
    }
    return (size_t)value;
}

/* ---- values ---- */

static const struct {
    const char *name;
    rg_vtk_kind kind;
    size_t bytes;
} known_type[] = {{"char", RG_VTK_SIGNED, 1},
                  {"unsigned_char", RG_VTK_UNSIGNED, 1},
                  {"short", RG_VTK_SIGNED, 2},
                  {"unsigned_short", RG_VTK_UNSIGNED, 2},
                  {"int", RG_VTK_SIGNED, 4},
                  {"unsigned_int", RG_VTK_UNSIGNED, 4},
                  {"vtkIdType", RG_VTK_SIGNED, 4},
                  {"long", RG_VTK_SIGNED, 8},
                  {"unsigned_long", RG_VTK_UNSIGNED, 8},
                  {"vtktypeint64", RG_VTK_SIGNED, 8},
                  {"vtktypeuint64", RG_VTK_UNSIGNED, 8},
                  {"float", RG_VTK_FLOAT, 4},
                  {"double", RG_VTK_FLOAT, 8}};

/* Big-endian, as all binary legacy files are. */
static double *read_binary(reader *r, size_t count, size_t t) {
    size_t bytes = known_type[t].bytes;
    skip_line(r);
    if (count > (r->size - r->at) / bytes) {
        refuse(r, "%zu values of type %s are more than there are", count, known_type[t].name);
    }
    double *value = RG_NEW(double, count + 1);
    for (size_t i = 0; i < count; i++) {
        value[i] = rg_vtk_decode((const unsigned char *)r->text + r->at + i * bytes, known_type[t].kind,
                                 bytes, true);
    }
    r->at += count * bytes;
    return value;
}

static double *read_text(reader *r, size_t count) {
    if (count > r->size) {
        refuse(r, "%zu values are more than there are", count);
    }
    double *value = RG_NEW(double, count + 1);
    for (size_t i = 0; i < count; i++) {
        char word[WORD], *end;
        need_word(r, word);
        value[i] = strtod(word, &end);
        if (*end != '\0') {
            refuse(r, "'%s' is not a number", word);
        }
    }
    return value;
}

/* [count] values of a type; the caller frees them. */
static double *read_values(reader *r, size_t count, const char *type) {
    for (size_t t = 0; t < sizeof known_type / sizeof *known_type; t++) {
        if (is(type, known_type[t].name)) {
            return r->binary ? read_binary(r, count, t) : read_text(r, count);
        }
    }
    refuse(r, "values of type '%s' cannot be read", type);
}

/* ---- points and cells ---- */

static void read_points(reader *r) {
    char type[WORD];
    rg_vtk_grid *g = &r->grid;
    size_t points = need_count(r);
    need_word(r, type);
    if (g->x != NULL) {
        refuse(r, "POINTS come twice");
    }
    g->points = points;
    g->x = read_values(r, 3 * points, type);
}

/* The nodes of old versions: each cell begins with how many it has. */
static void split_cells(reader *r, double *list, size_t size) {
    rg_vtk_grid *g = &r->grid;
    size_t at = 0, nodes = 0;
    g->start = RG_NEW(double, g->cells + 1);
    g->node = RG_NEW(double, size + 1);
    for (size_t cell = 0; cell < g->cells; cell++) {
        double count = at < size ? list[at++] : -1;
        if (!(count >= 0 && count <= (double)(size - at))) {
            refuse(r, "CELLS end within cell %zu", cell);
        }
        memcpy(g->node + nodes, list + at, (size_t)count * sizeof *list);
        nodes += (size_t)count;
        at += (size_t)count;
        g->start[cell + 1] = (double)nodes;
    }
    g->nodes = nodes;
    rg_free(list);
}

static void read_cells(reader *r) {
    char word[WORD], type[WORD];
    rg_vtk_grid *g = &r->grid;
    size_t count = need_count(r), size = need_count(r);
    if (g->start != NULL) {
        refuse(r, "CELLS come twice");
    }
    if (!follows(r, "OFFSETS")) {
        g->cells = count;
        split_cells(r, read_values(r, size, "int"), size);
        return;
    }
    need_word(r, type);
    g->cells = count > 0 ? count - 1 : 0;
    g->start = read_values(r, count, type);
    need_word(r, word);
    need_word(r, type);
    if (!is(word, "CONNECTIVITY")) {
        refuse(r, "'%s' instead of CONNECTIVITY", word);
    }
    g->nodes = size;
    g->node = read_values(r, size, type);
}

static void read_types(reader *r) {
    rg_vtk_grid *g = &r->grid;
    size_t count = need_count(r);
    if (g->start == NULL || count != g->cells || g->type != NULL) {
        refuse(r, "%zu CELL_TYPES of %zu cells", count, g->cells);
    }
    g->type = read_values(r, count, "int");
}

/* ---- data ---- */

/* Keeps single values of cells, and drops others. */
static void take_array(reader *r, const char *word, size_t components, size_t count, const char *type) {
    char name[WORD];
    size_t length = 0;
    if (components > r->size || count > r->size) {
        refuse(r, "%zu values with %zu components are more than there are", count, components);
    }
    double *value = read_values(r, components * count, type);
    for (const char *from = word; *from != '\0'; from++) { /* a blank is %20 */
        unsigned code;
        if (from[0] == '%' && isxdigit((unsigned char)from[1]) && isxdigit((unsigned char)from[2]) &&
            sscanf(from + 1, "%2x", &code) == 1 && code > 0) {
            name[length++] = (char)code;
            from += 2;
        } else {
            name[length++] = *from;
        }
    }
    name[length] = '\0';
    if (!r->of_cells || components != 1 || count != r->grid.cells) {
        rg_free(value);
        return;
    }
    rg_vtk_add_array(&r->grid, name, value);
}

static void read_scalars(reader *r) {
    char name[WORD], type[WORD], word[WORD];
    size_t components = 1;
    need_word(r, name);
    need_word(r, type);
    while (r->at < r->size && (r->text[r->at] == ' ' || r->text[r->at] == '\t')) {
        r->at++;
    }
    if (isdigit((unsigned char)r->text[r->at])) {
        components = need_count(r);
    }
    if (follows(r, "LOOKUP_TABLE")) {
        need_word(r, word);
    }
    take_array(r, name, components, r->data, type);
}

static void read_field(reader *r) {
    char name[WORD], type[WORD];
    need_word(r, name);
    size_t arrays = need_count(r);
    for (size_t i = 0; i < arrays; i++) {
        need_word(r, name);
        if (is(name, "METADATA")) {
            i--; /* of the array before */
            skip_line(r);
            while (r->at < r->size && r->text[r->at] != '\n') {
                skip_line(r);
            }
            continue;
        }
        size_t components = need_count(r), count = need_count(r);
        need_word(r, type);
        take_array(r, name, components, count, type);
    }
}

static void read_named(reader *r, size_t components) {
    char name[WORD], type[WORD];
    need_word(r, name);
    need_word(r, type);
    take_array(r, name, components, r->data, type);
}

static void read_table(reader *r, bool colours) {
    char name[WORD];
    need_word(r, name);
    size_t count = need_count(r);
    take_array(r, name, colours ? count : 4, colours ? r->data : count,
               r->binary ? "unsigned_char" : "float");
}

/* ---- the whole ---- */

static void read_head(reader *r) {
    char word[WORD];
    if (strncmp(r->text, "# vtk DataFile Version", 22) != 0) {
        refuse(r, "not a legacy file of VTK: it does not begin with '# vtk DataFile Version'");
    }
    skip_line(r);
    skip_line(r);
    need_word(r, word);
    if (!is(word, "ASCII") && !is(word, "BINARY")) {
        refuse(r, "'%s' instead of ASCII or BINARY", word);
    }
    bool binary = is(word, "BINARY");
    need_word(r, word);
    if (!is(word, "DATASET")) {
        refuse(r, "'%s' instead of DATASET", word);
    }
    need_word(r, word);
    if (!is(word, "UNSTRUCTURED_GRID")) {
        refuse(r, "DATASET %s: only an UNSTRUCTURED_GRID can be read", word);
    }
    r->binary = binary;
}

static void read_section(reader *r, const char *word) {
    if (is(word, "POINTS")) {
        read_points(r);
    } else if (is(word, "CELLS")) {
        read_cells(r);
    } else if (is(word, "CELL_TYPES")) {
        read_types(r);
    } else if (is(word, "CELL_DATA") || is(word, "POINT_DATA")) {
        r->of_cells = is(word, "CELL_DATA");
        r->data = need_count(r);
    } else if (is(word, "SCALARS")) {
        read_scalars(r);
    } else if (is(word, "FIELD")) {
        read_field(r);
    } else if (is(word, "VECTORS") || is(word, "NORMALS")) {
        read_named(r, 3);
    } else if (is(word, "TENSORS") || is(word, "TENSORS6")) {
        read_named(r, is(word, "TENSORS") ? 9 : 6);
    } else if (is(word, "GLOBAL_IDS") || is(word, "PEDIGREE_IDS")) {
        bool of_cells = r->of_cells;
        r->of_cells = false; /* they number the cells */
        read_named(r, 1);
        r->of_cells = of_cells;
    } else if (is(word, "COLOR_SCALARS") || is(word, "LOOKUP_TABLE")) {
        read_table(r, is(word, "COLOR_SCALARS"));
    } else if (is(word, "METADATA")) {
        skip_line(r);
        while (r->at < r->size && r->text[r->at] != '\n') {
            skip_line(r);
        }
    } else {
        refuse(r, "'%s' is not known here", word);
    }
}

rg_mesh *rg_vtk_read(const char *path, const rg_import_how *how) {
    reader r = {.path = path, .grid = {.path = path}};
    char word[WORD];
    load(&r);
    read_head(&r);
    while (next_word(&r, word)) {
        read_section(&r, word);
    }
    if (r.grid.x == NULL || r.grid.type == NULL) { /* no types without cells */
        rg_fatal(RG_USAGE, "%s: POINTS, CELLS or CELL_TYPES are not there", path);
    }
    rg_free(r.text);
    return rg_vtk_mesh(&r.grid, how);
}
