#include <string.h>

#include "kernels.h"
#include "support/deshpande_evans_points.h"

#define POINT_SET(isa, label)                                                                                \
    void points_step_##isa(const points *, size_t);                                                          \
    void points_at_rest_##isa(const points *, size_t);                                                       \
    void points_hencky_##isa(const double *, double *, size_t);                                              \
    void points_math_##isa(math_function, double, const double *, double *, size_t);                         \
    static const point_set set_##isa = {label, points_step_##isa, points_at_rest_##isa, points_hencky_##isa, \
                                        points_math_##isa}

#ifdef RG_X86
POINT_SET(v4, "x86-64-v4");
POINT_SET(v3, "x86-64-v3");
POINT_SET(v2, "x86-64-v2");
static const point_set *const all[] = {&set_v4, &set_v3, &set_v2};
#else
POINT_SET(generic, "generic");
static const point_set *const all[] = {&set_generic};
#endif

int point_sets(point_set sets[3]) {
    const rg_kernels *available[3];
    int n = 0, count = rg_kernels_available(available, 3);
    for (int k = 0; k < count; k++) {
        for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
            if (strcmp(all[i]->name, available[k]->name) == 0) {
                sets[n++] = *all[i];
            }
        }
    }
    return n;
}
