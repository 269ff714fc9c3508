/* Floating-point operations that a call really executes: a child process steps through it by the trap
 * flag, and looks each instruction up in the program's own disassembly. Exact for the object code at hand,
 * with its branches and loops, whatever the source looks like. */
#ifndef RG_INSTRUCTION_COUNT_H
#define RG_INSTRUCTION_COUNT_H

#include <stdbool.h>

typedef struct {
    double flops;  /* additions, subtractions, multiplications, divisions, roots of all lanes; a fused
                      multiply-add is two */
    double widest; /* of these, in vectors of the widest kind met */
    double fused;  /* of these, in fused multiply-adds */
    int width;     /* of the widest vectors, in bytes */
} instruction_count;

/* Why nothing can be counted here (not x86-64 Linux, no objdump, no trap flag), or NULL. */
const char *instruction_count_unavailable(void);

/* Counts run(context), which runs in a child: it changes nothing in this process. */
instruction_count instruction_count_of(void (*run)(void *context), void *context);

#endif
