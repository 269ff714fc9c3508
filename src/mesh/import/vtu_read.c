#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/mem.h"
#include "mesh/import/unpack.h"
#include "mesh/import/vtk_grid.h"
#include "mesh/import/vtk_read.h"

enum {
    WORD = 256,
    MOST_RATIO = 1100, /* zlib makes no more of a byte; LZMA may of an array, but hardly of a whole file */
    MOST_PIECES = 100000
};

typedef enum { NOTHING, POINTS, CELLS, CELL_DATA } part;

/* With points, connectivity, offsets and types. */
struct pieces {
    rg_vtk_grid *of;
    size_t count, room;
};

typedef struct {
    const char *path;
    char *text; /* of the whole file, with a zero behind it */
    size_t size;
    const char *at, *end; /* where we are in it */
    bool big_endian;
    rg_packing packing;
    size_t header;           /* bytes of a length before data; 0: no VTKFile yet */
    bool parallel, is_piece; /* it names other files; it is named by one */
    part part;               /* where we are */
    const char *appended;    /* the appended data, NULL: none */
    bool raw;                /* they are bytes, not base64 */
    rg_vtk_grid grid;        /* of the piece */
    size_t begun;            /* pieces, also those that a .pvtu names */
    struct pieces *done;
} reader;

static _Noreturn void refuse(const reader *r, const char *what, const char *which) {
    rg_fatal(RG_USAGE, "%s: %s%s", r->path, which, what);
}

/* ---- tags ---- */

typedef struct {
    const char *name, *end; /* from behind '<' to '>' */
} tag;

static bool has_name(const tag *t, const char *name) {
    size_t length = strlen(name);
    return (size_t)(t->end - t->name) >= length && strncmp(t->name, name, length) == 0 &&
           (t->name + length == t->end || isspace((unsigned char)t->name[length]) || t->name[length] == '/');
}

/* The next such character; NULL: there is none. */
static const char *find(const reader *r, char c) {
    return memchr(r->at, c, (size_t)(r->end - r->at));
}

/* The next tag; false at the end. */
static bool next_tag(reader *r, tag *t) {
    const char *begin = find(r, '<');
    r->at = begin != NULL ? begin + 1 : r->end;
    const char *close = find(r, '>');
    if (close == NULL) {
        return false;
    }
    *t = (tag){begin + 1, close};
    r->at = close + 1;
    return true;
}

/* The value of an attribute; false: it has none. */
static bool attribute(const reader *r, const tag *t, const char *name, char out[WORD]) {
    size_t length = strlen(name);
    for (const char *at = t->name; at + length + 2 < t->end; at++) {
        if (!isspace((unsigned char)at[0]) || strncmp(at + 1, name, length) != 0) {
            continue;
        }
        const char *value = at + 1 + length;
        for (; value < t->end && isspace((unsigned char)*value); value++) {
        }
        if (value >= t->end || *value++ != '=') {
            continue;
        }
        for (; value < t->end && isspace((unsigned char)*value); value++) {
        }
        char quote = value < t->end ? *value : '\0';
        const char *end =
            quote == '"' || quote == '\'' ? memchr(value + 1, quote, (size_t)(t->end - value - 1)) : NULL;
        if (end == NULL || end - value > WORD) {
            refuse(r, ": an attribute without an end", name);
        }
        memcpy(out, value + 1, (size_t)(end - value - 1));
        out[end - value - 1] = '\0';
        return true;
    }
    return false;
}

static size_t count_of(const reader *r, const tag *t, const char *name, size_t otherwise) {
    char text[WORD], *end;
    if (!attribute(r, t, name, text)) {
        return otherwise;
    }
    unsigned long long value = strtoull(text, &end, 10);
    for (; isspace((unsigned char)*end); end++) {
    }
    if (*end != '\0' || text[strcspn(text, "-")] != '\0' || value > MOST_RATIO * r->size) {
        refuse(r, ": no number of what this file could hold", name);
    }
    return (size_t)value;
}

/* ---- bytes ---- */

/* Bytes as they are, or of base64, whose pieces may end with padding anywhere. */
typedef struct {
    const char *at, *end;
    bool raw;
    unsigned char group[3];
    int have, used;
} stream;

static int digit_of(char c) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const char *found = c != '\0' ? strchr(digits, c) : NULL;
    return found != NULL ? (int)(found - digits) : -1;
}

