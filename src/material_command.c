#define _XOPEN_SOURCE 700 /* realpath */

#include "material_command.h"

#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.h"
#include "base/files.h"
#include "base/h5_parallel.h"
#include "base/mem.h"
#include "case/tree.h"
#include "case/user.h"
#include "kernels.h"
#include "usage.h"
#include "version.h"

enum { MOST_ARGUMENTS = 64, NAMED = 7 /* of them those whose values may have spaces */ };

typedef struct {
    const char *file, *isa;
    char *library;
    bool law; /* a cohesive law, not a material */
} arguments;

static int complain(const char *what, const char *argument) {
    fprintf(stderr, "rhegma: material: %s: %s\n%s", what, argument, rg_usage("material"));
    return RG_USAGE;
}

static int parse(int argc, char **argv, arguments *a) {
    for (int i = 2; i < argc; i++) {
        bool takes_value = strcmp(argv[i], "-o") == 0 || strcmp(argv[i], "--isa") == 0;
        if (takes_value && i + 1 == argc) {
            return complain("missing value after", argv[i]);
        }
        if (strcmp(argv[i], "-o") == 0) {
            rg_free(a->library);
            a->library = rg_text_copy(argv[i + 1], strlen(argv[i + 1]));
            i++;
        } else if (strcmp(argv[i], "--isa") == 0) {
            a->isa = argv[++i];
        } else if (strcmp(argv[i], "--law") == 0) {
            a->law = true;
        } else if (argv[i][0] == '-') {
            return complain("unknown option", argv[i]);
        } else if (a->file == NULL) {
            a->file = argv[i];
        } else {
            return complain("one file at a time; not understood", argv[i]);
        }
    }
    return a->file == NULL ? complain("no file given", "FILE.c") : RG_OK;
}

/* What the compiler has to be told of an instruction set; NULL: there is none of that name. */
static const char *flag_of(const char *isa) {
    static const char *const known[][2] = {
#ifdef __x86_64__
        {"x86-64-v2", "-march=x86-64-v2"},
        {"x86-64-v3", "-march=x86-64-v3"},
        {"x86-64-v4", "-march=x86-64-v4 -mprefer-vector-width=512"},
#endif
        {"generic", ""},
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        if (strcmp(known[i][0], isa) == 0) {
            return known[i][1];
        }
    }
    return NULL;
}

/* The headers beside this program, where it is installed, or those that it was built from. */
static char *find_headers(void) {
    char *installed = rg_path_beside_program("../" RG_INSTALLED_HEADERS);
    const char *const places[] = {installed, RG_SOURCE_HEADERS};
    for (int i = 0; i < 2; i++) {
        char *file = rg_join_path(places[i], "user/material.c");
        bool there = access(file, R_OK) == 0;
        rg_free(file);
        if (there) {
            char *found = rg_text_copy(places[i], strlen(places[i]));
            rg_free(installed);
            return found;
        }
    }
    rg_fatal(RG_FAILURE, "material: the headers are neither in %s nor in %s", installed, RG_SOURCE_HEADERS);
}

/* Adds the words of `text`, which it cuts apart. */
static int add_words(char *argument[], int count, char *text) {
    for (char *word = strtok(text, " "); word != NULL; word = strtok(NULL, " ")) {
        if (count == MOST_ARGUMENTS - NAMED) {
            rg_fatal(RG_USAGE, "material: the compiler is called with more than %d words", MOST_ARGUMENTS);
        }
        argument[count++] = word;
    }
    return count;
}

