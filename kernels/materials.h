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
    RG_HAS_DAMAGE = 1,        /* a share of the solid that is cracked, 0 to 1 */
    RG_HAS_REGIME = 2,        /* regimes of its cracks, 1, 2, 3 */
    RG_HAS_PLASTIC = 4,       /* equivalent plastic strain */
    RG_TAKES_YOUNG = 8,       /* by Young's modulus and Poisson's ratio */
    RG_TAKES_BULK = 16,       /* by its bulk modulus and coefficients of its energy */
    RG_HAS_VOLUME = 32,       /* plastic change of volume */
    RG_HAS_BULKING = 64,      /* pressure of what is crushed and takes more room */
    RG_HAS_TEMPERATURE = 128, /* a temperature of its own */
};

/* Constants of an elastic solid of any symmetry: the upper triangle of its stiffness, row by row, in Voigt's
 * order 11 22 33 23 13 12 with shear strains 2 e_23, 2 e_13, 2 e_12. */
enum { RG_STIFFNESS = 21 };

enum { RG_OGDEN_TERMS = 3 }; /* of the energy of material/ogden.h, at most */

/* History of a point of material/j2.h. Zero is the virgin material. */
enum {
    RG_J2_STRAIN = 0, /* ep, accumulated equivalent plastic strain */
    RG_J2_FLOW = 1,   /* Fp^-1 Fp^-T - I, six components xx yy zz yz xz xy */
    RG_J2_HISTORY = 7,
};

/* History of a point of material/johnson_cook.h. Zero is the virgin material, at the temperature to begin
 * with. */
enum {
    RG_JC_STRAIN = 0, /* ep, accumulated equivalent plastic strain */
    RG_JC_RISE = 1,   /* of the temperature (K) */
    RG_JC_FLOW = 2,   /* as RG_J2_FLOW */
    RG_JC_HISTORY = 8,
};

/* History of a point of material/johnson_holmquist.h. Zero is the virgin material. */
enum {
    RG_JH_STRAIN = 0,  /* accumulated equivalent plastic strain */
    RG_JH_DAMAGE = 1,  /* D */
    RG_JH_BULKING = 2, /* dp (Pa) */
    RG_JH_LAST = 3,    /* eb, the size of the elastic strain, after a step that flowed; 0: it did not */
    RG_JH_FLOW = 4,    /* as RG_J2_FLOW */
    RG_JH_HISTORY = 10,
};

/* History of a point of material/holmquist_johnson_cook.h. Zero is the virgin material. */
enum {
    RG_HJC_STRAIN = 0, /* accumulated equivalent plastic strain */
    RG_HJC_DAMAGE = 1, /* D */
    RG_HJC_CLOSED = 2, /* largest mu so far beyond mu_c, at most mu_m - mu_c */
    RG_HJC_LAST = 3,   /* as RG_JH_LAST */
    RG_HJC_FLOW = 4,   /* as RG_J2_FLOW */
    RG_HJC_HISTORY = 10,
};

/* History of a point of material/drucker_prager.h. Zero is the virgin material. */
enum {
    RG_DP_STRAIN = 0, /* accumulated equivalent plastic strain */
    RG_DP_VOLUME = 1, /* plastic part of log J */
    RG_DP_RISE = 2,   /* of the cap's pressure (Pa) */
    RG_DP_MEAN = 3,   /* mean of tau after a step that flowed (Pa); 0: it did not */
    RG_DP_MISES = 4,  /* its von Mises part (Pa), likewise */
    RG_DP_FLOW = 5,   /* as RG_J2_FLOW, of the part of Fp that keeps the volume */
    RG_DP_HISTORY = 11,
};

