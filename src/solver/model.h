/* What a solver solves: materials, law and strengths. Of the run's solver the case's (solver/setup.c), const
 * from then on; the critical step comes from linear ones (solver/spectrum.c). */
#ifndef RG_MODEL_H
#define RG_MODEL_H

#include "case/case.h"
#include "kernels.h"

/* A face that the case opens at a time; as in the law's strengths, tile-boundary faces are there twice. */
typedef struct {
    size_t tile, face; /* interface, of that tile */
    int set;           /* of interface.sets */
    double at;         /* s */
} rg_opening;

typedef struct {
    int materials;
    const rg_material *material; /* [materials], at rest */
    rg_gradient gradient;
    rg_cohesive law;
    rg_real *scale; /* layout as in rg_interface_args; NULL: all faces alike. Of a face that
                       opens at a time infinite before, 0 after */
    const rg_real *beta, *friction, *rise; /* likewise */
    double stiffest; /* largest ratio of strength to critical opening, over that of the law; 1: all alike */
    size_t openings;
    const rg_opening *opening; /* [openings] */
    const double *open_area;   /* [interface.sets]: of faces that are open, now or later, on all ranks, of
                                  reference (m^2); NULL: no set has any */
    const int64_t *open_faces; /* how many */
    size_t crack_stride, history_stride; /* values of a block of crack and history: as many as the longest
                                            needs */
} rg_model;

/* Of a case, with faces that are all alike (rg_strength_make). Free with rg_model_free. */
rg_model *rg_model_make(const rg_case *c);

void rg_model_free(rg_model *m);

#endif
