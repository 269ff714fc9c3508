/* Libraries of the user's: why one cannot be loaded, to the letter; their parameters in a case; what the
 * moduli and the checks refuse. dlopen gives structures of this program in place of libraries. */
#include <dlfcn.h>
#include <math.h>

#include "base/hash.h"
#include "case/user.h"
#include "support/case_input.h"

/* ---- libraries ---- */

static union {
    rg_user_head head;
    rg_user_material material;
    rg_user_law law;
} library;

static const char *open_failure; /* what dlerror says */
static bool without_symbol;
static char opened[200];

void *__wrap_dlopen(const char *file, int mode);
void *__wrap_dlsym(void *handle, const char *symbol);
void *__real_dlsym(void *handle, const char *symbol);
char *__wrap_dlerror(void);

void *__wrap_dlopen(const char *file, int mode) {
    assert_int_equal(mode, RTLD_NOW | RTLD_LOCAL);
    snprintf(opened, sizeof opened, "%s", file);
    return open_failure != NULL ? NULL : &library;
}

void *__wrap_dlsym(void *handle, const char *symbol) {
    if (handle != &library) /* asked by the run time of a sanitizer */
        return __real_dlsym(handle, symbol);
    assert_string_equal(symbol, "rg_user_here");
    return without_symbol ? NULL : handle;
}

char *__wrap_dlerror(void) {
    static char words[80];
    snprintf(words, sizeof words, "%s", open_failure != NULL ? open_failure : "");
    return words;
}

static rg_user_head make_head(const char *kind) {
    const rg_kernels *here = rg_kernels_select();
    rg_user_head head = {.magic = RG_USER_MAGIC,
                         .abi = RG_USER_ABI,
                         .layout = RG_USER_LAYOUT,
                         .vector = here->vector,
                         .real = sizeof(rg_real)};
    snprintf(head.kind, sizeof head.kind, "%s", kind);
    snprintf(head.isa, sizeof head.isa, "%s", here->name);
    return head;
}

/* ---- a solid for small strains ---- */

enum { STIFF, RATIO, FACTOR };
static rg_user_parameter list[RG_USER_PARAMETERS + 2];
static const rg_user_parameter usual[] = {
    {.name = "stiff", .unit = "Pa", .low = 0, .high = INFINITY, .open = true},
    {.name = "ratio", .low = 0, .high = 0.5, .optional = true, .fallback = 0.25},
    {.name = "factor", .optional = true, .fallback = 1},
};

static void moduli(const double p[], double *lambda, double *mu) {
    *lambda = p[STIFF] * p[RATIO] / ((1 + p[RATIO]) * (1 - 2 * p[RATIO]));
    *mu = p[STIFF] / (2 * (1 + p[RATIO]));
}

static void points(const rg_material *m, bool advance, rg_user_point point[RG_LANES]) {
    (void)advance;
    for (int lane = 0; lane < RG_LANES; lane++) {
        rg_user_point *p = &point[lane];
        double trace = p->H[0][0] + p->H[1][1] + p->H[2][2];
        p->energy = 0;
        for (int k = 0; k < 9; k++) {
            int i = k / 3, j = k % 3;
            double e = (p->H[i][j] + p->H[j][i]) / 2;
            p->P[i][j] = p->state_P[i][j] = m->lambda * trace * (i == j) + 2 * m->mu * e;
            p->energy += 0.5 * p->P[i][j] * e * m->of.user.parameter[FACTOR];
        }
        p->J = 1 + trace;
        const double F[9] = {1 + p->H[0][0], p->H[0][1], p->H[0][2], p->H[1][0],    1 + p->H[1][1],
                             p->H[1][2],     p->H[2][0], p->H[2][1], 1 + p->H[2][2]};
        double volume = F[0] * (F[4] * F[8] - F[5] * F[7]) - F[1] * (F[3] * F[8] - F[5] * F[6]) +
                        F[2] * (F[3] * F[7] - F[4] * F[6]);
        p->stiffening = volume > 0 ? 1 : NAN;
    }
}

