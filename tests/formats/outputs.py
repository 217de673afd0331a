"""What vmesh writes, opened by other programs."""
import csv
import json

import numpy

import volumes
from report import (
    CLEANED,
    DOUBLE,
    FLOAT,
    SIX_DIGITS,
    Surface,
    Tree,
    expect,
    expect_near,
    expect_same_surface,
    expect_same_tree,
    read_json_tree,
    read_ply,
)

NORMAL_NAMES = ("radius", "segment", "parameter", "branch")
VTK_NAMES = {
    "MaximumInscribedSphereRadius": "radius",
    "segment": "segment",
    "parameter": "parameter",
    "branch": "branch",
}
FACE_NAMES = ("EquiangleSkewness", "branch", "ModelFaceID", "CapID")


def list_names(*groups):
    return ", ".join(name for group in groups for name in group)


def y_up_metres(points):
    return 1e-3 * numpy.stack([points[:, 0], points[:, 2], -points[:, 1]], 1)


class Written:
    """A small tree and the surface around it with flat caps, in every format that vmesh writes."""

    def __init__(self, vmesh):
        self.vmesh, path = vmesh, vmesh.path
        self.known_volumes = None
        vmesh("generate", path("tree.json"), path("wall.ply"), "--ends", "flat")
        vmesh("convert", path("wall.ply"), path("points.ply"), "--attributes", "vertex")
        vmesh("convert", path("wall.ply"), path("cm.ply"), "--output-unit", "cm", "--output-space", "RAS")
        for ending in ("stl", "obj", "off", "glb", "3mf"):
            vmesh("convert", path("wall.ply"), path("wall." + ending))
        vmesh("generate", path("tree.json"), path("skin.ply"))
        vmesh("generate", path("tree.json"), path("skin.glb"), "--bones")
        for ending in ("ply", "stl"):
            vmesh("convert", path("wall.ply"), path("text." + ending), "--ascii")
        for ending in ("swc", "csv"):
            vmesh("convert", path("tree.json"), path("tree." + ending))
        self.with_vtk = "built without VTK" not in self.try_vtp()
        self.wall, self.skin = read_ply(path("wall.ply")), read_ply(path("skin.ply"))
        self.tree = read_json_tree(path("tree.json"))
        self.in_metres = Surface(y_up_metres(self.wall.points), self.wall.faces)

    def volumes(self):
        """Written when they are asked for."""
        self.known_volumes = self.known_volumes or volumes.Volumes(self.vmesh)
        return self.known_volumes

    def try_vtp(self):
        path = self.vmesh.path
        try:
            self.vmesh("convert", path("wall.ply"), path("wall.vtp"))
            self.vmesh("convert", path("wall.ply"), path("cm.vtp"), "--output-unit", "cm", "--output-space", "RAS")
            self.vmesh("convert", path("tree.json"), path("tree.vtp"))
        except Exception as error:  # said by the caller where it matters
            return str(error)
        return ""

    def counts(self, names, place):
        return len(self.wall.points), len(self.wall.faces), names, place


def check_vtk(table, vtk, written):
    path, wall = written.vmesh.path, written.wall

    def vtp(name, scale, turn, unit, space):
        there = vtk.surface("vtkXMLPolyDataReader", path(name))
        for theirs, ours in VTK_NAMES.items():
            expect(theirs in there.of_points, f"{theirs} did not arrive")
            there.of_points[ours] = there.of_points[theirs]
        lengths = {"radius": wall.of_points["radius"] * scale}
        moved = Surface(wall.points * numpy.array(turn) * scale, wall.faces, wall.of_points | lengths, wall.of_faces)
        expect_same_surface(there, moved, DOUBLE, NORMAL_NAMES, FACE_NAMES)
        expect((there.unit, there.space) == (unit, space), f"unit and frame are {there.unit}, {there.space}")
        return written.counts(list_names(VTK_NAMES, FACE_NAMES), f"{unit}, {space} (field data)")

    def plain(reader, name, tolerance, keeps_order=True, expected=wall, names=(), place=""):
        there = vtk.surface(reader, path(name))
        expect_same_surface(there, expected, tolerance, names, (), keeps_order)
        return len(there.points), len(there.faces), list_names(names), place

    def tree():
        there = vtk.tree(path("tree.vtp"))
        expect_same_tree(there, written.tree, CLEANED)
        expect((there.unit, there.space) == ("mm", "LPS"), f"unit and frame are {there.unit}, {there.space}")
        return len(there.points), len(there.segments), "MaximumInscribedSphereRadius", "mm, LPS (field data)"

    if written.with_vtk:
        table.check(".vtp", "out", vtk.name, lambda: vtp("wall.vtp", 1, (1, 1, 1), "mm", "LPS"))
        table.check(".vtp", "out, cm and RAS", vtk.name, lambda: vtp("cm.vtp", 0.1, (-1, -1, 1), "cm", "RAS"))
        table.check(".vtp", "out, centerline", vtk.name, tree)
    table.check(".ply", "out", vtk.name, lambda: plain("vtkPLYReader", "wall.ply", FLOAT))
    table.check(".stl", "out", vtk.name, lambda: plain("vtkSTLReader", "wall.stl", FLOAT, False))
    table.check(".obj", "out", vtk.name, lambda: plain("vtkOBJReader", "wall.obj", FLOAT))
    table.check(
        ".glb",
        "out",
        vtk.name,
        lambda: plain("vtkGLTFReader", "wall.glb", 2 * FLOAT, False, written.in_metres, (), "m, y up (the format's)"),
    )


