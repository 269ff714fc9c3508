/* The command "rhegma material": its arguments, the words that the compiler is called with, and what is said
 * of the library. A script stands in for the compiler, a structure of this program for the library. */
#include <dlfcn.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/error.h"
#include "base/h5_parallel.h"
#include "base/mem.h"
#include "library.h"
#include "material_command.h"
#include "support/mesh_text.h"
#include "usage.h"
#include "version.h"

static char folder[] = "/tmp/test_material_command.XXXXXX";

/* ---- the library ---- */

static union {
    rg_user_material material;
    rg_user_law law;
} library;

void *__wrap_dlopen(const char *file, int mode);
void *__wrap_dlsym(void *handle, const char *symbol);
void *__real_dlsym(void *handle, const char *symbol);

void *__wrap_dlopen(const char *file, int mode) {
    (void)mode;
    assert_int_equal(file[0], '/');
    return &library;
}

void *__wrap_dlsym(void *handle, const char *symbol) {
    return handle == &library ? handle : __real_dlsym(handle, symbol); /* of a sanitizer's run time */
}

static void moduli(const double p[], double *lambda, double *mu) {
    *lambda = *mu = p[0];
}

static double one(const double p[]) {
    (void)p;
    return 1;
}

static const rg_user_parameter list[] = {
    {.name = "soft", .unit = "Pa", .meaning = "how soft"},
    {.name = "wide", .unit = "m", .optional = true, .fallback = 0.125},
    {.name = "plain"},
    {.name = "told", .meaning = "as it is", .optional = true, .fallback = -3},
};
static rg_user_facts facts;
static rg_user_law_facts law_facts;

static void use(const char *kind, int parameters, const char *meaning) {
    const rg_kernels *here = rg_kernels_select();
    rg_user_head head = {.magic = RG_USER_MAGIC,
                         .abi = RG_USER_ABI,
                         .layout = RG_USER_LAYOUT,
                         .vector = here->vector,
                         .real = sizeof(rg_real)};
    snprintf(head.kind, sizeof head.kind, "%s", kind);
    snprintf(head.isa, sizeof head.isa, "%s", here->name);
    facts = (rg_user_facts){
        .name = "mine", .meaning = meaning, .parameter = list, .parameters = parameters, .moduli = moduli};
    law_facts = (rg_user_law_facts){.name = "ramp",
                                    .meaning = meaning,
                                    .parameter = list,
                                    .parameters = parameters,
                                    .work = one,
                                    .end = one};
    if (strcmp(kind, "law") == 0) {
        library.law = (rg_user_law){.head = head, .facts = &law_facts};
    } else {
        library.material = (rg_user_material){.head = head, .facts = &facts, .history = 7};
    }
}

/* ---- the command ---- */

static const char *const *words;

static void run_command(void) {
    char *argv[20] = {"rhegma", "material"};
    int n = 2;
    for (; words[n - 2] != NULL; n++) {
        argv[n] = (char *)(uintptr_t)words[n - 2];
    }
    dup2(STDERR_FILENO, STDOUT_FILENO); /* all in one */
    setvbuf(stdout, NULL, _IONBF, 0);
    size_t before = rg_alloc_blocks();
    int status = rg_material_command(n, argv);
    if (status == RG_OK && rg_alloc_blocks() != before) {
        printf("blocks are left\n");
    }
    _exit(status);
}

#define WORDS(...) ((const char *const[]){__VA_ARGS__, NULL})

static void expect(const char *const *line, int status, const char *said) {
    words = line;
    expect_said(run_command, status, said);
}

static void write_text(const char *name, const char *text) {
    FILE *f = fopen(name, "wb");
    assert_non_null(f);
    fputs(text, f);
    fclose(f);
}

static void expect_text(const char *name, const char *wanted) {
    char text[4000];
    FILE *f = fopen(name, "rb");
    assert_non_null(f);
    text[fread(text, 1, sizeof text - 1, f)] = '\0';
    fclose(f);
    assert_string_equal(text, wanted);
}

static bool is_there(const char *name) {
    struct stat of;
    return stat(name, &of) == 0;
}

/* The script writes its words, a line each, and a library. */
static int set_up(void **state) {
    (void)state;
    assert_non_null(mkdtemp(folder));
    assert_int_equal(chdir(folder), 0);
    write_text("cc", "for w; do printf '%s\\n' \"$w\"; [ \"$before\" = -o ] && echo made >\"$w\"; before=$w; "
                     "done >words\n");
    write_text("mine.c", "");
    write_text("no.dot", "");
    write_text("plain", "");
    setenv("CC", "sh cc --first", 1);
    return 0;
}

static int tear_down(void **state) {
    (void)state;
    static const char *const files[] = {"cc",       "mine.c", "no.dot",   "plain",   "words",
                                        "other.so", "no.so",  "plain.so", "mine.so", "a\"b.c"};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        unlink(files[i]);
    }
    assert_int_equal(chdir("/"), 0);
    return rmdir(folder); /* nothing else is left in it */
}

