"""Opens pages in a headless Chromium: browser_test.py VMESH EXAMPLES. Exits with 77, loudly, where there is none."""
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True  # next to the sources
if not shutil.which("chromium"):
    print("SKIPPED: no Chromium; scripts/install-dependencies --with-browser")
    sys.exit(77)
try:
    from browser import Browser
except ImportError:
    print("SKIPPED: no python3-websocket; scripts/install-dependencies --with-browser")
    sys.exit(77)

VMESH, EXAMPLES = map(os.path.abspath, sys.argv[1:3])
# Pixels that are not the ground's, of those that are drawn.
DRAWN = """(() => { vmesh.scene.render(); const gl = vmesh.scene.renderer.getContext();
  const [w, h] = [gl.drawingBufferWidth, gl.drawingBufferHeight]; const p = new Uint8Array(4 * w * h);
  gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, p);
  let n = 0; for (let i = 3; i < p.length; i += 4) n += p[i] > 0; return n / (w * h); })()"""
CAMERA = "vmesh.scene.camera.position.toArray().concat(vmesh.scene.controls.target.toArray())"
# Where a vertex in front of all others is on the screen.
FRONT = """(() => { const s = vmesh.shown.surface; let best = 0, near = Infinity; const c = vmesh.scene.camera.position;
  for (let v = 0; v < s.vertices; ++v) { const d = vmesh.shown.vertex(v).distanceTo(c); if (d < near) near = d, best = v; }
  const p = vmesh.scene.onScreen(vmesh.shown.vertex(best)), b = vmesh.scene.canvas.getBoundingClientRect();
  return [best, p.x + b.left, p.y + b.top]; })()"""


def distance(a, b):
    return sum((x - y) ** 2 for x, y in zip(a, b)) ** 0.5


