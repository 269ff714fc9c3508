#include "output/estimate.h"

#include <inttypes.h>
#include <math.h>

#include "base/error.h"
#include "base/mem.h"
#include "diagnostics/ledger.h"
#include "base/first_bad.h"
#include "cohesive/facts.h"
#include "library.h"
#include "mesh/info.h"
#include "output/snapshot.h"
#include "partition/material.h"
#include "solver/opening.h"

#define MOST_STEPS 1e15

/* Pressure waves run at some 20 m/s in the softest gels and at 18 km/s in diamond (m/s). */
#define SLOWEST_WAVE 10
#define FASTEST_WAVE 30e3

/* A point that has just switched by the conserving activation unloads 1/interface.onset times as stiffly as a
 * closed one bears contact, in the stiffer of opening and sliding. In all directions alike, at all faces at
 * once, that stiffness adds up to 1.2 times what the normal one does. Half of that is asked for, since never
 * do all points switch together: bars torn to pieces keep their energy in 20,000 steps within 0.8 % at 0.5
 * and safety 0.875, and gain 6.5 % at 0.3 and 0.9. */
static double steady_safety(const rg_case *c) {
    return (1 + 1e-9) * sqrt(c->interface.onset / 0.6);
}

/* Longest edge of interface i (m). */
static double longest_edge(const rg_solver *s, size_t i) {
    double square = 0;
    for (int e = 0; e < 3; e++) { /* edges 01, 02 and their difference 12 */
        double sum = 0;
        for (int c = 0; c < 3; c++) {
            double a = s->domain->igeom[rg_igeom_index(i, RG_IGEOM_EDGE + c)];
            double b = s->domain->igeom[rg_igeom_index(i, RG_IGEOM_EDGE + 3 + c)];
            double x = e == 0 ? a : e == 1 ? b : b - a;
            sum += x * x;
        }
        square = fmax(square, sum);
    }
    return sqrt(square);
}

/* E/(1 - nu^2) of the softer element beside interface i (Pa). */
static double plane_strain_modulus(const rg_solver *s, size_t i) {
    double least = INFINITY;
    for (int k = 0; k < 2; k++) {
        const rg_material *m = &s->model->material[s->domain->beside != NULL ? s->domain->beside[i][k] : 0];
        least = fmin(least, 4 * m->mu * (m->lambda + m->mu) / (m->lambda + 2 * m->mu));
    }
    return least;
}

/* Length of the cohesive zone of mode I, plane strain: (9 pi/32) E/(1 - nu^2) G_c/sigma_c^2 (thesis 2; Rice
 * 1968), with the strength and energy of the face; infinite where it cannot break. */
static double zone_of(const rg_solver *s, size_t i, double work) {
    const rg_cohesive *law = &s->model->law;
    double strength = law->strength, opening = law->opening;
    if (s->model->scale != NULL) {
        strength *= s->model->scale[i / RG_LANES * 2 * RG_LANES + i % RG_LANES];
        opening *= s->model->scale[(i / RG_LANES * 2 + 1) * RG_LANES + i % RG_LANES];
    }
    return isfinite(strength) && strength > 0
               ? 9 * 3.14159265358979324 / 32 * plane_strain_modulus(s, i) * work * opening / strength
               : INFINITY;
}

/* The face whose cohesive zone is shortest over its own longest edge. */
static void find_worst_zone(const rg_solver *s, rg_estimate *e) {
    const rg_law law = s->input->interface.law;
    double work = law == RG_LAW_NONE ? 0 : rg_law_facts_of(law, s->model->law.shape, s->model->law.beta).work;
    struct {
        double ratio;
        int rank;
    } worst = {INFINITY, s->rank};
    double zone[2] = {INFINITY, 0};
    for (size_t i = 0; i < s->domain->iblocks * RG_LANES && work > 0; i++) {
        double edge = longest_edge(s, i);
        if (edge > 0 && zone_of(s, i, work) / edge < worst.ratio) { /* not in padding */
            zone[0] = zone_of(s, i, work);
            zone[1] = edge;
            worst.ratio = zone[0] / edge;
        }
    }
    MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_DOUBLE_INT, MPI_MINLOC, s->comm);
    MPI_Bcast(zone, 2, MPI_DOUBLE, worst.rank, s->comm);
    e->cohesive_zone = zone[0];
    e->zone_edge = zone[1];
}

