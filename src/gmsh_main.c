/* rhegma-mesh: mesh files from what Gmsh reads. A program of its own, so that no run carries Gmsh along. */
#include <stdio.h>
#include <string.h>

#include "base/error.h"
#include "base/mem.h"
#include "mesh/import/gmsh_read.h"
#include "mesh_command.h"
#include "revision.h"
#include "version.h"

int main(int argc, char **argv) {
    if (argc == 2 && strcmp(argv[1], "--version") == 0) {
        printf("rhegma-mesh %s (%s)\n", RG_VERSION, RG_REVISION);
        return RG_OK;
    }
    rg_mesh_arguments a = rg_mesh_arguments_read(argc, argv, 1);
    if (a.info || a.partition != NULL) {
        rg_fatal(RG_USAGE, "mesh: --info and --partition are a matter of rhegma mesh");
    }
    rg_mesh *mesh = rg_gmsh_read(a.input, a.scale);
    rg_mesh_finish(mesh, &a);
    rg_mesh_free(mesh);
    rg_free(a.override);
    return RG_OK;
}
