// The distance between two points of the surface.

class Ruler {
  /** `label`: an element that is moved to the middle of the line. */
  constructor(scene, label) {
    this.scene = scene;
    this.label = label;
    this.ends = [];
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(6), 3));
    const look = { color: 0xd6336c, depthTest: false, transparent: true };
    this.line = new THREE.Group();
    this.line.add(new THREE.Line(geometry, new THREE.LineBasicMaterial(look)),
      new THREE.Points(geometry, new THREE.PointsMaterial({ ...look, size: 7, sizeAttenuation: false })));
    for (const part of this.line.children) {
      part.renderOrder = 6;
      part.frustumCulled = false;
    }
    scene.scene.add(this.line);
    scene.afterDrawing.push(() => this.moveLabel());
    this.clear();
  }

  clear() {
    this.ends = [];
    this.update();
  }

  /** The second point gives the distance, a third begins anew. */
  add(point) {
    if (this.ends.length === 2) this.ends = [];
    this.ends.push(point.clone());
    this.update();
  }

  /** Empty until there are two points. */
  text() {
    return this.ends.length === 2 ? `${brief(this.ends[0].distanceTo(this.ends[1]))} mm` : "";
  }

  /** Of both points; null until there are two. */
  middle() {
    return this.ends.length === 2 ? this.ends[0].clone().add(this.ends[1]).multiplyScalar(0.5) : null;
  }

  update() {
    const [from, to = from] = this.ends;
    this.line.visible = from !== undefined;
    if (from) {
      const { position } = this.line.children[0].geometry.attributes;
      from.toArray(position.array, 0);
      to.toArray(position.array, 3);
      position.needsUpdate = true;
    }
    this.label.textContent = this.text();
    this.scene.draw();
  }

  moveLabel() {
    const middle = this.middle();
    const at = middle && this.scene.onScreen(middle);
    this.label.hidden = !at;
    if (at) this.label.style.transform = `translate(${at.x.toFixed(1)}px, ${at.y.toFixed(1)}px)`;
  }
}
