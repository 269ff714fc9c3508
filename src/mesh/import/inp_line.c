#include "mesh/import/inp_line.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/error.h"
#include "base/files.h"
#include "base/mem.h"
#include "mesh/rows.h"

enum {
    LONGEST = 1 << 16, /* bytes of a line: what is longer is no text */
    DEEPEST = 5,       /* files that include each other */
    MOST_FILES = 4096  /* in all: some could include themselves */
};

struct rg_inp_file {
    rg_inp_file *outer; /* goes on when this one ends */
    FILE *stream;
    rg_inp_place at;
    char *text; /* the line */
    size_t room;
    bool held; /* it was looked at, but is still to come */
};

void rg_inp_refuse(rg_inp_place at, const char *format, ...) {
    char what[400];
    va_list args;
    va_start(args, format);
    vsnprintf(what, sizeof what, format, args);
    va_end(args);
    rg_fatal(RG_USAGE, "%s:%ld: %s", at.path, at.line, what);
}

/* ---- files ---- */

static void push_stream(rg_inp_lines *l, FILE *stream, const char *path) {
    l->path = rg_realloc(l->path, l->paths + 1, sizeof *l->path);
    char *name = l->path[l->paths++] = RG_NEW(char, strlen(path) + 1);
    rg_inp_file *f = RG_NEW(rg_inp_file, 1);
    *f = (rg_inp_file){.outer = l->file, .stream = stream, .at = {strcpy(name, path), 0}};
    l->file = f;
    l->depth++;
}

static void push_file(rg_inp_lines *l, const char *path) {
    FILE *stream = rg_open_input(path);
    if (stream == NULL && l->file == NULL) {
        rg_fatal(RG_USAGE, "%s: cannot be read: %s", path, strerror(errno));
    } else if (stream == NULL) {
        rg_inp_refuse(l->at, "*%s: %s cannot be read: %s", l->keyword, path, strerror(errno));
    }
    push_stream(l, stream, path);
}

static void pop_file(rg_inp_lines *l) {
    rg_inp_file *f = l->file;
    bool failed = ferror(f->stream) != 0;
    l->at = f->at;
    l->file = f->outer;
    l->depth--;
    fclose(f->stream);
    rg_free(f->text);
    rg_free(f);
    if (failed) {
        rg_inp_refuse(l->at, "the file cannot be read to its end");
    }
}

/* From the folder of the file that names it. */
static void include(rg_inp_lines *l, const char *name) {
    if (name == NULL || name[0] == '\0') {
        rg_inp_refuse(l->at, "*%s: INPUT must name a file", l->keyword);
    }
    if (l->depth > DEEPEST || l->paths == MOST_FILES) {
        rg_inp_refuse(l->at, "*%s: INPUT=%s: more than %d files include each other, or more than %d in all",
                      l->keyword, name, DEEPEST, MOST_FILES);
    }
    const char *here = l->file->at.path, *slash = name[0] == '/' ? NULL : strrchr(here, '/');
    size_t folder = slash != NULL ? (size_t)(slash - here) + 1 : 0;
    char *path = RG_NEW(char, folder + strlen(name) + 1);
    memcpy(path, here, folder);
    strcpy(path + folder, name);
    push_file(l, path);
    rg_free(path);
}

/* Reads a line without its end, which is that of Unix, Windows or an old Macintosh; false: there is none. */
static bool read_line(rg_inp_file *f) {
    size_t length = 0;
    int c;
    if (f->held) {
        f->held = false;
        return true;
    }
    f->at.line++;
    while ((c = getc_unlocked(f->stream)) != EOF && c != '\n' && c != '\r') {
        if (c == '\0' || length == LONGEST) {
            rg_inp_refuse(f->at, "not a line of text: it has a byte of 0, or more than %d bytes", LONGEST);
        }
        f->text = rg_grow(f->text, &f->room, length + 1, 1);
        f->text[length++] = (char)c;
    }
    if (c == '\r' && (c = getc_unlocked(f->stream)) != '\n' && c != EOF) {
        ungetc(c, f->stream);
    }
    f->text = rg_grow(f->text, &f->room, length, 1);
    f->text[length] = '\0';
    if (f->at.line == 1 && strncmp(f->text, "\xef\xbb\xbf", 3) == 0) { /* how some editors mark UTF-8 */
        memmove(f->text, f->text + 3, length - 2);
    }
    return length > 0 || c != EOF;
}

