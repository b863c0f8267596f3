// A motion or a load imposed over time.
// SPDX-License-Identifier: Apache-2.0
#include "sinew/base.h"

#include <math.h>
#include <string.h>

sn_status sn_history_create(int channels, int count, const double *time, const double *value,
                            sn_history **history) {
    *history = NULL;
    if (channels < 1 || count < 1) return sn_fail(SN_E_DATA, "a history needs at least one knot");
    for (int i = 0; i < count; i++) {
        if (!isfinite(time[i]) || (i > 0 && !(time[i] > time[i - 1])))
            return sn_fail(SN_E_DATA, "knot %d of a history: time %g s after %g s; times must rise",
                           i + 1, time[i], i > 0 ? time[i - 1] : (double)NAN);
        for (int k = 0; k < channels; k++)
            if (!isfinite(value[i * channels + k]))
                return sn_fail(SN_E_DATA, "knot %d of a history is not finite", i + 1);
    }
    sn_history *h = sn_alloc(1, sizeof *h);
    if (!h) return SN_E_MEMORY;
    h->count = count;
    h->channels = channels;
    h->time = sn_alloc((size_t)count, sizeof *h->time);
    h->value = sn_alloc((size_t)count * (size_t)channels, sizeof *h->value);
    if (!h->time || !h->value) {
        sn_history_destroy(h);
        return SN_E_MEMORY;
    }
    memcpy(h->time, time, (size_t)count * sizeof *time);
    memcpy(h->value, value, (size_t)count * (size_t)channels * sizeof *value);
    *history = h;
    return SN_OK;
}

sn_status sn_history_copy(const sn_history *h, sn_history **copy) {
    *copy = NULL;
    if (!h) return SN_OK;
    return sn_history_create(h->channels, h->count, h->time, h->value, copy);
}

void sn_history_destroy(sn_history *history) {
    if (!history) return;
    sn_free(history->time);
    sn_free(history->value);
    sn_free(history);
}

// index of the first knot strictly after t; count when there is none
static int knot_after(const sn_history *h, double t) {
    int low = 0, high = h->count;
    while (low < high) {
        int middle = low + (high - low) / 2;
        if (h->time[middle] > t)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

void sn_history_at(const sn_history *history, double t, double *value) {
    if (!history) {
        value[0] = 1.0;
        return;
    }
    int channels = history->channels, next = knot_after(history, t);
    int before = next > 0 ? next - 1 : 0, after = next < history->count ? next : history->count - 1;
    double span = history->time[after] - history->time[before];
    double w = span > 0 ? (t - history->time[before]) / span : 0.0;
    const double *a = history->value + before * channels, *b = history->value + after * channels;
    for (int k = 0; k < channels; k++) value[k] = w > 0 ? a[k] + w * (b[k] - a[k]) : a[k];
}

double sn_history_next(const sn_history *history, double t) {
    if (!history) return INFINITY;
    int next = knot_after(history, t);
    return next < history->count ? history->time[next] : (double)INFINITY;
}
