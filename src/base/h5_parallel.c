#define _GNU_SOURCE /* fallocate, sync_file_range */
#include "base/h5_parallel.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include "base/error.h"
#include "base/files.h"
#include "base/mem.h"

#define LITTLE_ROOM 1e6 /* bytes */

enum {
    VERIFY_BYTES = 1 << 20,   /* read back at a time */
    CHUNK_BYTES = 1 << 18,    /* compressed at a time */
    METADATA_BYTES = 1 << 13, /* reserved for what HDF5 itself writes about a dataset */
};

char *rg_join_path(const char *dir, const char *name) {
    size_t size = strlen(dir) + strlen(name) + 2;
    char *path = rg_realloc(NULL, size, 1);
    snprintf(path, size, "%s/%s", dir, name);
    return path;
}

/* Whether the disk that holds `path` has hardly any room left. */
static bool disk_full(const char *path) {
    char folder[4096];
    struct statvfs disk;
    snprintf(folder, sizeof folder, "%s", path);
    char *slash = strrchr(folder, '/');
    if (slash != NULL) {
        *slash = '\0';
    }
    return statvfs(slash != NULL ? folder : ".", &disk) == 0 &&
           (double)disk.f_bavail * (double)disk.f_frsize < LITTLE_ROOM;
}

void rg_h5_agree_on(const rg_h5_file *f, bool ok, const char *path, const char *verb, const char *reason) {
    int mine = ok ? INT_MAX : f->rank, failed = INT_MAX;
    MPI_Allreduce(&mine, &failed, 1, MPI_INT, MPI_MIN, f->comm);
    if (failed == f->rank) {
        bool full = disk_full(path); /* MPI-IO does not tell */
        if (f->part != NULL) {
            unlink(f->part);
        }
        rg_fatal(RG_FAILURE, "%s: cannot %s: %s%s", path, verb, reason, full ? " (the disk is full)" : "");
    }
    if (failed != INT_MAX) {
        MPI_Barrier(f->comm); /* until the failed rank ends the job */
    }
}

void rg_h5_note(rg_h5_file *f, bool ok, const char *verb, const char *what) {
    if (!ok && f->failure[0] == '\0') {
        snprintf(f->failure, sizeof f->failure, "%s %s%s%s", verb, f->group, what != NULL ? "/" : "",
                 what != NULL ? what : "");
    }
}

void rg_h5_agree(const rg_h5_file *f) {
    bool known = f->reason[0] != '\0';
    rg_h5_agree_on(f, f->failure[0] == '\0', f->shown, f->failure,
                   known ? f->reason : "it does not hold what was written (faulty MPI-IO?)");
}

/* ---- attributes ---- */

bool rg_h5_put_attribute(hid_t object, const char *name, hid_t type, const void *value) {
    hid_t space = H5Screate(H5S_SCALAR);
    hid_t attribute = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    bool ok = attribute >= 0 && H5Awrite(attribute, type, value) >= 0;
    ok = H5Aclose(attribute) >= 0 && ok;
    H5Sclose(space);
    return ok;
}

bool rg_h5_put_text(hid_t object, const char *name, const char *value) {
    hid_t type = H5Tcopy(H5T_C_S1);
    bool ok = H5Tset_size(type, strlen(value) + 1) >= 0 && rg_h5_put_attribute(object, name, type, value);
    H5Tclose(type);
    return ok;
}

/* ---- groups and datasets ---- */

hid_t rg_h5_group(rg_h5_file *f, const char *name) {
    snprintf(f->group, sizeof f->group, "/%s", name);
    hid_t plan = H5Pcreate(H5P_GROUP_CREATE);
    H5Pset_obj_track_times(plan, false); /* the same data are the same file */
    hid_t group = H5Gcreate2(f->file, name, H5P_DEFAULT, plan, H5P_DEFAULT);
    H5Pclose(plan);
    rg_h5_note(f, group >= 0, "create", NULL);
    return group;
}

