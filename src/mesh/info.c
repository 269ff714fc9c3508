#include "mesh/info.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "base/tet.h"
#include "base/vector.h"
#include "layout.h"
#include "mesh/check.h"

enum { QUALITY_BINS = 10, ASPECT_BINS = 8, ANGLE_BINS = 9, MOST_CLASSES = 32, SMALLEST = 5 };

#define PI 3.14159265358979323846

struct shape {
    double quality; /* 3 inradius / circumradius */
    double height;  /* smallest (m) */
    double aspect;  /* longest edge / smallest height, over that of the regular tetrahedron: 1 and more */
    double volume;
    double angle[6]; /* dihedral, between faces f < g (degrees) */
};

struct totals {
    rg_gid quality[QUALITY_BINS], aspect[ASPECT_BINS], angle[ANGLE_BINS], classes[MOST_CLASSES];
    rg_gid worst, longest, smallest[SMALLEST];
    double worst_quality, worst_aspect, smallest_height[SMALLEST], largest_height, volume, low_angle,
        high_angle;
};

/* ---- one element ---- */

static void edge(const rg_mesh *mesh, rg_gid e, int from, int to, double out[3]) {
    for (int i = 0; i < 3; i++) {
        out[i] = mesh->x[3 * mesh->corner[4 * e + to] + i] - mesh->x[3 * mesh->corner[4 * e + from] + i];
    }
}

/* Twice the area of face f, as a vector out of the element. */
static void face_vector(const rg_mesh *mesh, rg_gid e, int f, double out[3]) {
    double u[3], v[3], inward[3];
    edge(mesh, e, rg_face_node[f][0], rg_face_node[f][1], u);
    edge(mesh, e, rg_face_node[f][0], rg_face_node[f][2], v);
    edge(mesh, e, rg_face_node[f][0], f, inward);
    rg_vector_cross(u, v, out);
    double sign = rg_vector_dot(out, inward) > 0 ? -1 : 1;
    for (int i = 0; i < 3; i++) {
        out[i] *= sign;
    }
}

/* Radius of the sphere through the corners: |a^2 (b x c) + b^2 (c x a) + c^2 (a x b)| / (12 V), with the
 * edges a, b, c from one corner. */
static double circumradius(const rg_mesh *mesh, rg_gid e, double volume) {
    double a[3][3], sum[3] = {0, 0, 0};
    for (int k = 0; k < 3; k++) {
        edge(mesh, e, 0, k + 1, a[k]);
    }
    for (int k = 0; k < 3; k++) {
        double n[3];
        rg_vector_cross(a[(k + 1) % 3], a[(k + 2) % 3], n);
        for (int i = 0; i < 3; i++) {
            sum[i] += rg_vector_dot(a[k], a[k]) * n[i];
        }
    }
    return sqrt(rg_vector_dot(sum, sum)) / (12 * volume);
}

static struct shape measure(const rg_mesh *mesh, rg_gid e) {
    struct shape s;
    double n[4][3], area = 0, largest = 0;
    const rg_gid *c = mesh->corner + 4 * e;
    s.volume =
        fabs(rg_tet_volume(mesh->x + 3 * c[0], mesh->x + 3 * c[1], mesh->x + 3 * c[2], mesh->x + 3 * c[3]));
    for (int f = 0; f < 4; f++) {
        face_vector(mesh, e, f, n[f]);
        double here = 0.5 * sqrt(rg_vector_dot(n[f], n[f]));
        area += here;
        largest = fmax(largest, here);
    }
    s.height = 3 * s.volume / largest;
    s.aspect = rg_mesh_longest_edge(mesh, e) / s.height * sqrt(2.0 / 3);
    s.quality = 3 * (3 * s.volume / area) / circumradius(mesh, e, s.volume);
    for (int f = 1, k = 0; f < 4; f++) {
        for (int g = 0; g < f; g++, k++) {
            double cosine =
                -rg_vector_dot(n[f], n[g]) / sqrt(rg_vector_dot(n[f], n[f]) * rg_vector_dot(n[g], n[g]));
            s.angle[k] = acos(fmax(-1, fmin(1, cosine))) * 180 / PI;
        }
    }
    return s;
}

