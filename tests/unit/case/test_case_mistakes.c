/* Every mistake in a case file is named with its place. */
#include "support/case_input.h"

#define CELLS    "allowed: [x, y, z], each integer >= 1 and <= 100000\n"
#define CELL     "allowed: integer >= 1 and <= 100000\n"
#define SIZE     "allowed: [x, y, z], each number > 0 (m)\n"
#define YOUNG    "allowed: number > 0 (Pa)\n"
#define STRENGTH "allowed: number > 0, or expression in x, y, z, nx, ny, nz (Pa)\n"
#define SETS     "allowed: x-, x+, y-, y+, z-, z+"
#define MOTION   "allowed: number or expression in x, y, z, t (m/s)\n"
#define ONE_OF   ONE_MOTION
#define ENTRIES  "allowed: " BOUNDARY_LIST "\n"
#define INTERVAL "allowed: integer >= 1 (steps), or number > 0 and < 1 (simulated seconds)\n"
#define FIELDS                                                                                               \
    "allowed: list from displacement, velocity, stress, mean_stress, principal_stress, crack, "              \
    "damage, regime, plastic_strain, triaxiality, rank, fragment, material, plastic_volume, "                \
    "bulking_pressure, temperature, contact"
#define BLOCKS                                                                                               \
    "allowed: defaults, tables, mesh, material, materials, interface, contact, viscosity, temperature, "     \
    "mass, initial, "                                                                                        \
    "start, relax, "                                                                                         \
    "boundary, "                                                                                             \
    "loads, "                                                                                                \
    "bodies, time, output, checkpoint"
#define CERAMIC        ": not used, because material.model is neo-hookean; it belongs to deshpande-evans\n"
#define NAMES          "allowed: letters, digits, _ and -; unique in history.csv\n"
#define MATERIAL_NAMES "allowed: letters, digits, _ and -; unique among materials\n"
#define PAIR           "allowed: any, or names of two materials, or one twice: material, steel"
#define UNUSED         ": not used, because interface.law is none\n"
#define BY_FORM        ": not used, because interface.form is intrinsic\n"
#define JOINED         ": not used, because interface.form is continuous, without interface.faces\n"
#define INTRINSIC      "with form intrinsic: $SLOPED_LAWS\n"
#define SPECIAL        ": anchors, aliases and tags are not supported\n"

