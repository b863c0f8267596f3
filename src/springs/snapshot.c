// States and runs as bytes, to go on from later with the same bits.
// SPDX-License-Identifier: Apache-2.0
//
// Bytes are a head and then memory as it stands, piece after piece; one list of pieces serves
// saving and loading. The head holds the format's version, the order of bytes, a fingerprint of the
// net and a checksum of what follows, so that bytes of another net, another program or a damaged
// file are refused. What a step only writes before it reads (sums of tiles, scratch of the
// frequency search) is left out.
#include <string.h>

#include "springs/parts.h"
#include "springs/run.h"
#include "springs/steps.h"

#define SNAPSHOT_VERSION 3u
#define SNAPSHOT_ORDER 0x01020304u

/// What stands before the pieces.
typedef struct snapshot_head {
    char magic[8];
    uint32_t version, order;
    uint64_t fingerprint, bytes, checksum;
} snapshot_head;

static const char state_magic[8] = "SNSTATE", run_magic[8] = "SNRUN";

//---- fingerprints --------------------------------------------------------------------------------

// of the constants as the kernels have them, whatever rule they came from
static uint64_t mix_region(uint64_t hash, const sn_net_region *g) {
    const double numbers[] = {g->density,  g->shear,      g->bulk,
                              g->exponent, g->stiffening, (double)g->splits};
    hash = sn_hash(hash, numbers, sizeof numbers);
    hash = sn_hash(hash, g->square, sizeof g->square);
    for (int p = 0; p < (g->tissue.branched ? SN_PARTS : 1); p++) {
        const sn_exponentials *e = sn_region_memory(g, (sn_part)p);
        const double heads[] = {e->g_inf, e->viscous, (double)e->terms};
        hash = sn_hash(hash, heads, sizeof heads);
        hash = sn_hash(hash, e->g, (size_t)e->terms * sizeof *e->g);
        hash = sn_hash(hash, e->tau, (size_t)e->terms * sizeof *e->tau);
    }
    return hash;
}

uint64_t sn_net_fingerprint(const sn_case *c, const sn_net *net) {
    const double numbers[] = {net->nodes,
                              net->cells,
                              net->springs,
                              (double)net->rung,
                              net->volume,
                              net->volume_mode,
                              (double)net->integrator,
                              (double)net->precision,
                              net->damping,
                              net->until,
                              net->output_every,
                              net->asked_step,
                              net->tolerance,
                              net->step,
                              net->omega2,
                              SN_BLOCK,
                              net->cuttable,
                              (double)sizeof(sn_run_summary)};
    uint64_t hash = sn_hash(sn_case_fingerprint(c), numbers, sizeof numbers);
    for (int r = 0; r < net->region_count; r++) hash = mix_region(hash, &net->region[r]);
    return sn_cutting_mix(hash, net);
}

//---- pieces --------------------------------------------------------------------------------------

static size_t total(const sn_piece *piece, int count) {
    size_t bytes = 0;
    for (int k = 0; k < count; k++) bytes += piece[k].bytes;
    return bytes;
}

#define PIECE(member)                                                                              \
    { (void *)(uintptr_t)&s->member, sizeof s->member }

