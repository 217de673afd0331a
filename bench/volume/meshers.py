"""Other programs that make volume meshes: meshers.py MESHER SURFACE.vtp OUTPUT.vtu runs one of them on a surface.

Each is asked for cells as large as the surface's triangles, as vmesh makes them, on one thread. Timed is its own work;
reading, writing and imports are not. A file beside the output has the CPU and wall seconds. Packages are imported only
where they are needed, for each environment may lack the others.
"""

from __future__ import annotations

import json
import os
import re
import resource
import subprocess
import sys
import time
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

from measures import boundary
from surfaces import TETRAHEDRON, WALL, Surface, grid_of, polydata_of, read_grid, read_surface, write_grid

# The default of `vmesh volume`: four layers of together .2 radii, each 1.2 times as thick as that nearer to the wall.
LAYERS, THICKNESS, GROWTH = 4, .2, 1.2
# As libvmesh gives it (core_tetgen.cpp), so that what differs are our steps before and after it.
TETGEN_SWITCHES = "pYmq1.3/14o140O9/7"


class Stopwatch:
    """CPU and wall seconds of this process in all that is done within `with`."""

    cpu = wall = 0.

    def __enter__(self) -> None:
        self.start = time.process_time(), time.monotonic()

    def __exit__(self, *_) -> None:
        self.cpu += time.process_time() - self.start[0]
        self.wall += time.monotonic() - self.start[1]

    def add(self, seconds: float) -> None:
        """The CPU seconds of a process that knows no other clock."""
        self.cpu += seconds
        self.wall += seconds


def gmsh_mesh(surface: Surface, watch: Stopwatch, algorithm: int) -> vtk.vtkUnstructuredGrid:
    """A discrete surface for each patch. Sizes extend from the boundary, by default."""
    import gmsh

    gmsh.initialize(["-nopopup", "-v", "1"])
    gmsh.option.setNumber("General.NumThreads", 1)
    gmsh.option.setNumber("Mesh.Algorithm3D", algorithm)
    with watch:
        patches = np.unique(surface.patch).tolist()
        for patch in patches:
            gmsh.model.addDiscreteEntity(2, patch)
        gmsh.model.mesh.addNodes(2, patches[0], np.arange(1, len(surface.points) + 1), surface.points.ravel())
        for patch in patches:
            faces = surface.faces[surface.patch == patch] + 1
            gmsh.model.mesh.addElementsByType(patch, 2, [], faces.ravel())
        loop = gmsh.model.geo.addSurfaceLoop(patches)
        gmsh.model.geo.addVolume([loop])
        gmsh.model.geo.synchronize()
        gmsh.model.mesh.generate(3)
    numbers, positions, _ = gmsh.model.mesh.getNodes()
    _, corners = gmsh.model.mesh.getElementsByType(4)
    gmsh.finalize()
    order = np.argsort(numbers)
    cells = np.searchsorted(numbers[order], corners).reshape(-1, 4)
    return grid_of(positions.reshape(-1, 3)[order], cells, TETRAHEDRON)


def gmsh_delaunay(surface: Surface, watch: Stopwatch, _: Path) -> vtk.vtkUnstructuredGrid:
    return gmsh_mesh(surface, watch, 1)


def gmsh_hxt(surface: Surface, watch: Stopwatch, _: Path) -> vtk.vtkUnstructuredGrid:
    return gmsh_mesh(surface, watch, 10)


def core_of(layered: Path) -> Surface:
    """What bounds the tetrahedra of a mesh with layers, as one patch."""
    points, cells = read_grid(layered)
    faces = boundary({TETRAHEDRON: cells[TETRAHEDRON]})[0]
    used, numbers = np.unique(faces, return_inverse=True)
    return Surface(points[used], numbers.reshape(-1, 3), np.full(len(faces), WALL), np.full(len(used), np.nan))


def gmsh_core(_: Surface, watch: Stopwatch, output: Path) -> vtk.vtkUnstructuredGrid:
    """Of our core alone: what is possible inside our layers."""
    return gmsh_mesh(core_of(output.with_name("vmesh-layers.vtu")), watch, 1)


