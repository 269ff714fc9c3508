#include "mesh/import/inp_type.h"

#include <ctype.h>
#include <stdbool.h>
#include <stddef.h>
#include <string.h>
#include <strings.h>

/* Whether the name is `begin` and more that does not go on with its number: C3D4H is a C3D4, C3D40 is not. */
static bool is(const char *name, const char *begin) {
    size_t length = strlen(begin);
    return strncasecmp(name, begin, length) == 0 && !isdigit((unsigned char)name[length]);
}

/* Stress, heat, acoustic, fluid, electromagnetic, coupled. (F3D4 is a tetrahedron of fluid in CalculiX and a
 * face of a fluid cavity in Abaqus: refused.) */
static const char *const solid[] = {"C3D",  "DC3D",  "AC3D",  "FC3D", "EMC3D", "Q3D", "F3D", "DCC3D",
                                    "EC3D", "CIN3D", "COH3D", "GK3D", "SC6",   "SC8", "CSS", "CCL"};
enum { WITH_TETRAHEDRA = 6 }; /* so many of these, the first */

static const struct {
    const char *nodes;
    rg_inp_type type;
} of_corners[] = {{"4", {RG_INP_TETRAHEDRON, 4, 0}}, {"10", {RG_INP_TETRAHEDRON, 10, 0}},
                  {"8", {RG_INP_SOLID, 8, 8}},       {"20", {RG_INP_SOLID, 20, 8}},
                  {"6", {RG_INP_SOLID, 6, 6}},       {"15", {RG_INP_SOLID, 15, 6}},
                  {"5", {RG_INP_SOLID, 5, 5}},       {"13", {RG_INP_SOLID, 13, 5}}};

static const char *const quadrangle[] = {"S", "CPS", "CPE", "CPEG", "M3D", "SFM3D", "R3D", "DS", "DC2D"};

static const struct {
    const char *begin;
    int nodes;
} triangle[] = {{"S3", 3},   {"STRI3", 3}, {"STRI65", 6}, {"S6", 6},     {"CPS3", 3},
                {"CPS6", 6}, {"CPE3", 3},  {"CPE6", 6},   {"CPEG3", 3},  {"CPEG6", 6},
                {"M3D3", 3}, {"M3D6", 6},  {"SFM3D3", 3}, {"SFM3D6", 6}, {"R3D3", 3},
                {"DS3", 3},  {"DS6", 6},   {"DC2D3", 3},  {"DC2D6", 6}};

/* As Gmsh writes the edges of flat meshes. */
static const char *const line[] = {"T2D2", "T3D2", "B21", "B31"};

rg_inp_type rg_inp_type_of(const char *name) {
    for (size_t i = 0; i < sizeof line / sizeof *line; i++) {
        if (is(name, line[i])) {
            return (rg_inp_type){RG_INP_LINE, 2, 0};
        }
    }
    for (size_t i = 0; i < sizeof triangle / sizeof *triangle; i++) {
        if (is(name, triangle[i].begin)) {
            return (rg_inp_type){RG_INP_TRIANGLE, triangle[i].nodes, 0};
        }
    }
    for (size_t i = 0; i < sizeof quadrangle / sizeof *quadrangle; i++) {
        size_t length = strlen(quadrangle[i]);
        const char *nodes = name + length;
        if (strncasecmp(name, quadrangle[i], length) == 0 &&
            (is(nodes, "4") || is(nodes, "8") || is(nodes, "9"))) {
            return (rg_inp_type){RG_INP_QUADRANGLE, nodes[0] - '0', 0};
        }
    }
    for (size_t i = 0; i < sizeof solid / sizeof *solid; i++) {
        size_t length = strlen(solid[i]);
        if (strncasecmp(name, solid[i], length) != 0) {
            continue;
        }
        for (size_t k = 0; k < sizeof of_corners / sizeof *of_corners; k++) {
            size_t digits = strlen(of_corners[k].nodes);
            bool variable = strncasecmp(name + length + digits, "V", 1) == 0; /* C3D15V: in its nodes */
            if (i < WITH_TETRAHEDRA && !variable && is(name + length, of_corners[k].nodes)) {
                return of_corners[k].type;
            }
        }
        return (rg_inp_type){RG_INP_SOLID, 0, 0};
    }
    return (rg_inp_type){RG_INP_OTHER, 0, 0};
}
