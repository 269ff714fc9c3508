#include "solver/initial.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "base/error.h"
#include "base/first_bad.h"
#include "base/mem.h"
#include "base/vector.h"
#include "case/problem.h"
#include "domain/element.h"
#include "quadrature.h"
#include "solver/stress_of_run.h"
#include "stressed.h"

/* ---- Which values ---- */

static bool has_element(const rg_case *c, const rg_initial_set *set, const rg_domain *d,
                        const rg_sets *volume, size_t slot) {
    if (set->material != NULL) {
        return d->material[slot / RG_LANES] == rg_case_find_material(c, set->material);
    }
    if (set->set != NULL) {
        return rg_sets_hold(volume, d->region[slot], rg_sets_find(volume, set->set));
    }
    double x[3];
    for (int k = 0; k < 3; k++) {
        const double *corner = d->corner + 12 * slot + k;
        x[k] = 0.25 * (corner[0] + corner[3] + corner[6] + corner[9]);
    }
    double here = rg_expr_value(set->where, x, 0);
    return !isfinite(here) || here != 0; /* what is not finite is told with the values of the set */
}

const rg_initial *rg_initial_of(const rg_case *c, const rg_domain *d, const rg_sets *volume, size_t slot,
                                int *number) {
    *number = c->initial_sets - 1;
    while (*number >= 0 && !has_element(c, &c->initial_set[*number], d, volume, slot)) {
        --*number;
    }
    return *number < 0 ? &c->initial : &c->initial_set[*number].is;
}

static void refuse_set(const rg_solver *s, int i, int64_t elements) {
    const rg_initial_set *set = &s->input->initial_set[i];
    const rg_sets *volume = &s->part->volume;
    if (set->set != NULL && rg_sets_find(volume, set->set) < 0) {
        const char **names = RG_NEW(const char *, (size_t)volume->count + 1);
        char all[1024];
        memcpy(names, volume->name, (size_t)volume->count * sizeof *names);
        rg_speak(s->comm);
        rg_fatal(RG_USAGE, "%s: initial.sets[%d].set: %s: %s has no such volume set; allowed: %s",
                 s->input->path, i, set->set, s->input->mesh.file,
                 rg_choices(set->set, names, all, sizeof all));
    }
    if (elements == 0) {
        rg_speak(s->comm);
        rg_fatal(RG_USAGE, "%s: initial.sets[%d]: no element is in it, or later sets have them all",
                 s->input->path, i);
    }
}

/* Number of the set of each element: [slots]; -1: of none. */
static int16_t *choose_sets(const rg_solver *s) {
    size_t slots = s->domain->blocks * RG_LANES;
    int sets = s->input->initial_sets;
    int16_t *of = RG_NEW(int16_t, slots + 1);
    int64_t *count = RG_NEW(int64_t, (size_t)sets + 1);
    for (int i = 0; i < sets; i++) { /* unknown ones first: they have no elements either */
        refuse_set(s, i, 1);
    }
    for (size_t slot = 0; slot < slots; slot++) {
        int number = -1;
        if (s->domain->id[slot] >= 0) {
            rg_initial_of(s->input, s->domain, &s->part->volume, slot, &number);
            count[number + 1]++;
        }
        of[slot] = (int16_t)number;
    }
    MPI_Allreduce(MPI_IN_PLACE, count, sets + 1, MPI_INT64_T, MPI_SUM, s->comm);
    for (int i = 0; i < sets; i++) {
        refuse_set(s, i, count[i + 1]);
    }
    rg_free(count);
    return of;
}

/* ---- Values ---- */

/* Expressions of one thread: displacement, then velocity; of `initial`, then of each set. */
typedef rg_expr *values[6];

static values *copy_values(const rg_case *c) {
    values *own = rg_alloc((size_t)c->initial_sets + 1, sizeof *own);
    for (int i = -1; i < c->initial_sets; i++) {
        const rg_initial *of = i < 0 ? &c->initial : &c->initial_set[i].is;
        for (int k = 0; k < 3; k++) {
            own[i + 1][k] = rg_expr_copy(of->displacement[k]);
            own[i + 1][3 + k] = rg_expr_copy(of->velocity[k]);
        }
    }
    return own;
}

