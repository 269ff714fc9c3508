/* Rules that tie several keys of the case file together. */
#include "case/check.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

#include "base/mem.h"
#include "case/default.h"
#include "cohesive/facts.h"

/* ---- mesh.file: relative to the case file, which case.yaml in the output directory is not ---- */

char *rg_path_beside_case(const rg_check *ck, const char *path) {
    const char *file = ck->problems->file, *slash = strrchr(file, '/');
    int folder = path[0] == '/' || slash == NULL ? 0 : (int)(slash - file) + 1;
    return rg_text_format("%.*s%s", folder, file, path);
}

char *rg_path_of_case(const rg_check *ck, const char *file) {
    char here[4096], *path = rg_path_beside_case(ck, file);
    if (path[0] == '/' || getcwd(here, sizeof here) == NULL) {
        return path;
    }
    char *whole = rg_text_format("%s/%s", here, path);
    rg_free(path);
    return whole;
}

void rg_mesh_file_rule(rg_check *ck, const rg_node *node) {
    char *file = ck->c->mesh.file, *path = rg_path_of_case(ck, file);
    if (access(path, R_OK) != 0) {
        rg_subject subject = {
            .key = "mesh.file", .value = file, .allowed = "path of a mesh file, relative to the case file"};
        rg_problem_add(ck->problems, node->at, &subject, "cannot be read: %s", strerror(errno));
        rg_free(path);
    } else {
        ck->c->mesh.file = path;
        rg_free(file);
    }
}

void rg_stress_run_rule(rg_check *ck) {
    char *run = ck->c->stress_of.run;
    ck->c->stress_of.run = rg_path_of_case(ck, run);
    rg_free(run);
}

void rg_times_rule(rg_check *ck, const rg_node *node) {
    const rg_case *c = ck->c;
    int last = c->output.times - 1;
    if (c->time.end > 0 && c->output.time[last] > c->time.end) {
        rg_subject subject = {.key = "output.times", .value = node->child[last].text};
        rg_problem_add(ck->problems, node->child[last].at, &subject, "after time.end, %g s", c->time.end);
    }
}

/* ---- interface: law and form ---- */

static int forms_of(rg_law law) {
    return rg_law_facts_of(law, (double[RG_LAW_SHAPE]){0}, 1).forms;
}

/* What a form asks of a law. */
typedef struct {
    int bit;           /* of the law's forms; 0: no law at all */
    const char *words; /* the form, or what else asks */
    const char *other; /* why another law does not fit */
} demand;

static const demand dg_law = {RG_FORMS_DG, "form variational or incomplete",
                              "starts with a slope, which only form intrinsic can use"};
static const demand face_law = {RG_FORMS_DG, "form continuous",
                                "starts with a slope, which only form intrinsic can use"};
static const demand sloped_law = {RG_FORMS_INTRINSIC, "form intrinsic",
                                  "does not start with a slope, which form intrinsic needs"};
static const demand no_law = {0, "form continuous and no interface.faces",
                              "nothing can break, because form continuous has interfaces only on the faces "
                              "that interface.faces selects"};

static const demand falling_law = {RG_CONSERVES, "activation conserving", "needs a law that starts rigid"};

static const demand *demand_of(const rg_case *c) {
    switch (c->interface.form) {
    case RG_FORM_INTRINSIC:
        return &sloped_law;
    case RG_FORM_CONTINUOUS:
        return c->interface.faces != NULL ? &face_law : &no_law;
    default:
        return &dg_law;
    }
}

static bool fits(const demand *d, rg_law law) {
    return law == RG_LAW_NONE ? d != &sloped_law && d != &falling_law : (forms_of(law) & d->bit) != 0;
}

const char *rg_why_unused(rg_key_group group, const rg_case *c) {
    static char text[64];
    bool none = c->interface.law == RG_LAW_NONE, intrinsic = c->interface.form == RG_FORM_INTRINSIC;
    if (group == RG_GROUP_FACES) {
        return "form is not continuous";
    }
    if (group == RG_GROUP_ONSET && rg_group_used(RG_GROUP_SWITCH, c)) {
        return "activation is not conserving";
    }
    bool switches = group == RG_GROUP_SWITCH || group == RG_GROUP_ONSET;
    if (group == RG_GROUP_INTERFACE || group == RG_GROUP_DG || (switches && !none)) {
        return intrinsic ? "form is intrinsic" : "form is continuous, without interface.faces";
    }
    snprintf(text, sizeof text, "law is %s", rg_law_word(c->interface.law));
    return text;
}

