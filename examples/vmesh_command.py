"""Runs `vmesh` for other programs: the add-ons for Blender, ParaView and 3D Slicer have a copy of this file.

Python 3.7 on, nothing beyond its standard library. The command is a process of its own, so that neither its libraries
nor its memory get in the way of the program's. Where there is none, the Python package does the same, if it can be
imported.
"""

from __future__ import annotations

import importlib.util
import os
import re
import shutil
import subprocess
import tempfile
import warnings
from typing import Any, Callable, Dict, Sequence

Progress = Callable[[str, float], Any]  # told the stage and its share; may raise Cancelled
Warn = Callable[[str], Any]
Options = Dict[str, Any]
Paths = Sequence[str]

# Options of the command, and what the package calls them.
_READING = {"unit", "space", "radius_array", "radius", "voxel_size"}
_WRITING = {"output_unit": "unit", "output_space": "space", "bones": "bones", "compress": "compress"}
_SHAPING = {
    name: name
    for name in (
        "around max_error blend placement growth overlap gap ends budget simplification elongation ring_spacing"
        " least_vertices deformable sweeps max_vertices threads"
    ).split()
}
_SHAPING["flow_extensions"] = "flow_extension"
_WARNING = "warning: "
_ERROR = "vmesh: "
_NOT_AS_CLOSE = 6  # of the exit codes in tools/README.md
_HELP = "Run with --help"
_TAG = re.compile(r"<filter-(progress|comment)>([^<]*)</")


class VmeshError(RuntimeError):
    """What vmesh says is wrong, and what to do."""


class Cancelled(Exception):
    """By the function that is told of progress."""


def find_command(path: str = "") -> str | None:
    """The program: `path` or $VMESH_COMMAND if given, else that of a wheel in this Python, else the one in PATH; None if
    there is none of these. VmeshError where a given one is none."""
    given = path or os.environ.get("VMESH_COMMAND", "")
    if given:
        if not (os.path.isfile(given) and os.access(given, os.X_OK)):
            raise VmeshError(f"{given}: this is no program; give the path of vmesh, or none to look for it")
        return given
    package = importlib.util.find_spec("vmesh")
    for folder in package.submodule_search_locations or [] if package else []:
        program = os.path.join(folder, "bin", "vmesh")
        if os.access(program, os.X_OK):
            return program
    return shutil.which("vmesh")


def run(
    words: Sequence[str],
    progress: Progress | None = None,
    warn: Warn | None = None,
    command: str = "",
    environment: dict[str, str] | None = None,
) -> None:
    """`vmesh WORDS...`, a verb that takes --slicer.

    progress     called with a stage and a fraction in [0, 1]; returning False ends the program and raises Cancelled
    warn         called with every warning, a line each
    command      path of the program; "": find_command()
    environment  of the process; None: os.environ

    Raises VmeshError.
    """
    program = find_command(command)
    if program is None:
        raise VmeshError(
            "vmesh was not found: install its wheel or its Debian package, or give the path of the command"
        )
    words = [program, *map(str, words), "--slicer"]
    with tempfile.TemporaryFile("w+", errors="replace") as messages:
        process = subprocess.Popen(
            words,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=messages,
            universal_newlines=True,
            env=environment,
        )
        assert process.stdout is not None
        try:
            _pass_on(process.stdout, progress)
        except BaseException:
            _end(process)
            raise
        finally:
            process.stdout.close()
        code = process.wait()
        messages.seek(0)
        lines = messages.read().splitlines()
    _tell([line[len(_WARNING) :] for line in lines if line.startswith(_WARNING)], warn)
    if code == _NOT_AS_CLOSE:  # as asked for; that is a result
        _tell([line[len(_ERROR) :] for line in lines if line.startswith(_ERROR)], warn)
    elif code != 0:
        raise VmeshError(_error_in(lines) or f"{program} ended with the exit code {code}")


