#include "mesh/import/inp_read.h"

#include <ctype.h>
#include <errno.h>
#include <inttypes.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/error.h"
#include "base/files.h"
#include "base/mem.h"
#include "mesh/import/import.h"
#include "mesh/rows.h"

/* Where a set comes from; higher ones decide. */
typedef enum { FROM_LINE, FROM_ELSET, FROM_SECTION } rank;

typedef struct {
    char name[RG_SET_NAME];
    rank rank;
    long line;     /* where it begins */
    bool internal; /* made by the preprocessor for a *SURFACE */
    rg_gid *member;
    size_t count, room;
} elset;

typedef struct {
    rg_gid number;
    int nodes; /* 4, 10: a tetrahedron; 3: the corners of a triangle */
    size_t node[10];
} element;

typedef struct {
    char name[RG_SET_NAME], of[RG_SET_NAME]; /* `of`: an element or a set of elements */
    long line;
    int face; /* 0 to 3: S1 to S4; 4: the triangle itself */
} patch;

/* What a data line means. */
typedef enum { SKIP, NODE, ELEMENT, ELSET, SURFACE, INSTANCE } section;

typedef struct {
    const char *path;
    long line;
    rg_import import;
    section section;
    int expected, parts; /* nodes of an element; *PART lines */
    bool sections;       /* there is a *SOLID SECTION */
    elset *set;
    size_t sets, current; /* current: set of the data lines */
    element *element;
    size_t elements, element_room;
    patch *patch;
    size_t patches;
    char surface[RG_SET_NAME]; /* the one that the data lines define */
    bool generate;
    element pending; /* read in part */
    int have;
    rg_gid_map by_number; /* of the elements */
} reader;

static const int face_corner[4][3] = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}; /* S1 to S4 */

static _Noreturn void refuse(const reader *r, const char *format, ...) __attribute__((format(printf, 2, 3)));

static void refuse(const reader *r, const char *format, ...) {
    char what[300];
    va_list args;
    va_start(args, format);
    vsnprintf(what, sizeof what, format, args);
    va_end(args);
    rg_fatal(RG_USAGE, "%s:%ld: %s", r->path, r->line, what);
}

/* ---- text ---- */

/* The next of the words between commas, without the blanks around it; NULL at the end. Cuts up *line. */
static char *next_word(char **line) {
    if (*line == NULL) {
        return NULL;
    }
    char *word = *line + strspn(*line, " \t"), *comma = strchr(word, ',');
    *line = comma != NULL ? comma + 1 : NULL;
    size_t length = comma != NULL ? (size_t)(comma - word) : strlen(word);
    while (length > 0 && isspace((unsigned char)word[length - 1])) {
        length--;
    }
    word[length] = '\0';
    return word;
}

/* The value of parameter `name` of a keyword line ("" if it has none), NULL if it is not there. */
static const char *parameter(const reader *r, const char *line, const char *name, char out[RG_SET_NAME]) {
    char copy[1024], *rest = copy, *word;
    snprintf(copy, sizeof copy, "%s", line);
    while ((word = next_word(&rest)) != NULL) {
        char *equals = strchr(word, '=');
        size_t length = equals != NULL ? (size_t)(equals - word) : strlen(word);
        while (length > 0 && word[length - 1] == ' ') {
            length--;
        }
        if (length != strlen(name) || strncasecmp(word, name, length) != 0) {
            continue;
        }
        const char *value = equals != NULL ? equals + 1 + strspn(equals + 1, " \"") : "";
        size_t size = strcspn(value, "\"");
        if (size >= RG_SET_NAME) {
            refuse(r, "'%s' is longer than %d bytes", value, RG_SET_NAME - 1);
        }
        memcpy(out, value, size);
        out[size] = '\0';
        return out;
    }
    return NULL;
}

static rg_gid read_number(const reader *r, const char *word) {
    char *end;
    long long value = strtoll(word, &end, 10);
    if (end == word || *end != '\0' || value < 1 || value > INT64_C(4000000000)) {
        refuse(r, "'%s' is not the number of a node or element", word);
    }
    return value;
}

