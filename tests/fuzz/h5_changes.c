#include "h5_changes.h"

int64_t rg_fuzz_integer(uint8_t code) {
    static const int64_t special[16] = {
        INT8_MAX,  INT8_MIN,  INT16_MAX, INT32_MAX, INT32_MIN,       INT64_MAX, INT64_MIN,    1 << 20,
        1LL << 32, 1LL << 40, -1,        1000,      (1LL << 40) + 1, 1LL << 62, -(1LL << 40), 256};
    return code < 240 ? (int64_t)code - 120 : special[code - 240];
}

double rg_fuzz_real(uint8_t code) {
    static const double special[8] = {0.0 / 1.0,  1e300,       -1e300, 1e-300,
                                      1e308 * 10, -1e308 * 10, 0.5,    1 + 1e-12};
    if (code == 255) {
        return special[4] - special[4]; /* not a number */
    }
    return code < 240 ? 0.0625 * ((int)code - 16) : special[code % 8];
}

void rg_fuzz_change_attribute(hid_t object, const char *name, int64_t value, bool other_type) {
    if (other_type) {
        H5Adelete(object, name);
        hid_t space = H5Screate_simple(1, (hsize_t[]){(hsize_t)(value & 3)}, NULL);
        hid_t made = H5Acreate2(object, name, value & 4 ? H5T_NATIVE_DOUBLE : H5T_C_S1, space, H5P_DEFAULT,
                                H5P_DEFAULT);
        H5Aclose(made);
        H5Sclose(space);
        return;
    }
    hid_t a = H5Aopen(object, name, H5P_DEFAULT), space = H5Aget_space(a), type = H5Aget_type(a);
    bool integer = H5Tget_class(type) == H5T_INTEGER;
    if (integer && H5Sget_simple_extent_npoints(space) == 1) { /* not made another before */
        H5Awrite(a, H5T_NATIVE_INT64, &value);
    }
    H5Tclose(type);
    H5Sclose(space);
    H5Aclose(a);
}

void rg_fuzz_change_shape(hid_t file, const char *name, int64_t rows, uint8_t code) {
    H5Ldelete(file, name, H5P_DEFAULT);
    if (code == 0) {
        return;
    }
    const hid_t type[4] = {H5T_NATIVE_INT32, H5T_NATIVE_DOUBLE, H5T_C_S1, H5T_NATIVE_INT8};
    hsize_t size[2] = {rows < 0 ? 0 : (hsize_t)rows, 1 + code % 5u};
    hid_t space = H5Screate_simple(1 + code % 2, size, NULL);
    hid_t made = H5Dcreate2(file, name, type[code / 2 % 4], space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Dclose(made);
    H5Sclose(space);
}

void rg_fuzz_h5_begin(void) {
    H5set_free_list_limits(-1, -1, -1, -1, -1, -1);
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
}

void rg_fuzz_h5_close(void) {
    static int count;
    hid_t id[64];
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL); /* a reader's place for the reason may be gone */
    ssize_t found = H5Fget_obj_ids(H5F_OBJ_ALL, H5F_OBJ_ALL, 64, id);
    for (ssize_t i = 0; i < found; i++) {
        while (H5Iis_valid(id[i]) > 0 && H5Idec_ref(id[i]) >= 0) {
        }
    }
    if (++count % 512 == 0) {
        H5close(); /* with what is tied to no file */
    }
}
