/* Reference interface: DG terms where a point holds; where it breaks or has broken, one after the other,
 * criterion, law, contact and friction (kernels/README.md, sections 6 and 7). */
#include <math.h>
#include "cohesive/facts.h"
#include "reference/cohesive.h"
#include "reference/reference.h"

/* One quadrature point, gathered. */
typedef struct {
    double strength, opening, contact; /* of the law here; stiffness of closed points, area-weighted */
    double beta, friction;
    double held[3]; /* part of the traction that friction holds, by Mohr and Coulomb, area-weighted */
    double weight, shape[RG_FNODES];
    double area, iso, norm; /* reference area and the two penalty factors, area-weighted */
    double jump[3];
    double traction[3]; /* average of both sides, area-weighted */
    double dg[3];       /* traction plus penalty, area-weighted */
    double normal[3];   /* unit normal of the deformed mid-surface; zero in padding */
    double current;     /* deformed area */
    double tangent[2][3], by_xi[RG_FNODES],
        by_eta[RG_FNODES]; /* of the mid-surface; of the shape functions */
} point;

/* Opening of a broken point. */
typedef struct {
    double normal, shear[3]; /* normal opening (signed) and sliding */
    double effective;
} opening;

/* Crack state of a point, the memory of its law, and its friction. */
typedef struct {
    rg_real *state[RG_CRACK], *memory[RG_LAW_MEMORY], *friction[RG_FRICTION], *loan, *bond[RG_BOND],
        *rise[RG_RISE];
} crack;

/* Whether side k of interface i is what `side[0]` names: the minus side, or the own one of a tile-boundary
 * face. */
static bool is_first(const rg_interface_args *args, size_t i, int k) {
    bool plus_is_own = i / RG_LANES >= args->first_tile_face && args->side[1][i] % 2 == 1;
    return (k == 0) != plus_is_own;
}

static double element_value(const rg_interface_args *args, int32_t link, int a, int c) {
    return args->u[rg_node_index((size_t)link / 4, rg_face_node[link % 4][a], c)];
}

static double side_value(const rg_interface_args *args, size_t i, int side, int a, int c) {
    if (is_first(args, i, side))
        return element_value(args, args->side[0][i], a, c);
    if (i / RG_LANES >= args->first_tile_face)
        return args->ghost[rg_iforce_index(i - args->first_tile_face * RG_LANES, a, c)];
    return element_value(args, args->side[1][i], a, c);
}

static double side_traction(const rg_interface_args *args, size_t i, int side, int corner, int c) {
    size_t place = (size_t)(3 * corner + c);
    bool first = is_first(args, i, side);
    if (i / RG_LANES < args->first_tile_face)
        return args->traction[(size_t)args->side[first ? 0 : 1][i] * RG_TILE_FACE_ROW + place];
    if (first)
        return args->own_tractions[(i - args->first_tile_face * RG_LANES) * RG_TILE_FACE_ROW + place];
    return args->tractions[(size_t)(args->side[1][i] / 2) * RG_TILE_FACE_ROW + place];
}

/* Derivatives of the shape functions by xi and eta, l = (1 - xi - eta, xi, eta). */
static void shape_derivatives(const double l[3], double dxi[RG_FNODES], double deta[RG_FNODES]) {
    const double by_l[RG_FNODES][3] = {
        {4 * l[0] - 1, 0, 0},    {0, 4 * l[1] - 1, 0},    {0, 0, 4 * l[2] - 1},
        {4 * l[1], 4 * l[0], 0}, {0, 4 * l[2], 4 * l[1]}, {4 * l[2], 0, 4 * l[0]},
    };
    for (int a = 0; a < RG_FNODES; a++) {
        dxi[a] = by_l[a][1] - by_l[a][0];
        deta[a] = by_l[a][2] - by_l[a][0];
    }
}

static double edge(const rg_interface_args *args, size_t i, int k, int c) {
    return args->geom[rg_igeom_index(i, RG_IGEOM_EDGE + 3 * k + c)];
}

/* Normal and area of the deformed mid-surface. */
static void sample_surface(const rg_interface_args *args, size_t i, const double l[3], point *p) {
    shape_derivatives(l, p->by_xi, p->by_eta);
    for (int c = 0; c < 3; c++) {
        for (int k = 0; k < 2; k++)
            p->tangent[k][c] = edge(args, i, k, c);
        for (int a = 0; a < RG_FNODES; a++) {
            double mean = (side_value(args, i, 0, a, c) + side_value(args, i, 1, a, c)) / 2;
            p->tangent[0][c] += p->by_xi[a] * mean;
            p->tangent[1][c] += p->by_eta[a] * mean;
        }
    }
    rg_reference_cross(p->tangent[0], p->tangent[1], p->normal);
    double length = sqrt(rg_reference_dot(p->normal, p->normal));
    for (int c = 0; c < 3; c++)
        p->normal[c] = length > 0 ? p->normal[c] / length : 0;
    p->current = length / 2;
}

