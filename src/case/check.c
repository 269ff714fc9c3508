/* Walks the tree: finds each key of a table, reports unknown, missing and repeated ones, reads the others. */
#include <string.h>

#include "case/entry.h"

#include "base/mem.h"

/* One mapping being checked against one table. */
typedef struct {
    rg_check *ck;
    const rg_key_table *table;
    const rg_node *top;                /* the mapping */
    const char *path;                  /* its own path with a dot behind it, or "" */
    const rg_node *found[RG_MAX_KEYS]; /* by key; NULL: absent */
} scan;

static bool check_table(rg_check *ck, const rg_key_table *table, const rg_node *node, const char *path,
                        void *base);

/* ---- which keys are there ---- */

static void report_key(const scan *s, const rg_node *node, const char *name, const char *what) {
    char *path = rg_text_format("%s%s", s->path, name);
    rg_subject subject = {.key = path};
    rg_problem_add(s->ck->problems, node->key_at, &subject, "%s", what);
    rg_free(path);
}

/* With the key that was probably meant, or else with what there is. `section`: with a dot behind it, or "".
 */
static void report_unknown(const scan *s, const rg_node *node, const char *name, const char *section) {
    char *path = rg_text_format("%s%s", s->path, name), near[64], known[1024];
    rg_subject subject = {.key = path, .nearest = rg_key_nearest(s->table, name, near, sizeof near)};
    if (subject.nearest == NULL) {
        subject.allowed = rg_keys_in(s->table, section, known, sizeof known);
    }
    rg_problem_add(s->ck->problems, node->key_at, &subject, "unknown key");
    rg_free(path);
}

static void report_repeated(const scan *s, const rg_node *node, const char *name, rg_place first) {
    char *what = rg_text_format("given twice, first at line %d column %d", first.line, first.column);
    report_key(s, node, name, what);
    rg_free(what);
}

static void collect(scan *s, const rg_node *mapping, const char *prefix);

static void collect_one(scan *s, const rg_node *mapping, const rg_node *node, const char *section,
                        const char *name) {
    const rg_node *first = rg_node_find(mapping, node->key, strlen(node->key));
    const rg_key *key = rg_key_find(s->table, name);
    if (strchr(node->key, '.') != NULL) {
        report_key(s, node, name, "unknown key: the parts of a dotted key stand on lines of their own");
    } else if (first != node) {
        report_repeated(s, node, name, first->key_at);
    } else if (key != NULL) {
        s->found[key - s->table->key] = node;
    } else if (!rg_key_is_section(s->table, name)) {
        report_unknown(s, node, name, section);
    } else if (node->kind == RG_NODE_MAPPING) {
        char *prefix = rg_text_format("%s.", name);
        collect(s, node, prefix);
        rg_free(prefix);
    } else if (node->kind != RG_NODE_BAD) {
        char value[64];
        char *path = rg_text_format("%s%s", s->path, name);
        rg_subject subject = {
            .key = path, .value = rg_node_is_null(node) ? NULL : rg_node_line(node, value, sizeof value)};
        rg_problem_add(s->ck->problems, node->at, &subject, "%s",
                       rg_node_is_null(node) ? "no value" : "not a mapping of keys");
        rg_free(path);
    }
}

static void collect(scan *s, const rg_node *mapping, const char *prefix) {
    for (int i = 0; i < mapping->children; i++) {
        const rg_node *node = &mapping->child[i];
        bool bad_key = node->key[0] == '\0' && node->kind == RG_NODE_BAD;
        if (!bad_key) {
            char *name = rg_text_format("%s%s", prefix, node->key);
            collect_one(s, mapping, node, prefix, name);
            rg_free(name);
        }
    }
}

/* The innermost mapping (maybe empty) that exists on the way to `name`; NULL if something else stands there,
 * which is reported already. */
static const rg_node *parent_of(const rg_node *top, const char *name) {
    const rg_node *parent = top;
    for (const char *dot = strchr(name, '.'); dot != NULL; dot = strchr(name, '.')) {
        const rg_node *next = rg_node_find(parent, name, (size_t)(dot - name));
        if (next == NULL) {
            return parent;
        }
        if (next->kind != RG_NODE_MAPPING) {
            return rg_node_is_null(next) ? next : NULL;
        }
        parent = next;
        name = dot + 1;
    }
    return parent;
}

/* ---- values ---- */

