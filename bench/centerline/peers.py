"""Other programs that extract centerlines: peers.py PEER FOLDER OUTPUT.json runs one of them on a case.

Each gets the mask in memory, its cavities filled, as they would all trace something around each. Reading it, that
filling, and making a graph in our form of the result are not timed. The output has nodes and segments as vmesh's JSON;
a file beside it has the CPU seconds of the peer. Peers are imported only when they run, for each has an environment
that may lack the others.
"""

from __future__ import annotations

import json
import resource
import sys
import time
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import nibabel
import numpy as np
from scipy.ndimage import binary_fill_holes

from graph import Graph, make_graph, read_json, write_json


@dataclass(frozen=True)
class Image:
    """A mask with its places in LPS, mm: voxel (i, j, k) has its centre at origin + voxel * (i, j, k)."""

    values: np.ndarray
    level: float  # reached inside
    voxel: np.ndarray
    origin: np.ndarray
    true_tips: np.ndarray  # where true vessels end on their axes, mm; only for peers that must be told
    tip_radii: np.ndarray  # mm

    @property
    def mask(self) -> np.ndarray:
        return self.values >= self.level


class Stopwatch:
    """CPU seconds of this process, user and system, of all that is done within `with`."""

    seconds = 0.

    def __enter__(self) -> None:
        self.start = self.now()

    def __exit__(self, *_) -> None:
        self.seconds += self.now() - self.start

    @staticmethod
    def now() -> float:
        usages = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
        return sum(usage.ru_utime + usage.ru_stime for usage in usages)


def read_case(folder: Path) -> Image:
    """Reads what make_case() wrote, and fills cavities."""
    case = json.loads((folder / "case.json").read_text())
    nifti = nibabel.load(folder / "mask.nii.gz")
    to_lps = np.array([-1, -1, 1])
    values, level = np.asarray(nifti.dataobj), case["threshold"] or .5
    cavities = binary_fill_holes(values >= level) & (values < level)
    return Image(np.where(cavities, values.max(), values), level, to_lps * np.diag(nifti.affine)[:3],
                 to_lps * nifti.affine[:3, 3], *tips(read_json(folder / "truth.json")))


def tips(truth: Graph) -> tuple[np.ndarray, np.ndarray]:
    """The points of the vessels' round ends that are farthest out, and the radii there, mm."""
    end = truth.degrees == 1
    at_end = [(a, b) if end[a] else (b, a) for a, b in truth.segments.tolist() if end[a] or end[b]]
    if not at_end:
        return np.empty((0, 3)), np.empty(0)
    ends, before = np.array(at_end).T
    outward = truth.points[ends] - truth.points[before]
    outward /= np.linalg.norm(outward, axis=1)[:, None]
    return truth.points[ends] + truth.radii[ends, None] * outward, truth.radii[ends]


# scikit-image: thinning by Lee et al. 1994, and what everybody adds to it


def lee(image: Image, watch: Stopwatch) -> Graph:
    """Thinning, radii from the distance transform, and pruning of spurs that are shorter than the radius."""
    from scipy import ndimage
    from skimage.morphology import skeletonize

    mask = image.mask
    with watch:
        skeleton = skeletonize(mask, method="lee")
        distance = ndimage.distance_transform_edt(mask, sampling=image.voxel)
        voxels = np.argwhere(skeleton)
        neighbours = voxel_graph(voxels, image.voxel)
        radii = distance[tuple(voxels.T)]
        points = voxels * image.voxel
        prune_spurs(neighbours, points, radii)
    segments = [(a, b) for a, others in neighbours.items() for b in others if a < b]
    return subgraph(image.origin + points, radii, segments)


def voxel_graph(voxels: np.ndarray, sides: np.ndarray) -> dict[int, set[int]]:
    """The neighbours of each voxel of a skeleton: a spanning forest, and the pairs that close loops.

    Where vessels meet, several voxels touch each other, which is no loop; one has more voxels on its way around.
    """
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import minimum_spanning_tree
    from scipy.spatial import cKDTree

    around_a_clump = 6
    neighbours: dict[int, set[int]] = {i: set() for i in range(len(voxels))}
    pairs = cKDTree(voxels).query_pairs(1.8, output_type="ndarray")
    lengths = np.linalg.norm((voxels[pairs[:, 0]] - voxels[pairs[:, 1]]) * sides, axis=1)
    forest = minimum_spanning_tree(coo_matrix((lengths, pairs.T), shape=(len(voxels),) * 2)).tocoo()
    for a, b in zip(forest.row.tolist(), forest.col.tolist()):
        neighbours[a].add(b)
        neighbours[b].add(a)
    for a, b in pairs.tolist():
        reached = frontier = {a}
        for _ in range(around_a_clump):
            frontier = {other for node in frontier for other in neighbours[node]} - reached
            reached = reached | frontier
        if b not in reached:
            neighbours[a].add(b)
            neighbours[b].add(a)
    return neighbours


