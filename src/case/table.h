/* The tables of a case: functions of one variable that its expressions may call. */
#ifndef RG_CASE_TABLE_H
#define RG_CASE_TABLE_H

#include <stdio.h>

#include "case/check.h"

/* Reads the mapping `tables`: of each name a list of points, the path of a CSV file relative to the case
 * file, or {points or file, smooth}. False: something is wrong and reported under `path`; what is right is
 * there. */
bool rg_tables_read(rg_check *ck, const rg_key *key, const rg_node *node, const char *path, rg_curves *all);

/* All tables by their points, in one line of YAML. */
void rg_tables_write(FILE *out, const rg_curves *all);

#endif
