#include "solver/tie.h"

#include <inttypes.h>
#include <omp.h>
#include <stdio.h>
#include <string.h>

#include "base/error.h"
#include "base/exact_sum.h"
#include "base/mem.h"
#include "base/vector.h"
#include "domain/element.h"
#include "solver/pattern.h"
#include "solver/selection.h"

/* The nodes of an element that are tied. */
typedef struct {
    rg_lid slot;
    int body;
    const rg_pattern *pattern;
    double mass;
} entry;

enum { SUMS = 6, CARRIED = 13, ENERGY = SUMS, JOINING };

struct rg_ties {
    const rg_domain *domain;
    rg_bodies *bodies;
    MPI_Comm comm;
    bool any;
    int threads;
    rg_patterns patterns;
    size_t entries, *tile_begin;
    entry *entry;
    rg_selected *on;   /* [bodies]: the faces tied to each */
    rg_exact_sum *sum; /* [threads][bodies][SUMS] */

    /* Of bodies that are tied from a time on; NULL if there are none. */
    double (*joint)[RG_NODES][3]; /* [entries]: as a node was seen from its body when it was tied, less where
                                     it was at the start (m) */
    int64_t *key;                 /* [entries]: of the state */
    rg_exact_sum *joining;        /* [threads][bodies][JOINING]: momenta and energy just before */
};

/* ---- In time ---- */

/* Whether what is tied to a body is so in a kick at `time`, and up to the next one. */
static bool holds(const rg_body *b, double time) {
    return time >= b->input->tied_from && (b->input->tied_until <= 0 || time < b->input->tied_until);
}

/* Whether it becomes so in that kick. */
static bool joins(const rg_body *b, double time) {
    return b->input->tied_from > 0 && b->tied.joined == 0 && holds(b, time);
}

bool rg_ties_due(const rg_ties *t, double time) {
    bool due = false;
    for (int i = 0; t->joint != NULL && i < t->bodies->count; i++) {
        due = due || (rg_body_is_tied(t->bodies->body[i].input) && joins(&t->bodies->body[i], time));
    }
    return due;
}

/* From the body's centre, at the start; of nodes that were tied later, where they would have been then. */
static void arm_at_start(const rg_ties *t, const entry *e, int i, double arm[3]) {
    double x[3];
    rg_node_position(t->domain->corner + 12 * (size_t)e->slot, e->pattern->node[i], x);
    rg_vector_subtract(x, t->bodies->body[e->body].input->at, arm);
    for (int c = 0; t->joint != NULL && c < 3; c++) {
        arm[c] += t->joint[e - t->entry][e->pattern->node[i]][c];
    }
}

/* Ties the nodes of an entry where they are by now. */
static void join(rg_ties *t, const entry *e, const rg_real *u) {
    const rg_body *b = &t->bodies->body[e->body];
    const double *q = b->turn.rotation, back[4] = {q[0], -q[1], -q[2], -q[3]};
    for (int i = 0; i < e->pattern->constrained; i++) {
        int node = e->pattern->node[i];
        double x[3], place[3], turned[3];
        rg_node_position(t->domain->corner + 12 * (size_t)e->slot, node, x);
        for (int c = 0; c < 3; c++) {
            place[c] = x[c] + u[rg_node_index((size_t)e->slot, node, c)] - b->x[c];
        }
        rg_rotation_move(back, place, turned);
        for (int c = 0; c < 3; c++) {
            /* what the place differs by, plus what turning back moves it */
            t->joint[e - t->entry][node][c] =
                u[rg_node_index((size_t)e->slot, node, c)] - (b->x[c] - b->input->at[c]) + turned[c];
        }
    }
}

/* Momenta that impulses would have to give the nodes at rest to have the velocities of a field. */
static void momenta(const entry *e, const rg_real *velocity, double out[RG_NODES][3]) {
    const rg_pattern *p = e->pattern;
    for (int i = 0; i < p->constrained; i++) {
        for (int c = 0; c < 3; c++) {
            double sum = 0;
            for (int j = 0; j < p->constrained; j++) {
                sum += p->impulse[i][j] * velocity[rg_node_index((size_t)e->slot, p->node[j], c)];
            }
            out[i][c] = e->mass * sum;
        }
    }
}

