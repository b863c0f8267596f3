// Least-squares straight line.
// SPDX-License-Identifier: Apache-2.0
#include "lab/reduce/line.h"

#include <math.h>

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
    if (n < 2 || !(sxx > 0.0))
        return (sn_line_fit){(double)NAN, (double)NAN, (double)NAN, (double)NAN};
    double slope = sxy / sxx, rest = fmax(0.0, syy - slope * sxy);
    return (sn_line_fit){.slope = slope,
                         .intercept = my - slope * mx,
                         .slope_error = n > 2 ? sqrt(rest / (n - 2) / sxx) : 0.0,
                         .r_squared = syy > 0.0 ? 1.0 - rest / syy : 1.0};
}