/* Parameters of the law on interface i. */
static void sample_law(const rg_interface_args *args, size_t i, point *p) {
    const rg_real *scale =
        args->scale == NULL ? NULL : args->scale + i / RG_LANES * 2 * RG_LANES + i % RG_LANES;
    p->strength = args->law.strength * (scale == NULL ? 1 : scale[0]);
    p->opening = args->law.opening * (scale == NULL ? 1 : scale[RG_LANES]);
    double slope = args->law.slope * (scale == NULL ? 1 : scale[0] / scale[RG_LANES]);
    p->contact = fmax(p->iso + p->norm, slope * p->area);
    p->beta = args->beta == NULL ? args->law.beta : args->beta[i];
    p->friction = args->friction == NULL ? args->law.friction : args->friction[i];
}

static void sample(const rg_interface_args *args, size_t i, int q, point *p) {
    double l[3], edges[2][3], cross[3];
    *p = (point){.weight = rg_reference_face_point(q, l)};
    for (int k = 0; k < 2; k++)
        for (int c = 0; c < 3; c++)
            edges[k][c] = edge(args, i, k, c);
    rg_reference_cross(edges[0], edges[1], cross);
    p->area = sqrt(rg_reference_dot(cross, cross)) / 2;
    p->iso = args->geom[rg_igeom_index(i, RG_IGEOM_PEN_ISO)];
    p->norm = args->geom[rg_igeom_index(i, RG_IGEOM_PEN_NORM)] * p->area * p->area;
    rg_reference_face_shape(l, p->shape);
    sample_law(args, i, p);
    for (int c = 0; c < 3; c++)
        for (int a = 0; a < RG_FNODES; a++)
            p->jump[c] += p->shape[a] * (side_value(args, i, 1, a, c) - side_value(args, i, 0, a, c));
    for (int c = 0; c < 3; c++) {
        double unit = p->area > 0 ? cross[c] / (2 * p->area) : 0;
        double across = p->area > 0 ? rg_reference_dot(cross, p->jump) / (2 * p->area) : 0;
        p->dg[c] = p->iso * p->jump[c] + p->norm * across * unit;
    }
    sample_surface(args, i, l, p);
}

/* Completes a point by the average traction. */
static void sample_traction(const rg_interface_args *args, size_t i, int q, point *p) {
    double l[3];
    rg_reference_face_point(q, l);
    for (int c = 0; c < 3; c++) {
        for (int k = 0; k < RG_FCORNERS; k++)
            p->traction[c] += l[k] * (side_traction(args, i, 0, k, c) - side_traction(args, i, 1, k, c)) / 2;
        p->dg[c] += p->traction[c];
    }
}

static crack crack_of(const rg_interface_args *args, size_t i, int q) {
    rg_real *block = args->crack + i / RG_LANES * args->crack_stride;
    int memory = rg_law_facts_of(args->law.law, args->law.shape, args->law.beta).memory;
    crack found = {{NULL}, {NULL}, {NULL}, NULL, {NULL}, {NULL}};
    for (int k = 0; k < RG_RISE && args->law.rise.rate > 0; k++)
        found.rise[k] = args->crack + rg_rise_index(&args->law, i, q, k, args->crack_stride);
    for (int b = 0; b < RG_BOND && args->law.shear == RG_SHEAR_FADING; b++)
        found.bond[b] =
            block + RG_CRACK_BLOCK + (size_t)(memory * RG_POINTS + q * RG_BOND + b) * RG_LANES + i % RG_LANES;
    if (args->law.criterion == RG_CRITERION_MOHR_COULOMB)
        found.loan = args->crack + rg_loan_index(i, q, args->crack_stride);
    for (int k = 0; k < RG_CRACK; k++)
        found.state[k] = block + rg_crack_index(i % RG_LANES, q, k);
    for (int m = 0; m < memory; m++)
        found.memory[m] = block + RG_CRACK_BLOCK + (size_t)(q * memory + m) * RG_LANES + i % RG_LANES;
    for (int k = 0; k < RG_FRICTION && args->law.sliding == RG_SLIDING_COULOMB; k++)
        found.friction[k] = args->crack + rg_friction_index(i, q, k, args->crack_stride);
    return found;
}

/* ---- 1. Criterion (5.3, 5.17), and the opening with which a point that breaks starts ---- */

