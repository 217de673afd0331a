"""The cases: which trees, voxelised how. A case's name says all: TREE-VOXEL[-rough|-grey], the voxel in mm."""

from __future__ import annotations

import functools
import hashlib
import json
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Callable

import numpy as np

from graph import Graph, component, read_json, read_swc, write_json, write_swc
from trees import random_network, random_tree
from voxelise import GREY_FULL, grid_around, partial_volumes, roughen, topology, voxelise, write_nifti


class Unavailable(Exception):
    """What a case needs is not there: the data's folder, or vmesh."""


@dataclass(frozen=True)
class Sources:
    """Where trees come from that are not made here."""

    vmesh: Path | None  # for its `synth`, and to read formats other than SWC
    data: Path | None

    def run_vmesh(self, *arguments: str | Path) -> Graph:
        """The centerline that a verb of vmesh writes."""
        if self.vmesh is None:
            raise Unavailable("needs vmesh")
        with tempfile.TemporaryDirectory() as folder:
            output = Path(folder) / "tree.json"
            command = [self.vmesh, *arguments, "-o", output, "--quiet"]
            subprocess.run([str(part) for part in command], check=True, stderr=subprocess.DEVNULL)
            return read_json(output)

    def file(self, name: str) -> Path:
        if self.data is None or not (self.data / name).exists():
            raise Unavailable(f"needs {name} in the data's folder (--data)")
        return self.data / name


Tree = Callable[[Sources], Graph]


def synth(vertices: int, seed: int) -> Tree:
    return lambda sources: sources.run_vmesh("synth", "--vertices", str(vertices), "--seed", str(seed))


def swc(name: str) -> Tree:
    return lambda sources: read_swc(sources.file(name))


@functools.lru_cache(maxsize=None)
def converted(sources: Sources, name: str) -> Graph:
    """A file of micrometres, taken as mm: only ratios matter, and vmesh rounds to nanometres."""
    return sources.run_vmesh("convert", sources.file(name), "--unit", "mm", "--space", "LPS")


def network_of(name: str, rank: int) -> Tree:
    """The component with the most loops (rank 0), with the next most ..."""
    def tree(sources: Sources) -> Graph:
        graph = converted(sources, name)
        parts = [component(graph, label) for label in range(graph.parts[0])]
        return sorted(parts, key=lambda part: (-part.loops, -len(part.points)))[rank]
    return tree


BRAIN, LIVER = "brain_brava_swc", "liver_portal_centerlines/liverModelPatient1__"
MICRO = "microvascular_loops/vasculature"

TREES: dict[str, Tree] = {
    # for many sizes of voxels: radii 1.6 to 1
    "twigs": lambda _: random_tree(seed=11, ends=5, radius=1.6, least_radius=1.2),
    # radii 3 to .8
    **{f"random{seed}": functools.partial(lambda seed, _: random_tree(seed, ends=10), seed) for seed in range(1, 7)},
    # radii 8 to 3, as far apart as thick slices need
    **{f"thick{seed}": functools.partial(
        lambda seed, _: random_tree(20 + seed, ends=7, radius=8, least_radius=4, gap=6), seed) for seed in (1, 2, 3)},
    # networks with 2, 4, 6, 8 loops; radii 1.3 to 2.6
    **{f"network{loops}": functools.partial(lambda loops, _: random_network(loops, loops), loops)
       for loops in (2, 4, 6, 8)},
    "synth60": synth(60, 1),
    "synth119": synth(119, 7),
    "synth200": synth(200, 2),
    "synth400": synth(400, 3),
    "tree119": swc("synthetic_trees/tree119.swc"),
    "portal1": swc(f"{LIVER}portal1_1.swc"),
    "hepatic15": swc(f"{LIVER}hepatic15_1.swc"),
    "BG001": swc(f"{BRAIN}/BG001.CNG.swc"),
    "BG0002": swc(f"{BRAIN}/BG0002.CNG.swc"),
    # capillaries: 15 trees, and the components of a larger network with the most loops, 8, 6, 5 and 5
    "micro-forest": lambda sources: converted(sources, f"{MICRO}2.vtp"),
    **{f"micro{rank + 1}": network_of(f"{MICRO}1.vtp", rank) for rank in range(4)},
}


