// What acts on the held part: contact points with normals (hollow and faint on its far side), nearest-feature pairs, the force of each contact and its cone of
// friction, force and torque on the pen. Drawn over the parts, for most of it happens between them.
import * as THREE from "three";
import { disk, ring } from "../common/disk.js";
import { cssColor } from "../common/theme.js";
import { round125 } from "./compass.js";
import { distance, norm } from "./frame.js";
import { FrictionCones } from "./friction.js";

const maxPairs = 128;
const maxForces = 6;
// An arrow shorter than this share of the held part's radius is left out.
const minArrow = 0.05;

const over = { depthTest: false, depthWrite: false, transparent: true };

class Arrow {
  constructor(double) {
    this.material = new THREE.MeshBasicMaterial(over);
    const up = (geometry) => geometry.rotateX(Math.PI / 2); // along +z
    this.shaft = new THREE.Mesh(up(new THREE.CylinderGeometry(0.5, 0.5, 1, 12).translate(0, 0.5, 0)), this.material);
    const cone = up(new THREE.ConeGeometry(1.3, 4, 16).translate(0, -2, 0));
    this.heads = Array.from({ length: double ? 2 : 1 }, () => new THREE.Mesh(cone, this.material));
    this.group = new THREE.Group();
    this.group.add(this.shaft, ...this.heads);
    this.group.traverse((o) => (o.renderOrder = 12));
  }
  show(from, vector, thickness) {
    this.length = norm(vector);
    this.group.visible = this.length > 0;
    if (!this.group.visible) return;
    const head = Math.min(thickness, this.length / (5 * this.heads.length));
    thickness = Math.min(thickness, 1.5 * head); // a short arrow is a slim one
    this.group.position.copy(from);
    this.group.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), new THREE.Vector3(...vector).divideScalar(this.length));
    this.shaft.scale.set(thickness, thickness, Math.max(this.length - 4 * head * this.heads.length, 1e-9));
    this.heads.forEach((mesh, i) => {
      mesh.position.z = this.length - 4 * head * i;
      mesh.scale.set(thickness * 1.2, thickness * 1.2, head);
    });
  }
}

function dots(size, map = disk()) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * maxPairs), 3));
  const object = new THREE.Points(geometry, new THREE.PointsMaterial({ size, map, sizeAttenuation: false, ...over }));
  object.frustumCulled = false;
  return object;
}

function segments(opacity = 1) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(6 * maxPairs), 3));
  const object = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ ...over, opacity }));
  object.frustumCulled = false;
  return object;
}

function fill(object, numbers) {
  const attribute = object.geometry.getAttribute("position");
  attribute.array.set(numbers);
  attribute.needsUpdate = true;
  object.geometry.setDrawRange(0, numbers.length / 3);
}

const along = (p, n, s) => [p[0] + s * n[0], p[1] + s * n[1], p[2] + s * n[2]];

// To hundredths: what is less is not seen.
const rounded = (v) => (Array.isArray(v) ? v.map(rounded) : Math.round(100 * Number(v)));

export class Overlay {
  constructor(stage) {
    this.stage = stage;
    this.force = new Arrow(false);
    this.torque = new Arrow(true);
    this.exerted = Array.from({ length: maxForces }, () => new Arrow(false));
    this.cones = new FrictionCones(over);
    this.contacts = dots(9);
    this.normals = segments();
    this.farContacts = dots(11, ring());
    this.farNormals = segments(0.35);
    this.far = [];
    this.near = dots(5);
    this.links = segments();
    this.group = new THREE.Group();
    this.layers = { contacts: [this.contacts, this.normals, this.farContacts, this.farNormals], pairs: [this.near, this.links], forces: [...this.exerted.map((shape) => shape.group), this.cones.object], arrows: [this.force.group, this.torque.group] };
    this.enabled = { contacts: true, pairs: true, forces: true, arrows: true };
    for (const object of [this.links, this.near, ...this.layers.contacts]) object.renderOrder = 10;
    this.group.add(...Object.values(this.layers).flat());
    stage.scene.add(this.group);
  }

