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
  const scripts = [...html.matchAll(/<script(?: type="text\/plain" class="after-first")?>\n([^]*?)<\/script>/g)].map((match) => match[1]);
  assert.equal(scripts.length, 4);
  const [first, , deformer, ours] = scripts;
  const data = JSON.parse(html.match(/<script type="application\/json" id="page-data">([^]*?)<\/script>/)[1]);
  const context = vm.createContext({ console, process, WebAssembly, require: createRequire(import.meta.url), atob, __dirname: folder,
    __filename: join(folder, "page.js"), TextDecoder, Buffer, performance, setTimeout });
  // Before what draws.
  const before = (script, comment) => script.slice(0, script.indexOf(comment));
  vm.runInContext(`${before(first, "// The surface at rest before")}\n${deformer}\n${before(ours, "// The picture:")}
    globalThis.parts = { createDeformer, Stage, contentsOf };`, context);
  const { createDeformer, Stage, contentsOf } = context.parts;
  const { tree, surface } = contentsOf(data);
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

// Instruments, jaws, tissue and cuts. Their barriers take logarithms, of which C libraries differ in the last bit; what is
// asked for is a millionth of the least radius.
const leastRadius = ({ tree }) => Math.min(...tree.radii);

/** What the command makes of the scene is what the page has. */
function isPlayed(page, name) {
  const [here, there] = [shown(page.stage), played(page.stage, name)];
  assert.equal(here.length, there.length);
  const distance = farthest(here, there);
  console.log(`${name}: farthest from the command's: ${distance} mm`);
  assert.ok(distance <= 1e-6 * leastRadius(page), `${distance} mm`);
}

/** A replay ends in the same numbers. */
function isReplayed({ stage }) {
  const [positions, steps, scene] = [shown(stage), stage.steps, JSON.stringify(stage.scene())];
  stage.replay();
  while (stage.playing) stage.step();
  assert.equal(stage.steps, steps);
  assert.deepEqual(shown(stage), positions);
  assert.equal(JSON.stringify(stage.scene()), scene);
}

/** A leaf, its segment, the direction of the segment and one across, at rest. */
function twig(page, rank = 0) {
  const { positions, ends, radii } = page.tree, node = leaves(page)[rank];
  const segment = ends.indexOf(node) >> 1;
  const other = ends[2 * segment] === node ? ends[2 * segment + 1] : ends[2 * segment];
  const at = (n) => [0, 1, 2].map((i) => positions[3 * n + i]);
  const [tip, base] = [at(node), at(other)];
  const along = tip.map((x, i) => x - base[i]), length = Math.hypot(...along);
  const smallest = along.map(Math.abs).indexOf(Math.min(...along.map(Math.abs)));
  const axis = [0, 1, 2].map((i) => (i === smallest ? 1 : 0) - (along[smallest] * along[i]) / length ** 2);
  const across = axis.map((x) => x / Math.hypot(...axis));
  return { node, segment, tip, across, length, radius: radii[node], fromA: ends[2 * segment] === other };
}

const moved = (point, by, direction) => point.map((x, i) => x + by * direction[i]);

/** An instrument that comes beside the tip of a twig, pushes across it, and goes; it is aimed for `steps`. */
function pushAcross(page, { tip, across, radius }, { points = [[0, 0, 0]], steps = 60 } = {}) {
  const { stage } = page, size = 2 * radius;
  let from = 1.5 * (size + radius);
  while (!(stage.deformer.room({ points, radius: size }, moved(tip, from, across)) > 0.1)) from += radius;
  const probe = stage.push(points, size, moved(tip, from, across), 0.5 * size);
  let most = 0;
  run(stage, steps, (i) => {
    probe.aim = moved(tip, from - ((from + size) * i) / steps, across);
    stage.awake = true;
    most = Math.max(most, ...stage.acting().filter((hand) => hand.probe).map((hand) => hand.newton));
  });
  stage.finish(probe);
  return most;
}

test("an instrument pushes a vessel, feels it and leaves, and the command follows", async () => {
  const page = await open("live.html"), { stage } = page, one = twig(page);
  const rest = shown(stage);
  assert.ok(pushAcross(page, one) > 0, "there is a force on the instrument");
  const pushed = shown(stage);
  assert.ok(farthest(pushed, rest) > one.radius, "the vessel has given way");
  run(stage, 20);
  isPlayed(page, "pushed");
  const { instruments } = stage.scene();
  assert.equal(instruments.length, 1);
  assert.ok(instruments[0].leave_s > instruments[0].enter_s);
  isReplayed(page);
  run(stage, 3000);
  // At rest: less than 1e-7 of the radius a step.
  assert.ok(farthest(shown(stage), rest) < 1e-2 * farthest(pushed, rest), "the vessel has sprung back");
});

