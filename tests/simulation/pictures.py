"""Pictures of what solvers computed in check_simulation.py's folder: slices through flow, half of a wall under pressure."""
import glob
import os

import vtk
from vtk.util.numpy_support import numpy_to_vtk

import lame
import vessels

SIZE = (1000, 400)
VTK_CELLS = {4: vtk.VTK_TETRA, 6: vtk.VTK_WEDGE, 5: vtk.VTK_PYRAMID}


def palette(low, high):
    """From violet to yellow, in even steps of lightness."""
    colours = vtk.vtkColorTransferFunction()
    for share, colour in ((0, (0.27, 0, 0.33)), (0.25, (0.23, 0.32, 0.55)), (0.5, (0.13, 0.57, 0.55)),
                          (0.75, (0.37, 0.79, 0.38)), (1, (0.99, 0.91, 0.15))):
        colours.AddRGBPoint(low + share * (high - low), *colour)
    return colours


def mapped(port, name, by_cell, title, view):
    """Adds to a renderer what comes from a port, coloured by an array, with a bar that tells the values."""
    port.GetProducer().Update()
    data = port.GetProducer().GetOutputDataObject(port.GetIndex())
    array = (data.GetCellData() if by_cell else data.GetPointData()).GetArray(name)
    low, high = array.GetRange(-1 if array.GetNumberOfComponents() > 1 else 0)
    colours = palette(low, high)
    if array.GetNumberOfComponents() > 1:
        colours.SetVectorModeToMagnitude()
    mapper = vtk.vtkDataSetMapper()
    mapper.SetInputConnection(port)
    mapper.SetLookupTable(colours)
    if by_cell:
        mapper.SetScalarModeToUseCellFieldData()
    else:
        mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray(name)
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetInterpolationToFlat()
    actor.GetProperty().LightingOff()  # which would change the colours
    view.AddActor(actor)
    bar = vtk.vtkScalarBarActor()
    bar.SetLookupTable(colours)
    bar.SetTitle(title)
    bar.SetNumberOfLabels(3)
    bar.SetLabelFormat("%.3g")
    bar.UnconstrainedFontSizeOn()
    bar.SetMaximumWidthInPixels(60)
    bar.SetVerticalTitleSeparation(12)
    for text, size in ((bar.GetTitleTextProperty(), 15), (bar.GetLabelTextProperty(), 13)):
        text.SetColor(0, 0, 0)
        text.SetFontSize(size)
        text.ShadowOff()
        text.ItalicOff()
    bar.SetPosition(0.8, 0.1)
    bar.SetHeight(0.8)
    bar.SetWidth(0.18)
    view.AddActor2D(bar)


def look(view, direction, up, zoom=1.0):
    camera = view.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(0, 0, 0)
    camera.SetPosition(direction)
    camera.SetViewUp(up)
    view.ResetCamera()
    camera.Zoom(zoom)
    camera.SetWindowCenter(0.2, 0)  # room for the bar


def write(views, path):
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(*SIZE)
    for i, view in enumerate(views):
        view.SetViewport(i / len(views), 0, (i + 1) / len(views), 1)
        view.SetBackground(1, 1, 1)
        window.AddRenderer(view)
    window.Render()
    shot = vtk.vtkWindowToImageFilter()
    shot.SetInput(window)
    shot.ReadFrontBufferOff()
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(path)
    writer.SetInputConnection(shot.GetOutputPort())
    writer.Write()
    return path


def foam_slice(case):
    """The last time of an OpenFOAM case, cut along the plane of its axis."""
    marker = os.path.join(case, "case.foam")
    open(marker, "w").close()
    reader = vtk.vtkOpenFOAMReader()
    reader.SetFileName(marker)
    reader.UpdateInformation()
    times = reader.GetTimeValues()
    reader.UpdateTimeStep(times.GetValue(times.GetNumberOfTuples() - 1))
    inside = reader.GetOutput().GetBlock(0)  # patches follow
    plane = vtk.vtkPlane()
    plane.SetOrigin(0, 1e-6, 0)  # metres; vertices lie on 0
    plane.SetNormal(0, 1, 0)
    cutter = vtk.vtkCutter()
    cutter.SetInputData(inside)
    cutter.SetCutFunction(plane)
    return cutter


def draw_flow(case, path):
    up = (1, 0, 0) if os.path.basename(case) == "tube" else (0, 0, 1)
    cut, views = foam_slice(case), []
    for name, title in (("U", "velocity, m/s"), ("p", "pressure, m2/s2")):
        view = vtk.vtkRenderer()
        mapped(cut.GetOutputPort(), name, False, title, view)
        look(view, (0, -1, 0), up)
        views.append(view)
    return write(views, path)


def draw_wall(folder, path):
    points, elements, _, hoop = lame.hoop_stresses(folder)
    numbers = {number: i for i, number in enumerate(points)}
    places = vtk.vtkPoints()
    for position in points.values():
        places.InsertNextPoint(position)
    grid = vtk.vtkUnstructuredGrid()
    grid.SetPoints(places)
    for corners in elements.values():
        grid.InsertNextCell(VTK_CELLS[len(corners)], len(corners), [numbers[c] for c in corners])
    array = numpy_to_vtk(hoop, deep=True)
    array.SetName("hoop")
    grid.GetCellData().AddArray(array)
    plane = vtk.vtkPlane()
    plane.SetOrigin(0, 0, vessels.LENGTH_MM / 2)
    plane.SetNormal(0, 0, 1)
    half = vtk.vtkExtractGeometry()
    half.SetInputData(grid)
    half.SetImplicitFunction(plane)
    half.ExtractInsideOff()
    view = vtk.vtkRenderer()
    mapped(half.GetOutputPort(), "hoop", True, "hoop stress, MPa", view)
    look(view, (0.45, -0.2, -1), (0, 1, 0), 1.2)
    return write([view], path)


def draw_all(results, folder):
    """Of the cases that were solved. Returns the files."""
    written = []
    for name in ("tube", "bend18"):
        case = os.path.join(results, name)
        if glob.glob(os.path.join(case, "[1-9]*", "p")):
            written.append(draw_flow(case, os.path.join(folder, f"simulation-{name.rstrip('18')}.png")))
    wall = os.path.join(results, "shell")
    if os.path.exists(os.path.join(wall, "tube.dat")):
        written.append(draw_wall(wall, os.path.join(folder, "simulation-wall.png")))
    return written
