/* From the partition to the global order: every rank gets a contiguous slab of the global element numbers, so
 * that what is written does not depend on the partition. */
#ifndef RG_SLAB_H
#define RG_SLAB_H

#include "domain.h"

typedef struct {
    int rank, ranks;
    rg_gid total; /* elements of the mesh */
    rg_gid first; /* this rank's slab */
    size_t count;
    size_t own;    /* own elements, in the order of `slot` */
    rg_lid *slot;  /* [own]: slots of the own elements by ascending global number */
    size_t *place; /* [count]: row of the slab that each received record belongs to */
    int *send, *send_at, *receive, *receive_at; /* [ranks]: records */
    MPI_Comm comm;
} rg_slab;

/* Rank whose slab holds element `id` of `total`. */
int rg_slab_owner(rg_gid total, int ranks, rg_gid id);

/* Collective. Free with rg_slab_free. */
rg_slab *rg_slab_make(const rg_domain *d, rg_gid total, MPI_Comm comm);

/* Collective: in[own][values], in the order of `slot`, becomes out[count][values] in global order. */
void rg_slab_send(const rg_slab *s, int values, const double *in, double *out);

/* The same for records of `bytes` bytes, and back again. */
void rg_slab_send_bytes(const rg_slab *s, size_t bytes, const void *in, void *out);
void rg_slab_fetch_bytes(const rg_slab *s, size_t bytes, const void *in, void *out);

/* Row of the slab to which record i (in the order of `slot`) belongs if that is this rank's, else SIZE_MAX.
 * Who puts those there at once has only the others to send: `in` is not read where records stay. The sending
 * is collective. */
size_t rg_slab_place(const rg_slab *s, size_t i);
void rg_slab_send_others(const rg_slab *s, size_t bytes, const void *in, void *out);

/* Row of own element `id` in the order of `slot`. */
size_t rg_slab_row(const rg_slab *s, const rg_domain *d, rg_gid id);

void rg_slab_free(rg_slab *s);

#endif
