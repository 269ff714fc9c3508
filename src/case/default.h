/* Defaults that rest on measurements and depend on other keys. `defaults` in a case chooses their set, so
 * that a case means what it meant when it was written. */
#ifndef RG_CASE_DEFAULT_H
#define RG_CASE_DEFAULT_H

#include "case/case.h"

enum { RG_DEFAULTS = 1 /* the newest set */ };

/* Of form variational set 1 is chosen as one (kernels/README.md, "Which set of defaults"): a penalty that is
 * as stiff as its coercivity needs lengthens the critical step, and a switch and a contact that conserve
 * energy let the step come near it. Other forms have neither and keep the values of set 0. */
#define RG_DEFAULT_WORDS_beta_s                                                                              \
    "2 of form variational and a law of which activation may be conserving, else 4 (defaults 0: 4)"
#define RG_DEFAULT_WORDS_activation                                                                          \
    "conserving of form variational, a law that it takes and no contact flux, else continuous (defaults 0: " \
    "continuous)"
#define RG_DEFAULT_WORDS_onset   "0.5 (defaults 0: 0.3)"
#define RG_DEFAULT_WORDS_contact "potential where beta_s is 2 by default, else penalty (defaults 0: penalty)"
#define RG_DEFAULT_WORDS_safety                                                                              \
    "0.875 of form variational with activation conserving or law none, else 0.5 (defaults 0: 0.5)"
#define RG_DEFAULT_WORDS_contact_friction "interface.friction"
#define RG_DEFAULT_WORDS_static_friction  "contact.friction"

double rg_default_beta_s(const rg_case *c);
double rg_default_activation(const rg_case *c);
double rg_default_onset(const rg_case *c);
double rg_default_contact(const rg_case *c);
double rg_default_safety(const rg_case *c);
double rg_default_contact_friction(const rg_case *c);
double rg_default_static_friction(const rg_case *c);

#endif
