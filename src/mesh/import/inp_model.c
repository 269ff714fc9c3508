#include "mesh/import/inp_model.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/mem.h"

/* ---- rows ---- */

size_t rg_inp_row(const rg_inp_rows *rows, rg_gid number) {
    rg_lid row = rows->count > 0 ? rg_gid_map_get(&rows->map, number) : -1;
    return row >= 0 ? (size_t)row : SIZE_MAX;
}

/* The row of a number, a new one, at the end, if need be. */
static size_t need_row(rg_inp_rows *rows, rg_gid number) {
    if (rows->count == rows->map_room) {
        rg_gid_map_free(&rows->map);
        rows->map_room = 2 * rows->count + 64;
        rows->map = rg_gid_map_make(rows->map_room);
        for (size_t i = 0; i < rows->count; i++) {
            rg_gid_map_put(&rows->map, rows->number[i], (rg_lid)i);
        }
    }
    size_t row = (size_t)rg_gid_map_put(&rows->map, number, (rg_lid)rows->count);
    if (row == rows->count) {
        rows->number = rg_grow(rows->number, &rows->room, rows->count, sizeof *rows->number);
        rows->number[rows->count++] = number;
        rows->most = number > rows->most ? number : rows->most;
    }
    return row;
}

static void free_rows(rg_inp_rows *rows) {
    rg_free(rows->number);
    rg_gid_map_free(&rows->map);
}

/* ---- nodes and elements ---- */

void rg_inp_add_node(rg_inp_model *m, rg_gid number, const double x[3]) {
    size_t before = m->nodes.count, row = need_row(&m->nodes, number);
    m->x = rg_grow(m->x, &m->x_room, row, 3 * sizeof *m->x);
    m->moved += row < before && memcmp(m->x + 3 * row, x, 3 * sizeof *x) != 0;
    memcpy(m->x + 3 * row, x, 3 * sizeof *x);
}

bool rg_inp_add_element(rg_inp_model *m, rg_gid number, int kind, const rg_gid node[]) {
    size_t before = m->elements.count, row = need_row(&m->elements, number);
    if (row < before) {
        return false;
    }
    m->kind = rg_grow(m->kind, &m->kind_room, row, sizeof *m->kind);
    m->start = rg_grow(m->start, &m->start_room, row, sizeof *m->start);
    m->kind[row] = (int8_t)kind;
    m->start[row] = m->node_count;
    for (int i = 0; i < kind; i++) {
        m->node = rg_grow(m->node, &m->node_room, m->node_count, sizeof *m->node);
        m->node[m->node_count++] = (uint32_t)node[i];
    }
    return true;
}

/* ---- sets ---- */

char *rg_inp_copy_text(const char *text) {
    return strcpy(RG_NEW(char, strlen(text) + 1), text);
}

rg_inp_set *rg_inp_find_set(const rg_inp_model *m, rg_inp_of of, const char *name, int scope) {
    for (size_t i = 0; i < m->sets; i++) {
        rg_inp_set *s = &m->set[i];
        if (s->of == of && s->scope == scope && strcasecmp(s->name, name) == 0) {
            return s;
        }
    }
    return NULL;
}

static rg_inp_set *new_set(rg_inp_model *m, rg_inp_set set) {
    m->set = rg_grow(m->set, &m->set_room, m->sets, sizeof *m->set);
    m->set[m->sets] = set;
    return &m->set[m->sets++];
}

rg_inp_set *rg_inp_need_set(rg_inp_model *m, rg_inp_of of, const char *name, int scope, rg_inp_place at) {
    rg_inp_set *s = rg_inp_find_set(m, of, name, scope);
    if (s == NULL) {
        s = new_set(m, (rg_inp_set){.of = of, .scope = scope, .at = at});
        strcpy(s->name, name);
    }
    return s;
}

