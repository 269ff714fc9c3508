#include "mesh/import/convert.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.h"
#include "base/files.h"

enum { CANNOT_START = 127 };

bool rg_is_converted(const char *path) {
    const char *end = strrchr(path, '.');
    return end != NULL && (strcmp(end, ".med") == 0 || strcmp(end, ".cgns") == 0);
}

/* In the child: never returns. */
static _Noreturn void start(const char *program, const char *path, FILE *out) {
    char *arguments[] = {strdup(program), strdup(path), NULL};
    if (dup2(fileno(out), STDOUT_FILENO) >= 0) {
        execv(program, arguments);
    }
    rg_warn("%s: %s", program, strerror(errno));
    _exit(CANNOT_START);
}

FILE *rg_converted(const char *path) {
    FILE *there = rg_open_input(path), *out = tmpfile();
    if (there == NULL) {
        rg_fatal(RG_USAGE, "%s: cannot be read: %s", path, strerror(errno));
    }
    fclose(there);
    fflush(NULL); /* or the child has a copy of it */
    pid_t child = out != NULL ? fork() : -1;
    if (child < 0) {
        rg_fatal(RG_FAILURE, "%s: cannot be converted: %s", path, strerror(errno));
    }
    if (child == 0) {
        start(rg_path_beside_program("rhegma-convert"), path, out);
    }
    int status;
    while (waitpid(child, &status, 0) < 0) {
        if (errno != EINTR) {
            rg_fatal(RG_FAILURE, "%s: cannot be converted: %s", path, strerror(errno));
        }
    }
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
        rg_fatal(RG_USAGE, "%s: %s", path,
                 WIFSIGNALED(status)                   ? strsignal(WTERMSIG(status))
                 : WEXITSTATUS(status) == CANNOT_START ? "the program that reads it cannot be started"
                                                       : "it cannot be read");
    }
    rewind(out);
    return out;
}
