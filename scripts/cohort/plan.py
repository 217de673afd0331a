#!/usr/bin/python3
"""Writes OUT/plan.json: the cases of a cohort, the vmesh options of each, and the SHA-256 of what each is made from.

The Snakefile reads nothing else, so that a job on a cluster does not look for ten thousand files again. A case runs
again when its entry changes, that is, when the content of its files, its options or the version of vmesh do; times of
files do not count.
"""

import argparse
import fnmatch
import glob
import os
import re
import sys
from pathlib import Path

import yaml

sys.path.append(str(Path(__file__).resolve().parents[1] / "engine"))
from files import Hashes, PlanError, content_key, read_json, write_changed
from vmesh_command import Formats, arguments_of, parsed, version_of

TOP_KEYS = {"output", "inputs", "cases", "options", "picture", "surface", "threads", "memory_mb", "minutes"}
INPUT_KEYS = {"files", "exclude", "name", "options", "picture", "threads", "memory_mb", "minutes"}
CASE_KEYS = {"skip", "options", "picture", "threads", "memory_mb", "minutes"}
OURS = {"output", "json", "quiet", "threads", "centerline-output", "help"}  # options that a plan sets itself
DEFAULTS = {"options": {}, "picture": {"width": 800, "height": 600}, "threads": 1, "memory_mb": 2000, "minutes": 60}


def check_keys(where, given, known):
    if not isinstance(given, dict):
        raise PlanError(f"{where}: expected keys and values, got {given!r}")
    for key in given:
        if key not in known:
            raise PlanError(f"{where}: there is no key {key!r}; known are {', '.join(sorted(known))}")


def check_settings(where, settings):
    """Checks settings, which may be at the top, for inputs and for cases."""
    for key in ("options", "picture"):
        if settings.get(key) in (None, False) and key == "picture":
            continue
        if key in settings and not isinstance(settings[key], dict):
            raise PlanError(f"{where}: {key}: expected names and values like {{around: 8, tree: true}}, "
                            f"got {settings[key]!r}")
    for option in settings.get("options", {}):
        if option in OURS:
            raise PlanError(f"{where}: options: {option} is set by the workflow; leave it out")
    for key in ("threads", "memory_mb", "minutes"):
        if key in settings and (type(settings[key]) is not int or settings[key] < 1):
            raise PlanError(f"{where}: {key}: expected an integer of at least 1, got {settings[key]!r}")


def merged(*levels):
    """Settings of the levels, the later before the earlier; options and those of the picture one by one."""
    result = {key: dict(value) if isinstance(value, dict) else value for key, value in DEFAULTS.items()}
    for level in levels:
        for key in DEFAULTS:
            if key not in level:
                continue
            both_dicts = isinstance(level[key], dict) and isinstance(result[key], dict)
            result[key] = {**result[key], **level[key]} if both_dicts else level[key]
    return result


def stem_of(path, formats):
    """The name of a file without what says its format; a folder's whole name."""
    name = path.name
    if path.is_dir():
        return name
    for suffix in formats.inputs:
        if name.lower().endswith(suffix):
            return name[: -len(suffix)]
    return path.stem


def is_image(path, formats):
    return path.is_dir() or path.name.lower().endswith(formats.images)


def fixed_folder(pattern):
    """The part of a pattern before its first wildcard, as a folder."""
    parts = []
    for part in Path(pattern).parts[:-1]:
        if glob.has_magic(part):
            break
        parts.append(part)
    return Path(*parts)


def name_of(path, base, template, formats):
    folder = os.path.relpath(path.parent, base)
    fields = {"stem": stem_of(path, formats), "parent": path.parent.name, "folder": "" if folder == "." else folder + "/"}
    try:
        name = template.format(**fields)
    except (KeyError, IndexError, ValueError) as error:
        raise PlanError(f"name {template!r}: {error}; known are {{folder}}, {{parent}} and {{stem}}") from None
    return re.sub(r"[^\w.+=@/-]", "_", name, flags=re.ASCII).strip("/")


