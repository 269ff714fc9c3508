/* What a solver solves: materials, law and strengths. Of the run's solver the case's (solver/setup.c), const
 * from then on; the critical step comes from linear ones (solver/spectrum.c). */
#ifndef RG_MODEL_H
#define RG_MODEL_H

#include "case/case.h"
#include "kernels.h"

typedef struct {
    int materials;
    const rg_material *material; /* [materials], at rest */
    rg_gradient gradient;
    rg_cohesive law;
    const rg_real *scale;           /* layout as in rg_interface_args; NULL: all faces alike */
    const rg_real *beta, *friction; /* likewise */
    double stiffest; /* largest ratio of strength to critical opening, over that of the law; 1: all alike */
    size_t crack_stride, history_stride; /* values of a block of crack and history: as many as the longest
                                            needs */
} rg_model;

/* Of a case, with faces that are all alike (rg_strength_make). Free with rg_model_free. */
rg_model *rg_model_make(const rg_case *c);

void rg_model_free(rg_model *m);

#endif
