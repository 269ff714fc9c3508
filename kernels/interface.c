/* The 12-node interface kernel: DG traction, fracture, cohesive law and contact at the six points of a face.
 *
 * A face without damage costs only the DG terms and a bound on its traction; the normal of the deformed
 * mid-surface, the criterion and the cohesive law are computed, out of line, where a lane needs them. Lanes
 * that do not need them keep their bits: a face's result never depends on the faces that share its block. All
 * tractions are area-weighted: they carry the reference area of the face as a factor (N). */
#include "cohesive_linear.h"
#include "isa.h"
#include "tet10.h"

typedef rg_vec vec3[3];

/* A vector of interfaces at work. */
typedef struct {
    const rg_interface_args *args;
    size_t block;
    int lane;
    const double *geom;
    vec3 normal;
    rg_vec area, pen_iso, pen_norm;
    vec3 jump[RG_POINTS];  /* [u] */
    vec3 mean[RG_POINTS];  /* <P> N */
    vec3 total[RG_POINTS]; /* traction that acts */
} interface;

RG_INLINE rg_vec geometry(const interface *s, int k) {
    return rg_load(s->geom + k * RG_LANES);
}

RG_INLINE const int32_t *side(const interface *s, int k) {
    return s->args->side[k] + s->block * RG_LANES + s->lane;
}

RG_INLINE void load_interface(interface *s, const rg_interface_args *args, size_t block, int lane) {
    s->args = args;
    s->block = block;
    s->lane = lane;
    s->geom = args->geom + block * RG_IGEOM_BLOCK + lane;
    for (int c = 0; c < 3; c++) {
        s->normal[c] = geometry(s, RG_IGEOM_NORMAL + c);
    }
    s->area = geometry(s, RG_IGEOM_AREA);
    s->pen_iso = geometry(s, RG_IGEOM_PEN_ISO);
    s->pen_norm = geometry(s, RG_IGEOM_PEN_NORM);
}

RG_INLINE void jump_at_points(interface *s) {
    vec3 minus[RG_FNODES], plus[RG_FNODES];
    rg_gather_face(s->args->u, side(s, 0), minus);
    rg_gather_face(s->args->u, side(s, 1), plus);
    for (int a = 0; a < RG_FNODES; a++) {
        for (int c = 0; c < 3; c++) {
            plus[a][c] -= minus[a][c];
        }
    }
    rg_face_to_points(plus, s->jump);
}

/* <P> N at the points, from the corner tractions of both sides (each with its own outward normal). */
RG_INLINE void mean_traction(interface *s) {
    enum { ROW = RG_FCORNERS * 3 };
    rg_vec t[2][ROW];
    for (int k = 0; k < 2; k++) {
        rg_lanes at;
        for (int l = 0; l < RG_VLEN; l++) { /* a link is the number of a face: 4 * element + face */
            at.lane[l] = s->args->traction + (size_t)side(s, k)[l] * ROW;
        }
        rg_load_rows(&at, ROW, t[k]);
    }
    for (int i = 0; i < ROW; i++) {
        t[0][i] = 0.5 * (t[0][i] - t[1][i]);
    }
    for (int c = 0; c < 3; c++) {
        for (int q = 0; q < RG_POINTS; q++) {
            const rg_tri_rule *n = &rg_tri[q / 3];
            s->mean[q][c] =
                n->p * (t[0][c] + t[0][3 + c] + t[0][6 + c]) + (n->r - n->p) * t[0][3 * (q % 3) + c];
        }
    }
}

/* DG traction <P> N + (beta_s/h_s) <A> [u]. */
RG_INLINE void dg_traction(interface *s) {
    for (int q = 0; q < RG_POINTS; q++) {
        rg_vec normal_jump = s->pen_norm * rg_dot(s->normal, s->jump[q]);
        for (int c = 0; c < 3; c++) {
            s->total[q][c] = s->mean[q][c] + s->pen_iso * s->jump[q][c] + normal_jump * s->normal[c];
        }
    }
}

/* The Piola traction below which a point is not tested: half the strength, as an area-weighted square. */
RG_INLINE rg_vec test_bound(const interface *s) {
    double beta = s->args->law.beta, strength = s->args->law.strength;
    double reach = beta > 0 && beta < 1 ? 1 / (beta * beta) : 1;
    rg_vec half = (0.5 * strength) * s->area;
    return half * half / reach;
}

RG_INLINE bool any_to_test(const interface *s) {
    rg_vec bound = test_bound(s), largest = {0};
    for (int q = 0; q < RG_POINTS; q++) {
        largest = rg_max(rg_dot(s->mean[q], s->mean[q]), largest);
    }
    return rg_any(largest > bound);
}