def prune_spurs(neighbours: dict[int, set[int]], points: np.ndarray, radii: np.ndarray) -> None:
    """Removes branches that end within the radius of where they begin, the shortest first."""
    removed = True
    while removed:
        removed = False
        spurs = []
        for tip in [node for node, others in neighbours.items() if len(others) == 1]:
            path, node, length = [tip], next(iter(neighbours[tip])), 0.
            length += float(np.linalg.norm(points[node] - points[tip]))
            while len(neighbours[node]) == 2:
                following = next(other for other in neighbours[node] if other != path[-1])
                path.append(node)
                length += float(np.linalg.norm(points[following] - points[node]))
                node = following
            if len(neighbours[node]) > 2 and length < radii[node]:
                spurs.append((length, path, node))
        for _, path, node in sorted(spurs):
            if len(neighbours[node]) > 2:  # else the spur became the end of a longer branch
                neighbours[node].discard(path[-1])
                for gone in path:
                    del neighbours[gone]
                removed = True


# kimimaro: TEASAR, paths through the distance field


def kimimaro(image: Image, watch: Stopwatch) -> Graph:
    """Paths, 2 radii and 4 voxels apart, the best of those settings that were tried; its own are for nanometres.

    With its option fix_branching, which is on unless it is told, masks with tunnels get ten times as many false ends.
    """
    import kimimaro as package

    labels = np.asfortranarray(image.mask.astype(np.uint8))
    size = float(np.prod(image.voxel)**(1 / 3))
    with watch:
        skeletons = package.skeletonize(
            labels, teasar_params={"scale": 2, "const": 4 * size}, anisotropy=tuple(image.voxel.tolist()),
            fix_branching=False, dust_threshold=10, progress=False, parallel=1)
    skeleton = skeletons[1]
    # Its vertices are multiples of the voxel, the first voxel at 0.
    return make_graph(image.origin + skeleton.vertices, skeleton.radius, skeleton.edges)


# skeletor: wavefronts over a surface


def skeletor(image: Image, watch: Stopwatch) -> Graph:
    """Waves over marching cubes of the mask, which are timed too."""
    import skeletor as package
    import trimesh
    from skimage.measure import marching_cubes

    with watch:
        vertices, faces, _, _ = marching_cubes(image.values.astype(np.float32), image.level, spacing=image.voxel)
        mesh = trimesh.Trimesh(vertices, faces, process=True)
        nodes = package.skeletonize.by_wavefront(mesh, waves=1, step_size=1, progress=False).swc
    index = {node: i for i, node in enumerate(nodes.node_id)}
    segments = [(index[node], index[parent]) for node, parent in zip(nodes.node_id, nodes.parent_id)
                if parent in index]
    return subgraph(image.origin + nodes[["x", "y", "z"]].to_numpy(), nodes.radius.to_numpy(), segments)


def subgraph(points: np.ndarray, radii: np.ndarray, segments: list[tuple[int, int]]) -> Graph:
    """The graph without nodes that no segment has."""
    used, numbers = np.unique(np.array(segments, int).reshape(-1, 2), return_inverse=True)
    return make_graph(points[used], radii[used], numbers.reshape(-1, 2))


def vmtk_centerlines(image: Image, watch: Stopwatch) -> Graph:
    import peers_vmtk
    return peers_vmtk.centerlines(image, watch)


def vmtk_network(image: Image, watch: Stopwatch) -> Graph:
    import peers_vmtk
    return peers_vmtk.network(image, watch)


# Each with the packages whose versions are of interest. Those of VMTK need another environment.
PEERS = {
    "lee": (lee, ["scikit-image", "scipy"]),
    "kimimaro": (kimimaro, ["kimimaro"]),
    "skeletor": (skeletor, ["skeletor", "trimesh"]),
    "vmtkcenterlines": (vmtk_centerlines, ["vmtk", "vtk"]),
    "vmtknetworkextraction": (vmtk_network, ["vmtk", "vtk"]),
}


def version_of(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return "unknown"


def main() -> None:
    peer, packages = PEERS[sys.argv[1]]
    output = Path(sys.argv[3])
    image = read_case(Path(sys.argv[2]))
    watch = Stopwatch()
    start = time.monotonic()
    graph = peer(image, watch)
    if not len(graph.segments):
        sys.exit("it found nothing")
    write_json(output, graph)
    measured = {"cpu_seconds": watch.seconds, "whole_seconds": time.monotonic() - start,
                "versions": {package: version_of(package) for package in packages}}
    output.with_suffix(".measured.json").write_text(json.dumps(measured))


if __name__ == "__main__":
    main()
