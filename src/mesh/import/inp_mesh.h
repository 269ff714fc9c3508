/* From what Abaqus input says to a mesh. */
#ifndef RG_INP_MESH_H
#define RG_INP_MESH_H

#include "mesh/import/inp_model.h"
#include "mesh/mesh.h"

/* The mesh of the model; lengths times `scale` in m. `path` begins the messages. */
rg_mesh *rg_inp_mesh(const char *path, double scale, rg_inp_model *model);

#endif
