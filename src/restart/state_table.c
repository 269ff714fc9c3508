#include "restart/state_table.h"

#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "domain/sparse.h"
#include "solver/tile.h"

/* A record of the table on this rank: its key, and where its arrays have it. */
typedef struct {
    int64_t key;
    size_t at;
} entry;

int rg_state_tables(const rg_state *st, rg_state_table table[RG_MAX_STATE]) {
    int tables = 0;
    for (int i = 0; i < st->arrays; i++) {
        const rg_state_array *a = &st->array[i];
        if (a->of == RG_OF_LIST || a->of == RG_OF_POOL) {
            table[tables++] = (rg_state_table){.name = a->name, .arrays = 1, .array = {a}};
        } else if (a->of == RG_OF_FACE) {
            int t = 0;
            while (t < tables && strcmp(table[t].name, "face") != 0) {
                t++;
            }
            if (t == tables) {
                table[tables++] = (rg_state_table){.name = "face"};
            }
            table[t].array[table[t].arrays++] = a;
        }
    }
    return tables;
}

hid_t rg_state_h5_type(const rg_state_array *a) {
    switch (a->type) {
    case RG_STATE_BYTE:
        return H5T_NATIVE_UINT8;
    case RG_STATE_INT64:
        return H5T_NATIVE_INT64;
    case RG_STATE_REAL:
        return sizeof(rg_real) == sizeof(float) ? H5T_NATIVE_FLOAT : H5T_NATIVE_DOUBLE;
    case RG_STATE_DOUBLE:
        break;
    }
    return H5T_NATIVE_DOUBLE;
}

/* ---- records of this rank ---- */

static size_t face_entries(const rg_solver *s, bool marked, entry *list) {
    const rg_domain *d = s->domain;
    size_t n = 0;
    for (size_t t = 0; t < d->tiles; t++) {
        for (size_t i = d->tile[t].ibegin * RG_LANES; i < d->tile[t].iend * RG_LANES; i++) {
            double normal[3];
            if ((!marked || rg_face_is_marked(s, i)) &&
                rg_interface_area(d, i, normal) >
                    0) { /* not padding, which may break in the intrinsic form */
                list[n++] = (entry){rg_face_number(d, &d->tile[t], i), i};
            }
        }
    }
    return n;
}

/* At least as many as face_entries finds. */
static size_t most_faces(const rg_solver *s, bool marked) {
    size_t all = s->domain->iblocks * RG_LANES, n = 0;
    for (size_t i = 0; i < all; i++) {
        n += rg_face_is_marked(s, i);
    }
    return marked ? n : all;
}

/* Those that have something to keep, or (all) those that there are. */
static entry *entries(const rg_state_table *t, const rg_solver *s, bool all, size_t *count) {
    const rg_state_array *a = t->array[0];
    bool faces = a->of == RG_OF_FACE;
    size_t most = faces ? most_faces(s, !all) : a->records;
    entry *list = RG_NEW(entry, most);
    *count = faces ? face_entries(s, !all, list) : most;
    for (size_t i = 0; !faces && i < most; i++) {
        list[i] = (entry){a->key[i], i};
    }
    return list;
}

static size_t row_bytes(const rg_state_table *t) {
    size_t bytes = sizeof(int64_t);
    for (int k = 0; k < t->arrays; k++) {
        bytes += rg_state_bytes(t->array[k]);
    }
    return bytes;
}

/* ---- writing ---- */

static rg_sparse gather_pool(const rg_state_table *t) {
    const rg_state_array *a = t->array[0];
    int64_t *key;
    double *value;
    rg_sparse own = {.rows = a->pool.list(a->pool.of, &key, &value), .bytes = row_bytes(t)};
    own.row = RG_NEW(char, own.rows *own.bytes);
    for (size_t i = 0; i < own.rows; i++) {
        char *at = own.row + i * own.bytes;
        memcpy(at, &key[i], sizeof *key);
        memcpy(at + sizeof *key, value + i * (size_t)a->count, rg_state_bytes(a));
    }
    rg_free(key);
    rg_free(value);
    return own;
}

