/* Set-up of the twin. */
#include "support/step_twin_geometry.h"

#include <string.h>

#include "base/mem.h"
#include "cohesive/facts.h"

/* ---- Elements ---- */

static void set_geometry(twin *w, size_t e) {
    double volume = volume_of(w, e);
    size_t s = w->slot[e];
    for (int k = 0; k < 3; k++) { /* grad l_k is normal to face k, 1 over the height there */
        double edge[2][3], area[3], across[3];
        area_vector(w, e, k, edge, area);
        subtract(corner(w, e, k), corner(w, e, rg_face_node[k][0]), across);
        double over = rg_reference_dot(area, across);
        for (int c = 0; c < 3; c++)
            w->geom[rg_geom_index(s, RG_GEOM_GRAD + 3 * k + c)] = (rg_real)(area[c] / over);
    }
    w->geom[rg_geom_index(s, RG_GEOM_VOLUME)] = (rg_real)volume;
}

/* Elements of each material in whole blocks, by falling number: in another order than the solver's. */
static void place_elements(twin *w) {
    size_t count = 0;
    for (size_t e = 0; e < w->elements; e++) {
        double middle[3] = {0, 0, 0};
        for (int k = 0; k < 12; k++)
            middle[k % 3] += corner(w, e, k / 3)[k % 3] / 4;
        for (int m = 0; m < w->input->others; m++)
            if (rg_expr_value(w->input->other[m].where, middle, 0) != 0)
                w->of[e] = m + 1;
    }
    for (int m = 0; m <= w->input->others; m++) {
        for (size_t e = w->elements; e-- > 0;)
            if (w->of[e] == m)
                w->slot[e] = count++;
        count = (count + RG_LANES - 1) / RG_LANES * RG_LANES;
        w->begin[m + 1] = count / RG_LANES;
    }
    w->blocks = count / RG_LANES;
}

/* ---- Materials and law ---- */

static void set_material(const rg_material_input *in, rg_material *m) {
    *m = (rg_material){.model = in->model, .density = in->density};
    if (in->model == RG_MATERIAL_DESHPANDE_EVANS) {
        m->of.deshpande_evans.parameters = in->deshpande_evans;
        m->of.deshpande_evans.parameters.poisson = in->poisson;
        m->of.deshpande_evans.parameters.density = in->density;
        m->of.deshpande_evans.parameters.yield_stress = in->parameter[RG_PARAMETER_YIELD_STRESS];
        m->mu = in->deshpande_evans.shear;
    } else {
        memcpy(m->of.parameter, in->parameter, sizeof m->of.parameter);
        m->mu = in->young / 2 / (1 + in->poisson);
    }
    m->lambda = 2 * m->mu * in->poisson / (1 - 2 * in->poisson);
    rg_material_prepare(m, 1);
}

static void set_law(twin *w) {
    const rg_case *c = w->input;
    if (c->interface.law == RG_LAW_NONE) {
        w->law =
            (rg_cohesive){.strength = INFINITY, .opening = 1, .separation = 1, .beta = c->interface.beta};
        return;
    }
    rg_law_facts facts =
        rg_law_facts_of(c->interface.law, c->interface.shape[c->interface.law], c->interface.beta);
    double opening = c->interface.energy / facts.work / c->interface.strength;
    w->law = (rg_cohesive){
        .law = c->interface.law,
        .strength = c->interface.strength,
        .opening = opening,
        .beta = facts.forms & RG_NORMAL_MEASURE ? 0 : c->interface.beta,
        .activation = c->interface.activation,
        .onset = c->interface.onset,
        .beta_s = c->interface.beta_s,
        .contact = c->interface.contact,
        .form = c->interface.form,
        .separation = facts.separation * opening,
        .slope =
            c->interface.form == RG_FORM_INTRINSIC ? facts.slope[0] * c->interface.strength / opening : 0,
        .sliding = c->interface.friction > 0 ? RG_SLIDING_COULOMB : RG_SLIDING_FREE,
        .friction = c->interface.friction,
    };
    memcpy(w->law.shape, c->interface.shape[w->law.law], sizeof w->law.shape);
}