rg_inp_surface *rg_inp_need_surface(rg_inp_model *m, const char *name, rg_inp_of of, int scope) {
    for (size_t i = 0; i < m->surfaces; i++) {
        rg_inp_surface *s = &m->surface[i];
        if (s->of == of && s->scope == scope && strcasecmp(s->name, name) == 0) {
            return s;
        }
    }
    m->surface = rg_realloc(m->surface, m->surfaces + 1, sizeof *m->surface);
    rg_inp_surface *s = &m->surface[m->surfaces++];
    *s = (rg_inp_surface){.of = of, .scope = scope};
    strcpy(s->name, name);
    return s;
}

void rg_inp_add_entry(rg_inp_set *s, rg_inp_entry entry) {
    s->entry = rg_grow(s->entry, &s->room, s->count, sizeof *s->entry);
    s->entry[s->count++] = entry;
}

/* Numbers that follow each other are one entry. */
void rg_inp_add_number(rg_inp_set *s, rg_gid number, bool listed, rg_inp_place at) {
    rg_inp_entry *last = s->count > 0 ? &s->entry[s->count - 1] : NULL;
    if (last != NULL && last->name == NULL && last->step == 1 && last->to + 1 == number &&
        last->listed == listed) {
        last->to = number;
        return;
    }
    rg_inp_add_entry(s, (rg_inp_entry){.from = number, .to = number, .step = 1, .listed = listed, .at = at});
}

void rg_inp_add_patch(rg_inp_surface *s, rg_inp_patch patch) {
    s->patch = rg_grow(s->patch, &s->room, s->count, sizeof *s->patch);
    s->patch[s->count++] = patch;
}

/* ---- members ---- */

/* A search: sets and rows that were found are marked with its number. */
typedef struct {
    rg_inp_model *m;
    size_t id;
    rg_inp_of of;
    rg_inp_members found;
    const rg_inp_set **waiting; /* sets that are still to be looked through */
    size_t count, room;
} search;

static const rg_inp_rows *rows_of(const rg_inp_model *m, rg_inp_of of) {
    return of == RG_INP_NODES ? &m->nodes : &m->elements;
}

static search begin_search(rg_inp_model *m, rg_inp_of of) {
    m->search++;
    for (int i = 0; i < 2; i++) {
        size_t count = rows_of(m, (rg_inp_of)i)->count;
        if (m->seen_room[i] < count) {
            rg_free(m->seen[i]);
            m->seen_room[i] = count + count / 2;
            m->seen[i] = RG_NEW(size_t, m->seen_room[i]);
        }
    }
    return (search){.m = m, .id = m->search, .of = of};
}

static void find_row(search *s, size_t row) {
    size_t *seen = s->m->seen[s->of];
    if (seen[row] != s->id) {
        seen[row] = s->id;
        s->found.row = rg_grow(s->found.row, &s->found.room, s->found.count, sizeof *s->found.row);
        s->found.row[s->found.count++] = row;
    }
}

static void find_nodes_of(search *s, size_t element) {
    const rg_inp_model *m = s->m;
    for (int i = 0; i < m->kind[element]; i++) {
        size_t row = rg_inp_row(&m->nodes, m->node[m->start[element] + (size_t)i]);
        if (row != SIZE_MAX) {
            find_row(s, row);
        }
    }
}

/* The rows of a range: number by number, or where that is longer than the list of all, by that. */
static void find_range(search *s, const rg_inp_entry *e) {
    const rg_inp_rows *rows = rows_of(s->m, s->of);
    if ((e->to - e->from) / e->step >= (rg_gid)rows->count && !e->listed) {
        for (size_t row = 0; row < rows->count; row++) {
            rg_gid n = rows->number[row];
            if (n >= e->from && n <= e->to && (n - e->from) % e->step == 0) {
                find_row(s, row);
            }
        }
        return;
    }
    for (rg_gid n = e->from; n <= e->to; n += e->step) {
        size_t row = rg_inp_row(rows, n);
        if (row != SIZE_MAX) {
            find_row(s, row);
        } else if (e->listed) {
            s->found.first = s->found.missing++ == 0 ? n : s->found.first;
        }
    }
}

