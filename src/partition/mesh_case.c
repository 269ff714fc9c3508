/* The mesh that a case asks for. */
#include "partition/mesh_case.h"

#include <inttypes.h>
#include <string.h>

#include "base/error.h"
#include "base/first_bad.h"
#include "base/mem.h"
#include "case/problem.h"
#include "case/tree.h"
#include "mesh/file.h"
#include "partition/material_map.h"
#include "partition/tile_weight.h"

/* A surface set that entry `i` of a list names must be among those of the mesh file. */
static void check_set(const rg_case *c, const rg_sets *sets, const char *list, int i, const char *set) {
    if (set != NULL && rg_sets_find(sets, set) < 0) {
        const char **names = RG_NEW(const char *, (size_t)sets->count + 1);
        char all[1024];
        for (int32_t k = 0; k < sets->count; k++) {
            names[k] = sets->name[k];
        }
        rg_fatal(RG_USAGE, "%s: %s[%d].set: %s: %s has no such surface set; allowed: %s", c->path, list, i,
                 set, c->mesh.file, rg_choices(set, names, all, sizeof all));
    }
}

/* The case file could not know them. */
static void check_sets(const rg_case *c) {
    rg_mesh_file *f = rg_mesh_file_open(c->mesh.file);
    const rg_sets *sets = &rg_mesh_file_header(f)->surface;
    for (int i = 0; i < c->boundaries; i++) {
        check_set(c, sets, "boundary", i, c->boundary[i].set);
    }
    for (int i = 0; i < c->loads; i++) {
        check_set(c, sets, "loads", i, c->load[i].set);
    }
    for (int i = 0; i < c->interface.sets; i++) {
        check_set(c, sets, "interface.sets", i, c->interface.set[i].set);
    }
    rg_mesh_file_close(f);
}

/* The name of the crack's set, which the caller frees; NULL: there is none. */
static char *crack_of(const char *path) {
    rg_mesh_file *f = rg_mesh_file_open(path);
    const rg_mesh_header *h = rg_mesh_file_header(f);
    char *name = NULL;
    if (h->crack > 0) {
        const char *from = h->surface.name[h->crack - 1];
        name = rg_text_copy(from, strlen(from));
    }
    rg_mesh_file_close(f);
    return name;
}

static char *share_name(char *name, int rank, MPI_Comm comm) {
    int length = name != NULL ? (int)strlen(name) + 1 : 0;
    MPI_Bcast(&length, 1, MPI_INT, 0, comm);
    if (length > 0) {
        name = rank == 0 ? name : RG_NEW(char, (size_t)length);
        MPI_Bcast(name, length, MPI_CHAR, 0, comm);
    }
    return name;
}

/* Why a case cannot have faces that are open from the start, as the rules for interface.sets and start say it
 * of those that it names; NULL: it can. */
static const char *refuse_crack(const rg_case *c) {
    return c->interface.law == RG_LAW_NONE || c->interface.law == RG_LAW_FREE
               ? "needs a law of interfaces that ends (law: none in interface.sets keeps all other faces "
                 "whole)"
           : c->start != RG_START_INITIAL && c->interface.friction > 0
               ? "needs interface.friction 0 with start: static or relax: where it sticks would depend on "
                 "the way"
               : NULL;
}

void rg_case_take_crack(rg_case *c, MPI_Comm comm) {
    int rank;
    MPI_Comm_rank(comm, &rank);
    char *name =
        c->mesh.file == NULL ? NULL : share_name(rank == 0 ? crack_of(c->mesh.file) : NULL, rank, comm);
    bool named = name == NULL;
    for (int i = 0; i < c->interface.sets && !named; i++) {
        named = c->interface.set[i].set != NULL && strcmp(c->interface.set[i].set, name) == 0;
    }
    const char *wrong = named ? NULL : refuse_crack(c);
    if (wrong != NULL) {
        rg_speak(comm);
        rg_fatal(RG_USAGE, "%s: mesh.file: %s: its crack, set '%s', is open from the start, which %s",
                 c->path, c->mesh.file, name, wrong);
    }
    if (named) {
        rg_free(name);
        return;
    }
    int sets = c->interface.sets;
    rg_face_set *all = RG_NEW(rg_face_set, (size_t)sets + 1);
    for (int i = 0; i < sets; i++) {
        all[i] = c->interface.set[i];
    }
    all[sets] = (rg_face_set){.set = name, .open = true}; /* the last: what others say does not close it */
    rg_free(c->interface.set);
    c->interface.set = all;
    c->interface.sets = sets + 1;
}

