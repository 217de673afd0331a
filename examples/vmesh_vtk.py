"""Centerlines, curves and segmentations in VTK's objects to surfaces, by vmesh: what the add-ons for ParaView and 3D
Slicer have in common, each with a copy of this file and of vmesh_command.py.

Positions stay where they are: results are in the unit and frame of what they were made of. Arrays have the names of
vmesh's .vtp files: MaximumInscribedSphereRadius, segment, parameter and branch of points; EquiangleSkewness and branch of
cells. Options, progress and errors are those of vmesh_command.
"""

from __future__ import annotations

import gzip
import os
import struct
import tempfile
import zlib
from typing import Any
from xml.etree import ElementTree

import numpy
from vtkmodules.util import numpy_support
from vtkmodules.vtkCommonCore import vtkPoints, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

import vmesh_command


def curve(points: Any, radii: Any, closed: bool = False) -> Any:
    """A polyline through `points`, (n, 3), with the radii of its points, (n,)."""
    points, radii = numpy.array(points, float).reshape(-1, 3), numpy.array(radii, float)
    if len(points) < 2 or len(points) != len(radii):
        raise vmesh_command.VmeshError(
            f"a curve needs at least two points with a radius each; it has {len(points)} points and {len(radii)} radii"
        )
    ids = list(range(len(points))) + ([0] if closed else [])
    line = vtkCellArray()
    line.InsertNextCell(len(ids))
    for i in ids:
        line.InsertCellPoint(i)
    places = vtkPoints()
    places.SetData(numpy_support.numpy_to_vtk(points, deep=True))
    poly = vtkPolyData()
    poly.SetPoints(places)
    poly.SetLines(line)
    array = numpy_support.numpy_to_vtk(radii, deep=True)
    array.SetName("Radius")
    poly.GetPointData().AddArray(array)
    return poly


def text_of(poly: Any, name: str) -> str | None:
    """What a field of the data says, as vmesh's files have UNIT and SPACE; "" without it."""
    array = poly.GetFieldData().GetAbstractArray(name)
    text = array.GetValue(0) if array is not None and array.GetNumberOfValues() > 0 else ""
    return text if isinstance(text, str) else ""


def surface_of_files(files: list[str], options: dict[str, Any], **how: Any) -> Any:
    """The surface around the centerline that `files` form together, in mm and LPS unless the options tell otherwise."""
    with tempfile.TemporaryDirectory(prefix="vmesh-") as folder:
        return _generated(files, folder, options, how)


def centerline_of_files(files: list[str], reading: dict[str, Any] | None = None, **how: Any) -> Any:
    """The centerline in `files`, cleaned, with radii, in mm and LPS; reading: those of the options that are for reading."""
    with tempfile.TemporaryDirectory(prefix="vmesh-") as folder:
        path = os.path.join(folder, "centerline.vtp")
        vmesh_command.convert_centerline(files, path, reading or {}, **how)
        return _read(path)


def surface_around(
    centerlines: list[Any], options: dict[str, Any], unit: str = "", space: str = "", **how: Any
) -> Any:
    """The surface around the lines of vtkPolyData, one or several that form a centerline together, each with an array of
    its points' radii, where the lines are.

    unit   of positions and radii: nm, um, mm, cm or m; "": what the data say in the field UNIT, else mm
    space  LPS or RAS; "": what they say in the field SPACE, else LPS
    """
    centerlines = list(centerlines)
    unit = unit or text_of(centerlines[0], "UNIT") or "mm"
    space = space or text_of(centerlines[0], "SPACE") or "LPS"
    with tempfile.TemporaryDirectory(prefix="vmesh-") as folder:
        files = []
        for number, poly in enumerate(centerlines):
            if poly.GetNumberOfLines() == 0:
                raise vmesh_command.VmeshError("the centerline has no lines, along which a surface could grow")
            files.append(os.path.join(folder, f"centerline{number}.vtp"))
            _write_lines(poly, files[-1])
        place = {"unit": unit, "space": space, "output_unit": unit, "output_space": space}
        try:
            return _generated(files, folder, {**options, **place}, how)
        except vmesh_command.VmeshError as error:
            raise vmesh_command.VmeshError(_without_files(str(error), files)) from None


