#include "mesh/import/inp_read.h"

#include <inttypes.h>
#include <stdbool.h>
#include <string.h>
#include <strings.h>

#include "base/error.h"
#include "base/mem.h"
#include "mesh/import/inp_generate.h"
#include "mesh/import/inp_keyword.h"
#include "mesh/import/inp_line.h"
#include "mesh/import/inp_mesh.h"
#include "mesh/import/inp_model.h"
#include "mesh/import/inp_report.h"
#include "mesh/import/inp_type.h"

typedef struct {
    rg_inp_model *model;
    char name[RG_SET_NAME];
    rg_inp_place at;
    int instances;
} part;

typedef struct {
    rg_inp_lines *lines;
    rg_inp_word section; /* what data lines belong to */
    char keyword[RG_INP_WORD];
    bool in_step;
    bool assembled; /* there is an assembly, in which what stands outside of instances is not of the mesh */

    rg_inp_model *whole, *here; /* the assembly, or a file without parts; where things are added now */
    int scope;                  /* of `here` */
    part *part;
    size_t parts;

    rg_frame system, placed; /* of *SYSTEM; of the instance */
    double point[3][3];      /* data of *SYSTEM and *INSTANCE, as far as they have come */
    int lines_read;
    char instance[RG_SET_NAME];
    size_t of_part;
    bool pending;      /* an *INSTANCE that is not there yet: its data lines are still to come */
    char nodes_system; /* of *NODE, SYSTEM=: R, C, S */

    rg_inp_type type;
    rg_gid element[21]; /* its number and nodes */
    int have;
    bool goes_on;           /* the element of another type, in the next line */
    size_t tally;           /* of the type that is left out */
    size_t set;             /* of the data lines; SIZE_MAX: none */
    char name[RG_SET_NAME]; /* of the set that the generator fills; "": none */
    int of_scope;           /* of the numbers of the data lines: that of INSTANCE= */
    bool generate;
    size_t surface;

    bool split; /* other solids too are read, to be split */
    bool flat;  /* lines too are read, the edges of triangles */
    rg_inp_report report;
} reader;

/* ---- numbers ---- */

static bool is_outside(const reader *r, int scope) {
    return r->assembled && r->here == r->whole && scope == 0;
}

/* What is added to numbers of `scope` in data lines. */
static rg_gid shift_of(const reader *r, rg_inp_of of, int scope) {
    const rg_inp_scope *s = &r->here->scope[scope];
    return is_outside(r, scope) ? RG_INP_OUTSIDE : of == RG_INP_NODES ? s->nodes : s->elements;
}

static rg_gid shifted(const reader *r, rg_inp_of of, rg_gid number) {
    number += shift_of(r, of, r->scope);
    if (number > RG_INP_MOST && number < RG_INP_OUTSIDE) {
        rg_inp_refuse(r->lines->at, "the number gets beyond %" PRId64 " in instance '%s'", RG_INP_MOST,
                      r->here->scope[r->scope].name);
    }
    return number;
}

/* A node or element by its number or the name of its set, which may stand behind the name of an instance and
 * a dot. */
static rg_inp_entry read_entry(const reader *r, rg_inp_of of, const char *field) {
    int scope = r->of_scope;
    size_t past = 0;
    for (int s = 1; s < r->here->scopes; s++) {
        size_t length = strlen(r->here->scope[s].name);
        if (length >= past && strncasecmp(field, r->here->scope[s].name, length) == 0 &&
            field[length] == '.') {
            scope = s;
            past = length + 1;
        }
    }
    const char *label = field + past;
    rg_inp_entry e = {.step = 1, .scope = scope, .listed = true, .at = r->lines->at};
    if (rg_inp_is_number(label)) {
        e.from = e.to = rg_inp_number(r->lines, label) + shift_of(r, of, scope);
    } else {
        e.name = rg_inp_copy_text(label);
    }
    return e;
}

/* ---- keyword lines ---- */

static const char *allowed_name(reader *r, const char *parameter) {
    return rg_inp_parameter(r->lines, parameter) != NULL ? rg_inp_name(r->lines, parameter) : NULL;
}

