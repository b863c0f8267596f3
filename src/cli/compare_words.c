// sinew compare: what the numbers mean, in plain words by stated rules, and its tables.
// SPDX-License-Identifier: Apache-2.0
//
// The rules. A model's error in a case is the larger of the rms error of the displacements and of
// what answers (the force on what is moved, the motion of what is pushed); over several cases it is
// the worst. For each of 1, 2, 5 and 10 % the model to use is the one with the highest live
// real-time factor (its least over the cases) among the spring models, on whatever mesh, that stay
// below in all cases. A model that did not run to its end in a case is no candidate. Most of an
// error is the mesh's where linear finite elements on the same mesh have at least half of it (and
// no more than it).
// Errors below three times the reference's own are not told apart.
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/compare.h"

double compare_main_error(const sn_comparison_model *m) {
    if (!m->done) return (double)NAN;
    double answer = m->error.response_rms;
    return isfinite(answer) ? fmax(m->error.displacement_rms, answer) : m->error.displacement_rms;
}

const char *compare_percent(double value) {
    static char buffers[8][32];
    static int turn;
    char *text = buffers[turn++ % 8];
    if (!isfinite(value))
        snprintf(text, sizeof buffers[0], "—");
    else if (fabs(value) < 1e-6) // a tenth of a thousandth of a per cent is nothing here
        snprintf(text, sizeof buffers[0], "< 0.0001 %%");
    else
        snprintf(text, sizeof buffers[0], "%.3g %%", 100 * value);
    return text;
}

//---- summaries -----------------------------------------------------------------------------------