static bool missing(const scan *s, const rg_key *key, const char *path) {
    const rg_node *parent = parent_of(s->top, key->name);
    if (parent != NULL) {
        char allowed[512];
        rg_subject subject = {.key = path, .allowed = rg_key_allowed(key, allowed, sizeof allowed)};
        rg_problem_add(s->ck->problems, parent->at, &subject, "missing");
    }
    return false;
}

/* Of the fields see rg_fields_rule. */
static void set_default(const rg_key *key, void *base) {
    char *value = (char *)base + key->offset;
    double fallback = key->fallback_of != NULL ? key->fallback_of(base) : key->fallback;
    int64_t integer = (int64_t)fallback;
    int choice = (int)fallback;
    for (int i = 0; i < key->count && key->type == RG_KEY_REAL; i++) {
        memcpy(value + (size_t)i * sizeof(double), &fallback, sizeof(double));
    }
    if (key->type == RG_KEY_INTEGER) {
        memcpy(value, &integer, sizeof integer);
    } else if (key->type == RG_KEY_CHOICE) {
        memcpy(value, &choice, sizeof choice);
    }
}

static void check_entry(rg_check *ck, const rg_key *key, const rg_node *list, const char *path, int i,
                        char *entries) {
    char *item = rg_text_format("%s[%d]", path, i);
    char *dotted = rg_text_format("%s.", item);
    const rg_node *node = &list->child[i];
    bool good = false;
    if (key->entry == &rg_material_table) {
        ck->material = (rg_material_check){
            .path = dotted, .of = &ck->c->other[i].is, .flaws = true, .constants = true, .block = node};
    }
    if (node->kind == RG_NODE_MAPPING) {
        good = check_table(ck, key->entry, node, dotted, entries + (size_t)i * key->entry->size);
    } else {
        rg_value_wrong(ck, key, node, item, NULL, "not a mapping of keys");
    }
    if (key->entry == &rg_boundary_table) {
        rg_boundary_rule(ck, list, i, item, good);
    } else if (key->entry == &rg_load_table) {
        rg_load_rule(ck, list, i, item, good);
    } else if (key->entry == &rg_body_table) {
        rg_body_rule(ck, list, i, item, good);
    } else if (key->entry == &rg_probe_table) {
        rg_probe_rule(ck, list, i, item, good);
    } else if (key->entry == &rg_crack_tip_table) {
        rg_crack_tip_rule(ck, list, i, item, good);
    } else if (key->entry == &rg_crack_front_table) {
        rg_crack_front_rule(ck, list, i, item, good);
    } else if (key->entry == &rg_sensor_table) {
        rg_sensor_rule(ck, list, i, item, good);
    } else if (key->entry == &rg_material_table) {
        rg_material_rule(ck, list, i, item);
    } else if (key->entry == &rg_initial_set_table) {
        rg_initial_set_rule(ck, list, i, item, good);
    } else if (key->entry == &rg_face_set_table) {
        rg_face_set_rule(ck, list, i, item, good);
    } else if (key->entry == &rg_contact_force_table) {
        rg_contact_force_rule(ck, list, i, item, good);
    } else if (key->entry == &rg_contact_friction_table) {
        rg_contact_friction_rule(ck, list, i, item, good);
    }
    rg_free(dotted);
    rg_free(item);
}

static bool check_list(rg_check *ck, const rg_key *key, const rg_node *list, const char *path, char *base) {
    if (list->kind != RG_NODE_LIST) {
        rg_value_wrong(ck, key, list, path, NULL, "not a list");
        return false;
    }
    int before = ck->problems->count;
    char *entries = rg_alloc((size_t)list->children, key->entry->size);
    rg_pointer_set(base + key->offset, entries);
    memcpy(base + key->offset_count, &list->children, sizeof list->children);
    for (int i = 0; i < list->children; i++) {
        check_entry(ck, key, list, path, i, entries);
    }
    return ck->problems->count == before;
}

