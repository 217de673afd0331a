"use strict";
// Decodes the numbers written by packing.h.

/** `count` integers of an encoded text, as an Int32Array. */
function unpack(text, count, stride = 1) {
  const bytes = atob(text);
  const numbers = new Int32Array(count);
  let at = 0;
  for (let i = 0; i < count; ++i) {
    let value = 0;
    let scale = 1;
    let byte;
    do {
      byte = bytes.charCodeAt(at++);
      value += (byte & 127) * scale;
      scale *= 128;
    } while (byte > 127);
    const difference = value % 2 === 0 ? value / 2 : -(value + 1) / 2;
    numbers[i] = difference + (i < stride ? 0 : numbers[i - stride]);
  }
  return numbers;
}

/** Positions in mm relative to `origin`, three numbers per point. */
function positionsOf(places, low, step, origin) {
  const positions = new Float32Array(places.length);
  for (let i = 0; i < places.length; ++i) positions[i] = places[i] * step + low[i % 3] - origin[i % 3];
  return positions;
}

/** Values are integers, in steps; -1 means none, except for labels. */
function decodeAttribute(json, vertices, faces) {
  const steps = unpack(json.values, json.on === "vertex" ? vertices : faces);
  const none = json.labels ? NaN : -1;
  return {
    name: json.name, label: json.label, unit: json.unit, labels: json.labels, onFaces: json.on === "face",
    digits: json.labels ? 0 : Math.max(0, Math.floor(-Math.log10(json.step))), count: steps.length,
    value: (i) => (steps[i] === none ? NaN : json.low + json.step * steps[i]),
  };
}

/** The ends of the colour scale: the least and the largest value, or zero if the least is not far from it. */
function rangeOf(attribute) {
  let low = Infinity;
  let high = -Infinity;
  for (let i = 0; i < attribute.count; ++i) {
    const value = attribute.value(i);
    if (!isFinite(value)) continue;
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  if (low > high) return { low: 0, high: 1 };
  if (!attribute.labels && low > 0 && low < 0.3 * high) low = 0;
  return { low, high };
}

function decodeSurface(json, origin) {
  const corners = unpack(json.corners, 3 * json.faces, 3);
  for (let i = 0; i < corners.length; i += 3) {
    corners[i + 1] += corners[i];
    corners[i + 2] += corners[i + 1];
  }
  const places = unpack(json.positions, 3 * json.vertices, 3);
  return {
    name: json.name, reference: json.reference, vertices: json.vertices, faces: json.faces, step: json.step, places,
    low: json.low, corners, positions: positionsOf(places, json.low, json.step, origin),
    attributes: json.attributes.map((attribute) => decodeAttribute(attribute, json.vertices, json.faces)),
  };
}

function decodeCenterline(json, origin) {
  const steps = unpack(json.radius.values, json.nodes);
  return {
    nodes: json.nodes, segments: json.segments,
    positions: positionsOf(unpack(json.positions, 3 * json.nodes, 3), json.low, json.step, origin),
    ends: unpack(json.ends, 2 * json.segments, 2), radius: (node) => json.radius.low + json.radius.step * steps[node],
  };
}

/** Unit normals of vertices, weighted by the areas of their faces. */
function vertexNormals(positions, corners) {
  const normals = new Float32Array(positions.length);
  for (let i = 0; i < corners.length; i += 3) {
    const a = 3 * corners[i];
    const b = 3 * corners[i + 1];
    const c = 3 * corners[i + 2];
    const ux = positions[b] - positions[a];
    const uy = positions[b + 1] - positions[a + 1];
    const uz = positions[b + 2] - positions[a + 2];
    const vx = positions[c] - positions[a];
    const vy = positions[c + 1] - positions[a + 1];
    const vz = positions[c + 2] - positions[a + 2];
    const n = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
    for (const corner of [a, b, c]) {
      normals[corner] += n[0];
      normals[corner + 1] += n[1];
      normals[corner + 2] += n[2];
    }
  }
  for (let i = 0; i < normals.length; i += 3) {
    const length = Math.hypot(normals[i], normals[i + 1], normals[i + 2]) || 1;
    for (let axis = 0; axis < 3; ++axis) normals[i + axis] /= length;
  }
  return normals;
}

/** A number with three significant digits, and all of those before its decimal point. */
function brief(value) {
  return numberText(value, value === 0 ? 0 : Math.max(0, 2 - Math.floor(Math.log10(Math.abs(value)))));
}

/** A number with enough digits to distinguish it from others of its kind. */
function numberText(value, digits = 3) {
  if (!isFinite(value)) return "none";
  const text = value.toFixed(Math.min(digits, 6));
  return Number(text) === 0 ? text.replace("-", "") : text;
}
