/* The energy ledger: kinetic + bulk + penalty + cohesive + contact + foundation + dissipated + plastic +
 * damage + viscous + friction + radiated + relaxed + joined - external work = constant. */
#ifndef RG_LEDGER_H
#define RG_LEDGER_H

#include "base/files.h"
#include "diagnostics/peak.h"
#include "solver/solver.h"

typedef struct {
    int64_t step;
    double time;
    double kinetic, bodies, bulk, penalty, cohesive, contact; /* J; kinetic: of the solid, bodies: of free
 rigid ones; contact: of cracks and of bodies */
    double foundation;                                        /* stored in elastic foundations (J) */
    double dissipated;                                        /* by cracks between elements (J) */
    double plastic,
        damage;         /* set free in the bulk by plastic flow and by growing microcracks (J); the latter
                     can be negative, where growth raises the stored energy (material/deshpande_evans_model.h) */
    double viscous;     /* dissipated by bulk viscosity (J) */
    double friction;    /* dissipated where closed cracks and fragments slide (J); what they store while they
                         * stick is    part of contact */
    double unresolved;  /* set free where points switched, beyond what their law can take, and where faces
                         * opened because their time had come (J) */
    double radiated;    /* taken out of the body by absorbing sides and dashpots (J) */
    double relaxed;     /* taken by damping on the way to the start (J) */
    double joined;      /* kinetic energy that went as sets were tied to rigid bodies (J) */
    double half_kick;   /* dt^2/8 a . M a: by so much what a central difference keeps is below the sum (J) */
    double external;    /* work done by prescribed motions and loads, also on the way to the start (J) */
    double total;       /* sum of the parts less the external work (J) */
    double error;       /* change of the total since the start, over the largest energy seen (or what
                         * rounding of F makes of the energy, if that is more: 1000 eps mu V) */
    double broken_area; /* of the points that switched, without faces open from the start (m^2) */
    double failed_area; /* of those that carry nothing any more (m^2) */
    double momentum[3], angular_momentum[3]; /* with free bodies: kg m/s, kg m^2/s about the origin */
    double spent;                            /* dissipated + plastic + damage + viscous + friction (J) */
    double share; /* change of the total since the start, over `spent`; not a number before that is
                   * RG_JUDGED of the largest energy */
} rg_energy;

/* From this part of the largest energy on the error is judged by what has been dissipated. */
#define RG_JUDGED 0.01

/* Of one material (J): its elements' kinetic and stored energy; what plastic flow, damage and viscosity took
 * in them and half of what cracks and friction took at their faces (all of it between two of them). */
typedef struct {
    double kinetic, bulk, dissipated;
} rg_energy_part;

enum { RG_LEDGER_MATERIALS = 32 };

typedef struct {
    bool begun;
    double start, largest; /* total at the start, largest energy so far (J) */
    double change;         /* largest |total - start| so far (J) */
    rg_energy last;
    rg_energy_part material[RG_LEDGER_MATERIALS]; /* if there are no more */
    rg_peak unresolved; /* the face with most of what its points' laws could not take (J) */
} rg_ledger;

/* The largest change of the total so far over the largest energy so far; infinite where one was no number. */
double rg_ledger_worst(const rg_ledger *l);

/* The same over what has been dissipated by now; not a number before that is
 * RG_JUDGED of the largest energy. */
double rg_ledger_share(const rg_ledger *l);

/* Whether the error, over the largest energy or over what has been dissipated, is beyond what the case
 * allows; then `why` says so. */
bool rg_ledger_off(const rg_ledger *l, const rg_case *c, char *why, size_t size);

/* Takes stock of the current state, between its kick and its drift. Sums are exact: the same bits on any
 * ranks and threads. Collective; returns &l->last. */
const rg_energy *rg_ledger_take(rg_ledger *l, rg_solver *s);

/* Time at which the first point switched (s), but for faces open from the start; infinite if none has.
 * Collective. */
double rg_first_fracture(const rg_solver *s);

/* Columns of energy.csv, and a row of it: of more than one material, but no more
 * than RG_LEDGER_MATERIALS, also the parts of each. */
void rg_energy_header(rg_csv *t, const rg_solver *s);
void rg_energy_row(rg_csv *t, const rg_ledger *l, const rg_solver *s);

#endif
