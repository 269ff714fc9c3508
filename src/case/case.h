/* The case file: what a run computes. Strict YAML; every problem is reported at once with its place. */
#ifndef RG_CASE_H
#define RG_CASE_H

#include <stdbool.h>
#include <stdint.h>

#include "case/curve.h"
#include "case/expr.h"
#include "kernels.h"
#include "materials.h"
#include "modes.h"

typedef enum { RG_INTERACTION_THESIS, RG_INTERACTION_DERIVED } rg_interaction;
typedef enum { RG_OUTPUT_DOUBLE, RG_OUTPUT_SINGLE } rg_output_precision;
typedef enum { RG_FRAGMENTS_EACH, RG_FRAGMENTS_LAST, RG_FRAGMENTS_NONE } rg_fragments_when;
typedef enum { RG_KEEP_ENERGY, RG_KEEP_OPENING } rg_keep;
typedef enum { RG_BREAKING_BY_LAW, RG_BREAKING_NEVER } rg_breaking;
typedef enum { RG_SHAPE_SPHERE, RG_SHAPE_PLANE, RG_SHAPE_CYLINDER, RG_SHAPE_NONE } rg_shape_kind;
typedef enum { RG_START_INITIAL, RG_START_STATIC, RG_START_RELAX } rg_start;
typedef enum { RG_MOTION_FREE, RG_MOTION_PRESCRIBED } rg_motion;
typedef enum { RG_CONTACT_OF_INTERFACES, RG_CONTACT_GENERAL } rg_contact_model;

/* output.fields, as bits */
enum {
    RG_FIELD_DISPLACEMENT = 1,
    RG_FIELD_VELOCITY = 2,
    RG_FIELD_STRESS = 4,        /* Cauchy stress, mean per element */
    RG_FIELD_MEAN = 8,          /* mean stress */
    RG_FIELD_PRINCIPAL = 16,    /* principal stresses, largest first */
    RG_FIELD_CRACK = 32,        /* crack surface */
    RG_FIELD_DAMAGE = 64,       /* of the material: mean per element */
    RG_FIELD_REGIME = 128,      /* largest of the element's points */
    RG_FIELD_PLASTIC = 256,     /* equivalent plastic strain: mean per element */
    RG_FIELD_TRIAXIALITY = 512, /* mean over von Mises stress, of the mean Cauchy stress */
    RG_FIELD_RANK = 1024,       /* rank that owns the element, and that speaks for the cracked face */
    RG_FIELD_FRAGMENT = 2048,   /* id of the fragment */
    RG_FIELD_MATERIAL = 4096,   /* number of the material: 0 that of `material`, then those of `materials` */
    RG_FIELD_VOLUME = 8192,     /* plastic part of log J: mean per element */
    RG_FIELD_BULKING = 16384,   /* pressure that bulking has added: mean per element */
    RG_FIELD_TEMPERATURE = 32768,
    RG_FIELD_CONTACT = 65536, /* pressure and traction by which fragments meet, and heat of their friction */
    RG_FIELDS_COMMON = 63 | RG_FIELD_FRAGMENT, /* what every run puts out by default */
};

/* The registry of prescribed motions, of which an entry of `boundary` is one: X(NAME, key, unit, meaning),
 * with `join` between them. What each does to the nodes: solver/motion.h. */
#define RG_PRESCRIBED(X, join)                                                                               \
    X(VELOCITY, "velocity", "m/s", "prescribed velocity")                                                    \
    join X(DISPLACEMENT, "displacement", "m", "prescribed displacement") join X(                             \
        NORMAL, "normal", "m/s",                                                                             \
        "velocity along each face's outward normal of reference, free across: 0 is a roller") join           \
    X(ANGLE, "angle", "rad", "the set moves as a rigid body, turned by so much about `axis`")

#define RG_PRESCRIBED_ENUM(NAME, key, unit, meaning) RG_PRESCRIBED_##NAME,
#define RG_PRESCRIBED_KEY(NAME, key, unit, meaning)  key
typedef enum { RG_PRESCRIBED(RG_PRESCRIBED_ENUM, ) RG_PRESCRIBED_KINDS } rg_prescribed;

