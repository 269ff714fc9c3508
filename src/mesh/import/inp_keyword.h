/* Keywords of Abaqus and CalculiX: those that say something of the mesh, and those that provably do not. */
#ifndef RG_INP_KEYWORD_H
#define RG_INP_KEYWORD_H

typedef enum {
    RG_INP_UNKNOWN,    /* in neither list: it might move, copy or remove something */
    RG_INP_IRRELEVANT, /* materials, loads, constraints, output, ... */
    RG_INP_STEP,
    RG_INP_END_STEP,
    RG_INP_NODE,
    RG_INP_ELEMENT,
    RG_INP_NSET,
    RG_INP_ELSET,
    RG_INP_SURFACE,
    RG_INP_SYSTEM,
    RG_INP_PART,
    RG_INP_END_PART,
    RG_INP_ASSEMBLY,
    RG_INP_END_ASSEMBLY,
    RG_INP_INSTANCE,
    RG_INP_END_INSTANCE,
    RG_INP_NGEN,
    RG_INP_NFILL,
    RG_INP_ELGEN,
    RG_INP_ELCOPY
} rg_inp_word;

typedef struct {
    const char *name; /* capitals, without star and blanks */
    rg_inp_word word;
    const char *parameters; /* all that there may be (rg_inp_allow); NULL: any */
} rg_inp_keyword;

/* The entry of a keyword; `word` is RG_INP_UNKNOWN or RG_INP_IRRELEVANT where it says nothing of the mesh. */
rg_inp_keyword rg_inp_keyword_of(const char *name);

#endif
