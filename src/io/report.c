// The report page: head and foot, headings, text, tables.
// SPDX-License-Identifier: Apache-2.0
//
// One file that opens anywhere: style, figures and script are in it, and its own security policy
// forbids the browser every fetch. Nothing in it depends on the time or the machine, so that equal
// results give equal pages. Additions never fail; a shortage of memory is remembered by the buffer
// and returned by sn_report_write().
#include "io/report.h"

#include <ctype.h>
#include <stdarg.h>
#include <string.h>

static const char *const style[] = {
    ":root{--ink:#1b1f24;--soft:#59626d;--rule:#c9ced6;--faint:#eceff3}",
    "*{box-sizing:border-box}",
    "html{background:#fff;color:var(--ink);-webkit-text-size-adjust:100%}",
    "body{max-width:1100px;margin:0 auto;padding:40px 32px 64px;",
    "font:16px/1.55 \"Source Serif 4\",Charter,\"Bitstream Charter\",Cambria,Georgia,",
    "\"Liberation Serif\",serif}",
    "h1,h2,table,figcaption,caption,.note,svg text{font-family:system-ui,-apple-system,",
    "\"Segoe UI\",Roboto,\"Helvetica Neue\",Arial,\"Liberation Sans\",sans-serif}",
    "h1{font-size:28px;line-height:1.2;font-weight:650;margin:0 0 24px;padding-bottom:12px;",
    "border-bottom:2px solid var(--ink)}",
    "h2{font-size:19px;line-height:1.3;font-weight:650;margin:40px 0 10px}",
    "p{max-width:46em;margin:0 0 12px;white-space:pre-line;overflow-wrap:anywhere}",
    ".scroll{overflow-x:auto;margin:18px 0 26px}",
    "table{border-collapse:collapse;font-size:14px;line-height:1.4;",
    "font-variant-numeric:tabular-nums lining-nums;border-top:1.5px solid var(--ink);",
    "border-bottom:1.5px solid var(--ink)}",
    "caption,figcaption{font-size:14px;line-height:1.45;color:var(--soft);text-align:left;",
    "max-width:56em}",
    "caption{padding-bottom:8px}caption b,figcaption b{color:var(--ink)}",
    "th,td{padding:4px 16px;text-align:left;vertical-align:baseline}",
    "th:first-child,td:first-child{padding-left:6px}th:last-child,td:last-child{padding-right:6px}",
    "th{font-weight:650;border-bottom:1px solid var(--ink)}",
    "tbody tr+tr td{border-top:1px solid var(--faint)}",
    ".n{text-align:right;white-space:nowrap}",
    "figure{margin:22px 0 30px;break-inside:avoid}",
    "figure svg{display:block;max-width:100%;height:auto}",
    "figcaption{margin-top:6px}",
    ".note{border:1px solid #b58900;border-left-width:5px;background:#fdf8e8;padding:10px 14px;",
    "font-size:14px;max-width:56em;overflow-wrap:anywhere}",
    ".bodies{display:grid;grid-template-columns:repeat(auto-fill,minmax(300px,1fr));gap:12px}",
    ".bodies>div{min-width:0;max-width:720px}",
    ".bodies .title{display:block;font:600 14px/1.4 system-ui,sans-serif;text-align:center}",
    ".bodies canvas{display:block;width:100%;aspect-ratio:4/3;cursor:grab;touch-action:none}",
    ".bodies canvas:active{cursor:grabbing}",
    ".bodies canvas:focus-visible{outline:2px solid #0072b2;outline-offset:-2px}",
    ".bodies+.hint{margin-top:8px;font:12px/1.4 system-ui,sans-serif;color:var(--soft)}",
    "@media(max-width:640px){body{padding:20px 14px}}",
    "@media print{@page{margin:18mm}body{padding:0;font-size:10.5pt}h2{break-after:avoid}",
    "table{break-inside:auto;font-size:9pt}tr{break-inside:avoid}thead{display:table-header-group}",
    ".scroll{overflow:visible}.hint{display:none}}",
    NULL,
};

static void add_lines(sn_buffer *page, const char *const *lines) {
    for (; *lines; lines++) {
        sn_buffer_text(page, *lines);
        sn_buffer_text(page, "\n");
    }
}

sn_status sn_report_create(const char *title, sn_report **report) {
    *report = NULL;
    sn_report *made = sn_alloc(1, sizeof *made);
    if (!made) return SN_E_MEMORY;
    sn_buffer *page = &made->page;
    sn_buffer_text(page, "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
                         "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src "
                         "'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\n"
                         "<meta name=\"viewport\" content=\"width=device-width\">\n<title>");
    sn_buffer_escape(page, title);
    sn_buffer_text(page, "</title>\n<style>\n");
    add_lines(page, style);
    sn_buffer_text(page, "</style>\n</head>\n<body>\n<h1>");
    sn_buffer_escape(page, title);
    sn_buffer_text(page, "</h1>\n");
    *report = made;
    return SN_OK;
}

void sn_report_destroy(sn_report *report) {
    if (!report) return;
    sn_buffer_free(&report->page);
    sn_free(report);
}

