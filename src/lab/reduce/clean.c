// Rows out of order, rows at one time, gaps.
// SPDX-License-Identifier: Apache-2.0
//
// What is an accident. A logger that flushes its buffers out of turn swaps neighbours, now and
// then; a file that holds two records one after the other, or was sorted by another column, is a
// different thing, and to sort it would mix what does not belong together. So rows are put back
// where each must move by at most NEAR places and at most one row in a hundred must (one in a
// record of 20 rows or more); anything else is refused with the row.
#include "lab/reduce/clean.h"

#include <math.h>

#include "lab/reduce/signal.h"

enum { NEAR = 5, ONE_IN = 100, ROWS_MIN = 20, COLUMNS_MAX = 8 };
static const double gap = 10.0; // times the intervals before and after

// the columns of the curve that there are
static int columns_of(sn_curve *c, double **column) {
    double *all[] = {c->time, c->stretch, c->stress, c->stretch_2, c->stress_2};
    int count = 0;
    for (int k = 0; k < (int)(sizeof all / sizeof *all); ++k)
        if (all[k]) column[count++] = all[k];
    return count;
}

// a row moves up to its place, those between go down by one
static void move_row(int columns, double *const *column, int from, int to) {
    for (int k = 0; k < columns; ++k) {
        double value = column[k][from];
        for (int i = from; i > to; --i) column[k][i] = column[k][i - 1];
        column[k][to] = value;
    }
}

// a row that came after later ones
typedef struct late_row {
    int row;
    double before, time;
} late_row;

static sn_status refuse(const sn_curve *c, const late_row *late, int allowed) {
    return sn_fail(SN_E_DATA,
                   "%s: row %d: time goes back from %g s to %g s: expected rising times; of its "
                   "%d rows %d may come up to %d rows late; split a file of several records",
                   c->name, late->row + 1, late->before, late->time, c->count, allowed, (int)NEAR);
}

static sn_status put_back(sn_curve *c, int columns, double *const *column) {
    int moved = 0, allowed = c->count < ROWS_MIN ? 0 : (c->count + ONE_IN - 1) / ONE_IN;
    late_row first = {0};
    for (int i = 1; i < c->count; ++i) {
        if (!(c->time[i] < c->time[i - 1])) continue;
        late_row late = {i, c->time[i - 1], c->time[i]};
        if (moved++ == 0) first = late;
        if (moved > allowed) return refuse(c, &first, allowed);
        int to = i - 1;
        while (to > 0 && c->time[i] < c->time[to - 1] && i - to < NEAR) --to;
        if (to > 0 && c->time[i] < c->time[to - 1]) return refuse(c, &late, allowed);
        move_row(columns, column, i, to);
    }
    if (moved > 0)
        sn_remark(c->remarks, sizeof c->remarks,
                  "%d row(s) out of the order of time put back, the first row %d", moved,
                  first.row + 1);
    return SN_OK;
}

static void drop_repeats(sn_curve *c, int columns, double *const *column) {
    int kept = 1;
    for (int i = 1; i < c->count; ++i) {
        if (c->time[i] == c->time[kept - 1]) continue;
        for (int k = 0; k < columns; ++k) column[k][kept] = column[k][i];
        ++kept;
    }
    int repeats = c->count - kept;
    c->count = kept;
    c->discarded += repeats;
    if (repeats > 0)
        sn_remark(c->remarks, sizeof c->remarks, "%d row(s) at the time of the row before left out",
                  repeats);
}

// rows that are missing: an interval far longer than those before and after it
static void say_gaps(sn_curve *c) {
    int gaps = 0, longest = 0;
    for (int i = 2; i + 1 < c->count; ++i) {
        double here = c->time[i] - c->time[i - 1];
        if (here <= gap * (c->time[i - 1] - c->time[i - 2])) continue;
        if (here <= gap * (c->time[i + 1] - c->time[i])) continue;
        if (!gaps || here > c->time[longest] - c->time[longest - 1]) longest = i;
        ++gaps;
    }
    if (gaps > 0)
        sn_remark(c->remarks, sizeof c->remarks,
                  "%d gap(s) in time, the longest of %.4g s from %.6g s on", gaps,
                  c->time[longest] - c->time[longest - 1], c->time[longest - 1]);
}

sn_status sn_curve_clean(sn_curve *curve) {
    if (!curve->time || curve->count < 2) return SN_OK;
    double *column[COLUMNS_MAX];
    int columns = columns_of(curve, column);
    SN_TRY(put_back(curve, columns, column));
    drop_repeats(curve, columns, column);
    say_gaps(curve);
    return SN_OK;
}