@dataclass(frozen=True)
class Case:
    """A tree, voxelised in one way."""

    tree: str
    voxel: tuple[float, float, float]  # sides, mm
    kind: str = "clean"  # or rough: voxels at the boundary flipped; or grey: partial volumes
    seed: int = 1  # of the flips

    @property
    def name(self) -> str:
        sides = [f"{side:g}" for side in self.voxel]
        voxel = sides[0] if len(set(sides)) == 1 else "x".join(sides)
        return f"{self.tree}-{voxel}" + ("" if self.kind == "clean" else f"-{self.kind}")

    @property
    def size(self) -> float:
        """The side of a cube with the voxel's volume, mm: what measures and limits take for the voxel."""
        return float(np.prod(self.voxel)**(1 / 3))

    @property
    def threshold(self) -> float | None:
        """Of a grey image: the value that is reached within a vessel."""
        return GREY_FULL / 2 if self.kind == "grey" else None


def cube(tree: str, side: float, kind: str = "clean") -> Case:
    return Case(tree, (side, side, side), kind)


CASES: list[Case] = [
    # 1 to 8 voxels a radius of 1.2
    *(cube("twigs", round(1.2 / voxels, 2)) for voxels in (1, 1.5, 2, 3, 4, 6, 8)),
    *(cube("twigs", round(1.2 / voxels, 2), "rough") for voxels in (1.5, 3, 6)),
    *(cube("twigs", round(1.2 / voxels, 2), "grey") for voxels in (1, 2, 4)),
    cube("random1", .5), cube("random2", .5), cube("random3", .8),
    cube("random1", .5, "rough"), cube("random4", .6, "rough"), cube("random3", .8, "rough"),
    cube("random5", .5, "grey"), cube("random3", .8, "grey"),
    # slices
    Case("random6", (.3, .3, 1.5)), Case("random6", (.3, .3, 1.5), "rough"),
    Case("thick1", (1, 1, 5)), Case("thick2", (1, 1, 5)), Case("thick3", (1, 1, 5)),
    Case("thick1", (1, 1, 5), "rough"), Case("thick1", (1, 1, 5), "grey"),
    # loops
    cube("network2", .6), cube("network4", .6), cube("network6", .6), cube("network8", .6),
    cube("network4", .6, "rough"), cube("network8", .9, "rough"), cube("network6", .9, "grey"),
    Case("network4", (.4, .4, 1.6)),
    # vmesh's own trees
    cube("synth60", .8), cube("synth119", 1, "grey"), cube("synth200", .6), cube("synth200", .6, "rough"),
    cube("synth400", .6),
    # data of others
    cube("tree119", .5), cube("tree119", .5, "rough"), cube("portal1", .4), cube("portal1", .8, "rough"),
    cube("hepatic15", .4), cube("BG001", .4), cube("BG0002", .6),
    cube("micro-forest", .4), *(cube(f"micro{rank}", .4) for rank in (1, 2, 3, 4)),
]

QUICK = ["twigs-0.4", "twigs-0.8-rough", "twigs-0.6-grey", "random3-0.8", "thick1-1x1x5", "network2-0.6",
         "network4-0.6"]


def make_case(case: Case, sources: Sources, folder: Path) -> dict:
    """Writes the mask and the truth of a case into a folder; returns what there is to know about them.

    What a folder already has is kept if it was made from the same tree in the same way.
    """
    truth = TREES[case.tree](sources)
    digest = hashlib.sha256()
    for array in (truth.points, truth.radii, truth.segments):
        digest.update(np.ascontiguousarray(array).tobytes())
    for module in ("cases.py", "voxelise.py"):  # other code, other masks
        digest.update((Path(__file__).parent / module).read_bytes())
    digest.update(repr(case).encode())
    description = folder / "case.json"
    if description.exists():
        known = json.loads(description.read_text())
        if known["digest"] == digest.hexdigest():
            return known

    folder.mkdir(parents=True, exist_ok=True)
    grid = grid_around(truth, np.array(case.voxel))
    if case.kind == "grey":
        image = partial_volumes(truth, grid)
        inside = image >= case.threshold
    else:
        inside = voxelise(truth, grid)
        if case.kind == "rough":
            inside = roughen(inside, case.seed)
        image = inside.astype(np.uint8)
    write_nifti(folder / "mask.nii.gz", image, grid)
    write_json(folder / "truth.json", truth)
    if not truth.loops:
        write_swc(folder / "truth.swc", truth)
    radii = np.percentile(truth.radii, [0, 50, 100])
    known = {
        "name": case.name, "tree": case.tree, "kind": case.kind, "voxel": list(case.voxel), "size": case.size,
        "threshold": case.threshold, "shape": list(grid.shape), "voxels_inside": int(inside.sum()),
        "radius": dict(zip(("min", "median", "max"), radii.round(4).tolist())), "mask": topology(inside),
        "digest": digest.hexdigest(),
    }
    description.write_text(json.dumps(known, indent=1))
    return known
