"""OpenFOAM: whether it finds a mesh good, and laminar flow through it."""
import os
import re
import shutil

import numpy

import vessels
from report import Absent, expect, run

NU = 3.5e-6  # m^2/s, blood's
MEAN_VELOCITY = 0.05  # m/s; a Reynolds number of 57 at a radius of 2 mm

DEBIANS_FOLDER = "/usr/share/openfoam"

HEAD = "FoamFile\n{{\n    version 2.0;\n    format ascii;\n    class {};\n    object {};\n}}\n"

CONTROL = """application simpleFoam;
startFrom startTime; startTime 0; stopAt endTime; endTime 2000; deltaT 1;
writeControl timeStep; writeInterval 2000; purgeWrite 1; writeFormat ascii; writePrecision 10;
timeFormat general; runTimeModifiable false;
"""

# A gradient from the four neighbours of a tetrahedron alone would make the loss of pressure 8 % too large.
SCHEMES = """ddtSchemes { default steadyState; }
gradSchemes { default pointCellsLeastSquares; }
divSchemes { default none; div(phi,U) bounded Gauss linear; div((nuEff*dev2(T(grad(U))))) Gauss linear; }
laplacianSchemes { default Gauss linear corrected; }
interpolationSchemes { default linear; }
snGradSchemes { default corrected; }
"""

SOLUTION = """solvers
{
    p { solver PCG; preconditioner DIC; tolerance 1e-10; relTol 0.02; }
    U { solver PBiCGStab; preconditioner DILU; tolerance 1e-12; relTol 0.1; }
}
SIMPLE
{
    consistent yes;
    nNonOrthogonalCorrectors 1;
    residualControl { p 1e-5; U 1e-5; }
}
relaxationFactors { equations { U 0.9; } }
"""


def entries(path):
    """The lines of an OpenFOAM list between its brackets."""
    with open(path) as file:
        text = file.read()
    start = text.index("(\n", text.index("\n}\n")) + 2
    return text[start : text.rindex("\n)")].splitlines()


class FoamMesh:
    """A polyMesh folder: points (n x 3), faces, the cell that owns each, patches by name."""

    def __init__(self, folder):
        read = {name: entries(os.path.join(folder, name)) for name in ("points", "faces", "owner", "neighbour")}
        self.points = numpy.array([line.strip("()").split() for line in read["points"]], float)
        self.faces = [[int(v) for v in line[2:-1].split()] for line in read["faces"]]
        self.owner = numpy.array(read["owner"], int)
        self.neighbour = numpy.array(read["neighbour"], int)
        with open(os.path.join(folder, "boundary")) as file:
            text = file.read()
        found = re.findall(r"(\S+)\s*\{\s*type\s+\S+;\s*nFaces\s+(\d+);\s*startFace\s+(\d+);", text)
        self.patches = {name: range(int(start), int(start) + int(count)) for name, count, start in found}
        self.cells = int(max(self.owner.max(), self.neighbour.max())) + 1

    def areas_and_centres(self, patch):
        """Area vectors (n x 3) and centres (n x 3) of the faces of a patch."""
        vectors, centres = [], []
        for face in (self.faces[f] for f in self.patches[patch]):
            corners = self.points[face]
            centre = corners.mean(axis=0)
            parts = [numpy.cross(a - centre, b - centre) / 2 for a, b in zip(corners, numpy.roll(corners, -1, 0))]
            vectors.append(sum(parts))
            thirds = [(a + b + centre) / 3 for a, b in zip(corners, numpy.roll(corners, -1, 0))]
            weights = [numpy.linalg.norm(part) for part in parts]
            centres.append(numpy.average(thirds, axis=0, weights=weights))
        return numpy.array(vectors), numpy.array(centres)

    def cell_centres(self):
        """The mean of the corners of a cell's faces, near enough to its centre to fit a line through many."""
        sums, counts = numpy.zeros((self.cells, 3)), numpy.zeros(self.cells)
        for f, face in enumerate(self.faces):
            centre = self.points[face].mean(axis=0)
            for cell in (self.owner[f], *self.neighbour[f : f + 1]):
                sums[cell] += centre
                counts[cell] += 1
        return sums / counts[:, None]


