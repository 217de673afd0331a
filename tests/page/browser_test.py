"""Opens pages in a headless Chromium: browser_test.py VMESH EXAMPLES. Exits with 77, loudly, where there is none."""
import base64
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True  # next to the sources
from browser import DRAWN, Browser

VMESH, EXAMPLES = map(os.path.abspath, sys.argv[1:3])
CAMERA = "vmesh.scene.camera.position.toArray().concat(vmesh.scene.controls.target.toArray())"
# Where a vertex in front of all others is on the screen.
FRONT = """(() => { const s = vmesh.shown.surface; let best = 0, near = Infinity; const c = vmesh.scene.camera.position;
  for (let v = 0; v < s.vertices; ++v) { const d = vmesh.shown.vertex(v).distanceTo(c); if (d < near) near = d, best = v; }
  const p = vmesh.scene.onScreen(vmesh.shown.vertex(best)), b = vmesh.scene.canvas.getBoundingClientRect();
  return [best, p.x + b.left, p.y + b.top]; })()"""


# Where a vertex is on the screen.
ON_SCREEN = """(v => { const p = vmesh.scene.onScreen(vmesh.shown.vertex(v));
  const b = vmesh.scene.canvas.getBoundingClientRect(); return [p.x + b.left, p.y + b.top]; })"""
# The name and, in base64, the content of the file that a choice of Save makes.
SAVED = """(kind => new Promise(done => { const anchor = HTMLAnchorElement.prototype; let blob = null;
  const [click, create] = [anchor.click, URL.createObjectURL];
  URL.createObjectURL = made => { blob = made; return "blob:made"; };
  anchor.click = async function () { const bytes = blob && new Uint8Array(await blob.arrayBuffer());
    const text = blob && btoa(Array.from(bytes, c => String.fromCharCode(c)).join(""));
    done([this.download, text || this.href.split(",")[1]]); };
  const save = document.getElementById("save"); save.value = kind; save.dispatchEvent(new Event("change"));
  anchor.click = click; URL.createObjectURL = create; }))"""
