"""Vessel centerlines to surfaces.

A centerline (points with radii, and the segments between them) becomes a closed triangle mesh with
few, well-shaped triangles, that is measured, fitted to a segmentation and deformed:

>>> import vmesh
>>> tree = vmesh.read_centerline("tree.swc")
>>> surface = vmesh.generate(tree, around=6)
>>> surface.vertices, surface.faces                      # NumPy arrays, not copied
>>> surface.save("tree.ply")

Lengths are in millimetres, positions in the LPS frame (x to the left, y to the back, z up); a name
says where it is otherwise. Long calls let other threads run and end on Ctrl-C. What vmesh raises is
derived from vmesh.Error; bad arguments raise vmesh.InvalidInput, which is a ValueError too.
"""

from ._errors import (
    Cancelled,
    DefectiveSurface,
    DefectiveVolume,
    Error,
    InvalidInput,
    ReadError,
    SurfaceWarning,
    Unsupported,
    WriteError,
)
from ._core import (
    Centerline,
    Defect,
    Deformation,
    Distribution,
    Evaluation,
    FitDistance,
    FitReport,
    FlatEnd,
    HandForce,
    Hausdorff,
    LayerSummary,
    OneSidedHausdorff,
    Opening,
    OperatingPoint,
    ReferenceDistance,
    SampledDistance,
    StepReport,
    Surface,
    ThinPlace,
    Topology,
    UnmatchedPart,
    VesselDistance,
    VesselDistanceSide,
    VolumeDefect,
    VolumeMeasures,
    VolumeMesh,
    __version__,
    clean,
    closest_points,
    extract_centerline,
    finish_ends,
    read_centerline,
    read_surface,
    read_volume,
    reference_surface,
    synthetic_tree,
)
from ._functions import evaluate, fit, generate, hausdorff, page, render, volume
from ._trimesh import from_trimesh, to_trimesh
from ._vtk import from_vtk, to_pyvista, to_vtk

__all__ = [
    "__version__",
    "Cancelled",
    "Centerline",
    "clean",
    "closest_points",
    "Defect",
    "DefectiveSurface",
    "DefectiveVolume",
    "Deformation",
    "Distribution",
    "Error",
    "evaluate",
    "Evaluation",
    "extract_centerline",
    "finish_ends",
    "fit",
    "FitDistance",
    "FitReport",
    "FlatEnd",
    "from_trimesh",
    "from_vtk",
    "generate",
    "HandForce",
    "Hausdorff",
    "hausdorff",
    "InvalidInput",
    "LayerSummary",
    "OneSidedHausdorff",
    "Opening",
    "OperatingPoint",
    "page",
    "read_centerline",
    "read_surface",
    "read_volume",
    "ReadError",
    "reference_surface",
    "ReferenceDistance",
    "render",
    "SampledDistance",
    "StepReport",
    "Surface",
    "SurfaceWarning",
    "synthetic_tree",
    "ThinPlace",
    "to_pyvista",
    "to_trimesh",
    "to_vtk",
    "Topology",
    "UnmatchedPart",
    "Unsupported",
    "VesselDistance",
    "VesselDistanceSide",
    "volume",
    "VolumeDefect",
    "VolumeMeasures",
    "VolumeMesh",
    "WriteError",
]
