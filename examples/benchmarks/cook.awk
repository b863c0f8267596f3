# Cook's membrane as a Gmsh 2.2 mesh in mm: awk -v n=8 -f cook.awk >cook.msh
# SPDX-License-Identifier: Apache-2.0
# Corners (0,0) (48,44) (48,60) (0,44), 1 mm thick; n x n x 1 bricks of six tetrahedra each.
# Physical surfaces: left, right, front (z = 0), back (z = 1 mm); physical volume: membrane.

function node(i, j, k) { return 1 + i + (n + 1) * (j + (n + 1) * k) }

# a physical number for a tetrahedron or triangle
function element(type, physical, nodes) {
    line[++count] = type " 2 " physical " " physical " " nodes
}

# two triangles of a side of the body, cut from its lowest to its highest node as the bricks are
function side(physical, a, b, c, d) {
    element(2, physical, a " " b " " c)
    element(2, physical, a " " c " " d)
}

# six paths along the edges of the brick at (i, j) from its lowest to its highest corner
function brick(i, j,    p, axis, k, at, text) {
    for (p = 1; p <= 6; p++) {
        at["x"] = at["y"] = at["z"] = 0
        text = node(i, j, 0)
        for (k = 1; k <= 3; k++) {
            axis = substr(path[p], k, 1)
            at[axis] = 1
            text = text " " node(i + at["x"], j + at["y"], at["z"])
        }
        element(4, 5, text)
    }
}

BEGIN {
    if (n < 1) n = 8
    split("xyz yzx zxy xzy zyx yxz", path, " ")
    print "$MeshFormat\n2.2 0 8\n$EndMeshFormat"
    print "$PhysicalNames\n5\n2 1 \"left\"\n2 2 \"right\"\n2 3 \"front\"\n2 4 \"back\""
    print "3 5 \"membrane\"\n$EndPhysicalNames"
    print "$Nodes\n" 2 * (n + 1) * (n + 1)
    for (k = 0; k <= 1; k++)
        for (j = 0; j <= n; j++)
            for (i = 0; i <= n; i++) {
                low = 44 * i / n
                high = 44 + 16 * i / n
                printf "%d %.12g %.12g %d\n", node(i, j, k), 48 * i / n, low + (high - low) * j / n, k
            }
    print "$EndNodes"
    for (j = 0; j < n; j++) {
        side(1, node(0, j, 0), node(0, j + 1, 0), node(0, j + 1, 1), node(0, j, 1))
        side(2, node(n, j, 0), node(n, j + 1, 0), node(n, j + 1, 1), node(n, j, 1))
        for (i = 0; i < n; i++) {
            side(3, node(i, j, 0), node(i + 1, j, 0), node(i + 1, j + 1, 0), node(i, j + 1, 0))
            side(4, node(i, j, 1), node(i + 1, j, 1), node(i + 1, j + 1, 1), node(i, j + 1, 1))
            brick(i, j)
        }
    }
    print "$Elements\n" count
    for (k = 1; k <= count; k++) print k " " line[k]
    print "$EndElements"
}
