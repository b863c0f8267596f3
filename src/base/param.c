// Parameter tables: offsets, defaults, checks; suggestions for misspelt names.
// SPDX-License-Identifier: Apache-2.0
#include "sinew/base.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

int sn_param_length(const sn_param *param, int terms) {
    if (param->length == SN_PARAM_LIST) return terms;
    return param->length > 1 ? param->length : 1;
}

int sn_param_offset(const sn_param *params, int k, int terms) {
    int offset = 0;
    for (int i = 0; i < k; i++) offset += sn_param_length(&params[i], terms);
    return offset;
}

int sn_param_find(const sn_param *params, int count, const char *name) {
    for (int k = 0; k < count; k++)
        if (strcmp(params[k].name, name) == 0) return k;
    return -1;
}

void sn_param_defaults(const sn_param *params, int count, int terms, double *values) {
    for (int k = 0; k < count; k++)
        for (int i = 0; i < sn_param_length(&params[k], terms); i++) *values++ = params[k].init;
}

static bool in_range(const sn_param *param, double value) {
    if (isnan(value)) return false;
    if (isinf(value)) return value > 0 && param->infinity;
    bool above = param->min_open ? value > param->min : value >= param->min;
    bool below = param->max_open ? value < param->max : value <= param->max;
    return above && below;
}

// "more than 0 Pa", "from -1 to below 0.5", …
static void range_text(const sn_param *param, char *text, size_t size) {
    const char *unit = strcmp(param->unit, "1") == 0 ? "" : param->unit;
    char low[64] = "", high[64] = "";
    if (isfinite(param->min))
        snprintf(low, sizeof low, "%s %g", param->min_open ? "more than" : "at least", param->min);
    if (isfinite(param->max))
        snprintf(high, sizeof high, "%s %g", param->max_open ? "less than" : "at most", param->max);
    snprintf(text, size, "%s%s%s%s%s%s%s", low, *low && *high ? " and " : "", high,
             *unit ? " " : "", unit, param->infinity ? " or " : "",
             param->infinity ? param->infinity : "");
}

sn_status sn_param_check(const sn_param *params, int count, int terms, const double *values,
                         const char *owner) {
    for (int k = 0; k < count; k++) {
        for (int i = 0; i < sn_param_length(&params[k], terms); i++, values++) {
            if (in_range(&params[k], *values)) continue;
            char range[160];
            range_text(&params[k], range, sizeof range);
            if (isnan(*values))
                return sn_fail(SN_E_RANGE, "%s: %s is missing: expected %s", owner, params[k].name,
                               range);
            return sn_fail(SN_E_RANGE, "%s: %s is %g%s%s: expected %s", owner, params[k].name,
                           *values, strcmp(params[k].unit, "1") == 0 ? "" : " ",
                           strcmp(params[k].unit, "1") == 0 ? "" : params[k].unit, range);
        }
    }
    return SN_OK;
}

#define WORD_MAX 48

// Damerau-Levenshtein distance (adjacent swaps cost one), letters compared without case.
static int distance(const char *a, const char *b) {
    int n = (int)strlen(a), m = (int)strlen(b);
    if (n >= WORD_MAX || m >= WORD_MAX) return WORD_MAX;
    int d[WORD_MAX][WORD_MAX];
    for (int i = 0; i <= n; i++) d[i][0] = i;
    for (int j = 0; j <= m; j++) d[0][j] = j;
    for (int i = 1; i <= n; i++) {
        for (int j = 1; j <= m; j++) {
            int same = tolower((unsigned char)a[i - 1]) == tolower((unsigned char)b[j - 1]);
            int best = d[i - 1][j - 1] + !same;
            if (d[i - 1][j] + 1 < best) best = d[i - 1][j] + 1;
            if (d[i][j - 1] + 1 < best) best = d[i][j - 1] + 1;
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] &&
                d[i - 2][j - 2] + 1 < best)
                best = d[i - 2][j - 2] + 1;
            d[i][j] = best;
        }
    }
    return d[n][m];
}

const char *sn_suggest(const char *word, const char *const *names, int count) {
    const char *best = NULL;
    int length = (int)strlen(word), best_distance = (length + 2) / 3 + 1;
    for (int k = 0; k < count; k++) {
        int d = distance(word, names[k]);
        if (d < best_distance) {
            best_distance = d;
            best = names[k];
        }
    }
    return best;
}
