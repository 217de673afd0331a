// A motion: frames are displacements of the vertices and nodes from the previous frame.

class Player {
  constructor(json, view, centerline, origin, show) {
    this.times = json.time_s;
    this.view = view;
    this.centerline = centerline;
    this.show = show;
    this.frame = 0;
    this.playing = false;
    const { surface } = view;
    const count = 3 * (surface.vertices + (centerline ? centerline.nodes : 0));
    let places = new Int32Array(count);
    this.positions = json.moves.map((packed) => {
      const moves = unpack(packed, count, 3);
      places = places.map((place, i) => place + moves[i]);
      return positionsOf(places, surface.low, surface.step, origin);
    });
    this.displacement = surface.attributes.find((attribute) => attribute.name === "displacement");
    if (this.displacement) this.follow(this.displacement, surface.vertices);
  }

  /** The attribute displacement is that of the frame shown, with the range of all frames. */
  follow(attribute, vertices) {
    const at = (frame, v) => {
      const rest = this.positions[0];
      const now = this.positions[frame];
      const i = 3 * v;
      return Math.hypot(now[i] - rest[i], now[i + 1] - rest[i + 1], now[i + 2] - rest[i + 2]);
    };
    let high = 0;
    for (let frame = 0; frame < this.positions.length; ++frame) {
      for (let v = 0; v < vertices; ++v) high = Math.max(high, at(frame, v));
    }
    Object.assign(attribute, { low: 0, high });
    attribute.digits = 3;
    attribute.value = (v) => at(this.frame, v);
  }

  go(frame) {
    const count = this.positions.length;
    this.frame = ((Math.round(frame) % count) + count) % count;
    const now = this.positions[this.frame];
    const { positions } = this.view.surface;
    positions.set(now.subarray(0, positions.length));
    if (this.centerline) this.centerline.positions.set(now.subarray(positions.length));
    this.view.update();
    this.show(this);
  }

  stopAt(frame) {
    this.playing = false;
    this.go(frame);
  }

  play(on) {
    this.playing = on;
    this.show(this);
    if (!on) return;
    const last = this.times[this.times.length - 1] || 1;
    const begin = performance.now() - 1000 * (this.frame + 1 < this.times.length ? this.times[this.frame] : 0);
    const tick = (now) => {
      if (!this.playing) return;
      const time = Math.max(0, (now - begin) / 1000) % (last + 0.4);  // pauses at the end
      let frame = this.times.length - 1;
      while (frame > 0 && this.times[frame] > time) --frame;
      if (frame !== this.frame) this.go(frame);
      requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }
}