/* Strength and critical opening of face f of element e over those of the law. */
static void set_scale(twin *w, size_t i, size_t e, int f, int beside) {
    const rg_case *c = w->input;
    rg_real *scale = w->scale + i / RG_LANES * 2 * RG_LANES + i % RG_LANES;
    scale[0] = scale[RG_LANES] = 1;
    for (int k = 0; k < c->interface.sets; k++) {
        const rg_face_set *set = &c->interface.set[k];
        bool here = set->where == NULL || selects(w, set->where, e, f);
        if (set->between != NULL) {
            int a = rg_case_find_material(c, set->between[0]), b = rg_case_find_material(c, set->between[1]);
            here = here && ((a == w->of[e] && b == beside) || (b == w->of[e] && a == beside));
        }
        if (here) {
            double strength = set->strength > 0 ? set->strength : c->interface.strength;
            double energy = set->energy > 0 ? set->energy : c->interface.energy;
            scale[0] = (rg_real)(strength / c->interface.strength);
            scale[RG_LANES] = (rg_real)(energy / strength / (c->interface.energy / c->interface.strength));
        }
    }
}

/* ---- Interfaces ---- */

static void set_interface(twin *w, size_t i, size_t e, int f) {
    size_t other = (size_t)w->mesh->neighbour[4 * e + (size_t)f];
    int back = w->mesh->face[4 * e + (size_t)f];
    double edge[2][3], area[3], in[3];
    double size = area_vector(w, e, f, edge, area);
    subtract(corner(w, e, f), corner(w, e, rg_face_node[f][0]), in);
    int own = rg_reference_dot(area, in) < 0 ? 0 : 1; /* the area vector points from minus to plus */
    const rg_material *a = &w->material[w->of[e]], *b = &w->material[w->of[other]];
    double lambda = (a->lambda + b->lambda) / 2, mu = (a->mu + b->mu) / 2;
    double h = 3 * fmin(volume_of(w, e), volume_of(w, other)) / size, beta = w->input->interface.beta_s / h;
    bool isotropic = w->input->interface.penalty == RG_PENALTY_ISOTROPIC;
    for (int k = 0; k < 6; k++)
        w->igeom[rg_igeom_index(i, RG_IGEOM_EDGE + k)] = (rg_real)edge[k / 3][k % 3];
    w->igeom[rg_igeom_index(i, RG_IGEOM_PEN_ISO)] =
        (rg_real)(beta * size * (isotropic ? lambda + 2 * mu : mu));
    w->igeom[rg_igeom_index(i, RG_IGEOM_PEN_NORM)] = (rg_real)(isotropic ? 0 : beta / size * (lambda + mu));
    w->side[own][i] = rg_side_link(w->slot[e], f);
    w->side[1 - own][i] = rg_side_link(w->slot[other], back);
    w->interface[rg_link_index(w->slot[e], f)] = rg_link(i, own, 4);
    w->interface[rg_link_index(w->slot[other], back)] = rg_link(i, 1 - own, 4);
    w->neighbour[rg_link_index(w->slot[e], f)] = rg_neighbour_link(w->slot[other], back);
    w->neighbour[rg_link_index(w->slot[other], back)] = rg_neighbour_link(w->slot[e], f);
    w->face[4 * e + (size_t)f] = w->face[4 * other + (size_t)back] = (int32_t)i;
    if (w->scale != NULL)
        set_scale(w, i, e, f, w->of[other]);
}

/* Whether elements share their nodes across a face inside the mesh. */
static bool shares(const twin *w, size_t e, int f) {
    return w->joined && (w->input->interface.faces == NULL || !selects(w, w->input->interface.faces, e, f));
}

static void count_interfaces(twin *w) {
    for (size_t e = 0; e < w->elements; e++)
        for (int f = 0; f < RG_FACES; f++)
            w->interfaces += speaks(w, e, f) && !shares(w, e, f);
    w->iblocks = w->interfaces / RG_LANES + 1;
}

static void make_interfaces(twin *w) {
    size_t i = 0;
    for (size_t k = 0; k < w->blocks * RG_LANES; k++)
        for (int f = 0; f < RG_FACES; f++) {
            w->neighbour[rg_link_index(k, f)] = rg_neighbour_link(k, f);
            w->interface[rg_link_index(k, f)] = RG_NO_INTERFACE;
        }
    for (size_t k = 0; k < 4 * w->elements; k++)
        w->face[k] = -1;
    for (size_t e = 0; e < w->elements; e++)
        for (int f = 0; f < RG_FACES; f++)
            if (speaks(w, e, f) && !shares(w, e, f))
                set_interface(w, i++, e, f);
}

/* Names each copy of a shared node by the lowest of them, by passing names on until nothing changes. */
static void name_nodes(twin *w) {
    for (size_t k = 0; k < RG_NODES * w->elements; k++)
        w->node[k] = k;
    for (bool changed = w->joined; changed;) {
        changed = false;
        for (size_t e = 0; e < w->elements; e++)
            for (int f = 0; f < RG_FACES; f++) {
                rg_gid other = w->mesh->neighbour[4 * e + (size_t)f];
                if (other < 0 || !shares(w, e, f))
                    continue;
                const int *there = rg_face_node[w->mesh->face[4 * e + (size_t)f]];
                for (int a = 0; a < RG_FNODES; a++) {
                    size_t *own = &w->node[RG_NODES * e + (size_t)rg_face_node[f][a]];
                    size_t name = w->node[RG_NODES * (size_t)other + (size_t)there[a]];
                    changed = changed || name < *own;
                    *own = name < *own ? name : *own;
                }
            }
    }
}

