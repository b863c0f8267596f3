"""The cube of `sinew bench continuum` in dolfinx: block.py CELLS."""
# SPDX-License-Identifier: Apache-2.0
import sys

import numpy as np
import ufl
from dolfinx import fem, mesh, nls
from mpi4py import MPI
from petsc4py import PETSc

n = int(sys.argv[1])
body = mesh.create_unit_cube(MPI.COMM_WORLD, n, n, n, mesh.CellType.tetrahedron)
space = fem.VectorFunctionSpace(body, ("Lagrange", 1))
u, v = fem.Function(space), ufl.TestFunction(space)

F = ufl.Identity(3) + ufl.grad(u)
J, C = ufl.det(F), F.T * F
I1 = ufl.tr(C)
I2 = (I1**2 - ufl.tr(C * C)) / 2
W = (J ** (-2 / 3) * I1 - 3) + 0.1 * (J ** (-4 / 3) * I2 - 3) + 50 * (J - 1) ** 2
# one point: all is constant in a linear cell
balance = ufl.derivative(W * ufl.dx(metadata={"quadrature_degree": 0}), u, v)

pull = fem.Constant(body, PETSc.ScalarType((0.0, 0.0, 0.0)))
ends = []
for z, value in ((0.0, fem.Constant(body, PETSc.ScalarType((0.0, 0.0, 0.0)))), (1.0, pull)):
    nodes = fem.locate_dofs_geometrical(space, lambda x, z=z: np.isclose(x[2], z))
    ends.append(fem.dirichletbc(value, nodes, space))

problem = fem.petsc.NonlinearProblem(balance, u, ends)
solver = nls.petsc.NewtonSolver(body.comm, problem)
solver.convergence_criterion = "residual"
solver.rtol, solver.atol = 1e-8, 1e-10
options = PETSc.Options()
prefix = solver.krylov_solver.getOptionsPrefix()
options[prefix + "ksp_type"] = "preonly"
options[prefix + "pc_type"] = "lu"
options[prefix + "pc_factor_mat_solver_type"] = "mumps"
solver.krylov_solver.setFromOptions()

iterations = 0
for step in range(1, 11):
    pull.value[2] = 0.03 * step
    iterations += solver.solve(u)[0]
print(f"{iterations} iterations")
