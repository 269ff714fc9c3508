#include "base/files.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"
#include "base/mem.h"

enum { PATH_BYTES = 4096 }; /* more no system takes */

struct rg_csv {
    FILE *file; /* NULL on ranks that write nothing */
    char path[PATH_BYTES];
};

char *rg_path_beside_program(const char *name) {
    char *path = RG_NEW(char, PATH_BYTES + strlen(name) + 1);
    ssize_t length = readlink("/proc/self/exe", path, PATH_BYTES);
    path[length > 0 ? length : 0] = '\0';
    char *slash = strrchr(path, '/');
    strcpy(slash != NULL ? slash + 1 : path, name);
    return path;
}

/* Creates `path`, on the way to `whole`. */
static void make_one(const char *path, const char *whole) {
    struct stat found;
    if (mkdir(path, 0777) == 0) {
        return;
    }
    if (errno == EEXIST && stat(path, &found) == 0) {
        if (S_ISDIR(found.st_mode)) {
            return;
        }
        errno = ENOTDIR;
    }
    rg_fatal(RG_FAILURE, "output directory %s: cannot be created: %s", whole, strerror(errno));
}

void rg_make_directory(const char *path, MPI_Comm comm) {
    int rank;
    MPI_Comm_rank(comm, &rank);
    if (rank == 0) {
        size_t n = strlen(path);
        char *part = RG_NEW(char, n + 1);
        for (size_t i = 1; i <= n; i++) {
            if (path[i] == '/' || path[i] == '\0') {
                memcpy(part, path, i);
                part[i] = '\0';
                make_one(part, path);
            }
        }
        rg_free(part);
    }
    MPI_Barrier(comm);
}

FILE *rg_open_input(const char *path) {
    struct stat found;
    FILE *f = fopen(path, "rb");
    if (f != NULL && fstat(fileno(f), &found) == 0 && S_ISDIR(found.st_mode)) {
        fclose(f);
        errno = EISDIR;
        return NULL;
    }
    return f;
}

static void join(char *out, size_t size, const char *dir, const char *name) {
    if ((size_t)snprintf(out, size, "%s/%s", dir, name) >= size) {
        rg_fatal(RG_USAGE, "%s/%s: the path is too long", dir, name);
    }
}

static void remove_in(const char *dir, const char *name) {
    char path[PATH_BYTES];
    join(path, sizeof path, dir, name);
    if (remove(path) != 0 && errno != ENOENT) {
        rg_fatal(RG_FAILURE, "%s: an earlier result cannot be removed: %s", path, strerror(errno));
    }
}

/* The files of fields/ that a writer made, whole or not. */
void rg_remove_frames(const char *dir, int rank) {
    char path[PATH_BYTES];
    join(path, sizeof path, dir, "fields");
    DIR *folder = rank == 0 ? opendir(path) : NULL;
    for (struct dirent *e = folder == NULL ? NULL : readdir(folder); e != NULL; e = readdir(folder)) {
        if (strstr(e->d_name, ".h5") != NULL) {
            remove_in(path, e->d_name);
        }
    }
    if (folder != NULL) {
        closedir(folder);
        rmdir(path);
    }
}

void rg_remove_endings(const char *dir) {
    remove_in(dir, "summary.json");
    remove_in(dir, "autopsy.json");
}

void rg_refuse_own_case(const char *dir) {
    char own[PATH_BYTES], result[PATH_BYTES];
    join(own, sizeof own, dir, "case.yaml");
    join(result, sizeof result, dir, "energy.csv");
    if (access(own, F_OK) == 0 && access(result, F_OK) != 0) {
        rg_fatal(
            RG_USAGE,
            "%s: no run wrote it, for there is no energy.csv beside it, but this one would write over it: "
            "take another directory (-o), or name the file otherwise",
            own);
    }
}

/* But case.yaml and energy.csv, which are replaced: at no time one is there without the other, and no case is
 * lost that the run itself came from. */
void rg_remove_results(const char *dir, int rank) {
    static const char *const names[] = {"summary.json", "history.csv", "fragments.csv",
                                        "autopsy.json", "fields.xdmf", "fields.h5"};
    for (size_t i = 0; rank == 0 && i < sizeof names / sizeof *names; i++) {
        remove_in(dir, names[i]);
    }
    rg_remove_frames(dir, rank);
}

bool rg_sync(const char *path) {
    int file = open(path, O_RDONLY);
    bool ok = file >= 0 && fsync(file) == 0;
    int reason = errno;
    if (file >= 0) {
        close(file);
    }
    errno = reason;
    return ok;
}

bool rg_sync_folder(const char *path) {
    return rg_sync(path) || errno == EINVAL;
}