def run_tetgen(points: np.ndarray, faces: np.ndarray, sizes: np.ndarray, switches: str,
               stem: Path) -> tuple[np.ndarray, np.ndarray, float]:
    """Debian's command on files. Returns points, tetrahedra, and CPU seconds without writing, by its own clock."""
    nodes = "\n".join(f"{i} {x!r} {y!r} {z!r}" for i, (x, y, z) in enumerate(points.tolist()))
    facets = "\n".join(f"1\n3 {a} {b} {c}" for a, b, c in faces.tolist())
    stem.with_suffix(".poly").write_text(f"{len(points)} 3 0 0\n{nodes}\n{len(faces)} 0\n{facets}\n0\n0\n")
    stem.with_suffix(".mtr").write_text(f"{len(points)} 1\n" + "\n".join(map(repr, sizes.tolist())) + "\n")
    done = subprocess.run(["tetgen", f"-{switches}", str(stem.with_suffix(".poly"))], capture_output=True, text=True)
    total = re.search(r"Total running seconds:\s*(\S+)", done.stdout)
    if done.returncode or not total:
        sys.exit("TetGen gave up: " + " ".join((done.stdout + done.stderr).split())[-300:])
    writing = re.search(r"Output seconds:\s*(\S+)", done.stdout)
    nodes_made = np.loadtxt(f"{stem}.1.node", skiprows=1)
    cells = np.loadtxt(f"{stem}.1.ele", skiprows=1, dtype=np.int64)
    return nodes_made[:, 1:4], cells[:, 1:5], float(total.group(1)) - (float(writing.group(1)) if writing else 0)


def tetgen(surface: Surface, watch: Stopwatch, output: Path) -> vtk.vtkUnstructuredGrid:
    points, cells, seconds = run_tetgen(surface.points, surface.faces, surface.lengths_at_points(), TETGEN_SWITCHES,
                                        output.with_suffix(""))
    watch.add(seconds)
    return grid_of(points, cells, TETRAHEDRON)


def ftetwild(surface: Surface, watch: Stopwatch, output: Path) -> vtk.vtkUnstructuredGrid:
    """Sizes by way of tetrahedra that vmesh made. Its envelope is a tenth of the least radius, or less.

    That of its default, a thousandth of the diagonal, is wider than some vessels.
    """
    import pytetwild

    points, cells = read_grid(output.with_name("vmesh-tetrahedra.vtu"))
    diagonal = float(np.linalg.norm(np.ptp(surface.points, axis=0)))
    size = np.full(len(points), np.nan)
    size[:len(surface.points)] = surface.lengths_at_points()  # vmesh keeps the vertices of the wall first
    inner = np.isnan(size)
    locator = vtk.vtkStaticPointLocator()
    locator.SetDataSet(polydata_of(surface.points, surface.faces))
    locator.BuildLocator()
    size[inner] = [size[locator.FindClosestPoint(p)] for p in points[inner].tolist()]
    with watch:
        vertices, tetrahedra = pytetwild.tetrahedralize(
            surface.points, surface.faces.astype(np.int32), edge_length_abs=float(np.median(size)),
            epsilon=min(1e-3, .1 * float(surface.radius.min()) / diagonal), num_threads=1,
            bg_vertices=points, bg_tets=cells[TETRAHEDRON].astype(np.int32), bg_values=size)
    return grid_of(np.asarray(vertices, float), np.asarray(tetrahedra), TETRAHEDRON)


def with_numbers(data: vtk.vtkDataSet, name: str, values: np.ndarray) -> None:
    array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
    array.SetName(name)
    if len(values) == data.GetNumberOfCells():
        data.GetCellData().AddArray(array)
    else:
        data.GetPointData().AddArray(array)


