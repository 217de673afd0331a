"""Images of a ball, written by other programs; vmesh contours them where the ball is."""
import os

import numpy

import small_files as small
from report import Absent, Wrong, expect

BALL_CENTER, BALL_RADIUS, BALL_SIZE, BALL_SPACING = numpy.array([9, 10, 11.0]), 6.0, (40, 44, 50), 0.5


def ball():
    """Voxels of a ball, first axis fastest."""
    places = numpy.stack(numpy.meshgrid(*(numpy.arange(n) * BALL_SPACING for n in BALL_SIZE), indexing="ij"), -1)
    inside = numpy.linalg.norm(places - BALL_CENTER, axis=-1) <= BALL_RADIUS
    return inside.astype(numpy.uint8)


def nrrd(path, detached=False):
    head = (
        "NRRD0004\ntype: uchar\ndimension: 3\nspace: right-anterior-superior\nsizes: {} {} {}\nspace directions: "
        "({s},0,0) (0,{s},0) (0,0,{s})\nkinds: domain domain domain\nencoding: raw\nspace origin: (0,0,0)\n\n"
    )
    head = head.format(*BALL_SIZE, s=BALL_SPACING).encode()
    if not detached:
        return small.write(path, head + ball().tobytes("F"))
    small.write(path.replace(".nhdr", ".raw"), ball().tobytes("F"))
    return small.write(
        path, head.strip() + f"\ndata file: {os.path.basename(path).replace('.nhdr', '.raw')}\n".encode()
    )


def check_ball(table, form, program, vmesh, make, turn, options=(), way="in, image"):
    """`make` writes the image; `turn` takes its frame to LPS."""

    def action():
        vmesh("reference", make(), *options, "--label", 1, "--binary", "-o", vmesh.path("ball.ply"))
        there = vmesh.surface(vmesh.path("ball.ply"))
        off = numpy.linalg.norm(there.points - BALL_CENTER * numpy.array(turn), axis=1) - BALL_RADIUS
        # The contour lies between voxels, half a voxel off at most along each axis.
        allowed = BALL_SPACING * 3**0.5 / 2
        expect(numpy.abs(off).max() <= allowed, f"the ball is off by {numpy.abs(off).max():.3g} mm")
        return len(there.points), len(there.faces), "values", "mm, " + ("LPS" if turn[0] > 0 else "RAS")

    table.check(form, way, program, action)


def contours(table, written):
    if not written.with_vtk:
        table.notes.append("SKIPPED images: this vmesh is built without VTK, which contours them")
    return written.with_vtk


def reads(table, vmesh, form, option, library):
    path = small.write(vmesh.path("no" + form), "no image")
    try:
        vmesh("reference", path, "-o", vmesh.path("no.ply"))
    except Wrong as wrong:
        if option in str(wrong):
            table.notes.append(f"SKIPPED {form}: this vmesh is built without {library}")
            return False
    return True


def reads_dicom(table, vmesh):
    return reads(table, vmesh, ".dcm", "VMESH_WITH_DICOM", "GDCM")


def reads_tiff(table, vmesh):
    return reads(table, vmesh, ".tif", "VMESH_WITH_TIFF", "libtiff")


def write_by_vtk(vtk, path):
    writer, settings = "vtkMetaImageWriter", {}
    if not path.endswith((".mha", ".mhd")):
        writer, settings = "vtkNIFTIImageWriter", {"QFormMatrix": vtk.vtk.vtkMatrix4x4(), "QFac": 1}
    if path.endswith(".tif"):
        writer, settings = "vtkTIFFWriter", {}
    voxels = vtk.vtk.vtkImageData()
    voxels.SetDimensions(BALL_SIZE)
    voxels.SetSpacing([BALL_SPACING] * 3)
    voxels.GetPointData().SetScalars(vtk.arrays.numpy_to_vtk(ball().ravel("F"), deep=True))
    return vtk.write(writer, voxels, path, **settings)


def check_vtk(table, vtk, written):
    if not contours(table, written):
        return
    forms = {".nii": (-1, -1, 1), ".nii.gz": (-1, -1, 1), ".mha": (1, 1, 1), ".img": (-1, -1, 1), ".mhd": (1, 1, 1)}
    for form, turn in forms.items():
        path = written.vmesh.path("ball" + form)
        check_ball(table, form, vtk.name, written.vmesh, lambda path=path: write_by_vtk(vtk, path), turn)
    if reads_tiff(table, written.vmesh):
        path, size = written.vmesh.path("by_vtk.tif"), ("--voxel-size", BALL_SPACING)
        check_ball(table, ".tif", vtk.name, written.vmesh, lambda: write_by_vtk(vtk, path), (1, 1, 1), size)


