"""vmesh in ParaView 5.10 on: Tools > Manage Plugins > Load New, this file. README.md has the rest.

vmesh_vtk.py and vmesh_command.py have to be in the same folder.
"""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from paraview.util.vtkAlgorithm import smdomain, smhint, smproperty, smproxy
from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase
from vtkmodules.vtkCommonCore import vtkOutputWindow
from vtkmodules.vtkCommonDataModel import vtkPolyData

import vmesh_command
import vmesh_vtk

paraview_plugin_name = "vmesh"
paraview_plugin_version = "1"

_FILES = "swc vtp vtk vtu json csv ply obj tre vmv ctgr pth gxl xml am graphml gexf dat h5"
# Of those, what ParaView has no reader of its own for.
_ONLY_CENTERLINES = "swc tre vmv ctgr pth gxl am graphml gexf"


def _property(kind, name, default, told, domain="", hidden=False):
    visibility = ' panel_visibility="advanced"' if hidden else ""
    return (
        f'<{kind}VectorProperty name="{name}" command="Set{name}" number_of_elements="1"'
        f' default_values="{default}"{visibility}>{domain}<Documentation>{told}</Documentation></{kind}VectorProperty>'
    )


def _choices(*words):
    strings = "".join(f'<String value="{word}"/>' for word in words)
    return f'<StringListDomain name="list">{strings}</StringListDomain>'


_AS_TOLD = "as the data say"
_READING = (
    _property(
        "String",
        "Unit",
        _AS_TOLD,
        "Unit of positions and radii.",
        _choices(_AS_TOLD, "nm", "um", "mm", "cm", "m"),
    )
    + _property(
        "String",
        "RadiusArray",
        "",
        "Array or column that holds the radius; empty: the one that is called so.",
        hidden=True,
    )
    + _property(
        "Double",
        "Radius",
        "0",
        "Of all points where there is no array of radii; 0: none.",
        '<DoubleRangeDomain name="range" min="0"/>',
        hidden=True,
    )
)
_SHAPE = (
    _property(
        "Int",
        "Around",
        "6",
        "Vertices around a vessel, 3 to 200.",
        '<IntRangeDomain name="range" min="3" max="200"/>',
    )
    + _property(
        "String",
        "MaxError",
        "",
        "Proven limit of the distance to the vessels, like 0.3mm or 5% of the radius; empty: none.",
    )
    + _property(
        "Double",
        "Blend",
        "0.5",
        "Rounding at branches, in smaller radii.",
        '<DoubleRangeDomain name="range" min="0" max="2"/>',
    )
    + _property(
        "Double",
        "Elongation",
        "1",
        "Along vessels, triangles up to this times as long as wide.",
        '<DoubleRangeDomain name="range" min="1" max="16"/>',
    )
    + _property("String", "Ends", "round", "How vessels end.", _choices("round", "flat", "open"))
    + _property(
        "Double",
        "FlowExtensions",
        "0",
        "Length of straight extensions at ends that are not round, in radii.",
        '<DoubleRangeDomain name="range" min="0" max="100"/>',
        hidden=True,
    )
    + _property(
        "String",
        "Overlap",
        "separate",
        "Separate them, or keep them.",
        _choices("separate", "keep"),
        hidden=True,
    )
)
_COMMAND = _property(
    "String",
    "Command",
    "",
    "Path of vmesh; empty: that of Python's package, or the one in PATH.",
    hidden=True,
)


