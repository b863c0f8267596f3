// Writes a tissue as a FEBio 4 file with its material section.
// SPDX-License-Identifier: Apache-2.0
// Source: FEBio User Manual 4, uncoupled materials and uncoupled viscoelasticity.
//
// FEBio's uncoupled materials are W = W_d(isochoric strain) + U(J) as ours; pressure_model 2 is our
// U = k/2 (J - 1)^2. Its memory has the elastic law in the long term and weights g_i over it,
// G(0) = 1 + sum g_i, and acts on the distortional stress alone:
//     constants = G_inf ours,  g_i = ours / G_inf;  k = ours, which does not relax.
// A fluid (G_inf = 0) has g0 = 0 and its elastic law at t = 0.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "io/buffer.h"
#include "io/foreign.h"
#include "io/text.h"

#define TERMS_MAX 6 // of memories and of Ogden's law in FEBio

typedef struct febio_writer {
    sn_buffer out;
    const sn_tissue *tissue; ///< elastic constants in SI, in FEBio's convention
    sn_foreign *how;
    const char *indent;
} febio_writer;

static void put(febio_writer *w, const char *name, double value) {
    char text[32];
    sn_number_print(value, 15, text);
    sn_buffer_print(&w->out, "%s<%s>%s</%s>\n", w->indent, name, text, name);
}

static double get(const febio_writer *w, const char *name) {
    return sn_foreign_get(w->tissue, name, 0);
}

static void put_stress(febio_writer *w, const char *name, double value) {
    put(w, name, value / w->how->stress);
}

//---- laws ----------------------------------------------------------------------------------------

static sn_status neo_hookean(febio_writer *w) {
    put_stress(w, "c1", 0.5 * get(w, "shear_modulus"));
    put(w, "c2", 0);
    return SN_OK;
}

static sn_status mooney_rivlin(febio_writer *w) {
    put_stress(w, "c1", get(w, "c1"));
    put_stress(w, "c2", get(w, "c2"));
    return SN_OK;
}

static sn_status veronda_westmann(febio_writer *w) {
    put_stress(w, "c1", get(w, "c1"));
    put(w, "c2", get(w, "c2"));
    return SN_OK;
}

// W = sum c_i/m_i^2 (l1^m_i + …): c_i = mu_i alpha_i
static sn_status ogden(febio_writer *w) {
    const sn_tissue *t = w->tissue;
    char name[8];
    if (t->terms > TERMS_MAX)
        return sn_fail(SN_E_UNSUPPORTED, "law ogden has %d terms: FEBio takes at most %d", t->terms,
                       TERMS_MAX);
    for (int i = 0; i < t->terms; i++) {
        double alpha = sn_foreign_get(t, "alpha", i);
        snprintf(name, sizeof name, "c%d", i + 1);
        put_stress(w, name, sn_foreign_get(t, "mu", i) * alpha);
        snprintf(name, sizeof name, "m%d", i + 1);
        put(w, name, alpha);
    }
    return SN_OK;
}

// FEBio reads W as an expression; without exponents, which not every version understands there
static sn_status demiray(febio_writer *w) {
    double b = get(w, "b"), scale = get(w, "c") / w->how->stress / (2 * b);
    if (!(b >= 1e-6 && scale >= 1e-5 && scale < 1e12))
        return sn_fail(SN_E_UNSUPPORTED,
                       "law demiray: c/(2 b) = %g and b = %g: expected 1e-5 to 1e12 and at least "
                       "1e-6 in the unit of the file: choose another --stress-unit",
                       scale, b);
    char before[64], inside[64];
    snprintf(before, sizeof before, "%.21f", scale);
    snprintf(inside, sizeof inside, "%.21f", b);
    sn_buffer_print(&w->out, "%s<W>%s*(exp(%s*(I1-3))-1)</W>\n", w->indent, before, inside);
    return SN_OK;
}

// E_i, v_ij, G_ij of the compliance that is the inverse of c a
static sn_status fung(febio_writer *w) {
    double a[9], c = get(w, strcmp(w->tissue->law->name, "fung") == 0 ? "c" : "C");
    sn_foreign_orthotropic(w->tissue, a);
    double minor[3] = {a[1] * a[2] - a[4] * a[4], a[0] * a[2] - a[5] * a[5],
                       a[0] * a[1] - a[3] * a[3]};
    double det =
        a[0] * minor[0] - a[3] * (a[3] * a[2] - a[4] * a[5]) + a[5] * (a[3] * a[4] - a[1] * a[5]);
    // off the diagonal of the adjugate: 12, 23, 31
    double mixed[3] = {a[4] * a[5] - a[3] * a[2], a[3] * a[5] - a[0] * a[4],
                       a[3] * a[4] - a[1] * a[5]};
    static const char *const young[] = {"E1", "E2", "E3"}, *const shear[] = {"G12", "G23", "G31"},
                             *const ratio[] = {"v12", "v23", "v31"};
    for (int i = 0; i < 3; i++) put_stress(w, young[i], c * det / minor[i]);
    for (int i = 0; i < 3; i++) put_stress(w, shear[i], 0.5 * c * a[6 + i]);
    for (int i = 0; i < 3; i++) put(w, ratio[i], -mixed[i] / minor[i]);
    put_stress(w, "c", c);
    return SN_OK;
}

