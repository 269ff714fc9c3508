#include "solver/setup.h"

#include <omp.h>
#include <string.h>

#include "base/error.h"
#include "base/mem.h"
#include "partition/material.h"
#include "partition/mesh_case.h"
#include "partition/patch.h"
#include "solver/fields.h"
#include "solver/law.h"
#include "solver/stepper.h"
#include "solver/strength.h"
#include "solver/tile.h"

/* What the sweeps need beside the fields. */
static void allocate_rows(rg_solver *s) {
    size_t rows = s->domain->own_rows + s->domain->shared;
    s->stepper = RG_NEW(rg_stepper, 1);
    s->stepper->rows[0] = RG_NEW(rg_real, rows * RG_TRACE_ROW);
    s->stepper->rows[1] = RG_NEW(rg_real, rows * RG_TRACE_ROW);
    s->stepper->tractions = RG_NEW(rg_real, rows * RG_TILE_FACE_ROW);
    s->stepper->material = RG_NEW(rg_material, (size_t)s->model->materials);
    s->stepper->touching_request = MPI_REQUEST_NULL;
    memcpy(s->stepper->material, s->model->material,
           (size_t)s->model->materials * sizeof *s->stepper->material);
    s->work = RG_NEW(rg_workspace, (size_t)s->threads);
}

static void make_workspaces(rg_solver *s) {
#pragma omp parallel
    s->work[omp_get_thread_num()] = rg_workspace_make(s->domain);
}

static void touch_tile(rg_solver *s, const rg_tile *t) {
    size_t rows = rg_tile_face_blocks(t) * RG_LANES;
    rg_fields_touch(s, t);
    memset(s->stepper->tractions + t->row * RG_TILE_FACE_ROW, 0, rows * sizeof(rg_real[RG_TILE_FACE_ROW]));
    for (int k = 0; k < 2; k++) {
        memset(s->stepper->rows[k] + t->row * RG_TRACE_ROW, 0, rows * sizeof(rg_real[RG_TRACE_ROW]));
    }
}

/* In the loops of `evaluate`. */
void rg_solver_touch(rg_solver *s) {
    const rg_domain *d = s->domain;
#pragma omp parallel
    {
#pragma omp for schedule(static)
        for (size_t t = 0; t < d->boundary_tiles; t++) {
            touch_tile(s, &d->tile[t]);
        }
#pragma omp for schedule(static)
        for (size_t t = d->boundary_tiles; t < d->tiles; t++) {
            touch_tile(s, &d->tile[t]);
        }
    }
}

static void select_kernels(rg_solver *s) {
    s->kernels = rg_kernels_select();
    if (s->kernels == NULL) {
        rg_speak(s->comm);
        rg_fatal(RG_USAGE, "RHEGMA_ISA names an instruction set that this machine does not have; there are "
                           "x86-64-v2, -v3, -v4");
    }
}

/* The domain, and what joins its elements; the part's list of them is needed no more. */
static void build_domain(rg_solver *s, const rg_interface_material *m) {
    uint8_t *joined = rg_joined_faces(s->input, s->part, s->comm);
    s->domain = rg_domain_build(s->part, joined, s->rank, m);
    if (joined != NULL) {
        s->conforming_faces = rg_conforming_faces_make(s->domain, s->part, joined, s->rank);
        s->assembly = rg_assembly_make(s->domain, s->conforming_faces, s->model->material, s->comm);
    }
    rg_free(joined);
    rg_free(s->part->element);
    rg_free(s->part->turn);
    s->part->element = NULL;
    s->part->turn = NULL;
}

/* Fields at rest, which nobody has touched yet, and what they are stepped with. */
static void allocate(rg_solver *s) {
    rg_fields_allocate(s);
    allocate_rows(s);
    make_workspaces(s);
    for (int k = 0; k < 2; k++) {
        s->stepper->halo_u[k] = rg_halo_make(s->domain, RG_TRACE_ROW, s->stepper->rows[k], 1 + k, s->comm);
    }
    s->stepper->halo_t = rg_halo_make(s->domain, RG_TILE_FACE_ROW, s->stepper->tractions, 3, s->comm);
}

