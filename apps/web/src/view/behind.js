// Which parts stand before the contacts: these are seen through, so that contacts are where they are and not like pins on
// a face in front of them. The held part stays solid: contacts on its far side are drawn hollow (overlay.js).
import * as THREE from "three";

const periodMs = 250; // a query casts rays through all triangles
const keepMs = 1200; // so that parts do not flicker with the contacts
const maxRays = 6;
const margin = 1e-3; // of the scene's radius: a contact lies on the faces that touch
const maxHeldRays = 12;
const heldMargin = 0.02; // of the held part's radius, which may be drawn coarsely

export class Behind {
  constructor(stage, overlay) {
    Object.assign(this, { stage, overlay, on: true, seen: new Map(), looked: -Infinity });
  }

  set(on) {
    this.on = on;
    this.clear();
  }

  clear() {
    this.seen.clear();
    this.stage.seeThrough(new Set());
  }

  // No part is held, so none has contacts.
  rest() {
    this.frame = null;
    this.overlay.far = [];
    this.clear();
  }

  // Also where nothing but the eye has moved, and until what is seen through no longer has to be.
  show(frame, now = performance.now()) {
    this.frame = frame;
    if (!frame || this.waiting) return;
    if (now - this.looked < periodMs) return this.later();
    this.looked = now;
    this.findFar(frame);
    if (!this.on || this.stage.section !== null || this.stage.explosion > 0) return this.clear();
    for (const pair of frame.pairs.filter((p) => p.touching).slice(0, maxRays)) for (const i of this.before(pair.point)) this.seen.set(i, now);
    for (const [i, when] of this.seen) if (now - when > keepMs) this.seen.delete(i);
    this.stage.seeThrough(new Set(this.seen.keys()));
    if ([...this.seen.values()].some((when) => when < now)) this.later();
  }

  later() {
    this.waiting = true;
    setTimeout(() => {
      this.waiting = false;
      this.show(this.frame);
    }, periodMs);
  }

  // Which contacts the held part itself stands before.
  findFar(frame) {
    const { held, section } = this.stage;
    const solid = held?.group.visible && !held.materials.surface.transparent && section === null;
    const touching = solid ? frame.pairs.filter((p) => p.touching).slice(0, maxHeldRays) : [];
    const far = touching.map(({ point }) => ({ point, far: this.isBefore(held, this.rayTo(point, heldMargin * held.radius)) }));
    this.overlay.setFar(far, frame);
  }

  // From the eye to so much before a point.
  rayTo(point, short) {
    const from = this.stage.camera.position;
    const to = new THREE.Vector3(...point).sub(from);
    const length = to.length();
    return new THREE.Raycaster(from, to.normalize(), 0, Math.max(0, length - short));
  }

  isBefore(part, ray) {
    const { coarse, surface } = this.stage.geometry[part.mesh];
    const mesh = new THREE.Mesh(coarse ?? surface);
    mesh.matrixWorld.copy(part.group.matrixWorld);
    return ray.intersectObject(mesh, false).length > 0;
  }

  // Numbers of the parts between the eye and a point, the held one not counted.
  before(point) {
    const ray = this.rayTo(point, margin * this.stage.radius);
    return this.stage.parts.flatMap((part, i) => (!part.held && part.group.visible && this.isBefore(part, ray) ? [i] : []));
  }
}
