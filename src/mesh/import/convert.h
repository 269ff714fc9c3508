/* Formats that another program turns into Abaqus input: rhegma-convert, in the folder of this one. */
#ifndef RG_CONVERT_H
#define RG_CONVERT_H

#include <stdbool.h>
#include <stdio.h>

/* Whether it is one of these, by its ending: MED and CGNS. */
bool rg_is_converted(const char *path);

/* Abaqus input of the file, from its beginning; the reader closes it. Ends the run with a message (RG_USAGE)
 * where the program is not there or ends with another status than 0. */
FILE *rg_converted(const char *path);

#endif
