#include "base/input_errors.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/error.h"
#include "base/mem.h"

static int compare(const int64_t a[2], const int64_t b[2]) {
    int first = (a[0] > b[0]) - (a[0] < b[0]), second = (a[1] > b[1]) - (a[1] < b[1]);
    return first != 0 ? first : second;
}

char *rg_input_errors_place(rg_input_errors *f, int64_t key, int64_t second) {
    const int64_t keys[2] = {key, second};
    int at = f->kept;
    f->count++;
    while (at > 0 && compare(keys, f->input_error[at - 1].key) < 0) {
        at--;
    }
    if (at == RG_INPUT_ERRORS_TOLD) {
        return NULL;
    }
    f->kept += f->kept < RG_INPUT_ERRORS_TOLD;
    memmove(f->input_error + at + 1, f->input_error + at,
            (size_t)(f->kept - 1 - at) * sizeof *f->input_error);
    memcpy(f->input_error[at].key, keys, sizeof keys);
    return f->input_error[at].words;
}

void rg_input_errors_add(rg_input_errors *f, int64_t key, int64_t second, const char *format, ...) {
    char *words = rg_input_errors_place(f, key, second);
    if (words != NULL) {
        va_list args;
        va_start(args, format);
        vsnprintf(words, RG_INPUT_ERROR_WORDS, format, args);
        va_end(args);
    }
}

void rg_input_errors_end(const rg_input_errors *f) {
    if (f->count == 0) {
        return;
    }
    const char *join = "\nrhegma: "; /* rg_fatal says the first */
    size_t size = (size_t)(f->kept + 1) * (strlen(join) + strlen(f->name) + RG_INPUT_ERROR_WORDS + 2),
           used = 0;
    char *all = RG_NEW(char, size);
    for (int i = 0; i < f->kept; i++) {
        used += (size_t)snprintf(all + used, size - used, "%s%s: %s", i > 0 ? join : "", f->name,
                                 f->input_error[i].words);
    }
    if (f->count > f->kept) {
        snprintf(all + used, size - used, "%s%s: and %" PRId64 " more", join, f->name, f->count - f->kept);
    }
    rg_fatal(RG_USAGE, "%s", all);
}

/* Two lists become one, as an operation of MPI on one element. */
static void merge(void *in, void *inout, int *length, MPI_Datatype *type) {
    const rg_input_errors *a = in;
    rg_input_errors *out = inout, b = *out;
    int i = 0, j = 0;
    (void)length;
    (void)type;
    out->count = a->count + b.count;
    for (out->kept = 0; out->kept < RG_INPUT_ERRORS_TOLD && (i < a->kept || j < b.kept); out->kept++) {
        int order = i == a->kept  ? 1
                    : j == b.kept ? -1
                                  : compare(a->input_error[i].key, b.input_error[j].key);
        bool first = order < 0 || (order == 0 && strcmp(a->input_error[i].words, b.input_error[j].words) < 0);
        out->input_error[out->kept] = first ? a->input_error[i] : b.input_error[j];
        out->count -= order == 0;
        i += order <= 0;
        j += order >= 0;
    }
}

bool rg_input_errors_gather(const rg_input_errors *f, rg_input_errors *all, MPI_Comm comm) {
    int64_t count = f->count;
    MPI_Allreduce(MPI_IN_PLACE, &count, 1, MPI_INT64_T, MPI_SUM, comm);
    if (count == 0) {
        return false;
    }
    MPI_Datatype type;
    MPI_Op op;
    MPI_Type_contiguous(sizeof *all, MPI_BYTE, &type);
    MPI_Type_commit(&type);
    MPI_Op_create(merge, 1, &op);
    MPI_Reduce(f, all, 1, type, op, 0, comm);
    MPI_Op_free(&op);
    MPI_Type_free(&type);
    all->name = f->name; /* not another rank's pointer */
    return true;
}

void rg_input_errors_agree(const rg_input_errors *f, MPI_Comm comm) {
    rg_input_errors all = *f;
    if (rg_input_errors_gather(f, &all, comm)) {
        int rank;
        MPI_Comm_rank(comm, &rank);
        if (rank == 0) {
            rg_input_errors_end(&all);
        }
        MPI_Barrier(comm); /* until rank 0 ends the job */
    }
}
