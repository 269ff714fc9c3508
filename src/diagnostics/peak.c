#include "diagnostics/peak.h"

#include <math.h>

rg_peak rg_peak_of(const rg_peak *a, const rg_peak *b) {
    double lead = fabs(a->value) - fabs(b->value);
    return lead > 0 || (lead == 0 && a->face <= b->face) ? *a : *b;
}

rg_peak rg_peak_reduce(const rg_peak *mine, MPI_Comm comm) {
    double size = fabs(mine->value);
    MPI_Allreduce(MPI_IN_PLACE, &size, 1, MPI_DOUBLE, MPI_MAX, comm);
    int64_t face = fabs(mine->value) == size ? mine->face : INT64_MAX;
    MPI_Allreduce(MPI_IN_PLACE, &face, 1, MPI_INT64_T, MPI_MIN, comm);
    double told[4] = {INFINITY, INFINITY, INFINITY, INFINITY};
    if (size > 0 && fabs(mine->value) == size && mine->face == face) {
        told[0] = mine->value;
        for (int c = 0; c < 3; c++) {
            told[1 + c] = mine->place[c];
        }
    }
    MPI_Allreduce(MPI_IN_PLACE, told, 4, MPI_DOUBLE, MPI_MIN, comm);
    return size > 0 ? (rg_peak){told[0], face, {told[1], told[2], told[3]}} : (rg_peak){0};
}
