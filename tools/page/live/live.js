// The page: picture, hands and sliders around a Stage.

const byId = (id) => document.getElementById(id);
const SURFACE_COLOR = 0xc9504a;
const HELD_COLOR = 0x1f6f8b;
const MOST_STEPS_A_FRAME = 4;

/** 1 MPa, 30 kPa: with the prefix that leaves one to three digits. */
function pressureText(pascal) {
  const [unit, scale] = [["GPa", 1e9], ["MPa", 1e6], ["kPa", 1e3], ["Pa", 1]].find((u) => pascal >= 0.9995 * u[1]) || ["Pa", 1];
  return `${Number((pascal / scale).toPrecision(3))} ${unit}`;
}

const forceText = (newton) => (newton < 0.9995 ? `${Number((1e3 * newton).toPrecision(2))} mN` : `${Number(newton.toPrecision(3))} N`);
const secondsText = (s) => (s < 0.9995 ? `${Number((1e3 * s).toPrecision(3))} ms` : `${Number(s.toPrecision(3))} s`);

/** White, opaque within a circle. */
function discTexture() {
  const size = 32;
  const inside = (i) => Math.hypot((i % size) - size / 2 + 0.5, Math.floor(i / size) - size / 2 + 0.5) < size / 2;
  const texture = new THREE.DataTexture(Uint8Array.from({ length: 4 * size * size },
    (_, i) => (i % 4 < 3 || inside(i >> 2) ? 255 : 0)), size, size);
  texture.needsUpdate = true;
  return texture;
}

class Live {
  constructor(data, module) {
    this.data = data;
    this.tree = { positions: numbersOf(data.node_positions, Float64Array), radii: numbersOf(data.radii, Float64Array),
      ends: numbersOf(data.ends, Uint32Array) };
    this.surface = { positions: numbersOf(data.positions, Float64Array), normals: numbersOf(data.normals, Float64Array),
      segment: numbersOf(data.place_segments, Uint32Array), t: numbersOf(data.place_parameters, Float64Array),
      corners: numbersOf(data.corners, Uint32Array) };
    this.stage = new Stage(module, this.tree, this.surface, data.settings);
    this.origin = new THREE.Vector3(...this.stage.deformer.origin);
    this.mode = "pull";
    this.hands = new Map();  // pointer: { node, plane, shift }
    this.cost = { steps: 0, milliseconds: 0, frames: [] };
    this.addPicture();
    this.addHands();
    this.addTools();
    this.addSliders();
    this.last = performance.now();
    this.backlog = 0;
    this.looking = false;
    this.go();
  }

  addPicture() {
    const { positions } = this.surface;
    const about = Float32Array.from(positions, (x, i) => x - this.origin.getComponent(i % 3));
    this.scene = new Scene(byId("picture"), boundsOf([about]));
    this.scene.canvas.setAttribute("aria-label", "The surface in 3D. Drag a vessel to pull it, drag beside it to rotate.");
    this.geometry = new THREE.BufferGeometry();
    this.geometry.setIndex(new THREE.BufferAttribute(this.surface.corners, 1));
    for (const name of ["position", "normal"])
      this.geometry.setAttribute(name, new THREE.BufferAttribute(new Float32Array(positions.length), 3).setUsage(THREE.DynamicDrawUsage));
    this.mesh = new THREE.Mesh(this.geometry,
      new THREE.MeshLambertMaterial({ color: SURFACE_COLOR, side: THREE.DoubleSide }));
    this.mesh.frustumCulled = false;  // its bounds change
    this.marks = new THREE.Points(new THREE.BufferGeometry(),
      new THREE.PointsMaterial({ color: HELD_COLOR, size: 12 * this.scene.renderer.getPixelRatio(), sizeAttenuation: false,
        depthTest: false, map: discTexture(), alphaTest: 0.5 }));
    this.marks.frustumCulled = false;
    this.marks.renderOrder = 1;
    this.scene.scene.add(this.mesh, this.marks);
    this.showSurface();
    this.scene.viewAll(new THREE.Vector3(0, -1, 0.15), true);
  }

