/* What Abaqus input says of a mesh, before it becomes one: nodes, elements, sets and surfaces, by the numbers
 * and names of the input. A part is such a model; so is the assembly, to which every instance of a part adds
 * a copy with its own scope. Sets may name what comes later: members are found when they are asked for. */
#ifndef RG_INP_MODEL_H
#define RG_INP_MODEL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "mesh/gid_map.h"
#include "mesh/import/frame.h"
#include "mesh/import/inp_line.h"
#include "mesh/rows.h"

/* Rows that have numbers, each once. */
typedef struct {
    size_t count, room;
    rg_gid *number; /* [count] */
    rg_gid_map map;
    size_t map_room;
    rg_gid most; /* the largest number */
} rg_inp_rows;

/* Row of a number, SIZE_MAX if there is none. */
size_t rg_inp_row(const rg_inp_rows *rows, rg_gid number);

typedef enum { RG_INP_NODES, RG_INP_ELEMENTS } rg_inp_of;

/* Some members of a set. */
typedef struct {
    rg_gid from, to,
        step; /* these numbers; or, where `name` is not NULL, all members of the set so called: */
    char *name;
    int scope;
    bool corners; /* of a set of nodes: the nodes of a set of elements */
    bool listed;  /* one by one, so that each should be there */
    rg_inp_place at;
} rg_inp_entry;

typedef struct {
    char name[RG_SET_NAME];
    rg_inp_of of;
    int scope;
    bool unsorted, internal; /* internal: the preprocessor made it, for a surface */
    rg_inp_place at;         /* where it begins */
    rg_inp_entry *entry;
    size_t count, room;
    size_t seen; /* by which search */
} rg_inp_set;

/* Faces of a surface. */
enum { RG_INP_FREE = -1, RG_INP_SIDE = 6 }; /* those that no other element has; the triangle itself */

typedef struct {
    rg_inp_entry of; /* elements, or of a surface of nodes: nodes */
    int face;        /* 0 to 5: S1 to S6; or one of the above */
} rg_inp_patch;

typedef struct {
    char name[RG_SET_NAME];
    rg_inp_of of;
    int scope;
    rg_inp_patch *patch;
    size_t count, room;
} rg_inp_surface;

/* Added to the numbers of what stands in the assembly itself, in no instance: reference points, masses. No
 * node or element of the mesh has such. */
#define RG_INP_OUTSIDE (INT64_C(1) << 40)

/* What holds an instance's own names and numbers apart. Scope 0: what is in none. */
typedef struct {
    char name[RG_SET_NAME];
    rg_gid nodes, elements; /* added to its numbers */
} rg_inp_scope;

typedef struct {
    rg_inp_rows nodes;
    double *x; /* [nodes][3], in units of the input */
    size_t x_room;
    rg_inp_rows elements;
    int8_t *kind; /* [elements] nodes: 4, 10: a tetrahedron; 3: a triangle; 2: a line; RG_INP_CORNERS_4; 5, 6,
                     8: to be split; 0: left out */
    size_t *start; /* [elements] where its nodes begin in: */
    uint32_t *node;
    size_t kind_room, start_room, node_room, node_count;
    rg_inp_set *set;
    size_t sets, set_room;
    rg_inp_surface *surface;
    size_t surfaces;
    rg_inp_scope *scope;
    int scopes;
    size_t search;   /* how many there were */
    size_t *seen[2]; /* by which search a node or element was found */
    size_t seen_room[2];
    int64_t moved;    /* nodes that were given again at another place */
    rg_gid generated; /* nodes and elements that generators made */
} rg_inp_model;

/* An empty one with scope 0. */
rg_inp_model *rg_inp_model_make(void);
void rg_inp_model_free(rg_inp_model *m);

/* Adds a node; one that is there already moves. */
void rg_inp_add_node(rg_inp_model *m, rg_gid number, const double x[3]);

/* What is kept of a quadrangle: its corners, the last one 3 times more, so that no solid has as many nodes.
 */
enum { RG_INP_CORNERS_4 = 7 };

/* Adds an element of `kind` with its first `kind` nodes. False: its number is taken. */
bool rg_inp_add_element(rg_inp_model *m, rg_gid number, int kind, const rg_gid node[]);

/* The set of this name, a new one if need be. The pointer holds until the next set is made. */
rg_inp_set *rg_inp_need_set(rg_inp_model *m, rg_inp_of of, const char *name, int scope, rg_inp_place at);
rg_inp_set *rg_inp_find_set(const rg_inp_model *m, rg_inp_of of, const char *name, int scope);
rg_inp_surface *rg_inp_need_surface(rg_inp_model *m, const char *name, rg_inp_of of, int scope);

/* Adds an entry, taking over its name. */
void rg_inp_add_entry(rg_inp_set *s, rg_inp_entry entry);
void rg_inp_add_number(rg_inp_set *s, rg_gid number, bool listed, rg_inp_place at);
void rg_inp_add_patch(rg_inp_surface *s, rg_inp_patch patch);

char *rg_inp_copy_text(const char *text);

typedef struct {
    size_t *row; /* ascending by number, or in the order of the input where the set is unsorted */
    size_t count, room;
    int64_t missing; /* listed, but not there */
    rg_gid first;    /* of these */
} rg_inp_members;

/* Rows of all nodes or elements of a set or of one entry, each once. Ends the run where a set is named that
 * is not there. The caller frees `row`. */
rg_inp_members rg_inp_members_of_set(rg_inp_model *m, const rg_inp_set *s);
rg_inp_members rg_inp_members_of_entry(rg_inp_model *m, rg_inp_of of, const rg_inp_entry *e);

/* Adds a copy of a part, moved by `frame`, as a new scope called `name`, whose numbers are clear of those
 * that are there. Returns the scope. */
int rg_inp_add_instance(rg_inp_model *m, const rg_inp_model *part, const char *name, const rg_frame *frame,
                        rg_inp_place at);

#endif
