/* A small bar in every combination of form, law, activation, contact, mass, materials, viscosity, shared
 * nodes and bodies that changes what a step does. What a case can newly ask for of a step gets a line here.
 */
#ifndef STEP_CASES_H
#define STEP_CASES_H

#include <stdio.h>
#include <stdlib.h>

#include "case/case.h"
#include "case/read.h"
#include "mesh/mesh.h"

enum { OVERRIDES = 6 };

static const char bar[] =
    "mesh: {cells: [2, 2, 12], size: [2e-4, 2e-4, 12e-4], origin: [-1e-4, -1e-4, -6e-4], jitter: 0.15}\n"
    "material: {name: glass, model: neo-hookean, young: 260e9, poisson: 0.21, density: 3690}\n"
    "interface: {law: linear, strength: 400e6, energy: 10}\n"
    "boundary:\n"
    "  - {set: z+, component: z, velocity: '2e9*t*(1 + 1e3*x)'}\n"
    "  - {set: z+, component: x, velocity: 3}\n"
    "  - {set: x-, component: x, displacement: '5e-9*sin(4e8*t)*(1 + 2e3*y)'}\n"
    "time: {end: 1}\n"
    "output: {fields: []}\n";

typedef struct {
    const char *name, *override[OVERRIDES];
} variant;

#define HALVES                                                                                               \
    "materials=[{name: metal, model: j2, young: 200e9, poisson: 0.3, density: 7800, yield_stress: 3e8, "     \
    "hardening: 1e9, where: 'z > 1e-4'}, {name: foam, model: linear-elastic, young: 100e9, poisson: 0.1, "   \
    "density: 2000, where: 'z > 3e-4 && x > 0'}]"
#define CERAMIC                                                                                              \
    "material={name: glass, model: deshpande-evans, shear: 146e9, poisson: 0.2, density: 3700, "             \
    "flaw_radius: "                                                                                          \
    "19e-6, flaw_density: 1e12, toughness: 3e6, yield_stress: 4e9}"
/* The last one is pressed, so that the last of the sums counts. */
#define BODIES                                                                                               \
    "bodies=[{name: ghost, shape: plane, motion: free, at: [-1e-4, 0, 0], normal: [1, 0, 0], "               \
    "mass: 1e-7, velocity: {x: 9}, faces: [z+]}, {name: ball, shape: sphere, motion: free, at: "             \
    "[51e-4, 0, 1e-4], radius: 5e-3, density: 1, velocity: {x: -50, z: 4}}, {name: pin, shape: "             \
    "cylinder, motion: free, at: [0, 31e-4, 3e-4], axis: [2, 0, 0.6], radius: 3e-3, mass: 1e-7,"             \
    " velocity: {y: -30, x: 1}}, {name: roll, shape: cylinder, motion: prescribed, at: [0, "                 \
    "-21e-4, 0], axis: [0, 0, 3], radius: 2e-3, velocity: {y: 20, x: '-1e9*t'}}, {name: wall, "              \
    "shape: plane, motion: prescribed, at: [0, 0, -6e-4], normal: [0, 0, 2], velocity: {z: '30 "             \
    "+ 1e9*t'}, faces: [z-, y+]}]"

static const variant variants[] = {
    {"variational", {NULL}},
    {"incomplete, lumped", {"interface.form=incomplete", "mass=lumped"}},
    {"total, flux", {"interface.form=incomplete", "interface.activation=total", "interface.contact=flux"}},
    {"lifted flux", {"interface.activation=total", "interface.contact=flux"}},
    {"conserving, rate, potential",
     {"interface.activation=conserving", "interface.law=rate", "interface.contact=potential"}},
    {"potential, isotropic", {"interface.contact=potential", "interface.penalty=isotropic"}},
    {"friction", {"interface.friction=0.5"}},
    {"friction, fatigue, beta", {"interface.friction=0.3", "interface.law=fatigue", "interface.beta=0.7"}},
    {"normal criterion", {"defaults=0", "interface.beta=0", "interface.beta_s=6"}},
    {"intrinsic, steps",
     {"interface.form=intrinsic", "interface.law=bilinear", "interface.bilinear={ascent: 0.05, steps: 20}"}},
    {"intrinsic, friction",
     {"interface.form=intrinsic", "interface.law=exponential", "interface.friction=0.4"}},
    {"intrinsic, Xu-Needleman",
     {"interface.form=intrinsic", "interface.law=xu-needleman", "interface.energy=40"}},
    {"shared nodes", {"interface.form=continuous", "mass=lumped", "interface.faces=abs(nz) > 0.5"}},
    {"shared nodes alone", {"interface={form: continuous, law: none}", "mass=lumped"}},
    {"shared nodes, materials, viscosity",
     {"interface.form=continuous", "mass=lumped", "interface.faces=abs(nx) > 0.5", HALVES,
      "viscosity={linear: 0.06, quadratic: 1.2}"}},
    {"materials, viscosity", {"defaults=0", HALVES, "viscosity={linear: 0.06, quadratic: 1.2}"}},
    {"ceramic and metal", {"defaults=0", CERAMIC, HALVES}},
    {"sets",
     {"defaults=0", HALVES,
      "interface.sets=[{where: 'z < 0', strength: 500e6}, {where: 'abs(nz) > 0.9', strength: 300e6, "
      "energy: 20}, {between: [metal, glass], energy: 50}, {between: [foam, metal], strength: 200e6}]"}},
    {"bodies", {BODIES}},
    {"bodies, shared nodes", {BODIES, "interface.form=continuous", "mass=lumped", "interface.faces=1"}},
    {"no law", {"interface={law: none}", "mass=lumped"}},
    {"suddenly placed",
     {"boundary=[{set: z-, component: z, displacement: '2e-9*cos(4e8*t)'}, {set: x-, component: y, "
      "displacement: "
      "3e-9}, {set: x+, component: x, velocity: 2}]"}},
};

enum { VARIANTS = sizeof variants / sizeof *variants };

static inline rg_case *read_case(const variant *v) {
    int count = 0;
    while (count < OVERRIDES && v->override[count] != NULL)
        count++;
    rg_case *c = rg_case_read_text("bar", bar, sizeof bar - 1, count, v->override, stderr);
    if (c == NULL)
        abort();
    return c;
}

static inline rg_mesh *make_mesh(const rg_case *c) {
    return rg_mesh_box(c->mesh.cells, c->mesh.origin, c->mesh.size, c->mesh.jitter, c->mesh.seed);
}

#endif