/* Momentum and angular momentum about the body of an entry at a velocity, and twice its energy. */
static void add_momenta(const rg_ties *t, const entry *e, const rg_real *velocity, double all[JOINING]) {
    double momentum[RG_NODES][3];
    momenta(e, velocity, momentum);
    for (int i = 0; i < e->pattern->constrained; i++) {
        double start[3], arm[3], angular[3];
        arm_at_start(t, e, i, start);
        rg_body_arm(&t->bodies->body[e->body], start, arm);
        rg_vector_cross(arm, momentum[i], angular);
        for (int c = 0; c < 3; c++) {
            all[c] += momentum[i][c];
            all[3 + c] += angular[c];
            all[ENERGY] += momentum[i][c] * velocity[rg_node_index((size_t)e->slot, e->pattern->node[i], c)];
        }
    }
}

static void add_sums(rg_exact_sum *sum, const double *x, int count) {
    for (int c = 0; c < count; c++) {
        rg_exact_add(&sum[c], x[c]);
    }
}

void rg_ties_gather(rg_ties *t, size_t tile, double time, const rg_real *u, const rg_real *velocity,
                    const rg_real *now) {
    for (size_t n = t->tile_begin[tile]; n < t->tile_begin[tile + 1]; n++) {
        const entry *e = &t->entry[n];
        const rg_body *b = &t->bodies->body[e->body];
        int row = omp_get_thread_num() * t->bodies->count + e->body;
        double all[JOINING] = {0}, before[JOINING] = {0};
        if (joins(b, time)) {
            join(t, e, u);
            add_momenta(t, e, now, before);
            add_sums(t->joining + JOINING * row, before, JOINING);
        }
        add_momenta(t, e, velocity, all); /* of nodes that are not tied now nobody asks for it */
        add_sums(t->sum + SUMS * row, all, SUMS);
    }
}

/* Sums of all threads and ranks, which then begin anew. */
static void close_sums(const rg_ties *t, rg_exact_sum *sum, int each) {
    int sums = each * t->bodies->count;
    for (int i = sums; i < sums * t->threads; i++) {
        rg_exact_merge(&sum[i % sums], &sum[i]);
    }
    rg_exact_allreduce(sum, sums, t->comm);
}

static void forget_sums(const rg_ties *t, rg_exact_sum *sum, int each) {
    memset(sum, 0, (size_t)(each * t->bodies->count * t->threads) * sizeof *sum);
}

static void tell_bodies(const rg_ties *t);

/* Bodies to which something is tied in this kick learn what, and what it moved by. */
static void close_joints(rg_ties *t, double time) {
    close_sums(t, t->joining, JOINING);
    for (int i = 0; i < t->bodies->count; i++) {
        rg_body *b = &t->bodies->body[i];
        if (rg_body_is_tied(b->input) && joins(b, time)) {
            b->tied.joined = 1;
            b->tied.joins = true;
            for (int c = 0; c < 3; c++) {
                b->tied.before.momentum[c] = rg_exact_value(&t->joining[JOINING * i + c]);
                b->tied.before.angular[c] = rg_exact_value(&t->joining[JOINING * i + 3 + c]);
            }
            b->tied.before.energy = 0.5 * rg_exact_value(&t->joining[JOINING * i + ENERGY]);
        }
    }
    forget_sums(t, t->joining, JOINING);
    tell_bodies(t);
}

void rg_ties_close(rg_ties *t, double time) {
    if (rg_ties_due(t, time)) {
        close_joints(t, time);
    }
    close_sums(t, t->sum, SUMS);
    for (int i = 0; i < t->bodies->count; i++) {
        rg_body_tied *tied = &t->bodies->body[i].tied;
        for (int c = 0; c < 3; c++) {
            tied->momentum[c] = rg_exact_value(&t->sum[SUMS * i + c]);
            tied->angular[c] = rg_exact_value(&t->sum[SUMS * i + 3 + c]);
        }
        if (!holds(&t->bodies->body[i], time)) {
            tied->any = false;
        }
    }
    forget_sums(t, t->sum, SUMS);
}

/* Brings the tied nodes of an element to `target`; the others follow. Velocities at the time of the step go
 * the share of it that the kick has behind it by then: so momentum at that time stays as well. */
static void bring(const entry *e, double target[RG_NODES][3], double share, rg_real *velocity, rg_real *now) {
    const rg_pattern *p = e->pattern;
    double change[RG_NODES][3];
    for (int n = 0; n < RG_NODES; n++) {
        for (int c = 0; c < 3; c++) {
            size_t at = rg_node_index((size_t)e->slot, p->node[n], c);
            if (n < p->constrained) {
                change[n][c] = target[n][c] - velocity[at];
                velocity[at] = (rg_real)target[n][c];
            } else {
                change[n][c] = 0;
                for (int i = 0; i < p->constrained; i++) {
                    change[n][c] += p->follow[n][i] * change[i][c];
                }
                velocity[at] = (rg_real)(velocity[at] + change[n][c]);
            }
            if (now != NULL) {
                now[at] = (rg_real)(now[at] + share * change[n][c]);
            }
        }
    }
}

