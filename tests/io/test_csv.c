// Curves: reading and writing.
// SPDX-License-Identifier: Apache-2.0
#include "hostile.h"

static const char valid[] = "# area: 4.2 mm2\n# specimen: rabbit 12: abdominal skin\n"
                            "time [s],stretch [1],stress [kPa]\n"
                            "0,1,0\n0.01,1.001,0.05\n0.02,1.002,0.1\n";

static sn_record *read_text(const char *text) {
    sn_record *record;
    CHECK_OK(sn_curve_read(scratch_write("curve.csv", text, strlen(text)), &record));
    return record;
}

static void check_column(const sn_record *record, const char *name, const char *unit, int count,
                         const double *expected) {
    int k = sn_record_find(record, name);
    assert_true(k >= 0);
    assert_string_equal(record->series[k].unit, unit);
    assert_int_equal(record->rows, count);
    for (int i = 0; i < count; i++) CHECK_ABS(record->series[k].value[i], expected[i], 0.0);
}

static sn_status read_and_check(const char *path) {
    sn_record *record;
    sn_status status = sn_curve_read(path, &record);
    if (status != SN_OK) {
        assert_null(record);
        return status;
    }
    assert_true(record->rows > 0 && record->series_count > 0);
    for (int k = 0; k < record->series_count; k++)
        for (int i = 0; i < record->rows; i++) assert_true(isfinite(record->series[k].value[i]));
    sn_record_destroy(record);
    return SN_OK;
}

//---- accepted ------------------------------------------------------------------------------------

static void plain_curve(void **state) {
    (void)state;
    sn_record *record = read_text(valid);
    check_column(record, "time", "s", 3, (double[]){0, 0.01, 0.02});
    check_column(record, "stretch", "1", 3, (double[]){1, 1.001, 1.002});
    check_column(record, "stress", "Pa", 3, (double[]){0, 50, 100});
    const sn_note *area = sn_record_note(record, "area");
    assert_non_null(area);
    CHECK_REL(area->value, 4.2e-6, 1e-15); // one rounding of the decimal number
    assert_string_equal(area->text, "4.2 mm2");
    const sn_note *specimen = sn_record_note(record, "specimen");
    assert_non_null(specimen);
    assert_true(isnan(specimen->value));
    assert_string_equal(specimen->text, "rabbit 12: abdominal skin");
    assert_non_null(strstr(record->name, "curve.csv"));
    sn_record_destroy(record);
}

// One curve in all forms that are accepted.
static void forms_are_equal(void **state) {
    (void)state;
    static const char *const forms[] = {
        "time [s],force [N],extension [mm]\n0,0.5,1.25\n1,-2e3,3\n",
        "\xEF\xBB\xBFtime [s],force [N],extension [mm]\r\n0,0.5,1.25\r\n1,-2e3,3\r\n",
        "time [s],force [N],extension [mm]\r0,0.5,1.25\r1,-2e3,3",
        "time [s];force [N];extension [mm]\n0;0.5;1.25\n1;-2e3;3\n",
        "time [s];force [N];extension [mm]\n0;0,5;1,25\n1;-2e3;3\n",
        "time [s]\tforce [N]\textension [mm]\n0\t0,5\t1,25\n1\t-2e3\t3\n",
        "time,force,extension\ns,N,mm\n0,0.5,1.25\n1,-2e3,3\n",
        "time;force;extension\n(s);(N);(mm)\n0;0,5;1,25\n1;-2e3;3\n",
        "time, force, extension\n[s], [N], [mm]\n 0, 0.5, 1.25 \n1 ,-2e3 , 3\n",
        "\n# a: x\n\n  # b\ntime [s],force [N],extension [mm]\n\n0,0.5,1.25\n# c\n1,-2e3,3\n\n",
        "\"time [s]\",\"force [N]\",\"extension [mm]\"\n\"0\",\"0.5\",\"1.25\"\n1,-2e3,3\n",
        "time [ms],force [mN],extension [m]\n0,500,0.00125\n1000,-2000000,0.003\n",
        "time[s],force[kg m/s2],extension[cm]\n0,0.5,0.125\n1,-2e3,.3\n",
    };
    for (size_t k = 0; k < sizeof forms / sizeof forms[0]; k++) {
        sn_record *record = read_text(forms[k]);
        assert_int_equal(record->series_count, 3);
        check_column(record, "time", "s", 2, (double[]){0, 1});
        check_column(record, "force", "N", 2, (double[]){0.5, -2e3});
        check_column(record, "extension", "m", 2, (double[]){0.00125, 0.003});
        sn_record_destroy(record);
    }
}

