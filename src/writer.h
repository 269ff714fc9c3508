/* Field output: HDF5 files, one of each moment, and an XDMF file that ParaView opens. Knows no physics:
 * arrays in, files out. All functions are collective over the communicator; ranks without data take part with
 * count 0. */
#ifndef RG_WRITER_H
#define RG_WRITER_H

#include <mpi.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct rg_writer rg_writer;

enum rg_center { RG_CENTER_CELL, RG_CENTER_NODE };

/* How fields lie on the disk. */
typedef struct {
    bool single; /* in single precision, positions too */
    int deflate; /* compression level 1 to 9; 0: none */
} rg_writer_style;

/* Where a writer stands: all that it takes to go on from there. */
typedef struct {
    int64_t frames;        /* finished */
    int64_t volume, crack; /* their bytes in fields.xdmf */
} rg_writer_mark;

/* Creates dir/fields.h5 (replacing an old one) for `total` 10-node tetrahedra. This rank writes elements
 * first .. first + count - 1 of the global order, here and in every later call. x[count][10][3]: node
 * positions (m), nodes in VTK_QUADRATIC_TETRA order, right-handed; each element has its own ten nodes. Ends
 * the run with a message on failure. */
rg_writer *rg_writer_open(const char *dir, MPI_Comm comm, rg_writer_style style, int64_t total, int64_t first,
                          int64_t count, const double *x);

/* Goes on with the files of an earlier run on the same elements, from `mark`: what lies behind that is
 * removed. Ends the run with a message if those files do not reach so far. */
rg_writer *rg_writer_resume(const char *dir, MPI_Comm comm, rg_writer_style style, int64_t total,
                            int64_t first, int64_t count, const rg_writer_mark *mark);

/* Where the writer stands, between two frames. Not collective; the same on all ranks but `volume` and
 * `crack`, which rank 0 knows. */
rg_writer_mark rg_writer_stand(const rg_writer *w);

/* Brings to the disk what was written since the last call. */
void rg_writer_sync(rg_writer *w);

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

/* Ends the frame: its file gets its name, and dir/fields.h5 and dir/fields.xdmf learn of it (each as a new
 * file that takes the place of the old one), so that all can be opened while the run goes on, and are whole
 * whenever it is killed. */
void rg_writer_frame_end(rg_writer *w);

void rg_writer_close(rg_writer *w);

#endif
