/* Functions of one variable that a case gives by their points, `tables`: straight lines or a monotone cubic
 * between the points, constant beyond the first and the last. */
#ifndef RG_CASE_CURVE_H
#define RG_CASE_CURVE_H

#include <stdbool.h>
#include <stddef.h>

typedef struct {
    char *name; /* by which expressions call it */
    size_t points;
    double (*point)[2]; /* argument, ascending, and value */
    double *slope;      /* at the points, of a smooth one; NULL: straight lines */
} rg_curve;

typedef struct {
    int count;
    rg_curve *curve;
} rg_curves;

/* Appends a point. */
void rg_curve_add(rg_curve *c, size_t *room, double argument, double value);

/* Makes a curve of two points or more smooth: the cubic through them that is monotone wherever they are
 * (Fritsch & Butland 1984), with slope 0 at both ends, so that it is smooth beyond them too. */
void rg_curve_smooth(rg_curve *c);

/* Its value at an argument; not a number of one. */
double rg_curve_value(const rg_curve *c, double argument);

/* Reads the points of a curve from the text of a CSV file: two numbers a line, between them a comma, a
 * semicolon or blanks; one heading, empty lines and lines that begin with # are passed over. Returns what is
 * wrong in words, with the line; NULL: nothing. Free with rg_free. */
char *rg_curve_parse(rg_curve *c, const char *text, size_t size);

void rg_curves_free(rg_curves *all);

#endif
