"""Blender's add-on: blender --background --factory-startup --python blender_test.py -- VMESH BENT_TREE SOURCE
[PICTURE.png]."""

import json
import os
import re
import subprocess
import sys
import tempfile

import addon_utils
import bpy
import numpy
from mathutils import Matrix, Vector

VMESH, BENT_TREE, SOURCE = (os.path.abspath(path) for path in sys.argv[sys.argv.index("--") + 1 :][:3])
PICTURE = sys.argv[sys.argv.index("--") + 4 :]
TREE = os.path.join(SOURCE, "examples", "small_tree.swc")
MM = 1e-3  # in metres
# A float near .06 m, which the tree extends to, is within 4e-9 m of what it stands for; a few operations on such.
FLOAT = 2e-8
os.environ["VMESH_COMMAND"] = VMESH


def install(folder):
    """As users do, from the zip, and without touching what they have."""
    subprocess.run([os.path.join(SOURCE, "scripts", "add-ons"), folder], check=True, stdout=subprocess.DEVNULL)
    archive = next(os.path.join(folder, name) for name in os.listdir(folder) if name.startswith("vmesh-blender-"))
    scripts = os.path.join(folder, "scripts")
    os.makedirs(os.path.join(scripts, "addons"))
    bpy.context.preferences.filepaths.script_directory = scripts
    bpy.utils.refresh_script_paths()
    bpy.ops.preferences.addon_install(filepath=archive, target="PREFS")
    bpy.ops.preferences.addon_enable(module="vmesh_centerline")
    installed = sys.modules["vmesh_centerline"].__file__
    assert installed.startswith(scripts), installed


def start_anew():
    bpy.ops.object.select_all(action="DESELECT")
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    for kind in (bpy.data.meshes, bpy.data.armatures, bpy.data.materials):
        for one in list(kind):
            kind.remove(one)


def imported(**options):
    assert bpy.ops.import_scene.vmesh_centerline(filepath=TREE, **options) == {"FINISHED"}
    return bpy.context.object


def by_command(folder, *options):
    """Vertices with what they are called in PLY files, mm, and triangles."""
    path = os.path.join(folder, "expected.ply")
    subprocess.run([VMESH, "generate", TREE, "-o", path, "--ascii", "--quiet", *options], check=True)
    with open(path) as file:
        header, body = file.read().split("end_header\n")
    names = re.findall(r"property \w+ (\w+)$", header.split("element face")[0], re.MULTILINE)
    count = int(re.search(r"element vertex (\d+)", header)[1])
    rows = [line.split() for line in body.splitlines()]
    columns = dict(zip(names, numpy.array(rows[:count], float).T))
    columns["points"] = numpy.stack([columns[x] for x in "xyz"], axis=1)
    return columns, numpy.array([row[1:4] for row in rows[count:]], int)


def world_points(thing):
    """As shown: with modifiers and the object's place."""
    evaluated = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
    return numpy.array([evaluated.matrix_world @ vertex.co for vertex in evaluated.data.vertices])


def values(thing, name):
    return numpy.array([item.value for item in thing.data.attributes[name].data])


def expect_at(points, expected, tolerance):
    off = numpy.abs(points - expected).max()
    assert points.shape == expected.shape and off <= tolerance, (points.shape, expected.shape, off)


def test_the_mesh_is_what_the_command_makes_in_its_true_size(folder):
    thing = imported()
    columns, triangles = by_command(folder)
    expect_at(world_points(thing), MM * columns["points"], FLOAT)
    faces = numpy.array([list(polygon.vertices) for polygon in thing.data.polygons])
    assert numpy.array_equal(faces, triangles)
    assert all(polygon.use_smooth for polygon in thing.data.polygons)
    assert numpy.array_equal(values(thing, "segment"), columns["segment"])
    assert numpy.array_equal(values(thing, "branch"), columns["branch"])
    assert numpy.allclose(values(thing, "radius"), columns["radius"], rtol=1e-6)
    colors = numpy.array([item.color[:3] for item in thing.data.color_attributes["Color"].data])
    assert len(numpy.unique(colors.round(3), axis=0)) == len(numpy.unique(columns["branch"])) > 1
    assert [material.name for material in thing.data.materials] == ["vessel"]
    assert not thing.data.validate()  # nothing to mend


