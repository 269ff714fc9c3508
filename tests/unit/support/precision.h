/* What rounding may do to a kernel's result, relative to the largest value of its kind, by the precision of
 * the build. It is far more than a unit of rounding because the input goes to the limits: the body is turned
 * by 2 rad, so that displacements of an edge's length cancel to strains of per cents and openings of a
 * thousandth of an edge. */
#ifndef RG_TEST_PRECISION_H
#define RG_TEST_PRECISION_H

#include "layout.h"

#ifdef RG_SINGLE
#define TOLERANCE 1e-4
#else
#define TOLERANCE 7e-12
#endif

#endif
