"""Runs a command, and measures it: measured_run.py RESULT.json TIMEOUT COMMAND...

Writes its exit code, CPU and wall seconds, peak memory, and the end of what it printed. It is a process of its own, and
imports little, for the kernel counts what a process held before it executed another program into the peak of that
program; started by the benchmark itself, with masks in memory, every command would seem to need as much.
"""

from __future__ import annotations

import json
import math
import os
import resource
import signal
import subprocess
import sys
import tempfile
import time


PATIENCE = 4  # wall seconds for each CPU second of a timeout: on a busy machine a command gets a share of a core only


def run(command: list[str], timeout: float) -> dict:
    """Runs a command; `timeout` in CPU seconds, after which it is killed with all that it started."""
    def limit() -> None:
        seconds = math.ceil(timeout)
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 1))

    with tempfile.TemporaryFile() as printed:
        start = time.monotonic()
        child = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=printed, stderr=subprocess.STDOUT,
                                 start_new_session=True, preexec_fn=limit)
        timed_out = False
        pid = 0
        try:
            while True:
                pid, status, usage = os.wait4(child.pid, os.WNOHANG)
                if pid:
                    break
                if not timed_out and time.monotonic() - start > PATIENCE * timeout:
                    timed_out = True
                    os.killpg(child.pid, signal.SIGKILL)
                time.sleep(.005)
        finally:
            if not pid:  # interrupted; what is in a session of its own does not get the terminal's Ctrl-C
                os.killpg(child.pid, signal.SIGKILL)
        wall = time.monotonic() - start
        child.returncode = status  # it was waited for; Popen must not do it again
        printed.seek(0, os.SEEK_END)
        printed.seek(max(0, printed.tell() - 4000))
        tail = printed.read().decode(errors="replace")
    code = os.WEXITSTATUS(status) if os.WIFEXITED(status) else -os.WTERMSIG(status)
    return {
        "exit_code": code,
        "timed_out": timed_out or code == -signal.SIGXCPU,
        "cpu_seconds": usage.ru_utime + usage.ru_stime,
        "wall_seconds": wall,
        "peak_mb": usage.ru_maxrss / 1024,  # Linux gives KB
        "printed": tail,
    }


def main() -> None:
    output, timeout, *command = sys.argv[1:]
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
    result = run(command, float(timeout))
    with open(output, "w", encoding="utf-8") as file:
        json.dump(result, file)


if __name__ == "__main__":
    main()
