#define _DEFAULT_SOURCE /* madvise */
#include "base/mem.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

#include "base/error.h"

enum {
    ALIGN = 64,
    SPARE = 3 * ALIGN
}; /* SPARE: before and behind a block, for its alignment, header and guard */

/* Blocks from this size on ask the system for huge pages: a thousand times fewer page faults when they are
 * first touched, which is most of the set-up of a large mesh, and fewer misses of the address cache. */
enum { HUGE = 4 << 20 };

/* Stands right below every block. */
typedef struct {
    void *raw; /* what the C library or, if `mapped`, the system gave */
    size_t bytes, mapped;
    size_t guarded; /* bytes of the block, behind which `guard` stands if they are few */
} header;

/* Stands right behind every block but large ones, whose last page nobody may touch first. Whoever writes more
 * than he asked for is found out when the block is given back. */
static const uint64_t guard = 0x9e3779b97f4a7c15;

static size_t total, blocks;

static header *head(void *block) {
    return (header *)block - 1;
}

static _Noreturn void exhausted(size_t count, size_t size) {
    rg_fatal(RG_FAILURE, "out of memory: %zu items of %zu bytes", count, size);
}

static size_t checked_bytes(size_t count, size_t size) {
    if (size != 0 && count > (SIZE_MAX - SPARE) / size) {
        exhausted(count, size);
    }
    return count * size;
}

static void put_guard(header *h) {
    if (h->guarded < HUGE) {
        memcpy((char *)(h + 1) + h->guarded, &guard, sizeof guard);
    }
}

static void check_guard(const header *h) {
    if (h->guarded < HUGE && memcmp((const char *)(h + 1) + h->guarded, &guard, sizeof guard) != 0) {
        rg_fatal(RG_FAILURE, "a fault of this program: it wrote more than a block of %zu bytes holds",
                 h->guarded);
    }
}

/* One block more or less, and its bytes; both may be negative. */
static void count_blocks(size_t more, size_t bytes) {
#pragma omp atomic
    blocks += more;
#pragma omp atomic
    total += bytes;
}

static void *place(char *raw, header h) {
    char *block = raw + ALIGN + (ALIGN - ((uintptr_t)raw & (ALIGN - 1))) % ALIGN;
    *head(block) = h;
    put_guard(head(block));
    count_blocks(1, h.bytes);
    return block;
}

void *rg_alloc_sparse(size_t count, size_t size) {
    size_t bytes = checked_bytes(count, size);
    char *raw = calloc(1, bytes + SPARE); /* leaves large blocks as untouched zero pages */
    if (raw == NULL) {
        exhausted(count, size);
    }
    return place(raw, (header){raw, bytes, 0, bytes});
}

void *rg_alloc(size_t count, size_t size) {
    size_t bytes = checked_bytes(count, size), mapped = bytes + SPARE;
    if (bytes < HUGE) {
        return rg_alloc_sparse(count, size);
    }
    char *raw = mmap(NULL, mapped, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (raw == MAP_FAILED) {
        exhausted(count, size);
    }
    madvise(raw, mapped, MADV_HUGEPAGE); /* a hint; refused it costs nothing */
    return place(raw, (header){raw, bytes, mapped, bytes});
}

void *rg_realloc(void *block, size_t count, size_t size) {
    header *old = block == NULL ? NULL : head(block);
    if (old != NULL) {
        check_guard(old);
    }
    size_t bytes = checked_bytes(count, size);
    header *raw = realloc(old, sizeof(header) + bytes + sizeof guard);
    if (raw == NULL) {
        exhausted(count, size);
    }
    count_blocks(old == NULL, 0);
    *raw = (header){.raw = raw, .guarded = bytes}; /* its bytes are not counted: set-up only */
    put_guard(raw);
    return raw + 1;
}

void rg_free(void *block) {
    if (block != NULL) {
        header *h = head(block);
        check_guard(h);
        count_blocks((size_t)-1, -h->bytes);
        if (h->mapped > 0) {
            munmap(h->raw, h->mapped);
        } else {
            free(h->raw);
        }
    }
}

size_t rg_alloc_total(void) {
    return total;
}

size_t rg_alloc_blocks(void) {
    return blocks;
}