static const mistake mistakes[] = {
    /* missing, unknown, repeated keys */
    {"  cells: [2, 2, 4]\n", "", ":2:3: mesh.cells: missing; " CELLS},
    {"  law: linear\n", "", ":10:3: interface.law: missing; allowed: $LAWS, none, user\n"},
    {"  strength: 400e6\n", "", ":10:3: interface.strength: missing; " STRENGTH},
    {"strength: 400e6", "strength: -4", ":11:13: interface.strength: -4: out of range; " STRENGTH},
    {"strength: 400e6", "strength: .inf", ":11:13: interface.strength: .inf: not finite; " STRENGTH},
    {"strength: 400e6", "strength: \"4\"",
     ":11:13: interface.strength: \"4\": a text (in quotes), not a number; " STRENGTH},
    {"strength: 400e6", "strength: 4*t",
     ":11:13: interface.strength: 4*t: depends on t, but this is the state at the start; " STRENGTH},
    {"strength: 400e6", "strength: [4]",
     ":11:13: interface.strength: [4]: not a number or expression; " STRENGTH},
    {"time:\n  end: 1e-6\n", "", ":1:1: time.end: missing; allowed: number > 0 (s)\n"},
    {"mesh:\n  cells: [2, 2, 4]\n  size: [1e-3, 1e-3, 2e-3]\n", "mesh:\n",
     ":1:1: mesh: no value\n:1:1: mesh.cells: missing; " CELLS ":1:1: mesh.size: missing; " SIZE},
    {"cells", "cels",
     ":2:3: mesh.cels: unknown key; did you mean 'mesh.cells'?\n:2:3: mesh.cells: missing; " CELLS},
    {"material:\n", "material:\n  poisson_ratio: 0.2\n",
     ":5:3: material.poisson_ratio: unknown key; did you mean 'material.poisson'?\n"},
    {"  density: 3690\n", "  density: 3690\n  weibull: {modulus: 3}\n",
     ":9:3: material.weibull: unknown key; did you mean 'interface.weibull'?\n"}, /* a section at the wrong
                                                                                     place */
    {"mesh:\n", "cells: [1, 1, 1]\nmesh:\n", ":1:1: cells: unknown key; did you mean 'mesh.cells'?\n"},
    {"mesh:\n", "fracture: true\nmesh:\n", ":1:1: fracture: unknown key; " BLOCKS "\n"},
    {"velocity: 6.086", "velocity: 6.086, unit: 1",
     ":14:46: boundary[0].unit: unknown key; did you mean 'until'?\n"},
    {"mesh:\n", "mesh.jitter: 0.1\nmesh:\n",
     ":1:1: mesh.jitter: unknown key: the parts of a dotted key stand on lines of their own\n"},
    {"  density: 3690\n", "  density: 3690\n  density: 3691\n",
     ":9:3: material.density: given twice, first at line 8 column 3\n"},
    {"time:\n", "mesh: {}\ntime:\n", ":15:1: mesh: given twice, first at line 1 column 1\n"},
    {"time:\n  end: 1e-6", "time: 3", ":15:7: time: 3: not a mapping of keys\n"},
    /* numbers */
    {"[2, 2, 4]", "[2, 2]", ":2:10: mesh.cells: [2, 2]: wrong number of entries; " CELLS},
    {"[2, 2, 4]", "4", ":2:10: mesh.cells: 4: not a list; " CELLS},
    {"[2, 2, 4]", "[2, 2.5, 0]",
     ":2:14: mesh.cells[1]: 2.5: not an integer; " CELL ":2:19: mesh.cells[2]: 0: out of range; " CELL},
    {"[2, 2, 4]", "[2, 2, 99999999999999999999]",
     ":2:17: mesh.cells[2]: 99999999999999999999: out of range; " CELL},
    {"young: 260e9", "young: '260e9'",
     ":6:10: material.young: \"260e9\": a text (in quotes), not a number; " YOUNG},
    {"young: 260e9", "young: 260 GPa", ":6:10: material.young: 260 GPa: not a number; " YOUNG},
    {"young: 260e9", "young: 0x10", ":6:10: material.young: 0x10: not a number; " YOUNG},
    {"young: 260e9", "young: {a: 1}", ":6:10: material.young: {a: 1}: not a number; " YOUNG},
    {"young: 260e9", "young: .inf", ":6:10: material.young: .inf: not finite; " YOUNG},
    {"young: 260e9", "young: .NaN", ":6:10: material.young: .NaN: not finite; " YOUNG},
    {"young: 260e9", "young: 1e999", ":6:10: material.young: 1e999: not finite; " YOUNG},
    {"young: 260e9", "young: 0", ":6:10: material.young: 0: out of range; " YOUNG},
    {"young: 260e9", "young:", ":6:3: material.young: no value; " YOUNG},
    {"0.21", "0.5", ":7:12: material.poisson: 0.5: out of range; allowed: number >= 0 and < 0.5\n"},
    {"mesh:\n", "mesh:\n  jitter: 0.31\n  seed: -1\n",
     ":2:11: mesh.jitter: 0.31: out of range; allowed: number >= 0 and <= 0.3\n"
     ":3:9: mesh.seed: -1: out of range; allowed: integer >= 0\n"},
    {"  end: 1e-6\n", "  end: 1e-6\n  safety: 0\n  steps: 0\n",
     ":17:11: time.safety: 0: out of range; allowed: number > 0 and <= 1\n"
     ":18:10: time.steps: 0: out of range; allowed: integer >= 1\n"},
    {"output:\n", "output:\n  interval: 0\n", ":18:13: output.interval: 0: out of range; " INTERVAL},
    {"output:\n", "output:\n  interval: 1.5\n", ":18:13: output.interval: 1.5: out of range; " INTERVAL},
    {"output:\n", "output:\n  interval: often\n", ":18:13: output.interval: often: not a number; " INTERVAL},
    /* words */
    {"neo-hookean", "neohookean",
     ":5:10: material.model: neohookean: not one of the allowed words; allowed: $MODELS; did you mean "
     "'neo-hookean'?\n"},
    {"linear", "lnear",
     ":10:8: interface.law: lnear: not one of the allowed words; allowed: $LAWS, none, user; did you mean "
     "'linear'?\n"},
    {"linear", "none", ":11:3: interface.strength: 400e6" UNUSED ":12:3: interface.energy: 34" UNUSED},
    {"  law: linear\n  strength: 400e6\n  energy: 34\n", "  law: none\n  contact: flux\n",
     ":11:3: interface.contact: flux" UNUSED},
    {"  law: linear\n", "  law: linear\n  form: intrinsic\n",
     ":10:8: interface.law: linear: does not start with a slope, which form intrinsic needs; "
     "allowed: " INTRINSIC},
    {"  law: linear\n", "  law: bilinear\n",
     ":10:8: interface.law: bilinear: starts with a slope, which only form intrinsic can use; "
     "allowed: with form variational or incomplete: $RIGID_LAWS, none, user\n"},
    {"  law: linear\n", "  law: exponential\n  form: intrinsic\n  contact: flux\n  penalty: elastic\n",
     ":12:12: interface.contact: flux: brings DG terms back, which form intrinsic does not have; "
     "allowed: with form intrinsic: penalty\n"
     ":13:3: interface.penalty: elastic" BY_FORM},
    {"  law: linear\n",
     "  law: polynomial\n  form: intrinsic\n  beta: 2\n  activation: total\n"
     "  bilinear: {ascent: 0.1}\n  polynomial: {alpha: -1}\n",
     ":12:3: interface.beta: 2: not used, because interface.law is polynomial\n"
     ":13:3: interface.activation: total" BY_FORM
     ":14:14: interface.bilinear.ascent: 0.1: not used, because interface.law is polynomial\n"
     ":15:23: interface.polynomial.alpha: -1: out of range; allowed: number >= 0 and <= 100\n"},
    /* of a form that is none nothing follows */
    {"  law: linear\n  strength: 400e6\n  energy: 34\n", "  law: none\n  form: 3\n  activation: total\n",
     ":11:9: interface.form: 3: not one of the allowed words; allowed: variational, incomplete, intrinsic, "
     "continuous\n"},
    {"  law: linear\n", "  law: linear\n  form: continuous\n  beta_s: 4\n",
     ":10:8: interface.law: linear: nothing can break, because form continuous has interfaces only on the "
     "faces that interface.faces selects; allowed: with form continuous and no interface.faces: none\n"
     ":12:3: interface.beta_s: 4" JOINED},
    {"  law: linear\n  strength: 400e6\n  energy: 34\n",
     "  law: none\n  form: continuous\n  penalty: elastic\n  strength: 1e9\n",
     ":12:3: interface.penalty: elastic" JOINED ":13:3: interface.strength: 1e9" UNUSED},
    {"  law: linear\n", "  law: exponential\n  form: continuous\n  faces: abs(z) < 1e-6\n",
     ":10:8: interface.law: exponential: starts with a slope, which only form intrinsic can use; "
     "allowed: with form continuous: $RIGID_LAWS, none, user\n"},
    {"  law: linear\n", "  law: linear\n  faces: abs(z) < 1e-6\n",
     ":11:3: interface.faces: abs(z) < 1e-6: not used, because interface.form is not continuous\n"},
    {"  law: linear\n", "  law: linear\n  form: continuous\n  faces: t\n",
     ":12:10: interface.faces: t: depends on t, but this is the state at the start; allowed: number or "
     "expression in "
     "x, y, z, nx, ny, nz\n"},
    /* of a wrong value nothing more is told than that it is wrong */
    {"  energy: 34\n", "  energy: 34\n  form: continuous\n  faces: 1\nmass: lumpy\n",
     ":15:7: mass: lumpy: not one of the allowed words; allowed: consistent, lumped, scaled; did you mean "
     "'lumped'?\n"},
    {"  energy: 34\n", "  energy: 34\n  form: continuous\n  faces: 1\nmass: consistent\n",
     ":15:7: mass: consistent: couples all nodes that elements share, so that each step would have to solve "
     "with it; allowed: with form continuous: lumped\n"},
    {"  energy: 34\n", "  energy: 34\n  contact: penalty\ncontact: {model: general}\n",
     ":14:18: contact.model: general: the contact of interfaces must fade where faces slide off each other; "
     "allowed: with interface.contact potential: general\n"},
    {"  energy: 34\n", "  energy: 34\ncontact: {model: general, friction: 0.3, static_friction: 0.2}\n",
     ":13:59: contact.static_friction: 0.2: faces at rest hold at least as well as sliding ones; allowed: "
     "number >= contact.friction\n"},
    {"  energy: 34\n",
     "  energy: 34\ncontact:\n  model: general\n  pairs:\n    - {between: [material, stel], friction: 0.3}\n"
     "    - {between: any, friction: 0}\n    - {between: [material], friction: 0.1}\n"
     "    - {between: [material, material], friction: 0.3, static_friction: 0.1}\n",
     ":16:28: contact.pairs[0].between: stel: no such material; allowed: names of two materials, or one "
     "twice: "
     "material\n"
     ":17:17: contact.pairs[1].between: any: wrong number of entries; allowed: names of two materials, or "
     "one twice: material\n"
     ":18:17: contact.pairs[2].between: [material]: wrong number of entries; allowed: names of two "
     "materials, "
     "or one twice: material\n"
     ":19:71: contact.pairs[3].static_friction: 0.1: faces at rest hold at least as well as sliding ones; "
     "allowed: number >= friction\n"},
    {"  energy: 34\n", "  energy: 34\ncontact: {penalty: 3, damping: 0.1}\n",
     ":13:11: contact.penalty: 3: not used, because contact.model is interfaces\n"
     ":13:23: contact.damping: 0.1: not used, because contact.model is interfaces\n"},
    {"  law: linear\n", "  law: linear\n  activation: continuous\n  onset: 0.2\n",
     ":12:3: interface.onset: 0.2: not used, because interface.activation is not conserving\n"},
    {"  law: linear\n", "  law: linear\n  activation: conserving\n  onset: 0\n  contact: flux\n",
     ":12:10: interface.onset: 0: out of range; allowed: number > 0 and <= 1\n"
     ":13:12: interface.contact: flux: brings DG terms back, whose energy activation conserving does not "
     "count; allowed: with activation conserving: penalty, potential\n"},
    {"  law: linear\n", "  law: exponential\n  form: incomplete\n  activation: conserving\n",
     ":10:8: interface.law: exponential: starts with a slope, which only form intrinsic can use; allowed: "
     "with "
     "form variational or incomplete: $RIGID_LAWS, none, user\n"
     ":12:15: interface.activation: conserving: counts the energy of the lift, which form variational "
     "alone has; allowed: with this form: continuous, total\n"
     ":12:15: interface.activation: conserving: needs a law that starts rigid, and interface.law is "
     "exponential; allowed: with activation conserving: $RIGID_LAWS\n"},
    {"  law: linear\n", "  law: exponential\n  form: intrinsic\n  onset: 0.2\n",
     ":12:3: interface.onset: 0.2" BY_FORM},
    {"  energy: 34\n", "  energy: 34\n  rise: {exponent: 0.1}\n  sets: [{where: z, rise: 0}]\n",
     ":13:10: interface.rise.exponent: 0.1: not used without interface.rise.rate\n"
     ":14:21: interface.sets[0].rise: 0: not used without interface.rise.rate\n"},
    {"  energy: 34\n", "  energy: 34\n  rise: {rate: 1e5, most: 0.5}\n",
     ":13:9: interface.rise.exponent: missing; allowed: number >= 0 and <= 1\n"
     ":13:27: interface.rise.most: 0.5: out of range; allowed: number >= 1\n"},
    {"  law: linear\n", "  law: free\n",
     ":12:3: interface.energy: 34: not used, because interface.law is free\n"},
    {"output:\n", "output:\n  dir: 12\n",
     ":18:8: output.dir: 12: not a text (put it in quotes to make it one); allowed: text\n"},
    {"output:\n", "output:\n  fields: [stres, crack, crack]\n",
     ":18:12: output.fields[0]: stres: not one of the allowed words; " FIELDS "; did you mean 'stress'?\n"
     ":18:26: output.fields[2]: crack: given twice; " FIELDS "\n"},
    {"output:\n", "output:\n  times: [5e-7, x, 1e-6]\n", /* of what is not read no order is asked */
     ":18:17: output.times[1]: x: not a number; allowed: number >= 0 (s)\n"},
    {"output:\n", "output:\n  fields: [displacement, damage]\n",
     ":18:11: output.fields: damage: material.model has no such field\n"},
    {"output:\n", "output:\n  fields: [damage, crack, crack]\n", /* such a list is not looked at further */
     ":18:27: output.fields[2]: crack: given twice; " FIELDS "\n"},
    {"output:\n", "output:\n  fields: [crack, regime, damage]\n",
     ":18:11: output.fields: damage: material.model has no such field\n"
     ":18:11: output.fields: regime: material.model has no such field\n"},
    {"  poisson: 0.21\n", "  poisson: 0.21\n  shear: 146e9\n  friction: -1\n",
     ":8:3: material.shear: 146e9: not used, because material.model is neo-hookean; it belongs to "
     "anisotropic, "
     "deshpande-evans\n:9:3: material.friction: -1" CERAMIC},
    {"output:\n", "output:\n  fields: crack\n", ":18:11: output.fields: crack: not a list; " FIELDS "\n"},
    {"mesh:\n", "mesh:\n  file: a.msh\n",
     ":2:9: mesh.file: a.msh: cannot be read: No such file or directory; "
     "allowed: path of a mesh file, relative to the case file\n"
     ":3:3: mesh.cells: [2, 2, 4]: cannot be given together with mesh.file\n"
     ":4:3: mesh.size: [1e-3, 1e-3, 2e-3]: cannot be given together with mesh.file\n"},
    /* materials, and faces between them */
    {"  density: 3690\n",
     "  density: 3690\n"
     "  name: a b\n"
     "materials:\n"
     "  - {name: s, set: top, model: neo-hookean, young: 2e11, poisson: 0.3, density: 7800, friction: 1}\n"
     "  - {name: s, where: z > t, model: neo-hookean, young: -1, poisson: 0.3, density: 7800}\n"
     "  - {name: g, set: top, where: 1, model: neo-hookean, young: 2e9, poisson: 0.3, density: 1200}\n"
     "  - {name: t, model: neo-hookean, young: 5e10, poisson: 0.3, densty: 7000}\n"
     "  - 3\n",
     ":9:9: material.name: a b: not a name; " MATERIAL_NAMES
     ":11:15: materials[0].set: top: a mesh file has volume sets, the built-in box has none; say where\n"
     ":11:87: materials[0].friction: 1: not used, because materials[0].model is neo-hookean; it belongs to "
     "deshpande-evans\n"
     ":12:12: materials[1].name: s: the name of an earlier material; " MATERIAL_NAMES
     ":12:22: materials[1].where: z > t: depends on t, but this is the state at the start; allowed: number "
     "or "
     "expression in x, y, z\n"
     ":12:56: materials[1].young: -1: out of range; " YOUNG
     ":13:15: materials[2]: set and where both given; allowed: exactly one of set, where\n"
     ":14:5: materials[3].density: missing; allowed: number > 0 (kg/m3)\n"
     ":14:5: materials[3]: missing set or where; allowed: exactly one of set, where\n"
     ":14:62: materials[3].densty: unknown key; did you mean 'density'?\n"
     ":15:5: materials[4]: 3: not a mapping of keys; allowed: list of {name, set, where, file, and the keys "
     "of "
     "material}\n"},
    {"interface:\n",
     "materials: [{name: steel, where: 1, model: neo-hookean, young: 2e11, poisson: 0.3, density: 7800}]\n"
     "interface:\n"
     "  sets:\n"
     "    - {strength: 1}\n"
     "    - {between: [material, stel]}\n"
     "    - {between: [steel]}\n"
     "    - {between: steel}\n"
     "    - {between: [stel, steel, glue]}\n",
     ":12:7: interface.sets[0]: missing set, where or between; allowed: set, where, between, or several of "
     "them\n"
     ":13:28: interface.sets[1].between: stel: no such material; " PAIR "; did you mean 'steel'?\n"
     ":14:17: interface.sets[2].between: [steel]: wrong number of entries; " PAIR "\n"
     ":15:17: interface.sets[3].between: steel: not a list; allowed: list of texts\n"
     ":16:17: interface.sets[4].between: [stel, steel, glue]: wrong number of entries; " PAIR "\n"},
    /* bodies */
    {"time:\n",
     "bodies:\n"
     "  - {name: a b, shape: sphere, motion: free, at: [0, 0, 3e-3]}\n"
     "  - {name: w, shape: plane, motion: free, at: [0, 0, 3e-3], radius: 1, normal: [0, 0, 0], density: 2, "
     "velocity: {z: t}}\n"
     "  - {name: w, shape: cylinder, motion: prescribed, at: [0, 0, 3e-3], radius: 1e-3, mass: 1, normal: "
     "[0, 0, 1], velocity: {x: x}}\n"
     "  - {name: c, shape: cylinder, motion: prescribed, at: [0, 0, 3e-3], radius: 1e-3, mass: 1, normal: "
     "[0, 0, 1]}\n"
     "  - {name: q, shape: sphere, motion: free, at: [0, 0, 3e-3], radius: -1e-3, mass: 1, density: 3}\n"
     "  - {name: r, shape: sphere, motion: free, at: [0, 0, 3e-3], radius: 1e-3, mass: 1, density: 3, faces: "
     "[top], penalty: 0}\n"
     "  - {name: s, shape: sphere, motion: free, at: [0, 0, 3e-3], radius: 1e-3, mass: 1, density: 3, faces: "
     "z+}\n"
     "  - {name: t, shape: sphere, motion: free, at: [0, 0, 3e-3], radius: 1e-3, mass: 1, density: 3, faces: "
     "[]}\n"
     "  - {name: u, shape: ball, motion: loose, colour: red}\n"
     "  - 3\n"
     "time:\n",
     ":16:5: bodies[0].radius: missing: spheres and cylinders have one\n"
     ":16:5: bodies[0].mass: missing: a free body has a mass, or a sphere or cylinder a density\n"
     ":16:12: bodies[0].name: a b: not a name; allowed: letters, digits, _ and -; unique in history.csv\n"
     ":17:61: bodies[1].radius: not used: a plane has none\n"
     ":17:80: bodies[1].normal: [0, 0, 0]: has no direction\n"
     ":17:91: bodies[1].density: not used: only a sphere or a cylinder has a volume; give its mass\n"
     ":17:113: bodies[1].velocity.z: t: depends on t, but a free body has it at the start alone\n"
     ":18:12: bodies[2].name: w: the name of an earlier one in history.csv; allowed: letters, digits, _ and "
     "-; "
     "unique in history.csv\n"
     ":18:126: bodies[2].velocity.x: x: depends on x, y or z, but this is the same everywhere; allowed: "
     "number or expression in t (m/s)\n"
     ":19:5: bodies[3].axis: missing: it belongs to a cylinder\n"
     ":19:84: bodies[3].mass: not used: the motion is prescribed\n"
     ":19:93: bodies[3].normal: not used: it belongs to a plane\n"
     ":20:70: bodies[4].radius: -1e-3: out of range; allowed: number > 0 (m)\n"
     ":21:105: bodies[5].faces[0]: top: not one of the allowed words; allowed: x-, x+, y-, y+, z-, z+\n"
     ":21:120: bodies[5].penalty: 0: out of range; allowed: number > 0\n"
     ":22:104: bodies[6].faces: z+: not a list; allowed: list from x-, x+, y-, y+, z-, z+\n"
     ":23:104: bodies[7].faces: []: an empty list; allowed: list from x-, x+, y-, y+, z-, z+\n"
     ":24:5: bodies[8].at: missing; allowed: [x, y, z], each number (m)\n"
     ":24:22: bodies[8].shape: ball: not one of the allowed words; allowed: sphere, plane, cylinder, none\n"
     ":24:36: bodies[8].motion: loose: not one of the allowed words; allowed: free, prescribed\n"
     ":24:43: bodies[8].colour: unknown key; allowed: name, shape, motion, at, radius, normal, axis, "
     "density, length, mass, inertia, velocity, spin, faces, tied, tied_where, tied_from, "
     "tied_until, penalty\n"
     ":25:5: bodies[9]: 3: not a mapping of keys; allowed: list of {name, shape, motion, at, radius, normal, "
     "axis, density, length, mass, inertia, velocity, spin, faces, tied, tied_where, tied_from, "
     "tied_until, penalty}\n"},
    {"output:\n", "output:\n  times: [1e-7, 1e-7]\n",
     ":18:10: output.times: [1e-7, 1e-7]: not ascending; allowed: ascending list, each number >= 0 (s)\n"},
    {"output:\n", "output:\n  times: [1e-7, 2e-6]\n",
     ":18:17: output.times: 2e-6: after time.end, 1e-06 s\n"},
    {"output:\n", "output:\n  times: []\n",
     ":18:10: output.times: []: an empty list; allowed: ascending list, each number >= 0 (s)\n"},
    /* boundary */
    {"set: z+", "set: z",
     ":14:11: boundary[0].set: z: not one of the allowed words; " SETS "; did you mean 'z-'?\n"},
    {"set: z+", "set: top", ":14:11: boundary[0].set: top: not one of the allowed words; " SETS "\n"},
    {"component: z", "component: w",
     ":14:26: boundary[0].component: w: not one of the allowed words; allowed: x, y, z\n"},
    {", velocity: 6.086", "",
     ":14:5: boundary[0]: missing " MOTIONS(" or ") " or absorbing or dashpot; " ONE_OF},
    {"velocity: 6.086", "velocity: 6.086, displacement: 1",
     ":14:46: boundary[0]: velocity and displacement both given; " ONE_OF},
    {"time:\n", "  - {set: z+, component: z, displacement: 0}\ntime:\n",
     ":15:5: boundary[1]: set z+ component z is prescribed twice, first at line 14 column 5\n"},
    {"  - {set: z+, component: z, velocity: 6.086}", "  set: z+",
     ":14:3: boundary: {set: z+}: not a list; " ENTRIES},
    {"  - {set: z+, component: z, velocity: 6.086}", "  - 3",
     ":14:5: boundary[0]: 3: not a mapping of keys; " ENTRIES},
    /* expressions */
    {"velocity: 6.086", "velocity: 6.0*sinn(t)",
     ":14:39: boundary[0].velocity: 6.0*sinn(t): Unexpected token \"sinn\" found at position 4.; " MOTION},
    {"velocity: 6.086", "velocity: 'x, y'",
     ":14:39: boundary[0].velocity: \"x, y\": 2 values where one is needed; " MOTION},
    {"velocity: 6.086", "velocity: 1/0", ":14:39: boundary[0].velocity: 1/0: not finite; " MOTION},
    {"velocity: 6.086", "velocity: .nan", ":14:39: boundary[0].velocity: .nan: not finite; " MOTION},
    {"velocity: 6.086", "velocity: x=3",
     ":14:39: boundary[0].velocity: x=3: an assignment is not an expression; " MOTION},
    {"velocity: 6.086", "velocity: [1]",
     ":14:39: boundary[0].velocity: [1]: not a number or expression; " MOTION},
    {"mesh:\n", "initial: {velocity: {z: 2*t}}\nmesh:\n",
     ":1:25: initial.velocity.z: 2*t: depends on t, but this is the state at the start; "
     "allowed: number or expression in x, y, z (m/s)\n"},
    /* probes */
    {"name: p", "name: p mm", ":19:14: output.probes[0].name: p mm: not a name; " NAMES},
    {"1e-3]}", "2.1e-3]}",
     ":19:28: output.probes[0].at[2]: 2.1e-3: outside the box; allowed: number >= 0 and <= 0.002 (m)\n"},
    {"1e-3]}\n", "1e-3]}\n    - {name: p, at: [0, 0]}\n",
     ":20:14: output.probes[1].name: p: the name of an earlier one in history.csv; " NAMES
     ":20:21: output.probes[1].at: [0, 0]: wrong number of entries; allowed: [x, y, z], each number (m)\n"},
    /* YAML */
    {"mesh:\n", "mesh:\n\tjitter: 0\n",
     ":2:1: not valid YAML: tab character may not be used as indentation\n"},
    {"[2, 2, 4]", "[2, 2, 4", ":4:1: not valid YAML: wrongly indented flow sequence\n"},
    {"  cells", "cells", ":3:3: not valid YAML: invalid indentation in mapping\n"},
    {"mesh:\n", "mesh: &a\n", ":2:3" SPECIAL},
    {"260e9", "*a", ":6:10" SPECIAL},
    {"mesh:\n", "q: *a\nmesh:\n", ":1:1: q: unknown key; " BLOCKS "\n:1:4" SPECIAL},
    {"time:\n", "  - {set: *a, component: z, velocity: 0}\n  - {set: z-, component: z, velocity: 0}\ntime:\n",
     ":15:11" SPECIAL},
    {"260e9", "\x01", ":6:10: byte 0x01 is not text (UTF-8)\n"},
    {"260e9", "\xff", ":6:10: byte 0xff is not text (UTF-8)\n"},
    {"260e9", "\"a\\0b\"", ":6:10: a text cannot hold the character NUL\n"},
    {"mesh:\n", "? [a]\n: 3\nmesh:\n", ":1:3: a key must be a single word\n"},
    {NULL, "@a\n", ":1:1: not valid YAML: plain scalar cannot start with '@'\n"}, /* and not empty either */
    {NULL, "", ":1:1: the file is empty\n"},
    {NULL, "# nothing\n", ":1:1: the file is empty\n"},
    {NULL, "- 1\n", ":1:1: [1]: a case is a mapping of keys\n"},
    {NULL, "a: 1\n---\nb: 1\n", ":3:1: a second YAML document; a case is one document\n"},
};

