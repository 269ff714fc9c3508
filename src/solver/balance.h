/* Work that has become uneven: broken faces, growing damage and flow cost more than intact elements, and no
 * partition knows beforehand where they will be. With mesh.rebalance the program measures what each tile
 * costs and, when it pays, repartitions the mesh. A state is the same on any partition, so results are too.
 */
#ifndef RG_BALANCE_H
#define RG_BALANCE_H

#include "solver/solver.h"

/* How uneven the work of ranks is: the most over the mean. */
typedef struct {
    double level; /* when the present partition was new; that of a first one counts as even */
    double now;   /* when it was last looked at */
    double spent; /* seconds of work of this rank up to then */
    int64_t step; /* at which that was */
} rg_balance;

/* From the solver's state on; `repartitioned`: the partition was made by measured costs. */
void rg_balance_start(rg_balance *b, rg_solver *s, bool repartitioned);

/* Every so many steps: whether to repartition the mesh, given that this takes `cost` seconds and the run as
 * it is `left` more. True where the work is more uneven than mesh.rebalance allows, on top of what the
 * partition could not even out, and an even one would save twice the cost. Below 1 mesh.rebalance asks for no
 * reason. Only what rank 0 says of cost and left counts. Collective. */
bool rg_balance_pays(rg_balance *b, rg_solver *s, double cost, double left);

/* What each tile of the mesh took (s) since the last look but one; on rank 0, others get NULL. Caller frees.
 * Collective. */
double *rg_balance_costs(const rg_solver *s);

#endif
