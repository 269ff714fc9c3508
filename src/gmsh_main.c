/* rhegma-mesh: mesh files from what Gmsh reads. A program of its own, so that no run carries Gmsh along; and
 * Gmsh in a process of its own, which some files end. */
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.h"
#include "base/mem.h"
#include "mesh/import/gmsh_read.h"
#include "mesh_command.h"
#include "revision.h"
#include "version.h"

static int convert(const rg_mesh_arguments *a) {
    rg_mesh *mesh = rg_gmsh_read(a->input, &a->how, &(rg_gmsh_size){a->size, a->curvature});
    rg_mesh_finish(mesh, a);
    rg_mesh_free(mesh);
    return RG_OK;
}

/* The exit status of the process; a message if a signal ended it: a fault of a library. */
static int wait_for(pid_t child, const char *input) {
    int status;
    while (waitpid(child, &status, 0) < 0) {
        if (errno != EINTR) {
            rg_fatal(RG_FAILURE, "mesh: %s", strerror(errno));
        }
    }
    if (WIFSIGNALED(status)) {
        rg_fatal(RG_USAGE,
                 "%s: Gmsh broke down on it (%s): the file is damaged, or more than this Gmsh can do", input,
                 strsignal(WTERMSIG(status)));
    }
    return WEXITSTATUS(status);
}

int main(int argc, char **argv) {
    if (argc == 2 && strcmp(argv[1], "--version") == 0) {
        printf("rhegma-mesh %s (%s)\n", RG_VERSION, RG_REVISION);
        return RG_OK;
    }
    rg_mesh_arguments a = rg_mesh_arguments_read(argc, argv, 1);
    if (a.info || a.partition != NULL) {
        rg_fatal(RG_USAGE, "mesh: --info and --partition are a matter of rhegma mesh");
    }
    pid_t child = fork();
    if (child < 0) {
        rg_fatal(RG_FAILURE, "mesh: %s", strerror(errno));
    }
    if (child == 0) {
        prctl(PR_SET_PDEATHSIG, SIGKILL); /* it ends with this one */
    }
    int result = child == 0 ? convert(&a) : wait_for(child, a.input);
    rg_expr_free(a.size);
    rg_free(a.override);
    return result;
}
