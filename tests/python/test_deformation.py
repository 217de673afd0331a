import numpy as np
import pytest
import vmesh

from shapes import FORK, straight


@pytest.fixture
def rod():
    return vmesh.generate(*straight(length=40, radius=1, segments=40))


def test_it_starts_at_rest(rod):
    deformation = vmesh.Deformation(rod)
    # single precision, of half the length
    np.testing.assert_allclose(deformation.vertices, rod.vertices, atol=20 * 2**-22)
    np.testing.assert_allclose(np.linalg.norm(deformation.normals, axis=1), 1, atol=1e-5)
    np.testing.assert_array_equal(deformation.nodes, rod.centerline.nodes)
    deformation.step(10)
    np.testing.assert_allclose(deformation.vertices, rod.vertices, atol=20 * 2**-22)
    assert deformation.time == pytest.approx(0.2) and deformation.rest is rod


def test_a_cantilever_bends_as_beams_do(rod):
    deformation = vmesh.Deformation(rod, young_Pa=1e6, wall_ratio=1, damping_s=0.5, drag_per_s=5, iterations=6)
    deformation.clamp(0)
    deformation.set_force(40, [0, 0, 1e-5])
    deformation.step(2000)
    # F L^3 / (3 E J), J = pi r^4 / 4 in mm^4, E in N/mm^2. 40 segments make it 1/(2 * 40) off at most, as the first
    # half of the first one is stiff; deflected by less than a hundredth of its length the rod is linear.
    expected = 1e-5 * 40**3 / (3 * 1.0 * np.pi / 4)
    assert expected < 0.4
    sag = deformation.nodes[40, 2]
    assert sag == pytest.approx(expected, rel=3 / 80)
    # The surface goes with it.
    tip = rod.vertices[:, 0] > 39.5
    np.testing.assert_allclose((deformation.vertices - rod.vertices)[tip, 2], sag, rtol=0.1)
    assert deformation.elastic_energy == pytest.approx(1e-5 * sag / 2 * 1e-3, rel=0.05)  # J: half of force times way
    assert deformation.kinetic_energy < 1e-3 * deformation.elastic_energy


def test_views_follow_every_step(rod):
    deformation = vmesh.Deformation(rod)
    deformation.clamp(0)
    vertices, nodes = deformation.vertices, deformation.nodes
    kept = vertices.copy()
    assert vertices.base is deformation and not vertices.flags.writeable
    deformation.drag(40, [38, 6, 0])
    report = deformation.step()
    assert report.iterations >= 1 and report.awake > 0
    np.testing.assert_allclose(nodes[40], [38, 6, 0])
    assert np.abs(vertices - kept).max() > 1
    np.testing.assert_array_equal(vertices, deformation.vertices)
    del deformation
    assert np.isfinite(vertices).all()


def test_steps_are_the_same_one_by_one(rod):
    def run(counts):
        deformation = vmesh.Deformation(rod)
        deformation.clamp(0)
        deformation.set_gravity([0, 0, -9810])
        for count in counts:
            deformation.step(count)
        return deformation.vertices.copy()

    np.testing.assert_array_equal(run([30]), run([1] * 30))


@pytest.mark.parametrize("kind", [np.float32, np.float64])
def test_writes_into_arrays(rod, kind):
    deformation = vmesh.Deformation(rod)
    out = np.full(rod.vertices.shape, np.nan, kind)
    deformation.write_vertices(out)
    np.testing.assert_array_equal(out, deformation.vertices.astype(kind))


def test_refuses_arrays_that_would_be_copied(rod):
    deformation = vmesh.Deformation(rod)
    shape = rod.vertices.shape
    for out in (np.zeros(shape, int), np.zeros(shape, order="F"), np.zeros((2 * shape[0], 3))[::2]):
        with pytest.raises(vmesh.InvalidInput):
            deformation.write_vertices(out)
    with pytest.raises(vmesh.InvalidInput, match="shape"):
        deformation.write_vertices(np.zeros((3, 3)))
    locked = np.zeros(shape)
    locked.setflags(write=False)
    with pytest.raises(ValueError):
        deformation.write_vertices(locked)
    with pytest.raises(TypeError):
        deformation.write_vertices(rod.vertices.tolist())


