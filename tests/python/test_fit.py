import numpy as np
import pytest
import vmesh

from shapes import FORK, straight


def widened(share, around=24):
    nodes, radii, segments = FORK
    return vmesh.generate(nodes, radii * share, segments, around=around)


def is_as_near_as_grown(surface, reference):
    """As a surface of that resolution which grew where the reference did; a fit may use a twentieth more vertices."""
    grown = vmesh.evaluate(widened(1.1, around=6), reference).reference
    fitted = vmesh.evaluate(surface, reference).reference
    return (
        fitted.from_surface.distance.mean <= grown.from_surface.distance.mean
        and fitted.from_reference.distance.mean <= grown.from_reference.distance.mean
    )


def test_a_surface_moves_onto_its_reference():
    surface, reference = vmesh.generate(*FORK), widened(1.1)
    fitted = vmesh.fit(surface, reference)
    report = fitted.fit_report
    assert report.before.mean > 0.1  # a tenth of radii from 1.3 to 2 mm
    assert report.after.mean < 0.5 * report.before.mean
    assert is_as_near_as_grown(fitted, reference)
    # measured anew
    measured = vmesh.evaluate(fitted, reference, samples=100_000).reference
    assert measured.from_surface.distance.mean == pytest.approx(report.after.from_surface.distance.mean, rel=1e-6)
    assert fitted.volume == pytest.approx(reference.volume, rel=0.01)
    assert fitted.defects == [] and vmesh.evaluate(fitted).topology.closed
    assert surface.fit_report is None and fitted is not surface


def test_it_does_not_depend_on_threads_or_form():
    surface, reference = vmesh.generate(*FORK), widened(1.1)
    one = vmesh.fit(surface, reference, threads=1, rounds=4)
    many = vmesh.fit(surface, (reference.vertices, reference.faces), threads=4, rounds=4)
    np.testing.assert_array_equal(one.vertices, many.vertices)


def test_a_surface_from_a_file_is_fitted_too(tmp_path):
    tree = vmesh.Centerline(*FORK)
    vmesh.generate(tree).save(tmp_path / "fork.ply")
    surface = vmesh.read_surface(tmp_path / "fork.ply", centerline=tree)
    fitted = vmesh.fit(surface, widened(1.1))
    assert is_as_near_as_grown(fitted, widened(1.1))
    with pytest.raises(vmesh.InvalidInput, match="not bound to a centerline"):
        vmesh.fit(vmesh.read_surface(tmp_path / "fork.ply"), widened(1.1))


def test_finished_ends_come_after():
    with pytest.raises(vmesh.InvalidInput, match="finish_ends"):
        vmesh.fit(vmesh.generate(*FORK, ends="flat"), widened(1.1))
    fitted = vmesh.fit(vmesh.generate(*FORK, ends="open"), widened(1.1))
    assert len(vmesh.finish_ends(fitted).flat_ends) == 3
    tree, opened = vmesh.Centerline(*FORK), vmesh.generate(*FORK, ends="open")
    fitted = vmesh.fit(vmesh.Surface(opened.vertices, opened.faces, tree), widened(1.1))
    assert [o.node for o in fitted.openings] == [None] * 3
    with pytest.raises(vmesh.InvalidInput, match="from a file"):
        vmesh.finish_ends(fitted)


@pytest.mark.parametrize("options", [{"rounds": 0}, {"max_skewness": 2}, {"error": -1}])
def test_bad_options_are_refused(options):
    with pytest.raises(vmesh.InvalidInput):
        vmesh.fit(vmesh.generate(*FORK), widened(1.1), **options)


def mask_of_a_tube(radius, spacing):
    """Voxels of a tube along the first axis, from 5 to 25 mm, and where they are."""
    size = (int(30 / spacing), int(12 / spacing), int(14 / spacing))
    i, j, k = np.meshgrid(*(np.arange(n) * spacing for n in size), indexing="ij")
    inside = ((j - 6) ** 2 + (k - 7) ** 2 <= radius**2) & (i >= 5) & (i <= 25)
    affine = np.diag([spacing, spacing, spacing, 1])
    affine[:3, 3] = [100, -50, 20]
    return inside, affine


def test_an_array_becomes_a_reference():
    spacing = 0.5
    inside, affine = mask_of_a_tube(radius=3, spacing=spacing)
    for mask in (inside, inside.astype(np.uint8), np.asfortranarray(inside)):
        try:
            reference = vmesh.reference_surface(mask, affine, smooth=0.5)
        except vmesh.Unsupported as error:
            pytest.skip(str(error))
        assert vmesh.evaluate(reference).topology.outward
        low, high = reference.vertices.min(axis=0), reference.vertices.max(axis=0)
        # to within a voxel
        np.testing.assert_allclose(low, [105, -50 + 6 - 3, 20 + 7 - 3], atol=spacing)
        np.testing.assert_allclose(high, [125, -50 + 6 + 3, 20 + 7 + 3], atol=spacing)
    # labels
    labels = 3 * inside.astype(np.int16)
    labels[0, 0, 0] = 1
    same = vmesh.reference_surface(labels, affine, label=3, smooth=0.5)
    np.testing.assert_array_equal(same.vertices, reference.vertices)
    with pytest.raises(vmesh.InvalidInput):
        vmesh.reference_surface(labels, affine)
    with pytest.raises(vmesh.InvalidInput, match="affine"):
        vmesh.reference_surface(inside, np.eye(3))
    with pytest.raises(vmesh.InvalidInput, match="three dimensions"):
        vmesh.reference_surface(inside[0], affine)


def test_from_a_mask_to_a_surface_on_its_wall():
    inside, affine = mask_of_a_tube(radius=3, spacing=0.5)
    try:
        reference = vmesh.reference_surface(inside, affine, smooth=0.5)
    except vmesh.Unsupported as error:
        pytest.skip(str(error))
    tree = vmesh.extract_centerline(reference)
    assert tree.components == 1 and tree.loops == 0
    fitted = vmesh.fit(vmesh.generate(tree, around=12), reference)
    assert fitted.fit_report.after.mean < 0.05  # a tenth of a voxel
    assert fitted.defects == []


def test_a_centerline_is_extracted():
    tree = vmesh.extract_centerline(vmesh.generate(*straight(length=30, radius=2), around=12))
    assert tree.components == 1 and tree.loops == 0
    np.testing.assert_allclose(tree.nodes[:, 1:], 0, atol=0.1)
    assert np.median(tree.radii) == pytest.approx(2, rel=0.03)
    opened = vmesh.extract_centerline(vmesh.generate(*FORK, ends="open"))
    assert opened.components == 1 and len(opened.end_sections) == 3


def test_a_centerline_of_a_mask_is_extracted():
    inside, affine = mask_of_a_tube(radius=3, spacing=0.5)
    tree = vmesh.extract_centerline(inside, affine)
    assert tree.components == 1 and tree.loops == 0
    assert np.median(tree.radii) == pytest.approx(3, rel=0.02)
    with pytest.raises(vmesh.InvalidInput):
        vmesh.extract_centerline(inside, affine, label=7)
