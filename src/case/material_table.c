/* Entries of `materials` that stand for the rows of a CSV file: before anything is checked, each becomes as
 * many entries, so that all rules and messages are those of entries in the case file. */
#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/mem.h"
#include "case/check.h"
#include "case/read.h"

typedef struct {
    rg_check *ck;
    const rg_node *item, *file; /* the entry, and its key */
    char *path;                 /* of that key, in messages */
    rg_node *list;              /* gets the rows */
    int columns;
    char **column;
} table;

__attribute__((format(printf, 2, 3))) static void wrong(const table *t, const char *format, ...) {
    char what[256], value[64];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    rg_subject subject = {.key = t->path, .value = rg_node_line(t->file, value, sizeof value)};
    rg_problem_add(t->ck->problems, t->file->at, &subject, "%s", what);
}

/* The fields of a line, without blanks around them; the caller frees each, and the list. */
static char **split(const char *line, size_t length, int *count) {
    char **field = NULL;
    *count = 0;
    for (size_t begin = 0, end; begin <= length; begin = end + 1) {
        const char *comma = memchr(line + begin, ',', length - begin);
        end = comma != NULL ? (size_t)(comma - line) : length;
        size_t first = begin, last = end;
        while (first < last && strchr(" \t\r", line[first]) != NULL) {
            first++;
        }
        while (last > first && strchr(" \t\r", line[last - 1]) != NULL) {
            last--;
        }
        field = rg_realloc(field, (size_t)*count + 1, sizeof *field);
        field[(*count)++] = rg_text_copy(line + first, last - first);
    }
    return field;
}

static void free_fields(char **field, int count) {
    for (int i = 0; i < count; i++) {
        rg_free(field[i]);
    }
    rg_free(field);
}

static int find_column(const table *t, const char *name) {
    int i = 0;
    while (i < t->columns && strcmp(t->column[i], name) != 0) {
        i++;
    }
    return i < t->columns ? i : -1;
}

/* ---- header and rows ---- */

/* Columns of orientation.angles, all or none. */
static const char *const angle_column[3] = {"angle_1", "angle_2", "angle_3"};

static bool is_angle(const char *column) {
    return strncmp(column, "angle_", 6) == 0 && column[6] >= '1' && column[6] <= '3' && column[7] == '\0';
}

static bool check_angles(const table *t) {
    int columns = 0;
    for (int k = 0; k < 3; k++) {
        columns += find_column(t, angle_column[k]) >= 0;
    }
    if (columns % 3 != 0) {
        wrong(t, "of the columns angle_1, angle_2, angle_3 there are but %d", columns);
        return false;
    }
    if (columns > 0 && rg_node_find(t->item, "orientation", strlen("orientation")) != NULL) {
        wrong(t, "orientation is given beside the file's columns of angles");
        return false;
    }
    return true;
}

static bool check_header(const table *t) {
    for (int i = 0; i < t->columns; i++) {
        if (find_column(t, t->column[i]) != i) {
            wrong(t, "column %s is there twice", t->column[i]);
            return false;
        }
        if (strcmp(t->column[i], "name") != 0 &&
            rg_node_find(t->item, t->column[i], strlen(t->column[i])) != NULL) {
            wrong(t, "column %s of the file is given beside it too", t->column[i]);
            return false;
        }
    }
    if (find_column(t, "set") < 0) {
        wrong(t, "its first line names the columns, and there is no column 'set'");
        return false;
    }
    return check_angles(t);
}

static void add_text(const table *t, rg_node *node, const char *key, char *text, bool plain) {
    rg_node *child = rg_node_append(node);
    *child = (rg_node){.kind = RG_NODE_SCALAR,
                       .at = t->file->at,
                       .key_at = t->file->key_at,
                       .key = rg_text_copy(key, strlen(key)),
                       .text = text,
                       .plain = plain};
}

/* orientation: {angles: [..., ..., ...]} */
static void add_angles(const table *t, rg_node *node, char **field) {
    rg_node *orientation = rg_node_append(node);
    *orientation = (rg_node){.kind = RG_NODE_MAPPING,
                             .at = t->file->at,
                             .key_at = t->file->key_at,
                             .key = rg_text_copy("orientation", strlen("orientation"))};
    rg_node *angles = rg_node_append(orientation);
    *angles = (rg_node){.kind = RG_NODE_LIST,
                        .at = t->file->at,
                        .key_at = t->file->key_at,
                        .key = rg_text_copy("angles", strlen("angles"))};
    for (int k = 0; k < 3; k++) {
        const char *text = field[find_column(t, angle_column[k])];
        *rg_node_append(angles) = (rg_node){.kind = RG_NODE_SCALAR,
                                            .at = t->file->at,
                                            .text = rg_text_copy(text, strlen(text)),
                                            .plain = true};
    }
}

