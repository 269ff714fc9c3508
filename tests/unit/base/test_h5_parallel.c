/* Files that all ranks write together: how they are laid out, what is reserved, that each lost byte is
 * noticed, and what is said of failures. Prints TAP from rank 0. */
#include "base/h5_parallel.h"

#include <errno.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include "base/error.h"
#include "base/mem.h"
#define FATAL_ONLY RG_FAILURE
#include "support/fatal.h"
#include "support/tap.h"

static int ranks;
static char dir[64];

static const char *in_dir(const char *name) {
    static char path[2][700];
    static int next;
    next = 1 - next;
    snprintf(path[next], sizeof path[next], "%s/%s", dir, name);
    return path[next];
}

/* ---- stand-ins: the end of a run, the disk, an MPI-IO that spoils a byte ---- */

static struct {
    int calls, error[4];    /* errors of the next calls */
    int64_t offset, length; /* of the last */
} reserving;
int __wrap_fallocate64(int file, int mode, off_t offset, off_t length);
int __wrap_fallocate64(int file, int mode, off_t offset, off_t length) {
    (void)file;
    reserving.offset = mode == 0 ? offset : -1;
    reserving.length = length;
    errno = reserving.calls < 4 ? reserving.error[reserving.calls] : 0;
    reserving.calls++;
    return errno == 0 ? 0 : -1;
}

static int synced, sync_error;
int __wrap_fsync(int file);
int __wrap_fsync(int file) {
    (void)file;
    synced++;
    errno = sync_error;
    return sync_error == 0 ? 0 : -1;
}

static double room; /* on the disk (bytes) */
static char asked[128];
int __wrap_statvfs64(const char *path, struct statvfs *disk);
int __wrap_statvfs64(const char *path, struct statvfs *disk) {
    snprintf(asked, sizeof asked, "%s", path);
    *disk = (struct statvfs){.f_frsize = 1000, .f_bavail = (fsblkcnt_t)(room / 1000)};
    return 0;
}

static int64_t spoil; /* byte of the next large write that goes wrong; -1: none */
int MPI_File_write_at(MPI_File file, MPI_Offset offset, const void *data, int count, MPI_Datatype type,
                      MPI_Status *status) {
    int size;
    MPI_Type_size(type, &size);
    if (spoil < 0 || (int64_t)count * size <= spoil) {
        return PMPI_File_write_at(file, offset, data, count, type, status);
    }
    char *copy = rg_alloc((size_t)count, (size_t)size);
    memcpy(copy, data, (size_t)count * (size_t)size);
    copy[spoil] ^= 1;
    int result = PMPI_File_write_at(file, offset, copy, count, type, status);
    rg_free(copy);
    return result;
}

static int64_t largest_read; /* bytes */
int MPI_File_read_at(MPI_File file, MPI_Offset offset, void *data, int count, MPI_Datatype type,
                     MPI_Status *status) {
    int size;
    MPI_Type_size(type, &size);
    largest_read = (int64_t)count * size > largest_read ? (int64_t)count * size : largest_read;
    return PMPI_File_read_at(file, offset, data, count, type, status);
}

static int together; /* collective writes */
static bool fail_together;
int MPI_File_write_at_all(MPI_File file, MPI_Offset offset, const void *data, int count, MPI_Datatype type,
                          MPI_Status *status) {
    together++;
    return fail_together ? MPI_ERR_IO : PMPI_File_write_at_all(file, offset, data, count, type, status);
}

static bool fail_close;
herr_t __real_H5Fclose(hid_t file);
herr_t __wrap_H5Fclose(hid_t file);
herr_t __wrap_H5Fclose(hid_t file) {
    herr_t result = __real_H5Fclose(file);
    return fail_close ? -1 : result;
}

/* ---- content ---- */

enum { LONG = 100003, COLUMNS = 3 };

