"""What the package promises as a whole: names, documentation, types."""

import ast
import inspect
import os
import pathlib
import re
import shutil
import subprocess
import sys

import pytest
import vmesh
import vmesh._core

ROOT = pathlib.Path(__file__).parents[2]


def test_every_public_name_is_documented():
    for name in vmesh.__all__:
        if name == "__version__":
            continue
        thing = getattr(vmesh, name)
        assert inspect.getdoc(thing), name
        if inspect.isclass(thing) and not issubclass(thing, Exception):
            for member in vars(thing):
                assert member.startswith("_") or hasattr(thing, member)


def test_the_version_is_that_of_the_project():
    text = (ROOT / "CMakeLists.txt").read_text()
    assert f"project(vmesh VERSION {vmesh.__version__} " in text


def test_the_command_starts_without_numpy():
    program = "import sys, vmesh.__main__; print(*sys.modules)"
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    loaded = run.stdout.split()
    assert "vmesh" in loaded
    assert not {"numpy", "vmesh._core", "vmesh._public"} & set(loaded)


def test_names_are_found_when_they_are_asked_for():
    program = "from vmesh import *; print(generate.__name__, InvalidInput.__name__)"
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert run.stdout.split() == ["generate", "InvalidInput"]
    assert set(vmesh.__all__) <= set(dir(vmesh))
    with pytest.raises(AttributeError, match="module 'vmesh' has no attribute 'nothing'"):
        vmesh.nothing


def test_errors_are_what_python_expects():
    assert issubclass(vmesh.InvalidInput, (vmesh.Error, ValueError)) and issubclass(vmesh.InvalidInput, ValueError)
    assert issubclass(vmesh.ReadError, OSError) and issubclass(vmesh.WriteError, OSError)
    for name in vmesh.__all__:
        thing = getattr(vmesh, name)
        if inspect.isclass(thing) and issubclass(thing, Exception) and not issubclass(thing, Warning):
            assert issubclass(thing, vmesh.Error) and thing.__module__ == "vmesh"


@pytest.fixture
def mypy(tmp_path):
    pytest.importorskip("mypy", reason="mypy is missing")
    environment = {**os.environ, "MYPY_CACHE_DIR": str(tmp_path)}
    return lambda *arguments: subprocess.run(
        [sys.executable, "-m", *arguments], capture_output=True, text=True, env=environment, cwd=tmp_path
    )


def test_the_stubs_name_what_there_is(mypy, tmp_path):
    # Not compared: metaclasses, and constructors of what only vmesh makes.
    allowed = tmp_path / "allowed"
    allowed.write_text("vmesh\\._core\\.[A-Z]\\w*\nvmesh\\._core\\.[A-Z]\\w*\\.__init__\n")
    run = mypy("mypy.stubtest", "vmesh._core", "--allowlist", str(allowed), "--ignore-unused-allowlist")
    assert run.returncode == 0, run.stdout + run.stderr


def arguments_of(function):
    """Names in the signature that pybind11 puts first in a docstring."""
    signature = function.__doc__.splitlines()[0]
    return re.findall(r"[(,] ?(\w+): ", signature)


def test_the_stubs_name_all_arguments():
    tree = ast.parse((pathlib.Path(vmesh.__file__).parent / "_core.pyi").read_text())
    checked = 0
    for outer in tree.body:
        for node in [outer] + (outer.body if isinstance(outer, ast.ClassDef) else []):
            if not isinstance(node, ast.FunctionDef) or node.decorator_list:
                continue
            owner = vmesh._core if node is outer else getattr(vmesh._core, outer.name)
            expected = [a.arg for a in node.args.args + node.args.kwonlyargs]
            assert arguments_of(getattr(owner, node.name)) == expected, (outer.name, node.name)
            checked += 1
    assert checked > 30


def test_the_package_and_the_examples_are_typed(mypy, tmp_path):
    # Beside an installed package there are others, which mypy would take for files of one's own.
    package = tmp_path / "alone" / "vmesh"
    compiled = shutil.ignore_patterns("*.so", "bin", "__pycache__")
    shutil.copytree(pathlib.Path(vmesh.__file__).parent, package, ignore=compiled)
    examples = sorted(str(path) for path in (ROOT / "examples").glob("*.py"))
    assert examples
    # Calls of others: ours are all typed, VTK's are or not, by its version.
    run = mypy("mypy", "--strict", "--allow-untyped-calls", "--ignore-missing-imports", str(package), *examples)
    assert run.returncode == 0, run.stdout + run.stderr


def test_numpy_2_is_refused_where_arrays_would_be_wrong():
    program = "import numpy; numpy.__version__ = '2.1.0'; import vmesh; vmesh.generate"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    if vmesh._core._knows_numpy_2:
        assert done.returncode == 0
    else:
        assert "pybind11 before 2.12" in done.stderr
