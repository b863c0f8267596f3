// Reads case files: the keys at the top, and the settings of the engines.
// SPDX-License-Identifier: Apache-2.0
//
// What a key can see is checked where the key is read, with its line; what only the whole case can
// see (contradicting loads, a probe outside the body) is left to sn_case_check().
#include "io/case_file.h"

#define FRAMES_MAX 1e6 // most outputs of a run: a typing error should not fill the disk

static sn_status read_positive(const sn_yaml *node, const char *si_unit, double *value) {
    SN_TRY(sn_yaml_quantity(node, si_unit, value));
    if (*value > 0.0) return SN_OK;
    return sn_yaml_expected(node, SN_E_RANGE, "more than 0");
}

// A relative tolerance.
static sn_status read_tolerance(const sn_yaml *node, double *value) {
    SN_TRY(sn_yaml_quantity(node, "1", value));
    if (*value > 0.0 && *value < 1.0) return SN_OK;
    return sn_yaml_expected(node, SN_E_RANGE, "more than 0 and less than 1");
}

//---- engines -------------------------------------------------------------------------------------

// In the order of the enums.
static const char *const rung_names[] = {"central", "coupled", "smoothed"};
static const char *const integrator_names[] = {"explicit", "implicit", "quasi-static"};
static const char *const scheme_names[] = {"bdf2", "backward-euler"};
static const char *const precision_names[] = {"single", "double"};
static const char *const element_names[] = {"P1", "P2", "P2P1"};
static const char *const analysis_names[] = {"quasi-static", "dynamic", "linear"};
static const char *const solver_names[] = {"direct", "iterative"};

static sn_status read_step(const sn_yaml *node, double *step) {
    if (node->kind == SN_YAML_TEXT) {
        static const char *const word[] = {"auto"};
        int index;
        bool number = node->text[0] >= '0' && node->text[0] <= '9';
        if (number || node->text[0] == '-' || node->text[0] == '.' || node->text[0] == '+')
            return read_positive(node, "s", step);
        if (sn_yaml_choice(node, word, 1, &index) == SN_OK) {
            *step = 0.0;
            return SN_OK;
        }
    }
    return sn_yaml_expected(node, SN_E_SYNTAX, "auto or a time such as \"0.1 ms\"");
}

static sn_status read_coefficient(const sn_yaml *node, const char *unit, double *value) {
    SN_TRY(sn_yaml_quantity(node, unit, value));
    if (*value >= 0.0) return SN_OK;
    return sn_yaml_expected(node, SN_E_RANGE, unit[0] == 's' ? "0 s or more" : "0 1/s or more");
}

// a number is that of the mass
static sn_status read_damping(const sn_yaml *node, sn_springs_def *def) {
    static const char *const keys[] = {"mass", "stiffness"};
    const sn_yaml *value;
    if (node->kind == SN_YAML_TEXT) return read_coefficient(node, "1/s", &def->damping);
    SN_TRY(sn_yaml_map(node, keys, 2));
    if ((value = sn_yaml_get(node, "mass"))) SN_TRY(read_coefficient(value, "1/s", &def->damping));
    if ((value = sn_yaml_get(node, "stiffness")))
        SN_TRY(read_coefficient(value, "s", &def->stiffness_damping));
    return SN_OK;
}

