"""Volume meshes that vmesh writes, opened by other programs."""
import os

import numpy

from report import expect, expect_near, run

# Corners of each kind of cell by their numbers in VTK, and the name that meshio has for it.
KINDS = {10: ("tetra", 4), 13: ("wedge", 6), 14: ("pyramid", 5)}
PATCHES = ["wall", "inlet", "outlet"]


class Volumes:
    """A bent tube with layers of wedges and named ends, and the same of tetrahedra alone, in every format."""

    def __init__(self, vmesh):
        self.vmesh, path = vmesh, vmesh.path
        with open(path("bent.swc"), "w") as file:
            file.write("# SPACE=LPS UNIT=mm\n")
            for i in range(9):
                angle = i * numpy.pi / 16
                file.write(f"{i + 1} 0 {9 - 9 * numpy.cos(angle):.9g} 1 {9 * numpy.sin(angle):.9g} 2 {i or -1}\n")
        self.write("bent.vtu")
        for name in ("bent.msh", "bent.msh4", "bent.inp"):
            self.write(name)
        for name in ("tets.vtu", "tets.ele", "tets-mesh-complete"):
            self.write(name, "--tetrahedra")
        vmesh("generate", path("bent.swc"), "-o", path("bent.smesh"), "--ends", "flat", *self.names)
        vmesh("generate", path("bent.swc"), "-o", path("bent.vtp"), "--ends", "flat", *self.names)

    names = ("--name", "0=inlet", "--name", "8=outlet", "--simplification", "0")

    def write(self, name, *options):
        self.vmesh("volume", self.vmesh.path("bent.swc"), "-o", self.vmesh.path(name), "--layers", 2, *self.names, *options)


def grid(vtk, path):
    """An unstructured grid of a file."""
    reader = vtk.vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()


def texts(data, name):
    array = data.GetFieldData().GetAbstractArray(name)
    return [array.GetValue(i) for i in range(array.GetNumberOfValues())]


def signed_volume(points, faces):
    """Enclosed by polygons, positive if they look outwards (divergence theorem over fans)."""
    total = 0.0
    for face in faces:
        a = points[face[0]]
        for b, c in zip(face[1:-1], face[2:]):
            total += numpy.dot(a, numpy.cross(points[b], points[c])) / 6
    return total


def check_vtk(table, vtk, volumes):
    path = volumes.vmesh.path

    def volume(name, tolerance):
        data = grid(vtk, path(name))
        points = vtk.arrays.vtk_to_numpy(data.GetPoints().GetData())
        types = vtk.arrays.vtk_to_numpy(data.GetCellTypesArray())
        region = vtk.arrays.vtk_to_numpy(data.GetCellData().GetArray("ModelRegionID"))
        patch = vtk.arrays.vtk_to_numpy(data.GetCellData().GetArray("ModelFaceID"))
        expect(texts(data, "PatchNames") == PATCHES, f"patches are {texts(data, 'PatchNames')}")
        expect(texts(data, "RegionNames") == ["lumen"] and set(region) == {1}, "other regions")
        is_solid = numpy.isin(types, list(KINDS))
        expect(set(patch[is_solid]) == {0} and set(patch[~is_solid]) == {1, 2, 3}, "other numbers of patches")
        measured = vtk.vtk.vtkCellSizeFilter()
        measured.SetInputData(data)
        measured.Update()
        by_vtk = vtk.arrays.vtk_to_numpy(measured.GetOutput().GetCellData().GetArray("Volume"))[is_solid]
        expect(by_vtk.min() > 0, f"{(by_vtk <= 0).sum()} cells have no positive volume in VTK")
        # By VTK's own faces of each cell, whose normals tell whether it takes the cell for one turned inside out.
        for number in numpy.flatnonzero(is_solid):
            cell = data.GetCell(int(number))
            faces = [[cell.GetFace(f).GetPointId(i) for i in range(cell.GetFace(f).GetNumberOfPoints())]
                     for f in range(cell.GetNumberOfFaces())]
            expect(signed_volume(points, faces) > 0, f"the faces of cell {number} look inwards")
        outside = [[data.GetCell(int(number)).GetPointId(i) for i in range(data.GetCell(int(number)).GetNumberOfPoints())]
                   for number in numpy.flatnonzero(~is_solid)]
        whole = signed_volume(points, outside)
        expect_near(by_vtk.sum(), whole, tolerance * whole, "volume")
        return len(points), f"{int(is_solid.sum()):,} cells", "ModelRegionID, ModelFaceID, PatchNames", "mm, LPS (field data)"

    def mesh_complete():
        folder = path("tets-mesh-complete")
        data = grid(vtk, os.path.join(folder, "mesh-complete.mesh.vtu"))
        points = vtk.arrays.vtk_to_numpy(data.GetPoints().GetData())
        expect(set(vtk.arrays.vtk_to_numpy(data.GetCellTypesArray())) == {10}, "cells that are no tetrahedra")
        cells = vtk.cells(data.GetCells(), 4)
        elements = data.GetCellData().GetArray("GlobalElementID")
        # SimVascular's solver takes these arrays only as 32-bit integers.
        expect(isinstance(elements, vtk.vtk.vtkIntArray), "GlobalElementID has another type")
        found = 0
        for k, name in enumerate(PATCHES):
            there = vtk.surface("vtkXMLPolyDataReader", os.path.join(folder, "mesh-surfaces", name + ".vtp"))
            nodes = there.of_points["GlobalNodeID"].astype(int) - 1
            expect_near(points[nodes], there.points, 0, f"points of {name}")
            behind = cells[there.of_faces["GlobalElementID"].astype(int) - 1]
            inside = (nodes[there.faces][:, :, None] == behind[:, None, :]).any(axis=2).all()
            expect(inside, f"faces of {name} are not those of the elements they name")
            expect(set(there.of_faces["ModelFaceID"]) == {k + 1}, f"{name} has another ModelFaceID")
            found += len(there.faces)
        whole = vtk.surface("vtkXMLPolyDataReader", os.path.join(folder, "mesh-complete.exterior.vtp"))
        expect(len(whole.faces) == found, "the patches do not make up the outside")
        return len(points), f"{len(cells):,} cells", "GlobalNodeID, GlobalElementID, ModelFaceID", "mm, LPS (field data)"

    table.check(".vtu", "out, volume", vtk.name, lambda: volume("tets.vtu", 1e-12))  # rounding
    # Quads within need not be plane, and VTK does not cut those of two neighbours alike.
    table.check(".vtu", "out, volume, wedges", vtk.name, lambda: volume("bent.vtu", 1e-2))
    table.check("mesh-complete", "out, volume", vtk.name, mesh_complete)


