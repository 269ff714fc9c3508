#include "case/user.h"

#include <dlfcn.h>
#include <errno.h>
#include <math.h>
#include <string.h>

#include "base/hash.h"
#include "base/mem.h"
#include "case/check.h"
#include "case/read.h"

/* ---- loading ---- */

static const char *precision(int bytes) {
    return bytes == sizeof(float) ? "single" : "double";
}

/* What keeps the library from serving this program; the message names both. False: nothing. */
static bool unfit(const rg_user_head *head, char *why, size_t size) {
    const rg_kernels *here = rg_kernels_select();
    why[0] = '\0';
    if (head->abi != RG_USER_ABI || head->layout != RG_USER_LAYOUT) {
        snprintf(why, size,
                 "made for ABI %d, layout %d, and this program has ABI %d, layout %d: compile it again with "
                 "rhegma material",
                 (int)head->abi, (int)head->layout, RG_USER_ABI, RG_USER_LAYOUT);
    } else if (head->real != (int)sizeof(rg_real)) {
        snprintf(why, size, "computes in %s precision, and this program in %s: compile it with this program",
                 precision((int)head->real), precision((int)sizeof(rg_real)));
    } else if (here != NULL && (head->vector != here->vector || strcmp(head->isa, here->name) != 0)) {
        snprintf(
            why, size,
            "made for %.31s, vectors of %d bytes, and this run is on %s, vectors of %d bytes: compile it "
            "here, or for --isa %s, or run with RHEGMA_ISA=%.31s",
            head->isa, (int)head->vector, here->name, here->vector, here->name, head->isa);
    }
    return why[0] != '\0';
}

static bool is_reserved(const char *name) {
    const rg_key *key = rg_key_find(&rg_material_table, name);
    return (key != NULL && (key->models == 0 || (key->models & RG_MATERIAL_BIT_USER) != 0)) ||
           !rg_is_name(name);
}

/* What is wrong with what the library says of itself; false: nothing. */
static bool misstated(const rg_user_material *u, char *why, size_t size) {
    const rg_user_facts *f = u->facts;
    why[0] = '\0';
    if (f->name == NULL || f->moduli == NULL) {
        snprintf(why, size, "its RG_USER_MATERIAL has no .%s", f->name == NULL ? "name" : "moduli");
    } else if (u->history < 0 || u->history > RG_LIBRARY_HISTORY || f->parameters > RG_USER_PARAMETERS) {
        snprintf(why, size, "has %d values of history and %d parameters; at most %d and %d", u->history,
                 f->parameters, RG_LIBRARY_HISTORY, RG_USER_PARAMETERS);
    }
    for (int i = 0; i < f->parameters && why[0] == '\0'; i++) {
        const char *name = f->parameter[i].name;
        bool twice = false;
        for (int k = 0; name != NULL && k < i; k++) {
            twice = twice || strcmp(name, f->parameter[k].name) == 0;
        }
        if (name == NULL || is_reserved(name) || twice) {
            snprintf(why, size, "its parameter %d has %s%s", i + 1, name == NULL ? "no name" : "the name ",
                     name == NULL ? ""
                     : twice      ? "of another one"
                                  : "of another key, or one that is not of letters, digits, _ and -");
        }
    }
    return why[0] != '\0';
}

const rg_user_material *rg_user_load(const char *path, char *why, size_t size) {
    void *handle = dlopen(path, RTLD_NOW | RTLD_LOCAL); /* for as long as the program runs */
    const rg_user_material *u = handle != NULL ? dlsym(handle, RG_USER_SYMBOL) : NULL;
    if (handle == NULL) {
        snprintf(why, size, "cannot be loaded: %s", dlerror());
    } else if (u == NULL || strcmp(u->head.magic, RG_USER_MAGIC) != 0) {
        snprintf(why, size, "not made by rhegma material");
    } else if (strcmp(u->head.kind, "material") != 0) {
        snprintf(why, size, "of a %.15s, not of a material", u->head.kind);
    } else if (!unfit(&u->head, why, size) && !misstated(u, why, size)) {
        return u;
    }
    return NULL;
}

