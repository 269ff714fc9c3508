/* Reference bulk: tet10, at F plus the lifted jumps R (Ten Eyck & Lew 2006). */
#include <math.h>
#include <string.h>
#include "reference/material.h"
#include "reference/reference.h"
#include "stressed.h"

/* One element, gathered. */
typedef struct {
    double grad[4][3]; /* of the barycentric coordinates */
    double volume;
    double u[RG_NODES][3];
    double jump[RG_FACES][RG_POINTS][3]; /* other side minus own; 0 where the point is out of the lift */
} element;

/* Ends of node a's edge; both ends are the corner itself for a corner. */
static void node_ends(int a, int *i, int *j) {
    for (*i = 0; *i < 4; ++*i)
        for (*j = *i; *j < 4; ++*j)
            if (rg_edge_node[*i][*j] == a)
                return;
}

/* Coordinates of the quadrature points: b on the diagonal, a elsewhere. */
static double gauss_coordinate(int g, int corner) {
    double root = sqrt(5);
    return g == corner ? (5 + 3 * root) / 20 : (5 - root) / 20;
}

/* Coefficient that extends values at the quadrature points linearly to a corner. */
static double extend(int corner, int g) {
    double a = (5 - sqrt(5)) / 20, b = (5 + 3 * sqrt(5)) / 20;
    return ((g == corner) - a) / (b - a);
}

/* Node a of the trace that a neighbour link names. */
static double neighbour_value(const rg_bulk_args *args, int32_t link, int a, int c) {
    size_t number = (size_t)link / 8;
    if (link % 8 == RG_GHOST)
        return args->ghost[rg_iforce_index(number, a, c)];
    return args->u[rg_node_index(number, rg_face_node[link % 8][a], c)];
}

static void load_jumps(const rg_bulk_args *args, size_t e, element *el) {
    for (int f = 0; f < RG_FACES; f++) {
        int32_t other = args->neighbour[rg_link_index(e, f)], here = args->interface[rg_link_index(e, f)];
        unsigned out = here < 0 ? 0 : args->unlinked[here / 4];
        for (int q = 0; q < RG_POINTS; q++) {
            double l[3], n[RG_FNODES];
            rg_reference_face_point(q, l);
            rg_reference_face_shape(l, n);
            if (out >> q & 1)
                continue;
            for (int a = 0; a < RG_FNODES; a++)
                for (int c = 0; c < 3; c++)
                    el->jump[f][q][c] +=
                        n[a] * (neighbour_value(args, other, a, c) - el->u[rg_face_node[f][a]][c]);
        }
    }
}

static void load(const rg_bulk_args *args, size_t e, element *el) {
    memset(el, 0, sizeof *el);
    el->volume = args->geom[rg_geom_index(e, RG_GEOM_VOLUME)];
    for (int k = 0; k < 3; k++)
        for (int c = 0; c < 3; c++) {
            el->grad[k][c] = args->geom[rg_geom_index(e, RG_GEOM_GRAD + 3 * k + c)];
            el->grad[3][c] -= el->grad[k][c];
        }
    for (int a = 0; a < RG_NODES; a++)
        for (int c = 0; c < 3; c++)
            el->u[a][c] = args->u[rg_node_index(e, a, c)];
    if (args->gradient == RG_GRADIENT_LIFTED)
        load_jumps(args, e, el);
}

/* Outward normal of face f times its area. */
static void area_normal(const element *el, int f, double an[3]) {
    for (int c = 0; c < 3; c++)
        an[c] = -3 * el->volume * el->grad[f][c];
}

/* Gradient of node a's shape function at quadrature point g. */
static void shape_gradient(const element *el, int a, int g, double dn[3]) {
    int i, j;
    node_ends(a, &i, &j);
    double li = gauss_coordinate(g, i), lj = gauss_coordinate(g, j);
    for (int c = 0; c < 3; c++)
        dn[c] = i == j ? (4 * li - 1) * el->grad[i][c] : 4 * (li * el->grad[j][c] + lj * el->grad[i][c]);
}

