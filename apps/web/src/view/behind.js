// Which parts stand before the contacts: these are seen through, so that contacts are where they are and not like pins on
// a face in front of them.
import * as THREE from "three";

const periodMs = 250; // a query casts rays through all triangles
const keepMs = 1200; // so that parts do not flicker with the contacts
const maxRays = 6;
const margin = 1e-3; // of the scene's radius: a contact lies on the faces that touch

export class Behind {
  constructor(stage) {
    Object.assign(this, { stage, on: true, seen: new Map(), looked: -Infinity });
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
    this.clear();
  }

  // Also where nothing but the eye has moved, and until what is seen through no longer has to be.
  show(frame, now = performance.now()) {
    this.frame = frame;
    if (!this.on || !frame || this.waiting) return;
    if (now - this.looked < periodMs) return this.later();
    this.looked = now;
    if (this.stage.section !== null || this.stage.explosion > 0) return this.clear();
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

  // Numbers of the parts between the eye and a point, the held one not counted.
  before(point) {
    const { camera, parts, geometry, radius } = this.stage;
    const to = new THREE.Vector3(...point).sub(camera.position);
    const far = to.length() - margin * radius;
    const ray = new THREE.Raycaster(camera.position, to.normalize(), 0, far);
    return parts.flatMap((part, i) => {
      if (part.held || !part.group.visible) return [];
      const { coarse, surface } = geometry[part.mesh];
      const mesh = new THREE.Mesh(coarse ?? surface);
      mesh.matrixWorld.copy(part.group.matrixWorld);
      return ray.intersectObject(mesh, false).length > 0 ? [i] : [];
    });
  }
}
