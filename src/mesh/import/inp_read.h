/* Meshes from Abaqus and CalculiX input files. */
#ifndef RG_INP_READ_H
#define RG_INP_READ_H

#include <stdio.h>

#include "mesh/import/import.h"

/* Reads the mesh of an input file, or of the stream `in` that messages call so, which it closes, as the
 * manuals define it: nodes and elements, given (*NODE, *ELEMENT, in local systems) and generated (*NGEN,
 * *NFILL, *ELGEN, *ELCOPY), in one body or in parts that instances place, in one file or several. Elements
 * are tetrahedra of any physics, with `split` those too that hexahedra, wedges and pyramids are cut into
 * (solid.h), by their numbers; triangles (S3, CPS6, SFM3D3, ...) and with `split` quadrangles only name
 * faces.
 *
 * Volume sets are all sets of elements, surface sets all surfaces, sets of triangles, and sets of nodes that
 * hold whole faces; they may overlap. Sets that the preprocessor made for its own use (INTERNAL) are none.
 * With several instances the sets of each are called "instance.set".
 *
 * What is not read either has no influence on the mesh, and `out` gets a line with its number, or is left out
 * with a warning (elements that are no solids), or ends the run: other solids, keywords and parameters that
 * are not known here. The result is neither sorted nor connected; `original` holds the file's element
 * numbers, in later instances plus a multiple of a power of ten. The caller frees it. */
rg_mesh *rg_inp_read(const char *path, FILE *in, const rg_import_how *how, FILE *out);

#endif