/* Adds R at quadrature point g. */
static void add_lift(const element *el, int g, double f[3][3]) {
    for (int face = 0; face < RG_FACES; face++) {
        double an[3];
        area_normal(el, face, an);
        for (int q = 0; q < RG_POINTS; q++) {
            double l[3], extended = 0;
            double weight = rg_reference_face_point(q, l);
            for (int i = 0; i < RG_FCORNERS; i++)
                extended += l[i] * extend(rg_face_node[face][i], g);
            for (int r = 0; r < 3; r++)
                for (int c = 0; c < 3; c++)
                    f[r][c] += 2 / el->volume * weight * extended * el->jump[face][q][r] * an[c];
        }
    }
}

/* F + R at quadrature point g. */
static void deformation(const element *el, int g, double f[3][3]) {
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
            f[r][c] = r == c;
    for (int a = 0; a < RG_NODES; a++) {
        double dn[3];
        shape_gradient(el, a, g, dn);
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 3; c++)
                f[r][c] += el->u[a][r] * dn[c];
    }
    add_lift(el, g, f);
}

static void add_force(const element *el, int g, double p[3][3], double force[RG_NODES][3]) {
    for (int a = 0; a < RG_NODES; a++) {
        double dn[3];
        shape_gradient(el, a, g, dn);
        for (int r = 0; r < 3; r++)
            force[a][r] -= el->volume / 4 * rg_reference_dot(p[r], dn);
    }
}

static void add_traction(const element *el, int g, double p[3][3],
                         double traction[RG_FACES][RG_FCORNERS][3]) {
    for (int f = 0; f < RG_FACES; f++) {
        double an[3];
        area_normal(el, f, an);
        for (int i = 0; i < RG_FCORNERS; i++)
            for (int r = 0; r < 3; r++)
                traction[f][i][r] += extend(rg_face_node[f][i], g) * rg_reference_dot(p[r], an);
    }
}

enum { MOST_HISTORY = 24 }; /* values per point */

static rg_reference_point_law *law_of(const rg_material *m) {
#define LAW(name, NAME, word, meaning, history, inside) [RG_MATERIAL_##NAME] = rg_reference_point_##name,
    static rg_reference_point_law *const laws[] = {RG_MATERIALS(LAW)};
    return laws[m->model];
}

/* Row `row` of the history of element e. */
static rg_real *past(const rg_bulk_args *args, size_t e, size_t row) {
    return &args->history[rg_history_index(e, args->history_stride, row)];
}

/* The material at point g of element e, at its history. */
static rg_reference_point material(const rg_bulk_args *args, bool advance, size_t e, int g, double f[3][3],
                                   double p[3][3]) {
    int n = rg_material_history(args->material.model);
    double history[MOST_HISTORY];
    rg_reference_point point = {0};
    for (int k = 0; k < n; k++)
        history[k] = *past(args, e, (size_t)(g * n + k));
    law_of (&args->material)(&args->material, advance, f, history, p, &point);
    for (int k = 0; advance && k < n; k++)
        *past(args, e, (size_t)(g * n + k)) = (rg_real)history[k];
    return point;
}

/* Value `row` of what heat does to element e. */
static rg_real *thermal(const rg_bulk_args *args, size_t e, int row) {
    return &args->thermal[e / RG_LANES * RG_THERMAL_BLOCK + (size_t)row * RG_LANES + e % RG_LANES];
}

/* The same of a solid with the rows of Q as axes: its deformation is F Q^T, and P the derivative by F. */
static rg_reference_point turned(const rg_bulk_args *args, bool advance, size_t e, int g, double f[3][3],
                                 double p[3][3]) {
    if (args->turn == NULL || args->material.model != RG_MATERIAL_ANISOTROPIC)
        return material(args, advance, e, g, f, p);
    double q[3][3], own[3][3] = {{0}}, stress[3][3];
    for (int k = 0; k < RG_TURN; k++)
        q[k / 3][k % 3] = args->turn[rg_turn_index(e, k)];
    for (int k = 0; k < 27; k++)
        own[k / 9][k / 3 % 3] += f[k / 9][k % 3] * q[k / 3 % 3][k % 3];
    rg_reference_point point = material(args, advance, e, g, own, stress);
    for (int k = 0; k < 9; k++)
        p[k / 3][k % 3] = 0;
    for (int k = 0; k < 27; k++)
        p[k / 9][k / 3 % 3] += stress[k / 9][k % 3] * q[k % 3][k / 3 % 3];
    return point;
}

