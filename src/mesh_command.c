#include "mesh_command.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"
#include "base/files.h"
#include "base/mem.h"
#include "case/case.h"
#include "case/read.h"
#include "mesh/apart.h"
#include "mesh/check.h"
#include "mesh/import/crack.h"
#include "mesh/file.h"
#include "mesh/import/convert.h"
#include "mesh/import/inp_read.h"
#include "mesh/import/vtk_read.h"
#include "mesh/improve/improve.h"
#include "mesh/info.h"
#include "partition/material.h"
#include "partition/mesh_case.h"

static const char usage[] =
    "usage: rhegma mesh IN -o OUT.h5 [options]   a mesh file from Abaqus (.inp), VTK (.vtk .vtu .pvtu),\n"
    "                                               MED (.med), CGNS (.cgns), or\n"
    "                                               what Gmsh reads or meshes (.msh .bdf .unv .geo .step)\n"
    "         --unit U        lengths of IN are in m, cm, mm, um, nm, in or ft; or\n"
    "         --scale S       S: m per unit of IN; STEP and IGES say their own unit\n"
    "         --merge D       nodes as near as D (in the unit of IN) to one another become one\n"
    "         --apart         parts that share no node stay apart where they touch: contact acts between "
    "them\n"
    "         --crack NAME    faces that lie on each other with nodes of their own are a crack, set NAME\n"
    "         --extrude T[,N] a flat mesh of triangles becomes a plate of thickness T (in the unit of IN), "
    "in\n"
    "                         N layers; its edges are faces then, and there are sets bottom and top\n"
    "         --split         cuts hexahedra, wedges and pyramids into tetrahedra\n"
    "         --size D        elements of a geometry: their size, a number or an expression in x, y, z (in\n"
    "                         the unit of IN); --curvature N: N elements at least around a full turn\n"
    "         --improve       makes flat elements less flat\n"
    "         --tile N        256 (without it), 512 or 1024 elements are a tile: see mesh.tile of a case\n"
    "       rhegma mesh CASE.yaml -o OUT.h5 [--set a.b=value]   a mesh file from the mesh of a case\n"
    "       rhegma mesh --info MESH.h5 [--case CASE.yaml]   what a mesh file holds; its time steps with the\n"
    "                                               fastest material of a case, else for waves of 1 m/s\n"
    "       rhegma mesh --partition N[,M...] MESH.h5   store partitions for N, M ... ranks in a mesh file\n";

/* ---- arguments ---- */

static _Noreturn void complain(const char *what, const char *argument) {
    rg_fatal(RG_USAGE, "mesh: %s%s%s\n%s", what, argument[0] != '\0' ? ": " : "", argument, usage);
}

static double read_number(const char *option, const char *text) {
    char *end, what[64];
    double number = strtod(text, &end);
    if (end == text || *end != '\0' || !(number > 0) || !isfinite(number)) {
        snprintf(what, sizeof what, "%s must be a number > 0, not", option);
        complain(what, text);
    }
    return number;
}

static double read_unit(const char *text) {
    static const struct {
        const char *name;
        double scale;
    } units[] = {{"m", 1},     {"cm", 1e-2},   {"mm", 1e-3},  {"um", 1e-6},
                 {"nm", 1e-9}, {"in", 0.0254}, {"ft", 0.3048}};
    for (size_t i = 0; i < sizeof units / sizeof *units; i++) {
        if (strcmp(units[i].name, text) == 0) {
            return units[i].scale;
        }
    }
    complain("--unit is one of m, cm, mm, um, nm, in and ft, not", text);
}

/* THICKNESS[,LAYERS] */
static void read_extrusion(rg_mesh_arguments *a, const char *text) {
    char *end;
    double thickness = strtod(text, &end);
    bool good = end != text && thickness > 0 && isfinite(thickness);
    long layers = 1;
    if (good && *end == ',') {
        const char *number = end + 1;
        layers = strtol(number, &end, 10);
        good = end != number;
    }
    if (!good || *end != '\0' || layers < 1 || layers > 100000) {
        complain("--extrude: a thickness > 0, and perhaps a comma and a number of layers, not", text);
    }
    a->how.thickness = thickness;
    a->how.layers = (int)layers;
}

