#define _GNU_SOURCE
#include "support/instruction_count.h"

#if defined(__x86_64__) && defined(__linux__)

#include <link.h>
#include <signal.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ptrace.h>
#include <sys/user.h>
#include <sys/wait.h>
#include <unistd.h>

/* What one instruction does, by its address in the file. */
typedef struct {
    uint64_t address;
    uint8_t flops; /* of all lanes */
    uint8_t bytes; /* width of its vectors; 8 for a scalar */
    bool fused;
} instruction;

static instruction *code;
static size_t code_count;

/* Width in bytes of the widest register among the operands. */
static uint8_t register_bytes(const char *operands) {
    return strstr(operands, "%zmm") != NULL ? 64 : strstr(operands, "%ymm") != NULL ? 32 : 16;
}

static bool is_fused(const char *name) {
    static const char *const kinds[] = {"fmadd", "fmsub", "fnmadd", "fnmsub", "fmaddsub", "fmsubadd"};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        size_t n = strlen(kinds[k]);
        if (strncmp(name, kinds[k], n) == 0 && strlen(name) == n + 5) { /* kind, order (213), type (pd) */
            return true;
        }
    }
    return false;
}

static bool is_plain(const char *name) {
    static const char *const kinds[] = {"add", "sub", "mul", "div", "sqrt", "addsub", "hadd", "hsub"};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        size_t n = strlen(kinds[k]);
        if (strncmp(name, kinds[k], n) == 0 && strlen(name) == n + 2) {
            return true;
        }
    }
    return false;
}

/* Floating-point work of an instruction, from its name and operands (AT&T syntax). */
static instruction classify(const char *name, const char *operands) {
    instruction i = {0};
    name += *name == 'v';
    size_t n = strlen(name);
    const char *type = n > 2 ? name + n - 2 : "";
    bool packed = type[0] == 'p', scalar = type[0] == 's';
    bool fused = is_fused(name);
    if ((!packed && !scalar) || (type[1] != 'd' && type[1] != 's') || (!fused && !is_plain(name))) {
        return i;
    }
    uint8_t size = type[1] == 'd' ? 8 : 4;
    i.bytes = scalar ? size : register_bytes(operands);
    i.flops = (uint8_t)(i.bytes / size * (fused ? 2 : 1));
    i.fused = fused;
    return i;
}

/* Reads the disassembly of this program. */
static void read_code(FILE *listing) {
    char line[512], name[32], operands[256];
    size_t capacity = 0;
    while (fgets(line, sizeof line, listing) != NULL) {
        unsigned long long address;
        operands[0] = '\0';
        if (sscanf(line, " %llx: %31s %255[^\n]", &address, name, operands) < 2) {
            continue;
        }
        instruction i = classify(name, operands);
        i.address = address;
        if (i.flops == 0) {
            continue;
        }
        if (code_count == capacity) {
            capacity = 2 * capacity + 4096;
            code = realloc(code, capacity * sizeof *code);
            if (code == NULL) {
                abort();
            }
        }
        code[code_count++] = i;
    }
}

static int by_address(const void *key, const void *item) {
    uint64_t a = *(const uint64_t *)key, b = ((const instruction *)item)->address;
    return (a > b) - (a < b);
}

/* Where the program itself was loaded: the first object reported. */
static int load_bias(struct dl_phdr_info *info, size_t size, void *bias) {
    (void)size;
    *(uint64_t *)bias = info->dlpi_addr;
    return 1;
}

/* Starts a child that stops before run(context). */
static pid_t start(void (*run)(void *), void *context) {
    pid_t child = fork();
    if (child == 0) {
        if (ptrace(PTRACE_TRACEME, 0, NULL, NULL) != 0) {
            _exit(1);
        }
        raise(SIGSTOP);
        run(context);
        _exit(0);
    }
    return child;
}

static void nothing(void *context) {
    (void)context;
}

static bool can_trace(void) {
    int status;
    pid_t child = start(nothing, NULL);
    if (child < 0 || waitpid(child, &status, 0) != child || !WIFSTOPPED(status)) {
        return false;
    }
    bool steps = ptrace(PTRACE_SINGLESTEP, child, NULL, NULL) == 0 && waitpid(child, &status, 0) == child;
    if (steps && WIFSTOPPED(status)) {
        kill(child, SIGKILL);
        waitpid(child, &status, 0);
    }
    return steps;
}

const char *instruction_count_unavailable(void) {
    static bool tried;
    if (!tried) {
        char command[128];
        tried = true;
        snprintf(command, sizeof command, "objdump -d --no-show-raw-insn /proc/%ld/exe 2>/dev/null",
                 (long)getpid());
        FILE *listing = popen(command, "r");
        if (listing != NULL) {
            read_code(listing);
            pclose(listing);
        }
    }
    if (code_count == 0) {
        return "no disassembly: objdump (binutils) is missing";
    }
    return can_trace() ? NULL : "this system forbids tracing a child process";
}

static void add(instruction_count *sum, uint64_t address, double by_width[65]) {
    const instruction *i = bsearch(&address, code, code_count, sizeof *code, by_address);
    if (i != NULL) {
        sum->flops += i->flops;
        sum->fused += i->fused ? i->flops : 0;
        by_width[i->bytes] += i->flops;
    }
}

instruction_count instruction_count_of(void (*run)(void *), void *context) {
    instruction_count sum = {0};
    double by_width[65] = {0};
    uint64_t bias = 0;
    int status;
    dl_iterate_phdr(load_bias, &bias);
    pid_t child = start(run, context);
    while (waitpid(child, &status, 0) == child && WIFSTOPPED(status)) {
        long at = ptrace(PTRACE_PEEKUSER, child, offsetof(struct user, regs.rip), NULL);
        add(&sum, (uint64_t)at - bias, by_width);
        if (ptrace(PTRACE_SINGLESTEP, child, NULL, NULL) != 0) {
            break;
        }
    }
    for (int width = 64; sum.widest == 0 && width > 0; width /= 2) {
        sum.widest = by_width[width];
        sum.width = width;
    }
    return sum;
}

#else

const char *instruction_count_unavailable(void) {
    return "counting needs x86-64 Linux";
}

instruction_count instruction_count_of(void (*run)(void *), void *context) {
    (void)run;
    (void)context;
    return (instruction_count){0};
}

#endif
