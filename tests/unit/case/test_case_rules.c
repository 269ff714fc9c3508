/* Rules that tie several keys of a case together, each of them broken. */
#include "case/read.h"
#include "support/case_input.h"

static const mistake bodies[] = {
    {"time:\n",
     "bodies:\n"
     "  - {name: a, shape: plane, motion: free, at: [0, 0, 9], axis: [0, 0, 1], mass: 1}\n"
     "  - {name: b, shape: sphere, motion: prescribed, at: [0, 0, 9], radius: 1, density: 2}\n"
     "  - {name: c, shape: sphere, motion: prescribed, at: [0, 0, 9], radius: 1, mass: 2, density: 2}\n"
     "  - {name: d, shape: cylinder, motion: free, at: [0, 0, 9], radius: 1, axis: [0, 0, 0], mass: 2, "
     "density: 3}\n"
     "  - {name: e, shape: sphere, motion: free, at: [0, 0, 9], radius: 1, mass: 2, density: 3, normal: [1, "
     "0, 0]}\n"
     "  - {name: f, shape: plane, motion: free, at: [0, 0, 9], normal: [0, 0, 0.0]}\n"
     "  - {name: g, shape: cylinder, motion: free, at: [0, 0, 9], axis: [1, 0, 0], velocity: {x: t, y: 3, z: "
     "1 + t}}\n"
     "  - {shape: sphere, motion: free, at: [0, 0, 9], radius: 1}\n"
     "  - {name: h, shape: sphere, motion: free, at: [0, 0, 9], radius: 1, mass: 1, velocity: {x: y, y: z, "
     "z: nx}}\n"
     "  - {name: f, shape: sphere, motion: free, at: [0, 0, 9], radius: 1, mass: 1, velocity: 3, faces: [z+, "
     "7, z]}\n"
     "  - {name: p, shape: [sphere], motion: {a: 1}, at: 3, faces: [[1]]}\n"
     "time:\n",
     ":16:5: bodies[0].normal: missing: it belongs to a plane\n"
     ":16:58: bodies[0].axis: not used: it belongs to a cylinder\n"
     ":17:76: bodies[1].density: not used: the motion is prescribed\n"
     ":18:76: bodies[2].mass: not used: the motion is prescribed\n"
     ":18:85: bodies[2].density: not used: the motion is prescribed\n"
     ":19:78: bodies[3].axis: [0, 0, 0]: has no direction\n"
     ":19:98: bodies[3].density: not used: only a cylinder of a length has a volume; give that, or its mass\n"
     ":20:70: bodies[4].mass: given together with density\n"
     ":20:91: bodies[4].normal: not used: it belongs to a plane\n"
     ":21:5: bodies[5].mass: missing: a free body has a mass\n"
     ":21:66: bodies[5].normal: [0, 0, 0.0]: has no direction\n"
     ":22:5: bodies[6].radius: missing: spheres and cylinders have one\n"
     ":22:5: bodies[6].mass: missing: a free body has a mass, or a sphere or cylinder a density\n"
     ":22:88: bodies[6].velocity.x: t: depends on t, but a free body has it at the start alone\n"
     ":22:88: bodies[6].velocity.z: 1 + t: depends on t, but a free body has it at the start alone\n"
     ":23:5: bodies[7].name: missing; allowed: text\n"
     ":24:93: bodies[8].velocity.x: y: depends on x, y or z, but this is the same everywhere; allowed: "
     "number or expression in t (m/s)\n"
     ":24:99: bodies[8].velocity.y: z: depends on x, y or z, but this is the same everywhere; allowed: "
     "number or expression in t (m/s)\n"
     ":24:105: bodies[8].velocity.z: nx: depends on a normal, which only faces have; allowed: number or "
     "expression in t (m/s)\n"
     ":25:12: bodies[9].name: f: the name of an earlier one in history.csv; allowed: letters, digits, _ and "
     "-; "
     "unique in history.csv\n"
     ":25:89: bodies[9].velocity: 3: not a mapping of keys\n"
     ":25:104: bodies[9].faces[1]: 7: not one of the allowed words; allowed: x-, x+, y-, y+, z-, z+\n"
     ":25:107: bodies[9].faces[2]: z: not one of the allowed words; allowed: x-, x+, y-, y+, z-, z+; did you "
     "mean 'z-'?\n"
     ":26:22: bodies[10].shape: [sphere]: not one of the allowed words; allowed: sphere, plane, cylinder, "
     "none\n"
     ":26:40: bodies[10].motion: {a: 1}: not one of the allowed words; allowed: free, prescribed\n"
     ":26:52: bodies[10].at: 3: not a list; allowed: [x, y, z], each number (m)\n"
     ":26:63: bodies[10].faces[0]: [1]: not one of the allowed words; allowed: x-, x+, y-, y+, z-, z+\n"
     ":31:14: output.probes[0].name: p: the name of an earlier one in history.csv; allowed: letters, digits, "
     "_ "
     "and -; unique in history.csv\n"},
    /* that turn, and what is tied to them */
    {"time:\n",
     "bodies:\n"
     "  - {name: a, shape: none, motion: free, at: [0, 0, 9], mass: 1, radius: 1, faces: [z+]}\n"
     "  - {name: b, shape: none, motion: free, at: [0, 0, 9], mass: 1, tied: [z+, top]}\n"
     "  - {name: c, shape: none, motion: free, at: [0, 0, 9], mass: 1, tied: [z+], spin: {x: 1}}\n"
     "  - {name: d, shape: sphere, motion: free, at: [0, 0, 9], radius: 1, density: 2, inertia: [1, 1, 1, 0, "
     "0, 0]}\n"
     "  - {name: e, shape: plane, motion: prescribed, at: [0, 0, 9], normal: [0, 0, 1], inertia: [1, 1, 1, "
     "0, 0, 0]}\n"
     "  - {name: f, shape: plane, motion: free, at: [0, 0, 9], normal: [0, 0, 1], mass: 1, inertia: [1, 1, "
     "2.1, 0, 0, 0]}\n"
     "  - {name: g, shape: plane, motion: free, at: [0, 0, 9], normal: [0, 0, 1], mass: 1, inertia: [1, 1, "
     "1, 1, 0, 0], spin: {y: 'sin(t)'}}\n"
     "  - {name: h, shape: cylinder, motion: free, at: [0, 0, 9], axis: [0, 0, 1], radius: 1, mass: 2, "
     "length: 1}\n"
     "time:\n",
     ":16:5: bodies[0].tied: missing: a body that touches nothing has no other use\n"
     ":16:66: bodies[0].radius: not used: it belongs to spheres and cylinders\n"
     ":16:77: bodies[0].faces: not used: it touches nothing\n"
     ":17:77: bodies[1].tied[1]: top: not one of the allowed words; allowed: x-, x+, y-, y+, z-, z+\n"
     ":18:66: bodies[2].tied: makes a free body turn, which needs its inertia, or a density\n"
     ":18:78: bodies[2].spin: makes a free body turn, which needs its inertia, or a density\n"
     ":19:82: bodies[3].inertia: given together with density\n"
     ":20:83: bodies[4].inertia: not used: the motion is prescribed\n"
     ":21:95: bodies[5].inertia: [1, 1, 2.1, 0, 0, 0]: no body has such an inertia; allowed: principal "
     "moments > 0, none "
     "larger than the sum of the others\n"
     ":22:95: bodies[6].inertia: [1, 1, 1, 1, 0, 0]: no body has such an inertia; allowed: principal moments "
     "> 0, none "
     "larger than the sum of the others\n"
     ":22:121: bodies[6].spin.y: sin(t): depends on t, but a free body has it at the start alone\n"
     ":23:98: bodies[7].length: not used: it belongs to a cylinder with a density\n"},
};