static void test_mistakes(void **state) {
    (void)state;
    expect_mistakes(mistakes, sizeof mistakes / sizeof *mistakes);
}

/* An embedded NUL must not hide what follows it. */
static void test_nul_byte(void **state) {
    (void)state;
    write_bytes("a: 1\0\nb: 2\n", 11);
    expect_messages(0, NULL, ":1:5: byte 0x00 is not text (UTF-8)\n");
}

static void test_deep_nesting(void **state) {
    (void)state;
    static char text[20001];
    memset(text, '[', 20000);
    write_bytes(text, 20000);
    expect_messages(0, NULL, ":1:33: nested too deeply\n");
}

static void test_override_mistakes(void **state) {
    (void)state;
    static const struct {
        const char *set, *message;
    } wrong[] = {
        {"foo", "expected --set section.key=value"},
        {"=3", "expected --set section.key=value"},
        {"mesh.=3", "expected --set section.key=value"},
        {"mesh.jiter=0.1", "mesh.jiter: unknown key; did you mean 'mesh.jitter'?"},
        {"mesh.jitter=0.5", "mesh.jitter: 0.5: out of range; allowed: number >= 0 and <= 0.3"},
        {"mesh.jitter='0'",
         "mesh.jitter: \"0\": a text (in quotes), not a number; allowed: number >= 0 and <= 0.3"},
        {"time.end=", "no value behind the '='"},
        {"time.end=[1", "not valid YAML: flow sequence without a closing bracket"},
        {"boundary.0=3", "boundary.0: cannot be set: what it belongs to is not a mapping of keys"},
        {"time={safety: 1}", "time.end: missing; allowed: number > 0 (s)"},
    };
    write_bytes(base, strlen(base));
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        char expected[256];
        snprintf(expected, sizeof expected, "--set %s: %s\n", wrong[i].set, wrong[i].message);
        expect_messages(1, &wrong[i].set, expected);
    }
    static const char *const twice[] = {"time.end=1e-6", "time.end=2e-6"};
    expect_messages(2, twice, "--set time.end=2e-6: time.end: set twice\n");
}

