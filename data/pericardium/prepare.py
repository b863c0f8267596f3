#!/usr/bin/env python3
# Pairs the digitised directions of each protocol: see SOURCE.md.
# SPDX-License-Identifier: Apache-2.0
#
# Reads digitised/PROTOCOL-DIRECTION.csv, writes protocol-PROTOCOL.csv beside this script.
import csv, math, os

here = os.path.dirname(os.path.abspath(__file__))
# label as published (second axis : first axis) and T1/T2, the ratio of the nominal stresses
protocols = {"1-1": 1.0, "1-0.5": 0.5, "0.5-1": 2.0}


def read(protocol, direction):
    """Green strain and second Piola-Kirchhoff stress [kPa], from the unloaded state on."""
    path = os.path.join(here, "digitised", f"{protocol}-E{direction}{direction}.csv")
    with open(path) as file:
        rows = [r for r in csv.reader(l for l in file if not l.startswith("#"))][1:]
    return [(0.0, 0.0)] + [(float(e), float(s)) for e, s in rows]


def tension(e, s):
    return math.sqrt(1 + 2 * e) * s


def at_tension(curve, wanted):
    """Green strain and stress where the nominal stress is `wanted`, straight between rows."""
    for (e0, s0), (e1, s1) in zip(curve, curve[1:]):
        t0, t1 = tension(e0, s0), tension(e1, s1)
        if t0 <= wanted <= t1:
            e = e0 + (e1 - e0) * (wanted - t0) / (t1 - t0)
            return e, wanted / math.sqrt(1 + 2 * e)
    return None


for protocol, ratio in protocols.items():
    one, two = read(protocol, 1), read(protocol, 2)
    rows = []
    for e, s in one[1:]:
        partner = at_tension(two, tension(e, s) / ratio)
        if partner:
            rows.append((e, s, *partner))
    for e, s in two[1:]:
        partner = at_tension(one, tension(e, s) * ratio)
        if partner:
            rows.append((*partner, e, s))
    rows.sort(key=lambda r: tension(r[0], r[1]))
    with open(os.path.join(here, f"protocol-{protocol}.csv"), "w") as out:
        out.write(f"# specimen: pericardium, planar biaxial tension, protocol {protocol.replace('-', ':')}\n")
        out.write("# source: Armfield, AnisotropicHyperelastic_Calibration (MIT licence), after Li et al., "
                  "digitised curves reduced\n")
        out.write(f"# remark: directions paired at T1/T2 = {ratio:g} by prepare.py, see SOURCE.md\n")
        out.write("green_strain_1 [1],pk2_stress_1 [kPa],green_strain_2 [1],pk2_stress_2 [kPa]\n")
        for r in rows:
            out.write(",".join(f"{v:.5f}" if k % 2 == 0 else f"{v:.2f}" for k, v in enumerate(r)) + "\n")
