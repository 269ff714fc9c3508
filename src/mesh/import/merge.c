#include "mesh/import/merge.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "base/mem.h"
#include "base/union_find.h"
#include "base/vector.h"

struct projected {
    double along; /* a line that no regular mesh is aligned with, so that few nodes share a place on it */
    size_t row;
};

static int by_place(const void *a, const void *b) {
    const struct projected *p = a, *q = b;
    int order = (p->along > q->along) - (p->along < q->along);
    return order != 0 ? order : (p->row > q->row) - (p->row < q->row);
}

rg_merged rg_merge(size_t rows, const double *x, double reach, size_t *twin) {
    static const double line[3] = {0.5257311, 0.6360098, 0.5648217}; /* of length 1 */
    const double rounding = 16 * DBL_EPSILON;
    rg_merged found = {.count = 0};
    struct projected *p = RG_NEW(struct projected, rows + 1);
    size_t count = 0;
    for (size_t n = 0; n < rows; n++) {
        if (twin[n] == n) {
            p[count++] = (struct projected){rg_vector_dot(line, x + 3 * n), n};
        }
    }
    qsort(p, count, sizeof *p, by_place);
    for (size_t i = 0; i + 1 < count; i++) {
        for (size_t j = i + 1; j < count && p[j].along - p[i].along <= reach + rounding * fabs(p[j].along);
             j++) {
            double apart = sqrt(rg_vector_distance2(x + 3 * p[i].row, x + 3 * p[j].row));
            if (apart <= reach) {
                rg_union_join(twin, p[i].row, p[j].row);
                found.farthest = fmax(found.farthest, apart);
            }
        }
    }
    found.first = rows;
    for (size_t i = 0; i < count; i++) {
        bool joined = twin[p[i].row] != p[i].row;
        found.count += joined;
        found.first = joined && p[i].row < found.first ? p[i].row : found.first;
    }
    rg_free(p);
    for (size_t n = 0; n < rows; n++) {
        twin[n] = rg_union_root(twin, n);
    }
    return found;
}
