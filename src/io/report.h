// A report in the making, as the files of io/ that add to it see it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "io/buffer.h"
#include "sinew/io.h"

struct sn_report {
    sn_buffer page;
    int figures, tables;
    bool has_bodies; ///< the page needs the script that draws them
};

/// "<figcaption>Figure N. caption</figcaption>" and the end of the figure.
void sn_report_end_figure(sn_report *report, const char *caption);
/// A boxed note in place of what could not be drawn: why, and what to do.
void sn_report_missing(sn_report *report, const char *format, ...) SN_PRINTF(2, 3);

/// The script that draws bodies, line after line, NULL at the end.
extern const char *const sn_body_script[];
