/* What is wrong with a user's input, collected so that all of it is told at once: in the same words and the
 * same order on any number of ranks. */
#ifndef RG_INPUT_ERRORS_H
#define RG_INPUT_ERRORS_H

#include <mpi.h>
#include <stdbool.h>
#include <stdint.h>

enum { RG_INPUT_ERRORS_TOLD = 10, RG_INPUT_ERROR_WORDS = 400 };

/* An input error. Its key says what it is about: two input errors with one key are the same, and are told
 * once. */
typedef struct {
    int64_t key[2];
    char words[RG_INPUT_ERROR_WORDS];
} rg_input_error;

/* Errors of the input called `name`, which belongs to the caller; all else begins with zeros. */
typedef struct {
    const char *name;
    int64_t count; /* all of them */
    int kept;
    rg_input_error
        input_error[RG_INPUT_ERRORS_TOLD]; /* [kept]: those with the lowest keys, in the order of these */
} rg_input_errors;

/* Counts an input error, and says it if it is among those with the lowest keys so far. A caller does not
 * bring the same key twice. */
void rg_input_errors_add(rg_input_errors *f, int64_t key, int64_t second, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* The same for words that are dear: where to put them, [RG_INPUT_ERROR_WORDS]; NULL: they are not wanted. */
char *rg_input_errors_place(rg_input_errors *f, int64_t key, int64_t second);

/* Collective: whether any rank of `comm` has input errors; then those of all of them are in *all of rank 0.
 */
bool rg_input_errors_gather(const rg_input_errors *f, rg_input_errors *all, MPI_Comm comm);

/* Ends the run (RG_USAGE) with all that was collected, a line each, if anything was: "name: words", then
 * "name: and so many more". The second one is collective and takes what all ranks of `comm` have; the ranks
 * agree, so none goes on, and one speaks. The same input error may be brought by several ranks where all
 * together bring no more than RG_INPUT_ERRORS_TOLD different ones; beyond that it may count twice. */
void rg_input_errors_end(const rg_input_errors *f);
void rg_input_errors_agree(const rg_input_errors *f, MPI_Comm comm);

#endif
