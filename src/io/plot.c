// Plots of a report, drawn by gnuplot as SVG.
// SPDX-License-Identifier: Apache-2.0
//
// The axes are ours, so that a legend can be put where no line runs, decades can be labelled 10ⁿ
// with gnuplot's markup switched off (labels are the user's text), and points that nobody can tell
// apart need not be drawn. A value that is not finite, or not positive on a logarithmic axis, is
// left out: a line has a gap there.
//
// Source of the colours: Okabe & Ito, Color Universal Design (2008), without yellow, which does not
// show on white; grey takes its place.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "io/gnuplot.h"
#include "io/report.h"

#define WIDTH 720
#define HEIGHT 420
#define NEAR (1.0 / 3000) // of an axis: a third of a pixel at twice the size
#define DENSE 150         // points of a line from where on they are drawn as dots
#define FALLBACK_ROWS 24  // of the table that replaces a figure

static const char *const colour[8] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                      "#e69f00", "#56b4e9", "#000000", "#7f7f7f"};
static const int marker[8] = {6, 4, 8, 12, 10, 7, 5, 9};

typedef struct axis {
    bool log;
    double low, high;
} axis;

typedef struct figure {
    const sn_plot *plot;
    axis x, y;
    double gap;               // least between bars, along x; in decades on a logarithmic axis
    int bars, labels, widest; // labels: how many, and the most characters of one
} figure;

//---- axes ----------------------------------------------------------------------------------------

static bool drawable(const figure *f, double x, double y) {
    return isfinite(x) && isfinite(y) && (!f->x.log || x > 0) && (!f->y.log || y > 0);
}

// How far two values of an axis are apart; in decades on a logarithmic one.
static double apart(const axis *a, double x, double y) {
    return a->log ? fabs(log10(x / y)) : fabs(x - y);
}

// The place of a value along an axis: 0 at its low end, 1 at its high end.
static double along(const axis *a, double value) {
    if (a->log) return log(value / a->low) / log(a->high / a->low);
    return (value - a->low) / (a->high - a->low);
}

// Widens an axis at both ends by shares of its length.
static void widen(axis *a, double below, double above) {
    if (a->log) {
        double decades = log10(a->high) - log10(a->low);
        a->low *= pow(10, -below * decades);
        a->high *= pow(10, above * decades);
    } else {
        double length = a->high - a->low;
        a->low -= below * length;
        a->high += above * length;
    }
}

// An axis of one value gets a length around it.
static void open_axis(axis *a) {
    double size = fmax(fabs(a->low), fabs(a->high));
    if (a->high - a->low > 1e-9 * size) return;
    if (a->log) {
        a->low /= 2;
        a->high *= 2;
    } else {
        a->low -= size > 0 ? 0.1 * size : 1;
        a->high += size > 0 ? 0.1 * size : 1;
    }
}

static int characters(const char *text) {
    int count = 0;
    for (; *text; text++) count += ((unsigned char)*text & 0xC0) != 0x80;
    return count;
}

static bool is_labelled(const sn_line *line) {
    return line->label && *line->label;
}

// Smallest and largest drawable values. @return false where there is nothing to draw.
static bool measure(figure *f) {
    f->x.low = f->y.low = f->gap = HUGE_VAL;
    f->x.high = f->y.high = -HUGE_VAL;
    for (int k = 0; k < f->plot->line_count; k++) {
        const sn_line *line = &f->plot->line[k];
        bool bars = line->style == SN_BARS;
        double before = nan("");
        for (int i = 0; i < line->count; i++) {
            if (!drawable(f, line->x[i], line->y[i])) continue;
            f->x.low = fmin(f->x.low, line->x[i]);
            f->x.high = fmax(f->x.high, line->x[i]);
            f->y.low = fmin(f->y.low, line->y[i]);
            f->y.high = fmax(f->y.high, line->y[i]);
            if (bars && line->x[i] != before)
                f->gap = fmin(f->gap, apart(&f->x, line->x[i], before));
            before = line->x[i];
        }
        f->bars += bars;
        f->labels += is_labelled(line);
        if (is_labelled(line)) f->widest = (int)fmax(f->widest, characters(line->label));
    }
    return f->x.low <= f->x.high;
}

