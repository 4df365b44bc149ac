// The section plane: along an axis, along the screen or along a face, moved by a slider, keys, or its handle in the
// picture; Shift on the handle tilts it. What is cut away is on the eye's side, so that one sees the cut.
import * as THREE from "three";
import { length } from "../common/number.js";
import { cssColor } from "../common/theme.js";
import { toggle } from "./controls.js";
import { project, rayAt } from "./picking.js";

const $ = (id) => document.getElementById(id);
const grabPixels = 22;
const tiltPerPixel = 0.006; // rad
const keyTilt = (3 * Math.PI) / 180, keyMove = 0.01; // rad, share of the scene's reach
// Where one looks along the handle by less than this, a pixel would move it far: its way is then up and down the screen.
const along = Math.cos((20 * Math.PI) / 180);
// Of the reach: faces that lie exactly in the plane would be cut here and not there, by rounding.
const aside = 1e-4;

export class Section {
  // picked(): the normal of the face that was picked last, or null. changed(keys): whether keys move it, for the page to show.
  constructor(stage, viewpoint, { picked, changed }) {
    Object.assign(this, { stage, viewpoint, picked, changed, normal: null, kind: "off", keys: false });
    const kinds = { off: "Off", x: "x", y: "y", z: "z", screen: "Screen", face: "Face" };
    this.buttons = Object.entries(kinds).map(([kind, label]) => {
      const button = toggle(label, kind === "off", () => this.set(kind));
      button.dataset.kind = kind;
      button.title = { screen: "Across the way one looks", face: "Along the face that was picked last" }[kind] ?? "";
      return button;
    });
    document.querySelector("#section .group").append(...this.buttons);
    $("cut").addEventListener("input", () => this.apply());
    $("flip").addEventListener("change", () => this.apply());
    this.addHandle();
  }

  set(kind) {
    const axis = ["x", "y", "z"].indexOf(kind);
    let normal = null;
    if (axis >= 0) normal = new THREE.Vector3().setComponent(axis, -1);
    if (kind === "screen") normal = this.viewpoint.axis(2).negate();
    if (kind === "face") {
      normal = this.picked()?.clone().negate() ?? null;
      if (!normal) return;
    }
    if (normal?.dot(this.viewpoint.axis(2)) > 1e-3) normal.negate();
    Object.assign(this, { kind, normal });
    if (!normal) this.letGo();
    this.place = this.stage.box.getCenter(new THREE.Vector3());
    $("flip").checked = false;
    $("cut").value = 0.5;
    this.apply();
  }
  next() {
    const order = ["off", "x", "y", "z"];
    this.set(order[(order.indexOf(this.kind) + 1) % 4]);
  }
  // By such a share of what there is.
  shift(by) {
    if (!this.normal) return;
    $("cut").value = Number($("cut").value) + by;
    this.apply();
  }
  // About the handle's place: right about the screen's up, down about its right.
  tilt(right, down) {
    if (!this.normal) return;
    this.place.copy(this.handle.position);
    this.normal.applyAxisAngle(this.viewpoint.axis(1), right).applyAxisAngle(this.viewpoint.axis(0), down).normalize();
    this.kind = "tilted";
    const [low, high] = this.reach();
    $("cut").value = (high - this.place.dot(this.normal)) / (high - low);
    this.apply();
  }

  // The plane is moved and tilted by keys, or no longer.
  toggleKeys() {
    this.keys = this.normal !== null && !this.keys;
    this.changed(this.keys);
  }
  letGo() {
    if (this.keys) this.toggleKeys();
  }
  // Whether the key was the plane's.
  key(event) {
    const by = { ArrowRight: [keyTilt, 0], ArrowLeft: [-keyTilt, 0], ArrowUp: [0, -keyTilt], ArrowDown: [0, keyTilt] }[event.key];
    const pages = { PageUp: -keyMove, PageDown: keyMove }[event.key];
    if (!this.keys || (!by && !pages) || event.shiftKey) return false;
    if (by) this.tilt(...by);
    else this.shift(pages);
    return true;
  }

  // How far the scene reaches along the normal: [low, high].
  reach() {
    const { min, max } = this.stage.box;
    const along = [0, 1, 2, 3, 4, 5, 6, 7].map((i) => new THREE.Vector3(i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z).dot(this.normal));
    return [Math.min(...along), Math.max(...along)];
  }

