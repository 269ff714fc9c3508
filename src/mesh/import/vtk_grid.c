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
#include "mesh/import/import.h"
#include "mesh/rows.h"

/* VTK's numbers of cell types. */
enum { TRIANGLE = 5, TETRAHEDRON = 10, TRIANGLE_2 = 22, TETRAHEDRON_2 = 24 };

/* Points, lines and other surfaces, which are left out. */
static const int flat[] = {0, 1, 2, 3, 4, 6, 7, 8, 9, 21, 23, 28, 30, 34, 35, 36, 68, 69, 70, 75, 76};

typedef struct {
    const rg_vtk_grid *grid;
    rg_import import;
    rg_gid *element; /* [cells]: of the import, -1 for none */
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

static int type_of(const rg_vtk_grid *g, size_t cell) {
    double type = g->type[cell];
    return type >= 0 && type < 256 ? (int)type : -1;
}

/* Corners of the cell: how many nodes it has for us. */
static int nodes_of(int type) {
    return type == TRIANGLE        ? 3
           : type == TRIANGLE_2    ? 6
           : type == TETRAHEDRON   ? 4
           : type == TETRAHEDRON_2 ? 10
                                   : 0;
}

static bool is_flat(int type) {
    for (size_t i = 0; i < sizeof flat / sizeof *flat; i++) {
        if (flat[i] == type) {
            return true;
        }
    }
    return false;
}

/* The nodes of a cell, checked. */
static void take_nodes(const rg_vtk_grid *g, size_t cell, int count, size_t node[10]) {
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
}

static void take_tetrahedron(building *b, size_t cell, int count) {
    size_t node[10];
    take_nodes(b->grid, cell, count, node);
    if (count == 10) { /* the last two middles stand the other way round */
        size_t swap = node[8];
        node[8] = node[9];
        node[9] = swap;
    }
    b->element[cell] = b->import.elements;
    rg_import_element(&b->import, (rg_gid)cell, count, node);
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
        int type = type_of(g, cell), count = nodes_of(type);
        b->element[cell] = -1;
        if (type == TETRAHEDRON || type == TETRAHEDRON_2) {
            take_tetrahedron(b, cell, count);
        } else if (count == 0 && is_flat(type)) {
            b->left_out++;
        } else if (count == 0) {
            first = solids++ == 0 ? cell : first;
        }
    }
    if (solids > 0) {
        rg_fatal(RG_USAGE,
                 "%s: %" PRId64
                 " cells are neither tetrahedra nor flat, the first of them cell %zu of type %d; "
                 "only tetrahedra of first and second order are possible",
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
static bool name_sets(const building *b, const rg_vtk_array *a, bool triangles, rg_sets *sets) {
    const rg_vtk_grid *g = b->grid;
    double *value = RG_NEW(double, g->cells + 1);
    size_t count = 0, kept = 0;
    bool whole = true;
    for (size_t cell = 0; cell < g->cells; cell++) {
        int nodes = nodes_of(type_of(g, cell));
        if (nodes > 0 && (nodes == 3 || nodes == 6) == triangles) {
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
    size_t node[10];
    take_nodes(b->grid, cell, nodes_of(type_of(b->grid, cell)), node);
    rg_import_add_face(&b->import, (rg_import_face){{node[0], node[1], node[2]}, (rg_gid)cell, set});
}

/* `named`: whether the array names sets of volumes, of triangles. */
static void fill_sets(building *b, const rg_vtk_array *a, const bool named[2]) {
    double last[2] = {NAN, NAN};
    int32_t set[2] = {-1, -1};
    for (size_t cell = 0; cell < b->grid->cells; cell++) {
        int nodes = nodes_of(type_of(b->grid, cell));
        bool face = nodes == 3 || nodes == 6;
        if (nodes == 0 || !named[face]) {
            continue;
        }
        if (a->value[cell] != last[face]) { /* mostly it is that of the cell before */
            last[face] = a->value[cell];
            set[face] = set_of(face ? &b->import.surface : &b->import.volume, a, last[face]);
        }
        if (face) {
            add_face(b, cell, set[face]);
        } else {
            rg_import_put(&b->import, b->element[cell], set[face]);
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
        int nodes = nodes_of(type_of(g, cell));
        if (nodes == 3 || nodes == 6) {
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

rg_mesh *rg_vtk_mesh(rg_vtk_grid *g, double scale) {
    building b = {.grid = g, .import = {.path = g->path, .scale = scale}};
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