static const char *is_unlucky(const double p[]) {
    return p[STIFF] > 1e12 && p[RATIO] < 0.1 ? "is stiffer than diamond" : NULL;
}

static rg_user_facts facts;

static void use_material(void) {
    memset(list, 0, sizeof list);
    memcpy(list, usual, sizeof usual);
    facts = (rg_user_facts){.name = "mine",
                            .parameter = list,
                            .parameters = 3,
                            .small = true,
                            .moduli = moduli,
                            .wrong = is_unlucky};
    open_failure = NULL;
    without_symbol = false;
    library.material = (rg_user_material){.head = make_head("material"), .facts = &facts, .points = points};
}

/* ---- a linear law ---- */

static rg_user_law_facts law_facts;

static double work(const double p[]) {
    return 0.5 * p[0];
}

static double end(const double p[]) {
    return p[0] > 5 ? 2 : 1;
}

static void law_points(const rg_cohesive *law, rg_user_law_point point[RG_LANES]) {
    for (int lane = 0; lane < RG_LANES; lane++) {
        rg_user_law_point *p = &point[lane];
        p->secant = fmax(p->strength * (1 / p->largest - 1 / p->opening), 0);
        p->dissipated = 0.5 * law->shape[0] * p->strength * fmin(p->largest, p->opening);
    }
}

static void use_law(void) {
    memset(list, 0, sizeof list);
    list[0] = (rg_user_parameter){.name = "scale", .low = 0, .high = 10, .optional = true, .fallback = 1};
    list[1] = (rg_user_parameter){.name = "other"};
    law_facts =
        (rg_user_law_facts){.name = "ramp", .parameter = list, .parameters = 2, .work = work, .end = end};
    open_failure = NULL;
    without_symbol = false;
    library.law = (rg_user_law){.head = make_head("law"), .facts = &law_facts, .points = law_points};
}

/* ---- loading ---- */

/* Loads as a material and as a law: what each says, or that it is loaded. */
static void expect_loaded(const char *as_material, const char *as_law) {
    char why[512] = "";
    const rg_user_material *m = rg_user_load("/a/lib.so", why, sizeof why);
    assert_string_equal(opened, "/a/lib.so");
    assert_string_equal(m != NULL ? "loaded" : why, as_material);
    assert_true(m == NULL || m == &library.material);
    const rg_user_law *law = rg_user_load_law("/b/lib.so", why, sizeof why);
    assert_string_equal(opened, "/b/lib.so");
    assert_string_equal(law != NULL ? "loaded" : why, as_law);
    assert_true(law == NULL || law == &library.law);
}

static void expect_same(const char *words) {
    expect_loaded(words, words);
}

static void test_heads(void **state) {
    (void)state;
    const rg_kernels *here = rg_kernels_select();
    char words[400];
    const char *mine = sizeof(rg_real) == 8 ? "double" : "single",
               *other = sizeof(rg_real) == 8 ? "single" : "double";
    use_material();
    expect_loaded("loaded", "of a material, not of a law");
    use_law();
    expect_loaded("of a law, not of a material", "loaded");
    open_failure = "no such thing";
    expect_same("cannot be loaded: no such thing");
    use_material();
    without_symbol = true;
    expect_same("not made by rhegma material");
    use_material();
    library.head.magic[3] = 'x';
    expect_same("not made by rhegma material");
    for (int k = 0; k < 2; k++) {
        use_material();
        library.head.abi += k == 0;
        library.head.layout -= k == 1;
        snprintf(words, sizeof words,
                 "made for ABI %d, layout %d, and this program has ABI %d, layout %d: compile it again with "
                 "rhegma material",
                 RG_USER_ABI + (k == 0), RG_USER_LAYOUT - (k == 1), RG_USER_ABI, RG_USER_LAYOUT);
        expect_loaded(words, "of a material, not of a law");
    }
    use_material();
    library.head.real = 12 - (int)sizeof(rg_real);
    snprintf(words, sizeof words,
             "computes in %s precision, and this program in %s: compile it with this program", other, mine);
    expect_loaded(words, "of a material, not of a law");
    for (int k = 0; k < 2; k++) {
        use_material();
        library.head.vector += k == 0;
        library.head.isa[0] = k == 1 ? '?' : library.head.isa[0];
        snprintf(
            words, sizeof words,
            "made for %s, vectors of %d bytes, and this run is on %s, vectors of %d bytes: compile it here, "
            "or for --isa %s, or run with RHEGMA_ISA=%s",
            library.head.isa, here->vector + (k == 0), here->name, here->vector, here->name,
            library.head.isa);
        expect_loaded(words, "of a material, not of a law");
    }
}

