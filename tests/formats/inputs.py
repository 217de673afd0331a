"""What other programs write, and small files after the documentation of others, read by vmesh."""
import os

import numpy

import small_files as small
from outputs import FACE_NAMES, NORMAL_NAMES, VTK_NAMES, list_names
from report import (
    CLEANED,
    DOUBLE,
    FLOAT,
    SIX_DIGITS,
    Absent,
    Surface,
    Tree,
    Wrong,
    expect,
    expect_near,
    expect_same_surface,
    expect_same_tree,
)


CENTERLINE_TEXT = 1e-4  # mm: six digits of coordinates below 100


def check_surface(table, form, program, written, make, tolerance, keeps_order=True, names=(), face_names=(), way="in"):
    """`make` writes the wall with another program and returns the path and what it wrote."""

    def action():
        path, expected, place = make()
        there = written.vmesh.surface(path)
        expect_same_surface(there, expected, tolerance, names, face_names, keeps_order)
        return len(there.points), len(there.faces), list_names(names, face_names), place

    table.check(form, way, program, action)


def check_tree(
    table, form, program, vmesh, make, expected=small.TREE, tolerance=CLEANED, options=(), place="", way="in"
):
    """What `make` writes is the tree, and goes to a sound surface in one command."""

    def action():
        paths = make()
        read = [*([paths] if isinstance(paths, str) else paths), *options]
        there = vmesh.tree(*read)
        expect_same_tree(there, expected, tolerance)
        vmesh("generate", *read, "-o", vmesh.path("grown.ply"), "--check")
        return len(there.points), len(there.segments), "radius", place or "not said"

    table.check(form, way, program, action)


def check_vtk(table, vtk, written, shared_data):
    path, wall = written.vmesh.path, written.wall
    theirs = {name: wall.of_points[ours] for name, ours in VTK_NAMES.items()}
    data = vtk.make(wall.points, wall.faces, "Polys", theirs, wall.of_faces)

    def surface(
        form,
        writer,
        tolerance,
        keeps_order=True,
        names=(),
        face_names=(),
        way="in",
        source=data,
        expected=wall,
        **settings,
    ):
        name = path("by_vtk" + form)
        check_surface(
            table,
            form,
            vtk.name,
            written,
            lambda: (vtk.write(writer, source, name, **settings), expected, "not said"),
            tolerance,
            keeps_order,
            names,
            face_names,
            way,
        )

    for mode, word in ((0, "text"), (1, "binary"), (2, "appended")):
        surface(".vtp", "vtkXMLPolyDataWriter", DOUBLE, True, NORMAL_NAMES, FACE_NAMES, f"in, {word}", DataMode=mode)
    surface(".vtp", "vtkXMLPolyDataWriter", DOUBLE, True, NORMAL_NAMES, FACE_NAMES, "in, uncompressed", CompressorType=0)
    for kind, word in ((2, "LZ4"), (3, "LZMA")):
        name = vtk.write("vtkXMLPolyDataWriter", data, path("packed.vtp"), CompressorType=kind)
        table.check(
            ".vtp", f"in, {word}", vtk.name, lambda name=name: refused(written.vmesh, name, "save it with zlib")
        )
    for kind, word in ((1, "text"), (2, "binary")):
        surface(
            ".vtk",
            "vtkPolyDataWriter",
            DOUBLE if kind == 2 else SIX_DIGITS,
            True,
            NORMAL_NAMES,
            FACE_NAMES,
            f"in, {word}",
            FileType=kind,
        )
        surface(".ply", "vtkPLYWriter", FLOAT if kind == 2 else SIX_DIGITS, True, way=f"in, {word}", FileType=kind)
        surface(".stl", "vtkSTLWriter", FLOAT if kind == 2 else SIX_DIGITS, False, way=f"in, {word}", FileType=kind)
    stripper = vtk.vtk.vtkStripper()
    stripper.SetInputData(vtk.make(wall.points, wall.faces, "Polys"))
    stripper.Update()
    expect(stripper.GetOutput().GetNumberOfStrips() > 0, "VTK made no strips")
    surface(".vtk", "vtkPolyDataWriter", DOUBLE, False, way="in, strips", source=stripper.GetOutput(), FileType=2)
    surface(".obj", "vtkOBJWriter", SIX_DIGITS)

    tree = written.tree
    radii = {"MaximumInscribedSphereRadius": tree.radii}
    lines = vtk.make(tree.points, tree.segments, "Lines", radii)
    for form, writer, kind, word in (
        (".vtp", "vtkXMLPolyDataWriter", "DataMode", "appended"),
        (".vtk", "vtkPolyDataWriter", "FileType", "binary"),
    ):
        check_tree(
            table,
            form,
            vtk.name,
            written.vmesh,
            lambda form=form, writer=writer, kind=kind: vtk.write(writer, lines, path("lines" + form), **{kind: 2}),
            tree,
            CLEANED,
            (),
            "",
            f"in, centerline, {word}",
        )
    check_tree(
        table,
        ".vtk",
        vtk.name,
        written.vmesh,
        lambda: vtk.write("vtkPolyDataWriter", lines, path("lines.vtk"), FileType=1),
        tree,
        CENTERLINE_TEXT,
        (),
        "",
        "in, centerline, text",
    )
    check_shared_surfaces(table, vtk, written, shared_data)


