// Units and quantities through UDUNITS-2.
// SPDX-License-Identifier: Apache-2.0
//
// UDUNITS takes more than a file of measurements should say, so a gate stands before it:
//   - a number inside a unit is refused ("1 500 kPa" would be 1 times 500 kPa), but for exponents
//     and the 1 of "1/s";
//   - "@ 273" and "since 2000" (origins), and unbalanced parentheses (it ignores a trailing one);
//   - logarithmic units and factors that are zero, negative or not finite;
//   - an angle where none is wanted: to UDUNITS a radian is a pure number, so rad/s would pass for
//     Hz with factor 1. A frequency in rad/s or rpm is divided by 2 pi.
// Its parser keeps its state in globals; a lock stands round every call.
#include "io/units.h"

#include <ctype.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <udunits2.h>

#include "io/text.h"

#define PI 3.14159265358979323846
#define UNIT_MAX 64 // longest unit, bytes

// The dimensions that files use: what to call them and which units to suggest. The first unit is
// the example in messages; values are printed in the first of them that gives 1 or more.
typedef struct dimension {
    const char *si, *what;
    const char *unit[6]; // NULL-terminated
    const char *print[4];
} dimension;

static const dimension dimensions[] = {
    {"1", "a pure number", {"%", "1"}, {NULL}},
    {"s", "a time", {"s", "ms", "us", "min", "h"}, {"s", "ms", "us"}},
    {"m", "a length", {"mm", "m", "cm", "um", "km"}, {"m", "mm", "um"}},
    {"m2", "an area", {"mm2", "cm2", "m2", "um2"}, {"m2", "mm2"}},
    {"m3", "a volume", {"mm3", "cm3", "m3", "l", "ml"}, {"m3", "mm3"}},
    {"N", "a force", {"N", "mN", "kN", "uN", "gf"}, {"N", "mN"}},
    {"Pa", "a pressure", {"kPa", "Pa", "MPa", "GPa", "mmHg"}, {"GPa", "MPa", "kPa", "Pa"}},
    {"Hz", "a frequency", {"Hz", "kHz", "mHz", "rad/s", "1/s"}, {"Hz"}},
    {"1/s", "a rate", {"1/s", "1/min", "1/ms"}, {"1/s"}},
    {"kg/m3", "a density", {"kg/m3", "g/cm3"}, {"kg/m3"}},
    {"m/s2", "an acceleration", {"m/s2", "mm/s2"}, {"m/s2"}},
    {"m/s", "a speed", {"mm/s", "m/s", "mm/min"}, {"m/s", "mm/s"}},
    {"kg", "a mass", {"kg", "g", "mg"}, {"kg", "g"}},
    {"rad", "an angle", {"deg", "rad"}, {"rad"}},
    {"J", "an energy", {"J", "mJ", "kJ"}, {"J"}},
    {"N/m", "a force over length", {"N/m", "N/mm", "mN/mm"}, {"N/m"}},
    {"Pa s", "a viscosity", {"Pa s", "kPa s", "mPa s"}, {"Pa s"}},
    {"K", "a temperature", {"degC", "K"}, {"K"}},
};
enum { DIMENSION_COUNT = sizeof dimensions / sizeof dimensions[0] };

static const dimension *dimension_find(const char *si_unit) {
    for (int k = 0; k < DIMENSION_COUNT; k++)
        if (strcmp(dimensions[k].si, si_unit) == 0) return &dimensions[k];
    return NULL;
}

void sn_unit_example(const char *si_unit, char out[SN_NAME_MAX]) {
    const dimension *d = dimension_find(si_unit);
    if (!d)
        snprintf(out, SN_NAME_MAX, "a quantity in %s", si_unit);
    else if (strcmp(si_unit, "1") == 0)
        snprintf(out, SN_NAME_MAX, "a number such as 0.5");
    else
        snprintf(out, SN_NAME_MAX, "%s such as \"10 %s\"", d->what, d->unit[0]);
}

//---- UDUNITS -------------------------------------------------------------------------------------

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static ut_system *unit_system; // lives as long as the process

// Units people write that the database knows by a longer name only; as symbols, so that they take
// prefixes.
static void add_symbol(const char *symbol, const char *name) {
    ut_unit *unit = ut_get_unit_by_name(unit_system, name);
    if (unit) ut_map_symbol_to_unit(symbol, UT_ASCII, unit);
    ut_free(unit);
}

// Opens the database at the first call; the lock is held.
static sn_status open_system(void) {
    if (unit_system) return SN_OK;
    ut_set_error_message_handler(ut_ignore);
    unit_system = ut_read_xml(NULL);
    if (!unit_system)
        return sn_fail(SN_E_FILE, "cannot read the units database of UDUNITS-2: install "
                                  "libudunits2-data, or set UDUNITS2_XML_PATH");
    add_symbol("dyn", "dyne");
    add_symbol("deg", "degree");
    return SN_OK;
}

