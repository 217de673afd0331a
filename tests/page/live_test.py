"""Pulls vessels in a page of `vmesh deform --live`, in a headless Chromium, by pointer events: live_test.py VMESH. Exits
with 77, loudly, where there is none. VMESH_TEST_PICTURES: a folder for pictures of it."""
import json
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import time
import unittest

sys.dont_write_bytecode = True  # next to the sources
from browser import DRAWN, Browser

VMESH = os.path.abspath(sys.argv[1])
PICTURES = os.environ.get("VMESH_TEST_PICTURES")
# Where a leaf far from what is held is on the screen, if it is what a pointer there meets: [node, x, y].
LEAF = """(() => { const { tree, scene } = vmesh, degree = new Map(), box = scene.canvas.getBoundingClientRect();
  for (const n of tree.ends) degree.set(n, (degree.get(n) || 0) + 1);
  const root = vmesh.nodePosition(vmesh.stage.settings.clamp[0]);
  const leaves = [...degree.keys()].filter(n => degree.get(n) === 1)
    .sort((a, b) => vmesh.nodePosition(b).distanceTo(root) - vmesh.nodePosition(a).distanceTo(root));
  for (const n of leaves) { const p = scene.onScreen(vmesh.nodePosition(n));
    const [x, y] = [Math.round(p.x + box.left), Math.round(p.y + box.top)];
    const found = vmesh.under({ clientX: x, clientY: y }); if (found && found.node === n) return [n, x, y]; }
  return null; })()"""
NODE = "(n => { const p = vmesh.scene.onScreen(vmesh.nodePosition(n)), b = vmesh.scene.canvas.getBoundingClientRect();" \
       "return [p.x + b.left, p.y + b.top]; })"
POSITIONS = "(() => { const o = vmesh.stage.deformer.origin; vmesh.stage.deformer.follow();" \
            "return Array.from(vmesh.stage.deformer.positions(), (x, i) => x + o[i % 3]); })()"
# Where a segment between nodes without branches is on the screen, long enough to be cut, if it is what a pointer there
# meets: [segment, x, y].
BRANCH = """(() => { const { tree, scene } = vmesh, degree = new Map(), box = scene.canvas.getBoundingClientRect();
  for (const n of tree.ends) degree.set(n, (degree.get(n) || 0) + 1);
  const all = [...Array(tree.ends.length / 2).keys()].map(s => [s, tree.ends[2 * s], tree.ends[2 * s + 1]])
    .filter(([s, a, b]) => degree.get(a) === 2 && degree.get(b) === 2)
    .map(([s, a, b]) => [s, vmesh.nodePosition(a), vmesh.nodePosition(b)])
    .sort((u, v) => v[1].distanceTo(v[2]) - u[1].distanceTo(u[2]));
  for (const [s, a, b] of all) { const p = scene.onScreen(a.lerp(b, 0.5));
    const [x, y] = [Math.round(p.x + box.left), Math.round(p.y + box.top)];
    const found = vmesh.under({ clientX: x, clientY: y });
    if (found && found.segment === s && Math.abs(found.t - 0.5) < 0.2) return [s, x, y]; }
  return null; })()"""
# Beside a leaf, nearer to it on the screen than to anything else: [node, x, y, dx, dy], with the way across the leaf.
BESIDE = """(() => { const { tree, scene } = vmesh, degree = new Map(), box = scene.canvas.getBoundingClientRect();
  for (const n of tree.ends) degree.set(n, (degree.get(n) || 0) + 1);
  const screen = n => { const p = scene.onScreen(vmesh.nodePosition(n)); return [p.x + box.left, p.y + box.top]; };
  const all = [...degree.keys()].map(n => [n, ...screen(n)]), far = 16;
  for (const [n, x, y] of all.filter(([n]) => degree.get(n) === 1))
    for (let k = 0; k < 8; ++k) {
      const dx = -far * Math.cos(k * Math.PI / 4), dy = -far * Math.sin(k * Math.PI / 4);
      const others = all.filter(([m]) => m !== n).map(([m, u, v]) => Math.hypot(x - dx - u, y - dy - v));
      if (Math.min(...others) > 1.05 * far && !vmesh.under({ clientX: x - dx, clientY: y - dy })) return [n, x - dx, y - dy, dx, dy];
    }
  return null; })()"""
