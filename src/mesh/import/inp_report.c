#include "mesh/import/inp_report.h"

#include <inttypes.h>
#include <string.h>
#include <strings.h>

#include "base/error.h"
#include "base/mem.h"

/* The entry of this name, a new one if need be. */
static size_t need(rg_inp_tally **list, size_t *count, const char *name) {
    size_t i = 0;
    while (i < *count && strcasecmp((*list)[i].name, name) != 0) {
        i++;
    }
    if (i == *count) {
        *list = rg_realloc(*list, *count + 1, sizeof **list);
        (*list)[(*count)++] = (rg_inp_tally){.count = 0};
        strcpy((*list)[i].name, name);
    }
    return i;
}

void rg_inp_report_keyword(rg_inp_report *r, const char *name) {
    size_t i = need(&r->keyword, &r->keywords, name);
    r->keyword[i].count++;
}

size_t rg_inp_report_type(rg_inp_report *r, const char *name, bool solid, rg_inp_place at) {
    size_t before = r->types, i = need(&r->type, &r->types, name);
    r->type[i].solid = solid;
    r->type[i].at = i == before ? at : r->type[i].at;
    return i;
}

/* "3 C3D8R, 1 C3D6": of solids, or of the others. */
static const char *list_types(const rg_inp_report *r, bool solid, char *text, size_t size) {
    size_t used = 0;
    text[0] = '\0';
    for (size_t i = 0; i < r->types && used < size; i++) {
        if (r->type[i].solid == solid && r->type[i].count > 0) {
            used += (size_t)snprintf(text + used, size - used, "%s%" PRId64 " %s", used > 0 ? ", " : "",
                                     r->type[i].count, r->type[i].name);
        }
    }
    return text;
}

void rg_inp_report_judge(const rg_inp_report *r, const char *path, bool flat) {
    char list[300];
    for (size_t i = 0; i < r->types; i++) {
        if (r->type[i].solid && r->type[i].count > 0) {
            rg_inp_refuse(
                r->type[i].at,
                "*ELEMENT, TYPE=%s: only tetrahedra are possible (C3D4, C3D10 and their kin), but there "
                "are other solids: %s; --split cuts hexahedra, wedges and pyramids",
                r->type[i].name, list_types(r, true, list, sizeof list));
        }
    }
    bool others = list_types(r, false, list, sizeof list)[0] != '\0';
    if (others && flat) {
        rg_fatal(RG_USAGE, "%s: --extrude takes triangles alone, but there are other elements: %s", path,
                 list);
    }
    if (others) {
        rg_warn("%s: elements that are no solids are left out: %s", path, list);
    }
}

void rg_inp_report_print(rg_inp_report *r, const char *path, FILE *out) {
    int64_t all = 0;
    for (size_t i = 0; i < r->keywords; i++) {
        all += r->keyword[i].count;
    }
    fprintf(out, "%s: %" PRId64 " keywords skipped, which say nothing of the mesh", path, all);
    for (size_t i = 0; i < r->keywords; i++) {
        fprintf(out, "%s%" PRId64 " *%s", i == 0 ? ": " : ", ", r->keyword[i].count, r->keyword[i].name);
    }
    fputc('\n', out);
    rg_free(r->keyword);
    rg_free(r->type);
}
