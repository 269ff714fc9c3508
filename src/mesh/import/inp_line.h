/* Lines of Abaqus and CalculiX input, as their manuals define them: keyword lines, which begin with a star
 * and go on in the next line where they end with a comma, and data lines of fields between commas; through
 * all files that are included. Case and blanks do not count outside of quotation marks. */
#ifndef RG_INP_LINE_H
#define RG_INP_LINE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "mesh/mesh.h"

enum { RG_INP_WORD = 64, RG_INP_PARAMETERS = 24 };

/* Where something stands, for messages. */
typedef struct {
    const char *path;
    long line;
} rg_inp_place;

typedef struct rg_inp_file rg_inp_file;

typedef struct {
    rg_inp_place at;           /* of the line */
    char keyword[RG_INP_WORD]; /* the last one: capitals, without star and blanks */
    char *text, *rest;         /* of the line, and of it the fields that nobody took yet */
    size_t parameters;
    struct {
        char name[RG_INP_WORD]; /* capitals, without blanks */
        char *value;            /* NULL: none */
    } parameter[RG_INP_PARAMETERS];
    rg_inp_file *file; /* the innermost that is open */
    int depth;
    char **path; /* of all files that were opened: places point to them */
    size_t paths, text_room;
} rg_inp_lines;

typedef enum { RG_INP_END, RG_INP_KEYWORD, RG_INP_DATA } rg_inp_kind;

/* Begins with `stream`, which it closes, or with the file at `path` (NULL), of which it ends the run if that
 * cannot be read; messages call it `path`. */
rg_inp_lines *rg_inp_open(const char *path, FILE *stream);

/* The next keyword line or data line that is not blank. *INCLUDE is followed, from the folder of the file
 * that has it; to its caller it is not there. */
rg_inp_kind rg_inp_next(rg_inp_lines *l);

/* Where the keyword line has the parameter INPUT: goes on with the file that it names. */
void rg_inp_follow(rg_inp_lines *l);

/* The only parameters that the keyword may have, a list between blanks, in capitals and without blanks of
 * their own. An abbreviation that fits one of them is taken for it; others end the run. */
void rg_inp_allow(rg_inp_lines *l, const char *names);

/* Value of a parameter; "" if it has none, NULL if it is not there. */
const char *rg_inp_parameter(const rg_inp_lines *l, const char *name);

/* The same, which must be there and may be the name of a set: not empty, at most 63 bytes. */
const char *rg_inp_name(const rg_inp_lines *l, const char *parameter);

/* The next field of a data line, without the blanks around it; NULL at the end. */
char *rg_inp_field(rg_inp_lines *l);

/* The next field as a number of a node or element, or a count; `otherwise` where there is none (0: there must
 * be one). */
rg_gid rg_inp_integer(rg_inp_lines *l, rg_gid otherwise);

/* A field that is such a number: from 1 to RG_INP_MOST. */
rg_gid rg_inp_number(const rg_inp_lines *l, const char *field);

/* Whether it looks like one. */
bool rg_inp_is_number(const char *field);

/* The next field as a coordinate or angle, 0 where there is none; exponents may be Fortran's (1.5D-3). */
double rg_inp_value(rg_inp_lines *l);

/* Ends the run: "path:line: " and the message. */
_Noreturn void rg_inp_refuse(rg_inp_place at, const char *format, ...) __attribute__((format(printf, 2, 3)));

void rg_inp_close(rg_inp_lines *l);

#define RG_INP_MOST INT64_C(4000000000) /* the largest number of a node or element */

#endif
