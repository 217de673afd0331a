// The simulation over steps: what is held now, what was held, and playing it again.

class Stage {
  /** `settings`: of the scene, with `fix` and `clamp`, the nodes that are held from the start. */
  constructor(module, tree, surface, settings) {
    this.settings = settings;
    this.radii = tree.radii;
    this.deformer = new Deformer(module, tree, surface, settings);
    this.restPositions = this.deformer.nodes().slice();
    this.motion = new Motion();
    this.begin();
  }

  begin() {
    this.deformer.restart(this.settings);
    for (const node of this.settings.fix) this.deformer.fix(node);
    for (const node of this.settings.clamp) this.deformer.clamp(node);
    this.steps = 0;
    this.playUntil = 0;
    this.held = new Map();  // node: { hold, offset, pinned }
    this.awake = true;
  }

  /** Back to rest; everything that was done is forgotten. */
  forget() {
    this.motion = new Motion();
    this.begin();
  }

  /** From rest again, by itself for as long as something was done. */
  replay() {
    this.cutOff();
    this.motion.holds = this.motion.holds.filter((hold) => hold.path.length > 0);
    const until = Math.max(this.motion.length(), this.steps);
    this.begin();
    this.playUntil = until;
  }

  /** After the settings have changed: from rest, until the last thing that was done. */
  change() {
    this.replay();
    this.playUntil = this.motion.length();
  }

  /** Hands let go of what is not pinned. */
  cutOff() {
    for (const [node, held] of [...this.held]) if (!held.pinned) this.release(node);
  }

  get playing() {
    return this.steps < this.playUntil;
  }

  heldFromStart(node) {
    return this.settings.fix.includes(node) || this.settings.clamp.includes(node);
  }

  restOf(node) {
    return [0, 1, 2].map((i) => this.restPositions[3 * node + i]);
  }

  offsetOf(node) {
    const now = this.deformer.nodes();
    return this.restOf(node).map((x, i) => now[3 * node + i] - x);
  }

  /** Holds a node from the next step on, where it is until it is moved. */
  grab(node) {
    if (!this.held.has(node))
      this.held.set(node, { hold: this.motion.hold(node, this.steps + 1), offset: rounded(this.offsetOf(node)), pinned: false });
    this.awake = true;
    return this.held.get(node);
  }

  move(node, offset) {
    this.held.get(node).offset = rounded(offset);
    this.awake = true;
  }

  release(node) {
    const { hold } = this.held.get(node);
    this.motion.end(hold, this.steps + 1);
    this.held.delete(node);
    if (hold.path.length > 0) this.deformer.release(node);
    this.awake = true;
  }

  /** One step; false: everything is at rest, and nothing was done. */
  step() {
    if (!this.awake && !this.playing) return false;
    const step = this.steps + 1;
    if (this.playing) this.play(step);
    for (const [node, held] of this.held) {
      const offset = held.replayed ? held.hold.offset(step, this.settings.step_s) : held.offset;
      if (!held.replayed) held.hold.add(step, offset);
      this.deformer.drag(node, this.restOf(node).map((x, i) => x + offset[i]));
    }
    this.awake = this.deformer.step() > 0;
    this.steps = step;
    if (step === this.playUntil) this.resume();
    return true;
  }

  play(step) {
    for (const hold of this.motion.holds) {
      if (hold.end === step && this.held.has(hold.node)) {
        this.deformer.release(hold.node);
        this.held.delete(hold.node);
      }
    }
    for (const hold of this.motion.holds)
      if (hold.start === step) this.held.set(hold.node, { hold, replayed: true, pinned: true });
  }

  /** After a replay hands go on from there. */
  resume() {
    this.awake = true;
    for (const held of this.held.values()) {
      held.offset = held.hold.offset(this.steps, this.settings.step_s);
      held.replayed = false;
    }
  }

  scene() {
    return this.motion.scene(this.settings, this.steps);
  }
}