void rg_ties_kick(const rg_ties *t, size_t tile, double time, double dt_last, double dt_next,
                  rg_real *velocity, rg_real *now) {
    for (size_t n = t->tile_begin[tile]; n < t->tile_begin[tile + 1]; n++) {
        const entry *e = &t->entry[n];
        const rg_body *b = &t->bodies->body[e->body];
        double chord[RG_NODES][3];
        if (!holds(b, time)) {
            continue;
        }
        for (int i = 0; i < e->pattern->constrained; i++) {
            double start[3], arm[3];
            arm_at_start(t, e, i, start);
            rg_body_arm(b, start, arm);
            rg_body_sweep(b, arm, chord[i]);
            for (int c = 0; c < 3; c++) {
                chord[i][c] = b->v[c] + chord[i][c] / dt_next;
            }
        }
        bring(e, chord, dt_last / (dt_last + dt_next), velocity, now);
    }
}

/* What a node has moved since the start when its body is at x, turned by `rotation`. */
static void moved(const rg_ties *t, const entry *e, int i, const double x[3], const double rotation[4],
                  double u[3]) {
    double start[3];
    arm_at_start(t, e, i, start);
    rg_rotation_move(rotation, start, u);
    for (int c = 0; c < 3; c++) {
        u[c] += x[c] - t->bodies->body[e->body].input->at[c];
        u[c] += t->joint != NULL ? t->joint[e - t->entry][e->pattern->node[i]][c] : 0;
    }
}

void rg_ties_drift(const rg_ties *t, size_t tile, double time, double dt, rg_real *u) {
    for (size_t n = t->tile_begin[tile]; n < t->tile_begin[tile + 1]; n++) {
        const entry *e = &t->entry[n];
        const rg_body *b = &t->bodies->body[e->body];
        double x[3], rotation[4], to[3];
        if (!holds(b, time)) {
            continue;
        }
        rg_rotation_join(b->turn.step, b->turn.rotation, rotation);
        for (int c = 0; c < 3; c++) {
            x[c] = b->x[c] + dt * b->v[c];
        }
        for (int i = 0; i < e->pattern->constrained; i++) {
            moved(t, e, i, x, rotation, to);
            for (int c = 0; c < 3; c++) {
                u[rg_node_index((size_t)e->slot, e->pattern->node[i], c)] = (rg_real)to[c];
            }
        }
    }
}

void rg_ties_start(const rg_ties *t, rg_real *u, rg_real *velocity) {
    for (size_t n = 0; n < t->entries; n++) {
        const entry *e = &t->entry[n];
        const rg_body *b = &t->bodies->body[e->body];
        if (!holds(b, 0)) {
            continue;
        }
        for (int i = 0; i < e->pattern->constrained; i++) {
            double start[3], arm[3], to[3], turn[3];
            arm_at_start(t, e, i, start);
            moved(t, e, i, b->x, b->turn.rotation, to);
            rg_body_arm(b, start, arm);
            rg_vector_cross(b->turn.spin, arm, turn);
            for (int c = 0; c < 3; c++) {
                size_t at = rg_node_index((size_t)e->slot, e->pattern->node[i], c);
                u[at] = (rg_real)to[c];
                if (velocity != NULL) {
                    velocity[at] = (rg_real)(b->v[c] + turn[c]);
                }
            }
        }
    }
}

/* ---- Equilibria ---- */

void rg_ties_motions(rg_ties *t, const rg_real *field, const double (*impulse)[6], double (*motion)[6]) {
    if (!t->any) {
        return;
    }
#pragma omp parallel for schedule(static)
    for (size_t n = 0; n < t->entries; n++) {
        double all[JOINING] = {0};
        add_momenta(t, &t->entry[n], field, all);
        add_sums(t->sum + SUMS * (omp_get_thread_num() * t->bodies->count + t->entry[n].body), all, SUMS);
    }
    close_sums(t, t->sum, SUMS);
    for (int i = 0; i < t->bodies->count; i++) {
        const rg_body *b = &t->bodies->body[i];
        double whole[6];
        memset(motion[i], 0, sizeof motion[i]);
        if (b->input->motion != RG_MOTION_FREE || !b->tied.any) {
            continue;
        }
        for (int c = 0; c < 6; c++) {
            whole[c] = rg_exact_value(&t->sum[SUMS * i + c]) + (impulse != NULL ? impulse[i][c] : 0);
        }
        rg_body_carried_motion(b, whole, motion[i]);
    }
    forget_sums(t, t->sum, SUMS);
}

