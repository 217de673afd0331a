"""Random vessels whose topology is known and survives voxelisation: trees, and networks with loops.

Vessels are tortuous and their radii vary; whatever does not meet at a branching stays apart by rejection, so that a
mask of them has their components and loops as long as voxels are not larger than the gap. Lengths are in mm.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass, field

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import minimum_spanning_tree
from scipy.spatial import cKDTree

from graph import Graph, make_graph

STEP = .7  # distance between nodes, in local radii
MEETING = 3.5  # vessels may touch as near as this to the branching where they meet, in its radii
TRIES = 40


def perpendicular(rng: np.random.Generator, direction: np.ndarray) -> np.ndarray:
    """A random unit vector at right angles to a direction."""
    vector = np.cross(direction, rng.normal(size=3))
    return vector / np.linalg.norm(vector)


def turned(direction: np.ndarray, axis: np.ndarray, angle: float) -> np.ndarray:
    """The direction, turned towards an axis at right angles to it."""
    return np.cos(angle) * direction + np.sin(angle) * axis


@dataclass
class Vessels:
    """What was placed so far."""

    gap: float  # least distance between the walls of vessels, mm
    points: list = field(default_factory=list)
    radii: list = field(default_factory=list)
    segments: list = field(default_factory=list)

    def add_node(self, point: np.ndarray, radius: float) -> int:
        self.points.append(point)
        self.radii.append(radius)
        return len(self.points) - 1

    def add_path(self, start: int, points: np.ndarray, radii: np.ndarray, stop: int | None = None) -> int:
        """Adds a vessel from node start (to node stop); points and radii are of the nodes between. Returns the last."""
        node = start
        for point, radius in zip(points, radii):
            following = self.add_node(point, radius)
            self.segments.append((node, following))
            node = following
        if stop is not None:
            self.segments.append((node, stop))
        return node

    def has_room(self, points: np.ndarray, radii: np.ndarray, meetings: list[int]) -> bool:
        """Whether a path keeps apart from all vessels, and from itself, but where both are near a meeting's node."""
        def near(places: np.ndarray) -> list[np.ndarray]:
            return [np.linalg.norm(places - self.points[node], axis=1) < MEETING * self.radii[node]
                    for node in meetings]

        placed, placed_radii = np.array(self.points), np.array(self.radii)
        reach = radii.max() + placed_radii.max() + self.gap
        exempt = list(zip(near(points), near(placed)))
        for i, others in enumerate(cKDTree(placed).query_ball_point(points, reach)):
            others = np.array(others, int)
            distances = np.linalg.norm(placed[others] - points[i], axis=1)
            close = others[distances < radii[i] + placed_radii[others] + self.gap]
            for near_path, near_placed in exempt:
                if near_path[i]:
                    close = close[~near_placed[close]]
            if len(close):
                return False
        # A vessel that returns to itself: nodes that are much farther apart along it than across.
        along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
        for i, j in cKDTree(points).query_pairs(2 * radii.max() + self.gap):
            apart = np.linalg.norm(points[i] - points[j])
            limit = radii[i] + radii[j] + self.gap
            if apart < limit and abs(along[i] - along[j]) > 1.6 * limit:
                return False
        return True

    def graph(self) -> Graph:
        return make_graph(np.array(self.points), np.array(self.radii), np.array(self.segments))


def tortuous_path(rng: np.random.Generator, start: np.ndarray, direction: np.ndarray, radius: float, length: float,
                  tortuosity: float) -> tuple[np.ndarray, np.ndarray]:
    """Nodes of a winding vessel after its start, and their radii, which taper by a sixth and undulate a little.

    The direction turns by a random walk whose steps persist, at most by .2 of a radian a node, so that the curvature
    stays below 1/3 of 1/radius.
    """
    step = STEP * radius
    count = max(4, round(length / step))
    points, turn = [], np.zeros(3)
    for _ in range(count):
        turn = .8 * turn + tortuosity * rng.normal(size=3)
        across = turn - turn @ direction * direction
        size = np.linalg.norm(across)
        if size > 0:
            direction = turned(direction, across / size, min(size, .2))
            direction = direction / np.linalg.norm(direction)
        start = start + step * direction
        points.append(start)
    t = np.arange(1, count + 1) / count
    waves = .05 * np.sin(2 * np.pi * (t * count * STEP / rng.uniform(6, 10) + rng.random()))
    return np.array(points), radius * (1 - t / 6) * (1 + t * waves)


def random_tree(seed: int, ends: int = 8, radius: float = 3, least_radius: float = 1.2, gap: float = 2,
                tortuosity: float = .07) -> Graph:
    """A tree that divides until it has that many ends (its root among them) or no room.

    Radii (mm) at a branching follow Murray's law, the cubes of the daughters' sum up to the parent's, as long as they
    are above least_radius; vessels that start with it keep it but for their taper.
    """
    rng = np.random.default_rng(seed)
    vessels = Vessels(gap)
    root = vessels.add_node(np.zeros(3), radius)
    direction = rng.normal(size=3)
    direction /= np.linalg.norm(direction)
    points, radii = tortuous_path(rng, np.zeros(3), direction, radius, rng.uniform(8, 12) * radius, tortuosity)
    tips = [(vessels.add_path(root, points, radii), points[-1] - points[-2])]
    missing = ends - 2
    while tips and missing > 0:
        node, direction = tips.pop(0)
        daughters = divide(rng, vessels, node, direction / np.linalg.norm(direction), least_radius, tortuosity)
        tips += daughters
        missing -= len(daughters) > 0
    return vessels.graph()


