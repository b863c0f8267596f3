// Arithmetic on `wide`, several real numbers at once: an algorithm is written once, on `wide`.
// SPDX-License-Identifier: Apache-2.0
//
// A kernel file is compiled once for every instruction set and precision (cmake/SinewFolders.cmake)
// with
//     SN_ISA         scalar, sse2, avx2, avx512, neon
//     SN_LANE_BYTES  bytes of a vector register; 0: `wide` is a plain number
//     SN_REAL_BITS   32 or 64
// and gives its functions names of their own with SN_KERNEL(name). A file that defines none of
// these gets plain double. `wide` knows + - * / and unary minus; one operand may be a `real`.
// Small whole numbers may be written as they are (2 * x); any other constant needs a cast,
// (real)0.1 * x, or the single precision builds would calculate in double (the compiler says so).
//
// The same bits everywhere. Only IEEE add, subtract, multiply, divide, square root, comparisons and
// integer operations are used, contraction is off (-ffp-contract=off), and nothing depends on the
// number of lanes. So all instruction sets and both compilers give equal bits; tests/law holds them
// to it. The transcendental functions below are ours for the same reason. They have no branches:
// lanes of every range are calculated, and the right ones selected.
//
// Coefficients are near-minimax polynomials (Chebyshev fits in 200-bit arithmetic). Errors in units
// of the last place are those tests/base/test_wide.c measures.
#pragma once

#include <math.h>
#include <stdint.h>
#include <string.h>

#ifndef SN_ISA
#define SN_ISA scalar
#define SN_LANE_BYTES 0
#define SN_REAL_BITS 64
#endif

#define SN_KERNEL_JOIN(name, isa, bits) name##_##isa##_##bits
#define SN_KERNEL_EXPAND(name, isa, bits) SN_KERNEL_JOIN(name, isa, bits)
/// The name of a function of this build: name_avx2_64.
#define SN_KERNEL(name) SN_KERNEL_EXPAND(name, SN_ISA, SN_REAL_BITS)

#if SN_REAL_BITS == 64
typedef double real;
typedef int64_t real_int;
typedef uint64_t real_bits;
#define SN_MANTISSA_BITS 52
#define SN_EXPONENT_BIAS 1023
#else
typedef float real;
typedef int32_t real_int;
typedef uint32_t real_bits;
#define SN_MANTISSA_BITS 23
#define SN_EXPONENT_BIAS 127
#endif

#define SN_INLINE static inline __attribute__((always_inline))

//---- the type and what differs between targets ---------------------------------------------------

#if SN_LANE_BYTES == 0

#define SN_LANES 1
typedef real wide;
typedef real_int wide_int;
typedef real_bits wide_bits;
typedef int wide_mask; ///< result of a comparison: truth in every lane

SN_INLINE wide wide_set(real x) {
    return x;
}
SN_INLINE wide wide_select(wide_mask m, wide a, wide b) {
    return m ? a : b;
}
SN_INLINE wide wide_min(wide a, wide b) {
    return a < b ? a : b;
}
SN_INLINE wide wide_max(wide a, wide b) {
    return a > b ? a : b;
}
SN_INLINE wide wide_gather(const real *base, const int *index) {
    return base[index[0]];
}
#if SN_REAL_BITS == 64
SN_INLINE wide wide_sqrt(wide x) {
    return sqrt(x);
}
#else
SN_INLINE wide wide_sqrt(wide x) {
    return sqrtf(x);
}
#endif

#else

#if defined(__SSE2__)
#include <immintrin.h>
#elif defined(__ARM_NEON)
#include <arm_neon.h>
#endif

#define SN_LANES (SN_LANE_BYTES * 8 / SN_REAL_BITS)
typedef real wide __attribute__((vector_size(SN_LANE_BYTES)));
typedef real_int wide_int __attribute__((vector_size(SN_LANE_BYTES)));
typedef real_bits wide_bits __attribute__((vector_size(SN_LANE_BYTES)));
typedef wide_int wide_mask; ///< result of a comparison: all bits or none in every lane

/// x in every lane. (x - 0 keeps every bit of x, the sign of zero too.)
SN_INLINE wide wide_set(real x) {
    return x - (wide){0};
}

