/* The mesh of a case: cracks that it brings, sets that it has not, parts that are kept apart. On any number
 * of ranks; prints TAP from rank 0. */
#include "partition/mesh_case.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/mem.h"
#include "case/read.h"
#include "mesh/apart.h"
#include "mesh/file.h"
#include "support/fatal.h"
#include "support/tap.h"

static char warned[500];

void rg_warn(const char *format, ...) {
    va_list args;
    va_start(args, format);
    vsnprintf(warned, sizeof warned, format, args);
    va_end(args);
}

static char path[] = "/tmp/rhegma-mesh-case-XXXXXX";

/* A box with sides as sets, of which number `crack` - 1 is a crack; or two of them, side by side. */
static void write_mesh(int crack, bool apart) {
    static const int64_t cells[3] = {2, 1, 1};
    static const double origin[3] = {0, 0, 0}, size[3] = {2e-3, 1e-3, 1e-3};
    if (rank == 0) {
        rg_mesh *m = rg_mesh_box(cells, origin, size, 0, 1);
        m->crack = crack;
        if (apart) { /* the second half gets vertices of its own at x = 1e-3 */
            rg_gid old = m->vertices;
            double *x = RG_NEW(double, 6 * (size_t)old);
            memcpy(x, m->x, 3 * (size_t)old * sizeof *x);
            memcpy(x + 3 * old, m->x, 3 * (size_t)old * sizeof *x);
            rg_free(m->x);
            m->x = x;
            for (rg_gid e = 0; e < m->elements; e++) {
                double middle = 0;
                for (int i = 0; i < 4; i++) {
                    middle += x[3 * m->corner[4 * e + i]] / 4;
                }
                for (int i = 0; i < 4 && middle > 1e-3; i++) {
                    m->corner[4 * e + i] += old;
                }
            }
            m->vertices = 2 * old;
            rg_gid kept = 0; /* those that an element has */
            for (rg_gid v = 0; v < 2 * old; v++) {
                bool used = false;
                for (rg_gid i = 0; i < 4 * m->elements; i++) {
                    used = used || m->corner[i] == v;
                }
                if (used) {
                    memmove(m->x + 3 * kept, m->x + 3 * v, 3 * sizeof *m->x);
                    for (rg_gid i = 0; i < 4 * m->elements; i++) {
                        m->corner[i] = m->corner[i] == v ? kept : m->corner[i];
                    }
                    kept++;
                }
            }
            m->vertices = kept;
            rg_mesh_connect(m);
            rg_mesh_keep_apart(m);
        }
        rg_mesh_file_write(path, m, 0, NULL);
        rg_mesh_free(m);
    }
    MPI_Barrier(MPI_COMM_WORLD);
}

static const char text[] = "mesh: {file: none.h5}\n"
                           "material: {model: neo-hookean, young: 70e9, poisson: 0.21, density: 2500}\n"
                           "interface: {law: linear, strength: 400e6, energy: 34}\n"
                           "time: {end: 1e-6}\n";

/* The case with a change and another one, or "". */
static rg_case *make(const char *change, const char *more) {
    char mesh[100];
    snprintf(mesh, sizeof mesh, "mesh.file=%s", path);
    const char *all[3] = {mesh, change, more};
    int count = more[0] != '\0' ? 3 : change[0] != '\0' ? 2 : 1;
    rg_case *c = rg_case_read_text("a.yaml", text, strlen(text), count, all, stderr);
    if (c == NULL) {
        abort();
    }
    return c;
}

static rg_case *make_box(int64_t cells, int tile, const char *more) {
    char words[400];
    snprintf(words, sizeof words,
             "mesh: {cells: [%d, 12, 24], size: [1, 2, 3], tile: %d%s}\n"
             "material: {model: neo-hookean, young: 70e9, poisson: 0.21, density: 2500}\n"
             "interface: {law: none}\ntime: {end: 1e-6}\n",
             (int)cells, tile, more);
    rg_case *c = rg_case_read_text("a.yaml", words, strlen(words), 0, NULL, stderr);
    if (c == NULL) {
        abort();
    }
    return c;
}

/* ---- cracks ---- */

static void check_taken(int crack, const char *sets, int before, int after, const char *name) {
    write_mesh(crack, false);
    rg_case *c = make(sets, "");
    rg_case_take_crack(c, MPI_COMM_WORLD);
    bool good = c->interface.sets == after;
    for (int i = 0; good && i < after; i++) {
        bool taken = i >= before;
        good = c->interface.set[i].open == taken && strcmp(c->interface.set[i].set, i == after - 1 ? name
                                                                                    : i == 0       ? "y-"
                                                                                             : "x+") == 0;
    }
    report(good, "crack", sets[0] != '\0' ? sets : crack > 0 ? "alone" : "none");
    rg_case_free(c);
}

static bool refused(rg_case *c, const char *words, bool part) {
    bool good = true;
    if (rank == 0) {
        said[0] = '\0';
        expect_fatal = true;
        if (setjmp(escape) == 0) {
            if (part) {
                rg_part_free(rg_part_of_case(c, NULL, MPI_COMM_SELF));
            } else {
                rg_case_take_crack(c, MPI_COMM_SELF);
            }
        }
        expect_fatal = false;
        size_t length = strlen(words); /* up to a place that is not known */
        bool open = length > 0 && words[length - 1] == '(';
        good =
            fatal_status == RG_USAGE && strncmp(said, words, length) == 0 && (open || said[length] == '\0');
        if (!good) {
            printf("# %s\n# %s\n", said, words);
        }
    }
    return good;
}

