#include "contact/inner.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/vector.h"
#include "partition/material.h"
#include "domain/element.h"

/* Of the height of an element: how deep faces may lie in each other before they press, which those that break
 * under pressure do; how deep they see each other; and how far they may move between two searches, of the
 * mean.
 */
#define SKIN  2e-3
#define REACH 0.5
#define FAT   0.2

/* ---- Elements ---- */

static void make_element(rg_contacts *c, rg_mass mass) {
    for (int f = 0; f < RG_FACES; f++) {
        for (int n = 0; n < RG_NODES; n++) {
            for (int i = 0; i < RG_FCORNERS; i++) {
                for (int a = 0; a < RG_FNODES; a++) {
                    c->push[f][n][i] +=
                        rg_inverse_mass_entry(mass, n, rg_face_node[f][a]) * rg_contact_projection(i, a);
                }
            }
        }
    }
    /* Q M^-1 Q' times the mass matrix of the corners over the area, (I + 1 1')/12: the largest eigenvalue is
     * that of a face that moves as one, (a + 2 b)/3; the others are (a - b)/12, with each mass matrix less.
     */
    double own = 0, other = 0;
    for (int a = 0; a < RG_FNODES; a++) {
        own += rg_contact_projection(0, a) * c->push[0][rg_face_node[0][a]][0];
        other += rg_contact_projection(0, a) * c->push[0][rg_face_node[0][a]][1];
    }
    c->eigenvalue = (own + 2 * other) / 3;
}

/* With all of the surface pressed. */
static double largest_omega2(const rg_contacts *c) {
    const rg_domain *d = c->domain;
    double most = 0;
    for (size_t slot = 0; slot < d->blocks * RG_LANES; slot++) {
        double sum = 0;
        for (int k = 0; k < RG_FACES; k++) {
            if (rg_surface_has(d, slot, k)) {
                const rg_material *m = &c->material[d->material[slot / RG_LANES]];
                double kappa = c->penalty * rg_material_modulus(m) / rg_surface_height(d, slot, k);
                sum += kappa * rg_contact_omega2_of(c, slot, k);
            }
        }
        most = fmax(most, sum);
    }
    MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_DOUBLE, MPI_MAX, c->comm);
    return most;
}

rg_contacts *rg_contacts_make(const rg_case *input, const rg_domain *d, const rg_material *m, MPI_Comm comm) {
    if (input->contact.model == RG_CONTACT_OF_INTERFACES) {
        return NULL;
    }
    rg_contacts *c = RG_NEW(rg_contacts, 1);
    *c = (rg_contacts){.domain = d, .material = m, .comm = comm, .penalty = input->contact.penalty};
    c->rubs = rg_case_rubs(input);
    c->damping = input->contact.damping;
    c->values = RG_CONTACT_ROW + 1 + (c->damping > 0 ? RG_CONTACT_ROW : 0);
    c->specials = input->contact.pairs;
    c->special = RG_NEW(rg_contact_special, (size_t)c->specials + 1);
    for (int i = 0; i < c->specials; i++) {
        const rg_contact_friction *p = &input->contact.pair[i];
        c->special[i] = (rg_contact_special){
            {rg_case_find_material(input, p->between[0]), rg_case_find_material(input, p->between[1])},
            {fmax(p->friction, p->static_friction), p->friction}};
    }
    c->friction[0] = input->contact.static_friction;
    c->friction[1] = input->contact.friction;
    MPI_Comm_rank(comm, &c->rank);
    make_element(c, input->mass);
    c->omega2 = largest_omega2(c);
    c->tile_begin = RG_NEW(size_t, d->tiles + 1);
    c->tile_omega2 = RG_NEW(double, d->tiles + 1);
    c->tile_touching = RG_NEW(int64_t, d->tiles + 1);
    return c;
}

/* ---- Exposed faces ---- */

/* 0: not exposed; 1: on the surface; 2: a former interface. */
static int exposure(const rg_domain *d, const rg_tile *t, const uint8_t *exposed, size_t slot, int k) {
    int32_t link = d->interface[rg_link_index(slot, k)];
    if (rg_surface_has(d, slot, k)) {
        return 1;
    }
    return d->id[slot] >= 0 && link >= 0 && exposed[t->ibegin * RG_LANES + (size_t)link / 4] >= 2 ? 2 : 0;
}

/* Where `sunk` has the value of side k of interface i. */
static size_t sunk_index(size_t i, int k) {
    return (i / RG_LANES * 2 + (size_t)k) * RG_LANES + i % RG_LANES;
}

