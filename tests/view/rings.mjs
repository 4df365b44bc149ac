// A scene of many triangles: twelve bumpy rings of 24 960 each.
import { writeFileSync } from "node:fs";
import { join } from "node:path";

const [around, across] = [156, 80];
export const ringTriangles = 12 * 2 * around * across;

function ring(bumps) {
  const lines = [];
  for (let i = 0; i < around; ++i)
    for (let j = 0; j < across; ++j) {
      const [a, b] = [(2 * Math.PI * i) / around, (2 * Math.PI * j) / across];
      const r = 7 * (1 + 0.12 * Math.sin(bumps * a) * Math.cos(3 * b));
      const out = 20 + r * Math.cos(b);
      lines.push(`v ${[out * Math.cos(a), out * Math.sin(a), r * Math.sin(b)].map((v) => v.toFixed(5)).join(" ")}`);
    }
  const at = (i, j) => 1 + (i % around) * across + (j % across);
  for (let i = 0; i < around; ++i)
    for (let j = 0; j < across; ++j) {
      lines.push(`f ${at(i, j)} ${at(i + 1, j)} ${at(i + 1, j + 1)}`, `f ${at(i, j)} ${at(i + 1, j + 1)} ${at(i, j + 1)}`);
    }
  return lines.join("\n") + "\n";
}

// The scene file; no part of it is held.
export function writeRings(folder) {
  let text = 'unit = "mm"\n';
  for (let k = 0; k < 12; ++k) {
    writeFileSync(join(folder, `ring${k}.obj`), ring(5 + k));
    text += `[[part]]\nname = "ring ${k}"\nmesh = "ring${k}.obj"\nposition = [${0.06 * (k % 4)}, ${0.06 * Math.floor(k / 4)}, 0]\n`;
  }
  writeFileSync(join(folder, "rings.toml"), text);
  return join(folder, "rings.toml");
}

// Orbits for so many ms, a step a picture.
export const orbit = (page, ms) => page.evaluate((duration) => new Promise((done) => {
  const end = performance.now() + duration;
  const step = () => {
    if (performance.now() > end) return done();
    dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowRight" }));
    requestAnimationFrame(step);
  };
  requestAnimationFrame(step);
}), ms);
