/* Field output: one HDF5 file per run and an XDMF file that ParaView opens. Knows no physics: arrays in, file
 * out. All functions are collective over the communicator; ranks without data take part with count 0. */
#ifndef RG_WRITER_H
#define RG_WRITER_H

#include <mpi.h>
#include <stdint.h>

typedef struct rg_writer rg_writer;

enum rg_center { RG_CENTER_CELL, RG_CENTER_NODE };

/* Creates dir/fields.h5 (replacing an old one) for `total` 10-node tetrahedra. This rank writes elements
 * first .. first + count - 1 of the global order, here and in every later call. x[count][10][3]: node
 * positions (m), nodes in VTK_QUADRATIC_TETRA order, right-handed; each element has its own ten nodes. Ends
 * the run with a message on failure. */
rg_writer *rg_writer_open(const char *dir, MPI_Comm comm, int64_t total, int64_t first, int64_t count,
                          const double *x);

/* Starts the output of one moment. */
void rg_writer_frame(rg_writer *w, int64_t step, double time);

/* Adds a volume field to the current frame: data[count][components] per cell or data[count][10][components]
 * per node; components 1 (scalar), 3 (vector) or 6 (symmetric tensor xx yy zz xy yz xz, XDMF's order is its
 * own affair: the caller gives xx yy zz yz xz xy). `unit` is stored as an attribute. */
void rg_writer_volume(rg_writer *w, const char *name, const char *unit, enum rg_center center, int components,
                      const double *data);

/* Gives the current frame its crack surface: `count` triangles of this rank (any number, also none anywhere),
 * each with its own three points x[count][3][3] (m); then its fields, per triangle: data[count][components].
 */
void rg_writer_surface(rg_writer *w, int64_t count, const double *x);
void rg_writer_surface_field(rg_writer *w, const char *name, const char *unit, int components,
                             const double *data);

/* Ends the frame: flushes the HDF5 file and rewrites dir/fields.xdmf (to a new name, then renamed), so that
 * both can be opened while the run goes on. */
void rg_writer_frame_end(rg_writer *w);

void rg_writer_close(rg_writer *w);

#endif
