/* An entry of a list that a rule looks at, once its keys are read one by one. */
#ifndef RG_CASE_ENTRY_H
#define RG_CASE_ENTRY_H

#include "case/check.h"

typedef struct {
    rg_check *ck;
    const rg_node *item;
    const char *path; /* "loads[2]"; NULL: it is the case itself */
} rg_entry;

/* The key as it stands in the entry, or in a section of it ("weibull.seed"); NULL: it does not. */
const rg_node *rg_entry_given(const rg_entry *e, const char *key);

/* Reports what is wrong with a key of the entry (NULL: with the entry), with what `subject` says besides. */
void rg_entry_wrong(const rg_entry *e, const char *key, rg_place at, rg_subject subject, const char *what);

/* The angular velocity of a state at the start has an axis; its keys begin with `prefix` in the entry
 * (case/initial.c). */
void rg_rotation_rule(const rg_entry *e, const char *prefix, const rg_initial *is);

/* What a static start cannot be found for, what a stress before any deformation and what a temperature need
 * (case/initial.c). */
void rg_start_rule(const rg_entry *e);
void rg_stress_rule(const rg_entry *e);
void rg_temperature_rule(const rg_entry *e);

#endif