#ifdef RG_SINGLE

static void test_ceramic(void **state) {
    (void)state;
    write_changed(elastic, ceramic);
    expect_messages(
        0, NULL,
        ":5:10: material.model: deshpande-evans: needs double precision, and this program is built "
        "with -Dprecision=single\n");
    write_changed(elastic, metal);
    expect_messages(0, NULL,
                    ":5:10: material.model: j2: needs double precision, and this program is built with "
                    "-Dprecision=single\n");
}

#else

/* Everything that can be wrong with one at once. */
static void test_ceramic(void **state) {
    (void)state;
    write_changed(
        "material:\n  model: neo-hookean\n",
        "material:\n  model: deshpande-evans\n  shear: 0\n  flaw_radius: -1\n  alpha: 1.5\n  beta: 0\n"
        "  gamma: 0\n  friction: -1\n  growth_speed: 0\n  growth_exponent: 0\n  interaction: pi\n"
        "  damage_max: 1\n  yield_strain: 0\n  hardening_exponent: 2\n  plastic_rate: 0\n"
        "  transition_rate: 0\n  rate_exponent: 0.5\n");
    expect_messages(
        0, NULL,
        ":5:3: material.flaw_density: missing; allowed: number > 0 (1/m3)\n"
        ":5:3: material.toughness: missing; allowed: number > 0 (Pa sqrt(m))\n"
        ":5:3: material.yield_stress: missing; " YOUNG ":6:10: material.shear: 0: out of range; " YOUNG
        ":7:16: material.flaw_radius: -1: out of range; allowed: number > 0 (m)\n"
        ":8:10: material.alpha: 1.5: out of range; allowed: number > 0 and <= 1\n"
        ":9:9: material.beta: 0: out of range; allowed: number > 0\n"
        ":10:10: material.gamma: 0: out of range; allowed: number > 0\n"
        ":11:13: material.friction: -1: out of range; allowed: number >= 0\n"
        ":12:17: material.growth_speed: 0: out of range; allowed: number > 0 (m/s)\n"
        ":13:20: material.growth_exponent: 0: out of range; allowed: number > 0\n"
        ":14:16: material.interaction: pi: not one of the allowed words; allowed: thesis, derived\n"
        ":15:15: material.damage_max: 1: out of range; allowed: number > 0 and < 1\n"
        ":16:17: material.yield_strain: 0: out of range; allowed: number > 0\n"
        ":17:23: material.hardening_exponent: 2: out of range; allowed: number >= 0 and <= 1\n"
        ":18:17: material.plastic_rate: 0: out of range; allowed: number > 0 (1/s)\n"
        ":19:20: material.transition_rate: 0: out of range; allowed: number > 0 (1/s)\n"
        ":20:18: material.rate_exponent: 0.5: out of range; allowed: number >= 1\n"
        ":21:3: material.young: 260e9: not used, because material.model is deshpande-evans; it "
        "belongs to $ELASTIC_MODELS\n");
    write_changed(elastic, ceramic);
    static const char *const many[] = {"material.flaw_density=1e15"};
    expect_messages(
        1, many,
        "--set material.flaw_density=1e15: material.flaw_density: 1e15: the damage to begin with, "
        "4/3 pi (alpha flaw_radius)^3 flaw_density, is 10.16: not below damage_max, 0.999\n");
}