#define LOAD "allowed: exactly one of traction, pressure, force, acceleration, foundation, centrifugal\n"

static const mistake loads[] = {
    {"time:\n",
     "loads:\n"
     "  - {name: p, set: z+, pressure: 1}\n"
     "  - {name: p, set: z+, pressure: 1, traction: {x: 1}}\n"
     "  - {set: z+, where: 'nx > 0', force: {x: 1}, acceleration: {x: 1}}\n"
     "  - {set: z+}\n"
     "  - {set: z+, acceleration: {x: 1}}\n"
     "  - {where: nx > 0, acceleration: {x: 1}}\n"
     "  - {pressure: 1}\n"
     "  - {set: z+, where: 'x > 0', pressure: 1}\n"
     "  - {set: z+, force: {x: x}, from: 2, until: 1}\n"
     "  - {set: z+, force: {x: t}, from: 2, until: 2}\n"
     "  - {set: top, pressure: 'nx', until: 0}\n"
     "  - {set: z+, traction: 3}\n"
     "  - 3\n"
     "  - {set: z+, centrifugal: {speed: x, axis: [0, 0, 1]}}\n"
     "  - {set: z+, centrifugal: {speed: 1, axis: [0, 0, 0]}}\n"
     "  - {centrifugal: {speed: 1}}\n"
     "  - {centrifugal: {axis: [0, 0, 1]}, until: 1}\n"
     "time:\n",
     ":17:12: loads[1].name: p: the name of an earlier one in history.csv; allowed: letters, digits, _ and "
     "-; "
     "unique in history.csv\n"
     ":17:24: loads[1]: traction and pressure both given; " LOAD
     ":18:47: loads[2]: force and acceleration both given; " LOAD ":19:5: loads[3]: missing a load; " LOAD
     ":20:6: loads[4].set: not used: an acceleration acts on elements, which `where` selects\n"
     ":21:13: loads[5].where: depends on a normal, which only faces have\n"
     ":22:5: loads[6]: missing set or where; allowed: exactly one of set, where\n"
     ":23:15: loads[7]: set and where both given; allowed: exactly one of set, where\n"
     ":24:26: loads[8].force.x: x: depends on x, y or z, but this is the same everywhere; allowed: number or "
     "expression in t (N)\n"
     ":25:46: loads[9].until: not after `from`\n"
     ":26:11: loads[10].set: top: not one of the allowed words; allowed: x-, x+, y-, y+, z-, z+\n"
     ":26:26: loads[10].pressure: \"nx\": depends on a normal, which only faces have; allowed: number or "
     "expression in x, y, z, t (Pa)\n"
     ":26:39: loads[10].until: 0: out of range; allowed: number > 0 (s)\n"
     ":27:25: loads[11].traction: 3: not a mapping of keys\n"
     ":28:5: loads[12]: 3: not a mapping of keys; allowed: list of {name, set, where, cracks, traction, "
     "pressure, "
     "force, "
     "acceleration, foundation, centrifugal, from, until}\n"
     ":29:36: loads[13].centrifugal.speed: x: depends on x, y or z, but this is the same everywhere; "
     "allowed: number "
     "or expression in t (rad/s)\n"
     ":30:6: loads[14].set: not used: centrifugal forces act on elements, which `where` selects\n"
     ":30:45: loads[14].centrifugal.axis: [0, 0, 0]: has no direction\n"
     ":31:5: loads[15].centrifugal.axis: missing; allowed: 3 numbers\n"
     ":32:5: loads[16].centrifugal.speed: missing\n"
     ":37:14: output.probes[0].name: p: the name of an earlier one in history.csv; allowed: letters, digits, "
     "_ "
     "and -; unique in history.csv\n"},
};

