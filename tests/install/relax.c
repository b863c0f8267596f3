// The ten-line program that every way of installing must compile and run.
#include <stdio.h>

#include <sinew/relax.h>

int main(void) {
    sn_memory memory = {.law = sn_memory_law_find("fung-spectrum"), .value = {0.1, 0.01, 100}};
    printf("%.9f\n", sn_memory_relaxation(&memory, 1.0));
    return 0;
}