static const char *why_unused(const scan *s, const rg_key *key, char *text, size_t size) {
    if (key->group == RG_GROUP_BOX) {
        return "cannot be given together with mesh.file";
    }
    if (key->group == RG_GROUP_WEIBULL) {
        return "not used without interface.weibull.modulus";
    }
    if (key->group == RG_GROUP_RISE) {
        return "not used without interface.rise.rate";
    }
    if (key->group == RG_GROUP_HEAT) {
        return "not used without temperature.value";
    }
    if (key->group == RG_GROUP_RELAX) {
        return "not used, because start is not relax";
    }
    if (key->group == RG_GROUP_STRESS_RUN) {
        return "not used without initial.stress.run";
    }
    if (key->group == RG_GROUP_CONTACT) {
        return "not used, because contact.model is interfaces";
    }
    if (key->models == 0) {
        snprintf(text, size, "not used, because interface.%s", rg_why_unused(key->group, s->ck->c));
        return text;
    }
    char words[256];
    const rg_material_check *m = &s->ck->material;
    rg_models_words(key, words, sizeof words);
    snprintf(text, size, "not used, because %smodel is %s; it belongs to %s", m->path,
             rg_material_word(m->of->model), words);
    return text;
}

static bool refuse_unused(const scan *s, const rg_key *key, const rg_node *node, const char *path) {
    char value[64], why[400];
    rg_subject subject = {.key = path, .value = rg_node_line(node, value, sizeof value)};
    rg_problem_add(s->ck->problems, node->key_at, &subject, "%s", why_unused(s, key, why, sizeof why));
    return false;
}

static rg_usage usage_of(const rg_check *ck, const rg_key *key) {
    if (key->models == 0) {
        return ck->usage[key->group];
    }
    if (!ck->material.model) {
        return RG_UNSURE;
    }
    return (key->models >> ck->material.of->model & 1U) != 0 ? RG_USED : RG_UNUSED;
}

static bool check_key(const scan *s, const rg_key *as_model, const rg_node *node, const char *path,
                      void *base) {
    rg_usage usage = usage_of(s->ck, as_model);
    if (usage == RG_UNSURE && as_model->as != NULL) {
        return false; /* what it has to be is not known */
    }
    const rg_key here = rg_key_here(as_model, base), *key = &here;
    if (key->group == RG_GROUP_LAW && usage == RG_USED && !rg_key_used(key, base)) {
        usage = RG_UNUSED;
    }
    if (node == NULL) {
        if (key->need == RG_NEED_REQUIRED && usage == RG_USED) {
            return missing(s, key, path);
        }
        if (key->need == RG_NEED_DEFAULT) {
            set_default(key, base);
        }
        return key->need != RG_NEED_REQUIRED;
    }
    if (usage == RG_UNUSED) {
        return refuse_unused(s, key, node, path);
    }
    return key->type == RG_KEY_LIST ? check_list(s->ck, key, node, path, base)
                                    : rg_value_read(s->ck, key, node, path, base);
}

/* Notes the keys of an anisotropic solid; at the last of them they are looked at together. */
static void learn_constants(rg_check *ck, size_t at, const rg_node *node, bool good) {
    static const size_t keys[RG_CONSTANTS] = {
        [RG_OF_YOUNG] = offsetof(rg_material_input, young),
        [RG_OF_POISSON] = offsetof(rg_material_input, poisson),
        [RG_OF_SHEAR] = offsetof(rg_material_input, deshpande_evans.shear),
        [RG_OF_STIFFNESS] = offsetof(rg_material_input, anisotropic.stiffness),
        [RG_OF_AXIS_1] = offsetof(rg_material_input, anisotropic.axis[0]),
        [RG_OF_AXIS_2] = offsetof(rg_material_input, anisotropic.axis[1]),
        [RG_OF_ANGLE_1] = offsetof(rg_material_input, anisotropic.angle[0]),
        [RG_OF_ANGLE_2] = offsetof(rg_material_input, anisotropic.angle[1]),
        [RG_OF_ANGLE_3] = offsetof(rg_material_input, anisotropic.angle[2]),
        [RG_OF_FIELD] = offsetof(rg_material_input, anisotropic.field),
        [RG_OF_ANGLES] = offsetof(rg_material_input, anisotropic.angles)};
    rg_material_check *m = &ck->material;
    for (int i = 0; i < RG_CONSTANTS; i++) {
        if (at == keys[i]) {
            m->constant[i] = node;
            m->constants = m->constants && good;
        }
    }
    if (at == keys[RG_OF_ANGLES] && m->constants && m->model && m->of->model == RG_MATERIAL_ANISOTROPIC) {
        rg_anisotropic_rule(ck);
    }
}

