import os
import subprocess

import numpy as np
import pytest
import vmesh

from shapes import FORK


@pytest.fixture(scope="module")
def surface():
    return vmesh.generate(*FORK, ends="flat")


@pytest.fixture(scope="module")
def lumen(surface):
    try:
        return vmesh.volume(surface, layers=2)
    except vmesh.Unsupported as error:
        pytest.skip(str(error))


def test_a_lumen_has_layers_and_a_core(surface, lumen):
    assert len(lumen.wedges) == 2 * np.count_nonzero(surface.cap_label == 0)
    assert len(lumen.tetrahedra) > 100
    of_wall = np.unique(surface.faces[surface.cap_label == 0])
    np.testing.assert_array_equal(lumen.points[: len(of_wall)], surface.vertices[of_wall])
    assert lumen.region_names == ["lumen"]
    assert lumen.patch_names == ["wall", "cap_1", "cap_2", "cap_3"]
    assert len(lumen.cell_region) == len(lumen.tetrahedra) + len(lumen.wedges) + len(lumen.pyramids)
    assert lumen.layers.full_share == 1 and lumen.layers.thin == []
    assert lumen.defects == []


def test_its_volume_is_the_surfaces_and_its_caps_too(surface, lumen):
    # By other sums of the same numbers; 1e-9 is what the command checks.
    assert lumen.region_volume["lumen"] == pytest.approx(surface.volume, rel=1e-9)
    for end in surface.flat_ends:
        assert lumen.patch_area[f"cap_{end.label}"] == pytest.approx(end.area, rel=1e-9)


def test_tetrahedra_are_measured(lumen):
    p = lumen.points[lumen.tetrahedra]
    six_volumes = np.einsum("ij,ij->i", np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), p[:, 3] - p[:, 0])
    assert six_volumes.min() > 0
    measures = lumen.measures
    assert 5 < measures.min_dihedral < 70.6 < measures.max_dihedral < 175
    assert 0 < measures.least_radius_ratio < measures.mean_radius_ratio < 1


def test_the_outside_is_closed(lumen):
    edges = {}
    for face in lumen.boundary_faces:
        corners = [int(v) for v in face if v >= 0]
        for a, b in zip(corners, corners[1:] + corners[:1]):
            edges[a, b] = edges.get((a, b), 0) + 1
    assert set(edges.values()) == {1}
    assert all((b, a) in edges for a, b in edges)
    assert len(lumen.boundary_patch) == len(lumen.boundary_faces)


def test_a_file_is_that_of_the_command(surface, lumen, tmp_path):
    command = os.environ.get("VMESH_COMMAND")
    if not command:
        pytest.skip("built without the command")
    surface.save(tmp_path / "fork.vtp")
    options = ["-o", tmp_path / "a.vtu", "--layers", "2", "--quiet"]
    subprocess.run([command, "volume", tmp_path / "fork.vtp", *options], check=True)
    read = vmesh.read_volume(tmp_path / "a.vtu")
    for name in ("points", "tetrahedra", "wedges", "pyramids", "cell_region", "boundary_faces", "boundary_patch"):
        np.testing.assert_array_equal(getattr(read, name), getattr(lumen, name), err_msg=name)
    assert read.patch_names == lumen.patch_names


def test_is_saved_and_read(lumen, tmp_path):
    lumen.save(tmp_path / "fork.vtu")
    read = vmesh.read_volume(tmp_path / "fork.vtu")
    np.testing.assert_array_equal(read.points, lumen.points)
    np.testing.assert_array_equal(read.wedges, lumen.wedges)
    assert read.defects == [] and read.region_names == ["lumen"]
    with pytest.raises(vmesh.Unsupported):
        lumen.save(tmp_path / "fork.docx")
    with pytest.raises(vmesh.ReadError):
        vmesh.read_volume(tmp_path / "missing.vtu")
    lumen.save(tmp_path / "metres.vtu", unit="m")
    with pytest.raises(vmesh.InvalidInput, match="millimetres"):
        vmesh.read_volume(tmp_path / "metres.vtu")


def test_regions_are_divided_by_branches(surface, lumen):
    divided = lumen.with_branches(surface.centerline)
    assert divided.region_names == ["lumen_0", "lumen_1", "lumen_2"]
    assert sum(divided.region_volume.values()) == pytest.approx(surface.volume, rel=1e-9)
    assert lumen.region_names == ["lumen"], "the first has not changed"
    elsewhere = vmesh.Centerline([[500, 0, 0], [510, 0, 0]], [1, 1], [[0, 1]])
    with pytest.raises(vmesh.InvalidInput):
        lumen.with_branches(elsewhere)


def test_a_wall_alone_needs_no_tetrahedra(surface):
    wall = vmesh.volume(surface, wall_thickness="0.5mm", wall_only=True)
    assert len(wall.tetrahedra) == 0 and wall.region_names == ["wall"]
    assert len(wall.wedges) == 2 * np.count_nonzero(surface.cap_label == 0)
    assert wall.wall_layers.full_share > 0.9
    # Outwards, walls of tubes are larger than their inside; a tenth is for crotches, where they are thinner.
    inside = surface.area - sum(end.area for end in surface.flat_ends)
    assert wall.region_volume["wall"] > 0.9 * 0.5 * inside


@pytest.mark.parametrize(
    "options, message",
    [
        ({"layers": -1}, "layers"),
        ({"layer_thickness": "thick"}, "layer_thickness"),
        ({"layer_thickness": "xmm"}, "layer_thickness"),
        ({"wall_only": True}, "wall_thickness"),
        ({"wall_thickness": -1.0, "wall_only": True}, "thick"),
    ],
)
def test_wrong_options_are_refused(surface, options, message):
    with pytest.raises(vmesh.InvalidInput, match=message):
        vmesh.volume(surface, **options)


def test_a_surface_without_radii_is_refused(surface):
    with pytest.raises(vmesh.InvalidInput, match="radius"):
        vmesh.volume(vmesh.Surface(surface.vertices, surface.faces), wall_thickness=0.2, wall_only=True)


def test_an_open_surface_is_refused():
    with pytest.raises(vmesh.InvalidInput):
        vmesh.volume(vmesh.generate(*FORK, ends="open"), wall_thickness=0.2, wall_only=True)


def test_goes_to_vtk(lumen):
    pytest.importorskip("vtkmodules", reason="python3-vtk9 is missing")
    from vtkmodules.vtkFiltersVerdict import vtkCellSizeFilter
    from vtkmodules.util.numpy_support import vtk_to_numpy

    grid = lumen.to_vtk()
    assert grid.GetNumberOfCells() == len(lumen.cell_region)
    np.testing.assert_array_equal(vtk_to_numpy(grid.GetCellData().GetArray("ModelRegionID")), lumen.cell_region + 1)
    sizes = vtkCellSizeFilter()
    sizes.SetInputData(grid)
    sizes.Update()
    volumes = vtk_to_numpy(sizes.GetOutput().GetCellData().GetArray("Volume"))
    assert volumes.min() > 0
    # VTK cuts wedges, whose sides are curved, into tetrahedra: a thousandth is missing here.
    assert volumes.sum() == pytest.approx(lumen.region_volume["lumen"], rel=5e-3)


def test_goes_to_pyvista(lumen):
    pyvista = pytest.importorskip("pyvista", reason="PyVista is missing")
    grid = lumen.to_pyvista()
    assert isinstance(grid, pyvista.UnstructuredGrid) and grid.n_cells == len(lumen.cell_region)
