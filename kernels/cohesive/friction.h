/* Coulomb friction of closed points, in vectors: an elastic predictor and a return to the cone |t| <= mu p.
 *
 * Slip w is the tangential opening, two components along a frame that turns with the deformed mid-surface, so
 * that a rotation of the body changes nothing. A spring of stiffness k holds it to an anchor a:
 *     trial  r = w - a
 *     stick  e = r                if k |r| <= limit
 *     slide  e = (limit/k) r/|r|  else, and the anchor follows: a = w - e
 * and the traction is k e. An open point has no limit to reach: e = 0, its anchor goes along, and what the
 * spring held is lost. A step dissipates the trapezoid k (e0 + e)/2 . (a - a0), which closes the ledger of a
 * central difference to its own order; it is negative only where the limit falls while slip turns back, and
 * is then left out.
 *
 * Beside contact as a potential p is its normal force, and the springs have the forces that follow from the
 * turn of their frame, too (element/interface_friction.h), so that what sticks keeps its energy however far
 * it has slid.
 *
 * k is the tangential part of the penalty, (beta_s/h_s) mu (isotropic penalty: lambda + 2 mu): a point that
 * sticks is held across as it was while the face was whole.
 * limit = mu D p: p is the pressure of contact, D the damage (largest opening over that of full separation,
 * at most 1). Friction acts on the damaged part of a point alone and grows as cohesion goes: G. Alfano & E.
 * Sacco, Int. J. Numer. Meth. Engng 68 (2006) 542. (There the spring is weighed with D too; here D bounds the
 * traction alone, so that what the spring stores does not change while D grows.) */
#ifndef RG_FRICTION_H
#define RG_FRICTION_H

#include "cohesive/cohesive.h"

#define RG_FORCE_FLOOR 1e-30 /* N: keeps the return finite where no force acts, also in floats */

typedef struct {
    rg_vec slip[2];   /* m */
    rg_vec stiffness; /* k (N/m) */
    rg_vec limit;     /* N */
    rg_vec weight;    /* of the point in its face */
} rg_friction_point;

/* Advances the state; the traction is that of `stretch` (N). */
RG_INLINE void rg_friction_return(const rg_friction_point *p, rg_vec state[RG_FRICTION], rg_vec traction[2]) {
    rg_vec trial[2], gone = {0};
    for (int k = 0; k < 2; k++) {
        trial[k] = p->slip[k] - state[RG_FRICTION_ANCHOR + k];
    }
    rg_vec force = p->stiffness * rg_sqrt(trial[0] * trial[0] + trial[1] * trial[1]);
    rg_vec kept = rg_min(p->limit / rg_max(force, rg_splat(RG_FORCE_FLOOR)), rg_splat(1.0));
    for (int k = 0; k < 2; k++) {
        rg_vec stretch = kept * trial[k];
        gone += (state[RG_FRICTION_STRETCH + k] + stretch) * (trial[k] - stretch);
        state[RG_FRICTION_STRETCH + k] = stretch;
        state[RG_FRICTION_ANCHOR + k] = p->slip[k] - stretch;
        traction[k] = p->stiffness * stretch;
    }
    state[RG_FRICTION_HEAT] += rg_max(0.5 * p->weight * p->stiffness * gone, rg_splat(0.0));
}

/* k |e|^2 / 2, of the whole face (J). */
RG_INLINE rg_vec rg_friction_stored(rg_vec stiffness, const rg_vec stretch[2]) {
    return 0.5 * stiffness * (stretch[0] * stretch[0] + stretch[1] * stretch[1]);
}

#endif
