/* A hash over the bits of displacement, velocity and damage: equal on any ranks and threads, or there is a
 * bug. */
#ifndef RG_STATE_HASH_H
#define RG_STATE_HASH_H

#include "diagnostics/ledger.h"
#include "solver/solver.h"

/* Sum (modulo 2^64) of one hash per element and cracked interface, each keyed by its global number: what a
 * hash in global order would tell, without bringing the state into that order. Collective. */
uint64_t rg_state_hash(const rg_solver *s);

/* A hash over the bits of all numbers of a ledger. Not collective. */
uint64_t rg_energy_hash(const rg_energy *e);

#endif