/* Effective traction of an unbroken point, and the direction of its first opening if it breaks now; 0 below
 * half of the strength. */
static double effective_traction(const rg_cohesive *law, point *p, double direction[3]) {
    double beta2 = p->beta * p->beta, shear[3];
    double weight = p->beta > 0 ? fmax(1, 1 / beta2) : 1;
    double limit = p->strength * p->area;
    if (p->area == 0 || !isfinite(law->strength))
        return 0;
    if (!(rg_reference_dot(p->traction, p->traction) * weight > 0.25 * limit * limit))
        return 0;
    double across = rg_reference_dot(p->traction, p->normal) / p->current;
    double pull = fmax(0, across);
    for (int c = 0; c < 3; c++)
        shear[c] = p->traction[c] / p->current - across * p->normal[c];
    double sheared = sqrt(rg_reference_dot(shear, shear)), friction = p->friction * fmax(0, -across);
    for (int c = 0; c < 3 && law->criterion == RG_CRITERION_MOHR_COULOMB && sheared > 0; c++) {
        p->held[c] = p->current * shear[c] * fmin(1, friction / sheared);
        shear[c] -= p->held[c] / p->current;
    }
    double effective = pull;
    if (p->beta > 0)
        effective = sqrt(pull * pull + rg_reference_dot(shear, shear) / beta2);
    for (int c = 0; c < 3; c++)
        direction[c] = p->beta > 0 ? (shear[c] / beta2 + pull * p->normal[c]) / effective : p->normal[c];
    return effective;
}

/* Strength of a point whose effective traction is not 0, by its mean rate since half of the strength. */
static void raise_strength(const rg_interface_args *args, size_t i, point *p, const crack *k,
                           double effective) {
    const rg_rise *rise = &args->law.rise;
    double step = args->step, exponent = args->rise == NULL ? rise->exponent : args->rise[i];
    bool anew = *k->rise[RG_RISE_FACTOR] == 0 || args->time - *k->rise[RG_RISE_LAST] > 1.5 * step;
    if (anew) {
        *k->rise[RG_RISE_STRESS] = (rg_real)(step > 0 ? fmin(effective, p->strength / 2) : effective);
        *k->rise[RG_RISE_SPAN] = (rg_real)step;
    } else if ((rg_real)args->time > *k->rise[RG_RISE_LAST])
        *k->rise[RG_RISE_SPAN] += (rg_real)step;
    double span = *k->rise[RG_RISE_SPAN];
    double rate = span > 0 ? fmax(0, effective - *k->rise[RG_RISE_STRESS]) / span : 0;
    *k->rise[RG_RISE_LAST] = (rg_real)args->time;
    *k->rise[RG_RISE_FACTOR] = (rg_real)fmin(rise->most, pow(fmax(1, rate / rise->rate), exponent));
}

/* The law at a point by the factor of its strength. */
static void apply_rise(const rg_interface_args *args, point *p, const crack *k) {
    if (!(args->law.rise.rate > 0))
        return;
    double factor = fmax(1, *k->rise[RG_RISE_FACTOR]);
    p->strength *= factor;
    p->opening /= factor;
}

/* Opening from which a point that switches starts (m). */
static double onset(const rg_cohesive *law, const point *p) {
    double share[] = {[RG_ACTIVATION_CONTINUOUS] = RG_ONSET,
                      [RG_ACTIVATION_TOTAL] = 0,
                      [RG_ACTIVATION_CONSERVING] =
                          law->onset * fmax(1, p->beta * p->beta) / fmax(1, law->beta * law->beta)};
    return share[law->activation] * p->strength * p->area / (p->iso + p->norm);
}

/* That of a point which has switched: one that owes more than the common onset holds has a longer one. */
static double point_onset(const rg_cohesive *law, const point *p, const crack *k) {
    double common = onset(law, p);
    return law->activation == RG_ACTIVATION_CONSERVING ? fmax(common, -2 * *k->state[RG_CRACK_GIVEN])
                                                       : common;
}

/* What comes free at a point that switches, over its area and strength (m): what lift and penalty held by the
 * jump, less what contact holds from now on, which goes on with the pressure. */
static double given_free(const rg_cohesive *law, const point *p, double pressed) {
    double free = -p->contact * pressed * pressed / 2;
    for (int c = 0; c < 3; c++) {
        double penalty = p->dg[c] - p->traction[c];
        free += (p->traction[c] + fmax(0, 1 - 1.5 / law->beta_s) * penalty / 2) * p->jump[c];
    }
    return free / (p->area * p->strength);
}

static bool is_mixed(const rg_cohesive *law) {
    return (rg_law_facts_of(law->law, law->shape, law->beta).forms & RG_MIXED) != 0;
}