static rg_h5_slab slab_of(const char *name, int columns, int64_t rows, int deflate) {
    int64_t cut = ranks > 1 ? rows / 3 : rows; /* rank 0 has a third, the last one the rest */
    rg_h5_slab s = {name, H5T_NATIVE_DOUBLE, columns, rows, 0, rank == 0 ? cut : 0, deflate};
    if (rank > 0 && rank == ranks - 1) {
        s.first = cut;
        s.count = rows - cut;
    }
    return s;
}

static double value(const char *name, int64_t i) {
    return (double)(i % 1000) + 0.001 * name[0];
}

/* The caller frees it. */
static double *content(const rg_h5_slab *s) {
    int64_t n = s->columns * s->count;
    double *data = RG_NEW(double, (size_t)n);
    for (int64_t i = 0; i < n; i++) {
        data[i] = value(s->name, s->columns * s->first + i);
    }
    return data;
}

static void put(rg_h5_file *f, hid_t place, rg_h5_slab s, const char *unit) {
    double *data = content(&s);
    rg_h5_write(f, place, &s, unit, data);
    rg_free(data);
}

static const char *read_back(const rg_h5_file *f, rg_h5_slab s) {
    double *wanted = content(&s), *found = RG_NEW(double, (size_t)(s.columns * s.count));
    bool read = rg_h5_read(f->file, &s, found),
         same = memcmp(found, wanted, sizeof *found * (size_t)(s.columns * s.count)) == 0;
    rg_free(wanted);
    rg_free(found);
    return !read ? "refused" : same ? "same" : "other";
}

/* ---- layout, on rank 0 with HDF5 alone ---- */

static bool has_text(hid_t set, const char *name, const char *wanted) {
    char found[64] = "";
    if (H5Aexists(set, name) <= 0) {
        return wanted == NULL;
    }
    hid_t attribute = H5Aopen(set, name, H5P_DEFAULT), type = H5Aget_type(attribute);
    if (H5Tget_size(type) < sizeof found) {
        H5Aread(attribute, type, found);
    }
    H5Tclose(type);
    H5Aclose(attribute);
    return wanted != NULL && strcmp(found, wanted) == 0;
}

/* chunk: rows of it; 0: none. */
static bool laid_out(hid_t file, const char *name, hsize_t chunk, const char *unit, const char *components) {
    hid_t set = H5Dopen2(file, name, H5P_DEFAULT), plan = H5Dget_create_plist(set);
    hsize_t size[2] = {0, 0};
    unsigned level = 99;
    size_t values = 1;
    H5D_fill_time_t fill;
    H5O_info_t info;
    H5Oget_info2(set, &info, H5O_INFO_TIME);
    H5Pget_fill_time(plan, &fill);
    bool good = fill == H5D_FILL_TIME_NEVER && info.mtime == 0 && has_text(set, "unit", unit) &&
                has_text(set, "components", components);
    if (chunk == 0) {
        good = good && H5Pget_layout(plan) == H5D_CONTIGUOUS && H5Pget_nfilters(plan) == 0;
    } else {
        good = good && H5Pget_layout(plan) == H5D_CHUNKED && H5Pget_chunk(plan, 2, size) == 2 &&
               size[0] == chunk && size[1] == COLUMNS && H5Pget_nfilters(plan) == 2 &&
               H5Pget_filter2(plan, 0, NULL, &(size_t){0}, NULL, 0, NULL, NULL) == H5Z_FILTER_SHUFFLE &&
               H5Pget_filter2(plan, 1, NULL, &values, &level, 0, NULL, NULL) == H5Z_FILTER_DEFLATE &&
               level == 4;
    }
    H5Pclose(plan);
    H5Dclose(set);
    return good;
}