enum { DAY = 86400, MOST_TOLD = 32 /* materials */ };

/* Seconds in the unit that a person would take. */
static void print_seconds(double seconds, FILE *out) {
    static const struct {
        double length;
        const char *unit;
    } unit[] = {{1, "s"}, {60, "min"}, {3600, "h"}, {DAY, "days"}, {365.25 * DAY, "years"}};
    size_t k = 0;
    while (k + 1 < sizeof unit / sizeof *unit && seconds >= 2 * unit[k + 1].length) {
        k++;
    }
    fprintf(out, "%.3g %s", seconds / unit[k].length, unit[k].unit);
}

/* Of the fields, or at most: with cracks everywhere and the buffers of field output. */
static double bytes_per_element(const rg_solver *s, bool at_most) {
    double crack = (double)s->domain->iblocks * (double)s->model->crack_stride * sizeof *s->crack;
    double now = (double)rg_alloc_total(), elements = (double)s->domain->elements;
    double output = (double)rg_snapshots_bytes(s->input, s->domain->elements);
    double sum[2] = {now + (at_most ? output : -crack), elements};
    MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPI_DOUBLE, MPI_SUM, s->comm);
    return sum[0] / sum[1];
}

/* Interfaces, and nodes that move on their own, of the whole mesh. */
static void count_all(const rg_solver *s, int64_t count[2]) {
    count[0] = (int64_t)s->domain->interfaces;
    count[1] =
        (int64_t)(s->assembly != NULL ? rg_assembly_nodes(s->assembly) : RG_NODES * s->domain->elements);
    MPI_Allreduce(MPI_IN_PLACE, count, 2, MPI_INT64_T, MPI_SUM, s->comm);
}

/* Elements of each; the caller frees them. */
static int64_t *count_materials(const rg_solver *s) {
    int64_t *of = RG_NEW(int64_t, (size_t)s->model->materials);
    for (size_t slot = 0; slot < s->domain->blocks * RG_LANES; slot++) {
        of[s->domain->material[slot / RG_LANES]] += s->domain->id[slot] >= 0;
    }
    MPI_Allreduce(MPI_IN_PLACE, of, s->model->materials, MPI_INT64_T, MPI_SUM, s->comm);
    return of;
}

/* Of field output, in so many steps. */
static double frames(const rg_case *c, double steps, double dt) {
    if (c->output.fields == 0) {
        return 0;
    }
    if (c->output.times > 0) {
        return c->output.times;
    }
    double intervals = c->output.interval_steps > 0 ? steps / (double)c->output.interval_steps
                                                    : fmin(c->time.end, steps * dt) / c->output.interval_time;
    return 1 + ceil(intervals * (1 - 1e-9)); /* one at the start */
}

