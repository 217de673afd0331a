// Puts the page together.

const TOGGLES = ["edges", "centerline", "reference", "glass", "cut", "ruler"];

class Viewer {
  constructor(page) {
    this.page = page;
    const first = page.surfaces[0] || page.centerline;
    this.origin = first ? first.low : [0, 0, 0];
    this.surfaces = page.surfaces.map((json) => decodeSurface(json, this.origin));
    this.centerline = page.centerline && decodeCenterline(page.centerline, this.origin);
    const lists = this.surfaces.map((surface) => surface.positions);
    if (this.centerline) lists.push(this.centerline.positions);
    this.scene = new Scene(byId("picture"), boundsOf(lists));
    this.cut = new Cut(this.scene);
    this.ruler = new Ruler(this.scene, byId("length"));
    this.shown = null;
    this.place = -1;
    this.mark = null;
    this.markCurrent = fillPlaces(page, (i) => this.goTo(i));
    this.views = new Map();
    this.addLines();
    this.addReference();
    this.addSurfaces();
    this.addFrames();
    addAxes(byId("axes"), this.scene, (letter) => this.look(letter));
    this.scene.afterDrawing.push(() => this.moveMark());
    this.addPicking();
    for (const name of TOGGLES) byId(name).addEventListener("click", () => this.toggle(name));
    byId("cut-depth").addEventListener("input", () => this.moveCut());
    byId("save").addEventListener("change", () => this.save());
    byId("all").addEventListener("click", () => this.viewAll());
    byId("color").addEventListener("change", () => this.colorBy(byId("color").value));
    byId("surface").addEventListener("change", () => this.showSurface(byId("surface").value));
    byId("picked-close").addEventListener("click", () => this.unpick());
  }

  addLines() {
    byId("centerline").hidden = !this.centerline;
    if (!this.centerline) return;
    this.lines = centerlineView(this.centerline);
    this.scene.scene.add(this.lines);
    this.lines.visible = this.surfaces.length === 0;
    byId("centerline").setAttribute("aria-pressed", String(this.lines.visible));
  }

  addReference() {
    const surface = this.surfaces.find((s) => s.reference);
    byId("reference").hidden = !surface;
    if (!surface) return;
    this.reference = new SurfaceView(surface, true);
    this.reference.group.visible = false;
    this.scene.scene.add(this.reference.group);
  }

  addSurfaces() {
    const own = this.surfaces.filter((s) => s.attributes.length > 0);
    fillSelect(byId("surface"), own.map((s) => [s.name, s.name]));
    byId("surface-part").hidden = own.length < 2;
    for (const id of ["edges", "glass", "cut", "ruler"]) byId(id).hidden = own.length === 0;
    for (const option of byId("save").querySelectorAll("[value=ply], [value=stl]")) option.hidden = own.length === 0;
    byId("color-part").hidden = own.length === 0;
    byId("legend").hidden = own.length === 0;
    if (own.length > 0) this.showSurface(own[0].name);
  }

  showSurface(name) {
    const surface = this.surfaces.find((s) => s.name === name && s.attributes.length > 0);
    if (!surface) return;
    if (this.shown) this.shown.group.visible = false;
    if (!this.views.has(name)) {
      this.views.set(name, new SurfaceView(surface, false));
      this.scene.scene.add(this.views.get(name).group);
    }
    this.shown = this.views.get(name);
    this.shown.group.visible = true;
    byId("surface").value = name;
    this.unpick();
    this.ruler.clear();
    this.set("edges", this.is("edges"));
    this.set("glass", this.is("glass"));
    const colored = surface.attributes.filter((attribute) => attribute.name !== "parameter");
    fillSelect(byId("color"), [...colored.map((a) => [a.name, withUnit(a.label, a.unit)]), ["", "One colour"]]);
    const wanted = ["displacement", "distance", "relative_distance", "volume_distance", "EquiangleSkewness", "radius"];
    const has = (name) => colored.some((a) => a.name === name);
    const kept = this.attribute && has(this.attribute.name) ? this.attribute.name : null;
    this.colorBy(kept || wanted.find(has) || (colored[0] ? colored[0].name : ""));
  }

  colorBy(name) {
    this.attribute = this.shown.surface.attributes.find((a) => a.name === name) || null;
    if (this.attribute && this.attribute.low === undefined) Object.assign(this.attribute, rangeOf(this.attribute));
    this.scale = this.attribute && makeScale(this.attribute);
    byId("color").value = this.attribute ? name : "";
    this.shown.color(this.attribute, this.scale);
    byId("legend").hidden = !this.attribute;
    if (this.attribute) drawLegend(byId("legend"), this.attribute, this.scale);
    this.scene.draw();
  }

