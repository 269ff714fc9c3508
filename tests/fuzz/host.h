/* What fuzzed code runs on in place of src/base/error.c and src/base/mem.c: a fatal end comes back to the
 * fuzzer, and what it left behind is given back, so that one process tries inputs without end. */
#ifndef RG_FUZZ_HOST_H
#define RG_FUZZ_HOST_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* What a target defines; the fuzzer (libFuzzer, or replay.c) calls them. */
int LLVMFuzzerInitialize(int *argc, char ***argv);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* A reader under test, on an input. */
typedef void rg_fuzz_body(const uint8_t *data, size_t size);

/* Runs `body`. True: it returned; false: it refused the input. Aborts, for the fuzzer to notice, if it ended
 * in another way than bad input does (status RG_USAGE with a message of one line), asked for a block of more
 * than 256 MB, or returned without freeing what it took. */
bool rg_fuzz_run(rg_fuzz_body *body, const uint8_t *data, size_t size);

/* A target that has nothing to prepare and runs `body` on every input. */
#define RG_FUZZ_TARGET(body)                                                                                 \
    int LLVMFuzzerInitialize(int *argc, char ***argv) {                                                      \
        (void)argc;                                                                                          \
        (void)argv;                                                                                          \
        return 0;                                                                                            \
    }                                                                                                        \
                                                                                                             \
    int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {                                           \
        rg_fuzz_run(body, data, size);                                                                       \
        return 0;                                                                                            \
    }

/* Aborts with a message unless `good`: for what must hold of an accepted input. */
void rg_fuzz_require(bool good, const char *what);

/* The name of an empty scratch file of this process, in memory where there is a file system for it. */
const char *rg_fuzz_scratch(void);

#endif
