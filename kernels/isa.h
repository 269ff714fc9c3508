/* Names of the kernels of one instruction set: each source is compiled once per set with RG_ISA defined. */
#ifndef RG_ISA_H
#define RG_ISA_H

#include "kernels.h"

#define RG_PASTE_(name, isa) name##_##isa
#define RG_PASTE(name, isa)  RG_PASTE_(name, isa)
#define RG_ISA_NAME(name)    RG_PASTE(name, RG_ISA)

void RG_ISA_NAME(rg_send)(const rg_trace_args *args, size_t begin, size_t end);
void RG_ISA_NAME(rg_send_tractions)(const rg_trace_args *args, size_t begin, size_t end);
void RG_ISA_NAME(rg_receive)(const rg_trace_args *args, size_t begin, size_t end);
void RG_ISA_NAME(rg_bulk)(const rg_bulk_args *args, size_t begin, size_t end);
void RG_ISA_NAME(rg_interface)(const rg_interface_args *args, size_t begin, size_t end);
void RG_ISA_NAME(rg_kick)(const rg_kick_args *args, size_t begin, size_t end);
void RG_ISA_NAME(rg_drift)(const rg_drift_args *args, size_t begin, size_t end);
void RG_ISA_NAME(rg_bulk_state)(const rg_bulk_state_args *args, size_t begin, size_t end);
void RG_ISA_NAME(rg_kinetic)(const rg_kinetic_args *args, size_t begin, size_t end);
void RG_ISA_NAME(rg_interface_state)(const rg_interface_state_args *args, size_t begin, size_t end);
void RG_ISA_NAME(rg_viscosity)(const rg_viscosity_args *args, size_t begin, size_t end);
void RG_ISA_NAME(rg_prestress)(const rg_prestress_args *args, size_t begin, size_t end);
void RG_ISA_NAME(rg_prestress_state)(const rg_prestress_state_args *args, size_t begin, size_t end);
void RG_ISA_NAME(rg_contact)(const rg_contact_args *args, size_t begin, size_t end);

/* One of each for every material. */
#define RG_BULK_KERNELS(name, NAME, word, meaning, history, inside)                                          \
    void RG_ISA_NAME(rg_bulk_##name)(const rg_bulk_args *args, size_t begin, size_t end);                    \
    void RG_ISA_NAME(rg_bulk_state_##name)(const rg_bulk_state_args *args, size_t begin, size_t end);
RG_MATERIALS_HERE(RG_BULK_KERNELS)

#endif
