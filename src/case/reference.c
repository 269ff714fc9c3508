/* The registry of keys as text and as Markdown. */
#include "case/reference.h"

#include "case/expr.h"
#include "case/tree.h"

/* ---- the keys in order ---- */

void rg_keys_walk(rg_key_visit *visit, void *to) {
    for (int i = 0; i < rg_case_table.keys; i++) {
        const rg_key *key = &rg_case_table.key[i];
        visit(to, key->name, key);
        for (int k = 0; key->entry != NULL && k < key->entry->keys; k++) {
            const rg_key *inner = &key->entry->key[k];
            if (!inner->of_material) {
                char name[RG_LONGEST_WORD];
                snprintf(name, sizeof name, "%s[].%s", key->name, inner->name);
                visit(to, name, inner);
            }
        }
    }
}

/* When the key is used: "; with law bilinear". Appended. */
static void add_condition(const rg_key *key, char *text, size_t size) {
    static const char *const words[RG_GROUPS] = {
        [RG_GROUP_BOX] = "without mesh.file",
        [RG_GROUP_COHESIVE] = "unless the law is none",
        [RG_GROUP_ENERGY] = "with a law that has a work of separation",
        [RG_GROUP_SHEAR] = "with a law of the effective opening",
        [RG_GROUP_FACES] = "with form continuous",
        [RG_GROUP_INTERFACE] = "where there are interfaces",
        [RG_GROUP_DG] = "with interfaces, but in form intrinsic",
        [RG_GROUP_SWITCH] = "with a law, but in form intrinsic",
        [RG_GROUP_ONSET] = "with activation conserving",
        [RG_GROUP_WEIBULL] = "with interface.weibull.modulus",
        [RG_GROUP_RISE] = "with interface.rise.rate",
        [RG_GROUP_HEAT] = "with temperature.value",
        [RG_GROUP_RELAX] = "with start relax",
        [RG_GROUP_STRESS_RUN] = "with initial.stress.run",
        [RG_GROUP_CONTACT] = "with contact.model general",
    };
    if (key->group == RG_GROUP_LAW) {
        rg_text_add(text, size, "; with law %s", rg_law_word(key->law));
    } else if (words[key->group] != NULL) {
        rg_text_add(text, size, "; %s", words[key->group]);
    }
    if (key->models != 0 && key->models != (1U << RG_MATERIAL_MODELS) - 1) {
        char names[256];
        rg_models_words(key, names, sizeof names);
        rg_text_add(text, size, "; of %s", names);
    }
}

/* "0.3; with activation conserving" */
static const char *describe_default(const rg_key *key, char *text, size_t size) {
    rg_key_default(key, text, size);
    add_condition(key, text, size);
    return text;
}

static const char *change_words(const rg_key *key) {
    return key->may_change ? "; may change on a restart" : "";
}

static int choices(const rg_key *key) {
    int count = 0;
    while (key->choice_meaning != NULL && key->choice[count] != NULL) {
        count++;
    }
    return count;
}

/* ---- one page of either kind ---- */

typedef struct {
    FILE *out;
    const char *prefix;
    int keys;       /* written so far */
    char block[64]; /* the last one's first part: "mesh" */
} page;

static bool is_asked_for(const page *p, const char *name) {
    return strncmp(name, p->prefix, strlen(p->prefix)) == 0;
}

static void text_row(void *to, const char *name, const rg_key *key) {
    page *p = to;
    char allowed[512], absent[512];
    if (!is_asked_for(p, name)) {
        return;
    }
    fprintf(p->out, "%s%s\n    %s; %s%s\n    %s%s\n", p->keys > 0 ? "\n" : "", name,
            rg_key_allowed(key, allowed, sizeof allowed), rg_key_has_default(key) ? "default: " : "",
            describe_default(key, absent, sizeof absent), key->meaning, change_words(key));
    for (int i = 0; i < choices(key); i++) {
        fprintf(p->out, "      %s: %s\n", key->choice[i], key->choice_meaning[i]);
    }
    p->keys++;
}

/* A heading and the head of a table before the first key of each block. */
static void markdown_block(page *p, const char *name) {
    size_t length = strcspn(name, ".[");
    if (strlen(p->block) == length && strncmp(p->block, name, length) == 0) {
        return;
    }
    snprintf(p->block, sizeof p->block, "%.*s", (int)length, name);
    fprintf(p->out, "%s## `%s`\n\n| key | value | default | meaning |\n| --- | --- | --- | --- |\n",
            p->keys > 0 ? "\n" : "", p->block);
}

static void markdown_row(void *to, const char *name, const rg_key *key) {
    page *p = to;
    char allowed[512], absent[512];
    if (!is_asked_for(p, name)) {
        return;
    }
    markdown_block(p, name);
    fprintf(p->out, "| `%s` | %s | %s | %s%s", name, rg_key_allowed(key, allowed, sizeof allowed),
            describe_default(key, absent, sizeof absent), key->meaning, change_words(key));
    for (int i = 0; i < choices(key); i++) {
        fprintf(p->out, "<br>`%s`: %s", key->choice[i], key->choice_meaning[i]);
    }
    fputs(" |\n", p->out);
    p->keys++;
}

static bool shows_expressions(page *p) {
    bool shows = is_asked_for(p, "expressions");
    p->keys += shows ? 1 : 0;
    return shows;
}

int rg_reference_text(FILE *out, const char *prefix) {
    page p = {.out = out, .prefix = prefix};
    rg_keys_walk(text_row, &p);
    const char *gap = p.keys > 0 ? "\n" : "";
    if (shows_expressions(&p)) {
        fprintf(out, "%sexpressions\n", gap);
        for (const rg_expr_word *word = rg_expr_words; word->write != NULL; word++) {
            fprintf(out, "    %-44s%s\n", word->write, word->meaning);
        }
    }
    return p.keys;
}

int rg_reference_markdown(FILE *out, const char *prefix) {
    page p = {.out = out, .prefix = prefix};
    rg_keys_walk(markdown_row, &p);
    const char *gap = p.keys > 0 ? "\n" : "";
    if (shows_expressions(&p)) {
        fprintf(out, "%s## Expressions\n\n| write | meaning |\n| --- | --- |\n", gap);
        for (const rg_expr_word *word = rg_expr_words; word->write != NULL; word++) {
            fputs("| `", out);
            for (const char *c = word->write; *c != '\0'; c++) {
                fprintf(out, "%s%c", *c == '|' ? "\\" : "", *c); /* a bar would end the cell */
            }
            fprintf(out, "` | %s |\n", word->meaning);
        }
    }
    return p.keys;
}
