#!/usr/bin/python3
"""Runs one step of one case and writes what became of it: run_case.py surface|picture CASE THREADS LAST_ATTEMPT

In the folder of the results, beside plan.json. Ends with 0 when status/CASE.STEP.json says how vmesh ended: an input
that it refuses is a result. What says nothing about the input, an interruption, a disk that is full, or, but for the
last attempt, a vmesh that was killed, ends with 1 and no status, and is to be tried again.
"""

import os
import signal
import sys
import time
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "engine"))
from files import read_json, write_json

CANNOT_WRITE, INTERRUPTED = 5, 130  # exit codes of vmesh
LONGEST_MESSAGE = 600


def run(command, log):
    """Exit code (minus the signal where one ended it), wall and CPU seconds and peak memory in MB of a command."""
    log.parent.mkdir(parents=True, exist_ok=True)
    start = time.monotonic()
    with open(log, "wb") as errors:
        process = os.posix_spawn(command[0], command, os.environ,
                                 file_actions=[(os.POSIX_SPAWN_DUP2, errors.fileno(), 1),
                                               (os.POSIX_SPAWN_DUP2, errors.fileno(), 2)])
    _, status, usage = os.wait4(process, 0)
    return os.waitstatus_to_exitcode(status), {
        "seconds": round(time.monotonic() - start, 3),
        "cpu_seconds": round(usage.ru_utime + usage.ru_stime, 3),
        "peak_memory_mb": round(usage.ru_maxrss / 1024, 1),
    }


def message_of(exit_code, log, path):
    """vmesh's error messages, without the folders of the input."""
    if exit_code == 0:
        return ""
    lines = log.read_text(errors="replace").splitlines()
    errors = [line.removeprefix("vmesh: ") for line in lines if line.startswith("vmesh: ")]
    if not errors:  # warnings say what is not kept, and the command line's errors have no name in front
        errors = [line for line in lines if line][-2:]
    if exit_code < 0:
        errors.append(f"ended by {signal.Signals(-exit_code).name}; it may need more memory than memory_mb")
    message = "; ".join(errors).replace(path, os.path.basename(path))
    return message if len(message) <= LONGEST_MESSAGE else message[:LONGEST_MESSAGE] + " ..."


def finish(name, step, exit_code, message, costs, last_attempt, **made):
    says_nothing = exit_code in (CANNOT_WRITE, INTERRUPTED) or (exit_code < 0 and not last_attempt)
    if says_nothing:
        sys.exit(f"{name}: {step}: not finished: {message or exit_code}")
    write_json(f"status/{name}.{step}.json",
               {"schema": "vmesh.case/1", "case": name, "exit_code": exit_code, "message": message, **costs, **made})


def remove(paths):
    for path in filter(None, paths):
        Path(path).unlink(missing_ok=True)
        Path(path).parent.mkdir(parents=True, exist_ok=True)


def make_surface(vmesh, name, case, threads, last_attempt):
    remove([case["surface"], case["summary"], case["centerline"]])
    log = Path(f"log/{name}.surface.log")
    command = [vmesh, "generate", case["input"], "-o", case["surface"], "--json", case["summary"],
               "--threads", threads, *case["arguments"]]
    if case["centerline"]:
        command += ["--centerline-output", case["centerline"]]
    exit_code, costs = run(command, log)
    made = os.path.exists(case["surface"])
    finish(name, "surface", exit_code, message_of(exit_code, log, case["input"]), costs, last_attempt,
           surface=case["surface"] if made else None, summary=case["summary"] if made else None)


def draw_picture(vmesh, name, case, _threads, last_attempt):
    remove([case["picture"]])
    surface = read_json(f"status/{name}.surface.json")["surface"]
    if not surface:
        finish(name, "picture", 0, "", {}, last_attempt, picture=None)
        return
    log = Path(f"log/{name}.picture.log")
    command = [vmesh, "render", surface, "-o", case["picture"], "--quiet", *case["picture_arguments"]]
    exit_code, costs = run(command, log)
    finish(name, "picture", exit_code, message_of(exit_code, log, surface), costs, last_attempt,
           picture=case["picture"] if exit_code == 0 else None)


def main():
    step, name, threads, last_attempt = sys.argv[1:]
    plan = read_json("plan.json")
    make = {"surface": make_surface, "picture": draw_picture}[step]
    try:
        make(plan["vmesh"], name, plan["cases"][name], threads, last_attempt == "1")
    except OSError as error:
        sys.exit(f"{name}: {step}: not finished: {error}")


if __name__ == "__main__":
    main()