static const mistake names[] = {
    {"time:\n",
     "bodies:\n"
     "  - {name: p, shape: plane, motion: prescribed, at: [0, 0, 9], normal: [0, 0, 1]}\n"
     "  - {name: \"a.b\", shape: plane, motion: prescribed, at: [0, 0, 9], normal: [0, 0, 1]}\n"
     "  - {name: \"a.b\", shape: plane, motion: prescribed, at: [0, 0, 9], normal: [0, 0, 1]}\n"
     "  - {name: 5, shape: plane, motion: prescribed, at: [0, 0, 9], normal: [0, 0, 1]}\n"
     "  - {name: p, shape: plane, motion: prescribed, at: [0, 0, 9], normal: [0, 0, 1]}\n"
     "time:\n",
     ":17:12: bodies[1].name: a.b: not a name; allowed: letters, digits, _ and -; unique in history.csv\n"
     ":18:12: bodies[2].name: a.b: not a name; allowed: letters, digits, _ and -; unique in history.csv\n"
     ":19:12: bodies[3].name: 5: not a text (put it in quotes to make it one); allowed: text\n"
     ":20:12: bodies[4].name: p: the name of an earlier one in history.csv; allowed: letters, digits, _ and "
     "-; "
     "unique in history.csv\n"
     ":25:14: output.probes[0].name: p: the name of an earlier one in history.csv; allowed: letters, digits, "
     "_ "
     "and -; unique in history.csv\n"},
    {"1e-3]}\n",
     "1e-3]}\n"
     "    - {at: [0, 0, 0]}\n"
     "    - {name: q, at: [0, 0, 0]}\n"
     "    - {name: q, at: [0, 0, 0]}\n"
     "    - {name: \"\", at: [0, 0, 0]}\n"
     "    - {name: ~, at: [0, 0, 0]}\n"
     "    - 7\n",
     ":20:7: output.probes[1].name: missing; allowed: text\n"
     ":22:14: output.probes[3].name: q: the name of an earlier one in history.csv; allowed: letters, digits, "
     "_ "
     "and -; unique in history.csv\n"
     ":23:14: output.probes[4].name: \"\": not a text; allowed: text\n"
     ":24:14: output.probes[5].name: no value; allowed: text\n"
     ":25:7: output.probes[6]: 7: not a mapping of keys; allowed: list of {name, at, strain}\n"},
};

static const mistake probes[] = {
    {NULL,
     "mesh: {cells: [2, 2, 4], size: [1, 2, 4], origin: [-3, 5, 7]}\n"
     "material: {model: neo-hookean, young: 1, poisson: 0.25, density: 1}\n"
     "interface: {law: none}\n"
     "time: {end: 1}\n"
     "output:\n"
     "  probes:\n"
     "    - {name: a, at: [-3, 5, 7]}\n"
     "    - {name: b, at: [-2, 7, 11]}\n"
     "    - {name: c, at: [-3.5, 4.5, 6.5]}\n"
     "    - {name: d, at: [-1.5, 7.5, 11.5]}\n",
     ":9:22: output.probes[2].at[0]: -3.5: outside the box; allowed: number >= -3 and <= -2 (m)\n"
     ":9:28: output.probes[2].at[1]: 4.5: outside the box; allowed: number >= 5 and <= 7 (m)\n"
     ":9:33: output.probes[2].at[2]: 6.5: outside the box; allowed: number >= 7 and <= 11 (m)\n"
     ":10:22: output.probes[3].at[0]: -1.5: outside the box; allowed: number >= -3 and <= -2 (m)\n"
     ":10:28: output.probes[3].at[1]: 7.5: outside the box; allowed: number >= 5 and <= 7 (m)\n"
     ":10:33: output.probes[3].at[2]: 11.5: outside the box; allowed: number >= 7 and <= 11 (m)\n"},
    {"[1e-3, 1e-3, 2e-3]\n",
     "[1e-3, 1e-3]\n"
     "  origin: [9, 9, 9]\n",
     ":3:9: mesh.size: [1e-3, 1e-3]: wrong number of entries; allowed: [x, y, z], each number > 0 (m)\n"},
    {"  size: [1e-3, 1e-3, 2e-3]\n",
     "  size: [1e-3, 1e-3, 2e-3]\n"
     "  origin: [9, x, 9]\n",
     ":4:15: mesh.origin[1]: x: not a number; allowed: number (m)\n"},
};

static const mistake starts[] = {
    {"  energy: 34\n",
     "  energy: 34\n"
     "  friction: 0.1\n"
     "  sets: [{where: 1, beta: 1}, {where: 2, open: true}]\n"
     "start: static\n",
     ":15:8: start: static: needs interface.friction 0 with open faces or form intrinsic: where they stick "
     "would depend on the way\n"},
    {"  energy: 34\n",
     "  energy: 34\n"
     "  form: incomplete\n"
     "start: relax\n",
     ":14:8: start: relax: not with form incomplete, whose forces have no potential: its tangent is not "
     "symmetric, and its energy grows\n"},
    {"  energy: 34\n",
     "  energy: 34\n"
     "start: relax\n"
     "bodies:\n"
     "  - {name: a, shape: plane, motion: prescribed, at: [0, 0, 9], normal: [0, 0, 1]}\n"
     "  - {name: b, shape: sphere, motion: free, at: [0, 0, 9], radius: 1, mass: 1}\n",
     ":13:8: start: relax: not with bodies that are free or tied, which its damping does not bring to rest: "
     "static does\n"},
    {"  energy: 34\n",
     "  energy: 34\n"
     "start: relax\n"
     "bodies: [{name: a, shape: none, motion: prescribed, at: [0, 0, 9], tied: [z+]}]\n",
     ":13:8: start: relax: not with bodies that are free or tied, which its damping does not bring to rest: "
     "static does\n"},
};

