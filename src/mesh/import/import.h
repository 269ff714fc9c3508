/* A mesh on its way in, whatever its format: nodes and elements by the input's own numbers, which need not be
 * consecutive. */
#ifndef RG_IMPORT_H
#define RG_IMPORT_H

#include <stdbool.h>
#include <stddef.h>

#include "mesh/gid_map.h"
#include "mesh/mesh.h"

/* A surface face as the input names it. */
typedef struct {
    size_t node[3];
    rg_gid name; /* the input's number for it, for messages */
    int32_t set; /* or RG_IMPORT_UNNAMED */
} rg_import_face;

/* An edge that the input names: a face of the plate that the mesh is to become, else a place that stays. */
typedef struct {
    size_t node[2];
    rg_gid name;
    int32_t set; /* among `edge_set` */
} rg_import_edge;

/* A node of a set of nodes, which stands for the faces of the surface all of whose corners are in it. */
typedef struct {
    size_t node;
    int32_t set; /* among `node_set` */
} rg_import_point;

/* Set of a face that is only known to be a place of its own, not by a name. */
enum { RG_IMPORT_UNNAMED = -1 };

/* What is asked of an import. */
typedef struct {
    double scale;     /* m per unit of the input */
    double merge;     /* nodes as near as this become one (m); 0: none */
    bool split;       /* hexahedra, wedges and pyramids become tetrahedra */
    double thickness; /* flat meshes become plates of this thickness (m); 0: they do not */
    int layers;       /* of elements in it */
} rg_import_how;

typedef struct {
    const char *path; /* begins the messages */
    rg_import_how how;
    size_t nodes;   /* rows below, in the order of the input */
    double *x;      /* [nodes][3] m */
    size_t *number; /* [nodes]: the input's */
    rg_gid_map row; /* of a number, among the first `mapped` rows; numbers may be far apart */
    size_t mapped;
    size_t *twin; /* [mapped]: the row that stands for a row; NULL: each for itself */
    rg_gid elements;
    size_t *corner;  /* [elements][4] rows of nodes */
    rg_gid *name;    /* [elements] numbers */
    int32_t *region; /* [elements] groups of `volume` */
    int32_t *skin;   /* [elements] groups of `surface` that their outer faces are in; NULL: all in none */
    rg_sets surface, volume;
    rg_sets_joining volumes, skins; /* while they are put into sets */
    rg_sets skin_sets;              /* those of `surface` and their combinations */
    int64_t inverted;               /* elements of negative volume */
    rg_gid first_inverted;          /* number of one */
    int64_t middles, bent;          /* mid-nodes, and those off straight */
    double worst;                   /* how far, as a fraction of the edge */
    size_t faces;
    rg_import_face *face;
    rg_sets edge_set; /* sets of edges by their names */
    rg_import_edge *edge;
    size_t edges;
    rg_sets node_set; /* sets of nodes by their names */
    rg_import_point *point;
    size_t points;
    size_t x_room, number_room, corner_room, name_room, region_room, face_room, edge_room, point_room;
} rg_import;

/* Adds a node with coordinates x in units of the input; a number given twice keeps the last. */
void rg_import_node(rg_import *m, size_t number, const double x[3]);

/* Adds a tetrahedron of 4 or 10 nodes (corners, then the middles of edges 01 12 20 30 23 13), whose nodes
 * must be there already; ends the run with a message if they are not. */
void rg_import_element(rg_import *m, rg_gid name, int nodes, const size_t *node);

/* Adds the tetrahedra of a solid with 4, 5, 6 or 8 corners (solid.h), all by its name; returns how many. */
int rg_import_solid(rg_import *m, rg_gid name, int corners, const size_t *node);

/* Puts an element, by its row, into a set of `volume`, once all sets are there. */
void rg_import_put(rg_import *m, rg_gid element, int32_t set);

/* The same of its faces that are on the surface, if any, and a set of `surface`. */
void rg_import_put_skin(rg_import *m, rg_gid element, int32_t set);

void rg_import_add_face(rg_import *m, rg_import_face face);

/* Adds the two triangles of a quadrangle, cut as the solids beside it are. */
void rg_import_add_quadrangle(rg_import *m, const size_t corner[4], rg_gid name, int32_t set);

/* The number of the node that stands for this one, by which solids are cut: its own unless nodes are merged.
 */
size_t rg_import_number(rg_import *m, size_t number);

void rg_import_add_edge(rg_import *m, rg_import_edge edge);
void rg_import_add_point(rg_import *m, size_t node, int32_t set);

/* Position of a node (m), until the next one is added; NULL: there is none of that number. */
const double *rg_import_place(rg_import *m, size_t number);

/* The mesh, neither sorted nor connected, with `original`, `region` and sets; frees the rest. Sets of nodes
 * become surface sets; those without a face, or with the name of another set, are left out. Warns of what is
 * left out or not as it seems; ends the run if there are no elements. */
rg_mesh *rg_import_finish(rg_import *m);

#endif
