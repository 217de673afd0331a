// node --test live_stage_test.mjs: what the page of `vmesh deform --live` computes, in Node, beside what the command makes
// of the scene that it saves. VMESH_COMMAND names the command.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import vm from "node:vm";

const folder = mkdtempSync(join(tmpdir(), "vmesh-live-"));
const vmesh = (...words) => execFileSync(process.env.VMESH_COMMAND, [...words, "-q"], { cwd: folder });

/** Numbers without sign, so that a failure tells which. */
const farthest = (a, b) => a.reduce((most, x, i) => Math.max(most, Math.abs(x - b[i])), 0);

/** The scripts of a page but for three.js and what needs a document, and its data. */
async function open(page) {
  const html = readFileSync(join(folder, page), "utf8");
  const scripts = [...html.matchAll(/<script>\n([^]*?)<\/script>/g)].map((match) => match[1]);
  assert.equal(scripts.length, 3);
  const [, deformer, ours] = scripts;
  const data = JSON.parse(html.match(/<script type="application\/json" id="page-data">([^]*?)<\/script>/)[1]);
  const context = vm.createContext({ console, process, WebAssembly, require: createRequire(import.meta.url), atob, __dirname: folder,
    __filename: join(folder, "page.js"), TextDecoder, Buffer, performance, setTimeout });
  // Before what draws.
  vm.runInContext(`${deformer}\n${ours.slice(0, ours.indexOf("// The picture:"))}
    globalThis.parts = { createDeformer, Stage, numbersOf };`, context);
  const { createDeformer, Stage, numbersOf } = context.parts;
  const numbers = (name, kind) => numbersOf(data[name], vm.runInContext(kind, context));
  const tree = { positions: numbers("node_positions", "Float64Array"), radii: numbers("radii", "Float64Array"),
    ends: numbers("ends", "Uint32Array") };
  const surface = { positions: numbers("positions", "Float64Array"), normals: numbers("normals", "Float64Array"),
    segment: numbers("place_segments", "Uint32Array"), t: numbers("place_parameters", "Float64Array") };
  return { tree, surface, data, stage: new Stage(await createDeformer(), tree, surface, data.settings) };
}

/** Positions of the surface as the page has them, in mm. */
function shown(stage) {
  stage.deformer.follow();
  return Array.from(stage.deformer.positions(), (x, i) => x + stage.deformer.origin[i % 3]);
}

/** Positions in a binary PLY whose vertices begin with six doubles, more numbers following. */
function positionsIn(ply) {
  const bytes = readFileSync(ply);
  const header = bytes.toString("latin1", 0, bytes.indexOf("end_header\n") + 11);
  const count = Number(header.match(/element vertex (\d+)/)[1]);
  const sizes = { double: 8, int: 4, uchar: 1 };
  const properties = [...header.split("element face")[0].matchAll(/property (\w+) \w+/g)].map((match) => sizes[match[1]]);
  const stride = properties.reduce((sum, size) => sum + size, 0);
  const positions = [];
  for (let v = 0; v < count; ++v)
    for (let i = 0; i < 3; ++i) positions.push(bytes.readDoubleLE(header.length + v * stride + 8 * i));
  return positions;
}

/** The positions at which the command ends when it plays what the page saved. */
function played(stage, name) {
  writeFileSync(join(folder, `${name}.json`), JSON.stringify(stage.scene()));
  vmesh("deform", "tree.json", "tree.ply", "--script", `${name}.json`, "-o", name, "--format", "ply");
  const last = readdirSync(join(folder, name)).filter((file) => file.endsWith(".ply")).sort().pop();
  return positionsIn(join(folder, name, last));
}

const run = (stage, steps, before = () => {}) => {
  for (let i = 0; i < steps; ++i) {
    before(i);
    stage.step();
  }
};

/** Leaves, farthest first: nodes of one segment. */
function leaves({ tree }) {
  const degree = new Map();
  for (const node of tree.ends) degree.set(node, (degree.get(node) || 0) + 1);
  return [...degree.keys()].filter((node) => degree.get(node) === 1).sort((a, b) => b - a);
}