def check_meshio(table, meshio, written):
    def surface(name, tolerance, keeps_order=True, names=(), expected=written.wall):
        there = meshio.surface(written.vmesh.path(name))
        expect_same_surface(there, expected, tolerance, names, (), keeps_order)
        return len(there.points), len(there.faces), list_names(names), ""

    # Colours arrive as well, as signed bytes.
    table.check(
        ".ply",
        "out, `--attributes vertex`",
        meshio.name,
        lambda: surface("points.ply", DOUBLE, True, (*NORMAL_NAMES, "quality")),
    )
    table.check(".stl", "out", meshio.name, lambda: surface("wall.stl", FLOAT, False))
    table.check(".obj", "out", meshio.name, lambda: surface("wall.obj", DOUBLE))
    table.check(".off", "out", meshio.name, lambda: surface("wall.off", DOUBLE))


def check_assimp(table, assimp, written):
    path = written.vmesh.path

    def surface(name, expected, place=""):
        there = assimp.surface(path(name))
        expect_same_surface(there, expected, 2 * FLOAT, (), (), False)
        return len(there.points), len(there.faces), "", place

    def bones():
        found = assimp.bones(path("skin.glb"))
        # Three a segment and one for the root; those that no vertex needs it does not count.
        expect(0 < found <= 3 * len(written.tree.segments) + 1, f"{found} bones")
        points, faces, _, place = surface(
            "skin.glb", Surface(y_up_metres(written.skin.points), written.skin.faces), "m, y up (the format's)"
        )
        return points, faces, f"{found} bones", place

    for ending in ("ply", "stl", "obj", "off"):
        table.check("." + ending, "out", assimp.name, lambda ending=ending: surface("wall." + ending, written.wall))
    table.check(".3mf", "out", assimp.name, lambda: surface("wall.3mf", written.wall, "mm"))
    table.check(".glb", "out", assimp.name, lambda: surface("wall.glb", written.in_metres, "m, y up (the format's)"))
    table.check(".glb", "out, `--bones`", assimp.name, bones)


def check_three(table, three, written, bent_tree):
    path = written.vmesh.path

    def surface(name, keeps_order=True, expected=written.wall, place=""):
        there, _ = three.surface(path(name))
        expect_same_surface(there, expected, 2 * FLOAT, (), (), keeps_order)
        return len(there.points), len(there.faces), "", place

    def scene():
        there, _ = three.surface(path("wall.glb"))
        there.of_points = {name[1:]: values for name, values in there.of_points.items()}
        expect_same_surface(
            there,
            Surface(written.in_metres.points, written.wall.faces, written.wall.of_points),
            2 * FLOAT,
            NORMAL_NAMES,
        )
        expect("olor" in there.of_points, "no colours")
        return written.counts(
            list_names(["colours"], ["_" + n.upper() for n in NORMAL_NAMES]), "m, y up (the format's)"
        )

    def bent():
        bent_tree(path("tree.json"), path("skin.ply"), path("pose.json"))
        with open(path("pose.json")) as file:
            pose = json.load(file)
        there, bones = three.surface(path("skin.glb"), path("pose.json"))
        expect(bones == len(pose["joints"]) == 3 * len(written.tree.segments) + 1, f"{bones} bones")
        deformed = y_up_metres(numpy.array(pose["vertices"]))
        moved = numpy.linalg.norm(deformed - y_up_metres(written.skin.points), axis=1).max()
        expect(moved > 0.005, f"the tree is bent by no more than {moved} m")
        off = numpy.linalg.norm(there.points - deformed, axis=1) / (1e-3 * numpy.array(pose["radii"]))
        expect(off.max() <= 1e-5, f"off by {off.max():.2g} radii of the deformer's surface, 1e-5 are allowed")
        return (
            len(there.points),
            len(there.faces),
            f"{bones} bones, off by {off.max():.1g} radii",
            "m, y up (the format's)",
        )

    table.check(".ply", "out", three.name, lambda: surface("wall.ply"))
    table.check(".stl", "out", three.name, lambda: surface("wall.stl", False))
    table.check(".obj", "out", three.name, lambda: surface("wall.obj", False))
    table.check(".glb", "out", three.name, scene)
    table.check(".glb", "out, `--bones`: bent as the deformer bends it", three.name, bent)


