#include "base/denormals.h"

#if defined(__SSE2__)
#include <xmmintrin.h>

void rg_flush_denormals(void) {
    enum { DENORMALS_ARE_ZERO = 0x0040, FLUSH_TO_ZERO = 0x8000 };
#pragma omp parallel
    _mm_setcsr(_mm_getcsr() | DENORMALS_ARE_ZERO | FLUSH_TO_ZERO);
}
#else
void rg_flush_denormals(void) {
}
#endif