static void test_metal(void **state) {
    (void)state;
    write_changed("material:\n  model: neo-hookean\n",
                  "material:\n  model: j2\n  hardening: -1\n  saturation_stress: x\n  saturation_rate: -2\n");
    expect_messages(0, NULL,
                    ":5:3: material.yield_stress: missing; " YOUNG
                    ":6:14: material.hardening: -1: out of range; allowed: number >= 0 (Pa)\n"
                    ":7:22: material.saturation_stress: x: not a number; allowed: number >= 0 (Pa)\n"
                    ":8:20: material.saturation_rate: -2: out of range; allowed: number >= 0\n");
    write_changed(elastic, metal);
    static const char *const alone[] = {"material.saturation_rate=7"}, *const other[] = {
                                                                           "material.saturation_stress=4e8"};
    expect_messages(1, alone,
                    "--set material.saturation_rate=7: material.saturation_rate: not used without "
                    "material.saturation_stress\n");
    expect_messages(1, other,
                    "--set material.saturation_stress=4e8: material.saturation_stress: not used without "
                    "material.saturation_rate\n");
    static const char *const zero[] = {"material.saturation_rate=0", "material.saturation_stress=4e8"};
    expect_messages(2, zero,
                    "--set material.saturation_stress=4e8: material.saturation_stress: not used without "
                    "material.saturation_rate\n");
    static const char *const low[] = {"material.saturation_stress=1e8", "material.saturation_rate=7"};
    expect_messages(2, low,
                    "--set material.saturation_stress=1e8: material.saturation_stress: 1e8: below "
                    "material.yield_stress, 2e+08 Pa\n");
    static const char *const flaws[] = {"material.friction=1"};
    expect_messages(
        1, flaws,
        "--set material.friction=1: material.friction: 1: not used, because material.model is j2; it "
        "belongs to deshpande-evans\n");
}

