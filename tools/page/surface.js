// Surfaces for three.js: every face has its own corners, so that faces can be coloured.

function spread(perVertex, corners, target) {
  for (let i = 0; i < corners.length; ++i) {
    const from = 3 * corners[i];
    target[3 * i] = perVertex[from];
    target[3 * i + 1] = perVertex[from + 1];
    target[3 * i + 2] = perVertex[from + 2];
  }
  return target;
}

/** Every edge once, two vertices each. */
function uniqueEdges(corners, vertices) {
  const seen = new Set();
  const edges = [];
  for (let i = 0; i < corners.length; i += 3) {
    for (let k = 0; k < 3; ++k) {
      const a = corners[i + k];
      const b = corners[i + ((k + 1) % 3)];
      const key = Math.min(a, b) * vertices + Math.max(a, b);
      if (seen.has(key)) continue;
      seen.add(key);
      edges.push(a, b);
    }
  }
  return new Uint32Array(edges);
}

class SurfaceView {
  constructor(surface, asGlass) {
    this.surface = surface;
    const size = 3 * surface.corners.length;
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(size), 3));
    geometry.setAttribute("normal", new THREE.BufferAttribute(new Float32Array(size), 3));
    geometry.setAttribute("color", new THREE.BufferAttribute(new Uint8Array(size).fill(255), 3, true));
    this.mesh = new THREE.Mesh(geometry, asGlass ? this.glass() : this.skin());
    this.mesh.renderOrder = asGlass ? 2 : 0;
    this.group = new THREE.Group();
    this.group.add(this.mesh);
    this.edges = null;
    this.update();
  }

  skin() {
    return new THREE.MeshPhongMaterial({ vertexColors: true, side: THREE.DoubleSide, shininess: 18,
      specular: 0x1c1c1c, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
  }

  glass() {
    return new THREE.MeshPhongMaterial({ color: 0x7d8b99, side: THREE.DoubleSide, transparent: true, opacity: 0.28,
      depthWrite: false, shininess: 4, specular: 0x111111 });
  }

  /** To be called after the positions of vertices have changed. */
  update() {
    const { positions, corners } = this.surface;
    this.normals = vertexNormals(positions, corners);
    const geometry = this.mesh.geometry;
    spread(positions, corners, geometry.attributes.position.array);
    spread(this.normals, corners, geometry.attributes.normal.array);
    geometry.attributes.position.needsUpdate = true;
    geometry.attributes.normal.needsUpdate = true;
    geometry.computeBoundingSphere();
    if (this.edges) this.edges.geometry.attributes.position.needsUpdate = true;
  }

  /** Colours by `attribute`; by none: one colour. */
  color(attribute, scale) {
    const { corners } = this.surface;
    const colors = this.mesh.geometry.attributes.color.array;
    const plain = [198, 190, 180];
    for (let i = 0; i < corners.length; ++i) {
      const of = attribute && attribute.onFaces ? Math.floor(i / 3) : corners[i];
      const rgb = attribute ? scale.color(attribute.value(of)) : plain;
      colors[3 * i] = rgb[0];
      colors[3 * i + 1] = rgb[1];
      colors[3 * i + 2] = rgb[2];
    }
    this.mesh.geometry.attributes.color.needsUpdate = true;
  }

  showEdges(on) {
    if (on && !this.edges) {
      const { positions, corners, vertices } = this.surface;
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
      geometry.setIndex(new THREE.BufferAttribute(uniqueEdges(corners, vertices), 1));
      const material = new THREE.LineBasicMaterial({ color: 0x10151a, transparent: true, opacity: 0.38 });
      this.edges = new THREE.LineSegments(geometry, material);
      this.edges.frustumCulled = false;
      this.group.add(this.edges);
    }
    if (this.edges) this.edges.visible = on;
  }

  seeThrough(on) {
    this.mesh.material.transparent = on;
    this.mesh.material.opacity = on ? 0.45 : 1;
    this.mesh.material.depthWrite = !on;
    this.mesh.material.needsUpdate = true;
  }

  vertex(v) {
    return new THREE.Vector3().fromArray(this.surface.positions, 3 * v);
  }

  normal(v) {
    return new THREE.Vector3().fromArray(this.normals, 3 * v);
  }

  /** The longest edge of the faces at a vertex. */
  edgeAt(v) {
    const { corners } = this.surface;
    let longest = 0;
    for (let i = 0; i < corners.length; i += 3) {
      if (corners[i] !== v && corners[i + 1] !== v && corners[i + 2] !== v) continue;
      for (const other of corners.subarray(i, i + 3))
        longest = Math.max(longest, this.vertex(v).distanceTo(this.vertex(other)));
    }
    return longest;
  }

  nearestVertex(point) {
    const { positions, vertices } = this.surface;
    let best = -1;
    let least = Infinity;
    for (let v = 0; v < vertices; ++v) {
      const dx = positions[3 * v] - point.x;
      const dy = positions[3 * v + 1] - point.y;
      const dz = positions[3 * v + 2] - point.z;
      const distance = dx * dx + dy * dy + dz * dz;
      if (distance < least) {
        least = distance;
        best = v;
      }
    }
    return best;
  }
}

/** Lines and points, drawn over everything. */
function centerlineView(centerline) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(centerline.positions, 3));
  const lines = geometry.clone();
  lines.attributes.position = geometry.attributes.position;
  lines.setIndex(new THREE.BufferAttribute(new Uint32Array(centerline.ends), 1));
  const look = { color: 0xd6336c, depthTest: false, transparent: true };
  const view = new THREE.Group();
  view.add(new THREE.LineSegments(lines, new THREE.LineBasicMaterial({ ...look, opacity: 0.9 })),
    new THREE.Points(geometry, new THREE.PointsMaterial({ ...look, size: 2.5, sizeAttenuation: false })));
  for (const part of view.children) {
    part.renderOrder = 5;
    part.frustumCulled = false;
  }
  view.moved = () => {
    geometry.attributes.position.needsUpdate = true;
  };
  return view;
}
