/* A material or a cohesive law of the user's own, as the program and its library see each other. `rhegma
 * material FILE.c` compiles user/material.c (of a law user/law.c) around the file, and that defines the one
 * symbol of the library, rg_user_here.
 *
 * The head never changes. Behind it everything may: then RG_USER_ABI goes up, and libraries that were made
 * before are refused. */
#ifndef RG_LIBRARY_H
#define RG_LIBRARY_H

#include "kernels.h"

enum {
    RG_USER_ABI = 2,
    /* What kernels are handed; where sizes differ, so do places, whoever forgot the number above. */
    RG_USER_LAYOUT = (int)(sizeof(rg_bulk_args) + 7 * sizeof(rg_bulk_state_args) + 63 * sizeof(rg_material) +
                           5 * sizeof(rg_interface_args) + 11 * sizeof(rg_interface_state_args)),
    RG_LIBRARY_HISTORY = 256, /* values per point, at most */
};

#define RG_USER_MAGIC  "rhegma-user"
#define RG_USER_SYMBOL "rg_user_here"

typedef struct {
    char magic[16];
    char kind[16]; /* "material", "law" */
    int32_t abi, layout;
    int32_t vector, real; /* bytes of a vector, of a number in it */
    char isa[32];         /* instruction set, as RHEGMA_ISA has it */
} rg_user_head;

/* The head of what is compiled here, of a kind. */
#define RG_USER_HEAD(kind_)                                                                                  \
    {                                                                                                        \
        .magic = RG_USER_MAGIC, .kind = kind_, .abi = RG_USER_ABI, .layout = RG_USER_LAYOUT,                 \
        .vector = RG_VBYTES, .real = sizeof(rg_real), .isa = RG_USER_ISA                                     \
    }

/* Parameters, as a file states them. */
#define RG_USER_LIST(list) .parameter = (list), .parameters = (int)(sizeof(list) / sizeof *(list))

/* A number that the case gives by name: required, or `fallback` where it does not. */
typedef struct {
    const char *name, *unit, *meaning; /* unit: NULL if it has none */
    double low, high;                  /* its range; both 0: any number */
    bool open;                         /* the range is without its ends */
    bool optional;
    double fallback;
} rg_user_parameter;

/* What a user's file says of its material, by RG_USER_MATERIAL (user/material.h). `parameter` of the
 * functions is in the order of the list. */
typedef struct {
    const char *name, *meaning; /* what it is called, in a few words */
    const rg_user_parameter *parameter;
    int parameters;
    unsigned inside; /* RG_HAS_DAMAGE, ...: which of the internal variables it has */
    bool small;      /* for small strains and rotations alone: it is not asked to be objective */
    double strain;   /* of the deformations at which it is checked; 0: 0.01 */
    double rate;     /* of strain, likewise (1/s); 0: 1000 */
    /* Lame constants (Pa) of an isotropic solid whose acoustic tensor is no less than that of this one at
     * rest: of them are wave speeds, penalty and contact. */
    void (*moduli)(const double parameter[], double *lambda, double *mu);
    /* What is wrong with parameters that are each in range; NULL: nothing. May be absent. */
    const char *(*wrong)(const double parameter[]);
} rg_user_facts;

/* One point, for the checks when a library is loaded: the step of a case, then the state that it leaves. */
typedef struct {
    double H[3][3];                     /* in: F - I */
    double history[RG_LIBRARY_HISTORY]; /* in/out */
    double P[3][3], stiffening, released[RG_RELEASED];
    double energy, J, state_P[3][3], internal[RG_INTERNAL];
} rg_user_point;

typedef struct rg_user_material {
    rg_user_head head;
    const rg_user_facts *facts;
    int history; /* values per point */
    void (*bulk)(const rg_bulk_args *args, size_t begin, size_t end);
    void (*bulk_state)(const rg_bulk_state_args *args, size_t begin, size_t end);
    /* Of RG_LANES points, each on its own. */
    void (*points)(const rg_material *m, bool advance, rg_user_point point[RG_LANES]);
} rg_user_material;

/* What a user's file says of its law, by RG_USER_LAW_IS (user/law.h). */
typedef struct {
    const char *name, *meaning;
    const rg_user_parameter *parameter;
    int parameters; /* at most RG_USER_WORK */
    /* Work of separation over strength times critical opening, and opening of full separation over the
     * critical one. */
    double (*work)(const double parameter[]);
    double (*end)(const double parameter[]);
} rg_user_law_facts;

/* One point of a law, for the checks. */
typedef struct {
    double strength, opening, largest; /* in: sigma_c (Pa), delta_c, largest opening so far (m) */
    double secant, dissipated;         /* out: Pa/m, J/m^2 */
} rg_user_law_point;

typedef struct rg_user_law {
    rg_user_head head;
    const rg_user_law_facts *facts;
    void (*interface)(const rg_interface_args *args, size_t begin, size_t end);
    void (*interface_state)(const rg_interface_state_args *args, size_t begin, size_t end);
    /* Of RG_LANES points, each on its own. */
    void (*points)(const rg_cohesive *law, rg_user_law_point point[RG_LANES]);
} rg_user_law;

#endif
