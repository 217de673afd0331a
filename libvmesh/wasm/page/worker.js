
// In the page's worker: one surface at a time. The page ends the worker to cancel.

let vmesh = null;
let surface = null;

const kReportEvery = 60;  // ms

function progressReporter() {
  let last = 0;
  return (stage, fraction) => {
    const now = performance.now();
    if (now - last < kReportEvery) return;
    last = now;
    postMessage({ kind: "progress", stage, fraction });
  };
}

function grow({ files, reading, options }) {
  if (surface) surface.free();
  surface = null;
  const start = performance.now();
  const centerline = vmesh.read(files, reading);
  surface = vmesh.generate(centerline, options, progressReporter());
  const seconds = (performance.now() - start) / 1000;
  centerline.free();
  postMessage({ kind: "grown", page: surface.page(), sound: surface.sound, unproven: surface.unprovenFaces, seconds,
    cleaning: centerline.cleaning });
}

function save({ extension }) {
  const bytes = surface.write(extension);
  postMessage({ kind: "file", extension, bytes }, [bytes.buffer]);
}

onmessage = async ({ data }) => {
  try {
    if (data.kind === "start") {
      vmesh = await instantiate(data.module);
      postMessage({ kind: "ready", formats: vmesh.formats, version: vmesh.version });
    }
    if (data.kind === "grow") grow(data);
    if (data.kind === "save") save(data);
  } catch (error) {
    postMessage({ kind: "failed", name: error.name, message: error.message });
  }
};
