#include "keys_command.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "base/error.h"
#include "case/reference.h"
#include "usage.h"

static int complain(const char *what, const char *argument) {
    fprintf(stderr, "rhegma: keys: %s: %s\n%s", what, argument, rg_usage("keys"));
    return RG_USAGE;
}

static int print(const char *prefix, bool markdown) {
    int keys = markdown ? rg_reference_markdown(stdout, prefix) : rg_reference_text(stdout, prefix);
    if (keys == 0) {
        char text[RG_LONGEST_WORD];
        const char *nearest = rg_key_nearest(&rg_case_table, prefix, text, sizeof text);
        fprintf(stderr, "rhegma: no key begins with %s%s%s%s\n", prefix,
                nearest != NULL ? "; did you mean '" : "", nearest != NULL ? nearest : "",
                nearest != NULL ? "'?" : "");
        return RG_USAGE;
    }
    return RG_OK;
}

int rg_keys_command(int argc, char **argv) {
    const char *prefix = "";
    bool markdown = false, schema = false;
    for (int i = 2; i < argc; i++) {
        if (strcmp(argv[i], "--markdown") == 0) {
            markdown = true;
        } else if (strcmp(argv[i], "--schema") == 0) {
            schema = true;
        } else if (argv[i][0] == '-') {
            return complain("unknown option", argv[i]);
        } else if (prefix[0] != '\0') {
            return complain("one prefix at a time; not understood", argv[i]);
        } else {
            prefix = argv[i];
        }
    }
    if (schema && (markdown || prefix[0] != '\0')) {
        return complain("--schema is that of the whole case; not understood with it",
                        markdown ? "--markdown" : prefix);
    }
    if (schema) {
        rg_schema_write(stdout);
        return RG_OK;
    }
    return print(prefix, markdown);
}
