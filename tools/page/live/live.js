// The page: picture, hands and sliders around a Stage.

const SURFACE_COLOR = 0xc9504a;
const HELD_COLOR = 0x1f6f8b;
const PROBE_COLOR = 0x5f6b76;
const MODES = ["pull", "grasp", "push", "cut", "pin"];
const MOST_STEPS_A_FRAME = 4;
const MOST_LABELS = 6;
// With fewer frames a second than this, of a few, it is drawn with fewer pixels as long as it moves.
const FEW_FRAMES = 25, FRAMES_LOOKED_AT = 6, COARSE = 0.5;
// Of an instrument, in its radii: how far it goes in a step, how long a rod is, and how far beside a vessel on the screen
// it may be put down.
const PROBE_REACH = 0.5, ROD_LENGTH = 10, PROBE_BESIDE = 3;
const LEAST_BESIDE_PX = 60;

/** With the prefix that leaves one to three digits before the point, and so many digits in all. */
function withPrefix(value, unit, digits, prefixes) {
  const [prefix, scale] = prefixes.find((p) => value >= 0.9995 * p[1]) || prefixes[prefixes.length - 1];
  return `${Number((value / scale).toPrecision(digits))} ${prefix}${unit}`;
}

const pressureText = (pascal) => withPrefix(pascal, "Pa", 3, [["G", 1e9], ["M", 1e6], ["k", 1e3], ["", 1]]);
const forceText = (newton) => (newton > 0 ? withPrefix(newton, "N", 2, [["", 1], ["m", 1e-3], ["µ", 1e-6]]) : "0 N");
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

/** Around its position. */
function probeGeometry({ points, radius }) {
  if (points.length === 1) return new THREE.SphereGeometry(radius, 32, 20);
  const end = new THREE.Vector3(...points[1]), length = end.length();
  const geometry = new THREE.CapsuleGeometry(radius, length, 12, 24);
  geometry.applyQuaternion(new THREE.Quaternion().setFromUnitVectors(new THREE.Vector3(0, 1, 0), end.clone().divideScalar(length)));
  return geometry.translate(end.x / 2, end.y / 2, end.z / 2);
}

class Live {
  constructor({ data, tree, surface }, module) {
    Object.assign(this, { data, tree, surface });
    this.stage = new Stage(module, this.tree, this.surface, data.settings);
    this.origin = new THREE.Vector3(...this.stage.deformer.origin);
    this.mode = "pull";
    this.hands = new Map();  // pointer: { plane, move, end }
    this.probeMeshes = new Map();  // Probe: mesh
    this.forceLabels = [];
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
    this.shape = null;
    this.mesh = new THREE.Mesh(this.geometry,
      new THREE.MeshLambertMaterial({ color: SURFACE_COLOR, side: THREE.DoubleSide }));
    this.mesh.frustumCulled = false;  // its bounds change
    this.detail = this.scene.renderer.getPixelRatio();
    this.isSlow = false;
    this.marks = new THREE.Points(new THREE.BufferGeometry(),
      new THREE.PointsMaterial({ color: HELD_COLOR, size: 12 * this.detail, sizeAttenuation: false,
        depthTest: false, map: discTexture(), alphaTest: 0.5 }));
    this.probeMaterial = new THREE.MeshLambertMaterial({ color: PROBE_COLOR });
    this.marks.frustumCulled = false;
    this.marks.renderOrder = 1;
    this.scene.scene.add(this.mesh, this.marks);
    this.showSurface();
    this.scene.viewAll(new THREE.Vector3(0, -1, 0.15), true);
  }

  /** Other vertices and faces, after a cut or without it. */
  setShape() {
    const { deformer } = this.stage;
    this.shape = deformer.shape;
    this.geometry.dispose();
    this.geometry = new THREE.BufferGeometry();
    this.geometry.setIndex(new THREE.BufferAttribute(deformer.corners().slice(), 1));
    for (const name of ["position", "normal"])
      this.geometry.setAttribute(name, new THREE.BufferAttribute(new Float32Array(3 * deformer.vertexCount), 3).setUsage(THREE.DynamicDrawUsage));
    this.mesh.geometry = this.geometry;
    const { segment, t } = deformer.places();
    this.places = { segment: segment.slice(), t: t.slice() };
  }