  /** Positions as they are in WebAssembly. */
  showSurface() {
    const { deformer } = this.stage;
    deformer.follow();
    this.geometry.attributes.position.array.set(deformer.positions());
    this.geometry.attributes.normal.array.set(deformer.normals());
    this.geometry.attributes.position.needsUpdate = this.geometry.attributes.normal.needsUpdate = true;
    this.showMarks();
  }

  showMarks() {
    const { settings, held, deformer } = this.stage;
    const nodes = deformer.nodes();
    const all = [...new Set([...settings.fix, ...settings.clamp, ...held.keys()])];
    const at = new Float32Array(3 * all.length);
    all.forEach((node, k) => {
      for (let i = 0; i < 3; ++i) at[3 * k + i] = nodes[3 * node + i] - this.origin.getComponent(i);
    });
    const old = this.marks.geometry.getAttribute("position");
    if (old && old.array.length === at.length) {
      old.array.set(at);
      old.needsUpdate = true;
      return;
    }
    this.marks.geometry.dispose();  // attributes keep their length
    this.marks.geometry = new THREE.BufferGeometry();
    this.marks.geometry.setAttribute("position", new THREE.BufferAttribute(at, 3));
  }

  // Time

  /** Frames go on for as long as something moves. */
  go() {
    if (this.looking) return;
    this.looking = true;
    this.last = performance.now();
    this.backlog = 0;
    requestAnimationFrame((now) => this.frame(now));
  }

  frame(now) {
    const step_s = this.stage.settings.step_s;
    this.backlog += Math.min(0.1, Math.max(0, (now - this.last) / 1e3));
    this.last = now;
    // A quarter of a step early: frames do not come evenly.
    const due = Math.floor(this.backlog / step_s + 0.25);
    this.backlog -= due * step_s;
    let moves = due === 0;
    const begin = performance.now();
    let done = 0;
    for (; done < Math.min(due, MOST_STEPS_A_FRAME); ++done) if (!this.stage.step()) break;
    moves = moves || done > 0;
    if (done > 0) {
      this.showSurface();
      this.cost.steps += done;
      this.cost.milliseconds += performance.now() - begin;
      this.scene.render();
      this.count(now);
    }
    this.showState();
    if (moves) requestAnimationFrame((next) => this.frame(next));
    else this.looking = false;
  }

  /** Frames of the last second of motion. */
  count(now) {
    const { frames } = this.cost;
    if (frames.length > 0 && now - frames[frames.length - 1] > 500) frames.length = 0;
    frames.push(now);
    while (now - frames[0] > 1000) frames.shift();
  }

  framesPerSecond() {
    const { frames } = this.cost;
    return frames.length > 1 ? (1e3 * (frames.length - 1)) / (frames[frames.length - 1] - frames[0]) : 0;
  }

  showState() {
    const { stage } = this;
    const fps = this.framesPerSecond();
    byId("status").textContent = stage.steps === 0 ? "" :
      `${stage.playing ? "replay, " : ""}${(stage.steps * stage.settings.step_s).toFixed(1)} s, ${stage.steps} steps` +
      (fps > 0 ? `, ${Math.round(fps)} frames/s` : "") + this.forcesText();
    byId("save").disabled = stage.playing || stage.motion.holds.length === 0 || stage.steps === 0;
    byId("replay").disabled = stage.playing || stage.steps === 0;
  }

  /** Of hands and pins, the strongest ones. */
  forcesText() {
    const forces = [...this.stage.held.keys()].map((node) => this.stage.deformer.pull_N(node)).sort((a, b) => b - a);
    return forces.length === 0 ? "" : `, ${forces.slice(0, 3).map(forceText).join(", ")}`;
  }

  note(text) {
    byId("note").textContent = text;
    byId("note").hidden = false;
    clearTimeout(this.noting);
    this.noting = setTimeout(() => { byId("note").hidden = true; }, 4000);
  }

  // Hands

  ray(event) {
    const box = this.scene.canvas.getBoundingClientRect();
    const at = new THREE.Vector2(((event.clientX - box.left) / box.width) * 2 - 1, 1 - ((event.clientY - box.top) / box.height) * 2);
    const ray = new THREE.Raycaster();
    ray.setFromCamera(at, this.scene.camera);
    return ray;
  }