static bool file_laid_out(const char *path) {
    hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT), plan = H5Fget_create_plist(file);
    hsize_t block = 0;
    H5O_info_t info;
    H5Pget_userblock(plan, &block);
    H5Oget_info_by_name2(file, "group", &info, H5O_INFO_TIME, H5P_DEFAULT);
    bool good = block == 512 && info.mtime == 0;
    good = laid_out(file, "long", (1 << 18) / 24, "m", NULL) && good;
    good = laid_out(file, "short", 5, NULL, NULL) && good;
    good = laid_out(file, "empty", 0, NULL, NULL) && good;
    good = laid_out(file, "group/plain", 0, "Pa", NULL) && good;
    good = laid_out(file, "tensor", 0, "Pa", "xx xy xz yy yz zz") && good;
    good = laid_out(file, "six", 0, NULL, NULL) && good;
    H5Pclose(plan);
    H5Fclose(file);
    return good;
}

/* A path with a colon, which MPI-IO takes for a kind of file system. */
static void test_layout(void) {
    rg_h5_file f;
    reserving.calls = 0;
    synced = 0;
    rg_h5_create(&f, in_dir("a:b.h5"), 512, MPI_COMM_WORLD);
    put(&f, f.file, slab_of("long", COLUMNS, LONG, 4), "m");
    int64_t bytes = (int64_t)LONG * COLUMNS * 8, more = bytes + bytes / 64 + 8192;
    report(f.reserved == more && reserving.calls == (rank == 0) &&
               (rank > 0 || (reserving.offset == 0 && reserving.length == more)),
           "room", "is reserved by rank 0, for what does not compress as well");
    put(&f, f.file, slab_of("short", COLUMNS, 5, 4), NULL);
    put(&f, f.file, slab_of("empty", COLUMNS, 0, 4), NULL);
    report(f.reserved == more + 8192 + 121 && reserving.calls == (rank == 0 ? 2 : 0) &&
               (rank > 0 || (reserving.offset == more && reserving.length == 8192 + 121)),
           "room", "is reserved behind that, and none for nothing");
    put(&f, f.file, slab_of("one", COLUMNS, 1, 4), NULL); /* some ranks have no row */
    put(&f, f.file, slab_of("tensor", 6, 7, 0), "Pa");
    put(&f, f.file, slab_of("six", 6, 7, 0), NULL);
    hid_t group = rg_h5_group(&f, "group");
    largest_read = 0;
    report(strcmp(f.group, "/group") == 0, "group", "is the current one");
    put(&f, group, slab_of("plain", 2, LONG, 0), "Pa");
    int64_t own = slab_of("plain", 2, LONG, 0).count * 16, most = (1 << 20) + 16;
    report(largest_read == (own < most ? own : most - (1 << 20) % 16), "reading", "goes by pieces");
    report(!rg_h5_put_attribute(group, "no value", H5T_NATIVE_INT, NULL) &&
               rg_h5_put_attribute(group, "a", H5T_NATIVE_INT, &(int){7}) &&
               !rg_h5_put_attribute(group, "a", H5T_NATIVE_INT, &(int){7}) &&
               rg_h5_put_text(group, "b", "text") && !rg_h5_put_text(group, "b", "text"),
           "attributes", "that cannot be written are told");
    rg_h5_start_sync(&f);
    H5Gclose(group);
    rg_h5_close(&f);
    report(f.failure[0] == '\0' && synced == 0 && access(in_dir("a:b.h5.part"), F_OK) == 0 &&
               access(in_dir("a:b.h5"), F_OK) != 0,
           "file", "has another name until it is whole");
    rg_h5_finish(&f, true);
    report(synced == 1 && access(in_dir("a:b.h5.part"), F_OK) != 0 && access(in_dir("a:b.h5"), F_OK) == 0,
           "file", "comes to the disk and has its name");
    report(rank > 0 || file_laid_out(in_dir("a:b.h5")), "file", "is laid out as it must be");
}