def check_tifffile(table, written):
    try:
        import tifffile
    except ImportError as error:
        raise Absent(f"tifffile is not installed (Debian: python3-tifffile): {error}") from None
    vmesh, slices = written.vmesh, ball().transpose(2, 1, 0)
    if not contours(table, written) or not reads_tiff(table, vmesh):
        return
    sizes = {"resolution": (1 / BALL_SPACING,) * 2, "metadata": {"spacing": BALL_SPACING, "unit": "mm", "axes": "ZYX"}}
    for word, voxels, settings in (
        ("ImageJ", slices, {"imagej": True, **sizes}),
        ("tiles", slices.astype("u2"), {"tile": (16, 32), "photometric": "minisblack"}),
    ):
        path = vmesh.path(f"{word}.tif")
        check_ball(
            table,
            ".tif",
            f"tifffile {tifffile.__version__}",
            vmesh,
            lambda path=path, voxels=voxels, settings=settings: (tifffile.imwrite(path, voxels, **settings), path)[1],
            (1, 1, 1),
            () if "imagej" in settings else ("--voxel-size", BALL_SPACING),
            f"in, image, {word}",
        )


def check_text(table, written):
    vmesh, path, by = written.vmesh, written.vmesh.path, "by its documentation"
    if not contours(table, written):
        return
    check_ball(table, ".nrrd", by, vmesh, lambda: nrrd(path("ball.nrrd")), (-1, -1, 1))
    check_ball(table, ".nhdr", by, vmesh, lambda: nrrd(path("ball.nhdr"), detached=True), (-1, -1, 1))


def pydicom_module():
    try:
        import pydicom
    except ImportError as error:
        raise Absent(f"pydicom is not installed (Debian: python3-pydicom): {error}") from None
    return pydicom


def slice_by_pydicom(pydicom, voxels, number):
    meta = pydicom.dataset.FileMetaDataset()
    meta.MediaStorageSOPClassUID = pydicom.uid.CTImageStorage
    meta.MediaStorageSOPInstanceUID = f"1.2.826.0.1.3680043.8.498.1.{number + 1}"
    meta.TransferSyntaxUID = pydicom.uid.ExplicitVRLittleEndian
    data = pydicom.dataset.FileDataset("", {}, file_meta=meta, preamble=b"\0" * 128)
    data.is_little_endian, data.is_implicit_VR = True, False
    data.SOPClassUID, data.SOPInstanceUID = meta.MediaStorageSOPClassUID, meta.MediaStorageSOPInstanceUID
    data.SeriesInstanceUID, data.StudyInstanceUID, data.FrameOfReferenceUID = "1.2.3.4", "1.2.3.5", "1.2.3.6"
    data.Modality, data.PatientName, data.PatientID = "CT", "Ball", "1"
    data.ImagePositionPatient = [0, 0, number * BALL_SPACING]
    data.ImageOrientationPatient, data.PixelSpacing = [1, 0, 0, 0, 1, 0], [BALL_SPACING, BALL_SPACING]
    data.SliceThickness, data.InstanceNumber = BALL_SPACING, number + 1
    data.Columns, data.Rows = voxels.shape[:2]
    data.SamplesPerPixel, data.PhotometricInterpretation = 1, "MONOCHROME2"
    data.BitsAllocated = data.BitsStored = 16
    data.HighBit, data.PixelRepresentation = 15, 0
    data.RescaleIntercept, data.RescaleSlope = 0, 1
    data.PixelData = voxels.astype("<u2").tobytes("F")
    return data


def write_by_pydicom(folder):
    """A series, its slices under names that do not follow their order."""
    os.makedirs(folder, exist_ok=True)
    pydicom, voxels = pydicom_module(), ball()
    for number in range(BALL_SIZE[2]):
        name = os.path.join(folder, f"IM{number * 7 % BALL_SIZE[2]:03}")
        slice_by_pydicom(pydicom, voxels[:, :, number], number).save_as(name, write_like_original=False)
    return folder


def check_pydicom(table, written):
    name, vmesh = f"pydicom {pydicom_module().__version__}", written.vmesh
    if contours(table, written) and reads_dicom(table, vmesh):
        check_ball(table, "DICOM", name, vmesh, lambda: write_by_pydicom(vmesh.path("ct")), (1, 1, 1))
