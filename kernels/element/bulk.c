/* The bulk kernel of whatever material the arguments name. */
#include "isa.h"
#include "library.h"

void RG_ISA_NAME(rg_bulk)(const rg_bulk_args *args, size_t begin, size_t end) {
#define BULK(name, NAME, word, meaning, history, inside) [RG_MATERIAL_##NAME] = RG_ISA_NAME(rg_bulk_##name),
    static void (*const bulk[])(const rg_bulk_args *, size_t, size_t) = {RG_MATERIALS_HERE(BULK)};
    if (args->material.model == RG_MATERIAL_USER) {
        args->material.of.user.library->bulk(args, begin, end);
    } else {
        bulk[args->material.model](args, begin, end);
    }
}

void RG_ISA_NAME(rg_bulk_state)(const rg_bulk_state_args *args, size_t begin, size_t end) {
#define STATE(name, NAME, word, meaning, history, inside)                                                    \
    [RG_MATERIAL_##NAME] = RG_ISA_NAME(rg_bulk_state_##name),
    static void (*const state[])(const rg_bulk_state_args *, size_t, size_t) = {RG_MATERIALS_HERE(STATE)};
    if (args->bulk->material.model == RG_MATERIAL_USER) {
        args->bulk->material.of.user.library->bulk_state(args, begin, end);
    } else {
        state[args->bulk->material.model](args, begin, end);
    }
}