rg_estimate rg_estimate_run(const rg_solver *s) {
    const rg_case *c = s->input;
    double xi = s->damping * c->viscosity.linear; /* of the stiffest mode, by bulk viscosity */
    int64_t count[2];
    count_all(s, count);
    rg_estimate e = {.elements = s->part->total,
                     .interfaces = count[0],
                     .dofs = 3 * count[1],
                     .dt_critical = 2 / sqrt(s->omega2) * (sqrt(1 + xi * xi) - xi)};
    e.dt = c->time.safety * e.dt_critical;
    double steps = ceil(c->time.end / e.dt * (1 - 1e-12));
    if (c->time.steps > 0) {
        steps = fmin(steps, (double)c->time.steps);
    }
    if (!(steps <= MOST_STEPS)) {
        rg_speak(s->comm);
        rg_fatal(RG_USAGE, "time.end: %g s are %g steps of %g s, more than a run can count", c->time.end,
                 steps, e.dt);
    }
    e.steps = (int64_t)steps;
    e.bytes_per_element = bytes_per_element(s, false);
    e.peak_bytes_per_element = bytes_per_element(s, true);
    e.frames = frames(c, steps, e.dt);
    e.written = rg_snapshots_elements(s);
    e.frame_bytes = rg_snapshots_frame_bytes(c) * (double)e.written;
    e.seconds = 1.3 * s->pass_seconds * (double)e.steps; /* a step is a pass, the update and some output */
    find_worst_zone(s, &e);
    e.of_material = count_materials(s); /* now that the memory has been counted */
    return e;
}

void rg_estimate_warn(const rg_case *c, const rg_estimate *e) {
    for (int i = 0; i <= c->others; i++) {
        if (e->of_material[i] == 0) {
            rg_warn("%s: %s %s: later materials claim all of its elements", c->path,
                    i == 0 ? "material" : "materials:", rg_case_material_name(c, i));
        }
    }
}

/* What the checks of a user's material found. */
static void print_user(const rg_user_input *user, FILE *out) {
    const rg_user_facts *facts = user->is.library->facts;
    const rg_user_report *r = &user->report;
    fprintf(out, "library        %s of %s (%016" PRIx64 ")\n", facts->name, user->library.path,
            user->library.hash);
    fprintf(out, "checked        stress ");
    if (r->energetic) {
        fprintf(out, "the derivative of the energy to %.1e, ", r->energy);
    } else {
        fprintf(out, "without an energy, so that energy.csv will not add up, ");
    }
    fprintf(out, "turns with the solid to %.1e, Kirchhoff's symmetric to %.1e, the tangent to %.1e\n",
            r->turned, r->symmetric, r->tangent);
    fprintf(out,
            "               acoustic tensor at rest %.4g to %.4g times the declared, strained %.3g of the "
            "bound\n",
            r->modulus[0], r->modulus[1], r->stiffening);
    if (r->path) {
        fprintf(out,
                "               a cycle adds up to %.1e of its work, %.2g of which it sets free, and turns "
                "with the "
                "solid to %.1e; stress of a step is that of the state after it to %.1e\n",
                r->balance, r->released, r->path_turned, r->step);
    }
}

static void print_material(const rg_solver *s, const rg_estimate *e, int i, FILE *out) {
    const rg_material *m = &s->model->material[i];
    double limit, speed;
    char name[160] = "";
    if (s->model->materials > 1) {
        snprintf(name, sizeof name, "%s: %" PRId64 " elements, ", rg_case_material_name(s->input, i),
                 e->of_material[i]);
    }
    fprintf(out, "material       %s%s%s\n", name, rg_material_word(m->model),
            m->model == RG_MATERIAL_LINEAR_ELASTIC ? ": for small strains and rotations alone" : "");
    double fastest = rg_material_dilatational(m);
    if (m->model == RG_MATERIAL_ANISOTROPIC) {
        fprintf(out, "wave speeds    %.1f to %.1f m/s, by direction and kind\n", rg_material_slowest(m),
                fastest);
    } else {
        fprintf(out, "wave speeds    dilatational %.1f m/s, shear %.1f m/s\n", fastest, rg_material_shear(m));
    }
    if (fastest < SLOWEST_WAVE || fastest > FASTEST_WAVE) {
        fprintf(
            out,
            "warning: no solid carries waves at %.3g m/s: are its moduli in Pa and its density in kg/m3?\n",
            fastest);
    }
    if (m->model == RG_MATERIAL_USER) {
        print_user(&rg_case_material(s->input, i)->user, out);
    }
    if (rg_material_plastic_wave(m, &limit, &speed)) {
        fprintf(out, "plastic waves  %.1f m/s, beyond %.4g Pa in uniaxial strain\n", speed, limit);
    }
}

