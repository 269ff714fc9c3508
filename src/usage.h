/* How to call the program: what --help says and what follows a complaint. */
#ifndef RG_USAGE_H
#define RG_USAGE_H

/* Of a command, "run"; of all of them where there is none of that name (or NULL). */
const char *rg_usage(const char *command);

#endif
