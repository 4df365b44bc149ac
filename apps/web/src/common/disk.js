import * as THREE from "three";

// A white disk for points; their material gives it its color.
export function disk() {
  const side = 32;
  const data = new Uint8Array(4 * side * side);
  for (let i = 0; i < side * side; ++i) {
    const r = Math.hypot((i % side) + 0.5 - side / 2, Math.floor(i / side) + 0.5 - side / 2);
    data.set([255, 255, 255, 255 * Math.min(1, Math.max(0, side / 2 - r))], 4 * i);
  }
  const texture = new THREE.DataTexture(data, side, side);
  texture.magFilter = texture.minFilter = THREE.LinearFilter;
  texture.needsUpdate = true;
  return texture;
}
