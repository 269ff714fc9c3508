#include "mesh/import/inp_generate.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

#include "base/mem.h"

/* ---- helpers ---- */

static size_t need_row(const rg_inp_lines *l, const rg_inp_rows *rows, rg_gid number, const char *what) {
    size_t row = rg_inp_row(rows, number);
    if (row == SIZE_MAX) {
        rg_inp_refuse(l->at, "there is no %s %" PRId64 " so far", what, number);
    }
    return row;
}

/* Counts what is generated, before it is. */
static void count(const rg_inp_lines *l, rg_inp_model *m, rg_gid more) {
    m->generated += more;
    if (m->generated > RG_INP_GENERATED) {
        rg_inp_refuse(l->at, "more than %d nodes and elements to be generated", RG_INP_GENERATED);
    }
}

static void collect(const rg_inp_lines *l, rg_inp_model *m, rg_inp_of of, int scope, const char *set,
                    rg_gid number) {
    if (set != NULL) {
        rg_inp_add_number(rg_inp_need_set(m, of, set, scope, l->at), number, false, l->at);
    }
}

static rg_gid within(const rg_inp_lines *l, rg_gid number) {
    if (number > RG_INP_MOST) {
        rg_inp_refuse(l->at, "a number beyond %" PRId64 " is generated", RG_INP_MOST);
    }
    return number;
}

/* ---- nodes ---- */

/* A line of nodes to be: as many intervals, each `bias` times as long as the next one; numbers in steps. */
typedef struct {
    rg_gid intervals, step;
    double bias;
} spread;

/* How much of the whole length the first i intervals are. */
static double part_of(const spread *s, rg_gid i) {
    double ratio = 1 / s->bias, n = (double)s->intervals;
    return s->bias == 1 ? (double)i / n : (pow(ratio, (double)i) - 1) / (pow(ratio, n) - 1);
}

/* Nodes between rows a and b: numbers from that of a on, which would reach b's place after all intervals. */
static void fill(const rg_inp_lines *l, rg_inp_model *m, size_t a, size_t b, const spread *s, int scope,
                 const char *set) {
    rg_gid from = m->nodes.number[a], end = m->nodes.number[b];
    count(l, m, s->intervals - 1);
    collect(l, m, RG_INP_NODES, scope, set, from);
    for (rg_gid i = 1; i < s->intervals; i++) {
        double x[3], part = part_of(s, i);
        for (size_t k = 0; k < 3; k++) {
            x[k] = m->x[3 * a + k] + part * (m->x[3 * b + k] - m->x[3 * a + k]);
        }
        rg_gid number = within(l, from + i * s->step);
        rg_inp_add_node(m, number, x);
        collect(l, m, RG_INP_NODES, scope, set, number);
    }
    collect(l, m, RG_INP_NODES, scope, set, end);
}

void rg_inp_ngen(rg_inp_lines *l, rg_inp_model *m, int scope, const char *set) {
    rg_gid shift = m->scope[scope].nodes, from = rg_inp_integer(l, 0), to = rg_inp_integer(l, 0);
    rg_gid step = rg_inp_integer(l, 1);
    if (from == to || (to - from) % step != 0) {
        rg_inp_refuse(l->at, "*NGEN: steps of %" PRId64 " do not lead from node %" PRId64 " to %" PRId64,
                      step, from, to);
    }
    size_t a = need_row(l, &m->nodes, from + shift, "node"), b = need_row(l, &m->nodes, to + shift, "node");
    rg_gid intervals = (to > from ? to - from : from - to) / step;
    fill(l, m, a, b, &(spread){intervals, to > from ? step : -step, 1}, scope, set);
}

/* Nodes of a set, which must be there. */
static rg_inp_members bounding_set(rg_inp_lines *l, rg_inp_model *m, int scope) {
    const char *name = rg_inp_field(l);
    rg_inp_set *set = name != NULL ? rg_inp_find_set(m, RG_INP_NODES, name, scope) : NULL;
    if (set == NULL) {
        rg_inp_refuse(l->at, "*NFILL: no set of nodes '%s' so far", name != NULL ? name : "");
    }
    return rg_inp_members_of_set(m, set);
}