/* Critical opening of a point that has switched, or switches now. */
static double critical_opening(const rg_cohesive *law, const point *p, const crack *k) {
    return p->opening * (is_mixed(law) ? 1 + *k->memory[0] : 1);
}

/* Whether the shear traction of a point goes on in a spring that fades. */
static bool fades(const rg_cohesive *law, const point *p) {
    return law->shear == RG_SHEAR_FADING && !(p->beta > 0);
}

/* What of given_free comes of shear (J). */
static double given_by_shear(const rg_cohesive *law, const point *p) {
    double free = 0, across = rg_reference_dot(p->jump, p->normal), share = fmax(0, 1 - 1.5 / law->beta_s);
    for (int c = 0; c < 3; c++) {
        double slid = p->jump[c] - across * p->normal[c];
        free += (p->traction[c] + share * p->iso * slid / 2) * slid;
    }
    return free;
}

/* First crack state of a point. */
static void activate(const rg_interface_args *args, const point *p, const double direction[3],
                     const crack *k) {
    double start = onset(&args->law, p), first = start, pressed = 0;
    if (is_mixed(&args->law)) { /* what of the effective traction is not tension is shear */
        double open = rg_reference_dot(direction, p->normal);
        *k->memory[0] = (rg_real)rg_reference_excess(args->law.shape, fmax(0, 1 - open * open));
    }
    double end = critical_opening(&args->law, p, k);
    if (args->law.activation == RG_ACTIVATION_CONSERVING) {
        pressed = fmin(0, rg_reference_dot(p->traction, p->normal)) / p->contact;
        bool lends = args->law.criterion == RG_CRITERION_MOHR_COULOMB;
        double given = given_free(&args->law, p, lends ? 0 : pressed);
        if (fades(&args->law, p)) {
            double sheared = fmax(0, given_by_shear(&args->law, p));
            *k->bond[RG_BOND_GIVEN] = (rg_real)sheared;
            given -= sheared / (p->area * p->strength);
        }
        if (lends)
            *k->loan =
                (rg_real)((p->contact * pressed * pressed + rg_reference_dot(p->held, p->held) / p->iso) / 2);
        double left = sqrt(fmax(0, 1 - 2 * fmax(0, given) / end)); /* of the strength */
        first = fmax(RG_REFERENCE_NOTHING, end * (1 - left));
        double eps = fmax(start, -2 * given);
        start = given > 0 ? eps + first : eps * sqrt(fmax(0, 1 + 2 * given / eps));
        *k->state[RG_CRACK_GIVEN] = (rg_real)given;
    }
    *k->state[RG_CRACK_OPENING] = (rg_real)first;
    bool total = args->law.activation == RG_ACTIVATION_TOTAL;
    for (int c = 0; c < 3; c++)
        *k->state[RG_CRACK_ORIGIN + c] =
            total ? 0 : (rg_real)(p->jump[c] - start * direction[c] - pressed * p->normal[c]);
    *k->state[RG_CRACK_TIME] = (rg_real)args->time;
}

/* w_n, w_t and delta of (3.16). */
static opening measure(const point *p, const crack *k) {
    opening o = {0};
    double w[3];
    for (int c = 0; c < 3; c++)
        w[c] = p->jump[c] - *k->state[RG_CRACK_ORIGIN + c];
    o.normal = rg_reference_dot(w, p->normal);
    for (int c = 0; c < 3; c++)
        o.shear[c] = w[c] - o.normal * p->normal[c];
    double open = fmax(0, o.normal);
    o.effective = sqrt(p->beta * p->beta * rg_reference_dot(o.shear, o.shear) + open * open);
    return o;
}

/* ---- 2. Law ---- */

/* Asks the law; `before` is the largest opening before this state, `advance` whether its memory moves on. */
static rg_law_answer ask(const rg_interface_args *args, const point *p, const opening *o, const crack *k,
                         double before, bool advance) {
    const rg_cohesive *law = &args->law;
    rg_law_query query = {p->strength,
                          p->opening,
                          law->shape,
                          p->beta,
                          args->step,
                          o->normal,
                          sqrt(rg_reference_dot(o->shear, o->shear)),
                          o->effective,
                          before,
                          0};
    int memory = rg_law_facts_of(law->law, law->shape, law->beta).memory;
    double state[1 + RG_LAW_MEMORY] = {*k->state[RG_CRACK_OPENING]};
    for (int m = 0; m < memory; m++)
        state[1 + m] = *k->memory[m];
    bool conserving = law->activation == RG_ACTIVATION_CONSERVING;
    rg_law_answer answer = conserving
                               ? rg_reference_conserving(law->law, &query, point_onset(law, p, k), state)
                               : rg_reference_law(law->law, &query, state);
    for (int m = 0; m < memory && advance; m++)
        *k->memory[m] = (rg_real)state[1 + m];
    return answer;
}

