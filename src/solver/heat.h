/* Expansion of the materials by the temperature that the case prescribes (kernels/element/bulk.h): e =
 * expansion (T - T_free) at each point of an element. */
#ifndef RG_HEAT_H
#define RG_HEAT_H

#include <stdbool.h>
#include <stddef.h>

struct rg_solver;
typedef struct rg_heating rg_heating;

/* NULL where no temperature is prescribed. Free with rg_heating_free. */
rg_heating *rg_heating_make(const struct rg_solver *s);
void rg_heating_free(rg_heating *h);

/* All elements as they are at t = 0. Ends the run with a message where a temperature is not finite.
 * Collective. */
void rg_heating_start(struct rg_solver *s);

/* The elements of a tile as they are at the time of the solver, unless the temperature stays. In any thread.
 */
void rg_heating_tile(struct rg_solver *s, size_t tile);

/* Mean of an element's points as they are at the time of the solver (K). Something is prescribed; in any
 * thread. */
double rg_heating_temperature(const struct rg_solver *s, size_t slot);

/* Norm of the accelerations that the stress of a held body causes, as rg_initial_stress_scale. Collective. */
double rg_heating_scale(const struct rg_solver *s);

#endif
