// What sinew fit hands to its report.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/cli.h"

typedef struct fit_data {
    int count;
    const char *path[SN_FIT_CURVES_MAX];
    char sha256[SN_FIT_CURVES_MAX][65];
    sn_curve curve[SN_FIT_CURVES_MAX];
    double weight[SN_FIT_CURVES_MAX]; ///< as asked for by --weight, else 1
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
    held_out *held_out;  ///<                                       (data->count)
    double bulk_ratio;   ///< 0: incompressible
    const char *weights; ///< plain, peak or noise
    int seed;
    bool chose, chose_law; ///< the number of terms was chosen; of the law, not the memory
    sn_fit_choice choice;
} fit_outcome;

json_t *fit_json(const fit_outcome *o);
void fit_print(const fit_outcome *o);
sn_status fit_report(const char *path, const fit_outcome *o);

//---- how far the fit can be trusted: fit_details.c -----------------------------------------------

/// Adds weights, bootstrap and the choice of terms.
void fit_details_json(json_t *json, const fit_outcome *o);
void fit_details_print(const fit_outcome *o);
/// Choice of terms, bootstrap, correlations, and whether the residuals are noise, in words.
void fit_details_page(sn_report *report, const fit_outcome *o);
/// Weights of the exponentials at their times, and slope against stress of an exponential law.
void fit_details_plots(sn_report *report, const fit_outcome *o, const sn_exponentials *memory);
