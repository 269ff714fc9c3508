#include "case/entry.h"

#include <string.h>

#include "base/mem.h"

const rg_node *rg_entry_given(const rg_entry *e, const char *key) {
    const char *dot = strchr(key, '.');
    const rg_node *section = dot == NULL ? e->item : rg_node_find(e->item, key, (size_t)(dot - key));
    const char *last = dot == NULL ? key : dot + 1;
    return section == NULL ? NULL : rg_node_find(section, last, strlen(last));
}

void rg_entry_wrong(const rg_entry *e, const char *key, rg_place at, rg_subject subject, const char *what) {
    char *path = key == NULL ? rg_text_format("%s", e->path) : rg_text_format("%s.%s", e->path, key);
    subject.key = path;
    rg_problem_add(e->ck->problems, at, &subject, "%s", what);
    rg_free(path);
}
