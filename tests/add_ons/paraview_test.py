"""ParaView's plugin, in pvpython: paraview_test.py VMESH EXAMPLES [PICTURE.png], of which the last needs a display."""

import inspect
import os
import re
import subprocess
import sys
import tempfile
import traceback

import numpy
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow

VMESH, EXAMPLES = (os.path.abspath(path) for path in sys.argv[1:3])
TREE = os.path.join(EXAMPLES, "small_tree.swc")
# Arrays of points, and what they are in PLY files.
NAMES = {
    "MaximumInscribedSphereRadius": "radius",
    "segment": "segment",
    "parameter": "parameter",
    "branch": "branch",
}
os.environ["VMESH_COMMAND"] = VMESH
# Debian's ParaView 5.11 asks its Python 3.11 for what that has no more; README.md tells users of it.
if not hasattr(inspect, "getargspec"):
    inspect.getargspec = inspect.getfullargspec
simple.LoadPlugin(os.path.join(EXAMPLES, "paraview", "vmesh_plugin.py"), remote=False, ns=simple.__dict__)
# Messages would go to the terminal.
said = vtkStringOutputWindow()
vtkOutputWindow.SetInstance(said)


def fetched(source):
    source.UpdatePipeline()
    return servermanager.Fetch(source)


def points(poly):
    return vtk_to_numpy(poly.GetPoints().GetData()) if poly.GetNumberOfPoints() else numpy.zeros((0, 3))


def triangles(poly):
    return vtk_to_numpy(poly.GetPolys().GetConnectivityArray()).reshape(-1, 3)


def names(data):
    return {data.GetArrayName(i) for i in range(data.GetNumberOfArrays())}


def by_command(folder, *options):
    """As the command writes it, in a text: names and columns of its vertices, and its triangles."""
    path = os.path.join(folder, "expected.ply")
    subprocess.run(
        [VMESH, "generate", TREE, "-o", path, "--ascii", "--quiet", *options], check=True, stderr=subprocess.DEVNULL
    )
    with open(path) as file:
        header, body = file.read().split("end_header\n")
    of_vertices = re.findall(r"property \w+ (\w+)$", header.split("element face")[0], re.MULTILINE)
    count = int(re.search(r"element vertex (\d+)", header)[1])
    rows = [line.split() for line in body.splitlines()]
    columns = dict(zip(of_vertices, numpy.array(rows[:count], float).T))
    return columns, numpy.array([row[1:4] for row in rows[count:]], int)


def expect_same(poly, expected):
    columns, faces = expected
    assert numpy.array_equal(points(poly), numpy.stack([columns[x] for x in "xyz"], axis=1))
    assert numpy.array_equal(triangles(poly), faces)
    data = poly.GetPointData()
    for name, column in NAMES.items():
        assert numpy.array_equal(vtk_to_numpy(data.GetArray(name)), columns[column]), name
    assert vtk_to_numpy(poly.GetCellData().GetArray("EquiangleSkewness")).shape == (len(faces),)


def test_the_source_is_what_the_command_makes(folder):
    surface = simple.VmeshSurface(FileName=TREE)
    first = fetched(surface)
    expect_same(first, by_command(folder))
    surface.Around = 9
    surface.MaxError = "10%"
    surface.Blend = 0.7
    surface.Ends = "flat"
    surface.FlowExtensions = 2
    surface.Overlap = "keep"
    options = "--around 9 --max-error 10% --blend 0.7 --ends flat --flow-extensions 2 --overlap keep".split()
    finer = fetched(surface)
    expect_same(finer, by_command(folder, *options))
    assert "ModelFaceID" in names(finer.GetCellData())
    surface.Overlap, surface.MaxError, surface.Ends, surface.FlowExtensions = "separate", "", "round", 0
    surface.Elongation = 8
    expect_same(fetched(surface), by_command(folder, *"--around 9 --blend 0.7 --elongation 8".split()))


def test_files_are_opened_as_centerlines(folder):
    opened = simple.OpenDataFile(TREE)
    assert opened is not None and opened.GetXMLName() == "VmeshCenterline", opened
    lines = fetched(opened)
    assert (lines.GetNumberOfPoints(), lines.GetNumberOfLines()) == (12, 11)
    opened.Unit = "cm"
    assert numpy.allclose(points(fetched(opened)), 10 * points(lines), rtol=1e-12, atol=1e-6)  # rounded to 1e-6 mm