static bool is_number(const char *word) {
    return word[0] != '\0' && word[strspn(word, "0123456789")] == '\0';
}

/* ---- sets ---- */

static size_t find_set(const reader *r, const char *name, rank from) {
    size_t i = 0;
    while (i < r->sets && !(r->set[i].rank == from && strcasecmp(r->set[i].name, name) == 0)) {
        i++;
    }
    return i;
}

/* The set of this name and kind, a new one if need be. */
static size_t need_set(reader *r, const char *name, rank from) {
    size_t i = find_set(r, name, from);
    if (i == r->sets) {
        r->set = rg_realloc(r->set, r->sets + 1, sizeof *r->set);
        r->set[r->sets] = (elset){.rank = from, .line = r->line};
        strcpy(r->set[r->sets++].name, name);
    }
    return i;
}

/* A set may name elements that come later, or some twice, but there are limits: sets of sets of sets grow
 * without bound, and so does one with all numbers there could be. */
static void add_member(reader *r, size_t set, rg_gid number) {
    elset *s = &r->set[set];
    size_t most = 16 * r->elements + 65536;
    if (s->count == most) {
        refuse(r, "set '%s' has more than %zu members, with %zu elements so far", s->name, most, r->elements);
    }
    s->member = rg_grow(s->member, &s->room, s->count, sizeof *s->member);
    s->member[s->count++] = number;
}

/* Adds all members of the sets called `name`. */
static void add_set(reader *r, size_t to, const char *name) {
    bool found = false;
    for (size_t i = 0; i < r->sets; i++) {
        if (i == to || r->set[i].rank == FROM_SECTION || strcasecmp(r->set[i].name, name) != 0) {
            continue;
        }
        found = true;
        for (size_t k = 0; k < r->set[i].count; k++) {
            add_member(r, to, r->set[i].member[k]);
        }
    }
    if (!found) {
        refuse(r, "no set of elements '%s' so far", name);
    }
}

/* ---- keyword lines ---- */

/* Nodes that the data lines of an element type have; what else there is has none of our business (0). */
static int nodes_of(const reader *r, const char *type) {
    static const struct {
        const char *begin;
        int nodes;
    } known[] = {{"C3D10", 10}, {"C3D4", 4},   {"S3", 3},    {"STRI3", 3}, {"STRI65", 6},
                 {"CPS3", 3},   {"CPS6", 6},   {"CPE3", 3},  {"CPE6", 6},  {"M3D3", 3},
                 {"M3D6", 6},   {"SFM3D3", 3}, {"SFM3D6", 6}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        size_t length = strlen(known[i].begin);
        if (strncasecmp(type, known[i].begin, length) == 0 && !isdigit((unsigned char)type[length])) {
            return known[i].nodes;
        }
    }
    if (strncasecmp(type, "C3D", 3) == 0 || strncasecmp(type, "SC", 2) == 0) {
        refuse(r, "*ELEMENT, TYPE=%s: only tetrahedra of first and second order are possible: C3D4, C3D10",
               type);
    }
    return 0;
}

static void begin_elements(reader *r, const char *line) {
    char type[RG_SET_NAME], set[RG_SET_NAME];
    if (parameter(r, line, "TYPE", type) == NULL) {
        refuse(r, "*ELEMENT without TYPE");
    }
    r->expected = nodes_of(r, type);
    r->section = r->expected > 0 ? ELEMENT : SKIP;
    r->have = 0;
    r->current = parameter(r, line, "ELSET", set) != NULL ? need_set(r, set, FROM_LINE) : SIZE_MAX;
}

static void begin_set(reader *r, const char *line) {
    char name[RG_SET_NAME], unused[RG_SET_NAME];
    if (parameter(r, line, "ELSET", name) == NULL) {
        refuse(r, "*ELSET without a name");
    }
    r->section = ELSET;
    r->current = need_set(r, name, FROM_ELSET);
    r->generate = parameter(r, line, "GENERATE", unused) != NULL;
    r->set[r->current].internal = parameter(r, line, "INTERNAL", unused) != NULL;
}

