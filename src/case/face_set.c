/* Rules of interface.sets: which faces a set selects, and what it may say of them. */
#include <string.h>

#include "base/mem.h"
#include "case/entry.h"

/* "alumina, steel" */
static void list_names(const rg_case *c, const char *join, char *text, size_t size) {
    text[0] = '\0';
    for (int m = 0; m <= c->others; m++) {
        rg_text_add(text, size, "%s%s", join, rg_case_material_name(c, m));
        join = ", ";
    }
}

void rg_between_rule(rg_check *ck, const rg_node *node, int count, char *const between[], bool any,
                     const char *path) {
    char allowed[256], *key = rg_text_format("%s.between", path), value[64];
    const char **names = RG_NEW(const char *, (size_t)ck->c->others + 2); /* ends with NULL */
    for (int m = 0; m <= ck->c->others; m++) {
        names[m] = rg_case_material_name(ck->c, m);
    }
    list_names(ck->c,
               any ? "any, or names of two materials, or one twice: "
                   : "names of two materials, or one twice: ",
               allowed, sizeof allowed);
    rg_subject subject = {.key = key, .value = rg_node_line(node, value, sizeof value), .allowed = allowed};
    if (count != 2 && !(any && count == 1 && strcmp(between[0], "any") == 0)) {
        rg_problem_add(ck->problems, node->at, &subject, "wrong number of entries");
    }
    for (int k = 0; k < count && count == 2; k++) {
        if (rg_case_find_material(ck->c, between[k]) < 0) {
            subject.value = between[k];
            subject.nearest = rg_nearest(between[k], names);
            rg_problem_add(ck->problems, node->child[k].at, &subject, "no such material");
        }
    }
    rg_free(names);
    rg_free(key);
}

/* Reports a key that is given to no purpose. */
static void refuse(rg_check *ck, const rg_node *item, const char *path, const char *name, const char *why) {
    rg_entry e = {ck, item, path};
    const rg_node *node = rg_entry_given(&e, name);
    if (node != NULL) {
        char value[64];
        rg_subject subject = {.value = rg_node_line(node, value, sizeof value)};
        rg_entry_wrong(&e, name, node->key_at, subject, why);
    }
}

/* Faces that never break have none of the properties of those that do; form intrinsic has no others. */
static void check_breaking(rg_check *ck, const rg_node *item, const rg_face_set *set, const char *path) {
    static const char *const keys[] = {"strength", "energy",          "beta",         "friction",
                                       "rise",     "weibull.modulus", "weibull.area", "weibull.seed"};
    if (set->breaking != RG_BREAKING_NEVER) {
        return;
    }
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
        refuse(ck, item, path, keys[i], "not used, because law of this set is none");
    }
    if (ck->form && ck->c->interface.form == RG_FORM_INTRINSIC) {
        refuse(ck, item, path, "law", "form intrinsic has no DG terms that would hold faces without a law");
    }
}

/* Faces that are open have no law, only contact and friction. */
static void check_open(rg_check *ck, const rg_node *item, const rg_face_set *set, const char *path) {
    static const char *const keys[] = {"law",  "strength",        "energy",       "beta",
                                       "rise", "weibull.modulus", "weibull.area", "weibull.seed"};
    for (size_t i = 0; set->open && i < sizeof keys / sizeof *keys; i++) {
        refuse(ck, item, path, keys[i], "not used, because this set is open");
    }
    if (set->open && ck->c->interface.law == RG_LAW_FREE) {
        refuse(ck, item, path, "open", "law free has no end: its faces are never without traction");
    }
    if (!set->open) {
        refuse(ck, item, path, "at", "not used without open: true");
    } else if (ck->form && ck->c->interface.form == RG_FORM_INTRINSIC) {
        refuse(ck, item, path, "at", "form intrinsic has no DG terms that would hold the faces until then");
    }
}

static void check_shear(rg_check *ck, const rg_node *item, const rg_face_set *set, const char *path) {
    char why[128];
    if (ck->usage[RG_GROUP_SHEAR] == RG_UNUSED) {
        snprintf(why, sizeof why, "not used, because interface.%s", rg_why_unused(RG_GROUP_SHEAR, ck->c));
        refuse(ck, item, path, "beta", why);
    } else if (ck->form && ck->c->interface.form == RG_FORM_INTRINSIC) {
        refuse(ck, item, path, "beta", "in form intrinsic all faces have that of interface.beta");
    }
    bool none = set->friction_at == NULL || (rg_expr_is_number(set->friction_at) && !(set->friction > 0));
    if (!none && ck->c->interface.contact == RG_CONTACT_FLUX) {
        refuse(ck, item, path, "friction",
               "contact flux holds closed faces by all DG terms, so they do not slide");
    }
}

static void check_rise(rg_check *ck, const rg_node *item, const char *path) {
    if (ck->usage[RG_GROUP_RISE] == RG_UNUSED) {
        refuse(ck, item, path, "rise", "not used without interface.rise.rate");
    }
}

static void check_weibull(rg_check *ck, const rg_node *item, const rg_face_set *set, const char *path) {
    const rg_node *modulus = rg_entry_given(&(rg_entry){ck, item, path}, "weibull.modulus");
    if (modulus == NULL) {
        refuse(ck, item, path, "weibull.area", "not used without weibull.modulus");
        refuse(ck, item, path, "weibull.seed", "not used without weibull.modulus");
    } else if (!(set->area > 0)) {
        char *key = rg_text_format("%s.weibull.area", path);
        rg_subject subject = {.key = key, .allowed = "number > 0 (m2)"};
        rg_problem_add(ck->problems, modulus->key_at, &subject, "missing");
        rg_free(key);
    }
}

void rg_face_set_rule(rg_check *ck, const rg_node *list, int i, const char *path, bool good) {
    const rg_node *item = &list->child[i];
    if (item->kind != RG_NODE_MAPPING) {
        return;
    }
    const rg_face_set *set = &ck->c->interface.set[i];
    const rg_node *between = rg_node_find(item, "between", strlen("between"));
    rg_entry e = {ck, item, path};
    if (between == NULL && rg_entry_given(&e, "where") == NULL && rg_entry_given(&e, "set") == NULL) {
        rg_subject subject = {.key = path, .allowed = "set, where, between, or several of them"};
        rg_problem_add(ck->problems, item->at, &subject, "missing set, where or between");
    } else if (between != NULL && good) {
        rg_between_rule(ck, between, set->names, set->between, true, path);
    }
    if (good) {
        check_breaking(ck, item, set, path);
        check_open(ck, item, set, path);
        check_shear(ck, item, set, path);
        check_weibull(ck, item, set, path);
        check_rise(ck, item, path);
    }
}