static void test_facts_of_a_material(void **state) {
    (void)state;
    static const char law[] = "of a material, not of a law";
    use_material();
    facts.name = NULL;
    expect_loaded("its RG_USER_MATERIAL has no .name", law);
    use_material();
    facts.moduli = NULL;
    expect_loaded("its RG_USER_MATERIAL has no .moduli", law);
    for (int k = 0; k < 5; k++) { /* the limits pass */
        char words[200];
        use_material();
        library.material.history = k == 0 ? -1 : k == 1 ? 257 : k == 2 ? 256 : 0;
        for (int i = 3; k > 2 && i < 30 + k; i++) {
            static char names[RG_USER_PARAMETERS + 2][8];
            snprintf(names[i], sizeof names[i], "p%d", i);
            list[i].name = names[i];
        }
        facts.parameters = k < 3 ? 3 : 29 + k;
        snprintf(words, sizeof words, "has %d values of history and %d parameters; at most 256 and 32",
                 library.material.history, facts.parameters);
        expect_loaded(k == 2 || k == 3 ? "loaded" : words, law);
    }
}

static void test_names_of_parameters(void **state) {
    (void)state;
    static const struct {
        const char *name, *words;
    } cases[] = {
        {NULL, "its parameter 2 has no name"},
        {"stiff", "its parameter 2 has the name of another one"},
        {"density",
         "its parameter 2 has the name of another key, or one that is not of letters, digits, _ and -"},
        {"library",
         "its parameter 2 has the name of another key, or one that is not of letters, digits, _ and -"},
        {"model",
         "its parameter 2 has the name of another key, or one that is not of letters, digits, _ and -"},
        {"two words",
         "its parameter 2 has the name of another key, or one that is not of letters, digits, _ and -"},
        {"young", "loaded"}, /* of other models */
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        use_material();
        list[1].name = cases[i].name;
        expect_loaded(cases[i].words, "of a material, not of a law");
        use_law();
        list[0].name = "stiff";
        list[1].name = cases[i].name;
        expect_loaded("of a law, not of a material", cases[i].words);
    }
}

static void test_facts_of_a_law(void **state) {
    (void)state;
    for (int k = 0; k < 6; k++) {
        char words[200];
        use_law();
        law_facts.name = k == 0 ? NULL : "ramp";
        law_facts.work = k == 1 ? NULL : work;
        law_facts.end = k == 2 ? NULL : end;
        law_facts.parameters = k == 3 ? RG_USER_WORK + 1 : k == 4 ? RG_USER_WORK : 2;
        for (int i = 2; i < 8; i++) {
            static char names[8][8];
            snprintf(names[i], sizeof names[i], "p%d", i);
            list[i].name = names[i];
        }
        snprintf(words, sizeof words,
                 "its RG_USER_LAW_IS must have .name, .work, .end and at most %d parameters", RG_USER_WORK);
        expect_loaded("of a law, not of a material", k < 4 ? words : "loaded");
    }
}

/* ---- in a case ---- */

/* The base case with this in place of the model and Young's modulus. */
static void write_solid(const char *keys) {
    char text[1000];
    snprintf(text, sizeof text, "  model: user\n%s", keys);
    write_changed("  model: neo-hookean\n  young: 260e9\n  poisson: 0.21\n", text);
}

static void expect_solid(const char *keys, const char *messages) {
    write_solid(keys);
    expect_messages(0, NULL, messages);
}

