"""Runs the benches and writes their tables into the READMEs, between the lines <!-- figures: NAME --> and <!-- end -->.

scripts/figures builds what this needs and starts it.
"""

from __future__ import annotations

import argparse
import json
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
BIN = ROOT / "build" / "release" / "bin"
sys.path.insert(0, str(ROOT / "bench" / "centerline"))

from tables import beside, cpu, detail, in_all, number, table  # noqa: E402

LIVER = "liver_portal_centerlines/liverModelPatient1__"
ELONGATED = ["tree119", "portal1", "vessel_arterial", "vessel_hepatic", "portal3", "vessel_portal", "portal15",
             "hepatic3", "hepatic1", "hepatic15", "bile1", "arterial15"]
FITTED = [("airway", "airway/github_demo_seg.nii.gz", ["--tree"]),
          ("portal vein of an atlas", "liver_spl_atlas/spl_portal_vein_combined.ply", ["--tree"]),
          ("circle of Willis, MR", "brain_cow/topcow_mr_roi_014.nii.gz", ["--threshold", "0.5"]),
          ("circle of Willis, CT", "brain_cow/topcow_ct_roi_014.nii.gz", ["--threshold", "0.5"])]
EXTRACTED = [("liver vessels 002, label 1", "liver_segmentations/hepaticvessel_002_vsnet.nii.gz", ["--label", "1"]),
             ("liver vessels 002, label 2", "liver_segmentations/hepaticvessel_002_vsnet.nii.gz", ["--label", "2"]),
             ("liver vessels 008, label 1", "liver_segmentations/hepaticvessel_008_vsnet.nii.gz", ["--label", "1"]),
             ("liver vessels 008, label 2", "liver_segmentations/hepaticvessel_008_vsnet.nii.gz", ["--label", "2"]),
             *((name, file, []) for name, file in (
                 ("brain vessels 002", "brain_mra/labels-002.nii.gz"),
                 ("airways", "airway/github_demo_seg.nii.gz"),
                 ("aorta, open", "pairs_centerline_surface/aorta-surface-open-ends.stl"),
                 ("aorta, closed", "pairs_centerline_surface/aorta-surface.stl"),
                 ("pulmonary arteries (SU201)",
                  "pairs_centerline_surface/generate-1d-mesh_example_SU201_2005_RPA1_exterior.vtp"),
                 ("coronary tree", "surfaces_other/extract-faces_python_coronarytree.stl"),
                 ("portal vein of an atlas, 29 pieces", "liver_spl_atlas/spl_portal_vein_combined.ply")))]
CASES_BESIDE = ["network4-0.6", "tree119-0.5-rough", "portal1-0.4"]


class Bench:
    """Where data and temporary files are."""

    def __init__(self, data: Path, folder: Path):
        self.data, self.folder = data, folder

    def run(self, program: str, *arguments: str | Path) -> tuple[str, float]:
        """What a program printed, and its user CPU in seconds."""
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        command = [str(BIN / program), *map(str, arguments)]
        print("+", *command, file=sys.stderr, flush=True)
        done = subprocess.run(command, stdout=subprocess.PIPE, text=True, cwd=self.folder)
        if done.returncode != 0:
            sys.exit(f"exit code {done.returncode} of {' '.join(command)}")
        return done.stdout, resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before

    def summary(self, verb: str, *arguments: str | Path) -> tuple[dict, float]:
        """The JSON of a verb of the command, and its user CPU."""
        _, seconds = self.run("vmesh", verb, *arguments, "--json", "summary.json", "--quiet")
        return json.loads((self.folder / "summary.json").read_text()), seconds


def rows_of(markdown: str) -> list[list[str]]:
    """The cells of all lines of tables but the rules."""
    lines = [line for line in markdown.splitlines() if line.startswith("|") and not line.startswith("|-")]
    return [[cell.strip() for cell in line.strip().strip("|").split("|")] for line in lines]


def put(readme: str, name: str, lines: list[str]) -> None:
    path = ROOT / readme
    # On lines of their own: this script's manual names them as well.
    before, mark, rest = path.read_text().partition(f"\n<!-- figures: {name} -->\n")
    old, end, after = ("\n" + rest).partition("\n<!-- end -->\n")  # nothing between them yet, perhaps
    if not mark or not end or "<!-- figures: " in old:
        sys.exit(f"{readme}: there is no place for the table {name}")
    path.write_text(before + mark + "\n" + "\n".join(lines) + "\n" + end + after)


