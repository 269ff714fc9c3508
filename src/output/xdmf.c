/* The document is two temporal collections, one for the body and one for its cracks, because XDMF wants the
 * same kind of grid in all moments of a collection. Their text is kept as it grows; writing adds head and
 * foot. */
#include "output/xdmf.h"

#include <errno.h>
#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/mem.h"

typedef struct {
    char *bytes;
    size_t length, capacity;
} text;

struct rg_xdmf {
    int64_t total;           /* tetrahedra */
    int precision;           /* bytes of a real number */
    int64_t triangles;       /* of the current frame's crack */
    double time;             /* s, of the current frame */
    text place, crack_place; /* where the current frame is: "fields/000000.h5:", and its crack */
    text volume, crack;      /* the frames so far */
};

static void append(text *t, const char *format, ...) __attribute__((format(printf, 2, 3)));

static void append(text *t, const char *format, ...) {
    va_list args, again;
    va_start(args, format);
    va_copy(again, args);
    size_t need = (size_t)vsnprintf(NULL, 0, format, args) + 1;
    t->bytes = rg_grow(t->bytes, &t->capacity, t->length + need, 1);
    vsnprintf(t->bytes + t->length, need, format, again);
    t->length += need - 1;
    va_end(again);
    va_end(args);
}

static void append_item(text *t, int precision, int64_t rows, int columns, const char *place,
                        const char *name) {
    append(t,
           "<DataItem Dimensions=\"%" PRId64 " %d\" NumberType=\"%s\" Precision=\"%d\" Format=\"HDF\">"
           "%s/%s</DataItem>\n",
           rows, columns, precision == 0 ? "Int" : "Float", precision == 0 ? 8 : precision, place, name);
}

static void append_grid(text *t, const rg_xdmf *x, const char *name, const char *topology, int64_t cells,
                        int nodes, const char *place) {
    append(t, "<Grid Name=\"%s\" GridType=\"Uniform\">\n<Time Value=\"%.17g\"/>\n", name, x->time);
    append(t, "<Topology TopologyType=\"%s\" NumberOfElements=\"%" PRId64 "\">\n", topology, cells);
    append_item(t, 0, cells, nodes, place, "cells");
    append(t, "</Topology>\n<Geometry GeometryType=\"XYZ\">\n");
    append_item(t, x->precision, nodes * cells, 3, place, "points");
    append(t, "</Geometry>\n");
}

static void append_attribute(text *t, int precision, const char *name, enum rg_center center, int components,
                             int64_t rows, const char *place) {
    const char *type = components == 1 ? "Scalar" : components == 3 ? "Vector" : "Tensor6";
    append(t, "<Attribute Name=\"%s\" AttributeType=\"%s\" Center=\"%s\">\n", name, type,
           center == RG_CENTER_CELL ? "Cell" : "Node");
    append_item(t, precision, rows, components, place, name);
    append(t, "</Attribute>\n");
}

rg_xdmf *rg_xdmf_new(int64_t total, bool single) {
    rg_xdmf *x = RG_NEW(rg_xdmf, 1);
    x->total = total;
    x->precision = single ? 4 : 8;
    return x;
}

void rg_xdmf_frame(rg_xdmf *x, const char *file, double time) {
    x->place.length = x->crack_place.length = 0;
    append(&x->place, "%s:", file);
    append(&x->crack_place, "%s:/crack", file);
    x->time = time;
    x->triangles = 0;
    append_grid(&x->volume, x, "volume", "Tetrahedron_10", x->total, 10, "fields/mesh.h5:");
}

void rg_xdmf_volume(rg_xdmf *x, const rg_volume_field *field) {
    int64_t rows = field->center == RG_CENTER_CELL ? x->total : 10 * x->total;
    append_attribute(&x->volume, field->exact ? 8 : x->precision, field->name, field->center,
                     field->components, rows, x->place.bytes);
}

void rg_xdmf_surface(rg_xdmf *x, int64_t triangles) {
    x->triangles = triangles;
    if (triangles > 0) {
        append_grid(&x->crack, x, "crack", "Triangle", triangles, 3, x->crack_place.bytes);
    }
}

void rg_xdmf_surface_field(rg_xdmf *x, const char *name, int components) {
    if (x->triangles > 0) {
        append_attribute(&x->crack, x->precision, name, RG_CENTER_CELL, components, x->triangles,
                         x->crack_place.bytes);
    }
}

void rg_xdmf_frame_end(rg_xdmf *x) {
    append(&x->volume, "</Grid>\n");
    if (x->triangles > 0) {
        append(&x->crack, "</Grid>\n");
    }
}

static void put_collection(const text *t, const char *name, FILE *out) {
    if (t->length > 0) {
        fprintf(out, "<Grid Name=\"%s\" GridType=\"Collection\" CollectionType=\"Temporal\">\n%s</Grid>\n",
                name, t->bytes);
    }
}

static bool put_document(const rg_xdmf *x, const char *path) {
    FILE *out = fopen(path, "w");
    if (out == NULL) {
        return false;
    }
    fputs("<?xml version=\"1.0\"?>\n<Xdmf Version=\"2.0\">\n<Domain>\n", out);
    put_collection(&x->volume, "volume", out);
    put_collection(&x->crack, "crack", out);
    fputs("</Domain>\n</Xdmf>\n", out);
    bool failed = ferror(out) != 0;
    failed = fclose(out) != 0 || failed;
    return !failed;
}

bool rg_xdmf_write(const rg_xdmf *x, const char *path) {
    text name = {0};
    append(&name, "%s.tmp", path);
    bool ok = put_document(x, name.bytes) && rename(name.bytes, path) == 0;
    int reason = errno;
    rg_free(name.bytes);
    errno = reason;
    return ok;
}

/* ---- restart ---- */

static char *read_text(const char *path) {
    FILE *in = fopen(path, "rb");
    if (in == NULL) {
        return NULL;
    }
    text t = {0};
    char line[1024];
    append(&t, "%s", "");
    while (fgets(line, sizeof line, in) != NULL) {
        append(&t, "%s", line);
    }
    fclose(in);
    return t.bytes;
}

/* Takes the first `length` bytes of a collection of the document, which must end with a grid. */
static bool take_collection(text *to, const char *document, const char *name, int64_t length) {
    static const char end[] = "</Grid>\n";
    char head[100];
    snprintf(head, sizeof head, "<Grid Name=\"%s\" GridType=\"Collection\"", name);
    const char *at = length == 0 ? NULL : strstr(document, head);
    at = at == NULL ? NULL : strchr(at, '\n');
    if (at == NULL) {
        return length == 0;
    }
    append(to, "%.*s", (int)length, at + 1);
    return (int64_t)to->length == length && to->length >= strlen(end) &&
           strcmp(to->bytes + to->length - strlen(end), end) == 0;
}

bool rg_xdmf_resume(rg_xdmf *x, const char *path, int64_t volume, int64_t crack) {
    char *document = read_text(path);
    bool ok = document != NULL && take_collection(&x->volume, document, "volume", volume) &&
              take_collection(&x->crack, document, "crack", crack);
    rg_free(document);
    return ok;
}

void rg_xdmf_length(const rg_xdmf *x, int64_t *volume, int64_t *crack) {
    *volume = (int64_t)x->volume.length;
    *crack = (int64_t)x->crack.length;
}

void rg_xdmf_free(rg_xdmf *x) {
    if (x != NULL) {
        rg_free(x->volume.bytes);
        rg_free(x->crack.bytes);
        rg_free(x->place.bytes);
        rg_free(x->crack_place.bytes);
        rg_free(x);
    }
}
