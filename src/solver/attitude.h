/* How a rigid body is turned, and how it goes on turning.
 *
 * A rotation is a unit quaternion (cos a/2, sin a/2 n). Without moments the angular momentum L stays, and the
 * body turns by a splitting of its energy (after Dullweber, Leimkuhler & McLachlan 1997), with I1 <= I2 <= I3
 * its principal moments and p = R^T L:
 *     T = L^2/(2 I2) + (1/I1 - 1/I2) p1^2/2 + (1/I3 - 1/I2) p3^2/2.
 * Each part alone turns the body about a line that stays: the first about L, which commutes with the others,
 * these about an axis of the body. In the order 1 3 1 of half, whole and half a step that is a symplectic
 * map that can be run backwards; it keeps L by what it is, is the exact motion of a body with two equal
 * moments, and with three has an error of the energy of order (angle of a step)^2 that does not grow. */
#ifndef RG_ATTITUDE_H
#define RG_ATTITUDE_H

/* Inertia about the centre of mass, in the attitude that q = 1 stands for. */
typedef struct {
    double moment[3];  /* principal, smallest first (kg m^2) */
    double axis[3][3]; /* [principal][component] */
} rg_inertia;

/* From (xx yy zz yz xz xy), as int (r^2 delta - x x) dm has them: products of inertia with their minus. */
rg_inertia rg_inertia_make(const double tensor[6]);

/* out = a b: first b, then a. */
void rg_rotation_join(const double a[4], const double b[4], double out[4]);

/* Rotation by a vector: its length is the angle. */
void rg_rotation_by(const double vector[3], double q[4]);

/* out = R v */
void rg_rotation_turn(const double q[4], const double v[3], double out[3]);

/* out = (R - 1) v, right to rounding also of small angles. */
void rg_rotation_move(const double q[4], const double v[3], double out[3]);

/* Angular velocity of a body turned by q with angular momentum `momentum`, both about its centre of mass. */
void rg_inertia_spin(const rg_inertia *b, const double q[4], const double momentum[3], double spin[3]);

/* The rotation `step`, on top of q, by which the body goes on for `dt`. */
void rg_inertia_free(const rg_inertia *b, const double q[4], const double momentum[3], double dt,
                     double step[4]);

#endif
