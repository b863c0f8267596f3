// The rows of kernels: instruction sets by precisions.
// SPDX-License-Identifier: Apache-2.0
#include "base/isa.h"
#include "springs/pass.h"

#define DECLARE_BITS(isa, bits)                                                                    \
    void sn_volumes_##isa##_##bits(const sn_cell_pass *pass, const sn_tile *tile);                 \
    void sn_points_##isa##_##bits(const sn_point_pass *pass, int block);                           \
    void sn_cells_##isa##_##bits(const sn_cell_pass *pass, const sn_tile *tile);                   \
    void sn_press_##isa##_##bits(const sn_cell_pass *pass, const sn_tile *tile);                   \
    void sn_shapes_##isa##_##bits(const sn_cell_pass *pass, const sn_tile *tile);                  \
    void sn_edges_##isa##_##bits(const sn_cell_pass *pass, int block);                             \
    void sn_shares_##isa##_##bits(const sn_cell_pass *pass, const sn_tile *tile);                  \
    void sn_springs_##isa##_##bits(const sn_spring_pass *pass, const sn_tile *tile);               \
    void sn_nodes_##isa##_##bits(const sn_node_pass *pass, int chunk);                             \
    void sn_move_##isa##_##bits(const sn_move_pass *pass, int chunk);                              \
    double sn_peak_##isa##_##bits(long turns, double *out);
#define DECLARE(isa) DECLARE_BITS(isa, 32) DECLARE_BITS(isa, 64)
SN_ISA_LIST(DECLARE)

#define ROW(isa, bits)                                                                             \
    {                                                                                              \
        sn_volumes_##isa##_##bits, sn_points_##isa##_##bits, sn_cells_##isa##_##bits,              \
            sn_press_##isa##_##bits, sn_shapes_##isa##_##bits, sn_edges_##isa##_##bits,            \
            sn_shares_##isa##_##bits, sn_springs_##isa##_##bits, sn_nodes_##isa##_##bits,          \
            sn_move_##isa##_##bits, sn_peak_##isa##_##bits                                         \
    }
static const sn_spring_kernels rows[SN_ISA_COUNT][2] = {
#define ROWS(isa) [SN_ISA_##isa] = {[SN_SINGLE] = ROW(isa, 32), [SN_DOUBLE] = ROW(isa, 64)},
    SN_ISA_LIST(ROWS)
#undef ROWS
};

const sn_spring_kernels *sn_spring_kernels_row(int isa, sn_precision precision) {
    return &rows[isa][precision];
}
