// Hereditary stress of a solid whose lateral stretches must be solved for, and its derivatives by
// the constants.
// SPDX-License-Identifier: Apache-2.0
// Source: equations (33)-(35) with (32); free sides, S22 = S33 = 0.
//
// Compressible:    S = H[S_d] + H[K (J - 1)] J C^-1, both lateral stretches unknown.
// Incompressible:  S = H[S_d] - p C^-1, J = 1; the sides differ (orthotropic laws), so one lateral
//                  stretch is unknown and the condition is that both sides give the same p.
// The recursion for a step is affine in the new stress, H[S] = a S_new + b, so a trial of the
// lateral stretches costs one evaluation of the law and touches no memory variable. Newton on the
// logarithms of the stretches with differences for the 2 x 2 matrix: they need no tangent of the
// volume term and the three points go to the law in one call. Steps are of second order; the
// callers refine.
//
// Derivatives by a constant are those of the scheme itself, carried along with it. With S the total
// of a channel and v its elastic value, dS = a dv + db + X: db from the recursion of dv, X the
// integral with dG/dp where the constant is one of the memory; and dv = v_p + v_y dy, v_p at fixed
// sides from the law. dy is what keeps the residuals at 0: with R_y their matrix by the sides,
// from the law's tangent, R_y dy = -R_S (a v_p + db + X).
#include <math.h>
#include <string.h>

#include "lab/protocol/path.h"

enum { CHANNELS = 4 }; // S11, S22, S33 distortional, and K (J - 1)
static const int newton_max = 40;
static const double difference = 1e-6; // of a logarithm: balances rounding against curvature

// derivatives of what a puller holds by every constant
typedef struct slopes {
    const sn_constants *by;
    int count;
    sn_memory_slope memory[SN_FIT_PARAMS_MAX];   // of the constants of the memory
    double bulk[SN_FIT_PARAMS_MAX];              // of the bulk modulus
    double fixed[SN_FIT_PARAMS_MAX][CHANNELS];   // of the totals, elastic values held
    double value[SN_FIT_PARAMS_MAX][CHANNELS];   // of the elastic values
    double aged[SN_FIT_PARAMS_MAX][CHANNELS][2]; // shares of the exponential of `memory`
    double H[SN_FIT_PARAMS_MAX][CHANNELS][SN_TERMS_MAX];
    double nominal[SN_FIT_PARAMS_MAX]; // of the nominal stress
    double dS[SN_VALUES_MAX * 6];      // from the law
} slopes;

typedef struct puller {
    const sn_tissue *tissue;
    const sn_exponentials *e;
    double bulk; // INFINITY: incompressible
    double time, stretch;
    double log_lateral[2];
    double value[CHANNELS];           // elastic, at the end of the last step
    double H[CHANNELS][SN_TERMS_MAX]; // shares of the exponentials
    double a, b[CHANNELS];            // affine map of the step at hand
    slopes *slopes;                   // Nullable
} puller;

static int unknowns(const puller *p) {
    return isinf(p->bulk) ? 1 : 2;
}

// lateral stretches of a trial
static void lateral(const puller *p, double stretch, const double *y, double out[2]) {
    out[0] = exp(y[0]);
    out[1] = isinf(p->bulk) ? 1.0 / (stretch * out[0]) : exp(y[1]);
}

// elastic channels and total stresses at n trials; residual (2 x n), axial nominal stress (n)
static void trials(const puller *p, double stretch, int n, double y[][2], double value[][CHANNELS],
                   double residual[][2], double *nominal) {
    double E[6 * 3] = {0}, S[6 * 3];
    SN_ASSERT(n <= 3);
    for (int i = 0; i < n; ++i) {
        double side[2];
        lateral(p, stretch, y[i], side);
        E[i] = 0.5 * (stretch * stretch - 1.0);
        E[n + i] = 0.5 * (side[0] * side[0] - 1.0);
        E[2 * n + i] = 0.5 * (side[1] * side[1] - 1.0);
    }
    sn_law_solid(p->tissue->law, p->tissue->value, p->tissue->terms, n, E, NULL, S, NULL);
    for (int i = 0; i < n; ++i) {
        double side[2], total[CHANNELS];
        lateral(p, stretch, y[i], side);
        double J = stretch * side[0] * side[1];
        for (int c = 0; c < 3; ++c) value[i][c] = S[c * n + i];
        value[i][3] = isinf(p->bulk) ? 0.0 : sn_volume_stress(p->bulk, J);
        for (int c = 0; c < CHANNELS; ++c) total[c] = p->a * value[i][c] + p->b[c];
        double s22 = total[1] * side[0] * side[0], s33 = total[2] * side[1] * side[1];
        if (isinf(p->bulk)) {
            residual[i][0] = s22 - s33;
            residual[i][1] = 0.0;
            nominal[i] = stretch * total[0] - s33 / stretch;
        } else {
            residual[i][0] = s22 + total[3] * J;
            residual[i][1] = s33 + total[3] * J;
            nominal[i] = stretch * total[0] + total[3] * J / stretch;
        }
    }
}

