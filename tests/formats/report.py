"""What arrives where: surfaces and centerlines as plain arrays, their comparison, and the table of it."""
import json
import os
import subprocess
from dataclasses import dataclass, field

import numpy

DOUBLE = 2.0**-52  # relative, of numbers that pass through doubles and their shortest text
FLOAT = 2.0**-23  # the same of single precision
SIX_DIGITS = 1e-5  # the same of six digits, which some programs print
CLEANED = 6e-7  # mm; cleaning rounds to 1e-6 mm


class Wrong(Exception):
    """What arrived is not what was written."""


class Absent(Exception):
    """A program is not there."""


@dataclass
class Surface:
    """Points (n x 3), triangles (m x 3), attributes by name, one value per point or per triangle."""

    points: numpy.ndarray
    faces: numpy.ndarray
    of_points: dict = field(default_factory=dict)
    of_faces: dict = field(default_factory=dict)
    unit: str = ""
    space: str = ""


@dataclass
class Tree:
    """A centerline: points (n x 3), a radius each, segments (m x 2)."""

    points: numpy.ndarray
    radii: numpy.ndarray
    segments: numpy.ndarray
    unit: str = ""
    space: str = ""


def run(command, **options):
    """Runs a program and returns what it printed. Wrong if it fails."""
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, errors="replace", **options)
    if done.returncode != 0:
        raise Wrong(
            f"{' '.join(map(str, command))}: exit code {done.returncode}\n{done.stdout[-500:]}{done.stderr[-1500:]}"
        )
    return done.stdout


class Vmesh:
    """The command. Files are named within `folder`."""

    def __init__(self, command, folder):
        self.command, self.folder = command, folder
        version = json.loads(self("info", self.make_tree(), "--json", "-"))
        self.version = version["generator"]["version"]

    def make_tree(self):
        self("synth", "--vertices", 60, "--seed", 3, "-o", self.path("tree.json"))
        return self.path("tree.json")

    def path(self, name):
        return os.path.join(self.folder, name)

    def __call__(self, *arguments):
        return run([self.command, *arguments])

    def surface(self, path, *options):
        """What vmesh reads of a surface, by way of its PLY."""
        self("convert", path, "-o", self.path("arrived.ply"), *options)
        surface = read_ply(self.path("arrived.ply"))
        told = json.loads(self("info", path, "--json", "-", *options))
        surface.unit, surface.space = told.get("unit_in_file", ""), told.get("space_in_file", "")
        return surface

    def tree(self, *paths_and_options):
        """What vmesh reads of a centerline, by way of its JSON."""
        self("convert", *paths_and_options, "-o", self.path("arrived.json"))
        tree = read_json_tree(self.path("arrived.json"))
        told = json.loads(self("info", *paths_and_options, "--json", "-"))
        tree.unit, tree.space = told.get("unit_in_file", ""), told.get("space_in_file", "")
        return tree


PLY_TYPES = {"double": "<f8", "float": "<f4", "int": "<i4", "uchar": "u1"}


def read_ply(path):
    """A binary PLY of triangles with any scalar attributes, by its specification (G. Turk, 1994)."""
    with open(path, "rb") as file:
        content = file.read()
    header, _, data = content.partition(b"end_header\n")
    lines = header.decode().splitlines()
    if lines[:2] != ["ply", "format binary_little_endian 1.0"]:
        raise Wrong(f"{path}: no binary PLY")
    comments = dict(line[8:].split("=", 1) for line in lines if line.startswith("comment ") and "=" in line.split()[1])
    tables, at = {}, 0
    for line in lines:
        words = line.split()
        if words[0] == "element":
            tables[words[1]] = (int(words[2]), [])
        elif words[0] == "property":
            fields = tables[next(reversed(tables))][1]
            if words[1] == "list":
                fields += [("count", "u1"), ("corners", "<i4", (3,))]
            else:
                fields.append((words[-1], PLY_TYPES[words[1]]))
    arrays = {}
    for name, (count, fields) in tables.items():
        arrays[name] = numpy.frombuffer(data, numpy.dtype(fields), count, at)
        at += arrays[name].nbytes
    if at != len(data):
        raise Wrong(f"{path}: {len(data) - at} bytes too many")
    vertex, face = arrays["vertex"], arrays["face"]
    own = {"x", "y", "z", "nx", "ny", "nz", "count", "corners"}
    called = next((line.split()[-1] for line in lines if line.startswith("comment face quality is ")), "quality")
    return Surface(
        numpy.stack([vertex[c] for c in "xyz"], 1),
        face["corners"],
        {n: vertex[n] for n in vertex.dtype.names if n not in own},
        {called if n == "quality" else n: face[n] for n in face.dtype.names if n not in own},
        comments.get("UNIT", ""),
        comments.get("SPACE", ""),
    )