// what of a state matters to its next steps and to what it hands out
static int state_pieces(const sn_net *net, const sn_state *s, sn_piece *piece) {
    const size_t real = s->precision == SN_SINGLE ? sizeof(float) : sizeof(double);
    const size_t nodes = (size_t)net->nodes, tools = (size_t)net->tool_count;
    const size_t loads = (size_t)net->factor_count;
    const sn_piece all[] = {
        {s->u, nodes * 4 * real},
        {s->v, nodes * 4 * real},
        {s->now.f, nodes * 4 * real},
        {s->now.pressure, (size_t)net->point_blocks * SN_BLOCK * real},
        {s->store, net->store_size * real},
        {s->a_fixed, (size_t)net->fixed_count * sizeof *s->a_fixed},
        {s->ext, nodes * 3 * sizeof *s->ext},
        {s->contact, tools * (size_t)net->contact_count * sizeof *s->contact},
        {s->tool_pose, tools * sizeof *s->tool_pose},
        {s->tool_set, tools * sizeof *s->tool_set},
        {s->tool_force, tools * sizeof *s->tool_force},
        {s->tool_torque, tools * sizeof *s->tool_torque},
        {s->mode, nodes * 3 * sizeof *s->mode},
        {s->load_factor, loads * sizeof *s->load_factor},
        {s->load_was, loads * sizeof *s->load_was},
        {s->load_set, loads * sizeof *s->load_set},
        {s->push, nodes * 3 * sizeof *s->push},
        {s->pushed, nodes * sizeof *s->pushed},
        {s->grip, nodes * sizeof *s->grip},
        {s->gripped, nodes * sizeof *s->gripped},
        {s->tool_phase, tools * sizeof *s->tool_phase},
        {s->factors, (size_t)net->region_count * sizeof *s->factors},
        PIECE(time),
        PIECE(factors_step),
        PIECE(last_step),
        PIECE(omega2),
        PIECE(seen_omega2),
        PIECE(ruling_omega2),
        PIECE(doubt),
        PIECE(touching),
        PIECE(steps),
        PIECE(check_in),
        PIECE(check_every),
        PIECE(moved),
        PIECE(check_way),
        {s->look.u, net->integrator == SN_INTEGRATOR_EXPLICIT ? nodes * 4 * real : 0},
        PIECE(look.done),
        PIECE(look.upright),
        PIECE(warnings),
        PIECE(broken),
        PIECE(crushed),
        PIECE(damped_energy),
        PIECE(pushed_count),
        PIECE(gripped_count),
    };
    const int count = (int)(sizeof all / sizeof *all);
    SN_ASSERT(count + SN_CUT_PIECES + SN_IMPLICIT_PIECES <= SN_PIECES_MAX);
    memcpy(piece, all, sizeof all);
    const int cuts = s->cut ? sn_cut_pieces(net, s->cut, piece + count) : 0;
    return count + cuts +
           (s->implicit ? sn_implicit_pieces(net, s->implicit, piece + count + cuts) : 0);
}

static void write_pieces(const sn_piece *piece, int count, unsigned char *to) {
    for (int k = 0; k < count; k++) {
        if (piece[k].bytes > 0) memcpy(to, piece[k].data, piece[k].bytes);
        to += piece[k].bytes;
    }
}

static void read_pieces(const sn_piece *piece, int count, const unsigned char *from) {
    for (int k = 0; k < count; k++) {
        if (piece[k].bytes > 0) memcpy(piece[k].data, from, piece[k].bytes);
        from += piece[k].bytes;
    }
}

// fills in the head of bytes whose pieces are there
static void seal(const sn_net *net, const char magic[8], size_t bytes, unsigned char *out) {
    snapshot_head head = {.version = SNAPSHOT_VERSION,
                          .order = SNAPSHOT_ORDER,
                          .fingerprint = net->fingerprint,
                          .bytes = bytes};
    memcpy(head.magic, magic, sizeof head.magic);
    head.checksum = sn_hash(head.fingerprint, out + sizeof head, bytes);
    memcpy(out, &head, sizeof head);
}

static sn_status check_head(const sn_net *net, const char magic[8], const char *what,
                            const void *bytes, size_t size) {
    snapshot_head head;
    if (size < sizeof head || memcmp(bytes, magic, sizeof head.magic) != 0)
        return sn_fail(SN_E_DATA, "%s: %zu bytes that are no state of the springs", what, size);
    memcpy(&head, bytes, sizeof head);
    if (head.version != SNAPSHOT_VERSION || head.order != SNAPSHOT_ORDER)
        return sn_fail(SN_E_UNSUPPORTED,
                       "%s: saved by another version (format %u, expected %u) or on a machine of "
                       "another order of bytes; start anew",
                       what, (unsigned)head.version, SNAPSHOT_VERSION);
    if (head.fingerprint != net->fingerprint)
        return sn_fail(SN_E_DEFINITION,
                       "%s: saved from another net (fingerprint %016llx, this one has %016llx): "
                       "mesh, tissues, loads, tools, times and settings must be the same",
                       what, (unsigned long long)head.fingerprint,
                       (unsigned long long)net->fingerprint);
    if (head.bytes != size - sizeof head ||
        head.checksum != sn_hash(head.fingerprint, (const unsigned char *)bytes + sizeof head,
                                 size - sizeof head))
        return sn_fail(SN_E_DATA, "%s: damaged: %zu bytes with a wrong length or checksum", what,
                       size);
    return SN_OK;
}