static int compare_double(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static const char *short_name(const compare_case *one) {
    return one->folder[0] ? one->folder : one->c->name;
}

static void add_to_summary(compare_summary *row, const compare_case *one, const compare_run *run,
                           double *errors) {
    const sn_comparison_model *m = &run->result;
    double error = compare_main_error(m), live = m->live.real_time_factor;
    if (!isfinite(error)) {
        row->missing++;
        return;
    }
    errors[row->cases++] = error;
    if (error > row->worst || row->cases == 1) {
        row->worst = error;
        snprintf(row->worst_case, sizeof row->worst_case, "%.63s", short_name(one));
    }
    row->displacement = fmax(row->displacement, m->error.displacement_rms);
    row->answer = fmax(row->answer, m->error.response_rms);
    row->relaxation = fmax(row->relaxation, m->error.relaxation_max); // leaves NAN out
    row->wall_s += m->summary.wall_s;
    row->slowest = fmin(row->slowest, live); // fmin leaves NAN out
    row->nodes = m->summary.nodes > row->nodes ? m->summary.nodes : row->nodes;
}

int compare_summarise(const compare_study *s, compare_summary **rows) {
    int count = s->case_count ? s->item[0].run_count : 0, kept = 0;
    *rows = sn_alloc((size_t)count, sizeof **rows);
    double *errors = sn_alloc((size_t)s->case_count, sizeof *errors);
    for (int k = 0; *rows && errors && k < count; k++) {
        compare_summary row = {.model = s->item[0].run[k].model,
                               .mesh = s->item[0].run[k].mesh,
                               .relaxation = (double)NAN,
                               .slowest = (double)NAN};
        int wanted = 0;
        for (int i = 0; i < s->case_count; i++) {
            if (s->item[i].run[k].left_out) continue;
            wanted++;
            add_to_summary(&row, &s->item[i], &s->item[i].run[k], errors);
        }
        if (wanted == 0) continue;
        qsort(errors, (size_t)row.cases, sizeof *errors, compare_double);
        row.median =
            row.cases ? 0.5 * (errors[(row.cases - 1) / 2] + errors[row.cases / 2]) : (double)NAN;
        if (row.cases == 0) row.worst = row.displacement = row.answer = (double)NAN;
        (*rows)[kept++] = row;
    }
    bool good = *rows && errors;
    sn_free(errors);
    return good ? kept : -1;
}

//---- words ---------------------------------------------------------------------------------------

typedef struct speech {
    void (*say)(void *context, const char *text);
    void *context;
} speech;

static void SN_PRINTF(2, 3) say(const speech *to, const char *format, ...) {
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    to->say(to->context, text);
}

static const compare_summary *same_mesh_p1(const compare_summary *rows, int count,
                                           const compare_summary *of) {
    for (int k = 0; k < count; k++)
        if (rows[k].mesh == of->mesh && rows[k].cases > 0 &&
            strcmp(sn_compare_model_name(rows[k].model), "P1") == 0)
            return &rows[k];
    return NULL;
}

static void clock_words(double factor, char text[64]) {
    if (!isfinite(factor))
        snprintf(text, 64, "of unknown speed");
    else if (factor >= 1)
        snprintf(text, 64, "%.3g times faster than the clock", factor);
    else
        snprintf(text, 64, "%.3g times slower than the clock", 1 / factor);
}

static void say_choice(const speech *to, const char *limit, const compare_summary *rows, int count,
                       const compare_summary *best, int cases) {
    const compare_summary *p1 = same_mesh_p1(rows, count, best);
    char clock[64], mesh[128] = "", where[96] = "";
    clock_words(best->slowest, clock);
    if (p1)
        snprintf(mesh, sizeof mesh, " Linear finite elements on the same mesh err by %s%s.",
                 compare_percent(p1->worst),
                 p1->worst > best->worst          ? ", more than this"
                 : p1->worst >= 0.5 * best->worst ? ": most of the error is the mesh's"
                                                  : "");
    if (cases > 1) snprintf(where, sizeof where, " (worst: %s)", best->worst_case);
    say(to, "%s: %s with %d nodes. Error %s%s, %s at its own explicit step.%s", limit,
        sn_compare_model_name(best->model), best->nodes, compare_percent(best->worst), where, clock,
        mesh);
}

// Published rules are there to be compared with: where they are near, errors have cancelled.
static bool is_baseline(const compare_summary *row) {
    const char *name = sn_compare_model_name(row->model);
    return strncmp(name, "uniform", 7) == 0 || strncmp(name, "lloyd", 5) == 0;
}

static bool is_candidate(const compare_summary *row) {
    return row->cases > 0 && row->missing == 0 && isfinite(row->slowest) && !is_baseline(row);
}

static void say_choices(const speech *to, const compare_summary *rows, int count, int cases) {
    static const double limit[] = {0.01, 0.02, 0.05, 0.1};
    const compare_summary *before = NULL, *nearest = NULL;
    bool any = false;
    for (int k = 0; k < count; k++)
        if (is_candidate(&rows[k]) && (!nearest || rows[k].worst < nearest->worst))
            nearest = &rows[k];
    for (size_t l = 0; l < sizeof limit / sizeof limit[0]; l++) {
        const compare_summary *best = NULL;
        char text[64];
        for (int k = 0; k < count; k++)
            if (is_candidate(&rows[k]) && rows[k].worst <= limit[l] &&
                (!best || rows[k].slowest > best->slowest))
                best = &rows[k];
        snprintf(text, sizeof text, "For an error up to %g %%", 100 * limit[l]);
        if (best && best != before) say_choice(to, text, rows, count, best, cases);
        any = any || best;
        before = best;
    }
    if (!any && nearest)
        say_choice(to, "No spring model stays below 10 %; the nearest", rows, count, nearest,
                   cases);
    if (!any && !nearest) say(to, "No spring model ran to its end in every case.");
}

static void say_reference(const speech *to, const compare_study *s) {
    double worst = 0;
    int unknown = 0;
    for (int i = 0; i < s->case_count; i++) {
        const sn_comparison_model *m = &s->item[i].reference.model;
        double own = compare_main_error(m);
        if (m->done && isfinite(own))
            worst = fmax(worst, own);
        else
            unknown++;
    }
    say(to,
        "The reference's own error, at most: %s. Errors up to three times that (%s) are not told "
        "apart.",
        compare_percent(worst), compare_percent(3 * worst));
    if (unknown)
        say(to, "In %d of %d cases the reference's own error is not known, or there is none.",
            unknown, s->case_count);
}

static bool is_missing(const compare_case *one, int k) {
    return one->reference.model.done && !one->run[k].left_out && !one->run[k].result.done;
}

static bool same_loss(const compare_run *a, const compare_run *b) {
    return a->model == b->model && strcmp(a->result.summary.reason, b->result.summary.reason) == 0;
}

// one line for each reason that a model has; it names the first run and counts the others, which
// the tables name
static void say_lost_run(const speech *to, const compare_study *s, int i, int k) {
    const compare_run *run = &s->item[i].run[k];
    char others[64] = "";
    int count = 0;
    for (int j = 0; j < s->case_count; j++)
        for (int l = 0; l < s->item[j].run_count; l++) {
            if (!is_missing(&s->item[j], l) || !same_loss(&s->item[j].run[l], run)) continue;
            if (j < i || (j == i && l < k)) return; // said there
            count++;
        }
    if (count > 1)
        snprintf(others, sizeof others, " and %d more run%s", count - 1, count > 2 ? "s" : "");
    say(to, "Missing: %s, %s on mesh %d%s: %s.", sn_compare_model_name(run->model),
        short_name(&s->item[i]), run->mesh, others, run->result.summary.reason);
}

static void say_missing(const speech *to, const compare_study *s) {
    for (int i = 0; i < s->case_count; i++) {
        const compare_case *one = &s->item[i];
        if (strncmp(one->reference.text, "P2P1", 4) != 0)
            say(to, "Missing or doubtful, %s: reference %s.", short_name(one), one->reference.text);
        for (int k = 0; k < one->run_count; k++)
            if (is_missing(one, k)) say_lost_run(to, s, i, k);
    }
    const compare_case *first = s->item;
    for (int k = 0; s->case_count > 0 && k < first->run_count; k++)
        if (first->run[k].left_out && first->run[k].mesh == first->run[0].mesh)
            say(to, "Not run: %s: %s.", sn_compare_model_name(first->run[k].model),
                first->run[k].why);
}

void compare_words(const compare_study *study, const compare_case *only,
                   void (*say_line)(void *context, const char *text), void *context) {
    const speech to = {say_line, context};
    compare_study view = *study;
    compare_summary *rows;
    if (only) {
        view.case_count = 1;
        view.item = (compare_case *)only;
    }
    int count = compare_summarise(&view, &rows);
    if (count > 0) {
        say_choices(&to, rows, count, view.case_count);
        say_reference(&to, &view);
    }
    say_missing(&to, &view);
    sn_free(rows);
}

//---- tables --------------------------------------------------------------------------------------

sn_status compare_table_create(int columns, int most, compare_table *t) {
    *t = (compare_table){.columns = columns, .most = most};
    t->text = sn_alloc((size_t)(columns * most), sizeof *t->text);
    return t->text ? SN_OK : SN_E_MEMORY;
}

char (*compare_table_row(compare_table *t))[64] {
    SN_ASSERT(t->rows < t->most);
    return t->text + (size_t)t->columns * (size_t)t->rows++;
}

void compare_table_add(sn_report *report, const compare_table *t, const char *caption) {
    size_t count = (size_t)(t->columns * t->rows);
    const char **cells = sn_alloc(count, sizeof *cells);
    for (size_t k = 0; cells && k < count; k++) cells[k] = t->text[k];
    if (cells) sn_report_table(report, t->rows, t->columns, cells, caption);
    sn_free(cells);
}

// columns of a text on a terminal
static int width_of(const char *text) {
    int count = 0;
    for (; *text; text++) count += ((unsigned char)*text & 0xC0) != 0x80;
    return count;
}

void compare_table_print(const compare_table *t) {
    for (int r = 0; r < t->rows; r++) {
        for (int c = 0; c < t->columns; c++) {
            int wide = 0;
            for (int k = 0; k < t->rows; k++) {
                int one = width_of(t->text[k * t->columns + c]);
                wide = one > wide ? one : wide;
            }
            const char *text = t->text[r * t->columns + c];
            int pad = wide - width_of(text);
            if (c == 0)
                printf("  %s%*s", text, pad, "");
            else
                printf("  %*s%s", pad, "", text);
        }
        printf("\n");
    }
}

void compare_table_release(compare_table *t) {
    sn_free(t->text);
    *t = (compare_table){0};
}

static void fill_head(compare_table *t, const char *const *head) {
    char(*row)[64] = compare_table_row(t);
    for (int k = 0; k < t->columns; k++) snprintf(row[k], 64, "%s", head[k]);
}

static void fill_model(compare_table *t, const sn_comparison_model *m) {
    char(*row)[64] = compare_table_row(t);
    const double errors[] = {m->error.displacement_rms, m->error.displacement_max,
                             m->error.response_rms,     m->error.reaction_rms,
                             m->error.stress_rms,       m->error.energy,
                             m->error.relaxation_max};
    int c = 0;
    snprintf(row[c++], 64, "%s%s", m->name, m->done ? "" : " (not to the end)");
    snprintf(row[c++], 64, "%d", m->summary.nodes);
    for (int k = 0; k < 7; k++) snprintf(row[c++], 64, "%s", compare_percent(errors[k]));
    snprintf(row[c++], 64, "%s", cli_show(m->summary.wall_s, "s"));
    snprintf(row[c++], 64, "%.3g", m->summary.real_time_factor);
    if (isfinite(m->live.real_time_factor))
        snprintf(row[c++], 64, "%.3g", m->live.real_time_factor);
    else
        snprintf(row[c++], 64, "—");
    if (m->peak_memory_bytes > 0)
        snprintf(row[c++], 64, "%.3g MB", m->peak_memory_bytes / 1e6);
    else
        snprintf(row[c++], 64, "—");
}

sn_status compare_case_table(const compare_case *one, compare_table *t) {
    static const char *const head[] = {"model",     "nodes",  "displ. rms", "displ. max", "answer",
                                       "force",     "stress", "energy",     "relaxation", "wall",
                                       "real time", "live",   "memory"};
    SN_TRY(compare_table_create((int)(sizeof head / sizeof head[0]), 2 + one->run_count, t));
    fill_head(t, head);
    fill_model(t, &one->reference.model);
    for (int k = 0; k < one->run_count && one->reference.model.done; k++)
        if (!one->run[k].left_out) fill_model(t, &one->run[k].result);
    return SN_OK;
}

sn_status compare_summary_table(const compare_study *s, compare_table *t) {
    static const char *const head[] = {"model",        "mesh",         "nodes, most",
                                       "cases",        "median",       "worst",
                                       "worst displ.", "worst answer", "worst relaxation",
                                       "worst case",   "wall, all",    "live, slowest"};
    compare_summary *rows;
    int count = compare_summarise(s, &rows);
    sn_status status = count < 0 ? SN_E_MEMORY : SN_OK;
    if (status == SN_OK)
        status = compare_table_create((int)(sizeof head / sizeof head[0]), 1 + count, t);
    if (status == SN_OK) fill_head(t, head);
    for (int k = 0; k < count && status == SN_OK; k++) {
        const compare_summary *r = &rows[k];
        char(*row)[64] = compare_table_row(t);
        snprintf(row[0], 64, "%s", sn_compare_model_name(r->model));
        snprintf(row[1], 64, "%d", r->mesh);
        snprintf(row[2], 64, "%d", r->nodes);
        snprintf(row[3], 64, r->missing ? "%d of %d" : "%d", r->cases, r->cases + r->missing);
        snprintf(row[4], 64, "%s", compare_percent(r->median));
        snprintf(row[5], 64, "%s", compare_percent(r->worst));
        snprintf(row[6], 64, "%s", compare_percent(r->displacement));
        snprintf(row[7], 64, "%s", compare_percent(r->answer));
        snprintf(row[8], 64, "%s", compare_percent(r->relaxation));
        snprintf(row[9], 64, "%s", r->worst_case);
        snprintf(row[10], 64, "%s", cli_show(r->wall_s, "s"));
        if (isfinite(r->slowest))
            snprintf(row[11], 64, "%.3g", r->slowest);
        else
            snprintf(row[11], 64, "—");
    }
    sn_free(rows);
    return status;
}

// whether run k is of this mesh and wanted in some case
static bool is_used(const compare_study *s, int k, int mesh) {
    if (s->item[0].run[k].mesh != mesh) return false;
    for (int i = 0; i < s->case_count; i++)
        if (!s->item[i].run[k].left_out) return true;
    return false;
}

// displacement and answer, and of a memory what is its own
static void put_errors(char cell[64], const sn_comparison_errors *e) {
    snprintf(cell, 64, "%s / %s", compare_percent(e->displacement_rms),
             compare_percent(e->response_rms));
    const size_t used = strlen(cell);
    if (!isnan(e->relaxation_max))
        snprintf(cell + used, 64 - used, " / %s", compare_percent(e->relaxation_max));
}

static void fill_case(const compare_study *s, const compare_case *one, int mesh, compare_table *t) {
    char(*row)[64] = compare_table_row(t);
    int c = 2;
    snprintf(row[0], 64, "%.63s", short_name(one));
    put_errors(row[1], &one->reference.model.error);
    for (int k = 0; k < one->run_count && c < t->columns; k++) {
        const compare_run *run = &one->run[k];
        if (!is_used(s, k, mesh)) continue;
        if (run->left_out || !one->reference.model.done)
            snprintf(row[c], 64, "—");
        else if (!run->result.done)
            snprintf(row[c], 64, "not to the end");
        else
            put_errors(row[c], &run->result.error);
        c++;
    }
}

sn_status compare_cases_table(const compare_study *s, compare_table *t) {
    int mesh = s->mesh[s->mesh_count - 1], columns = 2;
    const compare_case *first = &s->item[0];
    for (int k = 0; k < first->run_count; k++) columns += is_used(s, k, mesh);
    SN_TRY(compare_table_create(columns, 1 + s->case_count, t));
    char(*row)[64] = compare_table_row(t);
    snprintf(row[0], 64, "case");
    snprintf(row[1], 64, "reference's own");
    for (int k = 0, c = 2; k < first->run_count; k++)
        if (is_used(s, k, mesh))
            snprintf(row[c++], 64, "%s", sn_compare_model_name(first->run[k].model));
    for (int i = 0; i < s->case_count; i++) fill_case(s, &s->item[i], mesh, t);
    return SN_OK;
}
