/* Which instruction sets this machine can run, and which one to use. */
#include <stdlib.h>
#include <string.h>

#include "kernels.h"

#define RG_KERNEL_SET(isa, label, bytes)                                                                     \
    void rg_send_##isa(const rg_trace_args *, size_t, size_t);                                               \
    void rg_send_tractions_##isa(const rg_trace_args *, size_t, size_t);                                     \
    void rg_receive_##isa(const rg_trace_args *, size_t, size_t);                                            \
    void rg_bulk_##isa(const rg_bulk_args *, size_t, size_t);                                                \
    void rg_interface_##isa(const rg_interface_args *, size_t, size_t);                                      \
    void rg_kick_##isa(const rg_kick_args *, size_t, size_t);                                                \
    void rg_drift_##isa(const rg_drift_args *, size_t, size_t);                                              \
    void rg_bulk_state_##isa(const rg_bulk_state_args *, size_t, size_t);                                    \
    void rg_kinetic_##isa(const rg_kinetic_args *, size_t, size_t);                                          \
    void rg_interface_state_##isa(const rg_interface_state_args *, size_t, size_t);                          \
    void rg_viscosity_##isa(const rg_viscosity_args *, size_t, size_t);                                      \
    void rg_contact_##isa(const rg_contact_args *, size_t, size_t);                                          \
    void rg_prestress_##isa(const rg_prestress_args *, size_t, size_t);                                      \
    void rg_prestress_state_##isa(const rg_prestress_state_args *, size_t, size_t);                          \
    static const rg_kernels set_##isa = {label,                                                              \
                                         bytes,                                                              \
                                         rg_send_##isa,                                                      \
                                         rg_send_tractions_##isa,                                            \
                                         rg_receive_##isa,                                                   \
                                         rg_bulk_##isa,                                                      \
                                         rg_interface_##isa,                                                 \
                                         rg_kick_##isa,                                                      \
                                         rg_drift_##isa,                                                     \
                                         rg_bulk_state_##isa,                                                \
                                         rg_kinetic_##isa,                                                   \
                                         rg_interface_state_##isa,                                           \
                                         rg_viscosity_##isa,                                                 \
                                         rg_contact_##isa,                                                   \
                                         rg_prestress_##isa,                                                 \
                                         rg_prestress_state_##isa}

#ifdef RG_X86
RG_KERNEL_SET(v4, "x86-64-v4", 64);
RG_KERNEL_SET(v3, "x86-64-v3", 32);
RG_KERNEL_SET(v2, "x86-64-v2", 16);
#else
RG_KERNEL_SET(generic, "generic", 16);
#endif

int rg_kernels_available(const rg_kernels *sets[], int capacity) {
    const rg_kernels *all[3];
    int n = 0;
#ifdef RG_X86
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw")) {
        all[n++] = &set_v4;
    }
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
        all[n++] = &set_v3;
    }
    all[n++] = &set_v2;
#else
    all[n++] = &set_generic;
#endif
    n = n < capacity ? n : capacity;
    memcpy(sets, all, (size_t)n * sizeof *sets);
    return n;
}

const rg_kernels *rg_kernels_select(void) {
    const rg_kernels *sets[3];
    int n = rg_kernels_available(sets, 3);
    const char *wanted = getenv("RHEGMA_ISA");
    if (wanted == NULL || *wanted == '\0') {
        return sets[0];
    }
    for (int i = 0; i < n; i++) {
        if (strcmp(sets[i]->name, wanted) == 0) {
            return sets[i];
        }
    }
    return NULL;
}