/* Nodal forces sum_q w_q N_a(q) T_q. */
RG_INLINE void store_nodal_force(const interface *s) {
    double *force = s->args->force + s->block * RG_IFORCE_BLOCK + s->lane;
    for (int c = 0; c < 3; c++) {
        rg_vec corner[2], edge[2], sum[2];
        for (int k = 0; k < 2; k++) {
            sum[k] =
                rg_tri[k].weight * (s->total[3 * k][c] + s->total[3 * k + 1][c] + s->total[3 * k + 2][c]);
            corner[k] = rg_splat(rg_tri[k].weight * (rg_tri[k].corner - rg_tri[k].other));
            edge[k] = rg_splat(rg_tri[k].weight * (rg_tri[k].facing - rg_tri[k].adjacent));
        }
        rg_vec corners = rg_tri[0].other * sum[0] + rg_tri[1].other * sum[1];
        rg_vec edges = rg_tri[0].adjacent * sum[0] + rg_tri[1].adjacent * sum[1];
        for (int i = 0; i < 3; i++) {
            rg_store(force + (i * 3 + c) * RG_LANES,
                     corners + corner[0] * s->total[i][c] + corner[1] * s->total[3 + i][c]);
            rg_store(force + (rg_facing[i] * 3 + c) * RG_LANES,
                     edges + edge[0] * s->total[i][c] + edge[1] * s->total[3 + i][c]);
        }
    }
}

/* ---- Damaged faces ---- */

/* Derivatives of the six shape functions along xi and eta (l = 1 - xi - eta, xi, eta) at point q. */
RG_INLINE void face_derivatives(int q, double xi[RG_FNODES], double eta[RG_FNODES]) {
    double l[3];
    for (int i = 0; i < 3; i++) {
        l[i] = i == q % 3 ? rg_tri[q / 3].r : rg_tri[q / 3].p;
    }
    const double dxi[RG_FNODES] = {1 - 4 * l[0], 4 * l[1] - 1, 0, 4 * (l[0] - l[1]), 4 * l[2], -4 * l[2]};
    const double deta[RG_FNODES] = {1 - 4 * l[0], 0, 4 * l[2] - 1, -4 * l[1], 4 * l[1], 4 * (l[0] - l[2])};
    memcpy(xi, dxi, sizeof dxi);
    memcpy(eta, deta, sizeof deta);
}

/* Unit normals n of the deformed mid-surface at the points, and its area there (m^2). */
RG_INLINE void mid_surface(const interface *s, vec3 n[RG_POINTS], rg_vec area[RG_POINTS]) {
    vec3 minus[RG_FNODES], plus[RG_FNODES], edge[2], reference;
    rg_gather_face(s->args->u, side(s, 0), minus);
    rg_gather_face(s->args->u, side(s, 1), plus);
    for (int c = 0; c < 3; c++) {
        edge[0][c] = geometry(s, RG_IGEOM_EDGE + c);
        edge[1][c] = geometry(s, RG_IGEOM_EDGE + 3 + c);
    }
    rg_cross(edge[0], edge[1], reference);
    rg_vec sign = rg_select(rg_dot(reference, s->normal) < 0.0, rg_splat(-1.0), rg_splat(1.0));
    for (int q = 0; q < RG_POINTS; q++) {
        double xi[RG_FNODES], eta[RG_FNODES];
        face_derivatives(q, xi, eta);
        vec3 g1, g2;
        for (int c = 0; c < 3; c++) {
            g1[c] = edge[0][c];
            g2[c] = edge[1][c];
            for (int a = 0; a < RG_FNODES; a++) {
                rg_vec u = 0.5 * (minus[a][c] + plus[a][c]);
                g1[c] += xi[a] * u;
                g2[c] += eta[a] * u;
            }
        }
        rg_cross(g1, g2, n[q]);
        rg_vec twice = rg_sqrt(rg_dot(n[q], n[q]));
        area[q] = 0.5 * twice;
        for (int c = 0; c < 3; c++) {
            n[q][c] *= sign / rg_max(twice, rg_splat(1e-300)); /* padding has no area */
        }
    }
}

RG_INLINE rg_mask bit_mask(const uint8_t bits[RG_VLEN], int q) {
    rg_mask m;
    for (int l = 0; l < RG_VLEN; l++) {
        m[l] = -(int64_t)((bits[l] >> q) & 1);
    }
    return m;
}

RG_INLINE void set_bits(uint8_t bits[RG_VLEN], int q, rg_mask m) {
    for (int l = 0; l < RG_VLEN; l++) {
        bits[l] = (uint8_t)((bits[l] & ~(1 << q)) | ((m[l] & 1) << q));
    }
}

