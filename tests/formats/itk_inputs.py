"""Tubes written by ITK, whose format is that of TubeTK, read by vmesh."""
import json
import os

import small_files as small
from inputs import check_tree
from report import Absent, run

HERE = os.path.dirname(os.path.abspath(__file__))
# Made by scripts/check-formats.
PYTHON = os.path.join(HERE, "..", "..", "build", "itk", "bin", "python")


def write(path, form):
    tree = {"points": small.POINTS.tolist(), "radius": small.RADIUS, "segments": small.SEGMENTS.tolist()}
    run([PYTHON, os.path.join(HERE, "itk_tubes.py"), path, form], input=json.dumps(tree))
    return path


def check(table, written):
    if not os.path.exists(PYTHON):
        raise Absent(
            "ITK for Python is not in Debian and takes 1 GB from PyPI: scripts/check-formats alone installs it;"
            " tests/io/tube_scene_test.cpp reads such files everywhere"
        )
    vmesh, program = written.vmesh, "ITK " + run([PYTHON, os.path.join(HERE, "itk_tubes.py"), "version"]).strip()
    for form in ("text", "binary"):
        check_tree(
            table,
            ".tre",
            program,
            vmesh,
            lambda form=form: write(vmesh.path(f"by_itk_{form}.tre"), form),
            place="mm, LPS (the format's)",
            way=f"in, {form}",
        )
