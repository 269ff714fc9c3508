/* Which faces contact between fragments sees (contact/contact.h): when an interface counts as separated, and
 * when that makes both its sides exposed.
 *
 * Every RG_EXPOSURE_EVERY steps interfaces are looked through; those that have separated count as exposed
 * from the next step on, once all ranks know that there are some. So it depends on the number of the step
 * alone, not on ranks or restarts. An interface has separated once all its points are broken and have been
 * open by what their law asks for full separation. */
#ifndef RG_EXPOSURE_H
#define RG_EXPOSURE_H

#include "solver/solver.h"

enum { RG_EXPOSURE_EVERY = 16 };

/* Marks interfaces that have separated. Returns whether any of this rank wait to be exposed. */
bool rg_exposure_mark(rg_solver *s);

/* Those that wait are newly exposed now; and these, once the others know of them, exposed. */
void rg_exposure_take(rg_solver *s);
void rg_exposure_settle(rg_solver *s);

/* Ends the run with a message if fragments lie in each other. Forces of contact are known. Collective. */
void rg_exposure_refuse_overlap(const rg_solver *s);

#endif
