/* The entries of `boundary` that prescribe a motion: on which faces, along which lines, what and when.
 *
 * An entry prescribes along one line, of coordinates or not, or along each face's own normal; an angle along
 * all three axes: places of a rigid body that turns about an axis, u = d + (R - I)(X - a), R by Rodrigues. */
#ifndef RG_SUPPORTS_H
#define RG_SUPPORTS_H

#include <mpi.h>
#include <stdbool.h>

#include "base/first_bad.h"
#include "case/case.h"
#include "domain/assembly.h"
#include "domain/domain.h"
#include "solver/account.h"
#include "solver/selection.h"

typedef struct {
    const rg_case *input;
    const rg_domain *domain;
    rg_account *account;
    uint8_t **faces; /* [boundaries][slots]: bits of its faces; NULL: it absorbs */
    uint16_t **
        nodes; /* [boundaries][slots]: bits of the nodes on them; where elements share nodes, on all copies */
    rg_selected *on;         /* [boundaries]: its faces */
    int *item;               /* [boundaries]: of the account; -1: it has no name */
    bool named;              /* some have */
    bool timed;              /* some begin or end */
    bool *acts;              /* [boundaries]: at present */
    double dt_last, dt_kick; /* the step that led here; that of the kick */
    rg_first_bad bad;        /* where a value was not finite first, and when */
} rg_supports;

/* Those of a case on this rank. `nodes`: by which elements share nodes; NULL: they do not. Ends the run with
 * a message where an entry selects nothing, or two prescribe the same at the same time. Keeps references to
 * all but `part`. Collective; free with rg_supports_free. */
rg_supports *rg_supports_make(const rg_case *c, const rg_domain *d, const rg_part *part, rg_assembly *nodes,
                              rg_account *account, MPI_Comm comm);

/* Frees what only the set-up needs: faces and nodes. */
void rg_supports_forget(rg_supports *s);

/* Whether an entry prescribes along lines that are not axes. */
bool rg_support_is_oblique(const rg_boundary *b);

/* Whether it prescribes axis c of coordinates. */
bool rg_support_has_axis(const rg_boundary *b, int c);

/* Whether what is prescribed changes with time, or does so by being a place. */
bool rg_support_varies(const rg_boundary *b);

/* What is prescribed at place x of reference and a time: of an angle the displacement along axis c. */
double rg_support_value(const rg_boundary *b, int c, const double x[3], double time);

/* Velocity at `time`; of a prescribed place, its difference over a step around it. */
double rg_support_velocity(const rg_boundary *b, int c, const double x[3], double time, double dt);

/* A kick at `time`: which entries act. */
void rg_supports_set(rg_supports *s, double time, double dt_last, double dt);

/* Notes that boundary b was told something that is not finite at x, `time`. */
void rg_supports_note(rg_supports *s, int b, const double x[3], double time);

/* Collective: whether a value was not finite in any step so far; then words[size] says which, where and when
 * first. */
bool rg_supports_told(const rg_supports *s, char *words, size_t size, MPI_Comm comm);

/* Entry b in words: "velocity along x on 2.5e-09 m2, 2 faces of steel". */
void rg_supports_describe(const rg_supports *s, int b, char *words, size_t size);

void rg_supports_free(rg_supports *s);

#endif
