// The surface at rest before WebGL and the module are there: drawn once by the processor, with the camera and the light
// of scene.js.

const POSTER = { color: [0xc9, 0x50, 0x4a], ground: [0xb8, 0xbc, 0xc4], field: 35, from: [0, -1, 0.15] };

const unit3 = (a) => a.map((x) => x / Math.hypot(...a));
const cross3 = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/** As Scene.viewAll() has it. */
function posterCamera(positions, aspect) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0, axis = 0; i < positions.length; ++i, axis = axis === 2 ? 0 : axis + 1) {
    const x = positions[i];
    if (x < low[axis]) low[axis] = x;
    if (x > high[axis]) high[axis] = x;
  }
  const center = low.map((x, i) => (x + high[i]) / 2), back = unit3(POSTER.from);
  const right = unit3(cross3([0, 0, 1], back)), up = cross3(back, right);
  const tall = Math.tan((POSTER.field * Math.PI) / 360), wide = tall * aspect;
  return { center, back, right, up, tall, wide, distance: 0 };
}

/** Of every vertex x, y, and how far it is towards the viewer, from the centre along the camera's axes. */
function posterPlaces(positions, camera) {
  const places = new Float32Array(positions.length);
  const { center: [cx, cy, cz], right: [rx, ry, rz], up: [ux, uy, uz], back: [bx, by, bz], tall, wide } = camera;
  let distance = 0;
  for (let i = 0; i < positions.length; i += 3) {
    const x = positions[i] - cx, y = positions[i + 1] - cy, z = positions[i + 2] - cz;
    const right = rx * x + ry * y + rz * z, up = ux * x + uy * y + uz * z, back = bx * x + by * y + bz * z;
    places[i] = right, places[i + 1] = up, places[i + 2] = back;
    distance = Math.max(distance, 1.1 * Math.max(Math.abs(right) / wide, Math.abs(up) / tall) + back);
  }
  camera.distance = distance;
  return places;
}

/** Red, green and blue of every vertex, 0 to 255; either side of the surface is lit. */
function posterColors(normals, places, { right, up, back, distance }) {
  // The light goes with the camera and looks at the middle, that of the sky comes from y, as three.js has it.
  const [lx, ly, lz] = unit3([-0.4, 0.7, 1 + distance]), [red, green, blue] = POSTER.color, [ground0, ground1, ground2] = POSTER.ground;
  const colors = new Float32Array(normals.length);
  for (let i = 0; i < normals.length; i += 3) {
    const nx = normals[i], ny = normals[i + 1], nz = normals[i + 2];
    const r = right[0] * nx + right[1] * ny + right[2] * nz, u = up[0] * nx + up[1] * ny + up[2] * nz;
    const b = back[0] * nx + back[1] * ny + back[2] * nz;
    const side = (distance - places[i + 2]) * b - places[i] * r - places[i + 1] * u < 0 ? -1 : 1;
    const sky = 0.5 + 0.5 * side * ny, direct = 0.52 * Math.max(0, side * (lx * r + ly * u + lz * b));
    colors[i] = red * (direct + 0.62 * (sky + ((1 - sky) * ground0) / 255));
    colors[i + 1] = green * (direct + 0.62 * (sky + ((1 - sky) * ground1) / 255));
    colors[i + 2] = blue * (direct + 0.62 * (sky + ((1 - sky) * ground2) / 255));
  }
  return colors;
}

/** RGBA of the picture of a surface; nothing where it is not. */
function posterPixels({ positions, normals, corners }, width, height) {
  const camera = posterCamera(positions, width / height), places = posterPlaces(positions, camera);
  const colors = posterColors(normals, places, camera);
  // From here on in pixels, and nearness for depth.
  for (let i = 0; i < places.length; i += 3) {
    const near = 1 / (camera.distance - places[i + 2]);
    places[i] = (0.5 + (0.5 * near * places[i]) / camera.wide) * width;
    places[i + 1] = (0.5 - (0.5 * near * places[i + 1]) / camera.tall) * height;
    places[i + 2] = near;
  }
  const pixels = new Uint8ClampedArray(4 * width * height), nearest = new Float32Array(width * height);
  for (let c = 0; c < corners.length; c += 3)
    posterTriangle(places, colors, 3 * corners[c], 3 * corners[c + 1], 3 * corners[c + 2], pixels, nearest, width, height);
  return pixels;
}

/** Centres of pixels within a triangle, row by row. */
function posterTriangle(places, colors, a, b, c, pixels, nearest, width, height) {
  const ax = places[a], ay = places[a + 1], abx = places[b] - ax, aby = places[b + 1] - ay;
  const acx = places[c] - ax, acy = places[c + 1] - ay, area = abx * acy - acx * aby;
  if (area === 0) return;
  // The shares of b and c, and of a, change by this from one pixel to the next.
  const bx = acy / area, cx = -aby / area, toB = -acx / area, toC = abx / area;
  const near0 = places[a + 2], nearB = places[b + 2] - near0, nearC = places[c + 2] - near0;
  const top = Math.max(0, Math.ceil(ay + Math.min(0, aby, acy) - 0.5));
  const bottom = Math.min(height - 1, Math.floor(ay + Math.max(0, aby, acy) - 0.5));
  const left = ax + Math.min(0, abx, acx) - 0.5, right = ax + Math.max(0, abx, acx) - 0.5;
  for (let y = top; y <= bottom; ++y) {
    const py = y + 0.5 - ay, x0 = 0.5 - ax;
    const wb0 = bx * x0 + toB * py, wc0 = cx * x0 + toC * py;
    // Where all three shares are at least 0.
    let from = left, to = right;
    if (bx > 0) from = Math.max(from, -wb0 / bx);
    else if (bx < 0) to = Math.min(to, -wb0 / bx);
    if (cx > 0) from = Math.max(from, -wc0 / cx);
    else if (cx < 0) to = Math.min(to, -wc0 / cx);
    const ax0 = 1 - wb0 - wc0, ax1 = -bx - cx;
    if (ax1 > 0) from = Math.max(from, -ax0 / ax1);
    else if (ax1 < 0) to = Math.min(to, -ax0 / ax1);
    const last = Math.min(width - 1, Math.floor(to));
    for (let x = Math.max(0, Math.ceil(from)); x <= last; ++x) {
      const wb = wb0 + bx * x, wc = wc0 + cx * x, at = y * width + x;
      const near = near0 + wb * nearB + wc * nearC;
      if (near <= nearest[at]) continue;
      nearest[at] = near;
      const wa = 1 - wb - wc;
      pixels[4 * at] = wa * colors[a] + wb * colors[b] + wc * colors[c];
      pixels[4 * at + 1] = wa * colors[a + 1] + wb * colors[b + 1] + wc * colors[c + 1];
      pixels[4 * at + 2] = wa * colors[a + 2] + wb * colors[b + 2] + wc * colors[c + 2];
      pixels[4 * at + 3] = 255;
    }
  }
}

/** A picture of the surface over the whole box; it is to be removed when there is a better one. */
function addPoster(box, surface) {
  const canvas = document.createElement("canvas"), ratio = Math.min(2, window.devicePixelRatio || 1);
  canvas.width = Math.max(1, Math.floor(box.clientWidth * ratio));
  canvas.height = Math.max(1, Math.floor(box.clientHeight * ratio));
  canvas.id = "poster";
  canvas.getContext("2d").putImageData(new ImageData(posterPixels(surface, canvas.width, canvas.height), canvas.width, canvas.height), 0, 0);
  box.append(canvas);
}
