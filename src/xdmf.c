/* The document is two temporal collections, one for the body and one for its cracks, because XDMF wants the
 * same kind of grid in all moments of a collection. Their text is kept as it grows; writing adds head and
 * foot. */
#include "xdmf.h"

#include <errno.h>
#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>

#include "mem.h"

typedef struct {
    char *bytes;
    size_t length, capacity;
} text;

struct rg_xdmf {
    int64_t total;           /* tetrahedra */
    int64_t triangles;       /* of the current frame's crack */
    double time;             /* s, of the current frame */
    text group, crack_group; /* of fields.h5, where the current frame is */
    text volume, crack;      /* the frames so far */
};

static void append(text *t, const char *format, ...) __attribute__((format(printf, 2, 3)));

static void append(text *t, const char *format, ...) {
    va_list args, again;
    va_start(args, format);
    va_copy(again, args);
    size_t need = (size_t)vsnprintf(NULL, 0, format, args) + 1;
    if (t->length + need > t->capacity) {
        t->capacity = 2 * t->capacity + need;
        t->bytes = rg_realloc(t->bytes, t->capacity, 1);
    }
    vsnprintf(t->bytes + t->length, need, format, again);
    t->length += need - 1;
    va_end(again);
    va_end(args);
}

static void append_item(text *t, const char *type, int64_t rows, int columns, const char *group,
                        const char *name) {
    append(t,
           "<DataItem Dimensions=\"%" PRId64 " %d\" NumberType=\"%s\" Precision=\"8\" Format=\"HDF\">"
           "fields.h5:%s/%s</DataItem>\n",
           rows, columns, type, group, name);
}

static void append_grid(text *t, const char *name, double time, const char *topology, int64_t cells,
                        int nodes, const char *group) {
    append(t, "<Grid Name=\"%s\" GridType=\"Uniform\">\n<Time Value=\"%.17g\"/>\n", name, time);
    append(t, "<Topology TopologyType=\"%s\" NumberOfElements=\"%" PRId64 "\">\n", topology, cells);
    append_item(t, "Int", cells, nodes, group, "cells");
    append(t, "</Topology>\n<Geometry GeometryType=\"XYZ\">\n");
    append_item(t, "Float", nodes * cells, 3, group, "points");
    append(t, "</Geometry>\n");
}

static void append_attribute(text *t, const char *name, enum rg_center center, int components, int64_t rows,
                             const char *group) {
    const char *type = components == 1 ? "Scalar" : components == 3 ? "Vector" : "Tensor6";
    append(t, "<Attribute Name=\"%s\" AttributeType=\"%s\" Center=\"%s\">\n", name, type,
           center == RG_CENTER_CELL ? "Cell" : "Node");
    append_item(t, "Float", rows, components, group, name);
    append(t, "</Attribute>\n");
}

rg_xdmf *rg_xdmf_new(int64_t total) {
    rg_xdmf *x = RG_NEW(rg_xdmf, 1);
    x->total = total;
    return x;
}

void rg_xdmf_frame(rg_xdmf *x, const char *group, double time) {
    x->group.length = x->crack_group.length = 0;
    append(&x->group, "%s", group);
    append(&x->crack_group, "%s/crack", group);
    x->time = time;
    x->triangles = 0;
    append_grid(&x->volume, "volume", time, "Tetrahedron_10", x->total, 10, "/mesh");
}

void rg_xdmf_volume(rg_xdmf *x, const char *name, enum rg_center center, int components) {
    int64_t rows = center == RG_CENTER_CELL ? x->total : 10 * x->total;
    append_attribute(&x->volume, name, center, components, rows, x->group.bytes);
}

void rg_xdmf_surface(rg_xdmf *x, int64_t triangles) {
    x->triangles = triangles;
    if (triangles > 0) {
        append_grid(&x->crack, "crack", x->time, "Triangle", triangles, 3, x->crack_group.bytes);
    }
}

void rg_xdmf_surface_field(rg_xdmf *x, const char *name, int components) {
    if (x->triangles > 0) {
        append_attribute(&x->crack, name, RG_CENTER_CELL, components, x->triangles, x->crack_group.bytes);
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

void rg_xdmf_free(rg_xdmf *x) {
    if (x != NULL) {
        rg_free(x->volume.bytes);
        rg_free(x->crack.bytes);
        rg_free(x->group.bytes);
        rg_free(x->crack_group.bytes);
        rg_free(x);
    }
}
