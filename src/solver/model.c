#include "solver/model.h"

#include "base/mem.h"
#include "partition/material.h"
#include "solver/law.h"

/* Without faces form continuous has no jumps to lift. */
static rg_gradient gradient_of(const rg_case *c) {
    bool lifts = c->interface.form == RG_FORM_VARIATIONAL || c->interface.faces != NULL;
    return lifts ? RG_GRADIENT_LIFTED : RG_GRADIENT_OWN;
}

rg_model *rg_model_make(const rg_case *c) {
    rg_model *m = RG_NEW(rg_model, 1);
    *m = (rg_model){.materials = 1 + c->others,
                    .material = rg_materials_of_case(c),
                    .gradient = gradient_of(c),
                    .law = rg_law_make(c),
                    .stiffest = 1};
    m->crack_stride = rg_crack_stride(&m->law);
    for (int i = 0; i < m->materials; i++) {
        size_t block = rg_history_block(rg_material_values(&m->material[i]));
        m->history_stride = block > m->history_stride ? block : m->history_stride;
    }
    return m;
}

void rg_model_free(rg_model *m) {
    if (m != NULL) {
        rg_free((void *)m->material);
        rg_free(m->scale);
        rg_free((void *)m->beta);
        rg_free((void *)m->friction);
        rg_free((void *)m->rise);
        rg_free((void *)m->opening);
        rg_free((void *)m->open_area);
        rg_free((void *)m->open_faces);
        rg_free(m);
    }
}
