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
    int type, nodes, corners, dimension;
} shape;

static const shape shapes[] = {{5, 3, 3, 2},   {22, 6, 3, 2}, {10, 4, 4, 3},  {24, 10, 4, 3}, {3, 2, 2, 1},
                               {21, 3, 2, 1},  {8, 4, 4, 2},  {9, 4, 4, 2},   {23, 8, 4, 2},  {28, 9, 4, 2},
                               {30, 6, 4, 2},  {11, 8, 8, 3}, {12, 8, 8, 3},  {25, 20, 8, 3}, {29, 27, 8, 3},
                               {33, 24, 8, 3}, {13, 6, 6, 3}, {26, 15, 6, 3}, {31, 12, 6, 3}, {32, 18, 6, 3},
                               {14, 5, 5, 3},  {27, 13, 5, 3}};
enum { WHOLE = 4, PIXEL = 8, VOXEL = 11, NODES = 27 }; /* the first ones are taken without a cut */
enum { GHOST = -2, DUPLICATE = 1, HIDDEN = 32 }; /* what stands for a cell's type; bits of vtkGhostType */

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
    return type == GHOST ? GHOST : type >= 0 && type < 256 ? (int)type : -1;
}

/* NULL: a cell of another type, or one that is cut, or extruded, where that was not asked for. */
static const shape *shape_of(const building *b, size_t cell) {
    int type = type_of(b->grid, cell);
    bool split = b->import.how.split, extrude = b->import.how.thickness > 0;
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++) {
        if (shapes[i].type == type) {
            int dimension = shapes[i].dimension;
            bool taken = i < WHOLE || (split && dimension > 1) || (extrude && dimension < 3);
            return taken ? &shapes[i] : NULL;
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
        if (s != NULL && s->dimension == 3) {
            take_solid(b, cell, s);
        } else if (s == NULL && is_flat(type_of(g, cell))) {
            b->left_out++;
        } else if (s == NULL && type_of(g, cell) != GHOST) {
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
static bool name_sets(const building *b, const rg_vtk_array *a, int dimension, rg_sets *sets) {
    const rg_vtk_grid *g = b->grid;
    double *value = RG_NEW(double, g->cells + 1);
    size_t count = 0, kept = 0;
    bool whole = true;
    for (size_t cell = 0; cell < g->cells; cell++) {
        const shape *s = shape_of(b, cell);
        if (s != NULL && s->dimension == dimension) {
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

/* A face, or an edge. */
static void add_face(building *b, size_t cell, int32_t set) {
    size_t node[NODES];
    const shape *s = shape_of(b, cell);
    take_nodes(b->grid, cell, s, node);
    if (s->dimension == 1) {
        rg_import_add_edge(&b->import, (rg_import_edge){{node[0], node[1]}, (rg_gid)cell, set});
    } else if (s->corners == 4) {
        rg_import_add_quadrangle(&b->import, node, (rg_gid)cell, set);
    } else {
        rg_import_add_face(&b->import, (rg_import_face){{node[0], node[1], node[2]}, (rg_gid)cell, set});
    }
}

/* Sets of edges, faces and volumes. */
static rg_sets *sets_of(building *b, int dimension) {
    return dimension == 1 ? &b->import.edge_set : dimension == 2 ? &b->import.surface : &b->import.volume;
}

/* `named`: whether the array names sets of edges, of faces, of volumes. */
static void fill_sets(building *b, const rg_vtk_array *a, const bool named[4]) {
    double last[4] = {NAN, NAN, NAN, NAN};
    int32_t set[4] = {-1, -1, -1, -1};
    for (size_t cell = 0; cell < b->grid->cells; cell++) {
        const shape *s = shape_of(b, cell);
        int d = s != NULL ? s->dimension : 0;
        if (!named[d]) {
            continue;
        }
        if (a->value[cell] != last[d]) { /* mostly it is that of the cell before */
            last[d] = a->value[cell];
            set[d] = set_of(sets_of(b, d), a, last[d]);
        }
        if (d < 3) {
            add_face(b, cell, set[d]);
        }
        for (rg_gid e = b->element[cell]; e < b->element[cell + 1]; e++) {
            rg_import_put(&b->import, e, set[d]);
        }
    }
}

static void take_sets(building *b) {
    const rg_vtk_grid *g = b->grid;
    bool(*named)[4] = rg_alloc(g->arrays + 1, sizeof *named), any = false;
    for (size_t i = 0; i < g->arrays; i++) {
        for (int d = 3; d > 0; d--) {
            named[i][d] = name_sets(b, &g->array[i], d, sets_of(b, d));
        }
        any = any || named[i][2];
        if (!named[i][3]) {
            rg_warn("%s: cell data '%s' are not the numbers of regions: they name no sets", g->path,
                    g->array[i].name);
        }
    }
    for (size_t i = 0; i < g->arrays; i++) {
        fill_sets(b, &g->array[i], named[i]);
    }
    for (size_t cell = 0; cell < g->cells && !any; cell++) { /* places, though without a name */
        const shape *s = shape_of(b, cell);
        if (s != NULL && s->dimension == 2) {
            add_face(b, cell, RG_IMPORT_UNNAMED);
        }
    }
    rg_free(named);
}

/* ---- pieces ---- */

static rg_vtk_array *array_of(const rg_vtk_grid *g, const char *name) {
    for (size_t i = 0; i < g->arrays; i++) {
        if (strcmp(g->array[i].name, name) == 0) {
            return &g->array[i];
        }
    }
    return NULL;
}

void rg_vtk_free(rg_vtk_grid *g) {
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

static void copy(double *to, const double *from, size_t count, double add) {
    for (size_t i = 0; i < count; i++) {
        to[i] = from[i] + add;
    }
}

/* Copies a piece behind those that are there already. */
static void put_piece(rg_vtk_grid *all, const rg_vtk_grid *piece) {
    copy(all->x + 3 * all->points, piece->x, 3 * piece->points, 0);
    copy(all->start + all->cells, piece->start, piece->cells + 1, (double)all->nodes);
    copy(all->node + all->nodes, piece->node, piece->nodes, (double)all->points);
    copy(all->type + all->cells, piece->type, piece->cells, 0);
    for (size_t i = 0; i < all->arrays; i++) {
        const rg_vtk_array *a = array_of(piece, all->array[i].name);
        if (a == NULL) {
            rg_fatal(RG_USAGE, "%s: cell data '%s' are not in all of its pieces", all->path,
                     all->array[i].name);
        }
        copy(all->array[i].value + all->cells, a->value, piece->cells, 0);
    }
    all->points += piece->points;
    all->cells += piece->cells;
    all->nodes += piece->nodes;
}

rg_vtk_grid rg_vtk_join(const char *path, rg_vtk_grid *piece, size_t pieces) {
    rg_vtk_grid all = {.path = path};
    size_t points = 0, cells = 0, nodes = 0;
    for (size_t p = 0; p < pieces; p++) {
        points += piece[p].points;
        cells += piece[p].cells;
        nodes += piece[p].nodes;
        for (size_t i = 0; i < piece[p].arrays; i++) {
            if (p > 0 && array_of(&piece[0], piece[p].array[i].name) == NULL) {
                rg_fatal(RG_USAGE, "%s: cell data '%s' are not in all of its pieces", path,
                         piece[p].array[i].name);
            }
        }
    }
    all.x = RG_NEW(double, 3 * points + 1);
    all.start = RG_NEW(double, cells + 1);
    all.node = RG_NEW(double, nodes + 1);
    all.type = RG_NEW(double, cells + 1);
    for (size_t i = 0; i < piece[0].arrays; i++) {
        rg_vtk_add_array(&all, piece[0].array[i].name, RG_NEW(double, cells + 1));
    }
    for (size_t p = 0; p < pieces; p++) {
        put_piece(&all, &piece[p]);
        rg_vtk_free(&piece[p]);
    }
    rg_free(piece);
    return all;
}

/* ---- the whole ---- */

static void leave_out_ghosts(rg_vtk_grid *g) {
    rg_vtk_array *ghost = array_of(g, "vtkGhostType");
    if (ghost == NULL) {
        return;
    }
    for (size_t cell = 0; cell < g->cells; cell++) {
        double bits = ghost->value[cell];
        if (bits >= 0 && bits < 256 && ((int)bits & (DUPLICATE | HIDDEN)) != 0) {
            g->type[cell] = GHOST;
        }
    }
    rg_free(ghost->name);
    rg_free(ghost->value);
    *ghost = g->array[--g->arrays];
}

rg_mesh *rg_vtk_mesh(rg_vtk_grid *g, const rg_import_how *how) {
    leave_out_ghosts(g);
    building b = {.grid = g, .import = {.path = g->path, .how = *how}};
    take_cells(&b);
    take_sets(&b);
    if (b.left_out > 0) {
        rg_warn("%s: %" PRId64 " cells that are points, lines or no triangles are left out", g->path,
                b.left_out);
    }
    rg_free(b.element);
    rg_vtk_free(g);
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
