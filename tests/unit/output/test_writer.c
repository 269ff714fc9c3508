/* Field output on any number of ranks: what is written is read back with serial HDF5 and compared with a
 * formula of the global numbers, so the content cannot depend on the ranks. Prints TAP; `test_writer DIR`
 * keeps the files. */
#include "output/writer.h"

#include <errno.h>
#include <hdf5.h>
#include <signal.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"
#include "base/hash.h"
#include "base/mem.h"
#include "support/fatal.h"

enum { PLANNED = 51, FRAMES = 4 };

/* What each frame has for a crack: nothing, an empty one, some triangles, triangles on one rank only. */
static const int64_t crack_size[FRAMES] = {-1, 0, 7, 2};

static int rank, ranks, done, failed;
static char dir[200];

static void ok(bool good, const char *name) {
    if (rank == 0) {
        printf("%sok %d - %s\n", good ? "" : "not ", ++done, name);
        failed += !good;
    }
}

/* ---- stand-ins: the end of the run, and an MPI-IO that loses writes ---- */

static bool lose_writes;

int MPI_File_write_at_all(MPI_File file, MPI_Offset offset, const void *data, int count, MPI_Datatype type,
                          MPI_Status *status) {
    if (lose_writes) {
        return MPI_Status_set_elements(status, type, count);
    }
    return PMPI_File_write_at_all(file, offset, data, count, type, status);
}

int MPI_File_write_at(MPI_File file, MPI_Offset offset, const void *data, int count, MPI_Datatype type,
                      MPI_Status *status) {
    if (lose_writes) {
        return MPI_Status_set_elements(status, type, count);
    }
    return PMPI_File_write_at(file, offset, data, count, type, status);
}

/* What is brought to the disk, in one line; and a disk that cannot take the file of this name. */
static char synced[1000];
static const char *broken_disk = "nothing";
bool __wrap_rg_sync(const char *path);
bool __wrap_rg_sync_folder(const char *path);

bool __wrap_rg_sync(const char *path) {
    size_t used = strlen(synced);
    snprintf(synced + used, sizeof synced - used, "%s ", strrchr(path, '/') + 1);
    errno = EIO;
    return strcmp(strrchr(path, '/') + 1, broken_disk) != 0;
}

bool __wrap_rg_sync_folder(const char *path) {
    return __wrap_rg_sync(path);
}

/* ---- content ---- */

enum tag { POINTS, SCALAR, VECTOR, TENSOR, NODAL, IDS, CRACK_POINTS, CRACK_SCALAR, CRACK_VECTOR };

static double value(enum tag tag, int frame, int64_t i) {
    return rg_hash_uniform(rg_hash(rg_hash((uint64_t)tag, (uint64_t)frame), (uint64_t)i)) - 0.5;
}

/* Entries [first, first + count) of the content `tag`. The caller owns the result. */
static double *content(enum tag tag, int frame, int64_t first, int64_t count) {
    double *data = RG_NEW(double, (size_t)count);
    for (int64_t i = 0; i < count; i++) {
        data[i] = value(tag, frame, first + i);
    }
    return data;
}

typedef struct {
    int64_t first, count;
} share;

/* This rank's share of n items: uneven, and nothing for rank `idle`. */
static share share_of(int64_t n, int idle) {
    share s = {0, 0};
    int64_t workers = ranks > 1 ? ranks - 1 : 1, worker = 0;
    for (int r = 0; r < ranks; r++) {
        bool works = ranks == 1 || r != idle;
        int64_t end = worker + 1 == workers ? n : (worker + 1) * n / (workers + 1);
        int64_t begin = worker * n / (workers + 1);
        if (r == rank && works) {
            s = (share){begin, end - begin};
        }
        worker += works;
    }
    return s;
}

/* ---- writing ---- */

static rg_writer_style style; /* of all that is written and read */