RG_INLINE double *crack_state(const interface *s, int q, int k) {
    return s->args->crack + s->block * s->args->crack_stride + (q * RG_CRACK + k) * RG_LANES + s->lane;
}

/* Writes x where m is set; where nothing is set nothing is touched (untouched pages cost no memory). */
RG_INLINE void store_where(double *p, rg_mask m, rg_vec x) {
    rg_store(p, rg_select(m, x, rg_load(p)));
}

/* Fracture criterion at unbroken points (5.3; beta = 0: 5.17), on the Cauchy traction: which lanes switch
 * now. The crack state starts so that the cohesive traction continues the one at the switch in direction and
 * size (Papoulia's time continuity): the opening is measured from `origin` = [u] - eps d, d along the
 * traction. */
RG_INLINE rg_mask switch_points(const interface *s, int q, const vec3 n, rg_vec area, rg_mask intact) {
    const rg_cohesive *law = &s->args->law;
    vec3 t, tau, d;
    for (int c = 0; c < 3; c++) {
        t[c] = s->mean[q][c] / rg_max(area, rg_splat(1e-300));
    }
    double shear = law->beta > 0 ? 1 / (law->beta * law->beta) : 0;
    rg_vec tn = rg_dot(t, n), tension = rg_max(tn, rg_splat(0.0));
    for (int c = 0; c < 3; c++) {
        tau[c] = t[c] - tn * n[c];
    }
    rg_vec effective = rg_sqrt(tension * tension + shear * rg_dot(tau, tau));
    rg_mask tested =
        (s->area > 0.0) & (rg_dot(s->mean[q], s->mean[q]) > test_bound(s)); /* padding has no area */
    rg_mask now = intact & tested & (effective > law->strength);
    if (!rg_any(now)) {
        return now;
    }
    rg_vec eps = (law->total ? 0.0 : RG_ONSET * law->strength) * s->area / (s->pen_iso + s->pen_norm);
    for (int c = 0; c < 3; c++) {
        d[c] = (shear * tau[c] + tension * n[c]) / effective;
        rg_vec origin = law->total ? rg_splat(0.0) : s->jump[q][c] - eps * d[c];
        store_where(crack_state(s, q, RG_CRACK_ORIGIN + c), now, origin);
    }
    store_where(crack_state(s, q, RG_CRACK_OPENING), now, eps);
    store_where(crack_state(s, q, RG_CRACK_TIME), now, rg_splat(s->args->time));
    return now;
}

/* Opening of a broken point: w = [u] - origin, split along n. */
typedef struct {
    vec3 tangential;
    rg_vec normal, effective;
} opening;

RG_INLINE void crack_opening(const interface *s, int q, const vec3 n, opening *o) {
    vec3 w;
    for (int c = 0; c < 3; c++) {
        w[c] = s->jump[q][c] - rg_load(crack_state(s, q, RG_CRACK_ORIGIN + c));
    }
    o->normal = rg_dot(w, n);
    for (int c = 0; c < 3; c++) {
        o->tangential[c] = w[c] - o->normal * n[c];
    }
    double beta2 = s->args->law.beta * s->args->law.beta;
    rg_vec open = rg_max(o->normal, rg_splat(0.0));
    o->effective = rg_sqrt(beta2 * rg_dot(o->tangential, o->tangential) + open * open);
}

/* Replaces the DG traction at broken points by the cohesive law and contact. Returns the points that keep
 * their DG terms because they are closed under flux contact. */
RG_INLINE rg_mask broken_traction(interface *s, int q, const vec3 n, rg_mask broken) {
    const rg_cohesive *law = &s->args->law;
    opening o;
    crack_opening(s, q, n, &o);
    rg_mask closed = (law->flux ? broken : (rg_mask){0}) & (o.normal < 0.0);
    rg_mask acting = broken & ~closed;
    rg_vec before = rg_load(crack_state(s, q, RG_CRACK_OPENING));
    rg_mask grows = acting & (o.effective > before);
    rg_vec delta_max = rg_select(grows, o.effective, before);
    if (rg_any(grows)) {
        rg_store(crack_state(s, q, RG_CRACK_OPENING), delta_max);
    }
    rg_vec secant = s->area * rg_cohesive_secant(law, delta_max);
    rg_vec touching = rg_select(o.normal < law->contact_below, o.normal, rg_splat(0.0));
    rg_vec along = secant * rg_max(o.normal, rg_splat(0.0)) +
                   (law->flux ? 0.0 : 1.0) * (s->pen_iso + s->pen_norm) * touching;
    double beta2 = law->beta * law->beta;
    for (int c = 0; c < 3; c++) {
        rg_vec t = secant * (beta2 * o.tangential[c]) + along * n[c];
        s->total[q][c] = rg_select(acting, t, s->total[q][c]);
    }
    return closed;
}