typedef struct {
    char *name;          /* column prefix in history.csv; NULL: it has no columns */
    char *set;           /* named set of faces, or */
    rg_expr *where;      /* not 0: faces of the surface, by their middle and outward normal */
    int component;       /* 0, 1, 2 for x, y, z; -1: of what has none */
    double direction[3]; /* of a velocity or displacement in place of a component, of any length; or 0 */
    rg_prescribed prescribed;
    rg_expr *value;
    double axis[3], at[3];   /* about which an angle turns; a point of it (m) */
    rg_expr *translation[3]; /* of a point of the axis (m), beside an angle; NULL: 0 */
    bool absorbing;          /* waves leave by it, and nothing is prescribed; or */
    double dashpot;          /* traction over velocity (N s/m^3); 0: it is none */
    double from, until;      /* a motion is prescribed in between (s); until 0: without end */
} rg_boundary;

/* What a load is, of which it has one: X(NAME, key, unit), with `join` between them. What each does:
 * solver/load.c. */
#define RG_LOADS(X, join)                                                                                    \
    X(TRACTION, "traction", "Pa")                                                                            \
    join X(PRESSURE, "pressure", "Pa") join X(FORCE, "force", "N") join X(ACCELERATION, "acceleration",      \
                                                                          "m/s2") join                       \
    X(FOUNDATION, "foundation", "N/m3") join                                                                 \
    X(CENTRIFUGAL, "centrifugal", "rad/s")

#define RG_LOAD_ENUM(NAME, key, unit) RG_LOAD_##NAME,
#define RG_LOAD_KEY(NAME, key, unit)  key
typedef enum { RG_LOADS(RG_LOAD_ENUM, ) RG_LOAD_KINDS } rg_load_kind;

typedef struct {
    char *name;     /* column prefix in history.csv; NULL: it has no columns */
    char *set;      /* named set of faces, or */
    rg_expr *where; /* not 0: on faces, by their middle and outward normal; of accelerations, at centroids */
    bool cracks;    /* of a pressure: on faces between elements, as they open; all, or where those two say */
    rg_load_kind kind;
    rg_expr *value[RG_LOAD_KINDS][3]; /* of its kind, x, y, z (of some the first alone); NULL: 0 */
    double axis[3], at[3];            /* of centrifugal forces: of any length; a point of it (m) */
    double from, until;               /* it acts in between (s); until 0: without end */
} rg_load_input;

/* An anisotropic solid: its stiffness, or in its place constants of a solid with three planes of symmetry,
 * whose order is that of base/stiffness.h; all 0 what is not given. Its axes: two of them, or angles. */
typedef struct {
    double stiffness[RG_STIFFNESS], young[3], poisson[3], shear[3]; /* Pa */
    double axis[2][3], angles[3];                                   /* of any length; degrees */
    rg_expr *angle[3]; /* in place of angles, at the centroid of an element (degrees); NULL: 0 */
    char *field;       /* ... or the name of a field of the mesh file; NULL: none */
} rg_anisotropic_input;

/* What the checks of a user's material found (case/user_check.c): deviations over the largest stress or
 * energy there was, and ratios. */
typedef struct {
    bool energetic;     /* it gives an energy */
    double energy;      /* stress against differences of the energy */
    double turned;      /* of a turned state against the turned stress and the same energy */
    double symmetric;   /* Kirchhoff's stress against its transpose */
    double tangent;     /* the tangent against its transpose */
    double modulus[2];  /* least and most of the acoustic tensor at rest over that of the moduli declared */
    double stiffening;  /* most of that of deformed states over the bound given */
    bool path;          /* it has a history, and the following hold: */
    double balance;     /* work of a cycle against what is stored and set free */
    double path_turned; /* of a cycle on which the solid turns besides, likewise */
    double step;        /* stress of a step against that of the state that it leaves */
    double released;    /* share of the work put in that the cycle sets free */
} rg_user_report;

/* A library of the user's (kernels/library.h). */
typedef struct {
    char *path;    /* absolute once loaded */
    uint64_t hash; /* of what it holds */
} rg_library_input;

/* A material of one. */
typedef struct {
    rg_library_input library;
    rg_user_values is;
    rg_user_report report;
} rg_user_input;

