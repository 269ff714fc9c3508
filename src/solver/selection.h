/* Faces on the surface, or of interfaces, that an entry of the case selects: those of a named set, or those
 * where an expression of their middle and their outward normal is not 0. */
#ifndef RG_SELECTION_H
#define RG_SELECTION_H

#include <mpi.h>

#include "case/case.h"
#include "domain/domain.h"

typedef struct {
    const char *list; /* of which it is an entry, and its number: "loads", 3 */
    int number;
    const char *set;      /* or */
    const rg_expr *where; /* NULL: by the set; both: all */
    bool inside; /* of faces with an interface, where the normal is of either sign, the same on both sides */
} rg_selection;

/* Bits of the selected faces of each element: [slots]; the caller frees them. Ends the run with a message
 * where the mesh has no such set, the expression is not finite or nothing is selected. Collective. */
uint8_t *rg_selection_faces(const rg_selection *s, const rg_case *c, const rg_domain *d, const rg_part *part,
                            MPI_Comm comm);

/* What is selected, of all ranks: how many faces, or elements; their area (m2), or volume (m3), of reference;
 * and, where the case has several materials, of which: " of glass and steel". */
typedef struct {
    int64_t count;
    double size;
    char of[120];
} rg_selected;

/* Of faces by their bits, or `whole` elements by bit 0: [slots]. Collective. */
rg_selected rg_selection_measure(const uint8_t *on, bool whole, const rg_case *c, const rg_domain *d,
                                 MPI_Comm comm);

/* Writes "0.01 m2, 8 faces of glass", or of `whole` elements "1e-9 m3, 1 element". */
void rg_selected_tell(const rg_selected *s, bool whole, char *words, size_t size);

#endif
