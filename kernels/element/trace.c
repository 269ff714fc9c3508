/* Rows that tile-boundary faces exchange: a row is contiguous, so the other side finds all of it in two or
 * three cache lines, where the lanes of a block would spread it over eighteen. */
#include "isa.h"
#include "tet10.h"

void RG_ISA_NAME(rg_send)(const rg_trace_args *args, size_t begin, size_t end) {
    for (size_t b = begin; b < end; b++) {
        for (int lane = 0; lane < RG_LANES; lane += RG_VLEN) {
            size_t tile_face = b * RG_LANES + (size_t)lane;
            rg_vec trace[RG_FNODES][3];
            rg_gather_face(args->u, args->side + tile_face, trace);
            rg_store_rows(args->own_rows + tile_face * RG_TRACE_ROW, RG_TRACE_ROW, RG_TRACE_ROW, trace[0]);
        }
    }
}

void RG_ISA_NAME(rg_send_tractions)(const rg_trace_args *args, size_t begin, size_t end) {
    for (size_t s = begin * RG_LANES; s < end * RG_LANES; s++) {
        memcpy(args->own_tractions + s * RG_TILE_FACE_ROW,
               args->traction + (size_t)args->side[s] * RG_TILE_FACE_ROW, RG_TILE_FACE_ROW * sizeof(rg_real));
    }
}

void RG_ISA_NAME(rg_receive)(const rg_trace_args *args, size_t begin, size_t end) {
    for (size_t b = begin; b < end; b++) {
        for (int lane = 0; lane < RG_LANES; lane += RG_VLEN) {
            const int32_t *other = args->other + b * RG_LANES + lane;
            rg_lanes row;
            for (int l = 0; l < RG_VLEN; l++) {
                row.lane[l] = args->rows + (size_t)((uint32_t)other[l] / 2) * RG_TRACE_ROW;
            }
            rg_vec trace[RG_TRACE_ROW];
            rg_load_rows(&row, RG_TRACE_ROW, trace);
            for (int k = 0; k < RG_TRACE_ROW; k++) {
                rg_store(args->ghost + b * RG_GHOST_BLOCK + k * RG_LANES + lane, trace[k]);
            }
        }
    }
}