/* The same of a solid that heat has expanded by s - 1: W(F/s); `step`: with the work of the expansion. */
static rg_reference_point heated(const rg_bulk_args *args, bool step, bool advance, size_t e, int g,
                                 double volume, double f[3][3], double p[3][3]) {
    if (args->thermal == NULL)
        return turned(args, advance, e, g, f, p);
    double s = 1 + *thermal(args, e, RG_THERMAL_EXPANSION + g), elastic[3][3], force = 0;
    for (int k = 0; k < 9; k++)
        elastic[k / 3][k % 3] = f[k / 3][k % 3] / s;
    rg_reference_point point = material(args, advance, e, g, elastic, p);
    for (int k = 0; k < 9; k++) {
        p[k / 3][k % 3] /= s;
        force -= p[k / 3][k % 3] * f[k / 3][k % 3] / s;
    }
    point.stiffening /= s * s;
    if (step) {
        rg_real *last = thermal(args, e, RG_THERMAL_LAST + g),
                *before = thermal(args, e, RG_THERMAL_FORCE + g);
        if (args->advance)
            *thermal(args, e, RG_THERMAL_WORK) +=
                (rg_real)(volume / 4 * (force + *before) / 2 * (s - 1 - *last));
        *last = *thermal(args, e, RG_THERMAL_EXPANSION + g);
        *before = (rg_real)force;
    }
    return point;
}

static void release(const rg_bulk_args *args, size_t e, double volume, const rg_reference_point *point) {
    int n = rg_material_history(args->material.model);
    for (int k = 0; n > 0 && args->advance && k < RG_RELEASED; k++)
        *past(args, e, (size_t)(RG_GAUSS * n + k)) += (rg_real)(volume / 4 * point->released[k]);
}

static void bulk_element(const rg_bulk_args *args, size_t e) {
    element el;
    double force[RG_NODES][3] = {{0}}, traction[RG_FACES][RG_FCORNERS][3] = {{{0}}}, worst = 0;
    load(args, e, &el);
    for (int g = 0; g < RG_GAUSS; g++) {
        double f[3][3], p[3][3];
        deformation(&el, g, f);
        rg_reference_point point = heated(args, true, args->advance, e, g, el.volume, f, p);
        release(args, e, el.volume, &point);
        add_force(&el, g, p, force);
        add_traction(&el, g, p, traction);
        worst = isnan(point.stiffening) || isnan(worst) ? NAN : fmax(worst, point.stiffening);
    }
    for (int a = 0; a < RG_NODES; a++)
        for (int c = 0; c < 3; c++)
            args->force[rg_node_index(e, a, c)] = (rg_real)force[a][c];
    for (int f = 0; f < RG_FACES; f++)
        for (int i = 0; i < RG_FCORNERS; i++)
            for (int c = 0; c < 3; c++)
                args->traction[rg_traction_index(e, f, i, c)] = (rg_real)traction[f][i][c];
    args->stiffening[e] = (rg_real)worst;
}

void rg_reference_bulk(const rg_bulk_args *args, size_t begin, size_t end) {
    for (size_t e = begin * RG_LANES; e < end * RG_LANES; e++)
        bulk_element(args, e);
}

/* Cauchy stress P F^T / J, six components. */
static void cauchy_stress(double p[3][3], double f[3][3], double s[6]) {
    static const int row[6] = {0, 1, 2, 1, 0, 0}, column[6] = {0, 1, 2, 2, 2, 1};
    double inv[3][3], det = rg_reference_invert(f, inv);
    for (int k = 0; k < 6; k++)
        s[k] = rg_reference_dot(p[row[k]], f[column[k]]) / det;
}

void rg_reference_bulk_state(const rg_bulk_state_args *args, size_t begin, size_t end) {
    for (size_t e = begin * RG_LANES; e < end * RG_LANES; e++) {
        element el;
        double energy = 0;
        size_t row = e / RG_LANES - begin;
        load(args->bulk, e, &el);
        for (int g = 0; g < RG_GAUSS; g++) {
            double f[3][3], p[3][3], s[6];
            size_t at = row * RG_GAUSS + (size_t)g;
            deformation(&el, g, f);
            rg_reference_point point = heated(args->bulk, false, false, e, g, el.volume, f, p);
            energy += el.volume / 4 * point.energy;
            cauchy_stress(p, f, s);
            for (size_t k = 0; args->cauchy && k < 6; k++)
                args->cauchy[(at * 6 + k) * RG_LANES + e % RG_LANES] = s[k];
            for (size_t k = 0; args->internal && k < RG_INTERNAL; k++)
                args->internal[(at * RG_INTERNAL + k) * RG_LANES + e % RG_LANES] = point.internal[k];
        }
        if (args->energy)
            args->energy[row * RG_LANES + e % RG_LANES] = energy;
    }
}

