#include "materials.h"

const char *rg_material_word(rg_material_model model) {
#define WORD(name, NAME, word, meaning, history, inside) [RG_MATERIAL_##NAME] = (word),
    static const char *const words[] = {RG_MATERIALS(WORD)};
    return words[model];
}

int rg_material_history(rg_material_model model) {
#define HISTORY(name, NAME, word, meaning, history, inside) [RG_MATERIAL_##NAME] = (history),
    static const int values[] = {RG_MATERIALS(HISTORY)};
    return values[model];
}

unsigned rg_material_inside(rg_material_model model) {
#define INSIDE(name, NAME, word, meaning, history, inside) [RG_MATERIAL_##NAME] = (inside),
    static const unsigned bits[] = {RG_MATERIALS(INSIDE)};
    return bits[model];
}

int rg_material_exists(rg_material_model model) {
#define EXISTS(name, NAME, word, meaning, history, inside) [RG_MATERIAL_##NAME] = 1,
    static const int here[RG_MATERIAL_MODELS] = {RG_MATERIALS_HERE(EXISTS)};
    return here[model];
}

void rg_material_prepare(rg_material *m, double dt) {
    m->dt = dt;
    if (m->model == RG_MATERIAL_DESHPANDE_EVANS) {
        m->of.deshpande_evans.constants = rg_de_prepare(&m->of.deshpande_evans.parameters, dt);
    }
}
