#!/usr/bin/python3
"""table.py RESULTS [--tell]: writes table.csv and table.md of all cases in RESULTS/plan.json: what they are like, what
they cost, what failed; --tell says the last on stderr."""

import csv
import io
import os
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "engine"))
from files import read_json, write_text

# Column, where the summary has it, and its digits in the Markdown table. Relative: in local radii.
MEASURES = (
    ("vertices", "vertices", 0),
    ("faces", "faces", 0),
    ("components", "topology.components", 0),
    ("genus", "topology.genus", 0),
    ("skewness_mean", "skewness.mean", 3),
    ("skewness_max", "skewness.max", 3),
    ("distance_mean", "distance.mean_relative", 3),
    ("distance_max", "distance.max_relative", 3),
    ("distance_mean_mm", "distance.mean_mm", 3),
    ("distance_max_mm", "distance.max_mm", 3),
    ("reference_mean_mm", "fit.after.mean_mm", 3),
    ("reference_p95_mm", "fit.after.p95_mm", 3),
    ("reference_hausdorff_mm", "fit.after.hausdorff_mm.upper", 3),
)
COSTS = (("seconds", 2), ("cpu_seconds", 2), ("peak_memory_mb", 0))
COLUMNS = ["case", "result", "exit_code", *(name for name, _, _ in MEASURES), *(name for name, _ in COSTS), "surface",
           "picture", "message", "input"]
# unmet: a surface was written, but a requested check or limit does not hold.
RESULTS = ("ok", "unmet", "failed", "not finished")
MARKDOWN = ("vertices", "skewness_mean", "skewness_max", "distance_mean", "distance_max", "reference_mean_mm",
            "reference_hausdorff_mm", "seconds", "cpu_seconds", "peak_memory_mb")


def look_up(summary, path):
    for key in path.split("."):
        summary = summary.get(key) if isinstance(summary, dict) else None
    return "" if summary is None else summary


def last_words(name):
    """vmesh's error messages for a case without a status."""
    log = Path(f"log/{name}.surface.log")
    lines = log.read_text(errors="replace").splitlines() if log.exists() else []
    return "; ".join(line.removeprefix("vmesh: ") for line in lines if line.startswith("vmesh: "))


def row_of(name, case):
    row = {column: "" for column in COLUMNS} | {"case": name, "input": case["input"]}
    status = read_json(f"status/{name}.surface.json")
    if status is None:
        return row | {"result": "not finished", "message": last_words(name) or "interrupted or killed; run again"}
    summary = read_json(status["summary"]) if status["summary"] else {}
    picture = read_json(f"status/{name}.picture.json") or {}
    row |= {measure: look_up(summary, path) for measure, path, _ in MEASURES}
    row |= {cost: status[cost] for cost, _ in COSTS}
    bad = "unmet" if status["surface"] else "failed"
    row |= {"result": "ok" if status["exit_code"] == 0 else bad, "exit_code": status["exit_code"],
            "surface": status["surface"] or "", "picture": picture.get("picture") or ""}
    row["message"] = "; ".join(filter(None, (status["message"], picture.get("message"))))
    return row


def as_csv(rows):
    text = io.StringIO()
    writer = csv.DictWriter(text, COLUMNS, lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue()


def markdown_line(cells):
    return "| " + " | ".join(str(cell).replace("|", "\\|").replace("\n", " ") for cell in cells) + " |"


def rounded(row, column):
    digits = {name: digits for name, _, digits in MEASURES} | dict(COSTS)
    return "" if row[column] == "" else f"{row[column]:.{digits[column]}f}"


def as_markdown(plan, rows):
    surfaces = [row for row in rows if row["surface"]]
    failed = [row for row in rows if row["result"] != "ok"]
    lines = [f"# {len(rows)} cases: {len(surfaces)} surfaces, {len(rows) - len(surfaces)} without", "",
             f"By {plan['version']}. Distances are from the surface to the vessels of the centerline in local radii; "
             "those to a reference, an image or a surface it was fitted to, are in mm, the larger way. Times are of "
             "`vmesh generate`; every column and its digits are in table.csv.", ""]
    if failed:
        lines += ["## What failed", "", "| case | result | exit code | message |", "|---|---|--:|---|"]
        lines += [markdown_line(row[column] for column in ("case", "result", "exit_code", "message"))
                  for row in failed]
        lines += ["", "## All", ""]
    lines += [markdown_line(["case", "result", *(column.replace("_", " ") for column in MARKDOWN)]),
              "|---|---|" + "--:|" * len(MARKDOWN)]
    for row in rows:
        name = f"[{row['case']}]({row['picture']})" if row["picture"] else row["case"]
        lines.append(markdown_line([name, row["result"], *(rounded(row, column) for column in MARKDOWN)]))
    return "\n".join(lines) + "\n"


def write_changed(path, text):
    if not Path(path).exists() or Path(path).read_text() != text:
        write_text(path, text)


def tell(rows):
    counts = {result: sum(row["result"] == result for row in rows) for result in RESULTS}
    for row in rows:
        if row["result"] != "ok":
            print(f"{row['case']}: {row['result']}: {row['message']}", file=sys.stderr)
    print(f"{len(rows)} cases: " + ", ".join(f"{count} {result}" for result, count in counts.items() if count) +
          f"; {Path('table.md').resolve()}", file=sys.stderr)


def main():
    os.chdir(sys.argv[1])
    plan = read_json("plan.json")
    rows = [row_of(name, case) for name, case in plan["cases"].items()]
    write_changed("table.csv", as_csv(rows))
    write_changed("table.md", as_markdown(plan, rows))
    if sys.argv[2:] == ["--tell"]:
        tell(rows)


if __name__ == "__main__":
    main()
