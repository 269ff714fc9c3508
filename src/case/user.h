/* Materials of the user's own: loading their libraries, and checking what they compute. */
#ifndef RG_CASE_USER_H
#define RG_CASE_USER_H

#include <stddef.h>

#include "case/case.h"
#include "library.h"

/* Loads a library and looks at its head. NULL, and why not in words, where it cannot serve this program. */
const rg_user_material *rg_user_load(const char *path, char *why, size_t size);

const rg_user_law *rg_user_load_law(const char *path, char *why, size_t size);

/* The material, whose library is loaded, as kernels take it. */
rg_material rg_user_material_of(const rg_material_input *in);

/* Checks what the library computes for these parameters (user_check.c). False: it cannot serve, and why in
 * words and numbers. */
bool rg_user_check(const rg_material *m, rg_user_report *report, char *why, size_t size);

/* The same for a law of strength and critical opening, whose parameters `law` has: what a monotonic opening
 * takes over the energy that it declares, and by how much stored and dissipated work differ from it. */
bool rg_user_law_check(const rg_cohesive *law, double strength, double opening, double *share, double *closed,
                       char *why, size_t size);

#endif
