/* Geometry of the twin's mesh, straight from its vertices; for both of its files. */
#ifndef STEP_TWIN_GEOMETRY_H
#define STEP_TWIN_GEOMETRY_H

#include <math.h>

#include "reference/reference.h"
#include "support/step_twin.h"

static inline const double *corner(const twin *w, size_t e, int k) {
    return w->mesh->x + 3 * w->mesh->corner[4 * e + (size_t)k];
}

static inline void subtract(const double *a, const double *b, double out[3]) {
    for (int c = 0; c < 3; c++)
        out[c] = a[c] - b[c];
}

/* Reference position of a node. */
static inline void position(const twin *w, size_t e, int node, double x[3]) {
    int i = 0, j = 0;
    for (i = 0; i < 4; i++) {
        for (j = i; j < 4 && rg_edge_node[i][j] != node; j++)
            ;
        if (j < 4)
            break;
    }
    for (int c = 0; c < 3; c++)
        x[c] = (corner(w, e, i)[c] + corner(w, e, j)[c]) / 2;
}

static inline double volume_of(const twin *w, size_t e) {
    double a[3], b[3], c[3], n[3];
    subtract(corner(w, e, 1), corner(w, e, 0), a);
    subtract(corner(w, e, 2), corner(w, e, 0), b);
    subtract(corner(w, e, 3), corner(w, e, 0), c);
    rg_reference_cross(a, b, n);
    return fabs(rg_reference_dot(n, c)) / 6;
}

/* Area vector of a face by its corners in the order of their numbers; its length is returned. */
static inline double area_vector(const twin *w, size_t e, int f, double edge[2][3], double area[3]) {
    for (int k = 0; k < 2; k++)
        subtract(corner(w, e, rg_face_node[f][k + 1]), corner(w, e, rg_face_node[f][0]), edge[k]);
    rg_reference_cross(edge[0], edge[1], area);
    for (int c = 0; c < 3; c++)
        area[c] /= 2;
    return sqrt(rg_reference_dot(area, area));
}

/* A value of the case at the middle of a face, which may depend on its normal. */
static inline bool selects(const twin *w, const rg_expr *e, size_t element, int f) {
    double edge[2][3], normal[3], middle[3] = {0, 0, 0};
    double area = area_vector(w, element, f, edge, normal);
    for (int c = 0; c < 3; c++) {
        normal[c] /= area;
        for (int k = 0; k < 3; k++)
            middle[c] += corner(w, element, rg_face_node[f][k])[c] / 3;
    }
    return rg_expr_face_value(e, middle, normal) != 0;
}

/* The lower number of each pair of elements speaks for their face. */
static inline bool speaks(const twin *w, size_t e, int f) {
    return w->mesh->neighbour[4 * e + (size_t)f] > (rg_gid)e;
}

static inline double body_velocity(const rg_body_input *in, int c, double time) {
    const double nowhere[3] = {0, 0, 0};
    return in->velocity[c] == NULL ? 0 : rg_expr_value(in->velocity[c], nowhere, time);
}

#endif
