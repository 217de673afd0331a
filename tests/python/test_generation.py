import os
import subprocess
import threading

import numpy as np
import pytest
import vmesh

from shapes import CROSSING, FORK, straight


def test_arrays_and_centerline_give_the_same_surface():
    from_arrays = vmesh.generate(*FORK, around=8)
    from_centerline = vmesh.generate(vmesh.Centerline(*FORK), around=8)
    np.testing.assert_array_equal(from_arrays.vertices, from_centerline.vertices)
    np.testing.assert_array_equal(from_arrays.faces, from_centerline.faces)


@pytest.mark.parametrize(
    "options",
    [
        [],
        ["--around", "9"],
        ["--max-error", "10%"],
        ["--ends", "flat"],
        ["--budget", "vertices=1500"],
        ["--ends", "flat", "--flow-extensions", "auto"],
    ],
)
def test_the_command_makes_the_same_surface(tmp_path, options):
    command = os.environ.get("VMESH_COMMAND")
    if not command:
        pytest.skip("the command was not built")
    vmesh.synthetic_tree(150, seed=2).save(tmp_path / "tree.json")
    made = [command, "generate", tmp_path / "tree.json", "-o", tmp_path / "tree.ply", "--quiet", *options]
    subprocess.run(made, check=True)
    of_command = vmesh.read_surface(tmp_path / "tree.ply")
    names = {"--around": "around", "--max-error": "max_error", "--ends": "ends", "--budget": "budget"}
    names["--flow-extensions"] = "flow_extension"
    keywords = {names[k]: int(v) if v.isdigit() else v for k, v in zip(options[::2], options[1::2])}
    surface = vmesh.generate(vmesh.read_centerline(tmp_path / "tree.json"), **keywords)
    np.testing.assert_array_equal(surface.vertices, of_command.vertices)
    np.testing.assert_array_equal(surface.faces, of_command.faces)
    for name, values in surface.vertex_attributes.items():
        np.testing.assert_array_equal(of_command.vertex_attributes[name], values, err_msg=name)
    for name, values in surface.face_attributes.items():
        np.testing.assert_array_equal(of_command.face_attributes[name], values, err_msg=name)


def test_a_capsule_has_its_volume():
    surface = vmesh.generate(*straight(length=20, radius=2), around=24)
    volume = np.pi * 4 * 20 + 4 / 3 * np.pi * 8
    # The placement keeps the volume; 24 edges around cut off 1.1 % of a circle, and half of a tenth of that is left.
    assert surface.volume == pytest.approx(volume, rel=0.005)
    assert surface.defects == [] and surface.openings == []


def test_every_vertex_knows_its_place():
    tree = vmesh.Centerline(*FORK)
    surface = vmesh.generate(tree)
    assert surface.centerline is tree
    a, b = tree.segments[surface.segment].T
    t = surface.parameter[:, None]
    on_axis = (1 - t) * tree.nodes[a] + t * tree.nodes[b]
    np.testing.assert_allclose(
        surface.radius, (1 - surface.parameter) * tree.radii[a] + surface.parameter * tree.radii[b], rtol=1e-9
    )
    distance = np.linalg.norm(surface.vertices - on_axis, axis=1) / surface.radius
    # Where vessels are rounded at the fork, half of the smaller radius away at most.
    assert (distance > 0.7).all() and (distance < 1.6).all()
    assert set(surface.branch.tolist()) == {0, 1, 2}


def test_arrays_are_views():
    surface = vmesh.generate(*FORK)
    for name in ("vertices", "faces", "segment", "parameter", "radius"):
        one, other = getattr(surface, name), getattr(surface, name)
        assert one.base is surface and not one.flags.writeable
        assert one.__array_interface__["data"] == other.__array_interface__["data"]
    vertices = surface.vertices
    expected = vertices.copy()
    del surface
    np.testing.assert_array_equal(vertices, expected)


def test_the_number_of_threads_does_not_matter():
    tree = vmesh.synthetic_tree(200)
    one, many = vmesh.generate(tree, threads=1), vmesh.generate(tree, threads=4)
    np.testing.assert_array_equal(one.vertices, many.vertices)


