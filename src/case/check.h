/* Checking the tree of a case file against the registry of keys, and filling the case. */
#ifndef RG_CASE_CHECK_H
#define RG_CASE_CHECK_H

#include "case/key.h"
#include "case/tree.h"

typedef enum { RG_USED, RG_UNUSED, RG_UNSURE /* what decides is itself wrong */ } rg_usage;

/* Keys of an anisotropic solid. */
enum {
    RG_OF_YOUNG,
    RG_OF_POISSON,
    RG_OF_SHEAR,
    RG_OF_STIFFNESS,
    RG_OF_AXIS_1,
    RG_OF_AXIS_2,
    RG_OF_ANGLE_1,
    RG_OF_ANGLE_2,
    RG_OF_ANGLE_3,
    RG_OF_FIELD,
    RG_OF_ANGLES,
    RG_CONSTANTS
};

/* The block of a material that is being checked. */
typedef struct {
    const char *path; /* "material." or that of an entry of materials with a dot behind it */
    rg_material_input *of;
    bool model;                            /* its model is good */
    bool flaws;                            /* what the initial damage follows from is good */
    const rg_node *density;                /* its flaw_density; NULL: not there */
    const rg_node *block;                  /* itself; NULL: not there */
    const rg_node *constant[RG_CONSTANTS]; /* of an anisotropic solid: its keys; NULL: not there */
    bool constants;                        /* those are good so far */
    bool saturates;                        /* its saturation_stress is good */
    const rg_node *saturation;             /* its saturation_stress; NULL: not there */
    const rg_node *given[RG_PARAMETERS];   /* its other parameters that are there and good */
    bool bad[RG_PARAMETERS];               /* ... that are not good */
    const rg_node *library;                /* its library; NULL: not there, or not good */
} rg_material_check;

typedef struct {
    rg_problems *problems;
    rg_case *c;
    rg_usage usage[RG_GROUPS];
    bool box;                   /* mesh.origin and mesh.size are good */
    bool form;                  /* interface.form and .faces are good */
    bool models;                /* those of all materials are good */
    bool penalty_given;         /* interface.beta_s is there */
    bool switch_given;          /* interface.activation or .onset is there */
    const rg_node *law_library; /* interface.library; NULL: not there, or not good */
    rg_material_check material;
} rg_check;

/* Fills ck->c, a zeroed case, from the tree and reports every problem. */
void rg_case_check(rg_check *ck, const rg_node *root);

/* Reads one value of `key` (any type but a list of mappings) into the structure `base`. False: wrong and
 * reported under `path`. */
bool rg_value_read(rg_check *ck, const rg_key *key, const rg_node *node, const char *path, void *base);

/* Reads true or false, not in quotes; false: it is neither. */
bool rg_bool_read(const rg_node *node, bool *value);

/* Reports a wrong value with what the key allows; `nearest` may be NULL. */
void rg_value_wrong(rg_check *ck, const rg_key *key, const rg_node *node, const char *path,
                    const char *nearest, const char *what);

/* A path that the case gives relative to its own file; the same as one that holds anywhere. Free with
 * rg_free. */
char *rg_path_beside_case(const rg_check *ck, const char *path);
char *rg_path_of_case(const rg_check *ck, const char *path);

/* Makes mesh.file, given relative to the case file, a path that holds anywhere; reports a file that cannot be
 * read. */
void rg_mesh_file_rule(rg_check *ck, const rg_node *node);

/* Makes initial.stress.run a path that holds anywhere. Whether it can be read is seen when it is: a restart
 * does without it. */
void rg_stress_run_rule(rg_check *ck);

/* Rules of the materials (case/material.c), but for the last two of the block in ck->material: a model that
 * this build does not have; hardening that saturates, which needs a stress, not below the yield stress, and a
 * rate (at `node`); other parameters that go together, above or below each other; an initial damage that
 * leaves nothing to grow, reported at its flaw_density; what the name is made of (at `node`); output fields
 * that no material has, or, without `node`, those that they put out by default. */
