/* What a restart may not change in a case: all keys but those marked so in the registry (case/key.c). */
#ifndef RG_CASE_COMPARE_H
#define RG_CASE_COMPARE_H

#include "case/case.h"

/* The values of those keys, "key: value" one a line. The caller frees it with free(). */
char *rg_case_fixed(const rg_case *c);

/* What differs between two such texts, in words; NULL if nothing does. The caller frees it with rg_free. */
char *rg_case_changes(const char *before, const char *here);

#endif