def divide(rng: np.random.Generator, vessels: Vessels, node: int, direction: np.ndarray, least_radius: float,
           tortuosity: float) -> list[tuple[int, np.ndarray]]:
    """Adds two daughters at the end of a vessel; returns their ends and directions, or nothing if there is no room."""
    start, radius = vessels.points[node], vessels.radii[node]
    for _ in range(TRIES):
        share = rng.uniform(.5, .75)
        sizes = np.minimum(radius, np.maximum(least_radius, radius * np.cbrt([share, 1 - share])))
        axis = perpendicular(rng, direction)
        total = rng.uniform(np.radians(75), np.radians(110))
        # The thinner daughter turns more, as in real trees.
        angles = total * np.array([sizes[1], -sizes[0]]) / sizes.sum()
        count = len(vessels.points)
        daughters = []
        for size, angle in zip(sizes, angles):
            points, radii = tortuous_path(rng, start, turned(direction, axis, angle), size,
                                          rng.uniform(7, 16) * size, tortuosity)
            if not vessels.has_room(points, radii, [node]):
                break
            daughters.append((vessels.add_path(node, points, radii), points[-1] - points[-2]))
        if len(daughters) == 2:
            return daughters
        del vessels.points[count:], vessels.radii[count:]
        vessels.segments[:] = [segment for segment in vessels.segments if max(segment) < count]
    return []


def random_network(seed: int, loops: int, cells: tuple[int, int, int] = (3, 3, 2), radius: float = 2,
                   spacing: float = 14, gap: float = 2) -> Graph:
    """One component with that many loops: a spanning tree of a jittered lattice, some more of its edges, all bent.

    The lattice has `cells` nodes along x, y and z, `spacing` radii (mm) apart. Radii vary by a third.
    """
    rng = np.random.default_rng(seed)
    lattice = np.array(list(itertools.product(*(range(n) for n in cells))))
    edges = np.array([pair for pair in itertools.combinations(range(len(lattice)), 2)
                      if np.abs(lattice[pair[0]] - lattice[pair[1]]).sum() == 1])
    weights = rng.random(len(edges)) + .1
    tree = minimum_spanning_tree(coo_matrix((weights, edges.T), shape=(len(lattice),) * 2)).tocoo()
    kept = {(int(min(a, b)), int(max(a, b))) for a, b in zip(tree.row, tree.col)}
    others = [edge for edge in map(tuple, edges.tolist()) if edge not in kept]
    if loops > len(others):
        raise ValueError(f"a lattice of {cells} has {len(others)} loops at most, not {loops}")
    kept |= {others[i] for i in rng.choice(len(others), loops, replace=False)}

    vessels = Vessels(gap)
    places = spacing * radius * (lattice + rng.uniform(-.1, .1, size=lattice.shape))
    for place, size in zip(places, radius * rng.uniform(.75, 1.3, size=len(places))):
        vessels.add_node(place, size)
    for a, b in sorted(kept):
        add_bent_vessel(rng, vessels, a, b, bend=.15 * spacing * radius)
    return vessels.graph()


def add_bent_vessel(rng: np.random.Generator, vessels: Vessels, a: int, b: int, bend: float) -> None:
    """Joins two nodes by a vessel that bends aside, up to `bend` (mm), as far as there is room."""
    start, stop = vessels.points[a], vessels.points[b]
    length = np.linalg.norm(stop - start)
    count = max(6, round(length / (STEP * min(vessels.radii[a], vessels.radii[b]))))
    t = np.arange(1, count) / count
    for attempt in range(TRIES):
        limit = bend * (1 - attempt / TRIES)
        aside = limit * rng.uniform(.4, 1) * perpendicular(rng, (stop - start) / length)
        winding = .5 * limit * perpendicular(rng, (stop - start) / length)
        # Both vanish with their slopes at the ends, so that vessels keep their angles where they meet.
        points = start + t[:, None] * (stop - start) + (np.sin(np.pi * t)**2)[:, None] * aside \
            + (np.sin(np.pi * t)**2 * np.sin(2 * np.pi * t))[:, None] * winding
        radii = (vessels.radii[a] + t * (vessels.radii[b] - vessels.radii[a])) \
            * (1 - rng.uniform(0, .25) * np.sin(np.pi * t)**2)
        if vessels.has_room(points, radii, [a, b]):
            vessels.add_path(a, points, radii, stop=b)
            return
    raise ValueError(f"no room for a vessel between nodes {a} and {b}; another seed or a larger spacing has")
