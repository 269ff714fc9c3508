/* Compressed bytes as they were before. */
#ifndef RG_UNPACK_H
#define RG_UNPACK_H

#include <stdbool.h>
#include <stddef.h>

typedef enum { RG_PLAIN, RG_ZLIB, RG_LZ4, RG_LZMA } rg_packing;

/* Whether this build can; RG_LZMA wants liblzma. */
bool rg_can_unpack(rg_packing p);

/* Unpacks in[size] into out[*room], and sets *room to how much that was; false: damaged, or too much. */
bool rg_unpack(rg_packing p, const unsigned char *in, size_t size, unsigned char *out, size_t *room);

#endif
