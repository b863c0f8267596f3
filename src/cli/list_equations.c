// Every equation of the source paper: what it is, where it lives, what proves it.
// SPDX-License-Identifier: Apache-2.0
//
// Numbers are those of the compiled paper. A proof is FOLDER.FILE:FUNCTION, the function of that
// name in tests/FOLDER/test_FILE.c; tests/cli/list.sh looks every one of them up. `state` is
// "proven", "partly" with what is missing, or "not implemented".
#include <stdio.h>

#include "cli/list.h"

typedef struct equation {
    int number;
    const char *what;
    const char *where; ///< files below src/, empty where there is none
    const char *proof; ///< separated by "; ", empty where there is none
    const char *state;
} equation;

#define PROVEN "proven"
#define NO_FLUID "not implemented: no fluid yet"

static const equation equations[] = {
    {1, "balance of momentum with balance of mass", "springs/explicit.c",
     "springs.explicit:free_body_conserves",
     "partly: in the form (3); the mass of a Lagrangian mesh is constant"},
    {2, "balance of mass", "springs/net.c", "springs.explicit:free_body_conserves",
     "partly: the mass of a Lagrangian mesh is constant, no flux through its cells"},
    {3, "balance of momentum", "springs/explicit.c, continuum/newton.c",
     "springs.explicit:free_body_conserves; continuum.solids:hanging_bar; "
     "continuum.balance:patch_test",
     PROVEN},
    {4, "incompressibility, at finite strain J = 1", "lab/protocol/uniaxial.c, continuum/cell.c",
     "lab.machine:incompressible_solid_follows_quadrature; "
     "lab.machine:compressible_tends_to_incompressible; continuum.solids:uniaxial",
     PROVEN},
    {5, "isotropic Hooke's law", "law/laws/hookean.c",
     "law.closed_forms:test_energies; law.battery:test_isotropy; continuum.solids:hanging_bar",
     PROVEN},
    {6, "motion of a Hookean body, by strain", "springs/explicit.c",
     "springs.explicit:bar_rings_at_its_frequency", PROVEN},
    {7, "small strain", "springs/kernels/cells.c, continuum/point.c",
     "continuum.balance:rotation; law.closed_forms:test_limits",
     "partly: Green strain (15) stands in its place, which equals it where (7) holds"},
    {8, "velocity and acceleration of a particle", "springs/explicit.c",
     "springs.explicit:bar_rings_at_its_frequency", PROVEN},
    {9, "motion of a Hookean body, by displacement",
     "springs/explicit.c, continuum/inertia.c, continuum/linear.c",
     "springs.explicit:bar_rings_at_its_frequency; continuum.dynamic:sudden_pull; "
     "continuum.linear:limit",
     PROVEN},
    {10, "Newtonian fluid, compressible", "", "", NO_FLUID},
    {11, "Newtonian fluid, incompressible", "", "", NO_FLUID},
    {12, "Navier-Stokes equations", "", "", NO_FLUID},
    {13, "slope of the curve linear in the stress", "lab/reduce/tensile.c",
     "lab.reduce:exponential_curve_has_no_yield", PROVEN},
    {14, "exponential stress-stretch law", "law/laws/exponential.c",
     "law.closed_forms:test_uniaxial_tension; law.closed_forms:test_limits", PROVEN},
    {15, "Green strain", "lab/reduce/curve.c, continuum/point.c",
     "lab.reduce:every_column_becomes_stretch_and_nominal_stress; law.battery:test_derivatives",
     PROVEN},
    {16, "second Piola-Kirchhoff stress from an energy", "law/solid.h",
     "law.battery:test_derivatives", PROVEN},
    {17, "second Piola-Kirchhoff stress from force and stretch", "lab/reduce/curve.c",
     "lab.reduce:every_column_becomes_stretch_and_nominal_stress", PROVEN},
    {18, "Fung's energy, general form", "law/laws/fung.c, law/laws/fung_general.c",
     "law.fibres:test_fung_limits; law.battery:test_derivatives",
     "partly: no polynomial in front of the exponential, no linear term in it"},
    {19, "biaxial energy of skin (with the sign missing in print)", "law/laws/fung_skin.c",
     "law.battery:test_derivatives; law.fibres:test_membrane_limits", PROVEN},
    {20, "biaxial stresses of skin", "law/laws/fung_skin.c",
     "law.battery:test_derivatives; law.fibres:test_membrane_limits", PROVEN},
    {21, "reduced biaxial energy", "law/laws/fung_planar.c",
     "law.battery:test_derivatives; law.fibres:test_membrane_limits", PROVEN},
    {22, "Maxwell body", "relax/maxwell.c", "relax.laws:test_closed_forms", PROVEN},
    {23, "Maxwell body, creep", "relax/creep.c",
     "relax.creep:closed_forms; lab.creep:step_has_its_closed_forms", PROVEN},
    {24, "Maxwell body, relaxation", "relax/maxwell.c", "relax.laws:test_closed_forms", PROVEN},
    {25, "unit step", "lab/protocol/hereditary.c, lab/protocol/creep.c",
     "lab.machine:step_relaxes_with_g; lab.creep:step_has_its_closed_forms", PROVEN},
    {26, "Voigt body", "relax/voigt.c", "lab.machine:voigt_ramp_has_its_closed_form", PROVEN},
    {27, "Voigt body, creep and relaxation", "relax/voigt.c, relax/creep.c",
     "relax.laws:test_closed_forms; relax.creep:closed_forms; "
     "lab.machine:voigt_ramp_has_its_closed_form",
     PROVEN},
    {28, "Kelvin body", "relax/kelvin.c", "relax.laws:test_closed_forms; relax.creep:closed_forms",
     PROVEN},
    {29, "Kelvin body, creep and relaxation", "relax/kelvin.c, relax/creep.c",
     "relax.laws:test_closed_forms; relax.creep:closed_forms; "
     "lab.machine:hysteresis_has_its_closed_forms",
     PROVEN},
    {30, "superposition of creep", "lab/protocol/creep.c", "lab.creep:uniaxial_law_superposes",
     PROVEN},
    {31, "superposition of relaxation", "lab/protocol/hereditary.c",
     "lab.machine:exponential_law_follows_quadrature", PROVEN},
    {32, "relaxation as a sum of exponentials", "relax/prony.c, relax/exponentials.c",
     "relax.exponentials:test_expand_samples; relax.exponentials:test_factors; "
     "relax.laws:test_completely_monotone",
     PROVEN},
    {33, "quasi-linear viscoelasticity, step of strain", "lab/protocol/hereditary.c",
     "lab.machine:step_relaxes_with_g; continuum.memory:relaxation; "
     "springs.quasi_static:relaxation_follows_the_memory",
     "partly: one scalar G for all components"},
    {34, "quasi-linear viscoelasticity, increment", "relax/exponentials.c",
     "relax.exponentials:test_factors; springs.central:spring_remembers",
     "partly: one scalar G for all components"},
    {35, "quasi-linear viscoelasticity, hereditary integral", "lab/protocol/hereditary.c",
     "lab.machine:incompressible_solid_follows_quadrature; "
     "lab.machine:compressible_solid_follows_direct_convolution; "
     "relax.exponentials:test_second_order; "
     "verification.strip:both_engines_follow_the_virtual_test",
     "partly: one scalar G for all components"},
    {36, "reduced relaxation of a Kelvin body", "relax/kelvin.c", "relax.laws:test_closed_forms",
     PROVEN},
    {37, "continuous spectrum", "relax/fung_spectrum.c", "relax.laws:test_spectrum_is_its_integral",
     PROVEN},
    {38, "spectrum c/q between two times, and its closed form", "relax/fung_spectrum.c",
     "relax.laws:test_reference; relax.laws:test_spectrum_is_its_integral; "
     "lab.sweep:bell_and_plateau",
     PROVEN},
    {39, "influence coefficients: deflections and forces", "", "",
     "not implemented: K and C of a body are not formed yet"},
    {40, "elastic energy of a body", "springs/forces.c",
     "springs.forces:forces_are_energy_slopes; springs.explicit:ledger_closes",
     "partly: the energy; not as a quadratic form of influence coefficients"},
    {41, "network of masses, springs and dampers", "springs/explicit.c",
     "springs.explicit:bar_rings_at_its_frequency; "
     "springs.explicit:damping_spares_rigid_motion",
     PROVEN},
    {42, "rate of kinetic energy", "springs/explicit.c", "springs.explicit:ledger_closes", PROVEN},
    {43, "balance of energy", "springs/explicit.c",
     "springs.explicit:ledger_closes; springs.explicit:free_body_conserves",
     "partly: mechanical terms; heat is what dissipates"},
    {44, "rates of elastic energy and of work", "springs/forces.c",
     "springs.forces:forces_are_energy_slopes; springs.explicit:ledger_closes", PROVEN},
    {45, "virtual power of a system", "springs/explicit.c", "springs.explicit:ledger_closes",
     "partly: positions of nodes are the coordinates"},
    {46, "Lagrange's equations", "springs/explicit.c",
     "springs.forces:forces_are_energy_slopes; springs.explicit:bar_rings_at_its_frequency",
     "partly: positions of nodes are the coordinates"},
    {47, "hereditary force between coordinates", "springs/edges.c",
     "springs.central:spring_remembers; springs.quasi_static:relaxation_follows_the_memory",
     "partly: every spring for itself; no matrix of generalised coordinates"},
    {48, "hereditary matrix as exponentials", "springs/edges.c", "springs.central:spring_remembers",
     "partly: every spring for itself; no matrix of generalised coordinates"},
    {49, "memory of a fluid around the body", "", "", NO_FLUID},
    {50, "body with the memories of tissue and fluid", "", "", NO_FLUID},
};

int list_equations(json_t *sections, int count, char **names) {
    if (count > 0) return cli_refuse("list equations: nothing may follow, got \"%s\"", names[0]);
    json_t *rows = list_section(sections, NULL, NULL);
    for (int k = 0; k < (int)(sizeof equations / sizeof equations[0]); k++) {
        const equation *e = &equations[k];
        char number[16];
        json_t *row = json_object();
        snprintf(number, sizeof number, "(%d)", e->number);
        cli_put_text(row, "equation", number);
        cli_put_text(row, "what", e->what);
        cli_put_text(row, "state", e->state);
        cli_put_text(row, "code", e->where);
        cli_put_text(row, "proof", e->proof);
        json_array_append_new(rows, row);
    }
    return -1;
}
