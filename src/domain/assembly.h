/* Assembly: the copies of a shared node move as one (domain/conforming.h).
 *
 * With a diagonal mass the acceleration of a node is sum f / sum m over its copies, which is the mean of the
 * accelerations f/m of the copies, each weighed by its mass: the projection of a field that each element has
 * made for itself onto the continuous ones, orthogonal in the inner product of the mass. Nothing scatters:
 * each tile sums the copies that it holds, by ascending number of their elements, and writes them alone; for
 * a node that other tiles hold too it publishes that sum as a row, and gathers the rows of all of them by
 * ascending number of the tile. So the order of every sum is the mesh's, all copies get the same bits, and
 * they are the same on any ranks and threads. Rows go to all ranks that hold the node, also to those that
 * share no face with this one: one message each. */
#ifndef RG_ASSEMBLY_H
#define RG_ASSEMBLY_H

#include <mpi.h>

#include "domain/halo.h"
#include "domain/conforming.h"
#include "materials.h"

typedef struct rg_assembly rg_assembly;

/* For the HRZ mass of the elements (kernels/element/update.c), of materials material[]. Keeps a reference to
 * `d`. Collective; free with rg_assembly_free. */
rg_assembly *rg_assembly_make(const rg_domain *d, const rg_conforming_faces *j, const rg_material *material,
                              MPI_Comm comm);

/* The mean over the copies, in place, of `field` (laid out as the velocity): first for each tile `sum`, which
 * settles the nodes that it alone holds; then the exchange of rows; then for each tile `gather`, for the
 * others. Threads may do different tiles at once. */
void rg_assembly_sum(rg_assembly *a, size_t tile, rg_real *field);
void rg_assembly_gather(const rg_assembly *a, size_t tile, rg_real *field);

/* Whether `gather` of this tile needs rows of other ranks. */
bool rg_assembly_waits(const rg_assembly *a, size_t tile);
rg_halo *rg_assembly_halo(const rg_assembly *a);

/* All of it. Collective. */
void rg_assembly_mean(rg_assembly *a, rg_real *field);

/* Bits of the nodes of each element: sets each that is set on some copy on all of them. mask[slots]. For the
 * set-up: allocates. Collective. */
void rg_assembly_spread(rg_assembly *a, uint16_t *mask);

/* Nodes that this rank speaks for: of all ranks together, each once. */
size_t rg_assembly_nodes(const rg_assembly *a);

void rg_assembly_free(rg_assembly *a);

#endif