/* Records of a share, in two windows (compressed, in one); `data` are those to come. */
typedef struct {
    const double *data;
    size_t count, values;
} two_windows;

static size_t get_window(void *of, size_t k, double *out) {
    two_windows *x = of;
    size_t half = style.deflate > 0 ? x->count : x->count / 2, n = k == 0 ? half : x->count - half;
    memcpy(out, x->data, n * x->values * sizeof *out);
    x->data += n * x->values;
    return n;
}

static rg_cell_source source_of(two_windows *x) {
    return (rg_cell_source){style.deflate > 0 ? 1 : 2, x->count + 1, x->values, get_window, x};
}

/* A field of the content `tag`, and how many values a cell has. */
typedef struct {
    const char *name;
    enum rg_center center;
    int components;
    enum tag tag; /* IDS are written exactly */
} cell_field;

static int64_t values_of(const cell_field *f) {
    return f->components * (f->center == RG_CENTER_NODE ? 10 : 1);
}

/* Fields that lie side by side in the records of cells, with other values before and after them. */
static void put_volume(rg_writer *w, int fields, const cell_field *field, int frame, share s) {
    enum { BEFORE = 2, AFTER = 1, MOST = 2 };
    rg_volume_field told[MOST];
    int64_t values = BEFORE + AFTER, from = BEFORE;
    for (int f = 0; f < fields; f++) {
        values += values_of(&field[f]);
    }
    double *data = content(CRACK_POINTS, frame, 0, values * s.count);
    for (int f = 0; f < fields; f++) {
        int64_t n = values_of(&field[f]);
        double *own = content(field[f].tag, frame, n * s.first, n * s.count);
        for (int64_t i = 0; i < n * s.count; i++) {
            data[i / n * values + from + i % n] = own[i];
        }
        told[f] = (rg_volume_field){field[f].name,       "Pa",         field[f].center,
                                    field[f].components, (size_t)from, field[f].tag == IDS};
        from += n;
        rg_free(own);
    }
    two_windows x = {data, (size_t)s.count, (size_t)values};
    rg_cell_source source = source_of(&x);
    rg_writer_volume(w, (size_t)fields, told, &source);
    rg_free(data);
}

static void put_crack_field(rg_writer *w, const char *name, int components, enum tag tag, int frame,
                            share s) {
    double *data = content(tag, frame, components * s.first, components * s.count);
    rg_writer_surface_field(w, name, "m", components, data);
    rg_free(data);
}

static void put_crack(rg_writer *w, int frame, int idle) {
    share s = share_of(crack_size[frame], idle);
    if (frame == FRAMES - 1) {
        s = rank == 0 ? (share){0, crack_size[frame]} : (share){crack_size[frame], 0};
    }
    double *x = content(CRACK_POINTS, frame, 9 * s.first, 9 * s.count);
    rg_writer_surface(w, s.count, x);
    rg_free(x);
    put_crack_field(w, "opening", 1, CRACK_SCALAR, frame, s);
    put_crack_field(w, "slip", 3, CRACK_VECTOR, frame, s);
}

static void put_frame(rg_writer *w, int frame, share s, int idle) {
    rg_writer_frame(w, 10 * frame, 1e-7 * frame);
    const cell_field both[] = {{"mean", RG_CENTER_CELL, 1, SCALAR}, {"velocity", RG_CENTER_NODE, 3, VECTOR}};
    put_volume(w, 2, both, frame, s);
    put_volume(w, 1, &(cell_field){"stress", RG_CENTER_CELL, 6, TENSOR}, frame, s);
    if (crack_size[frame] >= 0) {
        put_crack(w, frame, idle);
    }
    put_volume(w, 1, &(cell_field){"id", RG_CENTER_CELL, 1, IDS}, frame, s);
    put_volume(w, 1, &(cell_field){"potential", RG_CENTER_NODE, 1, NODAL}, frame, s);
    rg_writer_frame_end(w);
}

