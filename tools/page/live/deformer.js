"use strict";
// The tree and its surface in WebAssembly: what libvmesh/wasm/deform/exports.cpp offers, with arrays for pointers.

/** Numbers of a base64 text that holds them as in memory. */
function numbersOf(text, Kind) {
  const characters = atob(text);
  const bytes = new Uint8Array(characters.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = characters.charCodeAt(i);
  return new Kind(bytes.buffer);
}

class Deformer {
  /** `tree`: positions, radii, ends of segments. `surface`: positions, normals, and segment and t of every vertex. */
  constructor(module, tree, surface, settings) {
    this.module = module;
    this.nodeCount = tree.radii.length;
    this.vertexCount = surface.t.length;
    this.memory = [];
    this.settings = this.kept(this.listed(settings));
    this.pointer = module._vmesh_deform_create(this.nodeCount, this.kept(tree.positions), this.kept(tree.radii),
      tree.ends.length / 2, this.kept(tree.ends), this.settings);
    this.require(this.pointer);
    this.require(module._vmesh_deform_bind(this.pointer, this.vertexCount, this.kept(surface.positions),
      this.kept(surface.normals), this.kept(surface.segment), this.kept(surface.t)));
    for (const address of this.memory.slice(1)) module._free(address);
    this.origin = new Float64Array(module.HEAPU8.buffer, module._vmesh_deform_origin(this.pointer), 3).slice();
  }

  require(good) {
    if (!good) throw new Error(this.module.UTF8ToString(this.module._vmesh_deform_error()));
  }

  /** A copy of an array that C++ can read. */
  kept(array) {
    const address = this.module._malloc(array.byteLength);
    if (!address) throw new Error("there is not enough memory for this tree");
    new Uint8Array(this.module.HEAPU8.buffer).set(new Uint8Array(array.buffer, array.byteOffset, array.byteLength), address);
    this.memory.push(address);
    return address;
  }

  /** In the order of Settings in exports.cpp. */
  listed({ material: m, step_s, iterations, gravity_m_s2, drag_per_s, squeeze_response_s }) {
    return Float64Array.of(m.young_Pa, m.density_kg_m3, m.poisson_ratio, m.wall_mm || 0, m.wall_ratio || 1, m.damping_s,
      step_s, iterations, ...gravity_m_s2.map((g) => 1e3 * g), drag_per_s, squeeze_response_s);
  }

  /** Back to rest with these settings; nothing is held. */
  restart(settings) {
    new Float64Array(this.module.HEAPU8.buffer, this.settings, 13).set(this.listed(settings));
    this.require(this.module._vmesh_deform_restart(this.pointer, this.settings));
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

  /** Views of memory, valid until the next call: three numbers a vertex, relative to the origin. */
  positions() {
    return new Float32Array(this.module.HEAPU8.buffer, this.module._vmesh_deform_positions(this.pointer), 3 * this.vertexCount);
  }

  normals() {
    return new Float32Array(this.module.HEAPU8.buffer, this.module._vmesh_deform_normals(this.pointer), 3 * this.vertexCount);
  }

  /** Three numbers a node, in mm. */
  nodes() {
    return new Float64Array(this.module.HEAPU8.buffer, this.module._vmesh_deform_nodes(this.pointer), 3 * this.nodeCount);
  }
}
