/* Named sets of elements or faces, which may overlap. What is in them carries one number, its group: -1, in
 * no set; s below the number of sets, in set s alone; beyond that, in the sets of a combination. */
#ifndef RG_SETS_H
#define RG_SETS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct {
    int32_t count;
    char **name; /* [count] */
    int32_t combinations;
    int32_t *start;  /* [combinations + 1]: where combination c, group count + c, begins in: */
    int32_t *member; /* sets, ascending, two at least */
} rg_sets;

/* Adds a set, while there are no combinations yet; its number. */
int32_t rg_sets_add(rg_sets *s, const char *name);

/* Number of the set of that name, -1 if there is none. */
int32_t rg_sets_find(const rg_sets *s, const char *name);

/* Number of groups: those in use are below it. */
static inline int32_t rg_sets_groups(const rg_sets *s) {
    return s->count + s->combinations;
}

/* The sets of *group, ascending, and how many they are. */
const int32_t *rg_sets_of(const rg_sets *s, const int32_t *group, int32_t *count);

/* Whether what is of that group is in the set. */
bool rg_sets_hold(const rg_sets *s, int32_t group, int32_t set);

/* Which groups are in the set: [groups], which the caller frees. */
bool *rg_sets_groups_in(const rg_sets *s, int32_t set);

/* Adds a combination of `count` sets; its group. */
int32_t rg_sets_combine(rg_sets *s, int32_t count, const int32_t *set);

rg_sets rg_sets_copy(const rg_sets *s);
void rg_sets_free(rg_sets *s);

/* Puts things into sets one after the other, once all sets are there: group = rg_sets_join(&join, group,
 * set). A set again changes nothing. Things that come to the same sets in the same order get the same group.
 */
typedef struct {
    rg_sets *sets;
    int32_t group, set, joined; /* the last */
    int32_t *next,
        *child; /* [groups]: those made by joining a set to a group, as a list that begins at child */
    size_t rows;
} rg_sets_joining;

int32_t rg_sets_join(rg_sets_joining *j, int32_t group, int32_t set);
void rg_sets_joined(rg_sets_joining *j);

#endif