static rg_writer *open_writer(MPI_Comm comm, int64_t total, share s) {
    double *x = content(POINTS, 0, 30 * s.first, 30 * s.count);
    two_windows positions = {x, (size_t)s.count, 30};
    rg_cell_source source = source_of(&positions);
    rg_writer *w = rg_writer_open(dir, comm, style, total, s.first, s.count, &source);
    rg_free(x);
    return w;
}

/* ---- reading, on rank 0 ---- */

/* The dataset `path`, which must be [rows][columns]; NULL otherwise. The caller owns the result. */
static void *load(hid_t file, const char *path, hid_t type, int64_t rows, int columns) {
    hid_t set = H5Dopen2(file, path, H5P_DEFAULT);
    if (set < 0) {
        return NULL;
    }
    hid_t space = H5Dget_space(set);
    hsize_t size[8] = {0};
    void *data = NULL;
    if (H5Sget_simple_extent_ndims(space) == 2 && H5Sget_simple_extent_dims(space, size, NULL) == 2 &&
        size[0] == (hsize_t)rows && size[1] == (hsize_t)columns) {
        data = rg_alloc((size_t)(rows * columns), sizeof(double));
        H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data);
    }
    H5Sclose(space);
    H5Dclose(set);
    return data;
}

static bool same_doubles(hid_t file, const char *path, int64_t rows, int columns, enum tag tag, int frame) {
    double *found = load(file, path, H5T_NATIVE_DOUBLE, rows, columns);
    double *wanted = content(tag, frame, 0, rows * columns);
    for (int64_t i = 0; style.single && tag != IDS && i < rows * columns; i++) {
        wanted[i] = (float)wanted[i];
    }
    bool same = found != NULL && memcmp(found, wanted, (size_t)(rows * columns) * sizeof *found) == 0;
    rg_free(found);
    rg_free(wanted);
    return same;
}

/* The file holds xx xy xz yy yz zz, the caller gave xx yy zz yz xz xy. */
static bool same_tensors(hid_t file, const char *path, int64_t rows, enum tag tag, int frame) {
    static const int place[6] = {0, 3, 5, 4, 2, 1};
    double *found = load(file, path, H5T_NATIVE_DOUBLE, rows, 6);
    bool same = found != NULL;
    for (int64_t i = 0; same && i < 6 * rows; i++) {
        double wanted = value(tag, frame, i);
        same = found[6 * (i / 6) + place[i % 6]] == (style.single ? (float)wanted : wanted);
    }
    rg_free(found);
    return same;
}

static bool counts_up(hid_t file, const char *path, int64_t rows, int columns) {
    int64_t *cells = load(file, path, H5T_NATIVE_INT64, rows, columns);
    bool same = cells != NULL;
    for (int64_t i = 0; same && i < rows * columns; i++) {
        same = cells[i] == i;
    }
    rg_free(cells);
    return same;
}

static double number(hid_t file, const char *path, const char *name) {
    double result = -1;
    hid_t attribute = H5Aopen_by_name(file, path, name, H5P_DEFAULT, H5P_DEFAULT);
    if (attribute >= 0) {
        H5Aread(attribute, H5T_NATIVE_DOUBLE, &result);
        H5Aclose(attribute);
    }
    return result;
}

static bool says(hid_t file, const char *path, const char *name, const char *wanted) {
    char found[64] = "";
    hid_t attribute = H5Aopen_by_name(file, path, name, H5P_DEFAULT, H5P_DEFAULT);
    if (attribute < 0) {
        return false;
    }
    hid_t type = H5Aget_type(attribute);
    if (H5Tget_size(type) <= sizeof found) {
        H5Aread(attribute, type, found);
    }
    H5Tclose(type);
    H5Aclose(attribute);
    return strcmp(found, wanted) == 0;
}

static const char *in_frame(int frame, const char *name) {
    static char path[100];
    snprintf(path, sizeof path, "/frames/%06d%s", frame, name);
    return path;
}