static void all_columns_are_known(void **state) {
    (void)state;
    sn_record *record = read_text(
        "time [min],cycle,force_1 [mN],force_2 [kN],stretch_1 [1],stretch_2 [%],strain [%],"
        "true_stress [MPa],green_strain [-],pk2_stress_2 [GPa],length [um],shear_strain [rad],"
        "shear_stress [N/mm2],frequency [rad/s],storage_modulus [Pa],loss_modulus [mmHg]\n"
        "1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16\n");
    static const struct {
        const char *name, *unit;
        double value;
    } expected[] = {
        {"time", "s", 60},
        {"cycle", "1", 2},
        {"force_1", "N", 0.003},
        {"force_2", "N", 4000},
        {"stretch_1", "1", 5},
        {"stretch_2", "1", 0.06},
        {"strain", "1", 0.07},
        {"true_stress", "Pa", 8e6},
        {"green_strain", "1", 9},
        {"pk2_stress_2", "Pa", 1e10},
        {"length", "m", 11e-6},
        {"shear_strain", "1", 12},
        {"shear_stress", "Pa", 13e6},
        {"storage_modulus", "Pa", 15},
    };
    assert_int_equal(record->series_count, 16);
    for (size_t k = 0; k < sizeof expected / sizeof expected[0]; k++)
        check_column(record, expected[k].name, expected[k].unit, 1, &expected[k].value);
    CHECK_REL(sn_record_values(record, "frequency")[0], 14 / 6.283185307179586, 1e-15);
    CHECK_REL(sn_record_values(record, "loss_modulus")[0], 16 * 133.322387415, 1e-12);
    sn_record_destroy(record);
}

// Machines write Latin-1: "µm" with the one byte B5, "mm²" with B2.
static void latin1_is_understood(void **state) {
    (void)state;
    sn_record *record = read_text("# area: 2 mm\xB2\n# place: Z\xFCrich\n"
                                  "extension [\xB5m],stress [N/mm\xB2]\n5,2\n");
    check_column(record, "extension", "m", 1, (double[]){5e-6});
    check_column(record, "stress", "Pa", 1, (double[]){2e6});
    CHECK_REL(sn_record_note(record, "area")->value, 2e-6, 1e-15);
    assert_string_equal(sn_record_note(record, "place")->text, "Zürich");
    sn_record_destroy(record);
}

static void long_remarks_are_cut_at_a_character(void **state) {
    (void)state;
    char text[1200] = "# source: x";
    for (int k = 0; k < 200; k++) strcat(text, "µ");
    strcat(text, "\ntime [s]\n1\n");
    sn_record *record = read_text(text);
    const sn_note *note = sn_record_note(record, "source");
    assert_int_equal(strlen(note->text), SN_TEXT_MAX - 1); // "x" and 127 characters of two bytes
    assert_string_equal(note->text + SN_TEXT_MAX - 3, "µ");
    sn_record_destroy(record);
}

//---- refused -------------------------------------------------------------------------------------

#define H "time [s],stretch [1],stress [kPa]\n"

