"""Centerlines and meshes that tests are about."""

import numpy as np

# A fork of three branches.
FORK = (
    np.array([[0, 0, 0], [10, 0, 0], [20, 0, 0], [28, 6, 0], [28, -6, 0]], dtype=float),
    np.array([2, 2, 1.8, 1.3, 1.3]),
    np.array([[0, 1], [1, 2], [2, 3], [2, 4]]),
)

# Two vessels that cross at right angles without touching ends.
CROSSING = (
    np.array([[-10, 0, 0], [10, 0, 0], [0, -10, 0.5], [0, 10, 0.5]], dtype=float),
    np.array([2.0, 2, 2, 2]),
    np.array([[0, 1], [2, 3]]),
)


def straight(length=20.0, radius=2.0, segments=10):
    """A straight vessel along x."""
    nodes = np.zeros((segments + 1, 3))
    nodes[:, 0] = np.linspace(0, length, segments + 1)
    numbers = np.arange(segments)
    return nodes, np.full(segments + 1, radius), np.column_stack([numbers, numbers + 1])


def box(side=1.0, origin=(0, 0, 0)):
    """A cube of twelve triangles, facing outwards."""
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    faces = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1]]
    faces += [[2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
    return side * corners + np.asarray(origin, dtype=float), np.array(faces)
