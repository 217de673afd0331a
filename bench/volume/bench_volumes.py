"""Volume meshes of the same surfaces by vmesh and by other programs, side by side, measured by VTK.

Surfaces are grown by `vmesh generate --ends flat` around the trees of the data's folder; one is fitted to a
segmentation. `run` beside this file makes the environment, and starts this with its options. All work on one core.
"""

from __future__ import annotations

import argparse
import fnmatch
import json
import os
import signal
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path.append(str(HERE.parent / "centerline"))

import report  # noqa: E402
from measures import measure  # noqa: E402
from meshers import MESHERS, core_of  # noqa: E402
from surfaces import Surface, read_grid, read_surface  # noqa: E402

LIVER = "liver_portal_centerlines/liverModelPatient1__"
OTHER = "pulmonary_aorta_coronary_centerlines/"
IN_CM = ("--unit", "cm")
# The name of each surface, and the arguments of `vmesh generate` that make it.
SURFACES = {
    "tree119": ("synthetic_trees/tree119.swc",),
    "tree1560": ("synthetic_trees/tree1560.swc",),
    **{name: (f"{LIVER}{name}_1.swc",) for name in (
        "portal1", "portal3", "portal15", "hepatic1", "hepatic3", "hepatic15", "arterial15", "vessel_portal",
        "vessel_hepatic", "vessel_arterial")},
    "aorta 0030": (f"{OTHER}0030_H_ABAO_H_joined.swc", *IN_CM),
    "cerebral 0052": (f"{OTHER}0052_H_CERE_H_joined.swc", *IN_CM),
    "coronary 0066": (f"{OTHER}0066_H_CORO_H_joined.swc", *IN_CM),
    "SU201": ("pairs_centerline_surface/generate-1d-mesh_example_SU201_2005_RPA1_cl.vtp",),
    "portal vein 008, fitted": ("liver_segmentations/hepaticvessel_008_vsnet.nii.gz",),
}
FITTED = {"portal vein 008, fitted"}
OURS = {"vmesh": ("--layers", "0"), "vmesh-layers": ()}
NEEDS = {"ftetwild": "vmesh", "gmsh-core": "vmesh-layers"}  # programs that start from meshes of ours
OF_VMTK = {"vmtk", "vmtk-layers"}
ENOUGH = 5.  # CPU seconds after which a mesh is not made again for the median