// Newton's change of the unknowns from residuals at a point and at a difference in each unknown
static bool newton_change(int n, double residual[][2], double change[2]) {
    double A[2][2] = {{1.0, 0.0}, {0.0, 1.0}};
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) A[i][j] = (residual[j + 1][i] - residual[0][i]) / difference;
    double det = A[0][0] * A[1][1] - A[0][1] * A[1][0];
    change[0] = -(A[1][1] * residual[0][0] - A[0][1] * residual[0][1]) / det;
    change[1] = -(A[0][0] * residual[0][1] - A[1][0] * residual[0][0]) / det;
    double size = fmax(fabs(change[0]), fabs(change[1]));
    if (!isfinite(size)) return false;
    double limit = 0.1; // a tenth of the stretch a go: the law stays in its domain
    if (size > limit)
        for (int i = 0; i < 2; ++i) change[i] *= limit / size;
    return true;
}

// solves the sides at `stretch`; leaves elastic values in `value` and the nominal stress in
// *nominal
static sn_status solve_sides(puller *p, double stretch, double value[CHANNELS], double *nominal) {
    int n = unknowns(p);
    double y[3][2], values[3][CHANNELS], residual[3][2], stress[3], change[2] = {0.0, 0.0};
    memcpy(y[0], p->log_lateral, sizeof y[0]);
    for (int iteration = 0; iteration < newton_max; ++iteration) {
        for (int j = 0; j < n; ++j) {
            memcpy(y[j + 1], y[0], sizeof y[0]);
            y[j + 1][j] += difference;
        }
        trials(p, stretch, n + 1, y, values, residual, stress);
        if (!newton_change(n, residual, change)) break;
        double size = fmax(fabs(change[0]), fabs(change[1]));
        for (int j = 0; j < n; ++j) y[0][j] += change[j];
        if (size > 1e-11) continue; // the matrix is good to 1e-6: what remains is 1e-17
        trials(p, stretch, 1, y, values, residual, stress);
        memcpy(p->log_lateral, y[0], sizeof y[0]);
        memcpy(value, values[0], sizeof values[0]);
        *nominal = stress[0];
        return SN_OK;
    }
    return sn_fail(SN_E_SOLVER,
                   "law %s: the free sides at stretch %g, %g s have no equilibrium near lateral "
                   "stretch %g (last change %g): check the constants",
                   p->tissue->law->name, stretch, p->time, exp(p->log_lateral[0]), change[0]);
}

//---- derivatives ---------------------------------------------------------------------------------

// what the sides do to elastic values, residuals and nominal stress at a solution
typedef struct sides {
    double stretch, J, square[2];
    double value[CHANNELS][2], residual[2][2], nominal[2]; // derivatives by their logarithms
} sides;

static void sides_at(const puller *p, double stretch, const double value[CHANNELS], sides *s) {
    static const int at[3][2] = {{1, 2}, {6, 7}, {7, 11}}; // S_ii by E22, E33 in the tangent
    double l[2], D[21], total[CHANNELS], a = p->a;
    bool closed = isinf(p->bulk);
    lateral(p, stretch, p->log_lateral, l);
    *s = (sides){.stretch = stretch, .J = stretch * l[0] * l[1]};
    double E[6] = {0.5 * (stretch * stretch - 1.0)};
    for (int j = 0; j < 2; ++j) {
        s->square[j] = l[j] * l[j];
        E[1 + j] = 0.5 * (s->square[j] - 1.0);
    }
    sn_law_solid(p->tissue->law, p->tissue->value, p->tissue->terms, 1, E, NULL, NULL, D);
    for (int c = 0; c < CHANNELS; ++c) total[c] = a * value[c] + p->b[c];
    for (int c = 0; c < 3; ++c) {
        for (int j = 0; j < 2; ++j) s->value[c][j] = D[at[c][j]] * s->square[j];
        if (closed) s->value[c][0] -= s->value[c][1];
    }
    if (closed) {
        double t2 = total[1] * s->square[0], t3 = total[2] * s->square[1];
        double d3 = a * s->value[2][0] * s->square[1] - 2.0 * t3;
        s->residual[0][0] = a * s->value[1][0] * s->square[0] + 2.0 * t2 - d3;
        s->nominal[0] = stretch * a * s->value[0][0] - d3 / stretch;
        return;
    }
    for (int j = 0; j < 2; ++j) {
        s->value[3][j] = p->bulk * s->J;
        double swell = (a * s->value[3][j] + total[3]) * s->J;
        for (int i = 0; i < 2; ++i)
            s->residual[i][j] =
                (a * s->value[1 + i][j] + (i == j ? 2.0 * total[1 + i] : 0.0)) * s->square[i] +
                swell;
        s->nominal[j] = stretch * a * s->value[0][j] + swell / stretch;
    }
}