def read_json_tree(path):
    with open(path) as file:
        content = json.load(file)
    nodes = numpy.array(content["nodes"], float)
    return Tree(nodes[:, :3], nodes[:, 3], numpy.array(content["segments"], int), content["unit"], content["space"])


def read_obj(path):
    """Positions and triangles of an OBJ."""
    with open(path) as file:
        rows = [line.split() for line in file]
    points = numpy.array([row[1:4] for row in rows if row[:1] == ["v"]], float)
    faces = [[int(corner.split("/")[0]) - 1 for corner in row[1:]] for row in rows if row[:1] == ["f"]]
    expect(all(len(face) == 3 for face in faces), f"{path}: not all faces are triangles")
    return Surface(points, numpy.array(faces, int))


def read_text_ply(path):
    """A PLY as MeshLab exports it in text: positions first, then polygons, which are triangles."""
    with open(path) as file:
        lines = file.read().splitlines()
    end = lines.index("end_header")
    counts = {w[1]: int(w[2]) for w in (line.split() for line in lines[:end]) if w[0] == "element"}
    body = lines[end + 1 :]
    points = numpy.array([line.split()[:3] for line in body[: counts["vertex"]]], float)
    faces = [line.split() for line in body[counts["vertex"] : counts["vertex"] + counts["face"]]]
    return Surface(points, numpy.array([f[1:4] for f in faces if f[0] == "3"], int))


def triangles(surface):
    """Corners of all triangles (m x 3 x 3), each turned so that its least corner comes first."""
    corners = surface.points[surface.faces]
    first = numpy.lexsort(numpy.moveaxis(corners, 2, 0)[::-1], axis=1)[:, 0]
    turned = [numpy.take_along_axis(corners, ((first + k) % 3)[:, None, None], 1) for k in range(3)]
    return numpy.concatenate(turned, 1)


def sorted_rows(rows, digits):
    """The same rows in an order that does not depend on what lies beyond `digits` places."""
    rounded = numpy.round(rows, digits) + 0.0
    return rows[numpy.lexsort(rounded.T[::-1])]


def expect(holds, what):
    if not holds:
        raise Wrong(what)


def expect_near(arrived, written, tolerance, what):
    arrived, written = numpy.asarray(arrived, float), numpy.asarray(written, float)
    expect(arrived.shape == written.shape, f"{what}: {arrived.shape} arrived, {written.shape} were written")
    off = numpy.abs(arrived - written).max() if written.size else 0
    expect(off <= tolerance, f"{what}: off by {off:.3g}, {tolerance:.3g} are allowed")


