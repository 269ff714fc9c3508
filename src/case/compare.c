#include "case/compare.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/mem.h"
#include "case/key.h"
#include "case/tree.h"

static void write_fixed(FILE *out, const rg_key_table *table, const void *base, const char *prefix) {
    for (int i = 0; i < table->keys; i++) {
        const rg_key *key = &table->key[i];
        if (key->may_change || !rg_key_present(key, base)) {
            continue;
        }
        if (key->type != RG_KEY_LIST) {
            fprintf(out, "%s%s: ", prefix, key->name);
            rg_key_write(out, key, base);
            fputc('\n', out);
            continue;
        }
        int count = 0;
        memcpy(&count, (const char *)base + key->offset_count, sizeof count);
        const char *list = rg_pointer_get((const char *)base + key->offset);
        for (int k = 0; k < count; k++) {
            char *inner = rg_text_format("%s%s[%d].", prefix, key->name, k);
            write_fixed(out, key->entry, list + (size_t)k * key->entry->size, inner);
            rg_free(inner);
        }
    }
}

char *rg_case_fixed(const rg_case *c) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (out == NULL) {
        rg_fatal(RG_FAILURE, "out of memory");
    }
    write_fixed(out, &rg_case_table, c, "");
    fclose(out);
    return text;
}

/* A damaged checkpoint may have lines that are no "key: value". */
static size_t key_length(const char *line) {
    return strcspn(line, ":\n");
}

static const char *value_of(const char *line) {
    const char *at = line + key_length(line);
    at += *at == ':';
    return at + (*at == ' ');
}

/* The line of `text` with the key of `line`; NULL if there is none. */
static const char *find_line(const char *text, const char *line) {
    size_t key = key_length(line) + 1;
    while (text != NULL && strncmp(text, line, key) != 0) {
        text = strchr(text, '\n');
        text = text == NULL ? NULL : text + 1;
    }
    return text;
}

static const char *next_line(const char *line) {
    line += strcspn(line, "\n");
    return *line == '\n' ? line + 1 : line;
}

static bool same_line(const char *a, const char *b) {
    size_t n = strcspn(a, "\n");
    return strcspn(b, "\n") == n && strncmp(a, b, n) == 0;
}

/* Adds "\n  key: value, in the checkpoint ..." to *words. */
static void add_change(char **words, const char *here, const char *before) {
    const char *line = here != NULL ? here : before;
    const char *now = here != NULL ? value_of(here) : "not given";
    const char *then = before != NULL ? value_of(before) : "not given";
    char *longer = rg_text_format("%s\n  %.*s: %.*s; in the checkpoint: %.*s", *words, (int)key_length(line),
                                  line, (int)strcspn(now, "\n"), now, (int)strcspn(then, "\n"), then);
    rg_free(*words);
    *words = longer;
}

char *rg_case_changes(const char *before, const char *here) {
    char *words =
        rg_text_format("the case is not that of the checkpoint; a restart may change time, checkpoint, "
                       "mesh.weight, mesh.rebalance and most of output, but not");
    size_t none = strlen(words);
    for (const char *line = here; *line != '\0'; line = next_line(line)) {
        const char *then = find_line(before, line);
        if (then == NULL || !same_line(then, line)) {
            add_change(&words, line, then);
        }
    }
    for (const char *line = before; *line != '\0'; line = next_line(line)) {
        if (find_line(here, line) == NULL) {
            add_change(&words, NULL, line);
        }
    }
    if (strlen(words) == none) {
        rg_free(words);
        return NULL;
    }
    return words;
}
