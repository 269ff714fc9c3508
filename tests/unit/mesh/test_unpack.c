/* What is unpacked: LZ4 against its format by hand and at random, LZMA and zlib against their libraries; no
 * damage gets by. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>
#if __has_include(<lzma.h>)
#include <lzma.h>
#define HAS_LZMA
#endif

#include <cmocka.h>

#include "mesh/import/unpack.h"

enum { MOST = 4000 };

static size_t unpacked(rg_packing p, const void *in, size_t size, unsigned char *out, size_t room) {
    unsigned char *exact = malloc(size + 1); /* so that a sanitizer sees who reads behind it */
    memcpy(exact, in, size);
    bool good = rg_unpack(p, exact, size, out, &room);
    free(exact);
    return good ? room : SIZE_MAX;
}

#define BYTES(...) (const unsigned char[]){__VA_ARGS__}, sizeof((const unsigned char[]){__VA_ARGS__})

static void test_sequences(void **state) {
    (void)state;
    static const struct {
        unsigned char in[40];
        size_t size;
        const char *out; /* NULL: damaged */
    } cases[] = {
        {{0x00}, 1, ""},
        {{0x30, 'a', 'b', 'c'}, 4, "abc"},
        {{0x30, 'a', 'b', 'c', 0x00}, 5, NULL},                  /* a match without its place */
        {{0x40, 'a', 'b', 'c'}, 4, NULL},                        /* fewer bytes than it says */
        {{0x30, 'a', 'b', 'c', 3, 0, 0x10, 'd'}, 8, "abcabcad"}, /* 4 from 3 before: into themselves */
        {{0x12, 'a', 1, 0, 0x00}, 5, "aaaaaaa"},
        {{0x12, 'a', 2, 0, 0x00}, 5, NULL}, /* from before the beginning */
        {{0x12, 'a', 0, 0, 0x00}, 5, NULL},
        {{0x12, 'a', 1}, 3, NULL},
        {{0x12, 'a', 1, 0}, 4, NULL}, /* the last sequence has no match */
        {{0xf0, 2, 'a', 'b', 'c', 'd', 'e', 'f', 'g', 'h', 'i', 'j', 'k', 'l', 'm', 'n', 'o', 'p', 'q'},
         19,
         "abcdefghijklmnopq"},
        {{0xf0}, 1, NULL},
        {{0x1f, 'a', 1, 0, 1, 0x00}, 6, "aaaaaaaaaaaaaaaaaaaaa"}, /* 1, then 15 + 1 + 4 */
        {{0x1f, 'a', 1, 0, 255, 255}, 6, NULL},
    };
    unsigned char out[64];
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        size_t length = unpacked(RG_LZ4, cases[i].in, cases[i].size, out, 30);
        assert_int_equal(length, cases[i].out == NULL ? SIZE_MAX : strlen(cases[i].out));
        assert_true(cases[i].out == NULL || memcmp(out, cases[i].out, length) == 0);
    }
    assert_int_equal(unpacked(RG_LZ4, BYTES(0x30, 'a', 'b', 'c'), out, 2), SIZE_MAX);
    assert_int_equal(unpacked(RG_LZ4, BYTES(0x12, 'a', 1, 0, 0x00), out, 6), SIZE_MAX);
    assert_int_equal(unpacked(RG_LZ4, BYTES(0x12, 'a', 1, 0, 0x00), out, 7), 7);
    assert_int_equal(unpacked(RG_LZ4, "", 0, out, 7), SIZE_MAX);
}

static size_t put_length(unsigned char *out, size_t at, size_t length) {
    for (length -= 15; length >= 255; length -= 255) {
        out[at++] = 255;
    }
    out[at++] = (unsigned char)length;
    return at;
}

/* Bytes of many repetitions in LZ4: at each place the match farthest back, if there is one, after some
 * literals. */