/* ---- all ---- */

static int bin(double fraction, int bins) {
    int b = (int)(fraction * bins);
    return b < bins ? b : bins - 1;
}

/* Keeps the smallest heights, ascending; the lower number first among equals. */
static void rank_height(struct totals *t, rg_gid e, double height) {
    int at = SMALLEST;
    while (at > 0 && height < t->smallest_height[at - 1]) {
        at--;
    }
    for (int i = SMALLEST - 1; i > at; i--) {
        t->smallest[i] = t->smallest[i - 1];
        t->smallest_height[i] = t->smallest_height[i - 1];
    }
    if (at < SMALLEST) {
        t->smallest[at] = e;
        t->smallest_height[at] = height;
    }
}

/* Upper ends of the classes of aspect ratio, but for the last. */
static const double aspect_end[] = {1.5, 2, 3, 5, 10, 20, 50};

static void count_aspect(struct totals *t, rg_gid e, double aspect) {
    int b = 0;
    while (b < ASPECT_BINS - 1 && aspect >= aspect_end[b]) {
        b++;
    }
    t->aspect[b]++;
    if (aspect > t->worst_aspect) {
        t->worst_aspect = aspect;
        t->longest = e;
    }
}

static void count(struct totals *t, rg_gid e, const struct shape *s) {
    t->quality[bin(s->quality, QUALITY_BINS)]++;
    if (s->quality < t->worst_quality) {
        t->worst_quality = s->quality;
        t->worst = e;
    }
    for (int k = 0; k < 6; k++) {
        t->angle[bin(s->angle[k] / 180, ANGLE_BINS)]++;
        t->low_angle = fmin(t->low_angle, s->angle[k]);
        t->high_angle = fmax(t->high_angle, s->angle[k]);
    }
    count_aspect(t, e, s->aspect);
    t->volume += s->volume;
    t->largest_height = fmax(t->largest_height, s->height);
    rank_height(t, e, s->height);
}

static struct totals measure_all(const rg_mesh *mesh) {
    struct totals t = {.worst_quality = INFINITY, .low_angle = 180};
    for (int i = 0; i < SMALLEST; i++) {
        t.smallest_height[i] = INFINITY;
        t.smallest[i] = -1;
    }
    double *height = RG_NEW(double, (size_t)mesh->elements);
    for (rg_gid e = 0; e < mesh->elements; e++) {
        struct shape s = measure(mesh, e);
        height[e] = s.height;
        count(&t, e, &s);
    }
    for (rg_gid e = 0; e < mesh->elements; e++) {
        double octave = floor(log2(height[e] / t.smallest_height[0]));
        t.classes[octave < MOST_CLASSES ? (int)fmax(0, octave) : MOST_CLASSES - 1]++;
    }
    rg_free(height);
    return t;
}

/* ---- words ---- */

/* How many of group[count] are in each set. [sets]; the caller frees it. */
static rg_gid *count_members(const rg_sets *s, const int32_t *group, rg_gid count) {
    rg_gid *members = RG_NEW(rg_gid, (size_t)s->count + 1);
    for (rg_gid i = 0; i < count; i++) {
        int32_t sets;
        const int32_t *set = rg_sets_of(s, &group[i], &sets);
        for (int32_t k = 0; k < sets; k++) {
            members[set[k]]++;
        }
    }
    return members;
}

/* Groups of the faces between two elements, from the first of them; of the others -1. [elements][4] */
static int32_t *groups_inside(const rg_mesh *mesh) {
    int32_t *group = RG_NEW(int32_t, 4 * (size_t)mesh->elements);
    for (rg_gid slot = 0; slot < 4 * mesh->elements; slot++) {
        group[slot] = mesh->neighbour[slot] > slot / 4 ? mesh->set[slot] : -1;
    }
    return group;
}

