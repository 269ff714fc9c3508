/* Keys in the block of a material, included in each table of keys that has some (case/key.c), which defines
 *
 *     KEY(word)   the key's name in the table, from its name in the block
 *     INPUT       offset of the rg_material_input in the structure that the table fills
 */
/* clang-format off */
#define AT(member)    .of_material = true, .input = INPUT, .offset = INPUT + offsetof(rg_material_input, member)
#define FLAWS(member) CERAMIC, AT(deshpande_evans.member)
#define PARAMETER(NAME, key, unit_, needed, models_)                                                          \
    {.name = KEY(key), .unit = (unit_), REAL, .low = 0, .low_open = (needed), .high = INFINITY,                  \
     .need = (needed) ? RG_NEED_REQUIRED : RG_NEED_OPTIONAL, .models = (models_),                             \
     AT(parameter[RG_PARAMETER_##NAME])},

{.name = KEY("model"), CHOICE(models), REQUIRED, AT(model)},
{.name = KEY("young"), .unit = "Pa", REAL, ABOVE(0), REQUIRED, ELASTIC, AT(young)},
{.name = KEY("shear"), .unit = "Pa", REAL, ABOVE(0), REQUIRED, FLAWS(shear)},
{.name = KEY("poisson"), REAL, FROM_TO(0, 0.5), .high_open = true, REQUIRED, AT(poisson)},
{.name = KEY("density"), .unit = "kg/m3", REAL, ABOVE(0), REQUIRED, AT(density)},
{.name = KEY("flaw_radius"), .unit = "m", REAL, ABOVE(0), REQUIRED, FLAWS(flaw_radius)},
{.name = KEY("flaw_density"), .unit = "1/m3", REAL, ABOVE(0), REQUIRED, FLAWS(flaw_density)},
{.name = KEY("alpha"), REAL, FROM_TO(0, 1), .low_open = true, DEFAULT(0.70710678118654752), FLAWS(alpha)},
{.name = KEY("beta"), REAL, ABOVE(0), DEFAULT(0.1), FLAWS(beta)},
{.name = KEY("gamma"), REAL, ABOVE(0), DEFAULT(2), FLAWS(gamma)},
{.name = KEY("friction"), REAL, FROM(0), DEFAULT(0.75), FLAWS(friction)},
{.name = KEY("toughness"), .unit = "Pa sqrt(m)", REAL, ABOVE(0), REQUIRED, FLAWS(toughness)},
{.name = KEY("growth_speed"), .unit = "m/s", REAL, ABOVE(0), DEFAULT(100e-6), FLAWS(growth_speed)},
{.name = KEY("growth_exponent"), REAL, ABOVE(0), DEFAULT(10), FLAWS(growth_exponent)},
{.name = KEY("interaction"), CHOICE(interactions), DEFAULT(RG_INTERACTION_THESIS), CERAMIC,
 AT(interaction)},
{.name = KEY("damage_max"), REAL, FROM_TO(0, 1), .low_open = true, .high_open = true, DEFAULT(0.999),
 FLAWS(damage_max)},
RG_MATERIAL_PARAMETERS(PARAMETER)
{.name = KEY("yield_strain"), REAL, ABOVE(0), DEFAULT(0.002), FLAWS(yield_strain)},
{.name = KEY("hardening_exponent"), REAL, FROM_TO(0, 1), DEFAULT(0.1), FLAWS(hardening_exponent)},
{.name = KEY("plastic_rate"), .unit = "1/s", REAL, ABOVE(0), DEFAULT(0.002), FLAWS(plastic_rate)},
{.name = KEY("transition_rate"), .unit = "1/s", REAL, ABOVE(0), DEFAULT(1e6), FLAWS(transition_rate)},
{.name = KEY("rate_exponent"), REAL, FROM(1), DEFAULT(10), FLAWS(rate_exponent)},


#undef AT
#undef FLAWS
#undef PARAMETER
#undef KEY
#undef INPUT
    /* clang-format on */
