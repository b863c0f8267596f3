// The command on several ranks of MPI: one speaks, and all end together.
// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "cli/cli.h"

static int rank, count = 1;
static int speech = -1; // standard error of a rank that is silent

int cli_rank(void) {
    return rank;
}

int cli_ranks(void) {
    return count;
}

// All output of this process goes nowhere; its standard error is kept for a last word.
static void fall_silent(void) {
    speech = dup(STDERR_FILENO);
    int nowhere = open("/dev/null", O_WRONLY);
    if (nowhere < 0) return;
    fflush(stdout);
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
    close(nowhere);
}

int cli_ranks_join(const char *command) {
    sn_status status = sn_ranks_join(&rank, &count);
    if (status != SN_OK) return cli_fail(status);
    if (rank > 0) fall_silent();
    if (count == 1 || !strcmp(command, "run") || !strcmp(command, "bench")) return -1;
    return cli_refuse("%s: runs in one process; mpirun is for run --engine continuum and for bench "
                      "continuum",
                      command);
}

int cli_ranks_leave(int code) {
    if (code == CLI_DONE || !sn_ranks_lost()) return code;
    // the others do not know: a word if nobody has spoken, and the end of all
    if (speech >= 0) dprintf(speech, "sinew: rank %d: %s\n", rank, sn_error_text());
    fflush(NULL);
    sn_ranks_abort(code);
    return code;
}
