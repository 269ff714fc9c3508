/* Values of a test program that does not end with its first failure. */
#ifndef RG_TEST_NEAR_H
#define RG_TEST_NEAR_H

#include <math.h>
#include <stdbool.h>
#include <stdio.h>

/* Whether what is found is what is wanted to within `most`; tells where it is not. */
static inline bool near(double found, double wanted, double most) {
    bool good = fabs(found - wanted) <= most;
    if (!good) {
        printf("# %.17g, not %.17g: %.2g of what may be\n", found, wanted, fabs(found - wanted) / most);
    }
    return good;
}

#endif
