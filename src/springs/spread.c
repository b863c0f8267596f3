// Where a search for the highest frequency of a cut body starts from.
// SPDX-License-Identifier: Apache-2.0
//
// A search that goes on from the mode it found last sees that mode's surroundings and no more: its
// vector falls to nothing some cells away. What cuts leave hangs by few cells or is apart, and may
// stiffen by itself to several times what is followed.
//
// So the vector of a cut body keeps weight everywhere. Nodes stand in the order of a space-filling
// curve; every PATCH of them has a part of the vector: its own mode of highest frequency as far as
// all searches before have found it, which is the last power A^k v of a search, at a length that
// rises steeply with the growth |A^k v| / |A^(k-1) v| there. A motion without structure comes on
// top, so that nothing is lost inside a patch. All this takes no product beside those of the
// search.
#include <math.h>

#include "springs/steps.h"
#include "springs/vectors.h"

enum { PATCH = 32, SIZE = 3 * PATCH }; // nodes, numbers
static const double share = 0.3;       // of all patches, beside a mode of length 1
static const double unrest = 0.03;     // of the motion without structure, of a patch

static double length(const double *x, size_t n) {
    return sqrt(sn_dot(x, x, n));
}

void sn_lanczos_stir(const sn_net *net, double *mode) {
    const size_t n = 3 * (size_t)net->nodes;
    const double was = length(mode, n), part = share * sqrt(12 / (double)n);
    uint64_t noise = SN_NOISE_START;
    for (size_t k = 0; k < n; k++)
        mode[k] = (was > 0 ? mode[k] / was : 0) + part * sn_noise(&noise);
}

// x <- T x
static void multiply(const sn_lanczos *l, double *x) {
    double before = 0;
    for (int j = 0; j < l->steps; j++) {
        const double own = x[j];
        x[j] = l->diagonal[j] * own + (j > 0 ? l->beside[j - 1] * before : 0) +
               (j + 1 < l->steps ? l->beside[j] * x[j + 1] : 0);
        before = own;
    }
}

// A^(steps-1) v and A^(steps-2) v in place of the first two vectors of the basis
static void take_powers(const sn_lanczos *l, size_t n, double *basis) {
    double last[SN_LANCZOS_MAX], before[SN_LANCZOS_MAX] = {1};
    for (int turn = 2; turn < l->steps; turn++) multiply(l, before);
    for (int j = 0; j < SN_LANCZOS_MAX; j++) last[j] = before[j];
    multiply(l, last);
    for (size_t k = 0; k < n; k++) {
        double a = 0, b = 0;
        for (int j = 0; j < l->steps; j++) {
            a += last[j] * basis[(size_t)j * n + k];
            b += before[j] * basis[(size_t)j * n + k];
        }
        basis[k] = a;
        basis[n + k] = b;
    }
}

static double square(double x) {
    return x * x;
}

void sn_lanczos_spread(const sn_net *net, const sn_frequency_call *call, const sn_lanczos *l) {
    const size_t n = 3 * (size_t)net->nodes;
    double *last = call->basis, *before = last + n, *growth = before + n; // growth: of patches
    double most = 0, sum = 0;
    uint64_t noise = SN_NOISE_START;
    if (l->steps < 2) return; // nothing moves
    take_powers(l, n, call->basis);
    for (size_t p = 0, k = 0; k < n; p++, k += SIZE) {
        const size_t size = n - k < SIZE ? n - k : SIZE;
        const double was = length(before + k, size);
        growth[p] = was > 0 ? length(last + k, size) / was : 0;
        most = fmax(most, growth[p]);
    }
    if (!(most > 0) || !isfinite(most)) return;
    for (size_t p = 0; p * SIZE < n; p++) sum += square(square(square(growth[p] / most)));
    for (size_t p = 0, k = 0; k < n; p++, k += SIZE) {
        const size_t size = n - k < SIZE ? n - k : SIZE;
        const double weight = share * square(square(growth[p] / most)) / sqrt(sum);
        const double own = length(last + k, size);
        for (size_t i = 0; i < size && own > 0; i++)
            call->mode[k + i] += weight * (last[k + i] / own + unrest * sn_noise(&noise));
    }
}