/* Filters want chunks: pieces of rows, none larger than the dataset. */
static void compress(hid_t plan, const rg_h5_slab *s) {
    hsize_t rows = CHUNK_BYTES / (H5Tget_size(s->type) * (size_t)s->columns);
    if (rows > (hsize_t)s->rows) {
        rows = (hsize_t)s->rows;
    }
    H5Pset_chunk(plan, 2, (hsize_t[]){rows, (hsize_t)s->columns});
    H5Pset_shuffle(plan);
    H5Pset_deflate(plan, (unsigned)s->deflate);
}

static hid_t create_dataset(hid_t place, const rg_h5_slab *s) {
    hid_t plan = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_fill_time(plan, H5D_FILL_TIME_NEVER);
    H5Pset_obj_track_times(plan, false);
    if (s->deflate > 0 && s->rows > 0) {
        compress(plan, s);
    }
    hid_t space = H5Screate_simple(2, (hsize_t[]){(hsize_t)s->rows, (hsize_t)s->columns}, NULL);
    hid_t dataset = H5Dcreate2(place, s->name, s->type, space, H5P_DEFAULT, plan, H5P_DEFAULT);
    H5Sclose(space);
    H5Pclose(plan);
    return dataset;
}

/* Rows [first, first + count) of the dataset, or none of it. The caller closes the result. */
static hid_t select_rows(hid_t dataset, int columns, int64_t first, int64_t count) {
    hid_t space = H5Dget_space(dataset);
    H5Sselect_hyperslab(space, H5S_SELECT_SET, (hsize_t[]){(hsize_t)first, 0}, NULL,
                        (hsize_t[]){(hsize_t)count, (hsize_t)columns}, NULL);
    return space;
}

/* As many rows in memory. A rank without any selects none of one: the chunked collective path of HDF5 1.10
 * fails on a space without rows. */
static hid_t rows_here(int columns, int64_t count) {
    hid_t space = H5Screate_simple(2, (hsize_t[]){count > 0 ? (hsize_t)count : 1, (hsize_t)columns}, NULL);
    if (count == 0) {
        H5Sselect_none(space);
    }
    return space;
}

static bool write_slab(hid_t dataset, const rg_h5_slab *s, const void *data) {
    hid_t transfer = H5Pcreate(H5P_DATASET_XFER);
    H5Pset_dxpl_mpio(transfer, s->deflate > 0 ? H5FD_MPIO_COLLECTIVE : H5FD_MPIO_INDEPENDENT);
    hid_t there = select_rows(dataset, s->columns, s->first, s->count);
    hid_t here = rows_here(s->columns, s->count);
    bool ok = H5Dwrite(dataset, s->type, here, there, transfer, data) >= 0;
    H5Pclose(transfer);
    H5Sclose(here);
    H5Sclose(there);
    return ok;
}

static bool read_rows(hid_t dataset, const rg_h5_slab *s, int64_t first, int64_t count, void *data) {
    hid_t there = select_rows(dataset, s->columns, first, count);
    hid_t here = rows_here(s->columns, count);
    bool ok = H5Dread(dataset, s->type, here, there, H5P_DEFAULT, data) >= 0;
    H5Sclose(here);
    H5Sclose(there);
    return ok;
}

/* Whether this rank's slab reads back as `data`. MPI-IO promises so once all ranks have written. */
static bool verify_slab(hid_t dataset, const rg_h5_slab *s, const void *data) {
    size_t row = (size_t)s->columns * H5Tget_size(s->type);
    int64_t step = (int64_t)(VERIFY_BYTES / row) + 1;
    char *buffer = rg_realloc(NULL, (size_t)step, row);
    bool same = true;
    for (int64_t i = 0; i < s->count && same; i += step) {
        int64_t n = s->count - i < step ? s->count - i : step;
        same = read_rows(dataset, s, s->first + i, n, buffer) &&
               memcmp(buffer, (const char *)data + (size_t)i * row, (size_t)n * row) == 0;
    }
    rg_free(buffer);
    return same;
}

