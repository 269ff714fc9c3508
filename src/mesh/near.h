/* Boxes of different parts that meet. */
#ifndef RG_MESH_NEAR_H
#define RG_MESH_NEAR_H

#include <stdint.h>

typedef struct {
    double low[3], high[3];
    int32_t part;
} rg_near_box;

/* Calls visit(context, i, j) once for each two of box[count] of different parts that meet, the one of the
 * lower part first, in an order that follows from the boxes alone. */
void rg_near_pairs(const rg_near_box *box, int64_t count, void (*visit)(void *context, int64_t i, int64_t j),
                   void *context);

#endif
