#include "support/checkpoint_tamper.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "base/mem.h"
#include "layout.h"

void *load(hid_t file, const char *path, hid_t type, int64_t *rows, int columns) {
    hid_t set = H5Dopen2(file, path, H5P_DEFAULT), space = H5Dget_space(set), kind = H5Dget_type(set);
    hsize_t size[2] = {0, 0};
    bool good = H5Sget_simple_extent_ndims(space) == 2 && H5Sget_simple_extent_dims(space, size, NULL) == 2 &&
                size[1] == (hsize_t)columns && H5Tequal(kind, type) > 0 &&
                (*rows < 0 || size[0] == (hsize_t)*rows);
    void *data = good ? rg_alloc((size_t)(size[0] * size[1]) + 1, 8) : NULL;
    if (good) {
        H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data);
    } else {
        printf("# %s is not as it should be\n", path);
    }
    *rows = (int64_t)size[0];
    H5Tclose(kind);
    H5Sclose(space);
    H5Dclose(set);
    return data;
}

const checkpoint_change checkpoint_tampers[CHECKPOINT_TAMPERS] = {
    {"another format", "step-000000000107.h5: a checkpoint of format 1; this program reads 2", NULL},
    {"another number of elements", "a checkpoint of 145 elements; the mesh of the case has 144", NULL},
    {"another mesh", "a checkpoint on another mesh: vertices or surface sets differ", NULL},
    {"another precision",
     "a checkpoint in half precision; this program computes in " RG_PRECISION " precision", NULL},
    {"another case", "interface.strength: 400000000; in the checkpoint: 300000000", NULL},
    {"a key below all", NULL, NULL},
    {"a key beyond all", NULL, NULL},
    {"a key of another face", NULL, NULL},
    {"one key twice", NULL, NULL},
    {"a row too many", NULL, NULL},
    {"a row too few", NULL, NULL},
    {"a list that is short", NULL, NULL},
    {"a motion that nobody prescribes", NULL, NULL},
    {"a case of two columns", NULL, NULL},
    {"two numbers of elements", NULL, NULL},
    {"a format in words", NULL, NULL},
    {"no case", NULL, "case"},
    {"no values of the run", NULL, "run"},
    {"no time", NULL, "run/time"},
    {"no elements", NULL, "element"},
    {"no displacement", NULL, "element/displacement"},
    {"no faces", NULL, "face"},
    {"no keys", NULL, "face/key"},
    {"no crack", NULL, "face/crack"},
    {"no counts", NULL, "face/rows"},
    {"no list", NULL, "constraint"},
};

static void put_attribute(hid_t file, const char *name, hid_t type, const void *value) {
    hid_t a = H5Aopen(file, name, H5P_DEFAULT);
    H5Awrite(a, type, value);
    H5Aclose(a);
}

void put_text(hid_t file, const char *name, const char *value) {
    hid_t space = H5Screate(H5S_SCALAR), type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, strlen(value) + 1);
    H5Adelete(file, name);
    hid_t a = H5Acreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(a, type, value);
    H5Aclose(a);
    H5Tclose(type);
    H5Sclose(space);
}