static rg_expr *read_size(const char *text) {
    char *why = NULL;
    rg_expr *size = rg_expr_new(text, &why);
    if (size == NULL) {
        rg_fatal(RG_USAGE, "mesh: --size %s: %s", text, why);
    }
    if (rg_expr_is_number(size) && !(rg_expr_value(size, (const double[3]){0}, 0) > 0)) {
        complain("--size must be > 0, not", text);
    }
    if (rg_expr_uses_time(size)) {
        complain("--size must not depend on t", text);
    }
    return size;
}

static int read_tile(const char *text) {
    for (int tile = RG_TILE; tile <= RG_MOST_TILE; tile *= 2) {
        char word[16];
        snprintf(word, sizeof word, "%d", tile);
        if (strcmp(text, word) == 0) {
            return tile;
        }
    }
    complain("--tile is one of 256, 512 and 1024, not", text);
}

static void read_option(rg_mesh_arguments *a, const char *option, const char *value) {
    if (value == NULL) {
        complain("missing value after", option);
    }
    if (strcmp(option, "-o") == 0) {
        a->output = value;
    } else if (strcmp(option, "--scale") == 0) {
        a->how.scale = read_number(option, value);
    } else if (strcmp(option, "--unit") == 0) {
        a->unit = value;
    } else if (strcmp(option, "--merge") == 0) {
        a->how.merge = read_number(option, value);
    } else if (strcmp(option, "--crack") == 0) {
        a->crack = value;
    } else if (strcmp(option, "--extrude") == 0) {
        read_extrusion(a, value);
    } else if (strcmp(option, "--size") == 0) {
        a->size = read_size(value);
    } else if (strcmp(option, "--curvature") == 0) {
        a->curvature = read_number(option, value);
    } else if (strcmp(option, "--tile") == 0) {
        a->tile = read_tile(value);
    } else if (strcmp(option, "--partition") == 0) {
        a->partition = value;
    } else if (strcmp(option, "--case") == 0) {
        a->material = value;
    } else if (strcmp(option, "--set") == 0) {
        a->override[a->overrides++] = value;
    } else {
        complain("unknown option", option);
    }
}

static bool same_file(const char *a, const char *b) {
    struct stat of_a, of_b;
    return stat(a, &of_a) == 0 && stat(b, &of_b) == 0 && of_a.st_dev == of_b.st_dev &&
           of_a.st_ino == of_b.st_ino;
}

static bool ends_with(const char *text, const char *end) {
    size_t n = strlen(text), m = strlen(end);
    return n >= m && strcmp(text + n - m, end) == 0;
}

static bool is_case(const char *path) {
    return ends_with(path, ".yaml") || ends_with(path, ".yml");
}

/* What is read without Gmsh. */
static bool is_text(const char *path) {
    return ends_with(path, ".inp") || ends_with(path, ".vtk") || ends_with(path, ".vtu") ||
           ends_with(path, ".pvtu") || rg_is_converted(path);
}

/* An option that says something of an import; NULL: none is given. */
static const char *import_option(const rg_mesh_arguments *a) {
    return a->improve             ? "--improve"
           : a->tile > 0          ? "--tile"
           : a->how.split         ? "--split"
           : a->how.thickness > 0 ? "--extrude"
           : a->apart             ? "--apart"
           : a->crack != NULL     ? "--crack"
           : a->how.merge > 0     ? "--merge"
           : a->unit != NULL      ? "--unit"
           : a->how.scale > 0     ? "--scale"
           : a->size != NULL      ? "--size"
           : a->curvature > 0     ? "--curvature"
                                  : NULL;
}

static void check_together(const rg_mesh_arguments *a) {
    if (a->input == NULL) {
        complain("nothing to read", "");
    }
    if (a->partition != NULL && (a->info || a->output != NULL)) {
        complain("--partition changes the file that it is given; not understood with it",
                 a->info ? "--info" : "-o");
    }
    if (!a->info && a->partition == NULL && a->output == NULL) {
        complain("where to? -o OUT.h5 is missing", "");
    }
    if (a->info && a->output != NULL) {
        complain("--info writes nothing; not understood: -o", a->output);
    }
    if (a->output != NULL && same_file(a->input, a->output)) {
        complain("it would take the place of what it is made from: -o", a->output);
    }
    const char *import = import_option(a);
    if (import != NULL && (a->info || a->partition != NULL || is_case(a->input))) {
        char what[100];
        snprintf(what, sizeof what, "%s is for a mesh on its way in; not understood with it", import);
        complain(what, a->info ? "--info" : a->partition != NULL ? "--partition" : a->input);
    }
    if ((a->size != NULL || a->curvature > 0) && is_text(a->input)) {
        complain("it is a mesh already, so --size and --curvature say nothing of it", a->input);
    }
    if (a->unit != NULL && a->how.scale > 0) {
        complain("--unit and --scale say the same; not understood together", a->unit);
    }
    if (!a->info && a->material != NULL) {
        complain("--case is for --info", "");
    }
}

