import gc
import json
import os
import pathlib
import pickle

import numpy as np
import pytest
import vmesh

from shapes import FORK


def test_keeps_what_it_was_given():
    tree = vmesh.Centerline(*FORK)
    np.testing.assert_array_equal(tree.nodes, FORK[0])
    np.testing.assert_array_equal(tree.radii, FORK[1])
    np.testing.assert_array_equal(tree.segments, FORK[2])
    assert (tree.components, tree.loops) == (1, 0)


def test_takes_lists_and_other_kinds_of_numbers():
    tree = vmesh.Centerline([[0, 0, 0], [5, 0, 0]], [1, 1], [(0, 1)])
    small = vmesh.Centerline(np.float32([[0, 0, 0], [5, 0, 0]]), np.float32([1, 1]), np.uint8([[0, 1]]))
    np.testing.assert_array_equal(tree.nodes, small.nodes)
    backwards = vmesh.Centerline(np.asfortranarray(FORK[0])[::-1], FORK[1][::-1], 4 - FORK[2])
    np.testing.assert_array_equal(backwards.nodes, FORK[0][::-1])


def test_arrays_are_views_that_keep_it_alive():
    tree = vmesh.synthetic_tree(200, seed=3)
    expected = tree.nodes.copy()
    nodes, radii = tree.nodes, tree.radii
    assert nodes.base is tree and np.shares_memory(tree.nodes, nodes)
    assert nodes.__array_interface__["data"][0] == tree.nodes.__array_interface__["data"][0]
    # node by node, position and radius
    assert radii.__array_interface__["data"][0] - nodes.__array_interface__["data"][0] == nodes.strides[0] - 8
    del tree
    gc.collect()
    np.testing.assert_array_equal(nodes, expected)


def test_arrays_cannot_be_written():
    tree = vmesh.Centerline(*FORK)
    for array in (tree.nodes, tree.radii, tree.segments):
        assert not array.flags.writeable
        with pytest.raises(ValueError):
            array[0] = 1


def test_a_sphere_has_no_segments():
    ball = vmesh.Centerline([[1, 2, 3]], [4], [])
    assert ball.segments.shape == (0, 2)
    assert ball.branches() == []


@pytest.mark.parametrize(
    "nodes, radii, segments, message",
    [
        ([[0, 0]], [1], [], "nodes: the shape is (1, 2); (n, 3) is needed"),
        ([[0, 0, 0]], [1, 2], [], "radii: the shape is (2,); (1,) is needed"),
        ([[0, 0, 0], [1, 0, 0]], [1, 1], [[0, 1.5]], "segments: integers are needed"),
        ([[0, 0, 0], [1, 0, 0]], [1, 1], [[0, -1]], "segments: row 0 has the index -1"),
        ([[0, 0, 0], [1, 0, 0]], [1, 1], [[0, 1, 2]], "segments: the shape is (1, 3)"),
        ([[0, 0, 0], [1, 0, 0]], [1, 1], [[0, 7]], "there is no node 7"),
        ([[0, 0, 0], [1, 0, 0]], [1, 0], [[0, 1]], "node 1: its radius is 0"),
        ([[0, 0, 0], [np.nan, 0, 0]], [1, 1], [[0, 1]], "node 1"),
        ([["a", "b", "c"]], [1], [], "nodes: not numbers"),
        ([], [], [], "node"),
    ],
)
def test_says_what_is_wrong(nodes, radii, segments, message):
    with pytest.raises(vmesh.InvalidInput) as error:
        vmesh.Centerline(nodes, radii, segments)
    assert message in str(error.value)
    assert isinstance(error.value, ValueError) and isinstance(error.value, vmesh.Error)


def test_cleans_arrays():
    nodes = [[0, 0, 0], [10, 0, 0], [10, 0, 0], [20, 0, 0]]
    tree = vmesh.clean(nodes, [2, 2, 2, 0], [[0, 1], [2, 3], [1, 1]])
    assert len(tree.nodes) == 3 and tree.components == 1
    assert sorted(tree.radii) == [2, 2, 2]
    assert any("radius" in line for line in tree.cleaning)


def test_cleaning_can_keep_the_order():
    nodes = [[5, 0, 0], [0, 0, 0], [-5, 0, 0]]
    tree = vmesh.clean(nodes, [1, 1, 1], [[2, 1], [1, 0]], canonical_order=False)
    np.testing.assert_array_equal(tree.nodes, nodes)


def test_cleaning_converts():
    tree = vmesh.clean([[1, 2, 3], [2, 2, 3]], [0.5, 0.5], [[0, 1]], unit="cm", space="RAS", canonical_order=False)
    np.testing.assert_allclose(tree.nodes, [[-10, -20, 30], [-20, -20, 30]])
    np.testing.assert_allclose(tree.radii, 5)
    with pytest.raises(vmesh.InvalidInput, match="inch"):
        vmesh.clean([[1, 2, 3]], [1], [], unit="inch")


@pytest.mark.parametrize("extension", [".json", ".swc", ".csv"])
def test_comes_back_from_a_file(tmp_path, extension):
    tree = vmesh.clean(*FORK)
    tree.save(tmp_path / f"fork{extension}")
    again = vmesh.read_centerline(tmp_path / f"fork{extension}")
    np.testing.assert_array_equal(again.nodes, tree.nodes)
    np.testing.assert_array_equal(again.radii, tree.radii)
    assert again.warnings == []


