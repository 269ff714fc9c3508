/* The registry of a run's state: all that must outlive the program so that a restart goes on to the same
 * bits.
 *
 * To add state, add one line: to rg_state_of_solver (solver/fields.c) for what the solver holds, to
 * rg_restart_register (restart/restart.c) for what the run holds. Each line says what the values belong to:
 *
 *   RG_OF_ELEMENT   `count` values of every element, in the layout of all fields, [block][count][lane]
 *   RG_OF_FACE      the same of the interfaces, [interface block][count][lane]; kept only for interfaces
 *                   with a broken point, and zero for others after a restart
 *   RG_OF_RUN       `count` values that all ranks agree on (or that only rank 0 uses)
 *
 * and rg_state_add_list takes rows of which only some elements have any, rg_state_add_pool such that come and
 * go. What follows from the case, the mesh
 * or other state needs no line: recompute it in rg_solver_resume. Nothing here depends on ranks or threads: a
 * checkpoint knows values by the numbers of their elements. */
#ifndef RG_STATE_H
#define RG_STATE_H

#include "domain/domain.h"

typedef enum { RG_OF_RUN, RG_OF_ELEMENT, RG_OF_FACE, RG_OF_LIST, RG_OF_POOL } rg_state_of;
typedef enum { RG_STATE_BYTE, RG_STATE_INT64, RG_STATE_REAL, RG_STATE_DOUBLE } rg_state_type;

/* Rows that elements have in any number: [rows] 4 * global number of the element + 0 to 3, [rows][count]. */
typedef struct {
    void *of;
    size_t (*list)(const void *of, int64_t **key,
                   double **value); /* how many there are; the caller frees both */
    void (*take)(void *of, size_t rows, const int64_t *key, const double *value); /* in place of those */
} rg_state_pool;

typedef struct {
    const char *name; /* of its dataset */
    rg_state_of of;
    rg_state_type type;
    int count;
    void *data;
    const int64_t *key; /* of a list: [records] 4 * global number of the element + 0 to 3, no two the same */
    size_t records, stride; /* of a list, or of the run: rows, bytes from one to the next */
    rg_state_pool pool;
} rg_state_array;

enum { RG_MAX_STATE = 64 };

typedef struct rg_state {
    int arrays;
    rg_state_array array[RG_MAX_STATE];
} rg_state;

void rg_state_add(rg_state *st, const char *name, rg_state_of of, rg_state_type type, int count, void *data);

/* Of the run: `rows` rows of `count` values, the first at `data`, the others `stride` bytes apart. */
void rg_state_add_rows(rg_state *st, const char *name, rg_state_type type, int count, void *data,
                       size_t stride, size_t rows);

/* Of elements: rows of `count` values, the first at `data`. Keeps a reference to `key`. */
void rg_state_add_list(rg_state *st, const char *name, rg_state_type type, int count, void *data,
                       size_t stride, size_t records, const int64_t *key);

/* Of elements: rows of `count` doubles that come and go. */
void rg_state_add_pool(rg_state *st, const char *name, int count, rg_state_pool pool);

/* Bytes of all values of one element, face or row. */
size_t rg_state_bytes(const rg_state_array *a);

/* One record of an array out to or in from consecutive values; `i` is the slot, interface or row. */
void rg_state_get(const rg_state_array *a, size_t i, void *out);
void rg_state_put(const rg_state_array *a, size_t i, const void *in);

/* Number by which a checkpoint knows interface i of tile t. */
int64_t rg_face_number(const rg_domain *d, const rg_tile *t, size_t i);

#endif