/* History of a point of material/viscoelastic.h, tensors xx yy zz yz xz xy. Zero is the virgin material. */
enum {
    RG_VE_ELEMENTS = 3, /* Maxwell's */
    RG_VE_STRAIN = 0,   /* E after the last step */
    RG_VE_ELASTIC = 6,  /* A of each element */
    RG_VE_HISTORY = 6 + 6 * RG_VE_ELEMENTS,
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
    X(ogden, OGDEN, "ogden", "rubber: Ogden's, of powers of the principal stretches", 0, RG_TAKES_BULK)      \
    X(deshpande_evans, DESHPANDE_EVANS, "deshpande-evans",                                                   \
      "a ceramic with growing microcracks and plastic flow", RG_DE_HISTORY,                                  \
      RG_HAS_DAMAGE | RG_HAS_REGIME | RG_HAS_PLASTIC)                                                        \
    X(j2, J2, "j2", "a metal that flows: J2 plasticity with isotropic hardening", RG_J2_HISTORY,             \
      RG_TAKES_YOUNG | RG_HAS_PLASTIC)                                                                       \
    X(johnson_cook, JOHNSON_COOK, "johnson-cook",                                                            \
      "a metal that flows harder the faster and softer the hotter it is", RG_JC_HISTORY,                     \
      RG_TAKES_YOUNG | RG_HAS_PLASTIC | RG_HAS_TEMPERATURE)                                                  \
    X(johnson_holmquist, JOHNSON_HOLMQUIST, "johnson-holmquist-2",                                           \
      "a ceramic or glass that is crushed, under high pressure too", RG_JH_HISTORY,                          \
      RG_TAKES_YOUNG | RG_HAS_DAMAGE | RG_HAS_PLASTIC | RG_HAS_BULKING)                                      \
    X(holmquist_johnson_cook, HOLMQUIST_JOHNSON_COOK, "holmquist-johnson-cook",                              \
      "concrete: pores that close under pressure, strength by pressure, damage and rate", RG_HJC_HISTORY,    \
      RG_TAKES_YOUNG | RG_HAS_DAMAGE | RG_HAS_PLASTIC | RG_HAS_VOLUME)                                       \
    X(drucker_prager, DRUCKER_PRAGER, "drucker-prager",                                                      \
      "rock, soil or concrete: strength by pressure, with a cap and a tension cut-off", RG_DP_HISTORY,       \
      RG_TAKES_YOUNG | RG_HAS_PLASTIC | RG_HAS_VOLUME)                                                       \
    X(viscoelastic, VISCOELASTIC, "viscoelastic",                                                            \
      "a polymer that relaxes: neo-Hookean in the long run, beside three Maxwell elements", RG_VE_HISTORY,   \
      RG_TAKES_YOUNG)

#define RG_MATERIALS(X) RG_MATERIALS_ANY(X) RG_MATERIALS_DOUBLE(X)
#ifdef RG_SINGLE
#define RG_MATERIALS_HERE(X) RG_MATERIALS_ANY(X)
#else
#define RG_MATERIALS_HERE(X) RG_MATERIALS(X)
#endif

#define RG_MATERIAL_ENUM(name, NAME, word, meaning, history, inside) RG_MATERIAL_##NAME,
typedef enum {
    RG_MATERIALS(RG_MATERIAL_ENUM) RG_MATERIAL_MODELS, /* of this program */
    RG_MATERIAL_USER = RG_MATERIAL_MODELS,             /* that of a library of the user's (library.h) */
} rg_material_model;

#define RG_MATERIAL_BIT(name, NAME, word, meaning, history, inside)                                          \
    RG_MATERIAL_BIT_##NAME = 1 << RG_MATERIAL_##NAME,
enum { RG_MATERIALS(RG_MATERIAL_BIT) RG_MATERIAL_BIT_USER = 1 << RG_MATERIAL_USER };

/* Models that heat may expand: not those whose constants lie elsewhere (rg_material). */
enum {
    RG_EXPANDING = ((1 << RG_MATERIAL_MODELS) - 1) &
                   ~((int)RG_MATERIAL_BIT_ANISOTROPIC | (int)RG_MATERIAL_BIT_DESHPANDE_EVANS)
};

/* What a parameter may be. */
typedef enum {
    RG_NEEDED,   /* given, > 0 */
    RG_FROM_0,   /* >= 0; 0 where it is not given */
    RG_ANY_SIGN, /* any number; 0 where it is not given */
} rg_parameter_range;

/* Parameters besides density, elastic constants and those of the ceramic alone: name of the enum, key in the
 * block of a material, unit, range, models that use it, meaning. */
#define RG_MATERIAL_PARAMETERS(X)                                                                            \
    X(EXPANSION, "expansion", "1/K", RG_FROM_0, RG_EXPANDING,                                                \
      "by which lengths grow per kelvin above temperature.free; goes with temperature.value")                \
    X(YIELD_STRESS, "yield_stress", "Pa", RG_NEEDED,                                                         \
      RG_MATERIAL_BIT_J2 | RG_MATERIAL_BIT_DESHPANDE_EVANS | RG_MATERIAL_BIT_JOHNSON_COOK,                   \
      "yield stress before any plastic strain")                                                              \
    X(HARDENING, "hardening", "Pa", RG_FROM_0, RG_MATERIAL_BIT_J2,                                           \
      "slope of the yield stress over plastic strain")                                                       \
    X(SATURATION_STRESS, "saturation_stress", "Pa", RG_FROM_0, RG_MATERIAL_BIT_J2,                           \
      "yield stress to which hardening of Voce's kind goes up, not below yield_stress; goes with "           \
      "saturation_rate")                                                                                     \
    X(SATURATION_RATE, "saturation_rate", NULL, RG_FROM_0, RG_MATERIAL_BIT_J2,                               \
      "how fast it goes there: as 1 - exp(-saturation_rate times plastic strain)")                           \
    X(BULK, "bulk", "Pa", RG_NEEDED, RG_MATERIAL_BIT_MOONEY_RIVLIN | RG_MATERIAL_BIT_OGDEN,                  \
      "bulk modulus K")                                                                                      \
    X(MU_1, "mu_1", "Pa", RG_ANY_SIGN, RG_MATERIAL_BIT_OGDEN,                                                \
      "of the energy mu_1/alpha_1 (l1^alpha_1 + l2^alpha_1 + l3^alpha_1 - 3), l the stretches without what " \
      "the volume does; as each term of the sign of alpha_1. The shear modulus at rest is half of the sum "  \
      "of mu alpha")                                                                                         \
    X(MU_2, "mu_2", "Pa", RG_ANY_SIGN, RG_MATERIAL_BIT_OGDEN, "of a second term")                            \
    X(MU_3, "mu_3", "Pa", RG_ANY_SIGN, RG_MATERIAL_BIT_OGDEN, "of a third term")                             \
    X(ALPHA_1, "alpha_1", NULL, RG_ANY_SIGN, RG_MATERIAL_BIT_OGDEN, "power of the first term")               \
    X(ALPHA_2, "alpha_2", NULL, RG_ANY_SIGN, RG_MATERIAL_BIT_OGDEN, "power of the second term")              \
    X(ALPHA_3, "alpha_3", NULL, RG_ANY_SIGN, RG_MATERIAL_BIT_OGDEN, "power of the third term")               \
    X(C10, "c10", "Pa", RG_NEEDED, RG_MATERIAL_BIT_MOONEY_RIVLIN,                                            \
      "coefficient of the first invariant; the shear modulus at rest is 2 (c10 + c01)")                      \
    X(C01, "c01", "Pa", RG_FROM_0, RG_MATERIAL_BIT_MOONEY_RIVLIN, "coefficient of the second invariant")     \
    X(HARDENING_MODULUS, "hardening_modulus", "Pa", RG_FROM_0, RG_MATERIAL_BIT_JOHNSON_COOK,                 \
      "B: what hardening adds to the yield stress at a plastic strain of 1")                                 \
    X(HARDENING_POWER, "hardening_power", NULL, RG_NEEDED, RG_MATERIAL_BIT_JOHNSON_COOK,                     \
      "n: hardening goes with the plastic strain to this power")                                             \
    X(RATE_SENSITIVITY, "rate_sensitivity", NULL, RG_FROM_0,                                                 \
      RG_MATERIAL_BIT_JOHNSON_COOK | RG_MATERIAL_BIT_JOHNSON_HOLMQUIST |                                     \
          RG_MATERIAL_BIT_HOLMQUIST_JOHNSON_COOK,                                                            \
      "C: by so much strength grows per e-fold of the strain rate beyond reference_rate")                    \
    X(REFERENCE_RATE, "reference_rate", "1/s", RG_NEEDED,                                                    \
      RG_MATERIAL_BIT_JOHNSON_COOK | RG_MATERIAL_BIT_JOHNSON_HOLMQUIST |                                     \
          RG_MATERIAL_BIT_HOLMQUIST_JOHNSON_COOK,                                                            \
      "strain rate up to which strength is the quasi-static one, as a rule 1")                               \
    X(SOFTENING_POWER, "softening_power", NULL, RG_FROM_0, RG_MATERIAL_BIT_JOHNSON_COOK,                     \
      "m of the loss of strength on the way to the melting temperature; 0: heat softens nothing")            \
    X(MELTING_TEMPERATURE, "melting_temperature", "K", RG_FROM_0, RG_MATERIAL_BIT_JOHNSON_COOK,              \
      "where no strength is left; goes with softening_power, and is above room_temperature")                 \
    X(ROOM_TEMPERATURE, "room_temperature", "K", RG_FROM_0, RG_MATERIAL_BIT_JOHNSON_COOK,                    \
      "at which the yield stress holds, and the solid is to begin with")                                     \
    X(HEAT_CAPACITY, "heat_capacity", "J/(kg K)", RG_FROM_0, RG_MATERIAL_BIT_JOHNSON_COOK,                   \
      "per mass; goes with heat_fraction")                                                                   \
    X(HEAT_FRACTION, "heat_fraction", NULL, RG_FROM_0, RG_MATERIAL_BIT_JOHNSON_COOK,                         \
      "of the work of flow that heats the point (Taylor & Quinney), at most 1, as a rule 0.9; goes with "    \
      "heat_capacity")                                                                                       \
    X(HUGONIOT_LIMIT, "hugoniot_limit", "Pa", RG_NEEDED, RG_MATERIAL_BIT_JOHNSON_HOLMQUIST,                  \
      "HEL: axial stress of uniaxial strain where the solid begins to flow; strengths are in units of "      \
      "3/2 (HEL - P_HEL)")                                                                                   \
    X(HUGONIOT_PRESSURE, "hugoniot_pressure", "Pa", RG_NEEDED, RG_MATERIAL_BIT_JOHNSON_HOLMQUIST,            \
      "P_HEL: the pressure there, below hugoniot_limit; the unit of pressure in strengths and strains")      \
    X(INTACT_STRENGTH, "intact_strength", NULL, RG_NEEDED, RG_MATERIAL_BIT_JOHNSON_HOLMQUIST,                \
      "A of the intact solid's strength, A (P* + T*)^N")                                                     \
    X(INTACT_POWER, "intact_power", NULL, RG_NEEDED, RG_MATERIAL_BIT_JOHNSON_HOLMQUIST, "N of it")           \
    X(CRUSHED_STRENGTH, "crushed_strength", NULL, RG_FROM_0,                                                 \
      RG_MATERIAL_BIT_JOHNSON_HOLMQUIST | RG_MATERIAL_BIT_HOLMQUIST_JOHNSON_COOK,                            \
      "B of the crushed solid's strength, B P*^M; of concrete B P*^N in units of its compressive_strength")  \
    X(CRUSHED_POWER, "crushed_power", NULL, RG_FROM_0,                                                       \
      RG_MATERIAL_BIT_JOHNSON_HOLMQUIST | RG_MATERIAL_BIT_HOLMQUIST_JOHNSON_COOK, "M of it, N of concrete")  \
    X(CRUSHED_LIMIT, "crushed_limit", NULL, RG_FROM_0, RG_MATERIAL_BIT_JOHNSON_HOLMQUIST,                    \
      "most that B P*^M comes to; 0: no limit")                                                              \
    X(TENSILE_LIMIT, "tensile_limit", "Pa", RG_NEEDED,                                                       \
      RG_MATERIAL_BIT_JOHNSON_HOLMQUIST | RG_MATERIAL_BIT_HOLMQUIST_JOHNSON_COOK,                            \
      "T: hydrostatic tension that the intact solid bears")                                                  \
    X(FAILURE_STRAIN, "failure_strain", NULL, RG_FROM_0,                                                     \
      RG_MATERIAL_BIT_JOHNSON_HOLMQUIST | RG_MATERIAL_BIT_HOLMQUIST_JOHNSON_COOK,                            \
      "D1 of the plastic strain to fracture, D1 (P* + T*)^D2; 0: at once")                                   \
    X(FAILURE_POWER, "failure_power", NULL, RG_FROM_0,                                                       \
      RG_MATERIAL_BIT_JOHNSON_HOLMQUIST | RG_MATERIAL_BIT_HOLMQUIST_JOHNSON_COOK, "D2 of it")                \
    X(BULK_2, "bulk_2", "Pa", RG_ANY_SIGN,                                                                   \
      RG_MATERIAL_BIT_JOHNSON_HOLMQUIST | RG_MATERIAL_BIT_HOLMQUIST_JOHNSON_COOK,                            \
      "K2 of the pressure, K1 mu + K2 mu^2 + K3 mu^3 with mu the change of density over that to begin "      \
      "with; K1 follows from young and poisson; of concrete without pores, with bulk_1")                     \
    X(BULK_3, "bulk_3", "Pa", RG_ANY_SIGN,                                                                   \
      RG_MATERIAL_BIT_JOHNSON_HOLMQUIST | RG_MATERIAL_BIT_HOLMQUIST_JOHNSON_COOK, "K3 of it")                \
    X(BULKING, "bulking", NULL, RG_FROM_0, RG_MATERIAL_BIT_JOHNSON_HOLMQUIST,                                \
      "beta: share of the elastic energy lost by damage that raises the pressure, at most 1")                \
    X(COMPRESSIVE_STRENGTH, "compressive_strength", "Pa", RG_NEEDED, RG_MATERIAL_BIT_HOLMQUIST_JOHNSON_COOK, \
      "f_c: quasi-static strength without pressure across; the unit of pressures and strengths")             \
    X(COHESIVE_STRENGTH, "cohesive_strength", NULL, RG_NEEDED, RG_MATERIAL_BIT_HOLMQUIST_JOHNSON_COOK,       \
      "A of the strength A (1 - D) + B P*^N; under tension it falls to 0 at -tensile_limit (1 - D)")         \
    X(LARGEST_STRENGTH, "largest_strength", NULL, RG_FROM_0, RG_MATERIAL_BIT_HOLMQUIST_JOHNSON_COOK,         \
      "S_max: most that the strength comes to; 0: no limit")                                                 \
    X(LEAST_FAILURE_STRAIN, "least_failure_strain", NULL, RG_FROM_0, RG_MATERIAL_BIT_HOLMQUIST_JOHNSON_COOK, \
      "least plastic strain to fracture")                                                                    \
    X(CRUSH_PRESSURE, "crush_pressure", "Pa", RG_NEEDED, RG_MATERIAL_BIT_HOLMQUIST_JOHNSON_COOK,             \
      "P_crush: at which pores begin to close, up to which the solid is elastic")                            \
    X(LOCK_PRESSURE, "lock_pressure", "Pa", RG_NEEDED, RG_MATERIAL_BIT_HOLMQUIST_JOHNSON_COOK,               \
      "P_lock: at which all have closed")                                                                    \
    X(LOCK_STRAIN, "lock_strain", NULL, RG_NEEDED, RG_MATERIAL_BIT_HOLMQUIST_JOHNSON_COOK,                   \
      "mu_lock: change of density over that to begin with of the solid without pores, at no pressure")       \
    X(BULK_1, "bulk_1", "Pa", RG_NEEDED, RG_MATERIAL_BIT_HOLMQUIST_JOHNSON_COOK,                             \
      "K1 of its pressure, K1 x + K2 x^2 + K3 x^3 with x = (mu - mu_lock)/(1 + mu_lock); not below the "     \
      "bulk modulus of young and poisson")                                                                   \
    X(COHESION, "cohesion", "Pa", RG_NEEDED, RG_MATERIAL_BIT_DRUCKER_PRAGER,                                 \
      "c: with friction_angle, of the Mohr-Coulomb solid that is as strong under compression")               \
    X(FRICTION_ANGLE, "friction_angle", "degrees", RG_FROM_0, RG_MATERIAL_BIT_DRUCKER_PRAGER,                \
      "phi, below 90: how strength grows with pressure")                                                     \
    X(DILATION_ANGLE, "dilation_angle", "degrees", RG_FROM_0, RG_MATERIAL_BIT_DRUCKER_PRAGER,                \
      "psi, at most friction_angle: how volume grows with flow")                                             \
    X(TENSION_CUTOFF, "tension_cutoff", "Pa", RG_FROM_0, RG_MATERIAL_BIT_DRUCKER_PRAGER,                     \
      "T: largest mean stress; 0, and beyond the apex of the cone: that of the apex")                        \
    X(CAP_PRESSURE, "cap_pressure", "Pa", RG_FROM_0, RG_MATERIAL_BIT_DRUCKER_PRAGER,                         \
      "pressure from all sides at which pores begin to collapse; 0: no cap")                                 \
    X(CAP_RATIO, "cap_ratio", NULL, RG_FROM_0, RG_MATERIAL_BIT_DRUCKER_PRAGER,                               \
      "R: half axis of the cap along the pressure over that along von Mises' stress; goes with "             \
      "cap_pressure")                                                                                        \
    X(COMPACTION, "compaction", NULL, RG_FROM_0, RG_MATERIAL_BIT_DRUCKER_PRAGER,                             \
      "volume (as -log J) that pores lose in the end, below 1; goes with cap_pressure")                      \
    X(COMPACTION_PRESSURE, "compaction_pressure", "Pa", RG_FROM_0, RG_MATERIAL_BIT_DRUCKER_PRAGER,           \
      "by which pressure has to rise beyond cap_pressure till 1/e of that is left; goes with cap_pressure")  \
    X(SHEAR_FRACTION_1, "shear_fraction_1", NULL, RG_FROM_0, RG_MATERIAL_BIT_VISCOELASTIC,                   \
      "share of the shear modulus that relaxes in relaxation_time_1; young and poisson are those before")    \
    X(SHEAR_FRACTION_2, "shear_fraction_2", NULL, RG_FROM_0, RG_MATERIAL_BIT_VISCOELASTIC,                   \
      "share of the shear modulus that relaxes in relaxation_time_2; young and poisson are those before")    \
    X(SHEAR_FRACTION_3, "shear_fraction_3", NULL, RG_FROM_0, RG_MATERIAL_BIT_VISCOELASTIC,                   \
      "share of the shear modulus that relaxes in relaxation_time_3; young and poisson are those before")    \
    X(BULK_FRACTION_1, "bulk_fraction_1", NULL, RG_FROM_0, RG_MATERIAL_BIT_VISCOELASTIC,                     \
      "likewise of the bulk modulus")                                                                        \
    X(BULK_FRACTION_2, "bulk_fraction_2", NULL, RG_FROM_0, RG_MATERIAL_BIT_VISCOELASTIC,                     \
      "likewise of the bulk modulus")                                                                        \
    X(BULK_FRACTION_3, "bulk_fraction_3", NULL, RG_FROM_0, RG_MATERIAL_BIT_VISCOELASTIC,                     \
      "likewise of the bulk modulus")                                                                        \
    X(RELAXATION_TIME_1, "relaxation_time_1", "s", RG_FROM_0, RG_MATERIAL_BIT_VISCOELASTIC,                  \
      "time in which the stress of its Maxwell element falls to 1/e")                                        \
    X(RELAXATION_TIME_2, "relaxation_time_2", "s", RG_FROM_0, RG_MATERIAL_BIT_VISCOELASTIC,                  \
      "time in which the stress of its Maxwell element falls to 1/e")                                        \
    X(RELAXATION_TIME_3, "relaxation_time_3", "s", RG_FROM_0, RG_MATERIAL_BIT_VISCOELASTIC,                  \
      "time in which the stress of its Maxwell element falls to 1/e")

#define RG_PARAMETER_ENUM(NAME, key, unit, range, models, meaning) RG_PARAMETER_##NAME,
enum { RG_MATERIAL_PARAMETERS(RG_PARAMETER_ENUM) RG_PARAMETERS };

/* An anisotropic solid, in the axes of the mesh. Of the acoustic tensor of each direction the largest
 * eigenvalue: the most and the least of all directions (Pa). */
typedef struct {
    double stiffness[RG_STIFFNESS];
    double stiffest, softest;
} rg_anisotropic;

/* The cone of material/drucker_prager.h: q = strength + slope p, volume grows by `dilation` times the
 * equivalent plastic strain; `excess`: by so much the symmetric part of its tangent may exceed the elastic
 * one, since flow is not along the normal. */
typedef struct {
    double strength, slope, dilation, excess;
} rg_dp_cone;

/* The pores of material/holmquist_johnson_cook.h: mu_c, mu_m - mu_c, K_t (Pa). */
typedef struct {
    double crush, range, rise;
} rg_hjc_pores;

enum { RG_USER_PARAMETERS = 32 }; /* at most, of a material of the user's */

/* Such a material: its library, and its parameters in the order in which that declares them. */
typedef struct {
    const struct rg_user_material *library;
    double parameter[RG_USER_PARAMETERS];
} rg_user_values;

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
        rg_user_values user;
        double parameter[RG_PARAMETERS]; /* of all others */
        struct {
            double given[RG_PARAMETERS]; /* the same */
            rg_dp_cone cone;             /* of these, by rg_material_prepare */
        } drucker_prager;
        struct {
            double given[RG_PARAMETERS]; /* the same */
            rg_hjc_pores pores;          /* of these, by rg_material_prepare */
        } holmquist_johnson_cook;
    } of;
} rg_material;

/* The model's name in a case file. */
const char *rg_material_word(rg_material_model model);

/* Values of history per point, and what is inside, of a model of this program. */
int rg_material_history(rg_material_model model);
unsigned rg_material_inside(rg_material_model model);

/* Values of history per point of any material. */
int rg_material_values(const rg_material *m);

/* What is inside any material. */
unsigned rg_material_has(const rg_material *m);

/* Whether this build has the model's kernels. */
int rg_material_exists(rg_material_model model);

/* Readies a material, parameters set, for steps of `dt` (s), which is > 0: of a model that knows rates. */
void rg_material_prepare(rg_material *m, double dt);

/* Von Mises stress that Drucker and Prager's solid bears without pressure (Pa), of its parameters. */
double rg_dp_strength(const double parameter[]);

/* Pores of the Holmquist-Johnson-Cook concrete of these parameters and the elastic bulk modulus (Pa); `range`
 * is not a number where the dense solid does not come to its lock_pressure before it is pressed to half. */
rg_hjc_pores rg_hjc_pores_of(const double parameter[], double bulk);

#endif