@dataclass(frozen=True)
class Bench:
    """What is compared, and where."""

    vmesh: Path
    bench_volume: Path
    data: Path
    folder: Path
    vmtk_python: str | None
    timeout: float
    runs: int

    def call(self, *arguments: str | Path) -> None:
        command = [str(self.vmesh), *map(str, arguments)]
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if done.returncode:
            sys.exit(f"{' '.join(command)}: {last_line(done.stdout)}")

    def make_surface(self, name: str) -> Path:
        """Unless it is there from an earlier run."""
        surface = self.folder / name.replace(" ", "_").replace(",", "") / "surface.vtp"
        if surface.exists():
            return surface
        surface.parent.mkdir(parents=True, exist_ok=True)
        file, *options = SURFACES[name]
        source, fit = self.data / file, []
        if name in FITTED:
            wall, source = surface.with_name("wall.ply"), surface.with_name("centerline.json")
            self.call("reference", self.data / file, "--label", 2, "--spacing", 1, "--smooth", 1, "-o", wall)
            self.call("centerline", wall, "--tree", "-o", source)
            fit = ["--fit", wall]
        self.call("generate", source, *options, *fit, "--ends", "flat", "-o", surface)
        return surface

    def command(self, mesher: str, surface: Path, output: Path) -> list[str]:
        if mesher in OURS:
            return [str(self.vmesh), "volume", str(surface), "-o", str(output), "--threads", "1", "--json",
                    str(output.with_suffix(".json")), *OURS[mesher]]
        python = self.vmtk_python if mesher in OF_VMTK else sys.executable
        return [python, str(HERE / "meshers.py"), mesher, str(surface), str(output)]

    def run_once(self, mesher: str, surface: Path) -> dict:
        output = surface.with_name(f"{'vmesh-tetrahedra' if mesher == 'vmesh' else mesher}.vtu")
        output.unlink(missing_ok=True)
        result = surface.with_name("run.json")
        call = subprocess.Popen([sys.executable, str(HERE.parent / "centerline" / "measured_run.py"), str(result),
                                 str(self.timeout), *self.command(mesher, surface, output)])
        try:
            call.wait()
        finally:
            call.terminate()  # which ends what it runs
        run = json.loads(result.read_text())
        if run["timed_out"] or run["exit_code"] or not output.exists():
            return {"refused": f"not done after {self.timeout:g} s of CPU" if run["timed_out"]
                    else f"exit code {run['exit_code']}: {last_line(run['printed'])}",
                    "whole_cpu_seconds": run["cpu_seconds"], "whole_wall_seconds": run["wall_seconds"]}
        return {"whole_cpu_seconds": run["cpu_seconds"], "whole_wall_seconds": run["wall_seconds"],
                "output": str(output)} | self.own_seconds(mesher, surface, output)

    def own_seconds(self, mesher: str, surface: Path, output: Path) -> dict:
        """Of meshing alone. For CPU seconds of ours, bench_volume makes the mesh once more."""
        if mesher not in OURS:
            measured = json.loads(output.with_suffix(".measured.json").read_text())
            return {key: measured[key] for key in ("cpu_seconds", "wall_seconds", "versions")}
        stages = json.loads(output.with_suffix(".json").read_text())["stages"]
        printed = subprocess.run([str(self.bench_volume), *OURS[mesher], str(surface)], stdout=subprocess.PIPE,
                                 text=True, check=True).stdout
        header, _, row = [[cell.strip() for cell in line.split("|")] for line in printed.splitlines()
                          if line.startswith("|")]
        return {"cpu_seconds": float(row[header.index("CPU, s")]),
                "wall_seconds": sum(value for stage, value in stages.items() if stage not in ("read", "write", "total"))}

    def run(self, mesher: str, surface: Path) -> dict:
        """The measures of a mesh, and the medians of its times."""
        every = [self.run_once(mesher, surface)]
        while len(every) < self.runs and every[-1]["whole_cpu_seconds"] < ENOUGH and "refused" not in every[-1]:
            every.append(self.run_once(mesher, surface))
        result = every[-1]
        if "refused" in result:
            return result
        for key in [key for key in result if key.endswith("_seconds")]:
            result[key] = sorted(run[key] for run in every)[len(every) // 2]
        points, cells = read_grid(Path(result["output"]))
        if not cells:
            return {"refused": "a mesh without cells"} | result
        return result | measure(self.meshed_surface(mesher, surface), points, cells)

    def meshed_surface(self, mesher: str, surface: Path) -> Surface:
        return core_of(surface.with_name("vmesh-layers.vtu")) if mesher == "gmsh-core" else read_surface(surface)


def last_line(text: str) -> str:
    lines = [line.strip() for line in text.replace("\r", "\n").splitlines() if line.strip()]
    return lines[-1] if lines else "no message"


def chosen(names, patterns: list[str] | None) -> list[str]:
    return [name for name in names if not patterns or any(fnmatch.fnmatch(name, pattern) for pattern in patterns)]


def parsed() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--vmesh", type=Path, default=ROOT / "build/release/bin/vmesh", help="the command, beside bench_volume")
    parser.add_argument("--data", type=Path, default=ROOT.parent / "shared/data", help="folder of the test data")
    parser.add_argument("--surfaces", action="append", metavar="PATTERN", help=f"of {', '.join(SURFACES)}")
    parser.add_argument("--meshers", action="append", metavar="PATTERN", help=f"of {', '.join([*OURS, *MESHERS])}")
    parser.add_argument("--runs", type=int, default=3, help="medians of that many, where a mesh takes less than 5 s")
    parser.add_argument("--timeout", type=float, default=600, help="CPU seconds that a mesh may take")
    parser.add_argument("--keep", type=Path, metavar="FOLDER", help="where surfaces and meshes are kept")
    parser.add_argument("--markdown", type=Path, help="tables as a file")
    parser.add_argument("--json", type=Path, help="all that was measured")
    parser.add_argument("--vmtk-python", help="a Python that has VMTK")
    return parser.parse_args()


def main() -> None:
    options = parsed()
    if not os.access(options.vmesh, os.X_OK):
        sys.exit(f"{options.vmesh} is not there: scripts/build release vmesh, or --vmesh PATH")
    bench_volume = options.vmesh.with_name("bench_volume")
    if not os.access(bench_volume, os.X_OK):
        sys.exit(f"{bench_volume} is not there: scripts/build release -DVMESH_BUILD_BENCH=ON bench_volume")
    if not options.data.is_dir():
        sys.exit(f"{options.data} is not there: --data names the folder of the test data")
    surfaces, meshers = chosen(SURFACES, options.surfaces), chosen([*OURS, *MESHERS], options.meshers)
    if not options.vmtk_python:
        meshers = [mesher for mesher in meshers if mesher not in OF_VMTK]
    for mesher, ours in NEEDS.items():
        if mesher in meshers and ours not in meshers:
            meshers.insert(0, ours)
    os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    os.environ |= {"OMP_NUM_THREADS": "1", "VTK_SMP_MAX_THREADS": "1", "PYTHONDONTWRITEBYTECODE": "1"}
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
    with tempfile.TemporaryDirectory(prefix="vmesh-volumes-") as folder:
        bench = Bench(options.vmesh.resolve(), bench_volume.resolve(), options.data.resolve(),
                      (options.keep or Path(folder)).resolve(), options.vmtk_python, options.timeout,
                      max(1, options.runs))
        made = {name: bench.make_surface(name) for name in surfaces}
        results = {name: {"faces": len(read_surface(made[name]).faces), "meshes": {}} for name in surfaces}
        for mesher in meshers:  # each on all surfaces, so that what is slow is last
            for name in surfaces:
                result = results[name]["meshes"][mesher] = bench.run(mesher, made[name])
                print(f"{name}: {mesher}: " + (result.get("refused") or report.line(result)), file=sys.stderr, flush=True)
                if options.json:
                    options.json.write_text(json.dumps({"surfaces": results}, indent=1))
    text = report.markdown(results, meshers)
    print(text)
    if options.markdown:
        options.markdown.write_text(text + "\n")


if __name__ == "__main__":
    main()
