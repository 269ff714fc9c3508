#include "export_command.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "output/export.h"
#include "usage.h"

static int complain(const char *what, const char *argument) {
    fprintf(stderr, "rhegma: export: %s%s%s\n%s", what, argument[0] != '\0' ? ": " : "", argument,
            rg_usage("export"));
    return RG_USAGE;
}

int rg_export_command(int argc, char **argv) {
    const char *dir = NULL, *out = NULL;
    double time = INFINITY;
    bool crack = false;
    for (int i = 2; i < argc; i++) {
        bool takes_value = strcmp(argv[i], "-o") == 0 || strcmp(argv[i], "--time") == 0;
        if (takes_value && i + 1 == argc) {
            return complain("missing value after", argv[i]);
        }
        if (strcmp(argv[i], "-o") == 0) {
            out = argv[++i];
        } else if (strcmp(argv[i], "--time") == 0) {
            char *end;
            time = strtod(argv[++i], &end);
            if (end == argv[i] || *end != '\0' || !isfinite(time)) {
                return complain("--time is a number of seconds, not", argv[i]);
            }
        } else if (strcmp(argv[i], "--crack") == 0) {
            crack = true;
        } else if (argv[i][0] == '-') {
            return complain("unknown option", argv[i]);
        } else if (dir == NULL) {
            dir = argv[i];
        } else {
            return complain("one run at a time; not understood", argv[i]);
        }
    }
    if (dir == NULL) {
        return complain("of which run?", "");
    }
    if (out == NULL && (crack || isfinite(time))) {
        return complain("where to? -o is missing", "");
    }
    if (out == NULL) {
        rg_export_list(dir, stdout);
        return RG_OK;
    }
    if (rg_export_kind_of(out) == RG_EXPORT_NONE) {
        return complain("the name must end with .vtu, .vtp or .stl", out);
    }
    printf("%s: at %.9g s\n", out, rg_export(dir, time, crack, out));
    return RG_OK;
}
