#include "domain/assembly.h"

#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "domain/assembly_plan.h"
#include "domain/element.h"
#include "layout.h"

enum { TAG = 4 };

struct rg_assembly {
    const rg_domain *domain;
    rg_assembly_plan *plan;
    double *share; /* [copies]: mass of a copy over that of its node */
    rg_real *rows; /* [own rows, then those of other ranks][3] */
    rg_halo *halo;
};

/* The fields of a tile. */
static rg_real *of_tile(const rg_assembly *a, size_t tile, rg_real *field) {
    return field + a->domain->tile[tile].begin * RG_NODE_BLOCK;
}

static void write_copies(const rg_assembly_plan *p, rg_real *field, size_t node, const double value[3]) {
    for (size_t k = p->first_copy[node]; k < p->first_copy[node + 1]; k++) {
        for (int c = 0; c < 3; c++) {
            field[p->copy[k] + c * RG_LANES] = (rg_real)value[c];
        }
    }
}

void rg_assembly_sum(rg_assembly *a, size_t tile, rg_real *field) {
    const rg_assembly_plan *p = a->plan;
    rg_real *row = a->rows + 3 * p->tile[tile].row;
    field = of_tile(a, tile, field);
    for (size_t node = p->tile[tile].first; node < p->tile[tile].end; node++) {
        double sum[3] = {0, 0, 0};
        for (size_t k = p->first_copy[node]; k < p->first_copy[node + 1]; k++) {
            for (int c = 0; c < 3; c++) {
                sum[c] += a->share[k] * field[p->copy[k] + c * RG_LANES];
            }
        }
        if (node < p->tile[tile].border) {
            write_copies(p, field, node, sum);
            continue;
        }
        for (int c = 0; c < 3; c++) {
            *row++ = (rg_real)sum[c];
        }
    }
}

void rg_assembly_gather(const rg_assembly *a, size_t tile, rg_real *field) {
    const rg_assembly_plan *p = a->plan;
    size_t row = p->tile[tile].row;
    field = of_tile(a, tile, field);
    for (size_t node = p->tile[tile].border; node < p->tile[tile].end; node++, row++) {
        double sum[3] = {0, 0, 0};
        for (size_t k = p->sources[row].first; k < p->sources[row].end; k++) {
            for (int c = 0; c < 3; c++) {
                sum[c] += a->rows[3 * p->source[k] + (size_t)c];
            }
        }
        write_copies(p, field, node, sum);
    }
}

bool rg_assembly_waits(const rg_assembly *a, size_t tile) {
    return a->plan->tile[tile].waits;
}

rg_halo *rg_assembly_halo(const rg_assembly *a) {
    return a->halo;
}

void rg_assembly_mean(rg_assembly *a, rg_real *field) {
#pragma omp parallel
    {
#pragma omp for schedule(static)
        for (size_t t = 0; t < a->domain->tiles; t++) {
            rg_assembly_sum(a, t, field);
        }
        rg_halo_pack(a->halo);
#pragma omp master
        {
            rg_halo_start(a->halo);
            rg_halo_finish(a->halo);
        }
#pragma omp barrier
#pragma omp for schedule(static)
        for (size_t t = 0; t < a->domain->tiles; t++) {
            rg_assembly_gather(a, t, field);
        }
    }
}

void rg_assembly_spread(rg_assembly *a, uint16_t *mask) {
    size_t slots = a->domain->blocks * RG_LANES;
    rg_real *field = RG_NEW(rg_real, slots * 3 * RG_NODES);
    for (size_t i = 0; i < slots * RG_NODES; i++) {
        size_t slot = i / RG_NODES, n = i % RG_NODES;
        field[rg_node_index(slot, (int)n, 0)] = mask[slot] >> n & 1;
    }
    rg_assembly_mean(a, field);
    for (size_t i = 0; i < slots * RG_NODES; i++) {
        size_t slot = i / RG_NODES, n = i % RG_NODES;
        mask[slot] |= (uint16_t)((field[rg_node_index(slot, (int)n, 0)] > 0) << n);
    }
    rg_free(field);
}

/* Mass of a copy of a tile, over the density of the first material. */
static double mass_of(const rg_domain *d, const rg_material *material, size_t tile, int32_t at) {
    int node = at % RG_NODE_BLOCK / (3 * RG_LANES);
    size_t slot = (d->tile[tile].begin + (size_t)(at / RG_NODE_BLOCK)) * RG_LANES + (size_t)(at % RG_LANES);
    double density = material[d->material[slot / RG_LANES]].density / material->density;
    return density * rg_mass_entry(true, node, node) * d->geom[rg_geom_index(slot, RG_GEOM_VOLUME)];
}

/* The masses of copies over those of their nodes. First the masses are the shares themselves, so that what
 * is summed of ones are the nodes' masses. */
static void weigh(rg_assembly *a, const rg_material *material) {
    const rg_domain *d = a->domain;
    const rg_assembly_plan *p = a->plan;
    size_t values = d->blocks * RG_NODE_BLOCK;
    rg_real *mass = RG_NEW(rg_real, values);
    for (size_t i = 0; i < values; i++) {
        mass[i] = 1;
    }
    for (int pass = 0; pass < 2; pass++) {
        for (size_t t = 0; t < d->tiles; t++) {
            for (size_t k = p->first_copy[p->tile[t].first]; k < p->first_copy[p->tile[t].end]; k++) {
                double all = pass == 0 ? 1 : of_tile(a, t, mass)[p->copy[k]];
                a->share[k] = mass_of(d, material, t, p->copy[k]) / all;
            }
        }
        if (pass == 0) {
            rg_assembly_mean(a, mass);
        }
    }
    rg_free(mass);
}

rg_assembly *rg_assembly_make(const rg_domain *d, const rg_conforming_faces *j, const rg_material *material,
                              MPI_Comm comm) {
    rg_assembly *a = RG_NEW(rg_assembly, 1);
    *a = (rg_assembly){.domain = d, .plan = rg_assembly_plan_make(d, j, comm)};
    a->share = RG_NEW(double, a->plan->copies + 1);
    a->rows = RG_NEW(rg_real, 3 * (a->plan->halo.own + a->plan->halo.receives) + 1);
    a->halo = rg_halo_plan_make(&a->plan->halo, 3, a->rows, TAG, comm);
    weigh(a, material);
    return a;
}

/* A node of several tiles counts in the first one. */
size_t rg_assembly_nodes(const rg_assembly *a) {
    const rg_assembly_plan *p = a->plan;
    size_t count = p->nodes - p->halo.own;
    for (size_t row = 0; row < p->halo.own; row++) {
        count += p->source[p->sources[row].first] == row;
    }
    return count;
}

void rg_assembly_free(rg_assembly *a) {
    if (a == NULL) {
        return;
    }
    rg_halo_free(a->halo);
    rg_assembly_plan_free(a->plan);
    rg_free(a->share);
    rg_free(a->rows);
    rg_free(a);
}
