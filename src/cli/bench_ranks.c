// sinew bench continuum --ranks: the command starts itself under mpirun.
// SPDX-License-Identifier: Apache-2.0
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/cli.h"

json_t *cli_bench_on_ranks(const cli_bench_choice *choice) {
    char self[4096], line[8192];
    ssize_t length = readlink("/proc/self/exe", self, sizeof self - 1);
    if (length <= 0 || strchr(self, '\'')) return NULL;
    self[length] = 0;
    // mpirun refuses root unless told that this is meant; ranks that give way while they wait are
    // slow beside other work
    setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 0);
    setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 0);
    setenv("OMPI_MCA_rmaps_base_oversubscribe", "1", 0);
    setenv("OMPI_MCA_mpi_yield_when_idle", "0", 0);
    snprintf(line, sizeof line,
             "mpirun -n %d '%s' bench continuum --json --nodes %d --repeat %d --solver %s %s %s",
             choice->ranks, self, choice->most_nodes, choice->repeat, choice->solver,
             choice->element ? "--element" : "", choice->element ? choice->element : "");
    fflush(stdout);
    FILE *pipe = popen(line, "r");
    json_t *json = pipe ? json_loadf(pipe, 0, NULL) : NULL;
    bool good = pipe && pclose(pipe) == 0;
    if (good && json) return json;
    json_decref(json);
    cli_refuse("bench: mpirun -n %d did not end well; is it installed?", choice->ranks);
    return NULL;
}