/* A law of one; its parameters are those of `shape`. */
typedef struct {
    rg_library_input library;
    const struct rg_user_law *is;
    double share;  /* what a monotonic opening takes over the energy of the case */
    double closed; /* most by which dissipated and stored work differ from it, over it */
} rg_user_law_input;

typedef struct {
    rg_material_model model;
    double young, poisson, density;
    rg_anisotropic_input anisotropic;
    double parameter[RG_PARAMETERS];    /* materials.h */
    rg_deshpande_evans deshpande_evans; /* but for poisson, density, yield_stress and single_pi */
    rg_interaction interaction;         /* c3 of the ceramic: as printed, or as one derives it */
    rg_user_input user;
    char *name;   /* NULL: "material", of the one without which no case is */
    char *preset; /* that filled what the case does not say; NULL: none */
} rg_material_input;

/* A material besides `material`, and where it is: one of `set` and `where`; or, in the case file alone, a CSV
 * file of such. */
typedef struct {
    rg_material_input is;
    char *file;
    char *set;      /* volume set of the mesh file */
    rg_expr *where; /* elements at whose centroid this is not 0 (m) */
} rg_other_material;

/* Most materials in a case, `material` included. */
enum { RG_MAX_MATERIALS = UINT16_MAX + 1 }; /* they have numbers of 16 bits */

/* Friction of fragments of two materials (of one that is named twice): the last entry that has both counts.
 */
typedef struct {
    int names;
    char **between;
    double friction, static_friction; /* the latter 0: as the former */
} rg_contact_friction;

/* Whose force by contact between fragments is recorded: of faces of the surface, by what they touch; or of
 * faces of one material, by those of another. */
typedef struct {
    char *name;     /* column prefix in history.csv */
    char *set;      /* a side of the box, or a surface set of the mesh */
    rg_expr *where; /* faces of the surface where it is not 0, by middle and outward normal */
    int names;
    char **between; /* names of two materials: that which feels it, that which exerts it */
} rg_contact_force_input;

/* Faces with properties of their own: those that `set`, `where` and `between` (NULL: no such condition)
 * select. */
typedef struct {
    char *set;      /* named set of the mesh */
    rg_expr *where; /* not 0: by their middle x, y, z (m), unit normal nx, ny, nz */
    int names;
    char *
        *between; /* names of the materials on both sides; or "any" alone: volume sets or materials differ */
    rg_breaking breaking;
    bool open;       /* broken from the start, or from ... */
    double opens_at; /* ... this time on (s); 0: from the start */
    /* Numbers, or where the expression beside them is no number that: of these faces (Pa, J/m^2); without an
     * expression the interface's. */
    double strength, energy, beta, friction, rise;
    rg_expr *strength_at, *energy_at, *beta_at, *friction_at, *rise_at;
    double modulus, area; /* of Weibull's distribution (m^2); modulus 0: the interface's */
    int64_t seed;         /* 0: the interface's */
} rg_face_set;

/* A state at the start. */
typedef struct {
    rg_expr *displacement[3], *velocity[3]; /* m, m/s; NULL: zero */
    double spin, axis[3], at[3]; /* rad/s about an axis of any length through a point (m): on top */
    rg_expr *stress[6];          /* before any displacement, xx yy zz yz xz xy (Pa); NULL: zero */
} rg_initial;

/* Elements with a state of their own at the start: of one of these. */
typedef struct {
    char *set;      /* volume set of the mesh file */
    char *material; /* by name */
    rg_expr *where; /* at whose centroid this is not 0 */
    rg_initial is;
} rg_initial_set;

typedef struct {
    char *name;   /* column prefix in history.csv */
    double at[3]; /* reference position (m) */
    bool strain;  /* is recorded besides */
} rg_probe;

/* What sensors record, X(NAME, word, meaning): values at a place, those of stress last, and what is made of
 * them over a part of the body. */
