// Elastic stiffness of a tissue at rest, in the axes of space.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>

#include "sinew/tissue.h"

// with engineering shear strains: strain in the axes of the material from that in the axes of space
static void strain_map(const double Q[9], double T[6][6]) {
    static const int at[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}};
    for (int m = 0; m < 6; m++)
        for (int s = 0; s < 6; s++) {
            const double *p = Q + 3 * at[m][0], *q = Q + 3 * at[m][1];
            const int i = at[s][0], j = at[s][1];
            const double both = 0.5 * (p[i] * q[j] + p[j] * q[i]);
            T[m][s] = (m < 3 ? 1.0 : 2.0) * both;
        }
}

void sn_tissue_stiffness(const sn_tissue *tissue, const double axes[9], double C[6][6]) {
    const double rest[6] = {0};
    double upper[21], D[6][6], T[6][6];
    sn_moduli moduli;
    SN_ASSERT(tissue->law->kind == SN_LAW_SOLID);
    sn_tissue_moduli(tissue, &moduli);
    sn_law_solid(tissue->law, tissue->value, tissue->terms, 1, rest, NULL, NULL, upper);
    for (int i = 0, n = 0; i < 6; i++)
        for (int j = i; j < 6; j++, n++) D[i][j] = D[j][i] = upper[n];
    strain_map(axes, T);
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++) {
            C[i][j] = i < 3 && j < 3 ? moduli.bulk : 0.0;
            for (int k = 0; k < 6; k++)
                for (int l = 0; l < 6; l++) C[i][j] += T[k][i] * D[k][l] * T[l][j];
        }
}