/* Visits the exposed faces of a tile; counts them and, with room for them, lists them. */
static size_t list_faces(const rg_contacts *c, size_t tile, const uint8_t *exposed, rg_contact_side *out) {
    const rg_domain *d = c->domain;
    const rg_tile *t = &d->tile[tile];
    size_t count = 0;
    for (size_t slot = t->begin * RG_LANES; slot < t->end * RG_LANES; slot++) {
        for (int k = 0; k < RG_FACES; k++) {
            int how = exposure(d, t, exposed, slot, k);
            if (how > 0 && out != NULL) {
                int32_t link = d->interface[rg_link_index(slot, k)];
                out[count] = (rg_contact_side){
                    .slot = (rg_lid)slot, .face = (int8_t)k, .interface = RG_CONTACT_NO_INTERFACE};
                if (how == 2) {
                    out[count].interface = sunk_index(t->ibegin * RG_LANES + (size_t)link / 4, link % 2);
                }
            }
            count += how > 0;
        }
    }
    return count;
}

static void copy_corners(const double *corner, const rg_contact_side *f, double *rest) {
    for (int i = 0; i < 3; i++) {
        memcpy(rest + 3 * i, corner + 3 * rg_face_node[f->face][rg_contact_corner(f, i)], 3 * sizeof *rest);
    }
}

/* Corners in an order in which they run round the outward normal. */
static void set_rest(const rg_contacts *c, rg_contact_side *f, double *rest) {
    const double *corner = c->domain->corner + 12 * (size_t)f->slot;
    double out[3], normal[3];
    rg_surface_area(corner, f->face, out);
    copy_corners(corner, f, rest);
    rg_vector_normal(rest, normal);
    f->turned = rg_vector_dot(normal, out) < 0;
    copy_corners(corner, f, rest);
}

/* The numbers of a pair's faces, the lower one first. */
static void faces_of(const rg_contacts *c, size_t pair, rg_gid id[2]) {
    for (int k = 0; k < 2; k++) {
        id[k] = c->id[c->pair[pair].face[k]];
    }
}

/* What friction remembers now. */
static rg_grips list_grips(const rg_contacts *c) {
    rg_grips g = {0};
    for (size_t i = 0; i < c->pairs; i++) {
        rg_gid id[2];
        faces_of(c, i, id);
        rg_grips_add(&g, id[0], id[1], c->grip + RG_GRIP * i);
    }
    return g;
}

/* Before the pairs go. One that presses is found again: a search looks further than a step goes. */
static void keep_grips(rg_contacts *c) {
    if (c->grip != NULL) {
        rg_grips_clear(&c->kept);
        c->kept = list_grips(c);
    }
}

/* To the new pairs, which come by the numbers of their faces. */
static void give_grips(rg_contacts *c) {
    size_t at = 0;
    c->grip = RG_NEW(double, RG_GRIP *(c->pairs + 1));
    c->heat = RG_NEW(double, c->pairs + 1);
    for (size_t i = 0; i < c->pairs; i++) {
        rg_gid id[2];
        faces_of(c, i, id);
        rg_grips_find(&c->kept, &at, id[0], id[1], c->grip + RG_GRIP * i);
    }
    rg_grips_clear(&c->kept);
}

static void forget(rg_contacts *c) {
    rg_halo_free(c->halo);
    c->halo = NULL;
    void *blocks[] = {c->face,  c->rest,    c->corner,  c->last,    c->id,    c->row,
                      c->moved, c->stepped, c->pair,    c->touch,   c->force, c->energy,
                      c->depth, c->sunk,    c->box,     c->grip,    c->heat,  c->of_material,
                      c->rate,  c->drag,    c->stiffer, c->dragged, c->shift, c->power};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) {
        rg_free(blocks[i]);
    }
    c->grip = c->heat = c->rate = c->drag = c->stiffer = c->dragged = c->shift = c->power = NULL;
}

