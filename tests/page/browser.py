"""Drives a headless Chromium by its DevTools protocol: opens pages from files, clicks, types, takes pictures. A program
that imports this exits with 77, loudly, where there is none."""
import base64
import json
import re
import shutil
import subprocess
import sys
import tempfile
import time

if not shutil.which("chromium"):
    print("SKIPPED: no Chromium; scripts/install-dependencies --with-browser")
    sys.exit(77)
try:
    import websocket
except ImportError:
    print("SKIPPED: no python3-websocket; scripts/install-dependencies --with-browser")
    sys.exit(77)

# Pixels of a page's scene that are not the ground's, of those that are drawn.
DRAWN = """(() => { vmesh.scene.render(); const gl = vmesh.scene.renderer.getContext();
  const [w, h] = [gl.drawingBufferWidth, gl.drawingBufferHeight]; const p = new Uint8Array(4 * w * h);
  gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, p);
  let n = 0; for (let i = 3; i < p.length; i += 4) n += p[i] > 0; return n / (w * h); })()"""

FLAGS = ["--headless=new", "--no-sandbox", "--hide-scrollbars", "--use-angle=swiftshader",
         "--enable-unsafe-swiftshader", "--disable-extensions", "--no-first-run", "--remote-debugging-port=0",
         "--remote-allow-origins=*", "--force-prefers-reduced-motion"]


class Browser:
    """One tab. `problems`: exceptions, errors of the console, and whatever the page asked the network for."""

    def __init__(self, width, height, touch=False, motion=False, dark=False):
        self.folder = tempfile.mkdtemp(prefix="vmesh-browser-")
        flags = [flag for flag in FLAGS if not (motion and "reduced-motion" in flag)]
        if dark:
            flags += ["--force-dark-mode"]
        self.process = subprocess.Popen(["chromium", *flags, f"--user-data-dir={self.folder}", "about:blank"],
                                        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        address = self._address()
        self.count = 0
        self.problems = []
        self.touch = touch
        self.socket = websocket.create_connection(address, timeout=60, suppress_origin=True)
        targets = self._call("Target.getTargets")["targetInfos"]
        page = next(target for target in targets if target["type"] == "page")["targetId"]
        self.session = None
        self.session = self._call("Target.attachToTarget", targetId=page, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self._call(f"{domain}.enable")
        self._call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=touch)
        if touch:
            self._call("Emulation.setTouchEmulationEnabled", enabled=True)
        if dark:
            self._call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "dark"}])

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.socket.close()
        self.process.terminate()
        self.process.wait()
        self.process.stderr.close()
        shutil.rmtree(self.folder, ignore_errors=True)

    def _address(self):
        for line in self.process.stderr:
            found = re.search(r"DevTools listening on (ws://\S+)", line)
            if found:
                return found.group(1)
        raise RuntimeError("Chromium did not start")

    def _call(self, method, **parameters):
        self.count += 1
        message = {"id": self.count, "method": method, "params": parameters}
        if getattr(self, "session", None):
            message["sessionId"] = self.session
        self.socket.send(json.dumps(message))
        number = self.count
        while True:
            answer = json.loads(self.socket.recv())
            self._note(answer)
            if answer.get("id") == number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return answer["result"]

    def _note(self, message):
        method, what = message.get("method"), message.get("params", {})
        if method == "Runtime.exceptionThrown":
            self.problems.append(str(what["exceptionDetails"]))
        elif method == "Runtime.consoleAPICalled" and what["type"] in ("error", "warning", "assert"):
            self.problems.append(str([argument.get("value") or argument.get("description") for argument in what["args"]]))
        elif method == "Log.entryAdded" and what["entry"]["level"] in ("error", "warning"):
            self.problems.append(what["entry"]["text"])
        elif method == "Network.requestWillBeSent" and not what["request"]["url"].startswith(
                ("file:", "data:", "about:", "blob:")):
            self.problems.append("asked for " + what["request"]["url"])

    def open(self, path, fragment=""):
        """Returns the seconds until the page is drawn."""
        begin = time.monotonic()
        self._call("Page.navigate", url="about:blank")
        self._call("Page.navigate", url=f"file://{path}{fragment}")
        while not self.ask("document.body && document.body.dataset.ready === '1'"):
            time.sleep(0.02)
        self.settle()
        return time.monotonic() - begin

    def ask(self, expression):
        """The value of a JavaScript expression."""
        answer = self._call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(str(answer["exceptionDetails"]))
        return answer["result"].get("value")

    def wait_for(self, expression, seconds=120):
        """Until a JavaScript expression holds."""
        end = time.monotonic() + seconds
        while not self.ask(expression):
            if time.monotonic() > end:
                raise RuntimeError(f"after {seconds} s still not: {expression}")
            time.sleep(0.05)

    def drop(self, x, y, *paths):
        """Files on the page, as from a file manager."""
        data = {"items": [], "files": list(paths), "dragOperationsMask": 1}
        for kind in ("dragEnter", "dragOver", "drop"):
            self._call("Input.dispatchDragEvent", type=kind, x=x, y=y, data=data)

    def download_to(self, folder):
        """What the page saves goes there."""
        self._call("Browser.setDownloadBehavior", behavior="allow", downloadPath=folder)

    def settle(self):
        """Waits until no flight is on and two frames are drawn."""
        self.ask("new Promise(done => { const wait = () => window.vmesh && vmesh.scene.flight ? "
                 "requestAnimationFrame(wait) : requestAnimationFrame(() => requestAnimationFrame(done)); wait(); })")

    def click(self, x, y):
        if self.touch:
            self._call("Input.dispatchTouchEvent", type="touchStart", touchPoints=[{"x": x, "y": y}])
            self._call("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])
            self.ask("new Promise(done => setTimeout(done, 100))")  # a tap becomes a click a little later
        else:
            for kind in ("mousePressed", "mouseReleased"):
                self._call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)
        self.settle()

    def click_on(self, selector):
        x, y = self.ask(f"(() => {{ const e = document.querySelector({json.dumps(selector)});"
                        "e.scrollIntoView({block: 'nearest'}); const b = e.getBoundingClientRect();"
                        "return [b.left + b.width / 2, b.top + b.height / 2]; })()")
        self.click(x, y)

    def drag(self, x0, y0, x1, y1):
        steps = [(x0 + (x1 - x0) * i / 5, y0 + (y1 - y0) * i / 5) for i in range(6)]
        if self.touch:
            self._call("Input.dispatchTouchEvent", type="touchStart", touchPoints=[{"x": x0, "y": y0}])
            for x, y in steps:
                self._call("Input.dispatchTouchEvent", type="touchMove", touchPoints=[{"x": x, "y": y}])
            self._call("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])
        else:
            self._call("Input.dispatchMouseEvent", type="mousePressed", x=x0, y=y0, button="left", buttons=1, clickCount=1)
            for x, y in steps:
                self._call("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y, button="left", buttons=1)
            self._call("Input.dispatchMouseEvent", type="mouseReleased", x=x1, y=y1, button="left", clickCount=1)
        self.settle()

    def press(self, key):
        for kind in ("keyDown", "keyUp"):
            self._call("Input.dispatchKeyEvent", type=kind, key=key, text=key if len(key) == 1 and kind == "keyDown" else "")
        self.settle()

    def picture(self, path):
        data = self._call("Page.captureScreenshot", format="png")["data"]
        with open(path, "wb") as file:
            file.write(base64.b64decode(data))
