#include "solver/contact_force.h"

#include "base/error.h"
#include "base/first_bad.h"
#include "base/mem.h"
#include "solver/selection.h"

typedef struct {
    rg_contact_choice which;
    uint8_t *faces; /* of `which`; NULL: by materials */
    int item;
} part;

struct rg_contact_forces {
    rg_account *account;
    int count;
    part *part;
};

/* Ends the run where no element has a material whose force is asked for. */
static void check_material(const rg_case *c, const rg_domain *d, int i, int k, MPI_Comm comm) {
    const char *name = c->output.contact[i].between[k];
    int material = rg_case_find_material(c, name), here = 0, anywhere;
    for (size_t slot = 0; slot < d->blocks * RG_LANES; slot++) {
        here |= d->id[slot] >= 0 && d->material[slot / RG_LANES] == material;
    }
    MPI_Allreduce(&here, &anywhere, 1, MPI_INT, MPI_MAX, comm);
    if (!anywhere) {
        rg_speak(comm);
        rg_fatal(RG_USAGE, "%s: output.contacts[%d].between[%d]: %s: no element is of this material", c->path,
                 i, k, name);
    }
}

rg_contact_forces *rg_contact_forces_make(const rg_case *c, const rg_domain *d, const rg_part *of,
                                          rg_account *account, MPI_Comm comm) {
    rg_contact_forces *f = RG_NEW(rg_contact_forces, 1);
    *f = (rg_contact_forces){account, c->output.contacts, RG_NEW(part, (size_t)c->output.contacts + 1)};
    for (int i = 0; i < f->count; i++) {
        const rg_contact_force_input *in = &c->output.contact[i];
        part *p = &f->part[i];
        p->item = rg_account_add(account, in->name);
        account->item[p->item].inside = true;
        if (in->names == 2) {
            check_material(c, d, i, 0, comm);
            check_material(c, d, i, 1, comm);
            p->which = (rg_contact_choice){NULL, rg_case_find_material(c, in->between[0]),
                                           rg_case_find_material(c, in->between[1])};
        } else {
            rg_selection by = {"output.contacts", i, in->set, in->where, false};
            p->faces = rg_selection_faces(&by, c, d, of, comm);
            p->which = (rg_contact_choice){p->faces, -1, -1};
        }
    }
    return f;
}

void rg_contact_forces_book(const rg_contact_forces *f, const rg_contacts *contacts, size_t tile) {
    for (int i = 0; i < f->count; i++) {
        rg_account_entry entry = {.before = 0};
        if (rg_contacts_force(contacts, tile, &f->part[i].which, entry.force, entry.moment)) {
            rg_account_book(f->account, f->part[i].item, &entry);
        }
    }
}

void rg_contact_forces_free(rg_contact_forces *f) {
    for (int i = 0; f != NULL && i < f->count; i++) {
        rg_free(f->part[i].faces);
    }
    if (f != NULL) {
        rg_free(f->part);
        rg_free(f);
    }
}
