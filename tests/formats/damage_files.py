#!/usr/bin/python3
"""Feeds the command with damaged files of the formats that libraries read in a process of their own (assimp, HDF5,
GDCM), and with damaged headers of images in two files, one after another, for a time each. Every file must be read or refused with its name, within a minute: exit code
0, 3 or 4, or 2 for what looks like DICOM no more. What is not so answered is kept. Exit code 1 if anything was found, 77
if nothing could be tried."""
import argparse
import os
import random
import shutil
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True

import numpy  # noqa: E402

import hdf5_inputs  # noqa: E402
import images  # noqa: E402
import outputs  # noqa: E402
import programs  # noqa: E402
import small_files as small  # noqa: E402
from report import Absent, Surface, Vmesh, Wrong  # noqa: E402

FORMATS = ("glb", "gltf", "dae", "x3d", "3mf", "fbx", "h5", "mhd", "nhdr", "img", "dicom")
SECONDS = 60  # twice what the reading process may take of the processor
TETRAHEDRON = Surface(
    numpy.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]]),
    numpy.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]),
)
TELLING = (b"\0", b"\xff", b"9", b"-", b" ", b"<", b'"', b"\x7f", b"\x80", b"e", b"\n")


def seeds(form, written, folder):
    """Small valid files, as paths; of DICOM the slices."""
    path = written.vmesh.path
    if form == "glb":
        written.vmesh("cones", small.swc(path("cones.swc")), "-o", path("cones.glb"), "--sides", 3)
        return [path("cones.glb")]
    small.model_3mf(path("seed.3mf"), TETRAHEDRON)
    if form == "3mf":
        return [path("seed.3mf")]
    if form == "h5":
        return [hdf5_inputs.make(path("seed.h5"))]
    if form == "nhdr":
        return [images.nrrd(path("seed.nhdr"), detached=True)]
    if form in ("mhd", "img"):
        return [images.write_by_vtk(programs.Vtk(), path("seed." + form))]
    if form == "dicom":
        series = images.write_by_pydicom(path("series"))
        return [os.path.join(series, sorted(os.listdir(series))[0])]
    code = {"gltf": "gltf2", "dae": "collada", "x3d": "x3d", "fbx": "fbxa"}[form]
    written.vmesh("convert", path("seed.3mf"), "-o", path("seed.off"))
    return [programs.Assimp(folder).export(path("seed.off"), path("seed." + form), "-f" + code)]


def damaged(content, draw):
    """A few changes, of bytes, of stretches or of the length."""
    data = bytearray(content)
    for _ in range(draw.choice((1, 1, 2, 3, 8))):
        at = draw.randrange(len(data)) if data else 0
        kind = draw.randrange(5)
        if kind == 0:
            data[at : at + 1] = draw.choice(TELLING)
        elif kind == 1:
            data[at : at + 4] = draw.randbytes(4)
        elif kind == 2:
            del data[at : at + draw.randrange(1, 64)]
        elif kind == 3:
            start = draw.randrange(len(data)) if data else 0
            data[at:at] = data[start : start + draw.randrange(1, 64)]
        else:
            del data[at:]
    return bytes(data)


def is_answered(vmesh, path, image):
    """Whether the command reads or refuses it as it should; what it did otherwise."""
    verb = ["reference", path, "--threshold", "1", "-o", path + ".ply"] if image else ["info", path]
    try:
        done = subprocess.run([vmesh, *verb], capture_output=True, text=True, errors="replace", timeout=SECONDS)
    except subprocess.TimeoutExpired:
        return f"no answer within {SECONDS} s"
    if done.returncode not in ((0, 2, 3, 4) if image else (0, 3, 4)):
        return f"exit code {done.returncode}: {done.stderr[-300:]}"
    if done.returncode != 0 and os.path.basename(path) not in done.stderr and os.path.dirname(path) not in done.stderr:
        return f"the message does not name the file: {done.stderr[-300:]}"
    return ""


def damage(form, written, folder, found, seconds):
    """How many files were tried and how many were not answered."""
    draw = random.Random(form)
    contents = {}
    for path in seeds(form, written, folder):
        with open(path, "rb") as file:
            contents[path] = file.read()
    tried = wrong = 0
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        path, content = draw.choice(list(contents.items()))
        victim = small.write(path, damaged(content, draw))
        said = is_answered(written.vmesh.command, victim, form in ("mhd", "nhdr", "img", "dicom"))
        tried += 1
        if said:
            wrong += 1
            os.makedirs(found, exist_ok=True)
            kept = shutil.copy(victim, os.path.join(found, f"{tried}_{os.path.basename(victim)}"))
            print(f"{form}: {kept}: {said}", file=sys.stderr)
        small.write(path, content)
    return tried, wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--vmesh", required=True, help="the command")
    parser.add_argument("--seconds", type=float, default=60, help="for every format")
    parser.add_argument("--found", default="build/fuzz/found", help="folder for what is found")
    parser.add_argument("formats", nargs="*", metavar="FORMAT", help="of " + " ".join(FORMATS) + "; default: all")
    options = parser.parse_args()
    for form in options.formats:
        if form not in FORMATS:
            parser.error(f"{form} is none of {', '.join(FORMATS)}")
    wrongs = all_tried = 0
    with tempfile.TemporaryDirectory(prefix="vmesh-damage-") as folder:
        written = outputs.Written(Vmesh(options.vmesh, folder))
        for form in options.formats or FORMATS:
            try:
                tried, wrong = damage(form, written, folder, os.path.join(options.found, form), options.seconds)
            except (Absent, Wrong) as reason:
                print(f"SKIPPED {form}: {reason}", file=sys.stderr)
                continue
            print(f"{form}: {tried} files, {wrong} found", flush=True)
            wrongs, all_tried = wrongs + wrong, all_tried + tried
    return 77 if all_tried == 0 else 1 if wrongs else 0


if __name__ == "__main__":
    sys.exit(main())