static double smallest_height(const element *el) {
    double largest = 0;
    for (int k = 0; k < 4; k++)
        largest = fmax(largest, sqrt(rg_reference_dot(el->grad[k], el->grad[k])));
    return 1 / largest;
}

static void viscous_element(const rg_viscosity_args *v, size_t e) {
    rg_bulk_args args = *v->bulk;
    element el, rate;
    double force[RG_NODES][3] = {{0}}, worst = 0;
    args.gradient = RG_GRADIENT_OWN;
    load(&args, e, &el);
    args.u = v->velocity;
    load(&args, e, &rate);
    double h = smallest_height(&el);
    for (int g = 0; g < RG_GAUSS; g++) {
        double f[3][3], f_rate[3][3], inv[3][3], p[3][3], closing = 0;
        deformation(&el, g, f);
        deformation(&rate, g, f_rate);
        double det = rg_reference_invert(f, inv);
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 3; c++)
                closing -= inv[c][r] * (f_rate[r][c] - (r == c));
        double squeeze = fmax(closing, 0);
        double pressure =
            args.material.density * h * (v->linear * closing + v->quadratic * h * squeeze * squeeze);
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 3; c++)
                p[r][c] = -pressure * det * inv[c][r];
        add_force(&el, g, p, force);
        v->heat[e] += v->dt * el.volume / 4 * det * pressure * closing;
        worst = fmax(worst, squeeze);
    }
    for (int a = 0; a < RG_NODES; a++)
        for (int c = 0; c < 3; c++)
            args.force[rg_node_index(e, a, c)] += (rg_real)force[a][c];
    double xi = v->damping + v->damping_rate * h * worst, factor = (sqrt(1 + xi * xi) + xi) * v->allowed;
    args.stiffening[e] *= (rg_real)(factor * factor);
}

void rg_reference_viscosity(const rg_viscosity_args *args, size_t begin, size_t end) {
    for (size_t e = begin * RG_LANES; e < end * RG_LANES; e++)
        viscous_element(args, e);
}

/* ---- Stress before any deformation ---- */

/* S0 at point g of element e, from six components. */
static void stress_before(const rg_real *stress, size_t e, int g, double s[3][3]) {
    static const int component[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}};
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
            s[r][c] = stress[e / RG_LANES * RG_PRESTRESS_BLOCK +
                             (size_t)(6 * g + component[r][c]) * RG_LANES + e % RG_LANES];
}

static void multiply(double a[3][3], double b[3][3], double out[3][3]) {
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            out[r][c] = 0;
            for (int k = 0; k < 3; k++)
                out[r][c] += a[r][k] * b[k][c];
        }
}

static double row_sum(double s[3][3]) {
    double most = 0;
    for (int r = 0; r < 3; r++)
        most = fmax(most, fabs(s[r][0]) + fabs(s[r][1]) + fabs(s[r][2]));
    return most;
}

static bool is_pressure(const rg_material *m) {
    return m->model == RG_MATERIAL_J2 || m->model == RG_MATERIAL_JOHNSON_COOK;
}

/* P0, and what it adds to the stiffness (Pa). */
static double piola_before(const rg_material *m, double f[3][3], double s[3][3], double p[3][3]) {
    if (!is_pressure(m)) {
        multiply(f, s, p);
        return row_sum(s);
    }
    double inv[3][3], turned[3][3], square[3][3];
    rg_reference_invert(f, inv);
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            turned[r][c] = inv[c][r];
            p[r][c] = s[0][0] * inv[c][r];
        }
    multiply(inv, turned, square);
    return fabs(s[0][0]) * row_sum(square);
}

