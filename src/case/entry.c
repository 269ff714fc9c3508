#include "case/entry.h"

#include <string.h>

#include "base/mem.h"

const rg_node *rg_entry_given(const rg_entry *e, const char *key) {
    const rg_node *section = e->item;
    for (const char *dot = strchr(key, '.'); dot != NULL && section != NULL; dot = strchr(key, '.')) {
        section = rg_node_find(section, key, (size_t)(dot - key));
        key = dot + 1;
    }
    return section == NULL ? NULL : rg_node_find(section, key, strlen(key));
}

void rg_entry_wrong(const rg_entry *e, const char *key, rg_place at, rg_subject subject, const char *what) {
    char *path = key == NULL       ? rg_text_format("%s", e->path)
                 : e->path == NULL ? rg_text_format("%s", key)
                                   : rg_text_format("%s.%s", e->path, key);
    subject.key = path;
    rg_problem_add(e->ck->problems, at, &subject, "%s", what);
    rg_free(path);
}
