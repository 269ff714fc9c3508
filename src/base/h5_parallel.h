/* An HDF5 file that all ranks write together, dataset by dataset, each rank its rows.
 *
 * A file comes into being as path.part, is read back as it is written, and gets its name when it is complete:
 * what has the name is whole, whenever the program was killed. A rank's share of a dataset is one contiguous
 * slab, so it writes that by itself. Collective transfers would gain nothing, and where one rank fails to
 * write (a full disk) they hang: HDF5 1.10 leaves that rank out of the collective call that follows.
 * Compressed datasets need them; for these, and for HDF5's own metadata, room on the disk is reserved before,
 * where the file system can. OMPIO, the MPI-IO that Open MPI picks by itself, is reported to corrupt
 * collective writes (HDFGroup/hdf5#1227; its ROMIO component is not), hence every rank reads its slab back
 * and compares: most often a copy from the page cache. All functions are collective unless they say
 * otherwise; ranks without rows take part. A failure on any rank ends the run with one message, and removes
 * path.part: at once for compressed datasets, else when the file is closed. */
#ifndef RG_H5_PARALLEL_H
#define RG_H5_PARALLEL_H

#include <hdf5.h>
#include <mpi.h>
#include <stdbool.h>
#include <stdint.h>

#include "base/h5_reason.h"

enum { RG_H5_GROUP = 48 }; /* length of the longest group name */

typedef struct {
    MPI_Comm comm;
    int rank;
    char *path, *part; /* the name it will have, and the one it has until it is whole */
    const char *shown; /* what messages call it: `path`, or the name of what it belongs to */
    hid_t file;
    int disk;                        /* the same file for the system's own calls; -1: open for reading */
    int64_t reserved;                /* bytes of the file that have their place on the disk */
    char group[RG_H5_GROUP];         /* in which datasets are made now, for messages */
    char reason[RG_H5_REASON];       /* why the first HDF5 call that failed did so */
    char failure[RG_H5_GROUP + 100]; /* what failed first on this rank, as "verb object"; empty: nothing */
} rg_h5_file;

/* Rows [first, first + count) of `rows` are this rank's. */
typedef struct {
    const char *name;
    hid_t type; /* in memory and in the file: collective transfers into chunks cannot convert */
    int columns;
    int64_t rows, first, count;
    int deflate; /* compression level; 0: none */
} rg_h5_slab;

/* dir/name; the caller frees it. Not collective. */
char *rg_join_path(const char *dir, const char *name);

/* Creates the file; `room` bytes in front of HDF5's (0 or a power of 2 from 512) are the caller's. */
void rg_h5_create(rg_h5_file *f, const char *path, hsize_t room, MPI_Comm comm);

/* Opens a file for reading; the reason why not is in f->reason (all ranks return the same). */
bool rg_h5_open(rg_h5_file *f, const char *path, MPI_Comm comm);

/* Whether `ok` holds on all ranks: asked before what one rank alone must not leave out. */
bool rg_h5_all(MPI_Comm comm, bool ok);

/* Notes a failure on this rank unless `ok`, the first one: "cannot verb object: reason". `what` NULL: the
 * current group. The rank goes on taking part in what is collective until all agree. Not collective: on
 * thousands of ranks, or where ranks share cores, every agreement costs more than a small dataset. */
void rg_h5_note(rg_h5_file *f, bool ok, const char *verb, const char *what);

/* Goes on if no rank has noted a failure; else the lowest one that has ends the run, so that a failure common
 * to all is reported once. Also a barrier. rg_h5_close begins with it. */
void rg_h5_agree(const rg_h5_file *f);

/* The same for a failure that is known at once, of any file, with a reason of its own. */
void rg_h5_agree_on(const rg_h5_file *f, bool ok, const char *path, const char *verb, const char *reason);

/* Creates a group, which becomes the current one. The caller closes it. */
hid_t rg_h5_group(rg_h5_file *f, const char *name);

/* Attributes; not checked for agreement. */
bool rg_h5_put_attribute(hid_t object, const char *name, hid_t type, const void *value);
bool rg_h5_put_text(hid_t object, const char *name, const char *value);

/* Creates a dataset with its attributes (`unit` NULL: none) for rg_h5_put. The caller closes it. */
hid_t rg_h5_begin(rg_h5_file *f, hid_t place, const rg_h5_slab *s, const char *unit);

/* Writes rows [s->first, s->first + s->count) of a dataset that is not compressed, and reads them back. */
void rg_h5_put(rg_h5_file *f, hid_t dataset, const rg_h5_slab *s, const void *data);

/* Asks the system to bring what this rank has put so far to the disk, and does not wait for it: rg_h5_finish
 * then finds it half done. Not collective. */
void rg_h5_start_sync(const rg_h5_file *f);

/* Writes a whole dataset with its attributes and reads it back. */
void rg_h5_write(rg_h5_file *f, hid_t place, const rg_h5_slab *s, const char *unit, const void *data);

/* Reads this rank's rows of a dataset that must have s->rows and s->columns; whether it went well, here. */
bool rg_h5_read(hid_t place, const rg_h5_slab *s, void *data);

/* Closes the file and leaves it under the name path.part. */
void rg_h5_close(rg_h5_file *f);

/* Brings the closed file to the disk where `sync`, gives it its name, and frees what f holds. */
void rg_h5_finish(rg_h5_file *f, bool sync);

/* Closes a file that was opened for reading. */
void rg_h5_close_read(rg_h5_file *f);

#endif
