/* Quadrature rules of the tetrahedron and of its faces. */
#ifndef RG_QUADRATURE_H
#define RG_QUADRATURE_H

/* Four-point rule: barycentric coordinate RG_GAUSS_B at the own corner, RG_GAUSS_A at the others; weight 1/4.
 */
#define RG_GAUSS_A  0.13819660112501051518
#define RG_GAUSS_B  0.58541019662496845446
#define RG_GAUSS_BA (RG_GAUSS_B - RG_GAUSS_A)

/* Six-point rule of a triangle: points 0-2 have 1 - 2p at corner i and p at the others, points 3-5 likewise.
 */
#define RG_TRI_P0 0.445948490915965
#define RG_TRI_W0 0.223381589678011
#define RG_TRI_P1 0.091576213509771
#define RG_TRI_W1 0.109951743655322

#endif
