/* The registry of materials: everything that is told apart by the model of the bulk derives from this list.
 *
 * A material is a source bulk_NAME.c, which gives the pointwise functions of element/material_point.h their
 * vector form and includes element/bulk.h, the kernel around them; a source reference_NAME.c, the same as a
 * scalar (reference/material.h); its line here, and one for each parameter of its own. Case keys, dispatch,
 * fields, checkpoints and tests follow from these. */
#ifndef RG_MATERIALS_H
#define RG_MATERIALS_H

#include "material/deshpande_evans_model.h"

/* What a material has inside, and how its elastic constants are given, as bits. */
enum {
    RG_HAS_DAMAGE = 1,  /* a share of the solid that is cracked, 0 to 1 */
    RG_HAS_REGIME = 2,  /* regimes of its cracks, 1, 2, 3 */
    RG_HAS_PLASTIC = 4, /* equivalent plastic strain */
    RG_TAKES_YOUNG = 8, /* by Young's modulus and Poisson's ratio */
    RG_TAKES_BULK = 16, /* by its bulk modulus and coefficients of its energy */
};

/* Constants of an elastic solid of any symmetry: the upper triangle of its stiffness, row by row, in Voigt's
 * order 11 22 33 23 13 12 with shear strains 2 e_23, 2 e_13, 2 e_12. */
enum { RG_STIFFNESS = 21 };

/* History of a point of material/j2.h. Zero is the virgin material. */
enum {
    RG_J2_STRAIN = 0, /* ep, accumulated equivalent plastic strain */
    RG_J2_FLOW = 1,   /* Fp^-1 Fp^-T - I, six components xx yy zz yz xz xy */
    RG_J2_HISTORY = 7,
};

/* name in C, name of the enum, name in a case file, what it is, values of history per point, bits of the
 * above */
#define RG_MATERIALS_ANY(X)                                                                                  \
    X(neo_hookean, NEO_HOOKEAN, "neo-hookean", "elastic at any strain", 0, RG_TAKES_YOUNG)                   \
    X(linear_elastic, LINEAR_ELASTIC, "linear-elastic", "for small strains and small rotations alone", 0,    \
      RG_TAKES_YOUNG)                                                                                        \
    X(st_venant_kirchhoff, ST_VENANT_KIRCHHOFF, "st-venant-kirchhoff",                                       \
      "elastic at moderate strains and any rotation", 0, RG_TAKES_YOUNG)                                     \
    X(anisotropic, ANISOTROPIC, "anisotropic",                                                               \
      "a crystal or a composite: the same with a stiffness of any symmetry, along axes of its own", 0, 0)
/* ... and those that exist in double precision only */
#define RG_MATERIALS_DOUBLE(X)                                                                               \
    X(mooney_rivlin, MOONEY_RIVLIN, "mooney-rivlin", "rubber: Mooney and Rivlin's, compressible", 0,         \
      RG_TAKES_BULK)                                                                                         \
    X(deshpande_evans, DESHPANDE_EVANS, "deshpande-evans",                                                   \
      "a ceramic with growing microcracks and plastic flow", RG_DE_HISTORY,                                  \
      RG_HAS_DAMAGE | RG_HAS_REGIME | RG_HAS_PLASTIC)                                                        \
    X(j2, J2, "j2", "a metal that flows: J2 plasticity with isotropic hardening", RG_J2_HISTORY,             \
      RG_TAKES_YOUNG | RG_HAS_PLASTIC)

#define RG_MATERIALS(X) RG_MATERIALS_ANY(X) RG_MATERIALS_DOUBLE(X)
#ifdef RG_SINGLE
#define RG_MATERIALS_HERE(X) RG_MATERIALS_ANY(X)
#else
#define RG_MATERIALS_HERE(X) RG_MATERIALS(X)
#endif

#define RG_MATERIAL_ENUM(name, NAME, word, meaning, history, inside) RG_MATERIAL_##NAME,
typedef enum { RG_MATERIALS(RG_MATERIAL_ENUM) RG_MATERIAL_MODELS } rg_material_model;