#if SN_LANES == 2
#define SN_EACH_LANE(F) F(0), F(1)
#elif SN_LANES == 4
#define SN_EACH_LANE(F) F(0), F(1), F(2), F(3)
#elif SN_LANES == 8
#define SN_EACH_LANE(F) F(0), F(1), F(2), F(3), F(4), F(5), F(6), F(7)
#else
#define SN_EACH_LANE(F)                                                                            \
    F(0), F(1), F(2), F(3), F(4), F(5), F(6), F(7), F(8), F(9), F(10), F(11), F(12), F(13), F(14), \
        F(15)
#endif

/// base[index[lane]] in every lane.
SN_INLINE wide wide_gather(const real *base, const int *index) {
#define SN_GATHER_LANE(i) base[index[i]]
    return (wide){SN_EACH_LANE(SN_GATHER_LANE)};
#undef SN_GATHER_LANE
}

// square root, minimum and maximum have no vector form in C: one intrinsic each. Minimum and
// maximum are a < b ? a : b and a > b ? a : b, so b when either is NaN.
#define SN_UNARY(name, call)                                                                       \
    SN_INLINE wide name(wide x) {                                                                  \
        return (wide)call(x);                                                                      \
    }
#define SN_BINARY(name, call)                                                                      \
    SN_INLINE wide name(wide a, wide b) {                                                          \
        return (wide)call(a, b);                                                                   \
    }
#if SN_LANE_BYTES == 64 && SN_REAL_BITS == 64
SN_UNARY(wide_sqrt, _mm512_sqrt_pd)
SN_BINARY(wide_min, _mm512_min_pd)
SN_BINARY(wide_max, _mm512_max_pd)
#elif SN_LANE_BYTES == 64
SN_UNARY(wide_sqrt, _mm512_sqrt_ps)
SN_BINARY(wide_min, _mm512_min_ps)
SN_BINARY(wide_max, _mm512_max_ps)
#elif SN_LANE_BYTES == 32 && SN_REAL_BITS == 64
SN_UNARY(wide_sqrt, _mm256_sqrt_pd)
SN_BINARY(wide_min, _mm256_min_pd)
SN_BINARY(wide_max, _mm256_max_pd)
#elif SN_LANE_BYTES == 32
SN_UNARY(wide_sqrt, _mm256_sqrt_ps)
SN_BINARY(wide_min, _mm256_min_ps)
SN_BINARY(wide_max, _mm256_max_ps)
#elif defined(__SSE2__) && SN_REAL_BITS == 64
SN_UNARY(wide_sqrt, _mm_sqrt_pd)
SN_BINARY(wide_min, _mm_min_pd)
SN_BINARY(wide_max, _mm_max_pd)
#elif defined(__SSE2__)
SN_UNARY(wide_sqrt, _mm_sqrt_ps)
SN_BINARY(wide_min, _mm_min_ps)
SN_BINARY(wide_max, _mm_max_ps)
#elif SN_REAL_BITS == 64
SN_UNARY(wide_sqrt, vsqrtq_f64)
#else
SN_UNARY(wide_sqrt, vsqrtq_f32)
#endif
#undef SN_UNARY
#undef SN_BINARY

/// a where m, else b.
SN_INLINE wide wide_select(wide_mask m, wide a, wide b) {
#if defined(__AVX512DQ__) && SN_LANE_BYTES == 64 && SN_REAL_BITS == 64
    return (wide)_mm512_mask_blend_pd(_mm512_movepi64_mask((__m512i)m), b, a);
#elif defined(__AVX512DQ__) && SN_LANE_BYTES == 64
    return (wide)_mm512_mask_blend_ps(_mm512_movepi32_mask((__m512i)m), b, a);
#elif SN_LANE_BYTES == 32 && SN_REAL_BITS == 64
    return (wide)_mm256_blendv_pd(b, a, (wide)m);
#elif SN_LANE_BYTES == 32
    return (wide)_mm256_blendv_ps(b, a, (wide)m);
#else
    return (wide)((m & (wide_int)a) | (~m & (wide_int)b));
#endif
}