/* The set that parameter `parameter` names, to be filled; SIZE_MAX if there is none. */
static size_t set_to_fill(reader *r, rg_inp_of of, const char *parameter) {
    const char *name = allowed_name(r, parameter);
    if (name == NULL) {
        return SIZE_MAX;
    }
    return (size_t)(rg_inp_need_set(r->here, of, name, r->scope, r->lines->at) - r->here->set);
}

static void begin_nodes(reader *r) {
    const char *system = rg_inp_parameter(r->lines, "SYSTEM");
    r->nodes_system = 'R';
    if (system != NULL) {
        static const char *const known[] = {"R", "C", "S", "RECTANGULAR", "CYLINDRICAL", "SPHERICAL"};
        r->nodes_system = '\0';
        for (int i = 0; i < 6; i++) {
            r->nodes_system = strcasecmp(system, known[i]) == 0 ? known[i][0] : r->nodes_system;
        }
    }
    if (r->nodes_system == '\0') {
        rg_inp_refuse(r->lines->at, "*NODE, SYSTEM=%s: R, C or S is expected", system);
    }
    r->set = set_to_fill(r, RG_INP_NODES, "NSET");
}

static void begin_elements(reader *r) {
    const char *type = rg_inp_name(r->lines, "TYPE");
    r->type = rg_inp_type_of(type);
    r->have = 0;
    r->goes_on = false;
    r->set = set_to_fill(r, RG_INP_ELEMENTS, "ELSET");
    bool idle = (r->type.shape == RG_INP_SOLID && !r->split) || (r->type.shape == RG_INP_LINE && !r->flat) ||
                (r->type.shape == RG_INP_QUADRANGLE && !r->split && !r->flat);
    r->type.nodes = idle ? 0 : r->type.nodes;
    bool of_mesh = r->type.nodes > 0;
    if (of_mesh && is_outside(r, r->scope)) {
        rg_inp_refuse(r->lines->at, "*ELEMENT, TYPE=%s in the assembly, outside of its instances", type);
    }
    if (!of_mesh) {
        r->tally = rg_inp_report_type(&r->report, type, r->type.shape == RG_INP_SOLID, r->lines->at);
    }
}

/* Scope of INSTANCE=, or the present one. */
static int named_scope(const reader *r) {
    const char *name = rg_inp_parameter(r->lines, "INSTANCE");
    for (int s = 1; name != NULL && s < r->here->scopes; s++) {
        if (strcasecmp(r->here->scope[s].name, name) == 0) {
            return s;
        }
    }
    if (name != NULL) {
        rg_inp_refuse(r->lines->at, "there is no *INSTANCE, NAME=%s so far", name);
    }
    return r->scope;
}

static void begin_set(reader *r, rg_inp_of of, const char *parameter) {
    rg_inp_name(r->lines, parameter);
    r->of_scope = named_scope(r);
    r->set = set_to_fill(r, of, parameter);
    r->generate = rg_inp_parameter(r->lines, "GENERATE") != NULL;
    rg_inp_set *s = &r->here->set[r->set];
    s->internal = rg_inp_parameter(r->lines, "INTERNAL") != NULL;
    s->unsorted = rg_inp_parameter(r->lines, "UNSORTED") != NULL;
    if (of == RG_INP_NODES && rg_inp_parameter(r->lines, "ELSET") != NULL) {
        char *name = rg_inp_copy_text(rg_inp_name(r->lines, "ELSET"));
        rg_inp_add_entry(
            s, (rg_inp_entry){.name = name, .scope = r->of_scope, .corners = true, .at = r->lines->at});
    }
}

static void begin_surface(reader *r) {
    const char *name = rg_inp_name(r->lines, "NAME"), *type = rg_inp_parameter(r->lines, "TYPE");
    bool nodes = type != NULL && strcasecmp(type, "NODE") == 0;
    if (type != NULL && !nodes && strcasecmp(type, "ELEMENT") != 0) {
        rg_warn("%s:%ld: *SURFACE, NAME=%s is of TYPE=%s, not of elements or nodes: left out",
                r->lines->at.path, r->lines->at.line, name, type);
        r->section = RG_INP_IRRELEVANT;
        return;
    }
    r->of_scope = r->scope;
    rg_inp_of of = nodes ? RG_INP_NODES : RG_INP_ELEMENTS;
    r->surface = (size_t)(rg_inp_need_surface(r->here, name, of, r->scope) - r->here->surface);
}