class _Algorithm(VTKPythonAlgorithmBase):
    """What the source, the reader and the filter have in common: options, progress, messages."""

    def __init__(self, inputs):
        super().__init__(nInputPorts=inputs, nOutputPorts=1, inputType="vtkPolyData", outputType="vtkPolyData")
        self._values = {"Unit": _AS_TOLD}
        self._file = ""

    def _set(self, name, value):
        if self._values.get(name) != value:
            self._values[name] = value
            self.Modified()

    def reading(self):
        unit = self._values["Unit"]
        return {
            "unit": "" if unit == _AS_TOLD else unit,
            "radius_array": self._values.get("RadiusArray"),
            "radius": self._values.get("Radius") or None,
        }

    def shape(self):
        names = {
            "around": "Around",
            "max_error": "MaxError",
            "blend": "Blend",
            "elongation": "Elongation",
            "ends": "Ends",
            "overlap": "Overlap",
        }
        options = {name: self._values.get(value) for name, value in names.items()}
        options["flow_extensions"] = self._values.get("FlowExtensions") or None
        return options

    def RequestData(self, request, inputs, outputs):
        try:
            how = {"progress": self._progress, "warn": self._warn, "command": self._values.get("Command", "")}
            vtkPolyData.GetData(outputs, 0).ShallowCopy(self.make(inputs, how))
        except vmesh_command.Cancelled:
            pass
        except vmesh_command.VmeshError as error:
            vtkOutputWindow.GetInstance().DisplayErrorText(f"vmesh: {error}\n")
        return 1  # not 0, for which VTK would add pages about its pipeline, and try again at every turn

    def file(self):
        if not self._file:
            raise vmesh_command.VmeshError("choose a file with a centerline")
        return self._file

    def SetFileName(self, name):
        name = "" if name in (None, "None") else name
        if name != self._file:
            self._file = name
            self.Modified()

    def _progress(self, stage, fraction):
        self.SetProgressText(stage)
        self.UpdateProgress(fraction)
        return not self.GetAbortExecute()

    def _warn(self, line):
        vtkOutputWindow.GetInstance().DisplayWarningText(f"vmesh: {line}\n")


def _setter(name):
    return lambda self, value: self._set(name, value)


for _name in (
    "Unit",
    "RadiusArray",
    "Radius",
    "Around",
    "MaxError",
    "Blend",
    "Elongation",
    "Ends",
    "FlowExtensions",
    "Overlap",
    "Command",
):
    setattr(_Algorithm, "Set" + _name, _setter(_name))

_FILE_NAME = (
    '<StringVectorProperty name="FileName" command="SetFileName" number_of_elements="1"'
    ' animateable="0" panel_visibility="default"><FileListDomain name="files"/><Hints>'
    f'<FileChooser extensions="{_FILES}" file_description="Centerlines"/></Hints>'
    "<Documentation>The file with the centerline, in any of vmesh's formats.</Documentation></StringVectorProperty>"
)


@smproxy.source(name="VmeshSurface", label="Vmesh Surface", support_reload=False)
@smproperty.xml(_FILE_NAME + _READING + _SHAPE + _COMMAND)
@smhint.xml('<ShowInMenu category="vmesh"/>')
class VmeshSurface(_Algorithm):
    """A file's centerline as a surface, in mm and LPS."""

    def __init__(self):
        super().__init__(inputs=0)

    def make(self, inputs, how):
        return vmesh_vtk.surface_of_files([self.file()], {**self.reading(), **self.shape()}, **how)


@smproxy.reader(
    name="VmeshCenterline",
    label="Vmesh Centerline",
    file_description="Centerlines (vmesh)",
    extensions=_ONLY_CENTERLINES,
    support_reload=False,
)
@smproperty.xml(_FILE_NAME + _READING + _COMMAND)
class VmeshCenterline(_Algorithm):
    """A file's centerline, cleaned, as lines with radii, in mm and LPS."""

    def __init__(self):
        super().__init__(inputs=0)

    def make(self, inputs, how):
        return vmesh_vtk.centerline_of_files([self.file()], self.reading(), **how)


@smproxy.filter(name="VmeshSurfaceAroundLines", label="Vmesh Surface Around Lines", support_reload=False)
@smproperty.xml(_READING + _SHAPE + _COMMAND)
@smproperty.input(name="Input", port_index=0)
@smdomain.datatype(dataTypes=["vtkPolyData"], composite_data_supported=False)
@smhint.xml('<ShowInMenu category="vmesh"/>')
class VmeshSurfaceAroundLines(_Algorithm):
    """The surface around lines with radii, in the unit and frame of these."""

    def __init__(self):
        super().__init__(inputs=1)

    def make(self, inputs, how):
        options = {**self.reading(), **self.shape()}
        unit = options.pop("unit")
        return vmesh_vtk.surface_around([vtkPolyData.GetData(inputs[0], 0)], options, unit=unit, **how)
