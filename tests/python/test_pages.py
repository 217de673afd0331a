"""Pages that show a surface in a browser."""

import html
import json
import re

import numpy as np
import pytest
import vmesh

from shapes import FORK, box


@pytest.fixture
def made(tmp_path):
    """Makes a page and returns the data in it."""

    def make(surface, **options):
        path = tmp_path / "fork.html"
        try:
            vmesh.page(surface, path, **options)
        except vmesh.Unsupported as error:
            assert "built without pages" in str(error) and not path.exists()
            pytest.skip(str(error))
        text = path.read_text(encoding="utf-8")
        assert "src=" not in re.sub(r"<script>.*?</script>", "", text, flags=re.DOTALL)  # nothing from elsewhere
        return json.loads(re.search(r'<script[^>]*id="page-data">(.*?)</script>', text, re.DOTALL).group(1))

    return make


def test_a_page_has_the_surface_and_what_is_known_of_it(made):
    surface = vmesh.generate(*FORK)
    page = made(surface, title="A fork")
    assert page["title"] == "A fork"
    shown = page["surfaces"][0]
    assert (shown["vertices"], shown["faces"]) == (len(surface.vertices), len(surface.faces))
    names = {attribute["name"] for attribute in shown["attributes"]}
    assert {"radius", "branch", "EquiangleSkewness", "volume_distance"} <= names
    assert page["centerline"]["nodes"] == len(FORK[0])
    skew = [place for place in page["places"] if place["label"] == "Skew triangle"]
    assert float(skew[0]["value"]) == pytest.approx(surface.skewness.max(), abs=5e-4)
    corners = surface.vertices[surface.faces[surface.skewness.argmax()]]
    np.testing.assert_allclose(skew[0]["at"], corners.mean(axis=0))


def test_it_compares_with_a_reference(made):
    surface, reference = vmesh.Surface(*box()), vmesh.Surface(*box(side=1.25, origin=(0, 0, -0.5)))
    page = made(surface, reference=(reference.vertices, reference.faces))
    assert [shown["reference"] for shown in page["surfaces"]] == [False, True]
    histogram = next(h for h in page["histograms"] if h["title"] == "Distance of vertices to the reference")
    assert histogram["max"] == pytest.approx(vmesh.closest_points(surface.vertices, reference)[2].max())
    assert page["centerline"] is None


def test_defects_are_places(made):
    nodes = [[-10, 0, 0], [10, 0, 0], [0, -10, 0.5], [0, 10, 0.5]]
    with pytest.warns(vmesh.SurfaceWarning):
        surface = vmesh.generate(nodes, [2] * 4, [[0, 1], [2, 3]], overlap="keep", allow_defects=True)
    page = made(surface)
    assert page["places"][0]["label"].startswith("Defect: crossing faces")
    assert page["warnings"] == surface.warnings


def test_what_cannot_be_written_is_said(tmp_path):
    with pytest.raises(vmesh.Unsupported, match="pages are written as .html or .htm"):
        vmesh.page(box(), tmp_path / "page.pdf")
    with pytest.raises(vmesh.WriteError):
        vmesh.page(box(), tmp_path / "none" / "page.html")
    with pytest.raises(TypeError):
        vmesh.page(None, tmp_path / "page.html")
    assert list(tmp_path.iterdir()) == []


def test_notebooks_show_the_page(made):
    surface = vmesh.generate(*FORK)
    data = made(surface, title="surface")  # skips without pages
    frame = surface._repr_html_()
    assert re.fullmatch(r'<iframe srcdoc="[^"]*" style="[^"]*"></iframe>', frame)
    page = html.unescape(re.search(r'srcdoc="([^"]*)"', frame).group(1))
    assert json.loads(re.search(r'<script[^>]*id="page-data">(.*?)</script>', page, re.DOTALL).group(1)) == data


def test_notebooks_show_the_text_of_what_is_large_or_empty(monkeypatch):
    import vmesh._notebook

    surface = vmesh.generate(*FORK)
    monkeypatch.setattr(vmesh._notebook, "MOST_FACES", len(surface.faces) - 1)
    assert surface._repr_html_() is None
    assert vmesh.Surface(np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64))._repr_html_() is None
