/* Rigid motions and coordinate systems in which input gives positions. */
#ifndef RG_FRAME_H
#define RG_FRAME_H

#include <stdbool.h>

/* What is x in the frame is origin + x[0] axis[0] + x[1] axis[1] + x[2] axis[2] outside. */
typedef struct {
    double origin[3], axis[3][3];
} rg_frame;

/* The frame of the input itself. */
extern const rg_frame rg_frame_global;

/* From its origin a, a point b on its first axis and a point c in the plane of the first two, on the side of
 * the second. Without c (NULL) the third axis keeps its direction, and the first is that to b in the plane
 * across it. False: the points are on a line. */
bool rg_frame_through(const double a[3], const double b[3], const double *c, rg_frame *frame);

/* A translation by `by`, then a rotation by `angle` degrees about the axis from a to b, right-handed. False:
 * a and b are the same point. */
bool rg_frame_moved(const double by[3], const double a[3], const double b[3], double angle, rg_frame *frame);

/* x in the frame -> outside, in place. */
void rg_frame_out(const rg_frame *frame, double x[3]);

/* r, theta (degrees from x), z -> x, y, z, in place. */
void rg_from_cylindrical(double x[3]);

/* r, theta (degrees from x about z), phi (degrees from the plane of x and y) -> x, y, z, in place. */
void rg_from_spherical(double x[3]);

#endif
