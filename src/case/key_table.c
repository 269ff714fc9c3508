/* The registry: every key of a case file, a row each. */
#include "case/key.h"

#include <math.h>

#include "case/default.h"

#define CASE(member)    .offset = offsetof(rg_case, member)
#define CHOICE(list)    .type = RG_KEY_CHOICE, .choice = (list)
#define EXPLAINED(list) .type = RG_KEY_CHOICE, .choice = (list), .choice_meaning = list##_meaning
#define REAL            .type = RG_KEY_REAL, .count = 1
#define REAL3           .type = RG_KEY_REAL, .count = 3
#define INTEGER         .type = RG_KEY_INTEGER, .count = 1
#define INTEGER3        .type = RG_KEY_INTEGER, .count = 3
#define ANY             .low = -INFINITY, .high = INFINITY
#define FROM(a)         .low = (a), .high = INFINITY
#define ABOVE(a)        .low = (a), .low_open = true, .high = INFINITY
#define FROM_TO(a, b)   .low = (a), .high = (b)
#define REQUIRED        .need = RG_NEED_REQUIRED
#define OPTIONAL        .need = RG_NEED_OPTIONAL
#define ELSE(words)     OPTIONAL, .absent = (words)
#define DEFAULT(value)  .need = RG_NEED_DEFAULT, .fallback = (value)
#define DEFAULT_OF(key)                                                                                      \
    .need = RG_NEED_DEFAULT, .fallback_of = rg_default_##key, .absent = RG_DEFAULT_WORDS_##key