  /** Positions as they are in WebAssembly. */
  showSurface() {
    const { deformer } = this.stage;
    if (this.shape !== deformer.shape) this.setShape();
    deformer.follow();
    this.geometry.attributes.position.array.set(deformer.positions());
    this.geometry.attributes.normal.array.set(deformer.normals());
    this.geometry.attributes.position.needsUpdate = this.geometry.attributes.normal.needsUpdate = true;
    this.showMarks();
  }

  /** Relative to the origin. */
  relative(position) {
    return new THREE.Vector3(...position).sub(this.origin);
  }

  /** What is held, instruments, and the forces on hands. */
  showMarks() {
    const { settings, deformer } = this.stage;
    const acting = this.stage.acting(), nodes = deformer.nodes();
    const still = [...settings.fix, ...settings.clamp].map((node) => [...nodes.subarray(3 * node, 3 * node + 3)]);
    this.showPoints([...still, ...acting.filter((hand) => !hand.probe).map((hand) => hand.position)]);
    this.showProbes(acting.filter((hand) => hand.probe));
    this.showForces(acting.filter((hand) => !(hand.held && hand.held.pinned)));
  }

  showPoints(positions) {
    const at = Float32Array.from(positions.flatMap((position) => this.relative(position).toArray()));
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

  showProbes(acting) {
    const there = new Set(acting.map((hand) => hand.probe));
    for (const [probe, mesh] of [...this.probeMeshes]) {
      if (there.has(probe)) continue;
      mesh.geometry.dispose();
      this.scene.scene.remove(mesh);
      this.probeMeshes.delete(probe);
    }
    for (const { probe, position } of acting) {
      if (!this.probeMeshes.has(probe)) {
        const mesh = new THREE.Mesh(probeGeometry(probe), this.probeMaterial);
        this.probeMeshes.set(probe, mesh);
        this.scene.scene.add(mesh);
      }
      this.probeMeshes.get(probe).position.copy(this.relative(position));
    }
  }

  /** Beside the strongest. */
  showForces(acting) {
    const shown = acting.sort((a, b) => b.newton - a.newton).slice(0, MOST_LABELS);
    while (this.forceLabels.length < shown.length) {
      const label = Object.assign(document.createElement("output"), { className: "force" });
      byId("picture").append(label);
      this.forceLabels.push(label);
    }
    this.forceLabels.forEach((label, i) => {
      const at = i < shown.length ? this.scene.onScreen(this.relative(shown[i].position)) : null;
      label.hidden = at === null;
      if (at === null) return;
      label.textContent = forceText(shown[i].newton);
      label.style.transform = `translate(${Math.round(at.x)}px, ${Math.round(at.y)}px)`;
    });
  }

  // Time

  /** Frames go on for as long as something moves. */
  go() {
    if (this.looking) return;
    this.looking = true;
    this.last = performance.now();
    this.backlog = 0;
    this.cost.frames.length = 0;
    this.framesOfMotion = 0;
    if (this.isSlow) this.setDetail(COARSE);
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
    if (moves) {
      requestAnimationFrame((next) => this.frame(next));
      return;
    }
    this.looking = false;
    this.tellOfProbes();
    this.setDetail(1);
  }

  /** Instruments that a replay with other settings left out. */
  tellOfProbes() {
    const { left } = this.stage;
    if (left > 0)
      this.note(`${left} ${left > 1 ? "instruments" : "instrument"} had no room now where ${left > 1 ? "they" : "it"} came: left out.`);
    this.stage.left = 0;
  }

  /** Draws with a part of the screen's pixels; without a graphics card that takes less than half of the time. */
  setDetail(part) {
    const { renderer } = this.scene;
    if (renderer.getPixelRatio() === part * this.detail) return;
    renderer.setPixelRatio(part * this.detail);
    this.marks.material.size = 12 * part * this.detail;
    this.scene.render();
  }

  /** Frames of the last second of motion, two at least. */
  count(now) {
    const { frames } = this.cost;
    frames.push(now);
    while (frames.length > 2 && now - frames[0] > 1000) frames.shift();
    if (this.isSlow || ++this.framesOfMotion < FRAMES_LOOKED_AT || this.framesPerSecond() >= FEW_FRAMES) return;
    this.isSlow = true;
    this.setDetail(COARSE);
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
      (fps > 0 ? `, ${Math.round(fps)} frames/s` : "") + this.tornText() + this.forcesText();
    byId("save").disabled = stage.playing || stage.motion.empty || stage.steps === 0;
    byId("replay").disabled = stage.playing || stage.steps === 0;
  }

  tornText() {
    const torn = this.stage.settings.tissue ? this.stage.deformer.torn() : 0;
    return torn > 0 ? `, tissue torn at ${torn} node${torn > 1 ? "s" : ""}` : "";
  }

  /** Of hands and pins, the strongest ones. */
  forcesText() {
    const forces = this.stage.acting().map((hand) => hand.newton).sort((a, b) => b - a);
    return forces.length === 0 ? "" : `, ${forces.slice(0, 3).map(forceText).join(", ")}`;
  }

  note(text, duration_ms = 4000) {
    byId("note").textContent = text;
    byId("note").hidden = false;
    clearTimeout(this.noting);
    this.noting = setTimeout(() => { byId("note").hidden = true; }, duration_ms);
  }

  // Hands

  ray(event) {
    const box = this.scene.canvas.getBoundingClientRect();
    const at = new THREE.Vector2(((event.clientX - box.left) / box.width) * 2 - 1, 1 - ((event.clientY - box.top) / box.height) * 2);
    const ray = new THREE.Raycaster();
    ray.setFromCamera(at, this.scene.camera);
    return ray;
  }

  /** What of the surface is under a pointer: the point, its place, the node nearest to it along its segment; null: none. */
  under(event) {
    this.geometry.computeBoundingSphere();
    const hit = this.ray(event).intersectObject(this.mesh)[0];
    if (!hit) return null;
    const place = this.placeOf(hit);
    return { point: hit.point, ...place, node: this.nodeAt(place) };
  }

  /** Between the places of a face's corners, if they are on one segment, else of the nearest one. */
  placeOf({ point, face }) {
    const corners = [face.a, face.b, face.c], positions = this.geometry.attributes.position.array;
    const [a, b, c] = corners.map((v) => new THREE.Vector3().fromArray(positions, 3 * v));
    const { segment, t } = this.places;
    const weights = THREE.Triangle.getBarycoord(point, a, b, c, new THREE.Vector3());
    if (weights && corners.every((v) => segment[v] === segment[face.a])) {
      const between = corners.reduce((sum, v, i) => sum + weights.getComponent(i) * t[v], 0);
      return { segment: segment[face.a], t: Math.min(1, Math.max(0, between)) };
    }
    const distances = [a, b, c].map((p) => p.distanceToSquared(point));
    const nearest = corners[distances.indexOf(Math.min(...distances))];
    return { segment: segment[nearest], t: t[nearest] };
  }

  /** The nearer node of a segment that is not held from the start. */
  nodeAt({ segment, t }) {
    const [near, far] = this.stage.deformer.nodesNear(segment, t);
    return this.stage.heldFromStart(near) ? far : near;
  }

  nodePosition(node) {
    return this.relative(this.stage.deformer.nodes().subarray(3 * node, 3 * node + 3));
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
    if (!(this.mode === "push" ? this.push(event, found) : found && this.touch(event, found))) return;
    event.stopPropagation();
    this.scene.stopFlight();
    this.go();
  }

  touch(event, found) {
    if (this.mode === "cut") this.cut(found);
    else if (this.mode === "grasp" || !this.stage.isOfScene(found.node)) this.grasp(event, found);
    else if (this.stage.heldFromStart(found.node)) this.note(`Node ${found.node} is held from the start.`);
    else if (this.mode === "pin") this.pin(found.node);
    else if (!this.stage.held.has(found.node)) this.pull(event, found);
    return true;
  }

  pin(node) {
    const { held } = this.stage;
    if (held.has(node)) this.stage.release(node);
    else this.stage.grab(node).pinned = true;
    this.showMarks();
    this.scene.draw();
  }

  /** A pointer does something from now on. `move`: with points in the plane of view through `point`. */
  addHand(event, point, move, end) {
    this.hands.set(event.pointerId, { plane: new THREE.Plane().setFromNormalAndCoplanarPoint(this.forward(), point), move, end });
    this.scene.canvas.classList.add("pulling");
  }

  pull(event, { point, node }) {
    const shift = this.nodePosition(node).sub(point).add(this.origin), rest = this.stage.restOf(node);
    this.stage.grab(node);
    this.addHand(event, point, (at) => this.stage.move(node, at.add(shift).toArray().map((x, i) => x - rest[i])), () => {
      const held = this.stage.held.get(node);
      if (held && !held.pinned) this.stage.release(node);
    });
  }

  grasp(event, { point, segment, t }) {
    const grasp = this.stage.grasp(segment, t, this.instrument.slips_N);
    this.addHand(event, point, (at) => {
      grasp.offset = at.sub(point).toArray();
      this.stage.awake = true;
    }, () => this.stage.finish(grasp));
  }

  cut({ segment, t }) {
    try {
      this.stage.cut(segment, t);
      this.showSurface();
      this.scene.draw();
    } catch (error) {
      this.note(`${error.message[0].toUpperCase()}${error.message.slice(1)}.`, 8000);
    }
  }

  /** An instrument comes from where the viewer is, as far as there is room, and goes on to the depth of the vessel that is
   * nearest under or beside the pointer. False if that is far. */
  push(event, found) {
    const { radius } = this.instrument;
    const level = found ? this.axisBehind(found) : this.axisBeside(event, radius);
    if (!level) return false;
    const plane = new THREE.Plane().setFromNormalAndCoplanarPoint(this.forward(), level);
    const ray = this.ray(event).ray, at = ray.intersectPlane(plane, new THREE.Vector3());
    if (!at) return false;
    const points = this.probePoints();
    const from = this.freePlace(points, radius, at, ray.direction);
    const probe = this.stage.push(points, radius, from, PROBE_REACH * radius);
    const aim = (to) => {
      probe.aim = to.add(this.origin).toArray();
      this.stage.awake = true;
    };
    aim(at.clone());
    this.addHand(event, level, aim, () => this.stage.finish(probe));
    return true;
  }

  /** The point of a vessel's axis at the depth of which an instrument touches it. */
  axisBehind({ point, node }) {
    return this.nodePosition(node).projectOnVector(this.forward()).add(point.clone().projectOnPlane(this.forward()));
  }

  /** The direction of view. */
  forward() {
    return this.scene.camera.getWorldDirection(new THREE.Vector3());
  }

  /** The node nearest to a pointer on the screen; null: none is near. */
  axisBeside(event, radius) {
    const box = this.scene.canvas.getBoundingClientRect();
    const pointer = new THREE.Vector2(event.clientX - box.left, event.clientY - box.top);
    let best = null;
    for (let node = 0; node < this.stage.deformer.nodeCount; ++node) {
      const position = this.nodePosition(node), at = this.scene.onScreen(position);
      if (!at) continue;
      const distance = Math.hypot(at.x - pointer.x, at.y - pointer.y);
      if (!best || distance < best.distance) best = { position, distance };
    }
    if (!best) return null;
    const far = best.position.distanceTo(this.scene.camera.position) * this.scene.spread().high;
    const pixels = (PROBE_BESIDE * radius * box.height) / (2 * far);
    return best.distance <= Math.max(LEAST_BESIDE_PX, pixels) ? best.position : null;
  }

  /** The nearest place on the way to the viewer with room for an instrument, mm. */
  freePlace(points, radius, at, direction) {
    const least = 0.1 * radius;
    const place = at.clone();
    for (;;) {
      const room = this.stage.deformer.room({ points, radius }, place.clone().add(this.origin).toArray());
      if (room >= least) return place.add(this.origin).toArray();
      place.addScaledVector(direction, -Math.max(least, least - room));
    }
  }

  /** Of the instrument as chosen: a ball, or a rod that comes from the lower right, mm from its tip. */
  probePoints() {
    if (this.instrument.shape === "ball") return [[0, 0, 0]];
    const along = new THREE.Vector3(0.5, -0.45, 0.75).normalize().applyQuaternion(this.scene.camera.quaternion);
    return [[0, 0, 0], rounded(along.multiplyScalar(ROD_LENGTH * this.instrument.radius).toArray())];
  }

  moved(event) {
    const hand = this.hands.get(event.pointerId);
    if (!hand) return;
    const at = this.ray(event).ray.intersectPlane(hand.plane, new THREE.Vector3());
    if (!at) return;
    hand.move(at);
    this.go();
  }

  up(event) {
    const hand = this.hands.get(event.pointerId);
    if (!hand) return;
    this.hands.delete(event.pointerId);
    if (this.hands.size === 0) this.scene.canvas.classList.remove("pulling");
    hand.end();
    this.go();
  }

  /** What the mouse would do, looked at once a frame. */
  hover(event) {
    if (event.pointerType !== "mouse" || event.buttons !== 0 || this.hovering) return;
    this.hovering = true;
    requestAnimationFrame(() => {
      this.hovering = false;
      const found = this.under(event) !== null;
      this.scene.canvas.classList.toggle("pulls", found && this.mode !== "cut");
      this.scene.canvas.classList.toggle("cuts", found && this.mode === "cut");
    });
  }

  // Buttons, keys, sliders

  letGo() {
    for (const hand of this.hands.values()) hand.end();
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
    for (const name of MODES) byId(name).setAttribute("aria-pressed", String(name === mode));
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
    const acts = { ...Object.fromEntries(MODES.map((mode) => [mode, () => this.setMode(mode)])), rest: () => this.rest(),
      replay: () => this.replay(), save: () => this.save(),
      all: () => this.scene.viewAll(new THREE.Vector3(0, -1, 0.15), false) };
    for (const [id, act] of Object.entries(acts)) byId(id).addEventListener("click", act);
    const keys = { v: "pull", g: "grasp", u: "push", c: "cut", p: "pin", 0: "rest", r: "replay", s: "save", home: "all" };
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
    for (const [id, slider] of Object.entries({ ...sliders, ...this.tissueSliders() }))
      this.addSlider(id, slider, () => {
        this.stage.change();
        this.refresh();
      });
    for (const [id, slider] of Object.entries(this.instrumentSliders())) this.addSlider(id, slider, () => {});
    for (const shape of ["ball", "rod"]) byId(shape).addEventListener("click", () => this.setProbe(shape));
  }

  addSlider(id, { ends, value, text, change }, changed) {
    const slider = byId(id);
    const show = (x) => { byId(`${id}-text`).textContent = text(x); };
    if (ends) [slider.min, slider.max] = ends.map(String);
    slider.value = String(value);  // which has steps and ends
    show(value);
    slider.addEventListener("input", () => show(Number(slider.value)));
    slider.addEventListener("change", () => {
      change(Number(slider.value));
      changed();
    });
  }

  /** Springs to where vessels rest; none, and torn by nothing, at one end of the sliders. */
  tissueSliders() {
    const { settings } = this.stage;
    const none = Number(byId("tissue").min), never = Number(byId("tear").max);
    const wanted = { stiffness_N_mm2: 0, tear_N_mm: null, ...settings.tissue };
    const set = (change) => {
      Object.assign(wanted, change);
      settings.tissue = wanted.stiffness_N_mm2 > 0 ? { ...wanted } : null;
    };
    return {
      tissue: { value: wanted.stiffness_N_mm2 > 0 ? Math.log10(wanted.stiffness_N_mm2) : none,
        text: (x) => (x <= none ? "none" : `${forceText(10 ** x)}/mm²`),
        change: (x) => set({ stiffness_N_mm2: x <= none ? 0 : Number((10 ** x).toPrecision(3)) }) },
      tear: { value: wanted.tear_N_mm === null ? never : Math.log10(wanted.tear_N_mm),
        text: (x) => (x >= never ? "never" : `${forceText(10 ** x)}/mm`),
        change: (x) => set({ tear_N_mm: x >= never ? null : Number((10 ** x).toPrecision(3)) }) },
    };
  }

  instrumentSliders() {
    const radii = [...this.tree.radii].sort((a, b) => a - b);
    const never = Number(byId("slips").max);
    const usual = Number((1.5 * radii[radii.length >> 1]).toPrecision(2));
    this.instrument = { shape: "ball", radius: usual, slips_N: Infinity };
    const ends = [Math.log10(usual) - 1, Math.log10(usual) + 1];
    const millimetres = (x) => Number((10 ** x).toPrecision(2));
    return {
      radius: { ends, value: Math.log10(usual), text: (x) => `${millimetres(x)} mm`,
        change: (x) => { this.instrument.radius = millimetres(x); } },
      slips: { value: never, text: (x) => (x >= never ? "never" : forceText(10 ** x)),
        change: (x) => { this.instrument.slips_N = x >= never ? Infinity : Number((10 ** x).toPrecision(3)); } },
    };
  }

  setProbe(shape) {
    this.instrument.shape = shape;
    for (const name of ["ball", "rod"]) byId(name).setAttribute("aria-pressed", String(name === shape));
  }
}

async function start() {
  try {
    window.vmesh = new Live(contents, await createDeformer());
    await drawn();
    window.vmesh.ready_ms = performance.now();
    byId("poster").remove();
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