void rg_close_in(FILE *file, const char *dir, const char *name) {
    bool failed = ferror(file) != 0;
    failed = fclose(file) != 0 || failed;
    if (failed) {
        rg_fatal(RG_FAILURE, "%s/%s: cannot be written: %s", dir, name, strerror(errno));
    }
}

int64_t rg_sync_file(FILE *file, const char *name) {
    struct stat found;
    if (fflush(file) != 0 || fsync(fileno(file)) != 0 || fstat(fileno(file), &found) != 0) {
        rg_fatal(RG_FAILURE, "%s: cannot be written: %s", name, strerror(errno));
    }
    return (int64_t)found.st_size;
}

FILE *rg_reopen_in(const char *dir, const char *name, int64_t length) {
    char path[PATH_BYTES];
    join(path, sizeof path, dir, name);
    struct stat found;
    if (stat(path, &found) != 0) {
        rg_fatal(RG_USAGE, "%s: cannot go on with it: %s", path, strerror(errno));
    }
    if ((int64_t)found.st_size < length) {
        rg_fatal(RG_USAGE,
                 "%s: cannot go on with it: it has %" PRId64 " bytes and had %" PRId64 " at the checkpoint",
                 path, (int64_t)found.st_size, length);
    }
    FILE *f = truncate(path, (off_t)length) == 0 ? fopen(path, "a") : NULL;
    if (f == NULL) {
        rg_fatal(RG_FAILURE, "%s: cannot be written: %s", path, strerror(errno));
    }
    return f;
}

FILE *rg_open_in(const char *dir, const char *name) {
    char path[PATH_BYTES];
    join(path, sizeof path, dir, name);
    FILE *f = fopen(path, "w");
    if (f == NULL) {
        rg_fatal(RG_FAILURE, "%s: cannot be written: %s", path, strerror(errno));
    }
    return f;
}

FILE *rg_replace_in(const char *dir, const char *name) {
    char part[PATH_BYTES];
    snprintf(part, sizeof part, "%s.part", name);
    return rg_open_in(dir, part);
}

void rg_replaced_in(FILE *file, const char *dir, const char *name) {
    char part[PATH_BYTES + 8], path[PATH_BYTES];
    join(path, sizeof path, dir, name);
    snprintf(part, sizeof part, "%s.part", path);
    rg_sync_file(file, path);
    if (fclose(file) != 0 || rename(part, path) != 0) {
        rg_fatal(RG_FAILURE, "%s: cannot be written: %s", path, strerror(errno));
    }
}

rg_csv *rg_csv_open(const char *dir, const char *name, int rank) {
    rg_csv *t = RG_NEW(rg_csv, 1);
    join(t->path, sizeof t->path, dir, name);
    t->file = rank == 0 ? rg_open_in(dir, name) : NULL;
    return t;
}

rg_csv *rg_csv_reopen(const char *dir, const char *name, int rank, int64_t length) {
    rg_csv *t = RG_NEW(rg_csv, 1);
    join(t->path, sizeof t->path, dir, name);
    t->file = rank == 0 ? rg_reopen_in(dir, name, length) : NULL;
    return t;
}

static void take_lock(int file, const char *path) {
    if (flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
        rg_fatal(RG_USAGE, "%s: another run is writing to it; wait for its end, or take another directory",
                 path);
    }
}

void rg_csv_hold(const rg_csv *t) {
    if (t->file != NULL) {
        take_lock(fileno(t->file), t->path);
    }
}

void rg_refuse_busy(const char *dir, const char *name) {
    char path[PATH_BYTES];
    join(path, sizeof path, dir, name);
    int file = open(path, O_RDWR);
    if (file >= 0) {
        take_lock(file, path);
        close(file);
    }
}

int64_t rg_csv_sync(rg_csv *t) {
    return t->file != NULL ? rg_sync_file(t->file, t->path) : 0;
}

static void finish_row(rg_csv *t) {
    if (fputc('\n', t->file) == EOF || fflush(t->file) != 0) {
        rg_fatal(RG_FAILURE, "%s: cannot be written: %s", t->path, strerror(errno));
    }
}

void rg_csv_header(rg_csv *t, const char *columns) {
    if (t->file != NULL) {
        fputs(columns, t->file);
        finish_row(t);
    }
}

void rg_csv_row(rg_csv *t, const int64_t *number, size_t numbers, const double *value, size_t values) {
    if (t->file == NULL) {
        return;
    }
    for (size_t i = 0; i < numbers; i++) {
        fprintf(t->file, "%s%" PRId64, i > 0 ? "," : "", number[i]);
    }
    for (size_t i = 0; i < values; i++) {
        fprintf(t->file, ",%.17g", value[i]);
    }
    finish_row(t);
}

void rg_csv_close(rg_csv *t) {
    if (t->file != NULL && fclose(t->file) != 0) {
        rg_fatal(RG_FAILURE, "%s: cannot be written: %s", t->path, strerror(errno));
    }
    rg_free(t);
}