static const mistake law_and_form[] = {
    {"  energy: 34\n", "  energy: 34\n  form: continuous\n  faces: x +\nmass: consistent\n",
     ":14:10: interface.faces: x +: Unexpected end of expression at position 4; allowed: number or "
     "expression in x, "
     "y, z, nx, ny, nz\n"},
    {"  law: linear\n",
     "  law: jelly\n"
     "  form: intrinsc\n"
     "  penalty: elastic\n"
     "  beta: 2\n"
     "  bilinear: {ascent: 0.1}\n"
     "  activation: conserving\n"
     "  onset: 0.5\n"
     "  contact: flux\n",
     ":10:8: interface.law: jelly: not one of the allowed words; allowed: $LAWS, none, user\n"
     ":11:9: interface.form: intrinsc: not one of the allowed words; allowed: variational, incomplete, "
     "intrinsic, continuous; did you mean 'intrinsic'?\n"},
    {"  law: linear\n",
     "  law: jelly\n"
     "  bilinear: {ascent: 2}\n",
     ":10:8: interface.law: jelly: not one of the allowed words; allowed: $LAWS, none, user\n"
     ":11:22: interface.bilinear.ascent: 2: out of range; allowed: number >= 1e-06 and <= 0.999\n"},
    {"  law: linear\n",
     "  law: exponential\n"
     "  form: weird\n"
     "  contact: flux\n"
     "  mass: 3\n",
     ":11:9: interface.form: weird: not one of the allowed words; allowed: variational, incomplete, "
     "intrinsic, continuous\n"
     ":13:3: interface.mass: unknown key; did you mean 'mass'?\n"},
    {"  law: linear\n"
     "  strength: 400e6\n"
     "  energy: 34\n",
     "  law: none\n"
     "  form: intrinsic\n",
     ":10:8: interface.law: none: does not start with a slope, which form intrinsic needs; allowed: with "
     "form intrinsic: $SLOPED_LAWS\n"},
    {"  law: linear\n"
     "  strength: 400e6\n"
     "  energy: 34\n",
     "  law: none\n"
     "  activation: total\n"
     "  onset: 0.1\n"
     "  beta: 1\n"
     "  friction: 0\n"
     "  sets: []\n"
     "  weibull: {modulus: 3}\n",
     ":11:3: interface.activation: total: not used, because interface.law is none\n"
     ":12:3: interface.onset: 0.1: not used, because interface.law is none\n"
     ":13:3: interface.beta: 1: not used, because interface.law is none\n"
     ":14:3: interface.friction: 0: not used, because interface.law is none\n"
     ":15:3: interface.sets: []: not used, because interface.law is none\n"
     ":16:13: interface.weibull.modulus: 3: not used, because interface.law is none\n"},
    {"  law: linear\n"
     "  strength: 400e6\n"
     "  energy: 34\n",
     "  law: none\n"
     "  form: continuous\n"
     "  activation: total\n"
     "  onset: 0.1\n"
     "  faces: 0\n",
     ":12:3: interface.activation: total: not used, because interface.law is none\n"
     ":13:3: interface.onset: 0.1: not used, because interface.law is none\n"},
    {"  law: linear\n",
     "  law: linear\n"
     "  form: continuous\n"
     "  faces: x +\n"
     "  beta_s: 1\n",
     ":12:10: interface.faces: x +: Unexpected end of expression at position 4; allowed: number or "
     "expression in x, y, z, nx, ny, nz\n"},
    {"  law: linear\n",
     "  law: linear\n"
     "  form: continuous\n"
     "  faces: 1\n"
     "  activation: conserving\n",
     ":13:15: interface.activation: conserving: counts the energy of the lift, which form variational alone "
     "has; allowed: with this form: continuous, total\n"},
    {"  law: linear\n",
     "  law: linear\n"
     "  form: incomplete\n"
     "  activation: conserving\n",
     ":12:15: interface.activation: conserving: counts the energy of the lift, which form variational alone "
     "has; allowed: with this form: continuous, total\n"},
    {"  law: linear\n",
     "  law: exponential\n"
     "  form: intrinsic\n"
     "  activation: conserving\n",
     ":12:3: interface.activation: conserving: not used, because interface.form is intrinsic\n"},
    {"  law: linear\n",
     "  law: linear\n"
     "  activation: conserve\n"
     "  onset: 0.2\n"
     "  contact: flux\n",
     ":11:15: interface.activation: conserve: not one of the allowed words; allowed: continuous, total, "
     "conserving; did you mean 'conserving'?\n"},
    {"  law: linear\n",
     "  law: linear\n"
     "  activation: total\n"
     "  onset: 0.2\n",
     ":12:3: interface.onset: 0.2: not used, because interface.activation is not conserving\n"},
    {"  law: linear\n",
     "  law: linear\n"
     "  contact: flux\n"
     "  friction: 0.5\n",
     ":12:13: interface.friction: 0.5: contact flux holds closed faces by all DG terms, so they do not "
     "slide; allowed: with contact flux: 0\n"},
    {"  law: linear\n",
     "  law: linear\n"
     "  activation: total\n"
     "  shear: fading\n",
     ":12:10: interface.shear: fading: needs interface.activation conserving, which counts what the spring "
     "begins "
     "with\n"},
    {"  law: linear\n",
     "  law: linear\n"
     "  activation: total\n"
     "  criterion: mohr-coulomb\n",
     ":12:14: interface.criterion: mohr-coulomb: needs interface.activation conserving, by which pressure "
     "goes on "
     "at the switch\n"},
    {"  law: linear\n",
     "  law: linear\n"
     "  activation: conserving\n"
     "  criterion: mohr-coulomb\n",
     ":12:14: interface.criterion: mohr-coulomb: needs interface.friction, by which pressure adds to the "
     "strength\n"},
    {"  law: linear\n",
     "  law: linear\n"
     "  activation: conserving\n"
     "  criterion: mohr-coulomb\n"
     "  friction: 0.5\n"
     "  beta: 0\n",
     ":12:14: interface.criterion: mohr-coulomb: needs interface.beta, the strength of shear without "
     "pressure over "
     "strength\n"},
    {"  law: linear\n",
     "  law: linear\n"
     "  contact: flux\n"
     "  sets:\n"
     "    - {where: 1, law: none, strength: 3, weibull: {modulus: 3, area: 1}}\n"
     "    - {where: 1, law: linear, friction: 0}\n"
     "    - {where: 1, friction: 0.5, weibull: {area: 1, seed: 3}}\n"
     "    - {where: 1, friction: x, weibull: {modulus: 1}}\n"
     "    - {where: 1, strength: 4*t, weibull: 3}\n",
     ":13:29: interface.sets[0].strength: 3: not used, because law of this set is none\n"
     ":13:52: interface.sets[0].weibull.modulus: 3: not used, because law of this set is none\n"
     ":13:64: interface.sets[0].weibull.area: 1: not used, because law of this set is none\n"
     ":14:23: interface.sets[1].law: linear: not one of the allowed words; allowed: interface, none\n"
     ":15:18: interface.sets[2].friction: 0.5: contact flux holds closed faces by all DG terms, so they do "
     "not slide\n"
     ":15:43: interface.sets[2].weibull.area: 1: not used without weibull.modulus\n"
     ":15:52: interface.sets[2].weibull.seed: 3: not used without weibull.modulus\n"
     ":16:18: interface.sets[3].friction: x: contact flux holds closed faces by all DG terms, so they do not "
     "slide\n"
     ":16:41: interface.sets[3].weibull.area: missing; allowed: number > 0 (m2)\n"
     ":17:28: interface.sets[4].strength: 4*t: depends on t, but this is the state at the start; allowed: "
     "number > 0, or expression in x, y, z, nx, ny, nz (Pa)\n"
     ":17:42: interface.sets[4].weibull: 3: not a mapping of keys\n"},
    {"  law: linear\n",
     "  law: linear\n"
     "  sets: [{where: 1, open: true, strength: 3, beta: 1, weibull: {modulus: 1, area: 1}, friction: 0.1}, "
     "{where: 1, open: 1},\n"
     "    {where: 1, open: false, energy: 3}]\n",
     ":11:33: interface.sets[0].strength: 3: not used, because this set is open\n"
     ":11:46: interface.sets[0].beta: 1: not used, because this set is open\n"
     ":11:65: interface.sets[0].weibull.modulus: 1: not used, because this set is open\n"
     ":11:77: interface.sets[0].weibull.area: 1: not used, because this set is open\n"
     ":11:120: interface.sets[1].open: 1: neither true nor false; allowed: true or false\n"},
    {"  law: linear\n",
     "  law: tvergaard\n"
     "  form: intrinsic\n"
     "  sets: [{where: 1, law: none}, {where: 1, beta: 1}]\n",
     ":12:21: interface.sets[0].law: none: form intrinsic has no DG terms that would hold faces without a "
     "law\n"
     ":12:44: interface.sets[1].beta: 1: in form intrinsic all faces have that of interface.beta\n"},
    {"  law: linear\n",
     "  law: needleman\n"
     "  form: intrinsic\n"
     "  sets: [{where: 1, beta: 0}]\n",
     ":12:21: interface.sets[0].beta: 0: not used, because interface.law is needleman\n"},
    {"  law: linear\n",
     "  law: needleman\n"
     "  form: intrinsic\n"
     "  beta: 1\n"
     "  contact: potential\n",
     ":12:3: interface.beta: 1: not used, because interface.law is needleman\n"},
    {"  law: linear\n",
     "  law: linear\n"
     "  rate: {speed: 3}\n"
     "  fatigue: {decay: x}\n",
     ":11:10: interface.rate.speed: 3: not used, because interface.law is linear\n"
     ":12:13: interface.fatigue.decay: x: not used, because interface.law is linear\n"},
    {"  law: linear\n",
     "  law: linear\n"
     "  weibull: {area: 1, seed: 3, keep: energy}\n",
     ":11:13: interface.weibull.area: 1: not used without interface.weibull.modulus\n"
     ":11:22: interface.weibull.seed: 3: not used without interface.weibull.modulus\n"
     ":11:31: interface.weibull.keep: energy: not used without interface.weibull.modulus\n"},
    {"  law: linear\n",
     "  law: linear\n"
     "  weibull:\n"
     "    modulus: 3\n",
     ":12:5: interface.weibull.area: missing; allowed: number > 0 (m2)\n"},
    {"  law: linear\n",
     "  law: linear\n"
     "  weibull:\n"
     "    modulus: x\n"
     "    seed: 2\n",
     ":12:14: interface.weibull.modulus: x: not a number; allowed: number > 0\n"},
    {"time:\n",
     "mass: [lumped]\n"
     "time:\n",
     ":15:7: mass: [lumped]: not one of the allowed words; allowed: consistent, lumped, scaled\n"},
};