def refused(vmesh, path, hint):
    try:
        vmesh("info", path)
    except Wrong as wrong:
        expect(hint in str(wrong), f"it is refused without {hint!r}: {wrong}")
        return "refused", "refused", "", f"it says: {hint}"
    raise Wrong("it is read, and the table says that it is not")


def check_shared_surfaces(table, vtk, written, shared_data):
    """Surfaces of others: vmesh has what VTK's reader has."""
    folder = os.path.join(shared_data, "pairs_centerline_surface")
    if not os.path.isdir(folder):
        table.notes.append("SKIPPED shared data: its folder is not there")
        return
    for name, reader, names in (
        ("generate-1d-mesh_example_SU201_2005_RPA1_exterior.vtp", "vtkXMLPolyDataReader", ("ModelFaceID",)),
        ("centerline-based-material-props_c++_aorta.vtp", "vtkXMLPolyDataReader", ("ModelFaceID",)),
        ("aorta-surface.stl", "vtkSTLReader", ()),
    ):
        path = os.path.join(folder, name)
        theirs = vtk.surface(reader, path)
        check_surface(
            table,
            name[name.rindex(".") :],
            f"as {vtk.name}: {name}",
            written,
            lambda path=path, theirs=theirs: (path, theirs, "not said"),
            FLOAT if name.endswith("stl") else DOUBLE,
            not name.endswith("stl"),
            (),
            names,
        )


def check_meshio(table, meshio, written):
    path, wall = written.vmesh.path, written.wall
    for form, options, tolerance in (
        (".ply", {"binary": True}, DOUBLE),
        (".stl", {"binary": True}, FLOAT),
        (".obj", {}, 1e-9),
        (".off", {}, 1e-9),
    ):
        name = path("by_meshio" + form)
        check_surface(
            table,
            form,
            meshio.name,
            written,
            lambda name=name, options=options: (meshio.write(wall, name, **options), wall, "not said"),
            tolerance,
            form != ".stl",
        )


def check_assimp(table, assimp, written):
    path, wall = written.vmesh.path, written.wall
    if not assimp_reads_scenes(written.vmesh, path):
        table.notes.append("SKIPPED scenes: this vmesh is built without assimp")
    # Its binary PLY is shorter than its header says; MeshLab refuses it as vmesh does.
    for form, code in ((".ply", "ply"), (".stl", "stlb"), (".obj", "obj")):
        name = path("by_assimp" + form)
        check_surface(
            table,
            form,
            assimp.name,
            written,
            lambda name=name, code=code: (assimp.export(path("wall.ply"), name, "-f" + code), wall, "not said"),
            2 * FLOAT,
            False,
        )
    if not assimp_reads_scenes(written.vmesh, path):
        return
    # It takes the numbers as they are, for metres with y up, or centimetres in FBX. Its 3MF is empty.
    from_y_up = numpy.stack([wall.points[:, 0], -wall.points[:, 2], wall.points[:, 1]], 1)
    for form, code, unit, size in (
        (".glb", "glb2", "m", 1000),
        (".gltf", "gltf2", "m", 1000),
        (".dae", "collada", "m", 1000),
        (".x3d", "x3d", "m", 1000),
        (".fbx", "fbxa", "cm", 10),
    ):
        name, expected = path("by_assimp" + form), Surface(size * from_y_up, wall.faces)
        check_surface(
            table,
            form,
            assimp.name,
            written,
            lambda name=name, code=code, unit=unit, expected=expected: (
                assimp.export(path("wall.ply"), name, "-f" + code),
                expected,
                f"{unit}, y up",
            ),
            SIX_DIGITS,
            False,
        )


