// What every part of Sinew rests on: status and error text, parameter tables, imposed histories,
// measured records, a few special functions.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define SN_API __attribute__((visibility("default")))
#define SN_PRINTF(fmt, first) __attribute__((format(printf, fmt, first)))
#else
#define SN_API
#define SN_PRINTF(fmt, first)
#endif

#define SN_NAME_MAX 64  ///< bytes of a name with its closing zero
#define SN_TEXT_MAX 256 ///< bytes of a line of text with its closing zero

SN_API const char *sn_version(void);

//---- status and error text ----------------------------------------------------------------------

/// Every status with its text. A bug asserts; numerics that did not go well are a `reason` in a
/// result; a status is for what the world refuses.
#define SN_STATUS_LIST(X)                                                                          \
    X(SN_OK, "done")                                                                               \
    X(SN_E_MEMORY, "out of memory")                                                                \
    X(SN_E_FILE, "cannot read or write a file")                                                    \
    X(SN_E_SYNTAX, "bad syntax")                                                                   \
    X(SN_E_KEY, "unknown or missing key")                                                          \
    X(SN_E_UNIT, "missing or wrong unit")                                                          \
    X(SN_E_RANGE, "value out of range")                                                            \
    X(SN_E_DATA, "unusable data")                                                                  \
    X(SN_E_NAME, "unknown name")                                                                   \
    X(SN_E_DEFINITION, "bad definition")                                                           \
    X(SN_E_MESH, "unusable mesh")                                                                  \
    X(SN_E_UNSUPPORTED, "not supported")                                                           \
    X(SN_E_SOLVER, "solver failed")                                                                \
    X(SN_E_STOPPED, "stopped")

typedef enum sn_status {
#define SN_STATUS_ENUM(code, text) code,
    SN_STATUS_LIST(SN_STATUS_ENUM)
#undef SN_STATUS_ENUM
        SN_STATUS_COUNT
} sn_status;

/// The general text of a status.
SN_API const char *sn_status_text(sn_status status);
/// What went wrong last in this thread, in one line: what, where, what was expected, what to do.
SN_API const char *sn_error_text(void);
/// Stores a text for sn_error_text() and returns `status`, so that a caller can `return` it.
SN_API sn_status sn_fail(sn_status status, const char *format, ...) SN_PRINTF(2, 3);
/// Puts "prefix: " before the stored text: readers add the place they know.
SN_API sn_status sn_fail_within(sn_status status, const char *format, ...) SN_PRINTF(2, 3);

/// Returns from the calling function with the status of `call` unless it is SN_OK.
#define SN_TRY(call)                                                                               \
    do {                                                                                           \
        sn_status sn_try_status_ = (call);                                                         \
        if (sn_try_status_ != SN_OK) return sn_try_status_;                                        \
    } while (0)

/// Jumps to the label `fail` with `status` set unless `call` gives SN_OK: for functions that own
/// something and leave through one exit.
#define SN_TRY_GOTO(status, call)                                                                  \
    do {                                                                                           \
        (status) = (call);                                                                         \
        if ((status) != SN_OK) goto fail;                                                          \
    } while (0)