class PageInABrowser(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix="vmesh-pages-")
        cls.vmesh("synth", "--vertices", "1560", "--seed", "1", "-o", "tree.json")
        cls.vmesh("generate", "tree.json", "-o", "tree.ply", "--html", "tree.html")
        cls.vmesh("synth", "--vertices", "119", "-o", "small.json")
        cls.vmesh("generate", "small.json", "-o", "small.ply")
        cls.vmesh("generate", "small.json", "-o", "fine.ply", "--preset", "high")
        cls.vmesh("evaluate", "small.ply", "--reference", "fine.ply", "--centerline", "small.json", "--html", "eval.html")
        cls.vmesh("table2", "--centerline", "small.json", "--voxel", "2", "--samples", "3000", "--html", "table2.html")
        cls.vmesh("deform", "small.json", "small.ply", "--script", f"{EXAMPLES}/pull_branch.json", "-o", "moved",
                  "--html", "moved.html")

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    @classmethod
    def vmesh(cls, *arguments):
        subprocess.run([VMESH, *arguments, "-q"], cwd=cls.folder, check=True, stdout=subprocess.DEVNULL)

    def page(self, name):
        return os.path.join(self.folder, name)

    def test_twenty_seven_thousand_vertices_take_less_than_two_megabytes(self):
        self.assertLess(os.path.getsize(self.page("tree.html")), 2_000_000)

    def test_draws_at_the_size_of_a_desk_and_of_a_phone(self):
        for width, height, touch in ((1400, 900, False), (400, 800, True)):
            with self.subTest(width=width), Browser(width, height, touch) as browser:
                seconds = browser.open(self.page("tree.html"))
                print(f"tree.html at {width} px: drawn after {seconds:.2f} s")
                self.assertEqual(browser.ask("innerWidth"), width)
                self.assertGreater(browser.ask(DRAWN), 0.03)
                self.assertLessEqual(browser.ask("document.documentElement.scrollWidth"), width, "nothing sticks out")
                self.assertGreater(browser.ask("document.querySelectorAll('#report table tr').length"), 20)
                self.assertEqual(browser.problems, [])

    def test_a_click_on_a_worst_place_moves_the_camera_there(self):
        for width, height, touch in ((1400, 900, False), (400, 800, True)):
            with self.subTest(width=width), Browser(width, height, touch, motion=True) as browser:
                browser.open(self.page("tree.html"))
                before = browser.ask(CAMERA)
                browser.click_on("[data-place='5']")
                after = browser.ask(CAMERA)
                place = browser.ask("vmesh.page.places[4].at.map((x, i) => x - vmesh.origin[i])")
                self.assertLess(distance(after[3:], place), 1e-3, "it looks at the place")
                self.assertGreater(distance(before[:3], after[:3]), 1)
                self.assertLess(distance(after[:3], place), 0.5 * distance(before[:3], place), "from nearer")
                self.assertEqual(browser.ask("document.querySelector('[aria-current=true]').dataset.place"), "5")
                self.assertEqual(browser.ask("location.hash"), "#place=5")
                self.assertFalse(browser.ask("document.getElementById('mark').hidden"))
                self.assertEqual(browser.problems, [])

    def test_a_click_on_the_surface_tells_of_the_vertex(self):
        for width, height, touch in ((1400, 900, False), (400, 800, True)):
            with self.subTest(width=width), Browser(width, height, touch) as browser:
                browser.open(self.page("eval.html"), "#place=1")
                vertex, x, y = browser.ask(FRONT)
                browser.click(x, y)
                self.assertEqual(browser.ask("document.getElementById('picked-name').textContent"), f"Vertex {vertex}")
                told = browser.ask("document.getElementById('picked-values').innerText")
                for word in ("radius", "Branch", "Segment", "Distance to the reference", "Skewness"):
                    self.assertIn(word, told)
                self.assertEqual(browser.problems, [])

    def test_turns_by_dragging_and_by_keys(self):
        for width, height, touch in ((1400, 900, False), (400, 800, True)):
            with self.subTest(width=width), Browser(width, height, touch) as browser:
                browser.open(self.page("eval.html"))
                still = browser.ask(CAMERA)
                browser.drag(180, 120, 260, 150)
                dragged = browser.ask(CAMERA)
                self.assertGreater(distance(still[:3], dragged[:3]), 1)
                self.assertLess(distance(still[3:], dragged[3:]), 1e-6)
                self.assertTrue(browser.ask("document.getElementById('picked').hidden"), "a drag is not a click")
                browser.press("ArrowLeft")
                turned = browser.ask(CAMERA)
                self.assertGreater(distance(dragged[:3], turned[:3]), 1)
                browser.press("+")
                near = browser.ask(CAMERA)
                self.assertAlmostEqual(distance(near[:3], near[3:]), 0.85 * distance(turned[:3], turned[3:]), places=6)
                browser.press("0")
                self.assertLess(distance(browser.ask(CAMERA), still), 1e-6)
                self.assertEqual(browser.problems, [])

    def test_shows_and_hides(self):
        with Browser(1400, 900) as browser:
            browser.open(self.page("eval.html"))
            for key, shown in (("e", "vmesh.shown.edges && vmesh.shown.edges.visible"), ("c", "vmesh.lines.visible"),
                               ("r", "vmesh.reference.group.visible"), ("g", "vmesh.shown.mesh.material.transparent")):
                self.assertFalse(browser.ask(shown), key)
                browser.press(key)
                self.assertTrue(browser.ask(shown), key)
                browser.press(key)
                self.assertFalse(browser.ask(shown), key)
            before = browser.ask("document.getElementById('legend').innerText")
            browser.ask("(() => { const c = document.getElementById('color'); c.value = 'radius';"
                        "c.dispatchEvent(new Event('change')); })()")
            self.assertNotEqual(browser.ask("document.getElementById('legend').innerText"), before)
            browser.press("?")
            self.assertFalse(browser.ask("document.getElementById('help').hidden"))
            browser.press("Escape")
            self.assertTrue(browser.ask("document.getElementById('help').hidden"))
            self.assertEqual(browser.problems, [])

    def test_links_say_what_to_show(self):
        with Browser(1400, 900) as browser:
            browser.open(self.page("eval.html"), "#color=radius&edges=1&view=L")
            self.assertEqual(browser.ask("document.getElementById('color').value"), "radius")
            self.assertTrue(browser.ask("vmesh.shown.edges.visible"))
            camera = browser.ask(CAMERA)
            self.assertGreater(camera[0] - camera[3], 0.99 * distance(camera[:3], camera[3:]), "from the left")

    def test_colours_rise_evenly_in_lightness(self):
        with Browser(1400, 900) as browser:
            browser.open(self.page("eval.html"))
            # CIE L*, of the luminance of sRGB
            light = browser.ask("""SEQUENTIAL.map(rgb => { const [r, g, b] = rgb.map(c => { c /= 255;
              return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4; });
              return 116 * Math.cbrt(0.2126 * r + 0.7152 * g + 0.0722 * b) - 16; })""")
            self.assertGreater(light[-1] - light[0], 60)
            for i in range(16, len(light), 16):
                self.assertGreater(light[i] - light[i - 16], 2, "a sixteenth of the scale can be told from the next")

    def test_holds_several_surfaces(self):
        with Browser(1400, 900) as browser:
            browser.open(self.page("table2.html"))
            names = browser.ask("Array.from(document.querySelectorAll('#surface option')).map(o => o.value)")
            self.assertGreaterEqual(len(names), 4)
            browser.ask("(() => { const s = document.getElementById('surface'); s.value = 'truncated cones';"
                        "s.dispatchEvent(new Event('change')); })()")
            self.assertEqual(browser.ask("vmesh.shown.surface.name"), "truncated cones")
            other = browser.ask("vmesh.page.places.findIndex(p => p.surface && p.surface !== 'truncated cones')")
            browser.click_on(f"[data-place='{other + 1}']")
            self.assertEqual(browser.ask("vmesh.shown.surface.name"), browser.ask(f"vmesh.page.places[{other}].surface"))
            self.assertGreater(browser.ask(DRAWN), 0.01)
            self.assertEqual(browser.problems, [])

    def test_plays_a_motion(self):
        with Browser(1400, 900) as browser:
            browser.open(self.page("moved.html"))
            frames = browser.ask("vmesh.player.positions.length")
            self.assertGreater(frames, 5)
            rest = browser.ask("Array.from(vmesh.shown.surface.positions)")
            browser.press(".")
            self.assertEqual(browser.ask("vmesh.player.frame"), 1)
            browser.press(" ")
            browser.ask("new Promise(done => setTimeout(done, 900))")
            browser.press(" ")
            self.assertGreater(browser.ask("vmesh.player.frame"), 1)
            browser.ask(f"vmesh.player.stopAt({frames - 1})")
            moved = browser.ask("Array.from(vmesh.shown.surface.positions)")
            far = max(abs(a - b) for a, b in zip(rest, moved))
            self.assertGreater(far, 10)
            self.assertEqual(browser.problems, [])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