def test_a_profile_can_be_scaled_and_squeezed(rod):
    deformation = vmesh.Deformation(rod)
    deformation.fix(0)
    deformation.fix(40)
    deformation.set_radial_scale(20, 1.5)
    deformation.step(20)
    ring = np.abs(rod.vertices[:, 0] - 20) < 0.25
    assert np.linalg.norm(deformation.vertices[ring, 1:], axis=1).max() > 1.3
    deformation.set_radial_scale(20, 1)
    deformation.set_squeeze(20, 5)
    deformation.step(50)
    assert np.linalg.norm(deformation.vertices[ring, 1:], axis=1).max() < 0.9


def test_a_deformed_surface_can_be_kept(rod, tmp_path):
    deformation = vmesh.Deformation(rod)
    deformation.clamp(0)
    deformation.drag(40, [38, 6, 0])
    deformation.step(20)
    kept = deformation.surface()
    deformation.step(20)
    kept.save(tmp_path / "bent.ply")
    again = vmesh.read_surface(tmp_path / "bent.ply")
    np.testing.assert_array_equal(again.vertices, kept.vertices)
    way = np.linalg.norm(kept.vertices - rod.vertices, axis=1)
    np.testing.assert_allclose(again.vertex_attributes["displacement"], way, atol=1e-12)


def test_what_is_out_of_range_is_refused(rod):
    deformation = vmesh.Deformation(rod)
    with pytest.raises(vmesh.InvalidInput):
        deformation.fix(41)
    with pytest.raises(vmesh.InvalidInput):
        deformation.set_force(0, [0, np.inf, 0])
    with pytest.raises(vmesh.InvalidInput, match="force_N: the shape is"):
        deformation.set_force(0, [0, 1])
    with pytest.raises(vmesh.InvalidInput):
        vmesh.Deformation(rod, poisson_ratio=0.7)
    with pytest.raises(vmesh.InvalidInput):
        vmesh.Deformation(rod, step_s=0)
    with pytest.raises(vmesh.InvalidInput, match="not bound to a centerline"):
        vmesh.Deformation(vmesh.Surface(rod.vertices, rod.faces))


def test_any_mesh_follows_the_centerline_that_it_is_bound_to():
    tree = vmesh.Centerline(*FORK)
    grown = vmesh.generate(tree)
    deformation = vmesh.Deformation(vmesh.Surface(grown.vertices, grown.faces, centerline=tree))
    deformation.clamp(0)
    deformation.drag(3, [27, 9, 0])
    deformation.step(30)
    assert deformation.vertices[:, 1].max() > grown.vertices[:, 1].max() + 1


def test_a_rod_is_cut(rod):
    deformation = vmesh.Deformation(rod)
    deformation.clamp(0)
    deformation.step()
    before, nodes = deformation.vertices, deformation.nodes.copy()
    kept = before.copy()
    a, b = deformation.cut(20, 0.3)
    # Nothing moves but the vertices that went along the wall into the plane; views of before are still there.
    np.testing.assert_array_equal(before, kept)
    moved = np.linalg.norm(deformation.vertices[: len(kept)] - kept, axis=1)
    assert moved.max() < 0.3 and np.count_nonzero(moved > 1e-5) < 30
    np.testing.assert_allclose(deformation.nodes[:41], nodes, atol=1e-12)
    np.testing.assert_allclose(deformation.nodes[[a, b]], [[20.3, 0, 0]] * 2, atol=1e-12)
    assert deformation.rest is not rod and len(deformation.faces) > len(rod.faces)
    assert len(deformation.rest.vertices) == len(deformation.vertices)
    # The part that hangs on nothing flies away, the other one stays.
    deformation.set_velocity(40, [100, 0, 0])
    deformation.step(100)
    assert deformation.nodes[b, 0] > 21 and deformation.nodes[a, 0] == pytest.approx(20.3, abs=1e-6)
    with pytest.raises(ValueError, match="ends"):
        deformation.cut(20, 1.0)
    with pytest.raises(ValueError, match="no segment"):
        deformation.cut(99, 0.5)
    assert deformation.surface().vertices.shape == deformation.vertices.shape