#if !defined(__SSE2__)
// the processor's own minimum treats NaN in another way
SN_INLINE wide wide_min(wide a, wide b) {
    return wide_select(a < b, a, b);
}
SN_INLINE wide wide_max(wide a, wide b) {
    return wide_select(a > b, a, b);
}
#endif

#endif

//---- what all targets share ----------------------------------------------------------------------

/// SN_LANES numbers from memory, aligned or not.
SN_INLINE wide wide_load(const real *from) {
    wide x;
    memcpy(&x, from, sizeof x);
    return x;
}
SN_INLINE void wide_store(real *to, wide x) {
    memcpy(to, &x, sizeof x);
}

SN_INLINE wide_mask wide_less(wide a, wide b) {
    return a < b;
}
SN_INLINE wide_mask wide_equal(wide a, wide b) {
    return a == b;
}

/// The bits of the numbers as unsigned integers, and back.
SN_INLINE wide_bits wide_to_bits(wide x) {
    wide_bits b;
    memcpy(&b, &x, sizeof b);
    return b;
}
SN_INLINE wide wide_from_bits(wide_bits b) {
    wide x;
    memcpy(&x, &b, sizeof x);
    return x;
}

SN_INLINE wide wide_abs(wide x) {
    return wide_from_bits(wide_to_bits(x) & ~((real_bits)1 << (SN_REAL_BITS - 1)));
}

//---- exponential ---------------------------------------------------------------------------------
//
// x = k ln 2 + r with a whole number k and |r| <= ln 2 / 2. ln 2 is the sum of a short number,
// whose product with k is exact, and a correction. Then exp(r) - 1 = r + r^2 psi(r), psi a
// polynomial; as |r + r^2 psi| < 1/2 its rounding errors hardly reach the last place of exp(x) =
// 2^k (1 + ...). 2^k is multiplied in by adding k to the exponent bits. k is rounded by adding a
// number so large that its last place is 1; its low bits then are k itself.

#if SN_REAL_BITS == 64
#define SN_ROUNDER (real)0x1.8p52
#define SN_LN2_HIGH (real)0x1.62e42fefa3800p-1
#define SN_LN2_LOW (real)0x1.ef35793c76730p-45
#define SN_EXP_MAX (real)709.782712893383973096
#define SN_EXP_MIN (real) - 708.396418532264
#else
#define SN_ROUNDER (real)0x1.8p23
#define SN_LN2_HIGH (real)0x1.62e8p-1
#define SN_LN2_LOW (real) - 2.90889713046906e-5
#define SN_EXP_MAX (real)88.7228317
#define SN_EXP_MIN (real) - 87.33654
#endif

/// psi(r) = (exp(r) - 1 - r) / r^2 for |r| <= ln 2 / 2.
SN_INLINE wide wide_psi_core(wide r) {
    wide z = r * r;
#if SN_REAL_BITS == 64
    wide even = 2.0914717341716375948e-9 * z + 2.7557273570102139673e-7;
    wide odd = 2.5105259538448493413e-8 * z + 2.7557255297969644392e-6;
    even = even * z + 2.4801587325605322782e-5;
    odd = odd * z + 1.9841269874901259234e-4;
    even = even * z + 1.3888888888883731828e-3;
    odd = odd * z + 8.3333333333261120526e-3;
    even = even * z + 4.1666666666666669767e-2;
    odd = odd * z + 1.6666666666666671008e-1;
    even = even * z + 0.5;
#else
    wide even = 1.39336858626e-3f * z + 4.1666464602e-2f;
    wide odd = 1.98910306544e-4f * z + 8.33331088958e-3f;
    even = even * z + 0.5f;
    odd = odd * z + 1.66666666817e-1f;
#endif
    return even + r * odd;
}

/// exp(r) - 1 of the reduced argument; *power: the integer k in the low bits.
SN_INLINE wide wide_exp_core(wide x, wide_bits *power) {
    wide t = x * (real)1.44269504088896340736 + SN_ROUNDER;
    wide k = t - SN_ROUNDER;
    wide r = (x - k * SN_LN2_HIGH) - k * SN_LN2_LOW;
    *power = wide_to_bits(t);
    return r + r * r * wide_psi_core(r);
}

