/* Small output files: the directory, the echo of the case, tables. Written by rank 0. */
#ifndef RG_FILES_H
#define RG_FILES_H

#include <stdio.h>

#include "ledger.h"

/* Creates `path` and its parents where they do not exist. Ends the run with a message on failure. Collective.
 */
void rg_make_directory(const char *path, MPI_Comm comm);

/* Removes what an earlier run left in `dir`, so that results of two runs never mix; rank 0. */
void rg_remove_results(const char *dir, int rank);

/* Opens dir/name for writing; ends the run with a message on failure. */
FILE *rg_open_in(const char *dir, const char *name);

/* Writes the full set of values used to case.yaml in the output directory; rank 0. */
void rg_echo_case(const rg_case *c, int rank);

typedef struct rg_csv rg_csv;

/* A table in dir/name; on ranks other than 0 it takes rows and writes nothing. */
rg_csv *rg_csv_open(const char *dir, const char *name, int rank);
void rg_csv_energy_header(rg_csv *t);
void rg_csv_energy(rg_csv *t, const rg_energy *e);
void rg_csv_close(rg_csv *t);

#endif