static const mistake materials[] = {
    {"  density: 3690\n",
     "  density: 3690\n"
     "  name: [a]\n"
     "materials:\n"
     "  - {name: material, where: 1, model: neo-hookean, young: 1, poisson: 0.25, density: 1}\n"
     "  - {name: \"x y\", where: 1, model: jelly, young: 1, poisson: 0.25, density: 1, shear: 3, "
     "yield_stress: 2}\n"
     "  - {name: ok, where: .nan, model: neo-hookean, young: 1, poisson: 0.25, density: 1, name: ok}\n"
     "  - {model: linear-elastic, where: 1, young: 1, poisson: 0.25, density: 1, yield_stress: 3}\n",
     ":9:9: material.name: [a]: not a text; allowed: text\n"
     ":11:12: materials[0].name: material: the name of an earlier material; allowed: letters, digits, _ and "
     "-; unique among materials\n"
     ":12:12: materials[1].name: x y: not a name; allowed: letters, digits, _ and -; unique among materials\n"
     ":12:36: materials[1].model: jelly: not one of the allowed words; allowed: $MODELS\n"
     ":13:23: materials[2].where: .nan: not finite; allowed: number or expression in x, y, z\n"
     ":13:86: materials[2].name: given twice, first at line 13 column 6\n"
     ":14:5: materials[3].name: missing; allowed: text\n"
     ":14:76: materials[3].yield_stress: 3: not used, because materials[3].model is linear-elastic; it "
     "belongs to deshpande-evans, j2, johnson-cook\n"},
    {"  density: 3690\n",
     "  density: 3690\n"
     "  name: steel\n"
     "materials:\n"
     "  - {name: steel, where: 1, model: neo-hookean, young: 1, poisson: 0.25, density: 1}\n",
     ":11:12: materials[0].name: steel: the name of an earlier material; allowed: letters, digits, _ and -; "
     "unique among materials\n"},
    {"interface:\n",
     "materials:\n"
     "  - {name: tin, where: 1, model: neo-hookean, young: 1, poisson: 0.25, density: 1}\n"
     "  - {name: zinc, where: 1, model: neo-hookean, young: 1, poisson: 0.25, density: 1}\n"
     "interface:\n"
     "  sets:\n"
     "    - {between: [zinc, znc]}\n"
     "    - {between: [tn, iron]}\n"
     "    - {between: [tin, zinc, tin], where: 1}\n"
     "    - {between: [tin, 3]}\n"
     "    - {between: [tin, zinc], strength: 0}\n"
     "    - {where: x, between: [zinc, lead]}\n"
     "    - 8\n",
     ":14:24: interface.sets[0].between: znc: no such material; allowed: any, or names of two materials, or "
     "one "
     "twice: material, tin, zinc; did you mean 'zinc'?\n"
     ":15:18: interface.sets[1].between: tn: no such material; allowed: any, or names of two materials, or "
     "one "
     "twice: material, tin, zinc; did you mean 'tin'?\n"
     ":15:22: interface.sets[1].between: iron: no such material; allowed: any, or names of two materials, or "
     "one "
     "twice: material, tin, zinc\n"
     ":16:17: interface.sets[2].between: [tin, zinc, tin]: wrong number of entries; allowed: any, or names "
     "of two "
     "materials, or one twice: material, tin, zinc\n"
     ":17:23: interface.sets[3].between[1]: 3: not a text (put it in quotes to make it one); allowed: text\n"
     ":18:40: interface.sets[4].strength: 0: out of range; allowed: number > 0, or expression in x, y, z, "
     "nx, ny, nz (Pa)\n"
     ":19:34: interface.sets[5].between: lead: no such material; allowed: any, or names of two materials, or "
     "one "
     "twice: material, tin, zinc\n"
     ":20:7: interface.sets[6]: 8: not a mapping of keys; allowed: list of {set, where, between, law, open, "
     "at, "
     "strength, energy, beta, friction, rise, weibull}\n"},
    {"output:\n",
     "output:\n"
     "  fields: [damage, rank, plastic_strain, regime, triaxiality, material]\n"
     "materials: [{name: tin, where: 1, model: neo-hookean, young: 1, poisson: 0.25, density: 1}]\n"
     "x:\n",
     ":18:11: output.fields: damage: no material has such a field\n"
     ":18:11: output.fields: regime: no material has such a field\n"
     ":18:11: output.fields: plastic_strain: no material has such a field\n"
     ":20:1: x: unknown key; allowed: defaults, tables, mesh, material, materials, interface, contact, "
     "viscosity, temperature, "
     "mass, "
     "initial, start, relax, "
     "boundary, loads, bodies, time, output, checkpoint\n"},
    {"  model: neo-hookean\n",
     "  model: jelly\n"
     "  shear: 3\n"
     "  yield_stress: x\n",
     ":5:10: material.model: jelly: not one of the allowed words; allowed: $MODELS\n"
     ":7:17: material.yield_stress: x: not a number; allowed: number > 0 (Pa)\n"},
    {"  model: neo-hookean\n", "  model: jelly\n",
     ":5:10: material.model: jelly: not one of the allowed words; allowed: $MODELS\n"},
    {"model: neo-hookean\n"
     "  young: 260e9\n"
     "  poisson: 0.21\n"
     "  density: 3690\n"
     "interface:\n",
     "model: jelly\n"
     "  young: 260e9\n"
     "  poisson: 0.21\n"
     "  density: 3690\n"
     "output: {fields: [damage]}\n"
     "interface:\n",
     ":5:10: material.model: jelly: not one of the allowed words; allowed: $MODELS\n"
     ":18:1: output: given twice, first at line 9 column 1\n"},
};

