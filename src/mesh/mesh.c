/* The whole mesh: which elements are neighbours. */
#include "mesh/mesh.h"

#include <stdbool.h>
#include <stdlib.h>

#include "base/input_errors.h"
#include "base/mem.h"
#include "layout.h"

/* A face among those that have the same lowest vertex. */
struct face {
    rg_gid middle, high; /* its other vertices */
    rg_gid slot;         /* 4 * element + local face */
};

static int by_vertices(const void *a, const void *b) {
    const struct face *p = a, *q = b;
    if (p->middle != q->middle) {
        return p->middle < q->middle ? -1 : 1;
    }
    if (p->high != q->high) {
        return p->high < q->high ? -1 : 1;
    }
    return (p->slot > q->slot) - (p->slot < q->slot);
}

static bool same_vertices(const struct face *p, const struct face *q) {
    return p->middle == q->middle && p->high == q->high;
}

/* Vertex `i` (0 lowest, 2 highest) of the face in `slot`. */
static rg_gid face_vertex(const rg_mesh *mesh, rg_gid slot, int i) {
    return mesh->corner[slot / 4 * 4 + rg_face_node[slot % 4][i]];
}

/* Sorts all faces by their lowest vertex: head[vertex] is the slot of its first face, and `neighbour`, not
 * needed for its purpose yet, holds the slot of the next one. -1 ends a list. This takes no memory but
 * `head`. */
static rg_gid *list_faces(rg_mesh *mesh) {
    rg_gid *head = RG_NEW(rg_gid, (size_t)mesh->vertices);
    for (rg_gid v = 0; v < mesh->vertices; v++) {
        head[v] = -1;
    }
    for (rg_gid slot = 4 * mesh->elements - 1; slot >= 0; slot--) {
        rg_gid low = face_vertex(mesh, slot, 0);
        mesh->neighbour[slot] = head[low];
        head[low] = slot;
    }
    return head;
}

struct bundle {
    struct face *face;
    size_t count, room;
};

/* Takes the list that starts at `slot` into `b`. */
static void collect(const rg_mesh *mesh, rg_gid slot, struct bundle *b) {
    for (b->count = 0; slot >= 0; slot = mesh->neighbour[slot], b->count++) {
        b->face = rg_grow(b->face, &b->room, b->count, sizeof *b->face);
        b->face[b->count] = (struct face){face_vertex(mesh, slot, 1), face_vertex(mesh, slot, 2), slot};
    }
}

static void join(rg_mesh *mesh, rg_gid slot, rg_gid other) {
    mesh->neighbour[slot] = other / 4;
    mesh->face[slot] = (int8_t)(other % 4);
}

static long long name(const rg_mesh *mesh, rg_gid slot) {
    return (long long)rg_mesh_original(mesh, slot / 4);
}

static void tell_third(const rg_mesh *mesh, rg_gid low, const struct face *face,
                       rg_input_errors *input_errors) {
    rg_input_errors_add(input_errors, face[0].slot, face[2].slot,
                        "elements %lld, %lld and %lld share the face with vertices %lld, %lld and %lld",
                        name(mesh, face[0].slot), name(mesh, face[1].slot), name(mesh, face[2].slot),
                        (long long)low, (long long)face[0].middle, (long long)face[0].high);
}

/* Joins the faces of lowest vertex `low` that are equal; the others are on the surface. */
static void match(rg_mesh *mesh, rg_gid low, struct bundle *b, rg_input_errors *input_errors) {
    qsort(b->face, b->count, sizeof *b->face, by_vertices);
    for (size_t i = 0; i < b->count; i++) {
        const struct face *f = b->face + i;
        size_t left = b->count - i;
        if (left > 1 && same_vertices(f, f + 1)) {
            if (left > 2 && same_vertices(f, f + 2)) {
                tell_third(mesh, low, f, input_errors);
            }
            join(mesh, f[0].slot, f[1].slot);
            join(mesh, f[1].slot, f[0].slot);
            i++;
        } else {
            mesh->neighbour[f->slot] = -1;
            mesh->face[f->slot] = -1;
        }
    }
}

void rg_mesh_connect(rg_mesh *mesh) {
    rg_gid *head = list_faces(mesh);
    struct bundle bundle = {0};
    rg_input_errors input_errors = {.name = "mesh"};
    for (rg_gid v = 0; v < mesh->vertices; v++) {
        if (head[v] >= 0) {
            collect(mesh, head[v], &bundle);
            match(mesh, v, &bundle, &input_errors);
        }
    }
    rg_free(bundle.face);
    rg_free(head);
    rg_input_errors_end(&input_errors);
}

void rg_mesh_free(rg_mesh *mesh) {
    if (mesh == NULL) {
        return;
    }
    rg_sets_free(&mesh->surface);
    rg_sets_free(&mesh->volume);
    rg_free(mesh->original);
    rg_free(mesh->region);
    rg_free(mesh->part);
    rg_free(mesh->inner);
    rg_free(mesh->line);
    rg_free(mesh->x);
    rg_free(mesh->corner);
    rg_free(mesh->neighbour);
    rg_free(mesh->face);
    rg_free(mesh->set);
    rg_free(mesh);
}