/* An entry of row `row`, from 1 on: what the entry of the case says of all, and what the row says. */
static void add_row(const table *t, char **field, int row) {
    rg_node *node = rg_node_append(t->list);
    *node = (rg_node){.kind = RG_NODE_MAPPING, .at = t->item->at};
    for (int i = 0; i < t->item->children; i++) {
        const rg_node *child = &t->item->child[i];
        bool name = strcmp(child->key, "name") == 0;
        if (name && child->kind == RG_NODE_SCALAR && find_column(t, "name") < 0) {
            add_text(t, node, "name", rg_text_format("%s-%d", child->text, row), false);
        } else if (!name && child != t->file) {
            rg_node_copy(child, rg_node_append(node));
        }
    }
    for (int i = 0; i < t->columns; i++) {
        bool word = strcmp(t->column[i], "set") == 0 || strcmp(t->column[i], "name") == 0;
        if (field[i][0] != '\0' && !is_angle(t->column[i])) {
            add_text(t, node, t->column[i], rg_text_copy(field[i], strlen(field[i])), !word);
        }
    }
    if (find_column(t, angle_column[0]) >= 0) {
        add_angles(t, node, field);
    }
}

/* Lines that are blank, or begin with #, are none. */
static bool is_blank(const char *line, size_t length) {
    size_t at = 0;
    while (at < length && strchr(" \t\r", line[at]) != NULL) {
        at++;
    }
    return at == length || line[at] == '#';
}

static void add_rows(table *t, const char *text, size_t size) {
    int line = 0, rows = 0;
    bool good = true;
    for (size_t begin = 0, end; begin < size && good; begin = end + 1) {
        const char *feed = memchr(text + begin, '\n', size - begin);
        end = feed != NULL ? (size_t)(feed - text) : size;
        line++;
        if (is_blank(text + begin, end - begin)) {
            continue;
        }
        int count;
        char **field = split(text + begin, end - begin, &count);
        if (t->column == NULL) {
            t->column = field;
            t->columns = count;
            good = check_header(t);
            continue;
        }
        if (count != t->columns) {
            wrong(t, "line %d of the file has %d fields, its first one %d", line, count, t->columns);
            good = false;
        } else {
            add_row(t, field, ++rows);
        }
        free_fields(field, count);
    }
    if (good && rows == 0) {
        wrong(t, "the file has no rows");
    }
    free_fields(t->column, t->columns);
}

static void read_file(table *t) {
    if (t->file->kind != RG_NODE_SCALAR || rg_node_is_null(t->file) || t->file->text[0] == '\0') {
        wrong(t, "not the path of a CSV file");
        return;
    }
    size_t size = 0;
    char *path = rg_path_beside_case(t->ck, t->file->text), *text = rg_case_file(path, &size);
    if (text == NULL) {
        wrong(t, "cannot be read: %s", strerror(errno));
    } else if (memchr(text, '\0', size) != NULL) {
        wrong(t, "not a text");
    } else {
        add_rows(t, text, size);
    }
    rg_free(text);
    rg_free(path);
}

void rg_material_tables_expand(rg_check *ck, rg_node *root) {
    rg_node *list = rg_node_find(root, "materials", strlen("materials"));
    rg_node all = {.kind = RG_NODE_LIST};
    bool any = false;
    for (int i = 0; list != NULL && list->kind == RG_NODE_LIST && i < list->children; i++) {
        const rg_node *item = &list->child[i];
        const rg_node *file =
            item->kind == RG_NODE_MAPPING ? rg_node_find(item, "file", strlen("file")) : NULL;
        if (file == NULL) {
            rg_node_copy(item, rg_node_append(&all));
            continue;
        }
        any = true;
        table t = {.ck = ck, .item = item, .file = file, .list = &all};
        t.path = rg_text_format("materials[%d].file", i);
        read_file(&t);
        rg_free(t.path);
    }
    if (any) {
        rg_node *child = list->child;
        int children = list->children;
        list->child = all.child;
        list->children = all.children;
        all.child = child;
        all.children = children;
    }
    rg_node_clear(&all);
}