static bool frame_good(hid_t h5, int f, int64_t total) {
    return number(h5, in_frame(f, ""), "step") == 10 * f && number(h5, in_frame(f, ""), "time") == 1e-7 * f &&
           same_doubles(h5, in_frame(f, "/mean"), total, 1, SCALAR, f) &&
           same_doubles(h5, in_frame(f, "/id"), total, 1, IDS, f) &&
           same_doubles(h5, in_frame(f, "/velocity"), 10 * total, 3, VECTOR, f) &&
           same_doubles(h5, in_frame(f, "/potential"), 10 * total, 1, NODAL, f) &&
           same_tensors(h5, in_frame(f, "/stress"), total, TENSOR, f) &&
           says(h5, in_frame(f, "/velocity"), "unit", "Pa") &&
           says(h5, in_frame(f, "/stress"), "components", "xx xy xz yy yz zz");
}

static bool crack_good(hid_t h5, int f) {
    int64_t n = crack_size[f];
    if (n < 0) {
        return H5Lexists(h5, in_frame(f, "/crack"), H5P_DEFAULT) == 0;
    }
    return same_doubles(h5, in_frame(f, "/crack/points"), 3 * n, 3, CRACK_POINTS, f) &&
           counts_up(h5, in_frame(f, "/crack/cells"), n, 3) &&
           same_doubles(h5, in_frame(f, "/crack/opening"), n, 1, CRACK_SCALAR, f) &&
           same_doubles(h5, in_frame(f, "/crack/slip"), n, 3, CRACK_VECTOR, f) &&
           says(h5, in_frame(f, "/crack/opening"), "unit", "m");
}

static const char *in_dir(const char *name) {
    static char path[sizeof dir + 40];
    snprintf(path, sizeof path, "%s/%s", dir, name);
    return path;
}

/* Number of times `word` occurs in fields.xdmf. */
static int occurrences(const char *word) {
    FILE *in = fopen(in_dir("fields.xdmf"), "r");
    if (in == NULL) {
        return -1;
    }
    char line[400];
    int n = 0;
    while (fgets(line, sizeof line, in) != NULL) {
        n += strstr(line, word) != NULL;
    }
    fclose(in);
    return n;
}

static void check_content(int64_t total) {
    hid_t h5 = H5Fopen(in_dir("fields.h5"), H5F_ACC_RDONLY, H5P_DEFAULT);
    ok(h5 >= 0 && says(h5, "/", "program", "rhegma") && number(h5, "/", "format") == 2,
       "file and its attributes");
    ok(same_doubles(h5, "/mesh/points", 10 * total, 3, POINTS, 0), "points");
    ok(counts_up(h5, "/mesh/cells", total, 10), "connectivity");
    bool fields = true, cracks = true;
    for (int f = 0; f < FRAMES; f++) {
        fields = frame_good(h5, f, total) && fields;
        cracks = crack_good(h5, f) && cracks;
    }
    ok(fields, "volume fields of all frames");
    ok(cracks, "crack of all frames");
    H5Fclose(h5);
    ok(occurrences("Tetrahedron_10") == FRAMES && occurrences("\"Triangle\"") == 2, "grids in the XDMF file");
    ok(access(in_dir("fields.xdmf.tmp"), F_OK) != 0, "no temporary file is left");
}

static void clean(void);

/* ---- cases ---- */

static void check_while_open(void) {
    hid_t h5 = H5Fopen(in_dir("fields.h5"), H5F_ACC_RDONLY, H5P_DEFAULT);
    ok(h5 >= 0 && number(h5, in_frame(1, ""), "step") == 10 && occurrences("<Time") == 2,
       "finished frames are readable during the run");
    H5Fclose(h5);
}