static void begin_surface(reader *r, const char *line) {
    char type[RG_SET_NAME] = "ELEMENT";
    parameter(r, line, "TYPE", type);
    if (parameter(r, line, "NAME", r->surface) == NULL) {
        refuse(r, "*SURFACE without NAME");
    }
    r->section = strcasecmp(type, "ELEMENT") == 0 ? SURFACE : SKIP;
    if (r->section == SKIP) {
        rg_warn("%s:%ld: *SURFACE, NAME=%s is not of TYPE=ELEMENT: left out", r->path, r->line, r->surface);
    }
}

static void begin(reader *r, const char *line) {
    char copy[1024], *rest = copy, name[RG_SET_NAME];
    snprintf(copy, sizeof copy, "%s", line);
    const char *word = next_word(&rest);
    r->section = SKIP;
    if (strcasecmp(word, "*NODE") == 0) {
        r->section = NODE;
    } else if (strcasecmp(word, "*ELEMENT") == 0) {
        begin_elements(r, line);
    } else if (strcasecmp(word, "*ELSET") == 0) {
        begin_set(r, line);
    } else if (strcasecmp(word, "*SURFACE") == 0) {
        begin_surface(r, line);
    } else if (strcasecmp(word, "*SOLID SECTION") == 0 && parameter(r, line, "ELSET", name) != NULL) {
        need_set(r, name, FROM_SECTION);
        r->sections = true;
    } else if (strcasecmp(word, "*PART") == 0 && ++r->parts > 1) {
        refuse(r, "a second *PART: only one is possible");
    } else if (strcasecmp(word, "*INSTANCE") == 0) {
        r->section = INSTANCE;
    } else if (strcasecmp(word, "*INCLUDE") == 0) {
        refuse(r, "*INCLUDE: put everything into one file");
    }
}

/* ---- data lines ---- */

static void read_node(reader *r, char *line) {
    char *rest = line;
    size_t number = (size_t)read_number(r, next_word(&rest));
    double x[3] = {0, 0, 0};
    for (int i = 0; i < 3; i++) {
        const char *word = next_word(&rest);
        char *end;
        x[i] = word != NULL ? strtod(word, &end) : 0;
        if (word == NULL || end == word || *end != '\0') {
            refuse(r, "node %zu needs three coordinates", number);
        }
    }
    rg_import_node(&r->import, number, x);
}

static void end_element(reader *r) {
    element *e = &r->pending;
    r->element = rg_grow(r->element, &r->element_room, r->elements, sizeof *r->element);
    e->nodes = r->expected < 4 || r->expected == 6 ? 3 : r->expected;
    if (e->nodes == 10) { /* the last two middles stand the other way round */
        size_t swap = e->node[8];
        e->node[8] = e->node[9];
        e->node[9] = swap;
    }
    r->element[r->elements++] = *e;
    if (r->current != SIZE_MAX) {
        add_member(r, r->current, e->number);
    }
    r->have = 0;
}

/* An element may go on in the next line. */
static void read_element(reader *r, char *line) {
    char *rest = line;
    for (const char *word = next_word(&rest); word != NULL; word = next_word(&rest)) {
        if (word[0] == '\0' && rest == NULL) {
            break; /* comma at the end */
        }
        rg_gid number = read_number(r, word);
        if (r->have == 0) {
            r->pending.number = number;
        } else {
            r->pending.node[r->have - 1] = (size_t)number;
        }
        if (++r->have == r->expected + 1) {
            end_element(r);
        }
    }
}

static void read_set(reader *r, char *line) {
    char *rest = line, *word;
    if (r->generate) {
        rg_gid from = read_number(r, next_word(&rest)), step = 1;
        word = next_word(&rest);
        rg_gid to = word != NULL ? read_number(r, word) : from;
        word = next_word(&rest);
        step = word != NULL && word[0] != '\0' ? read_number(r, word) : 1;
        for (; from <= to; from += step) {
            add_member(r, r->current, from);
        }
        return;
    }
    while ((word = next_word(&rest)) != NULL) {
        if (is_number(word)) {
            add_member(r, r->current, read_number(r, word));
        } else if (word[0] != '\0') {
            add_set(r, r->current, word);
        }
    }
}

