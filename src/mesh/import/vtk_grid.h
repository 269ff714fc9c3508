/* An unstructured grid of VTK, whatever file it came in. */
#ifndef RG_VTK_GRID_H
#define RG_VTK_GRID_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "mesh/import/import.h"

/* Values of the cells, one each, by a name. */
typedef struct {
    char *name;
    double *value; /* [cells] */
} rg_vtk_array;

typedef struct {
    const char *path;
    size_t points, cells, nodes;
    double *x;     /* [points][3], in units of the input */
    double *start; /* [cells + 1] where the nodes of each begin in (numbers as the file has them): */
    double *node;  /* [nodes] */
    double *type;  /* [cells] */
    rg_vtk_array *array;
    size_t arrays;
} rg_vtk_grid;

typedef enum { RG_VTK_SIGNED, RG_VTK_UNSIGNED, RG_VTK_FLOAT } rg_vtk_kind;

/* A number of 1 to 8 bytes. */
double rg_vtk_decode(const unsigned char *from, rg_vtk_kind kind, size_t bytes, bool big_endian);

/* Keeps values[cells] of the cells, which may be the numbers of regions; takes them over, and copies the
 * name. Ends the run where that is too long for a set. */
void rg_vtk_add_array(rg_vtk_grid *g, const char *name, double *value);

/* Frees what the grid holds. */
void rg_vtk_free(rg_vtk_grid *g);

/* Makes one grid of pieces, one at least, which it frees with their array. Ends the run where one of them has
 * cell data that the first has not, or the other way round. */
rg_vtk_grid rg_vtk_join(const char *path, rg_vtk_grid *piece, size_t pieces);

/* The mesh, and frees the grid. Cells that vtkGhostType says are those of another piece, or hidden, are left
 * out. Arrays of whole numbers name sets:
 * "array.number" is the volume set of the tetrahedra, and the surface set of the triangles, that have this
 * number. Ends the run where cells are damaged, or solids of another shape. `original` holds the numbers of
 * the cells, from 0 on. */
rg_mesh *rg_vtk_mesh(rg_vtk_grid *g, const rg_import_how *how);

/* Reads a whole file into text[size + 1], which begins as NULL and 0 and ends with a zero byte; the caller
 * frees it. Ends the run with a message (RG_USAGE) if it cannot be opened; false if it cannot be read to its
 * end. */
bool rg_vtk_load(const char *path, char **text, size_t *size);

#endif
