#include "output/summary.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "base/files.h"
#include "base/h5_parallel.h"
#include "base/json.h"
#include "base/mem.h"
#include "diagnostics/state_hash.h"
#include "revision.h"
#include "solver/step.h"

static void write_bodies(FILE *f, const rg_bodies *b) {
    if (b->count == 0) {
        return;
    }
    fputs("  \"bodies\": [\n", f);
    for (int i = 0; i < b->count; i++) {
        const rg_body_seen *seen = &b->body[i].seen;
        fputs("  {\n", f);
        rg_json_vector(f, "position", seen->x);
        rg_json_vector(f, "velocity", seen->v);
        rg_json_vector(f, "force", seen->force);
        if (b->body[i].turns) {
            rg_json_vector(f, "angular_velocity", b->body[i].turn.seen_spin);
            rg_json_vector(f, "moment", b->body[i].turn.moment);
        }
        fprintf(f, "  \"name\": \"%s\"}%s\n", b->body[i].input->name, i + 1 < b->count ? "," : "],");
    }
}

static void write_materials(FILE *f, const rg_solver *s, const rg_estimate *e) {
    fputs("  \"materials\": [\n", f);
    for (int i = 0; i < s->model->materials; i++) {
        fputs("  {\n", f);
        rg_json_text(f, "name", rg_case_material_name(s->input, i));
        rg_json_integer(f, "elements", e->of_material[i]);
        fprintf(f, "  \"model\": \"%s\"}%s\n", rg_material_word(rg_case_material(s->input, i)->model),
                i + 1 < s->model->materials ? "," : "],");
    }
}

static void write_run(FILE *f, const rg_summary *m, const rg_solver *s, const rg_estimate *e) {
    rg_json_text(f, "case", s->input->name);
    rg_json_integer(f, "elements", e->elements);
    rg_json_integer(f, "interfaces", e->interfaces);
    rg_json_integer(f, "dofs", e->dofs);
    write_materials(f, s, e);
    rg_json_integer(f, "ranks", s->ranks);
    rg_json_integer(f, "threads", s->threads);
    rg_json_integer(f, "partitions", m->partitions);
    rg_json_number(f, "imbalance", s->part->quality.imbalance);
    rg_json_number(f, "cost_imbalance", s->part->quality.cost_imbalance);
    rg_json_integer(f, "cut_faces", s->part->quality.cut_faces);
    rg_json_integer(f, "neighbours_max", s->part->quality.neighbours_max);
    rg_json_text(f, "instruction_set", s->kernels->name);
    rg_json_text(f, "precision", RG_PRECISION);
    if (m->equilibrium.passes > 0) {
        rg_json_number(f, "static_residual", m->equilibrium.residual);
        rg_json_integer(f, "static_passes", m->equilibrium.passes);
    }
    if (s->input->start == RG_START_RELAX) {
        rg_json_number(f, "relax_heat_J", s->relaxed.heat);
        rg_json_number(f, "relax_work_J", s->relaxed.work);
    }
    if (s->prestress != NULL) {
        rg_json_number(f, "stress_out_of_balance", m->stress_out_of_balance);
    }
    rg_json_integer(f, "steps", s->step);
    rg_json_integer(f, "restarted_from_step", m->first_step);
    rg_json_number(f, "time_end", s->time);
    rg_json_number(f, "dt_critical", e->dt_critical);
    rg_json_number(f, "dt_first", m->dt_first);
    rg_json_number(f, "dt_last", s->dt);
    rg_json_integer(f, "limiting_element", s->limiting);
    rg_json_text(f, "limiting_state", s->limiting_state);
    rg_json_number(f, "setup_s", m->setup_seconds);
    rg_json_number(f, "wall_s", m->loop_seconds + m->output_seconds);
    rg_json_number(f, "output_s", m->output_seconds);
    rg_json_integer(f, "checkpoints", m->checkpoints);
    rg_json_number(f, "checkpoint_s", m->checkpoint_seconds);
    rg_json_number(f, "checkpoint_median_s", m->checkpoint_median);
    rg_json_number(f, "halo_wait_s", m->halo_wait_seconds);
    rg_json_number(f, "us_per_tet_step", m->us_per_tet_step);
}

static void write_physics(FILE *f, const rg_summary *m, const rg_ledger *l) {
    rg_json_number(f, "energy_error_rel", rg_ledger_worst(l));
    rg_json_number(f, "energy_error_dissipated", rg_ledger_share(l));
    rg_json_number(f, "energy_largest_J", l->largest);
    rg_json_number(f, "dissipated_J", l->last.dissipated);
    rg_json_number(f, "plastic_J", l->last.plastic);
    rg_json_number(f, "damage_J", l->last.damage);
    rg_json_number(f, "viscous_J", l->last.viscous);
    rg_json_number(f, "friction_J", l->last.friction);
    rg_json_number(f, "unresolved_J", l->last.unresolved);
    if (m->unresolved.value != 0) {
        rg_json_number(f, "unresolved_most_J", m->unresolved.value);
        rg_json_vector(f, "unresolved_most_at", m->unresolved.place);
    }
    rg_json_number(f, "first_fracture_time_s", m->first_fracture);
    rg_json_number(f, "broken_area_m2", l->last.broken_area);
    rg_json_number(f, "failed_area_m2", l->last.failed_area);
    rg_json_number(f, "halo_doubles_per_face",
                   (RG_TRACE_ROW + RG_TILE_FACE_ROW) * (double)sizeof(rg_real) / sizeof(double));
    rg_json_vector(f, "momentum", l->last.momentum);
    rg_json_vector(f, "angular_momentum", l->last.angular_momentum);
    rg_json_text(f, "status", m->failure[0] == '\0' ? "completed" : m->failure);
}

