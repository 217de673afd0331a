"""How an extracted centerline compares with the true one.

Lengths are weighted by the length that a sample stands for. Two of the measures need a tolerance, half of the true
radius or a voxel if that is more; `voxel` is the side of a cube with a voxel's volume, mm.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from graph import Graph, Samples, sample

WIDE = 2  # voxels: a vessel whose radius is at least that is wide, others are thin
NEIGHBOURS = 8  # samples near a point whose segments are candidates for the nearest


@dataclass(frozen=True)
class Feet:
    """The nearest points of a graph."""

    distances: np.ndarray  # mm
    radii: np.ndarray  # of the graph there, mm


def nearest(graph: Graph, samples: Samples, points: np.ndarray) -> Feet:
    """The nearest points on the segments of a graph, not on its samples, which only say what segments are near."""
    count = min(NEIGHBOURS, len(samples.points))
    _, near = cKDTree(samples.points).query(points, k=count)
    segments = graph.segments[samples.segments[near.reshape(len(points), count)]]
    start, stop = graph.points[segments[..., 0]], graph.points[segments[..., 1]]
    direction = stop - start
    squared = np.maximum((direction**2).sum(axis=2), 1e-300)
    t = np.clip(((points[:, None] - start) * direction).sum(axis=2) / squared, 0, 1)
    distances = np.linalg.norm(start + t[..., None] * direction - points[:, None], axis=2)
    radii = graph.radii[segments[..., 0]] * (1 - t) + graph.radii[segments[..., 1]] * t
    best = np.argmin(distances, axis=1)[:, None]
    return Feet(np.take_along_axis(distances, best, 1)[:, 0], np.take_along_axis(radii, best, 1)[:, 0])


def mean(values: np.ndarray, weights: np.ndarray) -> float | None:
    return float(np.average(values, weights=weights)) if weights.sum() > 0 else None


def percentile(values: np.ndarray, weights: np.ndarray, share: float) -> float | None:
    """The value that the given share of the weights does not exceed."""
    if weights.sum() <= 0:
        return None
    order = np.argsort(values)
    reached = np.cumsum(weights[order])
    return float(values[order][np.searchsorted(reached, share * reached[-1])])


def branchings(graph: Graph) -> int:
    """Nodes where three or more vessels meet; several that lie within a radius along the vessels count once.

    Programs place the two branchings of a trifurcation as one node or as two, and clusters of voxels as many.
    """
    neighbours: list[list[int]] = [[] for _ in graph.points]
    for a, b in graph.segments.tolist():
        neighbours[a].append(b)
        neighbours[b].append(a)
    branching = np.flatnonzero(graph.degrees >= 3).tolist()
    cluster = {node: node for node in branching}

    def find(node: int) -> int:
        while cluster[node] != node:
            node = cluster[node]
        return node

    for start in branching:
        for following in neighbours[start]:
            before, node, length = start, following, 0.
            while True:
                length += float(np.linalg.norm(graph.points[node] - graph.points[before]))
                if node in cluster or len(neighbours[node]) != 2 or length > graph.radii[start]:
                    break
                before, node = node, next(other for other in neighbours[node] if other != before)
            if node in cluster and length <= graph.radii[start]:
                cluster[find(node)] = find(start)
    return sum(cluster[node] == node for node in branching)


def counts(graph: Graph) -> dict[str, int]:
    """Of what a graph consists."""
    return {"components": graph.parts[0], "ends": int((graph.degrees == 1).sum()), "branchings": branchings(graph),
            "loops": graph.loops}


def within(points: np.ndarray, centres: np.ndarray, reach: np.ndarray) -> np.ndarray:
    """Whether each point is nearer than `reach` (one for each centre, mm) to a centre."""
    result = np.zeros(len(points), bool)
    if len(points):
        tree = cKDTree(points)
        for centre, distance in zip(centres, reach):
            result[tree.query_ball_point(centre, distance)] = True
    return result


def compare(truth: Graph, extracted: Graph, voxel: float) -> dict:
    """All measures. Errors of position and radius are over the true length that was found, shares over all of it.

    recall: share of the true length that is within the tolerance of what was extracted
    precision: share of the extracted length that is within the tolerance of the truth
    position_mean, position_p95: distance from the truth to what was extracted, in true radii
    radius_mean, radius_p95: relative error of the radius without its sign, farther than a radius from true ends
    radius_bias: the same with its sign, mean
    ends_found: true ends with something extracted within 1.5 radii and a voxel; ends_false: extracted ends that are not
    that near to a true one
    The groups "wide" and "thin" are the vessels whose true radius is at least WIDE voxels, and the others.
    """
    step = max(.1, .25 * voxel)
    true_samples, samples = sample(truth, step), sample(extracted, step)
    true_ends = truth.degrees == 1
    ends, end_radii = truth.points[true_ends], truth.radii[true_ends]
    end_reach = 1.5 * end_radii + voxel
    result: dict = {"true": counts(truth), "extracted": counts(extracted), "true_length": float(truth.lengths.sum()),
                    "extracted_length": float(extracted.lengths.sum())}
    if not len(samples.points):
        return {**result, "ends_found": 0, "ends_false": 0, "all": {"recall": 0.}, "wide": {}, "thin": {}}

    feet = nearest(extracted, samples, true_samples.points)
    found = feet.distances < np.maximum(.5 * true_samples.radii, voxel)
    position = feet.distances / true_samples.radii
    radius = feet.radii / true_samples.radii - 1
    inner = found & ~within(true_samples.points, ends, end_radii)
    back = nearest(truth, true_samples, samples.points)
    right = back.distances < np.maximum(.5 * back.radii, voxel)

    def group(of_truth: np.ndarray, of_extracted: np.ndarray) -> dict[str, float | None]:
        true_length, length = true_samples.lengths * of_truth, samples.lengths * of_extracted
        return {
            "true_length": float(true_length.sum()),
            "recall": mean(found, true_length),
            "precision": mean(right, length),
            "position_mean": mean(position, true_length * found),
            "position_p95": percentile(position, true_length * found, .95),
            "radius_mean": mean(np.abs(radius), true_length * inner),
            "radius_p95": percentile(np.abs(radius), true_length * inner, .95),
            "radius_bias": mean(radius, true_length * inner),
        }

    wide, wide_back = true_samples.radii >= WIDE * voxel, back.radii >= WIDE * voxel
    extracted_ends = extracted.points[extracted.degrees == 1]
    result["ends_found"] = int(sum(nearest(extracted, samples, ends).distances < end_reach)) if len(ends) else 0
    result["ends_false"] = int((~within(extracted_ends, ends, end_reach)).sum())
    result["all"] = group(np.ones(len(wide), bool), np.ones(len(wide_back), bool))
    result["wide"] = group(wide, wide_back)
    result["thin"] = group(~wide, ~wide_back)
    return result
