#!/usr/bin/python3
"""Exchanges files between vmesh and other programs, in every format and both ways, and compares what arrives with what
was written. Prints a table in Markdown; exit code 1 if anything is wrong, 77 if the program asked for is absent."""
import argparse
import os
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
SKIPPED = 77  # ctest's SKIP_RETURN_CODE
try:
    import numpy  # noqa: F401
except ImportError:
    print("SKIPPED: NumPy is not installed (Debian: python3-numpy)", file=sys.stderr)
    sys.exit(SKIPPED)

import caps  # noqa: E402
import hdf5_inputs  # noqa: E402
import images  # noqa: E402
import inputs  # noqa: E402
import itk_inputs  # noqa: E402
import networkx_inputs  # noqa: E402
import outputs  # noqa: E402
import programs  # noqa: E402
import volumes  # noqa: E402
from report import Absent, Table, Vmesh  # noqa: E402

PROGRAMS = ("vtk", "meshio", "assimp", "three", "meshlab", "gmsh", "tetgen", "h5py", "itk", "networkx", "pydicom",
            "tifffile", "text")


def check(name, table, written, options, folder):
    if name == "vtk":
        vtk = programs.Vtk()
        outputs.check_vtk(table, vtk, written)
        inputs.check_vtk(table, vtk, written, options.shared_data)
        volumes.check_vtk(table, vtk, written.volumes())
        images.check_vtk(table, vtk, written)
        if written.with_vtk:
            caps.check(table, vtk, written.vmesh, options.shared_data)
    elif name == "meshio":
        meshio = programs.Meshio()
        outputs.check_meshio(table, meshio, written)
        inputs.check_meshio(table, meshio, written)
        volumes.check_meshio(table, meshio, written.volumes())
    elif name == "assimp":
        assimp = programs.Assimp(folder)
        outputs.check_assimp(table, assimp, written)
        inputs.check_assimp(table, assimp, written)
    elif name == "three":
        outputs.check_three(table, programs.Three(), written, options.bend)
    elif name == "meshlab":
        meshlab = programs.MeshLab(folder)
        outputs.check_meshlab(table, meshlab, written)
        inputs.check_meshlab(table, meshlab, written)
    elif name in ("gmsh", "tetgen"):
        mesher = programs.Gmsh(folder) if name == "gmsh" else programs.TetGen(folder)
        outputs.check_mesher(table, mesher, written)
        (volumes.check_gmsh if name == "gmsh" else volumes.check_tetgen)(table, mesher, written.volumes())
    elif name == "pydicom":
        images.check_pydicom(table, written)
    elif name == "tifffile":
        images.check_tifffile(table, written)
    elif name == "networkx":
        networkx_inputs.check(table, written)
    elif name == "itk":
        itk_inputs.check(table, written)
    elif name == "h5py":
        hdf5_inputs.check(table, written, options.shared_data)
    else:
        outputs.check_text(table, written)
        inputs.check_text(table, written, options.shared_data)
        images.check_text(table, written)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--vmesh", required=True, help="the command")
    parser.add_argument("--bent-tree", required=True, help="the test's program of that name")
    parser.add_argument("--shared-data", default="", help="folder of third-party files; without it they are left out")
    parser.add_argument("--program", choices=PROGRAMS, action="append", help="only this one; default: all")
    parser.add_argument("--digest", help="write a shorter table, a row per format and way, to this file")
    options = parser.parse_args()
    options.bend = lambda *paths: subprocess.run([options.bent_tree, *paths], check=True)

    table, absent = Table(), []
    with tempfile.TemporaryDirectory(prefix="vmesh-formats-") as folder:
        written = outputs.Written(Vmesh(options.vmesh, folder))
        for name in options.program or PROGRAMS:
            try:
                check(name, table, written, options, folder)
            except Absent as reason:
                absent.append(f"SKIPPED {name}: {reason}")
    print(table.markdown())
    for line in absent + table.notes:
        print(line, file=sys.stderr)
    for failure in table.failures:
        print(f"WRONG {failure}", file=sys.stderr)
    if options.digest:
        with open(options.digest + ".tmp", "w") as file:
            file.write(table.digest() + "\n")
        os.replace(options.digest + ".tmp", options.digest)
    if table.failures:
        return 1
    return 0 if table.rows else SKIPPED


if __name__ == "__main__":
    sys.exit(main())
