/* From the partition to the global order: every rank gets a contiguous slab of the global element numbers, so
 * that what is written does not depend on the partition. */
#ifndef RG_SLAB_H
#define RG_SLAB_H

#include "domain/domain.h"

typedef struct {
    int rank, ranks;
    rg_gid total; /* elements of the mesh */
    rg_gid first; /* this rank's slab */
    size_t count;
    size_t own;    /* own elements, in the order of `slot` */
    rg_lid *slot;  /* [own]: slots of the own elements by ascending global number */
    size_t *row;   /* [own]: row that each of them has in the slab of its rank */
    size_t *place; /* [count]: row of the slab that each received record belongs to */
    int *send, *send_at, *receive, *receive_at; /* [ranks]: records */
    char *room; /* for records on their way, kept from one window to the next */
    size_t room_bytes;
    MPI_Comm comm;
} rg_slab;

/* Moves the record of own element i (in the order of `slot`) to `record`, or from there. Several threads call
 * it at once. */
typedef void rg_slab_move(const void *of, size_t i, void *record);

/* Rank whose slab holds element `id` of `total`. */
int rg_slab_owner(rg_gid total, int ranks, rg_gid id);

/* Collective. Free with rg_slab_free. */
rg_slab *rg_slab_make(const rg_domain *d, rg_gid total, MPI_Comm comm);

/* The same, made when it is first asked for and kept in *slab, which is NULL until then. */
rg_slab *rg_slab_shared(rg_slab **slab, const rg_domain *d, rg_gid total, MPI_Comm comm);

/* Rows of a window that holds a few megabytes of records; rows of the largest slab. */
size_t rg_slab_window(size_t bytes);
size_t rg_slab_most(const rg_slab *s);

/* Collective: the window of rows [first, first + rows) of every slab, as far as it has them, in global order:
 * out[.][bytes]. Returns how many rows that is here. Who goes through all slabs window by window needs no
 * copy of all records. */
size_t rg_slab_gather(rg_slab *s, size_t first, size_t rows, size_t bytes, rg_slab_move *get, const void *of,
                      char *out);

/* The way back: records of the same window, in[.][bytes], each to its element. Collective. */
void rg_slab_scatter(rg_slab *s, size_t first, size_t rows, size_t bytes, char *in, rg_slab_move *put,
                     const void *of);

void rg_slab_free(rg_slab *s);

#endif
