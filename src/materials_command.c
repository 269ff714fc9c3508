#include "materials_command.h"

#include <stdio.h>

#include "base/error.h"
#include "case/preset.h"
#include "usage.h"

static int complain(const char *what, const char *argument) {
    fprintf(stderr, "rhegma: materials: %s: %s\n%s", what, argument, rg_usage("materials"));
    return RG_USAGE;
}

static int unknown(const char *name) {
    const char *nearest = rg_preset_nearest(name);
    fprintf(stderr, "rhegma: materials: %s: no such preset%s%s%s\n", name,
            nearest != NULL ? "; did you mean '" : "", nearest != NULL ? nearest : "",
            nearest != NULL ? "'?" : "; rhegma materials lists them");
    return RG_USAGE;
}

int rg_materials_command(int argc, char **argv) {
    const char *name = argc > 2 ? argv[2] : NULL;
    if (argc > 3) {
        return complain("one name at a time; not understood", argv[3]);
    }
    if (name == NULL) {
        rg_presets_print(stdout);
        return RG_OK;
    }
    if (name[0] == '-') {
        return complain("unknown option", name);
    }
    const rg_preset *p = rg_preset_find(name);
    if (p == NULL) {
        return unknown(name);
    }
    rg_preset_print(p, stdout);
    return RG_OK;
}
