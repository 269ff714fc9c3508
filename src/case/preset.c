#include "case/preset.h"

#include <string.h>

#include "base/mem.h"
#include "case/check.h"

#define JH2                                                                                                  \
    "D. S. Cronin and others, 4th European LS-DYNA Users Conf. (2003), D-I-47, from memory; young and "      \
    "poisson "                                                                                               \
    "from its G and K1"
#define CRUSHED "under pressure as fitted to plate impact; in tension cracks between elements break it first"
#define COOK    "G. R. Johnson & W. H. Cook, 7th Int. Symp. Ballistics (1983) 541, from memory"
#define DUCTILE "up to rates of 1e5/s; conducts no heat, and has no damage of its own"

/* Where a source gives a fracture toughness, energy is K_Ic^2 (1 - nu^2)/E of it. */
const rg_preset rg_preset_list[RG_PRESETS] = {
    {"alumina-seagraves", "alumina of the thesis",
     "{model: neo-hookean, young: 260e9, poisson: 0.21, density: 3690}", 400e6, 34,
     "A. N. Seagraves, MIT 2010, section 5.1 (spall test)",
     "elastic; the strength is that of spall, above what bending bears"},
    {"alumina-ad995", "alumina of 99.5 %, CoorsTek AD-995",
     "{model: neo-hookean, young: 370e9, poisson: 0.22, density: 3900}", 262e6, 52,
     "CoorsTek, data sheet of AD-995: tensile strength 262 MPa; K_Ic 4 to 5 MPa sqrt(m), here 4.5",
     "elastic; strength from quasi-static tests, spall strength is 300 to 500 MPa"},
    {"silicon-carbide", "sintered alpha silicon carbide",
     "{model: neo-hookean, young: 415e9, poisson: 0.16, density: 3160}", 250e6, 22.6,
     "R. G. Munro, J. Phys. Chem. Ref. Data 26 (1997) 1195: tensile strength 250 MPa, K_Ic 3.1 MPa sqrt(m)",
     "elastic; quasi-static, at room temperature"},
    {"boron-carbide", "hot-pressed boron carbide",
     "{model: neo-hookean, young: 461e9, poisson: 0.17, density: 2510}", 350e6, 13.2,
     "elastic constants of G 197, K 233 GPa: G. R. Johnson & T. J. Holmquist, J. Appl. Phys. 85 (1999) 8060; "
     "tensile strength 350 MPa, K_Ic 2.5 MPa sqrt(m): usual of hot-pressed B4C",
     "elastic; it becomes amorphous beyond 20 GPa, which is not in the model"},
    {"soda-lime-glass", "float glass", "{model: neo-hookean, young: 72e9, poisson: 0.22, density: 2500}",
     60e6, 7.4,
     "S. M. Wiederhorn, J. Am. Ceram. Soc. 52 (1969) 99: K_Ic 0.75 MPa sqrt(m); strength: of a usual surface",
     "elastic; flaws decide the strength, 30 to 100 MPa: make it random (interface.weibull, modulus 5 to "
     "10)"},
    {"pmma", "polymethyl methacrylate at impact rates",
     "{model: neo-hookean, young: 3.24e9, poisson: 0.35, density: 1190}", 129.6e6, 352.3,
     "F. Zhou, J.-F. Molinari & T. Shioya, Eng. Fract. Mech. 72 (2005) 1383",
     "elastic: neither its viscosity nor the rise of G_c with the crack's speed is in it (law: rate has the "
     "latter)"},
    {"granite", "Laurentian granite", "{model: neo-hookean, young: 92e9, poisson: 0.21, density: 2630}",
     12.8e6, 24,
     "K. Xia & F. Dai and co-workers, Laurentian granite: static tensile strength 12.8 MPa, K_Ic 1.52 MPa "
     "sqrt(m)",
     "elastic, isotropic; static values: strength and toughness double and more at 1e2 to 1e3 GPa/s"},
    {"concrete", "plain concrete, 53 MPa in compression",
     "{model: neo-hookean, young: 36e9, poisson: 0.18, density: 2400}", 3.8e6, 65,
     "J. Ozbolt, J. Bosnjak & E. Sola, Eng. Fract. Mech. 110 (2013) 88: dynamic compact tension",
     "elastic in compression: crushing is not in it"},
    {"maraging-steel", "18Ni1900 of Kalthoff and Winkler's experiment",
     "{model: neo-hookean, young: 190e9, poisson: 0.3, density: 8000}", 844e6, 22130,
     "T. Belytschko, H. Chen, J. Xu & G. Zi, Int. J. Numer. Meth. Eng. 58 (2003) 1873; M. J. Borden and "
     "others, "
     "Comput. Methods Appl. Mech. Eng. 217 (2012) 77",
     "brittle failure below 20 to 30 m/s of impact, where no shear band forms"},
    {"concrete-hjc", "concrete of 48 MPa that is crushed, by Holmquist, Johnson and Cook",
     "{model: holmquist-johnson-cook, young: 34.0414e9, poisson: 0.145403, density: 2440, reference_rate: 1, "
     "rate_sensitivity: 0.007, compressive_strength: 48e6, cohesive_strength: 0.79, crushed_strength: 1.6, "
     "crushed_power: 0.61, largest_strength: 7, tensile_limit: 4e6, failure_strain: 0.04, failure_power: 1, "
     "least_failure_strain: 0.01, crush_pressure: 16e6, lock_pressure: 0.8e9, lock_strain: 0.1, bulk_1: "
     "85e9, "
     "bulk_2: -171e9, bulk_3: 208e9}",
     4e6, 65,
     "T. J. Holmquist, G. R. Johnson & W. H. Cook, 14th Int. Symp. Ballistics (1993) 591, from memory; young "
     "and "
     "poisson from its G and K; energy of cracks: as concrete",
     "impact and penetration, pressures up to 2 GPa; in tension cracks between elements break it first"},
    {"alumina-jh2", "alumina that is crushed, by Johnson and Holmquist",
     "{model: johnson-holmquist-2, young: 220e9, poisson: 0.22, density: 3700, reference_rate: 1, "
     "hugoniot_limit: 2.79e9, hugoniot_pressure: 1.46e9, intact_strength: 0.93, intact_power: 0.6, "
     "crushed_strength: 0.31, crushed_power: 0.6, tensile_limit: 0.2e9, failure_strain: 0.005, "
     "failure_power: 1, bulking: 1}",
     262e6, 52, JH2 "; cracks: as alumina-ad995", CRUSHED},
    {"boron-carbide-jh2", "boron carbide that is crushed, by Johnson and Holmquist",
     "{model: johnson-holmquist-2, young: 461.06e9, poisson: 0.1702, density: 2510, reference_rate: 1, "
     "rate_sensitivity: 0.005, hugoniot_limit: 19e9, hugoniot_pressure: 8.71e9, intact_strength: 0.927, "
     "intact_power: 0.67, crushed_strength: 0.7, crushed_power: 0.85, crushed_limit: 0.2, tensile_limit: "
     "0.26e9, failure_strain: 0.001, failure_power: 0.5, bulk_2: -593e9, bulk_3: 2800e9, bulking: 1}",
     350e6, 13.2,
     "G. R. Johnson & T. J. Holmquist, J. Appl. Phys. 85 (1999) 8060, from memory; cracks: as boron-carbide",
     CRUSHED "; the fit ends where boron carbide becomes amorphous, beyond 20 GPa"},
    {"silicon-carbide-jh2", "silicon carbide that is crushed, by Johnson and Holmquist",
     "{model: johnson-holmquist-2, young: 423e9, poisson: 0.15574, density: 3163, reference_rate: 1, "
     "hugoniot_limit: 14.567e9, hugoniot_pressure: 5.9e9, intact_strength: 0.96, intact_power: 0.65, "
     "crushed_strength: 0.35, crushed_power: 1, tensile_limit: 0.37e9, failure_strain: 0.48, failure_power: "
     "0.48, bulking: 1}",
     250e6, 22.6, JH2 "; cracks: as silicon-carbide", CRUSHED},
    {"float-glass-jh2", "float glass that is crushed, by Johnson and Holmquist",
     "{model: johnson-holmquist-2, young: 74.56e9, poisson: 0.22629, density: 2530, reference_rate: 1, "
     "rate_sensitivity: 0.003, hugoniot_limit: 5.95e9, hugoniot_pressure: 2.92e9, intact_strength: 0.93, "
     "intact_power: 0.77, crushed_strength: 0.088, crushed_power: 0.35, crushed_limit: 0.5, tensile_limit: "
     "0.15e9, failure_strain: 0.053, failure_power: 0.85, bulk_2: -138e9, bulk_3: 290e9, bulking: 1}",
     60e6, 7.4,
     JH2 ", after T. J. Holmquist and others, 15th Int. Symp. Ballistics (1995); cracks: as soda-lime-glass",
     CRUSHED},
    {"steel-4340", "4340 steel, by Johnson and Cook",
     "{model: johnson-cook, young: 200e9, poisson: 0.29, density: 7830, yield_stress: 792e6, "
     "hardening_modulus: 510e6, hardening_power: 0.26, rate_sensitivity: 0.014, reference_rate: 1, "
     "softening_power: 1.03, melting_temperature: 1793, room_temperature: 294, heat_capacity: 477, "
     "heat_fraction: 0.9}",
     2.4e9, 20e3, COOK ": Rockwell C-30; strength and energy of cracks: of the order of such steels",
     DUCTILE},
    {"copper-ofhc", "oxygen-free copper, by Johnson and Cook",
     "{model: johnson-cook, young: 124e9, poisson: 0.34, density: 8960, yield_stress: 90e6, "
     "hardening_modulus: 292e6, hardening_power: 0.31, rate_sensitivity: 0.025, reference_rate: 1, "
     "softening_power: 1.09, melting_temperature: 1356, room_temperature: 294, heat_capacity: 383, "
     "heat_fraction: 0.9}",
     1.2e9, 20e3, COOK "; strength and energy of cracks: of the order of its spall", DUCTILE},
    {"berea-sandstone", "Berea sandstone with pores that collapse",
     "{model: drucker-prager, young: 19.3e9, poisson: 0.2, density: 2100, cohesion: 18.5e6, friction_angle: "
     "37, "
     "dilation_angle: 10, cap_pressure: 390e6, cap_ratio: 0.5, compaction: 0.15, compaction_pressure: 300e6}",
     5e6, 6.4,
     "T.-f. Wong, C. David & W. Zhu, J. Geophys. Res. 102 (1997) 3009, from memory: 21 % pores, 390 MPa to "
     "crush "
     "grains; cone by 74 MPa in compression; cracks: of the order of such sandstones",
     "dry; order of magnitude of the cap: its ratio and hardening are not of the source"},
    {"pmma-viscoelastic", "polymethyl methacrylate that relaxes",
     "{model: viscoelastic, young: 6e9, poisson: 0.33, density: 1190, shear_fraction_1: 0.15, "
     "shear_fraction_2: "
     "0.15, shear_fraction_3: 0.16, relaxation_time_1: 1e-6, relaxation_time_2: 1e-4, relaxation_time_3: "
     "1e-2}",
     129.6e6, 352.3,
     "moduli from speeds of sound, 2.73 and 1.38 km/s, and 3.3 GPa in quasi-static tests, from memory; times "
     "spread over the decades between; cracks: as pmma",
     "stiffness by rate, roughly: a spectrum of three times, bulk modulus constant, room temperature"},
};