static rg_sparse gather(const rg_state_table *t, const rg_solver *s) {
    if (t->array[0]->of == RG_OF_POOL) {
        return gather_pool(t);
    }
    rg_sparse own = {.bytes = row_bytes(t)};
    entry *list = entries(t, s, false, &own.rows);
    own.row = RG_NEW(char, own.rows *own.bytes);
    for (size_t i = 0; i < own.rows; i++) {
        char *at = own.row + i * own.bytes;
        memcpy(at, &list[i].key, sizeof list[i].key);
        at += sizeof list[i].key;
        for (int k = 0; k < t->arrays; k++) {
            rg_state_get(t->array[k], list[i].at, at);
            at += rg_state_bytes(t->array[k]);
        }
    }
    rg_free(list);
    return own;
}

/* Rows before this rank's, and of all ranks. */
static void number(MPI_Comm comm, int64_t rows, int64_t *first, int64_t *total) {
    MPI_Scan(&rows, first, 1, MPI_INT64_T, MPI_SUM, comm);
    *first -= rows;
    MPI_Allreduce(&rows, total, 1, MPI_INT64_T, MPI_SUM, comm);
}

/* Bytes `from` .. `from` + size of every row, side by side; or the other way round. */
static void column_out(const rg_sparse *rows, size_t from, size_t size, char *column) {
    for (size_t i = 0; i < rows->rows; i++) {
        memcpy(column + i * size, rows->row + i * rows->bytes + from, size);
    }
}

static void column_in(const rg_sparse *rows, size_t from, size_t size, const char *column) {
    for (size_t i = 0; i < rows->rows; i++) {
        memcpy(rows->row + i * rows->bytes + from, column + i * size, size);
    }
}

static rg_h5_slab key_slab(const rg_sparse *rows, int64_t first, int64_t total) {
    return (rg_h5_slab){.name = "key",
                        .type = H5T_NATIVE_INT64,
                        .columns = 1,
                        .rows = total,
                        .first = first,
                        .count = (int64_t)rows->rows};
}

static rg_h5_slab rows_slab(const rg_slab *slab) {
    return (rg_h5_slab){.name = "rows",
                        .type = H5T_NATIVE_UINT16,
                        .columns = 1,
                        .rows = slab->total,
                        .first = slab->first,
                        .count = (int64_t)slab->count};
}

/* The dataset of array k, or, before all of them, of the keys; *from and *size tell where it is in a row. */
static rg_h5_slab column_slab(const rg_state_table *t, int k, rg_h5_slab s, size_t *from, size_t *size) {
    *from += *size;
    *size = k < 0 ? sizeof(int64_t) : rg_state_bytes(t->array[k]);
    if (k >= 0) {
        s.name = t->array[k]->name;
        s.type = rg_state_h5_type(t->array[k]);
        s.columns = t->array[k]->count;
    }
    return s;
}

void rg_state_table_write(rg_h5_file *f, const rg_state_table *t, const rg_solver *s, const rg_slab *slab) {
    rg_sparse own = gather(t, s), sorted = rg_sparse_to_slab(slab, &own);
    rg_free(own.row);
    hid_t group = rg_h5_group(f, t->name);
    int64_t first, total;
    number(f->comm, (int64_t)sorted.rows, &first, &total);
    char *column = RG_NEW(char, sorted.rows *sorted.bytes);
    uint16_t *of_element = RG_NEW(uint16_t, slab->count);
    for (size_t i = 0; i < sorted.rows; i++) {
        of_element[rg_sparse_key(&sorted, i) / 4 - slab->first]++;
    }
    rg_h5_slab rows = rows_slab(slab);
    rg_h5_write(f, group, &rows, NULL, of_element);
    size_t from = 0, size = 0;
    for (int k = -1; k < t->arrays; k++) {
        rg_h5_slab c = column_slab(t, k, key_slab(&sorted, first, total), &from, &size);
        column_out(&sorted, from, size, column);
        rg_h5_write(f, group, &c, NULL, column);
    }
    rg_h5_note(f, H5Gclose(group) >= 0, "close", NULL);
    rg_free(of_element);
    rg_free(column);
    rg_free(sorted.row);
}

/* ---- reading ---- */

static int by_key(const void *a, const void *b) {
    const entry *p = a, *q = b;
    return (p->key > q->key) - (p->key < q->key);
}