static void find_entry(search *s, const rg_inp_entry *e) {
    if (e->name == NULL) {
        find_range(s, e);
        return;
    }
    rg_inp_of of = e->corners ? RG_INP_ELEMENTS : s->of;
    rg_inp_set *set = rg_inp_find_set(s->m, of, e->name, e->scope);
    if (set == NULL) {
        rg_inp_refuse(e->at, "no set of %s '%s'", of == RG_INP_NODES ? "nodes" : "elements", e->name);
    }
    if (e->corners) {
        rg_inp_members inner = rg_inp_members_of_set(s->m, set); /* marks elements, and this one nodes */
        for (size_t i = 0; i < inner.count; i++) {
            find_nodes_of(s, inner.row[i]);
        }
        rg_free(inner.row);
    } else if (set->seen != s->id) {
        set->seen = s->id;
        s->waiting = rg_grow(s->waiting, &s->room, s->count, sizeof *s->waiting);
        s->waiting[s->count++] = set;
    }
}

static rg_inp_members end_search(search *s) {
    while (s->count > 0) {
        const rg_inp_set *set = s->waiting[--s->count];
        for (size_t i = 0; i < set->count; i++) {
            find_entry(s, &set->entry[i]);
        }
    }
    rg_free(s->waiting);
    return s->found;
}

typedef struct {
    rg_gid number;
    size_t row;
} numbered;

static int by_number(const void *a, const void *b) {
    rg_gid p = ((const numbered *)a)->number, q = ((const numbered *)b)->number;
    return (p > q) - (p < q);
}

static void sort_members(const rg_inp_model *m, rg_inp_of of, rg_inp_members *found) {
    numbered *list = RG_NEW(numbered, found->count + 1);
    for (size_t i = 0; i < found->count; i++) {
        list[i] = (numbered){rows_of(m, of)->number[found->row[i]], found->row[i]};
    }
    qsort(list, found->count, sizeof *list, by_number);
    for (size_t i = 0; i < found->count; i++) {
        found->row[i] = list[i].row;
    }
    rg_free(list);
}

rg_inp_members rg_inp_members_of_set(rg_inp_model *m, const rg_inp_set *set) {
    search s = begin_search(m, set->of);
    s.waiting = rg_grow(NULL, &s.room, 0, sizeof *s.waiting);
    s.waiting[s.count++] = set;
    rg_inp_members found = end_search(&s);
    if (!set->unsorted) {
        sort_members(m, set->of, &found);
    }
    return found;
}

rg_inp_members rg_inp_members_of_entry(rg_inp_model *m, rg_inp_of of, const rg_inp_entry *e) {
    search s = begin_search(m, of);
    find_entry(&s, e);
    return end_search(&s);
}

/* ---- instances ---- */

/* What is added to numbers up to `own`, so that they are clear of those up to `taken`: 0, or a multiple of a
 * power of ten, which leaves them easy to recognise. */
static rg_gid shift_past(rg_gid taken, rg_gid own) {
    rg_gid unit = 10;
    if (taken == 0) {
        return 0;
    }
    for (; unit <= own || (own == 0 && unit <= taken); unit *= 10) {
    }
    return (taken + unit - 1) / unit * unit;
}

static rg_inp_entry moved_entry(const rg_inp_entry *e, int scope, rg_gid by) {
    rg_inp_entry out = *e;
    out.from += by;
    out.to += by;
    out.scope = scope;
    out.name = e->name != NULL ? rg_inp_copy_text(e->name) : NULL;
    return out;
}

