"""What a run of Snakemake says to the user: how far it is, a line every three seconds at most, and what went wrong.

It goes to the file of the number $VMESH_PROGRESS; what Snakemake itself writes to stderr is much more.
"""

import os
import time

PERIOD_S = 3.0
WORTH_SAYING = ("Nothing to be done", "Trying to restart", "Will exit")
last_said = 0.0


def say(text):
    os.write(int(os.environ.get("VMESH_PROGRESS", "2")), f"{text}\n".encode())


def say_errors(log):
    """Shows vmesh's error messages from a log."""
    try:
        with open(log, errors="replace") as lines:
            for line in lines:
                if line.startswith("vmesh: "):
                    say(f"  {line.rstrip()}")
    except OSError:
        say(f"  there is no {log}")


def log_handler(message):
    global last_said
    level, text = message["level"], str(message.get("msg") or "")
    if level == "progress":
        finished = message["done"] == message["total"]
        if finished or time.monotonic() - last_said >= PERIOD_S:
            last_said = time.monotonic()
            say(f"{message['done']} of {message['total']} steps done")
    elif level in ("job_error", "group_error"):
        files = message.get("output") or [file for job in message.get("job_error_info", []) for file in job["output"]]
        say(f"not finished: {', '.join(files)} {text}".rstrip())
        for log in message.get("log") or []:
            say_errors(log)
    elif level in ("error", "warning", "run_info") or text.startswith(WORTH_SAYING):
        say(text)
