/* One moment of the field output of a run, as one file that other programs open. */
#ifndef RG_EXPORT_H
#define RG_EXPORT_H

#include <stdbool.h>
#include <stdio.h>

/* What kind of file a name asks for: by its ending. */
typedef enum { RG_EXPORT_NONE, RG_EXPORT_VTU, RG_EXPORT_VTP, RG_EXPORT_STL } rg_export_kind;

rg_export_kind rg_export_kind_of(const char *path);

/* Prints the numbers and times of the moments of the run in `dir`. These functions end the run with a message
 * (RG_USAGE) where `dir` has no field output, or lacks what is asked for. */
void rg_export_list(const char *dir, FILE *out);

/* Writes the moment nearest to `time` (s; infinite: the last one) to `path`, of that kind: the body with all
 * fields that the run wrote, in reference (.vtu), or its crack surface, where that is then (`crack`; always
 * for .vtp and .stl, of which the latter has no fields). Tensors in VTK's order. Returns the moment's time.
 */
double rg_export(const char *dir, double time, bool crack, const char *path);

#endif
