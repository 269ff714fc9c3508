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

/* What is wrong with the list of parameters; false: nothing. */
static bool misnamed(const rg_user_parameter *list, int count, char *why, size_t size) {
    for (int i = 0; i < count; i++) {
        const char *name = list[i].name;
        bool twice = false;
        for (int k = 0; name != NULL && k < i; k++) {
            twice = twice || strcmp(name, list[k].name) == 0;
        }
        if (name == NULL || is_reserved(name) || twice) {
            snprintf(why, size, "its parameter %d has %s%s", i + 1, name == NULL ? "no name" : "the name ",
                     name == NULL ? ""
                     : twice      ? "of another one"
                                  : "of another key, or one that is not of letters, digits, _ and -");
            return true;
        }
    }
    return false;
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
    return why[0] != '\0' || misnamed(f->parameter, f->parameters, why, size);
}

/* The symbol of the library at `path`; NULL where it cannot serve this program as `kind`. */
static const void *open_library(const char *path, const char *kind, char *why, size_t size) {
    void *handle = dlopen(path, RTLD_NOW | RTLD_LOCAL); /* for as long as the program runs */
    const rg_user_head *head = handle != NULL ? dlsym(handle, RG_USER_SYMBOL) : NULL;
    if (handle == NULL) {
        snprintf(why, size, "cannot be loaded: %s", dlerror());
    } else if (head == NULL || strcmp(head->magic, RG_USER_MAGIC) != 0) {
        snprintf(why, size, "not made by rhegma material");
    } else if (strcmp(head->kind, kind) != 0) {
        snprintf(why, size, "of a %.15s, not of a %s", head->kind, kind);
    } else if (!unfit(head, why, size)) {
        return head;
    }
    return NULL;
}

const rg_user_material *rg_user_load(const char *path, char *why, size_t size) {
    const rg_user_material *u = open_library(path, "material", why, size);
    return u != NULL && !misstated(u, why, size) ? u : NULL;
}

