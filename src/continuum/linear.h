// Linear statics: Navier's equation with the tangent of the laws at rest.
// SPDX-License-Identifier: Apache-2.0
// Source: equation (9).
//
// The stiffness at rest is factored once; every stop of the schedule is one solution. Loads act on
// the body at rest, so pressure does not follow. Strains, stresses, reactions and the energy belong
// to the linear displacement u. They come from the code of finite strain at +s u and -s u, with s
// so small that the largest strain is 1e-5: the odd part over s (of the energy density the even
// part over s^2) is the linear one to 1e-6 or better.
#pragma once

#include "continuum/march.h"

/// Goes through the whole programme. @return SN_OK, SN_E_SOLVER (singular), what the output says.
sn_status sn_fe_linear_go(sn_fe_march *m);
/// Elastic energy of the last state, J.
double sn_fe_linear_energy(sn_fe_march *m);