rg_material rg_user_material_of(const rg_material_input *in) {
    rg_material m = {.model = RG_MATERIAL_USER, .density = in->density, .of.user = in->user.is, .dt = 1};
    in->user.is.library->facts->moduli(in->user.is.parameter, &m.lambda, &m.mu);
    return m;
}

/* ---- in a case ---- */

static bool is_user(const rg_node *block) {
    const rg_node *model =
        block->kind == RG_NODE_MAPPING ? rg_node_find(block, "model", strlen("model")) : NULL;
    return model != NULL && model->kind == RG_NODE_SCALAR && strcmp(model->text, "user") == 0;
}

static void gather(rg_node *block) {
    if (!is_user(block)) {
        return;
    }
    rg_node numbers = {.kind = RG_NODE_MAPPING, .at = block->at, .key_at = block->at};
    rg_node *there = rg_node_find(block, "parameters", strlen("parameters"));
    int stay = 0;
    for (int i = 0; i < block->children; i++) {
        rg_node *child = &block->child[i];
        if (child->kind == RG_NODE_SCALAR && rg_is_name(child->key) && !is_reserved(child->key)) {
            *rg_node_append(there != NULL && there->kind == RG_NODE_MAPPING ? there : &numbers) = *child;
        } else {
            there = there == child ? &block->child[stay] : there;
            rg_node moved = *child;
            block->child[stay++] = moved;
        }
    }
    block->children = stay;
    if (numbers.children > 0) {
        numbers.key = rg_text_copy("parameters", strlen("parameters"));
        *rg_node_append(block) = numbers;
    }
}

void rg_user_parameters_gather(rg_node *root) {
    if (root->kind != RG_NODE_MAPPING) {
        return;
    }
    rg_node *block = rg_node_find(root, "material", strlen("material"));
    rg_node *list = rg_node_find(root, "materials", strlen("materials"));
    if (block != NULL) {
        gather(block);
    }
    for (int i = 0; list != NULL && list->kind == RG_NODE_LIST && i < list->children; i++) {
        gather(&list->child[i]);
    }
}

/* A problem of the key `word` of the block. */
static void wrong(rg_check *ck, rg_place at, const char *word, rg_subject subject, const char *what) {
    char *key = rg_text_format("%s%s", ck->material.path, word);
    subject.key = key;
    rg_problem_add(ck->problems, at, &subject, "%s", what);
    rg_free(key);
}

static rg_key key_of(const rg_user_parameter *p) {
    bool any = !(p->low < p->high);
    return (rg_key){.name = p->name,
                    .unit = p->unit,
                    .type = RG_KEY_REAL,
                    .count = 1,
                    .low = any ? -INFINITY : p->low,
                    .high = any ? INFINITY : p->high,
                    .low_open = p->open,
                    .high_open = p->open};
}

static bool read_parameter(rg_check *ck, const rg_user_parameter *p, const rg_node *all, double *value) {
    const rg_node *node = all != NULL ? rg_node_find(all, p->name, strlen(p->name)) : NULL;
    const rg_node *block = ck->material.block;
    rg_key key = key_of(p);
    char allowed[160];
    *value = p->fallback;
    if (node == NULL && p->optional) {
        return true;
    }
    if (node == NULL) {
        rg_subject subject = {.allowed = rg_key_allowed(&key, allowed, sizeof allowed)};
        wrong(ck, block != NULL ? block->at : (rg_place){0}, p->name, subject, "missing");
        return false;
    }
    char *path = rg_text_format("%s%s", ck->material.path, p->name);
    bool good = rg_value_read(ck, &key, node, path, value);
    rg_free(path);
    return good;
}

static const rg_user_parameter *find_parameter(const rg_user_facts *facts, const char *name) {
    for (int i = 0; i < facts->parameters; i++) {
        if (strcmp(facts->parameter[i].name, name) == 0) {
            return &facts->parameter[i];
        }
    }
    return NULL;
}

