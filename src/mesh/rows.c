#include "mesh/rows.h"

#include <string.h>

#include "base/hash.h"

const rg_rows rg_rows_surface_sets = {"surface_sets", RG_ROWS_NAME, 1};
const rg_rows rg_rows_volume_sets = {"volume_sets", RG_ROWS_NAME, 1};
const rg_rows rg_rows_surface_combinations = {"surface_combinations", RG_ROWS_INT32, 2};
const rg_rows rg_rows_volume_combinations = {"volume_combinations", RG_ROWS_INT32, 2};
const rg_rows rg_rows_corner = {"corner", RG_ROWS_INT64, 4};
const rg_rows rg_rows_neighbour = {"neighbour", RG_ROWS_INT64, 4};
const rg_rows rg_rows_face = {"face", RG_ROWS_INT8, 4};
const rg_rows rg_rows_set = {"set", RG_ROWS_INT32, 4};
const rg_rows rg_rows_region = {"region", RG_ROWS_INT32, 1};
const rg_rows rg_rows_original = {"original", RG_ROWS_INT64, 1};
const rg_rows rg_rows_part = {"part", RG_ROWS_INT32, 1};
const rg_rows rg_rows_vertex_start = {"vertex_start", RG_ROWS_INT64, 1};
const rg_rows rg_rows_vertex = {"vertex", RG_ROWS_INT64, 1};
const rg_rows rg_rows_x = {"x", RG_ROWS_DOUBLE, 3};
const rg_rows rg_rows_tile_start = {"tile_start", RG_ROWS_INT64, 1};
const rg_rows rg_rows_tile_neighbour = {"tile_neighbour", RG_ROWS_INT64, 1};
const rg_rows rg_rows_tile_faces = {"tile_faces", RG_ROWS_INT32, 1};

rg_rows rg_rows_of_names(const rg_rows *r, bool are_long) {
    return (rg_rows){r->name, are_long ? RG_ROWS_LONG_NAME : RG_ROWS_NAME, r->columns};
}

bool rg_rows_are_names(const rg_rows *r) {
    return r->type == RG_ROWS_NAME || r->type == RG_ROWS_LONG_NAME;
}

static size_t value_bytes(rg_row_type type) {
    static const size_t bytes[] = {sizeof(int8_t), sizeof(int32_t), sizeof(int64_t),
                                   sizeof(double), RG_SHORT_NAME,   RG_SET_NAME};
    return bytes[type];
}

size_t rg_rows_bytes(const rg_rows *r) {
    return value_bytes(r->type) * (size_t)r->columns;
}

hid_t rg_rows_type(const rg_rows *r) {
    hid_t name;
    switch (r->type) {
    case RG_ROWS_INT8:
        return H5T_NATIVE_INT8;
    case RG_ROWS_INT32:
        return H5T_NATIVE_INT32;
    case RG_ROWS_INT64:
        return H5T_NATIVE_INT64;
    case RG_ROWS_DOUBLE:
        return H5T_NATIVE_DOUBLE;
    case RG_ROWS_NAME:
    case RG_ROWS_LONG_NAME:
        break;
    }
    name = H5Tcopy(H5T_C_S1);
    H5Tset_size(name, value_bytes(r->type));
    return name;
}

static uint64_t word(rg_row_type type, const void *data, size_t i) {
    uint64_t bits = 0;
    switch (type) {
    case RG_ROWS_INT32:
        return (uint64_t)(int64_t)((const int32_t *)data)[i];
    case RG_ROWS_INT64:
    case RG_ROWS_DOUBLE:
        memcpy(&bits, (const char *)data + 8 * i, sizeof bits);
        return bits;
    case RG_ROWS_INT8:
    case RG_ROWS_NAME:
    case RG_ROWS_LONG_NAME:
        break;
    }
    return (uint64_t)(int64_t)((const int8_t *)data)[i];
}

uint64_t rg_rows_checksum(const rg_rows *r, const void *data, int64_t count) {
    size_t values = (size_t)count * (size_t)r->columns * (rg_rows_are_names(r) ? value_bytes(r->type) : 1);
    uint64_t sum = 0;
    for (size_t i = 0; i < values; i++) {
        sum = rg_hash(sum, word(r->type, data, i));
    }
    return sum;
}
