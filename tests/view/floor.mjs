// A scene of known sizes: a block over a floor; and the mouse that leads the block.
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { folder } from "./cases.mjs";

export const box = ([x0, y0, z0], [x1, y1, z1]) =>
  [[x0, y0, z0], [x1, y0, z0], [x1, y1, z0], [x0, y1, z0], [x0, y0, z1], [x1, y0, z1], [x1, y1, z1], [x0, y1, z1]].map((v) => `v ${v.join(" ")}\n`).join("") +
  ["1 4 3", "1 3 2", "5 6 7", "5 7 8", "1 2 6", "1 6 5", "2 3 7", "2 7 6", "3 4 8", "3 8 7", "4 1 5", "4 5 8"].map((f) => `f ${f}\n`).join("");

// A block of 10 mm held 3 mm over a wide floor (top at z = 0) by a hand that rests, or follows `script`.
export function writeFloor(script = "0,0,0,0.008,1,0,0,0\n") {
  writeFileSync(join(folder, "floor.obj"), box([-20, -20, -5], [20, 20, 0]));
  writeFileSync(join(folder, "block.obj"), box([-5, -5, -5], [5, 5, 5]));
  writeFileSync(join(folder, "rest.csv"), "t,px,py,pz,qw,qx,qy,qz\n" + script);
  writeFileSync(join(folder, "floor.toml"),
    'unit = "mm"\n[[part]]\nname = "floor"\nmesh = "floor.obj"\n' +
    '[[part]]\nname = "block <b>1</b>"\nmesh = "block.obj"\nheld = true\nposition = [0, 0, 0.008]\n[device]\nscript = "rest.csv"\n');
  return join(folder, "floor.toml");
}

// The floor is felt and shown.
export const pushesBack = (s) => s.frame.forceOn && s.frame.force[2] > 0.5 && s.shown.contacts >= 3 && s.arrows.force > 0;

// Boxes of mm, [[low, high], ...], as a scene in which nothing is held.
export function writeBoxes(name, boxes) {
  boxes.forEach(([low, high], i) => writeFileSync(join(folder, `${name}${i}.obj`), box(low, high)));
  writeFileSync(join(folder, `${name}.toml`), 'unit = "mm"\n' + boxes.map((_, i) => `[[part]]\nname = "box ${i}"\nmesh = "${name}${i}.obj"\n`).join(""));
  return join(folder, `${name}.toml`);
}

// Leads the part with the mouse, in the plane of the screen, to `below` m under where it is now.
export async function drag(page, below) {
  const [from, to] = await page.evaluate((d) => {
    const c = window.__tegotae.center();
    return [c, [c[0], c[1], c[2] - d]].map((p) => window.__tegotae.project(p));
  }, below);
  await page.mouse.move(...from);
  await page.mouse.down();
  for (let i = 1; i <= 12; ++i) {
    await page.mouse.move(from[0], from[1] + ((to[1] - from[1]) * i) / 12);
    await page.waitForTimeout(30);
  }
}