/* ---- Prescribed motion ---- */

/* All copies of a node on a face of a set; the last boundary that names one has it. */
static void find_held(twin *w) {
    bool *on = RG_NEW(bool, RG_NODES * w->elements);
    memset(w->held, 0xff, 3 * RG_NODES * w->elements * sizeof *w->held);
    for (int b = 0; b < w->input->boundaries; b++) {
        const rg_boundary *boundary = &w->input->boundary[b];
        memset(on, 0, RG_NODES * w->elements);
        for (size_t e = 0; e < w->elements; e++)
            for (int f = 0; f < RG_FACES; f++) {
                int set = w->mesh->set[4 * e + (size_t)f];
                for (int a = 0; a < RG_FNODES && set >= 0; a++)
                    if (strcmp(w->mesh->surface.name[set], boundary->set) == 0)
                        on[w->node[RG_NODES * e + (size_t)rg_face_node[f][a]]] = true;
            }
        for (size_t k = 0; k < RG_NODES * w->elements; k++)
            if (on[w->node[k]])
                w->held[3 * k + (size_t)boundary->component] = (int16_t)b;
    }
    rg_free(on);
}

/* Mass matrix over the mass, from that of the reference kernel: twice the energy of nodes that move. */
static void mass_matrix(rg_mass mass, double m[RG_NODES][RG_NODES]) {
    _Alignas(64) rg_real v[RG_NODE_BLOCK], geom[RG_GEOM_BLOCK];
    double energy[RG_LANES], own[RG_NODES];
    rg_kinetic_args args = {1, mass, geom, v, energy};
    for (int l = 0; l < RG_GEOM_BLOCK; l++)
        geom[l] = 1;
    for (int pass = 0; pass < 2; pass++)
        for (int a = 0; a < RG_NODES; a++)
            for (int b = 0; b < RG_NODES; b++) {
                memset(v, 0, sizeof v);
                v[rg_node_index(0, a, 0)] = v[rg_node_index(0, b, 0)] = 1;
                rg_reference_kinetic(&args, 0, 1);
                if (pass == 0 && a == b)
                    own[a] = m[a][a] = 2 * energy[0];
                else if (pass == 1 && a != b)
                    m[a][b] = (2 * energy[0] - own[a] - own[b]) / 2;
            }
}

/* ---- Rigid bodies ---- */

static void make_bodies(twin *w) {
    w->body = RG_NEW(twin_body, (size_t)w->input->bodies + 1);
    for (int i = 0; i < w->input->bodies; i++) {
        const rg_body_input *in = &w->input->body[i];
        const double *d = in->shape == RG_SHAPE_PLANE ? in->normal : in->axis;
        double length = in->shape == RG_SHAPE_SPHERE ? 1 : sqrt(rg_reference_dot(d, d));
        w->body[i].mass = in->density > 0 ? in->density * 4 / 3 * acos(-1) * pow(in->radius, 3) : in->mass;
        for (int c = 0; c < 3; c++) {
            w->body[i].direction[c] = d[c] / length;
            w->body[i].x[c] = in->at[c];
            w->body[i].v[c] = body_velocity(in, c, 0);
        }
    }
}

/* ---- Set-up ---- */