static void begin_generator(reader *r, const char *parameter) {
    const char *name = allowed_name(r, parameter);
    strcpy(r->name, name != NULL ? name : "");
    if (r->section == RG_INP_ELCOPY) {
        rg_inp_elcopy(r->lines, r->here, r->scope, name);
    }
}

/* ---- parts and instances ---- */

static void leave_part(reader *r) {
    r->here = r->whole;
    r->scope = 0;
    r->system = r->placed = rg_frame_global;
}

static void begin_part(reader *r) {
    const char *name = rg_inp_name(r->lines, "NAME");
    leave_part(r);
    for (size_t i = 0; i < r->parts; i++) {
        if (strcasecmp(r->part[i].name, name) == 0) {
            rg_inp_refuse(r->lines->at, "*PART, NAME=%s is there already, in line %ld", name,
                          r->part[i].at.line);
        }
    }
    r->part = rg_realloc(r->part, r->parts + 1, sizeof *r->part);
    part *p = &r->part[r->parts++];
    *p = (part){.model = rg_inp_model_make(), .at = r->lines->at};
    strcpy(p->name, name);
    r->here = p->model;
}

static void begin_instance(reader *r) {
    const char *of = rg_inp_name(r->lines, "PART"), *name = rg_inp_name(r->lines, "NAME");
    leave_part(r);
    for (r->of_part = 0; r->of_part < r->parts && strcasecmp(r->part[r->of_part].name, of) != 0;
         r->of_part++) {
    }
    if (r->of_part == r->parts) {
        rg_inp_refuse(r->lines->at, "there is no *PART, NAME=%s so far", of);
    }
    for (int s = 1; s < r->whole->scopes; s++) {
        if (strcasecmp(r->whole->scope[s].name, name) == 0) {
            rg_inp_refuse(r->lines->at, "a second *INSTANCE, NAME=%s", name);
        }
    }
    strcpy(r->instance, name);
    r->assembled = r->pending = true;
    r->lines_read = 0;
}

/* When its data lines are over. */
static void place_instance(reader *r) {
    part *p = &r->part[r->of_part];
    p->instances++;
    r->pending = false;
    r->scope = rg_inp_add_instance(r->whole, p->model, r->instance, &r->placed, r->lines->at);
}

/* Whether another field of the data line is not blank. */
static bool has_field(const reader *r) {
    return r->lines->rest != NULL && r->lines->rest[strspn(r->lines->rest, " \t,")] != '\0';
}

/* A translation; then perhaps a rotation, about an axis by two points, and its angle. */
static void read_instance(reader *r) {
    double value[7] = {0};
    for (int i = 0; i < (r->lines_read == 0 ? 3 : 7); i++) {
        value[i] = rg_inp_value(r->lines);
    }
    if (r->lines_read > 1 || has_field(r)) {
        rg_inp_refuse(r->lines->at,
                      "*INSTANCE: 3 numbers in the first data line, 7 in the second, no third one");
    }
    if (r->lines_read++ == 0) {
        memcpy(r->point[0], value, sizeof r->point[0]);
        memcpy(r->placed.origin, value, sizeof r->placed.origin);
    } else if (!rg_frame_moved(r->point[0], value, value + 3, value[6], &r->placed)) {
        rg_inp_refuse(r->lines->at, "the axis of the rotation of *INSTANCE has no length");
    }
}

