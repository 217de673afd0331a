"""3D Slicer's module, without Slicer: slicer_module_test.py VMESH EXAMPLES. What it does is tested with VTK alone, and its
shell with stand-ins for Slicer's modules, which show that it hangs together, not that Slicer has all it asks for.
$VMESH_PACKAGE: a folder with the Python package."""

import os
import subprocess
import sys
import tempfile
import types
import unittest.mock

try:
    import numpy
    import vtkmodules.all as vtk
    from vtkmodules.util.numpy_support import vtk_to_numpy
except ImportError as missing:
    print(f"SKIPPED: {missing} (Debian: python3-vtk9, python3-numpy)")
    sys.exit(77)

VMESH, EXAMPLES = (os.path.abspath(path) for path in sys.argv[1:3])
TREE = os.path.join(EXAMPLES, "small_tree.swc")
MODULE = os.path.join(EXAMPLES, "slicer", "VmeshSurface")
os.environ["VMESH_COMMAND"] = VMESH
sys.path.insert(0, MODULE)

import vmesh_command
import vmesh_vtk


def points(poly):
    return vtk_to_numpy(poly.GetPoints().GetData())


def expect_closed(poly, regions=1):
    edges = vtk.vtkFeatureEdges()
    edges.SetInputData(poly)
    edges.FeatureEdgesOff()
    edges.Update()
    assert edges.GetOutput().GetNumberOfCells() == 0, "open or not manifold"
    parts = vtk.vtkPolyDataConnectivityFilter()
    parts.SetInputData(poly)
    parts.SetExtractionModeToAllRegions()
    parts.Update()
    assert parts.GetNumberOfExtractedRegions() == regions, parts.GetNumberOfExtractedRegions()


def distances(places, begin, end):
    """Of points to a segment."""
    begin, along = numpy.asarray(begin, float), numpy.subtract(end, begin)
    t = numpy.clip((places - begin) @ along / (along @ along), 0, 1)
    return numpy.linalg.norm(places - begin - t[:, None] * along, axis=1)


def volume(poly):
    mass = vtk.vtkMassProperties()
    mass.SetInputData(poly)
    return mass.GetVolume()


def refused(told, call, *arguments, **named):
    try:
        call(*arguments, **named)
    except vmesh_command.VmeshError as error:
        assert told in str(error) and "vmesh-" not in str(error), error
    else:
        raise AssertionError(f"not refused: {told}")


def test_files_are_read_as_vtk_reads_them(folder):
    path = os.path.join(folder, "surface.vtp")
    for options in ([], ["--ends", "flat", "--name", "0=inlet"]):
        subprocess.run([VMESH, "generate", TREE, "-o", path, "--quiet", *options], check=True)
        reader = vtk.vtkXMLPolyDataReader()
        reader.SetFileName(path)
        reader.Update()
        expected, poly = reader.GetOutput(), vmesh_vtk._read(path)
        if expected.GetNumberOfPoints() == 0:
            print("this VTK does not read files with appended data")
            return
        assert numpy.array_equal(points(poly), points(expected))
        cells = [vtk_to_numpy(p.GetPolys().GetConnectivityArray()) for p in (poly, expected)]
        assert numpy.array_equal(*cells) and poly.GetNumberOfPolys() == expected.GetNumberOfPolys()
        for kind in ("GetPointData", "GetCellData"):
            ours, theirs = getattr(poly, kind)(), getattr(expected, kind)()
            assert ours.GetNumberOfArrays() == theirs.GetNumberOfArrays() > 0
            for i in range(theirs.GetNumberOfArrays()):
                name = theirs.GetArrayName(i)
                assert numpy.array_equal(vtk_to_numpy(ours.GetArray(name)), vtk_to_numpy(theirs.GetArray(i))), name
            assert ours.GetScalars().GetName() == theirs.GetScalars().GetName()
        for i in range(expected.GetFieldData().GetNumberOfArrays()):
            array = expected.GetFieldData().GetAbstractArray(i)
            ours = poly.GetFieldData().GetAbstractArray(array.GetName())
            texts = [[a.GetValue(j) for j in range(a.GetNumberOfValues())] for a in (ours, array)]
            assert texts[0] == texts[1], texts