/* What is there beside the first few of very many materials. */
static void print_others(const rg_solver *s, FILE *out) {
    double least = INFINITY, most = 0;
    for (int i = MOST_TOLD; i < s->model->materials; i++) {
        double speed = rg_material_dilatational(&s->model->material[i]);
        least = fmin(least, speed);
        most = fmax(most, speed);
    }
    fprintf(out, "materials      %d others, with dilatational waves of %.1f to %.1f m/s%s\n",
            s->model->materials - MOST_TOLD, least, most,
            s->model->materials > RG_LEDGER_MATERIALS ? "; energy.csv has no columns for each of so many"
                                                      : "");
}

/* What the case does not say: mass and inertia made of a density, and the area of what is tied. */
static void print_body(const rg_solver *s, int i, FILE *out) {
    const rg_body *b = &s->bodies->body[i];
    const double *moment = b->inertia.moment;
    char tied[300];
    rg_ties_describe(s->ties, i, tied, sizeof tied);
    if (!b->turns && tied[0] == '\0') {
        return;
    }
    fprintf(out, "body           %s:", b->input->name);
    if (b->input->motion == RG_MOTION_FREE) {
        fprintf(out, " %.4g kg, principal moments %.4g, %.4g, %.4g kg m2", b->mass, moment[0], moment[1],
                moment[2]);
    } else {
        fputs(" prescribed", out);
    }
    fprintf(out, "%s%s\n", tied[0] != '\0' ? ", tied to " : "", tied);
}

