#include "mesh/improve/improve.h"

#include <math.h>
#include <stdlib.h>

#include "base/mem.h"
#include "mesh/improve/flip.h"
#include "mesh/improve/move.h"
#include "mesh/improve/tets.h"

enum { IDLE = 2 }; /* passes in a row that gain little, after which there is no other */

static const double reach = 1.3, /* tetrahedra up to so many times the smallest height are worked on */
    progress = 1e-2;             /* relative growth of the smallest height in a pass that is not idle */

typedef struct {
    double height;
    rg_gid tet;
} flat_one;

static int flattest_first(const void *a, const void *b) {
    const flat_one *p = a, *q = b;
    int order = (p->height > q->height) - (p->height < q->height);
    return order != 0 ? order : (p->tet > q->tet) - (p->tet < q->tet);
}

static bool alive(const rg_tets *t, rg_gid tet) {
    return t->tet[tet].corner[0] >= 0;
}

static double smallest(const rg_tets *t) {
    double least = INFINITY;
    for (rg_gid i = 0; i < t->count; i++) {
        least = alive(t, i) ? fmin(least, t->tet[i].height) : least;
    }
    return least;
}

/* Those below a height, flattest first; returns how many. */
static size_t list_flat(const rg_tets *t, double below, flat_one **list) {
    size_t count = 0;
    *list = RG_NEW(flat_one, (size_t)t->count);
    for (rg_gid i = 0; i < t->count; i++) {
        if (alive(t, i) && t->tet[i].height < below) {
            (*list)[count++] = (flat_one){t->tet[i].height, i};
        }
    }
    qsort(*list, count, sizeof **list, flattest_first);
    return count;
}

static bool replace(rg_tets *t, rg_gid tet, rg_improvement *done) {
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < i; k++) {
            if (rg_tets_remove_edge(t, t->tet[tet].corner[i], t->tet[tet].corner[k])) {
                done->edges++;
                return true;
            }
        }
    }
    for (int f = 0; f < 4; f++) {
        if (rg_tets_remove_face(t, tet, f)) {
            done->faces++;
            return true;
        }
    }
    return false;
}

static void work_on(rg_tets *t, rg_gid tet, double below, rg_improvement *done) {
    if (replace(t, tet, done)) {
        return;
    }
    for (int i = 0; i < 4; i++) {
        rg_gid vertex = t->tet[tet].corner[i];
        if (rg_tets_star_height(t, vertex) < below) {
            done->moves += rg_tets_move(t, vertex);
        }
    }
}

static void pass(rg_tets *t, double below, rg_improvement *done) {
    flat_one *list;
    size_t count = list_flat(t, below, &list);
    for (size_t i = 0; i < count; i++) {
        if (alive(t, list[i].tet) && t->tet[list[i].tet].height < below) {
            work_on(t, list[i].tet, below, done);
        }
    }
    rg_free(list);
}

rg_improvement rg_mesh_improve(rg_mesh *mesh) {
    rg_tets t = rg_tets_make(mesh);
    rg_improvement done = {.before = smallest(&t)};
    double best = done.before;
    for (int idle = 0; idle < IDLE;) {
        pass(&t, reach * best, &done);
        double now = smallest(&t);
        idle = now > best * (1 + progress) ? 0 : idle + 1;
        best = now;
    }
    done.after = best;
    rg_tets_finish(&t);
    return done;
}
