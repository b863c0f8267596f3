// Fuzz target: measured curves, from the file to stretch and nominal stress.
// SPDX-License-Identifier: Apache-2.0
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    sn_record *record = NULL;
    sn_curve curve = {0};
    sn_status status = sn_curve_read(fuzz_file("input.csv", data, size), &record);
    if (status != SN_OK) {
        fuzz_check_error(status, "input.csv");
        return 0;
    }
    for (int k = 0; k < record->series_count; k++)
        fuzz_check_finite(record->series[k].value, record->rows);
    status = sn_curve_from_record(record, &curve);
    if (status != SN_OK) fuzz_check_error(status, "input.csv");
    if (status == SN_OK) {
        fuzz_check_finite(curve.stretch, curve.count);
        fuzz_check_finite(curve.stress, curve.count);
    }
    sn_curve_release(&curve);
    sn_record_destroy(record);
    return 0;
}