static bool has_lines(const sn_plot *plot) {
    for (int k = 0; k < plot->line_count; k++)
        if (plot->line[k].style == SN_LINE || plot->line[k].style == SN_DASHED) return true;
    return false;
}

// Lines run from edge to edge, marks and bars get room; what grows from nothing stands on zero.
static void choose_axes(figure *f) {
    if (!isfinite(f->gap)) f->gap = 1; // one bar
    if (f->x.log) f->gap = fmin(f->gap, 0.15);
    if (f->bars && f->x.log) {
        f->x.low *= pow(10, -0.6 * f->gap);
        f->x.high *= pow(10, 0.6 * f->gap);
    } else if (f->bars) {
        f->x.low -= 0.6 * f->gap;
        f->x.high += 0.6 * f->gap;
    }
    if (f->bars && !f->y.log) {
        f->y.low = fmin(f->y.low, 0);
        f->y.high = fmax(f->y.high, 0);
    }
    bool near_zero = f->x.low > 0 && f->x.low < 0.03 * f->x.high;
    if (near_zero && !f->x.log && has_lines(f->plot)) f->x.low = 0;
    open_axis(&f->x);
    open_axis(&f->y);
    if (!f->bars && !has_lines(f->plot)) widen(&f->x, 0.03, 0.03);
    double low = f->y.low, high = f->y.high;
    widen(&f->y, 0.05, 0.06);
    if (f->y.log) return;
    if (low >= 0 && low < 0.3 * (high - low)) f->y.low = 0;
    if (high <= 0 && -high < 0.3 * (high - low)) f->y.high = 0;
}

