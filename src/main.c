/* rhegma: three-dimensional dynamic fracture and fragmentation of brittle solids. */
#include <errno.h>
#include <fcntl.h>
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/denormals.h"
#include "base/error.h"
#include "base/h5_parallel.h"
#include "base/interrupt.h"
#include "base/mem.h"
#include "case/read.h"
#include "export_command.h"
#include "keys_command.h"
#include "layout.h"
#include "material_command.h"
#include "materials_command.h"
#include "mesh_command.h"
#include "partition/mesh_case.h"
#include "revision.h"
#include "run.h"
#include "usage.h"
#include "verify/verify.h"
#include "version.h"

typedef struct {
    const char *command, *path;
    const char **override;
    int overrides;
    char *restart_case; /* the case file in the directory of --restart */
    bool has_directory;
    rg_run_options run;
} arguments;

static int complain(int rank, const char *command, const char *what, const char *argument) {
    if (rank == 0) {
        fprintf(stderr, "rhegma: %s%s%s\n%s", what, argument[0] ? ": " : "", argument, rg_usage(command));
    }
    return RG_USAGE;
}

/* "-o DIR" as an override, quoted for YAML. */
static char *directory_override(const char *dir) {
    char *text = RG_NEW(char, 2 * strlen(dir) + 16), *end = text + sprintf(text, "output.dir=\"");
    for (; *dir != '\0'; dir++) {
        if (*dir == '"' || *dir == '\\') {
            *end++ = '\\';
        }
        *end++ = *dir;
    }
    strcpy(end, "\"");
    return text;
}

static bool asks_for_help(int argc, char **argv) {
    bool asks = false;
    for (int i = 1; i < argc; i++) {
        asks = asks || strcmp(argv[i], "--help") == 0 || strcmp(argv[i], "-h") == 0;
    }
    return asks;
}

static int parse(int argc, char **argv, int rank, arguments *a) {
    a->override = RG_NEW(const char *, (size_t)argc + 1);
    for (int i = 1; i < argc; i++) {
        bool takes_value = strcmp(argv[i], "--set") == 0 || strcmp(argv[i], "-o") == 0 ||
                           strcmp(argv[i], "--restart") == 0 || strcmp(argv[i], "--walltime") == 0;
        if (takes_value && i + 1 == argc) {
            return complain(rank, a->command, "missing value after", argv[i]);
        }
        if (strcmp(argv[i], "--set") == 0) {
            a->override[a->overrides++] = argv[++i];
        } else if (strcmp(argv[i], "-o") == 0) {
            a->override[a->overrides++] = directory_override(argv[++i]);
            a->has_directory = true;
        } else if (strcmp(argv[i], "--restart") == 0) {
            a->run.restart = true;
            a->restart_case = rg_join_path(argv[++i], "case.yaml");
            a->override[a->overrides++] = directory_override(argv[i]);
        } else if (strcmp(argv[i], "--walltime") == 0) {
            if (!rg_interrupt_parse(argv[++i], &a->run.walltime)) {
                return complain(rank, a->command, "--walltime takes H:M:S, not", argv[i]);
            }
        } else if (strcmp(argv[i], "--overwrite") == 0) {
            a->run.overwrite = true;
        } else if (strcmp(argv[i], "-q") == 0 || strcmp(argv[i], "--quiet") == 0) {
            a->run.quiet = true;
        } else if (argv[i][0] == '-') {
            return complain(rank, a->command, "unknown option", argv[i]);
        } else if (a->command == NULL) {
            a->command = argv[i];
        } else if (a->path == NULL) {
            a->path = argv[i];
        } else {
            return complain(rank, a->command, "one case at a time; not understood", argv[i]);
        }
    }
    if (a->command == NULL) {
        return complain(rank, a->command, "nothing to do", "");
    }
    if (strcmp(a->command, "run") != 0 && strcmp(a->command, "check") != 0) {
        return complain(rank, NULL, "unknown command", a->command);
    }
    if (strcmp(a->command, "check") == 0 && (a->run.restart || a->run.overwrite || a->run.walltime > 0)) {
        return complain(rank, a->command, "--restart, --overwrite and --walltime are for run", "");
    }
    if (a->run.restart && (a->has_directory || a->run.overwrite)) {
        return complain(rank, a->command,
                        "--restart goes on in its own directory: neither -o nor --overwrite", "");
    }
    a->path = a->path == NULL ? a->restart_case : a->path;
    return a->path == NULL ? complain(rank, a->command, "no case file given", "") : RG_OK;
}

/* The text of the case on all ranks, NULL with errno if it cannot be read. Rank 0 reads it: a pipe can be
 * read once, and a file that somebody saves meanwhile must not be two cases. */
static char *share_text(const char *path, int rank, size_t *size) {
    char *text = rank == 0 ? rg_case_file(path, size) : NULL;
    int64_t head[] = {text != NULL, text != NULL ? 0 : errno, (int64_t)*size};
    MPI_Bcast(head, 3, MPI_INT64_T, 0, MPI_COMM_WORLD);
    if (head[0] == 0) {
        errno = (int)head[1];
        return NULL;
    }
    *size = (size_t)head[2];
    text = rank == 0 ? text : RG_NEW(char, *size + 1);
    MPI_Bcast(text, (int)*size, MPI_CHAR, 0, MPI_COMM_WORLD);
    return text;
}