def test_the_filter_is_where_the_lines_are(folder):
    lines = simple.OpenDataFile(TREE)
    around = simple.VmeshSurfaceAroundLines(Input=lines, Around=8)
    expect_same(fetched(around), by_command(folder, "--around", "8"))
    # Of the same numbers in cm, the surface has the same numbers again.
    smaller = simple.Transform(Input=lines)
    smaller.Transform.Scale = [0.1, 0.1, 0.1]
    radii = simple.Calculator(Input=smaller, ResultArrayName="thin", Function="MaximumInscribedSphereRadius/10")
    in_cm = fetched(simple.VmeshSurfaceAroundLines(Input=radii, Around=8, Unit="cm", RadiusArray="thin"))
    # Transform computes in floats, 4 cm have 4e-7 cm.
    assert numpy.abs(points(in_cm) - points(fetched(around)) / 10).max() < 1e-3
    box, lines_box = numpy.array(in_cm.GetBounds()), numpy.array(fetched(smaller).GetBounds())
    assert (box[0::2] < lines_box[0::2]).all() and (box[1::2] > lines_box[1::2]).all(), (box, lines_box)
    one = simple.VmeshSurfaceAroundLines(Input=simple.Line(Point1=[0, 0, 0], Point2=[9, 0, 0]), Radius=1)
    thick = fetched(one).GetBounds()
    # A hexagon of a circle's area has corners 1.1 radii from its middle.
    assert 2 < thick[5] - thick[4] < 2.3, thick


def test_mistakes_are_told(folder):
    missing = os.path.join(folder, "missing.swc")
    for source, told in (
        (simple.VmeshSurface(), "choose a file"),
        (simple.VmeshSurface(FileName=missing), f"{missing}: there is no such file"),
        (simple.VmeshSurface(FileName=TREE, MaxError="often"), "often"),
        (simple.VmeshSurface(FileName=TREE, Command=missing), "is no program"),
        (simple.VmeshSurfaceAroundLines(Input=simple.Sphere()), "no lines"),
        (simple.VmeshSurfaceAroundLines(Input=simple.Line()), "radi"),
    ):
        before = len(said.GetOutput())
        assert fetched(source) is None or fetched(source).GetNumberOfPoints() == 0
        assert told in said.GetOutput()[before:], (told, said.GetOutput()[before:])
    # What is only worth knowing is told as well, and there is a surface.
    before = len(said.GetOutput())
    without_unit = os.path.join(folder, "tube.swc")
    with open(without_unit, "w") as file:
        file.write("1 1 0 0 0 1 -1\n2 1 9 0 0 1 1\n")
    assert fetched(simple.VmeshSurface(FileName=without_unit)).GetNumberOfPoints() > 0
    assert "does not say its unit" in said.GetOutput()[before:], said.GetOutput()[before:]


def draw(picture):
    surface = simple.VmeshSurface(FileName=TREE, Around=10)
    lines = simple.OpenDataFile(TREE)
    view = simple.GetActiveViewOrCreate("RenderView")
    view.ViewSize = [900, 700]
    shown = simple.Show(surface, view)
    shown.SetRepresentationType("Surface With Edges")
    simple.ColorBy(shown, ("POINTS", "MaximumInscribedSphereRadius"))
    shown.RescaleTransferFunctionToDataRange(True)
    shown.SetScalarBarVisibility(view, True)
    shown.Opacity = 0.7
    simple.Show(lines, view).LineWidth = 4
    view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = [0, -1, 0], [0, 0, 0], [0, 0, 1]
    simple.ResetCamera(view)
    simple.SaveScreenshot(picture, view)


if len(sys.argv) > 3:
    draw(os.path.abspath(sys.argv[3]))
    os._exit(0)  # the view cannot be closed without noise
for name, test in list(globals().items()):
    if not name.startswith("test_"):
        continue
    try:
        with tempfile.TemporaryDirectory() as temporary:
            test(temporary)
    except BaseException:
        # Python's own way to tell of it ends in `said`.
        os.write(1, f"FAILED: {name}\n{traceback.format_exc()}\n{said.GetOutput()}".encode())
        os._exit(1)
    os.write(1, f"passed: {name}\n".encode())