def generate(bench: Bench) -> None:
    header, *rows = rows_of(bench.run("bench_generate")[0])
    put("bench/README.md", "generate", table(header, rows))
    wanted = {"tree1560.swc": "synthetic portal vein", "the same, CGAL Mesh_3": "the same, CGAL's Mesh_3",
              "liverModelPatient1__portal15_1.swc": "portal vein of a liver",
              "PA000125_joined.swc": "pulmonary arteries"}
    columns = [header.index(name) for name in ("nodes", "vertices", "user CPU, s", "skewness mean / max")]
    short = [[wanted[row[0]], *(row[column] for column in columns)] for row in rows if row[0] in wanted]
    put("README.md", "generate", table(["centerline", "nodes", "vertices", "CPU, s", "skewness mean / max"], short))


def scaling(bench: Bench) -> None:
    header, *rows = rows_of(bench.run("bench_scaling", "100", "1000", "10000", "100000")[0])
    put("bench/README.md", "scaling", table(header, rows))


def million(bench: Bench) -> None:
    header, *rows = rows_of(bench.run("bench_scaling", "--runs=1", "100000", "999999")[0])
    put("bench/README.md", "million", table(header, rows))


def least_to_most(values: list[str]) -> str:
    numbers = sorted(float(value) for value in values if value != "nan")
    if not numbers:
        return "beyond the sweep"
    least, most = number(numbers[0], 2), number(numbers[-1], 2)
    return least if least == most else f"{least} to {most}"


def tradeoff(bench: Bench, name: str, centerline: list[Path]) -> None:
    prefix = bench.folder / name
    bench.run("bench_tradeoff", prefix, *centerline)
    (ROOT / ".assets" / f"tradeoff-{name}.svg").write_text(Path(f"{prefix}.svg").read_text())
    comparisons = rows_of(Path(f"{prefix}.md").read_text().split("\n\n")[1])[1:]
    groups: dict[tuple[str, str], list[list[str]]] = {}
    for row in comparisons:
        groups.setdefault((row[0], row[2]), []).append(row)
    rows = [[theirs, f"{min(int(row[1]) for row in group):,} to {max(int(row[1]) for row in group):,}", ours,
             *(least_to_most([row[column] for row in group]) for column in (3, 4, 5))]
            for (theirs, ours), group in groups.items() if ours in ("max-error", "max-error in mm, elongation 16",
                                                                    "vertices, elongation 16")]
    put("bench/README.md", f"tradeoff-{name}", table(
        ["beside", "their vertices", "our curve", "vertices at equal maximum error", "mean error at equal vertices",
         "mean skewness at equal vertices"], rows, left=3))


def tradeoffs(bench: Bench) -> None:
    tradeoff(bench, "portal1", [bench.data / f"{LIVER}portal1_1.swc"])
    tradeoff(bench, "hepatic1", [bench.data / f"{LIVER}hepatic1_1.swc"])
    tradeoff(bench, "synthetic", [])


def elongation(bench: Bench) -> None:
    rows = []

    def measure(name: str, file: str, limit: str, *options: str) -> None:
        plain, elongated = (bench.summary("generate", bench.data / file, "-o", "surface.ply", "--max-error", limit,
                                          "--allow-defects", *options, *more)
                            for more in ((), ("--elongation", "16")))
        count, fewer = plain[0]["vertices"], elongated[0]["vertices"]
        rows.append([name, limit, f"{count:,}", cpu(plain[1]), f"{fewer:,}", cpu(elongated[1]),
                     number(fewer / count, 2)])

    for name in ELONGATED:
        measure(name, "synthetic_trees/tree119.swc" if name == "tree119" else f"{LIVER}{name}_1.swc", "10%")
    measure("tree1560", "synthetic_trees/tree1560.swc", "0.3mm")
    measure("tree1560, `--blend 0`", "synthetic_trees/tree1560.swc", "0.3mm", "--blend", "0")
    put("bench/README.md", "elongation", table(
        ["centerline", "limit", "vertices", "CPU, s", "with `--elongation 16`", "CPU, s", "ratio"], rows, left=2))