/* Room on the disk for `bytes` more, and metadata. Where the file system cannot reserve it, writing will
 * tell. */
static void reserve(rg_h5_file *f, size_t bytes, const char *what) {
    int64_t more = (int64_t)bytes + METADATA_BYTES;
    bool ok = true;
    if (f->rank == 0) {
        do { /* signals ask for checkpoints, and come while one is written */
            ok = fallocate(f->disk, 0, f->reserved, more) == 0 || errno == EOPNOTSUPP;
        } while (!ok && errno == EINTR);
        if (!ok) {
            snprintf(f->reason, sizeof f->reason, "%s", strerror(errno));
        }
    }
    f->reserved += more;
    rg_h5_note(f, ok, "write", what);
}

hid_t rg_h5_begin(rg_h5_file *f, hid_t place, const rg_h5_slab *s, const char *unit) {
    hid_t dataset = create_dataset(place, s);
    rg_h5_note(f, dataset >= 0, "create", s->name);
    if (unit != NULL) {
        rg_h5_note(f, rg_h5_put_text(dataset, "unit", unit), "describe", s->name);
    }
    if (unit != NULL && s->columns == 6) {
        rg_h5_note(f, rg_h5_put_text(dataset, "components", "xx xy xz yy yz zz"), "describe", s->name);
    }
    if (s->rows > 0) {
        size_t bytes = (size_t)s->rows * (size_t)s->columns * H5Tget_size(s->type);
        reserve(f, bytes + bytes / 64, s->name); /* what does not compress grows a little */
    }
    return dataset;
}

void rg_h5_put(rg_h5_file *f, hid_t dataset, const rg_h5_slab *s, const void *data) {
    bool together = s->deflate > 0;
    if (together) {
        rg_h5_agree(f);
    }
    rg_h5_note(f, write_slab(dataset, s, data), "write", s->name);
    if (together) {
        rg_h5_agree(f);
    }
    rg_h5_note(f, verify_slab(dataset, s, data), "read back", s->name);
}

void rg_h5_start_sync(const rg_h5_file *f) {
    sync_file_range(f->disk, 0, 0, SYNC_FILE_RANGE_WRITE); /* a hint: rg_h5_finish tells of failures */
}

void rg_h5_write(rg_h5_file *f, hid_t place, const rg_h5_slab *s, const char *unit, const void *data) {
    hid_t dataset = rg_h5_begin(f, place, s, unit);
    if (s->rows > 0) {
        rg_h5_put(f, dataset, s, data);
    }
    rg_h5_note(f, H5Dclose(dataset) >= 0, "close", s->name);
}

bool rg_h5_read(hid_t place, const rg_h5_slab *s, void *data) {
    hsize_t size[2] = {0, 0};
    hid_t dataset = H5Dopen2(place, s->name, H5P_DEFAULT);
    hid_t space = dataset < 0 ? -1 : H5Dget_space(dataset);
    bool ok = space >= 0 && H5Sget_simple_extent_ndims(space) == 2 &&
              H5Sget_simple_extent_dims(space, size, NULL) == 2 && size[0] == (hsize_t)s->rows &&
              size[1] == (hsize_t)s->columns;
    if (space >= 0) {
        H5Sclose(space);
    }
    ok = ok && (s->rows == 0 || read_rows(dataset, s, s->first, s->count, data));
    return (dataset < 0 || H5Dclose(dataset) >= 0) && ok;
}

/* ---- files ---- */

static hid_t parallel_access(MPI_Comm comm) {
    MPI_Info info;
    MPI_Info_create(&info);
    MPI_Info_set(info, "romio_ds_write", "disable"); /* slabs have no holes to fill by reading first */
    hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    if (H5Pset_fapl_mpio(access, comm, info) < 0 ||
        H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18) < 0) {
        H5Pclose(access);
        access = -1;
    }
    MPI_Info_free(&info);
    return access;
}