  addFrames() {
    byId("frames").hidden = !this.page.frames;
    if (!this.page.frames) return;
    const show = (player) => {
      if (this.lines) this.lines.moved();
      this.ruler.clear();
      if (this.attribute && this.attribute === player.displacement) this.shown.color(this.attribute, this.scale);
      byId("frame").value = player.frame;
      byId("time").textContent = `${player.times[player.frame].toFixed(2)} s`;
      byId("play").setAttribute("aria-pressed", String(player.playing));
      this.scene.draw();
    };
    this.player = new Player(this.page.frames, this.shown, this.centerline, this.origin, show);
    byId("frame").max = this.player.positions.length - 1;
    byId("frame").addEventListener("input", () => this.player.stopAt(Number(byId("frame").value)));
    byId("play").addEventListener("click", () => this.player.play(!this.player.playing));
    this.player.go(0);
    this.colorBy(byId("color").value);
    this.scene.bounds = boundsOf(this.player.positions);
  }

  is(name) {
    return byId(name).getAttribute("aria-pressed") === "true";
  }

  set(name, on) {
    byId(name).setAttribute("aria-pressed", String(on));
    if (name === "edges" && this.shown) this.shown.showEdges(on);
    if (name === "glass" && this.shown) this.shown.seeThrough(on);
    if (name === "centerline" && this.lines) this.lines.visible = on;
    if (name === "reference" && this.reference) this.reference.group.visible = on;
    if (name === "cut") this.setCut(on);
    if (name === "ruler") this.ruler.clear();
    this.scene.draw();
  }

  setCut(on) {
    byId("cut-depth").hidden = !on;
    if (!on) {
      this.cut.end();
      return;
    }
    this.cut.begin();
    this.moveCut();
  }

  moveCut() {
    this.cut.move(Number(byId("cut-depth").value) / 1000);
  }

  /** Saves what was chosen, and offers the choice again. */
  save() {
    const kind = byId("save").value;
    byId("save").value = "";
    const name = `${this.page.title.replace(/\.\w+$/, "").replace(/[^\w.-]+/g, "-") || "surface"}.${kind}`;
    if (kind === "png") {
      const picture = pictureOf(this.scene, this.attribute, this.scale, this.ruler);
      download(picture.toDataURL("image/png"), name);
    }
    if (kind === "ply") downloadBytes(plyOf(this.shown.surface, this.origin), name);
    if (kind === "stl") downloadBytes(stlOf(this.shown.surface, this.origin), name);
  }

  toggle(name) {
    if (!byId(name).hidden) this.set(name, !this.is(name));
  }

  look(letter, atOnce) {
    this.scene.viewAll(new THREE.Vector3(...DIRECTIONS[letter].at), atOnce);
  }

  viewAll(atOnce) {
    this.choose(-1);
    this.unpick();
    this.look("A", atOnce);
  }

  choose(place) {
    this.place = place;
    this.markCurrent(place);
    try {
      history.replaceState(null, "", place < 0 ? "#" : `#place=${place + 1}`);
    } catch (error) {
      // Some browsers do not let a page from a file change its address; the place is then not in it.
    }
  }

  /** Flies to a place in the list, looking at it from outside. */
  goTo(i, atOnce) {
    const place = this.page.places[(i + this.page.places.length) % this.page.places.length];
    if (!place) return;
    this.choose(this.page.places.indexOf(place));
    this.unpick();
    if (this.player) this.player.stopAt(this.player.positions.length - 1);
    if (place.surface) this.showSurface(place.surface);
    if (place.attribute && this.shown && this.shown.surface.attributes.some((a) => a.name === place.attribute))
      this.colorBy(place.attribute);
    const target = new THREE.Vector3(...place.at).sub(new THREE.Vector3(...this.origin));
    const vertex = this.shown ? this.shown.nearestVertex(target) : -1;
    const direction = vertex >= 0 ? this.shown.normal(vertex) : new THREE.Vector3();
    if (direction.length() < 0.5) direction.set(0, -1, 0);
    if (Math.abs(direction.z) > 0.99) direction.y -= 0.15;  // straight from above there is no up
    this.mark = target;
    byId("mark-text").textContent = place.value;
    this.scene.flyTo(target, direction, this.scene.distanceFor(this.sizeAt(target, vertex)), atOnce);
  }

  /** How much around a place should be in view: some triangles, and the surface if the place is off it. */
  sizeAt(target, vertex) {
    if (vertex < 0) return 0.1 * this.scene.bounds.radius;
    const size = Math.max(7 * this.shown.edgeAt(vertex), 1.5 * target.distanceTo(this.shown.vertex(vertex)));
    return Math.min(size, this.scene.bounds.radius) || this.scene.bounds.radius;
  }

  moveMark() {
    const at = this.mark && this.scene.onScreen(this.mark);
    byId("mark").hidden = !at;
    if (at) byId("mark").style.transform = `translate(${at.x.toFixed(1)}px, ${at.y.toFixed(1)}px)`;
  }

  addPicking() {
    const { canvas } = this.scene;
    let down = null;
    canvas.addEventListener("pointerdown", (event) => {
      down = event.isPrimary ? { x: event.clientX, y: event.clientY } : null;
    });
    canvas.addEventListener("pointerup", (event) => {
      const still = down && Math.hypot(event.clientX - down.x, event.clientY - down.y) < 5;
      if (still && event.button === 0) this.pick(event.clientX, event.clientY);
      down = null;
    });
  }

