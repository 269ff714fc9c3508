#include "mesh/import/vtk_grid.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/files.h"
#include "base/mem.h"
#include "mesh/rows.h"

/* VTK's numbers of cell types that are read; corners come first. */
typedef struct {
    int type, nodes, corners;
    bool solid;
} shape;

static const shape shapes[] = {{5, 3, 3, false},  {22, 6, 3, false}, {10, 4, 4, true},  {24, 10, 4, true},
                               {8, 4, 4, false},  {9, 4, 4, false},  {23, 8, 4, false}, {28, 9, 4, false},
                               {30, 6, 4, false}, {11, 8, 8, true},  {12, 8, 8, true},  {25, 20, 8, true},
                               {29, 27, 8, true}, {33, 24, 8, true}, {13, 6, 6, true},  {26, 15, 6, true},
                               {31, 12, 6, true}, {32, 18, 6, true}, {14, 5, 5, true},  {27, 13, 5, true}};
enum { WHOLE = 4, PIXEL = 8, VOXEL = 11, NODES = 27 }; /* the first ones are taken without a cut */

/* Points, lines and other surfaces, which are left out. */
static const int flat[] = {0, 1, 2, 3, 4, 6, 7, 8, 9, 21, 23, 28, 30, 34, 35, 36, 68, 69, 70, 75, 76};

typedef struct {
    const rg_vtk_grid *grid;
    rg_import import;
    rg_gid *element; /* [cells + 1]: those of the import begin here, and end with the next */
    int64_t left_out;
} building;

void rg_vtk_add_array(rg_vtk_grid *g, const char *name, double *value) {
    if (strlen(name) >= RG_SET_NAME - 12) {
        rg_fatal(RG_USAGE, "%s: the name of cell data '%s' is longer than %d bytes", g->path, name,
                 RG_SET_NAME - 13);
    }
    g->array = rg_realloc(g->array, g->arrays + 1, sizeof *g->array);
    g->array[g->arrays++] = (rg_vtk_array){strcpy(RG_NEW(char, strlen(name) + 1), name), value};
}