class Case:
    """A folder in which OpenFOAM runs. The mesh is in metres."""

    def __init__(self, folder):
        if not shutil.which("simpleFoam") or not shutil.which("checkMesh"):
            raise Absent("OpenFOAM is not installed (Debian: openfoam)")
        self.folder = folder
        for name in ("0", "constant", "system"):
            os.makedirs(os.path.join(folder, name), exist_ok=True)
        self.mesh_folder = os.path.join(folder, "constant", "polyMesh")
        self.write("system/controlDict", "dictionary", CONTROL)
        self.write("system/fvSchemes", "dictionary", SCHEMES)
        self.write("system/fvSolution", "dictionary", SOLUTION)
        self.write("constant/transportProperties", "dictionary", f"transportModel Newtonian;\nnu {NU};\n")
        self.write("constant/turbulenceProperties", "dictionary", "simulationType laminar;\n")

    def write(self, name, kind, text):
        with open(os.path.join(self.folder, name), "w") as file:
            file.write(HEAD.format(kind, os.path.basename(name)) + text)

    def run(self, program):
        return run([program, "-case", self.folder], env={"WM_PROJECT_DIR": DEBIANS_FOLDER} | os.environ)

    def check_mesh(self):
        """Its figures. Wrong unless OpenFOAM says that the mesh is good."""
        said = self.run("checkMesh")
        expect("Mesh OK." in said, "checkMesh: " + "; ".join(re.findall(r"\*+(.*)", said)))
        non_orthogonality = float(re.search(r"non-orthogonality Max: (\S+)", said).group(1))
        skewness = float(re.search(r"Max skewness = (\S+)", said).group(1).rstrip(","))
        return non_orthogonality, skewness

    def flow(self):
        """Solves for the flow that enters with a parabola. Returns mesh, area of the inlet, flow, pressure of cells."""
        mesh = FoamMesh(self.mesh_folder)
        vectors, centres = mesh.areas_and_centres("inlet")
        area = numpy.linalg.norm(vectors.sum(axis=0))
        middle = numpy.average(centres, axis=0, weights=numpy.linalg.norm(vectors, axis=1))
        inwards = -vectors.sum(axis=0) / area
        speed = MEAN_VELOCITY * vessels.parabola(centres, middle, area)
        flow = -(vectors @ inwards * speed).sum()
        values = "\n".join("({:.12g} {:.12g} {:.12g})".format(*(s * inwards)) for s in speed)
        self.write("0/U", "volVectorField", "dimensions [0 1 -1 0 0 0 0];\ninternalField uniform (0 0 0);\n"
                   "boundaryField\n{\n    wall { type noSlip; }\n    outlet { type zeroGradient; }\n"
                   f"    inlet {{ type fixedValue; value nonuniform List<vector> {len(speed)}\n(\n{values}\n); }}\n}}\n")
        self.write("0/p", "volScalarField", "dimensions [0 2 -2 0 0 0 0];\ninternalField uniform 0;\n"
                   "boundaryField\n{\n    wall { type zeroGradient; }\n    inlet { type zeroGradient; }\n"
                   "    outlet { type fixedValue; value uniform 0; }\n}\n")
        said = self.run("simpleFoam")
        converged = re.search(r"SIMPLE solution converged in (\d+) iterations", said)
        expect(converged, "simpleFoam: no convergence in 2000 iterations")
        pressure = numpy.array(entries(os.path.join(self.folder, converged.group(1), "p")), float)[: mesh.cells]
        return mesh, area, flow, pressure


def check_tube(vmesh, folder, table):
    case = Case(os.path.join(folder, "tube"))
    vmesh.volume("tube", case.mesh_folder, "--around", 32, "--output-unit", "m")
    figures = case.check_mesh()
    mesh, area, flow, pressure = case.flow()
    along = mesh.cell_centres()[:, 2]
    length = 1e-3 * vessels.LENGTH_MM
    inside = (along > 0.25 * length) & (along < 0.75 * length)
    slope = -numpy.polyfit(along[inside], pressure[inside], 1)[0]
    table.add("OpenFOAM", "straight tube, pressure lost per length", mesh.cells, slope,
              vessels.poiseuille_gradient(flow, NU, area), 0.02, "Poiseuille", "m/s^2",
              "non-orthogonality {:.0f} degrees, skewness {:.2g}".format(*figures))


def bend_loss(vmesh, folder, around):
    """Pressure at the inlet by that at the outlet, divided by the square of the mean velocity; and the mesh's figures."""
    case = Case(os.path.join(folder, f"bend{around}"))
    vmesh.volume("bend", case.mesh_folder, "--around", around, "--output-unit", "m")
    figures = case.check_mesh()
    mesh, area, flow, pressure = case.flow()
    vectors, _ = mesh.areas_and_centres("inlet")
    at_inlet = numpy.average(pressure[mesh.owner[mesh.patches["inlet"]]], weights=numpy.linalg.norm(vectors, axis=1))
    return mesh.cells, at_inlet / (flow / area) ** 2, figures


def check_bend(vmesh, folder, table):
    fine_cells, fine, _ = bend_loss(vmesh, folder, 36)
    cells, loss, figures = bend_loss(vmesh, folder, 18)
    table.add("OpenFOAM", "bend, pressure lost by velocity squared", cells, loss, fine, 0.02,
              f"{fine_cells} cells", "1", "non-orthogonality {:.0f} degrees, skewness {:.2g}".format(*figures))