/* ---- what is right ---- */

static void expect_good(const char *from, const char *to) {
    size_t before = rg_alloc_total();
    write_changed(from, to);
    rg_case_free(read_good(path, 0, NULL));
    assert_int_equal(rg_alloc_total(), before);
}

static void test_good(void **state) {
    (void)state;
    expect_good(
        "time:\n",
        "bodies:\n"
        "  - {name: a, shape: plane, motion: free, at: [0, 0, 9], normal: [2, 0, 0], mass: 1}\n"
        "  - {name: b, shape: plane, motion: free, at: [0, 0, 9], normal: [0, -1, 0], mass: 1}\n"
        "  - {name: c, shape: plane, motion: prescribed, at: [0, 0, 9], normal: [0, 0, 1e-9]}\n"
        "  - {name: d, shape: cylinder, motion: prescribed, at: [0, 0, 9], axis: [1, 0, 0], "
        "radius: 1, velocity: {y: t}}\n"
        "  - {name: e, shape: cylinder, motion: free, at: [0, 0, 9], axis: [0, 1, 0], radius: 1, "
        "mass: 1, velocity: {x: 1, z: 1/3}}\n"
        "  - {name: f, shape: cylinder, motion: free, at: [0, 0, 9], axis: [0, 0, -1], radius: 1, "
        "mass: 1}\n"
        "  - {name: g, shape: sphere, motion: free, at: [0, 0, 9], radius: 1, mass: 1}\n"
        "  - {name: h, shape: cylinder, motion: free, at: [0, 0, 9], axis: [0, 3, 4], radius: 1, length: 2, "
        "density: 3, spin: {x: 1}, tied: [z+]}\n"
        "  - {name: i, shape: none, motion: free, at: [0, 0, 9], mass: 1, inertia: [1, 1, 2, 0, 0, 0], tied: "
        "[x-]}\n"
        "  - {name: j, shape: none, motion: prescribed, at: [0, 0, 9], spin: {z: t}, tied: [x+]}\n"
        "time:\n");
    expect_good("  law: linear\n", "  law: linear\n  contact: flux\n  friction: 0\n");
    expect_good("  law: linear\n",
                "  law: linear\n  activation: conserving\n  contact: potential\n  friction: 0.5\n");
    expect_good("  law: linear\n",
                "  law: exponential\n  form: intrinsic\n  contact: potential\n  friction: 0\n");
    expect_good("  law: linear\n", "  law: linear\n  sets: [{where: nx, strength: 3}]\n");
    expect_good("  law: linear\n", "  law: linear\n  contact: flux\n  sets: [{where: nx, friction: 0}]\n");
    expect_good("  law: linear\n", "  law: linear\n  sets: [{where: nx, law: none}]\n");
    expect_good("  law: linear\n",
                "  law: linear\n  activation: conserving\n  criterion: mohr-coulomb\n  friction: 0.5\n");
    expect_good("  law: linear\n", "  law: linear\n  activation: conserving\n  beta: 0\n  shear: fading\n");
    expect_good("boundary:\n", "mass: lumped\nboundary:\n");
    expect_good("  energy: 34\n", "  energy: 34\n  form: continuous\n  faces: nx\nmass: lumped\n");
    expect_good("output:\n", "output:\n  times: [0, 1e-6]\n  fields: [rank, triaxiality, material]\n");
    expect_good("boundary:\n", "boundary:\n  - {set: z+, component: x, displacement: 't*x'}\n");
}