/* Of a parameter of a material; after the last one, what they must be to each other. */
static void learn_parameter(rg_check *ck, size_t number, const rg_node *node, bool good) {
    rg_material_check *m = &ck->material;
    m->given[number] = good ? node : NULL;
    m->bad[number] = !good;
    if (number + 1 == RG_PARAMETERS && m->model) {
        rg_parameters_rule(ck);
    }
}

/* What the value of a key of a material says about others. */
static void learn_material(rg_check *ck, const rg_key *key, const rg_node *node, bool good) {
    const size_t first = offsetof(rg_material_input, parameter), size = sizeof ck->material.of->parameter;
    size_t at = key->offset - key->input;
    rg_material_check *m = &ck->material;
    learn_constants(ck, at, node, good);
    if (at >= first && at < first + size) {
        learn_parameter(ck, (at - first) / sizeof(double), node, good);
    }
    if (at == offsetof(rg_material_input, user.library)) {
        m->library = good ? node : NULL;
    } else if (at == offsetof(rg_material_input, user.is) && m->model && m->of->model == RG_MATERIAL_USER) {
        rg_user_rule(ck, good ? node : NULL);
    }
    if (at == offsetof(rg_material_input, model)) {
        m->model = good;
        ck->models = ck->models && good;
        if (good) {
            rg_model_rule(ck, node);
        }
    } else if (at == offsetof(rg_material_input, parameter[RG_PARAMETER_SATURATION_STRESS])) {
        m->saturation = good ? node : NULL;
        m->saturates = good;
    } else if (at == offsetof(rg_material_input, parameter[RG_PARAMETER_SATURATION_RATE]) && good) {
        rg_saturation_rule(ck, node);
    } else if (at == offsetof(rg_material_input, deshpande_evans.flaw_density)) {
        m->flaws = m->flaws && good;
        m->density = node;
    } else if (at == offsetof(rg_material_input, deshpande_evans.flaw_radius) ||
               at == offsetof(rg_material_input, deshpande_evans.alpha)) {
        m->flaws = m->flaws && good;
    } else if (at == offsetof(rg_material_input, deshpande_evans.damage_max) && m->flaws && good) {
        rg_flaw_rule(ck);
    }
}

/* Whether a group is used, where what decides on it is `good`. */
static rg_usage usage_if(bool good, rg_key_group group, const rg_case *c) {
    return !good ? RG_UNSURE : rg_group_used(group, c) ? RG_USED : RG_UNUSED;
}

