#include "mesh/import/unpack.h"

#include <string.h>
#include <zlib.h>
#if __has_include(<lzma.h>)
#include <lzma.h>
#define HAS_LZMA
#endif

static bool unpack_zlib(const unsigned char *in, size_t size, unsigned char *out, size_t *room) {
    uLongf length = (uLongf)*room;
    bool good = uncompress(out, &length, in, (uLong)size) == Z_OK;
    *room = (size_t)length;
    return good;
}

/* The file of xz, in memory. */
static bool unpack_lzma(const unsigned char *in, size_t size, unsigned char *out, size_t *room) {
#ifdef HAS_LZMA
    uint64_t most = UINT64_C(1) << 27; /* bytes of memory: xz takes half of it at most */
    size_t taken = 0, given = 0;
    bool good = lzma_stream_buffer_decode(&most, 0, NULL, in, &taken, size, out, &given, *room) == LZMA_OK;
    *room = given;
    return good && taken == size;
#else
    (void)in, (void)size, (void)out, (void)room;
    return false;
#endif
}

/* ---- LZ4: its block format ---- */

typedef struct {
    const unsigned char *at, *end;
} bytes;

/* Lengths of 15 go on in further bytes, up to one that is not 255. */
static bool take_length(bytes *b, size_t *length) {
    unsigned char more = 255;
    for (bool goes_on = *length == 15; goes_on; goes_on = more == 255) {
        if (b->at == b->end) {
            return false;
        }
        more = *b->at++;
        *length += more;
    }
    return true;
}

/* Sequences: some bytes as they are, then some from `back` bytes before, which may reach into themselves. The
 * last sequence has the first part alone. */
static bool unpack_lz4(const unsigned char *in, size_t size, unsigned char *out, size_t *room) {
    bytes b = {in, in + size};
    size_t done = 0;
    while (b.at < b.end) {
        size_t token = *b.at++, plain = token >> 4, repeated = token & 15;
        if (!take_length(&b, &plain) || plain > (size_t)(b.end - b.at) || plain > *room - done) {
            return false;
        }
        memcpy(out + done, b.at, plain);
        b.at += plain;
        done += plain;
        if (b.at == b.end) {
            *room = done;
            return true;
        }
        if (b.end - b.at < 2) {
            return false;
        }
        size_t back = b.at[0] | (size_t)b.at[1] << 8;
        b.at += 2;
        if (!take_length(&b, &repeated) || back == 0 || back > done || repeated + 4 > *room - done) {
            return false;
        }
        for (size_t i = 0; i < repeated + 4; i++, done++) {
            out[done] = out[done - back];
        }
    }
    return false;
}

/* ---- the whole ---- */

bool rg_can_unpack(rg_packing p) {
#ifdef HAS_LZMA
    (void)p;
    return true;
#else
    return p != RG_LZMA;
#endif
}

bool rg_unpack(rg_packing p, const unsigned char *in, size_t size, unsigned char *out, size_t *room) {
    switch (p) {
    case RG_ZLIB:
        return unpack_zlib(in, size, out, room);
    case RG_LZ4:
        return unpack_lz4(in, size, out, room);
    case RG_LZMA:
        return unpack_lzma(in, size, out, room);
    case RG_PLAIN:
        break;
    }
    bool fits = size <= *room;
    memcpy(out, in, fits ? size : 0);
    *room = fits ? size : 0;
    return fits;
}