const rg_preset *rg_preset_find(const char *name) {
    for (int i = 0; i < RG_PRESETS; i++) {
        if (strcmp(rg_preset_list[i].name, name) == 0) {
            return &rg_preset_list[i];
        }
    }
    return NULL;
}

const char *rg_preset_nearest(const char *name) {
    const char *names[RG_PRESETS + 1] = {NULL};
    for (int i = 0; i < RG_PRESETS; i++) {
        names[i] = rg_preset_list[i].name;
    }
    return rg_nearest(name, names);
}

/* ---- in a case ---- */

static void complain(rg_check *ck, const rg_node *node, const char *path) {
    char allowed[600] = "", value[64], *key = rg_text_format("%spreset", path);
    for (int i = 0; i < RG_PRESETS; i++) {
        rg_text_add(allowed, sizeof allowed, "%s%s", i > 0 ? ", " : "", rg_preset_list[i].name);
    }
    rg_subject subject = {.key = key,
                          .value = rg_node_line(node, value, sizeof value),
                          .allowed = allowed,
                          .nearest = node->kind == RG_NODE_SCALAR ? rg_preset_nearest(node->text) : NULL};
    rg_problem_add(ck->problems, node->at, &subject, "no such preset (rhegma materials lists them)");
    rg_free(key);
}

