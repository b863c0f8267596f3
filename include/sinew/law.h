// Elastic laws: energy, stress and tangent at many points.
// SPDX-License-Identifier: Apache-2.0
//
// Three kinds of law. A uniaxial law gives the nominal stress T (force over original area) at a
// stretch. A membrane law gives the stresses in the plane of a thin sheet, see sn_law_membrane(). A
// solid law gives the second Piola-Kirchhoff stress S at a Green strain E. Its energy is
//     W(E) = W_d(E) + U(J),   U(J) = K/2 (J - 1)^2,
// W_d the distortional part, K the bulk modulus, J the volume ratio; springs, mixed elements and
// incompressible tests each treat U in their own way, so the functions below give W_d alone.
//
// Symmetric tensors are six numbers in the order xx yy zz xy yz zx, tensor components (E_xy, not
// 2 E_xy). Tangents are the upper triangle by rows of the 6 x 6 matrix dS_i/de_j with
// e = (E_xx, E_yy, E_zz, 2 E_xy, 2 E_yz, 2 E_zx): 21 numbers. Arrays over n points are structures
// of arrays: component k of point i stands at [k * n + i].
#pragma once

#include "sinew/base.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum sn_law_kind { SN_LAW_UNIAXIAL, SN_LAW_SOLID, SN_LAW_MEMBRANE } sn_law_kind;

/// Small-strain moduli of a law, pascals.
typedef struct sn_moduli {
    double young; ///< Young's modulus; for a uniaxial law its slope at rest; for a membrane that
                  ///< of a strip along the first axis
    double shear; ///< shear modulus (of the isotropic part where the law has fibres); not uniaxial
    double bulk;  ///< bulk modulus; INFINITY for incompressible, as membranes are; not uniaxial
} sn_moduli;

typedef struct sn_law_kernels sn_law_kernels;

/// A law: a constant table. Adding one is one file in src/law/ and one line in its registry.
typedef struct sn_law {
    const char *name;   ///< key in files
    const char *text;   ///< one sentence
    const char *source; ///< equation of the paper, or the publication
    sn_law_kind kind;
    bool fibres; ///< strains are expected in axes of the material, the first of them the fibre's
    /// Nullable: the constant, in pascals, that the energy of the fibres is proportional to and
    /// that stands nowhere else; what is left with it at 0 is the matrix.
    const char *fibre_constant;
    int param_count;
    const sn_param *params;
    /// Nullable: conditions beyond the table's ranges (convexity); stores a text.
    sn_status (*check)(const double *value, int terms);
    void (*moduli)(const double *value, int terms, sn_moduli *out);
    /// sn_law_sensitivity() into zeros: a constant without influence is left alone.
    void (*sensitivity)(const double *value, int terms, int n, const double *in, double *dS);
    const sn_law_kernels *kernels; ///< one row per instruction set and precision
} sn_law;

SN_API int sn_law_count(void);
SN_API const sn_law *sn_law_at(int index);
/// A law by name. @return NULL with a text (and a suggestion) stored when there is none.
SN_API const sn_law *sn_law_find(const char *name);
/// Ranges and conditions. @return SN_OK or SN_E_RANGE.
SN_API sn_status sn_law_check(const sn_law *law, const double *value, int terms);

/// U(J) = K/2 (J - 1)^2: pressure-like derivative dU/dJ = K (J - 1), positive in tension.
static inline double sn_volume_stress(double bulk, double J) {
    return bulk * (J - 1.0);
}

/// Nominal stress at n stretches of a uniaxial law.
/// @param stretch  stretch [1]                                 (n)
/// @param W        energy per original volume, J/m3, Nullable  (n)
/// @param T        nominal stress, Pa, Nullable                (n)
/// @param dT       dT/dstretch, Pa, Nullable                   (n)
SN_API void sn_law_uniaxial(const sn_law *law, const double *value, int terms, int n,
                            const double *stretch, double *W, double *T, double *dT);

/// Distortional part of a solid law at n points (layouts above).
/// @param E  Green strain [1], in material axes if law->fibres            (6 x n)
/// @param W  energy W_d, J/m3, Nullable                                   (n)
/// @param S  second Piola-Kirchhoff stress dW_d/dE, Pa, Nullable          (6 x n)
/// @param D  tangent dS/de, Pa, Nullable                                  (21 x n)
/// W_d is finite wherever det(2E + I) > 0.
SN_API void sn_law_solid(const sn_law *law, const double *value, int terms, int n, const double *E,
                         double *W, double *S, double *D);
/// The same in single precision, for the real-time engine.
SN_API void sn_law_solid_f(const sn_law *law, const float *value, int terms, int n, const float *E,
                           float *W, float *S, float *D);
SN_API void sn_law_uniaxial_f(const sn_law *law, const float *value, int terms, int n,
                              const float *stretch, float *W, float *T, float *dT);

/// A membrane law at n points: a thin sheet that is stressed in its plane only. Its thickness is
/// free and follows from constant volume, with stretch 1/sqrt(det(2E + I)), so there is no pressure
/// to find. E12 and E21 count as independent: S12 = dW/dE12 with E21 held, half of the derivative
/// where one symbol stands for both; and e = (E11, E22, 2 E12) in the tangent.
/// @param E  Green strain [1] in material axes: 11 22 12                    (3 x n)
/// @param W  energy per original volume, J/m3, Nullable                     (n)
/// @param S  second Piola-Kirchhoff stress: 11 22 12, Pa, Nullable          (3 x n)
/// @param D  tangent dS/de, upper triangle by rows, Pa, Nullable            (6 x n)
/// Source: equations (19) to (21).
SN_API void sn_law_membrane(const sn_law *law, const double *value, int terms, int n,
                            const double *E, double *W, double *S, double *D);
SN_API void sn_law_membrane_f(const sn_law *law, const float *value, int terms, int n,
                              const float *E, float *W, float *S, float *D);

/// Components of the stress of a law: 1 (uniaxial), 6 (solid) or 3 (membrane).
SN_API int sn_law_components(const sn_law *law);
/// Derivatives of the stress by every value of a law, at n points of strain that stay: of T
/// (uniaxial), S of W_d (solid) or S (membrane). Zero for a bulk modulus, which W_d does not hold.
/// Where fibres begin to carry the one-sided derivatives differ; it is then that of fibres at rest.
/// @param in  stretch (n) or Green strain (components x n), as for the stress
/// @param dS  component c by value k of point i at [(k * components + c) * n + i]
///                                                          (values x components x n)
SN_API void sn_law_sensitivity(const sn_law *law, const double *value, int terms, int n,
                               const double *in, double *dS);

#ifdef __cplusplus
}
#endif