def is_second_of_pair(path):
    """Whether the file belongs to another one: the segments of a CSV pair, or Voreen's edges beside its nodes."""
    folder, name = os.path.split(path)
    head, edges, tail = name.rpartition("edges")
    has_nodes = edges and name.endswith(".csv") and os.path.exists(os.path.join(folder, f"{head}nodes{tail}"))
    return name.endswith(".segments.csv") or bool(has_nodes)


def find_inputs(entry, where, folder, formats):
    """Path and name of each case of an entry of `inputs`."""
    patterns = entry.get("files")
    patterns = [patterns] if isinstance(patterns, str) else patterns
    exclude = entry.get("exclude", [])
    exclude = [exclude] if isinstance(exclude, str) else exclude
    if not patterns or not all(isinstance(pattern, str) for pattern in [*patterns, *exclude]):
        raise PlanError(f"{where}: files and exclude: expected a pattern like masks/*.nii.gz or a list of such")
    for pattern in patterns:
        absolute = os.path.join(folder, pattern)
        paths = sorted(glob.glob(absolute, recursive=True))
        paths = [path for path in paths if not is_second_of_pair(path) and
                 not any(fnmatch.fnmatch(path, os.path.join(folder, unwanted)) for unwanted in exclude)]
        if not paths:
            raise PlanError(f"{where}: nothing matches {pattern} in {folder}; check the pattern")
        for path in map(Path, paths):
            yield path, name_of(path, fixed_folder(absolute), entry.get("name", "{folder}{stem}"), formats)


def fit_reference(options, name, path, folder, formats):
    """Replaces {case}, {stem} and {parent} in the option fit, a file that counts as an input."""
    if not options.get("fit"):
        return None
    try:
        reference = str(options["fit"]).format(case=name, stem=stem_of(path, formats), parent=path.parent.name)
    except (KeyError, IndexError, ValueError) as error:
        raise PlanError(f"options: fit: {error}; known are {{case}}, {{parent}} and {{stem}}") from None
    options["fit"] = os.path.join(folder, reference)
    return Path(options["fit"])


def plan_case(path, name, settings, folder, surface, hashes, formats):
    options = dict(settings["options"])
    reference = fit_reference(options, name, path, folder, formats)
    case = {
        "input": str(path),
        "sha256": hashes.of_input(path),
        "arguments": arguments_of(options),
        "surface": f"surfaces/{name}.{surface}",
        "summary": f"summaries/{name}.json",
        "centerline": f"centerlines/{name}.json" if is_image(path, formats) else None,
        "picture": None if not settings["picture"] else f"pictures/{name}.png",
        "picture_arguments": arguments_of(settings["picture"] or {}),
        "threads": settings["threads"],
        "memory_mb": settings["memory_mb"],
        "minutes": settings["minutes"],
    }
    if reference:
        case["reference_sha256"] = hashes.of_input(reference)
    return case


# Keys on which a surface does not depend; a picture depends on its surface.
NOT_OF_SURFACE = {"picture", "picture_arguments", "threads", "memory_mb", "minutes"}


def add_keys(case, version):
    surface = {name: value for name, value in case.items() if name not in NOT_OF_SURFACE}
    case["surface_key"] = content_key(version, surface)
    case["picture_key"] = content_key(version, case["picture"], case["picture_arguments"])


