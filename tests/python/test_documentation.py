"""What the README says, run."""

import ast
import inspect
import pathlib
import re

import pytest
import vmesh

STUBS = pathlib.Path(vmesh.__file__).parent / "_core.pyi"
README = pathlib.Path(__file__).parents[2] / "libvmesh" / "python" / "README.md"


def blocks():
    return re.findall(r"^```python\n(.*?)^```", README.read_text(), re.MULTILINE | re.DOTALL)


def test_the_examples_run(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    names = {}
    for block in blocks():
        if "to_vtk" in block:
            try:
                import vtkmodules  # noqa: F401
            except ImportError:
                continue
        try:
            exec(block, names)
        except vmesh.Unsupported as error:
            assert "vmesh.page(" in block and "built without pages" in str(error), error
    said = capsys.readouterr().out
    assert "its radius is 0" in said
    assert vmesh.read_surface(tmp_path / "tree.ply").faces.shape == names["surface"].faces.shape
    assert (tmp_path / "pulled.ply").exists()
    # what stands behind print() as a comment
    assert repr(names["surface"]) in README.read_text()


@pytest.mark.parametrize("name", sorted(set(re.findall(r"`(?:vmesh\.)?([A-Za-z_]+)(?:\(|`)", README.read_text()))))
def test_names_in_it_exist(name):
    owners = [vmesh, vmesh.Surface, vmesh.Centerline, vmesh.Deformation, vmesh.DefectiveSurface]
    known = {"help", "PYTHONPATH", "ValueError", "OSError", "KeyboardInterrupt", "False", "progress", "out", "vmesh"}
    known |= {"defects", "surface"}
    assert name in known or any(hasattr(owner, name) for owner in owners), name


def stubs(kind):
    return [node for node in ast.parse(STUBS.read_text()).body if isinstance(node, kind)]


def parameters(function):
    """Names of a public function's parameters: `progress` is the same everywhere."""
    if inspect.isfunction(function):
        return set(inspect.signature(function).parameters) - {"progress"}
    found = [stub for stub in stubs(ast.FunctionDef) if stub.name == function.__name__]
    assert found, function
    return {argument.arg for stub in found for argument in stub.args.args + stub.args.kwonlyargs} - {"progress"}


FUNCTIONS = sorted(name for name in vmesh.__all__ if inspect.isroutine(getattr(vmesh, name)))
CLASSES = sorted(name for name in vmesh.__all__ if inspect.isclass(getattr(vmesh, name)))


@pytest.mark.parametrize("name", FUNCTIONS)
def test_functions_tell_what_every_parameter_is(name):
    function = getattr(vmesh, name)
    told = inspect.getdoc(function)
    if not inspect.isfunction(function):
        told = told.split("\n\n", 1)[1]  # behind the signature
    assert [p for p in parameters(function) if not re.search(rf"\b{p}\b", told)] == []


@pytest.mark.parametrize("name", CLASSES)
def test_members_of_classes_are_told_of(name):
    members = {n: member for n, member in vars(getattr(vmesh, name)).items() if not n.startswith("_")}
    assert [n for n, member in members.items() if not inspect.getdoc(member)] == []


def members_with_arrays():
    for stub in stubs(ast.ClassDef):
        for member in stub.body:
            if isinstance(member, ast.FunctionDef) and not member.name.startswith("_"):
                if re.search(r"_Floats|_Indices|NDArray", ast.unparse(member.returns)):
                    yield stub.name, member.name


@pytest.mark.parametrize("owner, name", list(members_with_arrays()))
def test_arrays_are_told_with_their_shape(owner, name):
    told = inspect.getdoc(getattr(getattr(vmesh, owner), name))
    assert re.search(r"\((\w+,|\w+, \d)\)", told), told


@pytest.mark.parametrize("owner, name", list(members_with_arrays()))
def test_positions_are_told_with_their_unit(owner, name):
    if name in ("nodes", "vertices", "radii", "radius", "position", "center", "from_point", "to_point", "max_at"):
        assert "mm" in inspect.getdoc(getattr(getattr(vmesh, owner), name))