// Whether the characters of a unit are such as a file may have; see the head of this file.
static bool unit_allowed(const char *unit) {
    int depth = 0;
    if (strlen(unit) >= UNIT_MAX || !sn_text_is_utf8(unit)) return false;
    for (const char *s = unit; *s; s++) {
        if (*s == '(') depth++;
        if (*s == ')' && --depth < 0) return false;
        if (*s == '@' || (unsigned char)*s < 0x20) return false;
        if (!isdigit((unsigned char)*s)) continue;
        if (s == unit) {
            const char *after = s + 1 + strspn(s + 1, " ");
            if (*s != '1' || (*after != '/' && *after != 0)) return false;
            continue;
        }
        char before = s[-1];
        if ((before == '-' || before == '+') && s - unit >= 2) before = s[-2];
        if (!isalnum((unsigned char)before) && before != '^' && before != ')') return false;
    }
    return depth == 0;
}

// Whether a unit has an angle in it.
static bool has_angle(const ut_unit *unit) {
    char text[256];
    int length = ut_format(unit, text, sizeof text, UT_DEFINITION | UT_ASCII);
    return length > 0 && length < (int)sizeof text && strstr(text, "rad") != NULL;
}

// Factor and offset between two units of one dimension; false where the map is not a straight line
// with a positive slope.
static bool linear_map(ut_unit *from, ut_unit *to, double *factor, double *offset) {
    cv_converter *converter = ut_get_converter(from, to);
    if (!converter) return false;
    double at0 = cv_convert_double(converter, 0.0), at1 = cv_convert_double(converter, 1.0);
    double at3 = cv_convert_double(converter, 3.0);
    cv_free(converter);
    *factor = at1 - at0;
    *offset = at0;
    double bend = fabs(at0 + 3.0 * *factor - at3);
    return isfinite(*factor) && isfinite(*offset) && *factor > 0.0 && bend <= 1e-12 * fabs(at3);
}

// Whether `unit` is of the dimension of `wanted`, with the map between them; the lock is held.
static bool unit_map(ut_unit *unit, ut_unit *wanted, const char *si_unit, double *factor,
                     double *offset) {
    if (!ut_are_convertible(unit, wanted) || !linear_map(unit, wanted, factor, offset))
        return false;
    bool found_angle = has_angle(unit), wanted_angle = has_angle(wanted);
    if (wanted_angle && !found_angle) return false;
    if (found_angle && strcmp(si_unit, "Hz") == 0) *factor /= 2.0 * PI;
    return true;
}

// What a unit measures, or NULL where it is none of ours; the lock is held.
static const char *unit_dimension(ut_unit *unit) {
    for (int k = 0; k < DIMENSION_COUNT; k++) {
        double factor, offset;
        ut_unit *si = ut_parse(unit_system, dimensions[k].si, UT_UTF8);
        bool same = si && has_angle(si) == has_angle(unit) &&
                    unit_map(unit, si, dimensions[k].si, &factor, &offset);
        ut_free(si);
        if (same) return dimensions[k].what;
    }
    return NULL;
}

// The unit that was meant, of the wanted dimension first.
static const char *suggest_unit(const char *unit, const dimension *wanted) {
    const char *all[DIMENSION_COUNT * 6];
    int count = 0;
    for (int k = 0; wanted && k < 6 && wanted->unit[k]; k++) all[count++] = wanted->unit[k];
    const char *near = sn_suggest(unit, all, count);
    if (near) return near;
    for (int d = 0; d < DIMENSION_COUNT; d++)
        for (int k = 0; k < 6 && dimensions[d].unit[k]; k++) all[count++] = dimensions[d].unit[k];
    return sn_suggest(unit, all, count);
}

static sn_status unit_unknown(const char *unit, const char *si_unit) {
    const dimension *wanted = dimension_find(si_unit);
    const char *near = suggest_unit(unit, wanted);
    if (near)
        return sn_fail(SN_E_UNIT, "unknown unit \"%s\", did you mean \"%s\"?",
                       sn_text_quote(unit).text, near);
    return sn_fail(SN_E_UNIT, "unknown unit \"%s\", expected %s such as \"%s\"",
                   sn_text_quote(unit).text, wanted ? wanted->what : si_unit,
                   wanted ? wanted->unit[0] : si_unit);
}

static sn_status unit_wrong(const char *unit, const char *measures, const char *si_unit) {
    const dimension *wanted = dimension_find(si_unit);
    return sn_fail(SN_E_UNIT, "unit \"%s\"%s%s, expected %s such as \"%s\"",
                   sn_text_quote(unit).text, measures ? " is " : " does not fit",
                   measures ? measures : "", wanted ? wanted->what : si_unit,
                   wanted ? wanted->unit[0] : si_unit);
}

