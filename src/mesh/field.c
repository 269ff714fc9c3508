#include "mesh/field.h"

#include <hdf5.h>
#include <inttypes.h>
#include <stdio.h>

#include "base/h5_reason.h"

static bool is_right(hid_t dataset, hid_t space, rg_gid elements, char why[200]) {
    hsize_t size[2] = {0, 0};
    hid_t type = H5Dget_type(dataset);
    H5T_class_t kind = H5Tget_class(type);
    bool numbers = kind == H5T_FLOAT || kind == H5T_INTEGER;
    H5Tclose(type);
    if (!numbers || H5Sget_simple_extent_ndims(space) != 2 ||
        H5Sget_simple_extent_dims(space, size, NULL) != 2 || size[0] != (hsize_t)elements || size[1] != 3) {
        snprintf(why, 200, "is not %" PRId64 " rows of 3 numbers, a row for each element", elements);
        return false;
    }
    return true;
}

static bool read_run(hid_t dataset, hid_t space, const rg_mesh_run *run, double (*out)[3]) {
    hsize_t from[2] = {(hsize_t)run->first, 0}, count[2] = {(hsize_t)run->count, 3};
    hid_t here = H5Screate_simple(2, count, NULL);
    bool good = H5Sselect_hyperslab(space, H5S_SELECT_SET, from, NULL, count, NULL) >= 0 &&
                H5Dread(dataset, H5T_NATIVE_DOUBLE, here, space, H5P_DEFAULT, out) >= 0;
    H5Sclose(here);
    return good;
}

static bool read_all(hid_t file, const char *name, rg_gid elements, size_t runs, const rg_mesh_run *run,
                     double (*out)[3], const char *reason, char why[200]) {
    if (H5Lexists(file, name, H5P_DEFAULT) <= 0) {
        snprintf(why, 200, "there is no such dataset");
        return false;
    }
    hid_t dataset = H5Dopen2(file, name, H5P_DEFAULT), space = dataset < 0 ? -1 : H5Dget_space(dataset);
    bool good = space >= 0;
    if (!good) {
        snprintf(why, 200, "is no dataset");
    } else if ((good = is_right(dataset, space, elements, why))) {
        for (size_t i = 0; i < runs && good; i++) {
            good = read_run(dataset, space, &run[i], out);
            out += run[i].count;
        }
        if (!good) {
            snprintf(why, 200, "cannot be read: %.160s", reason);
        }
    }
    if (space >= 0) {
        H5Sclose(space);
    }
    if (dataset >= 0) {
        H5Dclose(dataset);
    }
    return good;
}

bool rg_mesh_field_read(const char *path, const char *name, rg_gid elements, size_t runs,
                        const rg_mesh_run *run, double (*out)[3], char why[200]) {
    char reason[RG_H5_REASON];
    rg_h5_listen(reason);
    hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    bool good = file >= 0;
    if (good) {
        good = read_all(file, name, elements, runs, run, out, reason, why);
        H5Fclose(file);
    } else {
        snprintf(why, 200, "cannot be opened: %.160s", reason);
    }
    rg_h5_deafen();
    return good;
}
