#include "solver/state.h"

#include <string.h>

#include "base/error.h"

static void add(rg_state *st, rg_state_array a) {
    if (st->arrays == RG_MAX_STATE) {
        rg_fatal(RG_FAILURE, "state %s: RG_MAX_STATE is too small", a.name);
    }
    st->array[st->arrays++] = a;
}

void rg_state_add(rg_state *st, const char *name, rg_state_of of, rg_state_type type, int count, void *data) {
    rg_state_array a = {.name = name, .of = of, .type = type, .count = count, .data = data, .records = 1};
    a.stride = rg_state_bytes(&a);
    add(st, a);
}

void rg_state_add_rows(rg_state *st, const char *name, rg_state_type type, int count, void *data,
                       size_t stride, size_t rows) {
    add(st, (rg_state_array){.name = name,
                             .of = RG_OF_RUN,
                             .type = type,
                             .count = count,
                             .data = data,
                             .records = rows,
                             .stride = stride});
}

void rg_state_add_list(rg_state *st, const char *name, rg_state_type type, int count, void *data,
                       size_t stride, size_t records, const int64_t *key) {
    add(st, (rg_state_array){.name = name,
                             .of = RG_OF_LIST,
                             .type = type,
                             .count = count,
                             .data = data,
                             .key = key,
                             .records = records,
                             .stride = stride});
}

void rg_state_add_pool(rg_state *st, const char *name, int count, rg_state_pool pool) {
    add(st, (rg_state_array){
                .name = name, .of = RG_OF_POOL, .type = RG_STATE_DOUBLE, .count = count, .pool = pool});
}

static size_t value_bytes(const rg_state_array *a) {
    static const size_t bytes[] = {1, sizeof(int64_t), sizeof(rg_real), sizeof(double)};
    return bytes[a->type];
}

size_t rg_state_bytes(const rg_state_array *a) {
    return value_bytes(a) * (size_t)a->count;
}

/* Where value k of record i lies. */
static char *address(const rg_state_array *a, size_t i, size_t k) {
    size_t value = value_bytes(a);
    if (a->of == RG_OF_LIST || a->of == RG_OF_RUN) {
        return (char *)a->data + i * a->stride + k * value;
    }
    return (char *)a->data + ((i / RG_LANES * (size_t)a->count + k) * RG_LANES + i % RG_LANES) * value;
}

void rg_state_get(const rg_state_array *a, size_t i, void *out) {
    size_t value = value_bytes(a);
    if (a->of == RG_OF_ELEMENT && a->type == RG_STATE_REAL) { /* nearly all there is */
        const rg_real *from =
            (const rg_real *)a->data + i / RG_LANES * (size_t)a->count * RG_LANES + i % RG_LANES;
        for (int k = 0; k < a->count; k++) {
            memcpy((char *)out + (size_t)k * sizeof *from, from + k * RG_LANES, sizeof *from);
        }
        return;
    }
    for (size_t k = 0; k < (size_t)a->count; k++) {
        memcpy((char *)out + k * value, address(a, i, k), value);
    }
}

void rg_state_put(const rg_state_array *a, size_t i, const void *in) {
    size_t value = value_bytes(a);
    for (size_t k = 0; k < (size_t)a->count; k++) {
        memcpy(address(a, i, k), (const char *)in + k * value, value);
    }
}

int64_t rg_face_number(const rg_domain *d, const rg_tile *t, size_t i) {
    int32_t link = d->side[0][i];
    return RG_FACES * d->id[t->begin * RG_LANES + (size_t)link / RG_FACES] + link % RG_FACES;
}