void sn_report_heading(sn_report *report, const char *text) {
    sn_buffer_text(&report->page, "<h2>");
    sn_buffer_escape(&report->page, text);
    sn_buffer_text(&report->page, "</h2>\n");
}

static void add_printed(sn_buffer *page, const char *format, va_list arguments) {
    sn_buffer text = {0};
    sn_buffer_vprint(&text, format, arguments);
    sn_buffer_escape(page, text.text);
    if (text.status != SN_OK) page->status = text.status;
    sn_buffer_free(&text);
}

void sn_report_text(sn_report *report, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    sn_buffer_text(&report->page, "<p>");
    add_printed(&report->page, format, arguments);
    sn_buffer_text(&report->page, "</p>\n");
    va_end(arguments);
}

void sn_report_missing(sn_report *report, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    sn_buffer_text(&report->page, "<div class=\"note\" role=\"note\">");
    add_printed(&report->page, format, arguments);
    sn_buffer_text(&report->page, "</div>\n");
    va_end(arguments);
}

void sn_report_end_figure(sn_report *report, const char *caption) {
    sn_buffer_print(&report->page, "<figcaption><b>Figure %d.</b> ", ++report->figures);
    sn_buffer_escape(&report->page, caption);
    sn_buffer_text(&report->page, "</figcaption>\n</figure>\n");
}

//---- tables --------------------------------------------------------------------------------------

// The first character that could be a digit of the number a cell begins with.
static const char *skip_signs(const char *text) {
    static const char *const signs[] = {" ", "+", "-", "−", "±", "<", ">", "≤", "≥", "≈", "~", "."};
    for (size_t k = 0; k < sizeof signs / sizeof *signs; k++) {
        size_t length = strlen(signs[k]);
        if (!strncmp(text, signs[k], length)) return skip_signs(text + length);
    }
    return text;
}

// A number, perhaps with a unit or an interval after it, but no date and no "3rd ramp".
static bool is_number(const char *text) {
    text = skip_signs(text);
    if (!isdigit((unsigned char)*text)) return false;
    while (isdigit((unsigned char)*text) || *text == '.' || *text == ',') text++;
    if ((*text == 'e' || *text == 'E') && strchr("+-0123456789", text[1])) return true;
    return !*text || *text == ' ' || *text == '%' || *text == '/' || (*text & 0x80);
}

static bool is_blank(const char *text) {
    static const char *const blanks[] = {"", "-", "–", "—", "n/a", "null", "nan", "inf"};
    for (size_t k = 0; k < sizeof blanks / sizeof *blanks; k++)
        if (!strcmp(text, blanks[k])) return true;
    return false;
}

// A column of numbers stands right: all its filled cells are numbers, and there is one.
static bool is_numeric(const char *const *cells, int rows, int columns, int column) {
    bool found = false;
    for (int r = 1; r < rows; r++) {
        const char *cell = cells[(size_t)r * (size_t)columns + (size_t)column];
        if (!cell || is_blank(cell)) continue;
        if (!is_number(cell)) return false;
        found = true;
    }
    return found;
}

static void add_row(sn_buffer *page, int columns, const char *const *cells, const bool *numeric,
                    const char *tag) {
    sn_buffer_text(page, "<tr>");
    for (int c = 0; c < columns; c++) {
        sn_buffer_print(page, "<%s%s>", tag, numeric[c] ? " class=\"n\"" : "");
        sn_buffer_escape(page, cells[c]);
        sn_buffer_print(page, "</%s>", tag);
    }
    sn_buffer_text(page, "</tr>\n");
}

void sn_report_table(sn_report *report, int rows, int columns, const char *const *cells,
                     const char *caption) {
    SN_ASSERT(rows >= 1 && columns >= 1);
    sn_buffer *page = &report->page;
    bool *numeric = sn_alloc((size_t)columns, sizeof *numeric);
    if (!numeric) {
        page->status = SN_E_MEMORY;
        return;
    }
    for (int c = 0; c < columns; c++) numeric[c] = is_numeric(cells, rows, columns, c);
    sn_buffer_print(page, "<div class=\"scroll\"><table>\n<caption><b>Table %d.</b> ",
                    ++report->tables);
    sn_buffer_escape(page, caption);
    sn_buffer_text(page, "</caption>\n<thead>\n");
    add_row(page, columns, cells, numeric, "th");
    sn_buffer_text(page, "</thead>\n<tbody>\n");
    for (int r = 1; r < rows; r++)
        add_row(page, columns, cells + (size_t)r * (size_t)columns, numeric, "td");
    sn_buffer_text(page, "</tbody>\n</table></div>\n");
    sn_free(numeric);
}

//---- file ----------------------------------------------------------------------------------------

sn_status sn_report_write(sn_report *report, const char *path) {
    sn_buffer *page = &report->page;
    size_t before = page->size;
    if (report->has_bodies) {
        sn_buffer_text(page, "<script>\n");
        add_lines(page, sn_body_script);
        sn_buffer_text(page, "</script>\n");
    }
    sn_buffer_text(page, "</body>\n</html>\n");
    if (page->status != SN_OK)
        return sn_fail(page->status, "%s: out of memory for the report", path);
    sn_status status = sn_text_write(path, page->text, page->size);
    page->size = before; // the page may go on
    return status;
}