// dy, and with it dv and the derivative of the nominal stress, from dS at fixed sides
static void follow_sides(const puller *p, const sides *s, const double dS[CHANNELS],
                         double value[CHANNELS], double *nominal) {
    double dy[2] = {0.0, 0.0}, dR[2];
    if (isinf(p->bulk)) {
        dR[0] = dS[1] * s->square[0] - dS[2] * s->square[1];
        dy[0] = -dR[0] / s->residual[0][0];
        *nominal = s->stretch * dS[0] - dS[2] * s->square[1] / s->stretch;
    } else {
        const double(*A)[2] = s->residual;
        for (int i = 0; i < 2; ++i) dR[i] = dS[1 + i] * s->square[i] + dS[3] * s->J;
        double det = A[0][0] * A[1][1] - A[0][1] * A[1][0];
        dy[0] = -(A[1][1] * dR[0] - A[0][1] * dR[1]) / det;
        dy[1] = -(A[0][0] * dR[1] - A[1][0] * dR[0]) / det;
        *nominal = s->stretch * dS[0] + dS[3] * s->J / s->stretch;
    }
    for (int j = 0; j < 2; ++j) {
        *nominal += s->nominal[j] * dy[j];
        for (int c = 0; c < CHANNELS; ++c) value[c] += s->value[c][j] * dy[j];
    }
}

// derivatives at the end of a step, the old ones in value[] replaced; `fixed` is known
static void slopes_solve(puller *p, double stretch, const double value[CHANNELS]) {
    slopes *d = p->slopes;
    sides s;
    sides_at(p, stretch, value, &s);
    const double E[6] = {0.5 * (stretch * stretch - 1.0), 0.5 * (s.square[0] - 1.0),
                         0.5 * (s.square[1] - 1.0)};
    sn_law_sensitivity(p->tissue->law, p->tissue->value, p->tissue->terms, 1, E, d->dS);
    for (int k = 0; k < d->count; ++k) {
        double dS[CHANNELS];
        for (int c = 0; c < CHANNELS; ++c) {
            d->value[k][c] = 0.0;
            if (k < d->by->law_count)
                d->value[k][c] = c < 3 ? d->dS[d->by->law[k] * 6 + c] : d->bulk[k] * (s.J - 1.0);
            dS[c] = p->a * d->value[k][c] + d->fixed[k][c];
        }
        follow_sides(p, &s, dS, d->value[k], &d->nominal[k]);
    }
}

// the integral with dG/dp of constant k at the end of a step of h seconds to `value`
static void memory_part(puller *p, int k, double h, const double value[CHANNELS]) {
    slopes *d = p->slopes;
    const sn_memory_slope *by = &d->memory[k];
    double x = h / by->tau, decay = exp(-x), m0 = -expm1(-x) / x;
    // x M1; for small x the difference of m0 and decay would lose its digits
    double old = x > 1e-3 ? m0 - decay : x * (0.5 - x * (1.0 / 3.0 - x * (1.0 / 8.0 - x / 30.0)));
    for (int c = 0; c < CHANNELS; ++c) {
        double change = value[c] - p->value[c], *H = d->aged[k][c];
        H[1] = decay * (H[1] + x * H[0]) + old * change;
        H[0] = decay * H[0] + m0 * change;
        d->fixed[k][c] += by->constant * value[c] + by->own * (p->a * value[c] + p->b[c]) +
                          by->plain * H[0] + by->aged * H[1] + by->viscous * change / h;
    }
}

