/* Defaults that rest on measurements and depend on other keys. `defaults` in a case chooses their set, so
 * that a case means what it meant when it was written. */
#ifndef RG_CASE_DEFAULT_H
#define RG_CASE_DEFAULT_H

#include "case/case.h"

enum { RG_DEFAULTS = 1 /* the newest set */ };

/* Of form variational set 1 is chosen as one (kernels/README.md, "Which set of defaults"): a penalty that is
 * as stiff as its coercivity needs lengthens the critical step, and a switch and a contact that conserve
 * energy let the step come near it. Other forms have neither and keep the thesis's values. */
#define RG_DEFAULT_WORDS_beta_s "4 (defaults 1: 2)"
#define RG_DEFAULT_WORDS_activation                                                                          \
    "continuous (defaults 1: conserving, of a law that it takes, without contact flux)"
#define RG_DEFAULT_WORDS_onset   "0.3 (defaults 1: 1)"
#define RG_DEFAULT_WORDS_contact "penalty (defaults 1: potential)"
#define RG_DEFAULT_WORDS_safety  "0.5 (defaults 1: 0.9)"

double rg_default_beta_s(const rg_case *c);
double rg_default_activation(const rg_case *c);
double rg_default_onset(const rg_case *c);
double rg_default_contact(const rg_case *c);
double rg_default_safety(const rg_case *c);

#endif
