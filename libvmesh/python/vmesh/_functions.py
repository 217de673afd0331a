"""Functions of the package with more argument types than the compiled module: arrays, pairs of arrays, numbers."""

from __future__ import annotations

import warnings
from os import PathLike
from typing import Any, Callable, Iterable, Optional, Sequence, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._core import Centerline, Evaluation, Hausdorff, Surface, VolumeMesh
from ._errors import DefectiveSurface, DefectiveVolume, InvalidInput, SurfaceWarning

Progress = Optional[Callable[[str, float], Any]]
SurfaceLike = Union[Surface, Tuple[ArrayLike, ArrayLike]]


def _as_surface(surface: SurfaceLike) -> Surface:
    if isinstance(surface, Surface):
        return surface
    if isinstance(surface, (tuple, list)) and len(surface) == 2:
        return Surface(*surface)
    raise TypeError(f"a vmesh.Surface or a pair (vertices, faces) is needed, not {type(surface).__name__}")


def _as_limit(max_error: Union[None, float, str]) -> str:
    if max_error is None:
        return ""
    return max_error if isinstance(max_error, str) else f"{float(max_error)!r}mm"


def _checked(surface: Surface, told: Iterable[str], allow_defects: bool) -> Surface:
    for line in surface.warnings:
        if line not in told:
            warnings.warn(line, SurfaceWarning, stacklevel=3)
    if surface.defects and not allow_defects:
        raise DefectiveSurface(surface)
    return surface


def generate(
    centerline: Union[Centerline, ArrayLike],
    radii: Optional[ArrayLike] = None,
    segments: Optional[ArrayLike] = None,
    *,
    around: int = 6,
    max_error: Union[None, float, str] = None,
    blend: float = 0.5,
    placement: str = "balanced",
    growth: str = "guided",
    overlap: str = "separate",
    gap: float = 0.1,
    ends: str = "round",
    open_ends: Sequence[int] = (),
    flow_extension: Union[float, str] = 0.0,
    budget: Optional[str] = None,
    simplification: float = 0.35,
    elongation: float = 1.0,
    ring_spacing: float = 1.0,
    least_vertices: int = 0,
    deformable: bool = False,
    sweeps: int = 30,
    max_vertices: int = 20_000_000,
    threads: int = 0,
    allow_defects: bool = False,
    progress: Progress = None,
) -> Surface:
    """The surface around a centerline: generate(centerline), or generate(nodes, radii, segments).

    centerline      a Centerline, or positions of its nodes, (n, 3), mm
    radii           (n,) mm, and
    segments        (m, 2) node numbers, if positions are given; numbers in the result refer to these
    around          vertices around a vessel, 3 to 200
    max_error       proven limit on the distance to the vessels' boundary, both ways: mm as a number, or
                    "0.3mm", "5%" of the local radius
    blend           width of the rounding at branches, in smaller radii, 0 to 2
    placement       "balanced" keeps the volume, "inscribed" has all vertices on the boundary
    growth          "guided", or "paper": a single seed, as published
    overlap         "separate" narrows vessels that touch, or moves them apart; "keep" leaves them
    gap             to be left between them, in smaller radii
    ends            how vessels end: "round", "flat" (capped, numbered for flow solvers), "open"; ends with one of
                    Centerline.end_sections are cut exactly there unless they are round
    open_ends       nodes at which the surface is left open regardless of `ends`
    flow_extension  length of straight extensions at ends that are not round, in radii; "auto": of each as long
                    as there is room, at most 10 radii
    budget          "vertices=5000", "time=50ms" or "error=0.2mm" choose `around` instead: the finest surface within
                    that number of vertices or time, or the one with the fewest vertices that keeps the error;
                    Surface.tried lists what was tried
    simplification  nodes are left out where that changes the vessels by at most this share of what edges across
                    them cut off anyway, 0 to 1
    elongation      along vessels, triangles as long as the error allows, at most this times their even
                    length, 1 (even) to 16
    ring_spacing    distance of rings along vessels by that of even triangles, 0.8 to 1.25, for numbers of
                    vertices between those of around
    least_vertices  with an elongation: leave out vertices until this number is left, where
                    they reduce the mean error most; with `max_error`, as long as that stays proven
    deformable      for a centerline that is to move: a ring of vertices at every node
    sweeps          of the final optimisation
    max_vertices    a centerline that would need more is refused
    threads         0: all; the result does not depend on it
    allow_defects   return a surface that is not sound instead of raising
    progress        a function of a stage and a fraction in [0, 1]; returning False cancels

    The same options give the same surface, which is that of the command `vmesh generate`.
    Raises InvalidInput, Unsupported (not enough free memory), DefectiveSurface, Cancelled.
    Anything else its user should know is in Surface.warnings, and issued as SurfaceWarning.
    """
    if not isinstance(centerline, Centerline):
        if radii is None or segments is None:
            raise TypeError("generate() takes a Centerline, or nodes, radii and segments")
        centerline = Centerline(centerline, radii, segments)
    elif radii is not None or segments is not None:
        raise TypeError("a Centerline has radii and segments of its own")
    if budget is not None and (around != 6 or max_error is not None or least_vertices != 0 or ring_spacing != 1):
        raise InvalidInput("a budget chooses around, ring_spacing, max_error and least_vertices; leave them out")
    surface = _core.generate(
        centerline,
        progress=progress,
        budget=budget or "",
        around=around,
        max_error=_as_limit(max_error),
        blend=blend,
        placement=placement,
        growth=growth,
        overlap=overlap,
        gap=gap,
        ends=ends,
        open_ends=open_ends,
        flow_extension=flow_extension,
        simplification=simplification,
        elongation=elongation,
        ring_spacing=ring_spacing,
        least_vertices=least_vertices,
        deformable=deformable,
        sweeps=sweeps,
        max_vertices=max_vertices,
        threads=threads,
    )
    return _checked(surface, (), allow_defects)


