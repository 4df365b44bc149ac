// Friction where contacts carry force: the cone that the force lies in, and which way the contact slides. A contact that
// sticks has a closed ring, one that slides a broken ring and an arrow along the surface, so that color is not needed.
import * as THREE from "three";
import { norm } from "./frame.js";

const ringSegments = 32;
const sides = 8;
const maxVertices = 6 * 2 * (ringSegments + sides + 3);

const add = (a, b, s = 1) => [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (v) => v.map((x) => x / norm(v));

// The end points of line segments, one after the other. `scale`: m for a newton; `length` of the arrow, m.
export function coneSegments({ point, normal, friction, mu, slides }, scale, length) {
  const height = norm(normal) * scale;
  if (!(mu > 0) || !(height > 0)) return [];
  const n = unit(normal);
  const first = unit(cross(n, Math.abs(n[0]) < 0.6 ? [1, 0, 0] : [0, 1, 0]));
  const second = cross(n, first);
  const base = add(point, n, height);
  const rim = (i, count) => {
    const a = (2 * Math.PI * i) / count;
    return add(add(base, first, mu * height * Math.cos(a)), second, mu * height * Math.sin(a));
  };
  const out = [];
  for (let i = 0; i < ringSegments; ++i) if (!slides || i % 2 === 0) out.push(rim(i, ringSegments), rim(i + 1, ringSegments));
  for (let i = 0; i < sides; ++i) out.push(point, rim(i, sides));
  if (slides && norm(friction) > 0) {
    const way = unit(friction).map((x) => -x);
    const aside = cross(n, way);
    const tip = add(point, way, length);
    out.push(point, tip);
    for (const side of [1, -1]) out.push(tip, add(add(tip, way, -0.25 * length), aside, 0.12 * length * side));
  }
  return out;
}

export class FrictionCones {
  constructor(material) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * maxVertices), 3));
    this.object = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial(material));
    this.object.frustumCulled = false;
    this.object.renderOrder = 11;
  }

  // Returns how many contacts stick and slide.
  show(forces, scale, length) {
    const rubbing = forces.filter((f) => f.mu > 0);
    const points = rubbing.flatMap((f) => coneSegments(f, scale, length));
    const attribute = this.object.geometry.getAttribute("position");
    attribute.array.set(points.flat());
    attribute.needsUpdate = true;
    this.object.geometry.setDrawRange(0, points.length);
    const slide = rubbing.filter((f) => f.slides).length;
    return { stick: rubbing.length - slide, slide };
  }
}
