/* The end of a test program that gives back all its memory (support/tap.h). */
#ifndef RG_TAP_MEMORY_H
#define RG_TAP_MEMORY_H

#include "base/mem.h"
#include "support/tap.h"

/* Prints the plan, with a failure where blocks are left. The exit status. */
static inline int finish_with_nothing_left(void) {
    report(rg_alloc_blocks() == 0, "memory", "all blocks are given back");
    return finish();
}

#endif
