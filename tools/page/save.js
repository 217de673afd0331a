// What is shown, as files made in the page.

/** Positions of vertices in mm, three numbers each; those of the frame shown. */
function placesOf(surface, origin) {
  return Array.from(surface.positions, (x, i) => x + origin[i % 3]);
}

/** A binary PLY file, with the values that the page has for vertices and faces. */
function plyOf(surface, origin) {
  const { vertices, faces, corners, attributes } = surface;
  const [ofFaces, ofVertices] = [true, false].map((on) => attributes.filter((a) => a.onFaces === on));
  const declared = (list) => list.map((a) => `property ${a.labels ? "int" : "double"} ${a.name}\n`).join("");
  const header = new TextEncoder().encode("ply\nformat binary_little_endian 1.0\ncomment SPACE=LPS\ncomment UNIT=mm\n" +
    `element vertex ${vertices}\nproperty double x\nproperty double y\nproperty double z\n${declared(ofVertices)}` +
    `element face ${faces}\nproperty list uchar int vertex_indices\n${declared(ofFaces)}end_header\n`);
  const sizeOf = (list) => list.reduce((sum, a) => sum + (a.labels ? 4 : 8), 0);
  const file = new ArrayBuffer(header.length + vertices * (24 + sizeOf(ofVertices)) + faces * (13 + sizeOf(ofFaces)));
  new Uint8Array(file).set(header);
  const data = new DataView(file);
  let at = header.length;
  const write = (kind, size, value) => {
    data[kind](at, value, true);
    at += size;
  };
  const writeValues = (list, i) => {
    for (const a of list) a.labels ? write("setInt32", 4, a.value(i)) : write("setFloat64", 8, a.value(i));
  };
  const places = placesOf(surface, origin);
  for (let v = 0; v < vertices; ++v) {
    for (let axis = 0; axis < 3; ++axis) write("setFloat64", 8, places[3 * v + axis]);
    writeValues(ofVertices, v);
  }
  for (let f = 0; f < faces; ++f) {
    write("setUint8", 1, 3);
    for (let k = 0; k < 3; ++k) write("setInt32", 4, corners[3 * f + k]);
    writeValues(ofFaces, f);
  }
  return file;
}

/** A binary STL file. */
function stlOf(surface, origin) {
  const { faces, corners } = surface;
  const file = new ArrayBuffer(84 + 50 * faces);
  const data = new DataView(file);
  data.setUint32(80, faces, true);
  const places = placesOf(surface, origin);
  const [a, b, c] = [new THREE.Vector3(), new THREE.Vector3(), new THREE.Vector3()];
  for (let f = 0; f < faces; ++f) {
    [a, b, c].forEach((corner, k) => corner.fromArray(places, 3 * corners[3 * f + k]));
    const normal = b.clone().sub(a).cross(c.clone().sub(a)).normalize();
    [normal, a, b, c].forEach((p, k) => p.toArray().forEach((x, axis) =>
      data.setFloat32(84 + 50 * f + 12 * k + 4 * axis, x, true)));
  }
  return file;
}

const LEGEND = { left: 24, width: 220, bottom: 52 };  // in a picture, pixels

/** The colour scale with the numbers at both ends, `top` pixels down a picture. */
function paintScale(paint, scale, top, ink) {
  const { left, width } = LEGEND;
  const colors = paint.createLinearGradient(left, 0, left + width, 0);
  for (let i = 0; i <= 24; ++i)
    colors.addColorStop(i / 24, cssColor(scale.color(scale.low + ((scale.high - scale.low) * i) / 24)));
  paint.fillStyle = colors;
  paint.fillRect(left, top, width, 12);
  paint.fillStyle = ink;
  paint.fillText(brief(scale.low), left, top + 28);
  paint.textAlign = "right";
  paint.fillText(brief(scale.high), left + width, top + 28);
}

/** Labels in a row, each after its colour. */
function paintLabels(paint, attribute, scale, top, ink) {
  const { labels, rest } = shownLabels(attribute);
  let x = LEGEND.left;
  for (const label of labels) {
    paint.fillStyle = cssColor(scale.color(label));
    paint.fillRect(x, top, 12, 12);
    paint.fillStyle = ink;
    paint.fillText(String(label), x + 16, top + 11);
    x += 26 + paint.measureText(String(label)).width;
  }
  paint.fillText(rest, x, top + 11);
}

/** The legend of an attribute, in the lower left corner. */
function paintLegend(paint, attribute, scale, height, ink) {
  const top = height - LEGEND.bottom;
  paint.fillStyle = ink;
  paint.fillText(withUnit(attribute.label, attribute.unit), LEGEND.left, top - 8);
  if (scale.labels) paintLabels(paint, attribute, scale, top, ink);
  else paintScale(paint, scale, top, ink);
}

/** A canvas with the view on the page's ground, the legend if there is one, and the ruler's distance. */
function pictureOf(scene, attribute, scale, ruler) {
  scene.render();  // its pixels last until the browser shows them
  const { canvas } = scene;
  const { backgroundColor, color } = getComputedStyle(document.body);
  const picture = element("canvas", { width: canvas.width, height: canvas.height });
  const paint = picture.getContext("2d");
  paint.fillStyle = backgroundColor;
  paint.fillRect(0, 0, canvas.width, canvas.height);
  paint.drawImage(canvas, 0, 0);
  const zoom = scene.renderer.getPixelRatio();
  paint.scale(zoom, zoom);
  paint.font = "13px sans-serif";
  paint.fillStyle = color;
  const middle = ruler.middle();
  const at = middle && scene.onScreen(middle);
  if (at) paint.fillText(ruler.text(), at.x + 8, at.y + 16);
  if (attribute) paintLegend(paint, attribute, scale, canvas.height / zoom, color);
  return picture;
}

function download(address, name) {
  element("a", { href: address, download: name }).click();
}

function downloadBytes(bytes, name) {
  const address = URL.createObjectURL(new Blob([bytes], { type: "application/octet-stream" }));
  download(address, name);
  setTimeout(() => URL.revokeObjectURL(address), 60000);
}
