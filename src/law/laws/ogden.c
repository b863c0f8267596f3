// Ogden: a sum of powers of the principal stretches.
// SPDX-License-Identifier: Apache-2.0
// Source: Ogden (1972); stress and tangent in principal axes as in Ogden, Non-Linear Elastic
// Deformations (1984), section 6.1.
//
//     W = sum_p mu_p / alpha_p (l1^alpha_p + l2^alpha_p + l3^alpha_p - 3)
//
// l1, l2, l3 the principal stretches without the change of volume. Shear modulus at rest: half the
// sum of mu_p alpha_p. (Others write 2 mu_p / alpha_p^2 in front; their mu_p is mu_p alpha_p / 2.)
// One term with alpha = 2 is the neo-Hookean law; alpha = -2 is the second part of Mooney-Rivlin
// with c2 = -mu/2.
//
// With C = a G, G = I + g of law/isochoric.h, g_i the principal values of g and x_i = ln l_i,
//     x_i = (y_i - (y_1 + y_2 + y_3) / 3) / 2,  y_i = ln(1 + g_i),
// which loses nothing of small strains, and, because the x_i sum to zero,
//     W   = sum_p mu_p alpha_p sum_i x_i^2 phi2(alpha_p x_i)
//     t_i = b_i - (b_1 + b_2 + b_3) / 3,  b_i = sum_p mu_p (exp(alpha_p x_i) - 1)
//     S   = sum_i t_i / L_i N_i x N_i,  L_i = a (1 + g_i) the values of C.
// The tangent has the usual two parts. Of normal strains, with h_i = db_i/dx_i and their mean m,
//     L_i L_j D_ij = (h_i - 2 t_i) [i = j] - (h_i + h_j) / 3 + m / 3;
// of shears, 2 (S_j - S_i) / (L_j - L_i), the quotient that equal stretches make 0/0. It is written
// without it: with x = x_j - x_i,
//     {sum_p mu_p alpha_p exp(alpha_p x_i) phi1(alpha_p x) / phi1(2 x) - 2 t_i} / (L_i L_j),
// phi1(z) = (exp(z) - 1) / z: exact for all x and smooth at 0. The axes N_i are arbitrary where
// stretches are equal, and drop out of the sums there.
#include "law/isochoric.h"
#include "law/principal.h"

/// ln(1 + x), accurate for small x too; the logarithm of a rounding unit for x <= -1.
SN_INLINE wide log1(wide x) {
    const real least = SN_REAL_BITS == 64 ? (real)0x1p-56 : (real)0x1p-27;
    wide u = wide_max(wide_set(least), 1 + x), du = u - 1;
    wide_mask small = wide_less(wide_abs(x), wide_set((real)0.5));
    wide_mask none = wide_equal(du, wide_set(0));
    wide y = wide_log(u);
    // ln u / (u - 1) hardly changes over the rounding error of u
    wide near = wide_select(none, x, y * (x / wide_select(none, wide_set(1), du)));
    return wide_select(small, near, y);
}

/// Sums over the terms.
typedef struct ogden_sums {
    wide W;
    wide b[3], h[3];
    wide q[3]; ///< sum of mu alpha exp(alpha x_i) phi1(alpha (x_j - x_i)), j = i + 1
} ogden_sums;

SN_INLINE void ogden_sum(const real *p, int terms, const wide x[3], ogden_sums *sum) {
    const wide zero = wide_set(0);
    *sum = (ogden_sums){
        .W = zero, .b = {zero, zero, zero}, .h = {zero, zero, zero}, .q = {zero, zero, zero}};
    for (int term = 0; term < terms; term++) {
        const real mu = p[term], alpha = p[terms + term], slope = mu * alpha;
        SOLID_UNROLL for (int i = 0; i < 3; i++) {
            wide power = alpha * x[i];
            wide h = slope * wide_exp(power);
            sum->W = sum->W + slope * (x[i] * x[i] * wide_phi2(power));
            sum->b[i] = sum->b[i] + mu * wide_expm1(power);
            sum->h[i] = sum->h[i] + h;
            sum->q[i] = sum->q[i] + h * wide_phi1(alpha * (x[(i + 1) % 3] - x[i]));
        }
    }
}

