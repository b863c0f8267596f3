// Least-squares straight line, windows of it, and small normal equations.
// SPDX-License-Identifier: Apache-2.0
#include "lab/reduce/line.h"

#include <math.h>

#include "sinew/base.h"

static sn_line_fit line_of(int n, double mx, double my, double sxx, double sxy, double syy) {
    if (n < 2 || !(sxx > 0.0))
        return (sn_line_fit){(double)NAN, (double)NAN, (double)NAN, (double)NAN};
    double slope = sxy / sxx, rest = fmax(0.0, syy - slope * sxy);
    return (sn_line_fit){.slope = slope,
                         .intercept = my - slope * mx,
                         .slope_error = n > 2 ? sqrt(rest / (n - 2) / sxx) : 0.0,
                         .r_squared = syy > 0.0 ? 1.0 - rest / syy : 1.0};
}

sn_line_fit sn_line_through(int n, const double *x, const double *y) {
    double mx = 0.0, my = 0.0, sxx = 0.0, sxy = 0.0, syy = 0.0;
    for (int i = 0; i < n; ++i) {
        mx += x[i] / n;
        my += y[i] / n;
    }
    for (int i = 0; i < n; ++i) { // about the means: stretches differ little from each other
        sxx += (x[i] - mx) * (x[i] - mx);
        sxy += (x[i] - mx) * (y[i] - my);
        syy += (y[i] - my) * (y[i] - my);
    }
    return line_of(n, mx, my, sxx, sxy, syy);
}

//---- windows -------------------------------------------------------------------------------------

bool sn_line_sums_create(int rows, const double *x, const double *y, sn_line_sums *sums) {
    *sums = (sn_line_sums){.rows = rows};
    sums->sum = sn_alloc(5 * ((size_t)rows + 1), sizeof *sums->sum);
    if (!sums->sum) return false;
    for (int i = 0; i < rows; ++i) {
        sums->x0 += x[i] / rows;
        sums->y0 += y[i] / rows;
    }
    for (int i = 0; i < rows; ++i) {
        double u = x[i] - sums->x0, v = y[i] - sums->y0, *s = sums->sum + 5 * (size_t)i;
        s[5] = s[0] + u;
        s[6] = s[1] + v;
        s[7] = s[2] + u * u;
        s[8] = s[3] + u * v;
        s[9] = s[4] + v * v;
    }
    return true;
}

void sn_line_sums_release(sn_line_sums *sums) {
    sn_free(sums->sum);
    *sums = (sn_line_sums){0};
}

sn_line_fit sn_line_window(const sn_line_sums *sums, int first, int last) {
    const double *a = sums->sum + 5 * (size_t)first, *b = sums->sum + 5 * ((size_t)last + 1);
    int n = last - first + 1;
    double u = (b[0] - a[0]) / n, v = (b[1] - a[1]) / n;
    double sxx = b[2] - a[2] - n * u * u, sxy = b[3] - a[3] - n * u * v;
    double syy = fmax(0.0, b[4] - a[4] - n * v * v);
    if (sxx <= 1e-13 * (b[2] + n * u * u)) sxx = 0.0; // equal but for rounding
    return line_of(n, sums->x0 + u, sums->y0 + v, sxx, sxy, syy);
}

void sn_window_means(const sn_line_sums *sums, int first, int last, double *x, double *y) {
    const double *a = sums->sum + 5 * (size_t)first, *b = sums->sum + 5 * ((size_t)last + 1);
    int n = last - first + 1;
    *x = sums->x0 + (b[0] - a[0]) / n;
    *y = sums->y0 + (b[1] - a[1]) / n;
}

//---- normal equations ----------------------------------------------------------------------------

bool sn_normal_solve(int m, double *a, double *x) {
    for (int j = 0; j < m; ++j) {
        for (int i = j; i < m; ++i) {
            double sum = a[i * m + j];
            for (int k = 0; k < j; ++k) sum -= a[i * m + k] * a[j * m + k];
            if (i == j && !(sum > 1e-14 * a[j * m + j])) return false;
            a[i * m + j] = i == j ? sqrt(sum) : sum / a[j * m + j];
        }
    }
    for (int i = 0; i < m; ++i) {
        for (int k = 0; k < i; ++k) x[i] -= a[i * m + k] * x[k];
        x[i] /= a[i * m + i];
    }
    for (int i = m - 1; i >= 0; --i) {
        for (int k = i + 1; k < m; ++k) x[i] -= a[k * m + i] * x[k];
        x[i] /= a[i * m + i];
    }
    return true;
}
