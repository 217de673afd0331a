"""What the README says, run."""

import pathlib
import re

import pytest
import vmesh

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
