/* An entry of a list that a rule looks at, once its keys are read one by one. */
#ifndef RG_CASE_ENTRY_H
#define RG_CASE_ENTRY_H

#include "case/check.h"

typedef struct {
    rg_check *ck;
    const rg_node *item;
    const char *path; /* "loads[2]" */
} rg_entry;

/* The key as it stands in the entry, or in a section of it ("weibull.seed"); NULL: it does not. */
const rg_node *rg_entry_given(const rg_entry *e, const char *key);

/* Reports what is wrong with a key of the entry (NULL: with the entry), with what `subject` says besides. */
void rg_entry_wrong(const rg_entry *e, const char *key, rg_place at, rg_subject subject, const char *what);

#endif