static void bad_curves_are_refused(void **state) {
    (void)state;
    static const hostile table[] = {
        {"", SN_E_DATA, "the file is empty", "time [s]"},
        {"\n\n# only: remarks\n", SN_E_DATA, "the file is empty", NULL},
        {H, SN_E_DATA, "no row of data", NULL},
        {"time,stress\ns,kPa\n", SN_E_DATA, "no row of data", NULL},
        {"time [s],stress \n0,1\n", SN_E_UNIT, "curve.csv:1: column \"stress\": no unit",
         "stress [Pa]"},
        {"time [s],strain\n0,1\n", SN_E_UNIT, "curve.csv:1: column \"strain\": no unit", "[%]"},
        {"time [s],stress []\n0,1\n", SN_E_UNIT, "column \"stress\": no unit", NULL},
        {"time,stress\n0,1\n2,3\n", SN_E_UNIT, "curve.csv:1: column \"time\": no unit", NULL},
        {"time,stress\ns,\n2,3\n", SN_E_UNIT, "curve.csv:2: column \"stress\": no unit", NULL},
        {"time,stress\ns,kpa\n2,3\n", SN_E_UNIT, "curve.csv:2: column \"stress\"",
         "did you mean \"kPa\""},
        {"time [s],stress [mm]\n0,1\n", SN_E_UNIT,
         "curve.csv:1: column \"stress\": unit \"mm\" is a length", "a pressure"},
        {"time [s],strain [furlong]\n0,1\n", SN_E_UNIT, "column \"strain\"", "is a length"},
        {"time [s],stress [kpa]\n0,1\n", SN_E_UNIT, "unknown unit \"kpa\"",
         "did you mean \"kPa\"?"},
        {"time [s],stress [kPa\n0,1\n", SN_E_SYNTAX, "expected \"name [unit]\"", NULL},
        {"time [s],stress [kPa] x\n0,1\n", SN_E_SYNTAX, "expected \"name [unit]\"", NULL},
        {"time [s],stres [kPa]\n0,1\n", SN_E_KEY, "curve.csv:1: unknown column \"stres\"",
         "did you mean \"stress [Pa]\"?"},
        {"Time (s),Load (N)\n0,1\n", SN_E_KEY, "unknown column \"Time (s)\"",
         "did you mean \"time [s]\"?"},
        {"time [s],load [N]\n0,1\n", SN_E_KEY, "unknown column \"load\"",
         "did you mean \"force [N]\"?"},
        {"time [s],time_1 [s]\n0,1\n", SN_E_KEY, "unknown column \"time_1\"", NULL},
        {"time [s],force_3 [N]\n0,1\n", SN_E_KEY, "unknown column \"force_3\"", NULL},
        {"time [s],qqqqqqqqqqqq [N]\n0,1\n", SN_E_KEY, "unknown column",
         "expected a header such as"},
        {"time [s],stress [Pa],stress [kPa]\n0,1,2\n", SN_E_KEY,
         "column \"stress\": stands in the header twice", NULL},
        {"time [s],stress [Pa],\n0,1,\n", SN_E_SYNTAX, "a column has no name", NULL},
        {"0,1,2\n1,2,3\n", SN_E_KEY, "curve.csv:1: unknown column \"0\"", NULL},
        {H "0,1,0\n0.1,1.01,nan\n", SN_E_DATA,
         "curve.csv:3: column \"stress\": found \"nan\", expected a number", NULL},
        {H "0,1,0\n0.1,1.01,NaN\n", SN_E_DATA, "found \"NaN\"", NULL},
        {H "0,1,inf\n", SN_E_DATA, "curve.csv:2: column \"stress\": found \"inf\"", NULL},
        {H "0,1,-Infinity\n", SN_E_DATA, "found \"-Infinity\"", NULL},
        {H "0,1,1e999\n", SN_E_DATA, "found \"1e999\" (too large)", NULL},
        {H "0,1,1e306\n", SN_E_DATA, "found \"1e306\" (too large)", NULL}, // in Pa
        {H "0,abc,0\n", SN_E_DATA,
         "curve.csv:2: column \"stretch\": found \"abc\", expected a number", NULL},
        {H "0,1x,0\n", SN_E_DATA, "found \"1x\"", NULL},
        {H "0,0x1p3,0\n", SN_E_DATA, "found \"0x1p3\"", NULL},
        {H "0,1 2,0\n", SN_E_DATA, "found \"1 2\"", NULL},
        {H "0,,0\n", SN_E_DATA, "column \"stretch\": found \"\"", NULL},
        {H "0,1,0\n5.0,1.2\n", SN_E_DATA, "curve.csv:3: found 2 columns, expected 3", NULL},
        {H "0,1,0,9\n", SN_E_DATA, "curve.csv:2: found 4 columns, expected 3", NULL},
        {H "0;1;0\n", SN_E_DATA, "found 1 columns, expected 3", NULL},
        {H "0,1,0\n" H "0,1,0\n", SN_E_DATA, "curve.csv:3: column \"time\": found \"time [s]\"",
         NULL},
        {H "0,\"1,0\n", SN_E_SYNTAX, "curve.csv:2: a quote is open", NULL},
        {H "0,\"1\"x,0\n", SN_E_SYNTAX, "curve.csv:2: text after a closing quote", NULL},
        {"time [s];stress [Pa]\n0;1,5\n1;1.5\n", SN_E_DATA, "curve.csv:3",
         "decimal commas stand from line 2"},
        {"time [s];stress [Pa]\n0;1.5\n1;1,5\n", SN_E_DATA, "curve.csv:3",
         "decimal points stand from line 2"},
        {"time [s];stress [Pa]\n0;1.234,5\n", SN_E_DATA, "found \"1.234,5\" (thousands separators",
         NULL},
        {"time [s];stress [Pa]\n0;1,234,567\n", SN_E_DATA, "thousands separators", NULL},
        {"# area: 4.2\n" H "0,1,0\n", SN_E_UNIT,
         "curve.csv:1: \"area\": found \"4.2\" without a unit", NULL},
        {"# area: 4.2 mm\n" H "0,1,0\n", SN_E_UNIT, "\"area\"", "an area"},
        {"# area: 0 mm2\n" H "0,1,0\n", SN_E_RANGE,
         "\"area\": found \"0 mm2\", expected more than 0", NULL},
        {"# area: -1 mm2\n" H "0,1,0\n", SN_E_RANGE, "expected more than 0", NULL},
        {"# area: nan mm2\n" H "0,1,0\n", SN_E_SYNTAX, "\"area\": found \"nan mm2\"", NULL},
        {"# gauge_length: long\n" H "0,1,0\n", SN_E_SYNTAX, "\"gauge_length\": found \"long\"",
         NULL},
        {"# area: 1 mm2\n# area: 2 mm2\n" H "0,1,0\n", SN_E_KEY,
         "curve.csv:2: \"area\" is given twice", NULL},
        {"\x89PNG\r\n\x1A\n", SN_E_KEY, "unknown column", NULL},
        {"{\"json\": [1, 2]}\n", SN_E_SYNTAX, "curve.csv:1", NULL},
    };
    check_hostile(read_and_check, "curve.csv", table, sizeof table / sizeof table[0]);
}