test("a rod pushes, and another instrument comes where the first one was", async () => {
  const page = await open("live.html"), { stage } = page, one = twig(page);
  assert.ok(pushAcross(page, one, { points: [[0, 0, 0], moved([0, 0, 0], 12 * one.radius, one.across)] }) > 0);
  pushAcross(page, twig(page, 1), { steps: 30 });
  run(stage, 5);
  assert.equal(stage.scene().instruments.length, 2);
  isPlayed(page, "rod");
  isReplayed(page);
});

test("jaws hold a place between nodes, and the command follows", async () => {
  const page = await open("live.html"), { stage } = page, { segment, across, length, tip, fromA } = twig(page);
  const grasp = stage.grasp(segment, fromA ? 0.7 : 0.3, Infinity);
  run(stage, 40, (i) => {
    grasp.offset = moved([0, 0, 0], (0.5 * length * i) / 40, across);
    stage.awake = true;
  });
  const [jaws] = stage.acting();
  assert.ok(jaws.newton > 0);
  assert.ok(!stage.held.size && farthest(jaws.position, tip) > 0.1, "it is not the node that is held");
  // Where jaws closed, 0.3 lengths before the tip, and on by their way.
  const along = tip.map((x, i) => x - base(page, segment, fromA)[i]);
  const place = moved(moved(tip, -0.3, along), (0.5 * length * 39) / 40, across);
  assert.ok(farthest(jaws.position, place) < 1e-5, `${jaws.position} ${place}`);
  stage.finish(grasp);
  run(stage, 10);
  assert.equal(stage.acting().length, 0);
  isPlayed(page, "grasped");
  isReplayed(page);
});

const base = ({ tree }, segment, fromA) => {
  const node = tree.ends[2 * segment + (fromA ? 0 : 1)];
  return [0, 1, 2].map((i) => tree.positions[3 * node + i]);
};

test("jaws slip above their grip", async () => {
  const page = await open("live.html"), { stage } = page, { segment, across } = twig(page);
  /** The strongest pull of jaws that move off, ever faster, and whether they have the vessel in the end. */
  const pull = (slips_N) => {
    const grasp = stage.grasp(segment, 0.5, slips_N);
    let most = 0;
    run(stage, 60, (i) => {
      grasp.offset = moved([0, 0, 0], 5e-4 * i * i, across);
      stage.awake = true;
      most = Math.max(most, ...stage.acting().map((hand) => hand.newton));
    });
    return { most, holds: stage.acting().length === 1 };
  };
  const firm = pull(Infinity);
  assert.ok(firm.holds && firm.most > 0);
  stage.forget();
  const weak = pull(firm.most / 2);
  assert.ok(weak.most > 0 && weak.most <= (1 + 1e-6) * firm.most / 2, `${weak.most} of ${firm.most} N`);
  assert.ok(!weak.holds, "they have lost it");
  isPlayed(page, "slipped");
});

test("tissue holds, tears, and the command follows", async () => {
  const page = await open("live.html"), { stage } = page, { node, across } = twig(page);
  const pull = (force) => {
    stage.settings.tissue = force;
    stage.change();
    while (stage.playing) stage.step();
    stage.grab(node);
    run(stage, 40, (i) => stage.move(node, moved([0, 0, 0], 0.1 * i, across)));
    const newton = stage.deformer.pull_N(node), torn = stage.deformer.torn();
    stage.forget();
    return { newton, torn };
  };
  const free = pull(null), firm = pull({ stiffness_N_mm2: 1e-3, tear_N_mm: null });
  assert.ok(firm.newton > 1.1 * free.newton, `${firm.newton} and ${free.newton} N`);
  assert.equal(firm.torn, 0);
  stage.settings.tissue = { stiffness_N_mm2: 1e-3, tear_N_mm: 5e-4 };
  stage.change();
  stage.grab(node);
  run(stage, 40, (i) => stage.move(node, moved([0, 0, 0], 0.1 * i, across)));
  assert.ok(stage.deformer.torn() > 0, "something tore");
  isPlayed(page, "torn");
  vmesh("deform", "tree.json", "tree.ply", "--script", "torn.json", "-o", "torn-again", "--json", "torn-summary.json");
  const summary = JSON.parse(readFileSync(join(folder, "torn-summary.json"), "utf8"));
  assert.equal(summary.torn_nodes, stage.deformer.torn());
  stage.release(node);
  run(stage, 5);
  isReplayed(page);
});

/** A segment in the middle of the tree, at some distance from branchings. */
function branchAway(page) {
  const { ends, positions, radii } = page.tree, degree = new Map();
  for (const node of ends) degree.set(node, (degree.get(node) || 0) + 1);
  const length = (s) => Math.hypot(...[0, 1, 2].map((i) => positions[3 * ends[2 * s] + i] - positions[3 * ends[2 * s + 1] + i]));
  const inner = [...Array(ends.length / 2).keys()].filter((s) => degree.get(ends[2 * s]) === 2 && degree.get(ends[2 * s + 1]) === 2);
  const score = (s) => length(s) / radii[ends[2 * s]];
  return inner.sort((a, b) => score(b) - score(a));
}