def expect_same_surface(arrived, written, tolerance, names=(), face_names=(), keeps_order=True):
    """The same triangles with the same orientation, `tolerance` relative to the largest coordinate; attributes of these
    names with the same values. Without `keeps_order`, points may be merged, repeated and numbered anew."""
    allowed = tolerance * numpy.abs(written.points).max()
    if keeps_order:
        expect_near(arrived.points, written.points, allowed, "points")
        expect(numpy.array_equal(arrived.faces, written.faces), "the faces are others")
    else:
        expect(
            len(arrived.faces) == len(written.faces),
            f"{len(arrived.faces)} faces arrived, {len(written.faces)} were written",
        )
        places = 6 if allowed < 1e-6 else 3
        a, b = (sorted_rows(triangles(s).reshape(-1, 9), places) for s in (arrived, written))
        expect_near(a, b, allowed, "triangles")
    for which, wanted in (("of_points", names), ("of_faces", face_names)):
        for name in wanted:
            got = getattr(arrived, which)
            expect(name in got, f"{name} did not arrive; there are {', '.join(got)}")
            values = getattr(written, which)[name]
            expect_near(got[name], values, tolerance * numpy.abs(values).max(), name)


def expect_same_tree(arrived, written, tolerance):
    """The same segments between the same points, numbered in any way, within `tolerance` mm."""

    def rows(tree):
        ends = numpy.concatenate([tree.points, tree.radii[:, None]], 1)[tree.segments]
        turned = numpy.lexsort(numpy.moveaxis(numpy.round(ends, 4) + 0.0, 2, 0)[::-1], axis=1)
        return sorted_rows(numpy.take_along_axis(ends, turned[:, :, None], 1).reshape(-1, 8), 4)

    expect(
        len(arrived.points) == len(written.points),
        f"{len(arrived.points)} points arrived, {len(written.points)} were written",
    )
    expect_near(rows(arrived), rows(written), tolerance, "segments")


KINDS = {
    "centerline": (
        (".swc", ".csv", ".json", ".mrk.json", ".ctgr", ".pth", ".gxl", ".am", ".dat", ".vmv", ".h5")
        + (".graphml", ".gexf", ".tre")
    ),
    "image": (),
    "volume": (),
}


class Table:
    """One row per format, way and program; beside it what went wrong and what was left out."""

    def __init__(self):
        self.rows, self.failures, self.notes = [], [], []

    def check(self, form, way, program, action):
        """Runs `action`, which returns (points, faces, names, unit and frame) or raises Wrong."""
        try:
            points, faces, names, place = action()
            self.rows.append((form, way, program, str(points), str(faces), names or "-", place or "-"))
        except Wrong as wrong:
            self.failures.append(f"{form} {way} {program}: {wrong}")
            self.rows.append((form, way, program, "**wrong**", "", "", ""))

    def markdown(self):
        """All rows."""
        head = ("format", "way", "program", "points", "faces or segments", "names", "unit, frame")
        lines = ["| " + " | ".join(head) + " |", "|---|---|---|--:|--:|---|---|"]
        return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in self.rows])

    def digest(self):
        """One row per format, way and kind of content: the programs, and what arrives at best."""
        groups = {}
        for form, way, program, points, faces, names, place in self.rows:
            ways = way.split(", ")
            kind = next((k for k in KINDS if k in ways or form in KINDS.get(k, ())), "surface")
            details = ", ".join(w for w in ways[1:] if w != kind)
            group = groups.setdefault((ways[0], kind, form), {"programs": {}, "names": "-", "places": []})
            known = group["programs"].setdefault("files of others" if program.startswith("as ") else program, [])
            known.append(
                "**wrong**" if points == "**wrong**" else "refused: " + details if points == "refused" else details
            )
            if not program.startswith("as ") and points != "refused":
                group["names"] = max(group["names"], names, key=lambda text: (text.count(","), len(text)))
                group["places"] += [place] if place not in ("", "-", *group["places"]) else []
        lines = ["| format | way | what | programs | names of attributes | unit, frame |", "|---|---|---|---|---|---|"]
        for (way, kind, form), group in sorted(
            groups.items(), key=lambda item: (item[0][0] == "in", item[0][1], item[0][2])
        ):
            programs = (
                p + (f" ({'; '.join(filter(None, d))})" if any(d) else "") for p, d in group["programs"].items()
            )
            lines.append(
                f"| `{form}` | {way} | {kind} | {', '.join(programs)} | {group['names']} | "
                f"{'; '.join(group['places']) or '-'} |"
            )
        return "\n".join(lines)
