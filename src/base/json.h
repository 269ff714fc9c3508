/* Members of a JSON object, each on a line of its own with a comma behind it. */
#ifndef RG_JSON_H
#define RG_JSON_H

#include <stdint.h>
#include <stdio.h>

void rg_json_text(FILE *f, const char *key, const char *value);
void rg_json_integer(FILE *f, const char *key, int64_t value);

/* JSON knows no infinity: null where there is no finite value. */
void rg_json_number(FILE *f, const char *key, double value);
void rg_json_vector(FILE *f, const char *key, const double value[3]);

#endif
