#!/usr/bin/python3
"""Splits the centerline of plan.json into parts/ and lists them with their SHA-256: split.py LIST SURFACE_SUFFIX

A part that is the same as before stays, and so does its surface: after a change in one place of the tree only the
parts there are made again.
"""

import os
import shutil
import subprocess
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "engine"))
from files import hash_of, read_json, write_json

PARTS, NEW = Path("parts"), Path("parts.new")


def split(plan, folder):
    shutil.rmtree(folder, ignore_errors=True)
    command = [plan["vmesh"], "split", plan["centerline"], "-o", str(folder), "--vertices", str(plan["vertices"]),
               *plan["arguments"]]
    code = subprocess.run(command).returncode
    if code:
        sys.exit(code if code > 0 else 1)


def take_over(new, old, surface_suffix):
    """Moves what changed from `new` to `old`, and removes what belongs to none of `new`; SHA-256 by name."""
    old.mkdir(exist_ok=True)
    digests = {path.name: hash_of(path) for path in sorted(new.iterdir())}
    for path in sorted(old.iterdir()):
        if path.name not in digests and path.suffix != surface_suffix:
            path.unlink()
    for name, digest in digests.items():
        target = old / name
        if not target.exists() or hash_of(target) != digest:
            target.with_suffix(surface_suffix).unlink(missing_ok=True)
            os.replace(new / name, target)
    for surface in old.glob("*" + surface_suffix):
        if not any(Path(name).stem == surface.stem for name in digests):
            surface.unlink()
    shutil.rmtree(new)
    return digests


def main():
    target, part_suffix, surface_suffix = sys.argv[1:]
    split(read_json("plan.json"), NEW)
    digests = take_over(NEW, PARTS, surface_suffix)
    parts = {Path(name).stem: digest for name, digest in digests.items() if name.endswith(part_suffix)}
    if not parts:
        sys.exit(f"parts: vmesh split left no *{part_suffix} in {PARTS}")
    write_json(target, parts)


if __name__ == "__main__":
    main()