rg_mesh *rg_mesh_of_case(const rg_case *c) {
    if (c->mesh.file != NULL) {
        check_sets(c);
        return rg_mesh_file_read(c->mesh.file);
    }
    rg_mesh *mesh = rg_mesh_box(c->mesh.cells, c->mesh.origin, c->mesh.size, c->mesh.jitter, c->mesh.seed);
    mesh->tile = rg_tile_elements(mesh->elements, RG_TILE << c->mesh.tile);
    return mesh;
}

/* Parts that are kept apart are so for contact to act between them. */
static void tell_apart(const rg_case *c, const rg_part *part) {
    if (part->parts > 0 && c->contact.model != RG_CONTACT_GENERAL) {
        rg_warn(
            "%s: mesh.file: %s: its %d parts are kept apart (rhegma mesh --apart) and do not see each other "
            "without contact.model: general: they go through each other",
            c->path, c->mesh.file, part->parts);
    }
}

static rg_part *part_of_file(const rg_case *c, double *cost, bool known, int rank, MPI_Comm comm) {
    if (rank == 0) {
        check_sets(c);
    }
    MPI_Barrier(comm); /* what is wrong with the file as such, rank 0 has told */
    if (!known && c->mesh.weight != NULL) {
        cost = rg_tile_weights_of_file(c, comm);
    }
    rg_part *part = rg_part_read(c->mesh.file, cost, comm);
    if (rank == 0 && !known) {
        tell_apart(c, part);
    }
    return part;
}

static rg_part *part_of_box(const rg_case *c, double *cost, bool known, int rank, MPI_Comm comm) {
    rg_mesh *mesh = NULL;
    int tile = 0;
    if (rank == 0) {
        mesh = rg_mesh_of_case(c);
        tile = rg_mesh_tile(mesh);
        if (!known && c->mesh.weight != NULL) {
            cost = rg_tile_weights_of_mesh(c, mesh, tile);
        }
    }
    rg_part *part = rg_part_distribute_weighted(mesh, tile, cost, comm);
    rg_mesh_free(mesh);
    return part;
}

/* Faces on the surface of the whole mesh that are in both sets; collective. */
static int64_t count_shared(const rg_part *part, int32_t a, int32_t b, MPI_Comm comm) {
    int64_t count = 0;
    for (rg_lid e = 0; e < part->elements; e++) {
        for (int f = 0; f < 4; f++) {
            int32_t group = part->element[e].set[f];
            count += part->element[e].neighbour[f] < 0 && rg_sets_hold(&part->surface, group, a) &&
                     rg_sets_hold(&part->surface, group, b);
        }
    }
    MPI_Allreduce(MPI_IN_PLACE, &count, 1, MPI_INT64_T, MPI_SUM, comm);
    return count;
}

/* Sets may overlap; what they prescribe to one face must not contradict. */
static void refuse_contradictions(const rg_case *c, const rg_part *part, MPI_Comm comm) {
    for (int b = 0; b < c->boundaries && part->surface.combinations > 0; b++) {
        for (int a = 0; a < b; a++) {
            const rg_boundary *p = &c->boundary[a], *q = &c->boundary[b];
            int64_t faces = p->component != q->component || p->component < 0 || p->set == NULL ||
                                    q->set == NULL || !rg_boundaries_meet(p, q)
                                ? 0
                                : count_shared(part, rg_sets_find(&part->surface, p->set),
                                               rg_sets_find(&part->surface, q->set), comm);
            if (faces > 0) {
                rg_speak(comm);
                rg_fatal(RG_USAGE,
                         "%s: boundary[%d] and boundary[%d] both prescribe component %c of %" PRId64
                         " faces, which are in sets '%s' and '%s'",
                         c->path, a, b, "xyz"[p->component], faces, p -> set, q -> set);
            }
        }
    }
}

rg_part *rg_part_of_case(const rg_case *c, double *cost, MPI_Comm comm) {
    int rank, known = cost != NULL;
    MPI_Comm_rank(comm, &rank);
    MPI_Bcast(&known, 1, MPI_INT, 0, comm);
    rg_part *part = c->mesh.file != NULL ? part_of_file(c, cost, known, rank, comm)
                                         : part_of_box(c, cost, known, rank, comm);
    refuse_contradictions(c, part, comm);
    rg_materials_assign(c, part, comm);
    return part;
}
