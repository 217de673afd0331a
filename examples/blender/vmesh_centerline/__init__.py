"""Vessel centerlines as meshes with an armature, by vmesh. README.md tells how to install it."""

import os
import tempfile
import threading

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty, StringProperty
from bpy_extras.io_utils import ImportHelper

from . import glb, rig, vmesh_command

bl_info = {
    "name": "Vessel centerlines (vmesh)",
    "author": "vmesh",
    "version": (1, 0, 0),
    "blender": (3, 4, 0),
    "location": "File > Import, 3D View > Sidebar > vmesh",
    "description": "Vessel centerlines with radii as meshes, with an armature to pose them",
    "category": "Import-Export",
}

_EXTENSIONS = "swc vtp vtk vtu json csv ply obj tre vmv ctgr pth gxl xml am graphml gexf dat h5".split()
_COLORS = "Color"
_AS_TOLD = "file"


class Options:
    """How a surface is made: of the import, and kept with the object for making it again."""

    unit: EnumProperty(
        name="Unit",
        description="Unit of the numbers in the file",
        items=[(_AS_TOLD, "As the file says", "mm if it does not say")]
        + [(u, u, "") for u in ("nm", "um", "mm", "cm", "m")],
    )
    radius_array: StringProperty(
        name="Radius array", description="Array or column that holds the radius; empty: the one that is called so"
    )
    around: IntProperty(name="Vertices around", description="Vertices around a vessel", default=6, min=3, max=200)
    max_error: StringProperty(
        name="Max. error", description="Proven limit of the distance to the vessels, like 0.3mm or 5%; empty: none"
    )
    blend: FloatProperty(name="Blend", description="Rounding at branches, in smaller radii", default=0.5, min=0, max=2)
    elongation: FloatProperty(
        name="Elongation",
        description="Along vessels, triangles up to this times as long as wide",
        default=1,
        min=1,
        max=16,
    )
    ends: EnumProperty(
        name="Ends",
        description="How vessels end",
        items=[("round", "Round", ""), ("flat", "Flat", "Closed by flat caps, each a material"), ("open", "Open", "")],
    )
    armature: BoolProperty(name="Armature", description="With bones along the vessels, to pose them by", default=True)
    scale: FloatProperty(
        name="Scale",
        description="Of the true size in metres: at 1000, a millimetre is a metre in Blender",
        default=1,
        min=1e-6,
        max=1e9,
    )

    def draw_options(self, layout):
        layout.use_property_split, layout.use_property_decorate = True, False
        for name in ("unit", "radius_array", "around", "max_error", "blend", "elongation", "ends", "armature", "scale"):
            layout.prop(self, name)


# So that the property group and the operator have the same.
_NAMES = tuple(Options.__annotations__)


class VmeshOptions(Options, bpy.types.PropertyGroup):
    """Of an object made by this add-on."""

    filepath: StringProperty(name="Centerline", subtype="FILE_PATH")


class VmeshPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    command: StringProperty(
        name="vmesh",
        description="Path of the command; empty: that of Python's package, or in PATH",
        subtype="FILE_PATH",
    )

    def draw(self, context):
        self.layout.prop(self, "command")


def _command():
    addon = bpy.context.preferences.addons.get(__package__)
    return bpy.path.abspath(addon.preferences.command) if addon else ""


class _Work(threading.Thread):
    """vmesh at work, without holding up Blender."""

    def __init__(self, options, path):
        super().__init__(daemon=True)
        names = ("radius_array", "around", "max_error", "ends")
        self._options = {name: getattr(options, name) for name in names}
        # As typed: a property is a float, of which .7 would be 0.699999988.
        self._options.update({name: f"{getattr(options, name):.6g}" for name in ("blend", "elongation")})
        self._options["bones"] = options.armature
        self._options["unit"] = "" if options.unit == _AS_TOLD else options.unit
        self._path, self._command = path, _command()
        self.fraction, self.stage, self.cancelled = 0.0, "", False
        self.surface, self.error, self.warnings = None, None, []

    def run(self):
        output = ""
        try:
            with tempfile.TemporaryDirectory(prefix="vmesh-") as folder:
                output = os.path.join(folder, "surface.glb")
                vmesh_command.generate(
                    [self._path],
                    output,
                    self._options,
                    progress=self._hear,
                    warn=self.warnings.append,
                    command=self._command,
                )
                with open(output, "rb") as file:
                    self.surface = glb.Surface(file.read())
        except vmesh_command.VmeshError as error:
            self.error = str(error).replace(output + ": ", "")  # of which the user knows nothing
        except Exception as error:  # told by who waits for it
            self.error = error

    def _hear(self, stage, fraction):
        self.stage, self.fraction = stage, fraction
        return not self.cancelled


