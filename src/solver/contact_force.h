/* Forces of contact between fragments (contact/contact.h) on parts of the solid that the case names in
 * output.contacts: items of the account (solver/account.h), without work, as these act inside the solid. */
#ifndef RG_CONTACT_FORCE_H
#define RG_CONTACT_FORCE_H

#include "contact/contact.h"
#include "solver/account.h"

typedef struct rg_contact_forces rg_contact_forces;

/* One item of the account for each part. Ends the run with a message where a part has no face, or a material
 * no element. Keeps a reference to `account`. Collective; free with rg_contact_forces_free. */
rg_contact_forces *rg_contact_forces_make(const rg_case *c, const rg_domain *d, const rg_part *part,
                                          rg_account *account, MPI_Comm comm);

/* Books the forces on a tile at the present time. Threads call it at once. */
void rg_contact_forces_book(const rg_contact_forces *f, const rg_contacts *contacts, size_t tile);

void rg_contact_forces_free(rg_contact_forces *f);

#endif