static unsigned model_bit(const rg_node *model) {
    unsigned bit = 0;
    for (int m = 0; model != NULL && model->kind == RG_NODE_SCALAR && m < RG_MATERIAL_MODELS; m++) {
        bit |= strcmp(rg_material_word((rg_material_model)m), model->text) == 0 ? 1U << m : 0;
    }
    return bit;
}

static void fill(rg_node *block, const rg_preset *p, rg_place at) {
    rg_problems none = {.file = p->name};
    rg_node values = {.kind = RG_NODE_BAD};
    rg_yaml_parse(&none, p->block, strlen(p->block), NULL, &values);
    const rg_node *model = rg_node_find(block, "model", strlen("model"));
    unsigned bit = model_bit(model != NULL ? model : rg_node_find(&values, "model", strlen("model")));
    for (int i = 0; i < values.children; i++) {
        rg_node *value = &values.child[i];
        const rg_key *key = rg_key_find(&rg_material_table, value->key);
        unsigned models = key->models & ~key->as_models; /* 0: all */
        if (rg_node_find(block, value->key, strlen(value->key)) == NULL &&
            (models == 0 || (models & bit) != 0)) {
            value->at = value->key_at = at;
            rg_node_copy(value, rg_node_append(block));
        }
    }
    rg_node_clear(&values);
}

