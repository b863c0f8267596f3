// Units and quantities.
// SPDX-License-Identifier: Apache-2.0
#include <locale.h>
#include <pthread.h>

#include "check.h"
#include "io/text.h"
#include "io/units.h"

#define PI 3.14159265358979323846

// Factors from the definitions of the units (SI brochure; mmHg, cmH2O, gf by standard gravity).
static void factors_are_right(void **state) {
    (void)state;
    static const struct {
        const char *unit, *si;
        double factor;
    } table[] = {
        {"Pa", "Pa", 1},          {"kPa", "Pa", 1e3},
        {"MPa", "Pa", 1e6},       {"N/mm2", "Pa", 1e6},
        {"N/mm^2", "Pa", 1e6},    {"N/mm²", "Pa", 1e6},
        {"N mm-2", "Pa", 1e6},    {"mmHg", "Pa", 133.322387415},
        {"cmH2O", "Pa", 98.0665}, {"dyn/cm2", "Pa", 0.1},
        {"dyne/cm2", "Pa", 0.1},  {"kdyn", "N", 1e-2},
        {"gf", "N", 9.80665e-3},  {"mN", "N", 1e-3},
        {"mm", "m", 1e-3},        {"um", "m", 1e-6},
        {"\u00B5m", "m", 1e-6},   {"\u03BCm", "m", 1e-6},
        {"mm2", "m2", 1e-6},      {"ms", "s", 1e-3},
        {"min", "s", 60},         {"h", "s", 3600},
        {"1/s", "1/s", 1},        {"1 / min", "1/s", 1.0 / 60},
        {"%", "1", 0.01},         {"1", "1", 1},
        {"mm/mm", "1", 1},        {"kg/m3", "kg/m3", 1},
        {"g/cm3", "kg/m3", 1e3},  {"Pa s", "Pa s", 1},
        {"deg", "rad", PI / 180}, {"degree", "rad", PI / 180},
        {"Hz", "Hz", 1},          {"rad/s", "Hz", 0.5 / PI},
        {"rpm", "Hz", 1.0 / 60},  {"m/s2", "m/s2", 1},
        {" kPa ", "Pa", 1e3},     {"kN/(m mm)", "Pa", 1e6},
    };
    for (size_t k = 0; k < sizeof table / sizeof table[0]; k++) {
        double factor, offset;
        CHECK_OK(sn_unit_to_si(table[k].unit, table[k].si, &factor, &offset));
        CHECK_REL(factor, table[k].factor, 1e-11); // the database has rpm and mmHg to 12 digits
        CHECK_ABS(offset, 0.0, 0.0);
    }
}

static void offsets_are_kept(void **state) {
    (void)state;
    double value;
    CHECK_OK(sn_quantity_parse("37 degC", "K", &value));
    CHECK_REL(value, 310.15, 1e-14);
}

static void wrong_units_are_refused(void **state) {
    (void)state;
    double factor, offset;
    CHECK_FAILS(sn_unit_to_si("kpa", "Pa", &factor, &offset), SN_E_UNIT, "did you mean \"kPa\"?");
    CHECK_FAILS(sn_unit_to_si("KPA", "Pa", &factor, &offset), SN_E_UNIT, "did you mean \"kPa\"?");
    CHECK_FAILS(sn_unit_to_si("mm", "Pa", &factor, &offset), SN_E_UNIT,
                "unit \"mm\" is a length, expected a pressure such as \"kPa\"");
    CHECK_FAILS(sn_unit_to_si("rad/s", "1/s2", &factor, &offset), SN_E_UNIT, "1/s2");
    // an angle is none of these, although it has no dimension
    CHECK_FAILS(sn_unit_to_si("%", "rad", &factor, &offset), SN_E_UNIT, "an angle");
    static const char *const bad[] = {
        "",
        " ",
        "furlongg",
        "500 kPa",
        "1e3 Pa",
        "kPa 5",
        "m 2",
        "10",
        "m/2",
        "kPa)",
        "(kPa",
        "((",
        "Pa @ 3",
        "s since 2000",
        "m/",
        "m^",
        "0 m",
        "-mm",
        "- mm",
        "lg(re Pa)",
        "lg(re 1 Pa)",
        "m^9999",
        "m^999999999999999999999",
        "\xB5m",
        "m\n",
        "m\x01",
        "kPa -3",
        "1 kPa",
        "2/s",
        "x^10",
        "$",
        "\xF0\x9F\x92\xA9",
        "Pa,",
        "kPaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa"};
    for (size_t k = 0; k < sizeof bad / sizeof bad[0]; k++) {
        sn_status status = sn_unit_to_si(bad[k], "Pa", &factor, &offset);
        if (status != SN_E_UNIT || strpbrk(sn_error_text(), "\n\x01\xB5")) {
            print_message("\"%s\": %d \"%s\"\n", bad[k], (int)status, sn_error_text());
            fail();
        }
    }
}