rg_mesh_arguments rg_mesh_arguments_read(int argc, char **argv, int first) {
    rg_mesh_arguments a = {.override = RG_NEW(const char *, (size_t)argc)};
    for (int i = first; i < argc; i++) {
        if (strcmp(argv[i], "--info") == 0) {
            a.info = true;
        } else if (strcmp(argv[i], "--improve") == 0) {
            a.improve = true;
        } else if (strcmp(argv[i], "--apart") == 0) {
            a.apart = true;
        } else if (strcmp(argv[i], "--split") == 0) {
            a.how.split = true;
        } else if (argv[i][0] == '-') {
            read_option(&a, argv[i], i + 1 < argc ? argv[i + 1] : NULL);
            i++;
        } else if (a.input == NULL) {
            a.input = argv[i];
        } else {
            complain("one mesh at a time; not understood", argv[i]);
        }
    }
    check_together(&a);
    a.how.scale = a.unit != NULL ? read_unit(a.unit) : a.how.scale > 0 ? a.how.scale : 1;
    a.how.merge *= a.how.scale;
    a.how.thickness *= a.how.scale;
    return a;
}

/* ---- making ---- */

enum { MOST_TOLD = 8 };

static void tell_parts(const rg_mesh *mesh, const char *input) {
    int32_t *part = RG_NEW(int32_t, (size_t)mesh->elements), parts = rg_mesh_parts(mesh, part);
    rg_gid *first = RG_NEW(rg_gid, (size_t)parts), *size = RG_NEW(rg_gid, (size_t)parts);
    for (rg_gid e = mesh->elements - 1; e >= 0; e--) {
        first[part[e]] = e;
        size[part[e]]++;
    }
    if (parts > 1) {
        rg_warn("%s: the mesh has %d parts that share no face", input, parts);
    }
    for (int32_t p = 0; parts > 1 && p < parts && p < MOST_TOLD; p++) {
        rg_warn("%s: part %d: %" PRId64 " elements, one of them %" PRId64, input, p + 1, size[p],
                rg_mesh_original(mesh, first[p]));
    }
    rg_free(first);
    rg_free(size);
    rg_free(part);
}

/* Parts that are kept apart are none for a mesh of one. */
static void keep_apart(rg_mesh *mesh, const char *input) {
    int32_t parts = rg_mesh_keep_apart(mesh);
    if (parts == 1) {
        rg_warn("%s: --apart: all elements hang together by their nodes: there is one part", input);
    }
}

/* Of a part, where parts are kept apart. */
static void take_crack(rg_mesh *mesh, const rg_mesh_arguments *a) {
    rg_mesh_crack crack = rg_mesh_take_crack(mesh, a->crack);
    if (crack.faces == 0) {
        rg_fatal(RG_USAGE, "%s: --crack %s: no two faces lie on each other with nodes of their own", a->input,
                 a->crack);
    }
    printf("%s: crack '%s': %" PRId64
           " faces, %.4g m2 around (%.4g, %.4g, %.4g) m, open from the start unless "
           "interface.sets names it\n",
           a->input, a->crack, crack.faces, crack.area, crack.place[0], crack.place[1], crack.place[2]);
}

static void tell_touches(const rg_mesh *mesh, const char *input) {
    size_t count;
    rg_touch *touch = rg_mesh_touches(mesh, &count);
    if (mesh->part != NULL && count == 0) {
        printf("%s: no two parts touch\n", input);
    }
    for (size_t i = 0; i < count && i < MOST_TOLD; i++) {
        const rg_touch *t = &touch[i];
        printf("%s: parts %d and %d touch: %" PRId64 " and %" PRId64
               " faces on %.4g m2 around (%.4g, %.4g, %.4g) m, with gaps of %.2g to %.2g m\n",
               input, t->part[0] + 1, t->part[1] + 1, t->faces[0], t->faces[1], t->area, t->place[0],
               t->place[1], t->place[2], t->gap[0], t->gap[1]);
    }
    if (count > MOST_TOLD) {
        printf("%s: %zu more pairs of parts touch\n", input, count - MOST_TOLD);
    }
    rg_free(touch);
}