/// Called when SN_ASSERT fails: a bug of the caller or ours. The default prints and aborts.
typedef void sn_assert_handler(const char *condition, const char *file, int line);
SN_API void sn_set_assert_handler(sn_assert_handler *handler); // Nullable: the default
SN_API void sn_assert_failed(const char *condition, const char *file, int line);
#ifdef NDEBUG
#define SN_ASSERT(condition) ((void)0)
#else
#define SN_ASSERT(condition)                                                                       \
    ((condition) ? (void)0 : sn_assert_failed(#condition, __FILE__, __LINE__))
#endif

//---- memory -------------------------------------------------------------------------------------

/// The allocator behind everything in Sinew. Replace it before the first call, or not at all.
typedef struct sn_allocator {
    void *(*resize)(void *context, void *block, size_t bytes); ///< as realloc
    void (*release)(void *context, void *block);               ///< as free
    void *context;
} sn_allocator;
SN_API void sn_set_allocator(const sn_allocator *allocator); // Nullable: realloc and free

/// count * size zeroed bytes; NULL with SN_E_MEMORY's text stored on overflow or shortage.
/// A count of 0 gives a block that may be freed.
SN_API void *sn_alloc(size_t count, size_t size);
/// Resizes a block of sn_alloc(), keeping its content; new bytes are not zeroed.
SN_API void *sn_resize(void *block, size_t count, size_t size);
SN_API void sn_free(void *block); // NULL is allowed

//---- parameter tables ---------------------------------------------------------------------------

#define SN_PARAM_LIST (-1) ///< `length` of a parameter that holds one value per term
#define SN_VALUES_MAX 160  ///< most values of one table, lists counted by their terms
#define SN_TERMS_MAX 64    ///< most terms of a list

/// One parameter of a law, a memory, a protocol or a solver. The file reader, the options of the
/// command, the bounds and scale of a fit and the manual's tables all read this.
typedef struct sn_param {
    const char *name;     ///< key in files and options
    const char *symbol;   ///< as in formulas, plain text
    const char *unit;     ///< SI unit in UDUNITS-2 form; "1" for a pure number
    double min, max;      ///< range; INFINITY allowed
    bool min_open;        ///< min itself is refused
    bool max_open;        ///< max itself is refused
    double init;          ///< default; NAN where the user must give it
    bool log_scale;       ///< fits and sliders use the logarithm
    int length;           ///< 0 or 1 a scalar, n > 1 a list of n, SN_PARAM_LIST one per term
    const char *infinity; ///< Nullable: the word for INFINITY in files ("incompressible")
    const char *text;     ///< one sentence
} sn_param;

/// Index of the first value of parameter k in a flat array of values: parameters stand one after
/// the other, a list takes its length or `terms` places.
SN_API int sn_param_offset(const sn_param *params, int k, int terms);
/// Number of values of parameter k.
SN_API int sn_param_length(const sn_param *param, int terms);
/// Index of a parameter by name; -1 when there is none.
SN_API int sn_param_find(const sn_param *params, int count, const char *name);
/// Fills values with the defaults.
SN_API void sn_param_defaults(const sn_param *params, int count, int terms, double *values);
/// Checks all values against the table. `owner` names the table in the message ("law demiray").
/// @return SN_OK or SN_E_RANGE.
SN_API sn_status sn_param_check(const sn_param *params, int count, int terms, const double *values,
                                const char *owner);
/// The best of `count` names for a misspelt one, or NULL when none is near (Damerau-Levenshtein
/// distance at most a third of the length).
SN_API const char *sn_suggest(const char *word, const char *const *names, int count);

//---- fingerprints --------------------------------------------------------------------------------

#define SN_HASH_START 14695981039346656037u
/// Goes on with a hash of all that came before; not for secrets. Not the same on machines of
/// another order of bytes. Source: Fowler, Noll and Vo's FNV-1a of 64 bits, here of eight bytes at
/// a time.
SN_API uint64_t sn_hash(uint64_t hash, const void *data, size_t bytes);

//---- histories and records ----------------------------------------------------------------------

/// A motion or a load imposed over time: piecewise linear, constant before and after.
typedef struct sn_history {
    int count;     ///< number of knots
    int channels;  ///< number of values at a knot
    double *time;  ///< seconds, strictly rising             (count)
    double *value; ///< values at the knots                  (count x channels)
} sn_history;

/// Copies `count` knots. @return SN_OK, SN_E_DATA (not finite, not rising, none), SN_E_MEMORY.
SN_API sn_status sn_history_create(int channels, int count, const double *time, const double *value,
                                   sn_history **history);
/// An equal history; NULL of NULL. @return SN_OK, SN_E_MEMORY.
SN_API sn_status sn_history_copy(const sn_history *history, sn_history **copy);
SN_API void sn_history_destroy(sn_history *history); // NULL is allowed
/// Values at time t by linear interpolation, `channels` of them. NULL history: 1 for one channel.
SN_API void sn_history_at(const sn_history *history, double t, double *value);
/// The first knot strictly after t, or INFINITY: a solver that lands on it misses no corner.
SN_API double sn_history_next(const sn_history *history, double t);

/// One named column of a record.
typedef struct sn_series {
    char name[SN_NAME_MAX];
    char unit[SN_NAME_MAX]; ///< UDUNITS-2 form; "1" for a pure number
    double *value;          ///< owned by the record           (rows of the record)
} sn_series;

/// A remark about a record: area, gauge_length, specimen, source, …
typedef struct sn_note {
    char key[SN_NAME_MAX];
    char text[SN_TEXT_MAX];
    double value; ///< SI value where the text is a quantity, else NAN
} sn_note;

/// What a test or a run measured: series of equal length, SI units, and remarks.
typedef struct sn_record {
    char name[SN_TEXT_MAX]; ///< where it came from: a file name or a test
    int rows;
    int capacity;
    int series_count;
    sn_series *series;
    int note_count;
    sn_note *note;
} sn_record;

SN_API sn_status sn_record_create(const char *name, sn_record **record);
SN_API void sn_record_destroy(sn_record *record); // NULL is allowed
/// Adds a column (zeros in the rows there are).
SN_API sn_status sn_record_add_series(sn_record *record, const char *name, const char *unit);
/// Appends a row of series_count values.
SN_API sn_status sn_record_append(sn_record *record, const double *row);
/// Index of a column; -1 when there is none.
SN_API int sn_record_find(const sn_record *record, const char *name);
/// Values of a column; NULL when there is none.
SN_API double *sn_record_values(const sn_record *record, const char *name);
SN_API sn_status sn_record_add_note(sn_record *record, const char *key, const char *text,
                                    double value);
/// The remark with this key, or NULL.
SN_API const sn_note *sn_record_note(const sn_record *record, const char *key);

typedef enum sn_place { SN_ON_NODES, SN_ON_CELLS } sn_place;

/// A field over the mesh at one time.
typedef struct sn_field {
    char name[SN_NAME_MAX];
    char unit[SN_NAME_MAX];
    sn_place place;
    int components;      ///< 1, 3, or 6 for a symmetric tensor: xx yy zz xy yz zx
    const double *value; ///< borrowed                        (points x components)
} sn_field;

/// All fields at one time. Valid until the function that handed it out returns.
typedef struct sn_frame {
    double time; ///< seconds
    int field_count;
    const sn_field *fields;
} sn_frame;

//---- special functions --------------------------------------------------------------------------

/// Exponential integral E1(x) for x > 0, to 1e-14 relative; INFINITY at 0.
/// Source: series and continued fraction, Abramowitz & Stegun 5.1.11 and 5.1.22.
SN_API double sn_expint_e1(double x);

//---- the machine --------------------------------------------------------------------------------

/// The instruction set in use: "scalar", "sse2", "avx2", "avx512", "neon". Chosen once from what
/// the processor has; the environment variable SINEW_ISA forces one. Results do not depend on it.
SN_API const char *sn_isa_name(void);

/// Seconds on a steady clock.
SN_API double sn_clock(void);

#ifdef __cplusplus
}
#endif
