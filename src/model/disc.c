// A disc of triangles, and the cylinder of tetrahedra over it.
// SPDX-License-Identifier: Apache-2.0
//
// Rings of 6, 12, 18, … points make nearly equilateral triangles until `around` is reached; beyond,
// all rings have `around` points. Where `around` is more than 6 radial, the rings grow evenly up to
// it. Two neighbouring rings are sewn together like a zip: from the seam on the x axis, whichever
// ring has its next point first takes the next triangle. A triangle with its edge on the outer ring
// (radius r, n points) is turned the right way as long as the chord stays outside the inner ring,
// cos(pi/n) > (r-1)/r, which all these counts keep; with equal counts the rings are aligned and the
// triangles are halves of trapezoids.
//
// A prism over the triangle a < b < c (numbers of its points) is cut along the walk from the low a
// to the high c: the diagonal on each side runs from the smaller number up to the larger, the same
// seen from both prisms. In the mirrored pattern odd layers stand on their heads.
#include <math.h>
#include <stdint.h>

#include "model/disc.h"

int sn_disc_ring(int radial, int around, int r) {
    if (r == 0) return 1;
    int64_t even = ((int64_t)around * r + radial / 2) / radial, six = 6 * (int64_t)r;
    int64_t count = even > six ? even : six;
    return (int)(count < around ? count : around);
}

double sn_disc_point_count(int radial, int around) {
    double count = 0;
    for (int r = 0; r <= radial; r++) count += sn_disc_ring(radial, around, r);
    return count;
}

double sn_disc_triangle_count(int radial, int around) {
    double count = sn_disc_ring(radial, around, 1);
    for (int r = 2; r <= radial; r++)
        count += (double)sn_disc_ring(radial, around, r - 1) + sn_disc_ring(radial, around, r);
    return count;
}

// Sews the ring of n points from `first` to the ring of m points that follows it.
static int *sew(int first, int n, int m, int *out) {
    int outer = first + n;
    int i = 0, o = 0;
    while (i < n || o < m) {
        // the next inner point stands at (i+1)/n of the turn, the next outer one at (o+1)/m
        bool take_outer = o < m && (i == n || (int64_t)(o + 1) * n <= (int64_t)(i + 1) * m);
        *out++ = first + i % n;
        *out++ = outer + o % m;
        if (take_outer)
            *out++ = outer + ++o % m;
        else
            *out++ = first + ++i % n;
    }
    return out;
}

void sn_disc_cut(int radial, int around, double *point, int *triangle) {
    int first = 0;
    for (int r = 0; r <= radial; r++) {
        int n = sn_disc_ring(radial, around, r);
        for (int a = 0; a < n; a++) {
            double angle = 2 * 3.14159265358979323846 * a / n, radius = (double)r / radial;
            *point++ = radius * cos(angle);
            *point++ = radius * sin(angle);
        }
        if (r == 1)
            for (int a = 0; a < n; a++) {
                *triangle++ = 0;
                *triangle++ = 1 + a;
                *triangle++ = 1 + (a + 1) % n;
            }
        if (r > 1) {
            int inner = sn_disc_ring(radial, around, r - 1);
            triangle = sew(first - inner, inner, n, triangle);
        }
        first += n;
    }
}

void sn_disc_extrude(int points, int triangles, const int *triangle, int layers, bool mirrored,
                     int *cell) {
    for (int k = 0; k < layers; k++) {
        int low = points * k, high = points * (k + 1);
        if (mirrored && k % 2) {
            low = high;
            high = points * k;
        }
        for (int t = 0; t < triangles; t++) {
            int p[3] = {triangle[3 * (size_t)t], triangle[3 * (size_t)t + 1],
                        triangle[3 * (size_t)t + 2]};
            for (int i = 0; i < 2; i++)
                for (int j = 0; j < 2 - i; j++)
                    if (p[j] > p[j + 1]) {
                        int swap = p[j];
                        p[j] = p[j + 1];
                        p[j + 1] = swap;
                    }
            // a a' … : after m + 1 low nodes the high ones follow from the same point on
            for (int m = 0; m < 3; m++) {
                for (int i = 0; i <= m; i++) *cell++ = low + p[i];
                for (int i = m; i < 3; i++) *cell++ = high + p[i];
            }
        }
    }
}