static void free_values(const rg_case *c, values *own) {
    for (int i = 0; i < 6 * (c->initial_sets + 1); i++) {
        rg_expr_free(own[i / 6][i % 6]);
    }
    rg_free(own);
}

static void fill_node(rg_solver *s, int set, rg_expr *const own[6], size_t slot, int n, rg_first_bad *bad) {
    const rg_initial *is = set < 0 ? &s->input->initial : &s->input->initial_set[set].is;
    double x[3], value[6], arm[3], turn[3], axis[3];
    double length = sqrt(rg_vector_dot(is->axis, is->axis));
    rg_node_position(s->domain->corner + 12 * slot, n, x);
    for (int k = 0; k < 6; k++) {
        value[k] = own[k] == NULL ? 0 : rg_expr_value(own[k], x, 0);
        if (!isfinite(value[k])) {
#pragma omp critical
            rg_first_bad_note(bad, 6 * (set + 1) + k, x, value[k]);
        }
    }
    for (int k = 0; k < 3; k++) {
        arm[k] = x[k] + value[k] - is->at[k];
        axis[k] = length > 0 ? is->axis[k] / length : 0;
    }
    rg_vector_cross(axis, arm, turn);
    for (int k = 0; k < 3; k++) {
        s->u[rg_node_index(slot, n, k)] = (rg_real)value[k];
        s->velocity[rg_node_index(slot, n, k)] = (rg_real)(value[3 + k] + is->spin * turn[k]);
    }
}

/* Value k of the stress of an element at point g. */
static size_t stress_index(size_t slot, int g, int k) {
    return slot / RG_LANES * RG_PRESTRESS_BLOCK + (size_t)(g * 6 + k) * RG_LANES + slot % RG_LANES;
}

/* Ends the run: value `part` of initial, of its set or of itself (-1), is not finite at a place. */
_Noreturn static void refuse_value(const rg_solver *s, int set, const char *part, const rg_expr *value,
                                   const rg_first_bad *bad) {
    char path[40] = "initial";
    if (set >= 0) {
        snprintf(path, sizeof path, "initial.sets[%d]", set);
    }
    rg_speak(s->comm);
    rg_fatal(RG_USAGE, "%s: %s.%s: %s is not finite at (%g, %g, %g)", s->input->path, path, part,
             rg_expr_text(value), bad->x[0], bad->x[1], bad->x[2]);
}

static double largest_stress(const rg_solver *s) {
    double most = 0;
    for (size_t i = 0; i < s->domain->blocks * RG_PRESTRESS_BLOCK; i++) {
        most = fmax(most, fabs((double)s->prestress[i]));
    }
    MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_DOUBLE, MPI_MAX, s->comm);
    return most;
}

/* Of the stress of the start, what it makes of elements by themselves: about the norm, in that of M^-1, of
 * its forces on a body of loose elements. */
static double stress_scale(const rg_solver *s) {
    const rg_domain *d = s->domain;
    rg_exact_sum sum = {0};
    for (size_t slot = 0; slot < d->blocks * RG_LANES; slot++) {
        double square = 0, volume = d->geom[rg_geom_index(slot, RG_GEOM_VOLUME)];
        for (int i = 0; i < RG_PRESTRESS && d->id[slot] >= 0; i++) {
            double value = s->prestress[stress_index(slot, i / 6, i % 6)];
            square += (i % 6 < 3 ? 0.25 : 0.5) * value * value;
        }
        if (d->id[slot] >= 0) {
            double side = cbrt(volume);
            rg_exact_add(&sum,
                         square * side * side * side * side / rg_element_mass(d, s->model->material, slot));
        }
    }
    rg_exact_allreduce(&sum, 1, s->comm);
    return sqrt(rg_exact_value(&sum));
}

static bool takes_stress(const rg_material *m) {
    return ((int)RG_STRESS_INSIDE >> m->model & 1) != 0;
}

/* A point of a solid that flows begins with an elastic strain; what of the stress is beside stays. */
static void take_point(rg_solver *s, size_t slot, int g, const rg_material *m) {
    enum { MOST = 32 };
    int count = rg_material_values(m);
    double stress[6], history[MOST] = {0};
    for (int k = 0; k < 6; k++) {
        stress[k] = s->prestress[stress_index(slot, g, k)];
    }
    rg_material_take_stress(m, stress, history);
    for (int k = 0; k < 6; k++) {
        s->prestress[stress_index(slot, g, k)] = (rg_real)stress[k];
    }
    rg_real *to = s->history + slot / RG_LANES * s->model->history_stride + slot % RG_LANES;
    for (int k = 0; k < count; k++) {
        to[(g * count + k) * RG_LANES] = (rg_real)history[k];
    }
}