def test_a_curve_gets_a_surface_where_it_is():
    begin, end = [10, -50, 300], [40, -20, 330]  # RAS, nowhere near where LPS would put them
    line = vmesh_vtk.curve(numpy.linspace(begin, end, 7), [3] * 7)
    surface = vmesh_vtk.surface_around([line], {"around": 6}, space="RAS")
    off = distances(points(surface), begin, end)
    # With six vertices around, these are lifted by a tenth of the radius and more, so that the volume is kept.
    assert 3 < off.min() and off.max() < 1.2 * 3, (off.min(), off.max())
    capsule = numpy.pi * 3**2 * (numpy.linalg.norm(numpy.subtract(end, begin)) + 4 / 3 * 3)
    assert abs(volume(surface) / capsule - 1) < 0.02, (volume(surface), capsule)
    expect_closed(surface)
    assert vmesh_vtk.text_of(surface, "SPACE") == "RAS"
    names = [surface.GetPointData().GetArrayName(i) for i in range(surface.GetPointData().GetNumberOfArrays())]
    assert {"MaximumInscribedSphereRadius", "segment", "parameter", "branch"} <= set(names), names


def test_curves_form_a_tree_together():
    trunk = vmesh_vtk.curve([[0, 0, 0], [20, 0, 0], [40, 0, 0]], [3, 3, 3])
    branch = vmesh_vtk.curve([[21, 1, 0], [30, 20, 0]], [2, 2])
    expect_closed(vmesh_vtk.surface_around([trunk, branch], {}))
    loop = vmesh_vtk.curve(20 * numpy.array([[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]]), [2] * 4, closed=True)
    ring = vmesh_vtk.surface_around([loop], {"around": 8})
    expect_closed(ring)
    faces, vertices = ring.GetNumberOfPolys(), ring.GetNumberOfPoints()
    assert vertices - faces // 2 == 0, "a torus"


def oblique(spacing):
    """A turned image, whose k axis points to the feet."""
    i, k = numpy.array([0.8, 0.6, 0]), numpy.array([0, 0, -1])
    matrix = numpy.eye(4)
    matrix[:3, :3] = numpy.stack([i, numpy.cross(k, i), k], axis=1) * spacing
    matrix[:3, 3] = 30, -70, 900
    return matrix


def tube(shape, begin, end, radius, spacing):
    """Voxels within `radius`, mm, of a segment between two voxels, (k, j, i)."""
    k, j, i = numpy.indices(shape)
    places = numpy.stack([i, j, k], axis=-1).reshape(-1, 3) * spacing
    near = distances(places, numpy.multiply(begin, spacing), numpy.multiply(end, spacing)) <= radius
    return near.reshape(shape)


def test_a_segment_gets_a_surface_on_its_wall():
    spacing = numpy.array([0.5, 0.5, 1.0])
    begin, end = [20, 20, 10], [30, 24, 50]  # (i, j, k)
    voxels = tube((60, 50, 50), begin, end, 4, spacing).astype(numpy.uint8)
    matrix = oblique(spacing)
    surface, centerline = vmesh_vtk.surface_of_segmentation(3 * voxels, matrix, {"around": 8})
    expect_closed(surface)
    ends = [(matrix @ [*place, 1])[:3] for place in (begin, end)]
    off = distances(points(surface), *ends)
    assert abs(off - 4).mean() < 0.25 and abs(off - 4).max() < 1.2, (abs(off - 4).mean(), abs(off - 4).max())
    of_voxels = voxels.sum() * spacing.prod()
    assert abs(volume(surface) / of_voxels - 1) < 0.05, (volume(surface), of_voxels)
    middle = distances(points(centerline), *ends)
    assert centerline.GetNumberOfLines() > 0 and middle.max() < 0.5, middle.max()


def test_a_vessel_that_the_border_cuts_ends_there():
    spacing = numpy.ones(3)
    voxels = tube((30, 30, 40), [0, 15, 15], [30, 15, 15], 4, spacing)
    surface, _ = vmesh_vtk.surface_of_segmentation(voxels, numpy.eye(4), {"ends": "open"})
    cut = points(surface)[:, 0].min()
    assert -1 < cut < 1, cut  # without a border it would be round, 4 mm farther
    edges = vtk.vtkFeatureEdges()
    edges.SetInputData(surface)
    edges.FeatureEdgesOff()
    edges.Update()
    assert edges.GetOutput().GetNumberOfCells() > 5, "it is not open"


