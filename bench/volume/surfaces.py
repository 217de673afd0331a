"""Surfaces as `vmesh generate` writes them, and grids of cells, as arrays. VTK alone, for every environment has that."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy

TETRAHEDRON, WEDGE, PYRAMID = vtk.VTK_TETRA, vtk.VTK_WEDGE, vtk.VTK_PYRAMID
CORNERS = {TETRAHEDRON: 4, WEDGE: 6, PYRAMID: 5}
WALL = 1  # its ModelFaceID; caps follow


@dataclass(frozen=True)
class Surface:
    """A closed surface of triangles that look outwards, in mm."""

    points: np.ndarray  # n x 3
    faces: np.ndarray  # m x 3
    patch: np.ndarray  # of each face
    radius: np.ndarray  # of the vessel at each point

    @property
    def edges(self) -> np.ndarray:
        """Each once, n x 2."""
        pairs = np.concatenate([self.faces[:, [0, 1]], self.faces[:, [1, 2]], self.faces[:, [2, 0]]])
        return pairs[pairs[:, 0] < pairs[:, 1]]

    def lengths_at_points(self) -> np.ndarray:
        """The mean length of the edges around each point: what vmesh gives TetGen as the size of cells."""
        edges = self.edges
        length = np.linalg.norm(self.points[edges[:, 0]] - self.points[edges[:, 1]], axis=1)
        total, count = np.zeros(len(self.points)), np.zeros(len(self.points))
        for side in (0, 1):
            np.add.at(total, edges[:, side], length)
            np.add.at(count, edges[:, side], 1)
        return total / count


def read_polydata(path: Path) -> vtk.vtkPolyData:
    reader = vtk.vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def read_surface(path: Path) -> Surface:
    data = read_polydata(path)
    return Surface(vtk_to_numpy(data.GetPoints().GetData()).astype(float),
                   vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(-1, 3).astype(np.int64),
                   vtk_to_numpy(data.GetCellData().GetArray("ModelFaceID")).astype(np.int64),
                   vtk_to_numpy(data.GetPointData().GetArray("MaximumInscribedSphereRadius")).astype(float))


def polydata_of(points: np.ndarray, faces: np.ndarray) -> vtk.vtkPolyData:
    data = vtk.vtkPolyData()
    data.SetPoints(vtk_points(points))
    cells = vtk.vtkCellArray()
    cells.SetData(numpy_to_vtkIdTypeArray(np.arange(0, 3 * len(faces) + 1, 3, dtype=np.int64), deep=True),
                  numpy_to_vtkIdTypeArray(np.ascontiguousarray(faces, np.int64).ravel(), deep=True))
    data.SetPolys(cells)
    return data


def vtk_points(points: np.ndarray) -> vtk.vtkPoints:
    result = vtk.vtkPoints()
    result.SetDataTypeToDouble()
    result.SetData(numpy_to_vtk(np.ascontiguousarray(points, float), deep=True))
    return result


def grid_of(points: np.ndarray, cells: np.ndarray, kind: int) -> vtk.vtkUnstructuredGrid:
    """Cells of one kind: n x 4 for tetrahedra."""
    grid = vtk.vtkUnstructuredGrid()
    grid.SetPoints(vtk_points(points))
    corners = cells.shape[1]
    array = vtk.vtkCellArray()
    array.SetData(numpy_to_vtkIdTypeArray(np.arange(0, corners * len(cells) + 1, corners, dtype=np.int64), deep=True),
                  numpy_to_vtkIdTypeArray(np.ascontiguousarray(cells, np.int64).ravel(), deep=True))
    grid.SetCells(kind, array)
    return grid


def read_grid(path: Path) -> tuple[np.ndarray, dict[int, np.ndarray]]:
    """Points, and the corners of cells by kind. Triangles that some programs add are left out."""
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    grid = reader.GetOutput()
    if not grid.GetNumberOfCells():
        return np.empty((0, 3)), {}
    points = vtk_to_numpy(grid.GetPoints().GetData()).astype(float)
    kinds = vtk_to_numpy(grid.GetCellTypesArray() if hasattr(grid, "GetCellTypesArray") else grid.GetCellTypes())
    starts = vtk_to_numpy(grid.GetCells().GetOffsetsArray())[:-1]
    connectivity = vtk_to_numpy(grid.GetCells().GetConnectivityArray())
    cells = {}
    for kind, corners in CORNERS.items():
        of_kind = starts[kinds == kind]
        if len(of_kind):
            cells[kind] = connectivity[of_kind[:, None] + np.arange(corners)].astype(np.int64)
    return points, cells


def write_grid(path: Path, grid: vtk.vtkUnstructuredGrid) -> None:
    writer = vtk.vtkXMLUnstructuredGridWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(grid)
    writer.Write()
