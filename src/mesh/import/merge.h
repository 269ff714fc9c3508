/* Nodes that coincide. */
#ifndef RG_MERGE_H
#define RG_MERGE_H

#include <stddef.h>
#include <stdint.h>

typedef struct {
    int64_t count;   /* rows that were joined to another one */
    size_t first;    /* of these, the lowest */
    double farthest; /* the farthest of two that were found within reach (m) */
} rg_merged;

/* Joins rows of x[rows][3] that are no farther than `reach` from one another, also over others in between:
 * twin[row] becomes the lowest row of them. Rows with another twin to begin with are not looked at, but
 * follow it. */
rg_merged rg_merge(size_t rows, const double *x, double reach, size_t *twin);

#endif
