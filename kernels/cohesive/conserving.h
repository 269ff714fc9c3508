/* Activation `conserving`: a law that starts rigid, inserted so that the energy of the switch adds up.
 *
 * Let T(d), T(0) = sigma_c, be the law's envelope, W(d) the integral of T from 0 to d, and delta the
 * effective opening, counted from the onset eps for the sake of a finite stiffness. Of the largest opening
 * delta_max only d = delta_max - eps counts as damage:
 *     traction    T(d) delta/delta_max, at most sigma_c/eps stiff
 *     dissipated  D(d) = W(d) - T(d) d/2, the law's own at d; dD = (T - d T')/2 dd >= 0
 *     stored      T(d)/2 (delta^2/delta_max - eps), 0 at the switch
 * Where delta = delta_max, stored + D = W(d), whose change is the work T dd; where d stays, the change of
 * stored is T(d) delta/delta_max d delta, the work again. So the ledger closes on every path, and the work of
 * separation is the law's own whatever eps. Stored is negative where delta^2 < eps delta_max: a point pushed
 * back beyond its state at the switch has given more than it took.
 *
 * A point that switches leaves the lift of its elements (Ten Eyck & Lew 2006) and the penalty. What they held
 * by its jump comes free, of which contact takes what it stores at the pressure that it goes on with:
 *     sigma_c g = t . [u] + [u] . Q [u]/2 - (c/2) w_p^2,   c w_p = min(0, t_n);
 * t is the whole DG traction, whether the law goes on with all of it or not, Q the penalty less the lift's
 * own answer to the jump, by RG_LIFT/beta_s of it. The point starts where the law has stored and dissipated
 * just that. A jump along the traction (g > 0) has opened it already, to d_0 with W(d_0) = sigma_c g, delta_0
 * = eps + d_0; one against it leaves it on the way back, at d_0 = 0, delta_0 = sqrt(eps^2 + 2 eps g), at less
 * than the strength. Two clips are left, of which neither loses energy:
 *   g < -eps/2          the point owes more than its onset can hold: it gets one of its own, eps = -2 g
 *   g > W(delta_c)/sigma_c   no law can take it: the rest is booked, as `unresolved`
 * so each point keeps its g. What remains is of the time step: a traction that changes at a switch by Delta t
 * does so half a step late or early, by Delta t . Delta[u]/2, which the first onset and the last step of
 * opening make small where the mesh resolves the cohesive zone.
 *
 * Serves laws that unload to the origin, whose secant falls only while the largest opening grows, and whose
 * envelope of slow opening is sigma_c (1 - d/delta_c) (RG_ENVELOPE): they are asked at d in place of both
 * delta and delta_max, so that to them a point opens and never turns back. A rate is that of d. A law whose
 * secant also falls below the largest opening (RG_FOLLOWS) is asked at delta, knows eps, and stores
 * s (delta^2 - eps^2)/2 by its secant s. */
#ifndef RG_COHESIVE_CONSERVING_H
#define RG_COHESIVE_CONSERVING_H

#include "cohesive/cohesive.h"

/* Lift of the jump at one point of a face between two elements of height h, in (lambda + 2 mu)/h along the
 * normal: 6 w sum_g E_qg^2 = 1.40 and 1.60 at the two kinds of points. */
#define RG_LIFT 1.5

/* d of an opening; never below the floor, so that laws find their secant T(d)/d finite. */
RG_INLINE rg_vec rg_conserving_damage(rg_vec opening, rg_vec onset) {
    return rg_max(opening - onset, rg_splat(RG_OPENING_FLOOR));
}

/* d_0 from g: delta_c (1 - sqrt(1 - 2 g/delta_c)), at most delta_c. */
RG_INLINE rg_vec rg_conserving_first(rg_vec given, rg_vec opening) {
    rg_vec g = rg_min(rg_max(given, rg_splat(RG_OPENING_FLOOR)), 0.5 * opening);
    return 2.0 * g / (1.0 + rg_sqrt(rg_max(1.0 - 2.0 * g / opening, rg_splat(0.0))));
}

/* delta_0 from g and d_0. */
RG_INLINE rg_vec rg_conserving_start(rg_vec given, rg_vec first, rg_vec onset) {
    rg_vec back = rg_max(1.0 + 2.0 * given / onset, rg_splat(0.0));
    return rg_select(given < 0.0, onset * rg_sqrt(back), onset + first);
}

/* Onset of a point of its own: one that owes more than the common onset can take back gets a larger one. */
RG_INLINE rg_vec rg_conserving_onset(rg_vec given, rg_vec onset) {
    return rg_max(onset, rg_splat(-2.0) * given);
}

/* What was set free beyond the work of separation, which no law can take (J per area and strength, m). */
RG_INLINE rg_vec rg_conserving_unresolved(rg_vec given, rg_vec opening) {
    return rg_max(given - 0.5 * opening, rg_splat(0.0));
}

/* From the law's answer at d to that at delta: T(d)/d becomes T(d)/delta_max. */
RG_INLINE void rg_conserving_respond(rg_vec damage, rg_vec onset, rg_law_response *r) {
    rg_vec share = damage / (damage + onset);
    r->normal *= share;
    r->shear *= share;
}

/* From the law's stored energy at d, T(d) d/2, to that at the effective opening delta. */
RG_INLINE void rg_conserving_energy(rg_vec damage, rg_vec onset, rg_vec effective, rg_law_energy *e) {
    e->stored *= (effective * effective / (damage + onset) - onset) / damage;
}

#endif
