/* Records on their way from the partition to the global order, window by window, on any number of ranks: each
 * element comes to its row once and gets its record back, whatever the windows. Prints TAP. */
#include "domain/slab.h"

#include <string.h>

#include "base/hash.h"
#include "base/mem.h"
#include "layout.h"
#include "support/tap_memory.h"

enum { TOTAL = 1009, VALUES = 3 };

static int ranks;

/* The elements of this rank, in blocks with gaps and in no order. `side`: the most of them have their slab on
 * it; else they are anywhere, and the last rank has none. */
static rg_domain make_domain(bool side) {
    rg_domain d = {.blocks = TOTAL / RG_LANES + 1};
    d.id = RG_NEW(rg_gid, d.blocks * RG_LANES);
    for (size_t i = 0; i < d.blocks * RG_LANES; i++) {
        rg_gid id = (rg_gid)(i * 631 % TOTAL); /* a permutation of the first TOTAL */
        int owner = side ? rg_slab_owner(TOTAL, ranks, id) : 0;
        if (!side || rg_hash((uint64_t)id, 1) % 8 == 0) {
            owner = (int)(rg_hash((uint64_t)id, 2) % (uint64_t)(ranks > 1 ? ranks - 1 : 1));
        }
        d.id[i] = i < TOTAL && owner == rank ? id : -1;
        d.elements += d.id[i] >= 0;
    }
    return d;
}

static double value(rg_gid id, size_t k) {
    return (double)id + 0.125 * (double)k;
}

typedef struct {
    const rg_slab *slab;
    const rg_domain *domain;
    double *back; /* what came back */
} source;

static void get(const void *of, size_t i, void *out) {
    const source *s = of;
    double record[VALUES];
    for (size_t k = 0; k < VALUES; k++) {
        record[k] = value(s->domain->id[s->slab->slot[i]], k);
    }
    memcpy(out, record, sizeof record);
}

/* Whether row i of `rows` rows from `first` on is that of its element. */
static bool right(const rg_slab *s, size_t first, size_t rows, const double *row) {
    bool good = true;
    for (size_t i = 0; i < VALUES * rows; i++) {
        double wanted = value(s->first + (rg_gid)(first + i / VALUES), i % VALUES);
        good = good && memcmp(&row[i], &wanted, sizeof wanted) == 0;
    }
    return good;
}

/* Writes the record that came back to its element, [TOTAL][VALUES] by global number. */
static void put(const void *of, size_t i, void *in) {
    const source *s = of;
    memcpy(s->back + VALUES * s->domain->id[s->slab->slot[i]], in, VALUES * sizeof *s->back);
}

/* Whether all own elements have their records back, and nobody else's came. */
static bool all_back(const source *s) {
    bool good = true;
    size_t own = 0;
    for (size_t i = 0; i < s->domain->blocks * RG_LANES; i++) {
        rg_gid id = s->domain->id[i];
        for (size_t k = 0; id >= 0 && k < VALUES; k++) {
            double wanted = value(id, k);
            good = good && memcmp(s->back + VALUES * id + k, &wanted, sizeof wanted) == 0;
        }
    }
    for (size_t i = 0; i < VALUES * TOTAL; i++) {
        own += s->back[i] >= 0;
    }
    return good && own == VALUES * s->domain->elements;
}

static bool by_windows(rg_slab *s, const rg_domain *d, size_t rows) {
    double back[VALUES * TOTAL];
    source of = {s, d, back};
    for (size_t i = 0; i < VALUES * TOTAL; i++) {
        back[i] = -1;
    }
    double *window = RG_NEW(double, VALUES *rows + 1);
    size_t sum = 0;
    bool good = true;
    for (size_t first = 0; first < rg_slab_most(s); first += rows) {
        window[VALUES * rows] = -1;
        size_t here = rg_slab_gather(s, first, rows, VALUES * sizeof *window, get, &of, (char *)window);
        good = here <= rows && right(s, first, here, window) && window[VALUES * rows] < 0 && good;
        rg_slab_scatter(s, first, rows, VALUES * sizeof *window, (char *)window, put, &of);
        sum += here;
    }
    rg_free(window);
    return good && sum == s->count && all_back(&of);
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    for (int side = 0; side < 2; side++) {
        rg_domain d = make_domain(side);
        rg_slab *s = rg_slab_make(&d, TOTAL, MPI_COMM_WORLD);
        const char *where = side ? "most elements on the rank of their slab" : "a rank without elements";
        report(by_windows(s, &d, 1), where, "windows of one row");
        report(by_windows(s, &d, 100), where, "windows of 100 rows");
        report(by_windows(s, &d, 2 * TOTAL), where, "one window");
        rg_slab_free(s);
        rg_free(d.id);
    }
    return finish_with_nothing_left();
}