void rg_ties_turning(rg_ties *t, const rg_real *field, double (*stiffness)[3][3]) {
    rg_exact_sum *sum = RG_NEW(rg_exact_sum, (size_t)(9 * t->bodies->count) + 1);
    for (size_t n = 0; n < t->entries; n++) {
        const entry *e = &t->entry[n];
        double force[RG_NODES][3];
        momenta(e, field, force);
        for (int i = 0; i < e->pattern->constrained; i++) {
            double start[3], arm[3];
            arm_at_start(t, e, i, start);
            rg_body_arm(&t->bodies->body[e->body], start, arm);
            for (int k = 0; k < 9; k++) {
                rg_exact_add(&sum[9 * e->body + k], arm[k / 3] * force[i][k % 3]);
            }
        }
    }
    rg_exact_allreduce(sum, 9 * t->bodies->count, t->comm);
    for (int i = 0; i < t->bodies->count; i++) {
        double whole[9];
        for (int k = 0; k < 9; k++) {
            whole[k] = rg_exact_value(&sum[9 * i + k]);
        }
        for (int k = 0; k < 9; k++) {
            double trace = k % 4 == 0 ? whole[0] + whole[4] + whole[8] : 0;
            stiffness[i][k / 3][k % 3] = trace - 0.5 * (whole[k] + whole[3 * (k % 3) + k / 3]);
        }
    }
    rg_free(sum);
}

void rg_ties_hold(const rg_ties *t, const double (*motion)[6], rg_real *field) {
#pragma omp parallel for schedule(static)
    for (size_t n = 0; n < t->entries; n++) {
        const entry *e = &t->entry[n];
        const rg_body *b = &t->bodies->body[e->body];
        double target[RG_NODES][3];
        for (int i = 0; holds(b, 0) && i < e->pattern->constrained; i++) {
            double start[3], arm[3];
            arm_at_start(t, e, i, start);
            rg_body_arm(b, start, arm);
            rg_vector_cross(motion[e->body] + 3, arm, target[i]);
            for (int c = 0; c < 3; c++) {
                target[i][c] += motion[e->body][c];
            }
        }
        if (holds(b, 0)) {
            bring(e, target, 0, field, NULL);
        }
    }
}

void rg_ties_show(const rg_ties *t, rg_held_line *show, void *to) {
    for (size_t n = 0; n < t->entries; n++) {
        const entry *e = &t->entry[n];
        const rg_body *b = &t->bodies->body[e->body];
        for (int k = 0;
             b->input->motion == RG_MOTION_PRESCRIBED && holds(b, 0) && k < 3 * e->pattern->constrained;
             k++) {
            const double line[3] = {k % 3 == 0, k % 3 == 1, k % 3 == 2};
            show(to, (size_t)e->slot, e->pattern->node[k / 3], line);
        }
    }
}

/* ---- Set-up ---- */

bool rg_ties_any(const rg_ties *t) {
    return t->any;
}

void rg_ties_describe(const rg_ties *t, int i, char *words, size_t size) {
    const rg_body_input *in = t->bodies->body[i].input;
    char from[40] = "", until[40] = "";
    words[0] = '\0';
    if (in->tied_from > 0) {
        snprintf(from, sizeof from, " from %g s on", in->tied_from);
    }
    if (in->tied_until > 0) {
        snprintf(until, sizeof until, " until %g s", in->tied_until);
    }
    if (rg_body_is_tied(in)) {
        char on[200];
        rg_selected_tell(&t->on[i], false, on, sizeof on);
        snprintf(words, size, "%s%s%s", on, from, until);
    }
}

double rg_ties_taken(const rg_ties *t) {
    double taken = 0;
    for (int i = 0; i < t->bodies->count; i++) {
        taken += t->bodies->body[i].tied.taken;
    }
    return taken;
}

void rg_ties_register(rg_ties *t, rg_state *st) {
    if (t->joint == NULL) {
        return;
    }
    rg_state_add_rows(st, "joined", RG_STATE_DOUBLE, 2, &t->bodies->body[0].tied.joined,
                      sizeof *t->bodies->body, (size_t)t->bodies->count);
    rg_state_add_list(st, "joint", RG_STATE_DOUBLE, 3 * RG_NODES, t->joint[0][0], sizeof *t->joint,
                      t->entries, t->key);
}

