/* Meshes from Abaqus input files. */
#ifndef RG_INP_READ_H
#define RG_INP_READ_H

#include "mesh/mesh.h"

/* Reads the mesh of an Abaqus input file, with lengths times `scale` in m: *NODE; *ELEMENT with types C3D4
 * and C3D10 (and variants: C3D10M, C3D10HS, ...); triangles (S3, STRI65, CPS6, SFM3D3, ...), which only name
 * faces; *ELSET; *SURFACE, TYPE=ELEMENT.
 *
 * Volume sets: the ELSETs of *SOLID SECTION; where there is no such line, those of *ELSET, and for elements
 * in none of these the ELSET of their *ELEMENT line. Surface sets: every *SURFACE, and the ELSETs of
 * triangles, chosen like those of volumes. An element or face in two sets ends the run. One part, in its own
 * coordinates: a second *PART or a moved *INSTANCE ends the run, as do other solid elements. The result is
 * neither sorted nor connected; `original` holds the file's element numbers. The caller frees it. */
rg_mesh *rg_inp_read(const char *path, double scale);

#endif
