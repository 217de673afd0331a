#!/usr/bin/python3
"""Writes RESULTS/plan.json: a centerline that is split into parts, their options and what they depend on."""

import argparse
import os
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "engine"))
from files import Hashes, PlanError, content_key, write_changed
from vmesh_command import arguments_of, parsed, version_of

SURFACES = (".ply", ".vtp", ".vtm")


def at_least_one(text):
    number = int(text)
    if number < 1:
        raise ValueError
    return number


def make_plan(given):
    centerline, whole = Path(os.path.abspath(given.centerline)), Path(os.path.abspath(given.output))
    if not centerline.is_file():
        raise PlanError(f"{given.centerline}: there is no such file; check the name")
    if whole.suffix.lower() not in SURFACES:
        raise PlanError(f"{given.output}: a surface in parts is written as one of {', '.join(SURFACES)}")
    results = whole.with_name(whole.name + ".parts")
    results.mkdir(parents=True, exist_ok=True)
    hashes = Hashes(results / ".hashes.json")
    plan = {
        "schema": "vmesh.parts/1",
        "vmesh": given.vmesh,
        "version": version_of(given.vmesh),
        "centerline": str(centerline),
        "sha256": hashes.of_input(centerline),
        "vertices": given.vertices,
        "arguments": arguments_of(dict(map(parsed, given.set))),
        "whole": str(whole),
        "threads": given.threads,
        "memory_mb": given.memory,
        "memory_whole_mb": given.memory_whole,
        "minutes": given.minutes,
    }
    plan["key"] = content_key(plan["version"], plan["sha256"], plan["vertices"], plan["arguments"])
    hashes.save()
    write_changed(results / "plan.json", plan)
    return results


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("centerline")
    parser.add_argument("-o", "--output", required=True, help="the whole surface: .ply, .vtp, or .vtm that lists parts")
    parser.add_argument("--vertices", type=at_least_one, default=1_000_000, help="of a part, about")
    parser.add_argument("--vmesh", required=True, help="the command, its whole path")
    parser.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", help="option of vmesh split")
    parser.add_argument("--threads", type=at_least_one, default=1, help="of a part")
    parser.add_argument("--memory", type=at_least_one, default=4000, metavar="MB", help="of a part")
    parser.add_argument("--memory-whole", type=at_least_one, default=16000, metavar="MB", help="to split and to join")
    parser.add_argument("--minutes", type=at_least_one, default=240, help="at most, of a job")
    try:
        print(make_plan(parser.parse_args()))
    except PlanError as error:
        sys.exit(f"parts: {error}")
    except OSError as error:
        sys.exit(f"parts: {error.filename}: {error.strerror}")


if __name__ == "__main__":
    main()