void rg_model_rule(rg_check *ck, const rg_node *node);
void rg_saturation_rule(rg_check *ck, const rg_node *node);
void rg_parameters_rule(rg_check *ck);
void rg_flaw_rule(rg_check *ck);
void rg_material_name_rule(rg_check *ck, const rg_node *node);
void rg_anisotropic_rule(rg_check *ck); /* anisotropic.c: which keys go together, stable, axes */
void rg_user_rule(rg_check *ck, const rg_node *parameters);     /* user.c: what its library makes of it */
void rg_user_law_rule(rg_check *ck, const rg_node *parameters); /* ... and of a law */
void rg_fields_rule(rg_check *ck, const rg_key *key, const rg_node *node);
/* Reports output times after the end of the run. */
void rg_times_rule(rg_check *ck, const rg_node *node);

/* Which keys of the interface are used, from form and law, which must fit each other. */
void rg_law_rule(rg_check *ck, const rg_node *node, bool good);

/* Form continuous has no other mass than the lumped one, which is its default. */
void rg_mass_rule(rg_check *ck, const rg_node *node);

/* A conserving activation: whether interface.onset is used (with `node` NULL or wrong too), and what form and
 * law must be. */
void rg_activation_rule(rg_check *ck, const rg_node *node, bool good);

/* Contact `flux` brings DG terms back: form intrinsic has none, a conserving activation does not count them.
 */
void rg_contact_rule(rg_check *ck, const rg_node *node);

/* Shear that fades needs a conserving activation. */
void rg_shear_rule(rg_check *ck, const rg_node *node);

/* Mohr and Coulomb's criterion: what it needs beside it. */
void rg_criterion_rule(rg_check *ck, const rg_node *node);

/* Friction acts on faces that slide, which contact `flux` does not let them. */
void rg_static_friction_rule(rg_check *ck, const rg_node *node);
void rg_contact_friction_rule(rg_check *ck, const rg_node *list, int i, const char *path, bool good);

/* Names of materials in `between`: two, or (any) the word "any". */
void rg_between_rule(rg_check *ck, const rg_node *node, int count, char *const between[], bool any,
                     const char *path);
void rg_contact_model_rule(rg_check *ck, const rg_node *node);
void rg_friction_rule(rg_check *ck, const rg_node *node);

/* Why a key of `group`, which the interface has no use for, is not used: "form is intrinsic", "law is
 * linear". */
const char *rg_why_unused(rg_key_group group, const rg_case *c);

/* Rules that tie several keys together, applied to entry i of a list once its keys are read. `good`: all of
 * them were. An entry that is not is left so that later entries are not compared with it. */
void rg_boundary_rule(rg_check *ck, const rg_node *list, int i, const char *path, bool good);
void rg_load_rule(rg_check *ck, const rg_node *list, int i, const char *path, bool good);
void rg_body_rule(rg_check *ck, const rg_node *list, int i, const char *path, bool good);
void rg_probe_rule(rg_check *ck, const rg_node *list, int i, const char *path, bool good);
void rg_crack_front_rule(rg_check *ck, const rg_node *list, int i, const char *path, bool good);
void rg_crack_tip_rule(rg_check *ck, const rg_node *list, int i, const char *path, bool good);
void rg_contact_force_rule(rg_check *ck, const rg_node *list, int i, const char *path, bool good);
void rg_sensor_rule(rg_check *ck, const rg_node *list, int i, const char *path, bool good);
void rg_material_rule(rg_check *ck, const rg_node *list, int i, const char *path);
void rg_initial_set_rule(rg_check *ck, const rg_node *list, int i, const char *path, bool good);
/* Puts the rows of CSV files in the place of the entries of `materials` that name them (material_table.c). */
void rg_material_tables_expand(rg_check *ck, rg_node *root);

/* Puts what stands in the blocks of users' materials and is no key under `parameters` (user.c). */
void rg_user_parameters_gather(rg_node *root);

/* Fills the blocks of `material` and `materials` that name a preset with those of its keys that they do not
 * have and that their model uses. Reports names that are none (preset.c). */
void rg_presets_expand(rg_check *ck, rg_node *root);

void rg_face_set_rule(rg_check *ck, const rg_node *list, int i, const char *path, bool good); /* face_set.c */

/* Letters, digits, _ and - alone. */
bool rg_is_name(const char *text);

/* Checks the name of a list's entry, which becomes part of column headings: of what letters it is, and that
 * no body or probe before it has it. */
void rg_name_rule(rg_check *ck, const rg_node *item, const char *path, const char *name);

#endif
