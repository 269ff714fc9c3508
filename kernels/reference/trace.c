/* Reference rows of tile-boundary faces. */
#include "reference/reference.h"

void rg_reference_send(const rg_trace_args *args, size_t begin, size_t end) {
    for (size_t s = begin * RG_LANES; s < end * RG_LANES; s++)
        for (int k = 0; k < RG_TRACE_ROW; k++) {
            int32_t own = args->side[s];
            args->own_rows[s * RG_TRACE_ROW + (size_t)k] =
                args->u[rg_node_index((size_t)own / 4, rg_face_node[own % 4][k / 3], k % 3)];
        }
}

void rg_reference_send_tractions(const rg_trace_args *args, size_t begin, size_t end) {
    for (size_t s = begin * RG_LANES; s < end * RG_LANES; s++)
        for (int k = 0; k < RG_TILE_FACE_ROW; k++) {
            int32_t own = args->side[s];
            args->own_tractions[s * RG_TILE_FACE_ROW + (size_t)k] =
                args->traction[rg_traction_index((size_t)own / 4, own % 4, k / 3, k % 3)];
        }
}

void rg_reference_receive(const rg_trace_args *args, size_t begin, size_t end) {
    for (size_t s = begin * RG_LANES; s < end * RG_LANES; s++)
        for (int k = 0; k < RG_TRACE_ROW; k++)
            args->ghost[rg_iforce_index(s, k / 3, k % 3)] =
                args->rows[(size_t)(args->other[s] / 2) * RG_TRACE_ROW + (size_t)k];
}
