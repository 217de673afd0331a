"""A module of 3D Slicer: surfaces around curves, centerline models and segments, by vmesh. Of the work itself nothing is
here: that is in vmesh_vtk.py, which needs VTK alone."""

import os
import sys

import ctk
import qt
import slicer
import vtk
from slicer.ScriptedLoadableModule import (
    ScriptedLoadableModule,
    ScriptedLoadableModuleLogic,
    ScriptedLoadableModuleWidget,
)

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import vmesh_command
import vmesh_vtk

_COMMAND = "vmesh/command"  # among Slicer's settings


class VmeshSurface(ScriptedLoadableModule):
    def __init__(self, parent):
        super().__init__(parent)
        parent.title = "Vessel surface (vmesh)"
        parent.categories = ["Vascular Modeling Toolkit", "Surface Models"]
        parent.contributors = ["vmesh"]
        parent.helpText = (
            "Grows a closed surface of few, well-shaped triangles around a curve with the measurement Radius and the"
            " curves below it, around a model of lines with an array of radii, or on the wall of a segment."
        )


class VmeshSurfaceWidget(ScriptedLoadableModuleWidget):
    def setup(self):
        super().setup()
        self.logic = VmeshSurfaceLogic()
        self._add_files()
        self._add_options()
        self.apply = qt.QPushButton("Apply")
        self.apply.enabled = False
        self.apply.connect("clicked(bool)", self.on_apply)
        self.layout.addWidget(self.apply)
        self.layout.addStretch(1)
        self.on_input()

    def _form(self, title, collapsed=False):
        box = ctk.ctkCollapsibleButton()
        box.text, box.collapsed = title, collapsed
        self.layout.addWidget(box)
        return qt.QFormLayout(box)

    def _selector(self, types, create):
        selector = slicer.qMRMLNodeComboBox()
        selector.nodeTypes = types
        selector.addEnabled = selector.renameEnabled = create
        selector.removeEnabled = False
        selector.noneEnabled = True
        selector.setMRMLScene(slicer.mrmlScene)
        return selector

    def _add_files(self):
        form = self._form("Input and output")
        self.input = self._selector(["vtkMRMLMarkupsCurveNode", "vtkMRMLModelNode", "vtkMRMLSegmentationNode"], False)
        self.input.connect("currentNodeChanged(vtkMRMLNode*)", lambda node: self.on_input())
        form.addRow("Curve, lines or segmentation:", self.input)
        self.segment = qt.QComboBox()
        form.addRow("Segment:", self.segment)
        self.tree = qt.QCheckBox()
        self.tree.toolTip = "Open all loops of the segment's vessels, each at its thinnest contact"
        form.addRow("A tree:", self.tree)
        self.output = self._selector(["vtkMRMLModelNode"], True)
        form.addRow("Surface (none: a new one):", self.output)

    def _add_options(self):
        form = self._form("How it is made")
        self.around = qt.QSpinBox()
        self.around.minimum, self.around.maximum, self.around.value = 3, 200, 6
        form.addRow("Vertices around a vessel:", self.around)
        self.blend = self._number(0, 2, 0.5, "Rounding at branches, in smaller radii")
        form.addRow("Blend:", self.blend)
        self.elongation = self._number(1, 16, 1, "Along vessels, triangles up to this times as long as wide")
        form.addRow("Elongation:", self.elongation)
        self.max_error = qt.QLineEdit()
        self.max_error.placeholderText = "0.3mm or 5%; empty: none"
        form.addRow("Proven max. error:", self.max_error)
        self.ends = qt.QComboBox()
        self.ends.addItems(["round", "flat", "open"])
        form.addRow("Ends:", self.ends)
        more = self._form("More", collapsed=True)
        self.radius = self._number(0, 1000, 0, "Of all points where there is no array of radii; 0: none")
        more.addRow("Radius, mm:", self.radius)
        self.command = ctk.ctkPathLineEdit()
        self.command.currentPath = qt.QSettings().value(_COMMAND, "")
        self.command.toolTip = "The program vmesh; empty: that of Slicer's Python, or the one in PATH"
        more.addRow("vmesh:", self.command)

    def _number(self, least, most, value, told):
        box = qt.QDoubleSpinBox()
        box.minimum, box.maximum, box.value, box.singleStep = least, most, value, 0.1
        box.toolTip = told
        return box

    def on_input(self):
        node = self.input.currentNode()
        is_segmentation = node is not None and node.IsA("vtkMRMLSegmentationNode")
        self.segment.clear()
        if is_segmentation:
            segments = node.GetSegmentation()
            for i in range(segments.GetNumberOfSegments()):
                self.segment.addItem(segments.GetNthSegment(i).GetName(), segments.GetNthSegmentID(i))
        self.segment.enabled = self.tree.enabled = is_segmentation
        self.apply.enabled = node is not None

    def options(self):
        return {
            "around": self.around.value,
            "blend": self.blend.value,
            "elongation": self.elongation.value,
            "max_error": self.max_error.text.strip(),
            "ends": self.ends.currentText,
            "radius": self.radius.value or None,
        }

    def on_apply(self):
        qt.QSettings().setValue(_COMMAND, self.command.currentPath)
        progress = slicer.util.createProgressDialog(labelText="vmesh", maximum=100)
        progress.setCancelButtonText("Cancel")

        def show(stage, fraction):
            progress.labelText, progress.value = stage, int(100 * fraction)
            slicer.app.processEvents()
            return not progress.wasCanceled

        try:
            self.logic.run(
                self.input.currentNode(),
                self.output.currentNode(),
                self.options(),
                segment=self.segment.currentData,
                tree=self.tree.checked,
                progress=show,
                command=self.command.currentPath,
            )
        except vmesh_command.Cancelled:
            pass
        except vmesh_command.VmeshError as error:
            slicer.util.errorDisplay(str(error), "vmesh")
        finally:
            progress.close()


