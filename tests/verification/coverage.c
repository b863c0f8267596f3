// How often the 95 % intervals of a fit hold the truth: coverage [REPEATS [PROCESSES]].
// SPDX-License-Identifier: Apache-2.0
//
// Virtual tests of random tissues, exponential x fung-spectrum, with normal noise of 1 %. Prints a
// table and exits 1 where the intervals of a constant hold the truth in fewer than 90 % or more
// than 99 % of the repetitions in which the fit called it identifiable. The noise of repetition k
// is drawn from k, so that the number of processes does not matter.
#include <stdio.h>
#include <sys/wait.h>
#include <unistd.h>

#include "lab/lab_oracle.h"

enum { CONSTANTS = 5, PLANS = 4, CURVES_MAX = 4, PROCESSES_MAX = 16, ATTEMPTS = 20 };
static const char *const names[CONSTANTS] = {"B", "C", "c", "tau1", "tau2"};

// the noise is 1 % of the largest peak on every curve, or of each curve's own
typedef struct plan {
    const char *text;
    bool own_peak;
    sn_fit_weighting weighting;
    int curves;
    struct {
        sn_protocol_kind kind;
        double ramp;
        int points;
    } test[CURVES_MAX];
} plan;

static const plan plans[PLANS] = {
    {"ramps of 0.05, 1, 20, 100 s and hold; noise 1 % of the largest peak; plain weights",
     false,
     SN_FIT_PLAIN,
     4,
     {{SN_PROTOCOL_RELAXATION, 0.05, 125},
      {SN_PROTOCOL_RELAXATION, 1, 125},
      {SN_PROTOCOL_RELAXATION, 20, 125},
      {SN_PROTOCOL_RELAXATION, 100, 125}}},
    {"the same; noise 1 % of each curve's peak; weights by noise",
     true,
     SN_FIT_NOISE,
     4,
     {{SN_PROTOCOL_RELAXATION, 0.05, 125},
      {SN_PROTOCOL_RELAXATION, 1, 125},
      {SN_PROTOCOL_RELAXATION, 20, 125},
      {SN_PROTOCOL_RELAXATION, 100, 125}}},
    {"ramp of 0.05 s and hold, cycles of 2 x 2 s; noise 1 % of the largest peak; plain weights",
     false,
     SN_FIT_PLAIN,
     2,
     {{SN_PROTOCOL_RELAXATION, 0.05, 250}, {SN_PROTOCOL_CYCLIC, 2, 250}}},
    {"ramp of 1 s and hold alone; noise 1 % of the peak; plain weights",
     false,
     SN_FIT_PLAIN,
     1,
     {{SN_PROTOCOL_RELAXATION, 1, 500}}},
};

// what one process found
typedef struct tally {
    int fits, failed, all, known[CONSTANTS], held[CONSTANTS], within[CONSTANTS];
    double width[CONSTANTS]; // sum of ln(upper / lower)
} tally;

static double between(uint64_t *seed, double low, double high) { // even in the logarithm
    return exp(check_random(seed, log(low), log(high)));
}

static void virtual_tests(const plan *p, const sn_tissue *tissue, uint64_t *seed, sn_curve *curve) {
    double largest = 0.0;
    for (int k = 0; k < p->curves; ++k) {
        curve[k] = oracle_test(tissue, p->test[k].kind, p->test[k].ramp, p->test[k].points);
        largest = fmax(largest, oracle_peak(&curve[k]));
    }
    for (int k = 0; k < p->curves; ++k)
        oracle_noise(&curve[k], 0.01 * (p->own_peak ? oracle_peak(&curve[k]) : largest), seed);
}

static void count(const sn_fit_result *r, const double *truth, tally *t) {
    t->fits++;
    t->all += r->identifiable;
    for (int j = 0; j < CONSTANTS; ++j) {
        const sn_fit_param *p = &r->param[j];
        t->within[j] += fabs(p->value / truth[j] - 1.0) <= 0.05;
        if (!p->identifiable) continue;
        t->known[j]++;
        t->held[j] += p->ci95[0] <= truth[j] && truth[j] <= p->ci95[1];
        t->width[j] += log(p->ci95[1] / p->ci95[0]);
    }
}

