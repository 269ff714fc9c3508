#include "solver/supports.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#include "base/error.h"
#include "base/mem.h"
#include "base/vector.h"
#include "layout.h"
#include "solver/surface.h"

/* ---- What an entry prescribes ---- */

bool rg_support_is_oblique(const rg_boundary *b) {
    return !rg_boundary_damps(b) && (b->prescribed == RG_PRESCRIBED_NORMAL ||
                                     (rg_boundary_is_along_line(b) && !rg_boundary_has_component(b)));
}

bool rg_support_has_axis(const rg_boundary *b, int c) {
    return !rg_boundary_damps(b) &&
           (b->prescribed == RG_PRESCRIBED_ANGLE || (rg_boundary_has_component(b) && b->component == c));
}

bool rg_support_varies(const rg_boundary *b) {
    return !rg_boundary_damps(b) && (rg_boundary_is_placed(b) || rg_expr_uses_time(b->value));
}

/* (R - I) r + d of a place at r from the axis' point. */
static double turned(const rg_boundary *b, int c, const double x[3], double time) {
    double length = sqrt(rg_vector_dot(b->axis, b->axis)), angle = rg_expr_value(b->value, x, time);
    double axis[3], r[3], across[3], inward[3];
    for (int k = 0; k < 3; k++) {
        axis[k] = b->axis[k] / length;
    }
    rg_vector_subtract(x, b->at, r);
    rg_vector_cross(axis, r, across);
    rg_vector_cross(axis, across, inward);
    double half = sin(0.5 * angle); /* 1 - cos a = 2 sin^2 (a/2), without loss at small angles */
    double moved = b->translation[c] == NULL ? 0 : rg_expr_value(b->translation[c], x, time);
    return sin(angle) * across[c] + 2 * half * half * inward[c] + moved;
}

double rg_support_value(const rg_boundary *b, int c, const double x[3], double time) {
    return b->prescribed == RG_PRESCRIBED_ANGLE ? turned(b, c, x, time) : rg_expr_value(b->value, x, time);
}

double rg_support_velocity(const rg_boundary *b, int c, const double x[3], double time, double dt) {
    if (!rg_boundary_is_placed(b)) {
        return rg_support_value(b, c, x, time);
    }
    double half = 0.5 * dt;
    return dt > 0 ? (rg_support_value(b, c, x, time + half) - rg_support_value(b, c, x, time - half)) / dt
                  : 0;
}

/* ---- In time ---- */

void rg_supports_set(rg_supports *s, double time, double dt_last, double dt) {
    s->dt_last = dt_last;
    s->dt_kick = 0.5 * (dt_last + dt);
    for (int b = 0; b < s->input->boundaries; b++) {
        const rg_boundary *of = &s->input->boundary[b];
        s->acts[b] = time >= of->from && !(of->until > 0 && time >= of->until);
    }
}

void rg_supports_note(rg_supports *s, int b, const double x[3], double time) {
    if (s->bad.which == RG_NOWHERE || s->bad.value == time) { /* what comes later only follows */
        rg_first_bad_note(&s->bad, b, x, time);
    }
}

static const char *const key[] = {
#define KEY(NAME, key, unit, meaning) key,
    RG_PRESCRIBED(KEY, )
#undef KEY
};

bool rg_supports_told(const rg_supports *s, char *words, size_t size, MPI_Comm comm) {
    rg_first_bad bad = s->bad;
    double first = bad.which == RG_NOWHERE ? INFINITY : bad.value;
    MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_DOUBLE, MPI_MIN, comm);
    if (bad.which != RG_NOWHERE && bad.value > first) { /* it only followed */
        bad.which = RG_NOWHERE;
    }
    bool found = rg_first_bad_lowest(&bad, comm);
    if (found) {
        const rg_boundary *b = &s->input->boundary[bad.which];
        bool rigid = b->prescribed == RG_PRESCRIBED_ANGLE;
        snprintf(words, size, "boundary[%d].%s: %s%s is not finite at (%g, %g, %g), t = %g s", (int)bad.which,
                 key[b->prescribed], rg_expr_text(b->value), rigid ? ", or the translation beside it," : "",
                 bad.x[0], bad.x[1], bad.x[2], bad.value);
    }
    return found;
}

void rg_supports_describe(const rg_supports *s, int b, char *words, size_t size) {
    const rg_boundary *of = &s->input->boundary[b];
    const char *what = of->absorbing ? "absorbing" : of->dashpot > 0 ? "dashpot" : key[of->prescribed];
    char along[80] = "";
    if (rg_boundary_has_component(of)) {
        snprintf(along, sizeof along, " along %c", "xyz"[of->component]);
    } else if (rg_boundary_is_along_line(of)) {
        snprintf(along, sizeof along, " along (%g, %g, %g)", of->direction[0], of->direction[1],
                 of->direction[2]);
    }
    char on[200];
    rg_selected_tell(&s->on[b], false, on, sizeof on);
    snprintf(words, size, "%s%s on %s", what, along, on);
}

/* ---- Set-up ---- */