void rg_reference_prestress(const rg_prestress_args *args, size_t begin, size_t end) {
    const rg_bulk_args *bulk = args->bulk;
    const rg_material *m = &bulk->material;
    double modulus = m->model == RG_MATERIAL_ANISOTROPIC ? m->of.anisotropic.softest : m->lambda + 2 * m->mu;
    for (size_t e = begin * RG_LANES; e < end * RG_LANES; e++) {
        element el;
        double force[RG_NODES][3] = {{0}}, traction[RG_FACES][RG_FCORNERS][3] = {{{0}}}, worst = 0;
        load(bulk, e, &el);
        for (int g = 0; g < RG_GAUSS; g++) {
            double f[3][3], s[3][3], p[3][3];
            deformation(&el, g, f);
            stress_before(args->stress, e, g, s);
            double stiff = piola_before(&bulk->material, f, s, p);
            add_force(&el, g, p, force);
            add_traction(&el, g, p, traction);
            worst = fmax(worst, stiff / modulus);
        }
        for (int a = 0; a < RG_NODES; a++)
            for (int c = 0; c < 3; c++)
                bulk->force[rg_node_index(e, a, c)] += (rg_real)force[a][c];
        for (int f = 0; f < RG_FACES; f++)
            for (int i = 0; i < RG_FCORNERS; i++)
                for (int c = 0; c < 3; c++)
                    bulk->traction[rg_traction_index(e, f, i, c)] += (rg_real)traction[f][i][c];
        bulk->stiffening[e] += (rg_real)worst;
    }
}

/* S0:C^-1:S0, of any stiffness. */
static double twice_stored(const rg_material *m, double s[3][3]) {
    static const int row[6] = {0, 1, 2, 1, 0, 0}, column[6] = {0, 1, 2, 2, 2, 1};
    double compliance[6][6], sum = 0;
    rg_material_compliance(m, compliance);
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++)
            sum += s[row[i]][column[i]] * compliance[i][j] * s[row[j]][column[j]];
    return sum;
}

/* S0:E, E = (F^T F - 1)/2, and S0:C^-1:S0/2, isotropic ((1 + nu) S0:S0 - nu (tr S0)^2)/(2 young); p log J and
 * p^2/2K. */
static double density_before(const rg_material *m, double f[3][3], double s[3][3]) {
    if (is_pressure(m)) {
        double inv[3][3], bulk = m->lambda + 2.0 / 3 * m->mu;
        return s[0][0] * log(rg_reference_invert(f, inv)) + s[0][0] * s[0][0] / (2 * bulk);
    }
    double nu = m->lambda / (2 * (m->lambda + m->mu)), young = 2 * m->mu * (1 + nu), work = 0, square = 0;
    double trace = s[0][0] + s[1][1] + s[2][2];
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            double strain = -0.5 * (r == c);
            for (int k = 0; k < 3; k++)
                strain += 0.5 * f[k][r] * f[k][c];
            work += s[r][c] * strain;
            square += s[r][c] * s[r][c];
        }
    bool elastic = m->model != RG_MATERIAL_ANISOTROPIC && m->model != RG_MATERIAL_VISCOELASTIC;
    return work + (elastic ? ((1 + nu) * square - nu * trace * trace) / (2 * young) : twice_stored(m, s) / 2);
}

void rg_reference_prestress_state(const rg_prestress_state_args *args, size_t begin, size_t end) {
    const rg_bulk_state_args *state = args->state;
    for (size_t e = begin * RG_LANES; e < end * RG_LANES; e++) {
        element el;
        size_t row = e / RG_LANES - begin;
        load(state->bulk, e, &el);
        for (int g = 0; g < RG_GAUSS; g++) {
            double f[3][3], s[3][3], p[3][3], cauchy[6];
            deformation(&el, g, f);
            stress_before(args->stress, e, g, s);
            piola_before(&state->bulk->material, f, s, p);
            cauchy_stress(p, f, cauchy);
            for (size_t k = 0; state->cauchy && k < 6; k++)
                state->cauchy[((row * RG_GAUSS + (size_t)g) * 6 + k) * RG_LANES + e % RG_LANES] += cauchy[k];
            if (state->energy)
                state->energy[row * RG_LANES + e % RG_LANES] +=
                    el.volume / 4 * density_before(&state->bulk->material, f, s);
        }
    }
}
