/* Field output: HDF5 files, one of each moment, and an XDMF file that ParaView opens. Knows no physics:
 * arrays in, files out. All functions are collective over the communicator; ranks without data take part with
 * count 0. */
#ifndef RG_WRITER_H
#define RG_WRITER_H

#include <mpi.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct rg_writer rg_writer;

enum rg_center { RG_CENTER_CELL, RG_CENTER_NODE };

/* A field of the volume: its values in the record of a cell, [components] or [10][components], begin at
 * `from`. 1 component: a scalar, 3: a vector, 6: a symmetric tensor xx yy zz yz xz xy (XDMF's order is its
 * own affair). `unit` is stored as an attribute. `exact`: in double precision whatever the style, as numbers
 * of elements want it. */
typedef struct {
    const char *name, *unit;
    enum rg_center center;
    int components;
    size_t from;
    bool exact;
} rg_volume_field;

/* Where the records of this rank's cells come from: window by window, so that nobody needs room for all. */
typedef struct {
    size_t windows; /* the same on all ranks; 1 where the data are compressed: HDF5 1.10 damages a chunk that
                       it compresses a second time */
    size_t cells;   /* of a window, at most */
    size_t values;  /* of a record */
    /* Puts the records of the cells of window k to out[.][values] and returns how many; windows are asked for
     * in turn. Collective. */
    size_t (*get)(void *of, size_t k, double *out);
    void *of;
} rg_cell_source;

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
 * first .. first + count - 1 of the global order, here and in every later call. `x` gives [10][3] positions
 * (m) of each one's own nodes, in VTK_QUADRATIC_TETRA order, right-handed. Ends the run with a message on
 * failure.
 */
rg_writer *rg_writer_open(const char *dir, MPI_Comm comm, rg_writer_style style, int64_t total, int64_t first,
                          int64_t count, const rg_cell_source *x);

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

/* Adds fields of the volume to the current frame, all from the same records. */
void rg_writer_volume(rg_writer *w, size_t fields, const rg_volume_field *field,
                      const rg_cell_source *source);

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