static bool refill(stream *s) {
    uint32_t bits = 0;
    int digits = 0, padding = 0;
    s->have = s->used = 0; /* whatever comes */
    while (digits + padding < 4 && s->at < s->end) {
        char c = *s->at++;
        int digit = digit_of(c);
        if (digit >= 0 && padding == 0) {
            bits = bits << 6 | (uint32_t)digit;
            digits++;
        } else if (c == '=' && digits >= 2) {
            bits <<= 6;
            padding++;
        } else if (!isspace((unsigned char)c)) {
            return false;
        }
    }
    for (int i = 0; i < 3; i++) {
        s->group[i] = (unsigned char)(bits >> (16 - 8 * i));
    }
    bool whole = digits + padding == 4;
    s->have = whole ? digits - 1 : 0;
    return whole;
}

static bool take_bytes(stream *s, unsigned char *out, size_t count) {
    if (s->raw) {
        if (count > (size_t)(s->end - s->at)) {
            return false;
        }
        memcpy(out, s->at, count);
        s->at += count;
        return true;
    }
    for (size_t i = 0; i < count; i++) {
        if (s->used == s->have && !refill(s)) {
            return false;
        }
        out[i] = s->group[s->used++];
    }
    return true;
}

/* A length before data; more than there could be if it is not there. */
static size_t take_length(const reader *r, stream *s) {
    unsigned char bytes[8];
    if (!take_bytes(s, bytes, r->header)) {
        return SIZE_MAX;
    }
    double value = rg_vtk_decode(bytes, RG_VTK_UNSIGNED, r->header, r->big_endian);
    return value <= (double)(MOST_RATIO * r->size) ? (size_t)value : SIZE_MAX;
}

/* Blocks: their number, the size of all but the last before compression, that of the last (0: as the others),
 * and the sizes after it. */
static unsigned char *take_blocks(const reader *r, stream *s, size_t *bytes) {
    size_t blocks = take_length(r, s), each = take_length(r, s), last = take_length(r, s), done = 0;
    if (blocks > r->size || each > MOST_RATIO * r->size || last > each) {
        return NULL;
    }
    *bytes = blocks == 0 ? 0 : (last > 0 ? blocks - 1 : blocks) * each + last;
    if (*bytes > MOST_RATIO * r->size) {
        return NULL;
    }
    size_t *packed = RG_NEW(size_t, blocks + 1);
    unsigned char *out = RG_NEW(unsigned char, *bytes + 1), *from = RG_NEW(unsigned char, r->size + 1);
    bool good = true;
    for (size_t i = 0; i < blocks; i++) {
        packed[i] = take_length(r, s);
    }
    for (size_t i = 0; i < blocks && good; i++) {
        size_t room = *bytes - done;
        good = packed[i] <= r->size && take_bytes(s, from, packed[i]) &&
               rg_unpack(r->packing, from, packed[i], out + done, &room);
        done += good ? room : 0;
    }
    good = good && done == *bytes;
    rg_free(packed);
    rg_free(from);
    if (!good) {
        rg_free(out);
    }
    return good ? out : NULL;
}

static unsigned char *take_block(const reader *r, stream *s, size_t *bytes) {
    *bytes = take_length(r, s);
    unsigned char *out = *bytes <= r->size ? RG_NEW(unsigned char, *bytes + 1) : NULL;
    if (out != NULL && !take_bytes(s, out, *bytes)) {
        rg_free(out);
        out = NULL;
    }
    return out;
}

/* ---- arrays ---- */

static const struct {
    const char *name;
    rg_vtk_kind kind;
    size_t bytes;
} known_type[] = {{"Int8", RG_VTK_SIGNED, 1},   {"UInt8", RG_VTK_UNSIGNED, 1},
                  {"Int16", RG_VTK_SIGNED, 2},  {"UInt16", RG_VTK_UNSIGNED, 2},
                  {"Int32", RG_VTK_SIGNED, 4},  {"UInt32", RG_VTK_UNSIGNED, 4},
                  {"Int64", RG_VTK_SIGNED, 8},  {"UInt64", RG_VTK_UNSIGNED, 8},
                  {"Float32", RG_VTK_FLOAT, 4}, {"Float64", RG_VTK_FLOAT, 8}};

static double *read_text(const reader *r, const char *name, const char *from, const char *end,
                         size_t *count) {
    double *value = NULL;
    size_t room = 0;
    for (*count = 0;;) {
        for (; from < end && isspace((unsigned char)*from); from++) {
        }
        value = rg_grow(value, &room, *count, sizeof *value);
        if (from == end) {
            return value;
        }
        char *behind;
        value[*count] = strtod(from, &behind);
        if (behind == from || behind > end) {
            refuse(r, ": what is no number", name);
        }
        from = behind;
        ++*count;
    }
}

