"""The programs that files are exchanged with. Each is a class that raises Absent where its program is not installed."""
import json
import os
import shutil
import warnings

import numpy

from report import Absent, Surface, Tree, expect, read_obj, read_text_ply, run

HERE = os.path.dirname(os.path.abspath(__file__))


def need(program, package):
    path = shutil.which(program)
    if not path:
        raise Absent(f"{program} is not installed (Debian: {package})")
    return path


class Vtk:
    """VTK by its Python bindings, which are Debian's."""

    name = "VTK"

    def __init__(self):
        try:
            import vtkmodules.all as vtk
            from vtkmodules.util import numpy_support
        except ImportError as error:
            raise Absent(f"VTK's Python bindings are not installed (Debian: python3-vtk9): {error}") from None
        self.vtk, self.arrays = vtk, numpy_support
        vtk.vtkObject.GlobalWarningDisplayOff()
        self.name = f"VTK {vtk.vtkVersion.GetVTKVersion()}"

    def poly_data(self, reader, path):
        reader = getattr(self.vtk, reader)()
        reader.SetFileName(path)
        reader.Update()
        data = reader.GetOutput()
        if isinstance(data, self.vtk.vtkMultiBlockDataSet):
            # A block for every primitive, that is for every patch.
            joined, blocks = self.vtk.vtkAppendPolyData(), data.NewIterator()
            while not blocks.IsDoneWithTraversal():
                joined.AddInputData(blocks.GetCurrentDataObject())
                blocks.GoToNextItem()
            joined.Update()
            data = joined.GetOutput()
        return data

    def values(self, data):
        """Name to values of all arrays that have one value each."""
        found = (data.GetArray(i) for i in range(data.GetNumberOfArrays()))
        return {a.GetName(): self.arrays.vtk_to_numpy(a) for a in found if a and a.GetNumberOfComponents() == 1}

    def text(self, data, name):
        array = data.GetFieldData().GetAbstractArray(name)
        return array.GetValue(0) if isinstance(array, self.vtk.vtkStringArray) else ""

    def cells(self, cells, size):
        ids = self.arrays.vtk_to_numpy(cells.GetConnectivityArray())
        expect(len(ids) == size * cells.GetNumberOfCells(), f"not all cells have {size} points")
        return ids.reshape(-1, size)

    def surface(self, reader, path):
        data = self.poly_data(reader, path)
        return Surface(
            self.arrays.vtk_to_numpy(data.GetPoints().GetData()).astype(float),
            self.cells(data.GetPolys(), 3),
            self.values(data.GetPointData()),
            self.values(data.GetCellData()),
            self.text(data, "UNIT"),
            self.text(data, "SPACE"),
        )

    def tree(self, path):
        data = self.poly_data("vtkXMLPolyDataReader", path)
        return Tree(
            self.arrays.vtk_to_numpy(data.GetPoints().GetData()),
            self.values(data.GetPointData())["MaximumInscribedSphereRadius"],
            self.cells(data.GetLines(), 2),
            self.text(data, "UNIT"),
            self.text(data, "SPACE"),
        )

    def make(self, points, cells, kind, of_points=None, of_faces=None):
        """Poly data with `cells` as polygons ("Polys") or lines ("Lines")."""
        vtk = self.vtk
        data, places, array = vtk.vtkPolyData(), vtk.vtkPoints(), vtk.vtkCellArray()
        places.SetData(self.arrays.numpy_to_vtk(numpy.ascontiguousarray(points, float), deep=True))
        data.SetPoints(places)
        for cell in cells:
            array.InsertNextCell(len(cell))
            for corner in cell:
                array.InsertCellPoint(int(corner))
        getattr(data, "Set" + kind)(array)
        for target, values in ((data.GetPointData(), of_points), (data.GetCellData(), of_faces)):
            for name, column in (values or {}).items():
                column = self.arrays.numpy_to_vtk(numpy.ascontiguousarray(column), deep=True)
                column.SetName(name)
                target.AddArray(column)
        return data

    def write(self, writer, data, path, **settings):
        """`settings` are the writer's: FileType=1 calls SetFileType(1)."""
        writer = getattr(self.vtk, writer)()
        writer.SetFileName(path)
        writer.SetInputData(data)
        for setting, value in settings.items():
            getattr(writer, "Set" + setting)(value)
        expect(writer.Write() != 0, f"VTK cannot write {path}")
        return path


class Meshio:
    """meshio, a converter of meshes in Python."""

    def __init__(self):
        try:
            import meshio
        except ImportError as error:
            raise Absent(f"meshio is not installed (Debian: python3-meshio): {error}") from None
        warnings.simplefilter("ignore")
        self.meshio = meshio
        self.name = f"meshio {meshio.__version__}"

    def surface(self, path):
        mesh = self.meshio.read(path)
        # One block, or one for each group of an OBJ file.
        expect({c.type for c in mesh.cells} == {"triangle"}, f"cells of the types {[c.type for c in mesh.cells]}")
        faces = numpy.concatenate([c.data for c in mesh.cells])
        return Surface(mesh.points, faces, dict(mesh.point_data), {})

    def write(self, surface, path, **options):
        mesh = self.meshio.Mesh(surface.points, [("triangle", surface.faces)])
        self.meshio.write(path, mesh, **options)
        return path