static void slopes_step(puller *p, double h, double stretch, const double *decay,
                        const double *gain, const double value[CHANNELS]) {
    slopes *d = p->slopes;
    const sn_exponentials *e = p->e;
    double old[SN_FIT_PARAMS_MAX][CHANNELS];
    memcpy(old, d->value, sizeof old);
    for (int k = 0; k < d->count; ++k) {
        for (int c = 0; c < CHANNELS; ++c) {
            double b = -e->viscous / h * old[k][c];
            for (int i = 0; i < e->terms; ++i) b += decay[i] * d->H[k][c][i] - gain[i] * old[k][c];
            d->fixed[k][c] = b;
        }
        if (k >= d->by->law_count) memory_part(p, k, h, value);
    }
    slopes_solve(p, stretch, value);
    for (int k = 0; k < d->count; ++k)
        for (int c = 0; c < CHANNELS; ++c)
            for (int i = 0; i < e->terms; ++i)
                d->H[k][c][i] = decay[i] * d->H[k][c][i] + gain[i] * (d->value[k][c] - old[k][c]);
}

// after the step from rest
static void slopes_start(puller *p, double stretch, const double value[CHANNELS]) {
    slopes *d = p->slopes;
    slopes_solve(p, stretch, value);
    for (int k = 0; k < d->count; ++k)
        for (int c = 0; c < CHANNELS; ++c) {
            d->aged[k][c][0] = value[c];
            for (int i = 0; i < p->e->terms; ++i) d->H[k][c][i] = p->e->g[i] * d->value[k][c];
        }
}

// derivative of the bulk modulus by a constant of the law: a rational function in closed form, of
// which a difference leaves 1e-10
static double bulk_slope(const sn_tissue *tissue, int index) {
    sn_moduli side[2];
    double change = 1e-6 * fabs(tissue->value[index]), at[2];
    sn_tissue moved = *tissue;
    if (isinf(change) || change == 0.0) return 0.0;
    for (int s = 0; s < 2; ++s) {
        at[s] = moved.value[index] = tissue->value[index] + (s ? change : -change);
        tissue->law->moduli(moved.value, moved.terms, &side[s]);
    }
    return isinf(side[0].bulk) ? 0.0 : (side[1].bulk - side[0].bulk) / (at[1] - at[0]);
}

static slopes *slopes_create(const sn_tissue *tissue, const sn_constants *by) {
    sn_memory_slope every[SN_VALUES_MAX];
    slopes *d = sn_alloc(1, sizeof *d);
    if (!d) return NULL;
    d->by = by;
    d->count = by->law_count + by->memory_count;
    for (int k = 0; k < by->law_count; ++k) d->bulk[k] = bulk_slope(tissue, by->law[k]);
    sn_memory_sensitivity(&tissue->memory, every);
    for (int k = 0; k < by->memory_count; ++k) d->memory[by->law_count + k] = every[by->memory[k]];
    return d;
}

//---- along the path ------------------------------------------------------------------------------

static sn_status start(puller *p, const sn_path *path, double *nominal) {
    const sn_exponentials *e = p->e;
    double guess = -0.5 * log(path->stretch[0]), value[CHANNELS];
    p->time = path->time[0];
    p->stretch = path->stretch[0];
    p->log_lateral[0] = p->log_lateral[1] = guess;
    p->a = 1.0; // a step from rest: G(0) = 1
    SN_TRY(solve_sides(p, p->stretch, value, nominal));
    for (int c = 0; c < CHANNELS; ++c) {
        p->value[c] = value[c];
        for (int i = 0; i < e->terms; ++i) p->H[c][i] = e->g[i] * value[c];
    }
    if (p->slopes) slopes_start(p, p->stretch, value);
    return SN_OK;
}

static sn_status step(puller *p, double time, double stretch, double *nominal) {
    const sn_exponentials *e = p->e;
    double decay[SN_TERMS_MAX], gain[SN_TERMS_MAX], value[CHANNELS];
    double h = time - p->time, viscous = e->viscous / h;
    sn_exponentials_factors(e, h, decay, gain);
    p->a = e->g_inf + viscous;
    for (int i = 0; i < e->terms; ++i) p->a += gain[i];
    for (int c = 0; c < CHANNELS; ++c) {
        p->b[c] = -viscous * p->value[c];
        for (int i = 0; i < e->terms; ++i) p->b[c] += decay[i] * p->H[c][i] - gain[i] * p->value[c];
    }
    double guess = log(stretch / p->stretch);
    for (int j = 0; j < 2; ++j) p->log_lateral[j] -= 0.5 * guess;
    p->time = time;
    SN_TRY(solve_sides(p, stretch, value, nominal));
    if (p->slopes) slopes_step(p, h, stretch, decay, gain, value);
    for (int c = 0; c < CHANNELS; ++c) {
        for (int i = 0; i < e->terms; ++i)
            p->H[c][i] = decay[i] * p->H[c][i] + gain[i] * (value[c] - p->value[c]);
        p->value[c] = value[c];
    }
    p->stretch = stretch;
    return SN_OK;
}

