// The command: finds the subcommand and hands over.
// SPDX-License-Identifier: Apache-2.0
#include <stdio.h>
#include <string.h>

#include "cli/cli.h"

static const cli_command *const commands[] = {
    &cli_analyze, &cli_fit,   &cli_test,    &cli_run,   &cli_calibrate,
    &cli_compare, &cli_bench, &cli_convert, &cli_lists,
};

#define COMMANDS ((int)(sizeof commands / sizeof commands[0]))

int cli_command_count(void) {
    return COMMANDS;
}

const cli_command *cli_command_at(int index) {
    SN_ASSERT(index >= 0 && index < COMMANDS);
    return commands[index];
}

static void print_help(void) {
    printf("sinew %s - soft tissue from the testing machine to the simulator\n\n", sn_version());
    for (int k = 0; k < COMMANDS; k++)
        printf("  sinew %-9s %s\n", commands[k]->name, commands[k]->text);
    printf(
        "\nEvery command explains itself with --help, prints one JSON object with --json, and is\n"
        "silent but for errors with --quiet. Exit code: 0 done, 1 the work failed, 2 bad input.\n");
}

int main(int argc, char **argv) {
    if (argc < 2 || strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0 ||
        strcmp(argv[1], "help") == 0) {
        print_help();
        return argc < 2 ? CLI_BAD_INPUT : CLI_DONE;
    }
    if (strcmp(argv[1], "--version") == 0) {
        printf("sinew %s\n", sn_version());
        return CLI_DONE;
    }
    const char *names[COMMANDS];
    for (int k = 0; k < COMMANDS; k++) {
        names[k] = commands[k]->name;
        if (strcmp(argv[1], names[k]) != 0) continue;
        int code = cli_ranks_join(names[k]);
        if (code < 0) code = commands[k]->run(commands[k], argc - 1, argv + 1);
        return cli_ranks_leave(code);
    }
    return cli_unknown("command", argv[1], names, COMMANDS);
}
