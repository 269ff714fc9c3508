#include "case/read.h"

#include <errno.h>
#include <string.h>

#include "base/mem.h"
#include "case/check.h"

enum {
    CHUNK = 65536,
    MOST = 64 << 20, /* bytes: more is no case, but perhaps a mesh */
    FRAMES = 50      /* outputs in a run, by default */
};

char *rg_case_file(const char *path, size_t *size) {
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        return NULL;
    }
    char *text = NULL;
    size_t got = 0, room = 0;
    *size = 0;
    do {
        text = rg_grow(text, &room, *size + CHUNK, 1);
        got = fread(text + *size, 1, CHUNK, file);
        *size += got;
    } while (got > 0 && *size <= MOST);
    int error = ferror(file) ? errno : got > 0 ? EFBIG : 0;
    fclose(file);
    if (error != 0) {
        rg_free(text);
        errno = error;
        return NULL;
    }
    return text;
}

/* "bench/examples/spall/spall.yaml" -> "spall" */
static char *case_name(const char *path) {
    const char *slash = strrchr(path, '/');
    const char *file = slash == NULL ? path : slash + 1;
    const char *dot = strrchr(file, '.');
    return rg_text_copy(file, dot == NULL || dot == file ? strlen(file) : (size_t)(dot - file));
}

/* Defaults that follow from other values. */
static void derive(rg_case *c) {
    if (c->output.dir == NULL) {
        c->output.dir = rg_text_format("results/%s", c->name);
    }
    if (c->output.interval_steps == 0 && c->output.interval_time <= 0) {
        c->output.interval_time = c->time.end / FRAMES;
    }
}

rg_case *rg_case_read_text(const char *path, const char *text, size_t size, int overrides,
                           const char *const override[], FILE *errors) {
    rg_problems problems = {.file = path};
    rg_node root = {.kind = RG_NODE_BAD};
    if (text != NULL) {
        rg_yaml_parse(&problems, text, size, NULL, &root);
    } else {
        rg_problem_add(&problems, (rg_place){0}, &(rg_subject){0}, "cannot be read: %s", strerror(errno));
    }
    for (int i = 0; i < overrides; i++) {
        rg_tree_override(&problems, &root, override[i]);
    }
    rg_case *c = RG_NEW(rg_case, 1);
    c->path = rg_text_copy(path, strlen(path));
    c->name = case_name(path);
    rg_check check = {.problems = &problems, .c = c};
    rg_material_tables_expand(&check, &root);
    rg_presets_expand(&check, &root);
    rg_user_parameters_gather(&root);
    rg_case_check(&check, &root);
    rg_node_clear(&root);
    if (problems.count > 0) {
        rg_problems_flush(&problems, errors);
        rg_case_free(c);
        return NULL;
    }
    derive(c);
    return c;
}

rg_case *rg_case_read(const char *path, int overrides, const char *const override[], FILE *errors) {
    size_t size = 0;
    char *text = rg_case_file(path, &size);
    rg_case *c = rg_case_read_text(path, text, size, overrides, override, errors);
    rg_free(text);
    return c;
}

void rg_case_free(rg_case *c) {
    if (c != NULL) {
        rg_keys_free(&rg_case_table, c);
        rg_free(c->path);
        rg_free(c->name);
        rg_free(c);
    }
}