/* `cut`: after the third frame the run is lost; another goes on from the second. */
static void write_and_read(int64_t total, int idle, bool cut) {
    share s = share_of(total, idle);
    rg_writer *w = open_writer(MPI_COMM_WORLD, total, s);
    rg_writer_mark mark = {0};
    for (int f = 0; f < FRAMES; f++) {
        put_frame(w, f, s, idle);
        if (f == 1 && rank == 0) {
            check_while_open();
        }
        if (f == 1) {
            mark = rg_writer_stand(w);
        }
        if (f == 2 && cut) {
            cut = false;
            rg_writer_sync(w);
            rg_writer_close(w);
            w = rg_writer_resume(dir, MPI_COMM_WORLD, style, total, s.first, s.count, &mark);
            if (rank == 0) {
                check_while_open();
            }
            f = 1;
        }
    }
    rg_writer_close(w);
    if (rank == 0) {
        check_content(total);
    }
    MPI_Barrier(MPI_COMM_WORLD);
}

/* What goes wrong below must end the run with status RG_FAILURE and a message that has `words`. */
static void failure_said(const char *name, const char *words) {
    bool good = fatal_status == RG_FAILURE && strstr(said, words) != NULL;
    ok(good, name);
    printf("# %s\n", said);
    fatal_status = RG_OK;
    said[0] = '\0';
}

static void limit_file_size(rlim_t bytes) {
    struct rlimit limit;
    getrlimit(RLIMIT_FSIZE, &limit);
    limit.rlim_cur = bytes;
    setrlimit(RLIMIT_FSIZE, &limit);
}

static void check_bad_directory(void) {
    char good[sizeof dir];
    memcpy(good, dir, sizeof dir);
    snprintf(dir, sizeof dir, "/dev/null/output");
    if (setjmp(escape) == 0) {
        open_writer(MPI_COMM_SELF, 1, (share){0, 1});
    }
    memcpy(dir, good, sizeof dir);
    failure_said("a missing directory", "output directory /dev/null/output/fields: cannot be created: ");
}

static void check_full_disk(void) {
    if (setjmp(escape) == 0) {
        rg_writer *w = open_writer(MPI_COMM_SELF, 100, (share){0, 100});
        signal(SIGXFSZ, SIG_IGN);
        limit_file_size(20000);
        put_frame(w, 0, (share){0, 100}, 1);
    }
    limit_file_size(RLIM_INFINITY);
    failure_said("a full disk", "fields/000000.h5: cannot write /velocity: ");
}

static void check_lost_write(void) {
    if (setjmp(escape) == 0) {
        rg_writer *w = open_writer(MPI_COMM_SELF, 5, (share){0, 5});
        lose_writes = true;
        put_frame(w, 0, (share){0, 5}, 1);
    }
    lose_writes = false;
    failure_said("a write that MPI-IO lost", "fields/000000.h5: cannot read back /mean: ");
}

static void check_blocked_xdmf(void) {
    remove(in_dir("fields.xdmf"));
    mkdir(in_dir("fields.xdmf"), 0777);
    if (setjmp(escape) == 0) {
        rg_writer *w = open_writer(MPI_COMM_SELF, 5, (share){0, 5});
        put_frame(w, 0, (share){0, 5}, 1);
    }
    rmdir(in_dir("fields.xdmf"));
    remove(in_dir("fields.xdmf.tmp"));
    failure_said("an XDMF file that cannot be written", "fields.xdmf: cannot write the file: ");
}

static void check_lost_frame(void) {
    if (setjmp(escape) == 0) {
        rg_writer *w = open_writer(MPI_COMM_SELF, 5, (share){0, 5});
        put_frame(w, 0, (share){0, 5}, 1);
        rg_writer_mark mark = rg_writer_stand(w);
        rg_writer_close(w);
        remove(in_dir("fields/000000.h5"));
        rg_writer_resume(dir, MPI_COMM_SELF, style, 5, 0, 5, &mark);
    }
    failure_said("a frame that a restart misses", "fields/000000.h5: No such file");
}

static bool there(const char *name) {
    return access(in_dir(name), F_OK) == 0;
}