static void test_mistakes(void **state) {
    (void)state;
    static const struct {
        const char *words[6], *said;
    } cases[] = {
        {{NULL}, "no file given: FILE.c"},
        {{"--law"}, "no file given: FILE.c"},
        {{"mine.c", "-o"}, "missing value after: -o"},
        {{"--isa"}, "missing value after: --isa"},
        {{"mine.c", "--laws"}, "unknown option: --laws"},
        {{"mine.c", "more.c"}, "one file at a time; not understood: more.c"},
        {{"mine.c", "--isa", "z80"}, "no such instruction set: z80"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char said[2000];
        snprintf(said, sizeof said, "rhegma: material: %s\n%s", cases[i].said, rg_usage("material"));
        expect(cases[i].words, RG_USAGE, said);
    }
    expect(WORDS("none.c"), RG_USAGE, "rhegma: material: none.c: No such file or directory\n");
    write_text("a\"b.c", "");
    expect(WORDS("a\"b.c"), RG_USAGE, "rhegma: material: a\"b.c: a path with a quote or a backslash\n");
    assert_false(is_there("words"));
}

/* What stands for the instruction set. */
static const char *flags_of(const char *isa) {
    return strcmp(isa, "x86-64-v4") == 0   ? "-march=x86-64-v4\n-mprefer-vector-width=512\n"
           : strcmp(isa, "x86-64-v3") == 0 ? "-march=x86-64-v3\n"
           : strcmp(isa, "x86-64-v2") == 0 ? "-march=x86-64-v2\n"
                                           : "";
}

static void expect_words(const char *isa, const char *around, const char *made) {
    char wanted[4000], kernel_flags[400];
    snprintf(kernel_flags, sizeof kernel_flags, "%s", RG_KERNEL_FLAGS);
    for (char *c = kernel_flags; *c != '\0'; c++) {
        *c = *c == ' ' ? '\n' : *c;
    }
    snprintf(
        wanted, sizeof wanted,
        "--first\n-std=c17\n%s\n%s-fPIC\n-shared\n-fvisibility=hidden\n-Wall\n-Wextra\n-DRG_ISA=library\n"
        "-D_POSIX_C_SOURCE=200809L\n%s-DRG_USER_ISA=\"%s\"\n-DRG_USER_SOURCE=\"%s/mine.c\"\n-I%s\n%s/user/"
        "%s\n-o\n",
        kernel_flags, flags_of(isa), sizeof(rg_real) == 4 ? "-DRG_SINGLE\n" : "", isa, folder,
        RG_SOURCE_HEADERS, RG_SOURCE_HEADERS, around);
    char text[4000], *end;
    FILE *f = fopen("words", "rb");
    assert_non_null(f);
    text[fread(text, 1, sizeof text - 1, f)] = '\0';
    fclose(f);
    assert_true(strncmp(text, wanted, strlen(wanted)) == 0 &&
                strncmp(text + strlen(wanted), made, strlen(made)) == 0);
    assert_int_equal(text[strlen(wanted) + strlen(made)], '.'); /* until it is whole */
    assert_true(strtol(text + strlen(wanted) + strlen(made) + 1, &end, 10) > 0);
    assert_string_equal(end, "\n-lm\n");
}

static void test_material(void **state) {
    (void)state;
    const char *here = rg_kernels_select()->name;
    char said[2000];
    use("material", 4, "as soft as it is wide");
    snprintf(said, sizeof said,
             "mine.so: for %s, %s precision\n"
             "mine: as soft as it is wide; parameters:\n"
             "  soft (Pa): how soft\n"
             "  wide (m); default 0.125\n"
             "  plain\n"
             "  told: as it is; default -3\n"
             "values of history per point: 7\n",
             here, RG_PRECISION);
    expect(WORDS("mine.c"), RG_OK, said);
    expect_text("mine.so", "made\n");
    expect_words(here, "material.c", "mine.so");
    use("material", 0, NULL);
    snprintf(said, sizeof said, "other.so: for %s, %s precision\nmine\nvalues of history per point: 7\n",
             here, RG_PRECISION);
    expect(WORDS("-o", "wrong.so", "mine.c", "--isa", here, "-o", "other.so"), RG_OK, said);
    assert_true(is_there("other.so") && !is_there("wrong.so"));
    facts.name = NULL;
    snprintf(said, sizeof said,
             "other.so: for %s, %s precision\n"
             "rhegma: material: other.so: its RG_USER_MATERIAL has no .name\n",
             here, RG_PRECISION);
    expect(WORDS("mine.c", "-o", "other.so"), RG_USAGE, said);
}

/* Where the name has no dot, or the dot is elsewhere. */
static void test_names(void **state) {
    (void)state;
    char said[400];
    use("material", 0, NULL);
    snprintf(said, sizeof said, "no.so: for %s, %s precision\nmine\nvalues of history per point: 7\n",
             rg_kernels_select()->name, RG_PRECISION);
    expect(WORDS("no.dot"), RG_OK, said);
    memcpy(said, "plain.so", 8);
    snprintf(said, sizeof said, "plain.so: for %s, %s precision\nmine\nvalues of history per point: 7\n",
             rg_kernels_select()->name, RG_PRECISION);
    expect(WORDS("plain"), RG_OK, said);
    assert_true(is_there("no.so") && is_there("plain.so"));
}

static void test_law(void **state) {
    (void)state;
    const char *here = rg_kernels_select()->name;
    char said[2000];
    use("law", 1, NULL);
    snprintf(said, sizeof said, "mine.so: for %s, %s precision\nramp; parameters:\n  soft (Pa): how soft\n",
             here, RG_PRECISION);
    expect(WORDS("--law", "mine.c"), RG_OK, said);
    expect_words(here, "law.c", "mine.so");
    snprintf(said, sizeof said,
             "mine.so: for %s, %s precision\n"
             "rhegma: material: mine.so: of a law, not of a material\n",
             here, RG_PRECISION);
    expect(WORDS("mine.c"), RG_USAGE, said);
    use("material", 1, NULL);
    snprintf(said, sizeof said,
             "mine.so: for %s, %s precision\n"
             "rhegma: material: mine.so: of a material, not of a law\n",
             here, RG_PRECISION);
    expect(WORDS("mine.c", "--law"), RG_USAGE, said);
}

/* Other instruction sets than that of this machine: the library is not looked at. */
static void test_instruction_sets(void **state) {
    (void)state;
    static const char *const all[] = {"generic",
#ifdef __x86_64__
                                      "x86-64-v2", "x86-64-v3", "x86-64-v4"
#endif
    };
    use("material", 1, NULL);
    library.material.head.magic[0] = 'x';
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        char said[400];
        bool own = strcmp(all[i], rg_kernels_select()->name) == 0;
        snprintf(said, sizeof said, "other.so: for %s, %s precision\n%s", all[i], RG_PRECISION,
                 own ? "rhegma: material: other.so: not made by rhegma material\n" : "");
        expect(WORDS("mine.c", "--isa", all[i], "-o", "other.so"), own ? RG_USAGE : RG_OK, said);
        expect_words(all[i], "material.c", "other.so");
    }
}