static __attribute__((noinline)) void damaged(interface *s) {
    const rg_interface_args *args = s->args;
    size_t first = s->block * RG_LANES + (size_t)s->lane;
    vec3 n[RG_POINTS];
    rg_vec area[RG_POINTS];
    mid_surface(s, n, area);
    uint8_t broken[RG_VLEN], unlinked[RG_VLEN] = {0}, any = 0;
    memcpy(broken, args->broken + first, sizeof broken);
    for (int q = 0; q < RG_POINTS; q++) {
        rg_mask cracked = bit_mask(broken, q);
        cracked |= switch_points(s, q, n[q], area[q], ~cracked);
        set_bits(broken, q, cracked);
        rg_mask closed = {0};
        if (rg_any(cracked)) {
            closed = broken_traction(s, q, n[q], cracked);
        }
        set_bits(unlinked, q, cracked & ~closed);
    }
    memcpy(args->broken + first, broken, sizeof broken);
    memcpy(args->unlinked + first, unlinked, sizeof unlinked);
    for (int l = 0; l < RG_VLEN; l++) {
        any |= broken[l];
    }
    if (any) {
        args->active[s->block] = 1;
    }
}

void RG_ISA_NAME(rg_interface)(const rg_interface_args *args, size_t begin, size_t end) {
    for (size_t b = begin; b < end; b++) {
        for (int lane = 0; lane < RG_LANES; lane += RG_VLEN) {
            interface s;
            load_interface(&s, args, b, lane);
            jump_at_points(&s);
            mean_traction(&s);
            dg_traction(&s);
            if (args->active[b] || any_to_test(&s)) {
                damaged(&s);
            }
            store_nodal_force(&s);
        }
    }
}

/* ---- Energies ---- */

RG_INLINE void broken_energy(const interface *s, int q, const vec3 n, rg_mask broken, rg_mask unlinked,
                             rg_vec sum[RG_E_INTERFACE]) {
    const rg_cohesive *law = &s->args->law;
    opening o;
    crack_opening(s, q, n, &o);
    rg_vec zero = {0}, weight = rg_splat(rg_tri[q / 3].weight);
    rg_vec delta_max = rg_load(crack_state(s, q, RG_CRACK_OPENING));
    rg_vec stored = 0.5 * s->area * rg_cohesive_secant(law, delta_max) * o.effective * o.effective;
    rg_vec contact = 0.5 * (s->pen_iso + s->pen_norm) * o.normal * o.normal;
    rg_mask touching = law->flux ? (rg_mask){0} : broken & (o.normal < law->contact_below);
    sum[RG_E_COHESIVE] += weight * rg_select(broken & unlinked, stored, zero);
    sum[RG_E_CONTACT] += weight * rg_select(touching, contact, zero);
    sum[RG_E_DISSIPATED] +=
        weight * rg_select(broken, s->area * rg_cohesive_dissipated(law, delta_max), zero);
}

void RG_ISA_NAME(rg_interface_state)(const rg_interface_state_args *args, size_t begin, size_t end) {
    for (size_t b = begin; b < end; b++) {
        for (int lane = 0; lane < RG_LANES; lane += RG_VLEN) {
            interface s;
            load_interface(&s, args->interface, b, lane);
            jump_at_points(&s);
            vec3 n[RG_POINTS];
            rg_vec area[RG_POINTS], sum[RG_E_INTERFACE] = {{0}};
            const uint8_t *broken = s.args->broken + b * RG_LANES + lane;
            const uint8_t *unlinked = s.args->unlinked + b * RG_LANES + lane;
            if (s.args->active[b]) {
                mid_surface(&s, n, area);
            }
            for (int q = 0; q < RG_POINTS; q++) {
                rg_mask gone = bit_mask(unlinked, q);
                rg_vec along = rg_dot(s.normal, s.jump[q]);
                rg_vec penalty = s.pen_iso * rg_dot(s.jump[q], s.jump[q]) + s.pen_norm * along * along;
                sum[RG_E_PENALTY] += rg_select(gone, rg_splat(0.0), 0.5 * rg_tri[q / 3].weight * penalty);
                if (s.args->active[b]) {
                    broken_energy(&s, q, n[q], bit_mask(broken, q), gone, sum);
                }
            }
            for (int k = 0; k < RG_E_INTERFACE; k++) {
                rg_store(args->energy + ((b - begin) * RG_E_INTERFACE + (size_t)k) * RG_LANES + lane, sum[k]);
            }
        }
    }
}
