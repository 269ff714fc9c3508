#include "solver/attitude.h"

#include <math.h>

#include "base/principal.h"
#include "base/vector.h"

rg_inertia rg_inertia_make(const double tensor[6]) {
    rg_inertia b;
    rg_principal_axes(tensor, b.moment, b.axis);
    return b;
}

void rg_rotation_join(const double a[4], const double b[4], double out[4]) {
    double cross[3], joined[4];
    rg_vector_cross(a + 1, b + 1, cross);
    joined[0] = a[0] * b[0] - rg_vector_dot(a + 1, b + 1);
    for (int c = 0; c < 3; c++) {
        joined[1 + c] = a[0] * b[1 + c] + b[0] * a[1 + c] + cross[c];
    }
    double length = sqrt(joined[0] * joined[0] + rg_vector_dot(joined + 1, joined + 1));
    for (int c = 0; c < 4; c++) {
        out[c] = joined[c] / length;
    }
}

void rg_rotation_by(const double vector[3], double q[4]) {
    double angle = sqrt(rg_vector_dot(vector, vector)), share = angle > 0 ? sin(0.5 * angle) / angle : 0.5;
    q[0] = cos(0.5 * angle);
    for (int c = 0; c < 3; c++) {
        q[1 + c] = share * vector[c];
    }
}

void rg_rotation_move(const double q[4], const double v[3], double out[3]) {
    double across[3], inward[3]; /* R - 1 = 2 w [n] + 2 [n]^2 */
    rg_vector_cross(q + 1, v, across);
    rg_vector_cross(q + 1, across, inward);
    for (int c = 0; c < 3; c++) {
        out[c] = 2 * (q[0] * across[c] + inward[c]);
    }
}

void rg_rotation_turn(const double q[4], const double v[3], double out[3]) {
    double moved[3];
    rg_rotation_move(q, v, moved);
    for (int c = 0; c < 3; c++) {
        out[c] = v[c] + moved[c];
    }
}

/* Components of v, of space, along the principal axes of a body turned by q. */
static void to_body(const rg_inertia *b, const double q[4], const double v[3], double out[3]) {
    double axis[3];
    for (int k = 0; k < 3; k++) {
        rg_rotation_turn(q, b->axis[k], axis);
        out[k] = rg_vector_dot(axis, v);
    }
}

void rg_inertia_spin(const rg_inertia *b, const double q[4], const double momentum[3], double spin[3]) {
    double along[3], sum[3] = {0, 0, 0};
    to_body(b, q, momentum, along);
    for (int k = 0; k < 3; k++) {
        for (int c = 0; c < 3; c++) {
            sum[c] += along[k] / b->moment[k] * b->axis[k][c];
        }
    }
    rg_rotation_turn(q, sum, spin);
}

/* Turns by `angle` about principal axis k, of the body as it is after `q` then `step`. */
static void turn_about(const rg_inertia *b, int k, double angle, const double q[4], double step[4]) {
    double before[4], axis[3], by[4];
    rg_rotation_join(step, q, before);
    rg_rotation_turn(before, b->axis[k], axis);
    for (int c = 0; c < 3; c++) {
        axis[c] *= angle;
    }
    rg_rotation_by(axis, by);
    rg_rotation_join(by, step, step);
}

/* Angle about principal axis k in `dt`, by what its share of the energy has besides L^2/(2 I2). */
static double angle_about(const rg_inertia *b, int k, double dt, const double q[4], const double step[4],
                          const double momentum[3]) {
    double now[4], along[3];
    rg_rotation_join(step, q, now);
    to_body(b, now, momentum, along);
    return dt * (1 / b->moment[k] - 1 / b->moment[1]) * along[k];
}

void rg_inertia_free(const rg_inertia *b, const double q[4], const double momentum[3], double dt,
                     double step[4]) {
    static const int axis[3] = {0, 2, 0};
    static const double share[3] = {0.5, 1, 0.5};
    double about[3], by[4];
    for (int c = 0; c < 4; c++) {
        step[c] = c == 0;
    }
    for (int i = 0; i < 3; i++) {
        double angle = angle_about(b, axis[i], share[i] * dt, q, step, momentum);
        turn_about(b, axis[i], angle, q, step);
    }
    for (int c = 0; c < 3; c++) {
        about[c] = dt * momentum[c] / b->moment[1];
    }
    rg_rotation_by(about, by);
    rg_rotation_join(by, step, step);
}