static uint16_t *nodes_of(const rg_domain *d, const uint8_t *faces, rg_assembly *shared) {
    uint16_t *nodes = RG_NEW(uint16_t, d->blocks * RG_LANES + 1);
    for (size_t i = 0; i < RG_FACES * d->blocks * RG_LANES; i++) {
        for (int a = 0; (faces[i / RG_FACES] >> i % RG_FACES & 1) != 0 && a < RG_FNODES; a++) {
            nodes[i / RG_FACES] |= (uint16_t)(1u << rg_face_node[i % RG_FACES][a]);
        }
    }
    if (shared != NULL) {
        rg_assembly_spread(shared, nodes);
    }
    return nodes;
}

/* Cosine beyond which two lines are one. */
#define SAME_LINE 0.999

/* Whether two entries prescribe the same of a face with this normal: of two angles, all. */
static bool contradict(const rg_boundary *a, const rg_boundary *b, const double normal[3]) {
    const rg_boundary *of[2] = {a, b};
    double line[2][3] = {{0}};
    if (a->prescribed == RG_PRESCRIBED_ANGLE || b->prescribed == RG_PRESCRIBED_ANGLE) {
        return true;
    }
    for (int i = 0; i < 2; i++) {
        for (int c = 0; c < 3; c++) {
            line[i][c] = of[i]->prescribed == RG_PRESCRIBED_NORMAL ? normal[c]
                         : rg_boundary_has_component(of[i])        ? of[i]->component == c
                                                                   : of[i]->direction[c];
        }
    }
    return fabs(rg_vector_dot(line[0], line[1])) >
           SAME_LINE * sqrt(rg_vector_dot(line[0], line[0]) * rg_vector_dot(line[1], line[1]));
}

static void refuse_contradiction(const rg_supports *s, int a, int b, MPI_Comm comm) {
    const rg_domain *d = s->domain;
    const rg_boundary *of = s->input->boundary;
    int64_t count = 0;
    for (size_t i = 0; i < RG_FACES * d->blocks * RG_LANES; i++) {
        size_t slot = i / RG_FACES;
        int face = (int)(i % RG_FACES);
        double normal[3];
        if ((s->faces[a][slot] & s->faces[b][slot] & 1u << face) != 0) {
            rg_surface_area(d->corner + 12 * slot, face, normal);
            count += contradict(&of[a], &of[b], normal);
        }
    }
    MPI_Allreduce(MPI_IN_PLACE, &count, 1, MPI_INT64_T, MPI_SUM, comm);
    if (count > 0) {
        rg_speak(comm);
        rg_fatal(RG_USAGE,
                 "%s: boundary[%d] and boundary[%d] both prescribe the motion of %" PRId64
                 " faces along one line, at the same time",
                 s->input->path, a, b, count);
    }
}

static void refuse_contradictions(const rg_supports *s, MPI_Comm comm) {
    for (int b = 0; b < s->input->boundaries; b++) {
        for (int a = 0; a < b; a++) {
            if (s->faces[a] != NULL && s->faces[b] != NULL &&
                rg_boundaries_meet(&s->input->boundary[a], &s->input->boundary[b])) {
                refuse_contradiction(s, a, b, comm);
            }
        }
    }
}

rg_supports *rg_supports_make(const rg_case *c, const rg_domain *d, const rg_part *part, rg_assembly *nodes,
                              rg_account *account, MPI_Comm comm) {
    size_t count = (size_t)c->boundaries + 1;
    rg_supports *s = RG_NEW(rg_supports, 1);
    *s = (rg_supports){.input = c,
                       .domain = d,
                       .account = account,
                       .faces = RG_NEW(uint8_t *, count),
                       .nodes = RG_NEW(uint16_t *, count),
                       .on = RG_NEW(rg_selected, count),
                       .item = RG_NEW(int, count),
                       .acts = RG_NEW(bool, count),
                       .bad = {.which = RG_NOWHERE}};
    for (int b = 0; b < c->boundaries; b++) {
        const rg_boundary *of = &c->boundary[b];
        rg_selection selection = {"boundary", b, of->set, of->where, false};
        uint8_t *faces = rg_selection_faces(&selection, c, d, part, comm);
        s->on[b] = rg_selection_measure(faces, false, c, d, comm);
        if (rg_boundary_damps(of)) {
            rg_free(faces);
        } else {
            s->faces[b] = faces;
            s->nodes[b] = nodes_of(d, faces, nodes);
        }
        s->item[b] = of->name == NULL ? -1 : rg_account_add(account, of->name);
        s->named = s->named || s->item[b] >= 0;
        s->timed = s->timed || of->from > 0 || of->until > 0;
    }
    refuse_contradictions(s, comm);
    return s;
}

void rg_supports_forget(rg_supports *s) {
    for (int b = 0; b < s->input->boundaries && s->faces != NULL; b++) {
        rg_free(s->faces[b]);
        rg_free(s->nodes[b]);
    }
    rg_free(s->faces);
    rg_free(s->nodes);
    s->faces = NULL;
    s->nodes = NULL;
}

void rg_supports_free(rg_supports *s) {
    if (s != NULL) {
        rg_supports_forget(s);
        rg_free(s->on);
        rg_free(s->item);
        rg_free(s->acts);
        rg_free(s);
    }
}
