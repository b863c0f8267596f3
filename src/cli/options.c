// Options of a command from a table, on getopt_long.
// SPDX-License-Identifier: Apache-2.0
#include <errno.h>
#include <getopt.h>
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"

#define OPTIONS_MAX 40
enum { OPTION_HELP = 1000, OPTION_JSON, OPTION_QUIET };

int cli_refuse(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    fputs("sinew: ", stderr);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
    return CLI_BAD_INPUT;
}

int cli_fail(sn_status status) {
    cli_refuse("%s", sn_error_text());
    bool work = status == SN_E_SOLVER || status == SN_E_MEMORY || status == SN_E_STOPPED;
    return work ? CLI_FAILED : CLI_BAD_INPUT;
}

int cli_unknown(const char *what, const char *word, const char *const *names, int count) {
    const char *near = sn_suggest(word, names, count);
    if (near) return cli_refuse("unknown %s \"%s\": did you mean \"%s\"?", what, word, near);
    char list[512] = "";
    for (int k = 0; k < count; k++) {
        size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, "%s%s", k ? ", " : "", names[k]);
    }
    return cli_refuse("unknown %s \"%s\": expected one of %s", what, word, list);
}

static void print_help(const cli_command *command, const cli_option *options, int count) {
    printf("sinew %s %s\n%s\n\n", command->name, command->usage, command->text);
    for (int k = 0; k < count; k++) {
        char left[64];
        snprintf(left, sizeof left, "--%s%s%s", options[k].name, options[k].argument ? " " : "",
                 options[k].argument ? options[k].argument : "");
        printf("  %-28s %s\n", left, options[k].text);
    }
    printf("  %-28s %s\n  %-28s %s\n  %-28s %s\n", "--json", "one JSON object on standard output",
           "--quiet", "no progress, no summary", "--help", "this text");
    printf("\nExample:\n  %s\n", command->example);
}

// stores the argument of one option; -1 or an exit code
static int store(const cli_option *option, char *argument) {
    switch (option->kind) {
    case CLI_FLAG: *(bool *)option->value = true; return -1;
    case CLI_TEXT: *(const char **)option->value = argument; return -1;
    case CLI_LIST: {
        cli_list *list = option->value;
        if (list->count == SN_FIT_PARAMS_MAX) return cli_refuse("too many --%s", option->name);
        list->item[list->count++] = argument;
        return -1;
    }
    case CLI_INTEGER: {
        char *end;
        errno = 0;
        long value = strtol(argument, &end, 10);
        if (errno || *end || end == argument || value < 1 || value > INT_MAX)
            return cli_refuse("--%s: found \"%s\", expected a whole number of at least 1",
                              option->name, argument);
        *(int *)option->value = (int)value;
        return -1;
    }
    case CLI_QUANTITY: {
        sn_status status = sn_quantity_parse(argument, option->unit, option->value);
        if (status == SN_OK) return -1;
        sn_fail_within(status, "--%s", option->name);
        return cli_fail(status);
    }
    }
    return -1;
}

static int bad_option(const cli_command *command, char **argv, const struct option *known) {
    const char *word = argv[optind - 1];
    const char *names[OPTIONS_MAX];
    int count = 0;
    while (known[count].name) {
        names[count] = known[count].name;
        count++;
    }
    while (*word == '-') word++;
    const char *near = sn_suggest(word, names, count);
    if (near && strcmp(near, word) == 0)
        return cli_refuse("%s: --%s: an argument is missing, or one is too many", command->name,
                          near);
    if (near)
        return cli_refuse("%s: unknown option \"%s\": did you mean \"--%s\"?", command->name,
                          argv[optind - 1], near);
    return cli_refuse("%s: unknown option \"%s\": see sinew %s --help", command->name,
                      argv[optind - 1], command->name);
}

// whoever wants to see options instead of using them; NULL in ordinary calls
static cli_option_visitor *visitor;
static void *visitor_context;

void cli_visit_options(const cli_command *command, cli_option_visitor *visit, void *context) {
    char *argv[] = {(char[]){"options"}, NULL};
    visitor = visit;
    visitor_context = context;
    command->run(command, 1, argv);
    visitor = NULL;
}

int cli_parse(const cli_command *command, int argc, char **argv, const cli_option *options,
              int option_count, cli_arguments *arguments) {
    if (visitor) {
        visitor(visitor_context, command, options, option_count);
        return CLI_DONE;
    }
    struct option known[OPTIONS_MAX] = {{"help", no_argument, NULL, OPTION_HELP},
                                        {"json", no_argument, NULL, OPTION_JSON},
                                        {"quiet", no_argument, NULL, OPTION_QUIET}};
    SN_ASSERT(option_count + 4 <= OPTIONS_MAX);
    for (int k = 0; k < option_count; k++)
        known[3 + k] =
            (struct option){options[k].name,
                            options[k].kind == CLI_FLAG ? no_argument : required_argument, NULL, k};
    *arguments = (cli_arguments){0};
    opterr = 0;
    int found;
    while ((found = getopt_long(argc, argv, "h", known, NULL)) != -1) {
        if (found == OPTION_HELP || found == 'h') {
            print_help(command, options, option_count);
            return CLI_DONE;
        }
        if (found == OPTION_JSON) {
            arguments->json = true;
        } else if (found == OPTION_QUIET) {
            arguments->quiet = true;
        } else if (found == '?') {
            return bad_option(command, argv, known);
        } else {
            int code = store(&options[found], optarg);
            if (code >= 0) return code;
        }
    }
    arguments->count = argc - optind;
    arguments->item = argv + optind;
    return -1;
}
