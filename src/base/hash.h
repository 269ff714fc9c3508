/* Counter-based hashing: the same numbers from the same keys on any rank, thread and machine. */
#ifndef RG_HASH_H
#define RG_HASH_H

#include <stdint.h>
#include <string.h>

/* splitmix64 finalizer (Steele, Lea & Flood 2014): mixes one 64-bit word. */
static inline uint64_t rg_mix(uint64_t z) {
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return z ^ (z >> 31);
}

/* Chains word `w` into hash `h`. */
static inline uint64_t rg_hash(uint64_t h, uint64_t w) {
    return rg_mix(h + UINT64_C(0x9e3779b97f4a7c15) + rg_mix(w));
}

/* Chains the bits of `x`; 0 and -0 differ. */
static inline uint64_t rg_hash_double(uint64_t h, double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return rg_hash(h, bits);
}

/* Uniform number in [0, 1) from a hash. */
static inline double rg_hash_uniform(uint64_t h) {
    return (double)(h >> 11) * 0x1p-53;
}

#endif