/* What the value of a key of the case says about others. */
static void learn(rg_check *ck, const rg_key *key, const rg_node *node, bool good) {
    if (key->offset == offsetof(rg_case, material.name) && node != NULL && good) {
        rg_material_name_rule(ck, node);
    } else if (key->offset == offsetof(rg_case, interface.form)) {
        ck->form = good;
        ck->usage[RG_GROUP_FACES] = usage_if(good, RG_GROUP_FACES, ck->c);
    } else if (key->offset == offsetof(rg_case, interface.faces)) {
        ck->form = ck->form && good;
        ck->usage[RG_GROUP_INTERFACE] = usage_if(ck->form, RG_GROUP_INTERFACE, ck->c);
        ck->usage[RG_GROUP_DG] = usage_if(ck->form, RG_GROUP_DG, ck->c);
    } else if (key->offset == offsetof(rg_case, interface.beta_s)) {
        ck->penalty_given = node != NULL;
    } else if (key->offset == offsetof(rg_case, interface.law)) {
        rg_law_rule(ck, node, good);
    } else if (key->offset == offsetof(rg_case, interface.user.library)) {
        ck->law_library = good ? node : NULL;
    } else if (key->offset == offsetof(rg_case, interface.user.is) && ck->law_library != NULL) {
        rg_user_law_rule(ck, good ? node : NULL);
    } else if (key->offset == offsetof(rg_case, interface.activation)) {
        ck->switch_given = node != NULL;
        rg_activation_rule(ck, node, good);
    } else if (key->offset == offsetof(rg_case, interface.onset)) {
        ck->switch_given |= node != NULL;
    } else if (key->offset == offsetof(rg_case, interface.contact) && good) {
        rg_contact_rule(ck, node);
    } else if (key->offset == offsetof(rg_case, interface.friction) && good) {
        rg_friction_rule(ck, node);
    } else if (key->offset == offsetof(rg_case, interface.shear) && node != NULL && good) {
        rg_shear_rule(ck, node);
    } else if (key->offset == offsetof(rg_case, interface.criterion) && node != NULL && good) {
        rg_criterion_rule(ck, node);
    } else if (key->offset == offsetof(rg_case, contact.model)) {
        bool general = ck->c->contact.model == RG_CONTACT_GENERAL;
        ck->usage[RG_GROUP_CONTACT] = !good ? RG_UNSURE : general ? RG_USED : RG_UNUSED;
        if (general && node != NULL && good) {
            rg_contact_model_rule(ck, node);
        }
    } else if (key->offset == offsetof(rg_case, contact.static_friction) && node != NULL && good) {
        rg_static_friction_rule(ck, node);
    } else if (key->offset == offsetof(rg_case, mass) && good && ck->form) {
        rg_mass_rule(ck, node);
    } else if (key->offset == offsetof(rg_case, interface.weibull.modulus)) {
        ck->usage[RG_GROUP_WEIBULL] = node == NULL ? RG_UNUSED : good ? RG_USED : RG_UNSURE;
    } else if (key->offset == offsetof(rg_case, interface.rise.rate)) {
        ck->usage[RG_GROUP_RISE] = node == NULL ? RG_UNUSED : good ? RG_USED : RG_UNSURE;
    } else if (key->offset == offsetof(rg_case, temperature.value)) {
        ck->usage[RG_GROUP_HEAT] = node == NULL ? RG_UNUSED : good ? RG_USED : RG_UNSURE;
    } else if (key->offset == offsetof(rg_case, start)) {
        ck->usage[RG_GROUP_RELAX] = !good ? RG_UNSURE : ck->c->start == RG_START_RELAX ? RG_USED : RG_UNUSED;
    } else if (key->offset == offsetof(rg_case, stress_of.run)) {
        ck->usage[RG_GROUP_STRESS_RUN] = node == NULL ? RG_UNUSED : good ? RG_USED : RG_UNSURE;
        if (node != NULL && good) {
            rg_stress_run_rule(ck);
        }
    } else if (key->offset == offsetof(rg_case, mesh.file) && node != NULL) {
        ck->usage[RG_GROUP_BOX] = RG_UNUSED;
        ck->box = false;
        if (good) {
            rg_mesh_file_rule(ck, node);
        }
    } else if (key->offset == offsetof(rg_case, output.time) && node != NULL && good) {
        rg_times_rule(ck, node);
    } else if (key->offset == offsetof(rg_case, mesh.size) || key->offset == offsetof(rg_case, mesh.origin)) {
        ck->box = ck->box && good;
    } else if (key->offset == offsetof(rg_case, output.fields) && good && ck->models) {
        rg_fields_rule(ck, key, node);
    }
}

static bool check_table(rg_check *ck, const rg_key_table *table, const rg_node *node, const char *path,
                        void *base) {
    scan s = {.ck = ck, .table = table, .top = node, .path = path};
    int before = ck->problems->count;
    collect(&s, node, "");
    bool all = ck->problems->count == before;
    for (int i = 0; i < table->keys; i++) {
        char *name = rg_text_format("%s%s", path, table->key[i].name);
        bool good = check_key(&s, &table->key[i], s.found[i], name, base);
        all = all && good;
        if (table->key[i].of_material) {
            learn_material(ck, &table->key[i], s.found[i], good);
        } else if (table == &rg_case_table) {
            learn(ck, &table->key[i], s.found[i], good);
        }
        rg_free(name);
    }
    return all;
}

void rg_case_check(rg_check *ck, const rg_node *root) {
    ck->box = ck->models = true;
    ck->material = (rg_material_check){
        .path = "material.",
        .of = &ck->c->material,
        .flaws = true,
        .constants = true,
        .block = root->kind == RG_NODE_MAPPING ? rg_node_find(root, "material", strlen("material")) : NULL};
    if (root->kind == RG_NODE_MAPPING) {
        int before = ck->problems->count;
        check_table(ck, &rg_case_table, root, "", ck->c);
        if (ck->problems->count == before) {
            rg_entry whole = {ck, root, NULL};
            rg_rotation_rule(&whole, "initial.", &ck->c->initial);
            rg_start_rule(&whole);
            rg_stress_rule(&whole);
            rg_temperature_rule(&whole);
        }
    } else if (root->kind != RG_NODE_BAD) {
        char value[64];
        rg_subject subject = {.value = rg_node_line(root, value, sizeof value)};
        rg_problem_add(ck->problems, root->at, &subject, "a case is a mapping of keys");
    }
}