/* The exposed faces of this rank, where they are now. */
static rg_exposed_face *expose(rg_contacts *c, const uint8_t *exposed, const rg_real *u) {
    const rg_domain *d = c->domain;
    for (size_t t = 0; t < d->tiles; t++) {
        c->tile_begin[t + 1] = c->tile_begin[t] + list_faces(c, t, exposed, NULL);
    }
    c->faces = c->tile_begin[d->tiles];
    c->face = RG_NEW(rg_contact_side, c->faces + 1);
    rg_exposed_face *e = RG_NEW(rg_exposed_face, c->faces + 1);
    for (size_t t = 0; t < d->tiles; t++) {
        list_faces(c, t, exposed, c->face + c->tile_begin[t]);
    }
    c->row = RG_NEW(rg_real, c->values * (c->faces + 1));
    for (size_t i = 0; i < c->faces; i++) {
        rg_contact_side *f = &c->face[i];
        size_t slot = (size_t)f->slot;
        const rg_material *m = &c->material[d->material[slot / RG_LANES]];
        e[i] = (rg_exposed_face){.id = RG_FACES * d->id[slot] + f->face,
                                 .rank = c->rank,
                                 .row = (int32_t)i,
                                 .former = f->interface != RG_CONTACT_NO_INTERFACE,
                                 .material = d->material[slot / RG_LANES],
                                 .modulus = rg_material_modulus(m),
                                 .shear = m->mu,
                                 .density = m->density,
                                 .height = rg_surface_height(d, slot, f->face)};
        set_rest(c, f, e[i].rest);
        rg_contact_set_row(c, i, u, c->row + c->values * i);
        for (int k = 0; k < RG_CONTACT_ROW; k++) {
            e[i].corner[k] = e[i].rest[k] + c->row[c->values * i + (size_t)k];
        }
    }
    return e;
}

/* ---- Pairs ---- */

/* A face that one rank has and another one needs. */
typedef struct {
    int32_t rank;
    rg_gid id;
    size_t row;
    int32_t material;
    const double *rest;
} shared;

static int by_rank(const void *a, const void *b) {
    const shared *p = a, *q = b;
    int order = (p->rank > q->rank) - (p->rank < q->rank);
    return order != 0 ? order : (p->id > q->id) - (p->id < q->id);
}

static size_t unique(shared *s, size_t count) {
    size_t kept = 0;
    qsort(s, count, sizeof *s, by_rank);
    for (size_t i = 0; i < count; i++) {
        if (kept == 0 || by_rank(&s[i], &s[kept - 1]) != 0) {
            s[kept++] = s[i];
        }
    }
    return kept;
}

/* Rows of faces: the own ones, then those of other ranks, with the exchange that brings these. */
static shared *make_rows(rg_contacts *c, const rg_exposed_face *own, const rg_candidate *p) {
    shared *needed = RG_NEW(shared, c->pairs + 1), *given = RG_NEW(shared, c->pairs + 1);
    size_t count = 0;
    for (size_t i = 0; i < c->pairs; i++) {
        for (int k = 0; k < 2; k++) {
            const rg_exposed_face *far = &p[i].face[k], *near = &p[i].face[1 - k];
            if (far->rank != c->rank) {
                needed[count] = (shared){far->rank, far->id, 0, far->material, far->rest};
                given[count++] = (shared){far->rank, near->id, (size_t)near->row, near->material, NULL};
            }
        }
    }
    c->far = unique(needed, count);
    count = unique(given, count);
    size_t rows = c->faces + c->far;
    rg_halo_row *send = RG_NEW(rg_halo_row, count + 1);
    int32_t *from = RG_NEW(int32_t, c->far + 1);
    rg_free(c->row);
    c->row = RG_NEW(rg_real, c->values * (rows + 1));
    c->sunk = RG_NEW(double, rows + 1);
    c->rest = RG_NEW(double, RG_CONTACT_ROW *(rows + 1));
    c->corner = RG_NEW(double, RG_CONTACT_ROW *(rows + 1));
    c->box = RG_NEW(double, RG_CONTACT_BOX *(rows + 1));
    c->last = RG_NEW(double, RG_CONTACT_ROW *(c->faces + 1));
    c->id = RG_NEW(rg_gid, rows + 1);
    c->of_material = RG_NEW(int32_t, rows + 1);
    c->moved = RG_NEW(double, c->faces + 1);
    c->stepped = RG_NEW(double, c->faces + 1);
    for (size_t i = 0; i < c->faces; i++) {
        memcpy(c->rest + RG_CONTACT_ROW * i, own[i].rest, sizeof own[i].rest);
        memcpy(c->last + RG_CONTACT_ROW * i, own[i].corner, sizeof own[i].corner);
        memcpy(c->corner + RG_CONTACT_ROW * i, own[i].corner, sizeof own[i].corner);
        c->id[i] = own[i].id;
        c->of_material[i] = own[i].material;
    }
    for (size_t i = 0; i < c->far; i++) {
        needed[i].row = c->faces + i;
        memcpy(c->rest + RG_CONTACT_ROW * needed[i].row, needed[i].rest, RG_CONTACT_ROW * sizeof *c->rest);
        c->id[needed[i].row] = needed[i].id;
        c->of_material[needed[i].row] = needed[i].material;
        from[i] = needed[i].rank;
    }
    for (size_t i = 0; i < count; i++) {
        send[i] = (rg_halo_row){given[i].rank, given[i].row};
    }
    rg_halo_plan plan = {.send = send, .sends = count, .from = from, .receives = c->far, .own = c->faces};
    c->halo = rg_halo_plan_make(&plan, (int)c->values, c->row, RG_CONTACT_HALO_TAG, c->comm);
    rg_free(send);
    rg_free(from);
    rg_free(given);
    return needed;
}