# After so many steps, or when everything is at rest.
STEPS = """(count => new Promise(done => {
  const stage = vmesh.stage, from = stage.steps, end = performance.now() + 45000;
  const look = () => stage.steps >= from + count || !stage.awake || performance.now() > end ? done(stage.steps - from)
                                                                                         : setTimeout(look, 5);
  look();
}))"""
# Whether two boxes on the screen have points in common.
MEET = """((a, b) => { const [p, q] = [a, b].map(e => document.querySelector(e).getBoundingClientRect());
  return p.width > 0 && q.width > 0 && p.left < q.right && q.left < p.right && p.top < q.bottom && q.top < p.bottom; })"""
CAMERA = "vmesh.scene.camera.position.toArray()"


def positions_in(path):
    """Of a binary PLY; its vertices begin with three doubles."""
    with open(path, "rb") as file:
        header, body = file.read().split(b"end_header\n", 1)
    lines = [line.split() for line in header.decode().split("\n")]
    count = next(int(words[2]) for words in lines if words[:2] == ["element", "vertex"])
    sizes = {"double": 8, "int": 4, "uchar": 1}
    before_faces = lines[:next(i for i, words in enumerate(lines) if words[:2] == ["element", "face"])]
    stride = sum(sizes[words[1]] for words in before_faces if words and words[0] == "property")
    return [x for v in range(count) for x in struct.unpack_from("<3d", body, v * stride)]

# However slow the machine is: the page has seen what the hand did, and goes on for a while.
A_FEW_STEPS = """new Promise(done => {
  const from = vmesh.cost.steps, end = performance.now() + 20000;
  const look = () => vmesh.cost.steps >= from + 10 || performance.now() > end ? setTimeout(done, 400)
                                                                              : setTimeout(look, 20);
  look();
})"""


class Hand:
    """One pointer, mouse or finger."""

    def __init__(self, browser):
        self.browser = browser

    def send(self, kind, x, y):
        if self.browser.touch:
            name = {"down": "touchStart", "move": "touchMove", "up": "touchEnd"}[kind]
            points = [] if kind == "up" else [{"x": x, "y": y}]
            self.browser._call("Input.dispatchTouchEvent", type=name, touchPoints=points)
        else:
            name = {"down": "mousePressed", "move": "mouseMoved", "up": "mouseReleased"}[kind]
            self.browser._call("Input.dispatchMouseEvent", type=name, x=x, y=y, button="left",
                               buttons=0 if kind == "up" else 1, clickCount=1)

    def draw(self, points, steps=4):
        """Down at the first point, along all others, and still down; some steps between events."""
        for i, (x, y) in enumerate(points):
            self.send("move" if i else "down", x, y)
            self.browser.ask(f"{STEPS}({steps})")

    def pull(self, x, y, dx, dy, seconds=1.0, events=20):
        """Down, there in even steps, and still down."""
        self.send("down", x, y)
        for i in range(1, events + 1):
            self.send("move", x + dx * i / events, y + dy * i / events)
            time.sleep(seconds / events)