static size_t pack_lz4(const unsigned char *in, size_t size, unsigned char *out) {
    size_t at = 0, done = 0, literal = 0;
    while (done < size) {
        size_t best = 0, from = 0;
        for (size_t k = 0; k < done && best < 300; k++) {
            size_t n = 0;
            for (; done + n < size && in[k + n] == in[done + n]; n++) {
            }
            from = n > best ? k : from;
            best = n > best ? n : best;
        }
        if (best < 4 || done + best == size) { /* the end stands as it is */
            done++;
            continue;
        }
        size_t plain = done - literal, more = best - 4;
        out[at++] = (unsigned char)((plain < 15 ? plain : 15) << 4 | (more < 15 ? more : 15));
        at = plain >= 15 ? put_length(out, at, plain) : at;
        memcpy(out + at, in + literal, plain);
        at += plain;
        out[at++] = (unsigned char)((done - from) & 255);
        out[at++] = (unsigned char)((done - from) >> 8);
        at = more >= 15 ? put_length(out, at, more) : at;
        done += best;
        literal = done;
    }
    size_t plain = size - literal;
    out[at++] = (unsigned char)((plain < 15 ? plain : 15) << 4);
    at = plain >= 15 ? put_length(out, at, plain) : at;
    memcpy(out + at, in + literal, plain);
    return at + plain;
}

static size_t pack(rg_packing p, const unsigned char *in, size_t size, unsigned char *out) {
    size_t length = 2 * MOST;
    if (p == RG_LZ4) {
        return pack_lz4(in, size, out);
    }
#ifdef HAS_LZMA
    if (p == RG_LZMA) {
        size_t at = 0;
        assert_int_equal(lzma_easy_buffer_encode(5, LZMA_CHECK_CRC32, NULL, in, size, out, &at, length),
                         LZMA_OK);
        return at;
    }
#endif
    if (p == RG_ZLIB) {
        uLongf most = (uLongf)length;
        assert_int_equal(compress(out, &most, in, (uLong)size), Z_OK);
        return (size_t)most;
    }
    memcpy(out, in, size);
    return size;
}

static void test_random(void **state) {
    (void)state;
    static unsigned char in[MOST], packed[3 * MOST], out[MOST + 1];
    unsigned seed = 1;
    for (rg_packing p = RG_PLAIN; p <= RG_LZMA; p++) {
        for (int turn = 0; turn < (rg_can_unpack(p) ? 40 : 0); turn++) {
            size_t size = 0, wanted = turn == 0 ? 0 : (size_t)(rand_r(&seed) % MOST);
            while (size < wanted) { /* new bytes, or some from before */
                size_t n = 1 + (size_t)rand_r(&seed) % (turn % 3 == 0 ? 600 : 20), from = size;
                from = size > 0 && rand_r(&seed) % 3 > 0 ? (size_t)rand_r(&seed) % size : from;
                for (size_t i = 0; i < n && size < wanted; i++, size++) {
                    in[size] = from < size ? in[from + i] : (unsigned char)rand_r(&seed);
                }
            }
            size_t length = pack(p, in, size, packed);
            assert_int_equal(unpacked(p, packed, length, out, MOST), size);
            assert_memory_equal(out, in, size);
            assert_int_equal(unpacked(p, packed, length, out, size), size);
            assert_memory_equal(out, in, size);
            if (size > 0) {
                assert_int_equal(unpacked(p, packed, length, out, size - 1), SIZE_MAX);
            }
            /* damage: what comes is told or fits, and nobody writes behind it */
            for (int k = 0; length > 0 && k < 30; k++) {
                out[size] = 77;
                packed[(size_t)rand_r(&seed) % length] ^= (unsigned char)(1 << rand_r(&seed) % 8);
                unpacked(p, packed, length - (size_t)rand_r(&seed) % 2, out, size);
                assert_int_equal(out[size], 77);
            }
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_sequences), cmocka_unit_test(test_random)};
    return cmocka_run_group_tests_name("unpack", tests, NULL, NULL);
}
