#include "diagnostics/autopsy.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/files.h"
#include "base/json.h"
#include "base/mem.h"
#include "base/vector.h"
#include "quadrature.h"
#include "solver/step_limiter.h"
#include "solver/spectrum.h"

/* One element, as doubles: they travel as one message. */
typedef struct {
    double x[3]; /* centroid, reference (m) */
    double volume, quality, jacobian, stiffening, displacement, speed, broken_faces;
} finding;

/* grad N_a at barycentric coordinates l: (4 l_i - 1) grad l_i at corners, 4 (l_i grad l_j + l_j grad l_i) at
 * mid-edges. */
static void shape_gradients(const double l[4], double grad[4][3], double out[RG_NODES][3]) {
    for (int i = 0; i < 4; i++) {
        for (int j = i; j < 4; j++) {
            for (int c = 0; c < 3; c++) {
                out[rg_edge_node[i][j]][c] =
                    i == j ? (4 * l[i] - 1) * grad[i][c] : 4 * (l[i] * grad[j][c] + l[j] * grad[i][c]);
            }
        }
    }
}

static double determinant(double F[3][3]) {
    return F[0][0] * (F[1][1] * F[2][2] - F[1][2] * F[2][1]) -
           F[0][1] * (F[1][0] * F[2][2] - F[1][2] * F[2][0]) +
           F[0][2] * (F[1][0] * F[2][1] - F[1][1] * F[2][0]);
}

/* Of the barycentric coordinates (1/m). */
static void gradients(const rg_solver *s, size_t slot, double grad[4][3]) {
    for (int c = 0; c < 3; c++) {
        grad[3][c] = 0;
        for (int k = 0; k < 3; k++) {
            grad[k][c] = s->domain->geom[rg_geom_index(slot, RG_GEOM_GRAD + 3 * k + c)];
            grad[3][c] -= grad[k][c];
        }
    }
}

static double length(const double a[3]) {
    return sqrt(rg_vector_dot(a, a));
}

/* 3 inradius / circumradius: heights are 1/|grad l_k|, 1/r is the sum of theirs; the centre of the sphere
 * through the corners is x_3 + sum_k |x_k - x_3|^2 grad l_k / 2. */
static double quality(const rg_solver *s, size_t slot) {
    double grad[4][3], centre[3] = {0, 0, 0}, sum = 0;
    const double *x = s->domain->corner + 12 * slot;
    gradients(s, slot, grad);
    for (int k = 0; k < 4; k++) {
        double e[3] = {x[3 * k] - x[9], x[3 * k + 1] - x[10], x[3 * k + 2] - x[11]}, edge = length(e);
        sum += length(grad[k]);
        for (int c = 0; c < 3; c++) {
            centre[c] += 0.5 * edge * edge * grad[k][c];
        }
    }
    return 3 / (sum * length(centre));
}