static void read_surface(reader *r, char *line) {
    static const char *const labels[] = {"S1", "S2", "S3", "S4", "SPOS", "SNEG"};
    char *rest = line;
    const char *of = next_word(&rest), *label = next_word(&rest);
    patch p = {.line = r->line, .face = -1};
    for (int i = 0; i < 6 && label != NULL; i++) {
        p.face = strcasecmp(label, labels[i]) == 0 ? (i < 4 ? i : 4) : p.face;
    }
    if (p.face < 0 || strlen(of) >= RG_SET_NAME) {
        refuse(r, "*SURFACE: 'element or set, S1 to S4' is expected");
    }
    strcpy(p.name, r->surface);
    strcpy(p.of, of);
    r->patch = rg_realloc(r->patch, r->patches + 1, sizeof *r->patch);
    r->patch[r->patches++] = p;
}

static void read_data(reader *r, char *line) {
    switch (r->section) {
    case NODE:
        read_node(r, line);
        break;
    case ELEMENT:
        read_element(r, line);
        break;
    case ELSET:
        read_set(r, line);
        break;
    case SURFACE:
        read_surface(r, line);
        break;
    case INSTANCE:
        refuse(r, "*INSTANCE that is moved: give the part in its own coordinates");
    case SKIP:
        break;
    }
}

static void read_lines(reader *r) {
    FILE *f = rg_open_input(r->path);
    char *line = NULL;
    size_t size = 0;
    if (f == NULL) {
        rg_fatal(RG_USAGE, "%s: cannot be read: %s", r->path, strerror(errno));
    }
    while (getline(&line, &size, f) >= 0) {
        r->line++;
        if (r->line == 1 && strncmp(line, "\xef\xbb\xbf", 3) == 0) { /* how some editors mark UTF-8 */
            memmove(line, line + 3, strlen(line + 3) + 1);
        }
        line[strcspn(line, "\r\n")] = '\0';
        bool blank = line[strspn(line, " \t")] == '\0', comment = strncmp(line, "**", 2) == 0;
        if (line[0] == '*' && !comment) {
            if (r->section == ELEMENT && r->have > 0) {
                refuse(r, "element %" PRId64 " has %d of %d nodes", r->pending.number, r->have - 1,
                       r->expected);
            }
            begin(r, line);
        } else if (!blank && !comment) {
            read_data(r, line);
        }
    }
    bool failed = ferror(f) != 0;
    free(line);
    fclose(f);
    if (failed || (r->section == ELEMENT && r->have > 0)) {
        refuse(r, "the file ends within an element, or cannot be read");
    }
}

/* ---- sets to regions and faces ---- */

static const element *find_element(const reader *r, rg_gid number) {
    rg_lid i = rg_gid_map_get(&r->by_number, number);
    return i >= 0 ? &r->element[i] : NULL;
}

static void index_elements(reader *r) {
    r->by_number = rg_gid_map_make(r->elements);
    for (size_t i = 0; i < r->elements; i++) {
        if (rg_gid_map_put(&r->by_number, r->element[i].number, (rg_lid)i) != (rg_lid)i) {
            rg_fatal(RG_USAGE, "%s: element %" PRId64 " is defined twice", r->path, r->element[i].number);
        }
    }
}

/* The number of set `name` in a mesh's list, a new one if need be. */
static int name_set(const reader *r, const char *name, int *count, char *list[]) {
    for (int i = 0; i < *count; i++) {
        if (strcmp(list[i], name) == 0) {
            return i;
        }
    }
    if (*count == RG_MAX_SETS) {
        rg_fatal(RG_USAGE, "%s: more than %d sets", r->path, RG_MAX_SETS);
    }
    list[*count] = RG_NEW(char, RG_SET_NAME);
    strcpy(list[*count], name);
    return (*count)++;
}

/* A section has the members of the sets of its name. */
static void fill_sections(reader *r) {
    for (size_t i = 0; i < r->sets; i++) {
        if (r->set[i].rank == FROM_SECTION) {
            char name[RG_SET_NAME];
            r->line = r->set[i].line;
            strcpy(name, r->set[i].name);
            add_set(r, i, name);
        }
    }
}

