/* Element types of Abaqus and CalculiX. */
#ifndef RG_INP_TYPE_H
#define RG_INP_TYPE_H

typedef enum {
    RG_INP_TETRAHEDRON,
    RG_INP_TRIANGLE,
    RG_INP_QUADRANGLE,
    RG_INP_LINE,
    RG_INP_SOLID,
    RG_INP_OTHER
} rg_inp_shape;

typedef struct {
    rg_inp_shape shape; /* SOLID: of another shape; OTHER: no solid (a mass, a spring, ...) */
    int nodes; /* of a tetrahedron 4 or 10, triangle 3 or 6, quadrangle 4, 8 or 9, line 2; of a SOLID that can
                  be split: */
    int corners; /* of such a one: 8, 6 or 5 (hexahedron, wedge, pyramid) */
} rg_inp_type;

/* Of a name in any case: C3D10MH, DC3D4, S3R, ... */
rg_inp_type rg_inp_type_of(const char *name);

#endif