def test_a_rod_is_clipped(rod):
    deformation = vmesh.Deformation(rod)
    kept = deformation.vertices.copy()
    nodes = deformation.clip(20, 0.5, width_mm=1.5, closing_s=0.2)
    assert min(deformation.nodes[nodes, 0]) == pytest.approx(20.5 - 0.75 - 0.5, abs=0.51)
    np.testing.assert_allclose(deformation.vertices, kept, atol=20 * 2**-22)
    deformation.step(5)  # half of the way
    within = np.abs(kept[:, 0] - 20.5) < 0.5
    assert within.sum() >= 6
    radius = np.linalg.norm(deformation.vertices[within, 1:], axis=1) / np.linalg.norm(kept[within, 1:], axis=1)
    np.testing.assert_allclose(radius, 1 - 0.95 / 2, rtol=0.02)
    deformation.step(20)
    radius = np.linalg.norm(deformation.vertices[within, 1:], axis=1) / np.linalg.norm(kept[within, 1:], axis=1)
    np.testing.assert_allclose(radius, 0.05, rtol=0.02)
    np.testing.assert_allclose(deformation.nodes[:41], rod.centerline.nodes, atol=1e-9)
    with pytest.raises(vmesh.InvalidInput, match="no room"):
        deformation.clip(39, 0.5)


def test_an_instrument_pushes_and_is_felt(rod):
    deformation = vmesh.Deformation(rod, damping_s=0.05, drag_per_s=5)
    deformation.clamp(0)
    deformation.set_contact(friction=0.1)
    with pytest.raises(vmesh.InvalidInput, match="overlaps"):
        deformation.add_instrument([[0, 0, 0]], 1, [30, 0, 1.5])
    shaft = deformation.add_instrument([[0, -5, 0], [0, 5, 0]], 1.5, [30, 0, 2.6])
    seen = []

    def look():
        force = deformation.instrument_force(shaft)
        assert force.behind == 0
        seen.append((force.contacts, force.force[2]))
        deformation.move_instrument(shaft, [30, 0, max(1.5, 2.6 - 0.02 * len(seen))])

    deformation.step(300, look)
    assert len(seen) == 300 and seen[-1][0] >= 1
    # What a cantilever resists with, pressed at 30 mm by as far as the node there went.
    way = -deformation.nodes[30, 2]
    assert 0.99 <= way <= 1.06
    assert seen[-1][1] == pytest.approx(3 * np.pi / 4 * way / 30**3, rel=0.05)
    assert deformation.contact_energy > 0


def test_jaws_and_tissue(rod):
    deformation = vmesh.Deformation(rod, damping_s=0.05, drag_per_s=5)
    deformation.clamp(0)
    for segment in range(40):
        deformation.set_tissue(segment, 1e-3, 1e-3)  # tears at 1 mm
    jaw = deformation.grasp(39, 0.5)
    start = deformation.jaw_position(jaw)
    for i in range(100):
        deformation.move_jaw(jaw, start + [0, 0, 0.03 * i])
        deformation.step()
    np.testing.assert_allclose(deformation.jaw_position(jaw), start + [0, 0, 2.97])
    assert deformation.jaw_force(jaw).force[2] < 0 and deformation.jaw_force(jaw).holds
    assert 0 < deformation.torn < 40
    deformation.open_jaw(jaw)
    assert not deformation.jaw_force(jaw).holds
