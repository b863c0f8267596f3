// What the commands share: options, progress, output, exit codes.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <jansson.h>

#include "sinew/sinew.h"

/// Exit codes of every command.
enum { CLI_DONE = 0, CLI_FAILED = 1, CLI_BAD_INPUT = 2 };

/// A command: one file in this folder, one line in main.c.
typedef struct cli_command {
    const char *name;
    const char *usage;   ///< what follows the name
    const char *text;    ///< one line for the list of commands
    const char *example; ///< a line that runs in the project's folder
    int (*run)(const struct cli_command *command, int argc, char **argv);
} cli_command;

extern const cli_command cli_analyze, cli_fit, cli_test, cli_run, cli_calibrate, cli_compare,
    cli_bench, cli_lists, cli_convert;

int cli_command_count(void);
const cli_command *cli_command_at(int index);

typedef enum cli_kind {
    CLI_FLAG,     ///< bool
    CLI_TEXT,     ///< const char *
    CLI_LIST,     ///< cli_list, the option may be repeated
    CLI_INTEGER,  ///< int, at least 1
    CLI_QUANTITY, ///< double, SI; the argument carries its unit
} cli_kind;

typedef struct cli_list {
    int count;
    const char *item[SN_FIT_PARAMS_MAX];
} cli_list;

typedef struct cli_option {
    const char *name; ///< without the dashes
    cli_kind kind;
    const char *argument; ///< how help writes the argument; NULL for a flag
    const char *unit;     ///< SI unit of a quantity
    void *value;          ///< default on entry
    const char *text;
} cli_option;

/// What every command has, and the arguments that are not options.
typedef struct cli_arguments {
    int count;
    char **item;
    bool json, quiet;
} cli_arguments;

/// Parses options. @return -1 to go on, or the exit code (help printed, bad option reported).
int cli_parse(const cli_command *command, int argc, char **argv, const cli_option *options,
              int option_count, cli_arguments *arguments);
/// Receives the options of a command, with their defaults.
typedef void cli_option_visitor(void *context, const cli_command *command,
                                const cli_option *options, int count);
/// Calls a command as far as its options and hands them to `visit` instead of parsing anything.
void cli_visit_options(const cli_command *command, cli_option_visitor *visit, void *context);
/// Prints "sinew: text" on standard error. @return CLI_BAD_INPUT
int cli_refuse(const char *format, ...) SN_PRINTF(1, 2);
/// Prints sn_error_text() and gives the exit code that belongs to the status.
int cli_fail(sn_status status);
/// Refuses a word that is not in a list, with a suggestion. @return CLI_BAD_INPUT
int cli_unknown(const char *what, const char *word, const char *const *names, int count);

/// Ends a benchmark: puts its results and the machine into the object, prints it where JSON is
/// wanted, and releases it. Returns the exit code.
int cli_bench_end(const cli_arguments *arguments, json_t *json, json_t *results);
/// sinew bench fit (bench_fit.c).
int cli_bench_fit(const cli_arguments *arguments);
/// G(t) of a memory beside the exponentials that stand for it, over their band (memory_plots.c).
void cli_relaxation_plot(sn_report *report, const sn_memory *memory, const sn_exponentials *e);
/// Weights of the exponentials at their times, as bars.
void cli_spectrum_plot(sn_report *report, const sn_exponentials *e);

/// What `sinew bench continuum` is to measure.
typedef struct cli_bench_choice {
    const char *element; ///< NULL: all
    const char *solver;  ///< direct or iterative
    int most_nodes;      ///< of a body
    int repeat;          ///< the best of as many
    int ranks;           ///< 1, or on so many processes as well
} cli_bench_choice;
/// What `sinew bench continuum` prints under mpirun with the same choice; NULL, and a message,
/// where that fails (bench_ranks.c). To be called before MPI starts in this process.
json_t *cli_bench_on_ranks(const cli_bench_choice *choice);
/// sinew bench continuum (bench_continuum.c).
int cli_bench_continuum(const cli_arguments *arguments, const cli_bench_choice *choice);
/// sinew bench springs --haptic (bench_haptic.c).
int cli_bench_haptic(const cli_arguments *arguments, double seconds);

//---- several processes (ranks.c) -----------------------------------------------------------------

/// Joins the ranks of mpirun, if there are any; all but the first fall silent.
/// @return -1 to go on, or the exit code where the command does not run on several.
int cli_ranks_join(const char *command);
/// The exit code of the command; ends all ranks where this one failed and the others do not know.
int cli_ranks_leave(int code);
/// This rank, and how many there are.
int cli_rank(void);
int cli_ranks(void);

//---- progress ------------------------------------------------------------------------------------

/// A bar on a terminal, plain lines otherwise, from the second second on.
typedef struct cli_progress {
    bool quiet, terminal, shown;
    double start, last;
} cli_progress;
cli_progress cli_progress_start(const cli_arguments *arguments);
/// An sn_output / sn_fit_def progress callback; context a cli_progress.
void cli_progress_show(void *context, double done, const char *text);
void cli_progress_end(cli_progress *progress);

//---- results -------------------------------------------------------------------------------------

/// Puts a number into an object; null where it is not finite.
void cli_put_number(json_t *object, const char *key, double value);
void cli_put_integer(json_t *object, const char *key, long value);
void cli_put_text(json_t *object, const char *key, const char *text);
void cli_put_flag(json_t *object, const char *key, bool value);
/// Puts a value into an object, which owns it from then on.
void cli_put(json_t *object, const char *key, json_t *value);
/// A JSON array of numbers; null where one is not finite.
json_t *cli_numbers(int count, const double *values);
/// The exponentials that stand for a memory: terms, max_error, band_s, g_infinity, g, tau_s.
json_t *cli_exponentials(const sn_exponentials *e);
/// Writes an object to folder/name, indented.
sn_status cli_write_json(const char *folder, const char *name, const json_t *object);
/// Prints an object on standard output and releases it.
void cli_print_json(json_t *object);
/// folder + "/" + name in a buffer of the caller.
const char *cli_path(char *buffer, size_t size, const char *folder, const char *name);
/// The file name of a path, without its folders.
const char *cli_basename(const char *path);
/// A value with a readable unit: "12.3 kPa", "45 ms", "—" where it is not finite. Uses one of eight
/// static buffers in turn.
const char *cli_show(double value, const char *si_unit);
/// The processor's name, for benchmarks.
void cli_machine(char *text, size_t size);