/* That pairs of faces exerted on each other, with the size of their forces (N s): each gave it to two
 * elements. */
static double contact_impulse(const rg_solver *s) {
    rg_exact_sum sum = {0};
    for (size_t slot = 0; slot < s->domain->blocks * RG_LANES; slot++) {
        rg_exact_add(&sum, 0.5 * s->contact_impulse[slot]);
    }
    rg_exact_allreduce(&sum, 1, s->comm);
    return rg_exact_value(&sum);
}

void rg_summary_write(rg_summary *m, rg_solver *s, const rg_ledger *l, const rg_fragment_table *fragments) {
    const rg_estimate *e = &m->estimate;
    uint64_t hash = rg_state_hash(s);
    double impulse = s->contacts != NULL ? contact_impulse(s) : 0;
    m->first_fracture = rg_first_fracture(s);
    m->unresolved = l->unresolved;
    rg_halo *halo[3];
    int halos = rg_solver_halos(s, halo);
    double work = (double)e->elements * (double)(s->step - m->first_step);
    m->us_per_tet_step = work > 0 ? 1e6 * m->loop_seconds * s->ranks * s->threads / work : 0;
    rg_phases_report phases = rg_phases_gather(&s->phases, s->domain, halo, halos, s->comm);
    m->halo_wait_seconds = phases.phase[RG_PHASE_WAIT].most;
    if (s->rank != 0) {
        return;
    }
    FILE *f = rg_open_in(s->input->output.dir, "summary.json");
    fputs("{\n", f);
    write_run(f, m, s, e);
    rg_json_number(f, "exchange_alone_s", s->exchange_seconds);
    rg_phases_write(&phases, f);
    write_physics(f, m, l);
    if (s->contacts != NULL) {
        rg_json_integer(f, "contacts", s->contacts_most);
        rg_json_number(f, "contact_impulse_Ns", impulse);
    }
    write_bodies(f, s->bodies);
    rg_json_integer(f, "overlaps", isfinite(fragments->overlap_time));
    rg_fragment_table_summary(fragments, f);
    rg_json_number(f, "bytes_per_tet", e->bytes_per_element);
    fprintf(f, "  \"state_hash\": \"%016" PRIx64 "\",\n  \"revision\": \"%s\"\n}\n", hash, RG_REVISION);
    rg_close_in(f, s->input->output.dir, "summary.json");
}

bool rg_completed(const char *dir) {
    char *path = rg_join_path(dir, "summary.json"), line[256];
    FILE *f = fopen(path, "r");
    rg_free(path);
    bool found = false;
    while (f != NULL && !found && fgets(line, sizeof line, f) != NULL) {
        found = strstr(line, "\"status\": \"completed\"") != NULL;
    }
    if (f != NULL) {
        fclose(f);
    }
    return found;
}

void rg_summary_print(const rg_summary *m, const rg_solver *s, const rg_ledger *l, FILE *out) {
    fprintf(out,
            "set-up %.2f s, time loop %.2f s, output %.2f s: %.3g us of core time per element and step\n",
            m->setup_seconds, m->loop_seconds, m->output_seconds, m->us_per_tet_step);
    fprintf(out, "energy error %.2g of the largest energy, %.4g J", rg_ledger_worst(l), l->largest);
    if (isfinite(rg_ledger_share(l))) {
        fprintf(out, "; %.2g of all that was dissipated, %.4g J", rg_ledger_share(l), l->last.spent);
    }
    fputc('\n', out);
    if (s->openings.released != 0) {
        fprintf(out, "%.3g J came free where faces opened at their time\n", s->openings.released);
    }
    double unresolved = l->last.unresolved - s->openings.released;
    if (unresolved > 0) {
        fprintf(out,
                "%.3g J came free where faces broke beyond what their law can take: the mesh does not "
                "resolve them\n",
                unresolved);
    } else if (unresolved < 0) {
        fprintf(out, "%.3g J were lent to contact and friction of faces that broke under pressure\n",
                -unresolved);
    }
    if (m->unresolved.value != 0) {
        const double *x = m->unresolved.place;
        fprintf(out, "  most at one face: %.3g J, at (%.4g, %.4g, %.4g) m\n", fabs(m->unresolved.value), x[0],
                x[1], x[2]);
    }
    if (isfinite(m->first_fracture)) {
        fprintf(out, "first fracture at %.5g s; failed %.4g m2, broken %.4g m2, dissipated %.4g J\n",
                m->first_fracture, l->last.failed_area, l->last.broken_area, l->last.dissipated);
    }
    for (int i = 0; i < s->bodies->count; i++) {
        const rg_body_seen *b = &s->bodies->body[i].seen;
        fprintf(out, "%s: at (%.4g, %.4g, %.4g) m, velocity (%.4g, %.4g, %.4g) m/s\n",
                s->bodies->body[i].input->name, b->x[0], b->x[1], b->x[2], b->v[0], b->v[1], b->v[2]);
    }
    fprintf(out, "results in %s\n", s->input->output.dir);
}
