// The keys of the JSON objects that commands print and write.
// SPDX-License-Identifier: Apache-2.0
//
// A path names a value: "a.b" a key in a key, "a[]" every item of a list, "*" any name that comes
// from the user's files. tests/cli/list.sh runs every command and holds what it prints against
// these tables, both ways: a new key needs its row here, and a row needs a command that prints it.
#include <fnmatch.h>
#include <stdio.h>
#include <string.h>

#include "cli/list.h"

typedef struct key_row {
    const char *path, *unit, *meaning;
} key_row;

typedef struct key_table {
    const char *command; ///< as `sinew list keys` knows it
    const char *text;
    const key_row *rows;
    int count;
} key_table;

#define EXPONENTIALS(prefix)                                                                       \
    {prefix, "", "the memory as exponentials, compressed"},                                        \
        {prefix ".terms", "", "number of exponentials"},                                           \
        {prefix ".max_error", "1", "largest error over the band, of G(0) = 1"},                    \
        {prefix ".band_s[]", "s", "ends of the band of times"},                                    \
        {prefix ".g_infinity", "1", "what never relaxes"}, {prefix ".g[]", "1", "weights"}, {      \
        prefix ".tau_s[]", "s", "relaxation times"                                                 \
    }

static const key_row tensile[] = {
    {"youngs_modulus_Pa", "Pa", "Young's modulus"},
    {"modulus_method", "", "how it was found"},
    {"toe_modulus_Pa", "Pa", "slope at small stretch"},
    {"max_slope_modulus_Pa", "Pa", "largest slope"},
    {"yield_stress_Pa", "Pa", "0.2 % offset yield; null where the line never meets the curve"},
    {"yield_strain", "1", "strain there; null likewise"},
    {"reason", "", "why there is no yield; absent where there is one"},
    {"ultimate_tensile_strength_Pa", "Pa", "largest nominal stress"},
    {"strain_at_ultimate", "1", "strain there"},
    {"work_to_failure_J_per_m3", "J/m3", "area under the curve"},
    {"slope_stress", "", "regression of slope on stress, equation (13)"},
    {"slope_stress.B", "1", "its slope"},
    {"slope_stress.C_Pa", "Pa", "its value at no stress"},
    {"slope_stress.r_squared", "1", "how straight it is"},
};

static const key_row cyclic[] = {
    {"cycles", "", "one object a cycle"},
    {"cycles[].hysteresis", "1", "loop area over area under the loading curve"},
    {"cycles[].loading_area_J_per_m3", "J/m3", "area under the loading curve"},
    {"cycles[].loop_area_J_per_m3", "J/m3", "area of the loop"},
    {"cycles[].peak_stress_Pa", "Pa", "largest nominal stress"},
    {"definition", "", "of hysteresis, in words"},
};

static const key_row relaxation[] = {
    {"peak_stress_Pa", "Pa", "nominal stress at the end of the ramp"},
    {"relaxed_fraction", "1", "(peak - final)/peak"},
    {"rate_per_decade", "1", "fall over peak per decade of time"},
    {"ramp_s", "s", "length of the ramp, found in the data"},
    {"final_stress_Pa", "Pa", "nominal stress in the last row"},
};

static const key_row creep[] = {
    {"compliance_per_Pa", "1/Pa", "strain over stress at the end of the hold"},
    {"initial_compliance_per_Pa", "1/Pa", "the same at its start"},
    {"creep_rate_per_s", "1/s", "smallest slope of the strain over a quarter of the hold"},
    {"time_to_rupture_s", "s", "from the start of the hold; null where it did not break"},
    {"recovered_fraction", "1", "of the strain at the end of the hold; null if never unloaded"},
    {"stress_Pa", "Pa", "held nominal stress"},
    {"ramp_s", "s", "length of the loading"},
    {"hold_s", "s", "time under the stress"},
};