class _Growing:
    """An operator that has vmesh at work: waits for it where there is no window, else looks at it now and then."""

    bl_options = {"UNDO"}

    def begin(self, context, options, path, finish):
        self._work, self._finish, self._timer = _Work(options, path), finish, None
        self._work.start()
        if bpy.app.background or context.window is None:
            self._work.join()
            return self._end(context)
        self._timer = context.window_manager.event_timer_add(0.1, window=context.window)
        context.window_manager.progress_begin(0, 100)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC":
            self._work.cancelled = True
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        if self._work.is_alive():
            context.window_manager.progress_update(100 * self._work.fraction)
            context.workspace.status_text_set(f"vmesh: {self._work.stage}, Esc cancels")
            return {"RUNNING_MODAL"}
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()
        context.workspace.status_text_set(None)
        return self._end(context)

    def _end(self, context):
        work = self._work
        if isinstance(work.error, vmesh_command.Cancelled):
            self.report({"INFO"}, "vmesh: cancelled")
            return {"CANCELLED"}
        if work.error is not None:
            self.report({"ERROR"}, f"vmesh: {work.error}")
            return {"CANCELLED"}
        for line in work.warnings:
            self.report({"WARNING"}, f"vmesh: {line}")
        try:
            if context.mode != "OBJECT":  # while vmesh was at work
                bpy.ops.object.mode_set(mode="OBJECT")
            self._finish(context, work.surface)
        except ReferenceError:
            self.report({"ERROR"}, "vmesh: the object was removed in the meantime")
            return {"CANCELLED"}
        return {"FINISHED"}


class VMESH_OT_import(_Growing, Options, bpy.types.Operator, ImportHelper):
    """Grow a surface around a vessel centerline"""

    bl_idname = "import_scene.vmesh_centerline"
    bl_label = "Import vessel centerline"

    filter_glob: StringProperty(default=";".join("*." + e for e in _EXTENSIONS), options={"HIDDEN"})

    def draw(self, context):
        Options.draw_options(self, self.layout)

    def execute(self, context):
        return self.begin(context, self, self.filepath, self._add)

    def _add(self, context, surface):
        name = os.path.splitext(os.path.basename(self.filepath))[0]
        thing = bpy.data.objects.new(name, bpy.data.meshes.new(name))
        context.collection.objects.link(thing)
        for option in _NAMES:
            setattr(thing.vmesh, option, getattr(self, option))
        thing.vmesh.filepath = self.filepath
        for other in context.selected_objects:
            other.select_set(False)
        _fill(context, thing, surface)
        thing.select_set(True)
        context.view_layer.objects.active = thing


class VMESH_OT_regenerate(_Growing, bpy.types.Operator):
    """Make the surface again with these options; materials, modifiers, the armature and its pose are kept"""

    bl_idname = "object.vmesh_regenerate"
    bl_label = "Make again"

    @classmethod
    def poll(cls, context):
        return _made_here(context.object) is not None and context.mode == "OBJECT"

    def execute(self, context):
        thing = _made_here(context.object)
        path = bpy.path.abspath(thing.vmesh.filepath)
        return self.begin(context, thing.vmesh, path, lambda context, surface: _fill(context, thing, surface))


class VMESH_PT_panel(bpy.types.Panel):
    bl_label = "Vessel centerline"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "vmesh"

    def draw(self, context):
        thing = _made_here(context.object)
        if thing is None:
            self.layout.operator(VMESH_OT_import.bl_idname)
            return
        self.layout.prop(thing.vmesh, "filepath")
        Options.draw_options(thing.vmesh, self.layout)
        self.layout.operator(VMESH_OT_regenerate.bl_idname)


def _made_here(thing):
    """The mesh that this add-on made: the object, or what its armature moves."""
    if thing is None:
        return None
    for candidate in [thing, *thing.children]:
        if candidate.type == "MESH" and candidate.vmesh.filepath:
            return candidate
    return None