static void quantities_are_read(void **state) {
    (void)state;
    static const struct {
        const char *text, *si;
        double value; // bits: what the decimal number in SI would be
    } table[] = {
        {"10 kPa", "Pa", 10e3},    {"10kPa", "Pa", 10e3},
        {"  3 mm  ", "m", 0.003},  {"7 mm", "m", 0.007},
        {"0.3 mm", "m", 0.0003},   {"5 ms", "s", 0.005},
        {"0.5 1/s", "1/s", 0.5},   {"-9.81 m/s2", "m/s2", -9.81},
        {"+1.5e3 Pa", "Pa", 1500}, {".5 N", "N", 0.5},
        {"5. N", "N", 5},          {"5.e-1 N", "N", 0.5},
        {"12", "1", 12},           {"12 %", "1", 0.12},
        {"0 mm", "m", 0},          {"1e-320 m", "m", 1e-320},
        {"3 1", "1", 3},
    };
    for (size_t k = 0; k < sizeof table / sizeof table[0]; k++) {
        double value;
        CHECK_OK(sn_quantity_parse(table[k].text, table[k].si, &value));
        CHECK_ABS(value, table[k].value, 0.0);
    }
}

static void bad_quantities_are_refused(void **state) {
    (void)state;
    static const struct {
        const char *text, *si;
        sn_status status;
        const char *part;
    } table[] = {
        {"10", "Pa", SN_E_UNIT,
         "found \"10\" without a unit, expected a pressure such as \"10 kPa\""},
        {"0", "m", SN_E_UNIT, "expected a length such as \"10 mm\""},
        {"10 mm", "Pa", SN_E_UNIT, "found \"10 mm\": unit \"mm\" is a length, expected"},
        {"10 kpa", "Pa", SN_E_UNIT, "did you mean \"kPa\"?"},
        {"", "Pa", SN_E_SYNTAX, "found nothing"},
        {"kPa", "Pa", SN_E_SYNTAX, "not a number"},
        {"nan Pa", "Pa", SN_E_SYNTAX, "not a number"},
        {"inf Pa", "Pa", SN_E_SYNTAX, "not a number"},
        {"-infinity", "1", SN_E_SYNTAX, "expected a number such as 0.5"},
        {"0x10 Pa", "Pa", SN_E_SYNTAX, "hexadecimal"},
        {"1e999 Pa", "Pa", SN_E_SYNTAX, "too large"},
        {"1e308 MPa", "Pa", SN_E_SYNTAX, "too large"},
        {"1,5 kPa", "Pa", SN_E_SYNTAX, "decimal point"},
        {"1 500 kPa", "Pa", SN_E_UNIT, "unknown unit \"500 kPa\""},
        {"10 kPa kPa", "Pa", SN_E_UNIT, "kPa kPa"},
        {"10 kPa 5", "Pa", SN_E_UNIT, "kPa 5"},
        {"1 abc", "1", SN_E_UNIT, "abc"},
        {"1.2.3", "1", SN_E_UNIT, ".3"},
        {"- 5 Pa", "Pa", SN_E_SYNTAX, "not a number"},
        {"--5 Pa", "Pa", SN_E_SYNTAX, "not a number"},
        {"5e Pa", "Pa", SN_E_UNIT, "e Pa"},
    };
    for (size_t k = 0; k < sizeof table / sizeof table[0]; k++) {
        double value = 42.0;
        CHECK_FAILS(sn_quantity_parse(table[k].text, table[k].si, &value), table[k].status,
                    table[k].part);
        CHECK_ABS(value, 42.0, 0.0); // untouched
    }
}