#define RG_SENSOR_VALUE(X)                                                                                   \
    X(UX, "ux", "displacement along x (m)")                                                                  \
    X(UY, "uy", "along y")                                                                                   \
    X(UZ, "uz", "along z")                                                                                   \
    X(VX, "vx", "velocity along x (m/s)")                                                                    \
    X(VY, "vy", "along y")                                                                                   \
    X(VZ, "vz", "along z")                                                                                   \
    X(SXX, "sxx", "Cauchy stress (Pa)")                                                                      \
    X(SYY, "syy", "Cauchy stress")                                                                           \
    X(SZZ, "szz", "Cauchy stress")                                                                           \
    X(SYZ, "syz", "Cauchy stress")                                                                           \
    X(SXZ, "sxz", "Cauchy stress")                                                                           \
    X(SXY, "sxy", "Cauchy stress")                                                                           \
    X(MISES, "von_mises", "von Mises stress (Pa)")                                                           \
    X(PRESSURE, "pressure", "minus the mean stress (Pa)")

#define RG_SENSOR_MEASURE(X)                                                                                 \
    X(MEAN, "mean", "over the volume or area of reference")                                                  \
    X(MIN, "min", "least, at nodes; of stress at the points of integration")                                 \
    X(MAX, "max", "largest")                                                                                 \
    X(INTEGRAL, "integral", "over the volume or area of reference (its unit times m3 or m2)")

#define RG_SENSOR_ENUM(NAME, word, meaning) RG_SENSOR_##NAME,
enum { RG_SENSOR_VALUE(RG_SENSOR_ENUM) RG_SENSOR_VALUES };
enum { RG_SENSOR_MEASURE(RG_SENSOR_ENUM) RG_SENSOR_MEASURES };

typedef struct {
    char *name;                /* column prefix in history.csv */
    char *set;                 /* named set of faces or elements; or */
    rg_expr *where;            /* not 0: elements by their centroid, with a normal faces of the surface; or */
    char *material;            /* by name; none of them: the whole body */
    unsigned values, measures; /* bits */
} rg_sensor_input;

/* The tip of a crack that is followed. */
typedef struct {
    char *name;          /* column prefix in history.csv */
    char *set;           /* named set of faces between elements; or */
    rg_expr *where;      /* not 0: faces between elements, by their middle and normal; NULL both: all */
    double direction[3]; /* of any length */
    double distance;     /* over which its speed is taken (m) */
} rg_crack_tip_input;

/* What is known at the front of a crack, X(NAME, word, meaning); those that the opening tells last. */
#define RG_FRONT_VALUE(X)                                                                                    \
    X(RELEASE, "J", "energy release rate by the domain integral with inertia (J/m2)")                        \
    X(INTENSITY, "K",                                                                                        \
      "sqrt(J E/(1 - nu^2)), of either sign: K_I of a resting crack in plane strain (Pa sqrt(m))")           \
    X(OPENING, "KI", "from the opening behind the front, extrapolated to it")                                \
    X(SLIDING, "KII", "from the slip along the direction")                                                   \
    X(TEARING, "KIII", "from the slip along the front, direction x normal")
#define RG_FRONT_ENUM(NAME, word, meaning) RG_FRONT_##NAME,
enum { RG_FRONT_VALUE(RG_FRONT_ENUM) RG_FRONT_VALUES };

/* A straight piece of the front of a crack. */
typedef struct {
    char *name;                            /* column prefix in history.csv */
    double at[3], direction[3], normal[3]; /* of reference (m); of any length */
    struct {
        double inner, outer;
    } radius;        /* (m) */
    double length;   /* of the piece about `at` (m); 0: the whole front */
    bool symmetric;  /* the body is the half on one side of the crack's plane */
    char *tip;       /* of crack_tips, that it moves with; NULL: it rests */
    unsigned values; /* bits */
} rg_crack_front_input;

/* A rigid body that the solid's surface touches, or that sets of its faces are tied to. Values that the shape
 * or the motion has no use for are 0. */