def test_mistakes_are_told_without_names_of_temporary_files():
    line = vmesh_vtk.curve([[0, 0, 0], [9, 0, 0]], [1, 1])
    refused("often", vmesh_vtk.surface_around, [line], {"max_error": "often"})
    refused("no lines", vmesh_vtk.surface_around, [vtk.vtkPolyData()], {})
    refused("2 points and 1 radii", vmesh_vtk.curve, [[0, 0, 0], [9, 0, 0]], [1])
    refused("empty", vmesh_vtk.surface_of_segmentation, numpy.zeros((9, 9, 9)), numpy.eye(4), {})
    refused("three dimensions", vmesh_vtk.surface_of_segmentation, numpy.zeros((9, 9)), numpy.eye(4), {})
    lines = vtk.vtkPolyData()
    lines.SetPoints(line.GetPoints())
    lines.SetLines(line.GetLines())
    refused("the centerline: there is no array", vmesh_vtk.surface_around, [lines], {})
    bad = vmesh_vtk.curve([[0, 0, 0], [9, 0, 0]], [1, numpy.nan])
    refused("curve 2", vmesh_vtk.surface_around, [line, bad], {})


def test_a_surface_beyond_its_budget_is_one_with_a_warning():
    told = []
    surface = vmesh_vtk.surface_of_files([TREE], {"budget": "vertices=50"}, warn=told.append)
    expect_closed(surface)
    assert len([line for line in told if "nothing is within the budget vertices=50" in line]) == 1, told


def test_progress_is_told_and_work_cancelled(folder):
    tree = os.path.join(folder, "tree.swc")
    subprocess.run([VMESH, "synth", "--vertices", "1560", "-o", tree, "--quiet"], check=True)
    told = []
    vmesh_vtk.surface_of_files([tree], {"around": 12}, progress=lambda stage, done: told.append((stage, done)))
    assert told and all(stage and 0 <= done <= 1 for stage, done in told), told

    def stop(stage, done):
        return False

    with unittest.mock.patch.object(tempfile, "tempdir", folder):
        before = os.listdir(folder)
        try:
            vmesh_vtk.surface_of_files([tree], {"around": 24, "max_error": "1%"}, progress=stop)
        except vmesh_command.Cancelled:
            pass
        else:
            raise AssertionError("not cancelled")
        assert os.listdir(folder) == before, "something is left"


def test_a_program_is_looked_for(folder):
    with unittest.mock.patch.dict(os.environ, VMESH_COMMAND="", PATH=os.path.dirname(VMESH)):
        assert vmesh_command.find_command() == VMESH
    with unittest.mock.patch.dict(os.environ, VMESH_COMMAND="", PATH=folder):
        assert vmesh_command.find_command() is None
        refused("was not found", vmesh_command.run, ["generate"])
    other = os.path.join(folder, "no program")
    refused("is no program", vmesh_command.run, ["generate"], command=other)


PROGRAM = """
import os, sys
sys.path[:0] = [{module!r}, {package!r}]
import vmesh, vmesh_command
assert vmesh_command.find_command() is None
told = []
vmesh_command.generate([{tree!r}], {output!r}, {options!r}, progress=lambda stage, done: told.append(done))
vmesh_command.convert_centerline([{tree!r}], {lines!r}, {{}})
for options, text in (({{"max_error": "often"}}, "often"), ({{"tree": True}}, "needs the command")):
    try:
        vmesh_command.generate([{tree!r}], {output!r} + "2", options)
    except vmesh_command.VmeshError as error:
        assert text in str(error), error
    else:
        raise AssertionError(text)
"""


def test_the_python_package_makes_the_same(folder):
    package = os.environ.get("VMESH_PACKAGE")
    if not package or not os.path.isdir(os.path.join(package, "vmesh")):
        print("not tested: built without the Python package")
        return
    options = {"around": 8, "max_error": "10%", "ends": "flat", "flow_extensions": 2, "output_space": "RAS"}
    output, lines = os.path.join(folder, "package.vtp"), os.path.join(folder, "lines.vtp")
    program = PROGRAM.format(module=MODULE, package=package, tree=TREE, output=output, lines=lines, options=options)
    environment = {**os.environ, "VMESH_COMMAND": "", "PATH": folder, "PYTHONDONTWRITEBYTECODE": "1"}
    subprocess.run([sys.executable, "-c", program], check=True, env=environment)
    expected = vmesh_vtk.surface_of_files([TREE], options)
    assert numpy.array_equal(points(vmesh_vtk._read(output)), points(expected))
    expected = vmesh_vtk.centerline_of_files([TREE])
    assert numpy.array_equal(points(vmesh_vtk._read(lines)), points(expected))


