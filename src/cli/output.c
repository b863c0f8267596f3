// Progress, JSON and readable numbers for all commands.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/cli.h"

cli_progress cli_progress_start(const cli_arguments *arguments) {
    double now = sn_clock();
    return (cli_progress){.quiet = arguments->quiet,
                          .terminal = isatty(STDERR_FILENO) == 1,
                          .start = now,
                          .last = now};
}

void cli_progress_show(void *context, double done, const char *text) {
    cli_progress *p = context;
    double now = sn_clock();
    // a bar may move ten times a second; lines in a log every five seconds
    if (p->quiet || now - p->start < 1.0 || now - p->last < (p->terminal ? 0.1 : 5.0)) return;
    p->last = now;
    p->shown = true;
    int width = (int)(24 * fmin(fmax(done, 0), 1));
    if (p->terminal)
        fprintf(stderr, "\r\033[K[%.*s%*s] %3.0f %%  %.60s", width, "########################",
                24 - width, "", 100 * done, text);
    else
        fprintf(stderr, "%3.0f %%  %s\n", 100 * done, text);
    fflush(stderr);
}

void cli_progress_end(cli_progress *progress) {
    if (progress->shown && progress->terminal) fputs("\r\033[K", stderr);
}

static json_t *number(double value) {
    return isfinite(value) ? json_real(value) : json_null();
}

void cli_put(json_t *object, const char *key, json_t *value) {
    json_object_set_new(object, key, value);
}

void cli_put_number(json_t *object, const char *key, double value) {
    cli_put(object, key, number(value));
}

void cli_put_integer(json_t *object, const char *key, long value) {
    cli_put(object, key, json_integer(value));
}

void cli_put_text(json_t *object, const char *key, const char *text) {
    cli_put(object, key, json_string(text));
}

void cli_put_flag(json_t *object, const char *key, bool value) {
    cli_put(object, key, json_boolean(value));
}

json_t *cli_numbers(int count, const double *values) {
    json_t *array = json_array();
    for (int i = 0; i < count; i++) json_array_append_new(array, number(values[i]));
    return array;
}

json_t *cli_exponentials(const sn_exponentials *e) {
    json_t *json = json_object();
    cli_put_integer(json, "terms", e->terms);
    cli_put_number(json, "max_error", e->max_error);
    cli_put(json, "band_s", cli_numbers(2, (double[]){e->t_min, e->t_max}));
    cli_put_number(json, "g_infinity", e->g_inf);
    cli_put(json, "g", cli_numbers(e->terms, e->g));
    cli_put(json, "tau_s", cli_numbers(e->terms, e->tau));
    return json;
}

#define JSON_STYLE (JSON_INDENT(2) | JSON_REAL_PRECISION(12))

const char *cli_path(char *buffer, size_t size, const char *folder, const char *name) {
    snprintf(buffer, size, "%s/%s", folder, name);
    return buffer;
}

sn_status cli_write_json(const char *folder, const char *name, const json_t *object) {
    char path[4096];
    char *text = json_dumps(object, JSON_STYLE);
    if (!text) return sn_fail(SN_E_MEMORY, "out of memory: %s/%s", folder, name);
    sn_status status = sn_text_write(cli_path(path, sizeof path, folder, name), text, strlen(text));
    free(text);
    return status;
}

void cli_print_json(json_t *object) {
    json_dumpf(object, stdout, JSON_STYLE);
    fputc('\n', stdout);
    json_decref(object);
}

const char *cli_basename(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

// a factor and a name for each magnitude, largest first
typedef struct readable_unit {
    const char *si, *shown;
    double factor;
} readable_unit;

static const readable_unit units[] = {
    {"Pa", "GPa", 1e9},
    {"Pa", "MPa", 1e6},
    {"Pa", "kPa", 1e3},
    {"Pa", "Pa", 1},
    {"s", "s", 1},
    {"s", "ms", 1e-3},
    {"s", "\xc2\xb5s", 1e-6},
    {"m", "m", 1},
    {"m", "mm", 1e-3},
    {"m", "\xc2\xb5m", 1e-6},
    {"N", "N", 1},
    {"N", "mN", 1e-3},
    {"J", "J", 1},
    {"J", "mJ", 1e-3},
    {"J", "\xc2\xb5J", 1e-6},
};

const char *cli_show(double value, const char *si_unit) {
    static char buffers[8][64];
    static int turn;
    char *text = buffers[turn++ % 8];
    if (!isfinite(value)) return "\xe2\x80\x94";
    const readable_unit *best = NULL;
    for (size_t k = 0; k < sizeof units / sizeof units[0]; k++) {
        if (strcmp(units[k].si, si_unit) != 0) continue;
        best = &units[k];
        if (fabs(value) >= units[k].factor) break;
    }
    if (value == 0 || !best)
        snprintf(text, sizeof buffers[0], "%.4g%s%s", value, strcmp(si_unit, "1") ? " " : "",
                 strcmp(si_unit, "1") ? si_unit : "");
    else
        snprintf(text, sizeof buffers[0], "%.4g %s", value / best->factor, best->shown);
    return text;
}

void cli_machine(char *text, size_t size) {
    snprintf(text, size, "unknown processor");
    FILE *file = fopen("/proc/cpuinfo", "r");
    char line[512];
    while (file && fgets(line, sizeof line, file)) {
        char *colon = strchr(line, ':');
        if (strncmp(line, "model name", 10) != 0 || !colon) continue;
        colon[strcspn(colon, "\n")] = 0;
        snprintf(text, size, "%s", colon + 2);
        break;
    }
    if (file) fclose(file);
}