static int32_t row_of(const rg_contacts *c, const rg_exposed_face *f, const shared *far) {
    if (f->rank == c->rank) {
        return f->row;
    }
    const shared key = {.rank = f->rank, .id = f->id};
    const shared *there = bsearch(&key, far, c->far, sizeof *far, by_rank);
    return (int32_t)there->row;
}

/* What each face touches: pairs come by the numbers of both faces, so that each face gets its partners
 * ascending, lower ones after higher ones or before as the pairs come: sorted below. */
typedef struct {
    size_t row;
    rg_gid partner;
    rg_contact_touch is;
} contact_of;

static int by_partner(const void *a, const void *b) {
    const contact_of *p = a, *q = b;
    int order = (p->row > q->row) - (p->row < q->row);
    return order != 0 ? order : (p->partner > q->partner) - (p->partner < q->partner);
}

static void make_touches(rg_contacts *c) {
    contact_of *of = RG_NEW(contact_of, 2 * c->pairs + 1);
    size_t count = 0;
    for (size_t i = 0; i < c->pairs; i++) {
        for (int k = 0; k < 2; k++) {
            size_t row = (size_t)c->pair[i].face[k], other = (size_t)c->pair[i].face[1 - k];
            if (row < c->faces) {
                of[count++] = (contact_of){row, c->id[other], {i, k}};
            }
        }
    }
    qsort(of, count, sizeof *of, by_partner);
    c->touch = RG_NEW(rg_contact_touch, count + 1);
    for (size_t i = 0, f = 0; f <= c->faces; f++) {
        c->face[f].touch = i;
        while (i < count && of[i].row == f) {
            c->touch[i] = of[i].is;
            i++;
        }
    }
    rg_free(of);
}

/* How far a face may move before the next search. */
static double set_fat(const rg_contacts *c, const rg_exposed_face *e) {
    double sum[2] = {0, (double)c->faces};
    for (size_t i = 0; i < c->faces; i++) {
        sum[0] += e[i].height;
    }
    MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPI_DOUBLE, MPI_SUM, c->comm);
    return sum[1] > 0 ? FAT * sum[0] / sum[1] : 0;
}

/* The spring of friction is as stiff across as the penalty along: with mu in place of lambda + 2 mu. */
static void set_friction(const rg_contacts *c, const rg_candidate *from, rg_contact_pair *pair) {
    double mu = from->face[0].shear + from->face[1].shear,
           all = from->face[0].modulus + from->face[1].modulus;
    memcpy(pair->friction, c->friction, sizeof c->friction);
    for (int i = 0; i < c->specials; i++) {
        const rg_contact_special *e = &c->special[i];
        for (int k = 0; k < 2; k++) {
            if (e->material[k] == from->face[0].material && e->material[1 - k] == from->face[1].material) {
                memcpy(pair->friction, e->friction, sizeof e->friction);
            }
        }
    }
    pair->shear = pair->friction[0] > 0 ? pair->stiffness * mu / all : 0;
}

static void make_damping(rg_contacts *c) {
    c->rate = RG_NEW(double, RG_CONTACT_ROW *(c->faces + c->far + 1));
    c->drag = RG_NEW(double, 18 * (c->pairs + 1));
    c->stiffer = RG_NEW(double, c->pairs + 1);
    c->power = RG_NEW(double, 2 * c->pairs + 1);
    c->dragged = RG_NEW(double, RG_CONTACT_ROW *(c->faces + 1));
    c->shift = RG_NEW(double, c->faces + 1);
}

/* Damping takes no more of a rate of depth than a quarter of the impedance of both solids, as stronger ones
 * would cost steps. */
static double impedance_of(const rg_candidate *from) {
    return 0.125 * (sqrt(from->face[0].density * from->face[0].modulus) +
                    sqrt(from->face[1].density * from->face[1].modulus));
}