static double read_bias(const rg_inp_lines *l) {
    const char *text = rg_inp_parameter(l, "BIAS");
    char *end = NULL;
    double bias = text != NULL ? strtod(text, &end) : 1;
    if (text != NULL && (end == text || *end != '\0' || !(bias > 0) || !isfinite(bias))) {
        rg_inp_refuse(l->at, "*NFILL, BIAS=%s: a number > 0 is expected", text);
    }
    return bias;
}

void rg_inp_nfill(rg_inp_lines *l, rg_inp_model *m, int scope, const char *set) {
    rg_inp_members a = bounding_set(l, m, scope), b = bounding_set(l, m, scope);
    spread s = {.bias = read_bias(l)};
    s.intervals = rg_inp_integer(l, 0);
    s.step = rg_inp_integer(l, 0);
    if (a.count != b.count) {
        rg_inp_refuse(l->at, "*NFILL: the two sets have %zu and %zu nodes", a.count, b.count);
    }
    for (size_t i = 0; i < a.count; i++) {
        fill(l, m, a.row[i], b.row[i], &s, scope, set);
    }
    rg_free(a.row);
    rg_free(b.row);
}

/* ---- elements ---- */

/* A copy of the element in `row`, with other numbers. */
static void copy_element(const rg_inp_lines *l, rg_inp_model *m, size_t row, rg_gid by, rg_gid nodes_by,
                         int scope, const char *set) {
    rg_gid node[10], number = within(l, m->elements.number[row] + by);
    for (int k = 0; k < m->kind[row]; k++) {
        node[k] = within(l, m->node[m->start[row] + (size_t)k] + nodes_by);
    }
    if (!rg_inp_add_element(m, number, m->kind[row], node)) {
        rg_inp_refuse(l->at, "element %" PRId64 " is defined twice", number);
    }
    collect(l, m, RG_INP_ELEMENTS, scope, set, number);
}

void rg_inp_elgen(rg_inp_lines *l, rg_inp_model *m, int scope, const char *set) {
    rg_gid master = rg_inp_integer(l, 0) + m->scope[scope].elements;
    rg_gid many[3], nodes_by[3], by[3]; /* elements in a row, rows in a layer, layers */
    size_t row = need_row(l, &m->elements, master, "element");
    rg_gid all = 1;
    for (int i = 0; i < 3; i++) {
        many[i] = rg_inp_integer(l, i == 0 ? 0 : 1);
        nodes_by[i] = rg_inp_integer(l, i == 0 || many[i] == 1 ? 1 : 0);
        by[i] = rg_inp_integer(l, i == 0 || many[i] == 1 ? 1 : 0);
        count(l, m, all * (many[i] - 1)); /* before `all` grows beyond all bounds */
        all *= many[i];
    }
    collect(l, m, RG_INP_ELEMENTS, scope, set, master);
    for (rg_gid n = 1; n < all; n++) {
        rg_gid at[3] = {n % many[0], n / many[0] % many[1], n / many[0] / many[1]};
        rg_gid far = at[0] * by[0] + at[1] * by[1] + at[2] * by[2];
        rg_gid nodes_far = at[0] * nodes_by[0] + at[1] * nodes_by[1] + at[2] * nodes_by[2];
        copy_element(l, m, row, far, nodes_far, scope, set);
    }
}

static rg_gid shift_of(const rg_inp_lines *l, const char *parameter) {
    const char *value = rg_inp_parameter(l, parameter);
    if (value == NULL) {
        rg_inp_refuse(l->at, "*ELCOPY without %s", parameter);
    }
    return rg_inp_number(l, value);
}

void rg_inp_elcopy(rg_inp_lines *l, rg_inp_model *m, int scope, const char *set) {
    rg_gid by = shift_of(l, "ELEMENTSHIFT"), nodes_by = shift_of(l, "SHIFTNODES");
    const char *name = rg_inp_name(l, "OLDSET");
    rg_inp_set *old = rg_inp_find_set(m, RG_INP_ELEMENTS, name, scope);
    if (old == NULL) {
        rg_inp_refuse(l->at, "*ELCOPY: no set of elements '%s' so far", name);
    }
    rg_inp_members members = rg_inp_members_of_set(m, old);
    count(l, m, (rg_gid)members.count);
    for (size_t i = 0; i < members.count; i++) {
        copy_element(l, m, members.row[i], by, nodes_by, scope, set);
    }
    rg_free(members.row);
}
