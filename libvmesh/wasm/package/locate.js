
/** Loads vmesh. `wasm`: bytes of vmesh.wasm or a compiled module; without it, the file beside this one. */
async function loadVmesh(wasm) {
  if (wasm) return instantiate(wasm);
  const address = new URL("vmesh.wasm", import.meta.url);
  if (address.protocol === "file:") {
    const { readFile } = await import("node:fs/promises");
    return instantiate(await readFile(address));
  }
  const response = await fetch(address);
  if (!response.ok) throw new VmeshError({ kind: "ReadError", message: `${address}: cannot be loaded: ${response.status}` });
  return instantiate(await response.arrayBuffer());
}

export { loadVmesh, Vmesh, Centerline, Surface, VmeshError };
export default loadVmesh;
