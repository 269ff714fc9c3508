#include "case/default.h"

#include "cohesive/facts.h"

/* Whether the newer set holds for the case: a switch that conserves, or none, goes with its form and law. */
static bool conserves(const rg_case *c) {
    rg_law law = c->interface.law;
    bool falls =
        law == RG_LAW_NONE || (rg_law_facts_of(law, c->interface.shape[law], 1).forms & RG_CONSERVES) != 0;
    return c->defaults >= 1 && c->interface.form == RG_FORM_VARIATIONAL && falls;
}

double rg_default_beta_s(const rg_case *c) {
    return conserves(c) ? 2 : 4;
}

double rg_default_activation(const rg_case *c) {
    return conserves(c) && c->interface.law != RG_LAW_NONE ? RG_ACTIVATION_CONSERVING
                                                           : RG_ACTIVATION_CONTINUOUS;
}

double rg_default_onset(const rg_case *c) {
    return c->defaults >= 1 ? 0.5 : 0.3;
}

double rg_default_contact(const rg_case *c) {
    return conserves(c) ? RG_CONTACT_POTENTIAL : RG_CONTACT_PENALTY;
}

/* A switch that does not conserve needs the smaller step. */
double rg_default_safety(const rg_case *c) {
    bool near = c->interface.law == RG_LAW_NONE || c->interface.activation == RG_ACTIVATION_CONSERVING;
    return conserves(c) && near ? 0.875 : 0.5;
}

double rg_default_contact_friction(const rg_case *c) {
    return c->interface.friction;
}

double rg_default_static_friction(const rg_case *c) {
    return c->contact.friction;
}
