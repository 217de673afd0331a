// node make_package.mjs PROJECT BUILD THREE LICENSE VERSION: puts npm/ and vmesh.html together in the folder BUILD, from
// emscripten's bin/module.js and bin/module.wasm and from THREE, what pages use of three.js, with its LICENSE.
import { cpSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { gzipSync } from "node:zlib";

const [project, build, threeFile, threeLicense, version] = process.argv.slice(2);
const wasmFolder = `${project}/libvmesh/wasm`;
const pageFolder = `${project}/tools/page`;
const text = (file) => readFileSync(file, "utf8");

/** `source` with the one `from` in it replaced; that it is there is not a matter of course. */
function replaced(source, from, to) {
  const parts = source.split(from);
  if (parts.length !== 2) throw new Error(`make_package: "${from}" is there ${parts.length - 1} times, not once`);
  return parts.join(to);
}

const embedded = (source) => source.replace(/<\/(script)/gi, "<\\/$1");

// emscripten's `createModule`, and what is ours around it.
const engine = `${text(`${build}/bin/module.js`)}\n${text(`${wasmFolder}/package/api.js`)}`;
const wasm = readFileSync(`${build}/bin/module.wasm`);

function makePackage() {
  const folder = `${build}/npm`;
  rmSync(folder, { recursive: true, force: true });
  mkdirSync(folder);
  writeFileSync(`${folder}/vmesh.js`, engine + text(`${wasmFolder}/package/locate.js`));
  writeFileSync(`${folder}/vmesh.wasm`, wasm);
  writeFileSync(`${folder}/package.json`, `${JSON.stringify({
    name: "vmesh", version, description: "Vessel centerlines to surfaces", license: "GPL-3.0-or-later", type: "module",
    main: "vmesh.js", types: "vmesh.d.ts", engines: { node: ">=18" },
    exports: { ".": { types: "./vmesh.d.ts", default: "./vmesh.js" }, "./vmesh.wasm": "./vmesh.wasm" },
    files: ["vmesh.js", "vmesh.wasm", "vmesh.d.ts", "README.md", "LICENSE"],
  }, null, 2)}\n`);
  cpSync(`${wasmFolder}/package/vmesh.d.ts`, `${folder}/vmesh.d.ts`);
  cpSync(`${wasmFolder}/package/README.md`, `${folder}/README.md`);
  cpSync(`${project}/LICENSE`, `${folder}/LICENSE`);
}

// The page of the command, with a part that makes surfaces and no surface yet.
function makePage() {
  const names = text(`${pageFolder}/embed.cmake`).match(/set\(scripts ([a-z ]+)\)/)[1].split(" ");
  const scripts = names.map((name) => text(`${pageFolder}/${name}.js`)).join("");
  const policy = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:";
  // Nothing may be loaded from anywhere: the worker and the module come from the page itself.
  const ownPolicy = policy.replace("'unsafe-inline';", "'unsafe-inline' 'wasm-unsafe-eval'; worker-src blob:;");
  let page = text(`${pageFolder}/page.html`);
  page = replaced(page, policy, ownPolicy);
  page = replaced(page, "@TITLE@", "vmesh");
  page = replaced(page, "@STYLE@", text(`${pageFolder}/page.css`) + text(`${wasmFolder}/page/live.css`));
  page = replaced(page, '<aside id="panel">\n', `<aside id="panel">\n${text(`${wasmFolder}/page/live.html`)}`);
  page = replaced(page, '  <div id="picture">\n',
    '  <div id="picture">\n  <div id="welcome"><b>From a centerline to a surface</b><span>Drop a file anywhere on this page, or choose one.</span></div>\n');
  const data = `null</script>
<script type="text/plain" id="example-file">${text(`${project}/examples/small_tree.swc`)}</script>
<script type="text/plain" id="worker">${embedded(engine + text(`${wasmFolder}/page/worker.js`))}</script>
<script type="text/plain" id="wasm">${gzipSync(wasm, { level: 9 }).toString("base64")}`;
  page = replaced(page, "@DATA@", data);
  page = replaced(page, "@LICENSE@", text(threeLicense));
  page = replaced(page, "@THREE@", embedded(text(threeFile)));
  page = replaced(page, "@SCRIPT@", embedded(scripts + text(`${wasmFolder}/page/live.js`)));
  writeFileSync(`${build}/vmesh.html`, page);
}

makePackage();
makePage();