// "10⁻³", or "0.001" where all decades of the axis are that handy.
static void print_decade(sn_buffer *out, int exponent, bool plain) {
    static const char *const raised[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    if (plain) {
        sn_buffer_print(out, "'%.*f'", exponent < 0 ? -exponent : 0, pow(10, exponent));
        return;
    }
    char digits[16];
    snprintf(digits, sizeof digits, "%d", exponent);
    sn_buffer_text(out, "'10");
    for (const char *at = digits; *at; at++)
        sn_buffer_text(out, *at == '-' ? "⁻" : raised[*at - '0']);
    sn_buffer_text(out, "'");
}

// Range and, on a logarithmic axis of at least two decades, its marks.
static void add_axis(sn_buffer *out, const axis *a, char name) {
    sn_buffer_print(out, "set %crange [%.17g:%.17g]\n", name, a->low, a->high);
    if (!a->log) return;
    sn_buffer_print(out, "set logscale %c 10\n", name);
    int first = (int)ceil(log10(a->low) - 1e-9), last = (int)floor(log10(a->high) + 1e-9);
    if (last <= first) return;
    int step = (last - first) / 8 + 1;
    bool plain = first >= -3 && last <= 4;
    const char *comma = "";
    sn_buffer_print(out, "set %ctics (", name);
    for (int e = first - 1; e <= last; e++) {
        double decade = pow(10, e);
        if (e >= first && (e - first) % step == 0) {
            sn_buffer_text(out, comma);
            print_decade(out, e, plain);
            sn_buffer_print(out, " %.17g", decade);
            comma = ",";
        }
        for (int k = 2; k <= 9 && step == 1; k++)
            if (k * decade >= a->low && k * decade <= a->high) {
                sn_buffer_print(out, "%s'' %.17g 1", comma, k * decade);
                comma = ",";
            }
    }
    sn_buffer_text(out, ")\n");
}

//---- legend --------------------------------------------------------------------------------------

// How much of the lines runs through a box, in samples about 1/100 of the figure apart.
static long crowd(const figure *f, double x0, double x1, double y0, double y1) {
    long inside = 0;
    for (int k = 0; k < f->plot->line_count; k++) {
        const sn_line *line = &f->plot->line[k];
        bool joined = line->style != SN_POINTS && line->style != SN_BARS, before = false;
        // a bar has a width, and fills what is below its top
        double half = line->style == SN_BARS ? 0.5 * f->gap / apart(&f->x, f->x.high, f->x.low) : 0;
        double px = 0, py = 0;
        for (int i = 0; i < line->count; i++) {
            bool draw = drawable(f, line->x[i], line->y[i]);
            double x = draw ? along(&f->x, line->x[i]) : 0, y = draw ? along(&f->y, line->y[i]) : 0;
            int steps = 1;
            if (joined && before) steps = 1 + (int)(100 * fmin(hypot(x - px, y - py), 2));
            for (int s = 1; draw && s <= steps; s++) {
                double part = (double)s / steps;
                double sx = before ? px + part * (x - px) : x,
                       sy = before ? py + part * (y - py) : y;
                if (line->style == SN_BARS) sy = fmin(sy, y1);
                inside += sx >= x0 - half && sx <= x1 + half && sy >= y0 && sy <= y1;
            }
            before = draw && joined;
            px = x;
            py = y;
        }
    }
    return inside;
}

// A corner that no line enters (0 … 3), or -1: under the plot.
static int choose_corner(const figure *f) {
    double width = (f->widest * 7.0 + 70) / (WIDTH - 100);
    double height = (f->labels * 18.0 + 16) / (HEIGHT - 110);
    for (int k = 0; k < 4 && width < 0.75 && height < 0.6; k++) {
        double x0 = k % 2 ? 0 : 1 - width, y0 = k < 2 ? 1 - height : 0;
        if (!crowd(f, x0, x0 + width, y0, y0 + height)) return k;
    }
    return -1;
}

// Legend, and the size of the figure: rows under the plot make it higher.
static void add_legend(sn_buffer *out, const figure *f) {
    static const char *const corners[4] = {"right top", "left top", "right bottom", "left bottom"};
    int height = HEIGHT, corner = f->labels ? choose_corner(f) : 0;
    if (corner < 0) {
        int columns = (WIDTH - 80) / (f->widest * 7 + 60);
        height += 18 * (1 + (f->labels - 1) / (columns > 1 ? columns : 1));
    }
    sn_buffer_print(out, "set terminal svg noenhanced size %d,%d fixed font 'Helvetica,13'\n",
                    WIDTH, height);
    if (!f->labels) {
        sn_buffer_text(out, "unset key\n");
        return;
    }
    sn_buffer_print(out, "set key noenhanced samplen 2 spacing 1.15 font ',12' Left reverse %s\n",
                    corner < 0 ? "outside bottom center horizontal title ' '" : corners[corner]);
}

//---- script --------------------------------------------------------------------------------------

static void add_point(sn_buffer *out, const figure *f, const sn_line *line, int i, int bar) {
    if (line->style == SN_BARS) {
        double width = 0.8 * f->gap / f->bars, shift = (bar - 0.5 * (f->bars - 1)) * width;
        double low = line->x[i] + shift - 0.5 * width, high = low + width;
        if (f->x.log) {
            low = line->x[i] * pow(10, shift - 0.5 * width);
            high = low * pow(10, width);
        }
        sn_buffer_print(out, "%.9g %.9g %.9g\n", 0.5 * (low + high), line->y[i], high - low);
    } else {
        sn_buffer_print(out, "%.9g %.9g\n", line->x[i], line->y[i]);
    }
}

// The points of a line that can be told from the one before.
static void add_points(sn_buffer *out, const figure *f, const sn_line *line, int bar) {
    bool empty = true, held = false;
    double px = 0, py = 0;
    for (int i = 0; i < line->count; i++) {
        if (!drawable(f, line->x[i], line->y[i])) {
            if (held) add_point(out, f, line, i - 1, bar);
            if (!empty) sn_buffer_text(out, "\n");
            empty = true;
            held = false;
            continue;
        }
        double x = along(&f->x, line->x[i]), y = along(&f->y, line->y[i]);
        held = !empty && line->style != SN_BARS && fabs(x - px) < NEAR && fabs(y - py) < NEAR;
        if (held) continue;
        add_point(out, f, line, i, bar);
        empty = false;
        px = x;
        py = y;
    }
    if (held) add_point(out, f, line, line->count - 1, bar);
}

static void add_style(sn_buffer *out, const sn_line *line, int marks) {
    const char *rgb = colour[(unsigned)line->colour % 8];
    int mark = marker[marks % 8];
    switch (line->style) {
    case SN_LINE: sn_buffer_print(out, "with lines lw 2 lc rgb '%s'", rgb); break;
    case SN_DASHED: sn_buffer_print(out, "with lines lw 2 dt (9,5) lc rgb '%s'", rgb); break;
    case SN_POINTS:
        if (line->count > DENSE)
            sn_buffer_print(out, "with points pt 7 ps 0.25 lc rgb '%s'", rgb);
        else
            sn_buffer_print(out, "with points pt %d ps 0.6 lc rgb '%s'", mark, rgb);
        break;
    case SN_LINE_POINTS:
        sn_buffer_print(out, "with linespoints lw 2 pt %d ps 0.7 lc rgb '%s'", mark, rgb);
        break;
    case SN_BARS:
        sn_buffer_print(out, "with boxes lc rgb '%s' fillstyle solid 0.9 noborder", rgb);
        break;
    }
}

static bool has_points(const figure *f, const sn_line *line) {
    for (int i = 0; i < line->count; i++)
        if (drawable(f, line->x[i], line->y[i])) return true;
    return false;
}

static void add_label(sn_buffer *out, const char *command, const char *text, const char *rest) {
    sn_buffer_text(out, command);
    sn_gnuplot_quote(out, text);
    sn_buffer_print(out, " noenhanced tc rgb '#1b1f24' %s\n", rest);
}

static void add_script(sn_buffer *out, const figure *f) {
    const sn_plot *plot = f->plot;
    sn_buffer_text(out, "set encoding utf8\n"
                        "set border 3 lc rgb '#59626d' lw 1 back\n"
                        "set tics nomirror out scale 0.6,0.3 tc rgb '#1b1f24'\n"
                        "set format '%g'\n"
                        "set grid back lt 1 lc rgb '#dfe3e8' lw 1 dt 1\n");
    add_legend(out, f);
    if (plot->title && *plot->title) add_label(out, "set title ", plot->title, "font ',14'");
    add_label(out, "set xlabel ", plot->x_label, "offset 0,0.4");
    add_label(out, "set ylabel ", plot->y_label, "");
    add_axis(out, &f->x, 'x');
    add_axis(out, &f->y, 'y');
    for (int k = 0, bar = 0; k < plot->line_count; k++) {
        sn_buffer_print(out, "$line%d << END_OF_LINE\n", k);
        add_points(out, f, &plot->line[k], bar);
        bar += plot->line[k].style == SN_BARS;
        sn_buffer_text(out, "END_OF_LINE\n");
    }
    const char *comma = "plot ";
    for (int k = 0, marks = 0; k < plot->line_count; k++) {
        const sn_line *line = &plot->line[k];
        if (!has_points(f, line)) continue;
        sn_buffer_print(out, "%s$line%d using %s ", comma, k,
                        line->style == SN_BARS ? "1:2:3" : "1:2");
        add_style(out, line, marks);
        marks += line->style == SN_POINTS || line->style == SN_LINE_POINTS;
        sn_buffer_text(out, is_labelled(line) ? " title " : " notitle");
        if (is_labelled(line)) sn_gnuplot_quote(out, line->label);
        comma = ", ";
    }
    sn_buffer_text(out, "\n");
}

//---- page ----------------------------------------------------------------------------------------

static void add_cell(sn_buffer *page, double value) {
    sn_buffer_print(page, "<td class=\"n\">%.5g</td>", value);
}

// Some values of every line, where the figure is missing.
static void add_values(sn_buffer *page, const figure *f) {
    const sn_plot *plot = f->plot;
    sn_buffer_text(page, "<div class=\"scroll\"><table>\n<thead><tr><th>line</th><th class=\"n\">");
    sn_buffer_escape(page, plot->x_label);
    sn_buffer_text(page, "</th><th class=\"n\">");
    sn_buffer_escape(page, plot->y_label);
    sn_buffer_text(page, "</th></tr></thead>\n<tbody>\n");
    for (int k = 0; k < plot->line_count; k++) {
        const sn_line *line = &plot->line[k];
        int rows = FALLBACK_ROWS / plot->line_count > 3 ? FALLBACK_ROWS / plot->line_count : 3;
        if (rows > line->count) rows = line->count;
        for (int r = 0; r < rows; r++) {
            int i = rows > 1 ? (int)((long long)r * (line->count - 1) / (rows - 1)) : 0;
            if (!drawable(f, line->x[i], line->y[i])) continue;
            sn_buffer_text(page, "<tr><td>");
            sn_buffer_escape(page, line->label);
            sn_buffer_text(page, "</td>");
            add_cell(page, line->x[i]);
            add_cell(page, line->y[i]);
            sn_buffer_text(page, "</tr>\n");
        }
    }
    sn_buffer_text(page, "</tbody>\n</table></div>\n");
}

static void draw(sn_report *report, const sn_plot *plot) {
    sn_buffer *page = &report->page;
    sn_buffer script = {0}, svg = {0};
    char reason[SN_TEXT_MAX], prefix[32];
    figure f = {.plot = plot, .x.log = plot->log_x, .y.log = plot->log_y};
    const char *title = plot->title ? plot->title : "";
    sn_buffer_text(page, "<figure>\n");
    if (!measure(&f)) {
        sn_report_missing(report, "No plot “%s”: none of its values can be drawn.", title);
    } else {
        choose_axes(&f);
        add_script(&script, &f);
        if (sn_gnuplot_run(&script, &svg, reason)) {
            snprintf(prefix, sizeof prefix, "f%d-", report->figures + 1);
            sn_gnuplot_inline(page, &svg, prefix, title);
        } else {
            sn_report_missing(report, "No plot “%s”: %s. Some of its values:", title, reason);
            add_values(page, &f);
        }
    }
    if (script.status != SN_OK || svg.status != SN_OK) page->status = SN_E_MEMORY;
    sn_report_end_figure(report, plot->caption ? plot->caption : title);
    sn_buffer_free(&script);
    sn_buffer_free(&svg);
}

static double *scaled(const double *values, int count, double scale) {
    double *copy = sn_alloc((size_t)count, sizeof *copy);
    for (int i = 0; copy && i < count; i++) copy[i] = scale * values[i];
    return copy;
}

void sn_report_plot(sn_report *report, const sn_plot *plot) {
    double x_scale = plot->x_scale != 0 ? plot->x_scale : 1;
    double y_scale = plot->y_scale != 0 ? plot->y_scale : 1;
    sn_line *line = sn_alloc((size_t)plot->line_count, sizeof *line);
    bool enough = line != NULL;
    for (int k = 0; enough && k < plot->line_count; k++) {
        line[k] = plot->line[k];
        line[k].x = scaled(plot->line[k].x, line[k].count, x_scale);
        line[k].y = scaled(plot->line[k].y, line[k].count, y_scale);
        enough = line[k].x && line[k].y;
    }
    sn_plot copy = *plot;
    copy.line = line;
    if (enough)
        draw(report, &copy);
    else
        report->page.status = SN_E_MEMORY;
    for (int k = 0; line && k < plot->line_count; k++) {
        // a line that was not reached yet, or still borrows, is not ours to free
        if (line[k].x != plot->line[k].x) sn_free((void *)line[k].x);
        if (line[k].y != plot->line[k].y) sn_free((void *)line[k].y);
    }
    sn_free(line);
}