//---- states --------------------------------------------------------------------------------------

size_t sn_state_size(const sn_net *net, const sn_state *s) {
    sn_piece piece[SN_PIECES_MAX];
    return sizeof(snapshot_head) + total(piece, state_pieces(net, s, piece));
}

void sn_state_save(const sn_net *net, const sn_state *s, void *bytes) {
    sn_piece piece[SN_PIECES_MAX];
    const int count = state_pieces(net, s, piece);
    write_pieces(piece, count, (unsigned char *)bytes + sizeof(snapshot_head));
    seal(net, state_magic, total(piece, count), bytes);
}

sn_status sn_state_load(const sn_net *net, sn_state *s, const void *bytes, size_t size) {
    sn_piece piece[SN_PIECES_MAX];
    const int count = state_pieces(net, s, piece);
    SN_TRY(check_head(net, state_magic, "state", bytes, size));
    if (size != sizeof(snapshot_head) + total(piece, count))
        return sn_fail(SN_E_DATA, "state: %zu bytes, expected %zu", size,
                       sizeof(snapshot_head) + total(piece, count));
    read_pieces(piece, count, (const unsigned char *)bytes + sizeof(snapshot_head));
    if (s->cut) sn_cut_restore(net, s->cut);
    sn_state_redo_look(net, s);
    return SN_OK;
}

//---- runs ----------------------------------------------------------------------------------------

/// Numbers of a run between two outputs.
typedef struct run_numbers {
    int rows, columns;
    int energy_columns;            ///< of the rows of sn_output.energy; 0: none was asked for
    double elapsed, step_wall_max; ///< wall time
    double internal_work, external_work, released, stored_start, kinetic_start;
    sn_run_summary summary;
} run_numbers;

static sn_record *energy_of(const sn_run *run) {
    return run->output ? run->output->energy : NULL;
}

// numbers, then the state, what the integrator keeps, the columns of the history and of the
// energies
static sn_status list_pieces(const sn_run *run, const sn_state *s, const sn_piece *own, int count,
                             run_numbers *numbers, sn_piece **piece, int *pieces) {
    const int columns = run->history->series_count, energies = numbers->energy_columns;
    const size_t bytes = (size_t)numbers->rows * sizeof(double);
    sn_piece *list = *piece =
        sn_alloc((size_t)(1 + SN_PIECES_MAX + count + columns + energies), sizeof *list);
    if (!list) return SN_E_MEMORY;
    list[0] = (sn_piece){numbers, sizeof *numbers};
    int at = 1 + state_pieces(run->net, s, list + 1);
    for (int k = 0; k < count; k++) list[at++] = own[k];
    for (int k = 0; k < columns; k++) list[at++] = (sn_piece){run->history->series[k].value, bytes};
    for (int k = 0; k < energies; k++)
        list[at++] = (sn_piece){energy_of(run)->series[k].value, bytes};
    *pieces = at;
    return SN_OK;
}

