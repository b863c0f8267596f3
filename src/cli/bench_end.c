// What all benchmarks say in the end.
// SPDX-License-Identifier: Apache-2.0
#include "cli/cli.h"

int cli_bench_end(const cli_arguments *arguments, json_t *json, json_t *results) {
    char machine[256];
    cli_machine(machine, sizeof machine);
    cli_put(json, "results", results);
    cli_put_text(json, "machine", machine);
    if (arguments->json)
        cli_print_json(json);
    else
        json_decref(json);
    return CLI_DONE;
}
