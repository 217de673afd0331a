// A plane that cuts off what is nearest to the viewer.

class Cut {
  constructor(scene) {
    this.scene = scene;
    this.plane = new THREE.Plane();
    this.on = false;
  }

  /** Begins to cut in the direction in which the camera looks. */
  begin() {
    this.on = true;
    const { camera, controls, bounds } = this.scene;
    this.plane.normal.copy(controls.target).sub(camera.position).normalize();
    this.near = Infinity;
    this.far = -Infinity;
    const point = new THREE.Vector3();
    for (const positions of bounds.lists) {
      for (let i = 0; i < positions.length; i += 3) {
        const depth = point.fromArray(positions, i).dot(this.plane.normal);
        this.near = Math.min(this.near, depth);
        this.far = Math.max(this.far, depth);
      }
    }
    this.scene.renderer.clippingPlanes = [this.plane];
  }

  end() {
    this.on = false;
    this.scene.renderer.clippingPlanes = [];
    this.scene.draw();
  }

  /** `share`: 0 cuts off nothing, 1 everything. */
  move(share) {
    this.plane.constant = -(this.near + share * (this.far - this.near));
    this.scene.draw();
  }

  shows(point) {
    return !this.on || this.plane.distanceToPoint(point) >= 0;
  }
}