void rg_contacts_search(rg_contacts *c, const uint8_t *exposed, const rg_real *u) {
    keep_grips(c);
    forget(c);
    memset(c->tile_omega2, 0, c->domain->tiles * sizeof *c->tile_omega2);
    rg_exposed_face *own = expose(c, exposed, u);
    c->fat = set_fat(c, own);
    rg_search by = {c->penalty, SKIN, REACH, c->fat, RG_CONTACT_TURN};
    rg_candidate *p = rg_search_pairs(&by, own, c->faces, &c->pairs, c->comm);
    shared *far = make_rows(c, own, p);
    c->pair = RG_NEW(rg_contact_pair, c->pairs + 1);
    c->force = RG_NEW(double, 18 * (c->pairs + 1));
    c->energy = RG_NEW(double, c->pairs + 1);
    c->depth = RG_NEW(double, c->pairs + 1);
    if (c->damping > 0) {
        make_damping(c);
    }
    for (size_t i = 0; i < c->pairs; i++) {
        c->pair[i] = p[i].pair;
        for (int k = 0; k < 2; k++) {
            c->pair[i].face[k] = row_of(c, &p[i].face[k], far);
        }
        set_friction(c, &p[i], &c->pair[i]);
        c->pair[i].impedance = impedance_of(&p[i]);
    }
    make_touches(c);
    if (c->rubs) {
        give_grips(c);
    }
    int here = c->pairs > 0, anywhere;
    MPI_Allreduce(&here, &anywhere, 1, MPI_INT, MPI_MAX, c->comm);
    c->any = anywhere != 0;
    rg_free(far);
    rg_free(p);
    rg_free(own);
}

/* ---- Checkpoints ---- */

size_t rg_contacts_grips(const rg_contacts *c, int64_t **key, double **value) {
    size_t rows = 0;
    *key = RG_NEW(int64_t, 2 * c->pairs + 1);
    *value = RG_NEW(double, RG_GRIP_ROW *(2 * c->pairs + 1));
    for (size_t i = 0; i < 2 * c->pairs; i++) {
        rg_gid id[2];
        faces_of(c, i / 2, id);
        const double *grip = c->grip + RG_GRIP * (i / 2);
        if (grip[RG_GRIP_STIFFNESS] > 0 && (size_t)c->pair[i / 2].face[i % 2] < c->faces) {
            (*key)[rows] = id[i % 2];
            rg_grips_row(id[1 - i % 2], grip, *value + RG_GRIP_ROW * rows++);
        }
    }
    return rows;
}

void rg_contacts_take_grips(rg_contacts *c, size_t rows, const int64_t *key, const double *value) {
    rg_grips_take(&c->kept, rows, key, value);
    rg_free(c->grip); /* those of the present pairs do not count any more */
    c->grip = NULL;
}

/* ---- Set-up ---- */

bool rg_contacts_overlap(const rg_contacts *c, char *words, size_t size) {
    rg_gid lowest = INT64_MAX, first;
    size_t which = 0;
    for (size_t i = c->pairs; i-- > 0;) {
        if (c->energy[i] > 0) {
            which = i;
            lowest = c->id[c->pair[i].face[0]];
        }
    }
    MPI_Allreduce(&lowest, &first, 1, MPI_INT64_T, MPI_MIN, c->comm);
    if (first == INT64_MAX) {
        return false;
    }
    double where[4] = {0, 0, 0, 0};
    if (first == lowest) {
        const double *x = c->corner + RG_CONTACT_ROW * c->pair[which].face[0];
        for (int k = 0; k < 3; k++) {
            where[k] = (x[k] + x[3 + k] + x[6 + k]) / 3;
        }
        where[3] = (double)(c->id[c->pair[which].face[1]] / RG_FACES);
    }
    double best[4];
    int mine = first == lowest ? c->rank : INT32_MAX, speaker;
    MPI_Allreduce(&mine, &speaker, 1, MPI_INT, MPI_MIN, c->comm);
    memcpy(best, where, sizeof best);
    MPI_Bcast(best, 4, MPI_DOUBLE, speaker, c->comm);
    snprintf(words, size, "elements %" PRId64 " and %.0f lie in each other at (%.6g, %.6g, %.6g)",
             first / RG_FACES, best[3], best[0], best[1], best[2]);
    return true;
}

double rg_contacts_omega2(const rg_contacts *c) {
    return c->omega2;
}

void rg_contacts_free(rg_contacts *c) {
    if (c != NULL) {
        forget(c);
        rg_grips_clear(&c->kept);
        rg_free(c->special);
        rg_free(c->tile_begin);
        rg_free(c->tile_omega2);
        rg_free(c->tile_touching);
        rg_free(c);
    }
}
