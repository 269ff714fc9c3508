#include "mesh/import/solid.h"

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

/* Corners of S1, S2, ...; the fourth of a triangle is -1, and so is the first of a face that is not there. */
static const int tetrahedron[RG_SOLID_FACES][4] = {{0, 1, 2, -1}, {0, 3, 1, -1}, {1, 3, 2, -1},
                                                   {2, 3, 0, -1}, {-1},          {-1}};
static const int pyramid[RG_SOLID_FACES][4] = {{0, 1, 2, 3},  {0, 4, 1, -1}, {1, 4, 2, -1},
                                               {2, 4, 3, -1}, {3, 4, 0, -1}, {-1}};
static const int wedge[RG_SOLID_FACES][4] = {{0, 1, 2, -1}, {3, 5, 4, -1}, {0, 3, 4, 1},
                                             {1, 4, 5, 2},  {2, 5, 3, 0},  {-1}};
static const int hexahedron[RG_SOLID_FACES][4] = {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1},
                                                  {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}};

static const int (*faces_of(int corners))[4] {
    return corners == 8 ? hexahedron : corners == 6 ? wedge : corners == 5 ? pyramid : tetrahedron;
}

/* Takes a triangle unless two of its corners are the same. */
static int take(size_t triangle[2][3], int count, size_t a, size_t b, size_t c) {
    if (a == b || b == c || c == a) {
        return count;
    }
    memcpy(triangle[count], (const size_t[3]){a, b, c}, sizeof triangle[count]);
    return count + 1;
}

int rg_solid_quadrangle(const size_t corner[4], size_t triangle[2][3]) {
    int low = 0;
    for (int i = 1; i < 4; i++) {
        low = corner[i] < corner[low] ? i : low;
    }
    size_t a = corner[low], b = corner[(low + 1) % 4], c = corner[(low + 2) % 4], d = corner[(low + 3) % 4];
    return take(triangle, take(triangle, 0, a, b, c), a, c, d);
}

int rg_solid_face(int corners, int face, const size_t node[], size_t triangle[2][3]) {
    const int *at = faces_of(corners)[face];
    size_t corner[4] = {0, 0, 0, 0};
    int count = at[3] >= 0 ? 4 : 3;
    if (at[0] < 0) {
        return 0;
    }
    for (int i = 0; i < count; i++) {
        corner[i] = node[at[i]];
    }
    return count == 3 ? take(triangle, 0, corner[0], corner[1], corner[2])
                      : rg_solid_quadrangle(corner, triangle);
}

/* From the corner of the lowest number to all triangles that do not have it: the faces that do are cut from
 * it. */
int rg_solid_split(int corners, const size_t node[], size_t tet[RG_SOLID_TETS][4]) {
    size_t apex = node[0], triangle[2][3];
    int count = 0;
    for (int i = 1; i < corners; i++) {
        apex = node[i] < apex ? node[i] : apex;
    }
    for (int face = 0; face < RG_SOLID_FACES; face++) {
        int triangles = rg_solid_face(corners, face, node, triangle);
        for (int t = 0; t < triangles; t++) {
            const size_t *v = triangle[t];
            if (v[0] != apex && v[1] != apex && v[2] != apex) {
                memcpy(tet[count++], (const size_t[4]){v[0], v[1], v[2], apex}, sizeof tet[0]);
            }
        }
    }
    return count;
}
