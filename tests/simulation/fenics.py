"""dolfinx (FEniCS): Stokes flow through a tube of tetrahedra, by way of a Gmsh file and its named patches."""
import logging
import os

import numpy

import vessels
from report import Absent, expect

VISCOSITY = 1.0  # in mm, s and any unit of mass
PATCHES = {"wall": 1, "inlet": 2, "outlet": 3}  # their physical groups, as vmesh numbers them


def import_dolfinx():
    try:
        import dolfinx
        import dolfinx.fem.petsc
        import gmsh
        import ufl
        from dolfinx.io import gmshio
    except ImportError as error:
        raise Absent(f"dolfinx is not installed (Debian: python3-dolfinx, python3-gmsh): {error}") from None
    logging.getLogger().setLevel(logging.WARNING)  # which it lowers, to tell of every form that it compiles
    return dolfinx, ufl, gmsh, gmshio


def groups_by_name(path):
    """Physical groups of patches, from the file."""
    with open(path) as file:
        lines = file.read().splitlines()
    start = lines.index("$PhysicalNames")
    rows = [line.split() for line in lines[start + 2 : start + 2 + int(lines[start + 1])]]
    return {name.strip('"'): int(number) for dimension, number, name in rows if dimension == "2"}


def check_tube(vmesh, folder, table):
    dolfinx, ufl, gmsh, gmshio = import_dolfinx()
    from mpi4py import MPI

    path = os.path.join(folder, "tube.msh")
    vmesh.volume("tube", path, "--around", 12, "--layers", 2, "--tetrahedra")
    expect(groups_by_name(path) == PATCHES, f"the groups are {groups_by_name(path)}")
    gmsh.initialize(["-nopopup", "-v", "2"])  # what gmshio.read_from_msh() does, where it works
    gmsh.merge(path)
    mesh, _, patches = gmshio.model_to_mesh(gmsh.model, MPI.COMM_SELF, 0, gdim=3)
    gmsh.finalize()
    cells = mesh.topology.index_map(3).size_local
    normal = ufl.FacetNormal(mesh)
    ds = ufl.Measure("ds", domain=mesh, subdomain_data=patches)
    one = dolfinx.fem.Constant(mesh, 1.0)

    def integral(form):
        return dolfinx.fem.assemble_scalar(dolfinx.fem.form(form))

    area = integral(one * ds(PATCHES["inlet"]))
    velocities = ufl.VectorElement("Lagrange", mesh.ufl_cell(), 2)
    pressures = ufl.FiniteElement("Lagrange", mesh.ufl_cell(), 1)
    space = dolfinx.fem.FunctionSpace(mesh, ufl.MixedElement([velocities, pressures]))
    of_velocity, _ = space.sub(0).collapse()
    entering = dolfinx.fem.Function(of_velocity)
    entering.interpolate(lambda x: numpy.stack([0 * x[0], 0 * x[0], vessels.parabola(
        numpy.stack([x[0], x[1], 0 * x[0]], 1), numpy.zeros(3), area)]))
    at_rest = dolfinx.fem.Function(of_velocity)

    def held(name, values):
        facets = patches.find(PATCHES[name])
        places = dolfinx.fem.locate_dofs_topological((space.sub(0), of_velocity), 2, facets)
        return dolfinx.fem.dirichletbc(values, places, space.sub(0))

    u, p = ufl.TrialFunctions(space)
    v, q = ufl.TestFunctions(space)
    stiffness = (VISCOSITY * ufl.inner(ufl.grad(u), ufl.grad(v)) - p * ufl.div(v) - q * ufl.div(u)) * ufl.dx
    load = ufl.inner(dolfinx.fem.Constant(mesh, (0.0, 0.0, 0.0)), v) * ufl.dx
    direct = {"ksp_type": "preonly", "pc_type": "lu", "pc_factor_mat_solver_type": "mumps"}
    # The wall last, so that it is at rest where it meets the inlet.
    problem = dolfinx.fem.petsc.LinearProblem(stiffness, load, [held("inlet", entering), held("wall", at_rest)],
                                              petsc_options=direct)
    velocity, pressure = problem.solve().split()

    def flux(name):
        return integral(ufl.dot(velocity, normal) * ds(PATCHES[name]))

    note = f"flow through the wall {abs(flux('wall')):.1g} mm^3/s"
    table.add("dolfinx", "Stokes flow, what leaves by what enters", cells, -flux("outlet") / flux("inlet"), 1.0, 1e-3,
              "conservation", "1", note)
    z = ufl.SpatialCoordinate(mesh)[2]

    def mean_within(low, high):
        inside = ufl.conditional(ufl.And(ufl.gt(z, low), ufl.lt(z, high)), 1.0, 0.0)
        volume = integral(inside * ufl.dx(domain=mesh))
        return integral(pressure * inside * ufl.dx) / volume, integral(z * inside * ufl.dx(domain=mesh)) / volume

    length = vessels.LENGTH_MM
    (first, at_first), (second, at_second) = mean_within(0.2 * length, 0.4 * length), mean_within(0.6 * length, 0.8 * length)
    lost = (first - second) / (at_second - at_first)
    table.add("dolfinx", "Stokes flow, pressure lost per length", cells, lost,
              vessels.poiseuille_gradient(-flux("inlet"), VISCOSITY, area), 0.02, "Poiseuille", "1")
