#include "case/problem.h"

#include <ctype.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/mem.h"

static void print_place(FILE *out, const char *file, rg_place at) {
    if (at.set != NULL) {
        fprintf(out, "--set %s: ", at.set);
    } else if (at.line == 0) {
        fprintf(out, "%s: ", file);
    } else {
        fprintf(out, "%s:%d:%d: ", file, at.line, at.column);
    }
}

/* One problem is one line, whatever control characters the input holds. */
static void flatten(char *text) {
    for (; *text != '\0'; text++) {
        if (iscntrl((unsigned char)*text)) {
            *text = ' ';
        }
    }
}

static void print_subject(FILE *out, const rg_subject *s, const char *what, va_list args) {
    if (s->key != NULL && s->key[0] != '\0') {
        fprintf(out, "%s: ", s->key);
    }
    if (s->value != NULL) {
        fprintf(out, "%s: ", s->value);
    }
    vfprintf(out, what, args);
    if (s->allowed != NULL) {
        fprintf(out, "; allowed: %s", s->allowed);
    }
    if (s->nearest != NULL) {
        fprintf(out, "; did you mean '%s'?", s->nearest);
    }
}

void rg_problem_add(rg_problems *all, rg_place at, const rg_subject *subject, const char *what, ...) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (out == NULL) {
        rg_fatal(RG_FAILURE, "out of memory");
    }
    print_place(out, all->file, at);
    va_list args;
    va_start(args, what);
    print_subject(out, subject, what, args);
    va_end(args);
    if (fclose(out) != 0) {
        rg_fatal(RG_FAILURE, "out of memory");
    }
    flatten(text);
    all->problem = rg_realloc(all->problem, (size_t)all->count + 1, sizeof *all->problem);
    all->problem[all->count] = (rg_problem){.at = at, .number = all->count, .text = text};
    all->count++;
}

/* By place in the file, then in the order of discovery; overrides come last. */
static int compare(const void *left, const void *right) {
    const rg_problem *a = left, *b = right;
    int order[] = {(a->at.set != NULL) - (b->at.set != NULL), a->at.line - b->at.line,
                   a->at.column - b->at.column, a->number - b->number};
    int i = 0;
    while (order[i] == 0 && i < 3) {
        i++;
    }
    return order[i];
}

void rg_problems_flush(rg_problems *all, FILE *out) {
    if (all->count > 0) {
        qsort(all->problem, (size_t)all->count, sizeof *all->problem, compare);
    }
    for (int i = 0; i < all->count; i++) {
        fprintf(out, "%s\n", all->problem[i].text);
        free(all->problem[i].text);
    }
    rg_free(all->problem);
    all->problem = NULL;
    all->count = 0;
}

static size_t least(size_t a, size_t b, size_t c) {
    size_t ab = a < b ? a : b;
    return ab < c ? ab : c;
}

size_t rg_edit_distance(const char *a, size_t m, const char *b, size_t n) {
    size_t row[RG_LONGEST_WORD + 1];
    for (size_t j = 0; j <= n; j++) {
        row[j] = j;
    }
    for (size_t i = 1; i <= m; i++) {
        size_t corner = row[0];
        row[0] = i;
        for (size_t j = 1; j <= n; j++) {
            size_t above = row[j];
            int same = tolower((unsigned char)a[i - 1]) == tolower((unsigned char)b[j - 1]);
            row[j] = least(corner + (same ? 0 : 1), above + 1, row[j - 1] + 1);
            corner = above;
        }
    }
    return row[n];
}

const char *rg_nearest(const char *word, const char *const list[]) {
    const char *best = NULL;
    size_t limit = strlen(word) / 3 + 1;
    if (strlen(word) > RG_LONGEST_WORD) {
        return NULL;
    }
    for (int i = 0; list[i] != NULL; i++) {
        size_t length = strlen(word) > strlen(list[i]) ? strlen(word) : strlen(list[i]);
        size_t distance = rg_edit_distance(word, strlen(word), list[i], strlen(list[i]));
        bool near = distance < limit || (distance == limit && best == NULL);
        if (near && distance < length) {
            best = list[i];
            limit = distance;
        }
    }
    return best;
}

const char *rg_choices(const char *word, const char *const list[], char *text, size_t size) {
    const char *near = rg_nearest(word, list);
    char question[RG_LONGEST_WORD + 32] = "";
    if (near != NULL) {
        snprintf(question, sizeof question, "; did you mean '%s'?", near);
    }
    size_t room = size - strlen(question), used = 0;
    snprintf(text, room, "none");
    for (int i = 0; list[i] != NULL && used < room; i++) {
        used += (size_t)snprintf(text + used, room - used, "%s%s", i > 0 ? ", " : "", list[i]);
    }
    strcat(text, question);
    return text;
}