def _fill(context, thing, surface):
    """The surface becomes the object's mesh, and its joints the object's armature."""
    old, new = thing.data, _mesh_of(surface, thing.vmesh.scale, thing.data.name)
    materials = list(old.materials)
    for number, name in enumerate(surface.materials):
        new.materials.append(materials[number] if number < len(materials) else _material(name, surface))
    for material in materials[len(surface.materials) :]:
        new.materials.append(material)
    thing.data = new
    name = old.name
    if old.users == 0:
        bpy.data.meshes.remove(old)
        new.name = name
    if surface.joints:
        _bind(context, thing, surface)


def _mesh_of(surface, scale, name):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata((scale * surface.positions.astype(float)).tolist(), [], surface.triangles.tolist())
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    mesh.polygons.foreach_set("material_index", surface.material_of_triangle.tolist())
    for attribute, values in surface.attributes.items():
        kind = "INT" if values.dtype.kind == "i" else "FLOAT"
        mesh.attributes.new(attribute, kind, "POINT").data.foreach_set("value", values)
    if surface.colors is not None:
        colors = mesh.color_attributes.new(_COLORS, "FLOAT_COLOR", "POINT")
        colors.data.foreach_set("color", surface.colors.astype("float32").ravel())
    mesh.update()
    return mesh


def _material(name, surface):
    """Of the colours of branches."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    shader = next((node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED"), None)
    if shader is not None and surface.colors is not None:
        colors = material.node_tree.nodes.new("ShaderNodeVertexColor")
        colors.layer_name = _COLORS
        colors.location = shader.location[0] - 250, shader.location[1]
        material.node_tree.links.new(colors.outputs["Color"], shader.inputs["Base Color"])
    return material


def _bind(context, thing, surface):
    slots = rig.slots_of(surface.joints)
    modifier = next((m for m in thing.modifiers if m.type == "ARMATURE" and m.object), None)
    armature = modifier.object if modifier else _armature_for(context, thing)
    _rebuild(context, armature, slots, thing.vmesh.scale)
    for group in list(thing.vertex_groups):
        thing.vertex_groups.remove(group)
    for name, (vertices, weights) in rig.weights(slots, surface.joint_of_vertex, surface.weights).items():
        group = thing.vertex_groups.new(name=name)
        for vertex, weight in zip(vertices, weights):
            group.add((vertex,), weight, "REPLACE")


def _armature_for(context, thing):
    armature = bpy.data.objects.new(thing.name + " bones", bpy.data.armatures.new(thing.name + " bones"))
    armature.data.display_type = "STICK"
    armature.show_in_front = True
    for collection in thing.users_collection:
        collection.objects.link(armature)
    # The pair is where the mesh was.
    armature.matrix_world = thing.matrix_world.copy()
    thing.parent = armature
    thing.matrix_parent_inverse.identity()
    thing.matrix_basis.identity()
    modifier = thing.modifiers.new("Armature", "ARMATURE")
    modifier.object = armature
    modifier.use_deform_preserve_volume = False  # Eq. 10 of the paper does not
    return armature


def _rebuild(context, armature, slots, scale):
    """Its bones; the pose of those that stay is kept."""
    layer = context.view_layer
    active, hidden = layer.objects.active, armature.hide_get()
    armature.hide_set(False)
    layer.objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    rig.make_bones(slots, armature.data.edit_bones, scale)
    bpy.ops.object.mode_set(mode="OBJECT")
    rig.make_helpers_follow(slots, armature)
    armature.hide_set(hidden)
    layer.objects.active = active


def _menu(self, context):
    self.layout.operator(VMESH_OT_import.bl_idname, text="Vessel centerline (vmesh)")


_CLASSES = (VmeshOptions, VmeshPreferences, VMESH_OT_import, VMESH_OT_regenerate, VMESH_PT_panel)


def register():
    for one in _CLASSES:
        bpy.utils.register_class(one)
    bpy.types.Object.vmesh = PointerProperty(type=VmeshOptions)
    bpy.types.TOPBAR_MT_file_import.append(_menu)


def unregister():
    bpy.types.TOPBAR_MT_file_import.remove(_menu)
    del bpy.types.Object.vmesh
    for one in reversed(_CLASSES):
        bpy.utils.unregister_class(one)