/* Traction of the law, as t = along n + over w_t, area-weighted. */
typedef struct {
    double along, over;
} traction;

/* That of the law at opening o (3.19); keeps the largest opening. */
static traction cohesive_traction(const rg_interface_args *args, const point *p, const opening *o,
                                  const crack *k) {
    const rg_cohesive *law = &args->law;
    double start =
        law->activation == RG_ACTIVATION_CONSERVING ? point_onset(law, p, k) : 0; /* counts as no damage */
    double before = *k->state[RG_CRACK_OPENING], largest = fmax(before, o->effective - start);
    double parts = p->opening * (law->separation / law->opening);
    *k->state[RG_CRACK_OPENING] = (rg_real)largest;
    if (law->form == RG_FORM_INTRINSIC && before < parts && largest >= parts)
        *k->state[RG_CRACK_TIME] = (rg_real)args->time;
    rg_law_answer a = ask(args, p, o, k, before, true);
    double sliding = sqrt(rg_reference_dot(o->shear, o->shear));
    return (traction){p->area * a.normal, sliding > 0 ? p->area * a.sliding / sliding : 0};
}

/* ---- 3. Contact ---- */

/* Whether contact acts at opening o: where it is closed; its linear part, anywhere. Contact `flux` is the DG
 * terms instead. */
static bool touches(const rg_cohesive *law, const opening *o) {
    switch (law->contact) {
    case RG_CONTACT_PENALTY:
    case RG_CONTACT_POTENTIAL:
        return o->normal < 0;
    case RG_CONTACT_LINEAR:
        return true;
    case RG_CONTACT_FLUX:
        break;
    }
    return false;
}

/* How much of a face still faces the other one. */
static double facing(const point *p, const opening *o) {
    double apart = rg_reference_dot(o->shear, o->shear) + 16 * o->normal * o->normal;
    double left = fmax(0, 1 - apart / p->area);
    return left * left;
}

/* Adds -dE/dx/2 of the mid-surface's nodes x for a potential whose gradient is t with respect to the opening
 * w: E depends on the normal n too, by dE/dn = (t . n - T w_n) w_t, where t = ... n + T w_t, and n = g/|g|
 * with g = g1 x g2 turns by dn = (I - n n)(dg1 x g2 + g1 x dg2)/|g|. */
static void turn(const point *p, const opening *o, double across, double sliding, double f[RG_FNODES][3]) {
    double factor = p->weight * (across - sliding * o->normal) / (2 * p->current);
    for (int a = 0; a < RG_FNODES; a++)
        for (int c = 0; c < 3; c++) {
            double unit[3] = {c == 0, c == 1, c == 2}, first[3], second[3];
            rg_reference_cross(unit, p->tangent[1], first);
            rg_reference_cross(p->tangent[0], unit, second);
            f[a][c] -= factor / 2 *
                       (p->by_xi[a] * rg_reference_dot(o->shear, first) +
                        p->by_eta[a] * rg_reference_dot(o->shear, second));
        }
}

/* Adds contact, and the turn of the normal under contact as a potential. */
static void add_contact(const rg_interface_args *args, const point *p, const opening *o, traction *t,
                        double turning[RG_FNODES][3]) {
    bool potential = args->law.contact == RG_CONTACT_POTENTIAL;
    if (touches(&args->law, o))
        t->along += p->contact * o->normal * (potential ? facing(p, o) : 1);
    if (touches(&args->law, o) && potential) {
        double apart = -2 * p->contact * o->normal * o->normal * sqrt(facing(p, o)) / p->area;
        t->along += 16 * apart * o->normal;
        t->over += apart;
    }
    if (potential)
        turn(p, o, t->along, t->over, turning);
}

/* ---- 4. Friction ---- */

/* Chord of the mid-surface from corner 0 to 1. */
static void sample_chord(const rg_interface_args *args, size_t i, double chord[3]) {
    for (int c = 0; c < 3; c++) {
        double first = (side_value(args, i, 0, 0, c) + side_value(args, i, 1, 0, c)) / 2;
        double second = (side_value(args, i, 0, 1, c) + side_value(args, i, 1, 1, c)) / 2;
        chord[c] = edge(args, i, 0, c) + second - first;
    }
}

