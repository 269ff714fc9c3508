/* Geometry of a straight-sided tetrahedron. */
#ifndef RG_TET_H
#define RG_TET_H

/* Signed volume (m^3) of the tetrahedron with corners a, b, c, d (m): positive if it is right-handed. */
static inline double rg_tet_volume(const double a[3], const double b[3], const double c[3],
                                   const double d[3]) {
    double u[3], v[3], w[3];
    for (int i = 0; i < 3; i++) {
        u[i] = b[i] - a[i];
        v[i] = c[i] - a[i];
        w[i] = d[i] - a[i];
    }
    return (u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) +
            u[2] * (v[0] * w[1] - v[1] * w[0])) /
           6.0;
}

#endif
