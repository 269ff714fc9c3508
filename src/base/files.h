/* Small output files: the directory, text, tables. Written by rank 0. */
#ifndef RG_FILES_H
#define RG_FILES_H

#include <mpi.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

/* Creates `path` and its parents where they do not exist. Ends the run with a message on failure. Collective.
 */
void rg_make_directory(const char *path, MPI_Comm comm);

/* Path of another program in the folder of this one, whatever folder the run is in. The caller frees it with
 * rg_free. */
char *rg_path_beside_program(const char *name);

/* Opens a file for reading; NULL, with errno set, where there is none or it is a directory. */
FILE *rg_open_input(const char *path);

/* Brings a file to the disk; false, with errno set, where that fails. */
bool rg_sync(const char *path);

/* The same for a directory, where the file system does that at all. */
bool rg_sync_folder(const char *path);

/* Length of an open file with all that was written to it, which this brings to the disk. Ends the run with a
 * message about `name` on failure. */
int64_t rg_sync_file(FILE *file, const char *name);

/* Ends the run if case.yaml in `dir` is not of a run but the user's own; rank 0. */
void rg_refuse_own_case(const char *dir);

/* Removes what an earlier run left in `dir`, so that results of two runs never mix; energy.csv and case.yaml
 * are to be written anew, in this order. Rank 0. */
void rg_remove_results(const char *dir, int rank);

/* Removes what only the end of a run writes: summary and autopsy. */
void rg_remove_endings(const char *dir);

/* Removes the field files of an earlier run; rank 0. */
void rg_remove_frames(const char *dir, int rank);

/* Opens dir/name for writing; ends the run with a message on failure. */
FILE *rg_open_in(const char *dir, const char *name);

/* Closes dir/name; ends the run with a message if some of it could not be written. */
void rg_close_in(FILE *file, const char *dir, const char *name);

/* Opens dir/name to go on with it behind its first `length` bytes; what follows them is removed. Ends the run
 * with a message if it is not that long. */
FILE *rg_reopen_in(const char *dir, const char *name, int64_t length);

/* Opens a new dir/name, which takes the place of an older one only when rg_replaced_in has closed it. Both
 * end the run with a message on failure. */
FILE *rg_replace_in(const char *dir, const char *name);
void rg_replaced_in(FILE *file, const char *dir, const char *name);

typedef struct rg_csv rg_csv;

/* A table in dir/name; on ranks other than 0 it takes rows and writes nothing. */
rg_csv *rg_csv_open(const char *dir, const char *name, int rank);
/* The same, going on with a table behind its first `length` bytes. */
rg_csv *rg_csv_reopen(const char *dir, const char *name, int rank, int64_t length);

/* Holds an open table of the output directory until it is closed, however the run ends: by a lock of the
 * system, where the file system has such. rg_refuse_busy ends the run with a message (RG_USAGE) where another
 * one holds dir/name, before anything there is touched. Rank 0. */
void rg_csv_hold(const rg_csv *t);
void rg_refuse_busy(const char *dir, const char *name);

/* Brings the table to the disk; its length (rank 0; 0 elsewhere). */
int64_t rg_csv_sync(rg_csv *t);
void rg_csv_header(rg_csv *t, const char *columns);

/* A row of whole numbers, then of others in all their digits. */
void rg_csv_row(rg_csv *t, const int64_t *number, size_t numbers, const double *value, size_t values);

void rg_csv_close(rg_csv *t);

#endif
