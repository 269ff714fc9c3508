#define _DEFAULT_SOURCE 1 /* madvise */
#include "mem.h"

#include <stdint.h>
#include <stdlib.h>
#include <sys/mman.h>

#include "error.h"

enum { ALIGN = 64 };

/* Stands right below every block. */
typedef struct {
    void *raw; /* what the C library gave */
    size_t bytes;
} header;

static size_t total;

static header *head(void *block) {
    return (header *)block - 1;
}

static _Noreturn void exhausted(size_t count, size_t size) {
    rg_fatal(RG_FAILURE, "out of memory: %zu items of %zu bytes", count, size);
}

/* Large blocks on huge pages where the system leaves it to the program: the sweeps touch many pages at once,
 * and misses of the TLB cost more than misses of the cache. Only advice, so its failure does not matter. */
static void advise(char *raw, size_t bytes) {
#ifdef MADV_HUGEPAGE
    const size_t huge = (size_t)2 << 20;
    char *begin = raw + (huge - ((uintptr_t)raw & (huge - 1))) % huge;
    if (bytes >= 4 * huge) {
        madvise(begin, (bytes - (size_t)(begin - raw)) / huge * huge, MADV_HUGEPAGE);
    }
#else
    (void)raw;
    (void)bytes;
#endif
}

void *rg_alloc(size_t count, size_t size) {
    if (size != 0 && count > (SIZE_MAX - 2 * ALIGN) / size) {
        exhausted(count, size);
    }
    size_t bytes = count * size;
    char *raw = calloc(1, bytes + 2 * ALIGN); /* leaves large blocks as untouched zero pages */
    if (raw == NULL) {
        exhausted(count, size);
    }
    char *block = raw + ALIGN + (ALIGN - ((uintptr_t)raw & (ALIGN - 1))) % ALIGN;
    *head(block) = (header){raw, bytes};
    advise(raw, bytes);
#pragma omp atomic
    total += bytes;
    return block;
}

void *rg_realloc(void *block, size_t count, size_t size) {
    header *old = block == NULL ? NULL : head(block);
    header *raw = realloc(old, count * size + sizeof(header));
    if (raw == NULL) {
        exhausted(count, size);
    }
    *raw = (header){raw, 0}; /* not counted: set-up only */
    return raw + 1;
}

void rg_free(void *block) {
    if (block != NULL) {
#pragma omp atomic
        total -= head(block)->bytes;
        free(head(block)->raw);
    }
}

size_t rg_alloc_total(void) {
    return total;
}