static double *read_bytes(const reader *r, const tag *t, const char *name, stream *s, size_t *count) {
    char type[WORD] = "";
    size_t k = 0, bytes = 0;
    attribute(r, t, "type", type);
    while (k < sizeof known_type / sizeof *known_type && strcmp(type, known_type[k].name) != 0) {
        k++;
    }
    if (k == sizeof known_type / sizeof *known_type) {
        refuse(r, ": its type is not known", name);
    }
    unsigned char *data = r->packing != RG_PLAIN ? take_blocks(r, s, &bytes) : take_block(r, s, &bytes);
    if (data == NULL) {
        refuse(r, ": its data are damaged", name);
    }
    *count = bytes / known_type[k].bytes;
    double *value = RG_NEW(double, *count + 1);
    for (size_t i = 0; i < *count; i++) {
        value[i] = rg_vtk_decode(data + i * known_type[k].bytes, known_type[k].kind, known_type[k].bytes,
                                 r->big_endian);
    }
    rg_free(data);
    return value;
}

/* The values of a DataArray; the caller frees them. */
static double *read_array(const reader *r, const tag *t, const char *name, size_t *count) {
    char format[WORD] = "ascii";
    const char *end = find(r, '<');
    end = end != NULL ? end : r->end;
    attribute(r, t, "format", format);
    if (strcmp(format, "ascii") == 0) {
        return read_text(r, name, r->at, end, count);
    }
    stream s = {.at = r->at, .end = end};
    if (strcmp(format, "appended") == 0) {
        size_t offset = count_of(r, t, "offset", 0);
        if (r->appended == NULL || offset > (size_t)(r->end - r->appended)) {
            refuse(r, ": its appended data are not there", name);
        }
        s = (stream){.at = r->appended + offset, .end = r->end, .raw = r->raw};
    } else if (strcmp(format, "binary") != 0) {
        refuse(r, ": its format is not known", name);
    }
    return read_bytes(r, t, name, &s, count);
}

static double *need_array(const reader *r, const tag *t, const char *name, size_t wanted,
                          const double *before) {
    size_t count;
    double *value = read_array(r, t, name, &count);
    if (before != NULL || count != wanted) {
        refuse(r, before != NULL ? ": it comes twice" : ": it has not as many values as it should have",
               name);
    }
    return value;
}

static void take_array(reader *r, const tag *t) {
    char name[WORD] = "";
    rg_vtk_grid *g = &r->grid;
    attribute(r, t, "Name", name);
    if (r->part == POINTS) {
        g->x = need_array(r, t, "Points", 3 * g->points, g->x);
    } else if (r->part == CELLS && strcmp(name, "types") == 0) {
        g->type = need_array(r, t, name, g->cells, g->type);
    } else if (r->part == CELLS && strcmp(name, "offsets") == 0) { /* the ends of the cells */
        double *end = need_array(r, t, name, g->cells, g->start);
        g->start = RG_NEW(double, g->cells + 1);
        memcpy(g->start + 1, end, g->cells * sizeof *end);
        rg_free(end);
    } else if (r->part == CELLS && strcmp(name, "connectivity") == 0) {
        if (g->node != NULL) {
            refuse(r, ": it comes twice", name);
        }
        g->node = read_array(r, t, name, &g->nodes);
    } else if (r->part == CELL_DATA && count_of(r, t, "NumberOfComponents", 1) == 1) {
        rg_vtk_add_array(g, name, need_array(r, t, name, g->cells, NULL));
    }
}

/* ---- the whole ---- */

static void load(reader *r) {
    if (!rg_vtk_load(r->path, &r->text, &r->size)) {
        refuse(r, "cannot be read to its end", "");
    }
    r->at = r->text;
    r->end = r->text + r->size;
}

static rg_packing packing_of(const reader *r, const char *compressor) {
    static const struct {
        const char *name;
        rg_packing packing;
    } known[] = {{"vtkZLibDataCompressor", RG_ZLIB},
                 {"vtkLZ4DataCompressor", RG_LZ4},
                 {"vtkLZMADataCompressor", RG_LZMA}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        if (strcmp(known[i].name, compressor) == 0) {
            if (!rg_can_unpack(known[i].packing)) {
                refuse(r, ": this program was built without liblzma (Debian: liblzma-dev)", compressor);
            }
            return known[i].packing;
        }
    }
    refuse(r, ": a compressor that is not known", compressor);
}

