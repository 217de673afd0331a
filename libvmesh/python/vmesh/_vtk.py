"""Surfaces to and from VTK, which is imported only when needed (Debian: python3-vtk9)."""

from __future__ import annotations

from typing import Any, Dict

import numpy as np
from numpy.typing import NDArray

from ._core import Surface


def to_vtk(surface: Surface) -> Any:
    """The surface as a vtkPolyData, its attributes as arrays.

    Points and arrays are copied. Raises ImportError without VTK.
    """
    vtk, convert = _import_vtk()
    poly = vtk.vtkPolyData()
    points = vtk.vtkPoints()
    points.SetData(convert.numpy_to_vtk(np.ascontiguousarray(surface.vertices), deep=True))
    poly.SetPoints(points)
    cells = vtk.vtkCellArray()
    offsets = np.arange(0, 3 * len(surface.faces) + 1, 3, dtype=np.int64)
    cells.SetData(
        convert.numpy_to_vtkIdTypeArray(offsets, deep=True),
        convert.numpy_to_vtkIdTypeArray(surface.faces.astype(np.int64).ravel(), deep=True),
    )
    poly.SetPolys(cells)
    _add(convert, poly.GetPointData(), surface.vertex_attributes)
    _add(convert, poly.GetCellData(), surface.face_attributes)
    return poly


def to_pyvista(surface: Surface) -> Any:
    """The surface as a pyvista.PolyData, its attributes as arrays; points and arrays are copied.

    Raises ImportError without PyVista.
    """
    try:
        import pyvista
    except ImportError as error:
        raise ImportError("PyVista is needed: pip install pyvista") from error
    return pyvista.wrap(to_vtk(surface))


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


def _add(convert: Any, data: Any, attributes: Dict[str, NDArray[Any]]) -> None:
    for name, values in attributes.items():
        array = convert.numpy_to_vtk(np.ascontiguousarray(values), deep=True)
        array.SetName(name)
        data.AddArray(array)


def _import_vtk() -> Any:
    try:
        from vtkmodules import vtkCommonCore, vtkCommonDataModel, vtkFiltersCore
        from vtkmodules.util import numpy_support
    except ImportError as error:
        raise ImportError("VTK for Python is needed: pip install vtk; on Debian: apt install python3-vtk9") from error

    class Names:
        vtkPolyData = vtkCommonDataModel.vtkPolyData
        vtkCellArray = vtkCommonDataModel.vtkCellArray
        vtkPoints = vtkCommonCore.vtkPoints
        vtkTriangleFilter = vtkFiltersCore.vtkTriangleFilter

    return Names, numpy_support