static const key_row fit[] = {
    {"elastic", "", "name of the elastic law"},
    {"memory", "", "name of the memory"},
    {"parameters", "", "one object a constant"},
    {"parameters[].name", "", "key of the constant; terms of a list are g1, g2, …"},
    {"parameters[].value", "as `unit`", "fitted or fixed value; null where infinite"},
    {"parameters[].unit", "", "SI unit"},
    {"parameters[].standard_error", "as `unit`", "null where fixed"},
    {"parameters[].ci95[]", "as `unit`", "ends of the 95 % interval"},
    {"parameters[].fixed", "", "held by the user"},
    {"parameters[].identifiable", "", "whether the data determine it"},
    {"r_squared", "1", "1 - SSE/SST over all points"},
    {"rmse_Pa", "Pa", "root of the mean square residual"},
    {"nrmse", "1", "that over the largest measured stress"},
    {"aicc", "1", "Akaike's criterion, corrected: smaller is better"},
    {"correlation[][]", "1", "of the constants, in the order of `parameters`"},
    {"active_bounds[]", "", "constants at a bound of the search"},
    {"identifiable", "", "every constant is"},
    {"not_identifiable", "", "one object a constant that is not"},
    {"not_identifiable[].name", "", "which"},
    {"not_identifiable[].reason", "", "why"},
    {"weakest_combination", "", "the combination of constants that the data know least"},
    {"convex", "", "Fung laws: the energy is convex; else null"},
    {"converged", "", "the search ended well"},
    {"reason", "", "how it ended"},
    {"points", "", "rows of all curves"},
    {"data", "", "one object a curve"},
    {"data[].file", "", "path as given"},
    {"data[].sha256", "", "of the file"},
    {"data[].points", "", "rows"},
    {"data[].window[]", "s", "first and last time used"},
    {"data[].weight", "1", "factor of its squares"},
    {"data[].rmse_Pa", "Pa", "root of its mean square residual"},
    {"data[].rmse_over_peak", "1", "that over its largest stress"},
    {"data[].r_squared", "1", "1 - SSE/SST of this curve"},
    {"data[].worst", "", "row of the largest residual"},
    {"data[].worst.time_s", "s", "its time"},
    {"data[].worst.measured_Pa", "Pa", "measured stress there"},
    {"data[].worst.fitted_Pa", "Pa", "fitted stress there"},
    EXPONENTIALS("memory_as_exponentials"),
    {"held_out", "", "with --hold-out: one object a curve, predicted from the others"},
    {"held_out[].file", "", "path as given"},
    {"held_out[].rmse_Pa", "Pa", "error of the prediction"},
    {"held_out[].rmse_over_peak", "1", "that over its largest stress"},
    {"held_out[].r_squared", "1", "1 - SSE/SST of the prediction"},
};

static const key_row test[] = {
    {"tissue", "", "name of the tissue"},
    {"points", "", "rows of the curve"},
    {"peak_*", "as named",
     "value farthest from rest of a column: `peak_stretch`, `peak_stress_Pa`"},
    {"duration_s", "s", "time of the last row"},
    EXPONENTIALS("memory"),
    {"rmse_Pa", "Pa", "with --replay: error of the prediction"},
    {"rmse_over_peak", "1", "with --replay: that over the largest measured stress"},
    {"r_squared", "1", "with --replay: 1 - SSE/SST"},
    {"sweep", "", "hysteresis and dynamic: one object a speed"},
    {"sweep[].frequency_Hz", "Hz", "1/(2 ramp), or that of the oscillation"},
    {"sweep[].ramp_s", "s", "hysteresis: time of the ramp"},
    {"sweep[].hysteresis", "1", "hysteresis: loop area over area under the loading curve"},
    {"sweep[].storage_modulus_Pa", "Pa", "dynamic: in phase with the stretch"},
    {"sweep[].loss_modulus_Pa", "Pa", "dynamic: in phase with its rate"},
    {"sweep[].tan_delta", "1", "dynamic: loss over storage"},
};

static const key_row runs[] = {
    {"engine", "", "springs or continuum"},
    {"model", "", "rung or element"},
    {"nodes", "", "of the mesh"},
    {"cells", "", "tetrahedra"},
    {"springs", "", "edges of central rungs"},
    {"unknowns", "", "of the continuum's system"},
    {"step_s", "s", "smallest step"},
    {"steps", "", "number of steps"},
    {"simulated_s", "s", "time reached"},
    {"wall_s", "s", "time it took"},
    {"real_time_factor", "1", "simulated over wall: above 1 is faster than the clock"},
    {"step_wall_p50_s", "s", "median of the time of a step"},
    {"step_wall_p99_s", "s", "99th percentile"},
    {"step_wall_max_s", "s", "longest step"},
    {"threads", "", "used"},
    {"newton_iterations", "", "in all"},
    {"cutbacks", "", "steps that were halved"},
    {"kinetic_J", "J", "kinetic energy at the end"},
    {"elastic_J", "J", "elastic energy at the end (springs: of the equilibrium part)"},
    {"memory_J", "J", "stored in the branches of the memory at the end (springs)"},
    {"dissipated_J", "J", "by memory, damping and friction"},
    {"external_work_J", "J", "of loads, supports and tools"},
    {"energy_residual", "1", "what is missing in the balance, relative"},
    {"memory_terms", "", "exponentials that stand for the memory"},
    {"memory_error", "1", "their largest error, of G(0) = 1"},
    {"memory_band_s[]", "s", "over this band of times"},
    {"converged", "", "it ran to its end"},
    {"reason", "", "why not"},
    {"note", "", "what else to know"},
    {"probes", "", "last row of the history"},
    {"probes.*", "m or N", "one component of a probe, reaction or tool"},
};