/* Unit tangents of the deformed mid-surface: along the chord, and across it. */
static void sample_tangents(const double chord[3], const point *p, double tangent[2][3]) {
    rg_reference_cross(p->normal, chord, tangent[1]);
    double length = sqrt(rg_reference_dot(tangent[1], tangent[1]));
    for (int c = 0; c < 3; c++)
        tangent[1][c] = length > 0 ? tangent[1][c] / length : 0;
    rg_reference_cross(tangent[1], p->normal, tangent[0]);
}

/* Pressure of contact at opening o, area-weighted. */
static double pressure_of(const rg_cohesive *law, const point *p, const opening *o) {
    double depth = fmax(0, -o->normal), root = sqrt(facing(p, o));
    double share = law->contact == RG_CONTACT_POTENTIAL ? root * (root - 32 * depth * depth / p->area) : 1;
    return p->contact * depth * fmax(0, share);
}

/* m <- (I - u u)(a x b + c x d)/length */
static void turned(const double u[3], const double a[3], const double b[3], const double c[3],
                   const double d[3], double length, double m[3]) {
    double first[3], second[3];
    rg_reference_cross(a, b, first);
    rg_reference_cross(c, d, second);
    for (int k = 0; k < 3; k++)
        first[k] = (first[k] + second[k]) / length;
    double along = rg_reference_dot(u, first);
    for (int k = 0; k < 3; k++)
        m[k] = first[k] - along * u[k];
}

/* Adds -sum drag_k w . da_k/dx/2 of the mid-surface's nodes x for each of them in each direction: n = g/|g|,
 * a_1 = (n x c)/|n x c|, a_0 = a_1 x n with the chord c. */
static void turn_frame(const point *p, const opening *o, const double chord[3], double tangent[2][3],
                       const double drag[2], double f[RG_FNODES][3]) {
    double across[3], w[3];
    rg_reference_cross(p->normal, chord, across);
    double length = sqrt(rg_reference_dot(across, across));
    if (!(p->area > 0))
        return;
    for (int c = 0; c < 3; c++)
        w[c] = o->shear[c] + o->normal * p->normal[c];
    for (int a = 0; a < RG_FNODES; a++)
        for (int c = 0; c < 3; c++) {
            double g1[3] = {0}, g2[3] = {0}, dc[3] = {0}, dn[3], first[3], left[3], right[3], sum = 0;
            g1[c] = p->by_xi[a];
            g2[c] = p->by_eta[a];
            dc[c] = a == 0 ? -1 : a == 1 ? 1 : 0;
            turned(p->normal, g1, p->tangent[1], p->tangent[0], g2, 2 * p->current, dn);
            turned(tangent[1], dn, chord, p->normal, dc, length, first);
            rg_reference_cross(first, p->normal, left);
            rg_reference_cross(tangent[1], dn, right);
            for (int k = 0; k < 3; k++)
                sum += w[k] * (drag[0] * (left[k] + right[k]) + drag[1] * first[k]);
            f[a][c] -= p->weight / 2 * sum;
        }
}

/* Adds friction: a spring of the tangential penalty from an anchor, which slips where the spring would pull
 * with more than mu times damage times pressure. */
static void add_coulomb(const rg_interface_args *args, size_t i, const point *p, const opening *o,
                        const crack *k, bool fresh, double t[3], double turning[RG_FNODES][3]) {
    const rg_cohesive *law = &args->law;
    double chord[3], tangent[2][3], slip[2], spring[2], drag[2], slid = 0;
    sample_chord(args, i, chord);
    sample_tangents(chord, p, tangent);
    double parts = critical_opening(law, p, k) * (law->separation / law->opening);
    double damage = parts > 0 ? fmin(1, *k->state[RG_CRACK_OPENING] / parts) : 1;
    bool all = law->criterion == RG_CRITERION_MOHR_COULOMB;
    damage = all ? 1 : damage;
    double limit = (fresh && !all) || o->normal >= 0 ? 0 : p->friction * damage * pressure_of(law, p, o);
    for (int d = 0; d < 2; d++) {
        slip[d] = rg_reference_dot(o->shear, tangent[d]);
        if (fresh && all) {
            *k->friction[RG_FRICTION_STRETCH + d] = (rg_real)(rg_reference_dot(p->held, tangent[d]) / p->iso);
            *k->friction[RG_FRICTION_ANCHOR + d] = (rg_real)(slip[d] - *k->friction[RG_FRICTION_STRETCH + d]);
        }
        spring[d] = p->iso * (slip[d] - *k->friction[RG_FRICTION_ANCHOR + d]);
    }
    double force = hypot(spring[0], spring[1]), part = force > limit ? limit / force : 1;
    for (int d = 0; d < 2; d++) {
        double before = p->iso * *k->friction[RG_FRICTION_STRETCH + d], now = drag[d] = part * spring[d];
        double stretch = p->iso > 0 ? now / p->iso : 0, moved = (spring[d] - now) / (p->iso > 0 ? p->iso : 1);
        slid += (before + now) / 2 * moved;
        *k->friction[RG_FRICTION_STRETCH + d] = (rg_real)stretch;
        *k->friction[RG_FRICTION_ANCHOR + d] = (rg_real)(slip[d] - stretch);
        for (int c = 0; c < 3; c++)
            t[c] += now * tangent[d][c];
    }
    *k->friction[RG_FRICTION_HEAT] += (rg_real)(p->weight * fmax(0, slid));
    if (law->contact == RG_CONTACT_POTENTIAL)
        turn_frame(p, o, chord, tangent, drag, turning);
}