static void test_reading(void) {
    static const struct {
        const char *name;
        int columns;
        int64_t rows;
        const char *found;
    } known[] = {
        {"long", COLUMNS, LONG, "same"}, {"short", COLUMNS, 5, "same"}, {"one", COLUMNS, 1, "same"},
        {"empty", COLUMNS, 0, "same"},   {"tensor", 6, 7, "same"},      {"tensor", 6, 6, "refused"},
        {"tensor", 5, 7, "refused"},     {"none", 1, 1, "refused"},     {"empty", COLUMNS, 1, "refused"}};
    rg_h5_file f;
    bool good = rg_h5_open(&f, in_dir("a:b.h5"), MPI_COMM_WORLD) && f.part == NULL && f.disk == -1;
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        const char *found = read_back(&f, slab_of(known[i].name, known[i].columns, known[i].rows, 0));
        good = strcmp(found, known[i].found) == 0 && good;
    }
    report(good, "reading", "gives each rank its rows, or none of another dataset");
    rg_h5_close_read(&f);
    good = !rg_h5_open(&f, in_dir("none.h5"), MPI_COMM_WORLD) && f.reason[0] != '\0' && f.file < 0;
    rg_h5_close_read(&f);
    char *reason = strchr(f.reason, '\0');
    f.reason[0] = '\0';
    H5Dopen2(-1, "x", H5P_DEFAULT);
    report(good && reason > f.reason && f.reason[0] == '\0', "reading", "tells why it cannot, until it ends");
    char *path = rg_join_path("a/b", "c.h5");
    report(strcmp(path, "a/b/c.h5") == 0, "path", "is joined");
    rg_free(path);
    report(rg_h5_all(MPI_COMM_WORLD, true) && !rg_h5_all(MPI_COMM_WORLD, rank != ranks - 1) &&
               !rg_h5_all(MPI_COMM_WORLD, rank != 0),
           "ranks", "agree only if all do");
}

/* The lowest rank with a failure tells; the others wait until it comes to the same barrier, which it does
 * here. */
static void test_who_tells(void) {
    static int first;
    for (first = 0; first < ranks; first++) {
        const rg_h5_file about = {.comm = MPI_COMM_WORLD, .rank = rank};
        said[0] = '\0';
        expect_fatal = true;
        if (setjmp(escape) == 0) {
            rg_h5_agree_on(&about, rank < first, in_dir("x"), "verb", "why");
        } else {
            MPI_Barrier(MPI_COMM_WORLD);
        }
        expect_fatal = false;
        report((said[0] != '\0') == (rank == first), "ranks", "wait for the lowest one that fails");
    }
}

/* ---- failures, on one rank ---- */

static rg_h5_file broken;

static void create(const char *name) {
    rg_h5_create(&broken, in_dir(name), 0, MPI_COMM_SELF);
}

/* What a run that ended left open, which HDF5 would not close well. */
static void close_all(void) {
    hid_t left[16];
    ssize_t n = H5Fget_obj_ids(H5F_OBJ_ALL, H5F_OBJ_DATASET | H5F_OBJ_GROUP, 16, left);
    for (ssize_t i = 0; i < n; i++) {
        H5Oclose(left[i]);
    }
    n = H5Fget_obj_ids(H5F_OBJ_ALL, H5F_OBJ_FILE, 16, left);
    for (ssize_t i = 0; i < n; i++) {
        H5Fclose(left[i]);
    }
}

/* A failure said as "path: cannot words" (of HDF5's own, which differ, the beginning), and the unfinished
 * file gone. */
static void end_said(const char *path, const char *words) {
    char expected[600];
    snprintf(expected, sizeof expected, "%s: cannot %s", in_dir(path), words);
    bool good = strncmp(said, expected, strlen(expected)) == 0;
    if (!good) {
        printf("# %s\n# %s\n", said, expected);
    }
    snprintf(expected, sizeof expected, "%s.part", path);
    good = good && access(in_dir(expected), F_OK) != 0;
    remove(in_dir(expected));
    spoil = -1;
    fail_together = fail_close = false;
    close_all();
    sync_error = 0;
    room = 2e6;
    memset(&reserving, 0, sizeof reserving);
    if (!good) {
        failures++;
    }
    printf("%s %d - failure: %s\n", good ? "ok" : "not ok", ++number, words);
}

