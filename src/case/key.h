/* The registry of all keys of a case file. Reading, checking, suggestions, echo and freeing all derive from
 * it. */
#ifndef RG_CASE_KEY_H
#define RG_CASE_KEY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "case/case.h"
#include "case/problem.h"

typedef enum {
    RG_KEY_REAL,    /* double [count] */
    RG_KEY_INTEGER, /* int64_t [count] */
    RG_KEY_CHOICE,  /* an enum: position in `choice` */
    RG_KEY_FLAGS,   /* unsigned: list of entries of `choice`, one bit each */
    RG_KEY_TEXT,    /* char *: any text, or one of `choice` if given */
    RG_KEY_TEXTS,   /* char **: list of such texts */
    RG_KEY_REALS,   /* double *: list of any length */
    RG_KEY_EXPR,    /* rg_expr *: number or expression */
    RG_KEY_FACE,    /* the same of a face, where place and normal are known, an rg_expr * at offset_expr; of a
                       number also double */
    RG_KEY_BOOL,    /* bool */
    RG_KEY_INTERVAL,   /* output.interval: steps or seconds, by the kind of number */
    RG_KEY_LIBRARY,    /* rg_library_input: path of a library, kept with a hash of what it holds */
    RG_KEY_PARAMETERS, /* of the library before it: mapping of names, which its library knows, to numbers */
    RG_KEY_TABLES,     /* rg_curves: mapping of names to tables */
    RG_KEY_LIST,       /* array of mappings with the keys of `entry` */
} rg_key_type;

typedef enum {
    RG_NEED_REQUIRED,
    RG_NEED_DEFAULT,  /* `fallback`, in every component */
    RG_NEED_OPTIONAL, /* absent is 0 (of vectors: all three) or NULL, or derived from other keys */
} rg_key_need;

/* Keys that are used only in some cases; given in others, they are refused rather than ignored. */
typedef enum {
    RG_GROUP_ALWAYS,
    RG_GROUP_BOX,        /* unless mesh.file */
    RG_GROUP_COHESIVE,   /* unless interface.law is none */
    RG_GROUP_ENERGY,     /* if the law has a work of separation */
    RG_GROUP_SHEAR,      /* if the law has an effective opening */
    RG_GROUP_LAW,        /* if interface.law is the key's `law` */
    RG_GROUP_FACES,      /* if interface.form is continuous */
    RG_GROUP_INTERFACE,  /* unless it is, and interface.faces is not given */
    RG_GROUP_DG,         /* the same, and unless interface.form is intrinsic */
    RG_GROUP_SWITCH,     /* if points switch from DG to a law: there is one, and DG terms */
    RG_GROUP_ONSET,      /* ... by the conserving activation */
    RG_GROUP_WEIBULL,    /* if interface.weibull.modulus is given */
    RG_GROUP_RISE,       /* if interface.rise.rate is given */
    RG_GROUP_HEAT,       /* if temperature.value is given */
    RG_GROUP_RELAX,      /* if start is relax */
    RG_GROUP_STRESS_RUN, /* if initial.stress.run is given */
    RG_GROUP_CONTACT,    /* if contact.model is general */
    RG_GROUP_LINE,       /* boundary entries: if a velocity or displacement is prescribed */
    RG_GROUP_COMPONENT,  /* ... of a component */
    RG_GROUP_RIGID,      /* ... if an angle is */
    RG_GROUP_MOTION,     /* ... if anything is */
    RG_GROUP_PRESCRIBED, /* boundary entries: if that is what is prescribed */
    RG_GROUPS,
} rg_key_group;

/* Of keys of a table that have this some must be given. */
typedef enum { RG_NO_ALTERNATIVE, RG_EXACTLY_ONE, RG_AT_LEAST_ONE } rg_key_alternative;

struct rg_key_table;