def surface_of_segmentation(voxels: Any, ijk_to_ras: Any, options: dict[str, Any], **how: Any) -> Any:
    """The surface on the wall of the voxels that are not 0, and the centerline in it, both in RAS, mm.

    voxels      (k, j, i), as VTK and Slicer order them
    ijk_to_ras  (4, 4), from (i, j, k, 1) to RAS, mm
    options     those for centerlines of images as well; `label` is set
    """
    voxels = numpy.asarray(voxels)
    if voxels.ndim != 3:
        raise vmesh_command.VmeshError(f"a segmentation has three dimensions, not {voxels.ndim}")
    if not voxels.any():
        raise vmesh_command.VmeshError("the segmentation is empty; choose a segment with voxels")
    with tempfile.TemporaryDirectory(prefix="vmesh-") as folder:
        image = os.path.join(folder, "segmentation.nrrd")
        mask, placed = _cropped(voxels != 0, numpy.asarray(ijk_to_ras, float))
        _write_nrrd(mask, placed, image)
        centerline = os.path.join(folder, "centerline.vtp")
        more = {"label": 1, "centerline_output": centerline, "output_space": "RAS"}
        try:
            surface = _generated([image], folder, {**options, **more}, how)
        except vmesh_command.VmeshError as error:
            raise vmesh_command.VmeshError(str(error).replace(image, "the segmentation")) from None
        # It is written in LPS, with whatever it says of ends.
        turned = os.path.join(folder, "turned.vtp")
        vmesh_command.run(["convert", centerline, "-o", turned, "--output-space", "RAS"], **how)
        return surface, _read(turned)


def _generated(files: list[str], folder: str, options: dict[str, Any], how: dict[str, Any]) -> Any:
    path = os.path.join(folder, "surface.vtp")
    vmesh_command.generate(files, path, options, **how)
    return _read(path)


def _without_files(message: str, files: list[str]) -> str:
    """The user has not seen the temporary files."""
    for number, file in enumerate(files):
        message = message.replace(file, "the centerline" if len(files) == 1 else f"curve {number + 1}")
    return message


def _write_lines(poly: Any, path: str) -> None:
    lines = vtkPolyData()
    lines.SetPoints(poly.GetPoints())
    lines.SetLines(poly.GetLines())
    lines.GetPointData().ShallowCopy(poly.GetPointData())
    if poly.GetNumberOfCells() == poly.GetNumberOfLines():
        lines.GetCellData().ShallowCopy(poly.GetCellData())
    # The unit and the frame are said otherwise.
    for i in range(poly.GetFieldData().GetNumberOfArrays()):
        array = poly.GetFieldData().GetAbstractArray(i)
        if array.GetName() not in ("UNIT", "SPACE"):
            lines.GetFieldData().AddArray(array)
    writer = vtkXMLPolyDataWriter()
    writer.SetFileName(path)
    writer.SetInputData(lines)
    writer.SetDataModeToBinary()
    if writer.Write() != 1:
        raise vmesh_command.VmeshError(f"{path}: the centerline could not be written; is there room on the disk?")


def _cropped(mask: Any, ijk_to_ras: Any) -> Any:
    """To what is inside, and a voxel around it, but not beyond the border, which cuts vessels."""
    begins, ends = [], []
    for axis in range(3):
        used = numpy.flatnonzero(mask.any(axis=tuple({0, 1, 2} - {axis})))
        begins.append(max(used[0] - 1, 0))
        ends.append(used[-1] + 2)
    moved = ijk_to_ras.copy()
    moved[:3, 3] += ijk_to_ras[:3, :3] @ begins[::-1]
    return mask[begins[0] : ends[0], begins[1] : ends[1], begins[2] : ends[2]], moved


def _write_nrrd(mask: Any, ijk_to_ras: Any, path: str) -> None:
    to_lps = numpy.diag([-1.0, -1.0, 1.0, 1.0]) @ ijk_to_ras
    vector = lambda v: "(" + ",".join(repr(float(x)) for x in v) + ")"
    header = "\n".join(
        [
            "NRRD0004",
            "type: unsigned char",
            "dimension: 3",
            "space: left-posterior-superior",
            "sizes: " + " ".join(str(n) for n in mask.shape[::-1]),
            "space directions: " + " ".join(vector(to_lps[:3, axis]) for axis in range(3)),
            "space origin: " + vector(to_lps[:3, 3]),
            "encoding: gzip",
        ]
    )
    with open(path, "wb") as file:
        file.write(header.encode() + b"\n\n")
        file.write(gzip.compress(numpy.ascontiguousarray(mask, dtype=numpy.uint8).tobytes(), 1))


