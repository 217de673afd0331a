"""From arrays to a surface: python3 examples/surface_from_numpy.py [OUTPUT.ply]

A vessel that winds up a helix and becomes thinner, with a branch.
"""

import sys
from typing import Tuple

import numpy as np
import vmesh
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


def helix(turns: float = 1.5, count: int = 80) -> Tuple[Floats, Floats, Integers]:
    """Nodes (n, 3) and radii (n,) in mm, and segments (n - 1, 2)."""
    angle = np.linspace(0, 2 * np.pi * turns, count)
    nodes = np.column_stack([20 * np.cos(angle), 20 * np.sin(angle), 4 * angle])
    radii = np.linspace(3.0, 1.5, count)
    numbers = np.arange(count)
    return nodes, radii, np.column_stack([numbers[:-1], numbers[1:]])


def with_branch(
    nodes: Floats, radii: Floats, segments: Integers, at: int, to: Floats
) -> Tuple[Floats, Floats, Integers]:
    """The same with a straight branch of four segments from node `at` to a point."""
    share = np.linspace(0, 1, 5)[1:, None]
    numbers = np.concatenate([[at], len(nodes) + np.arange(4)])
    return (
        np.vstack([nodes, (1 - share) * nodes[at] + share * to]),
        np.concatenate([radii, np.full(4, 0.6 * radii[at])]),
        np.vstack([segments, np.column_stack([numbers[:-1], numbers[1:]])]),
    )


def main() -> None:
    nodes, radii, segments = with_branch(*helix(), at=30, to=np.array([-35.0, 10.0, 20.0]))
    surface = vmesh.generate(nodes, radii, segments, around=8)
    print(surface)

    # Arrays look into the surface, nothing is copied. Every vertex knows where on the centerline it belongs.
    skewness = surface.skewness
    print(f"skewness {skewness.mean():.3f} mean, {skewness.max():.3f} max")
    branches = surface.branch
    assert branches is not None and surface.radius is not None
    for label in np.unique(branches):
        inside = branches == label
        print(f"branch {label}: {inside.sum()} vertices, radius {surface.radius[inside].mean():.2f} mm in the mean")

    distance = vmesh.evaluate(surface, centerline=surface.centerline).vessel
    assert distance is not None
    millimetres = distance.from_surface.mm
    print(f"distance from the vessels: {millimetres.mean:.3f} mm mean, {millimetres.max:.3f} max")
    if len(sys.argv) > 1:
        surface.save(sys.argv[1])
        print(f"wrote {sys.argv[1]}")
    # To look at it: import pyvista; pyvista.wrap(surface.to_vtk()).plot(scalars="radius")


if __name__ == "__main__":
    main()
