import subprocess
import sys

import numpy as np
import pytest
import vmesh

from shapes import FORK


def test_trimesh_is_imported_when_asked_for():
    program = "import sys, vmesh; sys.exit('trimesh' in sys.modules or 'pyvista' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", program]).returncode == 0


def test_goes_to_trimesh_and_back():
    trimesh = pytest.importorskip("trimesh", reason="trimesh is missing")
    surface = vmesh.generate(*FORK)
    mesh = surface.to_trimesh()
    assert isinstance(mesh, trimesh.Trimesh) and mesh.is_watertight and mesh.is_winding_consistent
    np.testing.assert_array_equal(mesh.vertices, surface.vertices)
    np.testing.assert_array_equal(mesh.faces, surface.faces)
    np.testing.assert_array_equal(mesh.vertex_attributes["radius"], surface.radius)
    np.testing.assert_array_equal(mesh.face_attributes["branch"], surface.face_branch)
    assert mesh.volume == pytest.approx(surface.volume, rel=1e-9)
    again = vmesh.from_trimesh(mesh)
    np.testing.assert_array_equal(again.vertices, surface.vertices)
    np.testing.assert_array_equal(again.faces, surface.faces)


def test_what_trimesh_changes_does_not_reach_the_surface():
    pytest.importorskip("trimesh", reason="trimesh is missing")
    surface = vmesh.generate(*FORK)
    before = surface.vertices.copy()
    surface.to_trimesh().apply_translation([0, 0, 5])
    np.testing.assert_array_equal(surface.vertices, before)


def test_a_missing_package_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "trimesh", None)
    monkeypatch.setitem(sys.modules, "pyvista", None)
    surface = vmesh.generate(*FORK)
    with pytest.raises(ImportError, match="pip install trimesh"):
        surface.to_trimesh()
    with pytest.raises(ImportError, match="pip install pyvista"):
        surface.to_pyvista()