// Parts of the interval after instant k, and how they are graded: part j of n ends at the fraction
// (exp(alpha j/n) - 1)/(exp(alpha) - 1) of it. A hold after a fast ramp wants its steps early, and
// a smooth grading keeps the even expansion of the error.
static int parts_of(const sn_path *path, int k, int level, double *alpha) {
    double change = fabs(path->stretch[k + 1] - path->stretch[k]);
    double duration = path->time[k + 1] - path->time[k];
    double before = k > 0 ? path->time[k] - path->time[k - 1] : duration;
    *alpha = log1p(duration / before) - log(2.0);
    if (!(*alpha > 0.1)) *alpha = 0.0;
    double parts = path->range > 0.0 ? ceil(12.0 * change / path->range) : 1.0;
    return level * (int)fmax(1.0 + ceil(*alpha), parts);
}

// steps from instant k to the next
static sn_status cross(puller *p, const sn_path *path, int k, int level, double *nominal) {
    double alpha, t0 = path->time[k], l0 = path->stretch[k];
    int parts = parts_of(path, k, level, &alpha);
    for (int j = 1; j <= parts; ++j) {
        double part = (double)j / parts;
        double u = alpha > 0.0 ? expm1(alpha * part) / expm1(alpha) : part;
        if (j == parts) u = 1.0;
        double t = j == parts ? path->time[k + 1] : t0 + u * (path->time[k + 1] - t0);
        SN_TRY(step(p, t, l0 + u * (path->stretch[k + 1] - l0), nominal));
    }
    return SN_OK;
}

static puller puller_of(const sn_tissue *tissue, const sn_exponentials *e) {
    sn_moduli moduli;
    tissue->law->moduli(tissue->value, tissue->terms, &moduli);
    return (puller){.tissue = tissue, .e = e, .bulk = moduli.bulk};
}

sn_status sn_path_stress_lateral(const sn_path *path, const sn_tissue *tissue,
                                 const sn_exponentials *e, int level, double *stress) {
    puller p = puller_of(tissue, e);
    double *at_instant = sn_alloc((size_t)path->count, sizeof *at_instant);
    if (!at_instant) return SN_E_MEMORY;
    sn_status status = start(&p, path, &at_instant[0]);
    for (int k = 0; status == SN_OK && k + 1 < path->count; ++k)
        status = cross(&p, path, k, level, &at_instant[k + 1]);
    for (int r = 0; status == SN_OK && r < path->records; ++r)
        stress[r] = path->record[r] < 0 ? 0.0 : at_instant[path->record[r]];
    sn_free(at_instant);
    return status;
}

sn_status sn_path_slopes_lateral(const sn_pulled *pulled, const sn_constants *by, double *out) {
    const sn_path *path = pulled->path;
    puller p = puller_of(pulled->tissue, pulled->e);
    const int count = by->law_count + by->memory_count;
    double nominal, *at_instant = sn_alloc((size_t)path->count * (size_t)count, sizeof *at_instant);
    sn_status status = SN_E_MEMORY;
    p.slopes = slopes_create(pulled->tissue, by);
    if (!at_instant || !p.slopes) goto fail;
    SN_TRY_GOTO(status, start(&p, path, &nominal));
    for (int k = 0; k < path->count; ++k) {
        if (k > 0) SN_TRY_GOTO(status, cross(&p, path, k - 1, pulled->level, &nominal));
        memcpy(at_instant + (ptrdiff_t)k * count, p.slopes->nominal,
               (size_t)count * sizeof *at_instant);
    }
    for (int j = 0; j < count; ++j)
        for (int r = 0; r < path->records; ++r, ++out)
            *out = path->record[r] < 0 ? 0.0 : at_instant[(ptrdiff_t)path->record[r] * count + j];
fail:
    sn_free(at_instant);
    sn_free(p.slopes);
    return status;
}
