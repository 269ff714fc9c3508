/* What is wrong with a user's input, collected so that all of it is told at once: in the same words and the
 * same order on any number of ranks. */
#ifndef RG_FAULTS_H
#define RG_FAULTS_H

#include <mpi.h>
#include <stdbool.h>
#include <stdint.h>

enum { RG_FAULTS_TOLD = 10, RG_FAULT_WORDS = 400 };

/* A fault. Its key says what it is about: two faults with one key are the same, and are told once. */
typedef struct {
    int64_t key[2];
    char words[RG_FAULT_WORDS];
} rg_fault;

/* Faults of the input called `name`, which belongs to the caller; all else begins with zeros. */
typedef struct {
    const char *name;
    int64_t count; /* all of them */
    int kept;
    rg_fault fault[RG_FAULTS_TOLD]; /* [kept]: those with the lowest keys, in the order of these */
} rg_faults;

/* Counts a fault, and says it if it is among those with the lowest keys so far. A caller does not bring the
 * same key twice. */
void rg_faults_add(rg_faults *f, int64_t key, int64_t second, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* The same for words that are dear: where to put them, [RG_FAULT_WORDS]; NULL: they are not wanted. */
char *rg_faults_place(rg_faults *f, int64_t key, int64_t second);

/* Collective: whether any rank of `comm` has faults; then those of all of them are in *all of rank 0. */
bool rg_faults_gather(const rg_faults *f, rg_faults *all, MPI_Comm comm);

/* Ends the run (RG_USAGE) with all that was collected, a line each, if anything was: "name: words", then
 * "name: and so many more". The second one is collective and takes what all ranks of `comm` have; the ranks
 * agree, so none goes on, and one speaks. The same fault may be brought by several ranks where all together
 * bring no more than RG_FAULTS_TOLD different ones; beyond that it may count twice. */
void rg_faults_end(const rg_faults *f);
void rg_faults_agree(const rg_faults *f, MPI_Comm comm);

#endif