static sn_status hgo(febio_writer *w) {
    put_stress(w, "c", get(w, "mu"));
    put_stress(w, "k1", get(w, "k1"));
    put(w, "k2", get(w, "k2"));
    put(w, "kappa", get(w, "kappa"));
    put(w, "gamma", get(w, "angle") * (180 / 3.14159265358979323846));
    return SN_OK;
}

static const struct {
    const char *law, *type;
    sn_status (*write)(febio_writer *w);
} laws[] = {
    {"neo-hookean", "Mooney-Rivlin", neo_hookean},
    {"mooney-rivlin", "Mooney-Rivlin", mooney_rivlin},
    {"ogden", "Ogden", ogden},
    {"demiray", "uncoupled hyperelastic", demiray},
    {"veronda-westmann", "Veronda-Westmann", veronda_westmann},
    {"fung", "Fung orthotropic", fung},
    {"guccione", "Fung orthotropic", fung},
    {"hgo", "Holzapfel-Gasser-Ogden", hgo},
};

//---- the file ------------------------------------------------------------------------------------

static void put_memory(febio_writer *w, const sn_exponentials *e) {
    char name[8];
    double scale = e->g_inf > 0 ? 1 / e->g_inf : 1;
    put(w, "g0", e->g_inf > 0 ? 1 : 0);
    for (int i = 0; i < e->terms; i++) {
        snprintf(name, sizeof name, "g%d", i + 1);
        put(w, name, e->g[i] * scale);
    }
    for (int i = 0; i < e->terms; i++) {
        snprintf(name, sizeof name, "t%d", i + 1);
        put(w, name, e->tau[i] / w->how->time);
    }
}

static sn_status write_material(febio_writer *w, int law, const sn_exponentials *e) {
    double density = w->tissue->density / sn_foreign_density(w->how);
    sn_buffer_text(&w->out, "    <material id=\"1\" name=\"");
    sn_buffer_escape(&w->out, *w->tissue->name ? w->tissue->name : "tissue");
    sn_buffer_print(&w->out, "\" type=\"%s\">\n",
                    e->terms ? "uncoupled viscoelastic" : laws[law].type);
    w->indent = "      ";
    if (isfinite(density)) put(w, "density", density);
    put_stress(w, "k", get(w, "bulk_modulus"));
    sn_buffer_print(&w->out, "%s<pressure_model>2</pressure_model>\n", w->indent);
    if (!e->terms) {
        SN_TRY(laws[law].write(w));
    } else {
        put_memory(w, e);
        sn_buffer_print(&w->out, "%s<elastic type=\"%s\">\n", w->indent, laws[law].type);
        w->indent = "        ";
        if (isfinite(density)) put(w, "density", density);
        SN_TRY(laws[law].write(w));
        sn_buffer_text(&w->out, "      </elastic>\n");
    }
    sn_buffer_text(&w->out, "    </material>\n");
    return SN_OK;
}

static sn_status find_law(const sn_tissue *tissue, int *law) {
    for (int k = 0; k < (int)(sizeof laws / sizeof laws[0]); k++) {
        if (strcmp(laws[k].law, tissue->law->name) != 0) continue;
        *law = k;
        if (isfinite(sn_tissue_value(tissue, "bulk_modulus"))) return SN_OK;
        return sn_fail(SN_E_UNSUPPORTED,
                       "bulk_modulus is incompressible: FEBio needs a number, such as a thousand "
                       "times the shear modulus");
    }
    return sn_fail(SN_E_UNSUPPORTED,
                   "law %s has no counterpart in FEBio: there are neo-hookean, mooney-rivlin, "
                   "ogden, demiray, veronda-westmann, fung, guccione, hgo",
                   tissue->law->name);
}

static void remarks(const sn_tissue *tissue, const sn_exponentials *e, sn_foreign *how) {
    if (tissue->law->fibres)
        sn_foreign_remark(how, "the axes of the material are mat_axis in FEBio, the first that of "
                               "the fibres: give them to the part");
    if (e->terms)
        sn_foreign_remark(how, "FEBio's memory spares the volume: k does not relax there");
}

sn_status sn_tissue_write_febio(const char *path, const sn_tissue *tissue, sn_foreign *how) {
    sn_exponentials e;
    int law = 0;
    SN_TRY(sn_foreign_start(tissue, how));
    SN_TRY(find_law(tissue, &law));
    SN_TRY(sn_foreign_memory(tissue, TERMS_MAX, how, &e));
    remarks(tissue, &e, how);
    sn_tissue scaled = *tissue;
    if (e.terms && e.g_inf > 0) sn_foreign_scale(&scaled, e.g_inf, false);
    febio_writer w = {.tissue = &scaled, .how = how, .indent = ""};
    sn_buffer_text(&w.out,
                   "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<febio_spec version=\"4.0\">\n"
                   "  <Module type=\"solid\"/>\n  <Material>\n");
    sn_status status = write_material(&w, law, &e);
    sn_buffer_text(&w.out, "  </Material>\n</febio_spec>\n");
    if (status == SN_OK) status = w.out.status;
    if (status == SN_OK) status = sn_text_write(path, w.out.text, w.out.size);
    sn_buffer_free(&w.out);
    return status;
}