  /** The point of the surface under a pointer, and the node nearest to it along its segment; null: none. */
  under(event) {
    this.geometry.computeBoundingSphere();
    const hit = this.ray(event).intersectObject(this.mesh)[0];
    if (!hit) return null;
    const positions = this.geometry.attributes.position.array;
    const distance = (v) => hit.point.distanceToSquared(new THREE.Vector3().fromArray(positions, 3 * v));
    const vertex = [hit.face.a, hit.face.b, hit.face.c].sort((a, b) => distance(a) - distance(b))[0];
    return { point: hit.point, node: this.nodeAt(this.surface.segment[vertex], this.surface.t[vertex]) };
  }

  /** The nearer node of a segment that is not held from the start; isolated nodes are numbered after the segments. */
  nodeAt(segment, t) {
    const { ends, radii } = this.tree;
    if (2 * segment >= ends.length) {
      const joined = new Set(ends);
      return [...radii.keys()].filter((node) => !joined.has(node))[segment - ends.length / 2];
    }
    const [a, b] = t < 0.5 ? [ends[2 * segment], ends[2 * segment + 1]] : [ends[2 * segment + 1], ends[2 * segment]];
    return this.stage.heldFromStart(a) ? b : a;
  }

  /** Relative to the origin. */
  nodePosition(node) {
    return new THREE.Vector3().fromArray(this.stage.deformer.nodes(), 3 * node).sub(this.origin);
  }

  addHands() {
    const box = byId("picture");
    // Before the camera's controls, which then do not hear of it.
    box.addEventListener("pointerdown", (event) => this.down(event), { capture: true });
    window.addEventListener("pointermove", (event) => this.moved(event));
    for (const kind of ["pointerup", "pointercancel"]) window.addEventListener(kind, (event) => this.up(event));
    box.addEventListener("pointermove", (event) => this.hover(event));
  }

  down(event) {
    if (event.button !== 0 || event.target !== this.scene.canvas || this.stage.playing) return;
    const found = this.under(event);
    if (!found) return;
    event.stopPropagation();
    this.scene.stopFlight();
    if (this.stage.heldFromStart(found.node)) this.note(`Node ${found.node} is held from the start.`);
    else if (this.mode === "pin") this.pin(found.node);
    else if (![...this.hands.values()].some((hand) => hand.node === found.node)) this.pull(event, found);
    this.go();
  }

  pin(node) {
    const { held } = this.stage;
    if (held.has(node)) this.stage.release(node);
    else this.stage.grab(node).pinned = true;
    this.showMarks();
    this.scene.draw();
  }

  pull(event, { point, node }) {
    const normal = this.scene.camera.getWorldDirection(new THREE.Vector3());
    this.hands.set(event.pointerId, { node, plane: new THREE.Plane().setFromNormalAndCoplanarPoint(normal, point),
      shift: this.nodePosition(node).sub(point) });
    this.stage.grab(node);
    this.scene.canvas.classList.add("pulling");
  }

  moved(event) {
    const hand = this.hands.get(event.pointerId);
    if (!hand) return;
    const at = this.ray(event).ray.intersectPlane(hand.plane, new THREE.Vector3());
    if (!at) return;
    const target = at.add(hand.shift).add(this.origin).toArray();
    this.stage.move(hand.node, this.stage.restOf(hand.node).map((x, i) => target[i] - x));
    this.go();
  }

  up(event) {
    const hand = this.hands.get(event.pointerId);
    if (!hand) return;
    this.hands.delete(event.pointerId);
    if (this.hands.size === 0) this.scene.canvas.classList.remove("pulling");
    const held = this.stage.held.get(hand.node);
    if (held && !held.pinned) this.stage.release(hand.node);
    this.go();
  }

  /** What the mouse would do, looked at once a frame. */
  hover(event) {
    if (event.pointerType !== "mouse" || event.buttons !== 0 || this.hovering) return;
    this.hovering = true;
    requestAnimationFrame(() => {
      this.hovering = false;
      this.scene.canvas.classList.toggle("pulls", this.under(event) !== null);
    });
  }