/* What fails leaves the library of before, and nothing else. */
static void test_failures(void **state) {
    (void)state;
    char many[400] = "sh";
    use("material", 1, NULL);
    write_text("mine.so", "old\n");
    setenv("CC", "false", 1);
    expect(WORDS("mine.c"), RG_USAGE, "");
    setenv("CC", "no-compiler", 1);
    expect(WORDS("mine.c"), RG_USAGE,
           "rhegma: material: no-compiler: No such file or directory; CC names the C compiler to use\n");
    for (int i = 0; i < 70; i++) {
        strcat(many, " -x");
    }
    setenv("CC", many, 1);
    expect(WORDS("mine.c"), RG_USAGE, "rhegma: material: the compiler is called with more than 64 words\n");
    expect_text("mine.so", "old\n");
    setenv("CC", "true", 1); /* makes nothing */
    expect(WORDS("mine.c"), RG_FAILURE, "rhegma: material: mine.so: No such file or directory\n");
    expect_text("mine.so", "old\n");
}

/* 64 words may be, the shell and its script counted. */
static void test_many_words(void **state) {
    (void)state;
    char cc[400] = "sh cc --first", said[400];
    const char *here = rg_kernels_select()->name;
    int words_now = 2;
    use("material", 0, NULL);
    setenv("CC", cc, 1);
    snprintf(said, sizeof said, "mine.so: for %s, %s precision\nmine\nvalues of history per point: 7\n", here,
             RG_PRECISION);
    expect(WORDS("mine.c"), RG_OK, said);
    FILE *f = fopen("words", "rb");
    assert_non_null(f);
    for (int c = fgetc(f); c != EOF; c = fgetc(f)) {
        words_now += c == '\n';
    }
    fclose(f);
    for (; words_now < 64; words_now++) {
        strcat(cc, " -x");
    }
    setenv("CC", cc, 1);
    expect(WORDS("mine.c"), RG_OK, said);
    strcat(cc, " -x");
    setenv("CC", cc, 1);
    expect(WORDS("mine.c"), RG_USAGE, "rhegma: material: the compiler is called with more than 64 words\n");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_mistakes),
        cmocka_unit_test(test_material),
        cmocka_unit_test(test_names),
        cmocka_unit_test(test_law),
        cmocka_unit_test(test_instruction_sets),
        cmocka_unit_test(test_many_words),
        cmocka_unit_test(test_failures),
    };
    return cmocka_run_group_tests_name("material_command", tests, set_up, tear_down);
}
