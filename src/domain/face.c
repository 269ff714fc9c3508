#include "domain/face.h"

#include <math.h>

#include "base/vector.h"

bool rg_surface_has(const rg_domain *d, size_t slot, int face) {
    return d->id[slot] >= 0 && d->interface[rg_link_index(slot, face)] == RG_NO_INTERFACE;
}

double rg_surface_area(const double *corner, int face, double normal[3]) {
    const int *node = rg_face_node[face];
    double edge[2][3], up[3];
    rg_vector_subtract(corner + 3 * node[1], corner + 3 * node[0], edge[0]);
    rg_vector_subtract(corner + 3 * node[2], corner + 3 * node[0], edge[1]);
    rg_vector_subtract(corner + 3 * face, corner + 3 * node[0], up); /* the corner opposite to the face */
    rg_vector_cross(edge[0], edge[1], normal);
    double length = sqrt(rg_vector_dot(normal, normal)), out = rg_vector_dot(normal, up) > 0 ? -1 : 1;
    for (int c = 0; c < 3; c++) {
        normal[c] *= out / length;
    }
    return 0.5 * length;
}

double rg_surface_height(const rg_domain *d, size_t slot, int face) {
    double normal[3];
    return 3 * (double)d->geom[rg_geom_index(slot, RG_GEOM_VOLUME)] /
           rg_surface_area(d->corner + 12 * slot, face, normal);
}
