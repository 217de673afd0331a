import struct

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


def test_long_triangles_come_nearer():
    surface, reference = vmesh.generate(*FORK), widened(1.1, around=48)
    even = vmesh.fit(surface, reference)
    fitted = vmesh.fit(surface, reference, max_vertices=len(even.vertices), elongation=16)
    assert len(fitted.vertices) <= len(even.vertices)
    assert fitted.fit_report.after.mean < 0.8 * even.fit_report.after.mean  # measured .45
    assert fitted.defects == []
    with pytest.raises(vmesh.InvalidInput, match="elongation"):
        vmesh.fit(surface, reference, elongation=17)


def test_a_largest_error_is_proven():
    surface, reference = vmesh.generate(*FORK), widened(1.1, around=48)
    fitted = vmesh.fit(surface, reference, max_error=0.05)
    report = fitted.fit_report
    assert report.beyond == [] and report.uncovered == [] and report.unsupported == []
    assert report.after.hausdorff.lower <= 0.05
    missed = vmesh.fit(surface, reference, max_error=0.001, max_vertices=len(surface.vertices)).fit_report
    assert missed.beyond and all(part.distance > 0.001 for part in missed.beyond)


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


def write_segmentation(path, values, names):
    """A .seg.nrrd as 3D Slicer writes it, of one layer: voxels of 1 mm, values 1, 2 ... for the names."""
    segments = "".join(
        f"Segment{i}_Name:={name}\nSegment{i}_LabelValue:={i + 1}\nSegment{i}_Layer:=0\n" for i, name in enumerate(names)
    )
    header = (
        "NRRD0004\ntype: unsigned char\ndimension: 3\nspace: left-posterior-superior\n"
        f"sizes: {' '.join(map(str, values.shape))}\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n"
        f"encoding: raw\nspace origin: (0,0,0)\n{segments}\n"
    )
    path.write_bytes(header.encode() + values.astype(np.uint8).tobytes(order="F"))


def test_segments_are_chosen_by_name(tmp_path):
    values = np.zeros((40, 30, 30))
    values[5:35, 5:11, 5:11] = 1
    values[5:35, 18:26, 18:26] = 2
    path = tmp_path / "liver.seg.nrrd"
    write_segmentation(path, values, ["portal", "hepatic"])
    by_name = vmesh.reference_surface(path, label="Portal")
    np.testing.assert_array_equal(by_name.vertices, vmesh.reference_surface(path, label=1).vertices)
    both = vmesh.reference_surface(path, label=["portal", 2])
    assert len(both.faces) > len(by_name.faces)
    tree = vmesh.extract_centerline(path, label="hepatic")
    np.testing.assert_allclose(tree.nodes[:, 1:], 21.5, atol=0.2)
    with pytest.raises(vmesh.InvalidInput, match="renal.*portal"):
        vmesh.reference_surface(path, label="renal")
    with pytest.raises(vmesh.InvalidInput, match="portal"):
        vmesh.extract_centerline(values, np.eye(4), label="portal")


def write_tiff(path, values):
    """Pages of bytes, uncompressed, which do not tell the size of a voxel."""
    width, height, pages = values.shape
    file = struct.pack("<2sHI", b"II", 42, 8)
    for page in range(pages):
        at = len(file) + 2 + 12 * 8 + 4
        tags = {256: width, 257: height, 258: 8, 259: 1, 262: 1, 273: at, 278: height, 279: width * height}
        file += struct.pack("<H", len(tags)) + b"".join(struct.pack("<HHII", tag, 4, 1, n) for tag, n in tags.items())
        file += struct.pack("<I", 0 if page == pages - 1 else at + width * height)
        file += values[:, :, page].astype(np.uint8).tobytes(order="F")
    path.write_bytes(file)


def test_the_voxels_of_a_tiff_have_the_size_given(tmp_path):
    values = np.zeros((40, 16, 16))
    values[4:36, 4:12, 4:12] = 1
    path = tmp_path / "stack.tif"
    write_tiff(path, values)
    try:
        surface = vmesh.reference_surface(path, voxel_size=(0.5, 1, 2))
    except vmesh.Unsupported as error:
        pytest.skip(f"built without libtiff, which scripts/test installs: {error}")
    np.testing.assert_allclose(np.ptp(surface.vertices, axis=0), [16, 8, 16], atol=1e-6)
    half, whole = (vmesh.extract_centerline(path, voxel_size=(side, side, side)) for side in (0.5, 1))
    np.testing.assert_allclose(2 * np.ptp(half.nodes, axis=0), np.ptp(whole.nodes, axis=0), atol=1e-3)
    np.testing.assert_allclose(2 * half.radii, whole.radii, rtol=1e-3)
    for unsaid in (vmesh.reference_surface(path), vmesh.extract_centerline(path)):
        assert any("1 mm is assumed" in warning for warning in unsaid.warnings)
    assert not any("1 mm" in warning for warning in surface.warnings + whole.warnings)
    with pytest.raises(vmesh.InvalidInput, match="above 0"):
        vmesh.reference_surface(path, voxel_size=(1, 0, 1))
    write_segmentation(tmp_path / "s.seg.nrrd", values, ["portal"])
    with pytest.raises(vmesh.InvalidInput, match="s.seg.nrrd: voxel_size does not act"):
        vmesh.reference_surface(tmp_path / "s.seg.nrrd", voxel_size=(1, 1, 1))
    with pytest.raises(vmesh.InvalidInput, match="affine"):
        vmesh.extract_centerline(values, np.eye(4), voxel_size=(1, 1, 1))
