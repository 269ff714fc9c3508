/* A mesh in words, and what a job says of one. Include after cmocka.h. */
#ifndef RG_MESH_TEXT_H
#define RG_MESH_TEXT_H

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "mesh/mesh.h"
#include "support/child.h"

/* "x 0: 0 1.5 2", "e 7: 0 1 2 3 in steel, top at 0" (its faces in sets), "inner 0 1 2": a line each. */
static inline void print_mesh(const rg_mesh *m, FILE *out) {
    for (rg_gid v = 0; v < m->vertices; v++) {
        fprintf(out, "x %" PRId64 ": %g %g %g\n", v, m->x[3 * v], m->x[3 * v + 1], m->x[3 * v + 2]);
    }
    for (rg_gid e = 0; e < m->elements; e++) {
        const rg_gid *c = m->corner + 4 * e;
        fprintf(out, "e %" PRId64 ": %" PRId64 " %" PRId64 " %" PRId64 " %" PRId64, rg_mesh_original(m, e),
                c[0], c[1], c[2], c[3]);
        int32_t count = 0;
        const int32_t *set = m->region != NULL ? rg_sets_of(&m->volume, &m->region[e], &count) : NULL;
        for (int32_t i = 0; i < count; i++) {
            fprintf(out, "%s%s", i == 0 ? " in " : " and ", m->volume.name[set[i]]);
        }
        for (int f = 0; f < 4; f++) {
            set = rg_sets_of(&m->surface, &m->set[4 * e + f], &count);
            for (int32_t i = 0; i < count; i++) {
                fprintf(out, "%s%s", i == 0 ? ", " : " and ", m->surface.name[set[i]]);
            }
            count > 0 ? fprintf(out, " at %d", f) : 0;
        }
        fputc('\n', out);
    }
    for (size_t i = 0; i < m->inners; i++) {
        const rg_gid *v = m->inner + 3 * i;
        fprintf(out, "inner %" PRId64 " %" PRId64 " %" PRId64 "\n", v[0], v[1], v[2]);
    }
}

/* Runs the job; expects its exit status and all that it says on standard error. */
static inline void expect_said(void (*job)(void), int status, const char *words) {
    static char said[1 << 16];
    int found = run_child(job, said, sizeof said);
    if (found != status || strcmp(said, words) != 0) {
        fail_msg("status %d instead of %d; said:\n%s\ninstead of:\n%s", found, status, said, words);
    }
}

#endif