/* The texts one after the other; the caller frees it. */
static char *join(const char *begin, const char *end) {
    size_t size = strlen(begin) + strlen(end) + 1;
    char *both = rg_realloc(NULL, size, 1);
    snprintf(both, size, "%s%s", begin, end);
    return both;
}

static void prepare(rg_h5_file *f, const char *path, MPI_Comm comm) {
    *f = (rg_h5_file){.comm = comm, .file = -1, .disk = -1};
    MPI_Comm_rank(comm, &f->rank);
    f->path = join(path, "");
    f->shown = f->path;
    H5dont_atexit(); /* a rank that ends the run must not wait for others to close the file */
    rg_h5_listen(f->reason);
}

/* The name by which MPI-IO finds a file; the caller frees it. ROMIO takes all before the first colon of a
 * path for a kind of file system, so a path with a colon gets one that serves for all kinds. OMPIO knows
 * none. */
static char *mpi_name(const char *path) {
    const char *io = getenv("OMPI_MCA_io");
    bool romio = io == NULL || strcmp(io, "ompio") != 0;
    return join(romio && strchr(path, ':') != NULL ? "ufs:" : "", path);
}

/* Why the file could not be created, in the system's words, which MPI-IO keeps to itself. */
static void tell_reason(rg_h5_file *f) {
    int disk = open(f->part, O_RDWR | O_CREAT, 0666);
    if (disk == -1) {
        snprintf(f->reason, sizeof f->reason, "%s", strerror(errno));
    } else {
        close(disk);
    }
}

void rg_h5_create(rg_h5_file *f, const char *path, hsize_t room, MPI_Comm comm) {
    prepare(f, path, comm);
    f->part = join(path, ".part");
    hid_t access = parallel_access(comm), plan = H5Pcreate(H5P_FILE_CREATE);
    H5Pset_obj_track_times(plan, false);
    if (room > 0) {
        H5Pset_userblock(plan, room);
    }
    char *name = mpi_name(f->part);
    f->file = access < 0 ? -1 : H5Fcreate(name, H5F_ACC_TRUNC, plan, access);
    rg_free(name);
    H5Pclose(plan);
    H5Pclose(access);
    if (f->file < 0) {
        tell_reason(f);
    }
    rg_h5_agree_on(f, f->file >= 0, f->shown, "create the file", f->reason);
    f->disk = open(f->part, O_RDWR);
    rg_h5_agree_on(f, f->disk != -1, f->shown, "open the file", strerror(errno));
}

bool rg_h5_open(rg_h5_file *f, const char *path, MPI_Comm comm) {
    prepare(f, path, comm);
    hid_t access = parallel_access(comm);
    char *name = mpi_name(path);
    f->file = access < 0 ? -1 : H5Fopen(name, H5F_ACC_RDONLY, access);
    rg_free(name);
    H5Pclose(access);
    return rg_h5_all(comm, f->file >= 0);
}

bool rg_h5_all(MPI_Comm comm, bool ok) {
    int all = ok;
    MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_INT, MPI_MIN, comm);
    return all;
}

static void release(rg_h5_file *f) {
    rg_h5_deafen();
    if (f->disk != -1) {
        close(f->disk);
    }
    rg_free(f->path);
    rg_free(f->part);
}

void rg_h5_close(rg_h5_file *f) {
    rg_h5_agree(f);
    bool ok = H5Fclose(f->file) >= 0;
    rg_h5_agree_on(f, ok, f->shown, "close the file", f->reason);
}

void rg_h5_finish(rg_h5_file *f, bool sync) {
    bool ok = !sync || fsync(f->disk) == 0;
    rg_h5_agree_on(f, ok, f->shown, "bring the file to the disk", strerror(errno));
    ok = f->rank != 0 || rename(f->part, f->path) == 0;
    rg_h5_agree_on(f, ok, f->shown, "name the file", strerror(errno));
    release(f);
}

void rg_h5_close_read(rg_h5_file *f) {
    if (f->file >= 0) {
        H5Fclose(f->file);
    }
    release(f);
}
