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
{.name = KEY("young"), .unit = "Pa", REAL, ABOVE(0), REQUIRED, ELASTIC, AT(young), MEANS("Young's modulus")},
{.name = KEY("shear"), .unit = "Pa", REAL, ABOVE(0), REQUIRED, FLAWS(shear), MEANS("shear modulus of the intact solid")},
{.name = KEY("poisson"), REAL, FROM_TO(0, 0.5), .high_open = true, REQUIRED, AT(poisson), MEANS("Poisson's ratio")},
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

#undef AT
#undef FLAWS
#undef PARAMETER
#undef KEY
#undef INPUT
    /* clang-format on */