double rg_vtk_decode(const unsigned char *from, rg_vtk_kind kind, size_t bytes, bool big_endian) {
    uint64_t bits = 0;
    for (size_t i = 0; i < bytes; i++) {
        bits = bits << 8 | from[big_endian ? i : bytes - 1 - i];
    }
    if (kind == RG_VTK_UNSIGNED) {
        return (double)bits;
    }
    if (kind == RG_VTK_SIGNED) {
        uint64_t sign = UINT64_C(1) << (8 * bytes - 1);
        return (double)(int64_t)((bits ^ sign) - sign);
    }
    if (bytes == 4) {
        uint32_t narrow = (uint32_t)bits;
        float value;
        memcpy(&value, &narrow, sizeof value);
        return value;
    }
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* ---- cells ---- */

static void exchange(size_t *a, size_t *b) {
    size_t swap = *a;
    *a = *b;
    *b = swap;
}

static int type_of(const rg_vtk_grid *g, size_t cell) {
    double type = g->type[cell];
    return type >= 0 && type < 256 ? (int)type : -1;
}

/* NULL: a cell of another type, or one that has to be cut where that was not asked for. */
static const shape *shape_of(const building *b, size_t cell) {
    int type = type_of(b->grid, cell);
    for (size_t i = 0; i < (b->import.how.split ? sizeof shapes / sizeof *shapes : WHOLE); i++) {
        if (shapes[i].type == type) {
            return &shapes[i];
        }
    }
    return NULL;
}

static bool is_flat(int type) {
    for (size_t i = 0; i < sizeof flat / sizeof *flat; i++) {
        if (flat[i] == type) {
            return true;
        }
    }
    return false;
}

/* The nodes of a cell, checked; of pixels and voxels the corners in turn. */
static void take_nodes(const rg_vtk_grid *g, size_t cell, const shape *s, size_t node[NODES]) {
    int count = s->nodes;
    double from = g->start[cell], to = g->start[cell + 1];
    bool good = from >= 0 && to <= (double)g->nodes && to - from == count;
    for (int i = 0; i < count && good; i++) {
        double n = g->node[(size_t)from + (size_t)i];
        good = n >= 0 && n < (double)g->points;
        node[i] = good ? (size_t)n : 0;
    }
    if (!good) {
        rg_fatal(RG_USAGE, "%s: cell %zu of type %d has not the %d points that it should have", g->path, cell,
                 (int)g->type[cell], count);
    }
    for (int i = 2; i < count && (s->type == PIXEL || s->type == VOXEL); i += 4) {
        exchange(&node[i], &node[i + 1]);
    }
}

static void take_solid(building *b, size_t cell, const shape *s) {
    size_t node[NODES];
    take_nodes(b->grid, cell, s, node);
    if (s->corners > 4) {
        int64_t inverted = b->import.inverted;
        rg_import_solid(&b->import, (rg_gid)cell, s->corners, node);
        b->import.inverted =
            s->corners == 6 ? inverted : b->import.inverted; /* writers differ about wedges */
        return;
    }
    if (s->nodes == 10) { /* the last two middles stand the other way round */
        exchange(&node[8], &node[9]);
    }
    rg_import_element(&b->import, (rg_gid)cell, s->nodes, node);
}

static void take_cells(building *b) {
    const rg_vtk_grid *g = b->grid;
    int64_t solids = 0;
    size_t first = 0;
    for (size_t n = 0; n < g->points; n++) {
        rg_import_node(&b->import, n, g->x + 3 * n);
    }
    b->element = RG_NEW(rg_gid, g->cells + 1);
    for (size_t cell = 0; cell < g->cells; cell++) {
        const shape *s = shape_of(b, cell);
        b->element[cell] = b->import.elements;
        if (s != NULL && s->solid) {
            take_solid(b, cell, s);
        } else if (s == NULL && is_flat(type_of(g, cell))) {
            b->left_out++;
        } else if (s == NULL) {
            first = solids++ == 0 ? cell : first;
        }
    }
    b->element[g->cells] = b->import.elements;
    if (solids > 0) {
        rg_fatal(RG_USAGE,
                 "%s: %" PRId64
                 " cells are neither tetrahedra nor flat, the first of them cell %zu of type %d; "
                 "only tetrahedra of first and second order are possible; --split cuts hexahedra, wedges and "
                 "pyramids",
                 g->path, solids, first, type_of(g, first));
    }
}

/* ---- sets ---- */

static int ascending(const void *a, const void *b) {
    double p = *(const double *)a, q = *(const double *)b;
    return (p > q) - (p < q);
}

/* Adds the different values of the cells of a kind to `sets` as "array.number"; false: they are no numbers of
 * sets. */
static bool name_sets(const building *b, const rg_vtk_array *a, bool faces, rg_sets *sets) {
    const rg_vtk_grid *g = b->grid;
    double *value = RG_NEW(double, g->cells + 1);
    size_t count = 0, kept = 0;
    bool whole = true;
    for (size_t cell = 0; cell < g->cells; cell++) {
        const shape *s = shape_of(b, cell);
        if (s != NULL && s->solid != faces) {
            value[count++] = a->value[cell];
            whole = whole && fabs(a->value[cell]) < 1e9 && a->value[cell] == floor(a->value[cell]);
        }
    }
    if (whole) {
        qsort(value, count, sizeof *value, ascending);
        for (size_t i = 0; i < count; i++) {
            if (kept == 0 || value[i] != value[kept - 1]) {
                value[kept++] = value[i];
            }
        }
    }
    whole = whole && (kept < 10 || kept <= count / 2); /* else they number the cells */
    for (size_t i = 0; i < kept && whole; i++) {
        char name[RG_SET_NAME + 16];
        snprintf(name, sizeof name, "%s.%.0f", a->name, value[i]);
        rg_sets_add(sets, name);
    }
    rg_free(value);
    return whole;
}

static int32_t set_of(const rg_sets *sets, const rg_vtk_array *a, double value) {
    char name[RG_SET_NAME + 16];
    snprintf(name, sizeof name, "%s.%.0f", a->name, value);
    return rg_sets_find(sets, name);
}

static void add_face(building *b, size_t cell, int32_t set) {
    size_t node[NODES];
    const shape *s = shape_of(b, cell);
    take_nodes(b->grid, cell, s, node);
    if (s->corners == 4) {
        rg_import_add_quadrangle(&b->import, node, (rg_gid)cell, set);
    } else {
        rg_import_add_face(&b->import, (rg_import_face){{node[0], node[1], node[2]}, (rg_gid)cell, set});
    }
}

/* `named`: whether the array names sets of volumes, of faces. */
static void fill_sets(building *b, const rg_vtk_array *a, const bool named[2]) {
    double last[2] = {NAN, NAN};
    int32_t set[2] = {-1, -1};
    for (size_t cell = 0; cell < b->grid->cells; cell++) {
        const shape *s = shape_of(b, cell);
        bool face = s != NULL && !s->solid;
        if (s == NULL || !named[face]) {
            continue;
        }
        if (a->value[cell] != last[face]) { /* mostly it is that of the cell before */
            last[face] = a->value[cell];
            set[face] = set_of(face ? &b->import.surface : &b->import.volume, a, last[face]);
        }
        if (face) {
            add_face(b, cell, set[face]);
        }
        for (rg_gid e = b->element[cell]; e < b->element[cell + 1]; e++) {
            rg_import_put(&b->import, e, set[face]);
        }
    }
}

static void take_sets(building *b) {
    const rg_vtk_grid *g = b->grid;
    bool(*named)[2] = rg_alloc(g->arrays + 1, sizeof *named), any = false;
    for (size_t i = 0; i < g->arrays; i++) {
        named[i][0] = name_sets(b, &g->array[i], false, &b->import.volume);
        named[i][1] = name_sets(b, &g->array[i], true, &b->import.surface);
        any = any || named[i][1];
        if (!named[i][0]) {
            rg_warn("%s: cell data '%s' are not the numbers of regions: they name no sets", g->path,
                    g->array[i].name);
        }
    }
    for (size_t i = 0; i < g->arrays; i++) {
        fill_sets(b, &g->array[i], named[i]);
    }
    for (size_t cell = 0; cell < g->cells && !any; cell++) { /* places, though without a name */
        const shape *s = shape_of(b, cell);
        if (s != NULL && !s->solid) {
            add_face(b, cell, RG_IMPORT_UNNAMED);
        }
    }
    rg_free(named);
}

/* ---- the whole ---- */

static void free_grid(rg_vtk_grid *g) {
    for (size_t i = 0; i < g->arrays; i++) {
        rg_free(g->array[i].name);
        rg_free(g->array[i].value);
    }
    rg_free(g->array);
    rg_free(g->x);
    rg_free(g->start);
    rg_free(g->node);
    rg_free(g->type);
}

rg_mesh *rg_vtk_mesh(rg_vtk_grid *g, const rg_import_how *how) {
    building b = {.grid = g, .import = {.path = g->path, .how = *how}};
    take_cells(&b);
    take_sets(&b);
    if (b.left_out > 0) {
        rg_warn("%s: %" PRId64 " cells that are points, lines or no triangles are left out", g->path,
                b.left_out);
    }
    rg_free(b.element);
    free_grid(g);
    return rg_import_finish(&b.import);
}

bool rg_vtk_load(const char *path, char **text, size_t *size) {
    FILE *f = rg_open_input(path);
    if (f == NULL) {
        rg_fatal(RG_USAGE, "%s: cannot be read: %s", path, strerror(errno));
    }
    size_t room = 0, got;
    do {
        *text = rg_grow(*text, &room, *size + (1 << 16), 1);
        got = fread(*text + *size, 1, room - *size - 1, f);
        *size += got;
    } while (got > 0);
    bool whole = ferror(f) == 0;
    fclose(f);
    (*text)[*size] = '\0';
    return whole;
}
