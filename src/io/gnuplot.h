// Runs gnuplot as a program of its own: text in, SVG out.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "io/buffer.h"

/// Runs the script. No shell is involved, and no start-up file of the user is read.
/// @param svg     the figure, from its XML head to </svg>
/// @param reason  why there is none, for a reader of the page; empty where there is one
/// @return true where there is a figure
bool sn_gnuplot_run(const sn_buffer *script, sn_buffer *svg, char reason[SN_TEXT_MAX]);
/// Adds a text as a gnuplot string: single quotes, in which gnuplot expands nothing.
void sn_gnuplot_quote(sn_buffer *script, const char *text);
/// Copies the <svg> element into a page: every id and every reference to one gets `prefix`, so that
/// figures of one page do not share marks; gnuplot's own titles (with its version) are left out.
/// @param label  read to those who do not see the figure
void sn_gnuplot_inline(sn_buffer *page, const sn_buffer *svg, const char *prefix,
                       const char *label);