# CIE L* of sRGB.
LIGHTNESS = """(rgb => { const [r, g, b] = rgb.map(c => { c /= 255;
  return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4; });
  return 116 * Math.cbrt(0.2126 * r + 0.7152 * g + 0.0722 * b) - 16; })"""


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

    def evaluated(self, name):
        """What the command says of a surface compared with small.ply."""
        self.vmesh("evaluate", name, "--reference", "small.ply", "--unit", "mm", "--space", "LPS", "--json", "it.json")
        with open(self.page("it.json"), encoding="utf-8") as file:
            return json.load(file)

    def page(self, name):
        return os.path.join(self.folder, name)

    def test_twenty_seven_thousand_vertices_take_less_than_1_6_megabytes(self):
        self.assertLess(os.path.getsize(self.page("tree.html")), 1_600_000)

    def test_has_the_three_js_that_is_pinned(self):
        with open(os.path.join(os.path.dirname(__file__), "..", "..", "scripts", "fetch-three"), encoding="utf-8") as file:
            pinned = re.search(r"^version=0\.(\d+)\.", file.read(), re.MULTILINE).group(1)
        with Browser(400, 400) as browser:
            browser.open(self.page("eval.html"))
            self.assertEqual(browser.ask("window.__THREE__"), pinned)

    def test_surfaces_have_the_colours_of_the_legend(self):
        """Under one light, white and from everywhere, what is drawn is the colour of the scale, not a brighter one."""
        with Browser(500, 500) as browser:
            browser.open(self.page("eval.html"), "#color=branch")
            browser.ask("""(() => { for (const light of vmesh.scene.scene.children.filter(c => c.isLight))
                light.groundColor.copy(light.color), light.intensity = Math.PI;
              for (const light of vmesh.scene.camera.children) light.intensity = 0;
              vmesh.shown.mesh.material.specular.set(0); })()""")
            vertex = browser.ask(FRONT)[0]
            drawn, wanted = browser.ask(f"""(v => {{ const {{ scene, attribute, scale, shown }} = vmesh;
              scene.render();
              const p = scene.onScreen(shown.vertex(v)), gl = scene.renderer.getContext(), rgba = new Uint8Array(4);
              gl.readPixels(Math.round(p.x), scene.canvas.height - Math.round(p.y), 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, rgba);
              return [Array.from(rgba).slice(0, 3), scale.color(attribute.value(v))]; }})({vertex})""")
            for channel in range(3):
                self.assertAlmostEqual(drawn[channel], wanted[channel], delta=3)

    def test_draws_at_the_size_of_a_desk_and_of_a_phone(self):
        for width, height, touch in ((1400, 900, False), (400, 800, True)):
            with self.subTest(width=width), Browser(width, height, touch) as browser:
                seconds = browser.open(self.page("tree.html"))
                print(f"tree.html at {width} px: drawn after {seconds:.2f} s")
                self.assertEqual(browser.ask("innerWidth"), width)
                self.assertGreater(browser.ask(DRAWN), 0.03)
                self.assertLessEqual(browser.ask("document.documentElement.scrollWidth"), width, "nothing sticks out")
                if touch:  # legend and axes have a strip of their own below the tree
                    above, below = browser.ask("""['#picture', '#legend, #axes'].map(all => Math.min(...
                      Array.from(document.querySelectorAll(all), e => e.getBoundingClientRect()[all === '#picture' ? 'bottom' : 'top'])))""")
                    self.assertLess(above, below)
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
            light = browser.ask(f"SEQUENTIAL.map({LIGHTNESS})")
            self.assertGreater(light[-1] - light[0], 60)
            for i in range(16, len(light), 16):
                self.assertGreater(light[i] - light[i - 16], 2, "a sixteenth of the scale can be told from the next")

    def test_the_worst_place_is_brightest(self):
        with Browser(1400, 900) as browser:
            browser.open(self.page("eval.html"))
            for name in ("distance", "volume_distance", "EquiangleSkewness"):
                browser.ask(f"vmesh.colorBy('{name}')")
                worst, brightest, ties = browser.ask(f"""(() => {{ const a = vmesh.attribute, s = vmesh.shown.surface;
                  const light = [], size = []; const colors = vmesh.shown.mesh.geometry.attributes.color.array;
                  for (let i = 0; i < s.corners.length; ++i) {{ const of = a.onFaces ? Math.floor(i / 3) : s.corners[i];
                    size.push(Math.abs(a.value(of)));
                    light.push({LIGHTNESS}(Array.from(colors.subarray(3 * i, 3 * i + 3)))); }}
                  const most = Math.max(...size), top = Math.max(...light);
                  return [light[size.indexOf(most)], top, light.filter(l => l > top - 1e-9).length / light.length]; }})()""")
                self.assertEqual(worst, brightest, name)
                self.assertLess(ties, 0.01, "it stands out: " + name)

    def test_legends_have_numbers_at_both_ends(self):
        with Browser(1400, 900) as browser:
            browser.open(self.page("eval.html"))
            for name in ("radius", "distance", "EquiangleSkewness"):
                browser.ask(f"vmesh.colorBy('{name}')")
                high = browser.ask("(() => { const a = vmesh.attribute; let most = 0;"
                                   "for (let i = 0; i < a.count; ++i) most = Math.max(most, a.value(i)); return most; })()")
                ends = browser.ask("['low', 'high'].map(c => Number(document.querySelector(`#legend .${c}`).textContent))")
                self.assertAlmostEqual(ends[1] / high, 1, delta=0.006)
                self.assertLess(ends[0], 0.5 * ends[1])
                boxes = browser.ask("Array.from(document.querySelectorAll('#legend .legend-ticks span'))"
                                    ".map(e => { const b = e.getBoundingClientRect(); return [b.left, b.right]; })")
                boxes.sort()
                for left, right in zip(boxes, boxes[1:]):
                    self.assertLess(left[1], right[0], "numbers do not overlap")

    def test_the_toolbar_is_beside_the_picture(self):
        for width, height, touch in ((1400, 900, False), (400, 800, True)):
            with self.subTest(width=width), Browser(width, height, touch) as browser:
                browser.open(self.page("eval.html"))
                tools, canvas = browser.ask("[document.getElementById('tools'), vmesh.scene.canvas].map(e => {"
                                            "const b = e.getBoundingClientRect(); return [b.top, b.bottom]; })")
                self.assertLessEqual(tools[1], canvas[0])
                self.assertGreater(canvas[1] - canvas[0], 0.4 * height)

    def test_cuts_off_what_is_nearest(self):
        with Browser(1400, 900) as browser:
            browser.open(self.page("eval.html"))
            whole = browser.ask(DRAWN)
            self.assertTrue(browser.ask("document.getElementById('cut-depth').hidden"), "off by default")
            front = browser.ask(FRONT)[1:]
            browser.click_on("#cut")
            depth = ("(depth => { const c = document.getElementById('cut-depth'); c.value = depth;"
                     "c.dispatchEvent(new Event('input')); })")
            shares = []
            for value in (0, 400, 700, 1000):
                browser.ask(f"{depth}({value})")
                shares.append(browser.ask(DRAWN))
            self.assertAlmostEqual(shares[0], whole, delta=0.01 * whole)
            self.assertEqual(shares, sorted(shares, reverse=True))
            self.assertLess(shares[2], 0.7 * whole)
            self.assertLess(shares[3], 1e-4)
            browser.click(*front)
            self.assertTrue(browser.ask("document.getElementById('picked').hidden"), "what is cut off cannot be picked")
            browser.press("x")
            self.assertEqual(browser.ask(DRAWN), whole)
            self.assertEqual(browser.problems, [])

    def test_the_ruler_tells_the_distance_of_two_clicks(self):
        for width, height, touch in ((1400, 900, False), (400, 800, True)):
            with self.subTest(width=width), Browser(width, height, touch) as browser:
                browser.open(self.page("eval.html"), "#place=1")
                front = browser.ask(FRONT)[0]
                # The neighbour that looks most towards the camera.
                other = browser.ask(f"""(() => {{ const c = vmesh.shown.surface.corners, towards =
                    vmesh.scene.camera.position.clone().sub(vmesh.shown.vertex({front})).normalize();
                  const near = [...c.keys()].filter(i => c[i] === {front}).flatMap(i => [0, 1, 2].map(k => c[i - i % 3 + k]));
                  const facing = v => v === {front} ? -2 : vmesh.shown.normal(v).dot(towards);
                  return near.reduce((best, v) => facing(v) > facing(best) ? v : best); }})()""")
                length = browser.ask(f"vmesh.shown.vertex({front}).distanceTo(vmesh.shown.vertex({other}))")
                browser.ask("vmesh.set('ruler', true)")
                browser.click(*browser.ask(f"{ON_SCREEN}({front})"))
                self.assertEqual(browser.ask("document.getElementById('length').textContent"), "")
                browser.click(*browser.ask(f"{ON_SCREEN}({other})"))
                told = browser.ask("document.getElementById('length').textContent")
                self.assertTrue(told.endswith(" mm"), told)
                self.assertAlmostEqual(float(told[:-3]) / length, 1, delta=0.05)
                self.assertTrue(browser.ask("document.getElementById('picked').hidden"))
                browser.press("m")
                self.assertTrue(browser.ask("document.getElementById('length').hidden"))
                self.assertEqual(browser.problems, [])

    def test_saves_what_is_shown(self):
        with Browser(700, 500) as browser:
            browser.open(self.page("eval.html"))
            for kind in ("ply", "stl", "png"):
                name, content = browser.ask(f"{SAVED}('{kind}')")
                self.assertEqual(name, f"small.{kind}")
                with open(self.page(f"saved.{kind}"), "wb") as file:
                    file.write(base64.b64decode(content))
            pictures = [browser.ask(f"{SAVED}('png')")[1]]
            for change in ("vmesh.colorBy('branch')", "vmesh.set('cut', true)", "vmesh.set('edges', true)"):
                browser.ask(change)
                pictures.append(browser.ask(f"{SAVED}('png')")[1])
            self.assertEqual(len(set(pictures)), len(pictures), "what is changed in the view changes in the picture")
            self.assertEqual(browser.problems, [])
        original = self.evaluated("small.ply")
        for name in ("saved.ply", "saved.stl"):
            saved = self.evaluated(name)
            self.assertTrue(saved["topology"]["closed"], name)
            self.assertEqual(saved["vertices"], original["vertices"], name)
            distance_mm = saved["reference"]["hausdorff_mm"]["upper"]
            self.assertLess(distance_mm, 0.01, name)
        with open(self.page("saved.png"), "rb") as file:
            head = file.read(24)
        self.assertEqual(head[1:4], b"PNG")
        self.assertGreater(int.from_bytes(head[16:20], "big"), 100)
        self.vmesh("render", "saved.ply", "-o", "values.png", "--color", "volume_distance", "--width", "64")

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
        with Browser(1100, 700) as browser:
            browser.open(self.page("moved.html"))
            legend, player = browser.ask("['legend', 'frames'].map(id => { const b = document.getElementById(id)"
                                         ".getBoundingClientRect(); return [b.left, b.right]; })")
            self.assertLess(legend[1], player[0], "the player is beside the legend")
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