twin *twin_make(const rg_case *c, const rg_mesh *mesh) {
    twin *w = RG_NEW(twin, 1);
    *w =
        (twin){.input = c,
               .mesh = mesh,
               .gradient = c->interface.form == RG_FORM_VARIATIONAL || c->interface.form == RG_FORM_CONTINUOUS
                               ? RG_GRADIENT_LIFTED
                               : RG_GRADIENT_OWN,
               .joined = c->interface.form == RG_FORM_CONTINUOUS,
               .elements = (size_t)mesh->elements};
    w->of = RG_NEW(int, w->elements);
    w->slot = RG_NEW(size_t, w->elements);
    w->face = RG_NEW(int32_t, 4 * w->elements);
    w->node = RG_NEW(size_t, RG_NODES * w->elements);
    w->held = RG_NEW(int16_t, 3 * RG_NODES * w->elements);
    w->hold = RG_NEW(twin_hold, 3 * w->elements);
    mass_matrix(c->mass, w->mass);
    place_elements(w);
    int values = 0;
    for (int m = 0; m <= c->others; m++) {
        set_material(rg_case_material(c, m), &w->material[m]);
        int own = rg_material_history(w->material[m].model);
        values = own > values ? own : values;
    }
    set_law(w);
    count_interfaces(w);
    bool memory = c->interface.law != RG_LAW_NONE;
    w->crack_stride = RG_CRACK_BLOCK + (w->law.sliding == RG_SLIDING_COULOMB ? RG_FRICTION_BLOCK : 0);
    if (memory) {
        w->crack_stride +=
            (size_t)rg_law_facts_of(w->law.law, w->law.shape, w->law.beta).memory * RG_POINTS * RG_LANES;
    }
    size_t slots = w->blocks * RG_LANES, islots = w->iblocks * RG_LANES;
    w->history_stride = rg_history_block(values);
    w->history = values > 0 ? RG_NEW(rg_real, w->blocks * w->history_stride) : NULL;
    w->heat = c->viscosity.linear > 0 || c->viscosity.quadratic > 0 ? RG_NEW(double, slots) : NULL;
    rg_real **field[] = {&w->u, &w->velocity, &w->step_velocity, &w->acceleration, &w->force};
    for (size_t k = 0; k < sizeof field / sizeof *field; k++)
        *field[k] = RG_NEW(rg_real, w->blocks * RG_NODE_BLOCK);
    w->traction = RG_NEW(rg_real, w->blocks * RG_TRACTION_BLOCK);
    w->stiffening = RG_NEW(rg_real, slots);
    w->geom = RG_NEW(rg_real, w->blocks * RG_GEOM_BLOCK);
    w->neighbour = RG_NEW(int32_t, slots * RG_FACES);
    w->interface = RG_NEW(int32_t, slots * RG_FACES);
    w->cracked = RG_NEW(uint8_t, w->blocks);
    w->igeom = RG_NEW(rg_real, islots * RG_IGEOM);
    w->iforce = RG_NEW(rg_real, w->iblocks * RG_IFORCE_BLOCK);
    w->turn = RG_NEW(rg_real, w->iblocks * RG_IFORCE_BLOCK);
    w->crack = RG_NEW(rg_real, w->iblocks * w->crack_stride);
    w->scale = c->interface.sets > 0 ? RG_NEW(rg_real, 2 * islots) : NULL;
    w->broken = RG_NEW(uint8_t, islots);
    w->unlinked = RG_NEW(uint8_t, islots);
    w->active = RG_NEW(uint8_t, w->iblocks);
    for (int k = 0; k < 2; k++)
        w->side[k] = RG_NEW(int32_t, islots);
    for (size_t k = 0; k < slots; k++) /* padding: elements of unit size */
        for (int i = 0; i < RG_GEOM; i++)
            w->geom[rg_geom_index(k, i)] = i % 4 == 0 || i == RG_GEOM_VOLUME;
    for (size_t e = 0; e < w->elements; e++)
        set_geometry(w, e);
    make_interfaces(w);
    name_nodes(w);
    find_held(w);
    make_bodies(w);
    if (w->law.form == RG_FORM_INTRINSIC) {
        memset(w->broken, (1 << RG_POINTS) - 1, islots);
        memset(w->unlinked, (1 << RG_POINTS) - 1, islots);
    }
    memset(w->active, 1, w->iblocks);
    memset(w->cracked, 1, w->blocks);
    return w;
}

void twin_start(twin *w) {
    for (size_t k = 0; k < 3 * RG_NODES * w->elements; k++) {
        size_t e = k / (3 * RG_NODES);
        int n = (int)(k % (3 * RG_NODES)) / 3, c = (int)(k % 3);
        w->hold[3 * e + (size_t)c].before[n] = w->velocity[rg_node_index(w->slot[e], n, c)];
        w->hold[3 * e + (size_t)c].place[n] = w->u[rg_node_index(w->slot[e], n, c)];
    }
}

void twin_free(twin *w) {
    void *blocks[] = {w->of,     w->slot,      w->face,          w->node,         w->held,     w->hold,
                      w->u,      w->velocity,  w->step_velocity, w->force,        w->traction, w->stiffening,
                      w->geom,   w->neighbour, w->interface,     w->acceleration, w->cracked,  w->igeom,
                      w->iforce, w->turn,      w->crack,         w->scale,        w->broken,   w->unlinked,
                      w->active, w->side[0],   w->side[1],       w->history,      w->heat,     w->body,
                      w};
    for (size_t k = 0; k < sizeof blocks / sizeof *blocks; k++)
        rg_free(blocks[k]);
}
