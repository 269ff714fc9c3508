#define _GNU_SOURCE /* getline through its wrapper */
#include "host.h"

#include <omp.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/error.h"
#include "base/mem.h"

enum { ALIGN = 64, LARGEST = 256 << 20 };

static jmp_buf refused;
static bool running;

_Noreturn static void found(const char *what, const char *detail) {
    fprintf(stderr, "fuzz: %s: %s\n", what, detail);
    abort();
}

void rg_fuzz_require(bool good, const char *what) {
    if (!good) {
        found("accepted input", what);
    }
}

/* ---- errors ---- */

void rg_fatal(int status, const char *format, ...) {
    char message[4096];
    va_list args;
    va_start(args, format);
    vsnprintf(message, sizeof message, format, args);
    va_end(args);
    if (!running) {
        found("outside of the reader", message);
    }
    if (status != RG_USAGE) {
        found("not the status of bad input", message);
    }
    if (message[0] == '\0') {
        found("no message", "");
    }
    longjmp(refused, 1);
}

void rg_warn(const char *format, ...) {
    char message[4096];
    va_list args;
    va_start(args, format);
    vsnprintf(message, sizeof message, format, args);
    va_end(args);
}

/* ---- memory ---- */

/* Stands right below every block, in a list of all. */
typedef struct header {
    struct header *before, *behind;
    size_t bytes;
} header;

static header all = {&all, &all, 0};

static header *head(void *block) {
    return (header *)(void *)((char *)block - ALIGN);
}

static size_t checked(size_t count, size_t size) {
    if (size != 0 && count > LARGEST / size) {
        char detail[80];
        snprintf(detail, sizeof detail, "%zu items of %zu bytes", count, size);
        found("a huge allocation", detail);
    }
    return count * size;
}

static void *take(size_t bytes) {
    header *h = aligned_alloc(ALIGN, ALIGN + (bytes + ALIGN - 1) / ALIGN * ALIGN);
    if (h == NULL) {
        found("memory", "none left");
    }
    *h = (header){&all, all.behind, bytes};
    all.behind->before = h;
    all.behind = h;
    return (char *)h + ALIGN;
}

void *rg_alloc(size_t count, size_t size) {
    size_t bytes = checked(count, size);
    return memset(take(bytes), 0, bytes);
}

void *rg_alloc_sparse(size_t count, size_t size) {
    return rg_alloc(count, size);
}

void *rg_realloc(void *block, size_t count, size_t size) {
    size_t bytes = checked(count, size);
    void *grown = take(bytes);
    if (block != NULL) {
        memcpy(grown, block, head(block)->bytes < bytes ? head(block)->bytes : bytes);
        rg_free(block);
    }
    return grown;
}

void rg_free(void *block) {
    if (block != NULL) {
        header *h = head(block);
        h->before->behind = h->behind;
        h->behind->before = h->before;
        free(h);
    }
}

size_t rg_alloc_total(void) {
    size_t total = 0;
    for (const header *h = all.behind; h != &all; h = h->behind) {
        total += h->bytes;
    }
    return total;
}

/* ---- files: the linker sends the readers' calls here ---- */

enum { MOST_FILES = 8 };

static FILE *open_file[MOST_FILES];
static char *line;

FILE *__real_fopen64(const char *path, const char *mode); /* what fopen is with -D_FILE_OFFSET_BITS=64 */
FILE *__wrap_fopen64(const char *path, const char *mode);
int __real_fclose(FILE *f);
int __wrap_fclose(FILE *f);
ssize_t __real_getline(char **text, size_t *size, FILE *f);
ssize_t __wrap_getline(char **text, size_t *size, FILE *f);

FILE *__wrap_fopen64(const char *path, const char *mode) {
    FILE *f = __real_fopen64(path, mode);
    int i = 0;
    while (i < MOST_FILES && open_file[i] != NULL) {
        i++;
    }
    if (f != NULL && i < MOST_FILES) {
        open_file[i] = f;
    }
    return f;
}

int __wrap_fclose(FILE *f) {
    for (int i = 0; i < MOST_FILES; i++) {
        open_file[i] = open_file[i] == f ? NULL : open_file[i];
    }
    line = NULL; /* its reader frees it before it closes the file */
    return __real_fclose(f);
}

ssize_t __wrap_getline(char **text, size_t *size, FILE *f) {
    ssize_t got = __real_getline(text, size, f);
    line = *text;
    return got;
}

const char *rg_fuzz_scratch(void) {
    static char path[64];
    if (path[0] == '\0') {
        const char *folder = access("/dev/shm", W_OK) == 0 ? "/dev/shm" : "/tmp";
        snprintf(path, sizeof path, "%s/rhegma-fuzz-%ld", folder, (long)getpid());
    }
    return path;
}

static void remove_scratch(void) {
    unlink(rg_fuzz_scratch());
}

/* ---- running ---- */

static void clean_up(header *last) {
    while (all.behind != last) {
        rg_free((char *)all.behind + ALIGN);
    }
    if (line != NULL) {
        free(line);
        line = NULL;
    }
    for (int i = 0; i < MOST_FILES; i++) {
        if (open_file[i] != NULL) {
            __wrap_fclose(open_file[i]);
        }
    }
}

bool rg_fuzz_run(rg_fuzz_body *body, const uint8_t *data, size_t size) {
    static bool begun;
    header *last = all.behind;
    if (!begun) {
        begun = true;
        omp_set_num_threads(1);
        atexit(remove_scratch);
    }
    running = true;
    bool returned = setjmp(refused) == 0;
    if (returned) {
        body(data, size);
    }
    running = false;
    if (returned && all.behind != last) {
        found("a leak", "blocks that nobody freed");
    }
    clean_up(last);
    return returned;
}
