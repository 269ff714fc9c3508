/* Contact between faces that are exposed: those of the surface, and both sides of interfaces that have
 * separated. Pairs of them that may touch are found now and then (contact/search.h); what they do to each
 * other is computed in every step (kernels/contact).
 *
 * A face is the triangle that is nearest to it: its corners are those of the linear field u^ = Q u with the
 * same moments as the displacement on it. So forces on its corners are forces Q' f^ on its six nodes: a
 * pressure that is uniform or linear over the face is the exact load of that pressure, and a body under it in
 * the same stress everywhere.
 *
 * The rows u^ of faces that touch one of another rank travel with the traces; both ranks compute such a pair,
 * from the same numbers to the same bits. An element adds up what its faces feel face by face, in the order
 * of the partner's number. So results do not depend on ranks and threads, nor on when the search was made. */
#ifndef RG_CONTACT_ROOM_H
#define RG_CONTACT_ROOM_H

#include <mpi.h>

#include "base/exact_sum.h"
#include "case/case.h"
#include "contact/grip.h"
#include "contact/search.h"
#include "domain/face.h"
#include "domain/halo.h"
#include "kernels.h"

/* An interface that has come to be exposed may lie deep in its neighbours, under pressure. So that nothing
 * jumps then, its sides begin as far sunk as they are: by so much later do they press. As they come out of
 * each other, what they have sunk by falls with their depth. It is remembered, side by side of the
 * interfaces: sunk[interface block][2][lane]. */
typedef struct rg_contacts rg_contacts;

/* Of an interface: it holds, has separated, its sides are exposed, and they have been since just now. */
enum { RG_UNEXPOSED, RG_SEPARATED, RG_EXPOSED, RG_NEWLY_EXPOSED };

/* Without faces yet. Keeps references to `d` and `m`. NULL where contact is that of interfaces alone.
 * Collective; free with rg_contacts_free. */
rg_contacts *rg_contacts_make(const rg_case *c, const rg_domain *d, const rg_material *m, MPI_Comm comm);

/* Finds the exposed faces and the pairs anew: those of the surface and of the interfaces i with exposed[i]
 * = 2. Nothing may be under way. Collective. */
void rg_contacts_search(rg_contacts *c, const uint8_t *exposed, const rg_real *u);

/* The pair with the lowest numbers whose faces lie in each other deeper than their skin, after the forces
 * have been computed; then words[size] says where. Collective. */
bool rg_contacts_overlap(const rg_contacts *c, char *words, size_t size);

/* The rows of a tile's faces at displacement u, with the velocity (of the half step before) that damping
 * sees. */
void rg_contacts_place(rg_contacts *c, size_t tile, const rg_real *u, const rg_real *velocity,
                       const rg_real *sunk);

/* Books what damping takes of a tile's elements in the half step (s) after the last push, now that its faces
 * have the velocity of that: the energy of the solid changes by just that, to rounding. */
void rg_contacts_settle(rg_contacts *c, size_t tile, double half, double *heat);

/* Exchange of the rows; NULL where no rank has a pair with another one. */
rg_halo *rg_contacts_halo(const rg_contacts *c);

/* Forces of all pairs, in a step of `dt` (s), over which friction goes on: once for each state. 0: without
 * friction and damping. A worksharing loop: call it from all threads; ends with a barrier. */
void rg_contacts_meet(rg_contacts *c, const rg_kernels *kernels, double dt);

/* What contact has done to each element: impulse[slot] grows by the forces that its faces feel, by pairs,
 * times the length of the kick (N s), heat[slot] by half of what friction and damping took of each pair (J;
 * NULL: there is none), touches[slot] by 1 whenever it touches something and has not in the last
 * RG_TOUCH_AFRESH steps, from which touching[slot] counts down: faces that just lean on each other flutter.
 */
enum { RG_TOUCH_AFRESH = 100 };
typedef struct {
    double *impulse, *heat, *touches;
    uint8_t *touching;
    rg_real *sunk;
} rg_contact_record;

/* What they do to the elements of a tile, in a kick of length `dt`. */
void rg_contacts_push(const rg_contacts *c, size_t tile, const rg_push *push, double dt,
                      const rg_contact_record *to);

/* Faces of the surface, by bits [slots] (NULL: all that are exposed), of a material, and materials of what
 * they touch; -1: all. */
typedef struct {
    const uint8_t *faces;
    int of, by;
} rg_contact_choice;

/* Adds the force (N) that chosen faces of a tile feel now, and its moment about the origin (N m); returns
 * whether they touch anything. */
bool rg_contacts_force(const rg_contacts *c, size_t tile, const rg_contact_choice *which, double force[3],
                       double moment[3]);

/* Of that face of an element which is pressed most, where two are alike the first: the normal part of the
 * force on it now, and the force, by its deformed area (Pa); 0 where none touches anything. */
void rg_contacts_traction(const rg_contacts *c, size_t slot, double *pressure, double traction[3]);

/* By how much the sides of newly exposed interfaces have sunk, once the pairs have met. */
void rg_contacts_sink(const rg_contacts *c, const uint8_t *exposed, rg_real *sunk);

/* Adds the energy of a tile's pairs (J), those whose lower face is here. */
void rg_contacts_energy(const rg_contacts *c, size_t tile, rg_exact_sum *energy);

/* How far faces have moved since the search, with two more steps like the last one, over what they may; from
 * 1 on a search is due. Of this rank. */
double rg_contacts_moved(const rg_contacts *c);

/* Pairs that touch, those whose lower face is here; whether there may be any, on all ranks. */
int64_t rg_contacts_touching(const rg_contacts *c);
bool rg_contacts_any(const rg_contacts *c);

/* What contact adds to the largest squared frequency (1/s^2): at most, if all of the undeformed surface is
 * pressed; and of what touches now, of this rank. */
double rg_contacts_omega2(const rg_contacts *c);
double rg_contacts_omega2_now(const rg_contacts *c);

/* What friction remembers, as rows of a checkpoint (contact/grip.h): RG_GRIP_ROW values for each face here.
 * Those that are taken hold from the next search on. */
size_t rg_contacts_grips(const rg_contacts *c, int64_t **key, double **value);
void rg_contacts_take_grips(rg_contacts *c, size_t rows, const int64_t *key, const double *value);

void rg_contacts_free(rg_contacts *c);

#endif
