"use strict";
// The tree and its surface in WebAssembly: what libvmesh/wasm/deform/exports.cpp offers, with arrays for pointers. Places
// are a segment and a parameter along it, of the tree before all cuts.

class Deformer {
  /** `tree`: positions, radii, ends of segments. `surface`: positions, normals, corners, segment and t of vertices. */
  constructor(module, tree, surface, settings) {
    this.module = module;
    this.memory = [];
    this.settings = this.kept(this.listed(settings));
    this.pointer = module._vmesh_deform_create(tree.radii.length, this.kept(tree.positions), this.kept(tree.radii),
      tree.ends.length / 2, this.kept(tree.ends), surface.t.length, this.kept(surface.positions), this.kept(surface.normals),
      this.kept(surface.segment), this.kept(surface.t), surface.corners.length / 3, this.kept(surface.corners), this.settings);
    this.require(this.pointer);
    for (const address of this.memory.slice(1)) module._free(address);
    this.origin = this.numbers(Float64Array, module._vmesh_deform_origin(this.pointer), 3).slice();
    this.shape = 0;  // another one when the surface has other vertices
    this.isWhole = true;
    this.count();
  }

  require(good) {
    if (!good) throw new Error(this.module.UTF8ToString(this.module._vmesh_deform_error()));
    return good;
  }

  /** A copy of an array that C++ can read. */
  kept(array) {
    const address = this.module._malloc(array.byteLength);
    if (!address) throw new Error("there is not enough memory for this tree");
    new Uint8Array(this.module.HEAPU8.buffer).set(new Uint8Array(array.buffer, array.byteOffset, array.byteLength), address);
    this.memory.push(address);
    return address;
  }

  /** A view of memory, valid until the next call. */
  numbers(Kind, address, count) {
    return new Kind(this.module.HEAPU8.buffer, this.require(address), count);
  }

  /** What `act` does with copies of numbers. */
  lent(numbers, act) {
    const address = this.kept(Float64Array.from(numbers));
    try {
      return act(address);
    } finally {
      this.module._free(address);
      this.memory.pop();
    }
  }

  count() {
    this.nodeCount = this.module._vmesh_deform_node_count(this.pointer);
    this.vertexCount = this.module._vmesh_deform_vertex_count(this.pointer);
    ++this.shape;
  }

  /** In the order of Settings in exports.cpp. */
  listed({ material: m, step_s, iterations, gravity_m_s2, drag_per_s, squeeze_response_s }) {
    return Float64Array.of(m.young_Pa, m.density_kg_m3, m.poisson_ratio, m.wall_mm || 0, m.wall_ratio || 1, m.damping_s,
      step_s, iterations, ...gravity_m_s2.map((g) => 1e3 * g), drag_per_s, squeeze_response_s);
  }

  /** Back to rest and whole, with these settings; nothing is held. */
  restart(settings) {
    new Float64Array(this.module.HEAPU8.buffer, this.settings, 13).set(this.listed(settings));
    this.require(this.module._vmesh_deform_restart(this.pointer, this.settings));
    if (!this.isWhole) this.count();
    this.isWhole = true;
  }

  fix(node) {
    this.require(this.module._vmesh_deform_fix(this.pointer, node));
  }

  clamp(node) {
    this.require(this.module._vmesh_deform_clamp(this.pointer, node));
  }

  release(node) {
    this.require(this.module._vmesh_deform_release(this.pointer, node));
  }

  drag(node, [x, y, z]) {
    this.require(this.module._vmesh_deform_drag(this.pointer, node, x, y, z));
  }

  contact({ self, gap_ratio, friction, iterations, slip_radii_per_s }) {
    this.require(this.module._vmesh_deform_contact(this.pointer, self ? 1 : 0, gap_ratio, friction, iterations, slip_radii_per_s));
  }

  tissue({ stiffness_N_mm2, tear_N_mm }) {
    this.require(this.module._vmesh_deform_tissue(this.pointer, stiffness_N_mm2, tear_N_mm === null ? Infinity : tear_N_mm));
  }