static void scatter_pool(const rg_state_array *a, const rg_sparse *own) {
    int64_t *key = RG_NEW(int64_t, own->rows + 1);
    double *value = RG_NEW(double, (own->rows + 1) * (size_t)a->count);
    for (size_t i = 0; i < own->rows; i++) {
        key[i] = rg_sparse_key(own, i);
        memcpy(value + i * (size_t)a->count, own->row + i * own->bytes + sizeof *key, rg_state_bytes(a));
    }
    a->pool.take(a->pool.of, own->rows, key, value);
    rg_free(key);
    rg_free(value);
}

static bool scatter(const rg_state_table *t, const rg_solver *s, const rg_sparse *own) {
    if (t->array[0]->of == RG_OF_POOL) {
        scatter_pool(t->array[0], own);
        return true;
    }
    size_t count;
    entry *list = entries(t, s, true, &count);
    qsort(list, count, sizeof *list, by_key);
    bool ok = t->array[0]->of == RG_OF_FACE || own->rows == count;
    for (size_t i = 0; ok && i < own->rows; i++) {
        entry wanted = {.key = rg_sparse_key(own, i)};
        const entry *found = bsearch(&wanted, list, count, sizeof *list, by_key);
        const char *at = own->row + i * own->bytes + sizeof wanted.key;
        ok = found != NULL;
        for (int k = 0; ok && k < t->arrays; k++) {
            rg_state_put(t->array[k], found->at, at);
            at += rg_state_bytes(t->array[k]);
        }
    }
    rg_free(list);
    return ok;
}

/* Whether the keys are those of the slab's elements: as many to each as its count says. */
static bool keys_fit(const rg_sparse *rows, const rg_slab *slab, const uint16_t *of_element) {
    uint16_t *left = RG_NEW(uint16_t, slab->count + 1);
    memcpy(left, of_element, slab->count * sizeof *left);
    bool ok = true;
    for (size_t i = 0; ok && i < rows->rows; i++) {
        int64_t element = rg_sparse_key(rows, i) / 4 - slab->first;
        ok = element >= 0 && element < (int64_t)slab->count && left[element] > 0;
        left[ok ? element : (int64_t)slab->count]--;
    }
    rg_free(left);
    return ok;
}

/* The slab's rows of the table. Collective; false on all ranks if they cannot be read. */
static bool read_sorted(rg_h5_file *f, hid_t group, const rg_state_table *t, const rg_slab *slab,
                        rg_sparse *sorted) {
    uint16_t *of_element = RG_NEW(uint16_t, slab->count);
    rg_h5_slab rows = rows_slab(slab);
    bool ok = rg_h5_all(f->comm, rg_h5_read(group, &rows, of_element));
    for (size_t i = 0; ok && i < slab->count; i++) {
        sorted->rows += of_element[i];
    }
    int64_t first, total;
    number(f->comm, (int64_t)sorted->rows, &first, &total);
    sorted->row = RG_NEW(char, sorted->rows * sorted->bytes);
    char *column = RG_NEW(char, sorted->rows * sorted->bytes);
    size_t from = 0, size = 0;
    for (int k = -1; ok && k < t->arrays; k++) {
        rg_h5_slab c = column_slab(t, k, key_slab(sorted, first, total), &from, &size);
        ok = rg_h5_all(f->comm, rg_h5_read(group, &c, column));
        column_in(sorted, from, size, column);
    }
    ok = rg_h5_all(f->comm, ok && keys_fit(sorted, slab, of_element));
    rg_free(column);
    rg_free(of_element);
    return ok;
}

bool rg_state_table_read(rg_h5_file *f, const rg_state_table *t, const rg_solver *s, const rg_slab *slab) {
    hid_t group = H5Gopen2(f->file, t->name, H5P_DEFAULT);
    rg_sparse sorted = {.bytes = row_bytes(t)};
    bool ok = rg_h5_all(f->comm, group >= 0) && read_sorted(f, group, t, slab, &sorted);
    if (ok) {
        rg_sparse own = rg_sparse_to_owners(slab, &sorted);
        ok = rg_h5_all(f->comm, scatter(t, s, &own));
        rg_free(own.row);
    }
    rg_free(sorted.row);
    if (group >= 0) {
        H5Gclose(group);
    }
    return ok;
}
