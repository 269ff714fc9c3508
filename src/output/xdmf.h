/* The XDMF description of the field files: the light XML file through which ParaView finds the heavy data.
 * Version 2 syntax, which ParaView's default reader understands. Serial: one rank keeps and writes it. */
#ifndef RG_XDMF_H
#define RG_XDMF_H

#include <stdbool.h>
#include <stdint.h>

#include "output/writer.h"

typedef struct rg_xdmf rg_xdmf;

/* Description of a mesh of `total` 10-node tetrahedra, no frames yet; reals have 4 bytes if `single`, else 8.
 * The caller owns the result. */
rg_xdmf *rg_xdmf_new(int64_t total, bool single);

/* Starts a frame whose volume fields are datasets at the root of `file` ("fields/000000.h5"), and adds
 * fields.
 */
void rg_xdmf_frame(rg_xdmf *x, const char *file, double time);
void rg_xdmf_volume(rg_xdmf *x, const rg_volume_field *field);

/* Gives the frame a crack surface of `triangles`, described in the file's /crack, and adds fields per
 * triangle. Without triangles the frame has no crack grid, since a reader cannot make a grid of nothing. */
void rg_xdmf_surface(rg_xdmf *x, int64_t triangles);
void rg_xdmf_surface_field(rg_xdmf *x, const char *name, int components);

void rg_xdmf_frame_end(rg_xdmf *x);

/* Writes all frames so far to `path`: first to `path`.tmp, which then takes its place. False on failure, with
 * errno set. */
bool rg_xdmf_write(const rg_xdmf *x, const char *path);

/* Bytes of the frames so far: of the body and of its cracks. */
void rg_xdmf_length(const rg_xdmf *x, int64_t *volume, int64_t *crack);

/* Takes the first frames of the file at `path`, as many as have these lengths. False: they are not there. */
bool rg_xdmf_resume(rg_xdmf *x, const char *path, int64_t volume, int64_t crack);

void rg_xdmf_free(rg_xdmf *x);

#endif
