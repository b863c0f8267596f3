// Writes a tissue as an Abaqus material.
// SPDX-License-Identifier: Apache-2.0
// Source: Abaqus Keywords Guide and Materials Guide: hyperelastic behaviour of rubberlike
// materials, anisotropic hyperelastic behaviour, time domain viscoelasticity.
//
// Constants are written as ours, MODULI=INSTANTANEOUS, with g_i = k_i over G(0) = 1: our memory
// acts on shape and volume alike. D = 2/K: U(J) = (J - 1)^2/D of the isotropic laws is ours, the
// anisotropic ones have ((J^2 - 1)/2 - ln J)/D.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "io/buffer.h"
#include "io/foreign.h"
#include "io/text.h"

#define TERMS_MAX 13 // exponentials that Abaqus takes
#define OGDEN_MAX 6

typedef struct abaqus_writer {
    sn_buffer out;
    const sn_tissue *tissue;
    const sn_foreign *how;
    int column; ///< numbers in the line so far; at most eight
} abaqus_writer;

static void put(abaqus_writer *w, double value) {
    char text[32];
    sn_number_print(value, 15, text);
    if (w->column) sn_buffer_text(&w->out, w->column % 8 ? ", " : ",\n");
    sn_buffer_text(&w->out, text);
    w->column++;
}

static void end_line(abaqus_writer *w) {
    sn_buffer_text(&w->out, "\n");
    w->column = 0;
}

static double get(const abaqus_writer *w, const char *name) {
    return sn_foreign_get(w->tissue, name, 0);
}

static void put_stress(abaqus_writer *w, double value) {
    put(w, value / w->how->stress);
}

// 0 stands for incompressible
static void put_volume(abaqus_writer *w) {
    put(w, 2 * w->how->stress / get(w, "bulk_modulus"));
}

//---- laws ----------------------------------------------------------------------------------------

static void neo_hookean(abaqus_writer *w) {
    sn_buffer_text(&w->out, "*HYPERELASTIC, NEO HOOKE, MODULI=INSTANTANEOUS\n");
    put_stress(w, 0.5 * get(w, "shear_modulus"));
    put_volume(w);
}

static void mooney_rivlin(abaqus_writer *w) {
    sn_buffer_text(&w->out, "*HYPERELASTIC, MOONEY-RIVLIN, MODULI=INSTANTANEOUS\n");
    put_stress(w, get(w, "c1"));
    put_stress(w, get(w, "c2"));
    put_volume(w);
}

// U = sum 2 mu_i/alpha_i^2 (l1^alpha_i + …): their mu is mu alpha/2 of ours
static void ogden(abaqus_writer *w) {
    const sn_tissue *t = w->tissue;
    sn_buffer_print(&w->out, "*HYPERELASTIC, OGDEN, N=%d, MODULI=INSTANTANEOUS\n", t->terms);
    for (int i = 0; i < t->terms; i++) {
        double alpha = sn_foreign_get(t, "alpha", i);
        put_stress(w, 0.5 * sn_foreign_get(t, "mu", i) * alpha);
        put(w, alpha);
    }
    put_volume(w);
    for (int i = 1; i < t->terms; i++) put(w, 0); // no higher powers of J - 1
}

// Q = b_ijkl E_ij E_kl over all indices: a shear stands there four times, in ours twice
static void fung(abaqus_writer *w) {
    double a[9];
    sn_foreign_orthotropic(w->tissue, a);
    const double b[9] = {a[0], a[3], a[1], a[5], a[4], a[2], 0.5 * a[6], 0.5 * a[8], 0.5 * a[7]};
    sn_buffer_text(&w->out, "*ANISOTROPIC HYPERELASTIC, FUNG-ORTHOTROPIC, MODULI=INSTANTANEOUS\n");
    for (int i = 0; i < 9; i++) put(w, b[i]);
    put_stress(w, get(w, strcmp(w->tissue->law->name, "fung") == 0 ? "c" : "C"));
    put_volume(w);
}

static void hgo(abaqus_writer *w) {
    sn_buffer_text(&w->out, "*ANISOTROPIC HYPERELASTIC, HOLZAPFEL, LOCAL DIRECTIONS=2, "
                            "MODULI=INSTANTANEOUS\n");
    put_stress(w, 0.5 * get(w, "mu"));
    put_volume(w);
    put_stress(w, get(w, "k1"));
    put(w, get(w, "k2"));
    put(w, get(w, "kappa"));
}

static const struct {
    const char *law;
    void (*write)(abaqus_writer *w);
} laws[] = {
    {"neo-hookean", neo_hookean},
    {"mooney-rivlin", mooney_rivlin},
    {"ogden", ogden},
    {"fung", fung},
    {"guccione", fung},
    {"hgo", hgo},
};