static void print_sets(const rg_mesh *mesh, FILE *out) {
    rg_gid free_faces = 0, free_elements = 0;
    int32_t *group = groups_inside(mesh);
    rg_gid *sides = count_members(&mesh->surface, mesh->set, 4 * mesh->elements);
    rg_gid *inside = count_members(&mesh->surface, group, 4 * mesh->elements);
    rg_gid *elements = count_members(&mesh->volume, mesh->region, mesh->region != NULL ? mesh->elements : 0);
    for (rg_gid slot = 0; slot < 4 * mesh->elements; slot++) {
        free_faces += mesh->neighbour[slot] < 0 && mesh->set[slot] < 0;
    }
    for (rg_gid e = 0; e < mesh->elements; e++) {
        free_elements += mesh->region == NULL || mesh->region[e] < 0;
    }
    for (int32_t s = 0; s < mesh->surface.count; s++) {
        fprintf(out, "surface set    %s: %" PRId64 " faces", mesh->surface.name[s], sides[s] - 2 * inside[s]);
        inside[s] > 0 ? fprintf(out, ", and %" PRId64 " between elements\n", inside[s]) : fputc('\n', out);
    }
    if (mesh->crack > 0) {
        fprintf(out, "crack          %s: open from the start\n", mesh->surface.name[mesh->crack - 1]);
    }
    fprintf(out, "               in no surface set: %" PRId64 " faces\n", free_faces);
    for (int32_t s = 0; s < mesh->volume.count; s++) {
        fprintf(out, "volume set     %s: %" PRId64 " elements\n", mesh->volume.name[s], elements[s]);
    }
    fprintf(out, "               in no volume set: %" PRId64 " elements\n", free_elements);
    rg_free(sides);
    rg_free(inside);
    rg_free(group);
    rg_free(elements);
}

static void print_parts(const rg_mesh *mesh, FILE *out) {
    int32_t *part = RG_NEW(int32_t, (size_t)mesh->elements), parts = rg_mesh_parts(mesh, part);
    rg_gid *size = RG_NEW(rg_gid, (size_t)parts);
    for (rg_gid e = 0; e < mesh->elements; e++) {
        size[part[e]]++;
    }
    fprintf(out, "parts          %d that share no face%s:", parts,
            mesh->part != NULL ? ", kept apart where they share no node" : "");
    for (int32_t p = 0; p < parts && p < 8; p++) {
        fprintf(out, " %" PRId64, size[p]);
    }
    fprintf(out, "%s elements\n", parts > 8 ? " ..." : "");
    rg_free(size);
    rg_free(part);
}

static void print_counts(const rg_mesh *mesh, const struct totals *t, FILE *out) {
    double box[2][3];
    rg_gid sides = 0, tile = rg_mesh_tile(mesh);
    rg_mesh_box_around(mesh, box);
    for (rg_gid slot = 0; slot < 4 * mesh->elements; slot++) {
        sides += mesh->neighbour[slot] >= 0;
    }
    fprintf(out,
            "elements       %" PRId64 " in %" PRId64 " tiles, %" PRId64 " vertices, %" PRId64
            " interfaces, %" PRId64 " surface faces\n",
            mesh->elements, (mesh->elements + tile - 1) / tile, mesh->vertices, sides / 2,
            4 * mesh->elements - sides);
    fprintf(out, "box            %g .. %g, %g .. %g, %g .. %g m; volume %.9g m3\n", box[0][0], box[1][0],
            box[0][1], box[1][1], box[0][2], box[1][2], t->volume);
}

static void print_bins(const char *title, double top, int bins, const rg_gid *number, FILE *out) {
    fprintf(out, "%s\n", title);
    for (int b = 0; b < bins; b++) {
        fprintf(out, "  %5.4g .. %-5.4g  %12" PRId64 "\n", top * b / bins, top * (b + 1) / bins, number[b]);
    }
}

