#include "base/json.h"

#include <inttypes.h>
#include <math.h>

void rg_json_text(FILE *f, const char *key, const char *value) {
    fprintf(f, "  \"%s\": \"", key);
    for (const char *p = value; *p != '\0'; p++) {
        if (*p == '"' || *p == '\\') {
            fputc('\\', f);
        }
        fputc((unsigned char)*p < ' ' ? ' ' : *p, f);
    }
    fputs("\",\n", f);
}

void rg_json_integer(FILE *f, const char *key, int64_t value) {
    fprintf(f, "  \"%s\": %" PRId64 ",\n", key, value);
}

void rg_json_number(FILE *f, const char *key, double value) {
    if (isfinite(value)) {
        fprintf(f, "  \"%s\": %.17g,\n", key, value);
    } else {
        fprintf(f, "  \"%s\": null,\n", key);
    }
}

void rg_json_vector(FILE *f, const char *key, const double value[3]) {
    fprintf(f, "  \"%s\": [", key);
    for (int c = 0; c < 3; c++) {
        const char *comma = c < 2 ? ", " : "";
        if (isfinite(value[c])) {
            fprintf(f, "%.17g%s", value[c], comma);
        } else {
            fprintf(f, "null%s", comma);
        }
    }
    fputs("],\n", f);
}