typedef struct {
    char *name; /* column prefix in history.csv */
    rg_shape_kind shape;
    rg_motion motion;
    double at[3];     /* centre of mass, on the plane or on the axis, at the start (m) */
    double normal[3]; /* of the plane, away from the body; of any length */
    double axis[3];   /* of the cylinder, which has no ends; of any length */
    double radius;    /* m */
    double length;    /* of the cylinder, of which density makes mass and inertia; contact sees no ends (m) */
    double density, mass; /* kg/m^3, kg: one of them, of a free body */
    double inertia[6]; /* about the centre, xx yy zz yz xz xy, beside a mass (kg m^2); 0: it does not turn */
    rg_expr *velocity[3]; /* m/s: at the start, or prescribed in time; NULL: zero */
    rg_expr *spin[3];     /* likewise, angular velocity (rad/s) */
    int sets;             /* of faces that may touch it; 0: all on the surface */
    char **set;
    int ties; /* sets of faces that move with it */
    char **tied;
    rg_expr *tied_where; /* and those of the surface where it is not 0; NULL: no others */
    double tied_from;    /* from this time on they do (s) */
    double tied_until;   /* from this time on they do no more (s); 0: they do to the end */
    double penalty; /* contact stiffness times h/(lambda + 2 mu), h the height of an element over its face */
} rg_body_input;

typedef struct {
    char *path;       /* as given on the command line */
    char *name;       /* its file name without directory and extension */
    int64_t defaults; /* which set of them (default.h) */
    rg_curves tables;
    struct {
        int64_t cells[3];
        double size[3], origin[3];
        double jitter; /* fraction of the smallest cell edge */
        int64_t seed;
        int tile;         /* elements of one: RG_TILE << tile */
        char *file;       /* a mesh file (mesh/file.h), as an absolute path; NULL: built-in box */
        rg_expr *weight;  /* cost of an element at x, y, z over that of others; NULL: all the same */
        double rebalance; /* most over mean work of ranks from which the mesh is repartitioned; 0: never */
    } mesh;
    rg_material_input material; /* of all elements that no other one claims */
    int others;
    rg_other_material *other; /* the last one that claims an element has it */
    struct {
        rg_form form;
        rg_expr *faces; /* form continuous: those that carry an interface, as in rg_face_set; NULL: none */
        double beta_s;
        rg_penalty penalty;
        rg_law law;
        double strength, energy, beta;
        rg_criterion criterion;
        rg_shear shear;                   /* of faces with beta 0 */
        rg_expr *strength_at, *energy_at; /* as in rg_face_set; NULL: the number */
        rg_activation activation;
        double onset; /* of a conserving activation (kernels.h: RG_ONSET) */
        rg_contact contact;
        double friction;                             /* coefficient of closed faces */
        rg_rise rise;                                /* of strengths with the rate of stress; rate 0: none */
        double shape[RG_LAW_USER + 1][RG_LAW_SHAPE]; /* parameters of its own of each law */
        rg_user_law_input user;
        int sets;
        rg_face_set *set; /* faces with properties of their own */
        struct {
            double modulus, area; /* m; A_0 (m^2); modulus 0: strengths are not random */
            int64_t seed;
            rg_keep keep;
        } weibull;
    } interface;
    struct {
        rg_contact_model model;
        double penalty; /* stiffness times h/(lambda + 2 mu), h the height of an element over its face */
        double damping; /* of a depth's rate: share of the force that 1 m/s adds (s/m) */
        double friction, static_friction; /* coefficients while faces slide, until they do */
        int pairs;
        rg_contact_friction *pair; /* in place of those */
    } contact;
    rg_mass mass;
    struct {
        double linear, quadratic; /* b1, b2 */
    } viscosity;
    struct {
        rg_expr *value; /* K; NULL: all is at `free` */
        double free;    /* at which nothing is expanded (K) */
    } temperature;
    rg_initial initial;
    struct {
        char *run; /* results of a run, as an absolute path, with the stress of the start; NULL: `initial` */
        int64_t frame; /* of its fields; -1: the last */
    } stress_of;
    rg_start start;
    struct {
        double tolerance; /* residual over loads and reactions */
        int64_t steps;    /* at most */
    } relax;              /* of that start */
    int initial_sets;
    rg_initial_set *initial_set; /* the last one that has an element counts */
    int boundaries;
    rg_boundary *boundary;
    int loads;
    rg_load_input *load;
    int bodies;
    rg_body_input *body;
    struct {
        double end;      /* s */
        double safety;   /* fraction of the critical time step */
        int64_t steps;   /* limit on the number of steps; 0: none */
        double collapse; /* the run stops when the step falls below this fraction of the one at rest */
    } time;
    struct {
        char *dir;
        double interval_time;   /* s; 0 if given in steps */
        int64_t interval_steps; /* 0 if given in time */
        int times;              /* moments of field output; 0: at every interval */
        double *time;           /* s, ascending */
        int probes;
        rg_probe *probe;
        int sensors;
        rg_sensor_input *sensor;
        int contacts;
        rg_contact_force_input *contact;
        int crack_tips;
        rg_crack_tip_input *crack_tip;
        int crack_fronts;
        rg_crack_front_input *crack_front;
        unsigned fields;
        rg_expr *region; /* fields of the elements at whose centroid this is not 0; NULL: of all */
        rg_output_precision precision; /* of the fields on the disk */
        int64_t compression;           /* of the fields on the disk; 0: none */
        rg_fragments_when fragments; /* output.fragments: rows for each output, for the last one, for none */
        double energy_limit;         /* the run stops when energy_error_rel passes this */
        double dissipation_limit;    /* and when the error over what was dissipated does; 0: it does not */
    } output;
    struct { /* when to write checkpoints; 0: not for that reason */
        int64_t steps;
        double time;      /* simulated (s) */
        double wall_time; /* s */
        int64_t keep;     /* of them, the last ones */
    } checkpoint;
} rg_case;