/* Parameters that go together, above or below each other, and shares. */
static void test_laws_of_flow(void **state) {
    (void)state;
    write_changed(elastic, "material:\n  model: johnson-cook\n  young: 200e9\n  yield_stress: 8e8\n  "
                           "hardening_power: 0.3\n  reference_rate: 1\n");
    static const char *const soft[] = {"material.softening_power=1", "material.heat_capacity=400"};
    expect_messages(2, soft,
                    "--set material.softening_power=1: material.softening_power: not used without "
                    "material.melting_temperature\n"
                    "--set material.heat_capacity=400: material.heat_capacity: not used without "
                    "material.heat_fraction\n");
    static const char *const cold[] = {"material.softening_power=1", "material.melting_temperature=300",
                                       "material.room_temperature=300", "material.heat_capacity=400",
                                       "material.heat_fraction=1.1"};
    expect_messages(5, cold,
                    "--set material.melting_temperature=300: material.melting_temperature: 300: not above "
                    "material.room_temperature, 300\n"
                    "--set material.heat_fraction=1.1: material.heat_fraction: 1.1: more than 1\n");
    write_changed(elastic, "material:\n  preset: float-glass-jh2\n");
    static const char *const crushed[] = {"material.hugoniot_pressure=6e9", "material.bulking=2",
                                          "material.bulk_2=-1e9"};
    expect_messages(3, crushed,
                    ":5:11: material.hugoniot_limit: 5.95e9: not above material.hugoniot_pressure, 6e+09\n"
                    "--set material.bulking=2: material.bulking: 2: more than 1\n");
#define OGDEN "material={model: ogden, density: 1100, bulk: 2e9"
    static const char *const rubber[] = {OGDEN ", alpha_1: 2, mu_1: -1e6}"};
    static const char *const signs[] = {OGDEN ", alpha_1: -2, mu_1: -1e6, alpha_2: -2, mu_2: 1e6}"};
    static const char *const none[] = {OGDEN "}"};
    expect_messages(1, rubber,
                    "--set " OGDEN ", alpha_1: 2, mu_1: -1e6}: material.mu_1: not a number of the sign of "
                    "material.alpha_1, neither 0\n");
    expect_messages(1, signs,
                    "--set " OGDEN ", alpha_1: -2, mu_1: -1e6, alpha_2: -2, mu_2: 1e6}: material.mu_2: not a "
                    "number of the sign of material.alpha_2, neither 0\n");
    expect_messages(1, none,
                    "--set " OGDEN "}: material.mu_1: missing, and material.mu_2 and material.mu_3 too\n");
    write_changed(elastic, "material:\n  preset: berea-sandstone\n");
    static const char *const rock[] = {"material.dilation_angle=40", "material.compaction=1",
                                       "material.cap_pressure=18e6"};
    expect_messages(
        3, rock,
        "--set material.compaction=1: material.compaction: 1: more than 0.99\n"
        "--set material.dilation_angle=40: material.dilation_angle: 40: above material.friction_angle, 37\n"
        "--set material.cap_pressure=18e6: material.cap_pressure: 18e6: the cap would begin under tension: "
        "not above cap_ratio times the strength without pressure, 1.84824e+07 Pa\n");
    static const char *const bare[] = {"material.cap_pressure=0", "material.friction_angle=90"};
    expect_messages(2, bare,
                    ":5:11: material.cap_ratio: not used without material.cap_pressure\n"
                    ":5:11: material.compaction: not used without material.cap_pressure\n"
                    ":5:11: material.compaction_pressure: not used without material.cap_pressure\n"
                    "--set material.friction_angle=90: material.friction_angle: 90: more than 89\n");
    write_changed(elastic, "material:\n  preset: concrete-hjc\n");
    static const char *const flat[] = {"material.lock_pressure=10e6"},
                             *const yielding[] = {"material.bulk_1=1e10"},
                             *const stiff[] = {"material.lock_strain=1e-4"},
                             *const beyond[] = {"material.bulk_2=-3e12"};
    expect_messages(1, flat,
                    "--set material.lock_pressure=10e6: material.lock_pressure: 10e6: not above "
                    "material.crush_pressure, 1.6e+07\n");
    expect_messages(
        1, yielding,
        "--set material.bulk_1=1e10: material.bulk_1: 1e10: below the bulk modulus of the elastic "
        "solid, 1.9564e+10 Pa\n");
    expect_messages(1, stiff,
                    "--set material.lock_strain=1e-4: material.lock_strain: 1e-4: too small: the way from "
                    "crush_pressure to lock_pressure would be stiffer than the elastic solid\n");
    expect_messages(
        1, beyond,
        ":5:11: material.lock_pressure: 0.8e9: bulk_1, bulk_2 and bulk_3 do not come to it before "
        "the dense solid is pressed to half\n");
    write_changed(elastic, "material:\n  preset: pmma-viscoelastic\n");
    static const char *const relaxed[] = {"material.shear_fraction_3=0.8", "material.bulk_fraction_1=0.1",
                                          "material.relaxation_time_1=0"};
    expect_messages(
        3, relaxed,
        ":5:11: material.shear_fraction_1: not used without material.relaxation_time_1\n"
        "--set material.shear_fraction_3=0.8: material.shear_fraction_3: 0.8: the shares that relax "
        "come to 1.1: not below 1\n"
        "--set material.bulk_fraction_1=0.1: material.bulk_fraction_1: not used without "
        "material.relaxation_time_1\n");
}

