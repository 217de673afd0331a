"""Options of the vmesh command, from the configuration or the command line of a workflow."""

import json
import subprocess

import yaml

from files import PlanError


def arguments_of(options):
    """{around: 8, tree: true, label: null} as --around 8 --tree."""
    arguments = []
    for name, value in options.items():
        if value is None or value is False:
            continue
        arguments.append(f"--{name}")
        if value is not True:
            arguments.append(str(value))
    return arguments


def parsed(text):
    """NAME=VALUE of the command line, VALUE as in a configuration."""
    name, equals, value = text.partition("=")
    if not equals:
        raise PlanError(f"--set {text}: expected NAME=VALUE, as in --set label=2 or --set tree=true")
    return name, yaml.safe_load(value)


def output_of(vmesh, *arguments):
    try:
        return subprocess.run([vmesh, *arguments], capture_output=True, text=True, check=True).stdout
    except (OSError, subprocess.CalledProcessError) as error:
        raise PlanError(f"{vmesh} does not run: {error}") from None


def version_of(vmesh):
    return output_of(vmesh, "--version").strip()


class Formats:
    """Extensions by what vmesh does with the files: tuples, the longest first, as one may end with another."""

    def __init__(self, vmesh):
        listed = json.loads(output_of(vmesh, "formats", "--json", "-"))

        def extensions(kind, wanted=lambda _: True):
            found = [extension for entry in listed[kind] if wanted(entry) for extension in entry["extensions"]]
            return tuple(sorted(found, key=len, reverse=True))

        self.images = extensions("image")
        centerlines = extensions("centerline", lambda entry: not entry["mostly_another_kind"])
        self.inputs = tuple(sorted(centerlines + self.images, key=len, reverse=True))
        self.surfaces = tuple(name[1:] for name in extensions("surface", lambda entry: entry["written"]))
