#define _GNU_SOURCE
#include "support/instruction_count.h"

#if defined(__x86_64__) && defined(__linux__)

#include <link.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <ucontext.h>
#include <unistd.h>

/* What one instruction does. */
typedef struct {
    uint8_t flops; /* of all lanes; 0: none of what is counted */
    uint8_t bytes; /* width of its vectors; 8 for a scalar */
    bool fused;
} instruction;

static instruction *code; /* [code_end] by address in the file */
static uint64_t code_end;

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

/* Room for the instruction at an address. */
static instruction *place(uint64_t address) {
    if (address >= code_end) {
        uint64_t end = 2 * address + 1;
        code = realloc(code, end * sizeof *code);
        if (code == NULL) {
            abort();
        }
        memset(code + code_end, 0, (end - code_end) * sizeof *code);
        code_end = end;
    }
    return &code[address];
}

/* Reads the disassembly of this program. */
static void read_code(FILE *listing) {
    char line[512], name[32], operands[256];
    while (fgets(line, sizeof line, listing) != NULL) {
        unsigned long long address;
        operands[0] = '\0';
        if (sscanf(line, " %llx: %31s %255[^\n]", &address, name, operands) >= 2) {
            *place(address) = classify(name, operands);
        }
    }
}

/* Where the program itself was loaded: the first object reported. */
static int load_bias(struct dl_phdr_info *info, size_t size, void *bias) {
    (void)size;
    *(uint64_t *)bias = info->dlpi_addr;
    return 1;
}

/* What the steps of this process add up to. */
static struct {
    volatile bool on;
    uint64_t bias;
    double steps, flops, fused, by_width[65];
} count;

/* After each instruction while the trap flag is set: far cheaper than another process that steps
 * this one, which takes two switches between them. */
static void step(int signal, siginfo_t *info, void *context) {
    static const greg_t trap_flag = 0x100;
    greg_t *registers = ((ucontext_t *)context)->uc_mcontext.gregs;
    uint64_t next = (uint64_t)registers[REG_RIP] - count.bias;
    (void)signal;
    (void)info;
    if (!count.on) {
        registers[REG_EFL] &= ~trap_flag;
        return;
    }
    registers[REG_EFL] |= trap_flag;
    count.steps++;
    if (next < code_end) {
        const instruction *i = &code[next];
        count.flops += i->flops;
        count.fused += i->fused ? i->flops : 0;
        count.by_width[i->bytes] += i->flops;
    }
}

static void count_here(void (*run)(void *), void *context) {
    struct sigaction action = {.sa_sigaction = step, .sa_flags = SA_SIGINFO};
    memset(&count, 0, sizeof count);
    sigaction(SIGTRAP, &action, NULL);
    dl_iterate_phdr(load_bias, &count.bias);
    count.on = true;
    raise(SIGTRAP); /* sets the flag */
    run(context);
    count.on = false;
}

/* Counts in a child. Returns whether the child said what it counted. */
static bool count_in_child(void (*run)(void *), void *context) {
    int ends[2], status;
    if (pipe(ends) != 0) {
        return false;
    }
    pid_t child = fork();
    if (child == 0) {
        count_here(run, context);
        _exit(write(ends[1], &count, sizeof count) == (ssize_t)sizeof count ? 0 : 1);
    }
    close(ends[1]);
    bool told = child > 0 && read(ends[0], &count, sizeof count) == (ssize_t)sizeof count;
    close(ends[0]);
    return child > 0 && waitpid(child, &status, 0) == child && told && status == 0;
}

static void nothing(void *context) {
    (void)context;
}

const char *instruction_count_unavailable(void) {
    if (code_end == 0) {
        char command[128];
        snprintf(command, sizeof command, "objdump -d --no-show-raw-insn /proc/%ld/exe 2>/dev/null",
                 (long)getpid());
        FILE *listing = popen(command, "r");
        if (listing != NULL) {
            read_code(listing);
            pclose(listing);
        }
    }
    if (code_end == 0) {
        return "no disassembly: objdump (binutils) is missing";
    }
    return count_in_child(nothing, NULL) && count.steps > 0 ? NULL : "this system has no trap flag";
}

instruction_count instruction_count_of(void (*run)(void *), void *context) {
    if (!count_in_child(run, context)) {
        abort();
    }
    instruction_count sum = {.flops = count.flops, .fused = count.fused};
    for (int width = 64; sum.widest == 0 && width > 0; width /= 2) {
        sum.widest = count.by_width[width];
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
