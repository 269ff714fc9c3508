/* Keys in the block of a material, included in each table of keys that has some (case/key.c), which defines
 *
 *     KEY(word)   the key's name in the table, from its name in the block
 *     INPUT       offset of the rg_material_input in the structure that the table fills
 */
/* clang-format off */
#define AT(member)    .of_material = true, .input = INPUT, .offset = INPUT + offsetof(rg_material_input, member)
#define FLAWS(member) CERAMIC, AT(deshpande_evans.member)
#define PARAMETER(NAME, key, unit_, range, models_, words)                                                    \
    {.name = KEY(key), .unit = (unit_), REAL, .low = (range) == RG_ANY_SIGN ? -INFINITY : 0,                  \
     .low_open = (range) == RG_NEEDED, .high = INFINITY,                                                      \
     .need = (range) == RG_NEEDED ? RG_NEED_REQUIRED : RG_NEED_OPTIONAL, .models = (models_),                 \
     AT(parameter[RG_PARAMETER_##NAME]), MEANS(words)},

{.name = KEY("preset"), .type = RG_KEY_TEXT, ELSE("none"), AT(preset),
 MEANS("a solid by name, as alumina-ad995, whose values hold where none are given; `rhegma materials` lists them")},
{.name = KEY("model"), EXPLAINED(models), REQUIRED, AT(model), MEANS("of the bulk")},
{.name = KEY("young"), .unit = "Pa", REAL, ABOVE(0), REQUIRED, ELASTIC, OF_AXES(young_of_axes), AT(young),
 MEANS("Young's modulus; of anisotropic those along its axes 1, 2, 3, unless stiffness is given")},
{.name = KEY("shear"), .unit = "Pa", REAL, ABOVE(0), REQUIRED,
 .models = RG_MATERIAL_BIT_DESHPANDE_EVANS | RG_MATERIAL_BIT_ANISOTROPIC, OF_AXES(shear_of_axes), AT(deshpande_evans.shear),
 MEANS("shear modulus of the intact solid; of anisotropic those of its planes, beside young")},
{.name = KEY("poisson"), REAL, FROM_TO(0, 0.5), .high_open = true, REQUIRED, OF_POISSON, OF_AXES(poisson_of_axes),
 AT(poisson), MEANS("Poisson's ratio; of anisotropic nu_ij, what the solid contracts along axis j where it is pulled along i, beside young ([0, 0, 0])")},
{.name = KEY("density"), .unit = "kg/m3", REAL, ABOVE(0), REQUIRED, AT(density), MEANS("reference density")},
{.name = KEY("flaw_radius"), .unit = "m", REAL, ABOVE(0), REQUIRED, FLAWS(flaw_radius),
 MEANS("a of the flaws from which cracks grow")},
{.name = KEY("flaw_density"), .unit = "1/m3", REAL, ABOVE(0), REQUIRED, FLAWS(flaw_density),
 MEANS("f; the damage to begin with, 4/3 pi (alpha a)^3 f, must be below damage_max")},
{.name = KEY("alpha"), REAL, FROM_TO(0, 1), .low_open = true, DEFAULT(0.70710678118654752), FLAWS(alpha),
 MEANS("cosine of the flaws' inclination")},
{.name = KEY("beta"), REAL, ABOVE(0), DEFAULT(0.1), FLAWS(beta), MEANS("geometry of the wing cracks")},
{.name = KEY("gamma"), REAL, ABOVE(0), DEFAULT(2), FLAWS(gamma), MEANS("geometry of the wing cracks too")},
{.name = KEY("friction"), REAL, FROM(0), DEFAULT(0.75), FLAWS(friction), MEANS("coefficient of the closed flaws")},
{.name = KEY("toughness"), .unit = "Pa sqrt(m)", REAL, ABOVE(0), REQUIRED, FLAWS(toughness), MEANS("K_IC of the grains")},
{.name = KEY("growth_speed"), .unit = "m/s", REAL, ABOVE(0), DEFAULT(100e-6), FLAWS(growth_speed),
 MEANS("of a crack at K_I = K_IC")},
{.name = KEY("growth_exponent"), REAL, ABOVE(0), DEFAULT(10), FLAWS(growth_exponent),
 MEANS("the speed goes with (K_I/K_IC) to this power, up to that of shear waves")},
{.name = KEY("interaction"), EXPLAINED(interactions), DEFAULT(RG_INTERACTION_THESIS), CERAMIC, AT(interaction),
 MEANS("c3 of the cracks' interaction")},
{.name = KEY("damage_max"), REAL, FROM_TO(0, 1), .low_open = true, .high_open = true, DEFAULT(0.999),
 FLAWS(damage_max), MEANS("damage stops here")},
RG_MATERIAL_PARAMETERS(PARAMETER)
{.name = KEY("yield_strain"), REAL, ABOVE(0), DEFAULT(0.002), FLAWS(yield_strain), MEANS("plastic strain at which hardening counts")},
{.name = KEY("hardening_exponent"), REAL, FROM_TO(0, 1), DEFAULT(0.1), FLAWS(hardening_exponent),
 MEANS("the yield stress goes with the plastic strain to this power")},
{.name = KEY("plastic_rate"), .unit = "1/s", REAL, ABOVE(0), DEFAULT(0.002), FLAWS(plastic_rate),
 MEANS("rate at which the yield stress holds")},
{.name = KEY("transition_rate"), .unit = "1/s", REAL, ABOVE(0), DEFAULT(1e6), FLAWS(transition_rate),
 MEANS("rate from which flow is viscous")},
{.name = KEY("rate_exponent"), REAL, FROM(1), DEFAULT(10), FLAWS(rate_exponent),
 MEANS("below that the rate of flow goes with the stress to this power")},
{.name = KEY("stiffness"), .unit = "Pa", .type = RG_KEY_REAL, .count = RG_STIFFNESS, ANY, ELSE("young, poisson, shear"), ALONG_AXES,
 .entries = "C11, C12, ..., C66", AT(anisotropic.stiffness),
 MEANS("21 constants in the solid's axes: the upper triangle row by row, in Voigt's order 11 22 33 23 13 12, with shear strains 2 e_23, 2 e_13, 2 e_12")},
{.name = KEY("orientation.axis_1"), REAL3, ANY, ELSE("the axes of the mesh"), ALONG_AXES, AT(anisotropic.axis[0]),
 MEANS("direction of the solid's axis 1, of any length")},
{.name = KEY("orientation.axis_2"), REAL3, ANY, ELSE("with axis_1"), ALONG_AXES, AT(anisotropic.axis[1]),
 MEANS("a direction in the half plane of its axes 1 and 2, on the side of 2")},
{.name = KEY("orientation.angle_1"), .unit = "degrees", .type = RG_KEY_EXPR, ELSE("0"), .no_time = true, ALONG_AXES, AT(anisotropic.angle[0]),
 MEANS("in place of axes, phi1 of angles where it differs from element to element, at its centroid")},
{.name = KEY("orientation.angle_2"), .unit = "degrees", .type = RG_KEY_EXPR, ELSE("0"), .no_time = true, ALONG_AXES, AT(anisotropic.angle[1]),
 MEANS("likewise Phi")},
{.name = KEY("orientation.angle_3"), .unit = "degrees", .type = RG_KEY_EXPR, ELSE("0"), .no_time = true, ALONG_AXES, AT(anisotropic.angle[2]),
 MEANS("likewise phi2")},
{.name = KEY("orientation.field"), .type = RG_KEY_TEXT, ELSE("none"), ALONG_AXES, AT(anisotropic.field),
 MEANS("in place of axes, a dataset of the mesh file with phi1, Phi, phi2 of angles for each element")},
{.name = KEY("orientation.angles"), REAL3, .entries = "phi1, Phi, phi2", ANY, ELSE("[0, 0, 0]"), ALONG_AXES,
 AT(anisotropic.angles),
 MEANS("in place of axes: Euler angles after Bunge in degrees, by which x, y, z turn into its axes: phi1 about z, Phi about the new x, phi2 about the new z")},
{.name = KEY("library"), .type = RG_KEY_LIBRARY, REQUIRED, .models = RG_MATERIAL_BIT_USER, AT(user.library),
 MEANS("path of what rhegma material compiled, relative to the case file; its parameters stand beside it, or under parameters")},
{.name = KEY("parameters"), .type = RG_KEY_PARAMETERS, ELSE("those beside library"), .models = RG_MATERIAL_BIT_USER, AT(user.is),
 MEANS("those that the library declares, by name")},

#undef AT
#undef FLAWS
#undef PARAMETER
#undef KEY
#undef INPUT
    /* clang-format on */
