/* Contact of faces, a pair at a time. */
#include "contact/pair.h"
#include "isa.h"

void RG_ISA_NAME(rg_contact)(const rg_contact_args *args, size_t begin, size_t end) {
    for (size_t i = begin; i < end; i++) {
        const rg_contact_pair *pair = &args->pair[i];
        size_t a = (size_t)pair->face[0], b = (size_t)pair->face[1];
        double sunk = args->sunk[a] > args->sunk[b] ? args->sunk[a] : args->sunk[b];
        args->energy[i] = pair_forces(pair, sunk, args->corner + 9 * a, args->corner + 9 * b,
                                      args->force + 18 * i, args->depth + i);
    }
}
