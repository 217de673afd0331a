"""Known trees as images: exact masks of round cones, partial volumes, rough boundaries, NIfTI files.

An image is an array indexed [i, j, k]; its voxel (i, j, k) has its centre at origin + voxel * (i, j, k), in mm, LPS.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import nibabel
import numpy as np
from scipy import ndimage
from skimage.measure import euler_number, label

from graph import Graph

GREY_FULL = 1000  # grey value of a voxel that lies within a vessel
SUBDIVISIONS = 4  # of a voxel's sides, for its partial volume


@dataclass(frozen=True)
class Grid:
    """Places of voxels."""

    origin: np.ndarray  # centre of the first voxel, mm, LPS
    voxel: np.ndarray  # sides, mm
    shape: tuple[int, int, int]


def grid_around(graph: Graph, voxel: np.ndarray, margin: int = 3) -> Grid:
    """A grid that holds the vessels and `margin` voxels around them.

    Its origin is the vessels' corner, so that nodes lie anywhere within voxels, not at their centres.
    """
    lower = (graph.points - graph.radii[:, None]).min(axis=0) - margin * voxel
    upper = (graph.points + graph.radii[:, None]).max(axis=0) + margin * voxel
    return Grid(lower, voxel, tuple(int(n) for n in np.ceil((upper - lower) / voxel).astype(int) + 1))


def refined(grid: Grid, divisions: int) -> Grid:
    """The grid with every voxel divided into divisions^3."""
    voxel = grid.voxel / divisions
    origin = grid.origin - .5 * grid.voxel + .5 * voxel
    return Grid(origin, voxel, tuple(divisions * n for n in grid.shape))


def inside_round_cone(a: np.ndarray, b: np.ndarray, radius_a: float, radius_b: float, axes: list) -> np.ndarray:
    """Whether points are in the convex hull of two spheres; axes: coordinates along x, y and z that broadcast.

    The hull is the union of the spheres whose centres and radii are interpolated along the segment. Of these, the one
    that reaches farthest towards a point is not the one at the point's perpendicular foot: where the radius shrinks by
    `slope` a mm, the hull's normal leans by as much, and the touching sphere lies that much nearer to the thick end.
    """
    length = float(np.linalg.norm(b - a))
    if length <= abs(radius_a - radius_b):  # one sphere is in the other
        a, radius_a, length = (a, radius_a, 0.) if radius_a >= radius_b else (b, radius_b, 0.)
    x, y, z = (axis - start for axis, start in zip(axes, a))
    squared = x**2 + y**2 + z**2
    if length == 0:
        return squared <= radius_a**2
    direction = (b - a) / length
    along = x * direction[0] + y * direction[1] + z * direction[2]
    across = np.sqrt(np.maximum(squared - along**2, 0))
    slope = (radius_a - radius_b) / length
    cosine = np.sqrt(1 - slope**2)
    touching = np.clip(along - across * slope / cosine, 0, length)
    return (along - touching)**2 + across**2 <= (radius_a - slope * touching)**2


def voxelise(graph: Graph, grid: Grid) -> np.ndarray:
    """The voxels whose centre is in a vessel."""
    mask = np.zeros(grid.shape, bool)
    alone = np.flatnonzero(graph.degrees == 0)
    pairs = graph.segments.tolist() + [[node, node] for node in alone.tolist()]
    for a, b in pairs:
        ends = graph.points[[a, b]]
        reach = graph.radii[[a, b]][:, None]
        first = np.ceil(((ends - reach).min(axis=0) - grid.origin) / grid.voxel).astype(int).clip(0)
        last = np.floor(((ends + reach).max(axis=0) - grid.origin) / grid.voxel).astype(int) + 1
        last = np.minimum(last, grid.shape)
        if (first >= last).any():  # it is between the centres of voxels
            continue
        axes = np.ix_(*(grid.origin[k] + grid.voxel[k] * np.arange(first[k], last[k]) for k in range(3)))
        block = tuple(slice(start, stop) for start, stop in zip(first, last))
        mask[block] |= inside_round_cone(graph.points[a], graph.points[b], graph.radii[a], graph.radii[b], axes)
    return mask


def partial_volumes(graph: Graph, grid: Grid) -> np.ndarray:
    """Grey values: GREY_FULL times the share of each voxel that is in a vessel, from SUBDIVISIONS^3 points of it."""
    n = SUBDIVISIONS
    image = np.empty(grid.shape, np.int16)
    fine = refined(grid, n)
    # Slab by slab, for the fine mask of the whole takes 64 times the memory.
    slab = max(1, 2**24 // (grid.shape[1] * grid.shape[2] * n**3))
    for start in range(0, grid.shape[0], slab):
        stop = min(start + slab, grid.shape[0])
        shape = (n * (stop - start), *fine.shape[1:])
        part = Grid(fine.origin + [n * start * fine.voxel[0], 0, 0], fine.voxel, shape)
        counts = voxelise(graph, part).reshape(stop - start, n, grid.shape[1], n, grid.shape[2], n).sum(axis=(1, 3, 5))
        image[start:stop] = np.round(GREY_FULL / n**3 * counts)
    return image


def roughen(mask: np.ndarray, seed: int, share: float = .25) -> np.ndarray:
    """Flips that share of the voxels at the boundary, on both of its sides, at random; nothing is repaired."""
    boundary = ndimage.binary_dilation(mask) ^ ndimage.binary_erosion(mask)
    where = np.flatnonzero(boundary)
    flipped = where[np.random.default_rng(seed).random(len(where)) < share]
    rough = mask.copy()
    rough.ravel()[flipped] ^= True
    return rough


def topology(mask: np.ndarray) -> dict[str, int]:
    """Components, tunnels and cavities of a mask; voxels that share a corner are connected.

    They say what can be expected: a mask may join vessels that are apart in the truth, or lose thin ones.
    """
    components = int(label(mask, connectivity=3, return_num=True)[1])
    cavities = int(label(np.pad(~mask, 1, constant_values=True), connectivity=1, return_num=True)[1]) - 1
    return {"components": components, "tunnels": components + cavities - int(euler_number(mask, connectivity=3)),
            "cavities": cavities}


def affine_of(grid: Grid) -> np.ndarray:
    """The affine of a NIfTI file. NIfTI is RAS, so x and y change their signs; voxels keep their indices."""
    to_ras = np.array([-1, -1, 1])
    affine = np.diag([*(to_ras * grid.voxel), 1.])
    affine[:3, 3] = to_ras * grid.origin
    return affine


def write_nifti(path: Path, image: np.ndarray, grid: Grid) -> None:
    """Writes an image, in mm."""
    nifti = nibabel.Nifti1Image(image, affine_of(grid))
    nifti.header.set_xyzt_units("mm")
    nifti.set_sform(affine_of(grid), code=1)
    nifti.set_qform(affine_of(grid), code=1)
    nibabel.save(nifti, path)