sn_status sn_run_save(sn_run *run, const sn_state *s, const sn_piece *own, int count) {
    const sn_restart *c = run->restart;
    if (!c || !c->save) return SN_OK;
    run_numbers *numbers = sn_alloc(1, sizeof *numbers); // zeros between its members too
    if (!numbers) return SN_E_MEMORY;
    numbers->rows = run->history->rows;
    numbers->columns = run->history->series_count;
    numbers->energy_columns = energy_of(run) ? energy_of(run)->series_count : 0;
    numbers->elapsed = sn_clock() - run->started;
    numbers->internal_work = run->internal_work;
    numbers->external_work = run->external_work;
    numbers->released = run->released;
    numbers->stored_start = run->stored_start;
    numbers->kinetic_start = run->kinetic_start;
    numbers->summary = *run->summary;
    sn_piece *piece = NULL;
    int pieces;
    unsigned char *bytes = NULL;
    sn_status status;
    SN_TRY_GOTO(status, list_pieces(run, s, own, count, numbers, &piece, &pieces));
    const size_t size = total(piece, pieces);
    bytes = sn_alloc(sizeof(snapshot_head) + size, 1);
    if (!bytes) {
        status = SN_E_MEMORY;
        goto fail;
    }
    write_pieces(piece, pieces, bytes + sizeof(snapshot_head));
    seal(run->net, run_magic, size, bytes);
    status = c->save(c->context, bytes, sizeof(snapshot_head) + size);
fail:
    sn_free(bytes);
    sn_free(piece);
    sn_free(numbers);
    return status;
}

static void take_numbers(sn_run *run, const run_numbers *numbers) {
    run->started -= numbers->elapsed;
    run->internal_work = numbers->internal_work;
    run->external_work = numbers->external_work;
    run->released = numbers->released;
    run->stored_start = numbers->stored_start;
    run->kinetic_start = numbers->kinetic_start;
    *run->summary = numbers->summary;
    run->summary->threads = run->net->threads; // may be another number: the bits are the same
}

// rows to be filled
static sn_status add_rows(sn_run *run, int rows) {
    memset(run->row, 0, (size_t)run->history->series_count * sizeof *run->row);
    for (int k = run->history->rows; k < rows; k++)
        SN_TRY(sn_record_append(run->history, run->row));
    return energy_of(run) ? sn_run_energy_rows(energy_of(run), rows) : SN_OK;
}

sn_status sn_run_load(sn_run *run, sn_state *s, const sn_piece *own, int count) {
    const sn_restart *c = run->restart;
    const unsigned char *from = c->state;
    SN_TRY(check_head(run->net, run_magic, "saved run", from, c->bytes));
    from += sizeof(snapshot_head);
    run_numbers *numbers = sn_alloc(1, sizeof *numbers);
    if (!numbers) return SN_E_MEMORY;
    sn_piece *piece = NULL;
    int pieces;
    sn_status status = SN_OK;
    if (c->bytes >= sizeof(snapshot_head) + sizeof *numbers) memcpy(numbers, from, sizeof *numbers);
    const int energies = energy_of(run) ? energy_of(run)->series_count : 0;
    if (numbers->rows < 1 || numbers->columns != run->history->series_count ||
        numbers->energy_columns != energies || (size_t)numbers->rows > c->bytes / sizeof(double)) {
        status =
            sn_fail(SN_E_DATA,
                    "saved run: %d rows of %d columns and %d energies, expected %d columns and "
                    "%d energies",
                    numbers->rows, numbers->columns, numbers->energy_columns,
                    run->history->series_count, energies);
        goto fail;
    }
    SN_TRY_GOTO(status, add_rows(run, numbers->rows));
    SN_TRY_GOTO(status, list_pieces(run, s, own, count, numbers, &piece, &pieces));
    if (c->bytes != sizeof(snapshot_head) + total(piece, pieces)) {
        status = sn_fail(SN_E_DATA, "saved run: %zu bytes, expected %zu", c->bytes,
                         sizeof(snapshot_head) + total(piece, pieces));
        goto fail;
    }
    read_pieces(piece, pieces, from);
    if (s->cut) sn_cut_restore(run->net, s->cut);
    sn_state_redo_look(run->net, s);
    take_numbers(run, numbers);
fail:
    sn_free(piece);
    sn_free(numbers);
    return status;
}
