/* Solids by name: values of a material, and of its cohesive faces, with their sources. */
#ifndef RG_CASE_PRESET_H
#define RG_CASE_PRESET_H

#include <stdio.h>

typedef struct {
    const char *name, *what;
    const char *block;       /* of `material`, in YAML, SI units */
    double strength, energy; /* of cracks (Pa, J/m^2) */
    const char *source, *validity;
} rg_preset;

enum { RG_PRESETS = 18 };
extern const rg_preset rg_preset_list[RG_PRESETS];

/* The one of that name; NULL: none has it. */
const rg_preset *rg_preset_find(const char *name);

/* The name that was probably meant, or NULL. */
const char *rg_preset_nearest(const char *name);

/* All presets, one a line; or one with values, sources and a block to copy. */
void rg_presets_print(FILE *out);
void rg_preset_print(const rg_preset *p, FILE *out);

#endif
