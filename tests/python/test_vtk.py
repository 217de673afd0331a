import subprocess
import sys

import numpy as np
import pytest
import vmesh

from shapes import FORK, box


def test_vtk_is_imported_when_asked_for():
    program = "import sys, vmesh; sys.exit(any(name.startswith('vtk') for name in sys.modules))"
    assert subprocess.run([sys.executable, "-c", program]).returncode == 0


def test_padded_faces_are_vtks_cells():
    vertices, faces = box()
    padded = vmesh.Surface(vertices, faces).padded_faces()
    assert padded.dtype == np.int64 and padded.flags.c_contiguous
    np.testing.assert_array_equal(padded, np.column_stack([np.full(12, 3), faces]))


def test_goes_to_vtk_and_back():
    pytest.importorskip("vtkmodules", reason="python3-vtk9 is missing")
    from vtkmodules.util.numpy_support import vtk_to_numpy

    surface = vmesh.generate(*FORK)
    poly = surface.to_vtk()
    assert (poly.GetNumberOfPoints(), poly.GetNumberOfPolys()) == (len(surface.vertices), len(surface.faces))
    np.testing.assert_array_equal(vtk_to_numpy(poly.GetPointData().GetArray("radius")), surface.radius)
    np.testing.assert_array_equal(vtk_to_numpy(poly.GetCellData().GetArray("branch")), surface.face_branch)
    again = vmesh.from_vtk(poly)
    np.testing.assert_array_equal(again.vertices, surface.vertices)
    np.testing.assert_array_equal(again.faces, surface.faces)


def test_vtk_can_work_with_it():
    pytest.importorskip("vtkmodules", reason="python3-vtk9 is missing")
    from vtkmodules.vtkFiltersCore import vtkMassProperties

    surface = vmesh.generate(*FORK)
    mass = vtkMassProperties()
    mass.SetInputData(surface.to_vtk())
    assert mass.GetVolume() == pytest.approx(surface.volume, rel=1e-9)
    assert mass.GetSurfaceArea() == pytest.approx(surface.area, rel=1e-9)


def test_goes_to_pyvista_and_back():
    pyvista = pytest.importorskip("pyvista", reason="PyVista is missing")
    surface = vmesh.generate(*FORK)
    mesh = surface.to_pyvista()
    assert isinstance(mesh, pyvista.PolyData) and mesh.is_all_triangles
    np.testing.assert_array_equal(mesh.point_data["radius"], surface.radius)
    np.testing.assert_array_equal(mesh.cell_data["branch"], surface.face_branch)
    assert mesh.volume == pytest.approx(surface.volume, rel=1e-6)  # VTK sums in another order
    for other in (mesh, pyvista.PolyData(surface.vertices, surface.padded_faces())):
        again = vmesh.from_vtk(other)
        np.testing.assert_array_equal(again.vertices, surface.vertices)
        np.testing.assert_array_equal(again.faces, surface.faces)