def vmtk_generator(watch: Stopwatch, output: Path):
    """vmtkmeshgenerator on a wall as it is, mended.

    Its wheels lack TetGen, so Debian's takes that place, and call what VTK 9.6 no longer has.
    """
    from vmtk import vmtkscripts

    class Threshold(vtk.vtkThreshold):
        def ThresholdByUpper(self, value: float) -> None:
            self.SetUpperThreshold(value)
            self.SetThresholdFunction(self.THRESHOLD_UPPER)

    def execute(script) -> None:
        """With the switches of VMTK's wrapper for what vmtkmeshgenerator sets."""
        data = script.Mesh
        faces = vtk_to_numpy(data.GetCells().GetConnectivityArray()).reshape(-1, 3)
        points = vtk_to_numpy(data.GetPoints().GetData()).astype(float)
        sizes = vtk_to_numpy(data.GetPointData().GetArray(script.SizingFunctionArrayName)).astype(float)
        watch.__exit__()
        points, cells, seconds = run_tetgen(
            points, faces, sizes, f"pYmq{script.MinRatio:g}/{script.MinDihedral:g}o/{script.MaxDihedral:g}",
            output.with_suffix(""))
        script.Mesh = grid_of(points, cells, TETRAHEDRON)
        with_numbers(script.Mesh, script.CellEntityIdsArrayName, np.zeros(len(cells), np.int32))
        watch.add(seconds)
        watch.__enter__()

    vtk.vtkThreshold = Threshold
    vmtkscripts.vmtkTetGen.Execute = execute
    generator = vmtkscripts.vmtkMeshGenerator()
    generator.SkipCapping = generator.SkipRemeshing = 1
    generator.ElementSizeMode, generator.TargetEdgeLengthArrayName = "edgelengtharray", "radius"
    generator.VolumeElementScaleFactor = 1.  # of the triangles' size
    return generator


def vmtk(surface: Surface, watch: Stopwatch, output: Path) -> vtk.vtkUnstructuredGrid:
    """vmtkmeshgenerator on the closed surface."""
    data = polydata_of(surface.points, surface.faces)
    with_numbers(data, "CellEntityIds", surface.patch.astype(np.int32))
    with_numbers(data, "radius", surface.radius)
    generator = vmtk_generator(watch, output)
    generator.Surface = data
    with watch:
        generator.Execute()
    return generator.Mesh


def vmtk_layers(surface: Surface, watch: Stopwatch, output: Path) -> vtk.vtkUnstructuredGrid:
    """vmtkmeshgenerator on the wall, which is open: layers end on the caps, which it makes anew."""
    faces = surface.faces[surface.patch == WALL]
    used, numbers = np.unique(faces, return_inverse=True)
    data = polydata_of(surface.points[used], numbers.reshape(-1, 3))
    with_numbers(data, "radius", surface.radius[used])
    edges = surface.edges
    length = np.linalg.norm(surface.points[edges[:, 0]] - surface.points[edges[:, 1]], axis=1)
    generator = vmtk_generator(watch, output)
    generator.Surface = data
    generator.TargetEdgeLengthFactor = float(np.median(length / surface.radius[edges].mean(axis=1)))
    generator.BoundaryLayer, generator.BoundaryLayerOnCaps = 1, 0
    generator.NumberOfSubLayers, generator.SubLayerRatio = LAYERS, 1 / GROWTH
    generator.BoundaryLayerThicknessFactor = THICKNESS / generator.TargetEdgeLengthFactor
    with watch:
        generator.Execute()
    return generator.Mesh


# Each with the packages whose versions are of interest. Those of VMTK need another environment.
MESHERS = {
    "gmsh-delaunay": (gmsh_delaunay, ["gmsh"]),
    "gmsh-hxt": (gmsh_hxt, ["gmsh"]),
    "gmsh-core": (gmsh_core, ["gmsh"]),
    "tetgen": (tetgen, []),
    "vmtk": (vmtk, ["vmtk"]),
    "vmtk-layers": (vmtk_layers, ["vmtk"]),
    "ftetwild": (ftetwild, ["pytetwild"]),
}


def version_of(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return "unknown"


def main() -> None:
    mesher, packages = MESHERS[sys.argv[1]]
    surface, output = Path(sys.argv[2]).resolve(), Path(sys.argv[3]).resolve()
    os.chdir(output.parent)  # where some leave files
    watch = Stopwatch()
    grid = mesher(read_surface(surface), watch, output)
    write_grid(output, grid)
    used = resource.getrusage(resource.RUSAGE_SELF)
    measured = {"cpu_seconds": watch.cpu, "wall_seconds": watch.wall, "peak_mb": used.ru_maxrss / 1024,
                "versions": {package: version_of(package) for package in packages}}
    output.with_suffix(".measured.json").write_text(json.dumps(measured))


if __name__ == "__main__":
    main()
