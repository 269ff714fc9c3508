#include "case/preset.h"

#include <string.h>

#include "base/mem.h"
#include "case/check.h"

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
    char allowed[400] = "", value[64], *key = rg_text_format("%spreset", path);
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