/* Reports what stands among the parameters and is none, or is there twice. */
static bool check_names(rg_check *ck, const rg_user_facts *facts, const rg_node *all) {
    const char *names[RG_USER_PARAMETERS + 1] = {NULL};
    char known[400] = "";
    bool good = true;
    for (int i = 0; i < facts->parameters; i++) {
        names[i] = facts->parameter[i].name;
        rg_text_add(known, sizeof known, "%s%s", i > 0 ? ", " : "", names[i]);
    }
    for (int i = 0; all != NULL && i < all->children; i++) {
        const rg_node *node = &all->child[i];
        const char *near = rg_nearest(node->key, names);
        rg_subject subject = {.nearest = near, .allowed = near != NULL ? NULL : known};
        if (find_parameter(facts, node->key) == NULL) {
            char what[160];
            snprintf(what, sizeof what, "unknown parameter of %.100s", facts->name);
            wrong(ck, node->key_at, node->key, subject, what);
            good = false;
        } else if (rg_node_find(all, node->key, strlen(node->key)) != node) {
            wrong(ck, node->key_at, node->key, (rg_subject){0}, "given twice");
            good = false;
        }
    }
    return good;
}

static uint64_t hash_of(const char *path) {
    size_t size = 0;
    char *bytes = rg_case_file(path, &size);
    uint64_t h = rg_hash(0, size);
    for (size_t i = 0; bytes != NULL && i < size; i += sizeof(uint64_t)) {
        uint64_t word = 0;
        memcpy(&word, bytes + i, size - i < sizeof word ? size - i : sizeof word);
        h = rg_hash(h, word);
    }
    rg_free(bytes);
    return h;
}

static bool load(rg_check *ck, const rg_node *node) {
    rg_user_input *user = &ck->material.of->user;
    char why[512], *path = rg_path_of_case(ck, user->library);
    user->is.library = rg_user_load(path, why, sizeof why);
    if (user->is.library == NULL) {
        wrong(ck, node->at, "library", (rg_subject){.value = user->library}, why);
        rg_free(path);
        return false;
    }
    user->hash = hash_of(path);
    rg_free(user->library);
    user->library = path;
    return true;
}

/* What the parameters make of the material: moduli of a solid, and a function that holds the checks. */
static void check_solid(rg_check *ck, const rg_node *node) {
    rg_user_input *user = &ck->material.of->user;
    const rg_user_facts *facts = user->is.library->facts;
    const char *complaint = facts->wrong != NULL ? facts->wrong(user->is.parameter) : NULL;
    const rg_node *block = ck->material.block;
    char why[512];
    if (complaint != NULL) {
        wrong(ck, block->at, "parameters", (rg_subject){.value = facts->name}, complaint);
        return;
    }
    rg_material m = rg_user_material_of(ck->material.of);
    if (!(m.mu > 0 && m.lambda + 2 * m.mu / 3 > 0 && isfinite(m.lambda + m.mu))) {
        snprintf(why, sizeof why, "gives moduli of no solid: lambda %.6g Pa, mu %.6g Pa", m.lambda, m.mu);
        wrong(ck, node->at, "library", (rg_subject){.value = facts->name}, why);
    } else if (!rg_user_check(&m, &user->report, why, sizeof why)) {
        wrong(ck, node->at, "library", (rg_subject){.value = facts->name}, why);
    }
}

void rg_user_rule(rg_check *ck, const rg_node *parameters) {
    rg_material_check *m = &ck->material;
    if (m->library == NULL || !load(ck, m->library)) {
        ck->models = false;
        return;
    }
    rg_user_values *is = &m->of->user.is;
    const rg_user_facts *facts = is->library->facts;
    bool good = check_names(ck, facts, parameters);
    for (int i = 0; i < facts->parameters; i++) {
        good = read_parameter(ck, &facts->parameter[i], parameters, &is->parameter[i]) && good;
    }
    if (good) {
        check_solid(ck, m->library);
    }
}
