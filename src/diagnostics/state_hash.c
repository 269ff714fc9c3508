#include "diagnostics/state_hash.h"

#include <string.h>

#include "base/hash.h"
#include "diagnostics/crack_surface.h"
#include "solver/tile.h"

static uint64_t element_hash(const rg_solver *s, size_t slot) {
    uint64_t h = rg_hash(1, (uint64_t)s->domain->id[slot]);
    for (int k = 0; k < 3 * RG_NODES; k++) {
        size_t at = rg_node_index(slot, k / 3, k % 3);
        h = rg_hash_double(rg_hash_double(h, s->u[at]), s->step_velocity[at]);
    }
    size_t rows = rg_history_rows(rg_material_values(rg_material_of(s, slot)));
    for (size_t row = 0; row < rows; row++) {
        h = rg_hash_double(h, rg_history_value(s, slot, row));
    }
    h = s->contact_heat != NULL ? rg_hash_double(h, s->contact_heat[slot]) : h;
    return s->heat != NULL ? rg_hash_double(h, s->heat[slot]) : h;
}

static uint64_t interface_hash(const rg_solver *s, const rg_tile *t, size_t i) {
    int32_t link = s->domain->side[0][i];
    rg_gid element = s->domain->id[t->begin * RG_LANES + (size_t)link / RG_FACES];
    uint64_t h = rg_hash(2, (uint64_t)(RG_FACES * element + link % RG_FACES));
    for (int q = 0; q < RG_POINTS; q++) {
        h = rg_hash_double(h, rg_damage(s, i, q));
        for (int k = 0; k < RG_FRICTION && s->model->law.sliding == RG_SLIDING_COULOMB; k++) {
            h = rg_hash_double(h, *rg_friction_value(s, i, q, k));
        }
    }
    return h;
}

static uint64_t body_hash(const rg_body *b, int number) {
    uint64_t h = rg_hash(3, (uint64_t)number);
    for (int c = 0; c < 3; c++) {
        h = rg_hash_double(rg_hash_double(h, b->seen.x[c]), b->seen.v[c]);
    }
    for (int k = 0; b->turns && k < 4; k++) {
        h = rg_hash_double(h, b->turn.seen_rotation[k]);
    }
    for (int c = 0; b->turns && c < 3; c++) {
        h = rg_hash_double(h, b->turn.seen_spin[c]);
    }
    return h;
}

uint64_t rg_state_hash(const rg_solver *s) {
    const rg_domain *d = s->domain;
    uint64_t sum = 0;
    for (size_t slot = 0; slot < d->blocks * RG_LANES; slot++) {
        sum += d->id[slot] >= 0 ? element_hash(s, slot) : 0;
    }
    for (size_t t = 0; t < d->tiles; t++) {
        for (size_t i = d->tile[t].ibegin * RG_LANES; i < d->tile[t].iend * RG_LANES; i++) {
            sum += s->broken[i] && d->counted[i] ? interface_hash(s, &d->tile[t], i) : 0;
        }
    }
    for (int i = 0; s->rank == 0 && i < s->bodies->count; i++) {
        sum += body_hash(&s->bodies->body[i], i);
    }
    MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_UINT64_T, MPI_SUM, s->comm);
    return sum;
}

uint64_t rg_energy_hash(const rg_energy *e) {
    uint64_t word[sizeof *e / sizeof(uint64_t)], h = 0; /* all members have 64 bits: there are no gaps */
    memcpy(word, e, sizeof word);
    for (size_t i = 0; i < sizeof word / sizeof *word; i++) {
        h = rg_hash(h, word[i]);
    }
    return h;
}
