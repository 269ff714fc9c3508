/* Rows that only some elements have, on their way between the partition and the global order (domain/slab.h).
 */
#ifndef RG_SPARSE_H
#define RG_SPARSE_H

#include <string.h>

#include "domain/slab.h"

/* Each row begins with its key, an int64_t: 4 * global number of the element + 0 to 3. */
typedef struct {
    size_t rows, bytes; /* bytes of a row, the key included */
    char *row;
} rg_sparse;

static inline int64_t rg_sparse_key(const rg_sparse *s, size_t i) {
    int64_t key;
    memcpy(&key, s->row + i * s->bytes, sizeof key);
    return key;
}

/* Collective: the rows of own elements become those of the slab, sorted by key. The caller frees `row`. */
rg_sparse rg_sparse_to_slab(const rg_slab *slab, const rg_sparse *own);

/* Collective: the rows of the slab go to the ranks that own their elements. The caller frees `row`. */
rg_sparse rg_sparse_to_owners(const rg_slab *slab, const rg_sparse *sorted);

#endif