/* ---- words ---- */

static const char *skip_blanks(const char *text) {
    return text + strspn(text, " \t");
}

static bool is_comment(const char *text) {
    return strncmp(skip_blanks(text), "**", 2) == 0;
}

/* Cuts the part before the next comma outside of quotation marks off; NULL at the end. */
static char *cut(char **rest) {
    char *begin = *rest;
    bool quoted = false;
    if (begin == NULL) {
        return NULL;
    }
    char *end = begin;
    for (; *end != '\0' && (quoted || *end != ','); end++) {
        quoted ^= *end == '"';
    }
    *rest = *end != '\0' ? end + 1 : NULL;
    *end = '\0';
    return begin;
}

/* What is between quotation marks as it is, other text without the blanks around it and inside. */
static char *tidy(char *text) {
    char *to = text;
    bool quoted = false;
    for (const char *from = text; *from != '\0'; from++) {
        quoted ^= *from == '"';
        if (*from != '"' && (quoted || (*from != ' ' && *from != '\t'))) {
            *to++ = *from;
        }
    }
    *to = '\0';
    return text;
}

/* Capitals without blanks to word[RG_INP_WORD]. */
static void take_word(const rg_inp_lines *l, char *word, char *text) {
    tidy(text);
    if (strlen(text) >= RG_INP_WORD) {
        rg_inp_refuse(l->at, "'%.80s' is no keyword or parameter", text);
    }
    for (size_t i = 0; i <= strlen(text); i++) {
        word[i] = (char)toupper((unsigned char)text[i]);
    }
}

/* ---- keyword lines ---- */

static bool ends_with_comma(const char *text) {
    size_t n = strlen(text);
    while (n > 0 && isspace((unsigned char)text[n - 1])) {
        n--;
    }
    return n > 0 && text[n - 1] == ',';
}

static void append(rg_inp_lines *l, const char *text) {
    size_t length = l->text != NULL ? strlen(l->text) : 0, more = strlen(text);
    if (length + more >= LONGEST) {
        rg_inp_refuse(l->at, "the keyword line has more than %d bytes", LONGEST);
    }
    if (length + more + 1 > l->text_room) {
        l->text_room = 2 * (length + more) + 64;
        l->text = rg_realloc(l->text, l->text_room, 1);
    }
    memcpy(l->text + length, text, more + 1);
}

/* Takes the lines in which the keyword line goes on: those behind a comma that are parameters. */
static void gather(rg_inp_lines *l) {
    append(l, l->file->text);
    while (ends_with_comma(l->text) && read_line(l->file)) {
        if (is_comment(l->file->text)) {
            continue;
        }
        if (!isalpha((unsigned char)*skip_blanks(l->file->text))) {
            l->file->held = true;
            break;
        }
        append(l, l->file->text);
    }
}

static void take_parameter(rg_inp_lines *l, char *text) {
    char *equals = strchr(text, '=');
    if (equals != NULL) {
        *equals++ = '\0';
    }
    if (*skip_blanks(text) == '\0' && equals == NULL) {
        return; /* a comma too many */
    }
    if (l->parameters == RG_INP_PARAMETERS) {
        rg_inp_refuse(l->at, "*%s has more than %d parameters", l->keyword, RG_INP_PARAMETERS);
    }
    take_word(l, l->parameter[l->parameters].name, text);
    l->parameter[l->parameters++].value = equals != NULL ? tidy(equals) : NULL;
}

static void read_keyword(rg_inp_lines *l) {
    l->parameters = 0;
    if (l->text != NULL) {
        l->text[0] = '\0';
    }
    gather(l);
    l->rest = l->text + strspn(l->text, " \t") + 1;
    take_word(l, l->keyword, cut(&l->rest));
    for (char *text = cut(&l->rest); text != NULL; text = cut(&l->rest)) {
        take_parameter(l, text);
    }
}

