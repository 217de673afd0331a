// What was done, in steps and not in seconds: so that the command, and the page itself, plays it to the same positions.

/** Offsets to a millionth of a millimetre: short to write, and what is written is what was done. */
const rounded = (offset) => offset.map((x) => Math.round(x * 1e6) / 1e6);

/** A node that is held from the step `start` on, until before the step `end`; at offsets from where it rests. */
class Hold {
  constructor(node, start) {
    this.node = node;
    this.start = start;
    this.end = Infinity;
    this.path = [];  // [step, x, y, z]; linear in between
  }

  /** For every step, one after the other. */
  add(step, offset) {
    const [last, before] = [this.path[this.path.length - 1], this.path[this.path.length - 2]];
    const same = (point) => point && offset.every((x, i) => x === point[i + 1]);
    if (same(last) && same(before)) {
      last[0] = step;
      return;
    }
    this.path.push([step, ...offset]);
  }

  /** At a step; as the command computes it. */
  offset(step, step_s) {
    let next = 0;
    while (next < this.path.length && this.path[next][0] <= step) ++next;
    if (next === 0 || next === this.path.length) return this.path[next === 0 ? 0 : next - 1].slice(1);
    const [from, to] = [this.path[next - 1], this.path[next]];
    const part = (step * step_s - from[0] * step_s) / (to[0] * step_s - from[0] * step_s);
    return [1, 2, 3].map((i) => from[i] + part * (to[i] - from[i]));
  }
}

class Motion {
  constructor() {
    this.holds = [];
  }

  /** Starts to hold a node. */
  hold(node, step) {
    const hold = new Hold(node, step);
    this.holds.push(hold);
    return hold;
  }

  /** Ends before `step`; a hold without a step is forgotten. */
  end(hold, step) {
    hold.end = step;
    if (hold.end <= hold.start) this.holds.splice(this.holds.indexOf(hold), 1);
  }

  /** The last step at which something that is done changes. */
  length() {
    const ends = this.holds.map((hold) => (hold.end < Infinity ? hold.end : hold.path.length ? hold.path[hold.path.length - 1][0] : 0));
    return Math.max(0, ...ends);
  }

  /** For vmesh deform --script, until after `steps`. */
  scene(settings, steps) {
    const { material, step_s, iterations, gravity_m_s2, drag_per_s, squeeze_response_s, fix, clamp } = settings;
    const shown = this.holds.filter((hold) => hold.path.length > 0 && hold.path[0][0] <= steps);
    // Times between steps, so that rounding decides nothing.
    const drags = shown.map((hold) => ({
      node: hold.node, start_s: (hold.start - 0.5) * step_s,
      path: hold.path.map(([step, ...offset]) => [step * step_s, ...offset]),
      ...(hold.end <= steps ? { release_s: (hold.end - 0.5) * step_s } : {}),
    }));
    return { schema: "vmesh.scene/1", material, step_s, iterations, drag_per_s, squeeze_response_s,
      duration_s: steps * step_s, frame_every: Math.max(1, Math.round(1 / (30 * step_s))), gravity_m_s2, fix, clamp,
      drag: drags };
  }
}
