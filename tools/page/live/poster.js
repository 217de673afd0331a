// The surface at rest before WebGL and the module are there: drawn once by the processor, with the camera and the light
// of scene.js.

const POSTER = { color: [0xc9, 0x50, 0x4a], ground: [0xb8, 0xbc, 0xc4], field: 35, from: [0, -1, 0.15] };

const dot3 = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const unit3 = (a) => a.map((x) => x / Math.sqrt(dot3(a, a)));
const cross3 = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/** As Scene.viewAll() has it. */
function posterCamera(positions, aspect) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < positions.length; ++i) {
    low[i % 3] = Math.min(low[i % 3], positions[i]);
    high[i % 3] = Math.max(high[i % 3], positions[i]);
  }
  const center = low.map((x, i) => (x + high[i]) / 2), back = unit3(POSTER.from);
  const right = unit3(cross3([0, 0, 1], back)), up = cross3(back, right);
  const tall = Math.tan((POSTER.field * Math.PI) / 360), wide = tall * aspect;
  let distance = 0;
  for (let i = 0; i < positions.length; i += 3) {
    const p = [positions[i] - center[0], positions[i + 1] - center[1], positions[i + 2] - center[2]];
    distance = Math.max(distance, 1.1 * Math.max(Math.abs(dot3(p, right)) / wide, Math.abs(dot3(p, up)) / tall) + dot3(p, back));
  }
  return { center, back, right, up, tall, wide, distance };
}

/** Red, green and blue of a normal, 0 to 255; either side of the surface is lit. */
function posterShade({ back, right, up }) {
  // The light goes with the camera, that of the sky comes from y, as three.js has it.
  const light = unit3([0, 1, 2].map((i) => -0.4 * right[i] + 0.7 * up[i] + back[i]));
  return (normal) => {
    const sky = 0.5 + 0.5 * normal[1], direct = 0.52 * Math.max(0, dot3(normal, light));
    return POSTER.color.map((c, i) => Math.min(255, c * (direct + 0.62 * (sky + (1 - sky) * POSTER.ground[i] / 255))));
  };
}

/** RGBA of the picture of a surface; nothing where it is not. */
function posterPixels({ positions, normals, corners }, width, height) {
  const camera = posterCamera(positions, width / height), shade = posterShade(camera);
  const vertices = positions.length / 3;
  const screen = new Float32Array(6 * vertices);  // x, y, nearness, and the colour
  for (let v = 0; v < vertices; ++v) {
    const p = [0, 1, 2].map((i) => positions[3 * v + i] - camera.center[i]);
    const near = 1 / (camera.distance - dot3(p, camera.back));
    let normal = [normals[3 * v], normals[3 * v + 1], normals[3 * v + 2]];
    const toEye = [0, 1, 2].map((i) => camera.distance * camera.back[i] - p[i]);
    if (dot3(normal, toEye) < 0) normal = normal.map((x) => -x);
    screen.set([(0.5 + (0.5 * near * dot3(p, camera.right)) / camera.wide) * width,
      (0.5 - (0.5 * near * dot3(p, camera.up)) / camera.tall) * height, near, ...shade(normal)], 6 * v);
  }
  const pixels = new Uint8ClampedArray(4 * width * height), nearest = new Float32Array(width * height);
  for (let c = 0; c < corners.length; c += 3) posterTriangle(screen, 6 * corners[c], 6 * corners[c + 1], 6 * corners[c + 2]);
  return pixels;

  function posterTriangle(s, a, b, c) {
    const area = (s[b] - s[a]) * (s[c + 1] - s[a + 1]) - (s[c] - s[a]) * (s[b + 1] - s[a + 1]);
    if (area === 0) return;
    const first = (i) => Math.max(0, Math.ceil(Math.min(s[a + i], s[b + i], s[c + i]) - 0.5));
    const last = (i, end) => Math.min(end - 1, Math.floor(Math.max(s[a + i], s[b + i], s[c + i]) - 0.5));
    for (let y = first(1), bottom = last(1, height); y <= bottom; ++y)
      for (let x = first(0), end = last(0, width); x <= end; ++x) {
        const px = x + 0.5, py = y + 0.5;
        const wb = ((px - s[a]) * (s[c + 1] - s[a + 1]) - (s[c] - s[a]) * (py - s[a + 1])) / area;
        const wc = ((s[b] - s[a]) * (py - s[a + 1]) - (px - s[a]) * (s[b + 1] - s[a + 1])) / area;
        const wa = 1 - wb - wc;
        if (wa < 0 || wb < 0 || wc < 0) continue;
        const near = wa * s[a + 2] + wb * s[b + 2] + wc * s[c + 2], at = y * width + x;
        if (near <= nearest[at]) continue;
        nearest[at] = near;
        for (let i = 0; i < 3; ++i) pixels[4 * at + i] = wa * s[a + 3 + i] + wb * s[b + 3 + i] + wc * s[c + 3 + i];
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
