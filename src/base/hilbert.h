/* Hilbert curve through three-dimensional space: points near each other on the curve are near each other. */
#ifndef RG_HILBERT_H
#define RG_HILBERT_H

#include <stdint.h>

enum { RG_HILBERT_BITS = 21 }; /* per axis: three axes fill 63 bits */

/* Index on the curve, below 2^63, of the cell with coordinates cell[3], each below 2^RG_HILBERT_BITS. */
uint64_t rg_hilbert_cell(const uint32_t cell[3]);

/* Index on the curve of point x in the cube with lower corner `low` and edge `edge` > 0 (m); points outside
 * the cube count as on its surface. The cube must be the same for all points that are compared. */
uint64_t rg_hilbert_point(const double x[3], const double low[3], double edge);

#endif
