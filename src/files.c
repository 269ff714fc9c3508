#include "files.h"

#include <errno.h>
#include <inttypes.h>
#include <string.h>
#include <sys/stat.h>

#include "error.h"
#include "mem.h"

struct rg_csv {
    FILE *file; /* NULL on ranks that write nothing */
    char path[1024];
};

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

static void join(char *out, size_t size, const char *dir, const char *name) {
    if ((size_t)snprintf(out, size, "%s/%s", dir, name) >= size) {
        rg_fatal(RG_USAGE, "%s/%s: the path is too long", dir, name);
    }
}

void rg_remove_results(const char *dir, int rank) {
    static const char *const names[] = {"summary.json", "energy.csv",  "history.csv",
                                        "case.yaml",    "fields.xdmf", "fields.h5"};
    for (size_t i = 0; rank == 0 && i < sizeof names / sizeof *names; i++) {
        char path[1024];
        join(path, sizeof path, dir, names[i]);
        if (remove(path) != 0 && errno != ENOENT) {
            rg_fatal(RG_FAILURE, "%s: an earlier result cannot be removed: %s", path, strerror(errno));
        }
    }
}

FILE *rg_open_in(const char *dir, const char *name) {
    char path[1024];
    join(path, sizeof path, dir, name);
    FILE *f = fopen(path, "w");
    if (f == NULL) {
        rg_fatal(RG_FAILURE, "%s: cannot be written: %s", path, strerror(errno));
    }
    return f;
}

void rg_echo_case(const rg_case *c, int rank) {
    if (rank != 0) {
        return;
    }
    FILE *f = rg_open_in(c->output.dir, "case.yaml");
    rg_case_echo(c, f);
    if (fclose(f) != 0) {
        rg_fatal(RG_FAILURE, "%s/case.yaml: cannot be written: %s", c->output.dir, strerror(errno));
    }
}

rg_csv *rg_csv_open(const char *dir, const char *name, int rank) {
    rg_csv *t = RG_NEW(rg_csv, 1);
    join(t->path, sizeof t->path, dir, name);
    t->file = rank == 0 ? rg_open_in(dir, name) : NULL;
    return t;
}

static void finish_row(rg_csv *t) {
    if (fputc('\n', t->file) == EOF || fflush(t->file) != 0) {
        rg_fatal(RG_FAILURE, "%s: cannot be written: %s", t->path, strerror(errno));
    }
}

void rg_csv_energy_header(rg_csv *t) {
    if (t->file != NULL) {
        fputs("step,time,kinetic,bodies,bulk,penalty,cohesive,contact,dissipated,plastic,damage,external_"
              "work,total,"
              "error_rel,"
              "broken_area,"
              "failed_area,momentum_x,momentum_y,momentum_z,angular_x,angular_y,angular_z",
              t->file);
        finish_row(t);
    }
}

void rg_csv_energy(rg_csv *t, const rg_energy *e) {
    if (t->file == NULL) {
        return;
    }
    const double row[] = {e->time,
                          e->kinetic,
                          e->bodies,
                          e->bulk,
                          e->penalty,
                          e->cohesive,
                          e->contact,
                          e->dissipated,
                          e->plastic,
                          e->damage,
                          e->external,
                          e->total,
                          e->error,
                          e->broken_area,
                          e->failed_area,
                          e->momentum[0],
                          e->momentum[1],
                          e->momentum[2],
                          e->angular_momentum[0],
                          e->angular_momentum[1],
                          e->angular_momentum[2]};
    fprintf(t->file, "%" PRId64, e->step);
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        fprintf(t->file, ",%.17g", row[i]);
    }
    finish_row(t);
}

void rg_csv_close(rg_csv *t) {
    if (t->file != NULL && fclose(t->file) != 0) {
        rg_fatal(RG_FAILURE, "%s: cannot be written: %s", t->path, strerror(errno));
    }
    rg_free(t);
}
