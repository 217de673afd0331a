// The package in Node: node --test package_test.mjs, with VMESH_COMMAND for what its surfaces are compared with.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import test from "node:test";
import { fileURLToPath } from "node:url";

const project = path.resolve(path.dirname(fileURLToPath(import.meta.url)), "../..");
const { loadVmesh, VmeshError } = await import(`${project}/build/wasm/npm/vmesh.js`);
const vmesh = await loadVmesh();
const tree = `${project}/examples/small_tree.swc`;
const command = process.env.VMESH_COMMAND;
const shared = process.env.VMESH_SHARED_DATA || "";

const read = (file, options) => vmesh.read({ name: path.basename(file), bytes: readFileSync(file) }, options);

/** Header of a PLY file, and the columns of its elements as bytes: by "vertex.x". */
function columnsOf(bytes) {
  const end = bytes.indexOf("end_header\n") + 11;
  const sizes = { double: 8, float: 4, int: 4, uchar: 1 };
  const columns = {};
  let at = end;
  let element = null;
  const elements = [];
  for (const line of bytes.subarray(0, end).toString().split("\n")) {
    const words = line.split(" ");
    if (words[0] === "element") elements.push(element = { name: words[1], count: Number(words[2]), properties: [] });
    if (words[0] === "property")
      element.properties.push(words[1] === "list" ? { name: words[4], size: 13 } : { name: words[2], size: sizes[words[1]] });
  }
  for (const { name, count, properties } of elements) {
    const stride = properties.reduce((sum, p) => sum + p.size, 0);
    let offset = 0;
    for (const p of properties) {
      const column = Buffer.alloc(count * p.size);
      for (let i = 0; i < count; ++i) bytes.copy(column, i * p.size, at + i * stride + offset, at + i * stride + offset + p.size);
      columns[`${name}.${p.name}`] = column;
      offset += p.size;
    }
    at += count * stride;
  }
  return columns;
}

/** What the command writes. */
function native(file, ...options) {
  const folder = mkdtempSync(path.join(tmpdir(), "vmesh-wasm-"));
  try {
    execFileSync(command, ["generate", file, "-o", `${folder}/surface.ply`, ...options], { stdio: "ignore" });
    return readFileSync(`${folder}/surface.ply`);
  } finally {
    rmSync(folder, { recursive: true });
  }
}

function meshOf(ply) {
  const columns = columnsOf(ply);
  const count = columns["vertex.x"].length / 8;
  const corners = columns["face.vertex_indices"];
  const vertices = new Float64Array(3 * count);
  for (let v = 0; v < count; ++v)
    ["x", "y", "z"].forEach((axis, k) => { vertices[3 * v + k] = columns[`vertex.${axis}`].readDoubleLE(8 * v); });
  const faces = new Uint32Array(corners.length / 13 * 3);
  for (let i = 0; i < faces.length; ++i) faces[i] = corners.readInt32LE(13 * Math.floor(i / 3) + 1 + 4 * (i % 3));
  return { vertices, faces, columns };
}

// Triangles are the same. Positions may differ in what comes of the last bits of logarithms (README.md of libvmesh/wasm):
// far below the grid of 1e-6 mm that cleaning puts nodes on.
function assertIsTheCommands(file, options, flags) {
  const what = `${path.basename(file)} ${flags.join(" ")}`;
  const surface = vmesh.generate(read(file), options);
  const own = meshOf(Buffer.from(surface.write("ply")));
  const others = meshOf(native(file, ...flags));
  assert.ok(surface.sound);
  assert.deepEqual(own.faces, others.faces, `${what}: other triangles`);
  const off = own.vertices.reduce((most, x, i) => Math.max(most, Math.abs(x - others.vertices[i])), 0);
  assert.ok(off < 1e-6, `${what}: ${off} mm from the command's vertices`);
  for (const name of Object.keys(own.columns)) assert.ok(others.columns[name], `the command writes no ${name}`);
  surface.free();
}

test("Surfaces are the command's", { skip: !command && "SKIPPED: VMESH_COMMAND is not set" }, () => {
  assertIsTheCommands(tree, {}, []);
  assertIsTheCommands(tree, { around: 11, blend: 1.1 }, ["--around", "11", "--blend", "1.1"]);
  assertIsTheCommands(tree, { maxError: "5%" }, ["--max-error", "5%"]);
  assertIsTheCommands(tree, { elongation: 4 }, ["--elongation", "4"]);
  assertIsTheCommands(tree, { ends: "flat", flowExtension: 3 }, ["--ends", "flat", "--flow-extensions", "3"]);
});

const large = `${shared}/synthetic_trees/tree1560.swc`;
const portal = `${shared}/liver_portal_centerlines/liverModelPatient1__portal1_1.vtp`;
test("Surfaces of larger trees are, too",
  { skip: (!command || !existsSync(large) || !existsSync(portal)) && "SKIPPED: no VMESH_COMMAND or no shared data" }, () => {
    assertIsTheCommands(large, {}, []);
    assertIsTheCommands(portal, {}, []);
    assertIsTheCommands(portal, { around: 8, elongation: 3 }, ["--around", "8", "--elongation", "3"]);
  });

test("Surfaces have the same bytes each time", () => {
  const bytes = () => Buffer.from(vmesh.generate(read(tree), { around: 7 }).write("ply"));
  assert.ok(bytes().equals(bytes()));
});