void rg_ties_resume(rg_ties *t) {
    if (t->joint != NULL) {
        tell_bodies(t);
    }
}

/* Adds the selected faces to those of each element, and their nodes. */
static void add_nodes(const rg_ties *t, const rg_selection *selection, const rg_case *c, const rg_part *part,
                      uint16_t *nodes, uint8_t *tied) {
    const rg_domain *d = t->domain;
    uint8_t *faces = rg_selection_faces(selection, c, d, part, t->comm);
    for (size_t n = 0; n < RG_FACES * d->blocks * RG_LANES; n++) {
        size_t slot = n / RG_FACES;
        int face = (int)(n % RG_FACES);
        for (int a = 0; a < RG_FNODES && (faces[slot] >> face & 1) != 0; a++) {
            tied[slot] |= (uint8_t)(1u << face);
            nodes[slot] |= (uint16_t)(1u << rg_face_node[face][a]);
        }
    }
    rg_free(faces);
}

/* Bits of the nodes of each element that are tied to body i. */
static uint16_t *nodes_of(rg_ties *t, int i, const rg_case *c, const rg_part *part, rg_assembly *shared) {
    size_t slots = t->domain->blocks * RG_LANES;
    uint16_t *nodes = RG_NEW(uint16_t, slots + 1);
    uint8_t *tied = RG_NEW(uint8_t, slots + 1);
    char list[64];
    snprintf(list, sizeof list, "bodies[%d].tied", i);
    for (int k = 0; k < c->body[i].ties; k++) {
        rg_selection selection = {list, k, c->body[i].tied[k], NULL, false};
        add_nodes(t, &selection, c, part, nodes, tied);
    }
    if (c->body[i].tied_where != NULL) {
        rg_selection selection = {"bodies", i, NULL, c->body[i].tied_where, false};
        add_nodes(t, &selection, c, part, nodes, tied);
    }
    t->on[i] = rg_selection_measure(tied, false, c, t->domain, t->comm);
    rg_free(tied);
    if (shared != NULL) {
        rg_assembly_spread(shared, nodes);
    }
    return nodes;
}

static void refuse_elements(const rg_ties *t, const rg_case *c, int64_t count, const char *why) {
    MPI_Allreduce(MPI_IN_PLACE, &count, 1, MPI_INT64_T, MPI_SUM, t->comm);
    if (count > 0) {
        rg_speak(t->comm);
        rg_fatal(RG_USAGE, "%s: bodies: %" PRId64 " elements with nodes that are tied %s", c->path, count,
                 why);
    }
}

static void refuse_conflicts(const rg_ties *t, const rg_case *c, uint16_t *const nodes[],
                             const rg_constraints *constraints) {
    const rg_domain *d = t->domain;
    uint8_t *held = RG_NEW(uint8_t, d->blocks * RG_LANES + 1);
    int64_t prescribed = 0, twice = 0;
    rg_constraints_mark(constraints, held);
    for (size_t slot = 0; slot < d->blocks * RG_LANES; slot++) {
        int bodies = 0;
        for (int i = 0; i < c->bodies; i++) {
            bodies += nodes[i] != NULL && nodes[i][slot] != 0;
        }
        prescribed += bodies > 0 && held[slot] != 0;
        twice += bodies > 1;
    }
    rg_free(held);
    refuse_elements(t, c, twice, "to two bodies");
    refuse_elements(t, c, prescribed,
                    "to a body have others whose motion `boundary` prescribes: tie or prescribe only one");
}

/* Adds what an element's tied nodes are to their body: its mass and the moments of that. */
static void carry(const rg_ties *t, const entry *e, rg_exact_sum *sum) {
    const rg_pattern *p = e->pattern;
    double arm[RG_NODES][3], all[CARRIED] = {0};
    for (int i = 0; i < p->constrained; i++) {
        arm_at_start(t, e, i, arm[i]);
    }
    for (int n = 0; n < p->constrained * p->constrained; n++) {
        int i = n / p->constrained, j = n % p->constrained;
        double mass = e->mass * p->impulse[i][j];
        all[0] += mass;
        for (int k = 0; k < 9; k++) {
            all[1 + k % 3] += k < 3 ? mass * arm[j][k] : 0;
            all[4 + k] += mass * arm[i][k / 3] * arm[j][k % 3];
        }
    }
    for (int k = 0; k < CARRIED; k++) {
        rg_exact_add(&sum[CARRIED * e->body + k], all[k]);
    }
}