  torn() {
    return this.module._vmesh_deform_torn(this.pointer);
  }

  /** The gap around an instrument, a chain of points of one radius. */
  room({ points, radius }, [x, y, z]) {
    return this.lent(points.flat(), (at) => this.module._vmesh_deform_room(this.pointer, points.length, at, radius, x, y, z));
  }

  /** Its number. */
  enter({ points, radius }, [x, y, z]) {
    return this.lent(points.flat(), (at) =>
      this.require(this.module._vmesh_deform_enter(this.pointer, points.length, at, radius, x, y, z)));
  }

  guide(number, [x, y, z]) {
    this.require(this.module._vmesh_deform_guide(this.pointer, number, x, y, z));
  }

  leave(number) {
    this.require(this.module._vmesh_deform_leave(this.pointer, number));
  }

  instrument(number) {
    return [...this.numbers(Float64Array, this.module._vmesh_deform_instrument(this.pointer, number), 3)];
  }

  instrument_N(number) {
    return this.module._vmesh_deform_instrument_N(this.pointer, number);
  }

  /** Closes jaws; their number. */
  grasp(segment, t, slips_N) {
    return this.require(this.module._vmesh_deform_grasp(this.pointer, segment, t, slips_N));
  }

  moveJaw(number, [x, y, z]) {
    this.require(this.module._vmesh_deform_move_jaw(this.pointer, number, x, y, z));
  }

  openJaw(number) {
    this.require(this.module._vmesh_deform_open_jaw(this.pointer, number));
  }

  jaw(number) {
    return [...this.numbers(Float64Array, this.module._vmesh_deform_jaw(this.pointer, number), 3)];
  }

  jaw_N(number) {
    return this.module._vmesh_deform_jaw_N(this.pointer, number);
  }

  jawHolds(number) {
    return this.module._vmesh_deform_jaw_holds(this.pointer, number) !== 0;
  }

  cut(segment, t) {
    this.require(this.module._vmesh_deform_cut(this.pointer, segment, t));
    this.isWhole = false;
    this.count();
  }

  /** The nodes of a place's segment, the nearer one first. */
  nodesNear(segment, t) {
    return [0, 1].map((other) => this.module._vmesh_deform_node_near(this.pointer, segment, t, other));
  }

  /** The number of nodes that move. */
  step() {
    return this.module._vmesh_deform_step(this.pointer);
  }

  /** Moves the surface to where the tree is. */
  follow() {
    this.require(this.module._vmesh_deform_follow(this.pointer));
  }

  /** The force on what holds a node. */
  pull_N(node) {
    return this.module._vmesh_deform_pull_N(this.pointer, node);
  }

  elastic_J() {
    return this.module._vmesh_deform_elastic_J(this.pointer);
  }

  /** Three numbers a vertex, relative to the origin. Views of memory, as all that follow. */
  positions() {
    return this.numbers(Float32Array, this.module._vmesh_deform_positions(this.pointer), 3 * this.vertexCount);
  }

  normals() {
    return this.numbers(Float32Array, this.module._vmesh_deform_normals(this.pointer), 3 * this.vertexCount);
  }

  /** Three vertices a face. */
  corners() {
    return this.numbers(Uint32Array, this.module._vmesh_deform_corners(this.pointer),
      3 * this.module._vmesh_deform_face_count(this.pointer));
  }

  /** Of every vertex. */
  places() {
    return { segment: this.numbers(Uint32Array, this.module._vmesh_deform_place_segments(this.pointer), this.vertexCount),
      t: this.numbers(Float64Array, this.module._vmesh_deform_place_parameters(this.pointer), this.vertexCount) };
  }

  /** Three numbers a node, in mm. */
  nodes() {
    return this.numbers(Float64Array, this.module._vmesh_deform_nodes(this.pointer), 3 * this.nodeCount);
  }
}
