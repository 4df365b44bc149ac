// Which way the axes point, and how large things are: the triad and the scale bar in the picture's corner.
import * as THREE from "three";
import { length } from "../common/number.js";

const colors = { x: "--axis-x", y: "--axis-y", z: "--axis-z" };
const arm = 24; // px
const widest = 120; // px, of the bar
const svg = (tag, attributes) => {
  const e = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) e.setAttribute(name, value);
  return e;
};

// 1, 2 or 5 times a power of ten, not above `value`.
export function round125(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return ([5, 2, 1].find((k) => k * power <= value * 1.0001) ?? 1) * power;
}

export class Compass {
  constructor(viewpoint, triad, bar) {
    Object.assign(this, { viewpoint, triad, bar });
    this.arms = Object.entries(colors).map(([name, color], k) => {
      const line = svg("line", { class: "arm" }), text = svg("text", { "text-anchor": "middle", "dominant-baseline": "central" });
      text.textContent = name;
      for (const e of [line, text]) e.style.setProperty("--axis", `var(${color})`);
      triad.append(line, text);
      return { k, line, text };
    });
  }

  // As one looks now.
  show() {
    const eye = this.viewpoint.stage.camera.quaternion.clone().invert();
    const ends = this.arms.map((a) => ({ ...a, end: new THREE.Vector3().setComponent(a.k, 1).applyQuaternion(eye) }));
    for (const { line, text, end } of ends.sort((a, b) => a.end.z - b.end.z)) {
      line.setAttribute("x2", arm * end.x);
      line.setAttribute("y2", -arm * end.y);
      text.setAttribute("x", 1.38 * arm * end.x);
      text.setAttribute("y", -1.38 * arm * end.y);
      this.triad.append(line, text);
    }
    const perPixel = this.viewpoint.viewHeight() / this.viewpoint.stage.canvas.clientHeight;
    if (!(perPixel > 0) || !Number.isFinite(perPixel)) return;
    const meters = round125(widest * perPixel);
    this.bar.style.width = `${meters / perPixel}px`;
    this.bar.textContent = length(meters, 3);
  }
}