#define RG_MATERIAL_BIT(name, NAME, word, meaning, history, inside)                                          \
    RG_MATERIAL_BIT_##NAME = 1 << RG_MATERIAL_##NAME,
enum { RG_MATERIALS(RG_MATERIAL_BIT) };

/* What a parameter may be. */
typedef enum {
    RG_NEEDED,   /* given, > 0 */
    RG_FROM_0,   /* >= 0; 0 where it is not given */
    RG_ANY_SIGN, /* any number; 0 where it is not given */
} rg_parameter_range;

/* Parameters besides density, elastic constants and those of the ceramic alone: name of the enum, key in the
 * block of a material, unit, range, models that use it, meaning. */
#define RG_MATERIAL_PARAMETERS(X)                                                                            \
    X(YIELD_STRESS, "yield_stress", "Pa", RG_NEEDED, RG_MATERIAL_BIT_J2 | RG_MATERIAL_BIT_DESHPANDE_EVANS,   \
      "yield stress before any plastic strain")                                                              \
    X(HARDENING, "hardening", "Pa", RG_FROM_0, RG_MATERIAL_BIT_J2,                                           \
      "slope of the yield stress over plastic strain")                                                       \
    X(SATURATION_STRESS, "saturation_stress", "Pa", RG_FROM_0, RG_MATERIAL_BIT_J2,                           \
      "yield stress to which hardening of Voce's kind goes up, not below yield_stress; goes with "           \
      "saturation_rate")                                                                                     \
    X(SATURATION_RATE, "saturation_rate", NULL, RG_FROM_0, RG_MATERIAL_BIT_J2,                               \
      "how fast it goes there: as 1 - exp(-saturation_rate times plastic strain)")                           \
    X(BULK, "bulk", "Pa", RG_NEEDED, RG_MATERIAL_BIT_MOONEY_RIVLIN, "bulk modulus K")                        \
    X(C10, "c10", "Pa", RG_NEEDED, RG_MATERIAL_BIT_MOONEY_RIVLIN,                                            \
      "coefficient of the first invariant; the shear modulus at rest is 2 (c10 + c01)")                      \
    X(C01, "c01", "Pa", RG_FROM_0, RG_MATERIAL_BIT_MOONEY_RIVLIN, "coefficient of the second invariant")

#define RG_PARAMETER_ENUM(NAME, key, unit, range, models, meaning) RG_PARAMETER_##NAME,
enum { RG_MATERIAL_PARAMETERS(RG_PARAMETER_ENUM) RG_PARAMETERS };

/* An anisotropic solid, in the axes of the mesh. Of the acoustic tensor of each direction the largest
 * eigenvalue: the most and the least of all directions (Pa). */
typedef struct {
    double stiffness[RG_STIFFNESS];
    double stiffest, softest;
} rg_anisotropic;

/* A material as a kernel takes it. */
typedef struct {
    double lambda, mu; /* Lame constants of the undeformed, undamaged solid (Pa); of an anisotropic one the
                          means over all orientations of its stiffness (Voigt's) */
    double density;    /* reference density (kg/m^3) */
    double dt;         /* step for which it was prepared (s) */
    rg_material_model model;
    union {
        rg_de_material deshpande_evans;
        rg_anisotropic anisotropic;
        double parameter[RG_PARAMETERS]; /* of all others */
    } of;
} rg_material;

/* The model's name in a case file. */
const char *rg_material_word(rg_material_model model);

/* Values of history per point, and what is inside, of a model. */
int rg_material_history(rg_material_model model);
unsigned rg_material_inside(rg_material_model model);

/* Whether this build has the model's kernels. */
int rg_material_exists(rg_material_model model);

/* Readies a material, parameters set, for steps of `dt` (s), which is > 0: of a model that knows rates. */
void rg_material_prepare(rg_material *m, double dt);

#endif
