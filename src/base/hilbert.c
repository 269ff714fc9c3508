/* J. Skilling, Programming the Hilbert curve, AIP Conference Proceedings 707 (2004) 381-387. */
#include "base/hilbert.h"

/* Skilling's transform: turns coordinates in place into the transposed index, whose bits interleave to the
 * index. */
static void transpose(uint32_t c[3]) {
    const uint32_t top = UINT32_C(1) << (RG_HILBERT_BITS - 1);
    for (uint32_t bit = top; bit > 1; bit >>= 1) {
        uint32_t below = bit - 1;
        for (int i = 0; i < 3; i++) {
            if (c[i] & bit) {
                c[0] ^= below;
            } else {
                uint32_t swap = (c[0] ^ c[i]) & below;
                c[0] ^= swap;
                c[i] ^= swap;
            }
        }
    }
    c[1] ^= c[0];
    c[2] ^= c[1];
    uint32_t flip = 0;
    for (uint32_t bit = top; bit > 1; bit >>= 1) {
        flip ^= (c[2] & bit) ? bit - 1 : 0;
    }
    for (int i = 0; i < 3; i++) {
        c[i] ^= flip;
    }
}

uint64_t rg_hilbert_cell(const uint32_t cell[3]) {
    uint32_t c[3] = {cell[0], cell[1], cell[2]};
    transpose(c);
    uint64_t index = 0;
    for (int bit = RG_HILBERT_BITS - 1; bit >= 0; bit--) {
        for (int i = 0; i < 3; i++) {
            index = index << 1 | (c[i] >> bit & 1);
        }
    }
    return index;
}

uint64_t rg_hilbert_point(const double x[3], const double low[3], double edge) {
    const double cells = (double)(UINT32_C(1) << RG_HILBERT_BITS);
    uint32_t cell[3];
    for (int i = 0; i < 3; i++) {
        double at = (x[i] - low[i]) / edge * cells;
        at = at > 0.0 ? at : 0.0;
        cell[i] = (uint32_t)(at < cells ? at : cells - 1.0);
    }
    return rg_hilbert_cell(cell);
}