static void test_parameters(void **state) {
    (void)state;
    static const char *const keys[] = {
        "  library: lib.so\n  stiff: 200e9\n",
        "  library: lib.so\n  parameters: {stiff: 200e9, factor: 1}\n",
        "  parameters: {ratio: 0.25}\n  library: lib.so\n  stiff: 200e9\n",
        "  stiff: 200e9\n  library: lib.so\n  parameters: {ratio: 0.25}\n",
    };
    char whole[100];
    snprintf(whole, sizeof whole, "%s/lib.so", directory);
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
        static const double wanted[] = {200e9, 0.25, 1, 0};
        use_material();
        write_solid(keys[i]);
        rg_case *c = read_good(path, 0, NULL);
        assert_string_equal(opened, whole);
        assert_string_equal(c->material.user.library.path, whole);
        assert_ptr_equal(c->material.user.is.library, &library.material);
        assert_memory_equal(c->material.user.is.parameter, wanted, sizeof wanted);
        rg_material m = rg_user_material_of(&c->material);
        assert_int_equal(m.model, RG_MATERIAL_USER);
        assert_true(fabs(m.lambda - 80e9) < 1 && fabs(m.mu - 80e9) < 1 && fabs(m.density - 3690) < 1e-9);
        assert_ptr_equal(m.of.user.library, &library.material);
        assert_memory_equal(m.of.user.parameter, wanted, sizeof wanted);
        rg_case_free(c);
    }
}

static void test_parameters_of_a_list(void **state) {
    (void)state;
    use_material();
    write_changed("interface:\n",
                  "materials:\n"
                  "  - {name: a, where: x > 0, model: user, library: lib.so, density: 2, stiff: 5e9,"
                  " ratio: 0}\n"
                  "interface:\n");
    rg_case *c = read_good(path, 0, NULL);
    assert_true(fabs(c->other[0].is.user.is.parameter[STIFF] - 5e9) < 1e-3);
    assert_true(!(fabs(c->other[0].is.user.is.parameter[RATIO]) > 0));
    rg_case_free(c);
    write_changed("interface:\n",
                  "materials:\n"
                  "  - {name: a, where: x > 0, model: user, library: lib.so, density: 2, stif: 5e9}\n"
                  "interface:\n");
    expect_messages(0, NULL,
                    ":10:5: materials[0].stiff: missing; allowed: number > 0 (Pa)\n"
                    ":10:71: materials[0].stif: unknown parameter of mine; did you mean 'stiff'?\n");
}

static void test_mistakes(void **state) {
    (void)state;
    use_material();
    expect_solid("  library: lib.so\n", ":5:3: material.stiff: missing; allowed: number > 0 (Pa)\n");
    expect_solid("  library: lib.so\n  stiff: -1\n  ratio: soft\n",
                 ":7:10: material.stiff: -1: out of range; allowed: number > 0 (Pa)\n"
                 ":8:10: material.ratio: soft: not a number; allowed: number >= 0 and <= 0.5\n");
    expect_solid("  library: lib.so\n  stiff: 1\n  ratio: 0.6\n  colour: 3\n  rato: 0.1\n  factor: x\n",
                 ":8:10: material.ratio: 0.6: out of range; allowed: number >= 0 and <= 0.5\n"
                 ":9:3: material.colour: unknown parameter of mine; allowed: stiff, ratio, factor\n"
                 ":10:3: material.rato: unknown parameter of mine; did you mean 'ratio'?\n"
                 ":11:11: material.factor: x: not a number; allowed: number\n");
    expect_solid("  library: lib.so\n  stiff: 1e9\n  parameters: {stiff: 1e9}\n",
                 ":7:3: material.stiff: given twice\n");
    expect_solid("  library: lib.so\n  stiff: 1.5e12\n  ratio: 0\n",
                 ":5:3: material.parameters: mine: is stiffer than diamond\n");
    expect_solid(
        "  library: lib.so\n  stiff: 1e9\n  ratio: 0.5\n",
        ":6:12: material.library: mine: gives moduli of no solid: lambda inf Pa, mu 3.33333e+08 Pa\n");
    library.material.head.magic[0] = 'x';
    expect_solid("  library: lib.so\n  stiff: 1e9\n",
                 ":6:12: material.library: lib.so: not made by rhegma material\n");
    use_material();
    char *messages = NULL;
    write_solid("  library: lib.so\n  stiff: 1e9\n  factor: 1.5\n");
    rg_case *c = read_case(path, 0, NULL, &messages);
    assert_null(c);
    assert_non_null(strstr(messages, ":6:12: material.library: mine: the stress is not the derivative"));
    free(messages);
}