typedef struct rg_key {
    const char *name;    /* dotted path within the mapping that the table describes */
    const char *unit;    /* NULL if it has none */
    const char *meaning; /* a sentence without capital and full stop */
    const char *absent;  /* what holds where it is not given, in words; NULL: `fallback`, or 0 */
    rg_key_type type;
    rg_key_need need;
    rg_key_group group;
    rg_key_alternative alternative;
    rg_prescribed prescribed;          /* of RG_GROUP_PRESCRIBED */
    bool of_material;                  /* in the block of a material */
    size_t input;                      /* of one that is: offset of its rg_material_input in the structure */
    unsigned models;                   /* materials.h: bits of the models that use it; 0: all */
    unsigned as_models;                /* ... of those that take something else by it: */
    const struct rg_key *as;           /* that; its offset is within rg_material_input */
    int count;                         /* numbers */
    const char *entries;               /* of more than one: their names; NULL: x, y, z */
    double low, high;                  /* numbers: range */
    bool low_open, high_open;          /* range without its ends */
    bool no_time, no_place;            /* expression without t; without x, y, z */
    bool normal;                       /* expression of a face, with nx, ny, nz */
    bool may_change;                   /* on a restart: nothing that was computed depends on it */
    const char *const *choice;         /* NULL-terminated; of a text: with the built-in mesh only */
    const char *const *choice_meaning; /* what each means; NULL: the words say it */
    double fallback;
    double (*fallback_of)(const rg_case *); /* default.h: where keys before it decide; `absent` says how */
    rg_law law;                             /* of a parameter of one law (RG_GROUP_LAW) */
    size_t offset;                          /* of the value in the structure */
    const struct rg_key_table *entry;       /* of a list */
    size_t offset_count;                    /* of lists: where their length (int) is kept */
    size_t offset_expr;                     /* of RG_KEY_FACE: its rg_expr * */
} rg_key;

typedef struct rg_key_table {
    const rg_key *key;
    int keys;
    size_t size; /* of the structure that the keys fill */
} rg_key_table;

enum { RG_MAX_KEYS = 256 }; /* at most, in a table */

/* A key comes after the keys that decide whether its group is used. */
extern const rg_key_table rg_case_table, rg_material_table, rg_boundary_table, rg_body_table, rg_probe_table,
    rg_sensor_table, rg_crack_tip_table, rg_crack_front_table, rg_face_set_table, rg_contact_friction_table,
    rg_contact_force_table, rg_load_table, rg_initial_set_table;

/* What a value of the key must be, in words. Returns `text`. */
const char *rg_key_allowed(const rg_key *key, char *text, size_t size);

/* The key as the model of its material in the structure `base` takes it. */
rg_key rg_key_here(const rg_key *key, const void *base);

/* The models that use the key, in words. */
void rg_models_words(const rg_key *key, char *text, size_t size);

/* The law's name in a case file, "none" included. */
const char *rg_law_word(rg_law law);

/* What holds where the key is not given, in words: a default, "required", or "this or NAME" of alternatives.
 * Returns `text`. */
const char *rg_key_default(const rg_key *key, char *text, size_t size);

/* Whether these words are a default. */
bool rg_key_has_default(const rg_key *key);

/* Whether the key is used in the filled structure `base`. */
bool rg_key_used(const rg_key *key, const void *base);

/* The same for a group that follows from law and form (RG_GROUP_COHESIVE to RG_GROUP_SWITCH, but for
 * RG_GROUP_LAW). */
bool rg_group_used(rg_key_group group, const rg_case *c);

/* The key with exactly this name, or NULL. */
const rg_key *rg_key_find(const rg_key_table *table, const char *name);

/* True if some key lies below `name`: "mesh", "initial.velocity". */
bool rg_key_is_section(const rg_key_table *table, const char *name);

/* The part of the key's name that stands in `section` ("interface." or ""), with its length; NULL if the key
 * lies elsewhere. */
const char *rg_key_part(const rg_key *key, const char *section, size_t *size);

/* What stands in a section, in words. Returns `text`. */
const char *rg_keys_in(const rg_key_table *table, const char *section, char *text, size_t size);

/* The key or section probably meant by `name`, in `text`, or NULL. */
const char *rg_key_nearest(const rg_key_table *table, const char *name, char *text, size_t size);

/* The pointer (to whatever type) kept at `place`. */
static inline void *rg_pointer_get(const void *place) {
    void *pointer = NULL;
    memcpy(&pointer, place, sizeof pointer);
    return pointer;
}

static inline void rg_pointer_set(void *place, const void *pointer) {
    memcpy(place, &pointer, sizeof pointer);
}

/* Whether the structure `base` has a value of the key to write, and writes it in YAML (no list). */
bool rg_key_present(const rg_key *key, const void *base);
void rg_key_write(FILE *out, const rg_key *key, const void *base);

/* Frees what the keys' values own in `base`. */
void rg_keys_free(const rg_key_table *table, void *base);

#endif
