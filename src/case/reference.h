/* What `rhegma keys` prints: the registry of keys, for people and for editors. */
#ifndef RG_CASE_REFERENCE_H
#define RG_CASE_REFERENCE_H

#include <stdio.h>

#include "case/key.h"

/* Calls visit(to, name, key) for every key that a case file may have, in order: "mesh.cells", and below each
 * list the keys of its entries, "boundary[].set". Those of `materials` that `material` has too come once. */
typedef void rg_key_visit(void *to, const char *name, const rg_key *key);
void rg_keys_walk(rg_key_visit *visit, void *to);

/* Writes the keys whose names begin with `prefix` ("": all), as text or as Markdown, and what expressions
 * know where "expressions" does. Returns how many that were. */
int rg_reference_text(FILE *out, const char *prefix);
int rg_reference_markdown(FILE *out, const char *prefix);

/* Writes a JSON Schema (draft 7) of case files, by which an editor completes and checks them. It lets pass
 * what only the program can tell, as the sets of a mesh. */
void rg_schema_write(FILE *out);

#endif
