// Orbit, pan and zoom as in CAD programs, and the views along the axes.
import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

// The view directions: right, back, up. The view from straight above is tilted by a hair, or up would be undefined.
export const views = [
  ["Front", [0, -1, 0]],
  ["Back", [0, 1, 0]],
  ["Left", [-1, 0, 0]],
  ["Right", [1, 0, 0]],
  ["Top", [0, -1e-4, 1]],
  ["Bottom", [0, -1e-4, -1]],
  ["Isometric", [1, -1.25, 0.85]],
];
// By the axis that is up: which way right, back and up are.
const bases = {
  z: [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
  y: [[1, 0, 0], [0, 0, -1], [0, 1, 0]],
  x: [[0, 1, 0], [0, 0, 1], [1, 0, 0]],
};
// An eye that is so far away sees the same as one that is infinitely far: 0.05° of perspective over the picture.
const nearAngle = 30, farAngle = 0.1;
const keyStep = (5 * Math.PI) / 180;
const margin = 1.12;

export class Viewpoint {
  constructor(stage) {
    this.stage = stage;
    this.up = "z";
    this.fit = null; // what was brought into the picture last, and from where
    stage.onResize = () => this.refit();
    this.addControls();
    // The browser's own middle button (scrolling) and context menu are in the way.
    stage.canvas.addEventListener("mousedown", (event) => event.button === 1 && event.preventDefault());
  }

  addControls() {
    const target = this.controls?.target;
    this.controls?.dispose();
    this.controls = new OrbitControls(this.stage.camera, this.stage.canvas);
    Object.assign(this.controls, {
      enableDamping: false,
      zoomToCursor: true,
      mouseButtons: { LEFT: THREE.MOUSE.ROTATE, MIDDLE: THREE.MOUSE.ROTATE, RIGHT: THREE.MOUSE.PAN },
    });
    if (target) this.controls.target.copy(target);
    this.controls.addEventListener("change", () => this.changed());
  }

  // Which axis is up: "x", "y" or "z".
  setUp(axis) {
    this.up = axis;
    this.stage.camera.up.set(...bases[axis][2]);
    this.stage.sky.position.copy(this.stage.camera.up);
    this.addControls(); // they read it once
    this.limits();
    this.look(6);
  }

  get parallel() {
    return this.stage.camera.fov < 1;
  }
  // Without perspective, or with it; what is in the picture's middle keeps its size.
  setParallel(on) {
    if (on === this.parallel) return;
    const { camera } = this.stage;
    const height = this.viewHeight();
    camera.fov = on ? farAngle : nearAngle;
    const offset = camera.position.clone().sub(this.controls.target);
    camera.position.copy(this.controls.target).addScaledVector(offset.normalize(), height / (2 * this.slope()));
    camera.updateProjectionMatrix();
    this.limits();
    this.controls.update();
    this.changed();
  }
  slope() {
    return Math.tan((this.stage.camera.fov * Math.PI) / 360);
  }
  // How much of the world (m) the picture is high, at `distance` from the eye.
  viewHeight(distance = this.stage.camera.position.distanceTo(this.controls.target)) {
    return 2 * distance * this.slope();
  }

  changed() {
    const { camera, radius } = this.stage;
    const distance = camera.position.distanceTo(this.controls.target);
    camera.near = Math.max(distance - 4 * radius, distance / 200);
    camera.far = distance + 6 * radius;
    camera.updateProjectionMatrix();
    this.stage.draw(true);
  }

  limits() {
    const height = 2 * this.slope();
    this.controls.minDistance = this.stage.radius / (100 * height);
    this.controls.maxDistance = (this.stage.radius * 12) / height;
  }

  // From where view number `i` looks.
  direction(i) {
    const v = new THREE.Vector3();
    bases[this.up].forEach((axis, k) => v.addScaledVector(new THREE.Vector3(...axis), views[i][1][k]));
    return v;
  }

  // All of the box `given`, or of all parts, from the direction of view number `i`, or from where one is.
  look(i = null, given = null) {
    const box = given ?? this.stage.measure();
    if (box.isEmpty()) return;
    this.limits();
    const { camera } = this.stage;
    const center = box.getCenter(new THREE.Vector3());
    const direction = i === null ? camera.position.clone().sub(this.controls.target) : this.direction(i);
    this.controls.target.copy(center);
    camera.position.copy(center).add(direction.normalize());
    this.controls.update(); // turns the camera
    camera.position.copy(center).addScaledVector(direction, this.distanceFor(box, center));
    this.controls.update();
    this.changed();
    this.fit = { box: given, eye: camera.position.clone(), target: center };
  }
  // The same again, of another picture or of parts that have moved, unless somebody has gone elsewhere meanwhile.
  refit() {
    if (!this.fit) return;
    const { position } = this.stage.camera;
    const still = 1e-6 * position.distanceTo(this.controls.target);
    if (position.distanceTo(this.fit.eye) < still && this.controls.target.distanceTo(this.fit.target) < still) this.look(null, this.fit.box);
  }

  // How far from `center` the eye must be, looking as it does, so that all corners of `box` are in the picture.
  distanceFor(box, center) {
    const { aspect } = this.stage.camera;
    const up = this.slope() / margin;
    const axes = [0, 1, 2].map((k) => this.axis(k));
    let distance = 0;
    for (let corner = 0; corner < 8; ++corner) {
      const of = (bit, axis) => (corner & bit ? box.max : box.min)[axis];
      const arm = new THREE.Vector3(of(1, "x"), of(2, "y"), of(4, "z")).sub(center);
      const [x, y, z] = axes.map((axis) => arm.dot(axis));
      distance = Math.max(distance, z + Math.abs(x) / (up * aspect), z + Math.abs(y) / up);
    }
    return distance;
  }

  lookAt(part) {
    this.look(null, new THREE.Box3().setFromObject(part.group).expandByScalar(part.radius * 0.5));
  }

  orbit(right, up) {
    const offset = this.stage.camera.position.clone().sub(this.controls.target);
    const toY = new THREE.Quaternion().setFromUnitVectors(this.stage.camera.up, new THREE.Vector3(0, 1, 0));
    const s = new THREE.Spherical().setFromVector3(offset.applyQuaternion(toY));
    s.theta += right * keyStep;
    s.phi = Math.min(Math.PI - 1e-3, Math.max(1e-3, s.phi - up * keyStep));
    const v = new THREE.Vector3().setFromSpherical(s).applyQuaternion(toY.invert());
    this.stage.camera.position.copy(this.controls.target).add(v);
    this.controls.update();
    this.changed();
  }
  pan(right, up) {
    const { camera } = this.stage;
    const step = 0.09 * this.viewHeight();
    const by = this.axis(0).multiplyScalar(right * step).add(this.axis(1).multiplyScalar(up * step));
    camera.position.add(by);
    this.controls.target.add(by);
    this.controls.update();
    this.changed();
  }
  zoom(factor) {
    const { camera } = this.stage;
    camera.position.sub(this.controls.target).multiplyScalar(factor).add(this.controls.target);
    this.controls.update();
    this.changed();
  }

  // Axis of the camera in the world: 0 right, 1 up, 2 towards the eye.
  axis(i) {
    this.stage.camera.updateMatrixWorld();
    return new THREE.Vector3().setFromMatrixColumn(this.stage.camera.matrixWorld, i);
  }
}
