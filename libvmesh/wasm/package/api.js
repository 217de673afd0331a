// vmesh for JavaScript: what the functions of bindings/exports.cpp are called by. `createModule` is emscripten's.

/** What is wrong and what to do; its name is InvalidInput, Unsupported, Cancelled, OutOfMemory or Error. */
class VmeshError extends Error {
  constructor({ kind, message }) {
    super(message);
    this.name = kind;
  }
}

/** Positions with radii and the segments between them, mm. */
class Centerline {
  constructor(vmesh, handle) {
    this._vmesh = vmesh;
    this._handle = handle;
    Object.assign(this, vmesh._json("vmesh_describe_centerline", handle));
  }

  /** Four numbers a node, a copy: position and radius, mm. */
  nodeArray() {
    return this._vmesh._copy(Float64Array, "vmesh_nodes", [this._handle], 4 * this.nodes);
  }

  /** Two node numbers a segment, a copy. */
  segmentArray() {
    return this._vmesh._copy(Uint32Array, "vmesh_segments", [this._handle], 2 * this.segments);
  }

  /** Gives its memory back. Surfaces around it stay. */
  free() {
    if (this._handle) this._vmesh._module._vmesh_free_centerline(this._handle);
    this._handle = 0;
  }
}

class Surface {
  constructor(vmesh, handle) {
    this._vmesh = vmesh;
    this._handle = handle;
    Object.assign(this, vmesh._json("vmesh_describe_surface", handle));
  }

  /** Three numbers a vertex, a copy, mm, LPS. */
  vertexArray() {
    return this._vmesh._copy(Float64Array, "vmesh_vertices", [this._handle], 3 * this.vertices);
  }

  /** Three vertex numbers a face, a copy. */
  faceArray() {
    return this._vmesh._copy(Uint32Array, "vmesh_faces", [this._handle], 3 * this.faces);
  }

  /** Values of all vertices, or else of all faces, a copy. */
  attribute(name) {
    const kinds = [["vmesh_vertex_attribute", this.vertexAttributes, this.vertices],
      ["vmesh_face_attribute", this.faceAttributes, this.faces]];
    for (const [call, list, count] of kinds) {
      const i = list.findIndex((a) => a.name === name);
      if (i >= 0) return this._vmesh._copy(Float64Array, call, [this._handle, i], count);
    }
    const known = [...this.vertexAttributes, ...this.faceAttributes].map((a) => a.name);
    throw new VmeshError({ kind: "InvalidInput", message: `there is no attribute "${name}"; there are ${known.join(", ")}` });
  }

  /** The bytes of a file: "ply", "stl", "glb", "obj", "vtp" or "off". */
  write(extension, options = {}) {
    const { FS } = this._vmesh._module;
    const path = `surface.${String(extension).replace(/^\./, "")}`;
    this._vmesh._call("vmesh_write", "number", [this._handle, path, JSON.stringify(options)]);
    const bytes = FS.readFile(path);
    FS.unlink(path);
    return bytes;
  }

  /** What vmesh's page shows of it, schema vmesh.page/1. */
  page() {
    return this._vmesh._json("vmesh_page", this._handle);
  }

  free() {
    if (this._handle) this._vmesh._module._vmesh_free_surface(this._handle);
    this._handle = 0;
  }
}

class Vmesh {
  constructor(module) {
    this._module = module;
    this.version = this._call("vmesh_version", "string", []);
    /** Extensions of files that are read and written. */
    this.formats = this._json("vmesh_formats");
  }

  /**
   * A centerline from a file, or from several that are its parts: [{ name, bytes }], by the extensions of their names.
   * Of a CSV pair, both.
   */
  read(files, options = {}) {
    const list = Array.isArray(files) ? files : [files];
    const { FS } = this._module;
    const folder = "/files";
    if (!FS.analyzePath(folder).exists) FS.mkdir(folder);
    FS.chdir(folder);
    const names = list.map(({ name, bytes }) => {
      const own = String(name).split(/[/\\]/).pop();
      FS.writeFile(own, typeof bytes === "string" ? bytes : new Uint8Array(bytes));
      return own;
    });
    const read = names.filter((name) => names.length === 1 || !/(\.segments|edges[^.]*)\.csv$/i.test(name));
    try {
      const request = JSON.stringify({ ...options, files: read });
      return new Centerline(this, this._call("vmesh_read", "number", [request]));
    } finally {
      for (const name of new Set(names)) FS.unlink(name);
      FS.chdir("/");
    }
  }

  /**
   * The surface around a centerline. `progress(stage, fraction)` is called now and then; returning false cancels. A
   * surface that is not sound is returned, too: see its `sound` and `defects`.
   */
  generate(centerline, options = {}, progress = null) {
    const given = { ...options };
    if (typeof given.maxError === "number") given.maxError = `${given.maxError}mm`;
    let thrown = null;
    this._module.report = progress && ((stage, fraction) => {
      try {
        return progress(stage, fraction) === false ? 0 : 1;
      } catch (error) {
        thrown = error;
        return 0;
      }
    });
    try {
      const handle = this._call("vmesh_generate", "number", [centerline._handle, JSON.stringify(given)]);
      return new Surface(this, handle);
    } catch (error) {
      throw thrown || error;
    } finally {
      this._module.report = null;
    }
  }

  _call(name, kind, values) {
    const kinds = values.map((value) => (typeof value === "string" ? "string" : "number"));
    const result = this._module.ccall(name, kind, kinds, values);
    if (!result) throw new VmeshError(JSON.parse(this._module.ccall("vmesh_error", "string", [], [])));
    return result;
  }

  _json(name, ...values) {
    return JSON.parse(this._call(name, "string", values));
  }

  _copy(Kind, name, values, count) {
    if (count === 0) return new Kind();
    const at = this._call(name, "number", values);
    return new Kind(this._module.HEAPU8.slice(at, at + count * Kind.BYTES_PER_ELEMENT).buffer);
  }
}

/** From the bytes of vmesh.wasm, or from what WebAssembly.compile() made of them. */
async function instantiate(wasm) {
  const compiled = wasm instanceof WebAssembly.Module ? wasm : await WebAssembly.compile(wasm);
  const module = await createModule({
    instantiateWasm(imports, receive) {
      WebAssembly.instantiate(compiled, imports).then((instance) => receive(instance, compiled));
      return {};
    },
  });
  return new Vmesh(module);
}
