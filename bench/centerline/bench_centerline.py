"""Centerlines that vmesh extracts from voxelised trees, beside the trees, which are known, and beside other programs.

Trees are synthetic, random (with loops and without), or those of the data's folder; their vessels, unions of round
cones, become masks: clean, with a rough boundary, grey, or with thick slices. `run` beside this file makes the
environment, and starts this with its options.
"""

from __future__ import annotations

import argparse
import fnmatch
import json
import os
import platform
import shlex
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import cases as known
import tables
from compare import compare
from graph import Graph, read_json

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
PEERS = ["lee", "kimimaro", "skeletor", "vmtkcenterlines", "vmtknetworkextraction"]
OF_VMTK = {"vmtkcenterlines", "vmtknetworkextraction"}


@dataclass(frozen=True)
class Build:
    """A vmesh to measure."""

    name: str
    path: Path
    options: tuple[str, ...]  # of `vmesh centerline`

    @staticmethod
    def parsed(text: str) -> Build:
        """[NAME=]PATH [OPTION...]"""
        words = shlex.split(text)
        if not words:
            raise argparse.ArgumentTypeError("expected the path of a vmesh")
        name, equals, path = words[0].partition("=")
        if not equals:
            name, path = "vmesh", words[0]
        if not os.access(path, os.X_OK):
            raise argparse.ArgumentTypeError(f"{path} is not there or cannot be executed")
        return Build(name, Path(path).resolve(), tuple(words[1:]))

    @property
    def version(self) -> str:
        return subprocess.run([self.path, "--version"], capture_output=True, text=True, check=True).stdout.strip()

    def command(self, case: dict, folder: Path, output: Path) -> list[str]:
        threshold = [] if case["threshold"] is None else ["--threshold", f"{case['threshold']:g}"]
        return [str(self.path), "centerline", str(folder / "mask.nii.gz"), "-o", str(output), *threshold,
                *self.options]


@dataclass(frozen=True)
class Peer:
    """Another program, run by peers.py in the environment that has it."""

    name: str
    python: str

    def command(self, case: dict, folder: Path, output: Path) -> list[str]:
        return [self.python, str(HERE / "peers.py"), self.name, str(folder), str(output)]


def last_line(text: str) -> str:
    lines = [line.strip() for line in text.replace("\r", "\n").splitlines() if line.strip()]
    return lines[-1] if lines else "no message"


def run(program: Build | Peer, case: dict, folder: Path, truth: Graph, timeout: float) -> dict:
    """Runs a program on a case, and measures the program and its result; an `error` says why there is none."""
    output = folder / f"{program.name}.json"
    measured_file, peer_file = folder / f"{program.name}.run.json", folder / f"{program.name}.measured.json"
    for file in (output, measured_file, peer_file):
        file.unlink(missing_ok=True)
    command = program.command(case, folder, output)
    # Peers compute on one thread, as far as they can be told; CPU seconds of idle threads would count against them.
    environment = {**os.environ, **{f"{name}_NUM_THREADS": "1" for name in ("OMP", "OPENBLAS", "MKL", "NUMBA")}}
    subprocess.run([sys.executable, "-I", str(HERE / "measured_run.py"), str(measured_file), str(timeout), *command],
                   check=True, env=environment)
    measured = json.loads(measured_file.read_text())
    printed = measured.pop("printed")
    if measured["timed_out"]:
        return {**measured, "error": f"no result after {measured['cpu_seconds']:.0f} s of CPU"}
    if measured["exit_code"] != 0 or not output.exists():
        return {**measured, "error": f"exit code {measured['exit_code']}: {last_line(printed)}"}
    if isinstance(program, Peer):
        # The peer's own work, without reading the mask and writing the result, which are in vmesh's figure.
        measured = {**measured, **json.loads(peer_file.read_text())}
    return {**measured, "measures": compare(truth, read_json(output), case["size"])}


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="bench/centerline/run", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--vmesh", metavar="[NAME=]PATH", action="append", type=Build.parsed, default=[],
                        help="a vmesh to measure, several times to compare some; '[NAME=]PATH OPTION...' in quotes "
                             "for options of its verb centerline (build/release/bin/vmesh)")
    parser.add_argument("--cases", metavar="PATTERN", action="append", default=[],
                        help="cases whose name matches, as '*-rough' does; several times for more (all)")
    parser.add_argument("--quick", action="store_true", help="a few small cases, under a minute with vmesh alone")
    parser.add_argument("--list", action="store_true", help="print the names of the cases that were chosen, and end")
    parser.add_argument("--peers", default="none", help=f"none, all, or some of {','.join(PEERS)} (none)")
    parser.add_argument("--timeout", type=float, default=300,
                        help="of each program on each case, CPU s; four times as much of wall time (300)")
    parser.add_argument("--data", type=Path, default=ROOT.parent / "shared" / "data",
                        help="the folder of the test data; without it, their cases are left out (../shared/data)")
    parser.add_argument("--markdown", type=Path, metavar="FILE", help="write the tables here, not to stdout")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write all figures")
    parser.add_argument("--keep", type=Path, metavar="DIR",
                        help="keep masks, truths and results here, DIR/CASE/...; masks that are there are used again")
    parser.add_argument("--masks-only", action="store_true", help="make the cases in --keep, and measure nothing")
    parser.add_argument("--vmtk-python", metavar="PYTHON", help=argparse.SUPPRESS)  # from `run`
    options = parser.parse_args()
    if options.masks_only and options.keep is None:
        parser.error("--masks-only needs --keep")
    if not options.vmesh:
        default = ROOT / "build" / "release" / "bin" / "vmesh"
        if not default.exists():
            parser.error(f"{default} is not there: build it, or give another with --vmesh")
        options.vmesh = [Build.parsed(str(default))]
    names = [build.name for build in options.vmesh]
    if len(set(names)) < len(names) or set(names) & set(PEERS):
        parser.error("builds need different names: --vmesh old=PATH --vmesh new=PATH")
    chosen = {"none": [], "all": PEERS}.get(options.peers, options.peers.split(","))
    for peer in chosen:
        if peer not in PEERS:
            parser.error(f"--peers: there is no {peer}; none, all, or some of {','.join(PEERS)}")
    options.peers = chosen
    return options