class Node(types.SimpleNamespace):
    """A node of Slicer's scene."""

    def IsA(self, name):
        return name in self.kinds

    def GetName(self):
        return "node"


def stand_ins(made):
    """Slicer's modules, with what the logic asks of them."""
    slicer, loadable = unittest.mock.MagicMock(), types.ModuleType("slicer.ScriptedLoadableModule")
    for name in ("", "Logic", "Widget"):
        setattr(loadable, "ScriptedLoadableModule" + name, type("ScriptedLoadableModule" + name, (), {}))
    slicer.util.startupEnvironment = lambda: {**os.environ, "LD_LIBRARY_PATH": ""}
    slicer.util.arrayFromMarkupsControlPoints = lambda node, world: numpy.array(node.points, float)
    slicer.mrmlScene.AddNewNodeByClass = lambda kind, name=None: made.setdefault(name, unittest.mock.MagicMock())
    slicer.mrmlScene.GenerateUniqueName = lambda name: name
    ids = unittest.mock.MagicMock()
    ids.GetNumberOfIds = lambda: 0
    with_ids = types.SimpleNamespace(**{name: getattr(vtk, name) for name in dir(vtk) if name.startswith("vtk")})
    with_ids.vtkIdList = lambda: ids
    return {
        "slicer": slicer,
        "slicer.ScriptedLoadableModule": loadable,
        "ctk": unittest.mock.MagicMock(),
        "qt": unittest.mock.MagicMock(),
        "vtk": with_ids,
    }


def surface_in(model):
    return model.SetAndObservePolyData.call_args[0][0]


def test_the_shell_hands_over_what_is_selected():
    made = {}
    with unittest.mock.patch.dict(sys.modules, stand_ins(made)):
        import VmeshSurface

        logic = VmeshSurface.VmeshSurfaceLogic()
        options = {"around": 7, "blend": 0.5, "elongation": 1, "max_error": "", "ends": "round", "radius": None}
        line = vmesh_vtk.curve([[50, 0, 0], [90, 0, 0]], [2, 2])
        model = Node(kinds=["vtkMRMLModelNode"], GetPolyData=lambda: line, GetParentTransformNode=lambda: None)
        surface = surface_in(logic.run(model, None, options))
        assert "node surface" in made and points(surface)[:, 0].min() > 45

        values = vtk.vtkDoubleArray()
        for radius in (2, 2):
            values.InsertNextValue(radius)
        measurement = types.SimpleNamespace(GetControlPointValues=lambda: values)
        curve = Node(
            kinds=["vtkMRMLMarkupsCurveNode"],
            points=[[50, 0, 0], [90, 0, 0]],
            GetMeasurement=lambda name: measurement if name == "Radius" else None,
        )
        output = unittest.mock.MagicMock()
        assert logic.run(curve, output, options) is output
        assert numpy.array_equal(points(surface_in(output)), points(surface))
        curve.GetMeasurement = lambda name: None
        refused("no measurement Radius", logic.run, curve, output, options)
        logic.run(curve, output, {**options, "radius": 2.0})
        assert numpy.array_equal(points(surface_in(output)), points(surface))

        logic._voxels = lambda node, segment: (tube((20, 20, 60), [10, 10, 10], [50, 10, 10], 4, 1), numpy.eye(4))
        segmentation = Node(kinds=["vtkMRMLSegmentationNode"])
        logic.run(segmentation, output, {**options, "radius": 1.0}, segment="Segment_1", tree=True)
        expect_closed(surface_in(output))
        assert surface_in(made["node centerline"]).GetNumberOfLines() > 0


for name, test in list(globals().items()):
    if name.startswith("test_"):
        with tempfile.TemporaryDirectory() as temporary:
            test(*([temporary] if test.__code__.co_argcount else []))
        print("passed:", name, flush=True)