def fit(
    surface: Surface,
    reference: SurfaceLike,
    *,
    rounds: int = 16,
    resize: bool = True,
    max_vertices: int = 0,
    error: float = 0.0,
    max_error: float = 0.0,
    elongation: float = 1.0,
    deformable: bool = False,
    max_skewness: float = 0.4,
    samples: int = 100_000,
    tolerance: float = 1e-3,
    threads: int = 0,
    allow_defects: bool = False,
    progress: Progress = None,
) -> Surface:
    """A copy of a surface, moved onto the wall of a segmentation; it stays sound.

    surface        bound to its centerline, as from generate(), ends not finished
    reference      a surface or a pair (vertices, faces); see reference_surface() for images
    rounds         of correspondence, least squares and repair, 1 to 100
    resize         make triangles finer where the error is large, coarser where it is small
    max_vertices   0: a twentieth more than there are, or as many as `error` needs
    error          mm: 95 % of either surface shall be nearer to the other, with as few vertices as
                   possible; 0: none
    max_error      mm: no point of either surface shall be farther from the other, but for the regions that
                   fit_report lists as uncovered or unsupported; proven, or fit_report.beyond has the places; 0: none
    elongation     how much longer than wide triangles may be, 1 to 16, where the reference is curved less along than
                   across; with the same number of vertices it comes two to three times nearer to the reference
    deformable     for a centerline that is to move: with an elongation, no edge is longer along the vessel than the
                   segments there
    max_skewness   beyond which no step may worsen a triangle, 0.1 to 0.9
    samples        points on each surface for mean, RMS and percentiles of the report
    tolerance      width of the interval that contains a Hausdorff distance, mm
    threads, allow_defects, progress  as for generate()

    Surface.fit_report contains the distances reached and the unmatched regions. Raises InvalidInput, Unsupported,
    DefectiveSurface, Cancelled.
    """
    fitted = _core.fit(
        surface,
        _as_surface(reference),
        progress=progress,
        rounds=rounds,
        resize=resize,
        max_vertices=max_vertices,
        error=error,
        max_error=max_error,
        elongation=elongation,
        deformable=deformable,
        max_skewness=max_skewness,
        samples=samples,
        tolerance=tolerance,
        threads=threads,
    )
    return _checked(fitted, surface.warnings, allow_defects)