static void expand(rg_check *ck, rg_node *block, const char *path) {
    const rg_node *node = block != NULL && block->kind == RG_NODE_MAPPING
                              ? rg_node_find(block, "preset", strlen("preset"))
                              : NULL;
    if (node == NULL || node->kind == RG_NODE_BAD) {
        return;
    }
    const rg_preset *p = node->kind == RG_NODE_SCALAR ? rg_preset_find(node->text) : NULL;
    if (p == NULL) {
        complain(ck, node, path);
        block->kind = RG_NODE_BAD; /* what it has not is not known */
    } else {
        fill(block, p, node->at);
    }
}

void rg_presets_expand(rg_check *ck, rg_node *root) {
    if (root->kind != RG_NODE_MAPPING) {
        return;
    }
    expand(ck, rg_node_find(root, "material", strlen("material")), "material.");
    rg_node *list = rg_node_find(root, "materials", strlen("materials"));
    for (int i = 0; list != NULL && list->kind == RG_NODE_LIST && i < list->children; i++) {
        char *path = rg_text_format("materials[%d].", i);
        expand(ck, &list->child[i], path);
        rg_free(path);
    }
}

/* ---- for people ---- */

void rg_presets_print(FILE *out) {
    for (int i = 0; i < RG_PRESETS; i++) {
        fprintf(out, "%-18s %s\n", rg_preset_list[i].name, rg_preset_list[i].what);
    }
}

void rg_preset_print(const rg_preset *p, FILE *out) {
    fprintf(out, "%s: %s\n\nmaterial: {preset: %s}   # the same as %s\n", p->name, p->what, p->name,
            p->block);
    fprintf(out, "interface: {law: linear, strength: %g, energy: %g}   # Pa, J/m2\n\n", p->strength,
            p->energy);
    fprintf(out, "source    %s\nvalidity  %s\n", p->source, p->validity);
}
