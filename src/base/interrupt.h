/* What asks a run to write a checkpoint or to stop: signals, and the clock.
 *
 *   SIGUSR1                   write a checkpoint and go on
 *   SIGTERM, SIGINT, SIGUSR2  write a checkpoint and stop; a second SIGINT or SIGTERM ends it at once
 *   SIGHUP                    the same, of a lost terminal; unless it was ignored from the start (nohup)
 *   the wall-time limit       write a checkpoint and stop, in time
 *
 * A signal to any one rank is enough: requests travel with the time step's reduction (solver/step.c). (mpirun
 * passes SIGUSR1 and SIGUSR2 on; on SIGTERM and SIGINT it ends the ranks within a second, so it is SIGUSR2
 * that asks a large run under mpirun to stop.) */
#ifndef RG_INTERRUPT_H
#define RG_INTERRUPT_H

#include <stdbool.h>

enum { RG_REQUEST_NONE, RG_REQUEST_CHECKPOINT, RG_REQUEST_STOP, RG_REQUEST_TIME_UP };

/* From now on signals are requests, and writing beyond a limit of file size, or to a pipe that nobody reads
 * any more, is an error like a full disk. The clock of the wall-time limit starts. */
void rg_interrupt_listen(void);

/* From now on signals end the program as they do others: for what has nothing to save. */
void rg_interrupt_deafen(void);

/* The limit, in seconds since rg_interrupt_listen: the sooner of `walltime` (0: none) and the end of the
 * Slurm job (SLURM_JOB_END_TIME). Infinite if there is none. Meant for rank 0. */
double rg_interrupt_limit(double walltime);

/* The clock asks to stop `stop` seconds after rg_interrupt_listen, and for a checkpoint `next` seconds after
 * it; infinite: never. Meant for rank 0. */
void rg_interrupt_clock(double stop, double next);

/* Seconds since rg_interrupt_listen. */
double rg_interrupt_now(void);

/* The largest request of this rank. */
int rg_interrupt_request(void);

/* A checkpoint was written: SIGUSR1 is answered. */
void rg_interrupt_answered(void);

/* "1:30:00" as seconds; false if it is not such a time above zero. */
bool rg_interrupt_parse(const char *text, double *seconds);

#endif