def assimp_reads_scenes(vmesh, path):
    try:
        vmesh("info", path("wall.glb"))
        return True
    except Wrong as wrong:
        if "VMESH_WITH_ASSIMP" not in str(wrong):
            raise
        return False


def check_meshlab(table, meshlab, written):
    path, wall = written.vmesh.path, written.wall
    for form in (".ply", ".stl", ".obj", ".off"):
        check_surface(
            table,
            form,
            meshlab.name,
            written,
            lambda form=form: (meshlab.convert(path("wall.ply"), path("by_meshlab" + form)), wall, "not said"),
            SIX_DIGITS,
            False,
        )


def check_text(table, written, shared_data):
    vmesh, path = written.vmesh, written.vmesh.path
    by = "by its documentation"

    def one(form, make, **more):
        check_tree(table, form, by, vmesh, make, **more)

    curves = (("trunk", [0, 1]), ("left", [1, 2]), ("right", [1, 3]))
    one(
        ".mrk.json",
        lambda: [small.markups(path(n + ".mrk.json"), c) for n, c in curves],
        place="mm, RAS",
        way="in, a file per branch",
    )
    one(
        ".ctgr",
        lambda: small.contour_group(path("trunk.ctgr")),
        expected=small.TRUNK,
        options=("--unit", "cm"),
        tolerance=1e-6,
    )
    one(
        ".pth",
        lambda: small.path_of_points(path("trunk.pth")),
        expected=small.TRUNK,
        options=("--unit", "cm", "--radius", 2),
    )
    one(".gxl", lambda: small.gxl(path("tree.gxl"), 0.5), options=("--voxel-size", 0.5), place="mm by --voxel-size")
    one(".am", lambda: small.spatial_graph(path("tree.am"), False), options=("--unit", "um"), way="in, text")
    one(".am", lambda: small.spatial_graph(path("tree.am"), True), options=("--unit", "um"), way="in, binary")
    one(".dat", lambda: small.network(path("network.dat")), place="um")
    one(".vmv", lambda: small.vmv(path("tree.vmv")), options=("--unit", "um"))
    one(".swc", lambda: small.swc(path("by_hand.swc")))
    one(".csv", lambda: small.pair(path("by_hand.csv")))
    one(".csv", lambda: small.voreen(path("tree_nodes.csv")), way="in, of Voreen")
    one(".tre", lambda: small.tubes(path("tree.tre"), False), place="mm, LPS (the format's)", way="in, text")
    one(".tre", lambda: small.tubes(path("binary.tre"), True), place="mm, LPS (the format's)", way="in, binary")
    one(".json", lambda: small.own_json(path("by_hand.json")), place="cm, RAS")
    check_surface(
        table,
        ".glb",
        "vmesh",
        written,
        lambda: (path("wall.glb"), written.wall, "mm, LPS of ours"),
        FLOAT,
        True,
        (*NORMAL_NAMES, "red", "green", "blue"),
        (),
        "in, ours",
    )
    if assimp_reads_scenes(vmesh, path):
        check_surface(
            table,
            ".3mf",
            by,
            written,
            lambda: (small.model_3mf(path("wall.3mf"), written.wall), written.wall, "mm"),
            FLOAT,
            False,
        )
    brava = os.path.join(shared_data, "brain_brava_swc", "BG0002.CNG.")
    if os.path.exists(brava + "vmv"):
        table.check(".swc", "in", "as NumPy: BG0002.CNG.swc", lambda: shared_swc(vmesh, brava + "swc"))


def shared_swc(vmesh, path):
    """Cleaning leaves points out or merges them; those that arrive are the file's."""
    rows = numpy.loadtxt(path)
    there = vmesh.tree(path)
    theirs = {tuple(p) for p in numpy.round(rows[:, 2:5], 6)}
    strange = [p for p in numpy.round(there.points, 6) if tuple(p) not in theirs]
    expect(not strange, f"{len(strange)} points are not the file's, as {strange[:1]}")
    expect(len(there.points) > 0.9 * len(theirs), f"of {len(theirs)} points {len(there.points)} arrived")
    return len(there.points), len(there.segments), "radius", "not said"