/** Two leaves pulled about and let go, one twice; one pinned while it is bent, and freed. */
function pullAbout(stage, [a, b]) {
  const path = (i) => [4 * Math.sin(0.11 * i), 0.05 * i, -3 * Math.sin(0.05 * i)];
  stage.grab(a);
  run(stage, 40, (i) => stage.move(a, path(i)));
  stage.grab(b).pinned = true;
  run(stage, 15);
  stage.release(a);
  run(stage, 25);
  stage.release(b);
  stage.grab(a);
  run(stage, 30, (i) => i < 12 && stage.move(a, [0.2 * i, 0, 1]));
  stage.release(a);
  stage.grab(a);
  run(stage, 9, (i) => stage.move(a, [2, 0.3 * i, 0]));
  stage.release(a);
  run(stage, 2);  // still bent
}

before(() => {
  vmesh("synth", "--vertices", "119", "-o", "tree.json");
  vmesh("generate", "tree.json", "-o", "tree.ply");
  vmesh("deform", "tree.json", "tree.ply", "--live", "live.html");
});
after(() => rmSync(folder, { recursive: true }));

test("at rest the surface is the file's", async () => {
  const { stage } = await open("live.html");
  // Single precision, relative to a tree of some 100 mm.
  assert.ok(farthest(shown(stage), positionsIn(join(folder, "tree.ply"))) < 1e-4);
});

test("the command plays a saved scene to the page's numbers", async () => {
  const page = await open("live.html");
  pullAbout(page.stage, leaves(page));
  const positions = shown(page.stage);
  const moved = farthest(positions, positionsIn(join(folder, "tree.ply")));
  assert.ok(moved > 0.1, `something has moved, by ${moved} mm`);
  const distance = farthest(positions, played(page.stage, "about"));
  console.log(`farthest from the command's: ${distance} mm`);
  assert.ok(distance <= 1e-12, `${distance} mm`);
});

test("a replay ends where the motion did", async () => {
  const page = await open("live.html");
  pullAbout(page.stage, leaves(page));
  const [positions, steps] = [shown(page.stage), page.stage.steps];
  page.stage.replay();
  assert.ok(page.stage.playing);
  while (page.stage.playing) page.stage.step();
  assert.equal(page.stage.steps, steps);
  assert.deepEqual(shown(page.stage), positions);
});

test("hands go on after a replay, and the command follows", async () => {
  const page = await open("live.html");
  const [a, b] = leaves(page);
  page.stage.grab(b).pinned = true;
  pullAbout(page.stage, [a, leaves(page)[2]]);
  page.stage.replay();
  while (page.stage.playing) page.stage.step();
  page.stage.grab(a);
  run(page.stage, 20, (i) => page.stage.move(a, [0.1 * i, 0, 0]));
  page.stage.release(b);
  run(page.stage, 20);
  assert.ok(farthest(shown(page.stage), played(page.stage, "on")) <= 1e-12);
});

test("the same motion with other settings, and the command follows", async () => {
  const page = await open("live.html");
  pullAbout(page.stage, leaves(page));
  const before_ = shown(page.stage);
  page.stage.settings.material.young_Pa = 2e4;
  page.stage.settings.gravity_m_s2 = [0, 0, -9.8];
  page.stage.change();
  while (page.stage.playing) page.stage.step();
  run(page.stage, 30);
  const positions = shown(page.stage);
  assert.ok(farthest(positions, before_) > 0.01, "it is another motion");
  assert.ok(farthest(positions, played(page.stage, "softer")) <= 1e-12);
});

test("a tree at rest takes no steps, and a touch without movement leaves nothing", async () => {
  const page = await open("live.html");
  const [a] = leaves(page);
  run(page.stage, 30);
  const steps = page.stage.steps;
  assert.ok(steps < 30, `${steps} steps`);
  page.stage.grab(a);
  page.stage.release(a);
  assert.equal(page.stage.motion.holds.length, 0);
});

test("settings and held nodes are a scene's", async () => {
  writeFileSync(join(folder, "stiff.json"), JSON.stringify({ schema: "vmesh.scene/1", step_s: 0.01, iterations: 3,
    material: { young_Pa: 5e6, wall_mm: 0.3 }, drag_per_s: 2, clamp: [0], fix: [5] }));
  vmesh("deform", "tree.json", "tree.ply", "--live", "stiff.html", "--script", "stiff.json");
  const page = await open("stiff.html");
  assert.equal(page.data.settings.material.young_Pa, 5e6);
  pullAbout(page.stage, leaves(page));
  assert.ok(farthest(shown(page.stage), played(page.stage, "stiff")) <= 1e-12);
});
