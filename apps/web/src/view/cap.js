// The face that a section plane makes of a closed part, in the plane itself: faces of parts that touch are beside each
// other there, where the inner sides behind the plane are also the other part's outer sides.
// It is where a ray that begins at the plane leaves the part once more than it comes in: the stencil counts that.
import * as THREE from "three";

const square = new THREE.PlaneGeometry(2, 2);
const ahead = new THREE.Vector3(0, 0, 1);
const drawnAfter = 100; // all surfaces

// Counts the triangles that are seen from this side, whatever stands before them.
function counter(side, op) {
  return new THREE.MeshBasicMaterial({
    side, colorWrite: false, depthWrite: false, depthTest: false,
    stencilWrite: true, stencilFunc: THREE.AlwaysStencilFunc, stencilFail: op, stencilZFail: op, stencilZPass: op,
  });
}

// What the face is drawn with besides its color: only where the count is not 0, and it leaves a 0 everywhere. Of parts that
// overlap the same one is always on top.
export const whereCounted = (number) => ({
  side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 0, polygonOffsetUnits: -4 * (number + 1),
  stencilWrite: true, stencilFunc: THREE.NotEqualStencilFunc, stencilRef: 0,
  stencilFail: THREE.ZeroStencilOp, stencilZFail: THREE.ZeroStencilOp, stencilZPass: THREE.ZeroStencilOp,
});

export class Cap {
  // material: of the face. `face` goes into the world, `counters` go with the part.
  constructor(geometry, material, number) {
    this.face = new THREE.Mesh(square, material);
    this.counters = [counter(THREE.BackSide, THREE.IncrementWrapStencilOp), counter(THREE.FrontSide, THREE.DecrementWrapStencilOp)].map((m) => new THREE.Mesh(geometry, m));
    for (const mesh of this.counters) mesh.renderOrder = drawnAfter + 2 * number;
    this.face.renderOrder = drawnAfter + 2 * number + 1;
    this.cut(null);
  }

  // section: the plane that cuts the part, or null.
  cut(section) {
    this.section = section;
    for (const { material } of this.counters) {
      material.clippingPlanes = section ? [section] : null;
      material.needsUpdate = true;
    }
    if (!section) this.show(false);
  }

  show(on) {
    for (const mesh of [this.face, ...this.counters]) mesh.visible = on;
    return on;
  }

  // Puts the face where the plane cuts the ball around the part.
  place({ center, radius }, shown) {
    const off = this.section?.distanceToPoint(center);
    if (!this.show(shown && Math.abs(off) < radius)) return;
    this.section.projectPoint(center, this.face.position);
    this.face.quaternion.setFromUnitVectors(ahead, this.section.normal);
    this.face.scale.setScalar(1.01 * Math.sqrt(radius * radius - off * off));
  }
}
