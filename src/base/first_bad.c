#include "base/first_bad.h"

#include <string.h>

static bool lower(const rg_first_bad *a, const rg_first_bad *b) {
    if (a->which != b->which) {
        return a->which < b->which;
    }
    for (int i = 0; i < 3; i++) {
        if (a->x[i] != b->x[i]) {
            return a->x[i] < b->x[i];
        }
    }
    return false;
}

void rg_first_bad_note(rg_first_bad *p, int64_t which, const double x[3], double value) {
    rg_first_bad here = {.which = which, .x = {x[0], x[1], x[2]}, .value = value};
    if (p->which == RG_NOWHERE || lower(&here, p)) {
        *p = here;
    }
}

/* An operation of MPI, on one element. */
static void take_lower(void *in, void *inout, int *length, MPI_Datatype *type) {
    const rg_first_bad *a = in;
    rg_first_bad *b = inout;
    (void)length;
    (void)type;
    *b = lower(a, b) ? *a : *b;
}

bool rg_first_bad_lowest(rg_first_bad *p, MPI_Comm comm) {
    MPI_Datatype type;
    MPI_Op op;
    MPI_Type_contiguous(sizeof *p, MPI_BYTE, &type);
    MPI_Type_commit(&type);
    MPI_Op_create(take_lower, 1, &op);
    MPI_Allreduce(MPI_IN_PLACE, p, 1, type, op, comm);
    MPI_Op_free(&op);
    MPI_Type_free(&type);
    return p->which != RG_NOWHERE;
}

void rg_speak(MPI_Comm comm) {
    int rank;
    MPI_Comm_rank(comm, &rank);
    if (rank > 0) {
        MPI_Barrier(comm); /* until rank 0 ends the job */
    }
}
