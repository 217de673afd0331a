import numpy as np
import pytest
import vmesh

from shapes import FORK, box, straight


def test_a_cube_has_its_measures():
    report = vmesh.evaluate(box(side=2))
    assert (report.vertices, report.faces) == (8, 12)
    assert report.area == pytest.approx(24) and report.volume == pytest.approx(8)
    topology = report.topology
    assert topology.closed and topology.manifold and topology.oriented and topology.outward
    assert (topology.components, topology.genus, topology.euler_characteristic) == (1, 0, 2)
    # right-angled and isosceles: (90 - 60) / 120 and (60 - 45) / 60
    assert report.skewness.min == pytest.approx(0.25) and report.skewness.max == pytest.approx(0.25)
    assert report.min_angle_deg.mean == pytest.approx(45) and report.max_angle_deg.mean == pytest.approx(90)
    assert len(report.crossing_faces) == len(report.degenerate_faces) == len(report.duplicate_faces) == 0
    assert report.reference is None and report.vessel is None


def test_defects_are_named():
    vertices, faces = box()
    open_box = vmesh.evaluate((vertices, faces[1:]))
    assert not open_box.topology.closed and open_box.topology.boundary_loops == 1 and open_box.volume is None
    twice = vmesh.evaluate((vertices, np.vstack([faces, faces[3:4]])))
    assert twice.duplicate_faces.tolist() == [12]
    flat = vmesh.evaluate((vertices, np.vstack([faces, [[0, 0, 1]]])))
    assert flat.degenerate_faces.tolist() == [12]
    other = box(origin=(0.5, 0.4, 0.3))
    crossing = vmesh.evaluate((np.vstack([vertices, other[0]]), np.vstack([faces, 8 + other[1]])))
    pairs = crossing.crossing_faces
    assert len(pairs) > 0 and (pairs[:, 0] < 12).all() and (pairs[:, 1] >= 12).all()


def test_the_hausdorff_distance_holds_the_true_one():
    square = (np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=float), [[0, 1, 2], [0, 2, 3]])
    lifted = (square[0] + [0, 0, 0.7], square[1])
    distance = vmesh.hausdorff(square, lifted, tolerance=1e-6)
    assert distance.lower <= 0.7 <= distance.upper and distance.upper - distance.lower <= 1e-6
    # From a point of the larger square to the nearest corner of the smaller one.
    larger = (square[0] * 3, square[1])
    distance = vmesh.hausdorff(square, larger, tolerance=1e-6)
    assert distance.forward.lower <= 0 <= distance.forward.upper <= 1e-6
    assert distance.backward.lower <= np.hypot(2, 2) <= distance.backward.upper
    np.testing.assert_allclose(distance.backward.from_point, [3, 3, 0])
    np.testing.assert_allclose(distance.backward.to_point, [1, 1, 0])


def test_distances_from_a_reference_are_taken_both_ways():
    inner, outer = box(side=1), box(side=3, origin=(-1, -1, -1))
    report = vmesh.evaluate(inner, outer, samples=20000).reference
    assert report.from_surface.distance.max == pytest.approx(1)  # every point of the inner cube is 1 away
    assert report.from_surface.distance.min == pytest.approx(1)
    assert report.hausdorff.lower <= np.sqrt(3) <= report.hausdorff.upper
    assert report.from_reference.distance.max <= np.sqrt(3)


def test_distances_from_a_centerline_are_of_its_volume():
    tree = vmesh.Centerline(*straight(length=20, radius=2))
    wide = vmesh.generate(*straight(length=20, radius=2.5), around=48)
    vessel = vmesh.evaluate(wide, centerline=tree).vessel
    # half a millimetre off everywhere, but for what 48 edges around cut off: 0.2 % of the radius
    assert vessel.from_surface.mm.mean == pytest.approx(0.5, abs=0.002 * 2.5)
    assert vessel.from_volume.mm.mean == pytest.approx(0.5, abs=0.002 * 2.5)
    assert vessel.from_surface.relative.mean == pytest.approx(0.25, abs=0.002 * 2.5)


def test_closest_points_are_on_the_surface():
    points, faces, distances = vmesh.closest_points([[0.5, 0.25, 3], [-1, -1, 0.5]], vmesh.Surface(*box()))
    np.testing.assert_allclose(points, [[0.5, 0.25, 1], [0, 0, 0.5]])
    np.testing.assert_allclose(distances, [2, np.sqrt(2)])
    vertices, corners = box()
    np.testing.assert_allclose(vertices[corners[faces[0]]][:, 2], 1)
    with pytest.raises(vmesh.InvalidInput):
        vmesh.closest_points([[np.nan, 0, 0]], vmesh.Surface(*box()))


def test_threads_do_not_matter():
    surface = vmesh.generate(*FORK)
    one = vmesh.evaluate(surface, box(side=20), threads=1, samples=5000).reference
    many = vmesh.evaluate(surface, box(side=20), threads=4, samples=5000).reference
    assert one.from_surface.distance.rms == many.from_surface.distance.rms
    assert one.from_reference.distance.p95 == many.from_reference.distance.p95


def test_what_cannot_be_measured_is_refused():
    with pytest.raises(vmesh.InvalidInput):
        vmesh.hausdorff(box(), (np.zeros((3, 3)), np.zeros((0, 3), int)))
    with pytest.raises(vmesh.InvalidInput):
        vmesh.hausdorff(box(), box(), tolerance=-1)
    with pytest.raises(TypeError, match="pair"):
        vmesh.hausdorff(box(), "surface.ply")
    with pytest.raises(vmesh.InvalidInput):
        vmesh.evaluate(box(), threads=-1)
