"""The Vascular Modeling Toolkit as a peer: centerlines between known ends, and the network of a surface.

Both start from a surface, marching cubes smoothed by Taubin's filter as in VMTK's tutorials, which is timed with them.
"""

from __future__ import annotations

import numpy as np
import vtk
from scipy.spatial import cKDTree
from vmtk import vmtkscripts
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

from graph import Graph, make_graph


def surface_of(image) -> vtk.vtkPolyData:
    """Marching cubes of an image, smoothed, in mm, LPS."""
    volume = vtk.vtkImageData()
    volume.SetDimensions(image.values.shape)
    volume.SetSpacing(image.voxel.tolist())
    volume.SetOrigin(image.origin.tolist())
    volume.GetPointData().SetScalars(numpy_to_vtk(image.values.astype(np.float32).ravel(order="F"), deep=True))
    contour = vmtkscripts.vmtkMarchingCubes()
    contour.Image, contour.Level = volume, image.level
    contour.Execute()
    smoothing = vmtkscripts.vmtkSurfaceSmoothing()
    smoothing.Surface, smoothing.NumberOfIterations, smoothing.PassBand = contour.Surface, 30, .1
    smoothing.Execute()
    return smoothing.Surface


def parts_of(surface: vtk.vtkPolyData) -> list[vtk.vtkPolyData]:
    """The connected parts of a surface."""
    regions = vtk.vtkPolyDataConnectivityFilter()
    regions.SetInputData(surface)
    regions.SetExtractionModeToAllRegions()
    regions.Update()
    count = regions.GetNumberOfExtractedRegions()
    regions.SetExtractionModeToSpecifiedRegions()
    parts = []
    for region in range(count):
        regions.InitializeSpecifiedRegionList()
        regions.AddSpecifiedRegion(region)
        clean = vtk.vtkCleanPolyData()  # drops the points of other parts
        clean.SetInputConnection(regions.GetOutputPort())
        clean.Update()
        part = vtk.vtkPolyData()
        part.DeepCopy(clean.GetOutput())
        parts.append(part)
    return parts


def points_of(data: vtk.vtkPolyData) -> np.ndarray:
    return vtk_to_numpy(data.GetPoints().GetData()).astype(float)


def volume_of(data: vtk.vtkPolyData) -> float:
    """The volume in a surface of triangles, mm3; that of a cavity, which is oriented inwards, is below 0."""
    corners = points_of(data)[vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(-1, 3)]
    return float((corners[:, 0] * np.cross(corners[:, 1], corners[:, 2])).sum() / 6)


def lines_of(data: vtk.vtkPolyData, radius_array: str) -> list[tuple[np.ndarray, np.ndarray]]:
    """The points and radii of each polyline."""
    points = points_of(data)
    radii = vtk_to_numpy(data.GetPointData().GetArray(radius_array)).astype(float)
    lines = []
    for index in range(data.GetNumberOfCells()):
        ids = data.GetCell(index).GetPointIds()
        nodes = [ids.GetId(i) for i in range(ids.GetNumberOfIds())]
        lines.append((points[nodes], radii[nodes]))
    return lines


def centerlines(image, watch) -> Graph:
    """vmtkcenterlines. It is told what the others have to find: where the true vessels end.

    In each part of the surface that has at least two of the true ends, the first is the source, and the others are the
    targets. Specks and the walls of cavities that marching cubes sees are no such parts.
    """
    graphs = []
    with watch:
        parts = parts_of(surface_of(image))
    largest = max(part.GetNumberOfPoints() for part in parts)
    parts = [part for part in parts if part.GetNumberOfPoints() > .01 * largest and volume_of(part) > 0]
    distances = np.array([cKDTree(points_of(part)).query(image.true_tips)[0] for part in parts])
    owner = np.argmin(distances.reshape(len(parts), -1), axis=0)
    for index, part in enumerate(parts):
        ends = image.true_tips[owner == index]
        if len(ends) < 2:
            continue
        with watch:
            script = vmtkscripts.vmtkCenterlines()
            script.Surface = part
            script.SeedSelectorName = "pointlist"
            script.SourcePoints = ends[0].tolist()
            script.TargetPoints = ends[1:].ravel().tolist()
            script.AppendEndPoints = 0  # from the axis on to the wall
            script.Resampling, script.ResamplingStepLength = 1, .5 * float(np.prod(image.voxel)**(1 / 3))
            script.Execute()
        graphs.append(merge(lines_of(script.Centerlines, script.RadiusArrayName), ends[0]))
    return union(graphs)


def merge(lines: list[tuple[np.ndarray, np.ndarray]], source: np.ndarray) -> Graph:
    """A tree of lines that all come from one source: each is followed from its target until it meets those before."""
    points: list[np.ndarray] = []
    radii: list[float] = []
    segments: list[tuple[int, int]] = []
    for line, line_radii in lines:
        if len(line) < 2:
            continue
        if np.linalg.norm(line[0] - source) < np.linalg.norm(line[-1] - source):
            line, line_radii = line[::-1], line_radii[::-1]
        before = cKDTree(np.array(points)) if points else None
        last = None
        for point, radius in zip(line, line_radii):
            distance, met = before.query(point) if before else (np.inf, -1)
            if distance < .1 * radius:
                if last is not None:
                    segments.append((last, int(met)))
                break
            points.append(point)
            radii.append(float(radius))
            if last is not None:
                segments.append((last, len(points) - 1))
            last = len(points) - 1
    return make_graph(points, radii, segments)


def union(graphs: list[Graph]) -> Graph:
    """All graphs as one."""
    if not graphs:
        return make_graph([], [], [])
    shifts = np.cumsum([0] + [len(graph.points) for graph in graphs[:-1]])
    return make_graph(np.concatenate([graph.points for graph in graphs]),
                      np.concatenate([graph.radii for graph in graphs]),
                      np.concatenate([graph.segments + shift for graph, shift in zip(graphs, shifts)]))


def network(image, watch) -> Graph:
    """vmtknetworkextraction. It starts from an opening, so a ball around the first true end is cut off.

    Where the truth has no end, at the surface's lowest point.
    """
    with watch:
        surface = surface_of(image)
    if len(image.true_tips):
        centre, radius = image.true_tips[0], image.tip_radii[0]
    else:
        points = points_of(surface)
        centre, radius = points[np.argmin(points[:, 2])], 2 * float(image.voxel.max())
    with watch:
        ball = vtk.vtkSphere()
        ball.SetCenter(centre.tolist())
        ball.SetRadius(float(radius))
        clip = vtk.vtkClipPolyData()
        clip.SetInputData(surface)
        clip.SetClipFunction(ball)
        largest = vtk.vtkPolyDataConnectivityFilter()
        largest.SetInputConnection(clip.GetOutputPort())
        largest.SetExtractionModeToLargestRegion()
        clean = vtk.vtkCleanPolyData()
        clean.SetInputConnection(largest.GetOutputPort())
        clean.Update()
        script = vmtkscripts.vmtkNetworkExtraction()
        script.Surface = clean.GetOutput()
        script.Execute()
    lines = lines_of(script.Network, script.RadiusArrayName)
    return union([make_graph(points, radii, [(i, i + 1) for i in range(len(points) - 1)]) for points, radii in lines])