#endif

/* One run shows all problems, in the order of the file, those of overrides last. */
static void test_all_at_once(void **state) {
    (void)state;
    static const char *const set[] = {"time.end=-1", "mass=heavy"};
    write_changed(NULL, "output: {energy_limit: 0, intervall: 3}\n"
                        "mesh:\n  cells: [2, x, 4]\n  size: [1e-3, 1e-3]\n"
                        "material: {model: neo-hookean, young: 1, poisson: 0.7}\n"
                        "interface:\n  law: linear\n  energy: 0\n");
    expect_messages(
        2, set,
        ":1:24: output.energy_limit: 0: out of range; allowed: number > 0\n"
        ":1:27: output.intervall: unknown key; did you mean 'output.interval'?\n"
        ":3:14: mesh.cells[1]: x: not a number; " CELL
        ":4:9: mesh.size: [1e-3, 1e-3]: wrong number of entries; " SIZE
        ":5:11: material.density: missing; allowed: number > 0 (kg/m3)\n"
        ":5:51: material.poisson: 0.7: out of range; allowed: number >= 0 and < 0.5\n"
        ":7:3: interface.strength: missing; " STRENGTH
        ":8:11: interface.energy: 0: out of range; allowed: number > 0, or expression in x, y, z, nx, ny, nz "
        "(J/m2)\n"
        "--set mass=heavy: mass: heavy: not one of the allowed words; allowed: consistent, lumped, scaled\n"
        "--set time.end=-1: time.end: -1: out of range; allowed: number > 0 (s)\n");
}

static void test_unreadable(void **state) {
    (void)state;
    static const char *const file[] = {"/nonexistent/a.yaml", "/tmp"};
    static const char *const expected[] = {"/nonexistent/a.yaml: cannot be read: No such file or directory\n",
                                           "/tmp: cannot be read: Is a directory\n"};
    for (int i = 0; i < 2; i++) {
        char *messages = NULL;
        rg_case *c = read_case(file[i], 0, NULL, &messages);
        assert_string_equal(messages, expected[i]);
        assert_null(c);
        free(messages);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_mistakes),     cmocka_unit_test(test_nul_byte),
        cmocka_unit_test(test_deep_nesting), cmocka_unit_test(test_override_mistakes),
#ifndef RG_SINGLE
        cmocka_unit_test(test_metal),        cmocka_unit_test(test_laws_of_flow),
#endif
        cmocka_unit_test(test_ceramic),      cmocka_unit_test(test_all_at_once),
        cmocka_unit_test(test_unreadable),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
