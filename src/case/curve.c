#include "case/curve.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "case/expr.h"
#include "case/tree.h"

enum { LONGEST = 256 }; /* bytes of a line of numbers */

void rg_curve_add(rg_curve *c, size_t *room, double argument, double value) {
    c->point = rg_grow(c->point, room, c->points + 1, sizeof *c->point);
    c->point[c->points][0] = argument;
    c->point[c->points++][1] = value;
}

/* ---- values ---- */

/* Slope between point k and the next. */
static double secant(const rg_curve *c, size_t k) {
    return (c->point[k + 1][1] - c->point[k][1]) / (c->point[k + 1][0] - c->point[k][0]);
}

void rg_curve_smooth(rg_curve *c) {
    c->slope = RG_NEW(double, c->points);
    for (size_t k = 1; k + 1 < c->points; k++) {
        double before = secant(c, k - 1), after = secant(c, k);
        double left = c->point[k][0] - c->point[k - 1][0], right = c->point[k + 1][0] - c->point[k][0];
        if (before * after > 0) { /* a harmonic mean, nearer to the slope of the shorter side */
            double w = 2 * right + left, v = right + 2 * left;
            c->slope[k] = (w + v) / (w / before + v / after);
        }
    }
}

double rg_curve_value(const rg_curve *c, double argument) {
    size_t low = 0, high = c->points - 1;
    if (!(argument > c->point[low][0])) {
        return isnan(argument) ? argument : c->point[low][1];
    }
    if (argument >= c->point[high][0]) {
        return c->point[high][1];
    }
    while (high - low > 1) {
        size_t middle = low + (high - low) / 2;
        *(argument < c->point[middle][0] ? &high : &low) = middle;
    }
    double h = c->point[high][0] - c->point[low][0], s = (argument - c->point[low][0]) / h;
    double from = c->point[low][1], to = c->point[high][1];
    if (c->slope == NULL) {
        return from + s * (to - from);
    }
    double r = 1 - s; /* Hermite's cubics */
    return (1 + 2 * s) * r * r * from + s * s * (3 - 2 * s) * to +
           h * s * r * (r * c->slope[low] - s * c->slope[high]);
}

/* ---- CSV ---- */

static bool separates(char c) {
    return c == ',' || c == ';' || isspace((unsigned char)c);
}

/* Passes over blanks and at most one comma or semicolon. */
static char *next_value(char *at) {
    bool passed = false;
    while (separates(*at) && !(passed && !isspace((unsigned char)*at))) {
        passed = passed || !isspace((unsigned char)*at);
        at++;
    }
    return at;
}

static char *number_in(char *at, char **end, double *value, size_t line) {
    bool integer = false;
    *end = at;
    while (**end != '\0' && !separates(**end)) {
        (*end)++;
    }
    char *word = rg_text_copy(at, (size_t)(*end - at)), *wrong = NULL;
    *value = rg_is_number(word, &integer) ? strtod(word, NULL) : NAN;
    if (!isfinite(*value)) {
        wrong = rg_text_format("line %zu: '%s' is not a finite number", line, word);
    }
    rg_free(word);
    return wrong;
}

/* The two numbers of a line. */
static char *parse_line(char *text, double value[2], size_t line) {
    char *end = text;
    for (int k = 0; k < 2; k++) {
        char *at = next_value(end), *wrong = NULL;
        wrong = *at == '\0' ? rg_text_format("line %zu: %d numbers where two are needed", line, k)
                            : number_in(at, &end, &value[k], line);
        if (wrong != NULL) {
            return wrong;
        }
    }
    return *next_value(end) == '\0' ? NULL : rg_text_format("line %zu: more than two numbers", line);
}

static bool is_heading(const char *text) {
    return isalpha((unsigned char)text[0]) || text[0] == '"';
}

char *rg_curve_parse(rg_curve *c, const char *text, size_t size) {
    static const char mark[] = "\xef\xbb\xbf"; /* of UTF-8, which some spreadsheets write */
    size_t room = 0, line = 1;
    const char *at = size >= 3 && memcmp(text, mark, 3) == 0 ? text + 3 : text, *end = text + size;
    bool headed = false;
    for (; at < end; line++) {
        const char *stop = memchr(at, '\n', (size_t)(end - at));
        size_t length = (size_t)((stop == NULL ? end : stop) - at);
        char row[LONGEST], *wrong = NULL;
        if (length >= sizeof row || memchr(at, '\0', length) != NULL) {
            return rg_text_format("line %zu: not two numbers", line);
        }
        memcpy(row, at, length);
        row[length] = '\0';
        char *first = row + strspn(row, " \t\r");
        at += length + 1;
        if (*first == '\0' || *first == '#') {
            continue;
        }
        if (!headed && c->points == 0 && is_heading(first)) {
            headed = true;
            continue;
        }
        double value[2];
        wrong = parse_line(first, value, line);
        if (wrong == NULL && c->points > 0 && !(value[0] > c->point[c->points - 1][0])) {
            wrong = rg_text_format("line %zu: %g is not above the argument before, %g", line, value[0],
                                   c->point[c->points - 1][0]);
        }
        if (wrong != NULL) {
            return wrong;
        }
        rg_curve_add(c, &room, value[0], value[1]);
    }
    return c->points < 2 ? rg_text_format("fewer than two points") : NULL;
}

void rg_curves_free(rg_curves *all) {
    for (int i = 0; i < all->count; i++) {
        rg_free(all->curve[i].name);
        rg_free(all->curve[i].point);
        rg_free(all->curve[i].slope);
    }
    rg_free(all->curve);
    *all = (rg_curves){0};
}