/* An origin; then perhaps a point on the first axis, in the same line, and one on the side of the second. */
static void read_system(reader *r) {
    double value[6];
    bool axis = false;
    for (int i = 0; i < 6; i++) {
        axis = axis || (i == 3 && has_field(r));
        value[i] = rg_inp_value(r->lines);
    }
    if (r->lines_read > 1 || (r->lines_read == 1 && axis) || has_field(r)) {
        rg_inp_refuse(r->lines->at,
                      "*SYSTEM: two points in the first line, one in the second, no third line");
    }
    if (r->lines_read++ == 0) {
        memcpy(r->point[0], value, sizeof r->point[0]);
        memcpy(r->point[1], axis ? value + 3 : value, sizeof r->point[1]);
        memcpy(r->system.origin, value, sizeof r->system.origin);
        if (axis && !rg_frame_through(r->point[0], r->point[1], NULL, &r->system)) {
            memset(r->system.axis, 0, sizeof r->system.axis); /* the second line has to save it */
        }
    } else if (!rg_frame_through(r->point[0], r->point[1], value, &r->system)) {
        rg_inp_refuse(r->lines->at, "the three points of *SYSTEM are on a line");
    }
}

/* ---- data lines ---- */

static void read_node(reader *r) {
    rg_gid number = rg_inp_integer(r->lines, 0);
    double x[3];
    for (int i = 0; i < 3; i++) {
        x[i] = rg_inp_value(r->lines);
    }
    if (is_outside(r, r->scope)) {
        return; /* a reference point */
    }
    if (r->nodes_system == 'C') {
        rg_from_cylindrical(x);
    } else if (r->nodes_system == 'S') {
        rg_from_spherical(x);
    }
    rg_frame_out(&r->system, x);
    rg_frame_out(&r->placed, x);
    number = shifted(r, RG_INP_NODES, number);
    rg_inp_add_node(r->here, number, x);
    if (r->set != SIZE_MAX) {
        rg_inp_add_number(&r->here->set[r->set], number, false, r->lines->at);
    }
}

static void end_element(reader *r, int kind) {
    if (!rg_inp_add_element(r->here, r->element[0], kind, r->element + 1)) {
        rg_inp_refuse(r->lines->at, "element %" PRId64 " is defined twice",
                      r->element[0] - shift_of(r, RG_INP_ELEMENTS, r->scope));
    }
    if (r->set != SIZE_MAX) {
        rg_inp_add_number(&r->here->set[r->set], r->element[0], false, r->lines->at);
    }
    r->have = 0;
}

/* The element that has all its nodes. */
static void take_element(reader *r) {
    if (r->type.shape == RG_INP_QUADRANGLE) {
        for (int k = 5; k <= RG_INP_CORNERS_4; k++) {
            r->element[k] = r->element[4];
        }
    }
    end_element(r, r->type.shape == RG_INP_TRIANGLE     ? 3
                   : r->type.shape == RG_INP_QUADRANGLE ? RG_INP_CORNERS_4
                   : r->type.shape == RG_INP_SOLID      ? r->type.corners
                                                        : r->type.nodes);
}

/* An element may go on in the next line. */
static void read_element(reader *r) {
    for (char *field = rg_inp_field(r->lines); field != NULL; field = rg_inp_field(r->lines)) {
        if (field[0] == '\0' && r->lines->rest == NULL) {
            break; /* a comma at the end */
        }
        rg_gid number = rg_inp_number(r->lines, field);
        r->element[r->have] = shifted(r, r->have == 0 ? RG_INP_ELEMENTS : RG_INP_NODES, number);
        if (++r->have == r->type.nodes + 1) {
            take_element(r);
        }
    }
}

/* Of a type that is left out: counted. */
static void pass_element(reader *r) {
    bool first = !r->goes_on;
    char *field = rg_inp_field(r->lines);
    if (first) {
        r->element[0] = shifted(r, RG_INP_ELEMENTS, rg_inp_number(r->lines, field));
        end_element(r, 0);
        r->report.type[r->tally].count++;
    }
    for (; field != NULL; field = rg_inp_field(r->lines)) {
        r->goes_on = field[0] == '\0';
    }
}

static void read_set(reader *r, rg_inp_of of) {
    rg_inp_set *s = &r->here->set[r->set];
    if (r->generate) {
        rg_gid shift = shift_of(r, of, r->of_scope), from = rg_inp_integer(r->lines, 0);
        rg_gid to = rg_inp_integer(r->lines, from), step = rg_inp_integer(r->lines, 1);
        if (to < from) {
            rg_inp_refuse(r->lines->at, "GENERATE from %" PRId64 " to %" PRId64 ", which is less", from, to);
        }
        rg_inp_add_entry(s, (rg_inp_entry){from + shift, to + shift, step, .at = r->lines->at});
        return;
    }
    for (char *field = rg_inp_field(r->lines); field != NULL; field = rg_inp_field(r->lines)) {
        if (field[0] == '\0') {
            continue;
        }
        rg_inp_entry e = read_entry(r, of, field);
        if (e.name == NULL) {
            rg_inp_add_number(s, e.from, e.from < RG_INP_OUTSIDE, e.at);
        } else {
            rg_inp_add_entry(s, e);
        }
    }
}

