#include "materials.h"

int rg_material_history(rg_material_model model) {
#define HISTORY(name, NAME, word, history, inside) [RG_MATERIAL_##NAME] = (history),
    static const int values[] = {RG_MATERIALS(HISTORY)};
    return values[model];
}

unsigned rg_material_inside(rg_material_model model) {
#define INSIDE(name, NAME, word, history, inside) [RG_MATERIAL_##NAME] = (inside),
    static const unsigned bits[] = {RG_MATERIALS(INSIDE)};
    return bits[model];
}

int rg_material_exists(rg_material_model model) {
#define EXISTS(name, NAME, word, history, inside) [RG_MATERIAL_##NAME] = 1,
    static const int here[RG_MATERIAL_MODELS] = {RG_MATERIALS_HERE(EXISTS)};
    return here[model];
}

void rg_material_prepare(rg_material *m, double dt) {
#define PREPARE(name, NAME, word, history, inside) [RG_MATERIAL_##NAME] = rg_prepare_##name,
    static void (*const prepare[])(rg_material *, double) = {RG_MATERIALS(PREPARE)};
    prepare[m->model](m, dt);
}

/* A hyperelastic solid knows no step. */
void rg_prepare_neo_hookean(rg_material *m, double dt) {
    (void)m;
    (void)dt;
}