/* Where stress is a part of the solid's own. */
static void take_stress(rg_solver *s) {
    s->initial_stress.largest = largest_stress(s);
    s->initial_stress.scale = stress_scale(s);
    for (size_t slot = 0; slot < s->domain->blocks * RG_LANES; slot++) {
        const rg_material *m = &s->model->material[s->domain->material[slot / RG_LANES]];
        for (int g = 0; g < RG_GAUSS && s->domain->id[slot] >= 0 && takes_stress(m); g++) {
            take_point(s, slot, g, m);
        }
    }
}

/* In order: expressions are not for threads. */
static void fill_stress(rg_solver *s, const int16_t *set) {
    static const char *const part[6] = {"stress.xx", "stress.yy", "stress.zz",
                                        "stress.yz", "stress.xz", "stress.xy"};
    rg_first_bad bad = {.which = RG_NOWHERE};
    for (size_t i = 0; i < s->domain->blocks * RG_LANES * RG_PRESTRESS; i++) {
        size_t slot = i / RG_PRESTRESS;
        if (set[slot] < 0 && s->input->stress_of.run != NULL) {
            continue; /* rg_stress_of_run has it */
        }
        int g = (int)(i % RG_PRESTRESS) / 6, k = (int)(i % 6);
        const rg_initial *is = set[slot] < 0 ? &s->input->initial : &s->input->initial_set[set[slot]].is;
        double x[3], value = 0;
        if (s->domain->id[slot] >= 0 && is->stress[k] != NULL) {
            rg_gauss_position(s->domain->corner + 12 * slot, g, x);
            value = rg_expr_value(is->stress[k], x, 0);
            if (!isfinite(value)) {
                rg_first_bad_note(&bad, 6 * (set[slot] + 1) + k, x, value);
            }
        }
        s->prestress[stress_index(slot, g, k)] = (rg_real)value;
    }
    if (rg_first_bad_lowest(&bad, s->comm)) {
        int number = (int)(bad.which / 6) - 1, k = (int)(bad.which % 6);
        const rg_initial *is = number < 0 ? &s->input->initial : &s->input->initial_set[number].is;
        refuse_value(s, number, part[k], is->stress[k], &bad);
    }
}

static void refuse_values(const rg_solver *s, rg_first_bad *bad) {
    static const char *const part[2][3] = {{"displacement.x", "displacement.y", "displacement.z"},
                                           {"velocity.x", "velocity.y", "velocity.z"}};
    if (rg_first_bad_lowest(bad, s->comm)) {
        int set = (int)(bad->which / 6) - 1, k = (int)(bad->which % 3);
        bool moves = bad->which % 6 >= 3;
        const rg_initial *is = set < 0 ? &s->input->initial : &s->input->initial_set[set].is;
        refuse_value(s, set, part[moves][k], (moves ? is->velocity : is->displacement)[k], bad);
    }
}

void rg_initial_fill(rg_solver *s) {
    rg_first_bad bad = {.which = RG_NOWHERE};
    int16_t *set = choose_sets(s);
#pragma omp parallel
    {
        values *own = copy_values(s->input);
#pragma omp for schedule(static)
        for (size_t slot = 0; slot < s->domain->blocks * RG_LANES; slot++) {
            for (int n = 0; s->domain->id[slot] >= 0 && n < RG_NODES; n++) {
                fill_node(s, set[slot], own[set[slot] + 1], slot, n, &bad);
            }
        }
        free_values(s->input, own);
    }
    if (s->prestress != NULL) {
        if (s->input->stress_of.run != NULL) {
            rg_stress_of_run(s, set);
        }
        fill_stress(s, set);
        take_stress(s);
    }
    rg_free(set);
    refuse_values(s, &bad);
    if (s->assembly != NULL && s->input->initial_sets > 0) {
        rg_assembly_mean(s->assembly, s->u);
        rg_assembly_mean(s->assembly, s->velocity);
    }
}
