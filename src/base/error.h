/* Errors a user can cause: one clear message on standard error, exit status 2, nothing half-written. */
#ifndef RG_ERROR_H
#define RG_ERROR_H

/* Exit statuses: fine; the run failed; bad input; stopped when asked to, with a checkpoint to go on from. */
enum { RG_OK = 0, RG_FAILURE = 1, RG_USAGE = 2, RG_INTERRUPTED = 3 };

/* Prints "rhegma: " and the message (rank 0 or the failing rank) and ends the whole job with `status`.
 * Never returns. Safe before MPI_Init and on one rank only (aborts the others). */
_Noreturn void rg_fatal(int status, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Prints "rhegma: warning: " and the message. */
void rg_warn(const char *format, ...) __attribute__((format(printf, 1, 2)));

#endif
