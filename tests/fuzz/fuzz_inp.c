/* Meshes from Abaqus input: any bytes as the file; then all that `rhegma mesh` does but writing. */
#include <stdio.h>

#include "host.h"
#include "mesh/check.h"
#include "mesh/import/inp_read.h"
#include "mesh/info.h"

static void body(const uint8_t *data, size_t size) {
    const char *path = rg_fuzz_scratch();
    FILE *f = fopen(path, "wb");
    rg_fuzz_require(f != NULL && fwrite(data, 1, size, f) == size && fclose(f) == 0, "the scratch file");
    FILE *nowhere = fopen("/dev/null", "w");
    const rg_import_how how = {.scale = 1e-3,
                               .split = size % 2 == 0,
                               .merge = size % 3 == 0 ? 1e-3 : 0,
                               .thickness = size % 5 == 0 ? 1 : 0,
                               .layers = 2};
    rg_mesh *mesh = rg_inp_read(path, NULL, &how, nowhere);
    rg_mesh_check_elements(mesh, path);
    rg_mesh_sort(mesh);
    rg_mesh_connect(mesh);
    rg_mesh_check(mesh, path);
    rg_mesh_info(mesh, 1, nowhere);
    fclose(nowhere);
    rg_mesh_free(mesh);
}

RG_FUZZ_TARGET(body)
