// What was done, in steps and not in seconds: so that the command, and the page itself, plays it to the same positions.

/** Millimetres to a millionth: short to write, and what is written is what was done. */
const rounded = (point) => point.map((x) => Math.round(x * 1e6) / 1e6);

/** Something that acts from the step `start` on, until before the step `end`, along a path of points. */
class Hold {
  constructor(start) {
    this.start = start;
    this.end = Infinity;
    this.path = [];  // [step, x, y, z]; linear in between
  }

  /** For every step, one after the other. */
  add(step, point) {
    const [last, before] = [this.path[this.path.length - 1], this.path[this.path.length - 2]];
    const same = (other) => other && point.every((x, i) => x === other[i + 1]);
    if (same(last) && same(before)) {
      last[0] = step;
      return;
    }
    this.path.push([step, ...point]);
  }

  /** At a step; as the command computes it. */
  at(step, step_s) {
    let next = 0;
    while (next < this.path.length && this.path[next][0] <= step) ++next;
    if (next === 0 || next === this.path.length) return this.path[next === 0 ? 0 : next - 1].slice(1);
    const [from, to] = [this.path[next - 1], this.path[next]];
    const part = (step * step_s - from[0] * step_s) / (to[0] * step_s - from[0] * step_s);
    return [1, 2, 3].map((i) => from[i] + part * (to[i] - from[i]));
  }

  /** The last step at which it changes something. */
  last() {
    return this.end < Infinity ? this.end : this.path.length ? this.path[this.path.length - 1][0] : 0;
  }
}

/** A node that is held at offsets from where it rests. */
class Drag extends Hold {
  constructor(node, start) {
    super(start);
    this.node = node;
  }
}

/** Jaws on a place of a segment, at offsets from where they closed. */
class Grasp extends Hold {
  constructor(segment, t, slips_N, start) {
    super(start);
    Object.assign(this, { segment, t, slips_N });
  }
}

/** An instrument: points of one radius around where it is. */
class Probe extends Hold {
  constructor(points, radius, start) {
    super(start);
    Object.assign(this, { points, radius });
  }
}

class Motion {
  constructor() {
    this.holds = [];
    this.grasps = [];
    this.probes = [];
    this.cuts = [];  // { step, segment, t }: after that step
  }

  get all() {
    return [...this.holds, ...this.grasps, ...this.probes];
  }

  get empty() {
    return this.all.length === 0 && this.cuts.length === 0;
  }

  /** Starts to hold a node. */
  hold(node, step) {
    const hold = new Drag(node, step);
    this.holds.push(hold);
    return hold;
  }

  /** Ends before `step`; a hold without a step is forgotten. */
  end(hold, step) {
    hold.end = step;
    if (hold.end <= hold.start) this.forget(hold);
  }

  forget(hold) {
    for (const list of [this.holds, this.grasps, this.probes])
      if (list.includes(hold)) list.splice(list.indexOf(hold), 1);
  }

  /** The last step at which something that is done changes. */
  length() {
    return Math.max(0, ...this.all.map((hold) => hold.last()), ...this.cuts.map((cut) => cut.step));
  }

  /** For vmesh deform --script, until after `steps`. */
  scene(settings, steps) {
    const { material, step_s, iterations, gravity_m_s2, drag_per_s, squeeze_response_s, fix, clamp, contact, tissue } = settings;
    const shown = (holds) => holds.filter((hold) => hold.path.length > 0 && hold.path[0][0] <= steps);
    // Times between steps, so that rounding decides nothing.
    const before = (step) => Math.max(0, (step - 0.5) * step_s);
    const path = (hold) => hold.path.map(([step, ...point]) => [step * step_s, ...point]);
    const over = (hold, begin, end) => ({ [begin]: before(hold.start), ...(hold.end <= steps ? { [end]: before(hold.end) } : {}) });
    const lists = {
      drag: shown(this.holds).map((hold) => ({ node: hold.node, ...over(hold, "start_s", "release_s"), path: path(hold) })),
      instruments: shown(this.probes).map((probe, i) => ({ name: `probe ${i + 1}`, points_mm: probe.points,
        radius_mm: probe.radius, ...over(probe, "enter_s", "leave_s"), path: path(probe) })),
      grasp: shown(this.grasps).map((grasp, i) => ({ name: `jaws ${i + 1}`, segment: grasp.segment, parameter: grasp.t,
        ...(grasp.slips_N < Infinity ? { slips_N: grasp.slips_N } : {}), ...over(grasp, "close_s", "release_s"),
        path: path(grasp) })),
      tissue: tissue ? [{ stiffness_N_mm2: tissue.stiffness_N_mm2,
        ...(tissue.tear_N_mm === null ? {} : { tear_N_mm: tissue.tear_N_mm }) }] : [],
      cut: this.cuts.filter((cut) => cut.step <= steps)
        .map(({ step, segment, t }) => ({ time_s: before(step), segment, parameter: t })),
    };
    return { schema: "vmesh.scene/1", material, step_s, iterations, drag_per_s, squeeze_response_s,
      duration_s: steps * step_s, frame_every: Math.max(1, Math.round(1 / (30 * step_s))), gravity_m_s2, fix, clamp,
      ...(contact ? { contact } : {}),
      ...Object.fromEntries(Object.entries(lists).filter(([name, list]) => name === "drag" || list.length > 0)) };
  }
}