/* Runs the compiler; its exit status. */
static int run(char *const argument[]) {
    fflush(stdout);
    pid_t child = fork();
    int status = 0;
    if (child == 0) {
        execvp(argument[0], argument);
        fprintf(stderr, "rhegma: material: %s: %s; CC names the C compiler to use\n", argument[0],
                strerror(errno));
        _exit(RG_FAILURE);
    }
    if (child < 0 || waitpid(child, &status, 0) < 0) {
        rg_fatal(RG_FAILURE, "material: %s: %s", argument[0], strerror(errno));
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : RG_FAILURE;
}

/* Compiles user/material.c or user/law.c around the file. */
static int compile(const arguments *a, const char *file, const char *library) {
    const char *environment = getenv("CC");
    char *headers = find_headers(), *argument[MOST_ARGUMENTS + 1] = {NULL};
    const char *cc = environment != NULL && environment[0] != '\0' ? environment : RG_CC;
    char *words = rg_text_format("%s -std=c17 %s %s -fPIC -shared -fvisibility=hidden -Wall -Wextra "
                                 "-DRG_ISA=library -D_POSIX_C_SOURCE=200809L%s",
                                 cc, RG_KERNEL_FLAGS, flag_of(a->isa),
                                 sizeof(rg_real) == sizeof(float) ? " -DRG_SINGLE" : "");
    char *named[NAMED] = {rg_text_format("-DRG_USER_ISA=\"%s\"", a->isa),
                          rg_text_format("-DRG_USER_SOURCE=\"%s\"", file),
                          rg_text_format("-I%s", headers),
                          rg_join_path(headers, a->law ? "user/law.c" : "user/material.c"),
                          rg_text_copy("-o", 2),
                          rg_text_copy(library, strlen(library)),
                          rg_text_copy("-lm", 3)};
    int count = add_words(argument, 0, words);
    for (int i = 0; i < NAMED; i++) {
        argument[count++] = named[i];
    }
    int status = run(argument);
    for (int i = 0; i < NAMED; i++) {
        rg_free(named[i]);
    }
    rg_free(words);
    rg_free(headers);
    return status;
}

static void print_parameter(const rg_user_parameter *p) {
    printf("  %s%s%s%s%s", p->name, p->unit != NULL ? " (" : "", p->unit != NULL ? p->unit : "",
           p->unit != NULL ? ")" : "", p->meaning != NULL ? ": " : "");
    printf("%s", p->meaning != NULL ? p->meaning : "");
    if (p->optional) {
        printf("; default %g", p->fallback);
    }
    printf("\n");
}

static void print_facts(const char *name, const char *meaning, const rg_user_parameter *list, int count) {
    printf("%s%s%s%s\n", name, meaning != NULL ? ": " : "", meaning != NULL ? meaning : "",
           count > 0 ? "; parameters:" : "");
    for (int i = 0; i < count; i++) {
        print_parameter(&list[i]);
    }
}

/* What was made; of another instruction set, or of a file that states nonsense, why it cannot serve here. */
static int tell(const arguments *a) {
    char why[512], *path = realpath(a->library, NULL);
    const rg_kernels *here = rg_kernels_select();
    printf("%s: for %s, %s precision\n", a->library, a->isa, RG_PRECISION);
    int status = RG_OK;
    if (here != NULL && path != NULL && strcmp(here->name, a->isa) == 0) {
        const rg_user_material *u = a->law ? NULL : rg_user_load(path, why, sizeof why);
        const rg_user_law *law = a->law ? rg_user_load_law(path, why, sizeof why) : NULL;
        if (u != NULL) {
            print_facts(u->facts->name, u->facts->meaning, u->facts->parameter, u->facts->parameters);
            printf("values of history per point: %d\n", u->history);
        } else if (law != NULL) {
            print_facts(law->facts->name, law->facts->meaning, law->facts->parameter, law->facts->parameters);
        } else {
            fprintf(stderr, "rhegma: material: %s: %s\n", a->library, why);
            status = RG_USAGE;
        }
    }
    free(path);
    return status;
}

int rg_material_command(int argc, char **argv) {
    const rg_kernels *here = rg_kernels_select();
    arguments a = {.isa = here != NULL ? here->name : getenv("RHEGMA_ISA")};
    if (parse(argc, argv, &a) != RG_OK) {
        return RG_USAGE;
    }
    if (flag_of(a.isa) == NULL) {
        return complain("no such instruction set", a.isa);
    }
    char *file = realpath(a.file, NULL);
    if (file == NULL || strpbrk(file, "\"\\") != NULL) {
        fprintf(stderr, "rhegma: material: %s: %s\n", a.file,
                file == NULL ? strerror(errno) : "a path with a quote or a backslash");
        return RG_USAGE;
    }
    if (a.library == NULL) {
        const char *dot = strrchr(a.file, '.');
        a.library =
            rg_text_format("%.*s.so", dot != NULL ? (int)(dot - a.file) : (int)strlen(a.file), a.file);
    }
    char *made = rg_text_format("%s.%ld", a.library, (long)getpid()); /* runs may have the old one loaded */
    int status = compile(&a, file, made) == 0 ? RG_OK : RG_USAGE;
    if (status == RG_OK && rename(made, a.library) != 0) {
        fprintf(stderr, "rhegma: material: %s: %s\n", a.library, strerror(errno));
        status = RG_FAILURE;
    }
    unlink(made);
    status = status == RG_OK ? tell(&a) : status;
    rg_free(made);
    rg_free(a.library);
    free(file);
    return status;
}