// The program around us may use decimal commas: set up as de_DE where the machine has it.
static void locale_does_not_matter(void **state) {
    (void)state;
    if (!setlocale(LC_NUMERIC, "de_DE.UTF-8") && !setlocale(LC_NUMERIC, "fr_FR.UTF-8")) skip();
    double value;
    char text[SN_NAME_MAX];
    sn_status status = sn_quantity_parse("1.5 kPa", "Pa", &value);
    sn_quantity_print(1500.0, "Pa", text);
    setlocale(LC_NUMERIC, "C");
    assert_int_equal(status, SN_OK);
    CHECK_ABS(value, 1500.0, 0.0);
    assert_string_equal(text, "1.5 kPa");
}

static void printing_reads_back_to_the_bit(void **state) {
    (void)state;
    char text[SN_NAME_MAX];
    static const struct {
        double value;
        const char *si, *text;
    } nice[] = {
        {20e3, "Pa", "20 kPa"},        {0.01, "s", "10 ms"}, {100, "s", "100 s"},
        {1100, "kg/m3", "1100 kg/m3"}, {0.003, "m", "3 mm"}, {0.1, "1", "0.1"},
        {-5e3, "Pa", "-5 kPa"},        {0, "Pa", "0 Pa"},    {2.5e6, "Pa", "2.5 MPa"},
        {1e-9, "s", "1e-09 s"},
    };
    for (size_t k = 0; k < sizeof nice / sizeof nice[0]; k++) {
        sn_quantity_print(nice[k].value, nice[k].si, text);
        assert_string_equal(text, nice[k].text);
    }
    static const char *const units[] = {"Pa", "s", "m", "1", "rad", "kg/m3", "N", "Hz"};
    uint64_t seed = 77;
    for (int k = 0; k < 4000; k++) {
        const char *si = units[k % 8];
        double value = check_random(&seed, -1, 1) * pow(10.0, check_random(&seed, -12, 12)), back;
        sn_quantity_print(value, si, text);
        CHECK_OK(sn_quantity_parse(text, si, &back));
        if (back != value) fail_msg("%s: %.17g came back as %.17g", text, value, back);
    }
}

static void *parse_many(void *argument) {
    bool *good = argument;
    for (int k = 0; k < 300; k++) {
        double value;
        *good = *good && sn_quantity_parse("2 N/mm2", "Pa", &value) == SN_OK && value == 2e6 &&
                sn_quantity_parse("2 kpa", "Pa", &value) == SN_E_UNIT;
    }
    return NULL;
}

static void threads_share_the_database(void **state) {
    (void)state;
    pthread_t thread[4];
    bool good[4] = {true, true, true, true};
    for (int k = 0; k < 4; k++)
        assert_int_equal(pthread_create(&thread[k], NULL, parse_many, &good[k]), 0);
    for (int k = 0; k < 4; k++) {
        pthread_join(thread[k], NULL);
        assert_true(good[k]);
    }
}

static void quotes_fit_one_line(void **state) {
    (void)state;
    assert_string_equal(sn_text_quote("a\nb\tc\x7F").text, "a?b?c?");
    assert_string_equal(sn_text_quote("\xB5m\xC0\xAF").text, "?m??");
    char text[200];
    for (int k = 0; k < 200; k += 2) memcpy(text + k, "\xC2\xB5", 2); // µ…
    text[199] = 0;
    for (int start = 0; start < 2; start++) {
        sn_quote quote = sn_text_quote(text + start);
        assert_true(sn_text_is_utf8(quote.text));
        assert_true(strlen(quote.text) < SN_QUOTE_MAX);
        assert_non_null(strstr(quote.text, "…"));
    }
    char trimmed[] = " \t\xC2\xA0 a b \xC2\xA0";
    assert_string_equal(sn_text_trim(trimmed), "a b");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        // first, so that the threads race for opening the database
        cmocka_unit_test(threads_share_the_database),
        cmocka_unit_test(factors_are_right),
        cmocka_unit_test(offsets_are_kept),
        cmocka_unit_test(wrong_units_are_refused),
        cmocka_unit_test(quantities_are_read),
        cmocka_unit_test(bad_quantities_are_refused),
        cmocka_unit_test(locale_does_not_matter),
        cmocka_unit_test(printing_reads_back_to_the_bit),
        cmocka_unit_test(quotes_fit_one_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
