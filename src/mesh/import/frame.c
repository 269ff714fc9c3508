#include "mesh/import/frame.h"

#include <math.h>
#include <string.h>

const rg_frame rg_frame_global = {{0, 0, 0}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

/* ---- vectors ---- */

static void cross(const double a[3], const double b[3], double out[3]) {
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        out[i] = a[j] * b[k] - a[k] * b[j];
    }
}

static bool normalise(double v[3]) {
    double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 3; i++) {
        v[i] /= length;
    }
    return length > 0 && isfinite(length);
}

/* Exact at whole quarter turns. */
static void turn(double degrees, double *cosine, double *sine) {
    static const double exact[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    double quarters = degrees / 90, pi = 3.14159265358979323846;
    if (quarters == nearbyint(quarters)) {
        int quarter = (int)fmod(fmod(quarters, 4) + 4, 4);
        *cosine = exact[quarter][0];
        *sine = exact[quarter][1];
        return;
    }
    *cosine = cos(degrees * (pi / 180));
    *sine = sin(degrees * (pi / 180));
}

/* ---- frames ---- */

bool rg_frame_through(const double a[3], const double b[3], const double *c, rg_frame *frame) {
    double first[3], side[3];
    memcpy(frame->origin, a, sizeof frame->origin);
    for (int i = 0; i < 3; i++) {
        first[i] = b[i] - a[i];
        side[i] = c != NULL ? c[i] - a[i] : 0;
    }
    if (c == NULL) {
        first[2] = 0;
        side[0] = -first[1];
        side[1] = first[0];
    }
    memcpy(frame->axis[0], first, sizeof first);
    cross(first, side, frame->axis[2]);
    bool good = normalise(frame->axis[0]) && normalise(frame->axis[2]);
    cross(frame->axis[2], frame->axis[0], frame->axis[1]);
    return good;
}

/* Rodrigues: a vector v turns to v cos + (n x v) sin + n (n.v) (1 - cos), and a point p about a, after the
 * translation, to a + R (p + by - a). */
bool rg_frame_moved(const double by[3], const double a[3], const double b[3], double angle, rg_frame *frame) {
    double n[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, cosine, sine;
    if (!normalise(n)) {
        return false;
    }
    turn(angle, &cosine, &sine);
    for (int k = 0; k < 3; k++) { /* where unit vector k turns to */
        double unit[3] = {k == 0, k == 1, k == 2}, across[3];
        cross(n, unit, across);
        for (int i = 0; i < 3; i++) {
            frame->axis[k][i] = unit[i] * cosine + across[i] * sine + n[i] * n[k] * (1 - cosine);
        }
    }
    memset(frame->origin, 0, sizeof frame->origin);
    double at[3] = {by[0] - a[0], by[1] - a[1], by[2] - a[2]};
    rg_frame_out(frame, at);
    for (int i = 0; i < 3; i++) {
        frame->origin[i] = at[i] + a[i];
    }
    return true;
}

void rg_frame_out(const rg_frame *frame, double x[3]) {
    double out[3];
    for (int i = 0; i < 3; i++) {
        out[i] = frame->origin[i] +
                 (frame->axis[0][i] * x[0] + frame->axis[1][i] * x[1] + frame->axis[2][i] * x[2]);
    }
    memcpy(x, out, sizeof out);
}

/* ---- polar coordinates ---- */

void rg_from_cylindrical(double x[3]) {
    double cosine, sine, r = x[0];
    turn(x[1], &cosine, &sine);
    x[0] = r * cosine;
    x[1] = r * sine;
}

void rg_from_spherical(double x[3]) {
    double cosine, sine, r = x[0];
    turn(x[2], &cosine, &sine);
    x[2] = r * sine;
    x[0] = r * cosine;
    rg_from_cylindrical(x);
}
