#!/usr/bin/python3
"""Meshes vessels with vmesh, solves for flow or stress in other programs, and compares with what is known. Prints a table
in Markdown; exit code 1 if anything is wrong, 77 if the program asked for is absent."""
import argparse
import os
import sys
import tempfile

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "formats"))
SKIPPED = 77  # ctest's SKIP_RETURN_CODE
try:
    import numpy  # noqa: F401
except ImportError:
    print("SKIPPED: NumPy is not installed (Debian: python3-numpy)", file=sys.stderr)
    sys.exit(SKIPPED)

import fenics  # noqa: E402
import foam  # noqa: E402
import lame  # noqa: E402
import vessels  # noqa: E402
from report import Absent, Wrong, run  # noqa: E402

CHECKS = {
    "openfoam": (foam.check_tube, foam.check_bend),
    "dolfinx": (fenics.check_tube,),
    "calculix": (lame.check_tube,),
}


class Vmesh:
    """The command, on the vessels of this test."""

    def __init__(self, command, folder):
        self.command, self.folder = command, folder
        for name, points in (("tube", vessels.tube()), ("bend", vessels.bend())):
            vessels.write_swc(self.path(name), points)

    def path(self, vessel):
        return os.path.join(self.folder, vessel + ".swc")

    def volume(self, vessel, output, *options):
        """All nodes count, as rings are then as far apart as the options ask for."""
        points = {"tube": vessels.tube(), "bend": vessels.bend()}[vessel]
        last = len(points) - 1
        ends = ("--name", "0=inlet", "--name", f"{last}=outlet")
        run([self.command, "volume", self.path(vessel), "-o", output, "--simplification", 0, *ends, *options])


class Table:
    """One row for each figure that was compared."""

    def __init__(self):
        self.rows, self.failures = [], []

    def add(self, program, what, cells, computed, expected, tolerance, by, unit, note=""):
        off = abs(computed / expected - 1)
        self.rows.append((program, what, f"{cells:,}", f"{computed:.5g} {unit}".removesuffix(" 1"),
                          f"{expected:.5g} ({by})", f"{100 * off:.2g} %", f"{100 * tolerance:g} %", note))
        if not off <= tolerance:
            self.failures.append(f"{program}, {what}: {computed:.6g} instead of {expected:.6g}, off by "
                                 f"{100 * off:.3g} %, {100 * tolerance:g} % are allowed")

    def markdown(self):
        head = ("program", "what", "cells", "computed", "expected", "off by", "allowed", "mesh")
        lines = ["| " + " | ".join(head) + " |", "|---|---|--:|--:|--:|--:|--:|---|"]
        return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in self.rows])


def draw(results, folder):
    """Needs VTK, which the checks do not."""
    import pictures

    os.makedirs(folder, exist_ok=True)
    for path in pictures.draw_all(results, folder):
        print(f"wrote {path}", file=sys.stderr)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--vmesh", required=True, help="the command")
    parser.add_argument("--program", choices=tuple(CHECKS), action="append", help="only this one; default: all")
    parser.add_argument("--pictures", metavar="FOLDER", help="draw flow and stress; needs VTK (python3-vtk9) and a display")
    options = parser.parse_args()
    table, absent = Table(), []
    with tempfile.TemporaryDirectory(prefix="vmesh-simulation-") as folder:
        vmesh = Vmesh(options.vmesh, folder)
        for name in options.program or CHECKS:
            for check in CHECKS[name]:
                try:
                    check(vmesh, folder, table)
                except Absent as reason:
                    absent.append(f"SKIPPED {name}: {reason}")
                    break
                except Wrong as wrong:
                    table.failures.append(f"{name}: {wrong}")
        if options.pictures:
            draw(folder, options.pictures)
    print(table.markdown())
    for line in absent:
        print(line, file=sys.stderr)
    for failure in table.failures:
        print(f"WRONG {failure}", file=sys.stderr)
    if table.failures:
        return 1
    return 0 if table.rows else SKIPPED


if __name__ == "__main__":
    sys.exit(main())