/* Adds the spring that goes on with the shear traction of the switch and fades with damage. */
static void add_bond(const rg_interface_args *args, size_t i, const point *p, const opening *o,
                     const crack *k, bool fresh, double t[3], double turning[RG_FNODES][3]) {
    const rg_cohesive *law = &args->law;
    double chord[3], tangent[2][3], drag[2], product = 0, square = 0;
    sample_chord(args, i, chord);
    sample_tangents(chord, p, tangent);
    double parts = critical_opening(law, p, k) * (law->separation / law->opening);
    double damage = parts > 0 ? fmin(1, *k->state[RG_CRACK_OPENING] / parts) : 1;
    for (int d = 0; d < 2; d++) {
        double slip = rg_reference_dot(o->shear, tangent[d]);
        double held =
            (rg_reference_dot(p->traction, tangent[d]) - rg_reference_dot(p->held, tangent[d])) / p->iso;
        if (fresh) {
            *k->bond[RG_BOND_ANCHOR + d] = (rg_real)(slip - held);
            *k->bond[RG_BOND_STRETCH + d] = (rg_real)held;
            square += held * held;
        }
        double stretch = slip - *k->bond[RG_BOND_ANCHOR + d];
        product += *k->bond[RG_BOND_STRETCH + d] * stretch;
        *k->bond[RG_BOND_STRETCH + d] = (rg_real)stretch;
        drag[d] = (1 - damage) * p->iso * stretch;
        for (int c = 0; c < 3; c++)
            t[c] += drag[d] * tangent[d][c];
    }
    if (fresh) {
        *k->bond[RG_BOND_START] = (rg_real)square;
        *k->bond[RG_BOND_DAMAGE] = (rg_real)damage;
        *k->bond[RG_BOND_HEAT] = 0;
    }
    double worn = damage - *k->bond[RG_BOND_DAMAGE];
    *k->bond[RG_BOND_HEAT] += (rg_real)(p->iso * worn * (product - *k->bond[RG_BOND_START]) / 2);
    *k->bond[RG_BOND_DAMAGE] = (rg_real)damage;
    if (law->contact == RG_CONTACT_POTENTIAL)
        turn_frame(p, o, chord, tangent, drag, turning);
}

static void set_bit(uint8_t *mask, int q, bool on) {
    *mask = (uint8_t)(on ? *mask | 1 << q : *mask & ~(1 << q));
}

/* ---- The point ---- */

/* Traction of point q, area-weighted; advances its state. */
static void point_traction(const rg_interface_args *args, size_t i, int q, point *p, double t[3],
                           double turning[RG_FNODES][3]) {
    double direction[3] = {0, 0, 0};
    bool broken = args->broken[i] >> q & 1;
    for (int c = 0; c < 3; c++)
        t[c] = p->dg[c];
    double effective = broken ? 0 : effective_traction(&args->law, p, direction);
    if (!broken && !(effective > 0))
        return;
    crack k = crack_of(args, i, q);
    if (!broken && args->law.rise.rate > 0)
        raise_strength(args, i, p, &k, effective);
    apply_rise(args, p, &k);
    if (!broken && !(effective > p->strength))
        return;
    if (!broken) {
        activate(args, p, direction, &k);
        set_bit(&args->broken[i], q, true);
        args->active[i / RG_LANES] = 1;
    }
    opening o = measure(p, &k);
    bool closed = args->law.contact == RG_CONTACT_FLUX && o.normal < 0;
    if (!closed) {
        traction law = cohesive_traction(args, p, &o, &k);
        add_contact(args, p, &o, &law, turning);
        for (int c = 0; c < 3; c++)
            t[c] = law.over * o.shear[c] + law.along * p->normal[c];
    }
    if (args->law.sliding == RG_SLIDING_COULOMB)
        add_coulomb(args, i, p, &o, &k, !broken, t, turning);
    if (fades(&args->law, p))
        add_bond(args, i, p, &o, &k, !broken, t, turning);
    for (int c = 0; c < 3 && args->law.sliding == RG_SLIDING_STUCK; c++)
        t[c] += p->iso * o.shear[c];
    set_bit(&args->unlinked[i], q, !closed);
}

