/* Nodes and elements that Abaqus input has generated from others: *NGEN, *NFILL, *ELGEN, *ELCOPY. What they
 * start from must be there already, as the manuals demand. */
#ifndef RG_INP_GENERATE_H
#define RG_INP_GENERATE_H

#include "mesh/import/inp_line.h"
#include "mesh/import/inp_model.h"

enum { RG_INP_GENERATED = 1000000 }; /* as many nodes and elements one model may have generated */

/* Each takes a data line of its keyword (*ELCOPY has none: its parameters); numbers and sets are those of
 * `scope`. `set` gets what the manuals say, or is NULL. */
void rg_inp_ngen(rg_inp_lines *l, rg_inp_model *m, int scope, const char *set);
void rg_inp_nfill(rg_inp_lines *l, rg_inp_model *m, int scope, const char *set);
void rg_inp_elgen(rg_inp_lines *l, rg_inp_model *m, int scope, const char *set);
void rg_inp_elcopy(rg_inp_lines *l, rg_inp_model *m, int scope, const char *set);

#endif