/* An attribute of two values in the place of one. */
static void put_pair(hid_t file, const char *name) {
    hid_t space = H5Screate_simple(1, (hsize_t[1]){2}, NULL);
    H5Adelete(file, name);
    hid_t a = H5Acreate2(file, name, H5T_NATIVE_INT64, space, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(a, H5T_NATIVE_INT64, (int64_t[2]){144, 144});
    H5Aclose(a);
    H5Sclose(space);
}

/* Puts another dataset in the place of one. */
static void put_rows(hid_t file, const char *path, hid_t type, int64_t rows, int columns, const void *data) {
    hid_t space = H5Screate_simple(2, (hsize_t[2]){(hsize_t)rows, (hsize_t)columns}, NULL);
    H5Ldelete(file, path, H5P_DEFAULT);
    hid_t set = H5Dcreate2(file, path, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data);
    H5Dclose(set);
    H5Sclose(space);
}

static void change_keys(hid_t file, const char *path, int64_t which, int64_t value) {
    int64_t n = -1, *key = load(file, path, H5T_NATIVE_INT64, &n, 1);
    key[which < 0 ? n + which : which] = value;
    put_rows(file, path, H5T_NATIVE_INT64, n, 1, key);
    rg_free(key);
}

static void change_count(hid_t file, const char *path, int64_t by) {
    int64_t n = -1;
    uint16_t *rows = load(file, path, H5T_NATIVE_UINT16, &n, 1);
    int64_t e = 0;
    while (rows[e] == 0) {
        e++;
    }
    rows[e] = (uint16_t)(rows[e] + by);
    put_rows(file, path, H5T_NATIVE_UINT16, n, 1, rows);
    rg_free(rows);
}

/* The first row of the list of prescribed motions is gone. */
static void shorten_list(hid_t file) {
    int64_t n = -1, *key = load(file, "constraint/key", H5T_NATIVE_INT64, &n, 1);
    double *value = load(file, "constraint/constraint", H5T_NATIVE_DOUBLE, &n, 42);
    uint16_t *rows;
    int64_t elements = 144;
    rows = load(file, "constraint/rows", H5T_NATIVE_UINT16, &elements, 1);
    rows[key[0] / 4]--;
    put_rows(file, "constraint/rows", H5T_NATIVE_UINT16, elements, 1, rows);
    put_rows(file, "constraint/key", H5T_NATIVE_INT64, n - 1, 1, key + 1);
    put_rows(file, "constraint/constraint", H5T_NATIVE_DOUBLE, n - 1, 42, value + 42);
    rg_free(key);
    rg_free(value);
    rg_free(rows);
}

static void shorten_case(hid_t file) {
    int64_t n = -1;
    char *words = load(file, "case", H5T_NATIVE_UINT8, &n, 1), *at = strstr(words, "interface.strength: 4");
    at[strlen("interface.strength: ")] = '3';
    put_rows(file, "case", H5T_NATIVE_UINT8, n, 1, words);
    rg_free(words);
}

void checkpoint_tamper(hid_t file, int which) {
    switch (which) {
    case 0:
        put_attribute(file, "format", H5T_NATIVE_INT, &(int){1});
        break;
    case 1:
        put_attribute(file, "elements", H5T_NATIVE_INT64, &(int64_t){145});
        break;
    case 2:
        put_attribute(file, "mesh", H5T_NATIVE_UINT64, &(uint64_t){7});
        break;
    case 3:
        put_text(file, "precision", "half");
        break;
    case 4:
        shorten_case(file);
        break;
    case 5:
        change_keys(file, "face/key", 0, -1);
        break;
    case 6:
        change_keys(file, "face/key", -1, 4 * 144 + 1);
        break;
    case 7:
        change_keys(file, "constraint/key", 0, 3);
        break;
    case 8: {
        int64_t n = -1, *key = load(file, "face/key", H5T_NATIVE_INT64, &n, 1);
        change_keys(file, "face/key", n - 1, key[0]);
        rg_free(key);
        break;
    }
    case 9:
        change_count(file, "face/rows", 1);
        break;
    case 10:
        change_count(file, "face/rows", -1);
        break;
    case 11:
        shorten_list(file);
        break;
    case 12: {
        int64_t n = -1, *key = load(file, "constraint/key", H5T_NATIVE_INT64, &n, 1);
        change_keys(file, "constraint/key", 0, key[0] / 4 * 4 + 3); /* of the same element */
        rg_free(key);
        break;
    }
    case 13:
        put_rows(file, "case", H5T_NATIVE_UINT8, 50, 2, (char[100]){0});
        break;
    case 14:
        put_pair(file, "elements");
        break;
    case 15:
        put_text(file, "format", "one");
        break;
    default:
        H5Ldelete(file, checkpoint_tampers[which].gone, H5P_DEFAULT);
    }
}