/* A unit forgotten shows in the size. */
static void tell(const rg_mesh *mesh, const char *output) {
    double box[2][3];
    rg_mesh_box_around(mesh, box);
    printf("%s: %.4g x %.4g x %.4g m, %" PRId64 " elements, %" PRId64 " vertices", output,
           box[1][0] - box[0][0], box[1][1] - box[0][1], box[1][2] - box[0][2], mesh->elements,
           mesh->vertices);
}

static double longest_edge(const rg_mesh *mesh) {
    double most = 0;
    for (rg_gid e = 0; e < mesh->elements; e++) {
        most = fmax(most, rg_mesh_longest_edge(mesh, e));
    }
    return most;
}

/* The gain, and what it costs. */
static void improve(rg_mesh *mesh) {
    rg_gid before = mesh->elements;
    double edge = longest_edge(mesh);
    rg_improvement done = rg_mesh_improve(mesh);
    rg_mesh_sort(mesh);
    rg_mesh_connect(mesh);
    printf("improved: smallest height from %.4g to %.4g m, longest edge from %.4g to %.4g m; vertices moved "
           "%" PRId64 " times, %" PRId64 " edges and %" PRId64 " faces replaced, from %" PRId64 " to %" PRId64
           " elements\n",
           done.before, done.after, edge, longest_edge(mesh), done.moves, done.edges, done.faces, before,
           mesh->elements);
}

/* A unit that was forgotten shows in the time that waves take. */
static void judge_size(const rg_mesh *mesh, const char *input) {
    static const double speed = 5e3, longest = 0.1, shortest = 1e-11; /* m/s, s */
    double box[2][3], length = 0, edge = INFINITY;
    rg_mesh_box_around(mesh, box);
    for (int i = 0; i < 3; i++) {
        length = fmax(length, box[1][i] - box[0][i]);
    }
    for (rg_gid e = 0; e < mesh->elements; e++) {
        edge = fmin(edge, rg_mesh_longest_edge(mesh, e));
    }
    if (length > longest * speed) {
        rg_warn(
            "%s: the body is %.4g m long, which waves of %g m/s cross in %.2g s: is that its unit? (--unit)",
            input, length, speed, length / speed);
    } else if (edge < shortest * speed) {
        rg_warn("%s: an element is %.4g m long, which waves of %g m/s cross in %.2g s: is that its unit? "
                "(--unit)",
                input, edge, speed, edge / speed);
    }
}

void rg_mesh_finish(rg_mesh *mesh, const rg_mesh_arguments *a) {
    rg_mesh_check_elements(mesh, a->input);
    rg_mesh_sort(mesh);
    rg_mesh_connect(mesh);
    a->apart ? keep_apart(mesh, a->input) : (void)0;
    a->crack != NULL ? take_crack(mesh, a) : (void)0;
    rg_mesh_check(mesh, a->input);
    rg_mesh_check_overlaps(mesh, a->input);
    tell_parts(mesh, a->input);
    judge_size(mesh, a->input);
    if (a->improve) {
        improve(mesh);
        a->apart ? (void)rg_mesh_keep_apart(mesh) : (void)0;
        rg_mesh_check(mesh, a->input);
    }
    tell_touches(mesh, a->input);
    mesh->tile = rg_tile_elements(mesh->elements, a->tile > 0 ? a->tile : RG_TILE);
    rg_mesh_file_write(a->output, mesh, 0, NULL);
    tell(mesh, a->output);
    printf(", %d surface sets, %d volume sets\n", mesh->surface.count, mesh->volume.count);
}

static int from_case(const rg_mesh_arguments *a) {
    rg_case *c = rg_case_read(a->input, a->overrides, a->override, stderr);
    if (c == NULL) {
        return RG_USAGE;
    }
    rg_mesh *mesh = rg_mesh_of_case(c);
    rg_mesh_file_write(a->output, mesh, 0, NULL);
    tell(mesh, a->output);
    putchar('\n');
    rg_mesh_free(mesh);
    rg_case_free(c);
    return RG_OK;
}

static int from_text(const rg_mesh_arguments *a) {
    rg_mesh *mesh = ends_with(a->input, ".vtk") ? rg_vtk_read(a->input, &a->how)
                    : ends_with(a->input, "vtu")
                        ? rg_vtu_read(a->input, &a->how)
                        : rg_inp_read(a->input, rg_is_converted(a->input) ? rg_converted(a->input) : NULL,
                                      &a->how, stdout);
    rg_mesh_finish(mesh, a);
    rg_mesh_free(mesh);
    return RG_OK;
}