def test_threads_of_python_can_work_at_once():
    trees = [vmesh.synthetic_tree(120, seed) for seed in range(4)]
    results = [None] * len(trees)

    def work(i):
        results[i] = vmesh.generate(trees[i], threads=1)

    threads = [threading.Thread(target=work, args=(i,)) for i in range(len(trees))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for tree, result in zip(trees, results):
        np.testing.assert_array_equal(result.vertices, vmesh.generate(tree).vertices)


def test_an_unsound_surface_raises_with_its_defects():
    with pytest.warns(vmesh.SurfaceWarning, match="touch"):
        with pytest.raises(vmesh.DefectiveSurface) as error:
            vmesh.generate(*CROSSING, overlap="keep")
    assert "crossing_faces" in str(error.value) and "allow_defects" in str(error.value)
    defect = error.value.defects[0]
    assert defect.kind == "crossing_faces" and defect.count > 0
    # where the vessels cross
    assert np.linalg.norm(defect.position) < 4
    assert len(error.value.surface.vertices) > 0


def test_defects_can_be_allowed():
    with pytest.warns(vmesh.SurfaceWarning):
        surface = vmesh.generate(*CROSSING, overlap="keep", allow_defects=True)
    assert [d.kind for d in surface.defects] == ["crossing_faces"] * len(surface.defects) != []
    assert len(vmesh.evaluate(surface).crossing_faces) > 0


def test_vessels_that_touch_are_separated():
    surface = vmesh.generate(*CROSSING)
    assert surface.defects == [] and len(vmesh.evaluate(surface).crossing_faces) == 0
    assert vmesh.evaluate(surface).topology.components == 2


def test_ends_can_be_left_open():
    surface = vmesh.generate(*FORK, open_ends=[0, 3])
    assert [o.node for o in surface.openings] == [0, 3]
    opening = surface.openings[0]
    np.testing.assert_allclose(opening.normal, [-1, 0, 0], atol=1e-9)
    ring = surface.vertices[opening.ring]
    np.testing.assert_allclose(ring[:, 0], 0, atol=1e-9)
    assert surface.volume is None
    with pytest.raises(vmesh.InvalidInput, match="node 2"):
        vmesh.generate(*FORK, open_ends=[2])


def test_ends_can_be_flat():
    surface = vmesh.generate(*FORK, ends="flat", flow_extension=3)
    assert [e.node for e in surface.flat_ends] == [0, 3, 4] and all(e.capped for e in surface.flat_ends)
    inlet = surface.flat_ends[0]
    assert inlet.area == pytest.approx(np.pi * 4, rel=1e-6)
    np.testing.assert_allclose(inlet.center, [-6, 0, 0], atol=1e-6)  # three radii on
    caps = surface.faces[surface.cap_label == inlet.label]
    np.testing.assert_allclose(surface.vertices[caps][..., 0], -6, atol=1e-6)
    assert surface.volume is not None


def test_ends_can_be_finished_later():
    later = vmesh.finish_ends(vmesh.generate(*FORK, ends="open"), cap=True)
    assert [e.capped for e in later.flat_ends] == [True] * 3
    with pytest.raises(vmesh.InvalidInput, match="centerline"):
        vmesh.finish_ends(vmesh.Surface(later.vertices, later.faces))


@pytest.mark.parametrize("limit", [0.1, "0.1mm", "5%"])
def test_an_error_limit_is_proven(limit):
    tree = vmesh.Centerline(*FORK)
    surface = vmesh.generate(tree, max_error=limit, blend=0)
    assert surface.unproven_faces == 0
    sides = vmesh.evaluate(surface, centerline=tree).vessel
    measured = [s.relative.max if limit == "5%" else s.mm.max for s in (sides.from_surface, sides.from_volume)]
    assert max(measured) <= (0.05 if limit == "5%" else 0.1)


def test_long_triangles_leave_out_vertices_down_to_a_number():
    fewest = vmesh.generate(*FORK, max_error="10%", elongation=16)
    more = vmesh.generate(*FORK, max_error="10%", elongation=16, least_vertices=len(fewest.vertices) + 20)
    assert len(more.vertices) == len(fewest.vertices) + 20
    assert more.unproven_faces == 0
    with pytest.raises(vmesh.InvalidInput, match="least_vertices"):
        vmesh.generate(*FORK, max_error="10%", least_vertices=50)


@pytest.mark.parametrize(
    "options, message",
    [
        ({"around": 2}, "around must be in"),
        ({"max_error": "much"}, "much"),
        ({"max_error": -1.0}, "-1"),
        ({"placement": "x"}, "x"),
        ({"growth": "x"}, "x"),
        ({"overlap": "x"}, "separate and keep"),
        ({"ends": "x"}, "round, flat and open"),
        ({"flow_extension": 2}, "ends that are not round"),
        ({"gap": 2}, "gap"),
        ({"max_vertices": 100}, "vertices"),
    ],
)
def test_bad_options_are_refused(options, message):
    with pytest.raises(ValueError, match=message):
        vmesh.generate(vmesh.synthetic_tree(300), **options)


def test_bad_arguments_are_refused():
    with pytest.raises(TypeError, match="nodes, radii and segments"):
        vmesh.generate(FORK[0])
    with pytest.raises(TypeError, match="of its own"):
        vmesh.generate(vmesh.Centerline(*FORK), FORK[1], FORK[2])


@pytest.mark.parametrize("extension", [".ply", ".vtp", ".obj", ".off", ".stl", ".glb"])
def test_comes_back_from_a_file(tmp_path, extension):
    surface = vmesh.generate(*FORK)
    try:
        surface.save(tmp_path / f"fork{extension}")
    except vmesh.Unsupported as error:
        pytest.skip(str(error))
    again = vmesh.read_surface(tmp_path / f"fork{extension}")
    assert again.faces.shape == surface.faces.shape
    # STL and GLB hold single precision, at most 2^-24 of 28 mm and of that in metres.
    exact = extension not in (".stl", ".glb")
    assert vmesh.hausdorff(surface, again).upper <= (1e-4 if exact else 1e-4 + 2 * 28 * 2**-24)


def test_a_file_keeps_the_places(tmp_path):
    tree = vmesh.Centerline(*FORK)
    surface = vmesh.generate(tree)
    surface.save(tmp_path / "fork.ply")
    again = vmesh.read_surface(tmp_path / "fork.ply", centerline=tree)
    np.testing.assert_array_equal(again.segment, surface.segment)
    np.testing.assert_array_equal(again.parameter, surface.parameter)
    np.testing.assert_allclose(again.radius, surface.radius, rtol=1e-14)


@pytest.mark.parametrize("extension, rtol", [(".ply", 1e-14), (".vtp", 1e-14), (".glb", 2**-24)])
def test_the_radius_in_a_file_is_there(tmp_path, extension, rtol):
    surface = vmesh.generate(*FORK)
    surface.save(tmp_path / f"fork{extension}")
    again = vmesh.read_surface(tmp_path / f"fork{extension}")
    np.testing.assert_allclose(again.radius, surface.radius, rtol=rtol)
    np.testing.assert_array_equal(again.vertex_attributes["segment"], surface.segment)
    assert again.segment is None  # which needs the centerline


def test_without_a_radius_in_the_file_there_is_none(tmp_path):
    surface = vmesh.generate(*FORK)
    surface.save(tmp_path / "fork.stl")
    assert vmesh.read_surface(tmp_path / "fork.stl").radius is None


def test_a_file_can_be_in_another_unit(tmp_path):
    surface = vmesh.generate(*FORK)
    surface.save(tmp_path / "fork.ply", unit="cm", space="RAS")
    again = vmesh.read_surface(tmp_path / "fork.ply")
    np.testing.assert_allclose(again.vertices, surface.vertices, rtol=1e-14)
    np.testing.assert_allclose(again.vertex_attributes["radius"], surface.radius, rtol=1e-14)


def test_nothing_is_left_where_writing_fails(tmp_path):
    with pytest.raises(vmesh.Unsupported):
        vmesh.generate(*FORK).save(tmp_path / "fork.doc")
    assert list(tmp_path.iterdir()) == []


def test_any_mesh_can_be_bound():
    tree = vmesh.Centerline(*FORK)
    grown = vmesh.generate(tree)
    bound = vmesh.Surface(grown.vertices, grown.faces, centerline=tree)
    assert bound.segment is not None and (bound.parameter >= 0).all() and (bound.parameter <= 1).all()
    assert vmesh.Surface(grown.vertices, grown.faces).segment is None


def test_faces_must_name_vertices():
    with pytest.raises(vmesh.InvalidInput, match="row 1 names vertex 4"):
        vmesh.Surface(np.zeros((4, 3)), [[0, 1, 2], [1, 2, 4]])


def test_a_budget_chooses_the_finest_surface_within_it():
    surface = vmesh.generate(vmesh.synthetic_tree(150, seed=2), budget="vertices=1500")
    assert len(surface.vertices) <= 1500
    within = [point for point in surface.tried if point.within_budget]
    assert len(surface.vertices) == max(point.vertices for point in within)
    assert [point.around for point in surface.tried] == sorted(point.around for point in surface.tried)
    finer = min(point.vertices for point in surface.tried if not point.within_budget)
    assert finer > 1500
    assert vmesh.generate(*FORK).tried == []


def test_a_budget_of_error_is_kept():
    surface = vmesh.generate(*FORK, budget="error=0.2mm")
    assert surface.unproven_faces == 0 and surface.warnings == []
    assert max(point.max_error for point in surface.tried if point.within_budget) <= 0.2


def test_a_budget_that_cannot_be_met_is_told():
    with pytest.warns(vmesh.SurfaceWarning, match="nothing is within the budget vertices=5"):
        vmesh.generate(*FORK, budget="vertices=5")
    for options in ({"around": 8}, {"max_error": 0.1}, {"least_vertices": 100, "elongation": 4}):
        with pytest.raises(vmesh.InvalidInput, match="a budget chooses"):
            vmesh.generate(*FORK, budget="vertices=500", **options)
    with pytest.raises(vmesh.InvalidInput, match="budget"):
        vmesh.generate(*FORK, budget="cheap")


def test_extensions_are_as_long_as_there_is_room():
    nodes = [[-10, 0, 0], [0, 0, 0], [6, -12, 0], [6, 12, 0]]
    crossroads = vmesh.Centerline(nodes, [1, 1, 2, 2], [[0, 1], [2, 3]])
    with pytest.raises(vmesh.DefectiveSurface), pytest.warns(vmesh.SurfaceWarning, match="at most 3.* radii fit there"):
        vmesh.generate(crossroads, ends="flat", flow_extension=5)
    surface = vmesh.generate(crossroads, ends="flat", flow_extension="auto")
    extensions = {end.node: end.extension for end in surface.flat_ends}
    assert 3 < extensions.pop(1) < 4
    assert set(extensions.values()) == {10.0}
    opened = vmesh.generate(crossroads, ends="open")
    assert [end.extension for end in vmesh.finish_ends(opened, extension=2).flat_ends] == [2.0] * 4
    with pytest.raises(vmesh.InvalidInput, match="neither a number of radii nor"):
        vmesh.generate(crossroads, ends="flat", flow_extension="long")


def test_normals_are_an_array_like_the_radius():
    surface = vmesh.generate(*straight())
    assert surface.normals.shape == surface.vertices.shape
    middle = (surface.parameter > 0.1) & (abs(surface.vertices[:, 0] - 10) < 5)
    outward = surface.vertices[middle] * [0, 1, 1] / np.linalg.norm(surface.vertices[middle, 1:], axis=1)[:, None]
    assert (np.sum(outward * surface.normals[middle], axis=1) > 0.95).all()


def test_files_are_text_or_packed_on_request(tmp_path):
    surface = vmesh.generate(*FORK)
    surface.save(tmp_path / "fork.ply", ascii=True)
    assert (tmp_path / "fork.ply").read_text().startswith("ply\nformat ascii")
    np.testing.assert_array_equal(vmesh.read_surface(tmp_path / "fork.ply").vertices, surface.vertices)
    with pytest.raises(vmesh.Unsupported, match="no text form"):
        surface.save(tmp_path / "fork.vtp", ascii=True)
    with pytest.raises(vmesh.Unsupported, match="no compressed form"):
        surface.save(tmp_path / "other.ply", compress=True)
    with pytest.raises(vmesh.InvalidInput, match="ascii, compress"):
        surface.save(tmp_path / "other.ply", ascii=True, compress=True)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["fork.ply"]