static void read_head(reader *r, const tag *t) {
    char value[WORD];
    r->header = attribute(r, t, "header_type", value) && strcmp(value, "UInt64") == 0 ? 8 : 4;
    r->big_endian = attribute(r, t, "byte_order", value) && strcmp(value, "BigEndian") == 0;
    if (attribute(r, t, "compressor", value) && value[0] != '\0') {
        r->packing = packing_of(r, value);
    }
    if (!attribute(r, t, "type", value) || strcmp(value + (value[0] == 'P'), "UnstructuredGrid") != 0 ||
        (value[0] == 'P' && r->is_piece)) {
        refuse(r, "only an UnstructuredGrid can be read", "");
    }
    r->parallel = value[0] == 'P';
}

/* Appended data begin behind an underscore. */
static void find_appended(reader *r) {
    tag t;
    char encoding[WORD] = "";
    while (next_tag(r, &t)) {
        if (has_name(&t, "AppendedData")) {
            const char *mark = find(r, '_');
            r->appended = mark != NULL ? mark + 1 : NULL;
            r->raw = attribute(r, &t, "encoding", encoding) && strcmp(encoding, "raw") == 0;
            break;
        }
    }
    r->at = r->text;
}

static void end_piece(reader *r) {
    const rg_vtk_grid *g = &r->grid;
    bool good = g->x != NULL && g->start != NULL && g->node != NULL && g->type != NULL;
    if (!good && (g->points > 0 || g->cells > 0 || (r->begun < 2 && !r->is_piece))) {
        refuse(r, "points, connectivity, offsets or types of cells are not there", "");
    }
    if (good) {
        r->done->of = rg_grow(r->done->of, &r->done->room, r->done->count, sizeof *r->done->of);
        r->done->of[r->done->count++] = r->grid;
    } else {
        rg_vtk_free(&r->grid);
    }
    r->grid = (rg_vtk_grid){.path = r->path};
}

static void read_file(const char *path, bool is_piece, struct pieces *done);

/* A file that a .pvtu names, beside it unless the name begins with '/'. */
static void read_named(reader *r, const tag *t) {
    char name[WORD];
    if (!attribute(r, t, "Source", name)) {
        refuse(r, "a Piece without a Source", "");
    }
    if (++r->begun > MOST_PIECES) {
        refuse(r, "too many pieces", "");
    }
    const char *slash = name[0] != '/' ? strrchr(r->path, '/') : NULL;
    size_t folder = slash != NULL ? (size_t)(slash + 1 - r->path) : 0;
    char *path = RG_NEW(char, folder + strlen(name) + 1);
    memcpy(path, r->path, folder);
    strcpy(path + folder, name);
    read_file(path, true, r->done);
    rg_free(path);
}

static void read_tag(reader *r, const tag *t) {
    static const char *const names[] = {[POINTS] = "Points", [CELLS] = "Cells", [CELL_DATA] = "CellData"};
    if (t->name[0] == '/') {
        r->part = has_name(t, "/DataArray") ? r->part : NOTHING;
    } else if (has_name(t, "VTKFile")) {
        read_head(r, t);
    } else if (has_name(t, "Piece") && r->parallel) {
        read_named(r, t);
    } else if (has_name(t, "Piece")) {
        r->begun++ > 0 ? end_piece(r) : (void)0;
        r->grid.points = count_of(r, t, "NumberOfPoints", 0);
        r->grid.cells = count_of(r, t, "NumberOfCells", 0);
    } else if (has_name(t, "DataArray")) {
        take_array(r, t);
    }
    for (part p = POINTS; p <= CELL_DATA; p++) {
        r->part = has_name(t, names[p]) && t->end[-1] != '/' ? p : r->part;
    }
}

static void read_file(const char *path, bool is_piece, struct pieces *done) {
    reader r = {.path = path, .grid = {.path = path}, .is_piece = is_piece, .done = done};
    tag t;
    load(&r);
    find_appended(&r);
    while (next_tag(&r, &t) && !has_name(&t, "AppendedData")) {
        read_tag(&r, &t);
    }
    if (r.header == 0) {
        refuse(&r, "not an XML file of VTK: it has no VTKFile", "");
    }
    r.parallel ? (void)0 : end_piece(&r);
    rg_free(r.text);
}

rg_mesh *rg_vtu_read(const char *path, const rg_import_how *how) {
    struct pieces all = {.count = 0};
    read_file(path, false, &all);
    if (all.count == 0) {
        rg_fatal(RG_USAGE, "%s: no piece has any cells", path);
    }
    rg_vtk_grid whole = all.of[0];
    if (all.count > 1) {
        whole = rg_vtk_join(path, all.of, all.count);
    } else {
        rg_free(all.of);
    }
    whole.path = path;
    return rg_vtk_mesh(&whole, how);
}