#define BOX          .group = RG_GROUP_BOX
#define GROUP(name)  .group = RG_GROUP_##name
#define ELASTIC      .models = RG_MATERIAL_BIT_ANISOTROPIC RG_MATERIALS(TAKES_YOUNG)
#define CERAMIC      .models = RG_MATERIAL_BIT_DESHPANDE_EVANS
#define OF_POISSON   .models = ((1U << RG_MATERIAL_MODELS) - 1) & ~(0U RG_MATERIALS(TAKES_BULK))
#define ALONG_AXES   .models = RG_MATERIAL_BIT_ANISOTROPIC
#define OF_AXES(key) .as_models = RG_MATERIAL_BIT_ANISOTROPIC, .as = &(key)
#define MAY_CHANGE   .may_change = true /* on a restart */
#define ONE_OF       .alternative = RG_EXACTLY_ONE
#define SOME_OF      .alternative = RG_AT_LEAST_ONE
#define MEANS(words) .meaning = (words)
/* Number or expression of a face; the member beside, with _at behind its name, holds the latter. */
#define FACE            .type = RG_KEY_FACE, .count = 1, .no_time = true, .normal = true
#define OF_CASE(member) CASE(member), .offset_expr = offsetof(rg_case, member##_at)
#define OF_SET(member)                                                                                       \
    .offset = offsetof(rg_face_set, member), .offset_expr = offsetof(rg_face_set, member##_at)

#define TAKES_BULK(name, NAME, word, meaning, history, inside)                                               \
    | ((inside)&RG_TAKES_BULK ? (unsigned)RG_MATERIAL_BIT_##NAME : 0U)
#define TAKES_YOUNG(name, NAME, word, meaning, history, inside)                                              \
    | ((inside)&RG_TAKES_YOUNG ? RG_MATERIAL_BIT_##NAME : 0)

/* Words in the order of the enums they set; behind some what each means. */
#define WORD(name, NAME, word, ...)             word,
#define MEANING(name, NAME, word, meaning, ...) meaning,
static const char *const models[] = {RG_MATERIALS(WORD) "user", NULL};
static const char *const models_meaning[] = {
    RG_MATERIALS(MEANING) "your own, of a library that rhegma material compiles"};
static const char *const laws[] = {
#define RG_LAW(NAME, name, word, ...) word,
#include "laws.h"
#undef RG_LAW
    "none", "user", NULL};
static const char *const laws_meaning[] = {
#define RG_LAW(NAME, name, word, meaning, ...) meaning,
#include "laws.h"
#undef RG_LAW
    "faces never break", "your own, of a library that rhegma material compiles"};
#define SENSOR_WORD(NAME, word, meaning)    word,
#define SENSOR_MEANING(NAME, word, meaning) meaning,
static const char *const sensor_values[] = {RG_SENSOR_VALUE(SENSOR_WORD) NULL};
static const char *const sensor_values_meaning[] = {RG_SENSOR_VALUE(SENSOR_MEANING)};
static const char *const sensor_measures[] = {RG_SENSOR_MEASURE(SENSOR_WORD) NULL};
static const char *const sensor_measures_meaning[] = {RG_SENSOR_MEASURE(SENSOR_MEANING)};
static const char *const front_values[] = {RG_FRONT_VALUE(SENSOR_WORD) NULL};
static const char *const front_values_meaning[] = {RG_FRONT_VALUE(SENSOR_MEANING)};
/* clang-format off */
static const char *const interactions[] = {"thesis", "derived", NULL};
static const char *const interactions_meaning[] = {
    "as the thesis prints it, with pi^2",
    "as one derives it, with pi"};
static const char *const forms[] = {"variational", "incomplete", "intrinsic", "continuous", NULL};
static const char *const forms_meaning[] = {
    "DG with the lifted jumps in the gradient: symmetric, conserves energy (Ten Eyck & Lew 2006)",
    "the thesis's (4.9) without the adjoint term: gains energy, without bound where beta_s is below about 20",
    "a cohesive law at every face from the start and no DG terms, which slows waves",
    "elements share their nodes, with interfaces on the faces that `faces` selects alone"};
static const char *const penalties[] = {"elastic", "isotropic", NULL};
static const char *const penalties_meaning[] = {
    "beta_s/h times the acoustic tensor of the face: lambda + 2 mu along its normal, mu across",
    "lambda + 2 mu in all directions, which conserves angular momentum exactly"};
static const char *const activations[] = {"continuous", "total", "conserving", NULL};
static const char *const activations_meaning[] = {
    "the opening counts from the jump at the moment of breaking, so the traction is continuous in time (legacy): loses or gains energy at each switch",
    "the whole jump enters at once (legacy, the thesis's): gains energy",
    "like continuous, and so that the energy of the switch adds up (form variational, contact penalty or potential; a law that starts rigid)"};
static const char *const shears[] = {"released", "fading", NULL};
static const char *const shears_meaning[] = {
    "it drops from one step to the next, whatever it is",
    "a spring of the penalty goes on with it and fades as the face opens: with activation conserving"};
static const char *const criteria[] = {"quadratic", "mohr-coulomb", NULL};
static const char *const criteria_meaning[] = {
    "where (tension/strength)^2 + (shear/(beta strength))^2 reaches 1; pressure does not matter",
    "the same in tension; under a pressure p where shear reaches beta strength + friction p: with activation conserving, beta and friction"};
static const char *const contacts[] = {"penalty", "flux", "potential", NULL};
static const char *const contacts_meaning[] = {
    "one-sided penalty on the normal opening (legacy)",
    "all DG terms return (legacy, the thesis's): unstable once closed faces slide",
    "the penalty as an exact potential, which fades as faces slide off each other"};
static const char *const contact_models[] = {"interfaces", "general", NULL};
static const char *const contact_models_meaning[] = {
    "both sides of a crack, as interface.contact says; fragments pass through each other",
    "those, and faces of the surface and of cracks that have separated, of one part or several: with interface.contact potential"};
static const char *const tiles[] = {"256", "512", "1024", NULL}; /* RG_TILE, doubled each time */
static const char *const precisions[] = {"double", "single", NULL};
static const char *const keeps[] = {"energy", "opening", NULL};
static const char *const keeps_meaning[] = {
    "the fracture energy: weak faces open further",
    "the critical opening: weak faces take less energy"};
static const char *const breakings[] = {"interface", "none", NULL};
static const char *const breakings_meaning[] = {
    "by interface.law",
    "they never do"};
static const char *const masses[] = {"consistent", "lumped", "scaled", NULL};
static const char *const masses_meaning[] = {
    "exact for the shape functions; its inverse is one constant matrix",
    "HRZ, on the diagonal: the only one of form continuous and its default",
    "consistent on all that is linear in an element, its quadratic modes twice as heavy: a longer step, and fronts that come late by a fraction of an element"};
static const char *const shapes[] = {"sphere", "plane", "cylinder", "none", NULL};
static const char *const shapes_meaning[] = {
    "of a radius", "all behind it is rigid", "of a radius, without ends", "it touches nothing: for what is tied to it"};
/* What the precision of the fields leaves to be found. */
#ifdef RG_SINGLE
#define RELAX_TOLERANCE FROM(1e-4), DEFAULT(1e-4)
#else
#define RELAX_TOLERANCE ABOVE(0), DEFAULT(1e-6)
#endif

static const char *const starts[] = {"initial", "static", "relax", NULL};
static const char *const starts_meaning[] = {
    "from the state of `initial`",
    "from the equilibrium under the loads of t = 0 and what `boundary` prescribes then (places; elsewhere along its lines it holds), with the velocities of `initial`; faces do not break on the way; what is tied to a free body comes to rest with it; not of form incomplete; of form intrinsic below the top of each law",
    "from the same, to which damping brings the body: it may also buckle on its way, or be free where its loads balance, with interface.penalty isotropic, which leaves it no moment; not with bodies that are free or tied"};
static const char *const motions[] = {"free", "prescribed", NULL};
static const char *const motions_meaning[] = {
    "by the forces on it: it has a mass; with an inertia or a density it turns", "by its velocity and angular velocity at all times"};
static const char *const components[] = {"x", "y", "z", NULL};
static const char *const box_sets[] = {"x-", "x+", "y-", "y+", "z-", "z+", NULL};
static const char *const fields[] = {
    "displacement", "velocity",       "stress",      "mean_stress", "principal_stress", "crack",    "damage",
    "regime",       "plastic_strain", "triaxiality", "rank",        "fragment",         "material",
    "plastic_volume", "bulking_pressure", "temperature", "contact", NULL};
static const char *const fields_meaning[] = {
    "of the nodes (m)",
    "of the nodes (m/s)",
    "Cauchy stress, mean of each element (Pa)",
    "a third of its trace (Pa)",
    "principal stresses, largest first (Pa)",
    "the crack surface: opening, slip, damage, time of failure",
    "share of the solid that is cracked or crushed, mean of each element",
    "of the ceramic's cracks, largest of the element: 1 closed, 2 sliding, 3 open",
    "equivalent plastic strain, mean of each element",
    "mean stress over von Mises stress",
    "that owns the element, and that speaks for a broken face",
    "number of the fragment",
    "number of the material: 0 that of `material`, then those of `materials`",
    "plastic part of the logarithm of the volume (pores that close: below 0), mean of each element",
    "pressure that crushing has added as it takes more room, mean of each element (Pa)",
    "of solids that heat themselves their own, of others what `temperature` prescribes, mean of each element (K)",
    "with contact.model general: pressure and traction on that face of each element which others press most (Pa), with friction or damping the heat of its contacts (J)"};
static const char *const fragments[] = {"each", "last", "none", NULL};
static const char *const fragments_meaning[] = {
    "for each output", "for the end of the run", "no file"};

#define INITIAL(name_, unit_, at_, words)                                                                    \
    {.name = (name_), .unit = (unit_), .type = RG_KEY_EXPR, ELSE("0"), .no_time = true, .offset = (at_), MEANS(words)},
/* Of `initial`, and of each of its sets. */
#define INITIAL_KEYS(path, at_, more)                                                                        \
    INITIAL(path "displacement.x", "m", (at_) + offsetof(rg_initial, displacement[0]), "displacement along x at the start") \
    INITIAL(path "displacement.y", "m", (at_) + offsetof(rg_initial, displacement[1]), "along y")            \
    INITIAL(path "displacement.z", "m", (at_) + offsetof(rg_initial, displacement[2]), "along z")            \
    INITIAL(path "velocity.x", "m/s", (at_) + offsetof(rg_initial, velocity[0]), "velocity along x at the start") \
    INITIAL(path "velocity.y", "m/s", (at_) + offsetof(rg_initial, velocity[1]), "along y")                  \
    INITIAL(path "velocity.z", "m/s", (at_) + offsetof(rg_initial, velocity[2]), "along z")                  \
    INITIAL(path "stress.xx", "Pa", (at_) + offsetof(rg_initial, stress[0]), "stress before anything is displaced, along the axes of reference: it turns and stretches with the element, and in solids that flow it counts against their limits; not of deshpande-evans and holmquist-johnson-cook") \
    INITIAL(path "stress.yy", "Pa", (at_) + offsetof(rg_initial, stress[1]), "stress") \
    INITIAL(path "stress.zz", "Pa", (at_) + offsetof(rg_initial, stress[2]), "stress") \
    INITIAL(path "stress.yz", "Pa", (at_) + offsetof(rg_initial, stress[3]), "stress") \
    INITIAL(path "stress.xz", "Pa", (at_) + offsetof(rg_initial, stress[4]), "stress") \
    INITIAL(path "stress.xy", "Pa", (at_) + offsetof(rg_initial, stress[5]), "stress") \
    more                                                                                                     \
    {.name = path "rotation.speed", .unit = "rad/s", REAL, ANY, ELSE("0"), .offset = (at_) + offsetof(rg_initial, spin),  \
     MEANS("angular velocity about an axis, of the displaced body, on top of that velocity")},               \
    {.name = path "rotation.axis", REAL3, ANY, ELSE("required with a speed"), .offset = (at_) + offsetof(rg_initial, axis), \
     MEANS("about which it turns, by the right hand: of any length")},                                       \
    {.name = path "rotation.at", .unit = "m", REAL3, ANY, ELSE("0, 0, 0"), .offset = (at_) + offsetof(rg_initial, at), MEANS("a point of the axis")},

/* Beside the expressions for stress, of `initial` alone. */
#define STRESS_OF_RUN                                                                                        \
    {.name = "initial.stress.run", .type = RG_KEY_TEXT, ELSE("those expressions"), CASE(stress_of.run),       \
     MEANS("path of the results of an earlier run on this mesh, relative to the case file: its field `stress` (Cauchy's, the mean of each element), in place of expressions; of elements that initial.sets do not have")}, \
    {.name = "initial.stress.frame", INTEGER, FROM(-1), DEFAULT(-1), GROUP(STRESS_RUN), CASE(stress_of.frame),  \
     MEANS("which of its moments, from 0 on, as rhegma export lists them; -1: the last")},

/* Of a material with axes. */
#define OF_MATERIAL(member) .offset = offsetof(rg_material_input, anisotropic.member)
static const rg_key young_of_axes = {REAL3, .entries = "E1, E2, E3", ABOVE(0), OPTIONAL, OF_MATERIAL(young)};
static const rg_key poisson_of_axes = {REAL3, .entries = "nu23, nu13, nu12", ANY, OPTIONAL, OF_MATERIAL(poisson)};
static const rg_key shear_of_axes = {REAL3, .entries = "G23, G13, G12", ABOVE(0), OPTIONAL, OF_MATERIAL(shear)};

static const rg_key case_keys[] = {
    {.name = "defaults", INTEGER, FROM_TO(0, RG_DEFAULTS), DEFAULT(1), MAY_CHANGE, CASE(defaults),
     MEANS("which defaults the case means: 1, those that conserve energy at nearly the critical step, of form "
           "variational; 0, those of version 0.9: interface.beta_s 4, activation continuous, onset 0.3, contact penalty, "
           "time.safety 0.5")},

    {.name = "tables", .type = RG_KEY_TABLES, ELSE("none"), CASE(tables),
     MEANS("functions of one variable that expressions may call: straight lines between the points, or smooth, a monotone cubic; constant beyond the ends")},

    {.name = "mesh.file", .type = RG_KEY_TEXT, ELSE("the box"), MAY_CHANGE, CASE(mesh.file),
     MEANS("mesh file that `rhegma mesh` made, in place of the box; relative to the case file")},
    {.name = "mesh.cells", INTEGER3, FROM_TO(1, 100000), REQUIRED, BOX, CASE(mesh.cells),
     MEANS("cubes of the box along x, y, z, each cut into 6 tetrahedra")},
    {.name = "mesh.size", .unit = "m", REAL3, ABOVE(0), REQUIRED, BOX, CASE(mesh.size),
     MEANS("edges of the box along x, y, z")},
    {.name = "mesh.origin", .unit = "m", REAL3, ANY, DEFAULT(0), BOX, CASE(mesh.origin),
     MEANS("corner of the box with the smallest x, y, z")},
    {.name = "mesh.jitter", REAL, FROM_TO(0, 0.3), DEFAULT(0), BOX, CASE(mesh.jitter),
     MEANS("moves interior vertices at random, by up to this fraction of the smallest cell edge")},
    {.name = "mesh.seed", INTEGER, FROM(0), DEFAULT(1), BOX, CASE(mesh.seed), MEANS("of the jitter")},
    {.name = "mesh.tile", CHOICE(tiles), DEFAULT(0), BOX, CASE(mesh.tile),
     MEANS("elements of a tile, what a rank owns and a thread sweeps at a time; with 1024 a step of a large mesh is "
           "faster, and fewer ranks can share it; small meshes have smaller ones; results differ in rounding")},
    {.name = "mesh.weight", .type = RG_KEY_EXPR, ELSE("1"), .no_time = true, MAY_CHANGE, CASE(mesh.weight),
     MEANS("cost of an element at its centroid over that of others, for the partition, > 0; results do not depend on it")},
    {.name = "mesh.rebalance", REAL, FROM(0), DEFAULT(0), MAY_CHANGE, CASE(mesh.rebalance),
     MEANS("ratio of the most to the mean work of ranks from which the mesh is repartitioned by what its parts "
           "cost, as 1.1, if the time left makes that pay; 0: never; below 1: every 100 steps")},

    {.name = "material.name", .type = RG_KEY_TEXT, ELSE("material"), CASE(material.name),
     MEANS("by which interface.sets calls it: letters, digits, _ and -")},
#define KEY(word) "material." word
#define INPUT     offsetof(rg_case, material)
#include "case/material_keys.h"
    {.name = "materials", .type = RG_KEY_LIST, ELSE("none"), CASE(other), .entry = &rg_material_table,
     .offset_count = offsetof(rg_case, others),
     MEANS("others, in part of the mesh; the last one that claims an element has it, and what none claims is of `material`")},

    {.name = "interface.form", EXPLAINED(forms), DEFAULT(RG_FORM_VARIATIONAL), CASE(interface.form),
     MEANS("how elements hang together")},
    {.name = "interface.faces", .type = RG_KEY_EXPR, ELSE("none"), .no_time = true, .normal = true, GROUP(FACES),
     CASE(interface.faces),
     MEANS("faces that carry an interface: those where it is not 0, by their middle and unit normal; without any the law must be none")},
    {.name = "interface.beta_s", REAL, ABOVE(0), DEFAULT_OF(beta_s), GROUP(INTERFACE), CASE(interface.beta_s),
     MEANS("interior penalty, in moduli over the height of an element")},
    {.name = "interface.penalty", EXPLAINED(penalties), DEFAULT(RG_PENALTY_ELASTIC), GROUP(DG),
     CASE(interface.penalty), MEANS("what beta_s multiplies")},
    {.name = "interface.law", EXPLAINED(laws), REQUIRED, CASE(interface.law), MEANS("cohesive law")},
    {.name = "interface.strength", .unit = "Pa", FACE, ABOVE(0), REQUIRED, GROUP(COHESIVE),
     OF_CASE(interface.strength), MEANS("tensile strength of a face, by its middle and unit normal, of either sign")},
    {.name = "interface.energy", .unit = "J/m2", FACE, ABOVE(0), REQUIRED, GROUP(ENERGY),
     OF_CASE(interface.energy), MEANS("fracture energy G_c, per area of new crack; of a toughness: K_Ic^2 (1 - nu^2)/E")},
    {.name = "interface.beta", REAL, FROM(0), DEFAULT(1), GROUP(SHEAR), CASE(interface.beta),
     MEANS("weight of shear against opening; 0: opening alone breaks")},
    {.name = "interface.activation", EXPLAINED(activations), DEFAULT_OF(activation), GROUP(SWITCH),
     CASE(interface.activation), MEANS("how the law takes over where the strength is reached")},
    {.name = "interface.onset", REAL, FROM_TO(0, 1), .low_open = true, DEFAULT_OF(onset), GROUP(ONSET),
     CASE(interface.onset),
     MEANS("opening from which the law starts, in jumps at which the penalty alone would carry the strength; "
           "a smaller one is stiffer")},
    {.name = "interface.contact", EXPLAINED(contacts), DEFAULT_OF(contact), GROUP(COHESIVE),
     CASE(interface.contact), MEANS("how closed cracks push")},
    {.name = "interface.friction", REAL, FROM(0), DEFAULT(0), GROUP(COHESIVE), CASE(interface.friction),
     MEANS("Coulomb's coefficient of closed cracks, with contact penalty or potential")},
    {.name = "interface.shear", EXPLAINED(shears), ELSE("released"), GROUP(SWITCH), CASE(interface.shear),
     MEANS("what becomes of the shear traction of faces with beta 0 where they break")},
    {.name = "interface.criterion", EXPLAINED(criteria), ELSE("quadratic"), GROUP(SWITCH),
     CASE(interface.criterion), MEANS("when a face breaks")},
#define RG_LAW_PARAMETER(NAME, index, word, unit_, low_, high_, fallback_, words)                            \
    {.name = word, .unit = unit_, REAL, FROM_TO(low_, high_), DEFAULT(fallback_), GROUP(LAW),                \
     .law = RG_LAW_##NAME, CASE(interface.shape[RG_LAW_##NAME][index]), MEANS(words)},
#include "laws.h"
#undef RG_LAW_PARAMETER
    {.name = "interface.library", .type = RG_KEY_LIBRARY, REQUIRED, GROUP(LAW), .law = RG_LAW_USER, CASE(interface.user.library),
     MEANS("path of what rhegma material --law compiled, relative to the case file")},
    {.name = "interface.parameters", .type = RG_KEY_PARAMETERS, ELSE("its defaults"), GROUP(LAW), .law = RG_LAW_USER, CASE(interface.user.is),
     MEANS("of it, by the names that it declares")},
    {.name = "interface.rise.rate", .unit = "Pa/s", REAL, ABOVE(0), ELSE("strengths do not rise"), GROUP(SWITCH),
     CASE(interface.rise.rate),
     MEANS("rate of stress r_0 beyond which strengths rise: times (r/r_0)^exponent, r the mean rate since half of the strength; the energy stays")},
    {.name = "interface.rise.exponent", REAL, FROM_TO(0, 1), REQUIRED, GROUP(RISE), CASE(interface.rise.exponent),
     MEANS("of the rate of stress; of concrete in tension 0.02 to 0.03 from 1e5 Pa/s on")},
    {.name = "interface.rise.most", REAL, FROM(1), DEFAULT(10), GROUP(RISE), CASE(interface.rise.most),
     MEANS("most that strengths rise by, times")},
    {.name = "interface.sets", .type = RG_KEY_LIST, ELSE("none"), GROUP(COHESIVE), CASE(interface.set), .entry = &rg_face_set_table,
     .offset_count = offsetof(rg_case, interface.sets),
     MEANS("faces with properties of their own; of those that select a face the last one counts")},
    {.name = "interface.weibull.modulus", REAL, ABOVE(0), ELSE("strengths are not random"), GROUP(COHESIVE), CASE(interface.weibull.modulus),
     MEANS("m of strengths that differ at random: strength (-(A_0/A) ln(1 - U))^(1/m) on a face of area A")},
    {.name = "interface.weibull.area", .unit = "m2", REAL, ABOVE(0), REQUIRED, GROUP(WEIBULL),
     CASE(interface.weibull.area), MEANS("area A_0 of a face: of such 63 % are weaker than `strength`")},
    {.name = "interface.weibull.seed", INTEGER, FROM(0), DEFAULT(1), GROUP(WEIBULL), CASE(interface.weibull.seed),
     MEANS("U follows from it and the corners of the face, whatever the partition")},
    {.name = "interface.weibull.keep", EXPLAINED(keeps), DEFAULT(RG_KEEP_ENERGY), GROUP(WEIBULL),
     CASE(interface.weibull.keep), MEANS("what stays that of `energy` on each face")},

    {.name = "contact.model", EXPLAINED(contact_models), ELSE("interfaces"), CASE(contact.model),
     MEANS("which faces meet each other")},
    {.name = "contact.penalty", REAL, ABOVE(0), DEFAULT(4), GROUP(CONTACT), CASE(contact.penalty),
     MEANS("stiffness, in moduli over the height of an element over its face")},
    {.name = "contact.damping", .unit = "s/m", REAL, FROM(0), DEFAULT(0), GROUP(CONTACT), CASE(contact.damping),
     MEANS("c: faces that get deeper at a rate d' press 1 + c d' times as hard (none to twice), so that what strikes at v leaves at e v, c v (1 + e) = ln((1 + c v)/(1 - c e v)), but for waves; its heat is in `friction` of energy.csv")},
    {.name = "contact.friction", REAL, FROM(0), DEFAULT_OF(contact_friction), GROUP(CONTACT), CASE(contact.friction),
     MEANS("Coulomb's coefficient of faces that slide on each other; their heat is `friction` in energy.csv")},
    {.name = "contact.static_friction", REAL, FROM(0), DEFAULT_OF(static_friction), GROUP(CONTACT),
     CASE(contact.static_friction), MEANS("until they slide; not less than `friction`")},
    {.name = "contact.pairs", .type = RG_KEY_LIST, ELSE("none"), GROUP(CONTACT), CASE(contact.pair), .entry = &rg_contact_friction_table,
     .offset_count = offsetof(rg_case, contact.pairs), MEANS("friction between materials, in place of those; the last entry that has both counts")},

    {.name = "viscosity.linear", REAL, FROM(0), DEFAULT(0), CASE(viscosity.linear),
     MEANS("b1 of the bulk viscosity rho h (b1 c (-div v) + b2^2 h (div v)^2), against ringing behind shocks, as 0.06")},
    {.name = "viscosity.quadratic", REAL, FROM(0), DEFAULT(0), CASE(viscosity.quadratic),
     MEANS("b2, in compression alone, as 1.2")},

    {.name = "temperature.value", .unit = "K", .type = RG_KEY_EXPR, ELSE("temperature.free"), CASE(temperature.value),
     MEANS("of the solid, as given: it expands materials with an expansion, and nothing is conducted; tables make it one of measured times")},
    {.name = "temperature.free", .unit = "K", REAL, FROM(0), DEFAULT(293), GROUP(HEAT), CASE(temperature.free), MEANS("at which nothing is expanded")},

    {.name = "mass", EXPLAINED(masses), DEFAULT(RG_MASS_CONSISTENT), CASE(mass), MEANS("mass matrix")},

    INITIAL_KEYS("initial.", offsetof(rg_case, initial), STRESS_OF_RUN)
    {.name = "initial.sets", .type = RG_KEY_LIST, ELSE("none"), CASE(initial_set), .entry = &rg_initial_set_table,
     .offset_count = offsetof(rg_case, initial_sets), MEANS("elements with values of their own in place of those of `initial`; the last one that has an element counts")},

    {.name = "start", EXPLAINED(starts), DEFAULT(RG_START_INITIAL), CASE(start), MEANS("how a run begins")},

    {.name = "relax.tolerance", REAL, RELAX_TOLERANCE, GROUP(RELAX), CASE(relax.tolerance),
     MEANS("residual over loads and reactions at which damping ends; in single precision the default is 1e-4, and no less is allowed")},
    {.name = "relax.steps", INTEGER, FROM(1), DEFAULT(200000), GROUP(RELAX), CASE(relax.steps), MEANS("until then the run fails")},

    {.name = "boundary", .type = RG_KEY_LIST, ELSE("none: a free body"), CASE(boundary), .entry = &rg_boundary_table,
     .offset_count = offsetof(rg_case, boundaries), MEANS("prescribed motion of the surface; what is not named is free")},

    {.name = "loads", .type = RG_KEY_LIST, ELSE("none"), CASE(load), .entry = &rg_load_table,
     .offset_count = offsetof(rg_case, loads), MEANS("forces from outside, each on a part of the surface or of the body; they add up")},

    {.name = "bodies", .type = RG_KEY_LIST, ELSE("none"), CASE(body), .entry = &rg_body_table,
     .offset_count = offsetof(rg_case, bodies), MEANS("rigid bodies that the solid's surface touches, or that sets of it are tied to")},

    {.name = "time.end", .unit = "s", REAL, ABOVE(0), REQUIRED, MAY_CHANGE, CASE(time.end), MEANS("end of the run")},
    {.name = "time.safety", REAL, FROM_TO(0, 1), .low_open = true, DEFAULT_OF(safety), MAY_CHANGE,
     CASE(time.safety), MEANS("time step as a fraction of the critical one")},
    {.name = "time.steps", INTEGER, FROM(1), ELSE("no limit"), MAY_CHANGE, CASE(time.steps),
     MEANS("the run ends after so many steps even before its end")},
    {.name = "time.collapse", REAL, FROM_TO(0, 1), .high_open = true, DEFAULT(0.01), MAY_CHANGE, CASE(time.collapse),
     MEANS("the run stops when the step falls below this fraction of that at rest")},

    {.name = "output.dir", .type = RG_KEY_TEXT, ELSE("results/NAME of the case file"), MAY_CHANGE, CASE(output.dir),
     MEANS("output directory; also option -o")},
    {.name = "output.interval", .type = RG_KEY_INTERVAL, ELSE("time.end/50"), MAY_CHANGE, CASE(output),
     MEANS("between outputs")},
    {.name = "output.times", .unit = "s", .type = RG_KEY_REALS, FROM(0), ELSE("at every interval"), CASE(output.time),
     .offset_count = offsetof(rg_case, output.times), MEANS("fields at exactly these times")},
    {.name = "output.probes", .type = RG_KEY_LIST, ELSE("none"), CASE(output.probe), .entry = &rg_probe_table,
     .offset_count = offsetof(rg_case, output.probes), MEANS("points whose history is recorded in every step")},
    {.name = "output.sensors", .type = RG_KEY_LIST, ELSE("none"), CASE(output.sensor), .entry = &rg_sensor_table,
     .offset_count = offsetof(rg_case, output.sensors), MEANS("means, extremes and integrals over parts of the body, recorded in every step: columns NAME_VALUE_MEASURE of history.csv")},
    {.name = "output.contacts", .type = RG_KEY_LIST, ELSE("none"), GROUP(CONTACT), CASE(output.contact), .entry = &rg_contact_force_table,
     .offset_count = offsetof(rg_case, output.contacts), MEANS("forces of contact between fragments on parts of the solid, recorded in every step: columns NAME_force_x ... (N) and NAME_moment_x ... (N m, about the origin) of history.csv")},
    {.name = "output.crack_tips", .type = RG_KEY_LIST, ELSE("none"), GROUP(COHESIVE), CASE(output.crack_tip), .entry = &rg_crack_tip_table,
     .offset_count = offsetof(rg_case, output.crack_tips), MEANS("how far cracks have come and how fast, recorded in every step: columns NAME_tip (m; nan before there is one) and NAME_speed (m/s) of history.csv")},
    {.name = "output.crack_fronts", .type = RG_KEY_LIST, ELSE("none"), CASE(output.crack_front), .entry = &rg_crack_front_table,
     .offset_count = offsetof(rg_case, output.crack_fronts), MEANS("energy release rate and stress intensity at straight fronts of cracks, recorded in every step: columns NAME_VALUE of history.csv")},
    {.name = "output.fields", .type = RG_KEY_FLAGS, .choice = fields, .choice_meaning = fields_meaning, DEFAULT(0), MAY_CHANGE,
     .absent = "all that the materials have but rank, and triaxiality and material where there is cause",
     CASE(output.fields), MEANS("what to write; [] for none")},
    {.name = "output.fragments", EXPLAINED(fragments), DEFAULT(RG_FRAGMENTS_EACH), CASE(output.fragments),
     MEANS("rows of fragments.csv")},
    {.name = "output.region", .type = RG_KEY_EXPR, ELSE("the whole body"), .no_time = true, CASE(output.region),
     MEANS("fields of the elements at whose centroid this is not 0")},
    {.name = "output.precision", CHOICE(precisions), DEFAULT(RG_OUTPUT_DOUBLE), CASE(output.precision),
     MEANS("of the fields on the disk")},
    {.name = "output.compression", INTEGER, FROM_TO(0, 9), DEFAULT(0), MAY_CHANGE, CASE(output.compression),
     MEANS("of the fields on the disk, by gzip; 0: none")},
    {.name = "output.energy_limit", REAL, ABOVE(0), DEFAULT(0.05), MAY_CHANGE, CASE(output.energy_limit),
     MEANS("the run stops when its energy error, over the largest energy, passes this")},
    {.name = "output.dissipation_limit", REAL, ABOVE(0), ELSE("no limit"), MAY_CHANGE, CASE(output.dissipation_limit),
     MEANS("the run stops when its energy error passes this times what has been dissipated; judged once that is 1 % of the largest energy")},

    {.name = "checkpoint.steps", INTEGER, FROM(0), DEFAULT(0), MAY_CHANGE, CASE(checkpoint.steps),
     MEANS("a checkpoint every so many steps; 0: not for that reason")},
    {.name = "checkpoint.time", .unit = "s", REAL, FROM(0), DEFAULT(0), MAY_CHANGE, CASE(checkpoint.time),
     MEANS("every so much simulated time")},
    {.name = "checkpoint.wall_time", .unit = "s", REAL, FROM(0), DEFAULT(0), MAY_CHANGE, CASE(checkpoint.wall_time),
     MEANS("every so much time of the clock")},
    {.name = "checkpoint.keep", INTEGER, FROM_TO(1, 1000), DEFAULT(2), MAY_CHANGE, CASE(checkpoint.keep),
     MEANS("so many stay, the last ones")},
};

static const rg_key contact_friction_keys[] = {
    {.name = "between", .type = RG_KEY_TEXTS, REQUIRED, .offset = offsetof(rg_contact_friction, between),
     .offset_count = offsetof(rg_contact_friction, names), MEANS("names of two materials, or one twice")},
    {.name = "friction", REAL, FROM(0), REQUIRED, .offset = offsetof(rg_contact_friction, friction), MEANS("as contact.friction")},
    {.name = "static_friction", REAL, FROM(0), ELSE("friction"), .offset = offsetof(rg_contact_friction, static_friction),
     MEANS("as contact.static_friction")},
};

#define CONTACT_FORCE(member) .offset = offsetof(rg_contact_force_input, member)
static const rg_key contact_force_keys[] = {
    {.name = "name", .type = RG_KEY_TEXT, REQUIRED, CONTACT_FORCE(name), MEANS("column prefix in history.csv: letters, digits, _ and -")},
    {.name = "set", .type = RG_KEY_TEXT, .choice = box_sets, ELSE("where or between"), ONE_OF, CONTACT_FORCE(set),
     MEANS("the force on a side of the box, or on a surface set of the mesh file, by all that it touches but rigid bodies")},
    {.name = "where", .type = RG_KEY_EXPR, ELSE("set or between"), ONE_OF, .no_time = true, .normal = true, CONTACT_FORCE(where),
     MEANS("that on faces of the surface where it is not 0, by their middle and outward normal")},
    {.name = "between", .type = RG_KEY_TEXTS, ELSE("set or where"), ONE_OF, CONTACT_FORCE(between), .offset_count = offsetof(rg_contact_force_input, names),
     MEANS("names of two materials: the force on the first by the second, faces that cracked open included")},
};

static const rg_key face_set_keys[] = {
    {.name = "set", .type = RG_KEY_TEXT, ELSE("where or between"), SOME_OF, .offset = offsetof(rg_face_set, set),
     MEANS("surface set of the mesh file: those of its faces that lie between elements; with `where` or `between` all hold")},
    {.name = "where", .type = RG_KEY_EXPR, ELSE("set or between"), SOME_OF, .no_time = true, .normal = true,
     .offset = offsetof(rg_face_set, where),
     MEANS("faces where it is not 0, by their middle and unit normal, of either sign")},
    {.name = "between", .type = RG_KEY_TEXTS, ELSE("set or where"), SOME_OF, .offset = offsetof(rg_face_set, between),
     .offset_count = offsetof(rg_face_set, names), MEANS("names of the materials on both sides, or one twice; any: between any two volume sets or materials, as the boundaries of grains")},
    {.name = "law", EXPLAINED(breakings), ELSE("interface"), .offset = offsetof(rg_face_set, breaking),
     MEANS("whether they can break")},
    {.name = "open", .type = RG_KEY_BOOL, ELSE("false"), .offset = offsetof(rg_face_set, open),
     MEANS("true: a crack from the start, whose faces press and rub where they are closed; nothing was dissipated there; so is the crack that a mesh file brings (rhegma mesh --crack), unless an entry names its set")},
    {.name = "at", .unit = "s", REAL, ABOVE(0), ELSE("the start"), .offset = offsetof(rg_face_set, opens_at),
     MEANS("the open faces hold, whatever pulls at them, and open at the first step from this time on; what the crack's DG terms stored is booked as `unresolved`")},
    {.name = "strength", .unit = "Pa", FACE, ABOVE(0), ELSE("interface.strength"), OF_SET(strength),
     MEANS("tensile strength of these faces")},
    {.name = "energy", .unit = "J/m2", FACE, ABOVE(0), ELSE("interface.energy"), OF_SET(energy),
     MEANS("fracture energy of these faces")},
    {.name = "beta", FACE, FROM(0), ELSE("interface.beta"), OF_SET(beta),
     MEANS("weight of shear against opening, but in form intrinsic")},
    {.name = "friction", FACE, FROM(0), ELSE("interface.friction"), OF_SET(friction),
     MEANS("Coulomb's coefficient of these faces, closed")},
    {.name = "rise", FACE, FROM(0), ELSE("interface.rise.exponent"), OF_SET(rise),
     MEANS("exponent of the rate of stress by which their strength rises, with interface.rise")},
    {.name = "weibull.modulus", REAL, ABOVE(0), ELSE("interface.weibull.modulus"), .offset = offsetof(rg_face_set, modulus),
     MEANS("of strengths that differ at random")},
    {.name = "weibull.area", .unit = "m2", REAL, ABOVE(0), ELSE("required with weibull.modulus"), .offset = offsetof(rg_face_set, area),
     MEANS("area of a face of which 63 % are weaker than `strength`")},
    {.name = "weibull.seed", INTEGER, FROM(1), ELSE("interface.weibull.seed"), .offset = offsetof(rg_face_set, seed),
     MEANS("of these faces")},
};

static const rg_key other_material_keys[] = {
    {.name = "name", .type = RG_KEY_TEXT, REQUIRED, .offset = offsetof(rg_other_material, is.name),
     MEANS("by which interface.sets calls it: letters, digits, _ and -")},
    {.name = "set", .type = RG_KEY_TEXT, ELSE("where or file"), ONE_OF, .offset = offsetof(rg_other_material, set),
     MEANS("a volume set of the mesh file")},
    {.name = "where", .type = RG_KEY_EXPR, ELSE("set or file"), ONE_OF, .no_time = true, .offset = offsetof(rg_other_material, where),
     MEANS("elements at whose centroid this is not 0")},
    {.name = "file", .type = RG_KEY_TEXT, ELSE("set or where"), ONE_OF, .offset = offsetof(rg_other_material, file),
     MEANS("CSV file beside the case with a material in each row: its first line names the columns, set and any keys of a material, orientation.angles as angle_1, angle_2, angle_3; what it does not say is as here; the names are NAME-1, NAME-2, ... or those of a column name")},
#define KEY(word) word
#define INPUT     offsetof(rg_other_material, is)
#include "case/material_keys.h"
};

#define BOUNDARY(member) .offset = offsetof(rg_boundary, member)
#define PRESCRIBED(NAME, key, unit_, words)                                                                 \
    {.name = (key), .unit = (unit_), .type = RG_KEY_EXPR, ELSE("another motion"), ONE_OF, .group = RG_GROUP_PRESCRIBED,  \
     .no_place = RG_PRESCRIBED_##NAME == RG_PRESCRIBED_ANGLE, .prescribed = RG_PRESCRIBED_##NAME, BOUNDARY(value), MEANS(words)},
#define TRANSLATION(key, i, words) \
    {.name = (key), .unit = "m", .type = RG_KEY_EXPR, ELSE("0"), GROUP(RIGID), .no_place = true, BOUNDARY(translation[i]), MEANS(words)},

static const rg_key boundary_keys[] = {
    {.name = "name", .type = RG_KEY_TEXT, ELSE("no columns"), BOUNDARY(name),
     MEANS("column prefix in history.csv of the force that holds it, on the solid, its moment about the origin and its work: letters, digits, _ and -")},
    {.name = "set", .type = RG_KEY_TEXT, .choice = box_sets, ELSE("where"), BOUNDARY(set),
     MEANS("a side of the box, or a surface set of the mesh file")},
    {.name = "where", .type = RG_KEY_EXPR, ELSE("set"), .no_time = true, .normal = true, BOUNDARY(where),
     MEANS("faces of the surface where it is not 0, by their middle and outward normal")},
    {.name = "component", CHOICE(components), DEFAULT(0), GROUP(COMPONENT), .absent = "required of a velocity or displacement, or `direction`",
     BOUNDARY(component), MEANS("of the motion that is prescribed")},
    {.name = "direction", REAL3, ANY, ELSE("a component"), GROUP(LINE), BOUNDARY(direction),
     MEANS("along which the velocity or displacement is prescribed, free across: of any length")},
    RG_PRESCRIBED(PRESCRIBED, )
    {.name = "absorbing", .type = RG_KEY_BOOL, ELSE("a motion"), ONE_OF, BOUNDARY(absorbing),
     MEANS("true: waves that meet it straight on leave by it (Lysmer & Kuhlemeyer 1969): the traction is -rho c_d v along the normal, -rho c_s v across")},
    {.name = "dashpot", .unit = "N s/m3", REAL, ABOVE(0), ELSE("a motion"), ONE_OF, BOUNDARY(dashpot),
     MEANS("traction over velocity of dashpots between the side and the ground, alike in all directions; what they take is `radiated` in energy.csv")},
    {.name = "axis", REAL3, ANY, ELSE("required of an angle"), GROUP(RIGID), BOUNDARY(axis), MEANS("about which the set turns, by the right hand: of any length")},
    {.name = "at", .unit = "m", REAL3, ANY, ELSE("0, 0, 0"), GROUP(RIGID), BOUNDARY(at), MEANS("a point of the axis at the start")},
    TRANSLATION("translation.x", 0, "of the axis along x, beside the turn")
    TRANSLATION("translation.y", 1, "along y")
    TRANSLATION("translation.z", 2, "along z")
    {.name = "from", .unit = "s", REAL, FROM(0), ELSE("0"), GROUP(MOTION), BOUNDARY(from),
     MEANS("the motion is prescribed from this time on, and free before")},
    {.name = "until", .unit = "s", REAL, ABOVE(0), ELSE("the end of the run"), GROUP(MOTION), BOUNDARY(until),
     MEANS("and no more from this one on: the side is released")},
};

#define LOAD(member) .offset = offsetof(rg_load_input, member)
#define LOAD_VECTOR(key, unit_, NAME, evenly, words)                                                    \
    {.name = key ".x", .unit = (unit_), .type = RG_KEY_EXPR, ELSE("another load"), ONE_OF, .no_place = (evenly), LOAD(value[RG_LOAD_##NAME][0]), MEANS(words)}, \
    {.name = key ".y", .unit = (unit_), .type = RG_KEY_EXPR, ELSE("0"), .no_place = (evenly), LOAD(value[RG_LOAD_##NAME][1]), MEANS("along y")}, \
    {.name = key ".z", .unit = (unit_), .type = RG_KEY_EXPR, ELSE("0"), .no_place = (evenly), LOAD(value[RG_LOAD_##NAME][2]), MEANS("along z")},

/* Of what comes first in RG_LOADS it has one. */
static const rg_key load_keys[] = {
    {.name = "name", .type = RG_KEY_TEXT, ELSE("no columns"), LOAD(name),
     MEANS("column prefix of its force, moment about the origin and work in history.csv: letters, digits, _ and -")},
    {.name = "set", .type = RG_KEY_TEXT, .choice = box_sets, ELSE("where"), LOAD(set),
     MEANS("a side of the box, or a surface set of the mesh file; not of what acts on elements")},
    {.name = "where", .type = RG_KEY_EXPR, ELSE("set; of accelerations and centrifugal forces the whole body"), .no_time = true, .normal = true, LOAD(where),
     MEANS("faces of the surface where it is not 0, by their middle and outward normal; of an acceleration and of centrifugal forces elements, by their centroid")},
    {.name = "cracks", .type = RG_KEY_BOOL, ELSE("false"), LOAD(cracks),
     MEANS("true: the pressure acts inside cracks, on both faces, by the share of a face's points that have separated; with set or where only in those")},
    LOAD_VECTOR("traction", "Pa", TRACTION, false, "traction along x, per area of reference: it keeps its direction")
    {.name = "pressure", .unit = "Pa", .type = RG_KEY_EXPR, ELSE("another load"), ONE_OF, LOAD(value[RG_LOAD_PRESSURE][0]),
     MEANS("pressure on the deformed face: it follows its normal and its area")},
    LOAD_VECTOR("force", "N", FORCE, true, "total force along x, spread evenly over the area of reference")
    LOAD_VECTOR("acceleration", "m/s2", ACCELERATION, false, "force per mass along x, as gravity")
    {.name = "foundation", .unit = "N/m3", .type = RG_KEY_EXPR, ELSE("another load"), ONE_OF, .no_time = true, LOAD(value[RG_LOAD_FOUNDATION][0]),
     MEANS("springs between the surface and the ground, alike in all directions, per area of reference: traction over displacement, not negative; what they store is `foundation` in energy.csv")},
    {.name = "centrifugal.speed", .unit = "rad/s", .type = RG_KEY_EXPR, ELSE("another load"), ONE_OF, .no_place = true, LOAD(value[RG_LOAD_CENTRIFUGAL][0]),
     MEANS("force per mass of a frame that turns so fast, speed^2 times the distance from its axis, at present places: the solid as it is seen from there, but for Coriolis forces")},
    {.name = "centrifugal.axis", REAL3, ANY, ELSE("required of it"), LOAD(axis), MEANS("about which the frame turns: of any length")},
    {.name = "centrifugal.at", .unit = "m", REAL3, ANY, ELSE("0, 0, 0"), LOAD(at), MEANS("a point of the axis")},
    {.name = "from", .unit = "s", REAL, FROM(0), DEFAULT(0), LOAD(from), MEANS("the load acts from this time on")},
    {.name = "until", .unit = "s", REAL, ABOVE(0), ELSE("the end of the run"), LOAD(until), MEANS("and no more from this one on")},
};

#define BODY(member) .offset = offsetof(rg_body_input, member)
#define BODY_VELOCITY(name_, component, words)                                                               \
    { .name = (name_), .unit = "m/s", .type = RG_KEY_EXPR, ELSE("0"), .no_place = true, BODY(velocity[component]), MEANS(words) }
#define BODY_SPIN(name_, component, words)                                                                   \
    { .name = (name_), .unit = "rad/s", .type = RG_KEY_EXPR, ELSE("0"), .no_place = true, BODY(spin[component]), MEANS(words) }

static const rg_key body_keys[] = {
    {.name = "name", .type = RG_KEY_TEXT, REQUIRED, BODY(name),
     MEANS("column prefix in history.csv: letters, digits, _ and -")},
    {.name = "shape", EXPLAINED(shapes), REQUIRED, BODY(shape), MEANS("of the body")},
    {.name = "motion", EXPLAINED(motions), REQUIRED, BODY(motion), MEANS("how it moves")},
    {.name = "at", .unit = "m", REAL3, ANY, REQUIRED, BODY(at),
     MEANS("its centre of mass at the start: centre of the sphere, a point of the plane or of the axis")},
    {.name = "radius", .unit = "m", REAL, ABOVE(0), ELSE("none"), BODY(radius), MEANS("of a sphere or cylinder, which must have it")},
    {.name = "normal", REAL3, ANY, ELSE("required of it"), BODY(normal), MEANS("of a plane, which must have it: away from the body, of any length")},
    {.name = "axis", REAL3, ANY, ELSE("required of it"), BODY(axis), MEANS("of a cylinder, which must have it: of any length")},
    {.name = "density", .unit = "kg/m3", REAL, ABOVE(0), ELSE("none"), BODY(density), MEANS("of a free sphere, or a cylinder of a length, in place of mass and inertia")},
    {.name = "length", .unit = "m", REAL, ABOVE(0), ELSE("none"), BODY(length), MEANS("of a cylinder with a density, half of it on either side of `at`; contact sees no ends")},
    {.name = "mass", .unit = "kg", REAL, ABOVE(0), ELSE("none"), BODY(mass), MEANS("of a free body, which must have it or a density")},
    {.name = "inertia", .unit = "kg m2", .type = RG_KEY_REAL, .count = 6, .entries = "xx, yy, zz, yz, xz, xy", ANY, ELSE("it does not turn"), BODY(inertia),
     MEANS("of a free body with a mass, about `at`, along the axes of coordinates at the start; products of inertia with their minus, yz = -int y z dm")},
    BODY_VELOCITY("velocity.x", 0, "along x: of a free body at the start, of a prescribed one at all times"),
    BODY_VELOCITY("velocity.y", 1, "along y"),
    BODY_VELOCITY("velocity.z", 2, "along z"),
    BODY_SPIN("spin.x", 0, "angular velocity about x: of a free body that turns at the start, of a prescribed one at all times"),
    BODY_SPIN("spin.y", 1, "about y"),
    BODY_SPIN("spin.z", 2, "about z"),
    {.name = "faces", .type = RG_KEY_TEXTS, .choice = box_sets, ELSE("all on the surface; with contact.model general also those that crack open"), BODY(set),
     .offset_count = offsetof(rg_body_input, sets), MEANS("sets of faces that may touch it")},
    {.name = "tied", .type = RG_KEY_TEXTS, .choice = box_sets, ELSE("none"), BODY(tied),
     .offset_count = offsetof(rg_body_input, ties), MEANS("sets of faces that move and turn with it: their forces and moments are the body's")},
    {.name = "tied_where", .type = RG_KEY_EXPR, ELSE("none"), .no_time = true, .normal = true, BODY(tied_where),
     MEANS("faces of the surface that do, too: where it is not 0, by their middle and outward normal")},
    {.name = "tied_from", .unit = "s", REAL, ABOVE(0), ELSE("the start"), BODY(tied_from),
     MEANS("from the first step at this time on they do, where they and the body then are; the kinetic energy that goes is `joined` in the ledger")},
    {.name = "tied_until", .unit = "s", REAL, ABOVE(0), ELSE("the end of the run"), BODY(tied_until),
     MEANS("from the first step at this time on they are let go, with the velocities that they have")},
    {.name = "penalty", REAL, ABOVE(0), DEFAULT(4), BODY(penalty),
     MEANS("contact stiffness in (lambda + 2 mu)/h, h the height of an element over its face")},
};

#define PART(member) .offset = offsetof(rg_initial_set, member)
static const rg_key initial_set_keys[] = {
    {.name = "set", .type = RG_KEY_TEXT, ELSE("where"), ONE_OF, PART(set), MEANS("a volume set of the mesh file")},
    {.name = "material", .type = RG_KEY_TEXT, ELSE("where"), ONE_OF, PART(material), MEANS("name of a material")},
    {.name = "where", .type = RG_KEY_EXPR, ELSE("set"), ONE_OF, .no_time = true, PART(where),
     MEANS("elements at whose centroid it is not 0")},
    INITIAL_KEYS("", offsetof(rg_initial_set, is), )
};

static const rg_key probe_keys[] = {
    {.name = "name", .type = RG_KEY_TEXT, REQUIRED, .offset = offsetof(rg_probe, name),
     MEANS("column prefix in history.csv: letters, digits, _ and -")},
    {.name = "at", .unit = "m", REAL3, ANY, REQUIRED, .offset = offsetof(rg_probe, at), MEANS("reference position, inside the body")},
    {.name = "strain", .type = RG_KEY_BOOL, ELSE("false"), .offset = offsetof(rg_probe, strain),
     MEANS("true: Green-Lagrange's strain (F'F - 1)/2 too, columns NAME_exx ... NAME_exy, beside displacement, velocity and Cauchy stress")},
};

#define TIP(member) .offset = offsetof(rg_crack_tip_input, member)
static const rg_key crack_tip_keys[] = {
    {.name = "name", .type = RG_KEY_TEXT, REQUIRED, TIP(name), MEANS("column prefix in history.csv: letters, digits, _ and -")},
    {.name = "direction", REAL3, ANY, REQUIRED, TIP(direction),
     MEANS("the tip is the furthest point along it, of reference, that has separated wholly; of a law without an end, that has broken: of any length")},
    {.name = "set", .type = RG_KEY_TEXT, .choice = box_sets, ELSE("where or all faces"), TIP(set),
     MEANS("a surface set of the mesh file: those of its faces that lie between elements")},
    {.name = "where", .type = RG_KEY_EXPR, ELSE("set or all faces"), .no_time = true, .normal = true, TIP(where),
     MEANS("faces between elements where it is not 0, by their middle and unit normal, of either sign")},
    {.name = "distance", .unit = "m", REAL, FROM(0), DEFAULT(0), TIP(distance),
     MEANS("the speed is that over at least this distance; 0: from one point to the next, which leaps")},
};

#define FRONT(member) .offset = offsetof(rg_crack_front_input, member)
static const rg_key crack_front_keys[] = {
    {.name = "name", .type = RG_KEY_TEXT, REQUIRED, FRONT(name), MEANS("column prefix in history.csv: letters, digits, _ and -")},
    {.name = "at", .unit = "m", REAL3, ANY, REQUIRED, FRONT(at), MEANS("a point of the front, of reference; with `length` the middle of the piece")},
    {.name = "direction", REAL3, ANY, REQUIRED, FRONT(direction), MEANS("in which the crack would grow, in its plane: of any length")},
    {.name = "normal", REAL3, ANY, REQUIRED, FRONT(normal), MEANS("of the plane of the crack, at right angles to the direction: of any length")},
    {.name = "radius.inner", .unit = "m", REAL, ABOVE(0), REQUIRED, FRONT(radius.inner), MEANS("about the front, of what the integral encloses: the cohesive zone, and an element or two")},
    {.name = "radius.outer", .unit = "m", REAL, ABOVE(0), REQUIRED, FRONT(radius.outer),
     MEANS("the integral's weight falls from 1 to 0 between them; openings are those between them. There the solid should be elastic, all faces behind the front free, and no load; J and K are refused beside a pressure inside cracks")},
    {.name = "length", .unit = "m", REAL, ABOVE(0), ELSE("the whole front, through a body of one thickness"), FRONT(length),
     MEANS("of a piece of the front, about `at`; its weight falls linearly from its middle to its ends")},
    {.name = "symmetric", .type = RG_KEY_BOOL, ELSE("false"), FRONT(symmetric), MEANS("true: the body is one half, on rollers in the plane of the crack ahead of it")},
    {.name = "tip", .type = RG_KEY_TEXT, ELSE("it rests at `at`"), FRONT(tip), MEANS("name in output.crack_tips: the front is where that tip was in the step before, at `at` as long as there is none")},
    {.name = "values", .type = RG_KEY_FLAGS, .choice = front_values, .choice_meaning = front_values_meaning, DEFAULT(0), .absent = "[J, K]", FRONT(values), MEANS("what is recorded")},
};

#define SENSOR(member) .offset = offsetof(rg_sensor_input, member)
static const rg_key sensor_keys[] = {
    {.name = "name", .type = RG_KEY_TEXT, REQUIRED, SENSOR(name), MEANS("column prefix in history.csv: letters, digits, _ and -")},
    {.name = "set", .type = RG_KEY_TEXT, .choice = box_sets, ELSE("where, material or the whole body"), SENSOR(set),
     MEANS("a side of the box, or a set of the mesh file: of faces of the surface, or of elements")},
    {.name = "where", .type = RG_KEY_EXPR, ELSE("set, material or the whole body"), .no_time = true, .normal = true, SENSOR(where),
     MEANS("elements at whose centroid it is not 0; an expression with nx, ny or nz selects faces of the surface, by middle and outward normal")},
    {.name = "material", .type = RG_KEY_TEXT, ELSE("set, where or the whole body"), SENSOR(material), MEANS("elements of the material of this name")},
    {.name = "values", .type = RG_KEY_FLAGS, .choice = sensor_values, .choice_meaning = sensor_values_meaning, REQUIRED, SENSOR(values),
     MEANS("what is recorded; stress costs each element about as much as half a step")},
    {.name = "measures", .type = RG_KEY_FLAGS, .choice = sensor_measures, .choice_meaning = sensor_measures_meaning, DEFAULT(0), .absent = "[mean]", SENSOR(measures),
     MEANS("what is made of it over the part")},
};
/* clang-format on */

#define TABLE(list, type)                                                                                    \
    { .key = (list), .keys = sizeof(list) / sizeof(list)[0], .size = sizeof(type) }

const rg_key_table rg_case_table = TABLE(case_keys, rg_case);
const rg_key_table rg_material_table = TABLE(other_material_keys, rg_other_material);
const rg_key_table rg_contact_friction_table = TABLE(contact_friction_keys, rg_contact_friction);
const rg_key_table rg_contact_force_table = TABLE(contact_force_keys, rg_contact_force_input);
const rg_key_table rg_face_set_table = TABLE(face_set_keys, rg_face_set);
const rg_key_table rg_boundary_table = TABLE(boundary_keys, rg_boundary);
const rg_key_table rg_load_table = TABLE(load_keys, rg_load_input);
const rg_key_table rg_body_table = TABLE(body_keys, rg_body_input);
const rg_key_table rg_initial_set_table = TABLE(initial_set_keys, rg_initial_set);
const rg_key_table rg_sensor_table = TABLE(sensor_keys, rg_sensor_input);
const rg_key_table rg_crack_tip_table = TABLE(crack_tip_keys, rg_crack_tip_input);
const rg_key_table rg_crack_front_table = TABLE(crack_front_keys, rg_crack_front_input);
const rg_key_table rg_probe_table = TABLE(probe_keys, rg_probe);

_Static_assert(sizeof(case_keys) / sizeof(case_keys[0]) <= RG_MAX_KEYS, "RG_MAX_KEYS is too small");
_Static_assert(sizeof(rg_form) == sizeof(int), "choices are stored as int");