static void tell_bodies(const rg_ties *t) {
    rg_exact_sum *sum = RG_NEW(rg_exact_sum, (size_t)(CARRIED * t->bodies->count));
    for (size_t n = 0; n < t->entries; n++) {
        carry(t, &t->entry[n], sum);
    }
    rg_exact_allreduce(sum, CARRIED * t->bodies->count, t->comm);
    for (int i = 0; i < t->bodies->count; i++) {
        rg_body *b = &t->bodies->body[i];
        double value[CARRIED];
        for (int k = 0; k < CARRIED; k++) {
            value[k] = rg_exact_value(&sum[CARRIED * i + k]);
        }
        b->tied.any = rg_body_is_tied(b->input) && (!(b->input->tied_from > 0) || b->tied.joined > 0);
        b->tied.mass = value[0];
        memcpy(b->tied.first, value + 1, sizeof b->tied.first);
        for (int k = 0; k < 9; k++) { /* symmetric to the last bit */
            b->tied.second[k / 3][k % 3] = 0.5 * (value[4 + k] + value[4 + 3 * (k % 3) + k / 3]);
        }
    }
    rg_free(sum);
}

/* Room for what is tied from a time on. */
static void make_joints(rg_ties *t) {
    t->joint = rg_alloc(t->entries + 1, sizeof *t->joint);
    memset(t->joint, 0, (t->entries + 1) * sizeof *t->joint);
    t->key = RG_NEW(int64_t, t->entries + 1);
    for (size_t n = 0; n < t->entries; n++) {
        t->key[n] = 4 * t->domain->id[t->entry[n].slot];
    }
    t->joining = RG_NEW(rg_exact_sum, (size_t)(JOINING * t->bodies->count * t->threads));
}

rg_ties *rg_ties_make(const rg_case *c, const rg_domain *d, const rg_part *part, const rg_material *m,
                      rg_assembly *shared, rg_bodies *bodies, const rg_constraints *constraints, int threads,
                      MPI_Comm comm) {
    rg_ties *t = RG_NEW(rg_ties, 1);
    *t = (rg_ties){.domain = d, .bodies = bodies, .comm = comm, .threads = threads, .patterns.mass = c->mass};
    t->tile_begin = RG_NEW(size_t, d->tiles + 1);
    for (int i = 0; i < c->bodies; i++) {
        t->any = t->any || rg_body_is_tied(&c->body[i]);
    }
    if (!t->any) {
        return t;
    }
    t->on = RG_NEW(rg_selected, (size_t)c->bodies);
    t->sum = RG_NEW(rg_exact_sum, (size_t)(SUMS * c->bodies * threads));
    uint16_t **nodes = RG_NEW(uint16_t *, (size_t)c->bodies);
    for (int i = 0; i < c->bodies; i++) {
        nodes[i] = rg_body_is_tied(&c->body[i]) ? nodes_of(t, i, c, part, shared) : NULL;
    }
    refuse_conflicts(t, c, nodes, constraints);
    size_t room = 0;
    for (size_t tile = 0; tile < d->tiles; tile++) {
        for (size_t slot = d->tile[tile].begin * RG_LANES; slot < d->tile[tile].end * RG_LANES; slot++) {
            for (int i = 0; i < c->bodies; i++) {
                if (nodes[i] != NULL && nodes[i][slot] != 0) {
                    t->entry = rg_grow(t->entry, &room, t->entries + 1, sizeof *t->entry);
                    t->entry[t->entries++] = (entry){.slot = (rg_lid)slot,
                                                     .body = i,
                                                     .pattern = rg_patterns_get(&t->patterns, nodes[i][slot]),
                                                     .mass = rg_element_mass(d, m, slot)};
                }
            }
        }
        t->tile_begin[tile + 1] = t->entries;
    }
    for (int i = 0; i < c->bodies; i++) {
        rg_free(nodes[i]);
    }
    rg_free(nodes);
    if (rg_case_joins(c)) {
        make_joints(t);
    }
    tell_bodies(t);
    return t;
}

void rg_ties_free(rg_ties *t) {
    if (t != NULL) {
        rg_patterns_clear(&t->patterns);
        void *blocks[] = {t->tile_begin, t->entry, t->on, t->sum, t->joint, t->key, t->joining, t};
        for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) {
            rg_free(blocks[i]);
        }
    }
}