static void read_surface(reader *r) {
    static const char *const labels[] = {"S1", "S2", "S3", "S4", "S5", "S6", "SPOS", "SNEG", ""};
    static const int faces[] = {0, 1, 2, 3, 4, 5, RG_INP_SIDE, RG_INP_SIDE, RG_INP_FREE};
    enum { NONE = 8 };
    rg_inp_surface *s = &r->here->surface[r->surface];
    const char *of = rg_inp_field(r->lines), *label = rg_inp_field(r->lines);
    int i = label == NULL || s->of == RG_INP_NODES ? NONE : 0;
    for (; i < NONE && strcasecmp(label, labels[i]) != 0; i++) {
    }
    if (of[0] == '\0' || (i == NONE && label != NULL && label[0] != '\0' && s->of == RG_INP_ELEMENTS)) {
        rg_inp_refuse(r->lines->at, "*SURFACE: 'element or set, S1 to S6' is expected");
    }
    rg_inp_add_patch(s, (rg_inp_patch){read_entry(r, s->of, of), faces[i]});
}

/* ---- all lines ---- */

static void end_keyword(reader *r) {
    if (r->section == RG_INP_ELEMENT && r->have > 0) {
        rg_inp_refuse(r->lines->at, "element %" PRId64 " has %d of %d nodes",
                      r->element[0] - shift_of(r, RG_INP_ELEMENTS, r->scope), r->have - 1, r->type.nodes);
    }
    if (r->section == RG_INP_SYSTEM && r->lines_read > 0 && r->system.axis[0][0] == 0 &&
        r->system.axis[0][1] == 0 && r->system.axis[0][2] == 0) {
        rg_inp_refuse(r->lines->at,
                      "the axis of *SYSTEM stands across the x-y plane, which takes a second line");
    }
    if (r->pending) {
        place_instance(r);
    }
}

static void begin(reader *r) {
    end_keyword(r);
    rg_inp_keyword keyword = rg_inp_keyword_of(r->lines->keyword);
    bool of_step =
        keyword.word == RG_INP_NSET || keyword.word == RG_INP_ELSET || keyword.word == RG_INP_END_STEP;
    if (keyword.word == RG_INP_UNKNOWN && !r->in_step) {
        rg_inp_refuse(
            r->lines->at,
            "*%s is not a keyword that is known here, and might change the mesh: without it, the mesh "
            "could be another one",
            r->lines->keyword);
    }
    if (keyword.parameters == NULL || (r->in_step && !of_step)) {
        rg_inp_report_keyword(&r->report, r->lines->keyword);
        r->in_step = (r->in_step || keyword.word == RG_INP_STEP) && keyword.word != RG_INP_END_STEP;
        r->section = RG_INP_IRRELEVANT;
        return;
    }
    rg_inp_allow(r->lines, keyword.parameters);
    strcpy(r->keyword, keyword.name);
    r->section = keyword.word;
    r->lines_read = 0;
    switch (keyword.word) {
    case RG_INP_NODE:
        begin_nodes(r);
        break;
    case RG_INP_ELEMENT:
        begin_elements(r);
        break;
    case RG_INP_NSET:
        begin_set(r, RG_INP_NODES, "NSET");
        break;
    case RG_INP_ELSET:
        begin_set(r, RG_INP_ELEMENTS, "ELSET");
        break;
    case RG_INP_SURFACE:
        begin_surface(r);
        break;
    case RG_INP_SYSTEM:
        r->system = rg_frame_global;
        break;
    case RG_INP_PART:
        begin_part(r);
        break;
    case RG_INP_ASSEMBLY:
        r->assembled = true;
        leave_part(r);
        break;
    case RG_INP_END_ASSEMBLY:
    case RG_INP_END_PART:
    case RG_INP_END_INSTANCE:
        leave_part(r);
        break;
    case RG_INP_INSTANCE:
        begin_instance(r);
        break;
    case RG_INP_NGEN:
    case RG_INP_NFILL:
        begin_generator(r, "NSET");
        break;
    case RG_INP_ELGEN:
        begin_generator(r, "ELSET");
        break;
    case RG_INP_ELCOPY:
        begin_generator(r, "NEWSET");
        break;
    case RG_INP_UNKNOWN:
    case RG_INP_IRRELEVANT:
    case RG_INP_STEP:
    case RG_INP_END_STEP:
        break;
    }
    rg_inp_follow(r->lines);
}