sn_status sn_case_read_springs(const sn_yaml *node, sn_springs_def *def) {
    static const char *const keys[] = {
        "model",   "volume",  "integrator",       "scheme",    "step",     "precision",
        "threads", "damping", "memory_tolerance", "constants", "tolerance"};
    const sn_yaml *value;
    int index;
    SN_TRY(sn_yaml_map(node, keys, (int)(sizeof keys / sizeof *keys)));
    if ((value = sn_yaml_get(node, "model"))) {
        SN_TRY(sn_yaml_choice(value, rung_names, 3, &index));
        def->rung = (sn_rung)index;
    }
    if ((value = sn_yaml_get(node, "volume"))) SN_TRY(sn_yaml_bool(value, &def->volume));
    if ((value = sn_yaml_get(node, "integrator"))) {
        SN_TRY(sn_yaml_choice(value, integrator_names, 3, &index));
        def->integrator = (sn_integrator)index;
    }
    if ((value = sn_yaml_get(node, "scheme"))) {
        SN_TRY(sn_yaml_choice(value, scheme_names, 2, &index));
        def->scheme = (sn_scheme)index;
    }
    if ((value = sn_yaml_get(node, "step"))) SN_TRY(read_step(value, &def->step));
    if ((value = sn_yaml_get(node, "precision"))) {
        SN_TRY(sn_yaml_choice(value, precision_names, 2, &index));
        def->precision = (sn_precision)index;
    }
    if ((value = sn_yaml_get(node, "threads"))) SN_TRY(sn_yaml_int(value, 1, 1024, &def->threads));
    if ((value = sn_yaml_get(node, "damping"))) SN_TRY(read_damping(value, def));
    if ((value = sn_yaml_get(node, "memory_tolerance")))
        SN_TRY(read_tolerance(value, &def->memory_tolerance));
    if (!(value = sn_yaml_get(node, "tolerance"))) return SN_OK;
    if (def->integrator == SN_INTEGRATOR_EXPLICIT)
        return sn_yaml_fail(value, SN_E_DEFINITION,
                            "the explicit integrator solves no equations; give \"integrator: "
                            "quasi-static\" or \"implicit\" too, or leave it away");
    return read_tolerance(value, &def->tolerance);
}

// A longest step, or a tolerance that chooses the steps: what a dynamic run does unless told.
static sn_status read_continuum_step(const sn_yaml *node, sn_continuum_def *def) {
    const sn_yaml *step = sn_yaml_get(node, "step"),
                  *tolerance = sn_yaml_get(node, "step_tolerance");
    bool dynamic = def->analysis == SN_ANALYSIS_DYNAMIC;
    const sn_yaml *word = NULL;
    if (step) SN_TRY(read_step(step, &def->step));
    if (step && !(def->step > 0.0)) word = step;
    if (tolerance) word = tolerance;
    if (word && !dynamic)
        return sn_yaml_fail(word, SN_E_UNSUPPORTED,
                            "steps are chosen by their error in analysis: dynamic only; the other "
                            "analyses take \"steps\" or a longest \"step\"");
    if (word || (dynamic && !step && !sn_yaml_get(node, "steps")))
        def->step_tolerance = SN_STEP_TOLERANCE;
    return tolerance ? read_tolerance(tolerance, &def->step_tolerance) : SN_OK;
}

// `constants` of `springs`, which need the mesh
static sn_status read_constants(const sn_yaml *springs, sn_case *c) {
    const sn_yaml *node = springs ? sn_yaml_get(springs, "constants") : NULL;
    const char *name;
    char *path;
    if (!node) return SN_OK;
    if (c->springs.rung != SN_RUNG_CENTRAL)
        return sn_yaml_fail(node, SN_E_DEFINITION,
                            "only the springs of model central have constants of their own: give "
                            "\"model: central\" too, or leave them away");
    SN_TRY(sn_yaml_text(node, "the path of a table that sinew calibrate wrote", &name));
    SN_TRY(sn_case_join_path(node, name, &path));
    sn_status status = sn_springs_read(path, c->mesh, &c->springs_given);
    sn_free(path);
    return sn_yaml_within(node, status);
}

sn_status sn_case_read_continuum(const sn_yaml *node, sn_continuum_def *def) {
    static const char *const keys[] = {
        "element",   "analysis",         "steps",          "step",  "rho_infinity",
        "tolerance", "memory_tolerance", "step_tolerance", "solver"};
    const sn_yaml *value;
    int index;
    SN_TRY(sn_yaml_map(node, keys, (int)(sizeof keys / sizeof *keys)));
    if ((value = sn_yaml_get(node, "element"))) {
        SN_TRY(sn_yaml_choice(value, element_names, 3, &index));
        def->element = (sn_element)index;
    }
    if ((value = sn_yaml_get(node, "analysis"))) {
        SN_TRY(sn_yaml_choice(value, analysis_names, 3, &index));
        def->analysis = (sn_analysis)index;
    }
    if ((value = sn_yaml_get(node, "solver"))) {
        SN_TRY(sn_yaml_choice(value, solver_names, 2, &index));
        def->solver = (sn_solver)index;
    }
    if ((value = sn_yaml_get(node, "steps"))) SN_TRY(sn_yaml_int(value, 1, 1000000, &def->steps));
    SN_TRY(read_continuum_step(node, def));
    if ((value = sn_yaml_get(node, "rho_infinity"))) {
        SN_TRY(sn_yaml_quantity(value, "1", &def->rho_infinity));
        if (!(def->rho_infinity >= 0.0 && def->rho_infinity <= 1.0))
            return sn_yaml_expected(value, SN_E_RANGE, "0 (most damping) to 1 (none)");
    }
    if ((value = sn_yaml_get(node, "tolerance"))) SN_TRY(read_tolerance(value, &def->tolerance));
    if ((value = sn_yaml_get(node, "memory_tolerance")))
        SN_TRY(read_tolerance(value, &def->memory_tolerance));
    return SN_OK;
}

