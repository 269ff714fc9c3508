/* The choices that a case makes of the discretization, as the kernels take them. Numbers are sections of
 * kernels/README.md. The first of each is the default of the case file. */
#ifndef RG_MODES_H
#define RG_MODES_H

/* Weak form (2). */
typedef enum { RG_FORM_VARIATIONAL, RG_FORM_INCOMPLETE, RG_FORM_INTRINSIC, RG_FORM_CONTINUOUS } rg_form;

/* F* of the weak form (2), at which the stress is taken: F of the element's own nodes, or F + R, which
 * carries the jumps of its faces. */
typedef enum { RG_GRADIENT_OWN, RG_GRADIENT_LIFTED } rg_gradient;

/* A_N of the interior penalty (2): the acoustic tensor at rest, or (lambda + 2 mu) I. */
typedef enum { RG_PENALTY_ELASTIC, RG_PENALTY_ISOTROPIC } rg_penalty;

/* When a point breaks (6): by the quadratic criterion of tension and shear; or by that, where pressure adds
 * its friction to the strength of shear. */
typedef enum { RG_CRITERION_QUADRATIC, RG_CRITERION_MOHR_COULOMB } rg_criterion;

/* What becomes of the shear traction of a point that breaks by opening alone, beta = 0 (6): nothing, or a
 * spring goes on with it and fades. */
typedef enum { RG_SHEAR_RELEASED, RG_SHEAR_FADING } rg_shear;

/* What the opening of a point is when it switches to its law (6). */
typedef enum { RG_ACTIVATION_CONTINUOUS, RG_ACTIVATION_TOTAL, RG_ACTIVATION_CONSERVING } rg_activation;
enum { RG_ACTIVATIONS = 3 };

/* What closed points meet (6). LINEAR: the penalty on whatever opening, for the time step; no case has it. */
typedef enum { RG_CONTACT_PENALTY, RG_CONTACT_FLUX, RG_CONTACT_POTENTIAL, RG_CONTACT_LINEAR } rg_contact;

/* What holds closed points as they slide (6): nothing; the elastic predictor and return of
 * cohesive/friction.h; or its spring without limit or memory, for the time step, which no case has. */
typedef enum { RG_SLIDING_FREE, RG_SLIDING_COULOMB, RG_SLIDING_STUCK } rg_sliding;

/* Mass matrix (3). */
typedef enum { RG_MASS_CONSISTENT, RG_MASS_LUMPED, RG_MASS_SCALED } rg_mass;
enum { RG_MASSES = 3, RG_MASS_SCALE = 2 /* s of the scaled one (kernels/README.md, section 4) */ };

/* The two sweeps of a step (src/README.md): elements with the interfaces inside a tile, then the
 * tile-boundary faces. */
typedef enum { RG_SWEEP_ELEMENT, RG_SWEEP_BOUNDARY } rg_sweep;

#endif
