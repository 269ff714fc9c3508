#include "diagnostics/crack_surface.h"

#include <math.h>

#include "base/mem.h"
#include "quadrature.h"
#include "solver/tile.h"

double rg_damage(const rg_solver *s, size_t i, int q) {
    if (!(s->broken[i] >> q & 1)) {
        return 0;
    }
    return fmin(1, *rg_crack_value(s, i, q, RG_CRACK_OPENING) / rg_separation(s, i, q));
}

static void corners(const rg_solver *s, const rg_tile *t, size_t i, double x[3][3]) {
    int32_t link = s->domain->side[0][i];
    const double *corner = s->domain->corner + 12 * (t->begin * RG_LANES + (size_t)link / RG_FACES);
    for (int a = 0; a < RG_FCORNERS; a++) {
        for (int c = 0; c < 3; c++) {
            double mean = 0.5 * (rg_tile_trace(s, t, i, 0, a, c) + rg_tile_trace(s, t, i, 1, a, c));
            x[a][c] = corner[3 * rg_face_node[link % RG_FACES][a] + c] + mean;
        }
    }
}

/* The mean of a quadratic over a triangle is the mean of its mid-edge values. */
static void mean_jump(const rg_solver *s, const rg_tile *t, size_t i, double jump[3]) {
    for (int c = 0; c < 3; c++) {
        jump[c] = 0;
        for (int a = RG_FCORNERS; a < RG_FNODES; a++) {
            jump[c] += (rg_tile_trace(s, t, i, 1, a, c) - rg_tile_trace(s, t, i, 0, a, c)) / 3;
        }
    }
}

/* Unit normal of a triangle, on the side of `along`. */
static void unit_normal(double x[3][3], const double along[3], double n[3]) {
    double a[3], b[3], norm = 0, side = 0;
    for (int c = 0; c < 3; c++) {
        a[c] = x[1][c] - x[0][c];
        b[c] = x[2][c] - x[0][c];
    }
    for (int c = 0; c < 3; c++) {
        int p = (c + 1) % 3, q = (c + 2) % 3;
        n[c] = a[p] * b[q] - a[q] * b[p];
        norm += n[c] * n[c];
        side += n[c] * along[c];
    }
    for (int c = 0; c < 3; c++) {
        n[c] *= (side < 0 ? -1 : 1) / sqrt(norm);
    }
}

static rg_crack_face crack_face(const rg_solver *s, const rg_tile *t, size_t i) {
    static const double weight[2] = {RG_TRI_W0, RG_TRI_W1};
    rg_crack_face f = {.time = INFINITY};
    double jump[3], n[3], reference[3], square = 0;
    corners(s, t, i, f.x);
    mean_jump(s, t, i, jump);
    rg_interface_area(s->domain, i, reference);
    unit_normal(f.x, reference, n);
    for (int c = 0; c < 3; c++) {
        f.opening += jump[c] * n[c];
        square += jump[c] * jump[c];
    }
    f.slip = sqrt(fmax(0, square - f.opening * f.opening));
    for (int q = 0; q < RG_POINTS; q++) {
        f.damage += weight[q / 3] * rg_damage(s, i, q);
        if (rg_point_is_broken(s, i, q)) {
            f.time = fmin(f.time, *rg_crack_value(s, i, q, RG_CRACK_TIME));
        }
    }
    return f;
}

size_t rg_crack_surface(const rg_solver *s, rg_crack_face **faces) {
    const rg_domain *d = s->domain;
    size_t count = 0;
    for (size_t i = 0; i < d->iblocks * RG_LANES; i++) {
        count += d->counted[i] && rg_face_is_broken(s, i);
    }
    *faces = RG_NEW(rg_crack_face, count);
    size_t n = 0;
    for (size_t t = 0; t < d->tiles; t++) {
        for (size_t i = d->tile[t].ibegin * RG_LANES; i < d->tile[t].iend * RG_LANES; i++) {
            if (d->counted[i] && rg_face_is_broken(s, i)) {
                (*faces)[n++] = crack_face(s, &d->tile[t], i);
            }
        }
    }
    return count;
}