/* Of the number of bytes, then of eight at a time, the last ones with zeros behind them. */
static uint64_t hash_of(const char *bytes, size_t size) {
    uint64_t hash = rg_hash(0, size);
    for (size_t i = 0; i < size; i += 8) {
        char word[8] = {0};
        uint64_t number;
        for (size_t k = i; k < size && k < i + 8; k++) {
            word[k - i] = bytes[k];
        }
        memcpy(&number, word, sizeof number);
        hash = rg_hash(hash, number);
    }
    return hash;
}

/* Of another library a case is another one: the bytes of its file, whatever their number. */
static void test_hash(void **state) {
    (void)state;
    static const char *const bytes[] = {"",          "\1",         "abcdefgh", "abcdefgi",
                                        "abcdefgh1", "abcdefgh12", "bbcdefgh1"};
    enum { FILES = sizeof bytes / sizeof *bytes };
    uint64_t hash[FILES];
    char whole[100];
    snprintf(whole, sizeof whole, "%s/lib.so", directory);
    use_material();
    write_solid("  library: lib.so\n  stiff: 1e9\n");
    for (int i = 0; i < FILES; i++) {
        FILE *f = fopen(whole, "wb");
        fputs(bytes[i], f);
        fclose(f);
        for (int again = 0; again < 2; again++) {
            rg_case *c = read_good(path, 0, NULL);
            assert_true(again == 0 || c->material.user.library.hash == hash[i]);
            hash[i] = c->material.user.library.hash;
            assert_true(hash[i] == hash_of(bytes[i], strlen(bytes[i])));
            rg_case_free(c);
        }
        for (int k = 0; k < i; k++) {
            assert_true(hash[k] != hash[i]);
        }
    }
    remove(whole);
}

static void write_law(const char *keys) {
    char text[1000];
    snprintf(text, sizeof text, "  law: user\n  activation: continuous\n%s", keys);
    write_changed("  law: linear\n", text);
}

static void test_law(void **state) {
    (void)state;
    use_law();
    write_law("  library: lib.so\n  parameters: {other: -7}\n");
    rg_case *c = read_good(path, 0, NULL);
    const double *shape = c->interface.shape[RG_LAW_USER];
    assert_ptr_equal(c->interface.user.is, &library.law);
    assert_true(fabs(shape[0] - 1) < 1e-15 && fabs(shape[1] + 7) < 1e-15);
    assert_true(fabs(shape[RG_USER_WORK] - 0.5) < 1e-15 && fabs(shape[RG_USER_END] - 1) < 1e-15);
    assert_true(fabs(c->interface.user.share - 1) < 1e-6 && fabs(c->interface.user.closed) < 1e-6);
    rg_case_free(c);
    write_law("  library: lib.so\n  parameters: {scale: 11}\n");
    expect_messages(0, NULL,
                    ":12:3: interface.other: missing; allowed: number\n"
                    ":13:23: interface.scale: 11: out of range; allowed: number >= 0 and <= 10\n");
    library.head.kind[0] = 'L';
    write_law("  library: lib.so\n  parameters: {other: -7}\n");
    expect_messages(0, NULL, ":12:12: interface.library: lib.so: of a Law, not of a law\n");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_heads),
        cmocka_unit_test(test_facts_of_a_material),
        cmocka_unit_test(test_names_of_parameters),
        cmocka_unit_test(test_facts_of_a_law),
        cmocka_unit_test(test_parameters),
        cmocka_unit_test(test_parameters_of_a_list),
        cmocka_unit_test(test_mistakes),
        cmocka_unit_test(test_hash),
        cmocka_unit_test(test_law),
    };
    return cmocka_run_group_tests_name("user", tests, set_up, tear_down);
}