class VmeshSurfaceLogic(ScriptedLoadableModuleLogic):
    def run(self, node, output, options, segment="", tree=False, progress=None, command=""):
        """The surface as the model `output`, or a new one if that is None, which is returned."""
        how = {
            "progress": progress,
            "warn": lambda line: slicer.util.showStatusMessage(f"vmesh: {line}", 5000),
            "command": command,
            # Not Slicer's libraries, which would be loaded instead of the system's.
            "environment": slicer.util.startupEnvironment(),
        }
        centerline = None
        if node.IsA("vtkMRMLSegmentationNode"):
            voxels, ijk_to_ras = self._voxels(node, segment)
            options = {name: value for name, value in options.items() if name != "radius"}
            surface, centerline = vmesh_vtk.surface_of_segmentation(
                voxels, ijk_to_ras, {**options, "tree": tree}, **how
            )
        elif node.IsA("vtkMRMLModelNode"):
            surface = vmesh_vtk.surface_around([self._in_world(node)], options, "mm", "RAS", **how)
        else:
            curves = [self._curve(curve, options) for curve in self._with_those_below(node)]
            surface = vmesh_vtk.surface_around(curves, options, "mm", "RAS", **how)
        if centerline is not None:
            self._show(None, centerline, node.GetName() + " centerline")
        return self._show(output, surface, node.GetName() + " surface")

    def _show(self, model, poly, name):
        if model is None:
            model = slicer.mrmlScene.AddNewNodeByClass("vtkMRMLModelNode", slicer.mrmlScene.GenerateUniqueName(name))
        model.SetAndObservePolyData(poly)
        if model.GetDisplayNode() is None:
            model.CreateDefaultDisplayNodes()
        return model

    def _in_world(self, model):
        """Its lines, where transformations put them; radii stay as they are."""
        if model.GetParentTransformNode() is None:
            return model.GetPolyData()
        to_world = vtk.vtkGeneralTransform()
        slicer.vtkMRMLTransformNode.GetTransformBetweenNodes(model.GetParentTransformNode(), None, to_world)
        move = vtk.vtkTransformPolyDataFilter()
        move.SetTransform(to_world)
        move.SetInputData(model.GetPolyData())
        move.Update()
        return move.GetOutput()

    def _with_those_below(self, curve):
        """The curve and those below it in the subject hierarchy, as Extract Centerline makes them."""
        hierarchy = slicer.vtkMRMLSubjectHierarchyNode.GetSubjectHierarchyNode(slicer.mrmlScene)
        below = vtk.vtkIdList()
        hierarchy.GetItemChildren(hierarchy.GetItemByDataNode(curve), below, True)
        nodes = [curve] + [hierarchy.GetItemDataNode(below.GetId(i)) for i in range(below.GetNumberOfIds())]
        return [node for node in nodes if node is not None and node.IsA("vtkMRMLMarkupsCurveNode")]

    def _curve(self, curve, options):
        """Straight between its control points."""
        points = slicer.util.arrayFromMarkupsControlPoints(curve, world=True)
        measurement = curve.GetMeasurement("Radius")
        values = measurement.GetControlPointValues() if measurement is not None else None
        if values is not None:
            radii = [values.GetValue(i) for i in range(values.GetNumberOfValues())]
        elif options["radius"]:
            radii = [options["radius"]] * len(points)
        else:
            raise vmesh_command.VmeshError(
                f"{curve.GetName()} has no measurement Radius of its control points; give a radius under More"
            )
        return vmesh_vtk.curve(points, radii, closed=curve.IsA("vtkMRMLMarkupsClosedCurveNode"))

    def _voxels(self, segmentation, segment):
        """Of one segment, and from (i, j, k, 1) to RAS. In the geometry of the image, whose border cuts vessels."""
        labelmap = slicer.mrmlScene.AddNewNodeByClass("vtkMRMLLabelMapVolumeNode")
        try:
            ids = vtk.vtkStringArray()
            ids.InsertNextValue(segment)
            slicer.modules.segmentations.logic().ExportSegmentsToLabelmapNode(
                segmentation, ids, labelmap, None, slicer.vtkSegmentation.EXTENT_REFERENCE_GEOMETRY
            )
            matrix = vtk.vtkMatrix4x4()
            labelmap.GetIJKToRASMatrix(matrix)
            ijk_to_ras = slicer.util.arrayFromVTKMatrix(matrix)
            return slicer.util.arrayFromVolume(labelmap).copy(), ijk_to_ras
        finally:
            slicer.mrmlScene.RemoveNode(labelmap)
