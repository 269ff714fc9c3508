#define _DEFAULT_SOURCE /* madvise */
#include "base/mem.h"

#include <stdint.h>
#include <stdlib.h>
#include <sys/mman.h>

#include "base/error.h"

enum { ALIGN = 64 };

/* Blocks from this size on ask the system for huge pages: a thousand times fewer page faults when they are
 * first touched, which is most of the set-up of a large mesh, and fewer misses of the address cache. */
enum { HUGE = 4 << 20 };

/* Stands right below every block. */
typedef struct {
    void *raw; /* what the C library or, if `mapped`, the system gave */
    size_t bytes, mapped;
} header;

static size_t total;

static header *head(void *block) {
    return (header *)block - 1;
}

static _Noreturn void exhausted(size_t count, size_t size) {
    rg_fatal(RG_FAILURE, "out of memory: %zu items of %zu bytes", count, size);
}

static size_t checked_bytes(size_t count, size_t size) {
    if (size != 0 && count > (SIZE_MAX - 2 * ALIGN) / size) {
        exhausted(count, size);
    }
    return count * size;
}

static void *place(char *raw, header h) {
    char *block = raw + ALIGN + (ALIGN - ((uintptr_t)raw & (ALIGN - 1))) % ALIGN;
    *head(block) = h;
#pragma omp atomic
    total += h.bytes;
    return block;
}

void *rg_alloc_sparse(size_t count, size_t size) {
    size_t bytes = checked_bytes(count, size);
    char *raw = calloc(1, bytes + 2 * ALIGN); /* leaves large blocks as untouched zero pages */
    if (raw == NULL) {
        exhausted(count, size);
    }
    return place(raw, (header){raw, bytes, 0});
}

void *rg_alloc(size_t count, size_t size) {
    size_t bytes = checked_bytes(count, size), mapped = bytes + 2 * ALIGN;
    if (bytes < HUGE) {
        return rg_alloc_sparse(count, size);
    }
    char *raw = mmap(NULL, mapped, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (raw == MAP_FAILED) {
        exhausted(count, size);
    }
    madvise(raw, mapped, MADV_HUGEPAGE); /* a hint; refused it costs nothing */
    return place(raw, (header){raw, bytes, mapped});
}

void *rg_realloc(void *block, size_t count, size_t size) {
    header *old = block == NULL ? NULL : head(block);
    header *raw = realloc(old, count * size + sizeof(header));
    if (raw == NULL) {
        exhausted(count, size);
    }
    *raw = (header){.raw = raw}; /* not counted: set-up only */
    return raw + 1;
}

void rg_free(void *block) {
    if (block != NULL) {
#pragma omp atomic
        total -= head(block)->bytes;
        if (head(block)->mapped > 0) {
            munmap(head(block)->raw, head(block)->mapped);
        } else {
            free(head(block)->raw);
        }
    }
}

size_t rg_alloc_total(void) {
    return total;
}