/// x 2^k by the exponent bits: x and the result must be normal numbers, or k zero.
SN_INLINE wide wide_scale(wide x, wide_bits power) {
    return wide_from_bits(wide_to_bits(x) + (power << SN_MANTISSA_BITS));
}

/// exp(x) within 1 unit of the last place. INFINITY beyond the largest number, 0 below the smallest
/// normal one (no denormal results), NaN for NaN.
SN_INLINE wide wide_exp(wide x) {
    wide_bits power;
    wide y = wide_exp_core(x, &power) + 1;
    y = wide_scale(y, power);
    y = wide_select(wide_less(wide_set(SN_EXP_MAX), x), wide_set((real)INFINITY), y);
    y = wide_select(wide_less(x, wide_set(SN_EXP_MIN)), wide_set(0), y);
    return wide_select(wide_equal(x, x), y, x);
}

/// exp(x) - 1 within 2 units of the last place, also for small x. Saturates at -1 and INFINITY; NaN
/// for NaN.
SN_INLINE wide wide_expm1(wide x) {
    // below this the result is -1 to the last place, and 2^-k stays harmless
    wide a = wide_max(wide_set(-SN_MANTISSA_BITS), x);
    wide_bits power;
    wide y = wide_exp_core(a, &power);
    // exp(x) - 1 = 2^k (exp(r) - 1 + 1 - 2^-k); the last difference is exact or far off
    wide_bits one = wide_to_bits(wide_set(1));
    wide back = wide_from_bits(one - (power << SN_MANTISSA_BITS));
#if SN_REAL_BITS == 64
    back = wide_select(wide_less(wide_set(700), x), wide_set(0), back); // 2^-1023 is no number
#else
    back = wide_select(wide_less(wide_set(86), x), wide_set(0), back);
#endif
    y = wide_scale(y + (1 - back), power);
    y = wide_select(wide_less(wide_set(SN_EXP_MAX), x), wide_set((real)INFINITY), y);
    return wide_select(wide_equal(x, x), y, x);
}

#define SN_EXPM1_NEAR 0.34 ///< < ln 2 / 2: where k of wide_expm1 is 0

/// wide_expm1(x), to the bit, for |x| <= SN_EXPM1_NEAR, at a third of the work.
SN_INLINE wide wide_expm1_near(wide x) {
    return x + x * x * wide_psi_core(x);
}

/// phi1(x) = (exp(x) - 1) / x, 1 at 0: what stays finite where a law's exponent goes to 0.
SN_INLINE wide wide_phi1(wide x) {
    wide_mask zero = wide_equal(x, wide_set(0));
    return wide_select(zero, wide_set(1), wide_expm1(x) / wide_select(zero, wide_set(1), x));
}

/// phi2(x) = (exp(x) - 1 - x) / x^2, 1/2 at 0, within 16 units of the last place.
SN_INLINE wide wide_phi2(wide x) {
    wide_mask small = wide_less(wide_abs(x), wide_set((real)0.34));
    wide far = wide_select(small, wide_set(1), x);
    wide near = wide_select(small, x, wide_set(0));
    return wide_select(small, wide_psi_core(near), (wide_expm1(far) - far) / far / far);
}

//---- logarithm -----------------------------------------------------------------------------------