test("Arrays describe the surface that files hold", () => {
  const surface = vmesh.generate(read(tree));
  const [vertices, faces] = [surface.vertexArray(), surface.faceArray()];
  assert.equal(vertices.length, 3 * surface.vertices);
  assert.equal(faces.length, 3 * surface.faces);
  assert.equal(surface.vertices - surface.faces / 2, 2);  // Euler's formula for a sphere
  assert.ok(surface.sound && surface.defects.length === 0);
  const radius = surface.attribute("radius");
  assert.equal(radius.length, surface.vertices);
  assert.ok(radius.every((r) => r > 0));
  const x = columnsOf(Buffer.from(surface.write("ply")))["vertex.x"];
  for (let v = 0; v < surface.vertices; ++v) assert.equal(x.readDoubleLE(8 * v), vertices[3 * v]);
  assert.throws(() => surface.attribute("colour"), /there are radius/);
});

test("Each format is what its name says", () => {
  const surface = vmesh.generate(read(tree));
  const text = (extension) => Buffer.from(surface.write(extension)).toString("latin1");
  assert.ok(text("ply").startsWith("ply\nformat binary_little_endian"));
  assert.equal(text("stl").length, 84 + 50 * surface.faces);
  assert.ok(text("glb").startsWith("glTF"));
  assert.equal(text("obj").match(/^f /gm).length, surface.faces);
  assert.ok(text("vtp").startsWith("<?xml") || text("vtp").includes("<VTKFile"));
  assert.throws(() => surface.write("doc"), { name: "Unsupported" });
});

test("Centerlines come from all formats of the page", () => {
  const swc = read(tree);
  assert.equal(swc.nodes, 12);
  const json = JSON.stringify({ nodes: [[0, 0, 0], [10, 0, 0]] });
  assert.throws(() => vmesh.read({ name: "tree.json", bytes: json }), VmeshError);
  const nodes = "id,x,y,z,radius\n1,0,0,0,1\n2,10,0,0,1\n";
  const pair = [{ name: "t.csv", bytes: nodes }, { name: "t.segments.csv", bytes: "a,b\n1,2\n" }];
  const csv = vmesh.read(pair, { unit: "mm", space: "LPS" });
  assert.deepEqual([csv.nodes, csv.segments], [2, 1]);
  assert.deepEqual([...csv.nodeArray()], [0, 0, 0, 1, 10, 0, 0, 1]);
  assert.deepEqual([...csv.segmentArray()], [0, 1]);
});

test("Numbers are read and written like everywhere else", () => {
  const numbers = [0.1, 1e-7, 123456.789, 5e-324, 1 / 3, 1e22, -0.30000000000000004];
  const rows = numbers.map((x, i) => `${i + 1},${x},${10 * i},0,1`).join("\n");
  const segments = numbers.slice(1).map((_, i) => `${i + 1},${i + 2}`).join("\n");
  const files = [{ name: "n.csv", bytes: `id,x,y,z,radius\n${rows.replace(/1e\+22/, "1e5")}\n` },
    { name: "n.segments.csv", bytes: `a,b\n${segments}\n` }];
  const nodes = vmesh.read(files, { unit: "mm", space: "LPS" }).nodeArray();
  // Cleaning rounds to a grid of 1e-6 mm, and renumbers.
  const near = (x) => [...nodes].some((y) => Math.abs(x - y) <= 5e-7);
  for (const x of numbers.filter((x) => x < 1e20)) assert.ok(near(x), `${x}`);
});

test("What is wrong is said with file and line", () => {
  assert.throws(() => vmesh.read({ name: "bad.swc", bytes: "1 1 0 0 zero 1 -1\n" }),
    (error) => error instanceof VmeshError && error.name === "InvalidInput" && /bad\.swc.*line 1/s.test(error.message));
  assert.throws(() => vmesh.read({ name: "tree.doc", bytes: "x" }), { name: "Unsupported" });
  const centerline = read(tree);
  assert.throws(() => vmesh.generate(centerline, { arround: 6 }), /no option "arround"/);
  assert.throws(() => vmesh.generate(centerline, { around: 6.5 }), /around must be a whole number/);
  assert.throws(() => vmesh.generate(centerline, { around: 2 }), { name: "InvalidInput" });
});

test("Progress is told, cancels, and hands on what it throws", () => {
  const centerline = read(tree);
  const stages = new Set();
  vmesh.generate(centerline, {}, (stage, fraction) => {
    stages.add(stage);
    assert.ok(fraction >= 0 && fraction <= 1);
  });
  assert.ok(stages.size > 0);
  assert.throws(() => vmesh.generate(centerline, {}, () => false), { name: "Cancelled" });
  assert.throws(() => vmesh.generate(centerline, {}, () => { throw new TypeError("mine"); }), { name: "TypeError" });
  assert.ok(vmesh.generate(centerline).sound);
});

test("Types are declared for everything that is exported", () => {
  const declared = readFileSync(`${project}/build/wasm/npm/vmesh.d.ts`, "utf8");
  for (const Class of [vmesh.constructor, read(tree).constructor, vmesh.generate(read(tree)).constructor]) {
    for (const name of Object.getOwnPropertyNames(Class.prototype)) {
      if (name.startsWith("_") || name === "constructor") continue;
      assert.ok(new RegExp(`^  ${name}\\(`, "m").test(declared), `${Class.name}.${name}`);
    }
  }
});