def evaluate(
    surface: SurfaceLike,
    reference: Optional[SurfaceLike] = None,
    centerline: Optional[Centerline] = None,
    *,
    samples: int = 100_000,
    tolerance: float = 1e-4,
    threads: int = 0,
    progress: Progress = None,
) -> Evaluation:
    """Measures any surface: topology, crossing faces, shape of triangles, distances.

    surface     a surface or a pair (vertices, faces)
    reference   another one to compare with, both ways
    centerline  whose volume (a union of round cones) to compare with, both ways
    samples     points on each surface for mean, RMS and percentiles
    tolerance   width of the interval that contains a Hausdorff distance, mm
    threads     0: all; the result does not depend on it
    progress    as for generate()

    Raises InvalidInput for a mesh without faces or with corners that are not finite, Cancelled.
    """
    return _core.evaluate(
        _as_surface(surface),
        None if reference is None else _as_surface(reference),
        centerline,
        progress=progress,
        samples=samples,
        tolerance=tolerance,
        threads=threads,
    )


def hausdorff(a: SurfaceLike, b: SurfaceLike, *, tolerance: float = 1e-4, progress: Progress = None) -> Hausdorff:
    """The Hausdorff distance of two surfaces, `a` and `b`, as an interval of at most `tolerance` that contains it, mm.

    Each is a surface or a pair (vertices, faces); open ones and soups of triangles are fine. Raises
    InvalidInput, Cancelled.
    """
    return _core.hausdorff(_as_surface(a), _as_surface(b), tolerance=tolerance, progress=progress)


def render(
    surface: SurfaceLike,
    path: Union[None, str, PathLike[str]] = None,
    *,
    color: Union[None, str, ArrayLike] = None,
    width: int = 1600,
    height: int = 1200,
    view: Union[str, Tuple[float, float]] = "front",
    look_at: Optional[ArrayLike] = None,
    view_height: float = 0.0,
    zoom: float = 1.0,
    field_of_view: float = 0.0,
    edges: bool = False,
    edge_width: float = 1.4,
    smooth: bool = True,
    back_faces: bool = True,
    occlusion: float = 0.7,
    legend: bool = True,
    range: Optional[Tuple[float, float]] = None,
) -> NDArray[np.uint8]:
    """A picture of a surface, without a display: pixels (height, width, 3) uint8, sRGB, rows from the top.

    surface        a surface or a pair (vertices, faces)
    path           also write it to this file (.png)
    color          an attribute by name, "skewness", or a number for every vertex, (n,), or face, (m,); integer
                   attributes ("branch", "segment", ...) get a colour each, unless `range` is given; None: one colour
    width, height  pixels, 16 to 16384
    view           where the camera stands: "front", "back", "left", "right", "top", "bottom", "iso", or azimuth
                   and elevation in degrees (azimuth 0 in front of the patient, 90 at the left; elevation 90 above)
    look_at        (3,) mm, the point in the middle; None: the middle of the surface
    view_height    of what is shown there, mm; 0: all of the surface
    zoom           magnification on top of that
    field_of_view  degrees, below 120; 0: orthographic
    edges          draw the triangles' edges, `edge_width` pixels wide
    smooth         False: shade facet by facet
    back_faces     draw the inside of the surface in magenta, so that holes and inverted faces show
    occlusion      darkening where little ambient light arrives, 0 to 1
    legend         draw the colour scale
    range          values at its ends; None: the least and the greatest

    The same arguments give the same picture, that of the command `vmesh render`. Raises InvalidInput, WriteError.
    """
    return _core.render(
        _as_surface(surface),
        path=path,
        color=color if color is None or isinstance(color, str) else np.asarray(color),
        width=width,
        height=height,
        view=view,
        look_at=look_at,
        view_height=view_height,
        zoom=zoom,
        field_of_view=field_of_view,
        edges=edges,
        edge_width=edge_width,
        smooth=smooth,
        back_faces=back_faces,
        occlusion=occlusion,
        legend=legend,
        range=range,
    )


