// The simulation over steps: what is done now, what was done, and playing it again.

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
    const { fix, clamp, contact, tissue } = this.settings;
    this.deformer.restart(this.settings);
    for (const node of fix) this.deformer.fix(node);
    for (const node of clamp) this.deformer.clamp(node);
    if (contact) this.deformer.contact(contact);
    if (tissue) this.deformer.tissue(tissue);
    this.steps = 0;
    this.playUntil = 0;
    this.held = new Map();    // node: { hold, offset, pinned }
    this.released = [];       // nodes that are let go in the next step, as the command has it
    this.jaws = new Map();    // Grasp: { number, closedAt }
    this.probes = new Map();  // Probe: number
    this.left = 0;            // probes that found no room when a motion was played again
    this.awake = true;
  }

  /** Back to rest; everything that was done is forgotten. */
  forget() {
    this.motion = new Motion();
    this.begin();
  }

  /** From rest again, by itself for as long as something was done. */
  replay() {
    this.letGo();
    for (const hold of this.motion.all) if (hold.path.length === 0) this.motion.forget(hold);
    const until = Math.max(this.motion.length(), this.steps);
    this.begin();
    this.playUntil = until;
    this.cutAgain();
  }

  /** After the settings have changed: from rest, until the last thing that was done. */
  change() {
    this.replay();
    this.playUntil = this.motion.length();
  }

  /** Hands let go of what is not pinned. */
  letGo() {
    for (const [node, held] of [...this.held]) if (!held.pinned) this.release(node);
    for (const hold of [...this.motion.grasps, ...this.motion.probes]) if (hold.end === Infinity) this.finish(hold);
  }

  get playing() {
    return this.steps < this.playUntil;
  }

  heldFromStart(node) {
    return this.settings.fix.includes(node) || this.settings.clamp.includes(node);
  }

  /** Nodes that cuts made are not of the scene. */
  isOfScene(node) {
    return node < this.radii.length;
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
    if (hold.path.length > 0) this.released.push(node);
    this.awake = true;
  }

  /** Closes jaws on a place in the next step. */
  grasp(segment, t, slips_N) {
    const grasp = new Grasp(segment, t, slips_N, this.steps + 1);
    grasp.offset = [0, 0, 0];
    this.motion.grasps.push(grasp);
    this.awake = true;
    return grasp;
  }

  /** An instrument comes in the next step and goes to where it is aimed, by no more than `reach` a step. */
  push(points, radius, from, reach) {
    const probe = new Probe(points, radius, this.steps + 1);
    Object.assign(probe, { reach, now: rounded(from), aim: from });
    this.motion.probes.push(probe);
    this.awake = true;
    return probe;
  }

  /** Opens jaws, takes an instrument away, in the next step. */
  finish(hold) {
    this.motion.end(hold, this.steps + 1);
    this.awake = true;
  }

  /** Parts the vessel there, at once. Throws where it cannot be cut. */
  cut(segment, t) {
    this.deformer.cut(segment, t);
    this.motion.cuts.push({ step: this.steps, segment, t });
    this.awake = true;
  }

  cutAgain() {
    for (const cut of this.motion.cuts) if (cut.step === this.steps) this.deformer.cut(cut.segment, cut.t);
  }

  /** One step; false: everything is at rest, and nothing was done. */
  step() {
    if (!this.awake && !this.playing) return false;
    const step = this.steps + 1, replays = this.playing;
    if (replays) this.play(step);
    for (const node of this.released.splice(0)) this.deformer.release(node);
    for (const [node, held] of this.held) {
      const offset = held.replayed ? held.hold.at(step, this.settings.step_s) : held.offset;
      if (!held.replayed) held.hold.add(step, offset);
      this.deformer.drag(node, this.restOf(node).map((x, i) => x + offset[i]));
    }
    // Instruments and jaws in the order of the scene, as the command has it.
    for (const probe of [...this.motion.probes]) this.guide(probe, step, replays);
    for (const grasp of this.motion.grasps) this.hold(grasp, step, replays);
    this.awake = this.deformer.step() > 0 || this.onTheirWay();
    this.steps = step;
    if (replays) this.cutAgain();
    if (step === this.playUntil) this.resume();
    return true;
  }

  guide(probe, step, replays) {
    if (step < probe.start) return;
    if (step >= probe.end) {
      if (this.probes.has(probe)) this.deformer.leave(this.probes.get(probe));
      this.probes.delete(probe);
      return;
    }
    if (!replays && probe.path.length > 0) probe.now = this.towards(probe);
    const at = replays ? probe.at(step, this.settings.step_s) : probe.now;
    if (!this.probes.has(probe)) {
      // Vessels may be elsewhere when a motion is played with other settings.
      if (!(this.deformer.room(probe, at) > 0)) {
        this.motion.forget(probe);
        ++this.left;
        return;
      }
      this.probes.set(probe, this.deformer.enter(probe, at));
    }
    if (!replays) probe.add(step, at);
    this.deformer.guide(this.probes.get(probe), at);
  }

  /** Where an instrument goes next. */
  towards({ now, aim, reach }) {
    const way = aim.map((x, i) => x - now[i]), far = Math.hypot(...way);
    return rounded(far <= reach ? aim : now.map((x, i) => x + (reach / far) * way[i]));
  }

  /** Whether some instrument has farther to go. */
  onTheirWay() {
    return this.motion.probes.some((probe) => probe.end === Infinity && probe.aim &&
      rounded(probe.aim).some((x, i) => x !== probe.now[i]));
  }

  hold(grasp, step, replays) {
    if (step < grasp.start) return;
    if (step >= grasp.end) {
      if (this.jaws.has(grasp)) this.deformer.openJaw(this.jaws.get(grasp).number);
      this.jaws.delete(grasp);
      return;
    }
    if (!this.jaws.has(grasp)) {
      const number = this.deformer.grasp(grasp.segment, grasp.t, grasp.slips_N);
      this.jaws.set(grasp, { number, closedAt: this.deformer.jaw(number) });
    }
    const offset = replays ? grasp.at(step, this.settings.step_s) : rounded(grasp.offset);
    if (!replays) grasp.add(step, offset);
    const { number, closedAt } = this.jaws.get(grasp);
    this.deformer.moveJaw(number, closedAt.map((x, i) => x + offset[i]));
  }

  play(step) {
    for (const hold of this.motion.holds) {
      if (hold.end === step && this.held.has(hold.node)) {
        this.released.push(hold.node);
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
      held.offset = held.hold.at(this.steps, this.settings.step_s);
      held.replayed = false;
    }
  }

  /** What acts now, with where it is and the force on it: { position, newton, held or jaws or probe }. */
  acting() {
    const { deformer } = this, all = [];
    const nodes = deformer.nodes().slice();
    for (const [node, held] of this.held)
      all.push({ held, position: [...nodes.subarray(3 * node, 3 * node + 3)], newton: deformer.pull_N(node) });
    for (const [jaws, { number }] of this.jaws)
      if (deformer.jawHolds(number)) all.push({ jaws, position: deformer.jaw(number), newton: deformer.jaw_N(number) });
    for (const [probe, number] of this.probes)
      all.push({ probe, position: deformer.instrument(number), newton: deformer.instrument_N(number) });
    return all;
  }

  scene() {
    return this.motion.scene(this.settings, this.steps);
  }
}