/* chosen[element]: the set that counts for it, + 1; solids and triangles each by their own rules. */
static size_t *choose_sets(const reader *r) {
    size_t *chosen = RG_NEW(size_t, r->elements + 1);
    for (size_t s = 0; s < r->sets; s++) {
        for (size_t k = 0; k < r->set[s].count && !r->set[s].internal; k++) {
            const element *e = find_element(r, r->set[s].member[k]);
            if (e == NULL || (e->nodes > 3 && r->sections && r->set[s].rank != FROM_SECTION)) {
                continue;
            }
            size_t *now = &chosen[e - r->element];
            const elset *old = *now > 0 ? &r->set[*now - 1] : NULL;
            if (old != NULL && old->rank == r->set[s].rank && *now != s + 1) {
                rg_fatal(RG_USAGE,
                         "%s: element %" PRId64 " is in two sets, '%s' and '%s'; it can be in one only",
                         r->path, e->number, old->name, r->set[s].name);
            }
            *now = old == NULL || old->rank < r->set[s].rank ? s + 1 : *now;
        }
    }
    return chosen;
}

static void take_elements(reader *r, rg_mesh *names) {
    size_t *chosen = choose_sets(r);
    for (size_t i = 0; i < r->elements; i++) {
        const element *e = &r->element[i];
        const char *set = chosen[i] > 0 ? r->set[chosen[i] - 1].name : NULL;
        if (e->nodes > 3) {
            int region = set != NULL ? name_set(r, set, &names->regions, names->region_name) : -1;
            rg_import_element(&r->import, e->number, e->nodes, e->node, region);
        } else if (set != NULL) {
            rg_import_add_face(&r->import, e->number, e->node,
                               name_set(r, set, &names->sets, names->set_name));
        }
    }
    rg_free(chosen);
}

static void take_face(reader *r, const patch *p, int set, rg_gid number) {
    const element *e = find_element(r, number);
    if (e == NULL || (p->face < 4) != (e->nodes > 3)) {
        rg_fatal(RG_USAGE, "%s: *SURFACE, NAME=%s: element %" PRId64 " is not there or has no such face",
                 r->path, p->name, number);
    }
    size_t node[3];
    for (int k = 0; k < 3; k++) {
        node[k] = e->node[p->face < 4 ? face_corner[p->face][k] : k];
    }
    rg_import_add_face(&r->import, number, node, set);
}

static void take_surfaces(reader *r, rg_mesh *names) {
    for (size_t i = 0; i < r->patches; i++) {
        const patch *p = &r->patch[i];
        r->line = p->line;
        int set = name_set(r, p->name, &names->sets, names->set_name);
        if (is_number(p->of)) {
            take_face(r, p, set, read_number(r, p->of));
            continue;
        }
        size_t all = need_set(r, "", FROM_SECTION); /* a place to collect them */
        r->set[all].count = 0;
        add_set(r, all, p->of);
        for (size_t k = 0; k < r->set[all].count; k++) {
            take_face(r, p, set, r->set[all].member[k]);
        }
    }
}

rg_mesh *rg_inp_read(const char *path, double scale) {
    reader r = {.path = path, .import = {.path = path, .scale = scale}};
    rg_mesh names = {0};
    read_lines(&r);
    index_elements(&r);
    fill_sections(&r);
    take_elements(&r, &names);
    take_surfaces(&r, &names);
    rg_mesh *mesh = rg_import_finish(&r.import, names.set_name);
    mesh->sets = names.sets;
    mesh->regions = names.regions;
    memcpy(mesh->set_name, names.set_name, sizeof mesh->set_name);
    memcpy(mesh->region_name, names.region_name, sizeof mesh->region_name);
    for (size_t s = 0; s < r.sets; s++) {
        rg_free(r.set[s].member);
    }
    rg_free(r.set);
    rg_free(r.element);
    rg_free(r.patch);
    rg_gid_map_free(&r.by_number);
    return mesh;
}
