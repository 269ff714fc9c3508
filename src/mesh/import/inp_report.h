/* What an import of Abaqus input left aside. */
#ifndef RG_INP_REPORT_H
#define RG_INP_REPORT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "mesh/import/inp_line.h"
#include "mesh/rows.h"

typedef struct {
    char name[RG_SET_NAME]; /* a type may be as long as any name */
    bool solid;             /* of an element type: it has a volume, which must not be lost */
    int64_t count;
    rg_inp_place at; /* of the first */
} rg_inp_tally;

typedef struct {
    rg_inp_tally *keyword, *type; /* keywords that say nothing of the mesh; element types */
    size_t keywords, types;
} rg_inp_report;

void rg_inp_report_keyword(rg_inp_report *r, const char *name);

/* The entry of an element type, a new one with a count of 0 if need be. */
size_t rg_inp_report_type(rg_inp_report *r, const char *name, bool solid, rg_inp_place at);

/* Ends the run if there are solids among the element types, warns of the others, or ends it for these
 * too, where all must be `flat` triangles. */
void rg_inp_report_judge(const rg_inp_report *r, const char *path, bool flat);

/* Prints the keywords with their numbers, and frees the report. */
void rg_inp_report_print(rg_inp_report *r, const char *path, FILE *out);

#endif