/// Natural logarithm within 1 unit of the last place. -INFINITY at 0, NaN below, INFINITY at
/// INFINITY. x = 2^k (1 + f) with 1 + f from sqrt(1/2) to sqrt(2); with s = f / (2 + f), log(1 + f)
/// = 2 atanh(s) = f - f^2/2 + s (f^2/2 + s^2 R(s^2)), R a polynomial; in this form f, which is
/// exact, carries most of the result (Tang 1990).
SN_INLINE wide wide_log(wide x) {
    // denormal numbers are brought up first
    const real up = SN_REAL_BITS == 64 ? (real)0x1p54 : (real)0x1p25;
    wide_mask tiny = wide_less(x, wide_set(SN_REAL_BITS == 64 ? (real)0x1p-1022 : (real)0x1p-126));
    wide a = wide_select(tiny, x * up, x);
    wide shift = wide_select(tiny, wide_set(SN_REAL_BITS == 64 ? 54 : 25), wide_set(0));
    // k + bias stands in the exponent bits once those of sqrt(1/2) are taken off
    wide_bits root = wide_to_bits(wide_set((real)0.70710678118654752440));
    wide_bits one = wide_to_bits(wide_set(1));
    wide_bits bits = wide_to_bits(a) + (one - root);
    wide_bits exponent = bits >> SN_MANTISSA_BITS;
    wide_bits mantissa = bits & (((real_bits)1 << SN_MANTISSA_BITS) - 1);
    wide f = wide_from_bits(mantissa + root) - 1;
    // an integer below 2^mantissa, put into the mantissa of 2^mantissa, is that number plus itself
    const real base = SN_REAL_BITS == 64 ? (real)0x1p52 : (real)0x1p23;
    wide k = wide_from_bits(exponent | wide_to_bits(wide_set(base)));
    k = (k - (base + (real)SN_EXPONENT_BIAS)) - shift;

    wide s = f / (f + 2);
    wide z = s * s;
#if SN_REAL_BITS == 64
    wide w = z * z;
    wide R =
        z * (((0.14617128399807299808 * w + 0.18182890778026130313) * w + 0.28571428626114518292) *
                 w +
             0.66666666666666696969) +
        w * ((0.15331666676597174347 * w + 0.22222211112104947364) * w + 0.39999999999899197894);
#else
    wide R =
        z * (((0.23331040834f * z + 0.285507997302f) * z + 0.400001220257f) * z + 0.666666665543f);
#endif
    wide half = f * f * (real)0.5;
    wide y = k * SN_LN2_HIGH - ((half - (s * (half + R) + k * SN_LN2_LOW)) - f);
    y = wide_select(wide_equal(x, wide_set(0)), wide_set(-(real)INFINITY), y);
    y = wide_select(wide_less(x, wide_set(0)), wide_set((real)NAN), y);
    y = wide_select(wide_equal(x, wide_set((real)INFINITY)), x, y);
    return wide_select(wide_equal(x, x), y, x);
}

//---- reciprocal cube root ------------------------------------------------------------------------

/// (1 + d)^(-1/3) - 1 for d > -1, accurate for small d too: within 3 units of the last place where
/// |d| <= 1/2, beyond that (1 + d)^(-1/3) within 3. The isochoric factor of a strain. Any value for
/// d <= -1.
/// With u = 1 + d and h = 1 - u y^3 a better y is y (1 + h/3 + 2 h^2/9), which cubes the error. The
/// same step for z = y - 1 has h = -(d + w + d w), w = 3 z + 3 z^2 + z^3, in which nothing is lost
/// for small d; h as it stands serves the rest. First guess: the exponent divided by -3, or two
/// terms of the series where |d| < 1/10.
SN_INLINE wide wide_rcbrt_m1(wide d) {
    const real third = (real)(1.0 / 3.0), ninths = (real)(2.0 / 9.0);
    wide u = d + 1;
    wide_bits b = wide_to_bits(u);
    wide_bits b3 = (b >> 2) + (b >> 4); // b / 3 as a series of shifts
    b3 += b3 >> 4;
    b3 += b3 >> 8;
    wide y = wide_from_bits((real_bits)(SN_REAL_BITS == 64 ? 0x553ed2f1a9fbe800 : 0x54a1d5ac) - b3);
    wide h = 1 - u * (y * y * y);
    y = y + y * (h * (third + ninths * h));
    wide_mask tiny = wide_less(wide_abs(d), wide_set((real)0.1));
    wide_mask small = wide_less(wide_abs(d), wide_set((real)0.6));
    wide z = wide_select(tiny, d * (d * ninths - third), y - 1);
    for (int step = 0; step < SN_REAL_BITS / 32; step++) {
        wide w = z * (z * (z + 3) + 3);
        y = z + 1;
        h = wide_select(small, -((d + w) + d * w), 1 - u * (y * y * y));
        z = z + y * (h * (third + ninths * h));
    }
    return z;
}
