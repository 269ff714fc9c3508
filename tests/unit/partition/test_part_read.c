/* Parts read from a mesh file by each rank for itself, on any number of ranks. Prints TAP from rank 0. */
#include <mpi.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/mem.h"
#include "case/expr.h"
#include "mesh/check.h"
#include "mesh/file.h"
#include "layout.h"
#include "mesh/mesh.h"
#include "partition/mesh_case.h"
#include "partition/tile_weight.h"
#include "support/fatal.h"
#include "support/tap.h"

void rg_warn(const char *format, ...) {
    (void)format;
}

static int ranks;
static char path[] = "/tmp/rhegma-part-XXXXXX";

static const struct box {
    const char *name;
    int64_t cells[3];
    double origin[3], size[3], jitter;
} boxes[] = {
    {"three cells", {1, 1, 3}, {0, 0, 0}, {1, 1, 3}, 0},
    {"bar", {3, 3, 30}, {-0.2e-3, -0.2e-3, -2e-3}, {0.4e-3, 0.4e-3, 4e-3}, 0.12},
    {"block", {24, 22, 27}, {1, 2, 3}, {1.6, 1.2, 2.0}, 0.1}, /* more tiles than are read at once */
};
enum { BOXES = sizeof boxes / sizeof boxes[0], CHECKS = 12, REFUSALS = 3, FAULTY = 6 };

static bool same_counts(const rg_part *a, const rg_part *b) {
    bool good = a->total == b->total && a->interfaces == b->interfaces && a->tile == b->tile &&
                a->surface.count == b->surface.count && a->volume.count == 2 && b->volume.count == 2 &&
                memcmp(a->box, b->box, sizeof a->box) == 0;
    for (int s = 0; good && s < a->surface.count; s++) {
        good = strcmp(a->surface.name[s], b->surface.name[s]) == 0;
    }
    for (int32_t g = 0; good && g < 9; g++) { /* group 7 is of sets 1 and 6, group 8 of 2 and 6 */
        for (int32_t s = 0; s < 7; s++) {
            bool in = g == s || (g > 6 && (s == 6 || s == g - 6));
            good = good && rg_sets_hold(&a->surface, g, s) == in && rg_sets_hold(&b->surface, g, s) == in;
        }
    }
    good = good && rg_sets_groups(&a->surface) == 9 && rg_sets_groups(&b->volume) == 3 &&
           rg_sets_hold(&a->volume, 2, 0) && rg_sets_hold(&b->volume, 2, 1);
    for (int r = 0; good && r < 2; r++) {
        good = strcmp(a->volume.name[r], b->volume.name[r]) == 0;
    }
    return good;
}

static bool same_part(const rg_part *a, const rg_part *b) {
    return a->tiles == b->tiles && a->boundary == b->boundary && a->elements == b->elements &&
           memcmp(a->tile_id, b->tile_id, (size_t)a->tiles * sizeof *a->tile_id) == 0 &&
           memcmp(a->element, b->element, (size_t)a->elements * sizeof *a->element) == 0;
}

