/* YAML to a tree of nodes, from the event stream of libfyaml: its events carry exact marks and, unlike its
 * documents, keep repeated keys apart. */
#include "case/tree.h"

#include <libfyaml.h>
#include <string.h>

#include "base/error.h"
#include "base/mem.h"

typedef struct {
    rg_problems *problems;
    const char *set;
    struct fy_parser *parser;
    int depth;
} reader;

enum { MAX_DEPTH = 32 }; /* far more than any case needs, far less than the stack holds */

static void complain(const reader *r, rg_place at, const char *what) {
    rg_problem_add(r->problems, at, &(rg_subject){0}, "%s", what);
}

/* ---- text ---- */

/* Bytes of the UTF-8 character at p (at most `left`), 0 if it is none or is a control character YAML forbids.
 */
static size_t character(const unsigned char *p, size_t left) {
    if (p[0] < 0x80) {
        bool control = p[0] < 0x20 && p[0] != '\t' && p[0] != '\n' && p[0] != '\r';
        return control || p[0] == 0x7f ? 0 : 1;
    }
    size_t size = p[0] >= 0xf0 ? 4 : p[0] >= 0xe0 ? 3 : 2;
    if (p[0] < 0xc2 || p[0] > 0xf4 || size > left) {
        return 0;
    }
    for (size_t i = 1; i < size; i++) {
        if ((p[i] & 0xc0) != 0x80) {
            return 0;
        }
    }
    return size;
}

/* libfyaml ends silently at a NUL and loses scalars that are not UTF-8, so such bytes are caught before it.
 */
static bool is_text(const reader *r, const char *text, size_t size) {
    rg_place at = {.line = 1, .column = 1, .set = r->set};
    for (size_t i = 0, step = 0; i < size; i += step) {
        step = character((const unsigned char *)text + i, size - i);
        if (step == 0) {
            unsigned byte = (unsigned char)text[i];
            rg_problem_add(r->problems, at, &(rg_subject){0}, "byte 0x%02x is not text (UTF-8)", byte);
            return false;
        }
        bool end = text[i] == '\n';
        at.line += end ? 1 : 0;
        at.column = end ? 1 : at.column + 1;
    }
    return true;
}

/* ---- events ---- */

/* libfyaml's marks of aliases and quoted scalars lie behind the asterisk or the quote. */
static bool mark_is_late(struct fy_event *event) {
    if (event->type != FYET_SCALAR || event->scalar.value == NULL) {
        return event->type == FYET_ALIAS;
    }
    enum fy_scalar_style style = fy_token_scalar_style(event->scalar.value);
    return style == FYSS_SINGLE_QUOTED || style == FYSS_DOUBLE_QUOTED;
}

static rg_place place_of(const reader *r, struct fy_event *event, rg_place otherwise) {
    const struct fy_mark *mark = fy_event_start_mark(event);
    if (mark == NULL) {
        return otherwise;
    }
    int column = mark->column + (mark_is_late(event) ? 0 : 1);
    return (rg_place){.line = mark->line + 1, .column = column, .set = r->set};
}

static void read_scalar(const reader *r, struct fy_event *event, rg_node *node) {
    struct fy_token *token = event->scalar.value;
    size_t size = 0;
    const char *text = token == NULL ? "" : fy_token_get_text(token, &size);
    node->text = rg_text_copy(text, size);
    node->plain = token == NULL || fy_token_scalar_style(token) == FYSS_PLAIN;
    node->kind = RG_NODE_SCALAR;
    if (strlen(node->text) != size) {
        complain(r, node->at, "a text cannot hold the character NUL");
        node->kind = RG_NODE_BAD;
    }
}

static bool read_node(reader *r, struct fy_event *event, rg_place otherwise, rg_node *node);

/* Reads the children of a list up to its end. */
static bool read_list(reader *r, rg_node *list) {
    struct fy_event *event = NULL;
    while ((event = fy_parser_parse(r->parser)) != NULL) {
        if (event->type == FYET_SEQUENCE_END) {
            fy_parser_event_free(r->parser, event);
            return true;
        }
        rg_node *item = rg_node_append(list);
        if (!read_node(r, event, list->at, item)) {
            return false;
        }
    }
    return false;
}

/* Turns the node read as a key into the key of `pair`. */
static void take_key(const reader *r, rg_node *key, rg_node *pair) {
    char *word = NULL;
    if (key->kind == RG_NODE_SCALAR) {
        word = key->text;
        key->text = NULL;
    } else {
        if (key->kind != RG_NODE_BAD) {
            complain(r, key->at, "a key must be a single word");
        }
        word = rg_text_copy("", 0);
        rg_node_clear(pair);
    }
    pair->key = word;
    pair->key_at = key->at;
    rg_node_clear(key);
}

