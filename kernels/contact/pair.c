/* Contact of faces, a vector of pairs at a time. */
#include "contact/damping.h"
#include "contact/friction.h"
#include "contact/pair.h"
#include "isa.h"

/* Writes out what the first `count` lanes come to. */
static void store_pairs(const rg_contact_args *args, const size_t pair[], int count, wide energy,
                        wide force[2][3][3]) {
    for (int l = 0; l < count; l++) {
        double *f = args->force + 18 * pair[l];
        args->energy[pair[l]] = energy[l];
        for (int k = 0; energy[l] > 0 && k < 2; k++) {
            for (int i = 0; i < 9; i++) {
                f[9 * k + 3 * corner_of[k][i / 3] + i % 3] = force[k][i / 3][i % 3][l];
            }
        }
    }
}

static void meet(const rg_contact_args *args, const size_t pair[], int count) {
    meeting m;
    for (int l = 0; l < WIDE; l++) { /* behind the last one, that again */
        load_pair(&m, args, pair[l < count ? l : count - 1], l);
    }
    set_normal(&m, 0);
    set_normal(&m, 1);
    m.facing = wide_dot(m.normal[0], m.normal[1]);
    set_frame(&m);
    set_face(&m, 0);
    set_face(&m, 1);
    set_depth(&m);
    find_overlap(&m.over);
    handover h = hand_over(&m);
    wide_mask met = m.over.is & (wide_mask)(m.facing > 0) & (wide_mask)(h.share > 0);
    wide most = m.over.most + m.skin;
    wide depth = wide_where(met & (wide_mask)(m.over.least < m.reach) & (wide_mask)(most > 0), most);
    wide_mask presses =
        met & (wide_mask)(m.reach > 0) & (wide_mask)(m.over.least < m.reach) & (wide_mask)(m.over.most > 0);
    wide energy = wide_splat(0), force[2][3][3];
    if (wide_any(presses)) {
        integral sum = integrate(&m.over);
        energy = pair_forces(&m, &sum, &h, force);
        presses &= (wide_mask)(energy > 0);
        if (args->rate != NULL) {
            add_damping(args, pair, count, &m, &sum, &h, presses, force);
        }
        if (args->grip != NULL) {
            energy += add_friction(args, pair, count, &m, &sum, &h, presses, force);
        }
        energy = wide_where(presses, energy);
    }
    for (int l = 0; l < count; l++) {
        args->depth[pair[l]] = depth[l];
    }
    store_pairs(args, pair, count, energy, force);
}

/* Whether there may be points over each other that are less deep than the limit: most pairs of a search are
 * some way from that. */
static bool are_near(const rg_contact_args *args, const rg_contact_pair *p) {
    const double *a = args->box + 6 * (size_t)p->face[0], *b = args->box + 6 * (size_t)p->face[1];
    bool near = true;
    for (int c = 0; c < 3; c++) {
        near = near & (a[c] - b[3 + c] <= p->limit) & (b[c] - a[3 + c] <= p->limit);
    }
    return near;
}

/* Pairs that wait for the next step until they fill a vector. */
typedef struct {
    size_t pair[2 * WIDE];
    int count;
} queue;

static void meet_some(const rg_contact_args *args, queue *q, int count) {
    meet(args, q->pair, count);
    q->count -= count;
    for (int k = 0; k < q->count; k++) {
        q->pair[k] = q->pair[count + k];
    }
}

/* Lanes whose faces do not face each other, are no part of the way above each other, or lie beside each
 * other: no corner of one on the inner side of an edge of the other one, seen along n. */
static wide_mask are_apart(const meeting *m) {
    wide n[3], low[2], high[2];
    for (int c = 0; c < 3; c++) {
        n[c] = m->normal[0][c] + m->normal[1][c];
    }
    wide_mask apart = (wide_mask)(wide_dot(m->normal[0], m->normal[1]) <= 0);
    for (int k = 0; k < 2; k++) {
        for (int i = 0; i < 3; i++) {
            wide r[3], edge[3], inward[3], most = wide_splat(-INFINITY);
            wide_minus(m->corner[k][i], m->corner[0][0], r);
            wide z = wide_dot(r, n);
            low[k] = i == 0 ? z : wide_select((wide_mask)(z < low[k]), z, low[k]);
            high[k] = i == 0 ? z : wide_select((wide_mask)(z > high[k]), z, high[k]);
            wide_minus(m->corner[k][(i + 1) % 3], m->corner[k][i], edge);
            wide_cross(n, edge, inward);
            for (int j = 0; j < 3; j++) {
                wide_minus(m->corner[1 - k][j], m->corner[k][i], r);
                wide side = wide_dot(inward, r);
                most = wide_select((wide_mask)(side > most), side, most);
            }
            apart |= (wide_mask)(most < 0);
        }
    }
    return apart | (wide_mask)(high[0] < low[1]);
}

/* Passes on those of a vector of pairs that are not. */
static void sift(const rg_contact_args *args, const size_t pair[], int count, queue *q) {
    meeting m;
    for (int l = 0; l < WIDE; l++) {
        load_pair(&m, args, pair[l < count ? l : count - 1], l);
    }
    set_normal(&m, 0);
    set_normal(&m, 1);
    wide_mask apart = are_apart(&m);
    for (int l = 0; l < count; l++) {
        q->pair[q->count] = pair[l];
        q->count += apart[l] == 0;
    }
    if (q->count >= WIDE) {
        meet_some(args, q, WIDE);
    }
}

/* What was pressed and is not any more loses its spring. */
static void let_go(const rg_contact_args *args, size_t i) {
    double *k = &args->grip[RG_GRIP * i + RG_GRIP_STIFFNESS];
    const double *e = args->grip + RG_GRIP * i + RG_GRIP_STRETCH;
    if (args->energy[i] == 0 && *k > 0) {
        args->heat[i] = 0.5 * *k * (e[0] * e[0] + e[1] * e[1]);
        *k = 0;
    }
}

void RG_ISA_NAME(rg_contact)(const rg_contact_args *args, size_t begin, size_t end) {
    size_t near[WIDE];
    queue q = {.count = 0};
    int count = 0;
    for (size_t i = begin; i < end; i++) {
        args->energy[i] = args->depth[i] = 0;
        if (args->grip != NULL) {
            args->heat[i] = 0;
        }
        near[count] = i;
        count += are_near(args, &args->pair[i]);
        if (count == WIDE) {
            sift(args, near, count, &q);
            count = 0;
        }
    }
    if (count > 0) {
        sift(args, near, count, &q);
    }
    if (q.count > 0) {
        meet_some(args, &q, q.count);
    }
    for (size_t i = begin; args->grip != NULL && i < end; i++) {
        let_go(args, i);
    }
}
