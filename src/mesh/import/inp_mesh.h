/* From what Abaqus input says to a mesh. */
#ifndef RG_INP_MESH_H
#define RG_INP_MESH_H

#include "mesh/import/import.h"
#include "mesh/import/inp_model.h"

/* The mesh of the model. `path` begins the messages. */
rg_mesh *rg_inp_mesh(const char *path, const rg_import_how *how, rg_inp_model *model);

#endif
