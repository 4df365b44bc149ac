import * as THREE from "three";

// A white disk for points; their material gives it its color.
export const disk = () => round(0);
// The same, hollow.
export const ring = () => round(10);

const side = 32;

// inner: radius of the hole.
function round(inner) {
  const data = new Uint8Array(4 * side * side);
  for (let i = 0; i < side * side; ++i) {
    const r = Math.hypot((i % side) + 0.5 - side / 2, Math.floor(i / side) + 0.5 - side / 2);
    data.set([255, 255, 255, 255 * Math.min(1, Math.max(0, side / 2 - r), inner > 0 ? Math.max(0, r - inner) : 1)], 4 * i);
  }
  const texture = new THREE.DataTexture(data, side, side);
  texture.magFilter = texture.minFilter = THREE.LinearFilter;
  texture.needsUpdate = true;
  return texture;
}