test("a cut parts the tree while it is pulled, ends can be grasped, and the command follows", async () => {
  const page = await open("live.html"), { stage } = page, [first, second] = branchAway(page);
  const before_ = shown(stage).length, faces = stage.deformer.corners().length;
  const [leaf] = leaves(page);
  stage.grab(leaf);
  run(stage, 10, (i) => stage.move(leaf, [0.1 * i, 0, 0]));
  stage.cut(first, 0.4);
  assert.ok(shown(stage).length > before_ && stage.deformer.corners().length > faces, "there are caps");
  run(stage, 10, (i) => stage.move(leaf, [1, 0.1 * i, 0]));
  // Beside the cut, on either side: two parts, that go their ways.
  const grasps = [0.4, 0.4 + 1e-9].map((t) => stage.grasp(first, t, Infinity));
  run(stage, 20, (i) => {
    grasps[0].offset = [0, 0, 0.05 * i];
    grasps[1].offset = [0, 0, -0.05 * i];
    stage.awake = true;
  });
  const [a, b] = stage.acting().filter((hand) => hand.jaws);
  const [from, to] = grasps.map((grasp) => stage.jaws.get(grasp).closedAt);
  assert.ok(Math.abs(a.position[2] - from[2] - 0.95) < 1e-9 && Math.abs(b.position[2] - to[2] + 0.95) < 1e-9);
  // Places of one segment, a millionth of a millimetre from each other, would be torn apart by far more.
  assert.ok(a.newton + b.newton < 1, `${a.newton} and ${b.newton} N`);
  stage.cut(second, 0.5);
  run(stage, 15);
  for (const grasp of grasps) stage.finish(grasp);
  stage.release(leaf);
  run(stage, 5);
  assert.equal(stage.scene().cut.length, 2);
  isPlayed(page, "cut");
  isReplayed(page);
  stage.settings.gravity_m_s2 = [0, 0, -9.8];
  stage.change();
  while (stage.playing) stage.step();
  run(stage, 20);
  isPlayed(page, "cut-and-fallen");
  stage.forget();
  assert.equal(shown(stage).length, before_);
});

test("vertices of caps and beside them are of their part", async () => {
  const page = await open("live.html"), { stage } = page, [segment] = branchAway(page);
  stage.cut(segment, 0.5);
  const { segment: segments, t } = stage.deformer.places();
  const sides = [0, 0];
  for (let v = 0; v < segments.length; ++v) if (segments[v] === segment) ++sides[t[v] <= 0.5 ? 0 : 1];
  assert.ok(sides[0] > 3 && sides[1] > 3, `${sides}`);
  // The nodes near a place on either side are of that part: the old ends of the segment, or new nodes.
  const [a, b] = [page.tree.ends[2 * segment], page.tree.ends[2 * segment + 1]];
  const nodesAt = (place) => stage.deformer.nodesNear(segment, place);
  assert.ok(nodesAt(0.1).includes(a) && !nodesAt(0.1).includes(b));
  assert.ok(nodesAt(0.9).includes(b) && !nodesAt(0.9).includes(a));
});

test("where a vessel cannot be cut nothing happens, and the message tells why", async () => {
  const page = await open("live.html"), { stage } = page, { segment, fromA } = twig(page), positions = shown(stage);
  assert.throws(() => stage.cut(segment, fromA ? 1 : 0), /ends|cut/);
  const [inner] = branchAway(page);
  stage.cut(inner, 0.5);
  assert.throws(() => stage.cut(inner, 0.5), /is cut there already/);
  assert.equal(stage.motion.cuts.length, 1);
  stage.forget();
  assert.deepEqual(shown(stage), positions);
});

test("everything together, and the command follows", async () => {
  writeFileSync(join(folder, "among.json"), JSON.stringify({ schema: "vmesh.scene/1", step_s: 1 / 60, clamp: [0],
    contact: { self: true, friction: 0.2 }, tissue: [{ stiffness_N_mm2: 1e-4, tear_N_mm: 1e-3 }] }));
  vmesh("deform", "tree.json", "tree.ply", "--live", "among.html", "--script", "among.json");
  const page = await open("among.html"), { stage } = page, [segment] = branchAway(page);
  pushAcross(page, twig(page), { steps: 30 });
  const grasp = stage.grasp(twig(page, 2).segment, 0.5, Infinity);
  stage.cut(segment, 0.5);
  run(stage, 10, (i) => {
    grasp.offset = [0, 0.1 * i, 0];
    stage.awake = true;
  });
  pullAbout(stage, leaves(page).slice(3));
  stage.finish(grasp);
  run(stage, 3);
  isPlayed(page, "among");
  isReplayed(page);
});