  // Buttons, keys, sliders

  letGo() {
    this.hands.clear();
    this.scene.canvas.classList.remove("pulling");
  }

  rest() {
    this.letGo();
    this.stage.forget();
    this.refresh();
  }

  replay() {
    this.letGo();
    this.stage.replay();
    this.refresh();
  }

  refresh() {
    this.showSurface();
    this.scene.draw();
    this.showState();
    this.go();
  }

  setMode(mode) {
    this.mode = mode;
    for (const name of ["pull", "pin"]) byId(name).setAttribute("aria-pressed", String(name === mode));
  }

  save() {
    const text = `${JSON.stringify(this.stage.scene())}\n`;
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([text], { type: "application/json" }));
    link.download = "scene.json";
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  }

  addTools() {
    const acts = { pull: () => this.setMode("pull"), pin: () => this.setMode("pin"), rest: () => this.rest(),
      replay: () => this.replay(), save: () => this.save(),
      all: () => this.scene.viewAll(new THREE.Vector3(0, -1, 0.15), false) };
    for (const [id, act] of Object.entries(acts)) byId(id).addEventListener("click", act);
    const keys = { v: "pull", p: "pin", 0: "rest", r: "replay", s: "save", home: "all" };
    document.addEventListener("keydown", (event) => {
      const id = keys[event.key.toLowerCase()];
      if (!id || event.ctrlKey || event.metaKey || event.altKey || event.target.tagName === "INPUT") return;
      byId(id).click();
      event.preventDefault();
    });
  }

  addSliders() {
    const { settings } = this.stage;
    const strength = Math.hypot(...settings.gravity_m_s2);
    const down = strength > 0 ? settings.gravity_m_s2.map((g) => g / strength) : [0, 0, -1];
    const sliders = {
      young: { value: Math.log10(settings.material.young_Pa), text: (x) => pressureText(10 ** x),
        change: (x) => { settings.material.young_Pa = Number((10 ** x).toPrecision(3)); } },
      damping: { value: Math.log10(Math.max(1e-4, settings.material.damping_s)), text: (x) => secondsText(10 ** x),
        change: (x) => { settings.material.damping_s = Number((10 ** x).toPrecision(3)); } },
      gravity: { value: strength, text: (x) => `${x.toFixed(1)} m/s²`,
        change: (x) => { settings.gravity_m_s2 = down.map((d) => (d === 0 ? 0 : d * x)); } },
    };
    for (const [id, { value, text, change }] of Object.entries(sliders)) {
      const slider = byId(id);
      const show = (x) => { byId(`${id}-text`).textContent = text(x); };
      slider.value = String(value);  // which has steps and ends
      show(value);
      slider.addEventListener("input", () => show(Number(slider.value)));
      slider.addEventListener("change", () => {
        change(Number(slider.value));
        this.letGo();
        this.stage.change();
        this.refresh();
      });
    }
  }
}

function fillPanel(data) {
  byId("title").textContent = data.title;
  byId("generator").textContent = data.generator;
  byId("command").textContent = data.command;
  for (const [name, value] of Object.entries(data.facts)) {
    const fact = document.createElement("div");
    fact.append(Object.assign(document.createElement("dt"), { textContent: name }),
      Object.assign(document.createElement("dd"), { textContent: value.toLocaleString("en") }));
    byId("facts").append(fact);
  }
}

async function start() {
  const data = JSON.parse(byId("page-data").textContent);
  fillPanel(data);
  try {
    window.vmesh = new Live(data, await createDeformer());
    window.vmesh.firstPicture_ms = performance.now();
  } catch (error) {
    console.error(error);
    byId("no-picture").textContent = `This browser cannot show it: ${error.message}. It takes WebGL, and WebAssembly with ` +
      "vectors and exceptions (Chrome 95, Firefox 100, Safari 16.4 and later).";
    byId("no-picture").hidden = false;
    document.body.classList.add("without-picture");
  }
  document.body.dataset.ready = "1";
}

start();