static void repeat(const plan *p, int k, sn_fit_result *result, tally *t) {
    uint64_t seed = 0x9e3779b97f4a7c15u * (uint64_t)(k + 1);
    sn_curve curve[CURVES_MAX] = {0};
    double truth[CONSTANTS];
    for (int i = 0; i < ATTEMPTS; ++i) check_random(&seed, 0.0, 1.0);
    truth[0] = between(&seed, 5.0, 20.0);
    truth[1] = between(&seed, 2e3, 5e4);
    truth[2] = between(&seed, 0.05, 0.4);
    truth[3] = between(&seed, 0.01, 0.5);
    truth[4] = between(&seed, 10.0, 200.0);
    sn_tissue tissue = oracle_tissue("exponential", truth, 2);
    tissue.memory = oracle_memory("fung-spectrum", 0, truth + 2, 3);
    sn_fit_def def = sn_fit_def_default();
    def.curve = curve;
    def.curve_count = p->curves;
    def.law = tissue.law;
    def.memory = tissue.memory.law;
    def.weighting = p->weighting;
    virtual_tests(p, &tissue, &seed, curve);
    if (sn_fit(&def, result) == SN_OK) {
        count(result, truth, t);
        t->failed += !result->converged;
        sn_fit_release(result);
    } else {
        fprintf(stderr, "repetition %d: %s\n", k, sn_error_text());
        t->failed++;
    }
    for (int c = 0; c < p->curves; ++c) sn_curve_release(&curve[c]);
}

static void add(tally *sum, const tally *t) {
    sum->fits += t->fits;
    sum->failed += t->failed;
    sum->all += t->all;
    for (int j = 0; j < CONSTANTS; ++j) {
        sum->known[j] += t->known[j];
        sum->held[j] += t->held[j];
        sum->within[j] += t->within[j];
        sum->width[j] += t->width[j];
    }
}

// every processes-th repetition in a process of its own
static bool run_plan(const plan *p, int repeats, int processes, tally *sum) {
    int pipes[PROCESSES_MAX][2];
    fflush(stdout);
    for (int n = 0; n < processes; ++n) {
        if (pipe(pipes[n]) != 0) return false;
        pid_t child = fork();
        if (child < 0) return false;
        if (child > 0) {
            close(pipes[n][1]);
            continue;
        }
        tally t = {0};
        sn_fit_result *result = sn_alloc(1, sizeof *result);
        for (int k = n; k < repeats && result; k += processes) repeat(p, k, result, &t);
        sn_free(result);
        _exit(write(pipes[n][1], &t, sizeof t) == (ssize_t)sizeof t ? 0 : 1);
    }
    bool good = true;
    for (int n = 0; n < processes; ++n) {
        tally t;
        good = read(pipes[n][0], &t, sizeof t) == (ssize_t)sizeof t && good;
        if (good) add(sum, &t);
        close(pipes[n][0]);
        wait(NULL);
    }
    return good && sum->fits + sum->failed >= repeats;
}

static bool print(const plan *p, const tally *t) {
    bool good = t->failed <= t->fits / 20; // a hidden constant may creep for ever
    printf("%s\n  %d fits, %d not converged, every constant identifiable in %d\n", p->text, t->fits,
           t->failed, t->all);
    printf("  %-6s %-13s %-9s %-16s %-14s\n", "", "identifiable", "covered", "interval +-",
           "within 5 %");
    for (int j = 0; j < CONSTANTS; ++j) {
        double part = t->known[j] ? (double)t->held[j] / t->known[j] : 1.0;
        bool fine = t->known[j] == 0 || (part >= 0.9 && part <= 0.99);
        printf("  %-6s %5d %13.1f %% %10.1f %% %10.1f %%  %s\n", names[j], t->known[j],
               100.0 * part, t->known[j] ? 50.0 * t->width[j] / t->known[j] : (double)NAN,
               100.0 * t->within[j] / t->fits, fine ? "ok" : "SHORT");
        good = good && fine;
    }
    return good;
}

int main(int argc, char **argv) {
    int repeats = argc > 1 ? atoi(argv[1]) : 200, processes = argc > 2 ? atoi(argv[2]) : 2;
    if (repeats < 1 || processes < 1 || processes > PROCESSES_MAX) {
        fprintf(stderr, "usage: coverage [REPEATS [PROCESSES, up to %d]]\n", PROCESSES_MAX);
        return 2;
    }
    bool good = true;
    double start = sn_clock();
    for (int k = 0; k < PLANS; ++k) {
        tally sum = {0};
        bool ran = run_plan(&plans[k], repeats, processes, &sum);
        good = ran && print(&plans[k], &sum) && good;
        if (!ran) printf("%s\n  a process failed\n", plans[k].text);
    }
    printf("%.0f s with %d processes\n", sn_clock() - start, processes);
    return good ? 0 : 1;
}
