#include "mem.h"

#include <stdint.h>
#include <stdlib.h>

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
