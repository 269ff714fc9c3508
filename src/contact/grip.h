/* What friction remembers of the pairs that press (kernels/contact/friction.h), from one search to the next
 * and in checkpoints: by the numbers of both faces, whatever ranks have them. */
#ifndef RG_GRIP_LIST_H
#define RG_GRIP_LIST_H

#include "kernels.h"
#include "mesh/mesh.h"

typedef struct {
    rg_gid face[2]; /* the lower number first */
    double value[RG_GRIP];
} rg_grip;

/* By ascending numbers, no two the same. */
typedef struct {
    size_t count, room;
    rg_grip *grip;
} rg_grips;

void rg_grips_clear(rg_grips *g);

/* Adds the grip of a pair, which comes after those before, unless it holds nothing. */
void rg_grips_add(rg_grips *g, rg_gid a, rg_gid b, const double value[RG_GRIP]);

/* The grip of a pair, or nothing; `at` goes on from one pair to the next. */
void rg_grips_find(const rg_grips *g, size_t *at, rg_gid a, rg_gid b, double value[RG_GRIP]);

/* Rows of a checkpoint: each face of a pair has one, with the partner's number and the grip. Back from them:
 * both faces of a pair may bring it; `key` has the faces. */
enum { RG_GRIP_ROW = 1 + RG_GRIP };
void rg_grips_row(rg_gid partner, const double value[RG_GRIP], double row[RG_GRIP_ROW]);
void rg_grips_take(rg_grips *g, size_t rows, const int64_t *key, const double *value);

#endif
