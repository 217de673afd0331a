"""Pictures of surfaces."""

import os
import subprocess

import numpy as np
import pytest
import vmesh

from shapes import FORK, box

SMALL = {"width": 120, "height": 90}


def is_drawn(pixels, background=(246, 247, 249)):
    return (np.abs(pixels.astype(int) - background).max(axis=2) > 8).any(axis=None)


def test_a_picture_is_an_array_of_its_size():
    pixels = vmesh.render(box(), **SMALL)
    assert pixels.shape == (90, 120, 3) and pixels.dtype == np.uint8
    assert is_drawn(pixels)
    assert not is_drawn(vmesh.render(box(), look_at=[1000, 0, 0], view_height=5, **SMALL))


def test_the_command_draws_the_same(tmp_path):
    command = os.environ.get("VMESH_COMMAND")
    if not command:
        pytest.skip("the command was not built")
    surface = vmesh.generate(*FORK)
    surface.save(tmp_path / "fork.ply")
    options = ["--edges", "--color", "branch", "--view", "30,-15", "--width", "120", "--height", "90", "--quiet"]
    subprocess.run([command, "render", tmp_path / "fork.ply", "-o", tmp_path / "command.png", *options], check=True)
    vmesh.render(surface, tmp_path / "python.png", edges=True, color="branch", view=(30, -15), **SMALL)
    assert (tmp_path / "python.png").read_bytes() == (tmp_path / "command.png").read_bytes()


def test_it_is_coloured_by_names_and_by_numbers():
    surface = vmesh.generate(*FORK)
    of_name = vmesh.render(surface, color="radius", legend=False, **SMALL)
    np.testing.assert_array_equal(of_name, vmesh.render(surface, color=surface.radius, legend=False, **SMALL))
    of_faces = vmesh.render(surface, color=surface.skewness, legend=False, **SMALL)
    np.testing.assert_array_equal(of_faces, vmesh.render(surface, color="skewness", legend=False, **SMALL))
    assert (of_name != of_faces).any()
    # the greatest value is yellow, the least dark blue
    high = vmesh.render(box(), color=np.ones(8), range=(0, 1), legend=False, **SMALL)[45, 60].astype(int)
    low = vmesh.render(box(), color=list(range(8)), range=(9, 10), legend=False, **SMALL)[45, 60].astype(int)
    assert high[0] > 100 and high[1] > 100 and high[2] < 100
    assert low[2] > low[1]


@pytest.mark.parametrize(
    "options, message",
    [
        ({"color": "thickness"}, "no attribute thickness to colour by; the surface has none"),
        ({"color": [1.0, 2.0]}, "color"),
        ({"view": "behind"}, "behind"),
        ({"width": 3}, "width"),
        ({"look_at": [1, 2]}, "look_at"),
    ],
)
def test_what_is_wrong_is_said(tmp_path, options, message):
    with pytest.raises(vmesh.InvalidInput, match=message):
        vmesh.render(box(), tmp_path / "a.png", **{**SMALL, **options})
    assert list(tmp_path.iterdir()) == []


def test_a_picture_that_cannot_be_written_is_an_error(tmp_path):
    with pytest.raises(vmesh.WriteError):
        vmesh.render(box(), tmp_path / "none" / "a.png", **SMALL)