SN_INLINE void point(const real *p, int terms, const wide E[6], solid_point *out) {
    const real third = (real)(1.0 / 3.0);
    isochoric q;
    principal main;
    ogden_sums sum;
    wide x[3], t[3], inverse[3], axes[3][6], rows[3][6], shear[3], dyad[3][6];
    isochoric_split(E, &q);
    principal_of(q.g, &main);
    SOLID_UNROLL for (int i = 0; i < 3; i++) {
        x[i] = log1(main.value[i]) * (real)0.5;
        inverse[i] = q.a_inverse / (1 + main.value[i]);
        principal_dyad(&main, i, i, axes[i]);
    }
    wide mean = (x[0] + x[1] + x[2]) * third;
    SOLID_UNROLL for (int i = 0; i < 3; i++) x[i] = x[i] - mean;
    ogden_sum(p, terms, x, &sum);
    out->W = sum.W;
    mean = (sum.b[0] + sum.b[1] + sum.b[2]) * third;
    SOLID_UNROLL for (int i = 0; i < 3; i++) t[i] = sum.b[i] - mean;
    SOLID_UNROLL for (int k = 0; k < 6; k++) out->S[k] = t[0] * inverse[0] * axes[0][k] +
                                                         t[1] * inverse[1] * axes[1][k] +
                                                         t[2] * inverse[2] * axes[2][k];

    wide m = (sum.h[0] + sum.h[1] + sum.h[2]) * (third * third);
    SOLID_UNROLL for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3;
        wide L[3];
        SOLID_UNROLL for (int k = 0; k < 3; k++) {
            wide l = m - (sum.h[i] + sum.h[k]) * third;
            L[k] = inverse[i] * inverse[k] * (k == i ? l + (sum.h[i] - 2 * t[i]) : l);
        }
        SOLID_UNROLL for (int k = 0; k < 6; k++) rows[i][k] =
            L[0] * axes[0][k] + L[1] * axes[1][k] + L[2] * axes[2][k];
        shear[i] =
            2 * (inverse[i] * inverse[j]) * (sum.q[i] / wide_phi1(2 * (x[j] - x[i])) - 2 * t[i]);
        principal_dyad(&main, i, j, dyad[i]);
    }
    SOLID_UNROLL for (int i = 0; i < 6; i++) {
        SOLID_UNROLL for (int k = i; k < 6; k++) {
            wide d = axes[0][i] * rows[0][k] + axes[1][i] * rows[1][k] + axes[2][i] * rows[2][k];
            d = d + (shear[0] * dyad[0][i] * dyad[0][k] + shear[1] * dyad[1][i] * dyad[1][k] +
                     shear[2] * dyad[2][i] * dyad[2][k]);
            out->D[SOLID_UPPER(i, k)] = d;
        }
    }
}
SN_LAW_LIST_KERNEL(ogden)

#if SN_LAW_TABLE
/// S is linear in the b_i, and db_i/dmu = exp(alpha x_i) - 1, db_i/dalpha = mu x_i exp(alpha x_i).
static void sensitivity(const double *p, int terms, int n, const double *E, double *dS) {
    for (int i = 0; i < n; i++) {
        isochoric q;
        principal main;
        double e[6], x[3], axes[3][6], mean = 0;
        for (int c = 0; c < 6; c++) e[c] = E[(ptrdiff_t)c * n + i];
        isochoric_split(e, &q);
        principal_of(q.g, &main);
        for (int a = 0; a < 3; a++) {
            x[a] = log1(main.value[a]) / 2;
            mean += x[a] / 3;
            principal_dyad(&main, a, a, axes[a]);
        }
        for (int k = 0; k < 2 * terms; k++) {
            double mu = p[k % terms], alpha = p[terms + k % terms], b[3], S[6] = {0};
            for (int a = 0; a < 3; a++) {
                double y = x[a] - mean;
                b[a] = k < terms ? wide_expm1(alpha * y) : mu * y * wide_exp(alpha * y);
            }
            for (int a = 0; a < 3; a++) {
                double t = b[a] - (b[0] + b[1] + b[2]) / 3, L = (1 + main.value[a]) / q.a_inverse;
                for (int c = 0; c < 6; c++) S[c] += t / L * axes[a][c];
            }
            law_sensitivity_add(dS, 6, n, k, i, S);
        }
    }
}

static void moduli(const double *p, int terms, sn_moduli *out) {
    double shear = 0;
    for (int i = 0; i < terms; i++) shear += p[i] * p[terms + i] / 2;
    *out = law_moduli_of(shear, p[2 * terms]);
}

/// Hill's condition: W is convex in the logarithmic strains if every mu alpha is positive.
static sn_status check(const double *p, int terms) {
    for (int i = 0; i < terms; i++)
        if (!(p[i] * p[terms + i] > 0))
            return sn_fail(SN_E_RANGE,
                           "law ogden is not convex: mu alpha of term %d is %g Pa: expected more "
                           "than 0, mu and alpha of one sign",
                           i + 1, p[i] * p[terms + i]);
    return SN_OK;
}

static const sn_param params[] = {
    {.name = "mu",
     .symbol = "mu",
     .unit = "Pa",
     .min = -1e12,
     .max = 1e12,
     .init = (double)NAN,
     .length = SN_PARAM_LIST,
     .text = "Stress of every term, of the sign of its alpha; the shear modulus at rest is half "
             "the sum of mu alpha."},
    {.name = "alpha",
     .symbol = "alpha",
     .unit = "1",
     .min = -100,
     .max = 100,
     .init = (double)NAN,
     .length = SN_PARAM_LIST,
     .text = "Exponent of the stretches in every term."},
    SN_LAW_BULK_MODULUS,
};

const sn_law sn_law_ogden = {
    .name = "ogden",
    .text = "Isotropic, a sum of powers of the stretches; brain, fat, liver, rubber.",
    .source = "Ogden, Proc. R. Soc. A 326 (1972) 565",
    .kind = SN_LAW_SOLID,
    .param_count = sizeof params / sizeof params[0],
    .params = params,
    .check = check,
    .moduli = moduli,
    .sensitivity = sensitivity,
    .kernels = &kernels,
};
#endif