class PageThatMoves(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix="vmesh-live-")
        cls.vmesh("synth", "--vertices", "1560", "--seed", "1", "-o", "tree.json")
        cls.vmesh("generate", "tree.json", "-o", "tree.ply", "--around", "4")  # 12,531 vertices
        cls.vmesh("deform", "tree.json", "tree.ply", "--live", "live.html")

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    @classmethod
    def vmesh(cls, *arguments):
        subprocess.run([VMESH, *arguments, "-q"], cwd=cls.folder, check=True, stdout=subprocess.DEVNULL)

    def open(self, width=1280, height=800, touch=False):
        browser = Browser(width, height, touch=touch)
        self.addCleanup(browser.__exit__)
        self.addCleanup(lambda: self.assertEqual(browser.problems, []))
        browser.download_to(self.folder)
        self.seconds = browser.open(os.path.join(self.folder, "live.html"))
        self.assertTrue(browser.ask("vmesh instanceof Live"))
        return browser

    def picture(self, browser, name):
        if PICTURES:
            browser.picture(os.path.join(PICTURES, name + ".png"))

    def saved(self, browser):
        """The scene that the button saves."""
        path = os.path.join(self.folder, "scene.json")
        if os.path.exists(path):
            os.remove(path)
        browser.click_on("#save")
        end = time.monotonic() + 20
        while not (os.path.exists(path) and os.path.getsize(path) > 0):
            self.assertLess(time.monotonic(), end, "nothing was saved")
            time.sleep(0.05)
        return path

    def played(self):
        """Where the command ends when it plays the scene."""
        frames = os.path.join(self.folder, "frames")
        shutil.rmtree(frames, ignore_errors=True)
        self.vmesh("deform", "tree.json", "tree.ply", "--script", "scene.json", "-o", "frames", "--format", "ply")
        return positions_in(os.path.join(frames, sorted(f for f in os.listdir(frames) if f.endswith(".ply"))[-1]))

    def stop(self, browser):
        """No step is taken after this."""
        browser.ask("(() => { const stage = vmesh.stage; stage.step = () => false; })()")

    def test_a_vessel_follows_the_pointer_and_the_command_plays_what_was_done(self):
        browser = self.open()
        self.assertGreater(browser.ask(DRAWN), 0.02)
        self.picture(browser, "live-rest")
        camera = browser.ask(CAMERA)
        node, x, y = browser.ask(LEAF)
        hand = Hand(browser)
        hand.pull(x, y, -120, -60, seconds=2)
        browser.settle()
        self.picture(browser, "live-pulled")
        at = browser.ask(f"{NODE}({node})")
        self.assertLess(abs(at[0] - (x - 120)) + abs(at[1] - (y - 60)), 4, "the node is where the pointer is")
        self.assertEqual(browser.ask(CAMERA), camera)
        self.assertGreater(browser.ask(f"vmesh.stage.deformer.pull_N({node})"), 1e-6)
        self.assertRegex(browser.ask("document.getElementById('status').textContent"), r"steps.* [mµ]?N$")
        cost = browser.ask("[vmesh.cost.milliseconds / vmesh.cost.steps, vmesh.framesPerSecond(), vmesh.cost.steps]")
        print(f"first picture {browser.ask('contents.firstPicture_ms') / 1e3:.2f} s, {self.seconds:.2f} s with the browser's "
              f"work; {cost[0]:.2f} ms a step with the surface, {cost[1]:.0f} frames/s")
        hand.send("up", x - 120, y - 60)
        browser.ask(A_FEW_STEPS)
        scene = self.is_played(browser)
        self.assertEqual([drag["node"] for drag in scene["drag"]], [node])
        self.assertIn("release_s", scene["drag"][0])

    def is_played(self, browser):
        """The command plays the scene that the page saves to the page's positions. Returns the scene."""
        self.stop(browser)
        shown = browser.ask(POSITIONS)
        with open(self.saved(browser), encoding="utf-8") as file:
            scene = json.load(file)
        played = self.played()
        self.assertEqual(len(played), len(shown))
        rest = positions_in(os.path.join(self.folder, "tree.ply"))
        self.assertGreater(max(abs(a - b) for a, b in zip(shown, rest)), 1e-3)
        least_radius = browser.ask("Math.min(...vmesh.tree.radii)")
        farthest = max(abs(a - b) for a, b in zip(shown, played))
        print(f"farthest from the command's: {farthest / least_radius:.2g} of the least radius")
        self.assertLess(farthest, 1e-6 * least_radius)
        return scene

    def press_beside(self, browser, hand):
        """Puts an instrument down beside a leaf, and goes across the leaf with it."""
        node, x, y, dx, dy = browser.ask(BESIDE)
        browser.click_on("#push")
        hand.draw([(x + i * dx / 5, y + i * dy / 5) for i in range(9)])
        return node

    def test_an_instrument_pushes_what_the_pointer_meets(self):
        browser = self.open()
        hand = Hand(browser)
        camera = browser.ask(CAMERA)
        self.press_beside(browser, hand)
        self.assertEqual(browser.ask(CAMERA), camera)
        self.assertGreater(browser.ask("Math.max(...vmesh.stage.acting().map(hand => hand.newton))"), 0)
        self.assertRegex(browser.ask("document.querySelector('.force:not([hidden])').textContent"), r"^[1-9].* [mµ]?N$")
        self.picture(browser, "live-push")
        hand.send("up", 0, 0)
        browser.ask(f"{STEPS}(5)")
        self.assertEqual(browser.ask("vmesh.stage.acting().length"), 0)
        scene = self.is_played(browser)
        self.assertEqual(len(scene["instruments"]), 1)
        self.assertGreater(scene["instruments"][0]["leave_s"], scene["instruments"][0]["enter_s"])

    def test_pressed_on_a_vessel_a_rod_comes_from_the_viewer(self):
        browser = self.open()
        browser.click_on("#rod")
        browser.click_on("#push")
        node, x, y = browser.ask(LEAF)
        hand = Hand(browser)
        hand.draw([(x, y)], steps=20)
        self.picture(browser, "live-rod")
        self.assertGreater(browser.ask("Math.max(...vmesh.stage.acting().map(hand => hand.newton))"), 0)
        hand.send("up", x, y)
        browser.ask(f"{STEPS}(5)")
        self.assertEqual(len(self.is_played(browser)["instruments"][0]["points_mm"]), 2)

    def test_jaws_hold_any_place(self):
        browser = self.open()
        segment, x, y = browser.ask(BRANCH)
        browser.click_on("#grasp")
        hand = Hand(browser)
        hand.draw([(x + 3 * i, y - 3 * i) for i in range(8)])
        self.picture(browser, "live-grasp")
        self.assertRegex(browser.ask("document.querySelector('.force:not([hidden])').textContent"), r"^[1-9].* [mµ]?N$")
        hand.send("up", x, y)
        browser.ask(f"{STEPS}(5)")
        grasp, = self.is_played(browser)["grasp"]
        self.assertEqual(grasp["segment"], segment)
        self.assertLess(abs(grasp["parameter"] - 0.5), 0.2)

    def test_a_vessel_that_is_clicked_is_cut(self):
        browser = self.open()
        segment, x, y = browser.ask(BRANCH)
        vertices = browser.ask("vmesh.stage.deformer.vertexCount")
        browser.click_on("#cut")
        browser.click(x, y)
        self.assertEqual(browser.ask("vmesh.stage.motion.cuts.length"), 1,
                         browser.ask("document.getElementById('note').textContent"))
        self.assertGreater(browser.ask("vmesh.stage.deformer.vertexCount"), vertices)
        # One part is pulled off by its new end.
        browser.click_on("#pull")
        hand = Hand(browser)
        hand.draw([(x + 6 * i, y - 4 * i) for i in range(12)])
        self.picture(browser, "live-cut")
        hand.send("up", x, y)
        browser.ask(f"{STEPS}(5)")
        cut, = self.is_played(browser)["cut"]
        self.assertEqual(cut["segment"], segment)
        browser.ask("(() => { delete vmesh.stage.step; })()")
        browser.click_on("#rest")
        self.assertEqual(browser.ask("vmesh.stage.deformer.vertexCount"), vertices)
        # Where a vessel ends it cannot be cut, which a note tells.
        browser.click_on("#cut")
        node, x, y = browser.ask(LEAF)
        browser.click(x, y)
        self.assertFalse(browser.ask("document.getElementById('note').hidden"))
        self.assertEqual(browser.ask("vmesh.stage.motion.cuts.length"), 0)
        self.picture(browser, "live-cannot-cut")

    def test_tissue_holds_and_tears(self):
        browser = self.open()
        node, x, y = browser.ask(LEAF)
        for slider, value in ("tissue", -3), ("tear", -3.5):
            browser.ask(f"(() => {{ const s = document.getElementById('{slider}'); s.value = {value};"
                        "s.dispatchEvent(new Event('input')); s.dispatchEvent(new Event('change')); })()")
        hand = Hand(browser)
        hand.draw([(x - 10 * i, y - 5 * i) for i in range(12)])
        self.picture(browser, "live-tissue")
        self.assertGreater(browser.ask("vmesh.stage.deformer.torn()"), 0)
        self.assertIn("tissue torn at", browser.ask("document.getElementById('status').textContent"))
        hand.send("up", x, y)
        browser.ask(f"{STEPS}(5)")
        scene = self.is_played(browser)
        self.assertEqual(scene["tissue"], [{"stiffness_N_mm2": 1e-3, "tear_N_mm": 3.16e-4}])

    def test_it_is_drawn_coarser_while_it_moves_where_frames_take_long(self):
        browser = self.open()
        ratio = "vmesh.scene.renderer.getPixelRatio()"
        node, x, y = browser.ask(LEAF)
        fine = browser.ask(ratio)
        browser.ask("(() => { vmesh.framesPerSecond = () => 60; })()")
        hand = Hand(browser)
        hand.draw([(x - i, y) for i in range(10)])
        self.assertEqual(browser.ask(ratio), fine)
        browser.ask("(() => { vmesh.framesPerSecond = () => 5; })()")
        hand.draw([(x - 10 - i, y) for i in range(10)])
        self.assertLess(browser.ask(ratio), fine)
        self.picture(browser, "live-coarse")
        hand.send("up", x, y)
        browser.wait_for("!vmesh.looking")
        self.assertEqual(browser.ask(ratio), fine)

    def test_the_first_picture_is_that_of_webgl(self):
        browser = self.open()
        covered, differ, shade = browser.ask("""(() => { vmesh.scene.render();
          const gl = vmesh.scene.renderer.getContext(), [w, h] = [gl.drawingBufferWidth, gl.drawingBufferHeight];
          const there = new Uint8Array(4 * w * h); gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, there);
          const here = posterPixels(vmesh.surface, w, h);
          let covered = 0, differ = 0, shade = 0;
          for (let y = 0; y < h; ++y) for (let x = 0; x < w; ++x) {
            const i = 4 * (y * w + x), j = 4 * ((h - 1 - y) * w + x), a = here[i + 3] > 0, b = there[j + 3] > 127;
            covered += a && b; differ += a !== b;
            if (a && b) for (let k = 0; k < 3; ++k) shade += Math.abs(here[i + k] - there[j + k]) / 3;
          }
          return [covered, differ, shade / covered]; })()""")
        print(f"first picture: {covered} pixels, {differ} others, shades differ by {shade:.1f} of 255 in the mean")
        self.assertGreater(covered, 5000)
        # Antialiased edges and the disc of what is held; shades between vertices, of which there are four around a
        # vessel, instead of normals.
        self.assertLess(differ, 0.04 * covered)
        self.assertLess(shade, 12)
        self.assertIsNone(browser.ask("document.getElementById('poster')"))

    def test_replay_ends_where_the_motion_did(self):
        browser = self.open()
        node, x, y = browser.ask(LEAF)
        hand = Hand(browser)
        hand.pull(x, y, 60, 80, seconds=0.5)
        hand.send("up", x + 60, y + 80)
        browser.ask("(() => { const s = vmesh.stage, step = s.step; s.step = () => step.call(s) &&"
                    "  (s.playing || (s.step = () => false, true)); })()")
        browser.settle()
        steps, shown = browser.ask("vmesh.stage.steps"), browser.ask(POSITIONS)
        browser.ask("(() => { delete vmesh.stage.step; const s = vmesh.stage, step = s.step;"
                    "  s.step = () => (s.playing ? step.call(s) : false); })()")
        browser.click_on("#replay")
        browser.wait_for(f"vmesh.stage.steps === {steps} && !vmesh.stage.playing")
        self.assertEqual(browser.ask(POSITIONS), shown)

    def test_pins_hold_and_rest_forgets(self):
        browser = self.open()
        node, x, y = browser.ask(LEAF)
        browser.click_on("#pin")
        browser.click(x, y)
        self.assertTrue(browser.ask(f"vmesh.stage.held.get({node}).pinned"))
        at = browser.ask(f"vmesh.nodePosition({node}).toArray()")
        browser.ask("(() => { const s = document.getElementById('gravity'); s.value = 9.8;"
                    "s.dispatchEvent(new Event('input')); s.dispatchEvent(new Event('change')); })()")
        browser.wait_for("vmesh.stage.steps > 40 && !vmesh.stage.playing")
        self.picture(browser, "live-pinned")
        held = browser.ask(f"vmesh.nodePosition({node}).toArray()")
        self.assertLess(max(abs(a - b) for a, b in zip(at, held)), 1e-5, "the pinned node does not fall")
        self.assertGreater(browser.ask("vmesh.stage.deformer.elastic_J()"), 0)
        browser.click_on("#rest")
        self.assertEqual(browser.ask("[vmesh.stage.motion.holds.length, vmesh.stage.held.size]"), [0, 0])

    def test_beside_a_vessel_the_picture_rotates(self):
        browser = self.open()
        before = browser.ask(CAMERA)
        box = browser.ask("(() => { const b = vmesh.scene.canvas.getBoundingClientRect(); return [b.left, b.top]; })()")
        browser.drag(box[0] + 8, box[1] + 60, box[0] + 120, box[1] + 70)
        self.assertNotEqual(browser.ask(CAMERA), before)
        self.assertEqual(browser.ask("vmesh.stage.motion.holds.length"), 0)

    def test_a_finger_pulls_on_a_phone(self):
        browser = self.open(390, 844, touch=True)
        self.picture(browser, "live-phone-rest")
        self.assertFalse(browser.ask(f"{MEET}('#picture', '#status')"))
        node, x, y = browser.ask(LEAF)
        hand = Hand(browser)
        hand.pull(x, y, 40, 30)
        browser.settle()
        self.picture(browser, "live-phone")
        self.assertGreater(browser.ask("document.getElementById('status').textContent.length"), 0)
        self.assertFalse(browser.ask(f"{MEET}('#picture', '#status')"), "the status does not cover the tree")
        at = browser.ask(f"{NODE}({node})")
        self.assertLess(abs(at[0] - (x + 40)) + abs(at[1] - (y + 30)), 4)
        hand.send("up", 0, 0)
        browser.settle()
        self.assertEqual(browser.ask("vmesh.stage.held.size"), 0)
        self.assertLessEqual(browser.ask("document.documentElement.scrollWidth"), 390)

    def test_a_finger_pushes_grasps_and_cuts_on_a_phone(self):
        browser = self.open(390, 844, touch=True)
        hand = Hand(browser)
        self.press_beside(browser, hand)
        self.picture(browser, "live-phone-push")
        self.assertEqual(browser.ask("vmesh.stage.probes.size"), 1)
        hand.send("up", 0, 0)
        browser.click_on("#rest")
        segment, x, y = browser.ask(BRANCH)
        browser.click_on("#grasp")
        hand.draw([(x + 4 * i, y) for i in range(8)])
        self.picture(browser, "live-phone-grasp")
        self.assertEqual(browser.ask("vmesh.stage.jaws.size"), 1)
        hand.send("up", 0, 0)
        browser.click_on("#rest")
        browser.click_on("#cut")
        browser.click(x, y)
        self.picture(browser, "live-phone-cut")
        self.assertEqual(browser.ask("vmesh.stage.motion.cuts.length"), 1)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