  apply() {
    const on = this.normal !== null;
    $("cut").disabled = $("flip").disabled = !on;
    for (const button of this.buttons) button.setAttribute("aria-pressed", String(button.dataset.kind === this.kind));
    let plane = null;
    if (on) {
      const [low, high] = this.reach();
      const at = high + Number($("cut").value) * (low - high);
      this.showHandle(new THREE.Plane(this.normal, -at), high - low);
      const axis = ["x", "y", "z"].indexOf(this.kind);
      $("cut").setAttribute("aria-valuetext", axis < 0 ? length(-at) : `${this.kind} ${length(this.handle.position.getComponent(axis))}`);
      plane = new THREE.Plane(this.normal.clone(), -at);
      if ($("flip").checked) plane.negate();
      plane.constant -= aside * (high - low);
    }
    this.handle.visible = on;
    this.stage.setSection(plane);
  }

  addHandle() {
    this.material = new THREE.MeshBasicMaterial({ depthTest: false, transparent: true, opacity: 0.9 });
    const up = (geometry) => geometry.rotateX(Math.PI / 2);
    this.handle = new THREE.Group();
    this.handle.add(new THREE.Mesh(up(new THREE.CylinderGeometry(0.06, 0.06, 1, 10)), this.material));
    for (const s of [1, -1]) this.handle.add(new THREE.Mesh(up(new THREE.ConeGeometry(0.22, 0.6, 16)).rotateX(s < 0 ? Math.PI : 0).translate(0, 0, 0.7 * s), this.material));
    this.handle.add(new THREE.Mesh(new THREE.SphereGeometry(0.18, 16, 12), this.material));
    this.handle.renderOrder = 20;
    this.handle.visible = false;
    this.stage.scene.add(this.handle);
    const place = this.stage.canvas.parentElement;
    place.addEventListener("pointerdown", (event) => this.down(event), { capture: true });
    place.addEventListener("pointermove", (event) => this.move(event));
    for (const type of ["pointerup", "pointercancel"]) place.addEventListener(type, () => this.release());
  }

  showHandle(plane, reach) {
    this.material.color.set(cssColor("--accent"));
    plane.projectPoint(this.place, this.handle.position);
    this.handle.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), plane.normal);
    this.handle.scale.setScalar(0.07 * this.stage.radius);
    this.length = reach;
  }

  down(event) {
    if (!this.normal || event.button !== 0 || event.target !== this.stage.canvas) return;
    const [x, y] = project(this.stage, this.handle.position);
    if (Math.hypot(event.clientX - x, event.clientY - y) > grabPixels) return;
    event.stopPropagation();
    event.preventDefault();
    this.viewpoint.controls.enabled = false;
    this.stage.canvas.setPointerCapture(event.pointerId);
    this.grip = { x: event.clientX, y: event.clientY };
    this.regrip(event);
  }

  // A motion along the handle begins here.
  regrip(event) {
    const sight = this.handle.position.clone().sub(this.stage.camera.position);
    const metersPerPixel = this.viewpoint.viewHeight(sight.length()) / this.stage.canvas.clientHeight;
    const slope = sight.normalize().dot(this.normal);
    // Up the screen is away from the eye.
    this.grip.upright = Math.abs(slope) > along ? -Math.sign(slope) * metersPerPixel : null;
    Object.assign(this.grip, { at: Number($("cut").value), on: this.alongAt(event) });
  }

  // How far along the handle's axis the pointer points.
  alongAt(event) {
    if (this.grip.upright !== null) return event.clientY * this.grip.upright;
    const { ray } = rayAt(this.stage, event.clientX, event.clientY);
    const end = this.handle.position.clone().addScaledVector(this.normal, 1e3 * this.stage.radius);
    const from = this.handle.position.clone().addScaledVector(this.normal, -1e3 * this.stage.radius);
    const nearest = new THREE.Vector3();
    ray.distanceSqToSegment(from, end, undefined, nearest);
    return nearest.dot(this.normal);
  }

  move(event) {
    if (!this.grip) return;
    const [dx, dy] = [event.clientX - this.grip.x, event.clientY - this.grip.y];
    Object.assign(this.grip, { x: event.clientX, y: event.clientY });
    if (event.shiftKey) {
      this.tilt(dx * tiltPerPixel, dy * tiltPerPixel);
      return this.regrip(event);
    }
    $("cut").value = this.grip.at - (this.alongAt(event) - this.grip.on) / this.length;
    this.apply();
  }

  release() {
    if (!this.grip) return;
    this.grip = null;
    this.viewpoint.controls.enabled = true;
  }
}