/* "with form intrinsic: free, exponential" */
static void laws_for(const demand *d, char *text, size_t size) {
    snprintf(text, size, "with %s", d->words);
    const char *join = ": ";
    for (int law = 0; law <= (int)RG_LAW_USER; law++) {
        if (fits(d, (rg_law)law)) {
            rg_text_add(text, size, "%s%s", join, rg_law_word((rg_law)law));
            join = ", ";
        }
    }
}

static void check_law_and_form(rg_check *ck, const rg_node *node) {
    const demand *d = demand_of(ck->c);
    rg_law law = ck->c->interface.law;
    if (!fits(d, law)) {
        char allowed[256];
        laws_for(d, allowed, sizeof allowed);
        rg_subject subject = {.key = "interface.law", .value = rg_law_word(law), .allowed = allowed};
        rg_problem_add(ck->problems, node->at, &subject, "%s", d->other);
    }
}

/* Its speed is the difference of two openings, of which floats leave too little. */
static void check_rate(rg_check *ck, const rg_node *node) {
    if (sizeof(rg_real) < sizeof(double) && ck->c->interface.law == RG_LAW_RATE) {
        rg_subject subject = {.key = "interface.law", .value = rg_law_word(RG_LAW_RATE)};
        rg_problem_add(ck->problems, node->at, &subject,
                       "needs double precision, and this program is built with -Dprecision=single");
    }
}

void rg_law_rule(rg_check *ck, const rg_node *node, bool good) {
    static const rg_key_group groups[] = {RG_GROUP_COHESIVE, RG_GROUP_ENERGY, RG_GROUP_SHEAR, RG_GROUP_LAW,
                                          RG_GROUP_SWITCH};
    for (size_t i = 0; i < sizeof groups / sizeof *groups; i++) {
        bool sure = good && (ck->form || groups[i] != RG_GROUP_SWITCH);
        ck->usage[groups[i]] = !sure ? RG_UNSURE : rg_group_used(groups[i], ck->c) ? RG_USED : RG_UNUSED;
    }
    if (good && !ck->penalty_given) { /* its default depends on the law, which comes later */
        ck->c->interface.beta_s = rg_default_beta_s(ck->c);
    }
    if (good && ck->form) {
        check_law_and_form(ck, node);
        check_rate(ck, node);
    }
}

static void check_conserving(rg_check *ck, const rg_node *node) {
    const rg_case *c = ck->c;
    char laws[128];
    rg_subject subject = {.key = "interface.activation", .value = "conserving"};
    if (c->interface.form != RG_FORM_VARIATIONAL) {
        subject.allowed = "with this form: continuous, total";
        rg_problem_add(ck->problems, node->at, &subject,
                       "counts the energy of the lift, which form variational alone has");
    }
    if (!fits(&falling_law, c->interface.law)) {
        laws_for(&falling_law, laws, sizeof laws);
        subject.allowed = laws;
        rg_problem_add(ck->problems, node->at, &subject, "%s, and interface.law is %s", falling_law.other,
                       rg_law_word(c->interface.law));
    }
}

void rg_activation_rule(rg_check *ck, const rg_node *node, bool good) {
    rg_usage switches = ck->usage[RG_GROUP_SWITCH];
    bool conserving = ck->c->interface.activation == RG_ACTIVATION_CONSERVING;
    ck->usage[RG_GROUP_ONSET] = switches == RG_UNUSED            ? RG_UNUSED
                                : switches == RG_UNSURE || !good ? RG_UNSURE
                                : conserving                     ? RG_USED
                                                                 : RG_UNUSED;
    if (node != NULL && ck->usage[RG_GROUP_ONSET] == RG_USED) {
        check_conserving(ck, node);
    }
}

