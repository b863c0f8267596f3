// Orders for qsort().
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Whole numbers, rising.
static inline int compare_int(const void *a, const void *b) {
    int x = *(const int *)a, y = *(const int *)b;
    return (x > y) - (x < y);
}