/* The same partition, counted face by face. */
static bool quality_right(const rg_part *p) {
    rg_gid faces = 0, most = p->elements;
    int *beside = RG_NEW(int, (size_t)ranks), neighbours = 0, largest, all;
    for (rg_lid i = 0; i < p->elements; i++) {
        for (int f = 0; f < 4; f++) {
            int32_t owner = p->element[i].owner[f];
            faces += owner >= 0 && owner != rank;
            neighbours += owner >= 0 && owner != rank && beside[owner]++ == 0;
        }
    }
    rg_free(beside);
    MPI_Allreduce(MPI_IN_PLACE, &faces, 1, MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD);
    MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_INT64_T, MPI_MAX, MPI_COMM_WORLD);
    MPI_Allreduce(&neighbours, &largest, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    MPI_Allreduce(&neighbours, &all, 1, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
    const rg_partition_quality *q = &p->quality;
    double imbalance = q->imbalance - (double)(most * ranks) / (double)p->total;
    return 2 * q->cut_faces == faces && imbalance * imbalance < 1e-24 && q->neighbours_max == largest &&
           (int)(q->neighbours_mean * ranks + 0.5) == all;
}

static int32_t silly_owner(int64_t tile) {
    return (int32_t)((tile + 1) % ranks);
}

/* Against all elements in order, as one rank alone has them: the same but for the owners of neighbours. */
static bool silly_part_right(const rg_part *p, const rg_part *alone) {
    bool good = p->elements > 0;
    for (rg_lid i = 0; good && i < p->elements; i++) {
        rg_element expected = alone->element[p->element[i].id];
        for (int f = 0; f < 4; f++) {
            rg_gid other = expected.neighbour[f];
            expected.owner[f] = other < 0 ? -1 : silly_owner(other / p->tile);
        }
        good = silly_owner(expected.id / p->tile) == rank &&
               memcmp(&expected, &p->element[i], sizeof expected) == 0;
    }
    return good;
}

static bool tiles_in_order(const rg_part *p) {
    const rg_element *e = p->element;
    bool good = true;
    for (rg_lid t = 0; t < p->tiles; t++) {
        bool shared = false;
        for (rg_lid i = 0; i < rg_tile_size(p, p->tile_id[t]); i++, e++) {
            good = good && e->id == p->tile_id[t] * p->tile + i;
            for (int f = 0; f < 4; f++) {
                shared = shared || (e->owner[f] >= 0 && e->owner[f] != rank);
            }
        }
        good = good && shared == (t < p->boundary) &&
               (t == 0 || t == p->boundary || p->tile_id[t - 1] < p->tile_id[t]);
    }
    return good && e == p->element + p->elements;
}

static void write_silly(int64_t tiles) {
    int32_t *owner = RG_NEW(int32_t, (size_t)tiles);
    for (int64_t t = 0; t < tiles; t++) {
        owner[t] = silly_owner(t);
    }
    rg_mesh_file_add_partitions(path, 1, &(rg_tile_partition){ranks, owner});
    rg_free(owner);
}

/* A box of which each fourth element is in no volume set, and each fourth in two; two sides have a set more,
 * and some faces inside are in it too. */
static rg_mesh *make_mesh(const struct box *b) {
    rg_mesh *mesh = rg_mesh_box(b->cells, b->origin, b->size, b->jitter, 5);
    mesh->region = RG_NEW(int32_t, (size_t)mesh->elements);
    rg_sets_add(&mesh->volume, "core");
    rg_sets_add(&mesh->volume, "shell");
    rg_sets_add(&mesh->surface, "both");
    rg_sets_combine(&mesh->surface, 2, (const int32_t[]){1, 6});
    rg_sets_combine(&mesh->surface, 2, (const int32_t[]){2, 6});
    rg_sets_combine(&mesh->volume, 2, (const int32_t[]){0, 1});
    for (rg_gid e = 0; e < mesh->elements; e++) {
        for (int f = 0; f < 4; f++) {
            int32_t *set = &mesh->set[4 * e + f];
            rg_gid other = mesh->neighbour[4 * e + f];
            *set = *set == 1 || *set == 2 ? *set + 6 : other >= 0 && (e + other) % 5 == 0 ? 6 : *set;
        }
        mesh->region[e] = (int32_t)(e % 4 - 1);
        mesh->original[e] = 2 * mesh->original[e] + 7;
    }
    return mesh;
}

/* Costs that rise along the curve; taken over by who partitions. */
static double *make_weights(const rg_mesh *mesh, int tile) {
    size_t tiles = (size_t)((mesh->elements + tile - 1) / tile);
    double *weight = rank == 0 ? RG_NEW(double, tiles) : NULL;
    for (size_t t = 0; rank == 0 && t < tiles; t++) {
        weight[t] = 1 + 4.0 * (double)t / (double)tiles;
    }
    return weight;
}

static void check_weights(const struct box *b, const rg_mesh *mesh, int tile) {
    double *weight = make_weights(mesh, tile);
    rg_part *given = rg_part_distribute_weighted(rank == 0 ? mesh : NULL, tile, weight, MPI_COMM_WORLD);
    rg_part *read =
        rg_part_read(path, make_weights(mesh, tile), MPI_COMM_WORLD); /* the stored partition knows of none */
    report(same_part(read, given), b->name, "parts by weight have the bits of those that rank 0 distributes");
    const rg_partition_quality *q = &read->quality;
    const rg_partition_quality *other = &given->quality;
    report(q->imbalance == other->imbalance && q->cost_imbalance == other->cost_imbalance &&
               q->cut_faces == other->cut_faces && q->neighbours_max == other->neighbours_max &&
               q->neighbours_mean == other->neighbours_mean,
           b->name, "the same quality");
    report(mesh->elements < 1000 || q->cost_imbalance < 1.1, b->name, "the costs are balanced");
    rg_part_free(given);
    rg_part_free(read);
}

/* The parts of a case: by its weights, by costs that are known better, from its file or from its box. */
static void check_case(const struct box *b, const rg_mesh *mesh, int tile) {
    char *message = NULL;
    rg_case c = {.path = (char[]){"a.yaml"}};
    c.mesh.file = path;
    c.mesh.weight = rg_expr_new("1 + z*z + abs(x)", &message);
    memcpy(c.mesh.cells, b->cells, sizeof c.mesh.cells);
    memcpy(c.mesh.origin, b->origin, sizeof c.mesh.origin);
    memcpy(c.mesh.size, b->size, sizeof c.mesh.size);
    c.mesh.jitter = b->jitter;
    c.mesh.seed = 5;
    size_t bytes = (size_t)((mesh->elements + tile - 1) / tile) * sizeof(double);
    double *file = rg_tile_weights_of_file(&c, MPI_COMM_WORLD),
           *memory = rg_tile_weights_of_mesh(&c, mesh, tile);
    report(rank == 0 ? memcmp(file, memory, bytes) == 0 : file == NULL, b->name,
           "weights of the file's tiles");
    rg_part *expected = rg_part_read(path, file, MPI_COMM_WORLD),
            *found = rg_part_of_case(&c, NULL, MPI_COMM_WORLD);
    report(same_part(found, expected), b->name, "a case's parts by weight");
    rg_part_free(expected);
    rg_part_free(found);
    expected = rg_part_read(path, make_weights(mesh, tile), MPI_COMM_WORLD);
    found = rg_part_of_case(&c, make_weights(mesh, tile), MPI_COMM_WORLD);
    report(same_part(found, expected), b->name, "its parts by costs that are known");
    rg_part_free(expected);
    rg_part_free(found);
    c.mesh.file = NULL;
    rg_mesh *plain = rg_mesh_box(b->cells, b->origin, b->size, b->jitter, 5);
    rg_free(rank > 0 ? memory : NULL);
    expected = rg_part_distribute_weighted(rank == 0 ? plain : NULL, tile, rank == 0 ? memory : NULL,
                                           MPI_COMM_WORLD);
    found = rg_part_of_case(&c, NULL, MPI_COMM_WORLD);
    bool same = same_part(found, expected);
    rg_part_free(expected);
    rg_part_free(found);
    expected =
        rg_part_distribute_weighted(rank == 0 ? plain : NULL, tile, make_weights(mesh, tile), MPI_COMM_WORLD);
    found = rg_part_of_case(&c, make_weights(mesh, tile), MPI_COMM_WORLD);
    report(same && same_part(found, expected), b->name, "a box's parts by weight and by known costs");
    rg_part_free(expected);
    rg_part_free(found);
    rg_mesh_free(plain);
    rg_expr_free(c.mesh.weight);
}

static void check_box(const struct box *b) {
    rg_mesh *mesh = make_mesh(b);
    int tile = rg_mesh_tile(mesh);
    if (rank == 0) {
        rg_mesh_file_write(path, mesh, 0, NULL);
    }
    rg_part *given = rg_part_distribute(rank == 0 ? mesh : NULL, tile, MPI_COMM_WORLD);
    rg_part *read = rg_part_read(path, NULL, MPI_COMM_WORLD);
    report(same_counts(read, given), b->name, "counts, box and sets");
    report(same_part(read, given), b->name, "parts have the bits of those that rank 0 distributes");
    report(quality_right(read) && quality_right(given), b->name, "quality of the partition");
    rg_part_free(given);
    rg_part_free(read);
    rg_part *alone = rg_part_distribute(mesh, tile, MPI_COMM_SELF);
    if (rank == 0) {
        write_silly((mesh->elements + tile - 1) / tile);
    }
    MPI_Barrier(MPI_COMM_WORLD);
    read = rg_part_read(path, NULL, MPI_COMM_WORLD);
    report(silly_part_right(read, alone) && tiles_in_order(read), b->name, "parts of a stored partition");
    report(quality_right(read), b->name, "its quality");
    rg_part_free(read);
    rg_part_free(alone);
    check_weights(b, mesh, tile);
    check_case(b, mesh, tile);
    rg_mesh_free(mesh);
}

/* ---- what a case's boundary asks of the sets of a file ---- */

/* Whether rank 0 ends the run with these words, for which the others wait; NULL: nobody ends it. */
static bool ends_with(const rg_boundary *boundary, int boundaries, const char *words) {
    rg_boundary copy[3];
    memcpy(copy, boundary, (size_t)boundaries * sizeof *boundary);
    rg_case c = {.path = (char[]){"a.yaml"}, .boundaries = boundaries, .boundary = copy};
    c.mesh.file = path;
    volatile bool ended = true;
    expect_fatal = true;
    said[0] = '\0';
    if (setjmp(escape) == 0) {
        rg_part_free(rg_part_of_case(&c, NULL, MPI_COMM_WORLD));
        ended = false;
    }
    expect_fatal = false;
    if (rank == 0 && ended) {
        MPI_Barrier(MPI_COMM_WORLD);
    }
    bool good = words == NULL ? !ended : ended && fatal_status == RG_USAGE && strcmp(said, words) == 0;
    if (!good) {
        printf("# %s\n", said);
    }
    return good;
}

/* Set 6 of the mesh, `both`, has all faces of x+ and of y-: 2 * 2 * 4 and 2 * 3 * 4. */
static void check_boundary(void) {
    static const struct box b = {"overlapping", {3, 2, 4}, {0, 0, 0}, {3, 2, 4}, 0};
    enum { X, Y, Z };
    char high_x[] = "x+", low_y[] = "y-", low_x[] = "x-", both[] = "both", wrong[] = "x*", words[200];
    if (rank == 0) {
        rg_mesh *mesh = make_mesh(&b);
        rg_mesh_file_write(path, mesh, 0, NULL);
        rg_mesh_free(mesh);
    }
    MPI_Barrier(MPI_COMM_WORLD);
    const rg_boundary x_z = {.set = high_x, .component = Z}, y_z = {.set = low_y, .component = Z},
                      low_z = {.set = low_x, .component = Z}, both_y = {.set = both, .component = Y},
                      both_z = {.set = both, .component = Z}, nowhere = {.set = wrong, .component = X},
                      absorbs = {.set = both, .component = -1},
                      absorbs_too = {.set = high_x, .component = -1};
    snprintf(words, sizeof words,
             "a.yaml: boundary[1].set: x*: %s has no such surface set; allowed: x-, x+, y-, y+, z-, z+, "
             "both; did you mean 'x-'?",
             path);
    /* rank 0 looks, and ends the run before the others read */
    report(ranks > 1 || ends_with((const rg_boundary[]){x_z, nowhere}, 2, words), b.name,
           "a set that is not there");
    report(ends_with((const rg_boundary[]){x_z, y_z, both_y}, 3, NULL) &&
               ends_with((const rg_boundary[]){low_z, both_z}, 2, NULL) && ends_with(&both_z, 1, NULL) &&
               ends_with((const rg_boundary[]){absorbs, absorbs_too}, 2, NULL),
           b.name, "sets that share no face, or share them in another direction");
    report(ends_with((const rg_boundary[]){low_z, x_z, both_z}, 3,
                     "a.yaml: boundary[1] and boundary[2] both prescribe component z of 16 faces, which are "
                     "in sets 'x+' "
                     "and 'both'") &&
               ends_with((const rg_boundary[]){both_z, both_y, y_z}, 3,
                         "a.yaml: boundary[0] and boundary[2] both prescribe component z of 24 faces, which "
                         "are in sets "
                         "'both' and 'y-'"),
           b.name, "contradictions");
}

/* ---- meshes that are open, or where three elements share a face ---- */

/* What is told of a mesh, in order. */
typedef struct {
    rg_gid key[2];
    char words[RG_INPUT_ERROR_WORDS];
} line;

static int by_key(const void *a, const void *b) {
    const line *p = a, *q = b;
    int k = p->key[0] == q->key[0];
    return (p->key[k] > q->key[k]) - (p->key[k] < q->key[k]);
}

static bool same_face(const rg_mesh *m, rg_gid slot, rg_gid other) {
    bool same = true;
    for (int i = 0; i < 3; i++) {
        same = same && m->corner[slot / 4 * 4 + rg_face_node[slot % 4][i]] ==
                           m->corner[other / 4 * 4 + rg_face_node[other % 4][i]];
    }
    return same;
}

/* By looking at all pairs of faces: the elements of two open ones at the same place, next to each other in
 * the order of all there, once; and an open one where two others are neighbours. */
static int list_lines(const rg_mesh *m, line *list) {
    int lines = 0;
    for (rg_gid s = 0; s < 4 * m->elements; s++) {
        rg_gid next = -1;
        for (rg_gid o = 0; o < 4 * m->elements; o++) {
            bool open = m->neighbour[o] < 0 && o / 4 != s / 4 && same_face(m, s, o);
            next = open && o / 4 > s / 4 && (next < 0 || o / 4 < next) ? o / 4 : next;
            if (open && m->neighbour[s] > s / 4) {
                list[lines].key[0] = s / 4;
                list[lines].key[1] = s % 4 - 4;
                snprintf(list[lines++].words, sizeof list->words, "elements %d, %d and %d share a face",
                         (int)m->original[s / 4], (int)m->original[m->neighbour[s]], (int)m->original[o / 4]);
            }
        }
        if (m->neighbour[s] < 0 && next >= 0) {
            bool told = false;
            for (int i = 0; i < lines; i++) {
                told = told || (list[i].key[0] == s / 4 && list[i].key[1] == next);
            }
            list[lines].key[0] = s / 4;
            list[lines].key[1] = next;
            snprintf(list[lines].words, sizeof list->words,
                     "elements %d and %d have a face at the same place, but are not neighbours: %s",
                     (int)m->original[s / 4], (int)m->original[next], rg_mesh_open_words(false));
            lines += !told;
        }
    }
    qsort(list, (size_t)lines, sizeof *list, by_key);
    return lines;
}

/* The box and a copy of element `twice` that has no neighbours; `alone`: neither has that element. */
static rg_mesh *make_faulty(rg_gid twice, bool alone) {
    static const struct box b = {"faulty", {1, 1, 2}, {0, 0, 0}, {1, 1, 2}, 0};
    rg_mesh *box = make_mesh(&b), *m = RG_NEW(rg_mesh, 1);
    size_t all = (size_t)box->elements + 1;
    *m = *box;
    m->elements++;
    m->corner = RG_NEW(rg_gid, 4 * all);
    m->neighbour = RG_NEW(rg_gid, 4 * all);
    m->face = RG_NEW(int8_t, 4 * all);
    m->set = RG_NEW(int32_t, 4 * all);
    m->region = RG_NEW(int32_t, all);
    m->original = RG_NEW(rg_gid, all);
    for (rg_gid slot = 0; slot < 4 * m->elements; slot++) {
        bool copy = slot / 4 == box->elements;
        rg_gid from = copy ? 4 * twice + slot % 4 : slot, other = copy ? -1 : box->neighbour[from];
        bool cut = other < 0 || (alone && (from / 4 == twice || other == twice));
        m->corner[slot] = box->corner[from];
        m->neighbour[slot] = cut ? -1 : other;
        m->face[slot] = (int8_t)(cut ? -1 : box->face[from]);
        m->set[slot] = -1;
        m->region[slot / 4] = -1;
        m->original[slot / 4] = 3 * (slot / 4) + 7;
    }
    rg_free(box->corner);
    rg_free(box->neighbour);
    rg_free(box->face);
    rg_free(box->set);
    rg_free(box->region);
    rg_free(box->original);
    rg_free(box);
    return m;
}

static bool reading_ends(void) {
    volatile bool ended = true;
    expect_fatal = true;
    if (setjmp(escape) == 0) {
        rg_part_free(rg_part_read(path, NULL, MPI_COMM_WORLD));
        ended = false;
    }
    expect_fatal = false;
    return ended;
}

/* On one rank: the others would go on where rank 0 has ended the run. */
static bool faulty_told(bool alone) {
    bool good = true;
    for (rg_gid twice = 0; twice < 12 && ranks == 1; twice++) {
        rg_mesh *m = make_faulty(twice, alone);
        line list[40];
        char expected[5000] = "";
        int lines = list_lines(m, list);
        for (int i = 0; i < lines; i++) {
            sprintf(expected + strlen(expected), "%s%s: %s", i > 0 ? "\nrhegma: " : "", path, list[i].words);
        }
        rg_mesh_file_write(path, m, 0, NULL);
        rg_mesh_free(m);
        bool ended = reading_ends();
        size_t seen = strlen(said); /* not all, if they are many */
        bool right = ended && lines > 2 && lines <= 10 && seen > 200 && strncmp(said, expected, seen) == 0 &&
                     (seen == sizeof said - 1 || seen == strlen(expected));
        if (!right) {
            printf("# %s\n# instead of\n# %s\n", said, expected);
        }
        good = good && right;
    }
    return good;
}

/* Of the same elements those that are parts of their own may be where others are; as many ranks as there are
 * read them. */
static bool parts_taken(bool alone, bool apart) {
    bool good = true;
    for (rg_gid twice = 0; twice < 12 && (apart || ranks == 1); twice++) {
        if (rank == 0) {
            rg_mesh *m = make_faulty(twice, alone);
            m->part = RG_NEW(int32_t, (size_t)m->elements);
            m->part[twice] = apart && alone;
            m->part[m->elements - 1] = apart ? 1 + alone : 0;
            rg_mesh_file_write(path, m, 0, NULL);
            rg_mesh_free(m);
        }
        MPI_Barrier(MPI_COMM_WORLD);
        bool ended = reading_ends();
        good = good && ended != apart && (apart || !alone || strstr(said, rg_mesh_open_words(true)) != NULL);
        MPI_Barrier(MPI_COMM_WORLD);
    }
    return good;
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    if (rank == 0) {
        printf("1..%d\n", BOXES * CHECKS + REFUSALS + FAULTY);
        close(mkstemp(path));
    }
    MPI_Bcast(path, sizeof path, MPI_CHAR, 0, MPI_COMM_WORLD);
    for (int b = 0; b < BOXES; b++) {
        check_box(&boxes[b]);
    }
    check_boundary();
    report(faulty_told(true), "faulty", "elements that do not know of each other");
    report(faulty_told(false), "faulty", "three elements at a face");
    for (int k = 0; k < 4; k++) {
        report(parts_taken(k % 2, k / 2), "faulty",
               k < 2 ? "inside one part" : "in parts that are kept apart");
    }
    if (rank == 0) {
        unlink(path);
    }
    MPI_Finalize();
    return failures > 0;
}