void rg_estimate_print(const rg_solver *s, const rg_estimate *e, FILE *out) {
    const rg_case *c = s->input;
    fprintf(out, "elements       %" PRId64 " (%" PRId64 " degrees of freedom), %" PRId64 " interfaces\n",
            e->elements, e->dofs, e->interfaces);
    const double(*box)[3] = (const double(*)[3])s->part->box;
    fprintf(out, "body           %.4g x %.4g x %.4g m\n", box[1][0] - box[0][0], box[1][1] - box[0][1],
            box[1][2] - box[0][2]);
    if (s->ranks > 1) {
        fprintf(out, "partition      ");
        rg_quality_print(&s->part->quality, s->part->interfaces, out);
    }
    for (int i = 0; i < s->model->materials && i < MOST_TOLD; i++) {
        print_material(s, e, i, out);
    }
    if (s->model->materials > MOST_TOLD) {
        print_others(s, out);
    }
    for (int i = 0; i < c->boundaries; i++) {
        char words[300];
        rg_constraints_describe(s->constraints, i, words, sizeof words);
        fprintf(out, "boundary       %s%s%s\n", c->boundary[i].name != NULL ? c->boundary[i].name : "",
                c->boundary[i].name != NULL ? ": " : "", words);
    }
    for (int i = 0; i < c->loads; i++) {
        char words[400];
        rg_loads_describe(s->loads, i, words, sizeof words);
        fprintf(out, "load           %s%s%s\n", c->load[i].name != NULL ? c->load[i].name : "",
                c->load[i].name != NULL ? ": " : "", words);
    }
    for (int i = 0; i < c->bodies; i++) {
        print_body(s, i, out);
    }
    for (int i = 0; i < c->interface.sets; i++) {
        if (s->model->open_area != NULL && c->interface.set[i].open) {
            char words[80];
            rg_opening_describe(s, i, words, sizeof words);
            fprintf(out, "opening        %s\n", words);
        }
    }
    if (s->initial_stress.largest > 0) {
        fprintf(out, "initial stress up to %.4g Pa%s%s\n", s->initial_stress.largest,
                c->stress_of.run != NULL ? ", of the fields of " : "",
                c->stress_of.run != NULL ? c->stress_of.run : "");
    }
    if (c->start == RG_START_RELAX) {
        fprintf(out,
                "start          relax: damping brings the body to rest first, to %.2g of the loads in at "
                "most %" PRId64 " steps\n",
                c->relax.tolerance, c->relax.steps);
    }
    if (c->start == RG_START_STATIC) {
        fprintf(out, "start          static: the run finds the equilibrium first, a pass over all forces an "
                     "iteration\n");
    }
    fprintf(out,
            "time step      %.4g s = %.3g of the critical %.4g s, set by element %" PRId64
            " with its faces %s\n",
            e->dt, c->time.safety, e->dt_critical, s->limiting, s->limiting_state);
    if (s->bodies->omega2 > 0) {
        fprintf(out, "               shorter by %.2g %% for what may touch bodies\n",
                100 * (1 - sqrt(1 - s->bodies->omega2 / s->omega2)));
    }
    if (s->contacts != NULL) {
        fprintf(out, "               shorter by up to %.2g %% while fragments touch\n",
                100 * (1 - sqrt(s->omega2 / (s->omega2 + rg_contacts_omega2(s->contacts)))));
    }
    fprintf(out, "steps          %" PRId64 " to %.4g s\n", e->steps,
            fmin(c->time.end, (double)e->steps * e->dt));
    fprintf(
        out,
        "memory         %.0f bytes per element, at most %.0f (output, cracks everywhere); %.3g GB in all\n",
        e->bytes_per_element, e->peak_bytes_per_element,
        e->peak_bytes_per_element * (double)e->elements * 1e-9);
    if (e->frames > 0) {
        fprintf(out,
                "disk           %.3g GB: %.0f frames of %.3g GB, and what cracks take; less by compression\n",
                e->frames * e->frame_bytes * 1e-9, e->frames, e->frame_bytes * 1e-9);
    }
    if (c->output.fields != 0 && c->output.region != NULL) {
        fprintf(out, "output         fields of %" PRId64 " elements: output.region\n", e->written);
    }
    fprintf(out, "time loop      about ");
    print_seconds(e->seconds, out);
    fprintf(out, " on %d ranks x %d threads (%s, %s precision)\n", s->ranks, s->threads, s->kernels->name,
            RG_PRECISION);
    if (e->seconds > 30.0 * DAY) {
        fprintf(out, "warning: it would run for months: is time.end in seconds, and the mesh in metres?\n");
    }
    if (s->model->law.activation == RG_ACTIVATION_CONSERVING && c->time.safety > steady_safety(c)) {
        fprintf(out,
                "warning: with interface.onset %.3g no step of time.safety above %.2g follows points that "
                "have just "
                "switched; the energy will show it\n",
                c->interface.onset, steady_safety(c));
    }
    if (c->interface.law == RG_LAW_USER) {
        const rg_user_law_input *user = &c->interface.user;
        fprintf(out,
                "law            %s of %s (%016" PRIx64
                "): opening takes %.6g of the energy, %.1e of which its "
                "stored and dissipated work leave out\n",
                user->is->facts->name, user->library.path, user->library.hash, user->share, user->closed);
    }
    if (isfinite(e->cohesive_zone)) {
        double ratio = e->cohesive_zone / e->zone_edge;
        fprintf(out,
                "cohesive zone  %.3g m, %.2g times the longest edge (%.3g m) of the face that resolves it "
                "worst\n",
                e->cohesive_zone, ratio, e->zone_edge);
        if (ratio < 2) {
            fprintf(
                out,
                "warning: the cohesive zone is not resolved: it should span at least two edges, here %.2g; "
                "the dissipated energy will depend on the mesh; edges of %.2g m or %.2g of the strength "
                "there "
                "would resolve it\n",
                ratio, e->cohesive_zone / 2, sqrt(ratio / 2));
        }
    }
}
