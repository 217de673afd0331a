"""Surfaces to and from VTK, which is imported only when needed (Debian: python3-vtk9)."""

from __future__ import annotations

from typing import Any, Dict, Sequence, Tuple

import numpy as np
from numpy.typing import NDArray

from ._core import Surface, VolumeMesh


def to_vtk(surface: Surface) -> Any:
    """The surface as a vtkPolyData, its attributes as arrays.

    Points and arrays are copied. Raises ImportError without VTK.
    """
    vtk, convert = _import_vtk()
    poly = vtk.vtkPolyData()
    poly.SetPoints(_points(surface.vertices))
    poly.SetPolys(_cells([surface.faces]))
    _add(convert, poly.GetPointData(), surface.vertex_attributes)
    _add(convert, poly.GetCellData(), surface.face_attributes)
    return poly


def to_pyvista(surface: Surface) -> Any:
    """The surface as a pyvista.PolyData, its attributes as arrays; points and arrays are copied.

    Raises ImportError without PyVista.
    """
    return _import_pyvista().wrap(to_vtk(surface))


def volume_to_vtk(volume: VolumeMesh) -> Any:
    """The mesh as a vtkUnstructuredGrid, ModelRegionID (from 1) of its cells as an array; points are copied.

    Raises ImportError without VTK.
    """
    vtk, convert = _import_vtk()
    grid = vtk.vtkUnstructuredGrid()
    grid.SetPoints(_points(volume.points))
    # The first triangle of VTK's wedges looks outwards; since 9.7, to the other one, as ours.
    order = [0, 1, 2, 3, 4, 5] if vtk.version >= (9, 7) else [0, 2, 1, 3, 5, 4]
    parts: Sequence[Tuple[int, NDArray[Any]]] = (
        (vtk.VTK_TETRA, volume.tetrahedra),
        (vtk.VTK_WEDGE, volume.wedges[:, order]),
        (vtk.VTK_PYRAMID, volume.pyramids),
    )
    kinds = np.concatenate([np.full(len(part), kind, dtype=np.uint8) for kind, part in parts])
    grid.SetCells(convert.numpy_to_vtk(kinds, deep=True), _cells([cells for _, cells in parts]))
    _add(convert, grid.GetCellData(), {"ModelRegionID": volume.cell_region.astype(np.int64) + 1})
    return grid


def volume_to_pyvista(volume: VolumeMesh) -> Any:
    """The mesh as a pyvista.UnstructuredGrid with ModelRegionID; points are copied.

    Raises ImportError without PyVista.
    """
    return _import_pyvista().wrap(volume_to_vtk(volume))


def from_vtk(poly: Any) -> Surface:
    """A Surface from the triangles of `poly`, a vtkPolyData or PyVista's PolyData, mm; polygons are triangulated."""
    vtk, convert = _import_vtk()
    triangles = vtk.vtkTriangleFilter()
    triangles.SetInputData(poly)
    triangles.PassVertsOff()
    triangles.PassLinesOff()
    triangles.Update()
    mesh = triangles.GetOutput()
    if mesh.GetNumberOfPolys() == 0:
        return Surface(np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64))
    vertices = convert.vtk_to_numpy(mesh.GetPoints().GetData())
    faces = convert.vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    return Surface(vertices, faces)


def _points(positions: NDArray[Any]) -> Any:
    """vtkPoints, copied."""
    vtk, convert = _import_vtk()
    points = vtk.vtkPoints()
    points.SetData(convert.numpy_to_vtk(np.ascontiguousarray(positions), deep=True))
    return points


def _cells(parts: Sequence[NDArray[Any]]) -> Any:
    """A vtkCellArray of cells, each part with rows of as many corners as its cells have."""
    vtk, convert = _import_vtk()
    sizes = np.concatenate([np.full(len(part), part.shape[1], dtype=np.int64) for part in parts])
    offsets = np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)
    corners = np.concatenate([part.astype(np.int64).ravel() for part in parts])
    cells = vtk.vtkCellArray()
    cells.SetData(
        convert.numpy_to_vtkIdTypeArray(offsets, deep=True), convert.numpy_to_vtkIdTypeArray(corners, deep=True)
    )
    return cells


def _add(convert: Any, data: Any, attributes: Dict[str, NDArray[Any]]) -> None:
    for name, values in attributes.items():
        array = convert.numpy_to_vtk(np.ascontiguousarray(values), deep=True)
        array.SetName(name)
        data.AddArray(array)


def _import_pyvista() -> Any:
    try:
        import pyvista
    except ImportError as error:
        raise ImportError("PyVista is needed: pip install pyvista") from error
    return pyvista


def _import_vtk() -> Any:
    try:
        from vtkmodules import vtkCommonCore, vtkCommonDataModel, vtkFiltersCore
        from vtkmodules.util import numpy_support
    except ImportError as error:
        raise ImportError("VTK for Python is needed: pip install vtk; on Debian: apt install python3-vtk9") from error

    _version = vtkCommonCore.vtkVersion

    class Names:
        vtkPolyData = vtkCommonDataModel.vtkPolyData
        vtkUnstructuredGrid = vtkCommonDataModel.vtkUnstructuredGrid
        version = (_version.GetVTKMajorVersion(), _version.GetVTKMinorVersion())
        VTK_TETRA = vtkCommonDataModel.VTK_TETRA
        VTK_WEDGE = vtkCommonDataModel.VTK_WEDGE
        VTK_PYRAMID = vtkCommonDataModel.VTK_PYRAMID
        vtkCellArray = vtkCommonDataModel.vtkCellArray
        vtkPoints = vtkCommonCore.vtkPoints
        vtkTriangleFilter = vtkFiltersCore.vtkTriangleFilter

    return Names, numpy_support
