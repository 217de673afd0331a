"""Centerlines as graphs: reading, writing, counting, sampling. Positions and radii are in mm, the frame is LPS."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components


@dataclass(frozen=True)
class Graph:
    """A centerline: nodes with radii, and the segments between them, each a vessel shaped like a round cone."""

    points: np.ndarray  # N x 3, mm, LPS
    radii: np.ndarray  # N, mm
    segments: np.ndarray  # M x 2, indices of nodes

    @property
    def lengths(self) -> np.ndarray:
        """The length of each segment, mm."""
        return np.linalg.norm(self.points[self.segments[:, 1]] - self.points[self.segments[:, 0]], axis=1)

    @property
    def degrees(self) -> np.ndarray:
        """The number of segments at each node."""
        return np.bincount(self.segments.ravel(), minlength=len(self.points))

    @property
    def parts(self) -> tuple[int, np.ndarray]:
        """The number of components that have a segment, and the component of each node (-1 without segments)."""
        count = len(self.points)
        a, b = self.segments.T
        labels = connected_components(coo_matrix((np.ones(len(a)), (a, b)), shape=(count, count)), directed=False)[1]
        labels[self.degrees == 0] = -1
        used, compact = np.unique(labels, return_inverse=True)
        shift = 1 if len(used) and used[0] == -1 else 0
        return len(used) - shift, compact.reshape(-1) - shift

    @property
    def loops(self) -> int:
        """The cycle rank: segments that can be taken away without dividing a component."""
        return len(self.segments) - int((self.degrees > 0).sum()) + self.parts[0]


def make_graph(points, radii, segments) -> Graph:
    """A graph whose nodes at one position are one node, without repeated segments or those from a node to itself."""
    points = np.asarray(points, float).reshape(-1, 3)
    radii = np.asarray(radii, float).reshape(-1)
    segments = np.asarray(segments, int).reshape(-1, 2)
    if not len(points):
        return Graph(points, radii, segments)
    _, first, node_of = np.unique(points, axis=0, return_index=True, return_inverse=True)
    # Nodes keep their order, so that a file that is read and written again remains the same.
    order = np.argsort(np.argsort(first))
    segments = np.sort(order[node_of.reshape(-1)][segments], axis=1)
    segments = np.unique(segments[segments[:, 0] != segments[:, 1]], axis=0)
    kept = np.sort(first)
    return Graph(points[kept], radii[kept], segments)


def read_swc(path: Path) -> Graph:
    """Reads an SWC file whose numbers are mm in LPS, as vmesh takes them."""
    rows = [line.split() for line in path.read_text().splitlines() if line.strip() and not line.startswith("#")]
    index = {int(row[0]): i for i, row in enumerate(rows)}
    numbers = np.array([[float(value) for value in row[2:6]] for row in rows])
    segments = [(index[int(row[6])], i) for i, row in enumerate(rows) if int(row[6]) in index]
    return with_radii(make_graph(numbers[:, :3], numbers[:, 3], segments))


def with_radii(graph: Graph) -> Graph:
    """Nodes whose radius is 0, which a file means as unknown, get the mean of their neighbours', over and over."""
    radii = graph.radii.copy()
    while (radii <= 0).any() and (radii > 0).any():
        sums, known = np.zeros(len(radii)), np.zeros(len(radii))
        for a, b in (graph.segments.T, graph.segments.T[::-1]):
            np.add.at(sums, b, np.maximum(radii[a], 0))
            np.add.at(known, b, radii[a] > 0)
        unknown = (radii <= 0) & (known > 0)
        if not unknown.any():
            break
        radii[unknown] = sums[unknown] / known[unknown]
    return Graph(graph.points, radii, graph.segments)


def read_json(path: Path) -> Graph:
    """Reads vmesh's JSON of a centerline."""
    content = json.loads(path.read_text())
    if content.get("unit", "mm") != "mm" or content.get("space", "LPS") != "LPS":
        raise ValueError(f"{path}: expected mm and LPS, got {content.get('unit')} and {content.get('space')}")
    nodes = np.array(content["nodes"], float).reshape(-1, 4)
    return make_graph(nodes[:, :3], nodes[:, 3], content["segments"])


def write_json(path: Path, graph: Graph) -> None:
    """Writes vmesh's JSON of a centerline."""
    nodes = np.column_stack([graph.points, graph.radii]).tolist()
    content = {"schema": "vmesh.centerline/1", "space": "LPS", "unit": "mm", "generator": "bench_centerline",
               "nodes": nodes, "segments": graph.segments.tolist()}
    path.write_text(json.dumps(content))


def write_swc(path: Path, graph: Graph) -> None:
    """Writes a forest as SWC, each tree from its lowest node on."""
    if graph.loops:
        raise ValueError(f"{path}: SWC has no loops, and the centerline has {graph.loops}")
    neighbours: list[list[int]] = [[] for _ in graph.points]
    for a, b in graph.segments.tolist():
        neighbours[a].append(b)
        neighbours[b].append(a)
    number: dict[int, int] = {}
    lines = []
    for root in range(len(graph.points)):
        stack = [(root, -1)] if root not in number else []
        while stack:
            node, parent = stack.pop()
            number[node] = len(number) + 1
            x, y, z = graph.points[node]
            lines.append(f"{number[node]} 3 {x:.9g} {y:.9g} {z:.9g} {graph.radii[node]:.9g} {parent}")
            stack += [(other, number[node]) for other in neighbours[node] if other not in number]
    path.write_text("\n".join(lines) + "\n")


def component(graph: Graph, label: int) -> Graph:
    """The component of that label alone."""
    inside = graph.parts[1] == label
    segments = graph.segments[inside[graph.segments[:, 0]]]
    renumbered = np.cumsum(inside) - 1
    return Graph(graph.points[inside], graph.radii[inside], renumbered[segments])


@dataclass(frozen=True)
class Samples:
    """Points along a graph, each in the middle of a piece of a segment."""

    points: np.ndarray  # mm
    radii: np.ndarray  # mm, interpolated along the segment
    lengths: np.ndarray  # of the pieces, mm; their sum is the length of the graph
    segments: np.ndarray  # the segment of each


def sample(graph: Graph, step: float) -> Samples:
    """Divides every segment into equal pieces no longer than step (mm), and takes the middle of each."""
    lengths = graph.lengths
    pieces = np.maximum(1, np.ceil(lengths / step).astype(int))
    segment = np.repeat(np.arange(len(lengths)), pieces)
    within = np.arange(len(segment)) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    t = (within + .5) / pieces[segment]
    a, b = graph.segments[segment].T
    points = graph.points[a] + t[:, None] * (graph.points[b] - graph.points[a])
    radii = graph.radii[a] + t * (graph.radii[b] - graph.radii[a])
    return Samples(points, radii, lengths[segment] / pieces[segment], segment)