static rg_solver *make(const rg_case *input, rg_part *part, MPI_Comm comm) {
    rg_model *model = rg_model_make(input);
    rg_solver *s = RG_NEW(rg_solver, 1);
    *s = (rg_solver){.input = input,
                     .model = model,
                     .comm = comm,
                     .threads = omp_get_max_threads(),
                     .part = part,
                     .limiting = -1};
    MPI_Comm_rank(comm, &s->rank);
    MPI_Comm_size(comm, &s->ranks);
    select_kernels(s);
    rg_interface_material m = {model->materials, model->material, input->interface.beta_s,
                               input->interface.penalty};
    build_domain(s, &m);
    if (part->original == NULL) { /* a patch has no need of them */
        rg_strength_make(s, model);
    }
    s->account = rg_account_make(comm);
    s->constraints =
        rg_constraints_make(input, s->domain, s->part, model->material, s->assembly, s->account, comm);
    s->bodies = rg_bodies_make(input, s->domain, s->part, model->material, s->threads, comm);
    s->ties = rg_ties_make(input, s->domain, s->part, model->material, s->assembly, s->bodies, s->constraints,
                           s->threads, comm);
    s->loads = rg_loads_make(input, s->domain, s->part, model->material, s->account, s->threads, comm);
    s->absorbing =
        rg_absorbing_make(input, s->domain, s->part, model->material, s->assembly, s->account, comm);
    if (part->original == NULL && input->contact.model == RG_CONTACT_GENERAL) {
        s->contacts = rg_contacts_make(input, s->domain, model->material, comm);
        s->contact_forces = rg_contact_forces_make(input, s->domain, s->part, s->account, comm);
    }
    rg_account_open(s->account, s->threads);
    s->heating = rg_heating_make(s);
    allocate(s);
    rg_law_start(s);
    return s;
}

rg_solver *rg_solver_make_from_part(const rg_case *input, rg_part *part, MPI_Comm comm) {
    rg_solver *s = make(input, part, comm);
    rg_solver_touch(s);
    return s;
}

rg_solver *rg_solver_beside(const rg_solver *s, const rg_model *model) {
    rg_solver *b = RG_NEW(rg_solver, 1);
    *b = (rg_solver){.input = s->input,
                     .model = model,
                     .comm = s->comm,
                     .rank = s->rank,
                     .ranks = s->ranks,
                     .threads = s->threads,
                     .kernels = s->kernels,
                     .part = s->part,
                     .domain = s->domain,
                     .conforming_faces = s->conforming_faces,
                     .assembly = s->assembly,
                     .beside = true,
                     .limiting = -1};
    allocate(b);
    rg_solver_touch(b);
    return b;
}

rg_solver *rg_solver_make(const rg_case *input, MPI_Comm comm) {
    rg_part *part = rg_part_of_case(input, NULL, comm);
    bool shared = input->interface.form == RG_FORM_CONTINUOUS; /* rg_spectrum has no use for a patch then */
    rg_material *material = rg_materials_of_case(input);
    rg_part *patch = shared ? NULL : rg_patch_gather(part, material, comm);
    rg_free(material);
    rg_solver *s = make(input, part, comm);
    s->patch = patch;
    if (!shared) {
        rg_solver_touch(s);
    }
    return s;
}

static void free_stepper(rg_solver *s) {
    rg_stepper *m = s->stepper;
    rg_halo_free(m->halo_u[0]);
    rg_halo_free(m->halo_u[1]);
    rg_halo_free(m->halo_t);
    for (int t = 0; t < s->threads; t++) {
        rg_workspace_free(&s->work[t]);
    }
    void *blocks[] = {m->rows[0], m->rows[1], m->tractions, m->material, m, s->work};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) {
        rg_free(blocks[i]);
    }
}

void rg_solver_free(rg_solver *s) {
    if (s == NULL) {
        return;
    }
    rg_fields_free(s);
    free_stepper(s);
    rg_free(s->tile_seconds);
    if (!s->beside) {
        rg_constraints_free(s->constraints);
        rg_ties_free(s->ties);
        rg_bodies_free(s->bodies);
        rg_loads_free(s->loads);
        rg_absorbing_free(s->absorbing);
        rg_account_free(s->account);
        rg_contacts_free(s->contacts);
        rg_contact_forces_free(s->contact_forces);
        rg_heating_free(s->heating);
        rg_assembly_free(s->assembly);
        rg_conforming_faces_free((rg_conforming_faces *)s->conforming_faces);
        rg_domain_free((rg_domain *)s->domain);
        rg_part_free(s->part);
        rg_part_free(s->patch);
        rg_model_free((rg_model *)s->model);
    }
    rg_free(s);
}
