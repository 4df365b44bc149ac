// The mouse, or the keys, as the pen: where the hand should carry the held part. The program's simulated hand goes there
// through its spring, and feels what is in the way.
import * as THREE from "three";

const turnPerPixel = 0.006; // rad
const keyMove = 0.02, keyTurn = (1.5 * Math.PI) / 180; // share of the held part's radius, rad
const wheelMove = 0.0011; // of the picture's height in the world, for a unit of the wheel

export class Hand {
  // lead(pose): sends the hand somewhere. changed(what): for the page to show. turns: a drag turns the part, and moves
  // it with Shift.
  constructor(stage, viewpoint, { lead, changed }) {
    Object.assign(this, { stage, viewpoint, lead, changed, enabled: false, turns: false, grip: null, keys: false });
    const place = stage.canvas.parentElement;
    // Before the camera's controls see the pointer.
    place.addEventListener("pointerdown", (event) => this.down(event), { capture: true });
    place.addEventListener("pointermove", (event) => this.move(event));
    for (const type of ["pointerup", "pointercancel"]) place.addEventListener(type, () => this.release());
    place.addEventListener("wheel", (event) => this.wheel(event), { capture: true, passive: false });
  }

  setScene(about) {
    this.center = new THREE.Vector3(...about.center);
    if (this.grip) this.viewpoint.controls.enabled = true;
    this.goal = null;
    this.grip = null;
    this.keys = false;
    this.frame = null; // that there is, is of another part
    this.changed("");
  }

  showFrame(frame) {
    this.frame = frame;
  }

  // Takes the part where the pen has it now.
  take() {
    const y = this.frame.y;
    this.goal = { p: new THREE.Vector3(y[0], y[1], y[2]), q: new THREE.Quaternion(y[4], y[5], y[6], y[3]) };
  }

  down(event) {
    if (!this.enabled || !this.frame || event.button !== 0 || event.target !== this.stage.canvas) return;
    if (!event.isPrimary) return this.release(); // a second finger pans
    const hit = this.stage.pick(event.clientX, event.clientY);
    if (!hit?.part.held) return;
    event.stopPropagation();
    this.viewpoint.controls.enabled = false;
    this.stage.canvas.setPointerCapture(event.pointerId);
    if (!this.keys) this.take();
    this.grip = { x: event.clientX, y: event.clientY, depth: this.stage.camera.position.distanceTo(hit.point) };
    this.changed("drag");
  }

  move(event) {
    if (!this.grip) return;
    const [dx, dy] = [event.clientX - this.grip.x, event.clientY - this.grip.y];
    Object.assign(this.grip, { x: event.clientX, y: event.clientY });
    if (event.shiftKey !== this.turns) this.turn(dx * turnPerPixel, dy * turnPerPixel);
    else {
      const metersPerPixel = this.viewpoint.viewHeight(this.grip.depth) / this.stage.canvas.clientHeight;
      this.shift(dx * metersPerPixel, -dy * metersPerPixel, 0);
    }
  }

  wheel(event) {
    if (!this.grip) return;
    event.preventDefault();
    event.stopPropagation();
    this.shift(0, 0, event.deltaY * wheelMove * this.viewpoint.viewHeight(this.grip.depth));
  }

  release() {
    if (!this.grip) return;
    this.grip = null;
    this.viewpoint.controls.enabled = true;
    if (!this.keys) this.letGo();
  }

  // Whether it carries the part now.
  get leads() {
    return this.goal !== null;
  }

  // The hand comes to where the part is, and nothing presses any more.
  letGo() {
    this.keys = false;
    if (this.goal) this.lead(this.frame.x);
    this.goal = null;
    this.changed("");
  }

  shift(right, up, near) {
    this.goal.p.addScaledVector(this.viewpoint.axis(0), right);
    this.goal.p.addScaledVector(this.viewpoint.axis(1), up);
    this.goal.p.addScaledVector(this.viewpoint.axis(2), near);
    this.send();
  }

  // About the center of mass: right about the eye's up, down about its right.
  turn(right, down, roll = 0) {
    const turn = new THREE.Quaternion().setFromAxisAngle(this.viewpoint.axis(1), right);
    turn.multiply(new THREE.Quaternion().setFromAxisAngle(this.viewpoint.axis(0), down));
    turn.multiply(new THREE.Quaternion().setFromAxisAngle(this.viewpoint.axis(2), roll));
    const center = this.center.clone().applyQuaternion(this.goal.q).add(this.goal.p);
    this.goal.q.premultiply(turn).normalize();
    this.goal.p.copy(center).sub(this.center.clone().applyQuaternion(this.goal.q));
    this.send();
  }

  send() {
    const { p, q } = this.goal;
    this.lead([p.x, p.y, p.z, q.w, q.x, q.y, q.z]);
  }

  toggleKeys() {
    if (!this.enabled || !this.frame) return;
    if (this.keys) return this.letGo();
    this.keys = true;
    this.take();
    this.changed("keys");
  }

  // Whether the key was the hand's.
  key(event) {
    const moves = { ArrowRight: [1, 0, 0], ArrowLeft: [-1, 0, 0], ArrowUp: [0, 1, 0], ArrowDown: [0, -1, 0], PageUp: [0, 0, -1], PageDown: [0, 0, 1] };
    const by = moves[event.key];
    if (!this.keys || !by) return false;
    if (event.shiftKey !== this.turns) this.turn(by[0] * keyTurn, -by[1] * keyTurn, -by[2] * keyTurn);
    else this.shift(...by.map((v) => v * keyMove * this.stage.held.radius));
    return true;
  }
}