void rg_contact_rule(rg_check *ck, const rg_node *node) {
    bool conserving = ck->usage[RG_GROUP_ONSET] == RG_USED;
    bool flux = ck->c->interface.contact == RG_CONTACT_FLUX;
    if (conserving && flux && !ck->switch_given) { /* a default that does not go with it */
        ck->c->interface.activation = RG_ACTIVATION_CONTINUOUS;
    } else if (conserving && flux) {
        rg_subject subject = {.key = "interface.contact",
                              .value = "flux",
                              .allowed = "with activation conserving: penalty, potential"};
        rg_problem_add(ck->problems, node->at, &subject,
                       "brings DG terms back, whose energy activation conserving does not count");
    }
    if (ck->form && ck->c->interface.form == RG_FORM_INTRINSIC &&
        ck->c->interface.contact == RG_CONTACT_FLUX) {
        rg_subject subject = {
            .key = "interface.contact", .value = "flux", .allowed = "with form intrinsic: penalty"};
        rg_problem_add(ck->problems, node->at, &subject,
                       "brings DG terms back, which form intrinsic does not have");
    }
}

void rg_contact_model_rule(rg_check *ck, const rg_node *node) {
    if (ck->usage[RG_GROUP_COHESIVE] == RG_USED && ck->c->interface.contact != RG_CONTACT_POTENTIAL) {
        rg_subject subject = {.key = "contact.model",
                              .value = node->text,
                              .allowed = "with interface.contact potential: general"};
        rg_problem_add(ck->problems, node->at, &subject,
                       "the contact of interfaces must fade where faces slide off each other");
    }
}

/* Of the static friction `key`, given at `node`, beside that of sliding. */
static void check_hold(rg_check *ck, const rg_node *node, const char *key, const char *allowed, double hold,
                       double sliding) {
    if (hold < sliding) {
        rg_subject subject = {.key = key, .value = node->text, .allowed = allowed};
        rg_problem_add(ck->problems, node->at, &subject,
                       "faces at rest hold at least as well as sliding ones");
    }
}

void rg_static_friction_rule(rg_check *ck, const rg_node *node) {
    check_hold(ck, node, "contact.static_friction", "number >= contact.friction",
               ck->c->contact.static_friction, ck->c->contact.friction);
}

void rg_contact_friction_rule(rg_check *ck, const rg_node *list, int i, const char *path, bool good) {
    const rg_contact_friction *pair = &ck->c->contact.pair[i];
    const rg_node *item = &list->child[i];
    if (!good) {
        return;
    }
    const rg_node *given = rg_node_find(item, "static_friction", strlen("static_friction"));
    rg_between_rule(ck, rg_node_find(item, "between", strlen("between")), pair->names, pair->between, false,
                    path);
    if (given != NULL) {
        char *key = rg_text_format("%s.static_friction", path);
        check_hold(ck, given, key, "number >= friction", pair->static_friction, pair->friction);
        rg_free(key);
    }
}

void rg_friction_rule(rg_check *ck, const rg_node *node) {
    if (ck->c->interface.friction > 0 && ck->c->interface.contact == RG_CONTACT_FLUX) {
        rg_subject subject = {
            .key = "interface.friction", .value = node->text, .allowed = "with contact flux: 0"};
        rg_problem_add(ck->problems, node->at, &subject,
                       "contact flux holds closed faces by all DG terms, so they do not slide");
    }
}

void rg_shear_rule(rg_check *ck, const rg_node *node) {
    if (ck->c->interface.shear == RG_SHEAR_FADING && ck->usage[RG_GROUP_ONSET] == RG_UNUSED) {
        rg_subject subject = {.key = "interface.shear", .value = node->text};
        rg_problem_add(ck->problems, node->at, &subject,
                       "needs interface.activation conserving, which counts what the spring begins with");
    }
}

void rg_criterion_rule(rg_check *ck, const rg_node *node) {
    const rg_case *c = ck->c;
    if (c->interface.criterion != RG_CRITERION_MOHR_COULOMB || ck->usage[RG_GROUP_ONSET] == RG_UNSURE) {
        return;
    }
    bool conserving = ck->usage[RG_GROUP_ONSET] == RG_USED;
    const char *wrong =
        !conserving ? "needs interface.activation conserving, by which pressure goes on at the switch"
        : !(c->interface.friction > 0) ? "needs interface.friction, by which pressure adds to the strength"
        : !(c->interface.beta > 0)
            ? "needs interface.beta, the strength of shear without pressure over strength"
            : NULL;
    if (wrong != NULL) {
        rg_subject subject = {.key = "interface.criterion", .value = node->text};
        rg_problem_add(ck->problems, node->at, &subject, "%s", wrong);
    }
}