/* Whether an entry of `boundary` absorbs or is a dashpot, and prescribes nothing; prescribes a velocity or
 * displacement along one line; along an axis of coordinates; whether it prescribes places, not only
 * velocities. */
bool rg_boundary_damps(const rg_boundary *b);
bool rg_boundary_is_along_line(const rg_boundary *b);
bool rg_boundary_has_component(const rg_boundary *b);
bool rg_boundary_is_placed(const rg_boundary *b);

/* Mass of a free body (kg), and its inertia in the order above. */
double rg_body_mass(const rg_body_input *b);
void rg_body_inertia(const rg_body_input *b, double inertia[6]);

/* Whether a body can turn: of what the solid presses only by lines through its centre it cannot. */
bool rg_body_turns(const rg_body_input *b);

/* Whether a free one has an inertia; whether it starts with an angular velocity, or one is prescribed. */
bool rg_body_has_inertia(const rg_body_input *b);

/* Whether faces move with it. */
bool rg_body_is_tied(const rg_body_input *b);

/* Whether sets become tied to bodies in the run. */
bool rg_case_joins(const rg_case *c);
bool rg_body_spins(const rg_body_input *b);

/* Whether a load acts on elements, not on faces. */
bool rg_load_is_inside(const rg_load_input *load);

/* Whether two entries act at the same time. */
bool rg_boundaries_meet(const rg_boundary *a, const rg_boundary *b);

/* Whether this is an anisotropic solid whose axes differ from element to element, by expressions or a field.
 */
bool rg_material_axes_vary(const rg_material_input *in);

/* Whether any element has an initial stress. */
bool rg_initial_has_stress(const rg_initial *is);
bool rg_case_has_stress(const rg_case *c);

/* Whether faces open at a time. */
bool rg_case_opens(const rg_case *c);

/* Whether fragments rub where they meet. */
bool rg_case_rubs(const rg_case *c);

/* Whether their contact takes energy. */
bool rg_case_heats(const rg_case *c);

/* Whether a set selects the faces between any two volume sets or materials. */
bool rg_face_set_is_any(const rg_face_set *set);

/* Input of material i (0: `material`, then the others), and its name. */
const rg_material_input *rg_case_material(const rg_case *c, int i);
const char *rg_case_material_name(const rg_case *c, int i);

/* Values of history per point, and what is inside, of a material. */
int rg_input_history(const rg_material_input *in);
unsigned rg_input_inside(const rg_material_input *in);

/* Number of the material of that name; -1 if there is none. */
int rg_case_find_material(const rg_case *c, const char *name);

/* Fields that a run puts out where the case asks for none in particular, and all that its materials let it
 * put out. */
unsigned rg_case_default_fields(const rg_case *c);
unsigned rg_case_possible_fields(const rg_case *c);

#endif