def check_gmsh(table, gmsh, volumes):
    def volume(name):
        """Checked and saved again in the other version, in which nothing may be lost."""
        path, out = volumes.vmesh.path(name), os.path.join(gmsh.folder, "again.msh")
        said = run([gmsh.command, path, "-check", "-0"])
        expect("Error" not in said and "Warning" not in said, said)
        run([gmsh.command, path, "-0", "-format", "msh22", "-o", out])
        tables = []
        for file_name in (out, volumes.vmesh.path("bent.msh")):
            with open(file_name) as file:
                lines = file.read().splitlines()
            nodes = numpy.array(gmsh.section(lines, "$Nodes"), float)
            place = {int(row[0]): tuple(numpy.round(row[1:], 9) + 0.0) for row in nodes}  # of 16 digits
            cells = sorted((row[1], row[3], sorted(place[int(v)] for v in row[3 + int(row[2]) :]))
                           for row in gmsh.section(lines, "$Elements"))
            tables.append((len(nodes), sorted(map(tuple, gmsh.section(lines, "$PhysicalNames"))), cells))
        expect(tables[0][1] == tables[1][1], f"names are {tables[0][1]}")
        expect(tables[0] == tables[1], "nodes or elements were lost or changed")
        return tables[0][0], f"{len(tables[0][2]):,} elements", "physical groups", ""

    table.check(".msh", "out, volume", gmsh.name, lambda: volume("bent.msh"))
    table.check(".msh4", "out, volume", gmsh.name, lambda: volume("bent.msh4"))


def check_tetgen(table, tetgen, volumes):
    path = volumes.vmesh.path

    def counted(name):
        return int(open(name).readline().split()[0])

    def volume():
        """Read as a mesh to be refined, with nothing to refine."""
        run([tetgen.command, "-rQ", path("tets.ele")])
        for ending in (".ele", ".node"):
            before, after = counted(path("tets" + ending)) if ending == ".ele" else None, counted(path("tets.1" + ending))
            expect(before in (None, after), f"{before} tetrahedra became {after}")
        return counted(path("tets.1.node")), f"{counted(path('tets.1.ele')):,} cells", "markers", ""

    def surface():
        """Filled; the faces keep their markers, and these the areas of the caps."""
        run([tetgen.command, "-pYQ", path("bent.smesh")])
        points = numpy.loadtxt(path("bent.1.node"), skiprows=1)[:, 1:4]
        faces = numpy.loadtxt(path("bent.1.face"), skiprows=1).astype(int)
        expect(set(faces[:, 4]) == {1, 2, 3}, f"markers are {set(faces[:, 4])}")
        a, b, c = (points[faces[:, k]] for k in (1, 2, 3))
        areas = numpy.linalg.norm(numpy.cross(b - a, c - a), axis=1) / 2
        for marker in (2, 3):
            expect_near(areas[faces[:, 4] == marker].sum(), 4 * numpy.pi, 1e-3, f"area of patch {marker}")
        return len(points), f"{len(faces):,} faces", "markers", ""

    table.check(".ele", "out, volume", tetgen.name, volume)
    table.check(".smesh", "out", tetgen.name, surface)


def check_meshio(table, meshio, volumes):
    path = volumes.vmesh.path

    # meshio 5 reads no VTU file with texts in it, as ours have: "Illegal data type 'String'".
    def read(name):
        mesh = meshio.meshio.read(path(name))
        cells = {kind: [b.data for b in mesh.cells if b.type == kind] for kind, _ in KINDS.values()}
        return mesh, {kind: numpy.concatenate(blocks) for kind, blocks in cells.items() if blocks}

    def named_groups():
        mesh, cells = read("bent.msh")
        expect({name: tuple(group) for name, group in mesh.field_data.items()}
               == {"wall": (1, 2), "inlet": (2, 2), "outlet": (3, 2), "lumen": (4, 3)}, f"groups: {mesh.field_data}")
        return len(mesh.points), f"{sum(map(len, cells.values())):,} cells", "physical groups", ""

    def sets():
        mesh, cells = read("bent.inp")
        reference, expected = read("bent.msh")
        # 13 digits, where Gmsh's file has as many as doubles need.
        expect_near(mesh.points, reference.points, 1e-12 * numpy.abs(reference.points).max(), "points")
        for kind, corners in expected.items():
            expect(numpy.array_equal(cells.get(kind), corners), f"other cells: {kind}")
        expect(set(PATCHES) <= set(mesh.point_sets), f"sets: {list(mesh.point_sets)}")
        return len(mesh.points), f"{sum(map(len, cells.values())):,} cells", "NSET", ""

    table.check(".msh", "out, volume", meshio.name, named_groups)
    table.check(".inp", "out, volume", meshio.name, sets)