static void check_refused(const char *text, size_t bytes, sn_status status, const char *part) {
    const char *path = scratch_write("curve.csv", text, bytes);
    CHECK_FAILS(read_and_check(path), status, part);
    assert_true(message_useful("curve.csv"));
}

static void bytes_and_sizes_are_refused(void **state) {
    (void)state;
    sn_record *record;
    check_refused(H "0,1\0,0\n", sizeof H "0,1\0,0\n" - 1, SN_E_SYNTAX,
                  "curve.csv:2: found a zero byte");
    check_refused("\xFF\xFEt\0i\0", 6, SN_E_SYNTAX, "not UTF-16");
    char binary[5000];
    for (int k = 0; k < 5000; k++) binary[k] = (char)(k % 256);
    check_refused(binary, sizeof binary, SN_E_SYNTAX, "zero byte");
    size_t size = 200000;
    char *large = malloc(size);
    memset(large, '1', size);
    check_refused(large, size, SN_E_SYNTAX, "curve.csv:1: the line is longer than 65535 bytes");
    memset(large, '\xB5', size);
    large[40000] = '\n'; // fits as Latin-1, not as UTF-8
    check_refused(large, size, SN_E_SYNTAX, "longer than 65535 bytes");
    memset(large, ',', size);
    large[100] = '\n';
    check_refused(large, size, SN_E_SYNTAX, "more than 64 columns");
    size_t used = 0;
    for (int k = 0; k < 1001; k++) used += (size_t)sprintf(large + used, "# key%d: x\n", k);
    check_refused(large, used, SN_E_DATA, "curve.csv:1001: more than 1000 remarks");
    free(large);
    CHECK_FAILS(sn_curve_read(scratch_path("none.csv"), &record), SN_E_FILE,
                "none.csv: cannot open");
    CHECK_FAILS(sn_curve_read(scratch, &record), SN_E_FILE, "is a folder");
    CHECK_FAILS(sn_curve_read("/dev/zero", &record), SN_E_SYNTAX, "zero byte");
    assert_null(record);
}

