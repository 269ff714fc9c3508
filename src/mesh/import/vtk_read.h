/* Meshes from VTK files. */
#ifndef RG_VTK_READ_H
#define RG_VTK_READ_H

#include "mesh/import/import.h"

/* Reads an unstructured grid of a legacy file (.vtk; text or binary, versions 1 to 5.1); cells and sets as in
 * rg_vtk_mesh. The caller frees it. */
rg_mesh *rg_vtk_read(const char *path, const rg_import_how *how);

/* The same of an XML file (.vtu, or .pvtu, which names others) of any pieces: text, base64 or appended,
 * compressed by zlib, LZ4 or LZMA or not. */
rg_mesh *rg_vtu_read(const char *path, const rg_import_how *how);

#endif