#define ENDS(path, words, ...)                                                                               \
    do {                                                                                                     \
        said[0] = '\0';                                                                                      \
        if (setjmp(escape) == 0) {                                                                           \
            __VA_ARGS__;                                                                                     \
        }                                                                                                    \
        end_said(path, words);                                                                               \
    } while (0)

static rg_h5_slab rows_of(const char *name, int64_t rows, int deflate) {
    return (rg_h5_slab){name, H5T_NATIVE_DOUBLE, COLUMNS, rows, 0, rows, deflate};
}

static void put_and_close(int64_t rows) {
    hid_t group = rg_h5_group(&broken, "g");
    put(&broken, group, rows_of("a", rows, 0), NULL);
    put(&broken, group, rows_of("b", rows, 0), NULL);
    H5Gclose(group);
    rg_h5_close(&broken);
}

static void test_failures(void) {
    static const char faulty[] = "read back /g/a: it does not hold what was written (faulty MPI-IO?)";
    const int64_t spoiled[] = {0, (1 << 20) - 1, 1 << 20, (1 << 20) + 30, 24 * 100000 - 1};
    static size_t i; /* longjmp leaves it alone */
    for (i = 0; i < sizeof spoiled / sizeof *spoiled; i++) {
        ENDS("f", faulty, create("f"); spoil = spoiled[i];
             put_and_close(100000)); /* more than is read at once */
    }
    ENDS("f", "read back /g/a: it does not hold what was written (faulty MPI-IO?) (the disk is full)",
         create("f");
         spoil = 2000; room = 999000; put_and_close(100));
    ENDS("f", faulty, create("f"); spoil = 2000; room = 1e6; put_and_close(100));
    ENDS("f", "write /g/a: No space left on device", create("f"); reserving.error[0] = ENOSPC;
         put_and_close(10));
    ENDS("f", "write /g/b: No space left on device", create("f"); reserving.error[1] = EINTR;
         reserving.error[2] = EINTR; reserving.error[3] = ENOSPC; put_and_close(10));
    static hid_t z;
    static double zero[10 * COLUMNS];
    static rg_h5_slab s;
    s = rows_of("z", 10, 4);
    ENDS("f", "write /z: No space left on device", create("f"); reserving.error[0] = ENOSPC;
         z = rg_h5_begin(&broken, broken.file, &s, NULL); together = 0; rg_h5_put(&broken, z, &s, zero));
    bool stopped = together == 0;
    ENDS("f", "write /z: ", create("f"); z = rg_h5_begin(&broken, broken.file, &s, NULL); largest_read = 0;
         fail_together = true; rg_h5_put(&broken, z, &s, zero));
    stopped = stopped && together > 0 && largest_read == 0;
    failures += !stopped;
    printf("%s %d - failure: nothing is done together after one\n", stopped ? "ok" : "not ok", ++number);
    ENDS("f", "create /g/a: ", create("f"); hid_t g = rg_h5_group(&broken, "g");
         put(&broken, g, rows_of("a", 9, 0), "m"); put(&broken, g, rows_of("a", 9, 0), "m");
         rg_h5_agree(&broken));
    ENDS("f", "create /g: ", create("f"); rg_h5_group(&broken, "g"); rg_h5_group(&broken, "g");
         rg_h5_agree(&broken));
    ENDS("f", "close the file: ", create("f"); fail_close = true; put_and_close(1));
    ENDS("f", "bring the file to the disk: Input/output error", create("f"); put_and_close(1);
         sync_error = EIO; rg_h5_finish(&broken, true));
    mkdir(in_dir("d"), 0777);
    ENDS("d", "name the file: Is a directory", create("d"); put_and_close(1); rg_h5_finish(&broken, true));
    rmdir(in_dir("d"));
    ENDS("no/f", "create the file: No such file or directory", create("no/f"));
    ENDS("name", "d: r", create("f"); broken.shown = in_dir("name"); rg_h5_note(&broken, true, "pass", "x");
         rg_h5_note(&broken, false, "do", NULL); broken.failure[1] = '\0';
         rg_h5_note(&broken, false, "redo", "y"); snprintf(broken.reason, sizeof broken.reason, "r");
         rg_h5_agree(&broken));
    rg_h5_file none = {.comm = MPI_COMM_SELF};
    ENDS("x", "verb: why", room = 0; rg_h5_agree_on(&none, true, "", "", "");
         snprintf(said, sizeof said, "%s", "went on"); room = 2e6;
         rg_h5_agree_on(&none, false, in_dir("x"), "verb", "why"));
    /* the folder is asked how full it is, of a name alone the current one */
    ENDS("x", "verb: why", rg_h5_agree_on(&none, false, in_dir("x"), "verb", "why"));
    bool folder = strcmp(asked, dir) == 0;
    if (setjmp(escape) == 0) {
        rg_h5_agree_on(&none, false, "x", "verb", "why");
    }
    folder = folder && strcmp(asked, ".") == 0 && strcmp(said, "x: cannot verb: why") == 0;
    failures += !folder;
    printf("%s %d - failure: the disk that is asked\n", folder ? "ok" : "not ok", ++number);
}