static void mutations_are_survived(void **state) {
    (void)state;
    check_fuzz(read_and_check, "curve.csv", valid, 2000);
    check_fuzz(read_and_check, "curve.csv",
               "# thickness: 1,5 mm\ntime;force_1;extension\n[s];(mN);\"mm\"\n0;0,5;1\n1;2;\"3\"\n",
               1000);
}

//---- written -------------------------------------------------------------------------------------

static void written_curves_read_back_to_the_bit(void **state) {
    (void)state;
    sn_record *record, *back;
    uint64_t seed = 5;
    CHECK_OK(sn_record_create("test", &record));
    CHECK_OK(sn_record_add_note(record, "area", "4.2 mm2", 4.2e-6));
    CHECK_OK(sn_record_add_note(record, "source", "two\nlines: \"and\" more", (double)NAN));
    CHECK_OK(sn_record_add_series(record, "time", "s"));
    CHECK_OK(sn_record_add_series(record, "stress", "Pa"));
    CHECK_OK(sn_record_add_series(record, "cycle", "1"));
    for (int i = 0; i < 2000; i++) {
        double row[] = {
            i * 0.125, check_random(&seed, -1, 1) * pow(10, check_random(&seed, -20, 20)), i / 100};
        CHECK_OK(sn_record_append(record, row));
    }
    for (int exact = 0; exact < 2; exact++) {
        const char *path = scratch_path("out.csv");
        CHECK_OK(sn_curve_write(path, record, exact));
        CHECK_OK(sn_curve_read(path, &back));
        for (int k = 0; k < 3; k++) {
            assert_string_equal(back->series[k].name, record->series[k].name);
            assert_string_equal(back->series[k].unit, record->series[k].unit);
            assert_memory_equal(back->series[k].value, record->series[k].value,
                                2000 * sizeof(double));
        }
        CHECK_REL(sn_record_note(back, "area")->value, 4.2e-6, 2.3e-16); // one rounding
        assert_string_equal(sn_record_note(back, "source")->text, "two lines: \"and\" more");
        sn_record_destroy(back);
    }
    sn_record_destroy(record);
}

static void written_text_is_as_documented(void **state) {
    (void)state;
    sn_record *record;
    char text[400] = "";
    CHECK_OK(sn_record_create("test", &record));
    CHECK_OK(sn_record_add_series(record, "tip_ux", "m"));
    CHECK_OK(sn_record_add_series(record, "odd, \"name\"", "N"));
    CHECK_OK(sn_record_append(record, (double[]){0.1, 1.0 / 3.0}));
    const char *path = scratch_path("out.csv");
    CHECK_OK(sn_curve_write(path, record, false));
    FILE *file = fopen(path, "r");
    assert_true(fread(text, 1, sizeof text - 1, file) > 0);
    fclose(file);
    assert_string_equal(text, "tip_ux [m],\"odd, \"\"name\"\" [N]\"\n0.1,0.3333333333333333\n");
    CHECK_OK(sn_record_append(record, (double[]){0.1, (double)NAN}));
    CHECK_FAILS(sn_curve_write(path, record, false), SN_E_DATA, "row 2 is not a finite number");
    assert_int_equal(access(path, F_OK), 0); // the one before still stands
    CHECK_FAILS(sn_curve_write(scratch_path("no/such.csv"), record, false), SN_E_FILE,
                "no/such.csv");
    sn_record_destroy(record);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plain_curve),
        cmocka_unit_test(forms_are_equal),
        cmocka_unit_test(all_columns_are_known),
        cmocka_unit_test(latin1_is_understood),
        cmocka_unit_test(long_remarks_are_cut_at_a_character),
        cmocka_unit_test(bad_curves_are_refused),
        cmocka_unit_test(bytes_and_sizes_are_refused),
        cmocka_unit_test(mutations_are_survived),
        cmocka_unit_test(written_curves_read_back_to_the_bit),
        cmocka_unit_test(written_text_is_as_documented),
    };
    return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
