"use strict";
// What the page has: numbers of the tree and of its surface at rest.

/** Numbers of a base64 text that holds them as in memory. */
function numbersOf(text, Kind) {
  const characters = atob(text);
  const bytes = new Uint8Array(characters.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = characters.charCodeAt(i);
  return new Kind(bytes.buffer);
}

function contentsOf(data) {
  return {
    data,
    tree: { positions: numbersOf(data.node_positions, Float64Array), radii: numbersOf(data.radii, Float64Array),
      ends: numbersOf(data.ends, Uint32Array) },
    surface: { positions: numbersOf(data.positions, Float64Array), normals: numbersOf(data.normals, Float64Array),
      segment: numbersOf(data.place_segments, Uint32Array), t: numbersOf(data.place_parameters, Float64Array),
      corners: numbersOf(data.corners, Uint32Array) },
  };
}