#define MODEL(prefix)                                                                              \
    {prefix ".name", "", "rung or element"}, {prefix ".done", "", "it ran to its end"},            \
        {prefix ".reason", "", "why not"},                                                         \
        {prefix ".displacement_rms", "1", "root mean square error of displacements"},              \
        {prefix ".displacement_max", "1", "largest error of displacements"},                       \
        {prefix ".reaction_rms", "1", "root mean square error of forces"},                         \
        {prefix ".stress_rms", "1", "root mean square error of stresses"},                         \
        {prefix ".energy", "1", "error of the elastic energy"},                                    \
        {prefix ".wall_s", "s", "time it took"},                                                   \
        {prefix ".real_time_factor", "1", "simulated over wall"},                                  \
        {prefix ".nodes", "", "of its mesh"}, {prefix ".cells", "", "tetrahedra"}, {               \
        prefix ".memory_terms", "", "exponentials that stand for the memory"                       \
    }

static const key_row comparison[] = {
    {"case", "", "name of the case"},
    {"reference", "", "the converged model; its errors are its own estimated ones"},
    MODEL("reference"),
    {"reference.text", "", "how it was converged"},
    {"models", "", "one object a model; errors over the reference's largest value"},
    MODEL("models[]"),
};

static const key_row bench_springs[] = {
    {"results", "", "one object a net"},
    {"results[].model", "", "rung"},
    {"results[].volume", "", "with a volume energy"},
    {"results[].memory_terms", "", "exponentials"},
    {"results[].nodes", "", "of the net"},
    {"results[].springs", "", "of the net"},
    {"results[].cells", "", "of the net"},
    {"results[].threads", "", "used"},
    {"results[].precision", "", "single or double"},
    {"results[].springs_per_second", "1/s", "whole steps"},
    {"results[].cells_per_second", "1/s", "whole steps"},
    {"results[].bound_per_second", "1/s", "what the memory's bandwidth allows"},
    {"machine", "", "processor"},
    {"kernels", "", "instruction set"},
};

static const key_row bench_fit[] = {
    {"results", "", "one object a fit"},
    {"results[].what", "", "the data"},
    {"results[].points", "", "rows"},
    {"results[].seconds", "s", "time it took"},
    {"results[].evaluations", "", "of the model"},
    {"direct_convolution_s", "s", "one curve by a plain convolution"},
    {"recursion_s", "s", "the same by the recursion"},
    {"machine", "", "processor"},
};

static const key_row conversion[] = {
    {"tissue", "", "name of the tissue"},
    {"elastic", "", "name of the elastic law"},
    {"memory", "", "name of the memory that was read"},
    {"terms", "", "exponentials in the file of the other program"},
    {"max_error", "1", "what their number costs, of G(0) = 1"},
    {"remarks", "", "what differs between the two"},
};

static const key_row lists[] = {
    {"*", "", "the topic: one object a section"},
    {"*[].name", "", "law, command, …; absent where there is one section"},
    {"*[].text", "", "what it is"},
    {"*[].rows", "", "one object a row"},
    {"*[].rows[].*", "", "a column of the printed table"},
};

#define TABLE(name, text, rows)                                                                    \
    { name, text, rows, (int)(sizeof(rows) / sizeof(rows)[0]) }

static const key_table tables[] = {
    TABLE("analyze-tensile", "`sinew analyze --test tensile`, analysis.json", tensile),
    TABLE("analyze-cyclic", "`sinew analyze --test cyclic`, analysis.json", cyclic),
    TABLE("analyze-relaxation", "`sinew analyze --test relaxation`, analysis.json", relaxation),
    TABLE("analyze-creep", "`sinew analyze --test creep`, analysis.json", creep),
    TABLE("fit", "`sinew fit`, fit.json", fit),
    TABLE("test", "`sinew test`", test),
    TABLE("run", "`sinew run`, summary.json", runs),
    TABLE("compare", "`sinew compare`, compare.json", comparison),
    TABLE("bench-springs", "`sinew bench springs`", bench_springs),
    TABLE("bench-fit", "`sinew bench fit`", bench_fit),
    TABLE("convert", "`sinew convert`", conversion),
    TABLE("list", "`sinew list`", lists),
};