/* Of one law alone, and kept with it. */
static void test_parameters_of_a_law(void **state) {
    (void)state;
    write_changed("  law: linear\n",
                  "  law: bilinear\n  form: intrinsic\n  bilinear: {ascent: 0.25, steps: 1}\n");
    rg_case *c = read_good(path, 0, NULL);
    assert_true(c->interface.shape[RG_LAW_BILINEAR][0] == 0.25 &&
                c->interface.shape[RG_LAW_BILINEAR][1] == 1);
    rg_case_free(c);
    write_changed("  law: linear\n",
                  "  law: xu-needleman\n  form: intrinsic\n  xu-needleman: {q: 0.5, r: 0.25}\n");
    c = read_good(path, 0, NULL);
    assert_true(c->interface.shape[RG_LAW_XU_NEEDLEMAN][0] == 0.5);
    assert_true(c->interface.shape[RG_LAW_XU_NEEDLEMAN][1] == 0.25);
    rg_case_free(c);
}

#ifndef RG_SINGLE

static void test_saturation(void **state) {
    (void)state;
    static const char *const equal[] = {"material.saturation_stress=2e8", "material.saturation_rate=3"};
    static const char *const zero[] = {"material.saturation_stress=0"};
    static const char *const bad[] = {"material.saturation_stress=x", "material.saturation_rate=7"};
    static const char *const both[] = {"material.saturation_stress=1e8", "material.saturation_rate=0"};
    static const char *const flaws[] = {"material.alpha=2", "material.flaw_density=1e15"};
    static const char *const radius[] = {"material.flaw_radius=0", "material.flaw_density=1e15"};
    write_changed(elastic, metal);
    rg_case_free(read_good(path, 2, equal));
    rg_case_free(read_good(path, 1, zero));
    expect_messages(
        2, bad,
        "--set material.saturation_stress=x: material.saturation_stress: x: not a number; allowed: "
        "number >= 0 (Pa)\n");
    expect_messages(2, both,
                    "--set material.saturation_stress=1e8: material.saturation_stress: 1e8: below "
                    "material.yield_stress, 2e+08 Pa\n"
                    "--set material.saturation_stress=1e8: material.saturation_stress: not used without "
                    "material.saturation_rate\n");
    /* what the initial damage follows from is wrong: nothing is said of it */
    write_changed(elastic, ceramic);
    expect_messages(
        2, flaws, "--set material.alpha=2: material.alpha: 2: out of range; allowed: number > 0 and <= 1\n");
    expect_messages(
        2, radius,
        "--set material.flaw_radius=0: material.flaw_radius: 0: out of range; allowed: number > 0 (m)\n");
}

/* Of the ceramic in a list the initial damage is told as well, against its own bound: 4/3 pi (0.5 x 1e-3)^3
 * 1e9. */
static void test_flaws_of_a_list(void **state) {
    (void)state;
    write_changed(
        "interface:\n",
        "materials:\n  - {name: c, where: 1, model: deshpande-evans, shear: 1e11, poisson: 0.2, density: "
        "3700, flaw_radius: 1e-3, alpha: 0.5, flaw_density: 1e9, toughness: 3e6, yield_stress: 4e9, "
        "damage_max: 0.5}\n  - {name: d, where: 1, model: deshpande-evans, shear: 1e11, poisson: 0.2, "
        "density: "
        "3700, flaw_radius: 1e-3, alpha: 0.5, flaw_density: 1e9, toughness: 3e6, yield_stress: 4e9, "
        "damage_max: 0.53}\ninterface:\n");
    expect_messages(
        0, NULL,
        ":10:136: materials[0].flaw_density: 1e9: the damage to begin with, 4/3 pi (alpha flaw_radius)^3 "
        "flaw_density, is 0.5236: not below damage_max, 0.5\n");
}

