/* The registry of materials: everything that is told apart by the model of the bulk derives from this list.
 *
 * A material is a source bulk_NAME.c, which gives the pointwise functions of material_point.h their vector
 * form and includes bulk.h, the kernel around them; a scalar reference of the same (reference_material.h);
 * its parameters and what it prepares for a step; and its line here. */
#ifndef RG_MATERIALS_H
#define RG_MATERIALS_H

#include "deshpande_evans_model.h"

/* What a material has inside, as bits. */
enum {
    RG_HAS_DAMAGE = 1,  /* a share of the solid that is cracked, 0 to 1 */
    RG_HAS_REGIME = 2,  /* regimes of its cracks, 1, 2, 3 */
    RG_HAS_PLASTIC = 4, /* equivalent plastic strain */
};

/* name in C, name of the enum, name in a case file, values of history per point, what it has inside */
#define RG_MATERIALS_ANY(X) X(neo_hookean, NEO_HOOKEAN, "neo-hookean", 0, 0)
/* ... and those that exist in double precision only */
#define RG_MATERIALS_DOUBLE(X)                                                                               \
    X(deshpande_evans, DESHPANDE_EVANS, "deshpande-evans", RG_DE_HISTORY,                                    \
      RG_HAS_DAMAGE | RG_HAS_REGIME | RG_HAS_PLASTIC)

#define RG_MATERIALS(X) RG_MATERIALS_ANY(X) RG_MATERIALS_DOUBLE(X)
#ifdef RG_SINGLE
#define RG_MATERIALS_HERE(X) RG_MATERIALS_ANY(X)
#else
#define RG_MATERIALS_HERE(X) RG_MATERIALS(X)
#endif

#define RG_MATERIAL_ENUM(name, NAME, word, history, inside) RG_MATERIAL_##NAME,
typedef enum { RG_MATERIALS(RG_MATERIAL_ENUM) RG_MATERIAL_MODELS } rg_material_model;

#define RG_MATERIAL_BIT(name, NAME, word, history, inside) RG_MATERIAL_BIT_##NAME = 1 << RG_MATERIAL_##NAME,
enum { RG_MATERIALS(RG_MATERIAL_BIT) };

/* A material as a kernel takes it. */
typedef struct {
    double lambda, mu; /* Lame constants of the undeformed, undamaged solid (Pa) */
    double density;    /* reference density (kg/m^3) */
    rg_material_model model;
    union {
        rg_de_material deshpande_evans;
    } of;
} rg_material;

/* Values of history per point, and what is inside, of a model. */
int rg_material_history(rg_material_model model);
unsigned rg_material_inside(rg_material_model model);

/* Whether this build has the model's kernels. */
int rg_material_exists(rg_material_model model);

/* Readies a material, parameters set, for steps of `dt` (s), which is > 0. */
void rg_material_prepare(rg_material *m, double dt);

#define RG_MATERIAL_PREPARE(name, NAME, word, history, inside)                                               \
    void rg_prepare_##name(rg_material *m, double dt);
RG_MATERIALS(RG_MATERIAL_PREPARE)

#endif