static rg_writer *with_frames(int frames) {
    rg_writer *w = open_writer(MPI_COMM_SELF, 5, (share){0, 5});
    for (int f = 0; f < frames; f++) {
        put_frame(w, f, (share){0, 5}, 1);
    }
    return w;
}

static int frames_linked(void) {
    hid_t h5 = H5Fopen(in_dir("fields.h5"), H5F_ACC_RDONLY, H5P_DEFAULT),
          group = H5Gopen2(h5, "frames", H5P_DEFAULT);
    H5G_info_t info = {0};
    H5Gget_info(group, &info);
    H5Gclose(group);
    H5Fclose(h5);
    return (int)info.nlinks;
}

/* Goes on behind `keep` of four frames; whether just these are left. */
static bool cut_good(int keep) {
    rg_writer *w = with_frames(keep);
    rg_writer_mark mark = rg_writer_stand(w);
    for (int f = keep; f < 4; f++) {
        put_frame(w, f, (share){0, 5}, 1);
    }
    rg_writer_close(w);
    if (keep == 0) {
        remove(in_dir("fields.xdmf")); /* nobody needs it then */
    }
    w = rg_writer_resume(dir, MPI_COMM_SELF, style, 5, 0, 5, &mark);
    bool good = mark.frames == keep && (mark.volume > 0) == (keep > 0) && (mark.crack > 0) == (keep > 2) &&
                there("fields/mesh.h5") && frames_linked() == keep &&
                (keep == 0 || occurrences("<Time") == keep + (keep > 2));
    for (int f = 0; f < 4; f++) {
        char name[40];
        snprintf(name, sizeof name, "fields/%06d.h5", f);
        good = there(name) == (f < keep) && good;
    }
    put_frame(w, keep, (share){0, 5}, 1);
    good = frames_linked() == keep + 1 && rg_writer_stand(w).frames == keep + 1 && good;
    rg_writer_close(w);
    clean();
    return good;
}

static void check_cuts(void) {
    ok(cut_good(0) && cut_good(1) && cut_good(3), "what lies behind a mark is gone");
}

/* What was brought to the disk before is not again, but for what has changed. */
static void check_syncs(void) {
    rg_writer *w = with_frames(0);
    synced[0] = '\0';
    rg_writer_sync(w);
    bool good = strcmp(synced, "mesh.h5 fields fields.h5 ") == 0 || strcmp(synced, "fields fields.h5 ") == 0;
    put_frame(w, 0, (share){0, 5}, 1);
    put_frame(w, 1, (share){0, 5}, 1);
    synced[0] = '\0';
    rg_writer_sync(w);
    good = strcmp(synced, "mesh.h5 000000.h5 000001.h5 fields fields.h5 fields.xdmf ") == 0 && good;
    put_frame(w, 2, (share){0, 5}, 1);
    synced[0] = '\0';
    rg_writer_sync(w);
    good = strcmp(synced, "000002.h5 fields fields.h5 fields.xdmf ") == 0 && good;
    rg_writer_mark mark = rg_writer_stand(w);
    rg_writer_close(w);
    w = rg_writer_resume(dir, MPI_COMM_SELF, style, 5, 0, 5, &mark);
    put_frame(w, 3, (share){0, 5}, 1);
    synced[0] = '\0';
    rg_writer_sync(w);
    good = strcmp(synced, "000003.h5 fields fields.h5 fields.xdmf ") == 0 && good;
    printf("# %s\n", synced);
    rg_writer_close(w);
    clean();
    ok(good, "what is brought to the disk");
    static const char *const name[] = {"mesh.h5", "000000.h5", "fields", "fields.h5", "fields.xdmf"};
    for (int k = 0; k < 5; k++) {
        broken_disk = name[k];
        if (setjmp(escape) == 0) {
            rg_writer_sync(with_frames(1));
        }
        failure_said("a disk that cannot take a file",
                     "fields.h5: cannot bring the fields to the disk: Input/output error");
        clean();
    }
    broken_disk = "nothing";
}