static void copy_names(rg_inp_model *m, const rg_inp_model *part, int scope) {
    const rg_gid by[2] = {
        [RG_INP_NODES] = m->scope[scope].nodes, [RG_INP_ELEMENTS] = m->scope[scope].elements};
    for (size_t i = 0; i < part->sets; i++) {
        rg_inp_set copy = part->set[i];
        copy.scope = scope;
        copy.entry = NULL;
        copy.count = copy.room = copy.seen = 0;
        rg_inp_set *to = new_set(m, copy);
        for (size_t k = 0; k < part->set[i].count; k++) {
            rg_inp_add_entry(to, moved_entry(&part->set[i].entry[k], scope, by[to->of]));
        }
    }
    for (size_t i = 0; i < part->surfaces; i++) {
        const rg_inp_surface *from = &part->surface[i];
        rg_inp_surface *to = rg_inp_need_surface(m, from->name, from->of, scope);
        for (size_t k = 0; k < from->count; k++) {
            const rg_inp_patch *p = &from->patch[k];
            rg_inp_add_patch(to, (rg_inp_patch){moved_entry(&p->of, scope, by[to->of]), p->face});
        }
    }
}

static void copy_mesh(rg_inp_model *m, const rg_inp_model *part, const rg_inp_scope *scope,
                      const rg_frame *frame) {
    for (size_t i = 0; i < part->nodes.count; i++) {
        double x[3];
        memcpy(x, part->x + 3 * i, sizeof x);
        rg_frame_out(frame, x);
        rg_inp_add_node(m, part->nodes.number[i] + scope->nodes, x);
    }
    for (size_t i = 0; i < part->elements.count; i++) {
        rg_gid node[10];
        for (int k = 0; k < part->kind[i]; k++) {
            node[k] = part->node[part->start[i] + (size_t)k] + scope->nodes;
        }
        rg_inp_add_element(m, part->elements.number[i] + scope->elements, part->kind[i], node);
    }
}

int rg_inp_add_instance(rg_inp_model *m, const rg_inp_model *part, const char *name, const rg_frame *frame,
                        rg_inp_place at) {
    rg_inp_scope scope = {.nodes = shift_past(m->nodes.most, part->nodes.most),
                          .elements = shift_past(m->elements.most, part->elements.most)};
    if (scope.nodes + part->nodes.most > RG_INP_MOST || scope.elements + part->elements.most > RG_INP_MOST) {
        rg_inp_refuse(at, "the nodes or elements of *INSTANCE, NAME=%s get numbers beyond %lld", name,
                      (long long)RG_INP_MOST);
    }
    strcpy(scope.name, name);
    m->scope = rg_realloc(m->scope, (size_t)m->scopes + 1, sizeof *m->scope);
    m->scope[m->scopes] = scope;
    copy_mesh(m, part, &scope, frame);
    copy_names(m, part, m->scopes);
    m->moved += part->moved;
    return m->scopes++;
}

/* ---- the whole ---- */

rg_inp_model *rg_inp_model_make(void) {
    rg_inp_model *m = RG_NEW(rg_inp_model, 1);
    m->scope = rg_realloc(NULL, 1, sizeof *m->scope);
    m->scope[m->scopes++] = (rg_inp_scope){.nodes = 0};
    return m;
}

void rg_inp_model_free(rg_inp_model *m) {
    for (size_t i = 0; i < m->sets; i++) {
        for (size_t k = 0; k < m->set[i].count; k++) {
            rg_free(m->set[i].entry[k].name);
        }
        rg_free(m->set[i].entry);
    }
    for (size_t i = 0; i < m->surfaces; i++) {
        for (size_t k = 0; k < m->surface[i].count; k++) {
            rg_free(m->surface[i].patch[k].of.name);
        }
        rg_free(m->surface[i].patch);
    }
    free_rows(&m->nodes);
    free_rows(&m->elements);
    rg_free(m->x);
    rg_free(m->kind);
    rg_free(m->start);
    rg_free(m->node);
    rg_free(m->set);
    rg_free(m->surface);
    rg_free(m->scope);
    rg_free(m->seen[0]);
    rg_free(m->seen[1]);
    rg_free(m);
}
