#include "contact/grip.h"

#include <stdlib.h>
#include <string.h>

#include "base/mem.h"

void rg_grips_clear(rg_grips *g) {
    rg_free(g->grip);
    *g = (rg_grips){0};
}

void rg_grips_add(rg_grips *g, rg_gid a, rg_gid b, const double value[RG_GRIP]) {
    if (value[RG_GRIP_STIFFNESS] > 0) {
        g->grip = rg_grow(g->grip, &g->room, g->count, sizeof *g->grip);
        rg_grip *last = &g->grip[g->count++];
        last->face[0] = a;
        last->face[1] = b;
        memcpy(last->value, value, sizeof last->value);
    }
}

static int by_faces(const void *a, const void *b) {
    const rg_grip *p = a, *q = b;
    for (int k = 0; k < 2; k++) {
        if (p->face[k] != q->face[k]) {
            return p->face[k] < q->face[k] ? -1 : 1;
        }
    }
    return 0;
}

void rg_grips_find(const rg_grips *g, size_t *at, rg_gid a, rg_gid b, double value[RG_GRIP]) {
    const rg_grip wanted = {.face = {a, b}};
    while (*at < g->count && by_faces(&g->grip[*at], &wanted) < 0) {
        ++*at;
    }
    memset(value, 0, RG_GRIP * sizeof *value);
    if (*at < g->count && by_faces(&g->grip[*at], &wanted) == 0) {
        memcpy(value, g->grip[*at].value, RG_GRIP * sizeof *value);
    }
}

void rg_grips_row(rg_gid partner, const double value[RG_GRIP], double row[RG_GRIP_ROW]) {
    row[0] = (double)partner;
    memcpy(row + 1, value, RG_GRIP * sizeof *value);
}

void rg_grips_take(rg_grips *g, size_t rows, const int64_t *key, const double *value) {
    rg_grips_clear(g);
    for (size_t i = 0; i < rows; i++) {
        const double *from = value + RG_GRIP_ROW * i;
        rg_gid face = key[i], partner = (rg_gid)from[0];
        rg_grips_add(g, face < partner ? face : partner, face < partner ? partner : face, from + 1);
    }
    size_t kept = 0;
    if (g->count > 0) {
        qsort(g->grip, g->count, sizeof *g->grip, by_faces);
    }
    for (size_t i = 0; i < g->count; i++) {
        if (kept == 0 || by_faces(&g->grip[i], &g->grip[kept - 1]) != 0) {
            g->grip[kept++] = g->grip[i];
        }
    }
    g->count = kept;
}