#endif

/* ---- mesh.file ---- */

/* It is told from the folder of the case, and known by its whole path then; its sets are its own. */
static void test_mesh_file(void **state) {
    (void)state;
    static const char text[] =
        "mesh: {file: %s}\n"
        "material: {model: neo-hookean, young: 1, poisson: 0.25, density: 1}\n"
        "materials: [{name: a, set: core, model: neo-hookean, young: 1, poisson: 0, density: 1}]\n"
        "interface: {law: none}\n"
        "boundary: [{set: top, component: z, velocity: 1}, {set: '3', component: z, velocity: 1}]\n"
        "bodies: [{name: b, shape: sphere, motion: free, at: [0, 0, 1], radius: 1, mass: 1, "
        "faces: [left, right]}]\n"
        "time: {end: 1}\n"
        "output: {probes: [{name: p, at: [99, 99, 99]}]}\n";
    char whole[2048], here[1024], expected[2048];
    write_bytes("", 0);
    assert_non_null(getcwd(here, sizeof here));
    assert_int_equal(chdir(directory), 0);
    const char *folder = strrchr(directory, '/') + 1;
    const struct {
        const char *at, *file; /* where the case is, what it calls its mesh */
        const char *begin, *end;
    } known[] = {{"case.yaml", "bar.yaml", directory, "/bar.yaml"},
                 {"./case.yaml", "bar.yaml", directory, "/./bar.yaml"},
                 {"no/../case.yaml", path, "", path},
                 {NULL, "bar.yaml", directory, "/bar.yaml"}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        char at[256];
        snprintf(at, sizeof at, "%s/case.yaml", directory);
        snprintf(whole, sizeof whole, text, known[i].file);
        snprintf(expected, sizeof expected, "%s%s", known[i].begin, known[i].end);
        size_t before = rg_alloc_total();
        rg_case *c =
            rg_case_read_text(known[i].at != NULL ? known[i].at : at, whole, strlen(whole), 0, NULL, stderr);
        assert_non_null(c);
        assert_string_equal(c->mesh.file, expected);
        assert_string_equal(c->boundary[1].set, "3");
        assert_string_equal(c->body[0].set[1], "right");
        rg_case_free(c);
        assert_int_equal(rg_alloc_total(), before);
    }
    /* from the folder above */
    assert_int_equal(chdir(".."), 0);
    char above[256], at[256];
    assert_non_null(getcwd(above, sizeof above));
    snprintf(at, sizeof at, "%s/case.yaml", folder);
    snprintf(whole, sizeof whole, text, "bar.yaml");
    snprintf(expected, sizeof expected, "%s/%s/bar.yaml", above, folder);
    rg_case *c = rg_case_read_text(at, whole, strlen(whole), 0, NULL, stderr);
    assert_string_equal(c->mesh.file, expected);
    rg_case_free(c);
    assert_int_equal(chdir(here), 0);
}

static void test_mistakes_with_a_mesh_file(void **state) {
    (void)state;
    static const char *const set[] = {"mesh.size=[1, 1, 1]"};
    char whole[1024], lines[2048];
    snprintf(whole, sizeof whole,
             "mesh:\n  file: %s\n  jitter: 0.1\n"
             "material: {model: neo-hookean, young: 1, poisson: 0.25, density: 1}\n"
             "materials: [{name: a, model: neo-hookean, young: 1, poisson: 0, density: 1, set: 3}]\n"
             "interface: {law: none}\n"
             "boundary: [{set: 4, component: z, velocity: 1}, {set: [top], component: z, velocity: 1}]\n"
             "time: {end: 1}\n",
             path);
    write_bytes(whole, strlen(whole));
    snprintf(lines, sizeof lines,
             ":3:3: mesh.jitter: 0.1: cannot be given together with mesh.file\n"
             ":5:82: materials[0].set: 3: not a text (put it in quotes to make it one); allowed: text\n"
             ":7:18: boundary[0].set: 4: not a text (put it in quotes to make it one); allowed: text\n"
             ":7:55: boundary[1].set: [top]: not a text; allowed: text\n"
             "--set mesh.size=[1, 1, 1]: mesh.size: [1, 1, 1]: cannot be given together with mesh.file\n");
    expect_messages(1, set, lines);
}

static void test_bodies(void **state) {
    (void)state;
    expect_mistakes(bodies, sizeof bodies / sizeof *bodies);
}

static void test_loads(void **state) {
    (void)state;
    expect_mistakes(loads, sizeof loads / sizeof *loads);
}

static void test_names(void **state) {
    (void)state;
    expect_mistakes(names, sizeof names / sizeof *names);
}

static void test_probes(void **state) {
    (void)state;
    expect_mistakes(probes, sizeof probes / sizeof *probes);
}

static void test_law_and_form(void **state) {
    (void)state;
    expect_mistakes(starts, sizeof starts / sizeof *starts);
    expect_mistakes(law_and_form, sizeof law_and_form / sizeof *law_and_form);
}

static void test_materials(void **state) {
    (void)state;
    expect_mistakes(materials, sizeof materials / sizeof *materials);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_loads),        cmocka_unit_test(test_bodies),
        cmocka_unit_test(test_names),        cmocka_unit_test(test_probes),
        cmocka_unit_test(test_law_and_form), cmocka_unit_test(test_materials),
        cmocka_unit_test(test_good),         cmocka_unit_test(test_parameters_of_a_law),
#ifndef RG_SINGLE
        cmocka_unit_test(test_saturation),   cmocka_unit_test(test_flaws_of_a_list),
#endif
        cmocka_unit_test(test_mesh_file),    cmocka_unit_test(test_mistakes_with_a_mesh_file),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
