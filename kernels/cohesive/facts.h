/* What is to be known of a cohesive law outside the kernels: all of it from the registry, laws.h. */
#ifndef RG_COHESIVE_FACTS_H
#define RG_COHESIVE_FACTS_H

#include "kernels.h"

enum {
    RG_FORMS_DG = 1,
    RG_FORMS_INTRINSIC = 2,
    RG_NORMAL_MEASURE = 4, /* the law's history is that of the normal opening alone */
    RG_LIMITS_STEP = 8,    /* the time step can follow its opening */
    RG_ENVELOPE =
        16, /* unloads to the origin; its secant falls only while the largest opening grows, and is that
              of strength times (1 - x) where it does so slowly: fit for a conserving activation */
    RG_FOLLOWS =
        64, /* with RG_ENVELOPE: its secant falls also below the largest opening, so that a conserving
               activation asks it at the opening and tells the onset, from which it counts its energy */
    RG_WORKLESS = 128, /* no work of separation: all that a conserving activation sets free is unresolved */
    RG_CONSERVES = RG_ENVELOPE | RG_WORKLESS, /* a conserving activation can serve it */
    RG_MIXED = 32, /* each point has a critical opening of its own, from the share of shear at its switch: its
                      memory begins with what that is larger by, over the law's */
};

typedef struct {
    const char *word; /* in case files */
    int forms;
    double work;       /* of separation, over strength times critical opening */
    double separation; /* effective opening of full separation, over the critical opening */
    double
        slope[2]; /* bound on the stiffness of opening and of sliding, times critical opening over strength */
    int memory;   /* values of a point besides RG_CRACK */
} rg_law_facts;

/* Facts of a law (not RG_LAW_NONE) with its own parameters shape[RG_LAW_SHAPE] and the weight of shear. */
rg_law_facts rg_law_facts_of(rg_law law, const double *shape, double beta);

#endif