  pick(x, y) {
    const hit = this.shown && this.scene.pick(this.shown.mesh, x, y, (point) => this.cut.shows(point));
    if (this.is("ruler")) {
      if (hit) this.ruler.add(hit.point);
      return;
    }
    if (!hit) {
      this.unpick();
      return;
    }
    const { surface } = this.shown;
    const corners = [0, 1, 2].map((k) => surface.corners[3 * hit.faceIndex + k]);
    const far = (v) => this.shown.vertex(v).distanceTo(hit.point);
    const vertex = corners.reduce((best, v) => (far(v) < far(best) ? v : best));
    this.mark = this.shown.vertex(vertex);
    byId("mark-text").textContent = "";
    showPicked(surface, vertex, hit.faceIndex, this.origin);
    this.scene.draw();
  }

  unpick() {
    this.mark = null;
    byId("picked").hidden = true;
    this.scene.draw();
  }

  /** What links can contain: #place=2&color=radius&edges=1&surface=low&view=L&frame=12. */
  follow(fragment) {
    const wanted = new URLSearchParams(fragment.replace(/^#/, ""));
    if (wanted.has("surface")) this.showSurface(wanted.get("surface"));
    if (wanted.has("color") && this.shown) this.colorBy(wanted.get("color"));
    for (const name of TOGGLES) if (wanted.has(name)) this.set(name, wanted.get(name) === "1");
    if (wanted.has("view") && DIRECTIONS[wanted.get("view")]) this.look(wanted.get("view"), true);
    if (wanted.has("frame") && this.player) this.player.go(Number(wanted.get("frame")) || 0);
    const place = Number(wanted.get("place"));
    if (place >= 1 && place <= this.page.places.length) this.goTo(place - 1, true);
  }
}

function toggleHelp() {
  const help = byId("help");
  help.hidden = !help.hidden;
  if (!help.hidden) byId("help-close").focus();
}

/** What keys do to a viewer. */
function keysOf(viewer) {
  const { scene } = viewer;
  const frame = (by) => {
    if (viewer.player) viewer.player.stopAt(viewer.player.frame + by);
  };
  return {
    e: () => viewer.toggle("edges"), c: () => viewer.toggle("centerline"), r: () => viewer.toggle("reference"),
    g: () => viewer.toggle("glass"), x: () => viewer.toggle("cut"), m: () => viewer.toggle("ruler"),
    Home: () => viewer.viewAll(), 0: () => viewer.viewAll(),
    n: () => viewer.goTo(viewer.place + 1), p: () => viewer.goTo(Math.max(viewer.place, 0) - 1),
    ",": () => frame(-1), ".": () => frame(1), "?": toggleHelp, h: toggleHelp,
    " ": () => viewer.player && viewer.player.play(!viewer.player.playing),
    ArrowLeft: () => scene.turn(-0.12, 0), ArrowRight: () => scene.turn(0.12, 0),
    ArrowUp: () => scene.turn(0, -0.12), ArrowDown: () => scene.turn(0, 0.12),
    "+": () => scene.zoom(0.85), "-": () => scene.zoom(1 / 0.85),
    Escape: () => {
      if (!byId("help").hidden) toggleHelp();
      else {
        viewer.unpick();
        viewer.ruler.clear();
      }
    },
  };
}

/** For the viewer that is there when a key is pressed. */
function addKeys() {
  document.addEventListener("keydown", (event) => {
    if (!window.vmesh) return;
    const keys = keysOf(window.vmesh);
    const own = event.target.closest("input, select, textarea, summary, .scroll, button");
    const action = keys[event.key] || keys[event.key.toLowerCase()];
    const typed = own && (event.key.startsWith("Arrow") || event.key === " " || event.key === "Home");
    if (!action || typed || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    action();
  });
}

/** Fills the page, which is as it was loaded. */
function show(page) {
  document.body.classList.toggle("figures-first", page.surfaces.length === 0);
  fillHeader(page);
  fillHistograms(page);
  fillReport(page);
  byId("help-open").addEventListener("click", toggleHelp);
  byId("help-close").addEventListener("click", toggleHelp);
  try {
    const viewer = new Viewer(page);
    viewer.look("A", true);
    viewer.follow(location.hash);
    window.vmesh = viewer;  // for keys and the console
  } catch (error) {
    console.error(error);
    byId("no-picture").hidden = false;
    if (byId("places").children.length === 0) fillPlaces(page, () => {});
    document.body.classList.add("without-picture");
  }
}

function start() {
  addKeys();
  window.addEventListener("hashchange", () => window.vmesh && window.vmesh.follow(location.hash));
  const page = JSON.parse(byId("page-data").textContent);
  if (page) show(page);  // there is none yet in a page that makes them
  document.body.dataset.ready = "1";
}

start();