sn_status sn_unit_to_si(const char *unit, const char *si_unit, double *factor, double *offset) {
    char text[UNIT_MAX];
    snprintf(text, sizeof text, "%s", unit);
    const char *name = strlen(unit) < sizeof text ? sn_text_trim(text) : unit;
    const dimension *expected = dimension_find(si_unit);
    if (!*name)
        return sn_fail(SN_E_UNIT, "no unit, expected %s such as \"%s\"",
                       expected ? expected->what : si_unit, expected ? expected->unit[0] : si_unit);
    if (!unit_allowed(name)) return unit_unknown(name, si_unit);

    const char *measures = NULL;
    bool known = false, fits = false;
    pthread_mutex_lock(&lock);
    sn_status status = open_system();
    if (status == SN_OK) {
        ut_unit *found = ut_parse(unit_system, name, UT_UTF8);
        ut_unit *wanted = ut_parse(unit_system, si_unit, UT_UTF8);
        SN_ASSERT(wanted);
        known = found != NULL;
        fits = known && unit_map(found, wanted, si_unit, factor, offset);
        if (known && !fits) measures = unit_dimension(found);
        ut_free(found);
        ut_free(wanted);
    }
    pthread_mutex_unlock(&lock);
    if (status != SN_OK) return status;
    if (!known) return unit_unknown(name, si_unit);
    return fits ? SN_OK : unit_wrong(name, measures, si_unit);
}

double sn_unit_apply(double x, double factor, double offset) {
    double inverse = rint(1.0 / factor);
    bool divide = factor < 1.0 && inverse < 1e15 && fabs(inverse * factor - 1.0) < 1e-15;
    return (divide ? x / inverse : x * factor) + offset;
}

//---- quantities ----------------------------------------------------------------------------------

sn_status sn_quantity_parse(const char *text, const char *si_unit, double *value) {
    char example[SN_NAME_MAX];
    sn_unit_example(si_unit, example);
    while (*text == ' ' || *text == '\t') text++;
    double number, factor = 1.0, offset = 0.0;
    const char *unit;
    const char *problem = sn_number_parse(text, &number, &unit);
    if (problem) {
        if (!*text) return sn_fail(SN_E_SYNTAX, "found nothing, expected %s", example);
        return sn_fail(SN_E_SYNTAX, "found \"%s\" (%s), expected %s", sn_text_quote(text).text,
                       problem, example);
    }
    if (*unit == ',')
        return sn_fail(SN_E_SYNTAX, "found \"%s\", expected %s with a decimal point",
                       sn_text_quote(text).text, example);
    unit += strspn(unit, " \t");
    bool pure = strcmp(si_unit, "1") == 0;
    if (!*unit && !pure)
        return sn_fail(SN_E_UNIT, "found \"%s\" without a unit, expected %s",
                       sn_text_quote(text).text, example);
    if (*unit) {
        sn_status status = sn_unit_to_si(unit, si_unit, &factor, &offset);
        if (status != SN_OK)
            return sn_fail_within(status, "found \"%s\"", sn_text_quote(text).text);
    }
    double si = sn_unit_apply(number, factor, offset);
    if (!isfinite(si))
        return sn_fail(SN_E_SYNTAX, "found \"%s\" (a number too large), expected %s",
                       sn_text_quote(text).text, example);
    *value = si;
    return SN_OK;
}

// Prints value in `unit`; false where no text reads back as the same double.
static bool print_in(double value, const char *si_unit, const char *unit, char out[SN_NAME_MAX]) {
    double factor, offset, back;
    if (sn_unit_to_si(unit, si_unit, &factor, &offset) != SN_OK || fabs(value) < factor)
        return false;
    for (int digits = 6; digits <= 17; digits++) {
        char number[32];
        sn_number_format((value - offset) / factor, digits, number);
        snprintf(out, SN_NAME_MAX, "%s %s", number, unit);
        if (sn_quantity_parse(out, si_unit, &back) == SN_OK && back == value) return true;
    }
    return false;
}

void sn_quantity_print(double value, const char *si_unit, char out[SN_NAME_MAX]) {
    char number[32];
    const dimension *d = dimension_find(si_unit);
    for (int k = 0; d && k < 4 && d->print[k]; k++)
        if (print_in(value, si_unit, d->print[k], out)) return;
    sn_number_print(value, 6, number);
    bool pure = strcmp(si_unit, "1") == 0;
    snprintf(out, SN_NAME_MAX, "%s%s%s", number, pure ? "" : " ", pure ? "" : si_unit);
}