static void print_aspects(const rg_mesh *mesh, const struct totals *t, FILE *out) {
    fprintf(out, "aspect ratio   longest edge / smallest height, 1 for the regular tetrahedron\n");
    for (int b = 0; b < ASPECT_BINS; b++) {
        fprintf(out, "  %5.4g .. %-5.4g  %12" PRId64 "\n", b > 0 ? aspect_end[b - 1] : 1,
                b < ASPECT_BINS - 1 ? aspect_end[b] : INFINITY, t->aspect[b]);
    }
    fprintf(out, "  worst %.4g: element %" PRId64 " (%" PRId64 " in the input)\n", t->worst_aspect,
            t->longest, rg_mesh_original(mesh, t->longest));
}

static void print_smallest(const rg_mesh *mesh, const struct totals *t, FILE *out) {
    fprintf(out, "heights        %.4g .. %.4g m; smallest:\n", t->smallest_height[0], t->largest_height);
    for (int i = 0; i < SMALLEST && t->smallest[i] >= 0; i++) {
        const double *x = mesh->x + 3 * mesh->corner[4 * t->smallest[i]];
        fprintf(out, "  %.4g m element %" PRId64 " (%" PRId64 " in the input) at (%.4g, %.4g, %.4g) m\n",
                t->smallest_height[i], t->smallest[i], rg_mesh_original(mesh, t->smallest[i]), x[0], x[1],
                x[2]);
    }
}

static void print_classes(const struct totals *t, double speed, FILE *out) {
    fprintf(out, "time steps     smallest height over %g m/s, in factors of 2\n", speed);
    int last = MOST_CLASSES - 1;
    while (t->classes[last] == 0) { /* the smallest element is of class 0 */
        last--;
    }
    for (int k = 0; k <= last; k++) {
        double low = t->smallest_height[0] / speed * ldexp(1, k);
        fprintf(out, "  %.4g .. %.4g s %12" PRId64 "\n", low, 2 * low, t->classes[k]);
    }
}

void rg_mesh_info(const rg_mesh *mesh, double speed, FILE *out) {
    struct totals t = measure_all(mesh);
    print_counts(mesh, &t, out);
    print_parts(mesh, out);
    print_sets(mesh, out);
    print_bins("quality        3 inradius / circumradius, elements", 1, QUALITY_BINS, t.quality, out);
    fprintf(out, "  worst %.4g: element %" PRId64 " (%" PRId64 " in the input)\n", t.worst_quality, t.worst,
            rg_mesh_original(mesh, t.worst));
    print_aspects(mesh, &t, out);
    print_bins("angles         between faces, degrees", 180, ANGLE_BINS, t.angle, out);
    fprintf(out, "  from %.4g to %.4g degrees\n", t.low_angle, t.high_angle);
    print_smallest(mesh, &t, out);
    print_classes(&t, speed, out);
}

/* ---- partitions ---- */

void rg_quality_print(const rg_partition_quality *q, rg_gid interfaces, FILE *out) {
    fprintf(out, "imbalance %.3f", q->imbalance);
    if (q->cost_imbalance < q->imbalance || q->cost_imbalance > q->imbalance) {
        fprintf(out, " (%.3f of the cost)", q->cost_imbalance);
    }
    double share = interfaces > 0 ? 100 * (double)q->cut_faces / (double)interfaces : 0;
    fprintf(out,
            ", %" PRId64
            " faces between ranks (%.3g %% of all), neighbours of a rank: at most %d, mean %.3g\n",
            q->cut_faces, share, q->neighbours_max, q->neighbours_mean);
}

void rg_mesh_info_partitions(rg_mesh_file *f, FILE *out) {
    int *parts, count = rg_mesh_file_partitions(f, &parts);
    rg_tile_graph *g = rg_mesh_file_graph(f);
    int32_t *owner = RG_NEW(int32_t, (size_t)g->tiles);
    fprintf(out, "partitions     %s\n", count > 0 ? "for ranks" : "none stored: a run makes its own");
    for (int p = 0; p < count; p++) {
        rg_mesh_file_partition(f, parts[p], owner);
        rg_partition_quality q = rg_tile_graph_quality(g, parts[p], owner);
        fprintf(out, "  %-12d ", parts[p]);
        rg_quality_print(&q, rg_mesh_file_header(f)->interfaces, out);
    }
    rg_free(owner);
    rg_tile_graph_free(g);
    rg_free(parts);
}