static bool read_pair(reader *r, struct fy_event *event, rg_place otherwise, rg_node *pair) {
    rg_node key = {.kind = RG_NODE_BAD}, value = {.kind = RG_NODE_BAD};
    bool good = read_node(r, event, otherwise, &key);
    event = good ? fy_parser_parse(r->parser) : NULL;
    good = event != NULL && read_node(r, event, key.at, &value);
    *pair = value;
    take_key(r, &key, pair);
    return good;
}

static bool read_mapping(reader *r, rg_node *mapping) {
    struct fy_event *event = NULL;
    while ((event = fy_parser_parse(r->parser)) != NULL) {
        if (event->type == FYET_MAPPING_END) {
            fy_parser_event_free(r->parser, event);
            return true;
        }
        rg_node *pair = rg_node_append(mapping);
        if (!read_pair(r, event, mapping->at, pair)) {
            return false;
        }
    }
    return false;
}

/* Reads the node that starts with `event` (and frees the event). False: the input ended or is bad YAML. */
static bool read_node(reader *r, struct fy_event *event, rg_place otherwise, rg_node *node) {
    enum fy_event_type type = event->type;
    node->at = place_of(r, event, otherwise);
    bool special = type == FYET_ALIAS || fy_event_get_anchor_token(event) != NULL ||
                   fy_event_get_tag_token(event) != NULL;
    if (type == FYET_SCALAR) {
        read_scalar(r, event, node);
    }
    fy_parser_event_free(r->parser, event);
    if (r->depth == MAX_DEPTH) {
        complain(r, node->at, "nested too deeply");
        return false;
    }
    r->depth++;
    bool good = true;
    if (type == FYET_SEQUENCE_START) {
        node->kind = RG_NODE_LIST;
        good = read_list(r, node);
    } else if (type == FYET_MAPPING_START) {
        node->kind = RG_NODE_MAPPING;
        good = read_mapping(r, node);
    }
    r->depth--;
    if (special) {
        complain(r, node->at, "anchors, aliases and tags are not supported");
        node->kind = RG_NODE_BAD;
    }
    return good;
}

/* Reads the one document of the stream. */
static void read_stream(reader *r, rg_node *root) {
    rg_place top = {.line = 1, .column = 1, .set = r->set};
    bool good = true;
    int documents = 0;
    struct fy_event *event = NULL;
    while (good && (event = fy_parser_parse(r->parser)) != NULL) {
        enum fy_event_type type = event->type;
        if (type == FYET_SCALAR || type == FYET_SEQUENCE_START || type == FYET_MAPPING_START ||
            type == FYET_ALIAS) {
            rg_node_clear(root);
            good = read_node(r, event, top, root);
            documents++;
            if (documents == 2) {
                complain(r, root->at, "a second YAML document; a case is one document");
            }
        } else {
            fy_parser_event_free(r->parser, event);
        }
    }
    if (documents == 0 && !fy_parser_get_stream_error(r->parser)) {
        complain(r, top, r->set == NULL ? "the file is empty" : "no value behind the '='");
    }
    if (documents != 1 || !good || fy_parser_get_stream_error(r->parser)) {
        rg_node_clear(root);
    }
}

static void report_syntax(const reader *r, struct fy_diag *diag) {
    void *iterator = NULL;
    const struct fy_diag_error *error = NULL;
    int reported = 0;
    while ((error = fy_diag_errors_iterate(diag, &iterator)) != NULL) {
        rg_place at = {.line = error->line, .column = error->column, .set = r->set};
        rg_problem_add(r->problems, at, &(rg_subject){0}, "not valid YAML: %s", error->msg);
        reported++;
    }
    if (reported == 0 && fy_parser_get_stream_error(r->parser)) {
        complain(r, (rg_place){.line = 1, .column = 1, .set = r->set}, "not valid YAML");
    }
}

void rg_yaml_parse(rg_problems *problems, const char *text, size_t size, const char *set, rg_node *root) {
    reader r = {.problems = problems, .set = set};
    if (!is_text(&r, text, size)) {
        return;
    }
    struct fy_diag_cfg quiet;
    fy_diag_cfg_default(&quiet);
    quiet.fp = NULL;
    struct fy_diag *diag = fy_diag_create(&quiet);
    struct fy_parse_cfg config = {.flags = FYPCF_QUIET | FYPCF_COLLECT_DIAG, .diag = diag};
    r.parser = fy_parser_create(&config);
    if (diag == NULL || r.parser == NULL) {
        rg_fatal(RG_FAILURE, "out of memory");
    }
    fy_diag_set_collect_errors(diag, true);
    if (fy_parser_set_string(r.parser, text, size) != 0) {
        rg_fatal(RG_FAILURE, "out of memory");
    }
    read_stream(&r, root);
    report_syntax(&r, diag);
    fy_parser_destroy(r.parser);
    fy_diag_destroy(diag);
}
