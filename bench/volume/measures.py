"""Measures of a volume mesh by VTK, which none of the programs compared here uses to judge its own.

Angles alone are computed here: VTK 9.7's smallest angle of a tetrahedron is too large for every fourth.

measures.py SURFACE.vtp MESH.vtu prints them as JSON.
"""

from __future__ import annotations

import json
import sys
from itertools import combinations
from pathlib import Path

import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

from surfaces import PYRAMID, TETRAHEDRON, WALL, WEDGE, Surface, grid_of, read_grid, read_surface

# Corners in the other order, which turns a cell inside out and back.
TURNED = {TETRAHEDRON: [0, 2, 1, 3], WEDGE: [0, 2, 1, 3, 5, 4], PYRAMID: [0, 3, 2, 1, 4]}
SIDES = {TETRAHEDRON: [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]],
         WEDGE: [[0, 2, 1], [3, 4, 5], [0, 1, 4, 3], [1, 2, 5, 4], [2, 0, 3, 5]],
         PYRAMID: [[0, 3, 2, 1], [0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]}


def quality(points: np.ndarray, cells: np.ndarray, kind: int, measure: str) -> np.ndarray:
    """One of vtkMeshQuality's measures for each cell."""
    name = {TETRAHEDRON: "Tet", WEDGE: "Wedge", PYRAMID: "Pyramid"}[kind]
    mesh_quality = vtk.vtkMeshQuality()
    getattr(mesh_quality, f"Set{name}QualityMeasureTo{measure}")()
    mesh_quality.SetInputData(grid_of(points, cells, kind))
    mesh_quality.Update()
    return vtk_to_numpy(mesh_quality.GetOutput().GetCellData().GetArray("Quality")).copy()


def least_angles_deg(points: np.ndarray, tetrahedra: np.ndarray) -> np.ndarray:
    """The smallest of the six angles between faces of each."""
    least = np.full(len(tetrahedra), 180.)
    for i, j in combinations(range(4), 2):
        start = points[tetrahedra[:, i]]
        edge = points[tetrahedra[:, j]] - start
        others = [points[tetrahedra[:, k]] - start for k in range(4) if k not in (i, j)]
        first, second = (np.cross(edge, other) for other in others)
        sine = np.linalg.norm(np.cross(first, second), axis=1)
        least = np.minimum(least, np.degrees(np.arctan2(sine, (first * second).sum(axis=1))))
    return least


def upright(points: np.ndarray, cells: dict[int, np.ndarray]) -> dict[int, np.ndarray]:
    """Each kind in the order of corners that makes most of its cells positive, for programs differ in theirs."""
    result = {}
    for kind, corners in cells.items():
        positive = np.count_nonzero(quality(points, corners, kind, "Jacobian") > 0)
        result[kind] = corners if 2 * positive >= len(corners) else corners[:, TURNED[kind]]
    return result


def boundary(cells: dict[int, np.ndarray]) -> list[np.ndarray]:
    """Sides that only one cell has, looking outwards: triangles (n x 3) and quadrilaterals (n x 4)."""
    result = []
    for size in (3, 4):
        sides = [corners[:, side] for kind, corners in cells.items() for side in SIDES[kind] if len(side) == size]
        if not sides:
            continue
        every = np.concatenate(sides)
        _, index, count = np.unique(np.sort(every, axis=1), axis=0, return_index=True, return_counts=True)
        result.append(every[index[count == 1]])
    return result


def triangles_of(sides: list[np.ndarray]) -> np.ndarray:
    """All sides as triangles. Quadrilaterals on a mesh's boundary are those of layers on caps, which are flat."""
    split = [side if side.shape[1] == 3 else np.concatenate([side[:, [0, 1, 2]], side[:, [0, 2, 3]]]) for side in sides]
    return np.concatenate(split) if split else np.empty((0, 3), np.int64)


def area_vectors(points: np.ndarray, faces: np.ndarray) -> np.ndarray:
    corners = points[faces]
    return np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2


def enclosed(points: np.ndarray, faces: np.ndarray) -> float:
    return float((points[faces].mean(axis=1) * area_vectors(points, faces)).sum() / 3)


def cap_differences(surface: Surface, points: np.ndarray, faces: np.ndarray) -> list[float]:
    """Of each cap: how far the area of the mesh's faces on it is from the surface's, as a share of that.

    Faces on it: with all corners in its plane, to a hundredth of its radius, and their centre within that radius.
    """
    vectors, corners = area_vectors(points, faces), points[faces]
    differences = []
    for patch in np.unique(surface.patch[surface.patch != WALL]):
        own = surface.faces[surface.patch == patch]
        normal = area_vectors(surface.points, own).sum(axis=0)
        area = np.linalg.norm(normal)
        normal /= area
        centre = surface.points[np.unique(own)].mean(axis=0)
        reach = np.linalg.norm(surface.points[np.unique(own)] - centre, axis=1).max()
        on = (abs((corners - centre) @ normal) < 1e-2 * reach).all(axis=1)
        on &= np.linalg.norm(corners.mean(axis=1) - centre, axis=1) < reach
        differences.append(abs(float(vectors[on].sum(axis=0) @ normal) / area - 1))
    return differences


def measure(surface: Surface, points: np.ndarray, cells: dict[int, np.ndarray]) -> dict:
    cells = upright(points, cells)
    count = {kind: len(cells.get(kind, ())) for kind in (TETRAHEDRON, WEDGE, PYRAMID)}
    result = {"tetrahedra": count[TETRAHEDRON], "wedges": count[WEDGE], "pyramids": count[PYRAMID], "inverted": 0}
    scaled = []
    for kind, corners in cells.items():
        result["inverted"] += int(np.count_nonzero(~(quality(points, corners, kind, "Jacobian") > 0)))
        scaled.append(quality(points, corners, kind, "ScaledJacobian"))
        if kind == WEDGE:
            result["least_scaled_jacobian_of_wedges"] = float(scaled[-1].min())
    if scaled:
        result["least_scaled_jacobian"] = float(min(values.min() for values in scaled))
    if count[TETRAHEDRON]:
        angle = least_angles_deg(points, cells[TETRAHEDRON])
        ratio = 1 / quality(points, cells[TETRAHEDRON], TETRAHEDRON, "RadiusRatio")  # VTK's is the inverse
        result |= {"least_angle_deg": float(angle.min()), "mean_angle_deg": float(angle.mean()),
                   "least_radius_ratio": float(ratio.min()), "mean_radius_ratio": float(ratio.mean())}
        result["tetrahedra_volume_mm3"] = float(quality(points, cells[TETRAHEDRON], TETRAHEDRON, "Volume").sum())
    outside = triangles_of(boundary(cells))
    own = enclosed(surface.points, surface.faces)
    result["volume_off"] = abs(enclosed(points, outside) / own - 1)
    caps = cap_differences(surface, points, outside)
    result["caps_off"] = max(caps, default=0.)
    if count[TETRAHEDRON] and not count[WEDGE] and not count[PYRAMID]:
        result["cells_volume_off"] = abs(result["tetrahedra_volume_mm3"] / own - 1)
    return result


def main() -> None:
    points, cells = read_grid(Path(sys.argv[2]))
    if not cells:
        sys.exit("there are no cells in it")
    print(json.dumps(measure(read_surface(Path(sys.argv[1])), points, cells)))


if __name__ == "__main__":
    main()
