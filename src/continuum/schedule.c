// The times a run lands on, and how long its steps are to be between them.
// SPDX-License-Identifier: Apache-2.0
#include "continuum/schedule.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define CORNER 0.2     // change of slope, of the largest slope, that makes a corner
#define RAMP_PART 20.0 // first step after a corner: this part of an interval
#define JUMP_PART 1e3  // the same after a jump
#define SAME_TIME 1e-9 // of `until`: two times that are one

static double slope_change(const sn_history *h, int knot) {
    double square = 0.0;
    for (int k = 0; k < h->channels; k++) {
        double slope[2] = {0.0, 0.0}; // before and after
        for (int side = 0; side < 2; side++) {
            int from = knot - 1 + side;
            if (from < 0 || from + 1 >= h->count) continue;
            slope[side] =
                (h->value[(from + 1) * h->channels + k] - h->value[from * h->channels + k]) /
                (h->time[from + 1] - h->time[from]);
        }
        square += (slope[1] - slope[0]) * (slope[1] - slope[0]);
    }
    return sqrt(square);
}

static double largest_slope(const sn_history *h) {
    double largest = 0.0;
    for (int from = 0; from + 1 < h->count; from++) {
        double square = 0.0;
        for (int k = 0; k < h->channels; k++) {
            double rise = h->value[(from + 1) * h->channels + k] - h->value[from * h->channels + k];
            square += rise * rise;
        }
        largest = fmax(largest, sqrt(square) / (h->time[from + 1] - h->time[from]));
    }
    return largest;
}

static int history_count(const sn_case *c) {
    return c->load_count + 2 * c->tool_count;
}

static const sn_history *history_of(const sn_case *c, int k) {
    if (k < c->load_count) return c->load[k].factor;
    const sn_tool *tool = &c->tool[(k - c->load_count) / 2];
    return (k - c->load_count) % 2 ? tool->turn : tool->path;
}

static void add_knots(const sn_case *c, sn_fe_schedule *s) {
    for (int k = 0; k < history_count(c); k++) {
        const sn_history *h = history_of(c, k);
        double largest = h ? largest_slope(h) : 0.0;
        for (int n = 0; h && n < h->count; n++) {
            if (!(h->time[n] > 0.0) || h->time[n] >= c->until) continue;
            s->stop[s->count++] =
                (sn_fe_stop){.time = h->time[n], .corner = slope_change(h, n) > CORNER * largest};
        }
    }
}

static int compare_stops(const void *a, const void *b) {
    const sn_fe_stop *x = a, *y = b;
    return (x->time > y->time) - (x->time < y->time);
}

// Sorts the stops and makes one of those that are at one time.
static void merge(sn_fe_schedule *s, double until) {
    int kept = 0;
    qsort(s->stop, (size_t)s->count, sizeof *s->stop, compare_stops);
    for (int k = 1; k < s->count; k++) {
        sn_fe_stop *last = s->stop + kept;
        if (s->stop[k].time - last->time <= SAME_TIME * until) {
            last->output |= s->stop[k].output;
            last->corner |= s->stop[k].corner;
        } else {
            s->stop[++kept] = s->stop[k];
        }
    }
    s->count = kept + 1;
    s->stop[kept].time = until;
}

// Whether something acts at once at time 0.
static bool starts_with_jump(const sn_case *c) {
    bool jump = c->gravity[0] != 0.0 || c->gravity[1] != 0.0 || c->gravity[2] != 0.0;
    for (int k = 0; k < c->load_count; k++) {
        double factor = 1.0;
        sn_history_at(c->load[k].factor, 0.0, &factor);
        jump |= factor != 0.0;
    }
    return jump;
}

static void grade(const sn_case *c, sn_fe_schedule *s) {
    double before = (double)INFINITY;
    for (int k = 0; k + 1 < s->count; k++) {
        if (!s->stop[k].corner) continue;
        int next = k + 1;
        while (next + 1 < s->count && !s->stop[next].corner) next++;
        double after = s->stop[next].time - s->stop[k].time;
        bool jump = k == 0 && starts_with_jump(c);
        s->stop[k].first = fmin(before, after) / (jump ? JUMP_PART : RAMP_PART);
        s->shortest = fmin(s->shortest, s->stop[k].first);
        before = after;
    }
}

sn_status sn_fe_schedule_create(const sn_case *c, bool remembers, sn_fe_schedule *out) {
    double every = c->output_every > 0.0 ? c->output_every : c->until;
    double outputs = floor(c->until / every * (1.0 + SAME_TIME));
    size_t most = 2;
    *out = (sn_fe_schedule){0};
    if (!(c->until > 0.0) || !isfinite(c->until))
        return sn_fail(SN_E_DEFINITION, "time: until must be positive, found %g s", c->until);
    if (outputs > 1e7)
        return sn_fail(SN_E_DEFINITION,
                       "time: output_every %g s gives more than 1e7 outputs in %g s", every,
                       c->until);
    for (int k = 0; k < history_count(c); k++)
        most += history_of(c, k) ? (size_t)history_of(c, k)->count : 0;
    sn_fe_schedule s = {.longest = c->until / (c->continuum.steps > 0 ? c->continuum.steps : 1)};
    if (c->continuum.step > 0.0) s.longest = fmin(c->continuum.step, c->until);
    s.shortest = s.longest;
    s.stop = sn_alloc(most + (size_t)outputs, sizeof *s.stop);
    if (!s.stop) return SN_E_MEMORY;
    s.stop[s.count++] = (sn_fe_stop){.time = 0.0, .output = true, .corner = true};
    for (int k = 1; k <= (int)outputs; k++)
        s.stop[s.count++] = (sn_fe_stop){.time = fmin(k * every, c->until), .output = true};
    s.stop[s.count++] = (sn_fe_stop){.time = c->until, .output = true};
    add_knots(c, &s);
    merge(&s, c->until);
    for (int k = 0; k < s.count; k++) s.stop[k].first = (double)INFINITY;
    if (remembers) grade(c, &s);
    *out = s;
    return SN_OK;
}

void sn_fe_schedule_free(sn_fe_schedule *s) {
    sn_free(s->stop);
    *s = (sn_fe_schedule){0};
}

double sn_fe_schedule_step(const sn_fe_schedule *s, int next, double time, double wish) {
    double left = s->stop[next].time - time, most = fmin(wish, s->longest);
    return left / fmax(1.0, ceil(left / most - 1e-6));
}
