/* The cohesive law of a case, and the state in which its faces start. */
#ifndef RG_LAW_H
#define RG_LAW_H

#include "solver/solver.h"

/* Law of the case, its critical opening from strength and energy; of infinite strength where there is none.
 * Strengths and energies that are expressions are, in the law, 1 (Pa, J/m^2): faces have factors of their
 * own then (solver/strength.h). */
rg_cohesive rg_law_make(const rg_case *c);

/* What the law has of a number, or of an expression. */
double rg_law_number(double number, const rg_expr *at);

/* N of the adaptive time step (solver/step_limiter.h); 0: the law has none, or it is not asked for. */
double rg_law_steps(const rg_cohesive *law);

/* Values of crack state, memory and friction of a block of interfaces. */
size_t rg_crack_stride(const rg_cohesive *law);

/* Opening from which on the traction of a law falls, over that of full separation. */
double rg_law_top(const rg_cohesive *law);

/* In the intrinsic form every point follows its law from the start, on the total jump. Faces that the case
 * has open are fully separated. */
void rg_law_start(rg_solver *s);

/* Opens the faces of which the case says that they open by this time. */
void rg_law_open_until(rg_solver *s, double time);

/* Bound on the stiffness of opening and of sliding where the law starts with a slope (Pa/m). */
void rg_law_stiffness(const rg_cohesive *law, double slope[2]);

#endif
