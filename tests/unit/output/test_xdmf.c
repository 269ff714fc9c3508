/* The XDMF document to the letter, and how it is taken up again after a restart. */
#include <errno.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/mem.h"

#include "output/xdmf.h"

static char directory[] = "/tmp/test_xdmf.XXXXXX", path[40], temporary[48];

static int set_up(void **state) {
    (void)state;
    snprintf(path, sizeof path, "%s/f.xdmf", mkdtemp(directory) == NULL ? "" : directory);
    snprintf(temporary, sizeof temporary, "%s.tmp", path);
    return 0;
}

static int tear_down(void **state) {
    (void)state;
    remove(path);
    return rmdir(directory);
}

static const rg_volume_field speed = {"velocity", "m/s", RG_CENTER_NODE, 3, 0, false};
static const rg_volume_field stress = {"stress", "Pa", RG_CENTER_CELL, 6, 0, false};
static const rg_volume_field id = {"id", "1", RG_CENTER_CELL, 1, 0, true};

/* Frame 0 has all kinds of fields and a crack of 2 triangles, frame 1 an empty crack, frame 2 one of 5. */
static void put_frame(rg_xdmf *x, int k) {
    static const int64_t triangles[] = {2, 0, 5};
    char file[40];
    snprintf(file, sizeof file, "fields/%06d.h5", k);
    rg_xdmf_frame(x, file, 1.5e-7 * k);
    rg_xdmf_volume(x, &speed);
    if (k == 0) {
        rg_xdmf_volume(x, &stress);
        rg_xdmf_volume(x, &id);
    }
    rg_xdmf_surface(x, triangles[k]);
    rg_xdmf_surface_field(x, "slip", k == 2 ? 3 : 1);
    rg_xdmf_frame_end(x);
}

static const char *document(const char *from) {
    static char text[20000];
    FILE *in = fopen(from, "r");
    assert_non_null(in);
    text[fread(text, 1, sizeof text - 1, in)] = '\0';
    fclose(in);
    return text;
}

#define CELLS(rows, columns, place)                                                                          \
    "<DataItem Dimensions=\"" rows " " columns "\" NumberType=\"Int\" Precision=\"8\" Format=\"HDF\">" place \
    "/cells</DataItem>\n"
#define REALS(rows, columns, bytes, place)                                                                   \
    "<DataItem Dimensions=\"" rows " " columns "\" NumberType=\"Float\" Precision=\"" bytes                  \
    "\" Format=\"HDF\">" place "</DataItem>\n"
#define GRID(name, time, topology, cells, nodes, points, bytes, place)                                       \
    "<Grid Name=\"" name "\" GridType=\"Uniform\">\n<Time Value=\"" time                                     \
    "\"/>\n<Topology TopologyType=\"" topology "\" NumberOfElements=\"" cells                                \
    "\">\n" CELLS(cells, nodes, place) "</Topology>\n<Geometry GeometryType=\"XYZ\">\n" REALS(               \
        points, "3", bytes, place "/points") "</Geometry>\n"
#define FIELD(name, type, center, rows, columns, bytes, place)                                               \
    "<Attribute Name=\"" name "\" AttributeType=\"" type "\" Center=\"" center                               \
    "\">\n" REALS(rows, columns, bytes, place "/" name) "</Attribute>\n"
#define VOLUME(time, bytes, file)                                                                            \
    GRID("volume", time, "Tetrahedron_10", "7", "10", "70", bytes, "fields/mesh.h5:")                        \
    FIELD("velocity", "Vector", "Node", "70", "3", bytes, file ":")
#define HEAD             "<?xml version=\"1.0\"?>\n<Xdmf Version=\"2.0\">\n<Domain>\n"
#define FOOT             "</Domain>\n</Xdmf>\n"
#define COLLECTION(name) "<Grid Name=\"" name "\" GridType=\"Collection\" CollectionType=\"Temporal\">\n"
#define END              "</Grid>\n"
#define FIRST(bytes)                                                                                         \
    VOLUME("0", bytes, "fields/000000.h5")                                                                   \
    FIELD("stress", "Tensor6", "Cell", "7", "6", bytes, "fields/000000.h5:")                                 \
    FIELD("id", "Scalar", "Cell", "7", "1", "8", "fields/000000.h5:") END
#define FIRST_CRACK(bytes)                                                                                   \
    GRID("crack", "0", "Triangle", "2", "3", "6", bytes, "fields/000000.h5:/crack")                          \
    FIELD("slip", "Scalar", "Cell", "2", "1", bytes, "fields/000000.h5:/crack") END
#define SECOND(bytes) VOLUME("1.4999999999999999e-07", bytes, "fields/000001.h5") END
#define THIRD(bytes)  VOLUME("2.9999999999999999e-07", bytes, "fields/000002.h5") END
#define THIRD_CRACK(bytes)                                                                                   \
    GRID("crack", "2.9999999999999999e-07", "Triangle", "5", "3", "15", bytes, "fields/000002.h5:/crack")    \
    FIELD("slip", "Vector", "Cell", "5", "3", bytes, "fields/000002.h5:/crack") END
#define WHOLE(bytes)                                                                                         \
    HEAD COLLECTION("volume") FIRST(bytes) SECOND(bytes) THIRD(bytes) END COLLECTION("crack")                \
        FIRST_CRACK(bytes) THIRD_CRACK(bytes) END FOOT