EVEN, LONG, QUADRIC, COLLAPSE = ("fitted", "fitted, long triangles", "quadric decimation, CGAL",
                                 "edge collapse, Lindstrom and Turk")


def surfaces_by_case(text: str) -> dict[str, dict[str, dict[str, str]]]:
    """What bench_fit printed: the cells by vessels, surface and column."""
    header, *rows = rows_of(text)
    cases: dict[str, dict[str, dict[str, str]]] = {}
    name = ""
    for row in rows:
        cells = dict(zip(header, row, strict=True))
        name = cells["vessels"] or name
        cases.setdefault(name, {})[cells["surface"]] = cells
    return cases


def distances(cells: dict[str, str]) -> str:
    return f"{number(float(cells['Hausdorff']), 2)} / {number(float(cells['mean']))} / {number(float(cells['95 %']))}"


def write_fits(text: str) -> None:
    cases = surfaces_by_case(text)
    put("bench/README.md", "fit", table(
        ["vessels", "vertices", "round cones", "fitted", "skewness mean / max", "CPU, s", "long triangles",
         "skewness mean / max", "CPU, s"],
        [[name, f"{int(of[EVEN]['vertices']):,}", distances(of["round cones"]), distances(of[EVEN]),
          of[EVEN]["skewness mean / max"], of[EVEN]["CPU, s"], distances(of[LONG]), of[LONG]["skewness mean / max"],
          of[LONG]["CPU, s"]] for name, of in cases.items()]))

    def ratio(of: dict[str, dict[str, str]], ours: str, theirs: str, column: str) -> str:
        return number(float(of[ours][column]) / float(of[theirs][column]), 2)

    put("bench/README.md", "fit-peers", table(
        ["vessels", "long triangles", "quadric decimation", "ours to theirs", "edge collapse", "ours to theirs, mean",
         "95 %", "even triangles to edge collapse"],
        [[name, number(float(of[LONG]["mean"])), number(float(of[QUADRIC]["mean"])), ratio(of, LONG, QUADRIC, "mean"),
          number(float(of[COLLAPSE]["mean"])), ratio(of, LONG, COLLAPSE, "mean"), ratio(of, LONG, COLLAPSE, "95 %"),
          ratio(of, EVEN, COLLAPSE, "mean")] for name, of in cases.items()]))


def fit(bench: Bench) -> None:
    write_fits(bench.run("bench_fit")[0])
    bench.run("bench_fit", ROOT / ".assets" / "tradeoff-fit.svg")
    others = []
    for name, file, options in FITTED:
        centerline = bench.folder / "centerline.swc"
        bench.summary("centerline", bench.data / file, "-o", centerline, *options)
        unfitted, _ = bench.summary("generate", centerline, "-o", "surface.ply")
        fitted, _ = bench.summary("generate", bench.data / file, "-o", "surface.ply", *options)
        before, after = fitted["fit"]["before"], fitted["fit"]["after"]
        others.append([name, f"{unfitted['vertices']:,}", f"{number(before['mean_mm'])} / {number(before['p95_mm'])}",
                       f"{number(after['mean_mm'])} / {number(after['p95_mm'])}", f"{fitted['vertices']:,}",
                       f"{number(fitted['skewness']['mean'])} / {number(fitted['skewness']['max'])}"])
    put("bench/README.md", "fit-others", table(
        ["vessels", "vertices", "round cones, mean / 95 %, mm", "fitted", "vertices", "skewness mean / max"], others))


def centerlines(bench: Bench) -> None:
    results = bench.folder / "centerlines.json"
    subprocess.run([str(ROOT / "bench" / "centerline" / "run"), "--peers", "all", "--data", str(bench.data), "--json",
                    str(results), "--markdown", str(bench.folder / "centerlines.md")], check=True)
    cases = json.loads(results.read_text())["cases"]
    programs = list(dict.fromkeys(program for case in cases for program in case["results"]))
    put("bench/README.md", "centerlines", detail(cases, "vmesh"))
    put("bench/README.md", "centerlines-peers", beside(
        [case for case in cases if case["name"] in CASES_BESIDE], programs))
    put("bench/README.md", "centerlines-all", in_all(cases, programs))


def volumes(bench: Bench) -> None:
    results = bench.folder / "volumes.json"
    subprocess.run([str(ROOT / "bench" / "volume" / "run"), "--data", str(bench.data), "--json", str(results)],
                   check=True)
    write_volumes(json.loads(results.read_text())["surfaces"])