def test_options_are_those_of_the_command(folder):
    thing = imported(
        around=9, blend=0.7, elongation=4, ends="flat", max_error="10%", unit="cm", armature=False, scale=10
    )
    options = "--around 9 --blend 0.7 --elongation 4 --ends flat --max-error 10% --unit cm".split()
    columns, triangles = by_command(folder, *options)
    expect_at(world_points(thing), 10 * MM * columns["points"], 100 * FLOAT)  # 100 times the size
    assert len(thing.data.polygons) == len(triangles)
    assert thing.parent is None and not thing.modifiers
    # Patches are materials: each has the faces of its part.
    assert [m.name for m in thing.data.materials] == ["wall"] + [f"cap_{i}" for i in range(1, 7)]
    used = {polygon.material_index for polygon in thing.data.polygons}
    assert used == set(range(7)), used


def turn(armature, name, rotation):
    """A bone and all beyond, about where it begins, in the axes of the armature."""
    bone = armature.pose.bones[name]
    head = Matrix.Translation(bone.bone.head_local)
    bone.matrix = head @ rotation @ head.inverted() @ bone.bone.matrix_local
    bpy.context.view_layer.update()


def test_a_turned_bone_deforms_as_vmesh_does(folder):
    """`bent_tree` turns a branch by 0.698 about (1, 2, 3) and has the vertices from Eq. 10 of the paper."""
    thing = imported()
    surface, pose_file = os.path.join(folder, "surface.ply"), os.path.join(folder, "pose.json")
    subprocess.run([VMESH, "generate", TREE, "-o", surface, "--quiet"], check=True)
    subprocess.run([BENT_TREE, TREE, surface, pose_file], check=True)
    with open(pose_file) as file:
        pose = json.load(file)
    turned = {joint["name"]: abs(joint["quaternion"][3]) < 0.99 for joint in pose["joints"]}
    hinge = [n[:-6] for n in turned if n.endswith(" start") and turned[n] and not turned[n[:-5] + "parent"]]
    assert len(hinge) == 1, hinge
    armature = thing.parent
    bones = [name for name in turned if name.endswith((" start", " parent"))]
    assert len(armature.data.bones) == len(bones) + 1, "two bones for each segment and a root"
    before = world_points(thing)
    turn(armature, hinge[0], Matrix.Rotation(0.698, 4, Vector((1, 2, 3))))
    deformed = MM * numpy.array(pose["vertices"])
    assert numpy.linalg.norm(deformed - before, axis=1).max() > 0.005
    off = numpy.linalg.norm(world_points(thing) - deformed, axis=1) / (MM * numpy.array(pose["radii"]))
    # 5e-8 m at a radius of 1.2 mm.
    assert off.max() < 4e-5, off.max()
    print(f"off by {off.max():.2g} radii of what vmesh deforms to")