def make_cases(config, where, folder, hashes, formats):
    overrides = config.get("cases") or {}
    if not isinstance(overrides, dict):
        raise PlanError(f"{where}: cases: expected names of cases with what is different for them, got {overrides!r}")
    for pattern, override in overrides.items():
        check_keys(f"{where}: cases: {pattern}", override, CASE_KEYS)
        check_settings(f"{where}: cases: {pattern}", override)
    cases, used = {}, set()
    for number, entry in enumerate(config["inputs"], 1):
        place = f"{where}: inputs, entry {number}"
        check_keys(place, entry, INPUT_KEYS)
        check_settings(place, entry)
        for path, name in find_inputs(entry, place, folder, formats):
            matching = [pattern for pattern in overrides if fnmatch.fnmatchcase(name, str(pattern))]
            used.update(matching)
            if any(overrides[pattern].get("skip") for pattern in matching):
                continue
            if name in cases:
                raise PlanError(f"{place}: {path} and {cases[name]['input']} are both the case {name}; tell them apart "
                                f'by name: "{{parent}}-{{stem}}" or leave one out with exclude')
            settings = merged(config, entry, *(overrides[pattern] for pattern in matching))
            cases[name] = plan_case(path, name, settings, folder, config.get("surface", "ply"), hashes, formats)
    for pattern in overrides:
        if pattern not in used:
            raise PlanError(f"{where}: cases: {pattern} is not a case; the first are {', '.join(sorted(cases)[:3])}")
    return dict(sorted(cases.items()))


def read_config(path, formats):
    try:
        config = yaml.safe_load(path.read_text())
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        raise PlanError(f"{path}: {error}") from None
    check_keys(path, config, TOP_KEYS)
    check_settings(path, config)
    if not isinstance(config.get("inputs"), list):
        raise PlanError(f"{path}: inputs: expected a list of patterns, each - files: PATTERN")
    if config.get("surface", "ply") not in formats.surfaces:
        raise PlanError(f"{path}: surface: {config['surface']!r} is none of {', '.join(formats.surfaces)}")
    return config


def config_of_folder(folder, formats):
    found = sorted(path.name for path in folder.iterdir() if path.name.lower().endswith(formats.inputs))
    if not found:
        raise PlanError(f"{folder}: no centerlines or images in it ({' '.join(formats.inputs)})")
    return {"inputs": [{"files": [glob.escape(name) for name in found if not is_second_of_pair(folder / name)]}]}


def forget(out, cases, retry_failed):
    """Removes the status of cases whose files are gone, or that failed, so that they run again."""
    for name, case in cases.items():
        for step, made in (("surface", "surface"), ("picture", "picture")):
            path = out / "status" / f"{name}.{step}.json"
            status = read_json(path)
            if status is None:
                continue
            gone = status.get(made) and not (out / status[made]).exists()
            if gone or (retry_failed and status["exit_code"] != 0):
                path.unlink(missing_ok=True)


def make_plan(arguments):
    source = Path(os.path.abspath(arguments.source))
    formats = Formats(arguments.vmesh)
    if source.is_dir():
        folder, config = source, config_of_folder(source, formats)
        out = source.with_name(source.name + ".cohort")
    elif source.exists():
        folder, config = source.parent, read_config(source, formats)
        out = folder / config.get("output", source.stem + ".cohort")
    else:
        raise PlanError(f"{arguments.source}: there is no such file or folder; check the name")
    config["options"] = {**config.get("options", {}), **dict(map(parsed, arguments.set))}
    check_settings("--set", config)
    out = Path(os.path.abspath(arguments.output or out))
    out.mkdir(parents=True, exist_ok=True)
    hashes = Hashes(out / ".hashes.json")
    cases = make_cases(config, source, folder, hashes, formats)
    hashes.save()
    version = version_of(arguments.vmesh)
    for case in cases.values():
        add_keys(case, version)
    plan = {"schema": "vmesh.cohort/1", "vmesh": arguments.vmesh, "version": version, "cases": cases}
    write_changed(out / "plan.json", plan)
    forget(out, cases, arguments.retry_failed)
    return out


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("source", help="configuration, or a folder of centerlines and images")
    parser.add_argument("-o", "--output", help="folder for the results")
    parser.add_argument("--vmesh", required=True, help="the command, its whole path")
    parser.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", help="option of vmesh generate")
    parser.add_argument("--retry-failed", action="store_true", help="run again what failed")
    try:
        print(make_plan(parser.parse_args()))
    except PlanError as error:
        sys.exit(f"cohort: {error}")
    except OSError as error:
        sys.exit(f"cohort: {error.filename}: {error.strerror}")


if __name__ == "__main__":
    main()