/* What does not fail on the way: a disk that cannot reserve, signals while it does; no sync if none is
 * wanted. */
static void test_what_is_no_failure(void) {
    create("f");
    memcpy(reserving.error, (const int[4]){EOPNOTSUPP, EINTR, EINTR, 0}, sizeof reserving.error);
    put_and_close(10);
    synced = 0;
    rg_h5_finish(&broken, false);
    bool good = reserving.calls == 4 && synced == 0 && access(in_dir("f"), F_OK) == 0;
    memset(&reserving, 0, sizeof reserving);
    remove(in_dir("f"));
    failures += !good;
    printf("%s %d - failure: is none\n", good ? "ok" : "not ok", ++number);
}

/* ---- the causes that HDF5 tells ---- */

static void test_reasons(void) {
    char reason[RG_H5_REASON] = "";
    rg_h5_listen(reason);
    H5Fopen(in_dir("none"), H5F_ACC_RDONLY, H5P_DEFAULT); /* a call of the system: its message alone */
    bool good = strcmp(reason, "No such file or directory") == 0;
    H5Dopen2(-1, "x", H5P_DEFAULT);
    good = good && strcmp(reason, "No such file or directory") == 0; /* the first one counts */
    reason[0] = '\0';
    H5Dopen2(-1, "x", H5P_DEFAULT); /* HDF5's own words, whole */
    good = good && strncmp(reason, "invalid location", 16) == 0 && strchr(reason, '\'') == NULL;
    reason[0] = '\0';
    rg_h5_deafen();
    H5Dopen2(-1, "x", H5P_DEFAULT);
    good = good && reason[0] == '\0';
    failures += !good;
    printf("%s %d - reasons: are the first and innermost\n", good ? "ok" : "not ok", ++number);
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    snprintf(dir, sizeof dir, "/tmp/test_h5_parallel.XXXXXX");
    if (rank == 0 && mkdtemp(dir) == NULL) {
        MPI_Abort(MPI_COMM_WORLD, 1);
    }
    MPI_Bcast(dir, sizeof dir, MPI_CHAR, 0, MPI_COMM_WORLD);
    spoil = -1;
    room = 2e6;
    test_layout();
    test_reading();
    test_who_tells();
    if (rank == 0) {
        remove(in_dir("a:b.h5"));
        expect_fatal = true;
        test_failures();
        expect_fatal = false;
        test_what_is_no_failure();
        test_reasons();
        rmdir(dir);
    }
    MPI_Barrier(MPI_COMM_WORLD);
    return finish();
}
