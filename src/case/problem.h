/* Problems found in a case file: collected, so that all of them can be shown at once in the order of the
 * file. */
#ifndef RG_CASE_PROBLEM_H
#define RG_CASE_PROBLEM_H

#include <stdio.h>

/* Where something stands: line and column of the case file, from 1 (line 0: the file as a whole), or the
 * override "a.b=value" it came with. */
typedef struct {
    int line, column;
    const char *set; /* NULL: in the file */
} rg_place;

/* What a problem is about. Any member may be NULL. */
typedef struct {
    const char *key;     /* dotted path */
    const char *value;   /* as written */
    const char *allowed; /* range */
    const char *nearest; /* known key or value that was probably meant */
} rg_subject;

typedef struct {
    rg_place at;
    int number; /* order of discovery */
    char *text;
} rg_problem;

typedef struct {
    const char *file;
    int count;
    rg_problem *problem;
} rg_problems;

/* Adds "place: key: value: what; allowed: range; did you mean 'nearest'?". */
void rg_problem_add(rg_problems *all, rg_place at, const rg_subject *subject, const char *what, ...)
    __attribute__((format(printf, 4, 5)));

/* Prints the problems, one a line, in the order of the file, those of overrides last, and forgets them. */
void rg_problems_flush(rg_problems *all, FILE *out);

/* Longer than any key or value that could be meant: comparing them would take long, a megabyte forever. */
enum { RG_LONGEST_WORD = 128 };

/* Edits (insertions, deletions, replacements; letter case is ignored) that turn a[0..m) into b[0..n);
 * n <= RG_LONGEST_WORD. */
size_t rg_edit_distance(const char *a, size_t m, const char *b, size_t n);

/* The entry of the NULL-terminated `list`, words as short, closest to `word`, or NULL if none is close. */
const char *rg_nearest(const char *word, const char *const list[]);

/* What may stand instead of `word`: "a, b, c; did you mean 'b'?", or "none"; of a list that is too long for
 * `text` the end is missing. Returns `text`. */
const char *rg_choices(const char *word, const char *const list[], char *text, size_t size);

#endif