def page(
    surface: SurfaceLike,
    path: Union[str, PathLike[str]],
    *,
    reference: Optional[SurfaceLike] = None,
    title: Optional[str] = None,
) -> None:
    """Writes a page with the surface in 3D for any browser, without a network: one file (.html).

    surface    a surface or a pair (vertices, faces), coloured by any of its attributes, by its skewness and, where it
               is bound to a centerline, by the distance to the vessels, mm
    path       of the page
    reference  another one, shown in transparency, with the surface's distance to it, mm
    title      of the page; None: the name of the file

    It lists the worst places, each a click away, beside figures and distributions. Raises WriteError, InvalidInput,
    Unsupported (another extension, or a build without pages).
    """
    _core.page(
        _as_surface(surface), path, reference=None if reference is None else _as_surface(reference), title=title
    )


def volume(
    surface: Surface,
    *,
    layers: int = 4,
    layer_thickness: Union[float, str] = 0.2,
    first_layer: float = 0.0,
    layer_growth: float = 1.2,
    core_size: float = 0.0,
    wall_thickness: Union[None, float, str] = None,
    wall_layers: int = 2,
    merge_walls: bool = False,
    wall_only: bool = False,
    allow_defects: bool = False,
    progress: Progress = None,
) -> VolumeMesh:
    """A mesh of what a closed surface encloses, for solvers; of the vessel's own wall too, if asked for.

    surface          closed, with radii: of generate() with ends="flat" or "round", or read from a file that has them
    layers           of wedges along the wall, 0 to 100
    layer_thickness  of all of them together: local radii as a number, or "0.3mm"
    first_layer      thickness of that at the wall, mm, from which that of all follows; 0: by layer_thickness
    layer_growth     thickness of a layer by that of the one nearer to the wall, 0.5 to 5
    core_size        length of edges of tetrahedra within, in local radii; 0: as those of the surface
    wall_thickness   mesh the vessel's own wall, outwards from the surface: local radii, or "0.8mm"; None: not
    wall_layers      of wedges across it
    merge_walls      where the walls of two vessels meet, make them one; else both are thinner there
    wall_only        not what is within
    allow_defects    return a mesh that is not sound instead of raising
    progress         a function of a stage and a fraction in [0, 1]; returning False cancels

    The mesh is that of the command `vmesh volume`. Where layers do not fit they are thinner, or end:
    VolumeMesh.layers lists the places. Lumens are filled by TetGen, whose license is AGPL-3; builds without it, as
    wheels are, mesh walls alone. One at a time: TetGen has state. Raises InvalidInput, Unsupported, DefectiveVolume,
    Cancelled.
    """
    thickness, in_mm = _as_thickness(layer_thickness, "layer_thickness")
    wall, wall_in_mm = (0.0, False) if wall_thickness is None else _as_thickness(wall_thickness, "wall_thickness")
    if wall_thickness is None and (merge_walls or wall_only):
        raise InvalidInput("merge_walls and wall_only need a wall_thickness: 0.2 of the local radius, or '0.8mm'")
    mesh = _core.volume(
        surface,
        progress=progress,
        layers=layers,
        layer_thickness=thickness,
        layer_thickness_in_mm=in_mm,
        first_layer=first_layer,
        layer_growth=layer_growth,
        core_size=core_size,
        wall_layers=0 if wall_thickness is None else wall_layers,
        wall_thickness=wall,
        wall_thickness_in_mm=wall_in_mm,
        merge_walls=merge_walls,
        wall_only=wall_only,
    )
    if mesh.defects and not allow_defects:
        raise DefectiveVolume(mesh)
    return mesh


def _as_thickness(value: Union[float, str], name: str) -> Tuple[float, bool]:
    if not isinstance(value, str):
        return float(value), False
    try:
        if value.endswith("mm"):
            return float(value[:-2]), True
    except ValueError:
        pass
    raise InvalidInput(f"{name}: {value!r} is neither a share of the local radius such as 0.2 nor a length as '0.3mm'")