class Assimp:
    """The command of assimp, through its export to OBJ, which has scenes' nodes applied and nine digits."""

    def __init__(self, folder):
        self.command, self.folder = need("assimp", "assimp-utils"), folder
        self.name = "assimp " + run([self.command, "version"]).split("Version ")[1].split()[0]

    def surface(self, path):
        return read_obj(self.export(path, os.path.join(self.folder, "assimp.obj")))

    def bones(self, path):
        told = run([self.command, "info", path])
        return int(next(line for line in told.splitlines() if line.startswith("Bones:")).split()[1])

    def export(self, path, out, *options):
        run([self.command, "export", path, out, *options])
        expect(os.path.exists(out), f"assimp exported no {out}")
        return out


class Three:
    """three.js in node, with its loaders (three_reader.mjs)."""

    folder = os.path.join(HERE, "..", "..", "build", "node_modules", "three")

    def __init__(self):
        self.node = need("node", "nodejs")
        if not os.path.exists(os.path.join(self.folder, "package.json")):
            raise Absent("three.js is not there (scripts/fetch-three)")
        self.name = "three.js r" + self.call("version")

    def call(self, *arguments):
        return json.loads(run([self.node, os.path.join(HERE, "three_reader.mjs"), self.folder, *arguments]))

    def surface(self, path, *pose):
        """With a file of joints' poses, bent by them."""
        told = self.call("read", path, *pose)
        surface = Surface(
            numpy.array(told["points"], float).reshape(-1, 3),
            numpy.array(told["faces"], int).reshape(-1, 3),
            {name: numpy.array(values, float) for name, values in told["attributes"].items()},
        )
        return surface, told["bones"]


class MeshLab:
    """meshlabserver, which wants a display: a virtual one."""

    def __init__(self, folder):
        self.command, self.folder = [need("xvfb-run", "xvfb"), "-a", need("meshlabserver", "meshlab")], folder
        need("xauth", "xauth")
        self.name = "MeshLab"

    def convert(self, path, out, *keep):
        run([*self.command, "-i", path, "-o", out, *(["-m", *keep] if keep else [])])
        expect(os.path.exists(out), f"MeshLab wrote no {out}")
        return out

    def surface(self, path):
        """With colours and quality, where the file has them."""
        out = self.convert(path, os.path.join(self.folder, "meshlab.ply"), "vc", "vq", "sa")
        surface = read_text_ply(out)
        with open(out) as file:
            lines = file.read().splitlines()
        names = [w[-1] for w in (line.split() for line in lines[: lines.index("end_header")]) if w[0] == "property"]
        start = lines.index("end_header") + 1
        rows = numpy.array([line.split() for line in lines[start : start + len(surface.points)]], float)
        surface.of_points = {n: rows[:, i] for i, n in enumerate(names[: rows.shape[1]]) if n not in ("x", "y", "z")}
        return surface


class Gmsh:
    """Gmsh, through its own format in text."""

    def __init__(self, folder):
        self.command, self.folder = need("gmsh", "gmsh"), folder
        self.name = "Gmsh " + run([self.command, "-info"]).split(":")[1].split()[0]

    def surface(self, path):
        out = os.path.join(self.folder, "gmsh.msh")
        run([self.command, path, "-0", "-format", "msh2", "-o", out])
        with open(out) as file:
            lines = file.read().splitlines()
        nodes = self.section(lines, "$Nodes")
        number = {row[0]: i for i, row in enumerate(nodes)}
        faces = [row[-3:] for row in self.section(lines, "$Elements") if row[1] == "2"]
        return Surface(
            numpy.array([row[1:4] for row in nodes], float).reshape(-1, 3),
            numpy.array([[number[node] for node in face] for face in faces], int).reshape(-1, 3),
        )

    def section(self, lines, name):
        start = lines.index(name)
        return [line.split() for line in lines[start + 2 : start + 2 + int(lines[start + 1])]]


class TetGen:
    """TetGen: the boundary of the tetrahedra with which it fills a surface, without points of its own there."""

    def __init__(self, folder):
        self.command, self.folder = need("tetgen", "tetgen"), folder
        self.name = "TetGen 1.5"

    def surface(self, path):
        copy = os.path.join(self.folder, "tetgen" + os.path.splitext(path)[1])
        shutil.copyfile(path, copy)
        run([self.command, "-pYQz", copy])
        points = self.rows("tetgen.1.node")[:, 1:4]
        faces = self.rows("tetgen.1.face")[:, 1:4].astype(int)
        return Surface(points, faces[:, ::-1])  # which face inwards

    def rows(self, name):
        path = os.path.join(self.folder, name)
        expect(os.path.exists(path), f"TetGen wrote no {name}")
        return numpy.loadtxt(path, skiprows=1)
