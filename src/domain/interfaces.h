/* The interfaces of a domain: one at every interior face inside a tile, two copies of a face between tiles.
 */
#ifndef RG_INTERFACES_H
#define RG_INTERFACES_H

#include "domain/domain.h"

/* Fills all that concerns interfaces in a domain whose elements are in place; element[t] are the elements of
 * tile t, turn[i] the axes of element[0][i] (NULL: none differ), joined[i] bits of the faces of element[0][i]
 * without one (rg_domain_build). */
void rg_interfaces_build(rg_domain *d, const rg_element *const element[], const rg_turn *turn,
                         const uint8_t *joined, int rank, const rg_interface_material *m);

#endif
