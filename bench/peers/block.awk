# block.yaml, tissue.yaml for sinew and block.inp for CalculiX: awk -v n=CELLS -f block.awk
# SPDX-License-Identifier: Apache-2.0
# Kuhn tetrahedra: six paths along the edges of each brick from its lowest to its highest corner.

function node(i, j, k) { return 1 + i + (n + 1) * (j + (n + 1) * k) }

BEGIN {
    print "tissue: block\ndensity: 1000 kg/m3" >"tissue.yaml"
    print "elastic: {law: mooney-rivlin, c1: 1 Pa, c2: 0.1 Pa, bulk_modulus: 100 Pa}" >"tissue.yaml"
    file = "block.yaml"
    print "case: block\nmesh: {block: {size: [1 m, 1 m, 1 m], cells: [" n ", " n ", " n "], pattern: kuhn}}" >file
    print "tissue: tissue.yaml\nsupports: [{on: bottom, fix: xyz}]" >file
    print "loads: [{on: top, displacement: [0 m, 0 m, 0.3 m], time: {ramp: 1 s}}]" >file
    print "time: {until: 1 s, output_every: 1 s}" >file
    print "continuum: {element: P1, analysis: quasi-static, steps: 10}" >file

    file = "block.inp"
    split("xyz yzx zxy xzy zyx yxz", path, " ")
    print "*NODE, NSET=ALL" >file
    for (k = 0; k <= n; k++)
        for (j = 0; j <= n; j++)
            for (i = 0; i <= n; i++)
                printf "%d, %.12g, %.12g, %.12g\n", node(i, j, k), i / n, j / n, k / n >file
    print "*ELEMENT, TYPE=C3D4, ELSET=BODY" >file
    for (k = 0; k < n; k++)
        for (j = 0; j < n; j++)
            for (i = 0; i < n; i++)
                for (p = 1; p <= 6; p++) {
                    at["x"] = at["y"] = at["z"] = 0
                    for (s = 0; s <= 3; s++) {
                        if (s) at[substr(path[p], s, 1)] = 1
                        corner[s] = node(i + at["x"], j + at["y"], k + at["z"])
                    }
                    if (p > 3) { # an odd path: turned round
                        swap = corner[2]
                        corner[2] = corner[3]
                        corner[3] = swap
                    }
                    print ++count ", " corner[0] ", " corner[1] ", " corner[2] ", " corner[3] >file
                }
    print "*NSET, NSET=BOTTOM, GENERATE\n1, " (n + 1) * (n + 1) >file
    print "*NSET, NSET=TOP, GENERATE\n" node(0, 0, n) ", " node(n, n, n) >file
    # U = (J - 1)^2/D1 there, K/2 (J - 1)^2 here: D1 = 2/K
    print "*MATERIAL, NAME=M\n*HYPERELASTIC, MOONEY-RIVLIN\n1, 0.1, 0.02" >file
    print "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n*BOUNDARY\nBOTTOM, 1, 3" >file
    print "*STEP, NLGEOM, INC=200\n*STATIC\n0.1, 1, 1e-3, 0.1" >file
    print "*BOUNDARY\nTOP, 1, 2\nTOP, 3, 3, 0.3" >file
    print "*NODE PRINT, NSET=TOP, TOTALS=ONLY\nRF\n*END STEP" >file
}
