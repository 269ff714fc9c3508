/* What a mesh file holds, for a person: rhegma mesh --info. */
#ifndef RG_MESH_INFO_H
#define RG_MESH_INFO_H

#include <stdio.h>

#include "mesh/file.h"

/* Prints counts, sets, box, parts, histograms of quality (3 times inradius over circumradius: 1 for the
 * regular tetrahedron, 0 for a flat one) and of dihedral angles, the elements of smallest height, and how
 * many elements there are in each class of the critical time step, by factors of 2. `speed` is that of the
 * fastest wave (m/s), by which a height becomes a time; the step that a run takes is a fraction of it that
 * follows from the spectrum. */
void rg_mesh_info(const rg_mesh *mesh, double speed, FILE *out);

/* Prints the quality of the partitions that the file has. */
void rg_mesh_info_partitions(rg_mesh_file *f, FILE *out);

/* "imbalance ..." in words, to the end of the line; `interfaces` of the whole mesh. */
void rg_quality_print(const rg_partition_quality *q, rg_gid interfaces, FILE *out);

#endif