const rg_user_law *rg_user_load_law(const char *path, char *why, size_t size) {
    const rg_user_law *u = open_library(path, "law", why, size);
    if (u == NULL || misnamed(u->facts->parameter, u->facts->parameters, why, size)) {
        return NULL;
    }
    const rg_user_law_facts *f = u->facts;
    if (f->name == NULL || f->work == NULL || f->end == NULL || f->parameters > RG_USER_WORK) {
        snprintf(why, size, "its RG_USER_LAW_IS must have .name, .work, .end and at most %d parameters",
                 RG_USER_WORK);
        return NULL;
    }
    return u;
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

/* A problem of the key `word` of the block at `path`, which has a dot behind it. */
static void wrong(rg_check *ck, rg_place at, const char *path, const char *word, rg_subject subject,
                  const char *what) {
    char *key = rg_text_format("%s%s", path, word);
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

/* What declares parameters, and where they stand. */
typedef struct {
    const char *name, *path;
    const rg_user_parameter *list;
    int count;
    rg_place block;
    const rg_node *given; /* NULL: none */
} declared;

static bool read_parameter(rg_check *ck, const declared *d, const rg_user_parameter *p, double *value) {
    const rg_node *node = d->given != NULL ? rg_node_find(d->given, p->name, strlen(p->name)) : NULL;
    rg_key key = key_of(p);
    char allowed[160];
    *value = p->fallback;
    if (node == NULL && p->optional) {
        return true;
    }
    if (node == NULL) {
        rg_subject subject = {.allowed = rg_key_allowed(&key, allowed, sizeof allowed)};
        wrong(ck, d->block, d->path, p->name, subject, "missing");
        return false;
    }
    char *path = rg_text_format("%s%s", d->path, p->name);
    bool good = rg_value_read(ck, &key, node, path, value);
    rg_free(path);
    return good;
}

/* Reports what stands among the parameters and is none, or is there twice. */
static bool check_names(rg_check *ck, const declared *d) {
    const char *names[RG_USER_PARAMETERS + 1] = {NULL};
    char known[400] = "";
    bool good = true;
    for (int i = 0; i < d->count; i++) {
        names[i] = d->list[i].name;
        rg_text_add(known, sizeof known, "%s%s", i > 0 ? ", " : "", names[i]);
    }
    for (int i = 0; d->given != NULL && i < d->given->children; i++) {
        const rg_node *node = &d->given->child[i];
        const char *near = rg_nearest(node->key, names);
        rg_subject subject = {.nearest = near, .allowed = near != NULL ? NULL : known};
        int k = 0;
        while (k < d->count && strcmp(names[k], node->key) != 0) {
            k++;
        }
        if (k == d->count) {
            char what[160];
            snprintf(what, sizeof what, "unknown parameter of %.100s", d->name);
            wrong(ck, node->key_at, d->path, node->key, subject, what);
            good = false;
        } else if (rg_node_find(d->given, node->key, strlen(node->key)) != node) {
            wrong(ck, node->key_at, d->path, node->key, (rg_subject){0}, "given twice");
            good = false;
        }
    }
    return good;
}

static bool read_parameters(rg_check *ck, const declared *d, double value[]) {
    bool good = check_names(ck, d);
    for (int i = 0; i < d->count; i++) {
        good = read_parameter(ck, d, &d->list[i], &value[i]) && good;
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

/* The loaded library, its path made absolute; NULL: what is wrong with it is reported. */
static const void *load(rg_check *ck, const rg_node *node, const char *block, bool law,
                        rg_library_input *library) {
    char why[512], *path = rg_path_of_case(ck, library->path);
    const void *is = law ? (const void *)rg_user_load_law(path, why, sizeof why)
                         : (const void *)rg_user_load(path, why, sizeof why);
    if (is == NULL) {
        wrong(ck, node->at, block, "library", (rg_subject){.value = library->path}, why);
        rg_free(path);
        return NULL;
    }
    library->hash = hash_of(path);
    rg_free(library->path);
    library->path = path;
    return is;
}

/* What the parameters make of the material: moduli of a solid, and a function that holds the checks. */
static void check_solid(rg_check *ck, const rg_node *node) {
    rg_user_input *user = &ck->material.of->user;
    const rg_user_facts *facts = user->is.library->facts;
    const char *complaint = facts->wrong != NULL ? facts->wrong(user->is.parameter) : NULL;
    const rg_node *block = ck->material.block;
    char why[512];
    if (complaint != NULL) {
        wrong(ck, block->at, ck->material.path, "parameters", (rg_subject){.value = facts->name}, complaint);
        return;
    }
    rg_material m = rg_user_material_of(ck->material.of);
    if (!(m.mu > 0 && m.lambda + 2 * m.mu / 3 > 0 && isfinite(m.lambda + m.mu))) {
        snprintf(why, sizeof why, "gives moduli of no solid: lambda %.6g Pa, mu %.6g Pa", m.lambda, m.mu);
        wrong(ck, node->at, ck->material.path, "library", (rg_subject){.value = facts->name}, why);
    } else if (!rg_user_check(&m, &user->report, why, sizeof why)) {
        wrong(ck, node->at, ck->material.path, "library", (rg_subject){.value = facts->name}, why);
    }
}

void rg_user_rule(rg_check *ck, const rg_node *parameters) {
    rg_material_check *m = &ck->material;
    rg_user_input *user = &m->of->user;
    user->is.library = m->library != NULL ? load(ck, m->library, m->path, false, &user->library) : NULL;
    if (user->is.library == NULL) {
        ck->models = false;
        return;
    }
    const rg_user_facts *facts = user->is.library->facts;
    declared d = {facts->name,
                  m->path,
                  facts->parameter,
                  facts->parameters,
                  m->block != NULL ? m->block->at : (rg_place){0},
                  parameters};
    if (read_parameters(ck, &d, user->is.parameter)) {
        check_solid(ck, m->library);
    }
}

void rg_user_law_rule(rg_check *ck, const rg_node *parameters) {
    static const char path[] = "interface.";
    const rg_node *node = ck->law_library;
    rg_user_law_input *user = &ck->c->interface.user;
    double *shape = ck->c->interface.shape[RG_LAW_USER];
    user->is = load(ck, node, path, true, &user->library);
    if (user->is == NULL) {
        return;
    }
    const rg_user_law_facts *facts = user->is->facts;
    declared d = {facts->name, path, facts->parameter, facts->parameters, node->key_at, parameters};
    if (!read_parameters(ck, &d, shape)) {
        return;
    }
    char why[512];
    shape[RG_USER_WORK] = facts->work(shape);
    shape[RG_USER_END] = facts->end(shape);
    rg_cohesive law = {.law = RG_LAW_USER, .user = user->is};
    memcpy(law.shape, shape, sizeof law.shape);
    if (!rg_user_law_check(&law, 1e8, 1e-6, &user->share, &user->closed, why, sizeof why)) {
        wrong(ck, node->at, path, "library", (rg_subject){.value = facts->name}, why);
    }
}
