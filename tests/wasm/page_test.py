"""The page that makes surfaces, in a headless Chromium: page_test.py PAGE VMESH. Exits with 77, loudly, without one."""
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import time
import unittest

sys.dont_write_bytecode = True  # next to the sources
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "page"))
from browser import DRAWN, Browser

PAGE, VMESH = map(os.path.abspath, sys.argv[1:3])
PROJECT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
TREE = os.path.join(PROJECT, "examples", "small_tree.swc")
PICTURES = os.environ.get("VMESH_TEST_PICTURES")
MADE = "document.body.dataset.made === '1'"


def counts_in_ply(path):
    with open(path, "rb") as file:
        header = file.read().split(b"end_header\n")[0].decode()
    words = [line.split() for line in header.split("\n") if line.startswith("element")]
    return {word[1]: int(word[2]) for word in words}


class MakingPage(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="vmesh-page-")
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def open(self, width=1280, height=800, touch=False):
        browser = Browser(width, height, touch=touch)
        self.addCleanup(browser.__exit__)
        browser.download_to(self.folder)
        browser.open(PAGE)
        browser.wait_for("document.body.dataset.maker === 'ready'")
        return browser

    def picture(self, browser, name):
        if PICTURES:
            browser.settle()
            browser.picture(os.path.join(PICTURES, name + ".png"))

    def move(self, browser, slider, value):
        browser.ask(f"(() => {{ const s = document.getElementById('{slider}'); s.value = '{value}';"
                    "s.dispatchEvent(new Event('input')); s.dispatchEvent(new Event('change')); })()")

    def downloaded(self, browser, extension):
        browser.click_on(f"[data-save={extension}]")
        end = time.monotonic() + 30
        while time.monotonic() < end:
            for name in os.listdir(self.folder):
                if name.endswith("." + extension) and os.path.getsize(os.path.join(self.folder, name)) > 0:
                    return os.path.join(self.folder, name)
            time.sleep(0.1)
        self.fail(f"no .{extension} was downloaded")

    def vertices(self, browser):
        return browser.ask("vmesh.shown.surface.vertices")

    def test_a_large_centerline_is_dropped_seen_and_downloaded(self):
        tree = os.path.join(self.folder, "tree3500.swc")
        subprocess.run([VMESH, "synth", "-o", tree, "--vertices", "3500"], check=True, stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL)
        with open(tree, encoding="ascii") as file:
            self.assertGreaterEqual(sum(not line.startswith("#") for line in file), 3500)
        browser = self.open()
        self.picture(browser, "page-empty")
        begin = time.monotonic()
        browser.drop(400, 400, tree)
        browser.wait_for("document.getElementById('progress').value > 0")
        browser.wait_for(MADE, 300)
        print(f"3,500 nodes dropped and seen after {time.monotonic() - begin:.1f} s", file=sys.stderr)
        self.picture(browser, "page-large")
        self.assertGreater(browser.ask(DRAWN), 0.03)
        self.assertGreater(browser.ask("document.querySelectorAll('#places button').length"), 3)
        self.assertEqual(browser.ask("document.querySelector('#facts dd').textContent"), "yes")
        counts = counts_in_ply(self.downloaded(browser, "ply"))
        self.assertEqual(counts["vertex"], self.vertices(browser))
        with open(self.downloaded(browser, "stl"), "rb") as file:
            self.assertEqual(struct.unpack_from("<I", file.read(), 80)[0], counts["face"])
        with open(self.downloaded(browser, "glb"), "rb") as file:
            self.assertEqual(file.read(4), b"glTF")
        self.assertEqual(browser.problems, [])

    def test_sliders_make_it_again_and_the_view_stays(self):
        browser = self.open()
        browser.click_on("#example")
        browser.wait_for(MADE)
        self.picture(browser, "page-example")
        few = self.vertices(browser)
        browser.press("e")
        browser.drag(300, 400, 380, 420)
        camera = "vmesh.scene.camera.position.toArray()"
        before = browser.ask(camera)
        self.move(browser, "around", 12)
        browser.wait_for(f"{MADE} && vmesh.shown.surface.vertices !== {few}")
        self.assertGreater(self.vertices(browser), 2 * few)
        self.assertEqual(browser.ask("document.getElementById('edges').getAttribute('aria-pressed')"), "true")
        # Both are shown about a corner of their boxes, which is all that differs.
        self.assertLess(max(abs(a - b) for a, b in zip(before, browser.ask(camera))), 1)
        self.assertIn("--around 12", browser.ask("document.getElementById('command').textContent"))
        self.move(browser, "max-error", 3)
        browser.wait_for(f"{MADE} && document.getElementById('command').textContent.includes('--max-error 5%')")
        self.assertEqual(browser.problems, [])

    def test_what_is_being_made_can_be_cancelled(self):
        browser = self.open()
        browser.click_on("#example")
        browser.wait_for(MADE)
        self.move(browser, "around", 24)
        browser.ask("document.getElementById('cancel').click()")
        browser.wait_for("document.getElementById('working').hidden")
        self.assertIn("Cancelled", browser.ask("document.getElementById('outcome').textContent"))
        self.move(browser, "around", 5)
        browser.wait_for(MADE)
        self.assertEqual(browser.ask("document.getElementById('failure').hidden"), True)
        self.assertEqual(browser.problems, [])

    def test_what_is_wrong_with_a_file_is_said(self):
        bad = os.path.join(self.folder, "bad.swc")
        with open(bad, "w", encoding="ascii") as file:
            file.write("1 1 0 0 zero 1 -1\n")
        browser = self.open()
        browser.drop(400, 400, bad)
        browser.wait_for("!document.getElementById('failure').hidden")
        self.assertRegex(browser.ask("document.getElementById('failure').textContent"), "bad.swc.*line 1")
        browser.drop(400, 400, TREE)
        browser.wait_for(MADE)
        self.assertEqual(browser.problems, [])

    def test_it_fits_a_phone(self):
        browser = self.open(390, 844, touch=True)
        self.picture(browser, "phone-empty")
        browser.click_on("#example")
        browser.wait_for(MADE)
        self.picture(browser, "phone-example")
        self.assertLessEqual(browser.ask("document.documentElement.scrollWidth"), 390)
        self.assertGreater(browser.ask(DRAWN), 0.03)
        small = "[...document.querySelectorAll('#make button, #choose span')].filter(e => e.getClientRects().length)" \
                ".filter(e => e.getBoundingClientRect().height < 44).length"
        self.assertEqual(browser.ask(small), 0)
        browser.click_on("[data-save=ply]")
        self.assertGreater(counts_in_ply(self.downloaded(browser, "ply"))["vertex"], 0)
        self.assertEqual(browser.problems, [])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
