"""Results as Markdown tables, in the style of bench/README.md."""

from __future__ import annotations

DASH = "-"


def number(value: float | None, digits: int = 3) -> str:
    """A number without the zero before its point, as in the READMEs; 1 for 1.000."""
    if value is None:
        return DASH
    if value == 1:
        return "1"
    text = f"{value:.{digits}f}"
    return text.replace("0.", ".", 1) if text.startswith(("0.", "-0.")) else text


def cpu(seconds: float | None) -> str:
    """Seconds with two digits that count."""
    if seconds is None:
        return DASH
    return f"{seconds:.0f}" if seconds >= 9.95 else number(seconds, 1 if seconds >= .995 else 2)


def table(header: list[str], rows: list[list[str]], left: int = 1) -> list[str]:
    """Lines of a table whose first `left` columns are words, and the others numbers."""
    rule = ["--" if column < left else "--:" for column in range(len(header))]
    return ["| " + " | ".join(header) + " |", "|" + "|".join(rule) + "|",
            *("| " + " | ".join(row) + " |" for row in rows)]


def pair(result: dict, key: str, digits: int = 3) -> str:
    """A measure where vessels are wide and where they are thin."""
    return " / ".join(number(result[group].get(key), digits) for group in ("wide", "thin"))


def ends(result: dict) -> str:
    return f"{result['ends_found']} of {result['true']['ends']}, {result['ends_false']}"


def of_true(result: dict, key: str) -> str:
    return f"{result['extracted'][key]} of {result['true'][key]}"


def radius_in_voxels(case: dict) -> str:
    """Least, median and largest."""
    return " / ".join(number(case["radius"][key] / case["size"], 1) for key in ("min", "median", "max"))


def detail(cases: list[dict], program: str) -> list[str]:
    """All measures of one program, a case a row."""
    header = ["case", "radius, voxels", "mask", "CPU, s", "MB", "recall", "precision", "position", "p95", "radius",
              "p95", "ends, false", "branchings", "loops"]
    rows = []
    for case in cases:
        run = case["results"].get(program)
        if run is None:
            continue
        row = [case["name"], radius_in_voxels(case), "{components}, {tunnels}".format(**case["mask"])]
        result = run.get("measures")
        if result is None:
            rows.append(row + [DASH] * (len(header) - len(row)))
            continue
        row += [cpu(run["cpu_seconds"]), f"{run['peak_mb']:.0f}"]
        row += [pair(result, "recall"), pair(result, "precision")]
        for key in ("position", "radius"):
            row += [pair(result, f"{key}_mean"), pair(result, f"{key}_p95", 2)]
        row += [ends(result), of_true(result, "branchings"), of_true(result, "loops")]
        rows.append(row)
    return table(header, rows)


def beside(cases: list[dict], programs: list[str]) -> list[str]:
    """The main measures of all programs, a row for each program within each case."""
    header = ["case", "program", "CPU, s", "MB", "recall", "precision", "position", "radius", "ends, false",
              "branchings", "loops"]
    rows = []
    for case in cases:
        name = case["name"]
        for program in programs:
            run = case["results"].get(program)
            if run is None:
                continue
            row, name = [name, program], ""  # a case's name stands in its first row only
            result = run.get("measures")
            if result is None:
                rows.append(row + [DASH] * (len(header) - len(row)))
                continue
            every = result["all"]
            rows.append(row + [
                cpu(run["cpu_seconds"]), f"{run['peak_mb']:.0f}", number(every["recall"]),
                number(every.get("precision")), number(every.get("position_mean")),
                number(every.get("radius_mean")), ends(result), of_true(result, "branchings"),
                of_true(result, "loops")])
    return table(header, rows, left=2)


def in_all(cases: list[dict], programs: list[str]) -> list[str]:
    """A row for each program: sums and means over the cases on which all programs gave a result."""
    shared = [case for case in cases
              if all("measures" in case["results"].get(program, {}) for program in programs)]
    rows = []
    for program in programs if shared else []:
        runs = [case["results"][program] for case in shared]
        results = [run["measures"] for run in runs]

        def average(key: str) -> str:
            values = [result["all"].get(key) for result in results]
            values = [value for value in values if value is not None]
            return number(sum(values) / len(values)) if values else DASH

        found = sum(result["ends_found"] for result in results)
        true = sum(result["true"]["ends"] for result in results)
        false = sum(result["ends_false"] for result in results)
        wrong = sum(abs(result["extracted"]["loops"] - result["true"]["loops"]) for result in results)
        rows.append([program, str(len(shared)), cpu(sum(run["cpu_seconds"] for run in runs)), average("recall"),
                     average("precision"), average("position_mean"), average("radius_mean"),
                     f"{found} of {true}, {false}", str(wrong)])
    header = ["program", "cases", "CPU, s", "recall", "precision", "position", "radius", "ends, false", "loops wrong"]
    return table(header, rows) if rows else []


LEGEND = """\
Radius, voxels: least, median and largest. Mask: its components and tunnels, which differ from the truth's where vessels
touch or are lost. Recall and precision: shares of the true and of the extracted length within half a radius or a voxel
of the other. Position: distance in true radii; radius: relative error; means, and 95th percentiles in the columns p95.
Two figures: where the true radius is at least two voxels / below. Ends: true ones found, and how many extracted ones
are at no true end. Branchings and loops: extracted of true. MB: peak of the process, with its interpreter for those in
Python. A dash: no result, or nothing to measure; the reason is in the JSON."""


def markdown(cases: list[dict], ours: list[str], peers: list[str]) -> str:
    """The whole report."""
    lines = [LEGEND, ""]
    for program in ours:
        lines += [f"**{program}**", "", *detail(cases, program), ""]
    if len(ours) + len(peers) > 1:
        programs = ours + peers
        lines += ["**Side by side**", "", *beside(cases, programs), ""]
        total = in_all(cases, programs)
        if total:
            lines += ["Over the cases on which each gave a result:", "", *total, ""]
    return "\n".join(lines)