/* Hands over to the program that has Gmsh, in the folder of this one. */
static int from_gmsh(int argc, char **argv) {
    char *path = rg_path_beside_program("rhegma-mesh");
    char **copy = RG_NEW(char *, (size_t)argc);
    copy[0] = path;
    for (int i = 2; i < argc; i++) {
        copy[i - 1] = argv[i];
    }
    execv(path, copy);
    rg_fatal(RG_USAGE,
             "mesh: %s: %s; it reads all but .yaml, .inp, .vtk, .vtu, .pvtu, .med and .cgns, and is built "
             "where Gmsh is there "
             "(Debian: "
             "libgmsh-dev; then meson configure build -Dgmsh=enabled)",
             path, strerror(errno));
}

/* ---- showing ---- */

static int show(const rg_mesh_arguments *a) {
    double speed = 1;
    if (a->material != NULL) {
        rg_case *c = rg_case_read(a->material, a->overrides, a->override, stderr);
        if (c == NULL) {
            return RG_USAGE;
        }
        rg_material *material = rg_materials_of_case(c);
        speed = 0;
        for (int m = 0; m <= c->others; m++) {
            speed = fmax(speed, rg_material_dilatational(&material[m]));
        }
        rg_free(material);
        rg_case_free(c);
    }
    rg_mesh *mesh = rg_mesh_file_read(a->input);
    rg_mesh_info(mesh, speed, stdout);
    rg_mesh_free(mesh);
    rg_mesh_file *f = rg_mesh_file_open(a->input);
    rg_mesh_info_partitions(f, stdout);
    rg_mesh_file_close(f);
    return RG_OK;
}

/* ---- partitions ---- */

/* The numbers of a list like "2,4,8", each from 2 to the number of tiles; returns how many there are. */
static int read_parts(const char *list, const rg_mesh_header *h, int *parts) {
    int count = 0;
    const char *at = list;
    char *end;
    do {
        long value = strtol(at, &end, 10);
        if (end == at || (*end != ',' && *end != '\0') || value < 2 || value > h->tiles ||
            value > INT32_MAX) {
            rg_fatal(RG_USAGE,
                     "mesh: --partition %s: numbers of ranks, separated by commas, each from 2 to %" PRId64
                     ", the number of tiles",
                     list, h->tiles);
        }
        parts[count++] = (int)value;
        at = end + 1;
    } while (*end != '\0');
    return count;
}

static int store_partitions(const rg_mesh_arguments *a) {
    rg_mesh_file *f = rg_mesh_file_open(a->input);
    rg_tile_graph *g = rg_mesh_file_graph(f);
    int *parts = RG_NEW(int, strlen(a->partition) + 1);
    int count = read_parts(a->partition, rg_mesh_file_header(f), parts);
    rg_tile_partition *partition = RG_NEW(rg_tile_partition, (size_t)count);
    for (int p = 0; p < count; p++) {
        int32_t *owner = RG_NEW(int32_t, (size_t)g->tiles);
        rg_tile_graph_partition(g, parts[p], owner);
        partition[p] = (rg_tile_partition){parts[p], owner};
    }
    rg_mesh_file_close(f);
    rg_mesh_file_add_partitions(a->input, count, partition);
    f = rg_mesh_file_open(a->input);
    rg_mesh_info_partitions(f, stdout);
    rg_mesh_file_close(f);
    for (int p = 0; p < count; p++) {
        rg_free((void *)(uintptr_t)partition[p].owner);
    }
    rg_free(partition);
    rg_free(parts);
    rg_tile_graph_free(g);
    return RG_OK;
}

int rg_mesh_help(void) {
    fputs(usage, stdout);
    return RG_OK;
}

int rg_mesh_command(int argc, char **argv) {
    rg_mesh_arguments a = rg_mesh_arguments_read(argc, argv, 2);
    int status;
    if (a.info) {
        status = show(&a);
    } else if (a.partition != NULL) {
        status = store_partitions(&a);
    } else if (is_case(a.input)) {
        status = from_case(&a);
    } else if (ends_with(a.input, ".h5")) {
        complain("a mesh file already, which --info shows", a.input);
    } else if (is_text(a.input)) {
        status = from_text(&a);
    } else {
        status = from_gmsh(argc, argv);
    }
    rg_expr_free(a.size);
    rg_free(a.override);
    return status;
}