static void check_crack_refused(const char *change, const char *more, const char *why) {
    char words[500] = "";
    if (why != NULL) {
        snprintf(words, sizeof words,
                 "a.yaml: mesh.file: %s: its crack, set 'z+', is open from the start, which %s", path, why);
    }
    rg_case *c = make(change, more);
    fatal_status = RG_USAGE;
    report(refused(c, words, false), change, why == NULL ? "may have cracks" : "refuses cracks");
    rg_case_free(c);
}

static void check_cracks(void) {
    check_taken(0, "", 0, 0, "");
    check_taken(6, "", 0, 1, "z+");
    check_taken(1, "", 0, 1, "x-");
    check_taken(6, "interface.sets=[{set: y-, strength: 3e8}]", 1, 2, "z+");
    check_taken(6, "interface.sets=[{set: y-, strength: 3e8}, {set: z+, strength: 2e8}]", 2, 2, "z+");
    check_taken(6, "interface.sets=[{set: z+, strength: 2e8}]", 1, 1, "z+");
    check_taken(6, "interface.sets=[{set: y-, strength: 3e8}, {set: x+, strength: 2e8}]", 2, 3, "z+");
}

static void check_cracks_refused(void) {
    static const char needs_law[] =
        "needs a law of interfaces that ends (law: none in interface.sets keeps all other faces whole)";
    write_mesh(6, false);
    check_crack_refused("interface={law: none}", "", needs_law);
    check_crack_refused("interface={law: free, strength: 4e8}", "", needs_law);
    check_crack_refused("interface.form=continuous", "interface.faces=x > 0.5e-3", NULL);
    check_crack_refused("interface.friction=0.2", "", NULL);
    check_crack_refused("start=static", "", NULL);
    check_crack_refused(
        "interface.friction=0.2", "start=static",
        "needs interface.friction 0 with start: static or relax: where it sticks would depend on the way");
}

/* ---- sets ---- */

static void check_sets(void) {
    static const char *const cases[][2] = {
        {"boundary=[{set: x-, component: x, velocity: 0}, {set: top, component: x, velocity: 0}]",
         "boundary[1].set: top"},
        {"loads=[{set: x+, pressure: 1}, {set: y+, pressure: 1}, {set: zebra, pressure: 1}]",
         "loads[2].set: zebra"},
        {"interface.sets=[{set: q, strength: 1e8}]", "interface.sets[0].set: q"},
    };
    write_mesh(0, false);
    for (int i = 0; i < 3; i++) {
        char words[300];
        rg_case *c = make(cases[i][0], "");
        snprintf(words, sizeof words,
                 "a.yaml: %s: %s has no such surface set; allowed: x-, x+, y-, y+, z-, z+", cases[i][1],
                 path);
        report(refused(c, words, true), "sets", cases[i][1]);
        rg_case_free(c);
    }
}

/* Costs that are none are told, of meshes in files and of boxes. */
static void check_weights(void) {
    static const char words[] = "a.yaml: mesh.weight: x > 5 is 0 at (";
    write_mesh(0, false);
    for (int file = 0; file < 2; file++) {
        rg_case *c = file ? make("mesh.weight=x > 5", "") : make_box(1, 256, ", weight: x > 5");
        report(refused(c, words, true), "weights", file ? "of a file" : "of a box");
        rg_case_free(c);
    }
}

/* ---- parts ---- */

static void check_apart(const char *change, bool apart, bool tells) {
    char words[500] = "";
    write_mesh(0, apart);
    rg_case *c = make(change, "");
    warned[0] = '\0';
    if (tells && rank == 0) {
        snprintf(
            words, sizeof words,
            "a.yaml: mesh.file: %s: its 2 parts are kept apart (rhegma mesh --apart) and do not see each "
            "other without contact.model: general: they go through each other",
            path);
    }
    rg_part *part = rg_part_of_case(c, NULL, MPI_COMM_WORLD);
    bool good = strcmp(warned, words) == 0 && part->parts == (apart ? 2 : 0) && part->total == 12;
    report(good, change, tells ? "parts that do not see each other are told" : "nothing is told");
    rg_part_free(part);
    rg_case_free(c);
}

/* ---- tiles ---- */

/* Of 41,472 elements there are 64 tiles of 648, of those full ones at most; of 1,728 there are 64 of 27. */
static void check_tiles(void) {
    static const int wanted[3] = {256, 512, 640};
    bool good = true;
    for (int k = 0; k < 3; k++) {
        rg_case *c = make_box(24, 256 << k, "");
        rg_mesh *m = rg_mesh_of_case(c);
        good = good && m->elements == 41472 && rg_mesh_tile(m) == wanted[k];
        rg_mesh_free(m);
        rg_case_free(c);
    }
    report(good, "tiles", "of a large box, as the case asks for");
    rg_case *c = make_box(1, 512, "");
    rg_part *part = rg_part_of_case(c, NULL, MPI_COMM_WORLD);
    report(part->total == 1728 && part->tile == 16, "tiles", "of a small box");
    rg_part_free(part);
    rg_case_free(c);
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    if (rank == 0) {
        close(mkstemp(path));
    }
    MPI_Bcast(path, sizeof path, MPI_CHAR, 0, MPI_COMM_WORLD);
    check_cracks();
    check_apart("", false, false);
    check_apart("contact.model=interfaces", true, true);
    check_apart("contact={model: general}", true, false);
    check_tiles();
    report(rg_alloc_blocks() == 0, "memory", "all blocks are given back");
    check_cracks_refused(); /* what ends a run gives nothing back */
    check_sets();
    check_weights();
    rank == 0 ? unlink(path) : 0;
    return finish();
}