def test_making_it_again_keeps_the_rest(folder):
    thing = imported()
    armature = thing.parent
    paint = bpy.data.materials.new("paint")
    thing.data.materials[0] = paint
    thing.modifiers.new("finer", "SUBSURF").levels = 0
    armature.location = 1, 2, 3
    name = next(bone.name for bone in armature.data.bones if bone.name.startswith("segment 5"))
    turn(armature, name, Matrix.Rotation(0.5, 4, Vector((0, 1, 0))))
    before = armature.pose.bones[name].rotation_quaternion.copy()
    meshes = len(bpy.data.meshes)
    bent = world_points(thing)
    for around in (6, 9):
        thing.vmesh.around = around
        assert bpy.ops.object.vmesh_regenerate() == {"FINISHED"}
        if around == 6:
            expect_at(world_points(thing), bent, 100 * FLOAT)  # 3 m off, where floats are 2e-7 m apart
    columns, _ = by_command(folder, "--around", "9")
    assert len(thing.data.vertices) == len(columns["points"]) > len(bent)
    assert list(thing.data.materials) == [paint]
    assert [modifier.type for modifier in thing.modifiers] == ["ARMATURE", "SUBSURF"]
    assert bpy.context.object == thing and thing.parent == armature and len(bpy.data.armatures) == 1
    assert len(bpy.data.meshes) == meshes
    assert armature.pose.bones[name].rotation_quaternion == before and before.angle > 0.4
    assert all(len(bone.constraints) <= 1 for bone in armature.pose.bones)
    # From the armature as well, and without a pose it is the surface at its new place.
    bpy.context.view_layer.objects.active = armature
    for bone in armature.pose.bones:
        bone.matrix_basis.identity()
    assert bpy.ops.object.vmesh_regenerate() == {"FINISHED"}
    expect_at(world_points(thing), MM * columns["points"] + [1, 2, 3], 100 * FLOAT)


def test_mistakes_are_told_and_change_nothing(folder):
    def refused(call, told, **options):
        try:
            call(**options)
        except RuntimeError as error:
            assert told in str(error), error
        else:
            raise AssertionError(f"not refused: {told}")

    missing = os.path.join(folder, "missing.swc")
    refused(bpy.ops.import_scene.vmesh_centerline, "there is no such file", filepath=missing)
    refused(bpy.ops.import_scene.vmesh_centerline, "often", filepath=TREE, max_error="often")
    assert not bpy.data.objects and not bpy.data.meshes
    thing = imported()
    points = world_points(thing)
    thing.vmesh.max_error = "often"
    refused(bpy.ops.object.vmesh_regenerate, "often")
    assert numpy.array_equal(world_points(thing), points)
    preferences = bpy.context.preferences.addons["vmesh_centerline"].preferences
    preferences.command = missing
    refused(bpy.ops.import_scene.vmesh_centerline, "is no program", filepath=TREE)
    preferences.command = ""
    thing.vmesh.filepath = ""
    assert not bpy.ops.object.vmesh_regenerate.poll(), "an object that the add-on did not make"


def draw(path):
    """By Cycles, which needs no display."""
    thing = imported(around=10)
    armature = thing.parent
    segment = next(bone for bone in armature.data.bones if bone.parent and bone.parent.name.startswith("root"))
    turn(armature, segment.children[0].name, Matrix.Rotation(0.5, 4, Vector((0, 1, 0))))
    scene = bpy.context.scene
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    scene.collection.objects.link(camera)
    camera.data.clip_start = 1e-4
    camera.location, camera.rotation_euler = (0.003, -0.2, 0.03), (1.5708, 0, 0)
    camera.data.lens = 70
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.data.energy, sun.rotation_euler = 3, (0.9, 0.2, 0.5)
    scene.collection.objects.link(sun)
    scene.camera, scene.render.engine = camera, "CYCLES"
    scene.cycles.samples, scene.cycles.device, scene.cycles.use_denoising = 32, "CPU", False
    scene.render.threads_mode, scene.render.threads = "FIXED", 1
    scene.render.resolution_x, scene.render.resolution_y = 700, 600
    scene.world = bpy.data.worlds.new("world")
    scene.world.color = (0.5, 0.5, 0.5)
    scene.render.filepath = path
    bpy.ops.render.render(write_still=True)


with tempfile.TemporaryDirectory() as temporary:
    install(temporary)
    if PICTURE:
        start_anew()
        draw(os.path.abspath(PICTURE[0]))
    else:
        for test_name, test in list(globals().items()):
            if test_name.startswith("test_"):
                start_anew()
                with tempfile.TemporaryDirectory() as empty:
                    test(empty)
                print("passed:", test_name, flush=True)
        addon_utils.disable("vmesh_centerline")  # unregisters without an error
        print("all passed")