static void read_data(reader *r) {
    const char *set = r->name[0] != '\0' ? r->name : NULL;
    switch (r->section) {
    case RG_INP_NODE:
        read_node(r);
        break;
    case RG_INP_ELEMENT:
        r->type.nodes > 0 ? read_element(r) : pass_element(r);
        break;
    case RG_INP_NSET:
        read_set(r, RG_INP_NODES);
        break;
    case RG_INP_ELSET:
        read_set(r, RG_INP_ELEMENTS);
        break;
    case RG_INP_SURFACE:
        read_surface(r);
        break;
    case RG_INP_SYSTEM:
        read_system(r);
        break;
    case RG_INP_INSTANCE:
        read_instance(r);
        break;
    case RG_INP_NGEN:
        rg_inp_ngen(r->lines, r->here, r->scope, set);
        break;
    case RG_INP_NFILL:
        rg_inp_nfill(r->lines, r->here, r->scope, set);
        break;
    case RG_INP_ELGEN:
        rg_inp_elgen(r->lines, r->here, r->scope, set);
        break;
    case RG_INP_UNKNOWN:
        rg_inp_refuse(r->lines->at, "data before the first keyword");
    case RG_INP_PART:
    case RG_INP_END_PART:
    case RG_INP_ASSEMBLY:
    case RG_INP_END_ASSEMBLY:
    case RG_INP_END_INSTANCE:
    case RG_INP_ELCOPY:
        rg_inp_refuse(r->lines->at, "*%s has no data lines", r->keyword);
    case RG_INP_IRRELEVANT:
    case RG_INP_STEP:
    case RG_INP_END_STEP:
        break;
    }
}

static void read_lines(reader *r) {
    for (rg_inp_kind kind = rg_inp_next(r->lines); kind != RG_INP_END; kind = rg_inp_next(r->lines)) {
        kind == RG_INP_KEYWORD ? begin(r) : read_data(r);
    }
    end_keyword(r);
}

/* A part by itself needs no instance; of several, those without one are left out. */
static rg_inp_model *choose_model(reader *r) {
    if (r->whole->scopes == 1 && r->parts == 1 && r->whole->elements.count == 0) {
        return r->part[0].model;
    }
    for (size_t i = 0; i < r->parts; i++) {
        const part *p = &r->part[i];
        if (p->instances == 0 && p->model->elements.count > 0) {
            rg_inp_refuse(p->at, "no *INSTANCE places *PART, NAME=%s, which has %zu elements", p->name,
                          p->model->elements.count);
        }
    }
    return r->whole;
}

rg_mesh *rg_inp_read(const char *path, FILE *in, const rg_import_how *how, FILE *out) {
    reader r = {.lines = rg_inp_open(path, in),
                .whole = rg_inp_model_make(),
                .section = RG_INP_UNKNOWN,
                .split = how->split,
                .flat = how->thickness > 0};
    leave_part(&r);
    read_lines(&r);
    rg_inp_report_judge(&r.report, path, how->thickness > 0);
    rg_mesh *mesh = rg_inp_mesh(path, how, choose_model(&r));
    rg_inp_report_print(&r.report, path, out);
    for (size_t i = 0; i < r.parts; i++) {
        rg_inp_model_free(r.part[i].model);
    }
    rg_free(r.part);
    rg_inp_model_free(r.whole);
    rg_inp_close(r.lines);
    return mesh;
}
