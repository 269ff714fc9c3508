#include "domain/conforming.h"

#include <math.h>
#include <stdlib.h>

#include "base/error.h"
#include "base/mem.h"
#include "base/first_bad.h"
#include "base/vector.h"
#include "layout.h"
#include "mesh/gid_map.h"

/* ---- Which faces ---- */

/* Whether interface.faces selects face f: by its middle and unit normal, as both sides compute them from the
 * same corners in the same order. */
static bool selected(const rg_expr *faces, const rg_element *e, int f, rg_first_bad *bad) {
    const double *x[RG_FCORNERS];
    double middle[3], u[3], v[3], normal[3];
    for (int k = 0; k < RG_FCORNERS; k++) {
        x[k] = e->x[rg_face_node[f][k]];
    }
    rg_vector_subtract(x[1], x[0], u);
    rg_vector_subtract(x[2], x[0], v);
    rg_vector_cross(u, v, normal);
    double length = sqrt(rg_vector_dot(normal, normal));
    for (int k = 0; k < 3; k++) {
        middle[k] = (x[0][k] + x[1][k] + x[2][k]) / 3;
        normal[k] /= length;
    }
    double here = rg_expr_face_value(faces, middle, normal);
    if (!isfinite(here)) {
#pragma omp critical
        rg_first_bad_note(bad, 0, middle, here);
    }
    return here != 0;
}

uint8_t *rg_joined_faces(const rg_case *c, const rg_part *part, MPI_Comm comm) {
    const rg_expr *faces = c->interface.faces;
    if (c->interface.form != RG_FORM_CONTINUOUS) {
        return NULL;
    }
    rg_first_bad bad = {.which = RG_NOWHERE};
    uint8_t *joined = RG_NEW(uint8_t, (size_t)part->elements + 1);
    int64_t chosen = 0;
#pragma omp parallel reduction(+ : chosen)
    {
        rg_expr *own = rg_expr_copy(faces); /* this thread's */
#pragma omp for schedule(static)
        for (rg_lid i = 0; i < part->elements; i++) {
            const rg_element *e = &part->element[i];
            for (int f = 0; f < RG_FACES; f++) {
                bool conforming_face = e->neighbour[f] >= 0 && (own == NULL || !selected(own, e, f, &bad));
                joined[i] |= (uint8_t)(conforming_face << f);
                chosen += e->neighbour[f] >= 0 && !conforming_face;
            }
        }
        rg_expr_free(own);
    }
    if (rg_first_bad_lowest(&bad, comm)) {
        rg_speak(comm);
        rg_fatal(RG_USAGE, "%s: interface.faces: %s is not finite at (%g, %g, %g)", c->path,
                 rg_expr_text(faces), bad.x[0], bad.x[1], bad.x[2]);
    }
    if (faces != NULL && !rg_expr_is_number(faces)) { /* a number says so on purpose */
        MPI_Allreduce(MPI_IN_PLACE, &chosen, 1, MPI_INT64_T, MPI_SUM, comm);
        if (chosen == 0) {
            rg_speak(comm);
            rg_fatal(RG_USAGE, "%s: interface.faces: %s: no face is in it", c->path, rg_expr_text(faces));
        }
    }
    return joined;
}

/* ---- Shared-node faces ---- */

typedef struct {
    const rg_domain *d;
    const rg_part *part;
    const uint8_t *joined;
    int rank;
    rg_gid_map tile; /* global number of a tile -> its number here */
    rg_conforming_faces *conforming_faces;
} builder;

static rg_lid slot_of(const builder *b, rg_gid id) {
    const rg_tile *t = &b->d->tile[rg_gid_map_get(&b->tile, id / b->d->tile_elements)];
    return (rg_lid)(t->begin * RG_LANES + rg_slot_in(b->d, t, id));
}

/* Visits the shared-node faces of element i: counts them and, with room for them, lists them. */
static void visit(builder *b, rg_lid i) {
    rg_conforming_faces *j = b->conforming_faces;
    const rg_element *e = &b->part->element[i];
    for (int8_t f = 0; f < RG_FACES; f++) {
        rg_gid other = e->neighbour[f];
        if ((b->joined[i] >> f & 1) == 0) {
            continue;
        }
        if (e->owner[f] != b->rank) {
            if (j->far != NULL) {
                rg_gid key = e->id < other ? RG_FACES * e->id + f : RG_FACES * other + e->face[f];
                j->far[j->fars] = (rg_far_conforming_face){e->owner[f], key, slot_of(b, e->id), f};
            }
            j->fars++;
        } else if (other < e->id) { /* once for both sides */
            if (j->conforming_face != NULL) {
                j->conforming_face[j->count] =
                    (rg_conforming_face){{slot_of(b, e->id), slot_of(b, other)}, {f, e->face[f]}};
            }
            j->count++;
        }
    }
}

static void visit_all(builder *b) {
    b->conforming_faces->count = b->conforming_faces->fars = 0;
    for (rg_lid i = 0; i < b->part->elements; i++) {
        visit(b, i);
    }
}

static int by_rank_and_key(const void *a, const void *b) {
    const rg_far_conforming_face *p = a, *q = b;
    if (p->rank != q->rank) {
        return p->rank < q->rank ? -1 : 1;
    }
    return (p->key > q->key) - (p->key < q->key);
}

rg_conforming_faces *rg_conforming_faces_make(const rg_domain *d, const rg_part *part, const uint8_t *joined,
                                              int rank) {
    rg_conforming_faces *j = RG_NEW(rg_conforming_faces, 1);
    builder b = {d, part, joined, rank, rg_gid_map_make(d->tiles), j};
    for (size_t t = 0; t < d->tiles; t++) {
        rg_gid_map_put(&b.tile, d->tile[t].first / d->tile_elements, (rg_lid)t);
    }
    visit_all(&b);
    j->conforming_face = RG_NEW(rg_conforming_face, j->count + 1);
    j->far = RG_NEW(rg_far_conforming_face, j->fars + 1);
    j->far_rank = RG_NEW(int, j->fars + 1);
    visit_all(&b);
    qsort(j->far, j->fars, sizeof *j->far, by_rank_and_key);
    for (size_t k = 0; k < j->fars; k++) {
        j->far_rank[k] = j->far[k].rank;
    }
    rg_gid_map_free(&b.tile);
    return j;
}

void rg_conforming_faces_free(rg_conforming_faces *j) {
    if (j == NULL) {
        return;
    }
    rg_free(j->conforming_face);
    rg_free(j->far);
    rg_free(j->far_rank);
    rg_free(j);
}