//---- the keys at the top -------------------------------------------------------------------------

static sn_status read_time(const sn_yaml *node, sn_case *c) {
    static const char *const keys[] = {"until", "output_every"};
    const sn_yaml *value;
    SN_TRY(sn_yaml_map(node, keys, 2));
    SN_TRY(sn_yaml_need(node, "until", &value));
    SN_TRY(read_positive(value, "s", &c->until));
    c->output_every = c->until / 100.0;
    if (!(value = sn_yaml_get(node, "output_every"))) return SN_OK;
    SN_TRY(read_positive(value, "s", &c->output_every));
    if (c->until / c->output_every > FRAMES_MAX)
        return sn_yaml_expected(value, SN_E_RANGE, "at least a millionth of \"until\"");
    return SN_OK;
}

static sn_status read_settings(const sn_yaml *root, sn_case *c) {
    const sn_yaml *node;
    SN_TRY(sn_yaml_need(root, "case", &node));
    SN_TRY(sn_yaml_copy(node, "the name of the case", c->name, sizeof c->name));
    SN_TRY(sn_yaml_need(root, "time", &node));
    SN_TRY(read_time(node, c));
    if ((node = sn_yaml_get(root, "gravity")))
        SN_TRY(sn_yaml_quantities(node, "m/s2", 3, c->gravity));
    if ((node = sn_yaml_get(root, "springs"))) SN_TRY(sn_case_read_springs(node, &c->springs));
    if ((node = sn_yaml_get(root, "continuum")))
        SN_TRY(sn_case_read_continuum(node, &c->continuum));
    return SN_OK;
}

static sn_status read_case(const sn_yaml *root, sn_case *c) {
    static const char *const keys[] = {"case",     "mesh",      "tissue", "fibres", "gravity",
                                       "supports", "loads",     "tools",  "probes", "time",
                                       "springs",  "continuum", "cuts"};
    const sn_yaml *node;
    SN_TRY(sn_yaml_map(root, keys, 13));
    // what is cheap to check comes before the mesh is built
    SN_TRY(read_settings(root, c));
    SN_TRY(sn_yaml_need(root, "tissue", &node));
    SN_TRY(sn_yaml_need(root, "mesh", &node));
    SN_TRY(sn_case_read_mesh(node, c));
    SN_TRY(sn_case_read_tissues(sn_yaml_get(root, "tissue"), c));
    if ((node = sn_yaml_get(root, "fibres"))) SN_TRY(sn_case_read_fibres(node, c));
    SN_TRY(read_constants(sn_yaml_get(root, "springs"), c));
    if ((node = sn_yaml_get(root, "supports"))) SN_TRY(sn_case_read_supports(node, c));
    if ((node = sn_yaml_get(root, "loads"))) SN_TRY(sn_case_read_loads(node, c));
    if ((node = sn_yaml_get(root, "tools"))) SN_TRY(sn_case_read_tools(node, c));
    if ((node = sn_yaml_get(root, "probes"))) SN_TRY(sn_case_read_probes(node, c));
    if ((node = sn_yaml_get(root, "cuts"))) SN_TRY(sn_case_read_cuts(node, c));
    sn_status status = sn_case_check(c);
    return status == SN_OK ? SN_OK : sn_fail_within(status, "%s", root->file);
}

sn_status sn_case_read(const char *path, sn_case **c) {
    *c = NULL;
    sn_yaml *root = NULL;
    sn_case *read = NULL;
    sn_status status;
    SN_TRY_GOTO(status, sn_yaml_read(path, &root));
    SN_TRY_GOTO(status, sn_case_create(&read));
    SN_TRY_GOTO(status, read_case(root, read));
    *c = read;
    read = NULL;
fail:
    sn_case_destroy(read);
    sn_yaml_destroy(root);
    return status;
}
