#include "state_hash.h"

#include <string.h>

#include "crack_surface.h"
#include "hash.h"

static uint64_t chain(uint64_t h, double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return rg_hash(h, bits);
}

static uint64_t element_hash(const rg_solver *s, size_t slot) {
    uint64_t h = rg_hash(1, (uint64_t)s->domain->id[slot]);
    for (int k = 0; k < 3 * RG_NODES; k++) {
        size_t at = rg_node_index(slot, k / 3, k % 3);
        h = chain(chain(h, s->u[at]), s->velocity[at]);
    }
    return h;
}

static uint64_t interface_hash(const rg_solver *s, size_t i) {
    int32_t minus = s->domain->side[0][i];
    uint64_t h = rg_hash(2, (uint64_t)(RG_FACES * s->domain->id[minus / RG_FACES] + minus % RG_FACES));
    for (int q = 0; q < RG_POINTS; q++) {
        h = chain(h, rg_damage(s, i, q));
    }
    return h;
}

uint64_t rg_state_hash(const rg_solver *s) {
    uint64_t sum = 0;
    for (size_t slot = 0; slot < s->domain->blocks * RG_LANES; slot++) {
        sum += s->domain->id[slot] >= 0 ? element_hash(s, slot) : 0;
    }
    for (size_t i = 0; i < s->domain->iblocks * RG_LANES; i++) {
        sum += s->broken[i] && s->domain->counted[i] ? interface_hash(s, i) : 0;
    }
    MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_UINT64_T, MPI_SUM, s->comm);
    return sum;
}
