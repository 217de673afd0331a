"""Options of the vmesh command, from the configuration or the command line of a workflow."""

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


def version_of(vmesh):
    try:
        return subprocess.run([vmesh, "--version"], capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError) as error:
        raise PlanError(f"{vmesh} does not run: {error}") from None