#define TABLES ((int)(sizeof tables / sizeof tables[0]))

//---- the keys of a result file -------------------------------------------------------------------

typedef struct scan {
    const key_table *table;
    const char *file;
    bool *seen; ///< rows of the table that were found         (count)
} scan;

// a path as fnmatch() wants it: names apart by slashes, and no brackets
static void plain(const char *path, char out[256]) {
    snprintf(out, 256, "%s", path);
    for (char *s = out; *s; s++) *s = *s == '.' ? '/' : *s == '[' || *s == ']' ? '!' : *s;
}

// the row of a path: an exact one before one with a wildcard, which stands for one name
static int find_row(const key_table *table, const char *path) {
    char name[256], pattern[256];
    for (int k = 0; k < table->count; k++)
        if (strcmp(table->rows[k].path, path) == 0) return k;
    plain(path, name);
    for (int k = 0; k < table->count; k++) {
        plain(table->rows[k].path, pattern);
        if (strchr(pattern, '*') && fnmatch(pattern, name, FNM_PATHNAME) == 0) return k;
    }
    return -1;
}

static int visit(scan *s, const json_t *value, const char *path);

static int visit_object(scan *s, const json_t *object, const char *path) {
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)object, key, value) {
        char name[256];
        snprintf(name, sizeof name, "%s%s%s", path, *path ? "." : "", key);
        int code = visit(s, value, name);
        if (code >= 0) return code;
    }
    return -1;
}

// A list of numbers, texts or lists is one value, "g[]"; of a list of objects the list itself and
// every key of its objects have rows. What is empty tells nothing of its items and passes.
static int visit_array(scan *s, const json_t *array, const char *path) {
    size_t i;
    json_t *item;
    char name[256];
    snprintf(name, sizeof name, "%s[]", path);
    int row = find_row(s->table, path);
    if (row >= 0) s->seen[row] = true;
    if (row < 0 && json_is_object(json_array_get(array, 0)))
        return cli_refuse("%s: unknown key \"%s\" of %s", s->file, path, s->table->command);
    json_array_foreach(array, i, item) {
        int code = json_is_object(item) ? visit_object(s, item, name) : visit(s, item, name);
        if (code >= 0) return code;
    }
    return -1;
}

static int visit(scan *s, const json_t *value, const char *path) {
    if (json_is_array(value)) return visit_array(s, value, path);
    int row = find_row(s->table, path);
    if (row < 0)
        return cli_refuse("%s: unknown key \"%s\" of %s", s->file, path, s->table->command);
    s->seen[row] = true;
    return json_is_object(value) ? visit_object(s, value, path) : -1;
}

static int scan_file(scan *s) {
    json_error_t error;
    json_t *json = json_load_file(s->file, 0, &error);
    if (!json) return cli_refuse("%s:%d: no JSON: %s", s->file, error.line, error.text);
    int code = json_is_object(json) ? visit_object(s, json, "")
                                    : cli_refuse("%s: expected a JSON object", s->file);
    json_decref(json);
    return code;
}

static void add_rows(json_t *sections, const key_table *table, const bool *seen) {
    char text[128];
    snprintf(text, sizeof text, "%s.", table->text);
    json_t *rows = list_section(sections, table->command, text);
    for (int k = 0; k < table->count; k++) {
        if (seen && !seen[k]) continue;
        json_t *row = json_object();
        cli_put_text(row, "key", table->rows[k].path);
        cli_put_text(row, "unit", table->rows[k].unit);
        cli_put_text(row, "meaning", table->rows[k].meaning);
        json_array_append_new(rows, row);
    }
}

int list_keys(json_t *sections, int count, char **names) {
    const char *known[TABLES];
    for (int k = 0; k < TABLES; k++) {
        known[k] = tables[k].command;
        if (count > 0 && strcmp(names[0], known[k]) != 0) continue;
        if (count < 2) {
            add_rows(sections, &tables[k], NULL);
            continue;
        }
        bool *seen = sn_alloc((size_t)tables[k].count, sizeof *seen);
        if (!seen) return cli_fail(SN_E_MEMORY);
        int code = -1;
        for (int i = 1; i < count && code < 0; i++) {
            scan s = {&tables[k], names[i], seen};
            code = scan_file(&s);
        }
        if (code < 0) add_rows(sections, &tables[k], seen);
        sn_free(seen);
        return code;
    }
    return json_array_size(sections) ? -1 : cli_unknown("command", names[0], known, TABLES);
}
