/* The fields of a solver: to add one, add a line here. From it follow the member of rg_solver, its memory,
 * who touches it first, its place in a checkpoint and its end (solver/fields.c).
 *
 * X(member, type, per, values, there, saved)
 *   type    REAL (of the precision of this build), DOUBLE or BYTE
 *   per     ELEMENT, FACE    [block][values][lane], in the layout of kernels/layout.h
 *           SPARSE_FACE      the same, of memory that is taken as it is written: for what few faces have
 *           BLOCK, FACE_BLOCK, TILE   [values]
 *   values, there   of the solver `s`, when its domain and law are known; not there: NULL
 *   saved   name of its dataset in a checkpoint; NULL: it follows from the others (rg_solver_resume). FACE:
 * kept for interfaces with a broken point alone */
#ifndef RG_FIELD_LIST_H
#define RG_FIELD_LIST_H

#define RG_FIELDS(X)                                                                                         \
    /* m; m/s at the half step; m/s at the time of u, where it was asked for */                              \
    X(u, REAL, ELEMENT, 3 * RG_NODES, true, "displacement")                                                  \
    X(velocity, REAL, ELEMENT, 3 * RG_NODES, true, "velocity")                                               \
    X(step_velocity, REAL, ELEMENT, 3 * RG_NODES, true, NULL)                                                \
    /* of each element for itself, then of the nodes (m/s^2) */                                              \
    X(acceleration, REAL, ELEMENT, 3 * RG_NODES, s->assembly != NULL, NULL)                                  \
    /* points that are broken, and that have left the lift, as bits */                                       \
    X(broken, BYTE, FACE, 1, true, "broken")                                                                 \
    X(unlinked, BYTE, FACE, 1, true, "unlinked")                                                             \
    /* state of all broken points, and the memory of their law */                                            \
    X(crack, REAL, SPARSE_FACE, s->model->crack_stride / RG_LANES, true, "crack")                            \
    /* of the materials */                                                                                   \
    X(history, REAL, ELEMENT, s->model->history_stride / RG_LANES, s->model->history_stride > 0, "history")  \
    /* of an element before anything is displaced (kernels/element/prestress.c) */                           \
    X(prestress, REAL, ELEMENT, RG_PRESTRESS, rg_case_has_stress(s->input), "prestress")                     \
    /* expansion by heat, and its work (kernels/layout.h) */                                                 \
    X(thermal, REAL, ELEMENT, RG_THERMAL, s->input->temperature.value != NULL, "thermal")                    \
    /* dissipated by bulk viscosity (J) */                                                                   \
    X(heat, DOUBLE, ELEMENT, 1, is_viscous(s->input), "heat")                                                \
    /* contact between fragments: 0 of an interface that holds, 1 from when it was found to have separated,  \
     * 2 once both its sides count as exposed; and the impulse that it gave each element (N s) */            \
    X(exposed, BYTE, FACE, 1, s->input->contact.model == RG_CONTACT_GENERAL, "exposed")                      \
    X(contact_sunk, REAL, FACE, 2, s->input->contact.model == RG_CONTACT_GENERAL, "contact_sunk")            \
    X(contact_impulse, DOUBLE, ELEMENT, 1, s->input->contact.model == RG_CONTACT_GENERAL, "contact_impulse") \
    /* how many times it began to touch something, and whether it does now */                                \
    X(contact_touches, DOUBLE, ELEMENT, 1, s->input->contact.model == RG_CONTACT_GENERAL, "contact_touches") \
    X(contact_touching, BYTE, ELEMENT, 1, s->input->contact.model == RG_CONTACT_GENERAL, "contact_touching") \
    /* sides of exposed interfaces that have been outside all bodies since, as bits */                       \
    X(body_clear, BYTE, FACE, 1, s->input->contact.model == RG_CONTACT_GENERAL && s->input->bodies > 0,      \
      "body_clear")                                                                                          \
    /* half of what friction and damping took of its pairs (J) */                                            \
    X(contact_heat, DOUBLE, ELEMENT, 1, rg_case_heats(s->input), "contact_heat")                             \
    /* tangent over the undeformed one, at most (1): of elements, of tiles */                                \
    X(stiffening, REAL, ELEMENT, 1, true, NULL)                                                              \
    X(tile_stiffening, REAL, TILE, 1, true, NULL)                                                            \
    /* largest of a tile's points (1/s), where the law asks for steps (solver/step_limiter.h) */             \
    X(tile_opening_rate, DOUBLE, TILE, 1, rg_law_steps(&s->model->law) > 0, NULL)                            \
    /* element blocks beside a broken point; interface blocks with one */                                    \
    X(cracked, BYTE, BLOCK, 1, true, NULL)                                                                   \
    X(active, BYTE, FACE_BLOCK, 1, true, NULL)                                                               \
    /* tiles that a watcher looks at */                                                                      \
    X(watched, BYTE, TILE, 1, true, NULL)

#define RG_TYPE_OF_REAL   rg_real
#define RG_TYPE_OF_DOUBLE double
#define RG_TYPE_OF_BYTE   uint8_t

#endif