static rg_xdmf *three_frames(bool single) {
    rg_xdmf *x = rg_xdmf_new(7, single);
    for (int k = 0; k < 3; k++) {
        put_frame(x, k);
    }
    return x;
}

static void document_to_the_letter(void **state) {
    (void)state;
    for (int single = 0; single < 2; single++) {
        rg_xdmf *x = three_frames(single);
        assert_true(rg_xdmf_write(x, path));
        assert_string_equal(document(path), single ? WHOLE("4") : WHOLE("8"));
        int64_t volume, crack;
        rg_xdmf_length(x, &volume, &crack);
        assert_int_equal(volume, strlen(FIRST("8") SECOND("8") THIRD("8")));
        assert_int_equal(crack, strlen(FIRST_CRACK("8") THIRD_CRACK("8")));
        rg_xdmf_free(x);
    }
    assert_int_equal(access(temporary, F_OK), -1);
}

static void without_frames(void **state) {
    (void)state;
    rg_xdmf *x = rg_xdmf_new(7, false);
    int64_t volume = -1, crack = -1;
    rg_xdmf_length(x, &volume, &crack);
    assert_true(volume == 0 && crack == 0);
    assert_true(rg_xdmf_write(x, path));
    assert_string_equal(document(path), HEAD FOOT);
    rg_xdmf_free(x);
    rg_xdmf_free(NULL);
}

/* From the first `frames` frames of a whole document the others make the same again. */
static void goes_on(void **state) {
    (void)state;
    rg_xdmf *x = rg_xdmf_new(7, false);
    int64_t volume[3], crack[3];
    for (int k = 0; k < 3; k++) {
        put_frame(x, k);
        rg_xdmf_length(x, &volume[k], &crack[k]);
    }
    for (int frames = 1; frames <= 3; frames++) {
        assert_true(rg_xdmf_write(x, path));
        rg_xdmf *again = rg_xdmf_new(7, false);
        assert_true(rg_xdmf_resume(again, path, volume[frames - 1], crack[frames - 1]));
        for (int k = frames; k < 3; k++) {
            put_frame(again, k);
        }
        assert_true(rg_xdmf_write(again, path));
        assert_string_equal(document(path), WHOLE("8"));
        rg_xdmf_free(again);
    }
    rg_xdmf_free(x);
}

static void refuse(int64_t volume, int64_t crack, bool good) {
    rg_xdmf *x = rg_xdmf_new(7, false);
    assert_int_equal(rg_xdmf_resume(x, path, volume, crack), good);
    rg_xdmf_free(x);
}

static void lengths_that_are_not_there(void **state) {
    (void)state;
    rg_xdmf *x = three_frames(false);
    int64_t volume, crack;
    rg_xdmf_length(x, &volume, &crack);
    assert_true(rg_xdmf_write(x, path));
    refuse(volume, crack, true);
    refuse(volume, 0, true);
    refuse(volume - 1, crack, false); /* not the end of a grid */
    refuse(volume + 1, crack, false);
    refuse(volume, crack - 1, false);
    refuse(volume, crack + 1, false);
    refuse(3, 0, false); /* shorter than the end of a grid */
    refuse(100000, crack, false);
    refuse(volume, 100000, false);
    const char *text = document(path), *first = strstr(text, COLLECTION("volume")); /* cut after a grid */
    const char *end = strstr(strstr(first, "</Grid>\n") + 1, "</Grid>\n") + strlen("</Grid>\n");
    assert_int_equal(truncate(path, end - text), 0);
    refuse(end - first - (int64_t)strlen(COLLECTION("volume")), 0, true);
    refuse(volume, 0, false);
    rg_xdmf_free(x);
    x = rg_xdmf_new(7, false); /* a document of whose collections one is there */
    put_frame(x, 1);
    rg_xdmf_length(x, &volume, &crack);
    assert_true(rg_xdmf_write(x, path));
    refuse(volume, 0, true);
    refuse(volume, 8, false);
    remove(path);
    refuse(volume, 0, false);
    refuse(0, 0, false);
    rg_xdmf_free(x);
}

static void files_that_cannot_be_written(void **state) {
    (void)state;
    rg_xdmf *x = three_frames(false);
    errno = 0;
    assert_false(rg_xdmf_write(x, "/dev/null/f.xdmf"));
    assert_int_equal(errno, ENOTDIR);
    remove(path);
    assert_int_equal(mkdir(path, 0777), 0); /* takes the place of the file */
    errno = 0;
    assert_false(rg_xdmf_write(x, path));
    assert_int_equal(errno, EISDIR);
    assert_int_equal(rmdir(path), 0);
    assert_int_equal(remove(temporary), 0);
    assert_int_equal(symlink("/dev/full", temporary), 0); /* a disk without room */
    assert_false(rg_xdmf_write(x, path));
    assert_int_equal(errno, ENOSPC);
    assert_int_equal(access(path, F_OK), -1);
    assert_int_equal(remove(temporary), 0);
    rg_xdmf_free(x);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(document_to_the_letter),
        cmocka_unit_test(without_frames),
        cmocka_unit_test(goes_on),
        cmocka_unit_test(lengths_that_are_not_there),
        cmocka_unit_test(files_that_cannot_be_written),
    };
    int failed = cmocka_run_group_tests(tests, set_up, tear_down);
    return failed + (rg_alloc_blocks() > 0); /* all is given back */
}
