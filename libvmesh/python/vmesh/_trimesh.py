"""Surfaces to and from trimesh, which is imported only when needed."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._core import Surface


def to_trimesh(surface: Surface) -> Any:
    """The surface as a trimesh.Trimesh with its attributes; vertices and faces are copied and keep their order.

    Raises ImportError without trimesh.
    """
    try:
        import trimesh
    except ImportError as error:
        raise ImportError("trimesh is needed: pip install trimesh") from error
    return trimesh.Trimesh(
        vertices=np.array(surface.vertices),
        faces=surface.faces.astype(np.int64),
        process=False,  # which would merge vertices
        vertex_attributes={name: np.array(values) for name, values in surface.vertex_attributes.items()},
        face_attributes={name: np.array(values) for name, values in surface.face_attributes.items()},
    )


def from_trimesh(mesh: Any) -> Surface:
    """A Surface from the vertices and faces of `mesh`, a trimesh.Trimesh, mm."""
    return Surface(np.asarray(mesh.vertices), np.asarray(mesh.faces))