def chosen_cases(options: argparse.Namespace) -> list[known.Case]:
    cases = [case for case in known.CASES if not options.quick or case.name in known.QUICK]
    if options.cases:
        cases = [case for case in cases if any(fnmatch.fnmatchcase(case.name, pattern) for pattern in options.cases)]
    return cases


def programs_of(options: argparse.Namespace) -> list[Build | Peer]:
    programs: list[Build | Peer] = list(options.vmesh)
    for name in options.peers:
        python = options.vmtk_python if name in OF_VMTK else sys.executable
        if python is None:
            print(f"{name} is left out: it needs an environment of Python 3.12 or newer", file=sys.stderr)
        else:
            programs.append(Peer(name, python))
    return programs


def progress(name: str, program: str, result: dict) -> None:
    if "error" in result:
        text = result["error"]
    else:
        every = result["measures"]["all"]
        text = f"{tables.cpu(result['cpu_seconds'])} s, recall {tables.number(every['recall'])}, " \
               f"precision {tables.number(every.get('precision'))}"
    print(f"{name}: {program}: {text}", file=sys.stderr, flush=True)


def write_results(options: argparse.Namespace, report: dict, peers: list[str]) -> None:
    if options.json:
        options.json.write_text(json.dumps(report, indent=1))
    if options.markdown:
        ours = [build.name for build in options.vmesh]
        options.markdown.write_text(tables.markdown(report["cases"], ours, peers))


def main() -> int:
    options = arguments()
    cases = chosen_cases(options)
    if options.list:
        print("\n".join(case.name for case in cases))
        return 0
    if not cases:
        print("no case matches; --list prints their names", file=sys.stderr)
        return 2
    data = options.data.resolve() if options.data.is_dir() else None
    sources = known.Sources(options.vmesh[0].path, data)
    programs = [] if options.masks_only else programs_of(options)
    peers = [program.name for program in programs if isinstance(program, Peer)]
    report: dict = {
        "schema": "vmesh.bench_centerline/1",
        "machine": f"{platform.processor() or platform.machine()}, {os.cpu_count()} cores",
        "python": platform.python_version(),
        "builds": {build.name: {"version": build.version, "options": list(build.options)} for build in options.vmesh},
        "cases": [],
    }
    with tempfile.TemporaryDirectory(prefix="bench_centerline-") as temporary:
        for case in cases:
            # Without --keep, no more than one case's files are on the disk at a time.
            folder = (options.keep or Path(temporary)) / case.name
            try:
                description = known.make_case(case, sources, folder)
            except known.Unavailable as reason:
                print(f"{case.name}: left out: {reason}", file=sys.stderr)
                continue
            truth = read_json(folder / "truth.json")
            results = {}
            for program in programs:
                results[program.name] = run(program, description, folder, truth, options.timeout)
                progress(case.name, program.name, results[program.name])
            report["cases"].append({**description, "results": results})
            if options.keep is None:
                for file in folder.iterdir():
                    file.unlink()
            if programs:
                write_results(options, report, peers)  # after each case, so that an interruption loses little
    if programs and not options.markdown:
        print(tables.markdown(report["cases"], [build.name for build in options.vmesh], peers), end="")
    return 0


if __name__ == "__main__":
    sys.exit(main())
