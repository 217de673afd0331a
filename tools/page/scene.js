// The picture: camera, light, and drawing when something has changed.

// Colours are drawn as the legend has them, the numbers of sRGB, without going to linear light and back.
THREE.ColorManagement.enabled = false;

class Scene {
  constructor(box, bounds) {
    this.box = box;
    this.bounds = bounds;
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(35, 1, 0.1, 1000);
    this.camera.up.set(0, 0, 1);
    this.renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true });
    this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
    this.canvas = this.renderer.domElement;
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", "The surface in 3D. Drag to rotate, wheel to zoom, click for the values at a vertex.");
    box.prepend(this.canvas);
    this.controls = new THREE.OrbitControls(this.camera, this.canvas);
    this.controls.target.copy(bounds.center);
    this.camera.position.copy(bounds.center).y -= bounds.radius;
    this.controls.addEventListener("change", () => this.draw());
    this.controls.addEventListener("start", () => this.stopFlight());
    const light = new THREE.DirectionalLight(0xffffff, 0.52 * Math.PI);
    light.position.set(-0.4, 0.7, 1);
    this.camera.add(light);
    this.scene.add(this.camera, new THREE.HemisphereLight(0xffffff, 0xb8bcc4, 0.62 * Math.PI));
    this.afterDrawing = [];
    this.waiting = false;
    this.flight = null;
    new ResizeObserver(() => this.resize()).observe(box);
    this.resize();
  }

  resize() {
    const width = Math.max(1, this.box.clientWidth);
    const height = Math.max(1, this.box.clientHeight);
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.render();
  }

  draw() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.render();
    });
  }

  render() {
    const distance = this.camera.position.distanceTo(this.controls.target);
    const away = this.camera.position.distanceTo(this.bounds.center);
    this.camera.near = Math.max(distance / 200, away - 1.2 * this.bounds.radius, 1e-6);
    this.camera.far = away + 1.5 * this.bounds.radius;
    this.camera.updateProjectionMatrix();
    this.renderer.render(this.scene, this.camera);
    for (const call of this.afterDrawing) call();
  }

  /** Pixels of the box, from its upper left; null behind the camera. */
  onScreen(point) {
    const p = point.clone().project(this.camera);
    if (p.z > 1) return null;
    return { x: ((p.x + 1) / 2) * this.box.clientWidth, y: ((1 - p.y) / 2) * this.box.clientHeight };
  }

  /** The face of a mesh at a position in the window, at a point that `shows`; null: none. */
  pick(mesh, clientX, clientY, shows) {
    const box = this.canvas.getBoundingClientRect();
    const at = new THREE.Vector2(((clientX - box.left) / box.width) * 2 - 1, 1 - ((clientY - box.top) / box.height) * 2);
    const ray = new THREE.Raycaster();
    ray.setFromCamera(at, this.camera);
    return ray.intersectObject(mesh).find((hit) => shows(hit.point)) || null;
  }

  /** Half of the picture's height and width, at a distance of 1. */
  spread() {
    const high = Math.tan((this.camera.fov * Math.PI) / 360);
    return { high, wide: high * this.camera.aspect };
  }

  /** The distance at which a sphere fills the picture. */
  distanceFor(radius) {
    const { high, wide } = this.spread();
    return (1.08 * radius) / Math.sin(Math.atan(Math.min(high, wide)));
  }

  /** The distance at which everything fills it, seen from `direction`. */
  distanceForAll(direction) {
    const { high, wide } = this.spread();
    const back = direction.clone().normalize();
    const right = new THREE.Vector3().crossVectors(this.camera.up, back).normalize();
    const up = new THREE.Vector3().crossVectors(back, right);
    const point = new THREE.Vector3();
    let distance = 0;
    for (const positions of this.bounds.lists) {
      for (let i = 0; i < positions.length; i += 3) {
        point.fromArray(positions, i).sub(this.bounds.center);
        const beside = Math.max(Math.abs(point.dot(right)) / wide, Math.abs(point.dot(up)) / high);
        distance = Math.max(distance, 1.1 * beside + point.dot(back));
      }
    }
    return distance || this.bounds.radius;
  }

  stopFlight() {
    this.flight = null;
  }

  /** Moves the camera so that it looks at `target` from `direction` away by `distance`. */
  flyTo(target, direction, distance, atOnce) {
    const start = performance.now();
    const fromTarget = this.controls.target.clone();
    const offset = this.camera.position.clone().sub(fromTarget);
    const fromDistance = offset.length() || distance;
    const turn = new THREE.Quaternion().setFromUnitVectors(offset.clone().normalize(), direction.clone().normalize());
    const still = new THREE.Quaternion();
    const quiet = atOnce || window.matchMedia("(prefers-reduced-motion: reduce)").matches;
    const place = (t) => {
      const partly = new THREE.Quaternion();
      partly.slerpQuaternions(still, turn, t);
      const far = fromDistance * (distance / fromDistance) ** t;
      this.controls.target.lerpVectors(fromTarget, target, t);
      this.camera.position.copy(offset).normalize().applyQuaternion(partly).multiplyScalar(far);
      this.camera.position.add(this.controls.target);
      this.controls.update();
      this.draw();
    };
    if (quiet) {
      this.flight = null;
      place(1);
      return;
    }
    const flight = (now) => {
      if (this.flight !== flight) return;
      const t = Math.min(1, (now - start) / 700);
      place(t < 0 ? 0 : t * t * (3 - 2 * t));
      if (t < 1) requestAnimationFrame(flight);
      else this.flight = null;
    };
    this.flight = flight;
    requestAnimationFrame(flight);
  }

  viewAll(direction, atOnce) {
    this.flyTo(this.bounds.center, direction, this.distanceForAll(direction), atOnce);
  }

  /** Rotates by angles in radians about the target, or moves closer. */
  turn(across, along) {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const spherical = new THREE.Spherical().setFromVector3(new THREE.Vector3(offset.x, offset.z, -offset.y));
    spherical.theta += across;
    spherical.phi = Math.min(Math.PI - 0.01, Math.max(0.01, spherical.phi + along));
    const turned = new THREE.Vector3().setFromSpherical(spherical);
    this.camera.position.set(turned.x, -turned.z, turned.y).add(this.controls.target);
    this.controls.update();
    this.draw();
  }

  zoom(factor) {
    this.camera.position.sub(this.controls.target).multiplyScalar(factor).add(this.controls.target);
    this.controls.update();
    this.draw();
  }
}

/** The centre of the box around points (three numbers each), and the radius of a sphere that contains them. */
function boundsOf(lists) {
  const box = new THREE.Box3();
  const point = new THREE.Vector3();
  for (const positions of lists) {
    for (let i = 0; i < positions.length; i += 3) box.expandByPoint(point.fromArray(positions, i));
  }
  if (box.isEmpty()) box.expandByPoint(point.set(0, 0, 0));
  const sphere = box.getBoundingSphere(new THREE.Sphere());
  return { center: sphere.center, radius: sphere.radius || 1, lists };
}