/* All ranks check the case; only one reports what is wrong with it. */
static rg_case *read_case(const arguments *a, int rank) {
    FILE *errors = rank == 0 ? stderr : fopen("/dev/null", "w");
    if (errors == NULL) {
        rg_fatal(RG_FAILURE, "/dev/null cannot be opened");
    }
    size_t size = 0;
    char *text = share_text(a->path, rank, &size);
    rg_case *c = rg_case_read_text(a->path, text, size, a->overrides, a->override, errors);
    rg_free(text);
    if (rank != 0) {
        fclose(errors);
    }
    if (c != NULL) {
        rg_case_take_crack(c, MPI_COMM_WORLD);
    }
    return c;
}

/* A standard stream that is closed gives its number to whatever is opened next, an output or a socket of MPI,
 * and that would get what is said. */
static void fill_streams(void) {
    int file;
    do {
        file = open("/dev/null", O_RDWR);
    } while (file >= 0 && file <= STDERR_FILENO);
    if (file >= 0) {
        close(file);
    }
}

/* Whether standard output took everything; says so, once, if it did not. */
static bool has_said_all(void) {
    bool all = fflush(stdout) == 0 && ferror(stdout) == 0;
    if (!all) {
        rg_warn("standard output cannot be written: some of what was said is lost");
        clearerr(stdout);
    }
    return all;
}

static int execute(int argc, char **argv, int rank) {
    if (argc == 2 && strcmp(argv[1], "--version") == 0) {
        printf("rhegma %s (%s), %s precision\n", RG_VERSION, RG_REVISION, RG_PRECISION);
        return RG_OK;
    }
    if (asks_for_help(argc, argv)) {
        if (rank == 0) {
            fputs(rg_usage(argv[1]), stdout);
        }
        return RG_OK;
    }
    if (argc > 1 && strcmp(argv[1], "verify") == 0) {
        if (argc > 2) {
            return complain(rank, "verify", "verify takes nothing else; not understood", argv[2]);
        }
        rg_flush_denormals();
        rg_interrupt_deafen();
        return rg_verify(MPI_COMM_WORLD);
    }
    arguments a = {0};
    if (parse(argc, argv, rank, &a) != RG_OK) {
        return RG_USAGE;
    }
    rg_case *c = read_case(&a, rank);
    if (c == NULL) {
        return RG_USAGE;
    }
    rg_flush_denormals();
    int status;
    if (strcmp(a.command, "run") == 0) {
        status = rg_run(c, MPI_COMM_WORLD, &a.run);
        has_said_all();
    } else {
        rg_interrupt_deafen();
        status = rg_run_check(c, MPI_COMM_WORLD);
    }
    rg_case_free(c);
    return status;
}

/* Of what only answers, an answer that was lost is a failure. */
static int answer(int status) {
    return has_said_all() || status != RG_OK ? status : RG_FAILURE;
}

int main(int argc, char **argv) {
    fill_streams();
    if (argc > 1 && strcmp(argv[1], "mesh") == 0) {
        return answer(asks_for_help(argc, argv) ? rg_mesh_help() : rg_mesh_command(argc, argv));
    }
    if (argc > 1 && strcmp(argv[1], "keys") == 0 && !asks_for_help(argc, argv)) {
        return answer(rg_keys_command(argc, argv));
    }
    if (argc > 1 && strcmp(argv[1], "materials") == 0 && !asks_for_help(argc, argv)) {
        return answer(rg_materials_command(argc, argv));
    }
    if (argc > 1 && strcmp(argv[1], "material") == 0 && !asks_for_help(argc, argv)) {
        return answer(rg_material_command(argc, argv));
    }
    if (argc > 1 && strcmp(argv[1], "export") == 0 && !asks_for_help(argc, argv)) {
        setenv("HDF5_USE_FILE_LOCKING", "FALSE", 0); /* the run may be writing */
        return answer(rg_export_command(argc, argv));
    }
    /* Open MPI's own I/O layer has been reported to hang or corrupt HDF5's collective writes
     * (HDFGroup/hdf5#1227, open-mpi/ompi#12718): use ROMIO unless the user chose otherwise. */
    setenv("OMPI_MCA_io", "romio321", 0);
    /* HDF5 would lock the files that rank 0 opens alone, which file systems of clusters often refuse; each is
     * written under a name that nobody else opens. */
    setenv("HDF5_USE_FILE_LOCKING", "FALSE", 0);
    rg_interrupt_listen();
    int provided, rank;
    MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
    if (provided < MPI_THREAD_FUNNELED) {
        rg_fatal(RG_FAILURE, "the MPI library does not support threads (MPI_THREAD_FUNNELED)");
    }
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    int status = answer(execute(argc, argv, rank));
    MPI_Finalize();
    return status;
}