static sn_status find_law(const sn_tissue *tissue, int *law) {
    for (int k = 0; k < (int)(sizeof laws / sizeof laws[0]); k++) {
        if (strcmp(laws[k].law, tissue->law->name) != 0) continue;
        *law = k;
        if (strcmp(laws[k].law, "ogden") != 0 || tissue->terms <= OGDEN_MAX) return SN_OK;
        return sn_fail(SN_E_UNSUPPORTED, "law ogden has %d terms: Abaqus takes at most %d",
                       tissue->terms, OGDEN_MAX);
    }
    return sn_fail(SN_E_UNSUPPORTED,
                   "law %s has no counterpart in Abaqus without a subroutine: there are "
                   "neo-hookean, mooney-rivlin, ogden, fung, guccione, hgo",
                   tissue->law->name);
}

//---- the file ------------------------------------------------------------------------------------

// letters, digits, '_' and '-', the first a letter
static void write_name(sn_buffer *out, const char *name) {
    sn_buffer_text(out, "*MATERIAL, NAME=");
    bool letter = (*name >= 'a' && *name <= 'z') || (*name >= 'A' && *name <= 'Z');
    if (!letter) sn_buffer_text(out, "TISSUE-");
    for (const char *s = name; *s; s++) {
        bool good = (*s >= 'a' && *s <= 'z') || (*s >= 'A' && *s <= 'Z') ||
                    (*s >= '0' && *s <= '9') || *s == '_' || *s == '-';
        sn_buffer_add(out, good ? s : "-", 1);
    }
    sn_buffer_text(out, "\n");
}

static void write_fibres(abaqus_writer *w) {
    double angle = get(w, "angle");
    sn_buffer_text(&w->out, "*ORIENTATION, NAME=FIBRES, LOCAL DIRECTIONS=2\n"
                            "1., 0., 0., 0., 1., 0.\n3, 0.\n");
    for (int side = 1; side >= -1; side -= 2) {
        put(w, cos(angle));
        put(w, side * sin(angle));
        put(w, 0);
        end_line(w);
    }
}

static void write_file(abaqus_writer *w, int law, const sn_exponentials *e) {
    double density = w->tissue->density / sn_foreign_density(w->how);
    sn_buffer_print(&w->out,
                    "** written by sinew %s; units: stress %g Pa, time %g s\n"
                    "** constants are instantaneous: G(0) = 1\n",
                    sn_version(), w->how->stress, w->how->time);
    if (strcmp(w->tissue->law->name, "hgo") == 0) write_fibres(w);
    write_name(&w->out, *w->tissue->name ? w->tissue->name : "tissue");
    if (isfinite(density)) {
        sn_buffer_text(&w->out, "*DENSITY\n");
        put(w, density);
        end_line(w);
    }
    laws[law].write(w);
    end_line(w);
    if (e->terms) sn_buffer_text(&w->out, "*VISCOELASTIC, TIME=PRONY\n");
    for (int i = 0; i < e->terms; i++) {
        put(w, e->g[i]);
        put(w, e->g[i]);
        put(w, e->tau[i] / w->how->time);
        end_line(w);
    }
}

static void remarks(const sn_tissue *tissue, sn_foreign *how) {
    bool incompressible = isinf(sn_tissue_value(tissue, "bulk_modulus"));
    if (tissue->law->fibres)
        sn_foreign_remark(how, "the axes of the material are those of the section's orientation, "
                               "the first that of the fibres");
    if (tissue->law->fibres && !incompressible)
        sn_foreign_remark(how, "U(J) is ((J^2 - 1)/2 - ln J)/D in Abaqus's anisotropic laws, "
                               "equal to ours at small changes of volume");
    if (incompressible)
        sn_foreign_remark(how, "D = 0 means incompressible and needs hybrid elements");
}

sn_status sn_tissue_write_abaqus(const char *path, const sn_tissue *tissue, sn_foreign *how) {
    sn_exponentials e;
    int law = 0;
    SN_TRY(sn_foreign_start(tissue, how));
    SN_TRY(find_law(tissue, &law));
    SN_TRY(sn_foreign_memory(tissue, TERMS_MAX, how, &e));
    if (!(e.g_inf > 0))
        return sn_fail(SN_E_UNSUPPORTED,
                       "memory %s relaxes to no stress at all: Abaqus wants weights that sum to "
                       "less than 1",
                       tissue->memory.law->name);
    remarks(tissue, how);
    abaqus_writer w = {.tissue = tissue, .how = how};
    write_file(&w, law, &e);
    sn_status status = w.out.status;
    if (status == SN_OK) status = sn_text_write(path, w.out.text, w.out.size);
    sn_buffer_free(&w.out);
    return status;
}