static double jacobian_at(const rg_solver *s, size_t slot, const double l[4]) {
    double grad[4][3], shape[RG_NODES][3], F[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    gradients(s, slot, grad);
    shape_gradients(l, grad, shape);
    for (int k = 0; k < 9 * RG_NODES; k++) {
        int i = k % 3, j = k / 3 % 3, n = k / 9;
        F[i][j] += s->u[rg_node_index(slot, n, i)] * shape[n][j];
    }
    return determinant(F);
}

/* Smallest determinant of the deformation gradient at the Gauss points of an element, from its own
 * displacement (without jumps); not a number where that is not. */
static double smallest_jacobian(const rg_solver *s, size_t slot) {
    double smallest = INFINITY;
    for (int g = 0; g < RG_GAUSS; g++) {
        double l[4] = {RG_GAUSS_A, RG_GAUSS_A, RG_GAUSS_A, RG_GAUSS_A};
        l[g] = RG_GAUSS_B;
        double J = jacobian_at(s, slot, l);
        smallest = J < smallest || isnan(J) ? J : smallest;
        if (isnan(smallest)) {
            break;
        }
    }
    return smallest;
}

/* Largest length of the three components at the nodes of an element; infinite where one is not finite. */
static double largest_at_nodes(const rg_real *field, size_t slot) {
    double most = 0;
    for (int n = 0; n < RG_NODES; n++) {
        double square = 0;
        for (int c = 0; c < 3; c++) {
            double v = field[rg_node_index(slot, n, c)];
            square += v * v;
        }
        most = isfinite(square) ? fmax(most, sqrt(square)) : INFINITY;
    }
    return most;
}

static int broken_faces(const rg_solver *s, size_t slot) {
    const rg_tile *t = rg_tile_of(s->domain, slot);
    int count = 0;
    for (int f = 0; f < RG_FACES; f++) {
        int32_t link = s->domain->interface[rg_link_index(slot, f)];
        count += link >= 0 && s->broken[t->ibegin * RG_LANES + (size_t)link / 4] != 0;
    }
    return count;
}

static finding look_at(const rg_solver *s, size_t slot) {
    const double *corner = s->domain->corner + 12 * slot;
    finding f = {.volume = s->domain->geom[rg_geom_index(slot, RG_GEOM_VOLUME)],
                 .quality = quality(s, slot),
                 .jacobian = smallest_jacobian(s, slot),
                 .stiffening = s->stiffening[slot],
                 .displacement = largest_at_nodes(s->u, slot),
                 .speed = largest_at_nodes(s->velocity, slot),
                 .broken_faces = broken_faces(s, slot)};
    for (int c = 0; c < 3; c++) {
        f.x[c] = 0.25 * (corner[c] + corner[3 + c] + corner[6 + c] + corner[9 + c]);
    }
    return f;
}

/* How bad an element is: its stiffening, infinite where that is not a number. */
static double badness(const rg_solver *s, size_t slot) {
    return isfinite(s->stiffening[slot]) ? (double)s->stiffening[slot] : INFINITY;
}

/* Number of the worst element, of several the lowest; what is found there, on all ranks. */
static rg_gid find_worst(const rg_solver *s, finding *f) {
    const rg_domain *d = s->domain;
    double most = 0, anywhere;
    for (size_t slot = 0; slot < d->blocks * RG_LANES; slot++) {
        most = d->id[slot] >= 0 ? fmax(most, badness(s, slot)) : most;
    }
    MPI_Allreduce(&most, &anywhere, 1, MPI_DOUBLE, MPI_MAX, s->comm);
    rg_gid id = INT64_MAX, first;
    size_t here = 0;
    for (size_t slot = 0; slot < d->blocks * RG_LANES; slot++) {
        if (d->id[slot] >= 0 && badness(s, slot) >= anywhere && d->id[slot] < id) {
            id = d->id[slot];
            here = slot;
        }
    }
    MPI_Allreduce(&id, &first, 1, MPI_INT64_T, MPI_MIN, s->comm);
    int owner = id == first && id != INT64_MAX ? s->rank : 0, who;
    MPI_Allreduce(&owner, &who, 1, MPI_INT, MPI_MAX, s->comm);
    *f = s->rank == who && id == first ? look_at(s, here) : (finding){0};
    MPI_Bcast(f, (int)(sizeof *f / sizeof(double)), MPI_DOUBLE, who, s->comm);
    return first;
}

static const char *limited_by(const rg_solver *s) {
    return rg_step_limiter_acts(s)                       ? "the rate of opening"
           : s->stiffening_anywhere < RG_STIFFENING_FREE ? "the spectrum at rest"
                                                         : "the stiffening of the element";
}

static void write_json(const char *reason, const rg_solver *s, int64_t step, double time, rg_gid element,
                       const finding *f) {
    FILE *out = rg_open_in(s->input->output.dir, "autopsy.json");
    fputs("{\n", out);
    rg_json_text(out, "reason", reason);
    rg_json_integer(out, "step", step);
    rg_json_number(out, "time_s", time);
    rg_json_number(out, "dt_s", s->dt);
    rg_json_integer(out, "element", element);
    rg_json_number(out, "x_m", f->x[0]);
    rg_json_number(out, "y_m", f->x[1]);
    rg_json_number(out, "z_m", f->x[2]);
    rg_json_number(out, "volume_m3", f->volume);
    rg_json_number(out, "quality", f->quality);
    rg_json_number(out, "smallest_jacobian", f->jacobian);
    rg_json_number(out, "stiffening", f->stiffening);
    rg_json_number(out, "largest_displacement_m", f->displacement);
    rg_json_number(out, "largest_speed_m_s", f->speed);
    rg_json_number(out, "broken_faces", f->broken_faces);
    rg_json_text(out, "step_limited_by", limited_by(s));
    rg_json_integer(out, "spectrum_element", s->limiting);
    fprintf(out, "  \"spectrum_faces\": \"%s\"\n}\n", s->limiting_state);
    rg_close_in(out, s->input->output.dir, "autopsy.json");
}

void rg_autopsy_add(char *words, const rg_solver *s, int64_t step, double time, double good_time) {
    finding f;
    rg_gid element = find_worst(s, &f);
    if (s->rank == 0) {
        write_json(words, s, step, time, element, &f);
    }
    size_t used = strlen(words);
    snprintf(
        words + used, RG_FAILURE_WORDS - used,
        " at step %" PRId64 ", time %.6g s; dt %.4g s, limited by %s; worst: element %" PRId64
        " at (%.4g, %.4g, %.4g) m; its quality is %.2g, its smallest J %.3g, its stiffening %.3g, %g of its "
        "faces are broken; at rest element %" PRId64 " sets the time step; last good output at %.6g s",
        step, time, s->dt, limited_by(s), element, f.x[0], f.x[1], f.x[2], f.quality, f.jacobian,
        f.stiffening, f.broken_faces, s->limiting, good_time);
}
