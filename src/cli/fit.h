// What sinew fit hands to its report.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/cli.h"

typedef struct fit_data {
    int count;
    const char *path[SN_FIT_CURVES_MAX];
    char sha256[SN_FIT_CURVES_MAX][65];
    sn_curve curve[SN_FIT_CURVES_MAX];
} fit_data;

/// A curve predicted from a fit of the others.
typedef struct held_out {
    sn_tissue tissue;
    sn_fit_curve prediction;
} held_out;

typedef struct fit_outcome {
    fit_data *data;
    sn_fit_result *fit;
    bool fitted, has_held_out;
    held_out *held_out; ///<                                       (data->count)
    double bulk_ratio;  ///< 0: incompressible
} fit_outcome;

json_t *fit_json(const fit_outcome *o);
void fit_print(const fit_outcome *o);
sn_status fit_report(const char *path, const fit_outcome *o);
