// sinew convert: tissues to and from the files of other programs.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/cli.h"

typedef sn_status read_function(const char *path, sn_tissue *tissue, sn_foreign *how);
typedef sn_status write_function(const char *path, const sn_tissue *tissue, sn_foreign *how);

static sn_status read_yaml(const char *path, sn_tissue *tissue, sn_foreign *how) {
    how->remarks[0] = 0;
    return sn_tissue_read(path, tissue);
}

static sn_status write_yaml(const char *path, const sn_tissue *tissue, sn_foreign *how) {
    char comment[1024];
    snprintf(comment, sizeof comment, "written by sinew convert %s%s%s", sn_version(),
             *how->remarks ? "\n" : "", how->remarks);
    return sn_tissue_write(path, tissue, comment);
}

typedef struct file_kind {
    const char *suffix;
    bool unitless;
    read_function *read;
    write_function *write;
} file_kind;

static const file_kind kinds[] = {
    {".yaml", false, read_yaml, write_yaml},
    {".yml", false, read_yaml, write_yaml},
    {".feb", true, sn_tissue_read_febio, sn_tissue_write_febio},
    {".inp", true, sn_tissue_read_abaqus, sn_tissue_write_abaqus},
};

// the kind of a file by its suffix; NULL with the message printed where there is none
static const file_kind *kind_of(const char *path) {
    static const char *const meshes[] = {".msh", ".vtu", ".vtk", ".stl", ".pvd"};
    const char *dot = strrchr(cli_basename(path), '.');
    for (int k = 0; dot && k < (int)(sizeof kinds / sizeof kinds[0]); k++)
        if (strcmp(dot, kinds[k].suffix) == 0) return &kinds[k];
    for (int k = 0; dot && k < (int)(sizeof meshes / sizeof meshes[0]); k++)
        if (strcmp(dot, meshes[k]) == 0) {
            cli_refuse("convert: %s: meshes are not converted, tissues are: .yaml, .feb, .inp",
                       path);
            return NULL;
        }
    cli_refuse("convert: %s: unknown kind of file, expected .yaml, .feb or .inp", path);
    return NULL;
}

static sn_status unit_of(const char *name, const char *text, const char *si, double *factor) {
    double offset;
    if (!text) return SN_OK;
    sn_status status = sn_unit_to_si(text, si, factor, &offset);
    return status == SN_OK ? SN_OK : sn_fail_within(status, "--%s", name);
}

static void show(const cli_arguments *arguments, const sn_tissue *tissue, const sn_foreign *how) {
    if (arguments->json) {
        json_t *json = json_object();
        cli_put_text(json, "tissue", tissue->name);
        cli_put_text(json, "elastic", tissue->law->name);
        cli_put_text(json, "memory", tissue->memory.law->name);
        cli_put_integer(json, "terms", how->terms);
        cli_put_number(json, "max_error", how->max_error);
        cli_put_text(json, "remarks", how->remarks);
        cli_print_json(json);
    } else if (!arguments->quiet) {
        printf("tissue \"%s\", %s x %s: %s -> %s\n", tissue->name, tissue->law->name,
               tissue->memory.law->name, arguments->item[0], arguments->item[1]);
        if (*how->remarks) printf("  %s\n", how->remarks);
    }
}

static int convert(const cli_arguments *arguments, const file_kind *from, const file_kind *to,
                   sn_foreign *how) {
    sn_tissue tissue;
    char remarks[2 * sizeof how->remarks];
    sn_status status = from->read(arguments->item[0], &tissue, how);
    if (status != SN_OK) return cli_fail(status);
    snprintf(remarks, sizeof remarks, "%s", how->remarks);
    status = to->write(arguments->item[1], &tissue, how);
    if (status != SN_OK) return cli_fail(sn_fail_within(status, "%s", arguments->item[0]));
    // what reading said still holds, unless both ends are one
    if (*remarks && from->unitless && to->unitless) {
        size_t used = strlen(remarks);
        snprintf(remarks + used, sizeof remarks - used, "%s%s", *how->remarks ? "; " : "",
                 how->remarks);
        snprintf(how->remarks, sizeof how->remarks, "%s", remarks);
    }
    show(arguments, &tissue, how);
    return CLI_DONE;
}

static int run(const cli_command *command, int argc, char **argv) {
    sn_foreign how = sn_foreign_default();
    const char *stress = NULL, *time = NULL, *length = NULL;
    const cli_option options[] = {
        {"stress-unit", CLI_TEXT, "UNIT", NULL, &stress,
         "unit of stress in the .feb or .inp file, e.g. kPa"},
        {"time-unit", CLI_TEXT, "UNIT", NULL, &time, "its unit of time, e.g. s"},
        {"length-unit", CLI_TEXT, "UNIT", NULL, &length,
         "its unit of length, e.g. mm: the density is converted with it"},
        {"material", CLI_TEXT, "NAME", NULL, &how.material,
         "the material to read where the file has several"},
        {"from", CLI_QUANTITY, "TIME", "s", &how.from,
         "start of the band in which a spectrum is compressed"},
        {"to", CLI_QUANTITY, "TIME", "s", &how.to, "end of that band"},
    };
    cli_arguments arguments;
    int code = cli_parse(command, argc, argv, options, (int)(sizeof options / sizeof *options),
                         &arguments);
    if (code >= 0) return code;
    if (arguments.count != 2)
        return cli_refuse("convert: expected a file to read and one to write, got %d",
                          arguments.count);
    const file_kind *from = kind_of(arguments.item[0]);
    const file_kind *to = from ? kind_of(arguments.item[1]) : NULL;
    if (!to) return CLI_BAD_INPUT;
    if (!from->unitless && !to->unitless)
        return cli_refuse("convert: both files are tissue files: nothing to convert");
    if (!stress || !time)
        return cli_refuse("convert: %s files carry no units: --stress-unit and --time-unit are "
                          "needed, e.g. --stress-unit kPa --time-unit s",
                          (to->unitless ? to : from)->suffix);
    sn_status status = unit_of("stress-unit", stress, "Pa", &how.stress);
    if (status == SN_OK) status = unit_of("time-unit", time, "s", &how.time);
    if (status == SN_OK) status = unit_of("length-unit", length, "m", &how.length);
    return status == SN_OK ? convert(&arguments, from, to, &how) : cli_fail(status);
}

const cli_command cli_convert = {
    "convert", "IN OUT --stress-unit UNIT --time-unit UNIT",
    "tissues to and from FEBio (.feb) and Abaqus (.inp)",
    "sinew convert examples/muscle/muscle.yaml muscle.feb --stress-unit kPa --time-unit s", run};