void rg_mass_rule(rg_check *ck, const rg_node *node) {
    if (ck->c->interface.form != RG_FORM_CONTINUOUS) {
        return;
    }
    if (node != NULL && ck->c->mass != RG_MASS_LUMPED) {
        rg_subject subject = {
            .key = "mass", .value = "consistent", .allowed = "with form continuous: lumped"};
        rg_problem_add(
            ck->problems, node->at, &subject,
            "couples all nodes that elements share, so that each step would have to solve with it");
    }
    ck->c->mass = RG_MASS_LUMPED;
}

/* ---- names: unique, fit for a column heading ---- */

/* The name of entry i of the lists that history.csv has columns of, in the order of reading; *end: there are
 * no more. */
static const char *column_name(const rg_case *c, int i, bool *end) {
    *end = false;
    if (i < c->boundaries) {
        return c->boundary[i].name;
    }
    i -= c->boundaries;
    if (i < c->loads) {
        return c->load[i].name;
    }
    i -= c->loads;
    if (i < c->bodies) {
        return c->body[i].name;
    }
    i -= c->bodies;
    if (i < c->output.probes) {
        return c->output.probe[i].name;
    }
    i -= c->output.probes;
    if (i < c->output.sensors) {
        return c->output.sensor[i].name;
    }
    i -= c->output.sensors;
    if (i < c->output.contacts) {
        return c->output.contact[i].name;
    }
    i -= c->output.contacts;
    if (i < c->output.crack_tips) {
        return c->output.crack_tip[i].name;
    }
    i -= c->output.crack_tips;
    *end = i >= c->output.crack_fronts;
    return *end ? NULL : c->output.crack_front[i].name;
}

/* Whether an entry before that of `name` has the same one. */
static bool is_taken(const rg_case *c, const char *name) {
    bool end = false;
    for (int i = 0; !end; i++) {
        const char *other = column_name(c, i, &end);
        if (other == name) {
            return false;
        }
        if (other != NULL && strcmp(other, name) == 0) {
            return true;
        }
    }
    return false;
}

bool rg_is_name(const char *text) {
    static const char allowed[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
    return strspn(text, allowed) == strlen(text);
}

void rg_name_rule(rg_check *ck, const rg_node *item, const char *path, const char *name) {
    const rg_node *node = rg_node_find(item, "name", strlen("name"));
    const char *wrong = !rg_is_name(name)       ? "not a name"
                        : is_taken(ck->c, name) ? "the name of an earlier one in history.csv"
                                                : NULL;
    if (wrong != NULL && node != NULL) {
        char *key = rg_text_format("%s.name", path);
        rg_subject subject = {
            .key = key, .value = node->text, .allowed = "letters, digits, _ and -; unique in history.csv"};
        rg_problem_add(ck->problems, node->at, &subject, "%s", wrong);
        rg_free(key);
    }
}

/* ---- probes: places inside the box ---- */

static void check_place(rg_check *ck, const rg_node *item, const char *path, const rg_probe *probe) {
    const rg_node *node = rg_node_find(item, "at", strlen("at"));
    const double *origin = ck->c->mesh.origin, *size = ck->c->mesh.size;
    for (int k = 0; k < 3 && node != NULL; k++) {
        if (probe->at[k] < origin[k] || probe->at[k] > origin[k] + size[k]) {
            char *key = rg_text_format("%s.at[%d]", path, k);
            char *allowed = rg_text_format("number >= %g and <= %g (m)", origin[k], origin[k] + size[k]);
            rg_subject subject = {.key = key, .value = node->child[k].text, .allowed = allowed};
            rg_problem_add(ck->problems, node->child[k].at, &subject, "outside the box");
            rg_free(allowed);
            rg_free(key);
        }
    }
}

void rg_probe_rule(rg_check *ck, const rg_node *list, int i, const char *path, bool good) {
    const rg_node *item = &list->child[i];
    if (ck->c->output.probe[i].name != NULL) {
        rg_name_rule(ck, item, path, ck->c->output.probe[i].name);
    }
    if (good && ck->box) {
        check_place(ck, item, path, &ck->c->output.probe[i]);
    }
}
