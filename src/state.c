#include "state.h"

#include <string.h>

#include "error.h"

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
    add(st, (rg_state_array){name, RG_OF_RUN, type, count, data, NULL, rows, stride});
}

void rg_state_add_list(rg_state *st, const char *name, rg_state_type type, int count, void *data,
                       size_t stride, size_t records, const int64_t *key) {
    add(st, (rg_state_array){name, RG_OF_LIST, type, count, data, key, records, stride});
}

void rg_state_of_solver(rg_state *st, rg_solver *s) {
    rg_state_add(st, "time", RG_OF_RUN, RG_STATE_DOUBLE, 1, &s->time);
    rg_state_add(st, "dt", RG_OF_RUN, RG_STATE_DOUBLE, 1, &s->dt);
    rg_state_add(st, "step", RG_OF_RUN, RG_STATE_INT64, 1, &s->step);
    /* The next time step follows the stiffening of the state before. */
    rg_state_add(st, "stiffening", RG_OF_RUN, RG_STATE_DOUBLE, 1, &s->stiffening_anywhere);
    rg_state_add(st, "pace", RG_OF_RUN, RG_STATE_DOUBLE, 1, &s->pace); /* likewise */
    rg_state_add(st, "omega2", RG_OF_RUN, RG_STATE_DOUBLE, 1, &s->omega2);
    rg_state_add(st, "limiting", RG_OF_RUN, RG_STATE_INT64, 1, &s->limiting);
    rg_state_add(st, "damping", RG_OF_RUN, RG_STATE_DOUBLE, 1, &s->damping);
    rg_state_add(st, "displacement", RG_OF_ELEMENT, RG_STATE_REAL, 3 * RG_NODES, s->u);
    rg_state_add(st, "velocity", RG_OF_ELEMENT, RG_STATE_REAL, 3 * RG_NODES, s->velocity);
    rg_state_add(st, "broken", RG_OF_FACE, RG_STATE_BYTE, 1, s->broken);
    rg_state_add(st, "unlinked", RG_OF_FACE, RG_STATE_BYTE, 1, s->unlinked);
    rg_state_add(st, "crack", RG_OF_FACE, RG_STATE_REAL, (int)(s->crack_stride / RG_LANES), s->crack);
    if (s->history != NULL) {
        rg_state_add(st, "history", RG_OF_ELEMENT, RG_STATE_REAL, (int)(s->history_stride / RG_LANES),
                     s->history);
    }
    if (s->heat != NULL) {
        rg_state_add(st, "heat", RG_OF_ELEMENT, RG_STATE_DOUBLE, 1, s->heat);
    }
    rg_constraints_register(s->constraints, st);
    rg_bodies_register(s->bodies, st);
}

static size_t value_bytes(const rg_state_array *a) {
    static const size_t bytes[] = {1, sizeof(int64_t), sizeof(rg_real), sizeof(double)};
    return bytes[a->type];
}

size_t rg_state_bytes(const rg_state_array *a) {
    return value_bytes(a) * (size_t)a->count;
}

/* Where value k of record i lies. */
static char *place(const rg_state_array *a, size_t i, size_t k) {
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
        memcpy((char *)out + k * value, place(a, i, k), value);
    }
}

void rg_state_put(const rg_state_array *a, size_t i, const void *in) {
    size_t value = value_bytes(a);
    for (size_t k = 0; k < (size_t)a->count; k++) {
        memcpy(place(a, i, k), (const char *)in + k * value, value);
    }
}

int64_t rg_face_number(const rg_domain *d, const rg_tile *t, size_t i) {
    int32_t link = d->side[0][i];
    return RG_FACES * d->id[t->begin * RG_LANES + (size_t)link / RG_FACES] + link % RG_FACES;
}
