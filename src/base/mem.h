/* Memory: 64-byte aligned, zero where it says so, never NULL (out of memory ends the run with a message). Who
 * writes behind a block, unless it is a large one, ends the run when it is given back. */
#ifndef RG_MEM_H
#define RG_MEM_H

#include <stddef.h>

/* `count` items of `size` bytes, aligned to 64 bytes, zeroed; pages are not touched before their first use,
 * so that the thread which uses them places them. Free with rg_free. */
void *rg_alloc(size_t count, size_t size);

/* The same for a large array of which only parts will be used: what is not touched costs no memory. */
void *rg_alloc_sparse(size_t count, size_t size);

/* Grows or shrinks a block from rg_realloc(NULL, ...); not aligned, for set-up only. Free with rg_free. */
void *rg_realloc(void *block, size_t count, size_t size);

/* Makes room for more than `count` items in a block from rg_realloc that has it for *room of them: by so much
 * at once that to add one after the other takes a time that grows with their number. */
static inline void *rg_grow(void *block, size_t *room, size_t count, size_t size) {
    if (count < *room) {
        return block;
    }
    *room = count + count / 2 + 64;
    return rg_realloc(block, *room, size);
}

void rg_free(void *block);

/* Bytes that rg_alloc has given and rg_free has not taken back (address space; untouched pages cost nothing).
 */
size_t rg_alloc_total(void);

/* Blocks of any of these functions that rg_free has not taken back: for tests, which shall leave none. */
size_t rg_alloc_blocks(void);

#define RG_NEW(type, count) ((type *)rg_alloc((count), sizeof(type)))

#endif
