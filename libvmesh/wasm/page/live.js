// Makes surfaces of the files that are dropped on the page, in a worker, and shows each.

const MAX_ERRORS = ["", "20%", "10%", "5%", "3%", "2%", "1%"];
const SLIDERS = {
  around: { read: Number, text: (value) => value, option: "around" },
  blend: { read: Number, text: (value) => `${value.toFixed(1)} radii`, option: "blend" },
  elongation: { read: Number, text: (value) => (value === 1 ? "no" : `up to ${value} times`), option: "elongation" },
  "max-error": { read: (value) => MAX_ERRORS[value], text: (value) => (value ? `${value} of the radius` : "no limit"),
    option: "maxError" },
};

/** Bytes packed by gzip in base64, from an element of the page. */
async function unpacked(id) {
  const text = atob(byId(id).textContent.trim());
  const packed = Uint8Array.from(text, (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).arrayBuffer();
}

class Maker {
  constructor() {
    this.files = null;
    this.worker = null;
    this.isReady = false;
    this.waiting = null;  // what to grow once the worker is ready
    this.isBusy = false;
    this.pristine = ["view", "panel"].map((id) => byId(id).cloneNode(true));
    for (const id of ["help-open", "help-close"]) byId(id).addEventListener("click", toggleHelp);
    this.addInputs();
    this.addDropping();
    this.describeOptions();
    this.module = unpacked("wasm").then((bytes) => WebAssembly.compile(bytes));
    this.module.then(() => this.startWorker(), (error) => this.fail(`This browser cannot run vmesh: ${error.message}`));
  }

  /** The worker's program is in the page; the compiled module goes to it as it is. */
  async startWorker() {
    const program = new Blob([byId("worker").textContent], { type: "text/javascript" });
    const address = URL.createObjectURL(program);
    const worker = new Worker(address);
    URL.revokeObjectURL(address);
    this.worker = worker;
    this.isReady = false;
    worker.onmessage = ({ data }) => this.worker === worker && this.take(data);
    worker.onerror = (event) => this.worker === worker && this.lose(event.message);
    worker.postMessage({ kind: "start", module: await this.module });
  }

  /** Ends what the worker does and what it holds. */
  restartWorker() {
    if (this.worker) this.worker.terminate();
    this.worker = null;
    return this.startWorker();
  }

  take(data) {
    if (data.kind === "ready") {
      this.isReady = true;
      byId("make-version").textContent = data.version;
      byId("file").accept = data.formats.centerlines.join(",");
      document.body.dataset.maker = "ready";
      if (this.waiting) this.send(this.waiting);
      this.waiting = null;
    }
    if (data.kind === "progress") this.progress(data.stage, data.fraction);
    if (data.kind === "grown") this.grown(data);
    if (data.kind === "file") downloadBytes(data.bytes, `${this.stem()}.${data.extension}`);
    if (data.kind === "failed") this.fail(data.message);
  }

  lose(message) {
    this.fail(`This did not work: ${message || "the page has run out of memory"}. Ask for fewer vertices around.`);
    this.restartWorker();
  }

  stem() {
    return this.files[0].name.replace(/(\.nodes)?\.\w+$/, "").replace(/[^\w.-]+/g, "-") || "surface";
  }

  options() {
    const options = { ends: byId("ends").value };
    for (const [id, slider] of Object.entries(SLIDERS)) options[slider.option] = slider.read(byId(id).value);
    return options;
  }

  describeOptions() {
    for (const [id, slider] of Object.entries(SLIDERS))
      byId(`${id}-text`).textContent = slider.text(slider.read(byId(id).value));
  }

  /** Starts over with the files and options there are now. */
  make() {
    if (!this.files) return;
    const unit = byId("unit").value;
    const work = { kind: "grow", files: this.files, reading: unit ? { unit } : {}, options: this.options() };
    byId("failure").hidden = true;
    byId("downloads").hidden = true;
    document.body.classList.add("stale");
    document.body.dataset.made = "";
    this.progress("", 0);
    byId("working").hidden = false;
    if (this.isBusy) this.restartWorker();
    this.isBusy = true;
    if (this.isReady) this.send(work);
    else this.waiting = work;
  }

  send(work) {
    this.worker.postMessage(work);
  }

  cancel() {
    this.waiting = null;
    this.rest("Cancelled. Move a slider to go on.");
    this.restartWorker();
  }

  progress(stage, fraction) {
    byId("progress").value = fraction;
    byId("stage").textContent = stage;
  }

  /** Nothing is being made; `outcome` tells what became of it. */
  rest(outcome) {
    this.isBusy = false;
    byId("working").hidden = true;
    byId("outcome").textContent = outcome;
    byId("outcome").hidden = !outcome;
  }

  fail(message) {
    this.rest("");
    byId("failure").textContent = message;
    byId("failure").hidden = false;
    document.body.dataset.made = "failed";
  }

  grown({ page, sound, unproven, seconds, cleaning }) {
    const limit = unproven > 0 ? "; the error is not proven everywhere" : "";
    this.rest(`${sound ? "Made" : "Made, but not sound: see the places below;"} in ${seconds.toFixed(1)} s${limit}.`);
    page.warnings.push(...cleaning);
    page.command_line = this.commandLine();
    this.replace(page);
    byId("downloads").hidden = false;
    document.body.classList.remove("stale", "empty");
    document.body.dataset.made = "1";
  }

  /** What does the same on the command line. */
  commandLine() {
    const { around, blend, elongation, maxError, ends } = this.options();
    const more = [[around !== 6, `--around ${around}`], [blend !== 0.5, `--blend ${blend}`],
      [elongation !== 1, `--elongation ${elongation}`], [maxError, `--max-error ${maxError}`],
      [ends !== "round", `--ends ${ends}`], [byId("unit").value, `--unit ${byId("unit").value}`]];
    const names = this.files.map((file) => (/[^\w.-]/.test(file.name) ? `'${file.name.replace(/'/g, "'\\''")}'` : file.name));
    return ["vmesh generate", ...names, "-o", `${this.stem()}.ply`, ...more.filter(([on]) => on).map(([, text]) => text)]
      .join(" ");
  }

  /** Shows another surface as the last one was: from the same side, if it is of the same file. */
  replace(page) {
    const old = window.vmesh;
    const kept = old && old.page.title === page.title && this.shownFiles === this.files ? this.stateOf(old) : null;
    if (old) old.scene.renderer.dispose();
    if (old) old.scene.renderer.forceContextLoss();
    window.vmesh = null;
    document.body.classList.remove("without-picture");
    this.restore();
    this.shownFiles = this.files;
    show(page);
    if (kept && window.vmesh) this.follow(window.vmesh, kept);
  }

  /** View and panel as they were loaded, but for what makes surfaces. */
  restore() {
    const [view, panel] = this.pristine;
    byId("view").replaceWith(view.cloneNode(true));
    const parts = [...panel.cloneNode(true).children].filter((part) => part.id !== "make");
    for (const part of [...byId("panel").children]) if (part.id !== "make") part.remove();
    byId("panel").append(...parts);
    for (const option of byId("save").querySelectorAll("[value=ply], [value=stl]")) option.remove();  // rounded positions
  }

  stateOf(viewer) {
    const { camera, controls } = viewer.scene;
    const on = TOGGLES.filter((name) => name !== "cut" && name !== "ruler" && viewer.is(name));
    return { position: camera.position.clone().add(new THREE.Vector3(...viewer.origin)),
      target: controls.target.clone().add(new THREE.Vector3(...viewer.origin)), on,
      color: viewer.attribute ? viewer.attribute.name : "" };
  }

  follow(viewer, { position, target, on, color }) {
    const origin = new THREE.Vector3(...viewer.origin);
    viewer.scene.controls.target.copy(target).sub(origin);
    viewer.scene.camera.position.copy(position).sub(origin);
    viewer.scene.controls.update();
    for (const name of on) viewer.set(name, true);
    if (viewer.shown && viewer.shown.surface.attributes.some((a) => a.name === color)) viewer.colorBy(color);
    viewer.scene.draw();
  }

  async open(list) {
    const files = await Promise.all([...list].map(async (file) => ({ name: file.name, bytes: await file.arrayBuffer() })));
    if (files.length > 0) this.use(files);
  }

  use(files) {
    this.files = files;
    byId("drop-name").textContent = files.map((file) => file.name).join(", ");
    byId("drop-hint").textContent = "Drop another one to replace it.";
    this.make();
  }

  addInputs() {
    for (const id of Object.keys(SLIDERS)) {
      byId(id).addEventListener("input", () => this.describeOptions());
      byId(id).addEventListener("change", () => this.make());
    }
    for (const id of ["ends", "unit"]) byId(id).addEventListener("change", () => this.make());
    byId("cancel").addEventListener("click", () => this.cancel());
    byId("file").addEventListener("change", () => {
      this.open(byId("file").files);
      byId("file").value = "";
    });
    byId("example").addEventListener("click", () =>
      this.use([{ name: "small_tree.swc", bytes: byId("example-file").textContent }]));
    for (const button of byId("downloads").querySelectorAll("button"))
      button.addEventListener("click", () => this.worker.postMessage({ kind: "save", extension: button.dataset.save }));
  }

  addDropping() {
    const over = (event) => {
      event.preventDefault();
      document.body.classList.add("dragging");
    };
    document.addEventListener("dragenter", over);
    document.addEventListener("dragover", over);
    document.addEventListener("dragleave", (event) => {
      if (!event.relatedTarget) document.body.classList.remove("dragging");
    });
    document.addEventListener("drop", (event) => {
      event.preventDefault();
      document.body.classList.remove("dragging");
      this.open(event.dataTransfer.files);
    });
  }
}

document.body.classList.add("empty");
window.maker = new Maker();
