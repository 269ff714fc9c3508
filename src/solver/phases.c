#include "solver/phases.h"

static const char *const phase_name[RG_PHASES] = {"compute", "jump", "pack", "exchange", "wait", "reduce"};

static rg_spread spread(double here, MPI_Comm comm) {
    double extreme[2] = {-here, here}, sum = here;
    int ranks;
    MPI_Comm_size(comm, &ranks);
    MPI_Allreduce(MPI_IN_PLACE, extreme, 2, MPI_DOUBLE, MPI_MAX, comm);
    MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, comm);
    return (rg_spread){-extreme[0], sum / ranks, extreme[1]};
}

rg_phases_report rg_phases_gather(const rg_phases *p, const rg_domain *d, rg_halo *const halo[], int halos,
                                  MPI_Comm comm) {
    int partners = 0, messages = 0;
    double bytes = 0;
    for (int k = 0; k < halos; k++) {
        int own = rg_halo_partners(halo[k]);
        partners = own > partners ? own : partners;
        messages += own;
        bytes += (double)rg_halo_bytes(halo[k]);
    }
    rg_phases_report r;
    for (int k = 0; k < RG_PHASES; k++) {
        r.phase[k] = spread(p->seconds[k], comm);
    }
    r.neighbours = spread(partners, comm);
    r.inner = spread(1 - (double)d->boundary_tiles / (double)d->tiles, comm);
    r.messages = spread(messages, comm);
    r.bytes = spread(bytes, comm);
    r.message_bytes = spread(messages > 0 ? bytes / messages : 0, comm);
    return r;
}

static void put(FILE *out, const char *indent, const char *name, const rg_spread *s, const char *end) {
    fprintf(out, "%s\"%s\": [%.6g, %.6g, %.6g]%s\n", indent, name, s->least, s->mean, s->most, end);
}

void rg_phases_write(const rg_phases_report *r, FILE *out) {
    fputs("  \"phases_s\": {\n", out);
    for (int k = 0; k < RG_PHASES; k++) {
        put(out, "    ", phase_name[k], &r->phase[k], k + 1 < RG_PHASES ? "," : "");
    }
    fputs("  },\n", out);
    put(out, "  ", "neighbours", &r->neighbours, ",");
    put(out, "  ", "inner_share", &r->inner, ",");
    put(out, "  ", "messages_per_step", &r->messages, ",");
    put(out, "  ", "bytes_per_step", &r->bytes, ",");
    put(out, "  ", "bytes_per_message", &r->message_bytes, ",");
}
