// Reads case files: the keys at the top, and the settings of the engines.
// SPDX-License-Identifier: Apache-2.0
//
// What a key can see is checked where the key is read, with its line; what only the whole case can
// see (contradicting loads, a probe outside the body) is left to sn_case_check().
#include "io/case_file.h"

#include <math.h>

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
    static const char *const keys[] = {"model",   "volume",  "integrator",
                                       "scheme",  "step",    "precision",
                                       "threads", "damping", "memory_tolerance"};
    const sn_yaml *value;
    int index;
    SN_TRY(sn_yaml_map(node, keys, 9));
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
    return SN_OK;
}

sn_status sn_case_read_continuum(const sn_yaml *node, sn_continuum_def *def) {
    static const char *const keys[] = {
        "element",   "analysis",         "steps", "step", "rho_infinity",
        "tolerance", "memory_tolerance", "solver"};
    const sn_yaml *value;
    int index;
    SN_TRY(sn_yaml_map(node, keys, 8));
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
    if ((value = sn_yaml_get(node, "step"))) SN_TRY(read_positive(value, "s", &def->step));
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

static sn_status read_fibres(const sn_yaml *node, sn_case *c) {
    double v[3];
    if (node->kind != SN_YAML_LIST)
        return sn_yaml_expected(node, SN_E_UNSUPPORTED,
                                "one direction such as [1, 0, 0] (rules and files for fibres are "
                                "not supported)");
    SN_TRY(sn_yaml_quantities(node, "1", 3, v));
    double largest = fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2])));
    if (!(largest > 0.0)) return sn_yaml_fail(node, SN_E_RANGE, "the direction has no length");
    for (int i = 0; i < 3; i++) v[i] /= largest; // no overflow in the squares
    double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 3; i++) c->fibre[i] = v[i] / length;
    return SN_OK;
}

static sn_status read_settings(const sn_yaml *root, sn_case *c) {
    const sn_yaml *node;
    SN_TRY(sn_yaml_need(root, "case", &node));
    SN_TRY(sn_yaml_copy(node, "the name of the case", c->name, sizeof c->name));
    SN_TRY(sn_yaml_need(root, "time", &node));
    SN_TRY(read_time(node, c));
    if ((node = sn_yaml_get(root, "fibres"))) SN_TRY(read_fibres(node, c));
    if ((node = sn_yaml_get(root, "gravity")))
        SN_TRY(sn_yaml_quantities(node, "m/s2", 3, c->gravity));
    if ((node = sn_yaml_get(root, "springs"))) SN_TRY(sn_case_read_springs(node, &c->springs));
    if ((node = sn_yaml_get(root, "continuum")))
        SN_TRY(sn_case_read_continuum(node, &c->continuum));
    return SN_OK;
}

static sn_status read_case(const sn_yaml *root, sn_case *c) {
    static const char *const keys[] = {"case",    "mesh",     "tissue",  "fibres",
                                       "gravity", "supports", "loads",   "tools",
                                       "probes",  "time",     "springs", "continuum"};
    const sn_yaml *node;
    SN_TRY(sn_yaml_map(root, keys, 12));
    // what is cheap to check comes before the mesh is built
    SN_TRY(read_settings(root, c));
    SN_TRY(sn_yaml_need(root, "tissue", &node));
    SN_TRY(sn_yaml_need(root, "mesh", &node));
    SN_TRY(sn_case_read_mesh(node, c));
    SN_TRY(sn_case_read_tissues(sn_yaml_get(root, "tissue"), c));
    if ((node = sn_yaml_get(root, "supports"))) SN_TRY(sn_case_read_supports(node, c));
    if ((node = sn_yaml_get(root, "loads"))) SN_TRY(sn_case_read_loads(node, c));
    if ((node = sn_yaml_get(root, "tools"))) SN_TRY(sn_case_read_tools(node, c));
    if ((node = sn_yaml_get(root, "probes"))) SN_TRY(sn_case_read_probes(node, c));
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
