"""A table of many cases: python3 examples/cohort_table.py FILE_OR_FOLDER... [-o TABLE.csv]

Every centerline becomes a surface, on as many processes as the machine has processors; a case that fails is a row of
the table too. Without files, a few synthetic trees are made.
"""

import argparse
import csv
import sys
import time
import warnings
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Dict, List, Union

import vmesh

COLUMNS = ["case", "nodes", "vertices", "skewness_mean", "skewness_max", "distance_mean", "volume_ml", "seconds"]
COLUMNS += ["error"]
Row = Dict[str, Union[str, int, float]]


def measure(path: Path) -> Row:
    """A row of the table; distances in local radii."""
    row: Row = {"case": path.name}
    begin = time.perf_counter()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", vmesh.SurfaceWarning)
            tree = vmesh.read_centerline(path)
            surface = vmesh.generate(tree, threads=1)
        report = vmesh.evaluate(surface, centerline=tree, samples=20_000, threads=1)
    except vmesh.Error as error:
        row["error"] = str(error).splitlines()[0]
        return row
    assert report.vessel is not None and report.volume is not None
    row["nodes"] = len(tree.nodes)
    row["vertices"] = report.vertices
    row["skewness_mean"] = round(report.skewness.mean, 4)
    row["skewness_max"] = round(report.skewness.max, 4)
    row["distance_mean"] = round(report.vessel.from_surface.relative.mean, 4)
    row["volume_ml"] = round(report.volume / 1000, 4)
    row["seconds"] = round(time.perf_counter() - begin, 2)
    return row


def files_in(inputs: List[Path]) -> List[Path]:
    found = []
    for path in inputs:
        found += sorted(p for p in path.iterdir() if p.suffix in (".swc", ".vtp", ".json")) if path.is_dir() else [path]
    return found


def make_synthetic(folder: Path) -> List[Path]:
    folder.mkdir(parents=True, exist_ok=True)
    for seed in range(1, 5):
        vmesh.synthetic_tree(60 * seed, seed).save(folder / f"tree{seed}.swc")
    (folder / "damaged.swc").write_text("1 0 0 0 0 1 -1\n2 0 x 0 0 1 1\n")
    return files_in([folder])


def main() -> None:
    parser = argparse.ArgumentParser(description="A table of many centerlines and their surfaces.")
    parser.add_argument("inputs", nargs="*", type=Path, help="centerlines, or folders of .swc, .vtp and .json")
    parser.add_argument("-o", "--output", type=Path, default=Path("cohort.csv"))
    arguments = parser.parse_args()
    cases = files_in(arguments.inputs) or make_synthetic(arguments.output.parent / "cohort_trees")

    with ProcessPoolExecutor() as pool:
        rows = list(pool.map(measure, cases))
    with open(arguments.output, "w", newline="") as file:
        table = csv.DictWriter(file, COLUMNS, restval="")
        table.writeheader()
        table.writerows(rows)

    failed = [row for row in rows if "error" in row]
    for row in failed:
        print(f"failed: {row['case']}: {row['error']}", file=sys.stderr)
    print(f"wrote {arguments.output}: {len(rows)} cases, {len(failed)} failed")


if __name__ == "__main__":
    main()