def test_keeps_flat_ends(tmp_path):
    path = tmp_path / "cut.json"
    ring = [[9, 2, 0], [9, -1.5, 2], [9, -1.5, -2]]
    section = {"node": 1, "center": [9, 0, 0], "normal": [1, 0, 0], "area": 7, "open": True, "ring": ring}
    other = {"node": 0, "center": [0, 0, 0], "normal": [-1, 0, 0], "area": 12, "open": False}
    path.write_text(
        json.dumps(
            {
                "schema": "vmesh.centerline/1",
                "nodes": [[0, 0, 0, 2], [9, 0, 0, 2]],
                "segments": [[0, 1]],
                "end_sections": [section, other],
            }
        )
    )
    tree = vmesh.read_centerline(path, unit="mm", space="LPS")
    tree.save(tmp_path / "again.json")
    for centerline in (tree, vmesh.read_centerline(tmp_path / "again.json"), pickle.loads(pickle.dumps(tree))):
        flat = {tuple(s["center"]): s for s in centerline.end_sections}
        assert len(flat) == 2
        np.testing.assert_array_equal(flat[(9, 0, 0)]["ring"], ring)
        np.testing.assert_array_equal(flat[(9, 0, 0)]["normal"], [1, 0, 0])
        assert flat[(9, 0, 0)]["open"] and not flat[(0, 0, 0)]["open"]
        assert flat[(0, 0, 0)]["ring"] is None and flat[(0, 0, 0)]["area"] == 12
    assert vmesh.clean(*FORK).end_sections == []
    surface = vmesh.generate(tree, ends="flat")
    assert sorted(round(end.area, 6) for end in surface.flat_ends)[1] == 12


def test_reads_paths_of_any_kind(tmp_path):
    path = tmp_path / "fork.swc"
    vmesh.clean(*FORK).save(str(path))
    assert len(vmesh.read_centerline(str(path)).nodes) == 5
    assert len(vmesh.read_centerline([path]).nodes) == 5


def test_a_file_is_complete_or_not_there(tmp_path):
    ring = vmesh.Centerline([[0, 0, 0], [9, 0, 0], [0, 9, 0]], [1, 1, 1], [[0, 1], [1, 2], [2, 0]])
    assert ring.loops == 1
    with pytest.raises(vmesh.Unsupported):
        ring.save(tmp_path / "ring.swc")
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(vmesh.WriteError):
        ring.save(tmp_path / "no" / "ring.json")


def test_errors_name_file_and_line(tmp_path):
    with pytest.raises(vmesh.ReadError, match="nowhere.swc") as error:
        vmesh.read_centerline(tmp_path / "nowhere.swc")
    assert isinstance(error.value, OSError)
    bad = tmp_path / "bad.swc"
    bad.write_text("1 0 0 0 0 1 -1\n2 0 x 0 0 1 1\n")
    with pytest.raises(vmesh.InvalidInput, match="line 2"):
        vmesh.read_centerline(bad)


def test_warns_of_what_was_assumed(tmp_path):
    path = tmp_path / "plain.swc"
    path.write_text("1 0 0 0 0 1 -1\n2 0 5 0 0 1 1\n")
    assert any("unit" in line for line in vmesh.read_centerline(path).warnings)
    assert not any("unit" in line for line in vmesh.read_centerline(path, unit="mm").warnings)
    np.testing.assert_allclose(vmesh.read_centerline(path, unit="cm", space="LPS").radii, 10)


def test_branches_take_every_segment_once():
    tree = vmesh.synthetic_tree(300)
    pairs = sorted(tuple(sorted(pair)) for b in tree.branches() for pair in zip(b[:-1].tolist(), b[1:].tolist()))
    assert pairs == sorted(tuple(sorted(pair)) for pair in tree.segments.tolist())


def test_goes_to_other_processes():
    tree = vmesh.clean(*FORK)
    again = pickle.loads(pickle.dumps(tree))
    np.testing.assert_array_equal(again.nodes, tree.nodes)
    np.testing.assert_array_equal(again.segments, tree.segments)
    assert again.cleaning == tree.cleaning


def test_a_seed_gives_the_same_tree_always():
    np.testing.assert_array_equal(vmesh.synthetic_tree(50, 7).nodes, vmesh.synthetic_tree(50, 7).nodes)
    assert not np.array_equal(vmesh.synthetic_tree(50, 7).nodes, vmesh.synthetic_tree(50, 8).nodes)
    with pytest.raises(vmesh.InvalidInput):
        vmesh.synthetic_tree(1)


def test_reads_a_vtp_of_vmtk():
    data = pathlib.Path(os.environ.get("VMESH_SHARED_DATA", "")) / "pulmonary_aorta_coronary_centerlines"
    files = sorted(data.glob("**/*.vtp"))
    if not files:
        pytest.skip(f"no data in {data}")
    tree = vmesh.read_centerline(files[0])
    assert len(tree.nodes) > 10 and (tree.radii > 0).all()


def test_ends_that_nearly_meet_are_joined(tmp_path):
    path = tmp_path / "gap.swc"
    path.write_text("1 3 0 0 0 .5 -1\n2 3 5 0 0 .5 1\n3 3 5.3 0 0 .5 -1\n4 3 9 0 0 .5 3\n")
    apart = vmesh.read_centerline(path, join_gaps=False)
    assert apart.components == 2
    for near in ("0.4mm", 0.7):  # radii
        joined = vmesh.read_centerline(path, join_gaps=False, join_ends=near)
        assert joined.components == 1
        assert any("join" in line for line in joined.cleaning)
    assert vmesh.read_centerline(path, join_gaps=False, join_ends=0.5).components == 2
    for wrong in (0, -1, float("nan"), "near"):
        with pytest.raises(vmesh.InvalidInput, match="0.5mm"):
            vmesh.read_centerline(path, join_ends=wrong)