/* A file of an earlier run that is not as it was. */
static void check_resume_without(const char *name, const char *words) {
    static rg_writer_mark mark;
    if (setjmp(escape) == 0) {
        rg_writer *w = with_frames(3);
        mark = rg_writer_stand(w);
        rg_writer_close(w);
        remove(in_dir(name));
        rg_writer_resume(dir, MPI_COMM_SELF, style, 5, 0, 5, &mark);
    }
    failure_said("a file that a restart misses", words);
    clean();
}

static void check_blocked_index(void) {
    mkdir(in_dir("fields.h5"), 0777);
    if (setjmp(escape) == 0) {
        with_frames(0);
    }
    rmdir(in_dir("fields.h5"));
    remove(in_dir("fields.h5.part"));
    failure_said("an index that cannot be put in its place",
                 "fields.h5: cannot write the file: Is a directory");
    mkdir(in_dir("fields.h5.part"), 0777);
    if (setjmp(escape) == 0) {
        with_frames(0);
    }
    rmdir(in_dir("fields.h5.part"));
    failure_said("an index that cannot be made", "fields.h5: cannot write the file: ");
    clean();
}

static void clean(void) {
    remove(in_dir("fields.h5"));
    remove(in_dir("fields.xdmf"));
    remove(in_dir("fields/mesh.h5"));
    for (int f = 0; f < FRAMES; f++) {
        char name[40];
        snprintf(name, sizeof name, "fields/%06d.h5", f);
        remove(in_dir(name));
    }
    rmdir(in_dir("fields"));
}

/* Rank 0 alone: its writer on one rank must fail as it should. */
static void check_failures(void) {
    expect_fatal = true;
    check_bad_directory();
    check_full_disk();
    check_lost_write();
    check_blocked_xdmf();
    check_lost_frame();
    clean();
    check_resume_without("fields/mesh.h5", "fields/mesh.h5: No such file or directory");
    check_resume_without("fields/000002.h5", "fields/000002.h5: No such file or directory");
    check_resume_without("fields.xdmf",
                         "fields.xdmf: cannot go on with the fields: it is shorter than at the checkpoint");
    check_blocked_index();
    check_cuts();
    check_syncs();
    expect_fatal = false;
    clean();
}

/* The directory to write to: the one given, else a new one, which rank 0 removes at the end. */
static void choose_directory(const char *given) {
    if (rank == 0) {
        snprintf(dir, sizeof dir, "%s", given != NULL ? given : "/tmp/test_writer.XXXXXX");
        if (given == NULL && mkdtemp(dir) == NULL) {
            rg_fatal(RG_FAILURE, "cannot make %s", dir);
        }
    }
    MPI_Bcast(dir, sizeof dir, MPI_CHAR, 0, MPI_COMM_WORLD);
}

int main(int argc, char **argv) {
    setenv("OMPI_MCA_io", "romio321",
           0); /* OMPIO, the other choice, is reported to corrupt collective writes */
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    choose_directory(argc > 1 ? argv[1] : NULL);
    if (rank == 0) {
        printf("1..%d\n", PLANNED);
        check_failures();
    }
    MPI_Barrier(MPI_COMM_WORLD);
    write_and_read(9000, 0, false); /* more than the writer reads back at once */
    write_and_read(7, ranks - 1, true);
    write_and_read(1, 0, false);
    style = (rg_writer_style){.single = true, .deflate = 4};
    write_and_read(9000, 0, true);
    if (rank == 0 && argc == 1) {
        clean();
        rmdir(dir);
    }
    int bad = rank == 0 && (failed > 0 || done != PLANNED);
    MPI_Bcast(&bad, 1, MPI_INT, 0, MPI_COMM_WORLD);
    MPI_Finalize();
    return bad;
}