def generate(inputs: Paths, output: str, options: Options, **how: Any) -> None:
    """The surface around a centerline as the file `output`.

    inputs   names of files that form one centerline, or of one segmentation
    options  those of `vmesh generate` by their names, with _ for -; None, "" and False: not given, True: a flag, a list:
             with commas between
    how      as for run()
    """
    given = _given(options)
    if _has_only_package(how):
        _generate_here(inputs, output, given, how)
    else:
        run(["generate", *inputs, "-o", output, *_words(given)], **how)


def convert_centerline(inputs: Paths, output: str, options: Options, **how: Any) -> None:
    """The centerline that files form, as the file `output`; options: those for reading. Others as for generate()."""
    given = _given(options)
    if _has_only_package(how):
        _convert_here(inputs, output, given)
    else:
        run(["convert", *inputs, "-o", output, *_words(given)], **how)


def _error_in(lines: list[str]) -> str:
    """What is wrong begins with the program's name, behind what it told before."""
    told = [line for line in lines if not line.startswith((_WARNING, "cleaning: ", _HELP))]
    begin = next((i for i, line in enumerate(told) if line.startswith(_ERROR)), 0)
    return "\n".join(told[begin:]).replace(_ERROR, "", 1)


def _given(options: Options) -> Options:
    return {name: value for name, value in options.items() if value is not None and value != "" and value is not False}


def _words(given: Options) -> list[str]:
    words = []
    for name, value in given.items():
        words.append("--" + name.replace("_", "-"))
        if value is not True:
            words.append(",".join(map(str, value)) if isinstance(value, (list, tuple)) else str(value))
    return words


def _has_only_package(how: dict[str, Any]) -> bool:
    return find_command(how.get("command", "")) is None and importlib.util.find_spec("vmesh") is not None


def _tell(warnings: Any, warn: Warn | None) -> None:
    if warn is not None:
        for line in warnings:
            warn(line)


def _pass_on(lines: Any, progress: Progress | None) -> None:
    stage = ""
    for line in lines:
        for kind, text in _TAG.findall(line):
            if kind == "comment":
                stage = text
            elif progress is not None and progress(stage, float(text)) is False:
                raise Cancelled(stage)


def _end(process: Any) -> None:
    process.terminate()
    try:
        process.wait(10)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


def _refuse_unknown(given: Options, known: Any) -> None:
    unknown = sorted(set(given) - known)
    if unknown:
        raise VmeshError(f"{', '.join(unknown)}: this needs the command vmesh, which is not beside the Python package")


def _read_here(vmesh: Any, inputs: Paths, given: Options, **more: Any) -> Any:
    options = {name: given[name] for name in _READING if name in given}
    return vmesh.read_centerline(list(inputs), **options, **more)


def _generate_here(inputs: Paths, output: str, given: Options, how: dict[str, Any]) -> None:
    """By the Python package."""
    import vmesh

    _refuse_unknown(given, _READING | set(_WRITING) | set(_SHAPING))
    try:
        tree = _read_here(vmesh, inputs, given)
        shaping = {_SHAPING[name]: given[name] for name in _SHAPING if name in given}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", vmesh.SurfaceWarning)  # they are in surface.warnings
            surface = vmesh.generate(tree, progress=how.get("progress"), **shaping)
        surface.save(output, **{_WRITING[name]: given[name] for name in _WRITING if name in given})
    except vmesh.Cancelled as error:
        raise Cancelled(str(error)) from None
    except (vmesh.Error, TypeError) as error:
        raise VmeshError(str(error)) from None
    _tell([*tree.warnings, *surface.warnings], how.get("warn"))


def _convert_here(inputs: Paths, output: str, given: Options) -> None:
    import vmesh

    _refuse_unknown(given, _READING)
    try:
        _read_here(vmesh, inputs, given, canonical_order=False).save(output)
    except vmesh.Error as error:
        raise VmeshError(str(error)) from None