  setScene(about) {
    if (!this.stage.held) return;
    const radius = this.stage.held.radius;
    this.center = new THREE.Vector3(...about.center);
    this.unit = radius;
    // What a hand often feels is about as long as the part.
    this.metersPerNewton = round125((2 * radius) / 1);
    this.metersPerNewtonMeter = round125((2 * radius) / 0.01);
  }

  applyTheme() {
    this.force.material.color.set(cssColor("--force"));
    this.torque.material.color.set(cssColor("--torque"));
    for (const shape of this.exerted) shape.material.color.set(cssColor("--contact"));
    this.cones.object.material.color.set(cssColor("--contact"));
    for (const object of this.layers.contacts) object.material.color.set(cssColor("--contact"));
    this.near.material.color.set(cssColor("--pair"));
    this.links.material.color.set(cssColor("--pair"));
  }

  enable(layer, on) {
    this.enabled[layer] = on;
    for (const object of this.layers[layer]) object.visible = on;
    this.stage.draw();
  }

  // Nothing of it is where the parts are while they are apart.
  hide(hidden) {
    this.group.visible = !hidden;
  }

  // Returns whether it shows something else than before.
  show(frame) {
    const [x, y, z, qw, qx, qy, qz] = frame.x;
    const center = this.center.clone().applyQuaternion(new THREE.Quaternion(qx, qy, qz, qw)).add(new THREE.Vector3(x, y, z));
    const before = JSON.stringify(this.seen);
    this.seen = [frame.force, frame.torque.map((v) => 100 * v), frame.pairs.map((p) => [p.touching, p.part, ...p.point.map((v) => (100 * v) / this.unit)])].map(rounded);
    const arrow = (shape, layer, from, vector, scale) => {
      const scaled = vector.map((v) => v * scale);
      shape.show(from, norm(scaled) < minArrow * this.unit ? [0, 0, 0] : scaled, 0.035 * this.unit);
      shape.group.visible &&= this.enabled[layer];
    };
    arrow(this.force, "arrows", center, frame.force, this.metersPerNewton);
    arrow(this.torque, "arrows", center, frame.torque, this.metersPerNewtonMeter);
    this.exerted.forEach((shape, i) => {
      const { point, force } = frame.forces[i] ?? { point: [0, 0, 0], force: [0, 0, 0] };
      arrow(shape, "forces", new THREE.Vector3(...point), force, this.metersPerNewton);
    });
    const friction = this.cones.show(frame.forces, this.metersPerNewton, 0.3 * this.unit);
    const touching = frame.pairs.filter((pair) => pair.touching);
    const near = frame.pairs.filter((pair) => !pair.touching);
    this.showContacts(touching);
    fill(this.near, near.flatMap((p) => p.point));
    fill(this.links, near.flatMap((p) => [...p.point, ...along(p.point, p.normal, -p.gap)]));
    this.shown = { contacts: touching.length, far: this.farCount, pairs: near.length, forces: this.exerted.filter((shape) => shape.group.visible).length, friction };
    return JSON.stringify(this.seen) !== before;
  }

  showContacts(touching) {
    const isFar = ({ point }) => this.far.reduce((best, known) => (distance(known.point, point) < distance(best.point, point) ? known : best), this.far[0])?.far ?? false;
    const [near, far] = [false, true].map((which) => touching.filter((p) => isFar(p) === which));
    const draw = (pairs, points, normals) => {
      fill(points, pairs.flatMap((p) => p.point));
      fill(normals, pairs.flatMap((p) => [...p.point, ...along(p.point, p.normal, 0.35 * this.unit)]));
    };
    draw(near, this.contacts, this.normals);
    draw(far, this.farContacts, this.farNormals);
    this.farCount = far.length;
  }

  // far: [{point, far}], contacts of which it is known whether the held part stands before them.
  setFar(far, frame) {
    const before = JSON.stringify(this.far.map((known) => known.far));
    this.far = far;
    if (JSON.stringify(far.map((known) => known.far)) === before || !this.shown) return;
    this.showContacts(frame.pairs.filter((p) => p.touching));
    this.shown.far = this.farCount;
    this.stage.draw();
  }
}
