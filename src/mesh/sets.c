#include "mesh/sets.h"

#include <string.h>

#include "base/mem.h"

int32_t rg_sets_add(rg_sets *s, const char *name) {
    s->name = rg_realloc(s->name, (size_t)s->count + 1, sizeof *s->name);
    s->name[s->count] = strcpy(RG_NEW(char, strlen(name) + 1), name);
    return s->count++;
}

int32_t rg_sets_find(const rg_sets *s, const char *name) {
    for (int32_t i = 0; i < s->count; i++) {
        if (strcmp(s->name[i], name) == 0) {
            return i;
        }
    }
    return -1;
}

const int32_t *rg_sets_of(const rg_sets *s, const int32_t *group, int32_t *count) {
    if (*group < s->count) {
        *count = *group >= 0;
        return group;
    }
    const int32_t *start = s->start + (*group - s->count);
    *count = start[1] - start[0];
    return s->member + start[0];
}

bool rg_sets_hold(const rg_sets *s, int32_t group, int32_t set) {
    int32_t count;
    const int32_t *member = rg_sets_of(s, &group, &count);
    for (int32_t i = 0; i < count; i++) {
        if (member[i] == set) {
            return true;
        }
    }
    return false;
}

bool *rg_sets_groups_in(const rg_sets *s, int32_t set) {
    bool *in = RG_NEW(bool, (size_t)rg_sets_groups(s) + 1);
    for (int32_t g = 0; g < rg_sets_groups(s); g++) {
        in[g] = rg_sets_hold(s, g, set);
    }
    return in;
}

int32_t rg_sets_combine(rg_sets *s, int32_t count, const int32_t *set) {
    int32_t at = s->combinations > 0 ? s->start[s->combinations] : 0;
    s->start = rg_realloc(s->start, (size_t)s->combinations + 2, sizeof *s->start);
    s->member = rg_realloc(s->member, (size_t)(at + count), sizeof *s->member);
    memcpy(s->member + at, set, (size_t)count * sizeof *set);
    s->start[s->combinations] = at;
    s->start[s->combinations + 1] = at + count;
    return s->count + s->combinations++;
}

rg_sets rg_sets_copy(const rg_sets *s) {
    rg_sets copy = {.count = 0};
    for (int32_t i = 0; i < s->count; i++) {
        rg_sets_add(&copy, s->name[i]);
    }
    for (int32_t c = 0; c < s->combinations; c++) {
        rg_sets_combine(&copy, s->start[c + 1] - s->start[c], s->member + s->start[c]);
    }
    return copy;
}

void rg_sets_free(rg_sets *s) {
    for (int32_t i = 0; i < s->count; i++) {
        rg_free(s->name[i]);
    }
    rg_free(s->name);
    rg_free(s->start);
    rg_free(s->member);
    *s = (rg_sets){.count = 0};
}

/* ---- joining ---- */

static void make_room(rg_sets_joining *j) {
    size_t groups = (size_t)rg_sets_groups(j->sets);
    if (groups >= j->rows) {
        size_t rows = groups + groups / 2 + 16;
        j->next = rg_realloc(j->next, rows, sizeof *j->next);
        j->child = rg_realloc(j->child, rows, sizeof *j->child);
        for (; j->rows < rows; j->rows++) {
            j->next[j->rows] = j->child[j->rows] = -1;
        }
    }
}

/* The members of `group` with `set` among them, ascending; the caller frees them. */
static int32_t *insert(const rg_sets *s, int32_t group, int32_t set, int32_t *count) {
    const int32_t *member = rg_sets_of(s, &group, count);
    int32_t *all = RG_NEW(int32_t, (size_t)*count + 1), at = 0;
    for (; at < *count && member[at] < set; at++) {
        all[at] = member[at];
    }
    all[at] = set;
    memcpy(all + at + 1, member + at, (size_t)(*count - at) * sizeof *all);
    ++*count;
    return all;
}

/* The group of `group` and `set` together, a new one if need be. */
static int32_t find_joined(rg_sets_joining *j, int32_t group, int32_t set) {
    int32_t count, members;
    int32_t *all = insert(j->sets, group, set, &count);
    make_room(j);
    int32_t found = j->child[group];
    for (; found >= 0; found = j->next[found]) {
        const int32_t *member = rg_sets_of(j->sets, &found, &members);
        if (members == count && memcmp(member, all, (size_t)count * sizeof *all) == 0) {
            break;
        }
    }
    if (found < 0) {
        found = rg_sets_combine(j->sets, count, all);
        j->next[found] = j->child[group];
        j->child[group] = found;
    }
    rg_free(all);
    return found;
}

int32_t rg_sets_join(rg_sets_joining *j, int32_t group, int32_t set) {
    if (group < 0 || rg_sets_hold(j->sets, group, set)) {
        return group < 0 ? set : group;
    }
    if (j->rows == 0 || j->group != group || j->set != set) {
        j->joined = find_joined(j, group, set);
        j->group = group;
        j->set = set;
    }
    return j->joined;
}

void rg_sets_joined(rg_sets_joining *j) {
    rg_free(j->next);
    rg_free(j->child);
    *j = (rg_sets_joining){.sets = NULL};
}