void rg_reference_interface(const rg_interface_args *args, size_t begin, size_t end) {
    for (size_t i = begin * RG_LANES; i < end * RG_LANES; i++) {
        double g[RG_FNODES][3] = {{0}}, turning[RG_FNODES][3] = {{0}};
        for (int q = 0; q < RG_POINTS; q++) {
            point p;
            double t[3];
            sample(args, i, q, &p);
            sample_traction(args, i, q, &p);
            point_traction(args, i, q, &p, t, turning);
            for (int a = 0; a < RG_FNODES; a++)
                for (int c = 0; c < 3; c++)
                    g[a][c] += p.weight * p.shape[a] * t[c];
        }
        for (int a = 0; a < RG_FNODES; a++)
            for (int c = 0; c < 3; c++) {
                args->force[rg_iforce_index(i, a, c)] = (rg_real)g[a][c];
                if (args->law.contact == RG_CONTACT_POTENTIAL && args->broken[i] != 0)
                    args->turn[rg_iforce_index(i, a, c)] = (rg_real)turning[a][c];
            }
    }
}

/* Adds the energies of point q. */
static void point_energy(const rg_interface_args *args, size_t i, int q, double energy[RG_E_INTERFACE]) {
    const rg_cohesive *law = &args->law;
    bool broken = args->broken[i] >> q & 1, unlinked = args->unlinked[i] >> q & 1;
    point p;
    sample(args, i, q, &p); /* without the traction dg is the penalty alone */
    if (!unlinked)
        energy[RG_E_PENALTY] += p.weight * rg_reference_dot(p.dg, p.jump) / 2;
    if (!broken)
        return;
    crack k = crack_of(args, i, q);
    apply_rise(args, &p, &k);
    opening o = measure(&p, &k);
    rg_law_answer a = ask(args, &p, &o, &k, *k.state[RG_CRACK_OPENING], false);
    if (unlinked)
        energy[RG_E_COHESIVE] += p.weight * p.area * a.stored;
    if (touches(law, &o)) {
        double share = law->contact == RG_CONTACT_POTENTIAL ? facing(&p, &o) : 1;
        energy[RG_E_CONTACT] += p.weight * p.contact * o.normal * o.normal / 2 * share;
    }
    for (int d = 0; d < 2 && law->sliding == RG_SLIDING_COULOMB; d++) {
        double stretch = *k.friction[RG_FRICTION_STRETCH + d];
        energy[RG_E_CONTACT] += p.weight * p.iso * stretch * stretch / 2;
    }
    energy[RG_E_DISSIPATED] += p.weight * p.area * a.dissipated;
    if (law->activation == RG_ACTIVATION_CONSERVING) {
        double given = *k.state[RG_CRACK_GIVEN], taken = critical_opening(law, &p, &k) / 2;
        bool workless = (rg_law_facts_of(law->law, law->shape, law->beta).forms & RG_WORKLESS) != 0;
        energy[RG_E_UNRESOLVED] +=
            p.weight * p.area * p.strength * (workless ? given : fmax(0, given - taken));
    }
    if (fades(law, &p)) {
        double x = *k.bond[RG_BOND_STRETCH], y = *k.bond[RG_BOND_STRETCH + 1];
        double more = x * x + y * y - *k.bond[RG_BOND_START];
        energy[RG_E_COHESIVE] += p.weight * p.iso * (1 - *k.bond[RG_BOND_DAMAGE]) * more / 2;
        energy[RG_E_DISSIPATED] += p.weight * *k.bond[RG_BOND_HEAT];
        energy[RG_E_UNRESOLVED] += p.weight * *k.bond[RG_BOND_GIVEN];
    }
    if (law->criterion == RG_CRITERION_MOHR_COULOMB)
        energy[RG_E_UNRESOLVED] -= p.weight * *k.loan;
}

void rg_reference_interface_state(const rg_interface_state_args *args, size_t begin, size_t end) {
    for (size_t i = begin * RG_LANES; i < end * RG_LANES; i++) {
        double energy[RG_E_INTERFACE] = {0};
        size_t row = i / RG_LANES - begin;
        for (int q = 0; q < RG_POINTS; q++)
            point_energy(args->interface, i, q, energy);
        for (size_t k = 0; k < RG_E_INTERFACE; k++)
            args->energy[(row * RG_E_INTERFACE + k) * RG_LANES + i % RG_LANES] = energy[k];
    }
}
