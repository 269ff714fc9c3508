/* The interfaces of a domain: found from the elements' neighbours, sorted for the sweep, with their geometry.
 */
#ifndef RG_INTERFACES_H
#define RG_INTERFACES_H

#include "domain.h"
#include "gid_map.h"

/* Fills the interface part of `d` and the links of its elements. `slot` gives own and ghost elements. */
void rg_interfaces_build(rg_domain *d, const rg_part *part, int rank, const rg_interface_material *m,
                         const rg_gid_map *slot);

#endif