def check_mesher(table, mesher, written):
    """Programs that fill surfaces for simulations; those of them tested here read PLY as text only."""

    def surface(name):
        there = mesher.surface(written.vmesh.path(name))
        expect_same_surface(there, written.wall, DOUBLE, (), (), False)
        return len(there.points), len(there.faces), "", ""

    for ending in ("ply", "stl"):
        table.check("." + ending, "out, `--ascii`", mesher.name, lambda ending=ending: surface("text." + ending))


def check_meshlab(table, meshlab, written):
    def surface(name, names=()):
        there = meshlab.surface(written.vmesh.path(name))
        expect_same_surface(there, written.wall, SIX_DIGITS, names, (), False)
        return len(there.points), len(there.faces), list_names(names), ""

    table.check(".ply", "out", meshlab.name, lambda: surface("wall.ply", ("red", "green", "blue", "quality")))
    # Debian's MeshLab aborts on every OBJ, of its own too: an assertion in its reader.
    for ending in ("stl", "off"):
        table.check("." + ending, "out", meshlab.name, lambda ending=ending: surface("wall." + ending))


def check_text(table, written):
    """Centerlines in text, by Python's own readers and NumPy's; PLY by its specification."""
    path = written.vmesh.path

    def swc():
        rows = numpy.loadtxt(path("tree.swc"))
        expect(numpy.array_equal(rows[:, 0], numpy.arange(1, len(rows) + 1)), "the numbers have gaps")
        joined = rows[rows[:, 6] > 0]
        there = Tree(rows[:, 2:5], rows[:, 5], joined[:, [0, 6]].astype(int) - 1)
        expect_same_tree(there, written.tree, CLEANED)
        return len(rows), len(joined), "radius", "mm, LPS (comments)"

    def pair():
        def rows(name):
            with open(path(name)) as file:
                return list(csv.DictReader(line for line in file if not line.startswith("#")))

        nodes, segments = rows("tree.csv"), rows("tree.segments.csv")
        there = Tree(
            numpy.array([[float(n[c]) for c in "xyz"] for n in nodes]),
            numpy.array([float(n["radius"]) for n in nodes]),
            numpy.array([[int(s["a"]), int(s["b"])] for s in segments]),
        )
        expect_same_tree(there, written.tree, CLEANED)
        return len(nodes), len(segments), "radius", "mm, LPS (comments)"

    def ply(name, unit, space, scale, turn):
        there = read_ply(path(name))
        expect_near(
            there.points,
            written.wall.points * numpy.array(turn) * scale,
            DOUBLE * numpy.abs(written.wall.points).max(),
            "points",
        )
        expect((there.unit, there.space) == (unit, space), f"unit and frame are {there.unit}, {there.space}")
        return (
            len(there.points),
            len(there.faces),
            list_names(there.of_points, there.of_faces),
            f"{unit}, {space} (comments)",
        )

    table.check(".ply", "out", "NumPy", lambda: ply("wall.ply", "mm", "LPS", 1, (1, 1, 1)))
    table.check(".ply", "out, cm and RAS", "NumPy", lambda: ply("cm.ply", "cm", "RAS", 0.1, (-1, -1, 1)))
    table.check(".swc", "out", "NumPy", swc)
    table.check(".csv", "out", "Python's csv", pair)
    table.check(
        ".json",
        "out",
        "Python's json",
        lambda: (
            len(written.tree.points),
            len(written.tree.segments),
            "radius",
            f"{written.tree.unit}, {written.tree.space}",
        ),
    )