def write_volumes(surfaces: dict) -> None:
    sys.path.append(str(ROOT / "bench" / "volume"))
    import report

    meshers = list(dict.fromkeys(mesher for surface in surfaces.values() for mesher in surface["meshes"]))
    put("bench/README.md", "volumes", report.in_all(surfaces, meshers))
    put("bench/README.md", "volumes-each", report.times(surfaces, meshers))


def masks(bench: Bench) -> None:
    rows = []
    for name, file, options in EXTRACTED:
        summary, seconds = bench.summary("centerline", bench.data / file, "-o", "centerline.vtp", *options)
        found, extraction = summary["centerline"], summary["extraction"]
        rows.append([name, cpu(seconds), f"{extraction['components']}, {extraction['left_out']}",
                     f"{found['ends']}, {len(summary['end_sections'])}", str(found["loops"]),
                     number(extraction["coverage"])])
    put("bench/README.md", "masks", table(
        ["file", "CPU, s", "components, left out", "ends, flat ones", "loops", "coverage of the wall"], rows))


def deform(bench: Bench) -> None:
    printed, _ = bench.run("bench_deform", "--benchmark_format=json", "--benchmark_repetitions=3",
                           "--benchmark_report_aggregates_only=true")
    rows = []
    for result in json.loads(printed)["benchmarks"]:
        if result["aggregate_name"] != "median":
            continue
        name, segments, *rest = result["run_name"].split("/")
        what = {"step": lambda: f"a step, {rest[0]} iteration{'s' if rest[0] != '1' else ''}",
                "step_of_a_twig": lambda: "a step, one twig moving",
                "synchronise": lambda: "the surface, " + ("with normals" if rest[0] == "1" else "without normals"),
                "synchronise_naive": lambda: "the surface with normals, Eq. 10 as written",
                "bind_to_nearest": lambda: "binding a surface by its nearest places"}[name]()
        scale = {"ns": 1e-3, "us": 1, "ms": 1e3}[result["time_unit"]]
        rows.append([what, f"{int(segments):,}", f"{result['cpu_time'] * scale:,.3g}"])
    put("bench/README.md", "deform", table(["what", "segments", "CPU, us"], rows))
    bench.run("vmesh", "table1", "--plot", ROOT / ".assets" / "tradeoff-deform.svg")


def hausdorff(bench: Bench) -> None:
    header, *rows = rows_of(bench.run("bench_hausdorff")[0])
    put("bench/README.md", "hausdorff", table(header, rows))


def table2(bench: Bench) -> None:
    bench.run("vmesh", "table2", "--report", "table2.md", "--json", "table2.json")
    blocks = [rows_of(block) for block in (bench.folder / "table2.md").read_text().split("\n\n")]
    rows = next(rows[1:] for rows in blocks if rows and rows[0][:2] == ["surface", "vertices"])
    put("bench/README.md", "table2", table(
        ["surface", "vertices", "faces", "skewness mean / max", "Hausdorff, mm"],
        [[row[0], f"{int(row[1]):,}", f"{int(row[2]):,}", f"{number(float(row[3]))} / {number(float(row[4]))}",
          "" if row[5] == "-" else number(float(row[5].split()[-1]), 2)] for row in rows]))


FIGURES = {figure.__name__: figure for figure in
           (generate, scaling, million, tradeoffs, elongation, fit, centerlines, volumes, masks, deform, hausdorff, table2)}


def main() -> None:
    parser = argparse.ArgumentParser(prog="scripts/figures", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME",
                        help=f"some of {', '.join(FIGURES)}; all, if none is given, which takes hours")
    parser.add_argument("--data", type=Path, default=ROOT.parent / "shared" / "data",
                        help="the folder of the test data (../shared/data)")
    options = parser.parse_args()
    for name in options.names:
        if name not in FIGURES:
            parser.error(f"there are no figures {name}; --help lists them")
    if not options.data.is_dir():
        parser.error(f"{options.data} is not there; --data gives another folder of the test data")
    for name in options.names or FIGURES:
        with tempfile.TemporaryDirectory(prefix="vmesh-figures-") as folder:
            FIGURES[name](Bench(options.data.resolve(), Path(folder)))


main()