def _read(path: str) -> Any:
    """A .vtp of vmesh. Not by VTK's reader: of ParaView 5.11 with Debian 12's libexpat1 of 2025, that reads no file with
    appended data, ParaView's own neither."""
    with open(path, "rb") as file:
        content = file.read()
    begin = content.index(b"<AppendedData")
    blocks = memoryview(content)[content.index(b"_", begin) + 1 :]
    data: Any = ElementTree.fromstring(content[:begin] + b"</VTKFile>").find("PolyData")
    piece = data.find("Piece")
    arrays = lambda name: (
        {} if piece.find(name) is None else {a.get("Name"): _array(a, blocks) for a in piece.find(name)}
    )
    poly = vtkPolyData()
    points = vtkPoints()
    points.SetData(numpy_support.numpy_to_vtk(arrays("Points")["Points"], deep=True))
    poly.SetPoints(points)
    for name in ("Lines", "Polys"):
        cells = arrays(name)
        if cells and len(cells["offsets"]):
            getattr(poly, "Set" + name)(_cells(cells["offsets"], cells["connectivity"]))
    for name, target in (("PointData", poly.GetPointData()), ("CellData", poly.GetCellData())):
        for array_name, values in arrays(name).items():
            _add(target, array_name, values)
        section = piece.find(name)
        if section is not None and section.get("Scalars"):
            target.SetActiveScalars(section.get("Scalars"))
        if section is not None and section.get("Normals"):
            target.SetActiveNormals(section.get("Normals"))
    for array in data.findall("FieldData/*"):
        _add_field(poly.GetFieldData(), array, blocks)
    return poly


_TYPES = {
    "Float32": numpy.float32,
    "Float64": numpy.float64,
    "Int32": numpy.int32,
    "Int64": numpy.int64,
    "UInt8": numpy.uint8,
}


def _array(element: Any, blocks: Any) -> Any:
    """The values of a DataArray: text, or zlib blocks behind their number, their size, that of the last and the packed
    ones."""
    kind = numpy.dtype(_TYPES[element.get("type")])
    if element.get("format") == "ascii":
        values = numpy.array((element.text or "").split(), kind)
    else:
        offset = int(element.get("offset"))
        count = struct.unpack_from("<Q", blocks, offset)[0]
        packed = struct.unpack_from(f"<{count}Q", blocks, offset + 24)
        place, parts = offset + 24 + 8 * count, []
        for size in packed:
            parts.append(zlib.decompress(blocks[place : place + size]))
            place += size
        values = numpy.frombuffer(b"".join(parts), kind.newbyteorder("<")).astype(kind)
    components = int(element.get("NumberOfComponents", 1))
    return values.reshape(-1, components) if components > 1 else values


def _cells(offsets: Any, connectivity: Any) -> Any:
    cells = vtkCellArray()
    starts = numpy.concatenate([[0], offsets]).astype(numpy.int64)
    cells.SetData(
        numpy_support.numpy_to_vtkIdTypeArray(starts, deep=True),
        numpy_support.numpy_to_vtkIdTypeArray(connectivity.astype(numpy.int64), deep=True),
    )
    return cells


def _add(target: Any, name: str, values: Any) -> None:
    array = numpy_support.numpy_to_vtk(numpy.ascontiguousarray(values), deep=True)
    array.SetName(name)
    target.AddArray(array)


def _add_field(target: Any, element: Any, blocks: Any) -> None:
    """Of texts, each ends with a zero."""
    if element.get("type") != "String":
        _add(target, element.get("Name"), _array(element, blocks))
        return
    texts = bytes(int(code) for code in (element.text or "").split()).split(b"\0")[:-1]
    array = vtkStringArray()
    array.SetName(element.get("Name"))
    for text in texts:
        array.InsertNextValue(text.decode("utf-8", "replace"))
    target.AddArray(array)