void rg_inp_allow(rg_inp_lines *l, const char *names) {
    for (size_t i = 0; i < l->parameters; i++) {
        char *given = l->parameter[i].name, fit[RG_INP_WORD] = "";
        size_t length = strlen(given), fits = 0;
        bool exact = false;
        for (const char *name = names; *name != '\0' && !exact; name += strspn(name, " ")) {
            size_t size = strcspn(name, " ");
            if (length > 0 && strncmp(name, given, length) == 0) { /* no word has a blank */
                exact = length == size;
                fits = exact ? 1 : fits + 1;
                memcpy(fit, name, size);
                fit[size] = '\0';
            }
            name += size;
        }
        if (fits != 1) {
            rg_inp_refuse(l->at, "*%s has no parameter '%s' that is known here", l->keyword, given);
        }
        strcpy(given, fit);
    }
}

const char *rg_inp_parameter(const rg_inp_lines *l, const char *name) {
    for (size_t i = 0; i < l->parameters; i++) {
        if (strcmp(l->parameter[i].name, name) == 0) {
            return l->parameter[i].value != NULL ? l->parameter[i].value : "";
        }
    }
    return NULL;
}

const char *rg_inp_name(const rg_inp_lines *l, const char *parameter) {
    const char *name = rg_inp_parameter(l, parameter);
    if (name == NULL || name[0] == '\0') {
        rg_inp_refuse(l->at, "*%s without %s", l->keyword, parameter);
    }
    if (strlen(name) >= RG_SET_NAME) {
        rg_inp_refuse(l->at, "'%s' is longer than %d bytes", name, RG_SET_NAME - 1);
    }
    return name;
}

/* ---- data lines ---- */

char *rg_inp_field(rg_inp_lines *l) {
    char *text = cut(&l->rest);
    return text != NULL ? tidy(text) : NULL;
}

bool rg_inp_is_number(const char *field) {
    return field[0] != '\0' && field[strspn(field, "0123456789")] == '\0';
}

rg_gid rg_inp_number(const rg_inp_lines *l, const char *field) {
    char *end;
    long long value = strtoll(field, &end, 10);
    if (end == field || *end != '\0' || value < 1 || value > RG_INP_MOST) {
        rg_inp_refuse(l->at, "'%s' is not the number of a node or element", field);
    }
    return value;
}

rg_gid rg_inp_integer(rg_inp_lines *l, rg_gid otherwise) {
    const char *field = rg_inp_field(l);
    bool none = field == NULL || field[0] == '\0';
    return none && otherwise > 0 ? otherwise : rg_inp_number(l, none ? "" : field);
}

double rg_inp_value(rg_inp_lines *l) {
    char *field = rg_inp_field(l), *end;
    if (field == NULL || field[0] == '\0') {
        return 0;
    }
    size_t d = strcspn(field, "Dd");
    if (field[d] != '\0') {
        field[d] = 'e';
    }
    double value = strtod(field, &end);
    if (field[strspn(field, "0123456789+-.eE")] != '\0' || *end != '\0' || end == field || !isfinite(value)) {
        rg_inp_refuse(l->at, "'%s' is not a coordinate", field);
    }
    return value;
}

/* ---- all lines ---- */

rg_inp_lines *rg_inp_open(const char *path, FILE *stream) {
    rg_inp_lines *l = RG_NEW(rg_inp_lines, 1);
    if (stream != NULL) {
        push_stream(l, stream, path);
    } else {
        push_file(l, path);
    }
    return l;
}

rg_inp_kind rg_inp_next(rg_inp_lines *l) {
    while (l->file != NULL) {
        if (!read_line(l->file)) {
            pop_file(l);
            continue;
        }
        const char *begin = skip_blanks(l->file->text);
        l->at = l->file->at;
        if (*begin == '\0' || is_comment(begin)) {
            continue;
        }
        if (*begin != '*') {
            l->rest = l->file->text;
            return RG_INP_DATA;
        }
        read_keyword(l);
        if (strcmp(l->keyword, "INCLUDE") != 0) {
            return RG_INP_KEYWORD;
        }
        include(l, rg_inp_parameter(l, "INPUT"));
    }
    return RG_INP_END;
}

void rg_inp_follow(rg_inp_lines *l) {
    if (rg_inp_parameter(l, "INPUT") != NULL) {
        include(l, rg_inp_parameter(l, "INPUT"));
    }
}

void rg_inp_close(rg_inp_lines *l) {
    while (l->file != NULL) {
        pop_file(l);
    }
    for (size_t i = 0; i < l->paths; i++) {
        rg_free(l->path[i]);
    }
    rg_free(l->path);
    rg_free(l->text);
    rg_free(l);
}
