// A STEP file dropped on the program: look at it, measure it, hold a part, move it, get the report; on three widths, light
// and dark, the narrowest with a finger. With TEGOTAE_PICTURES=FOLDER it leaves a picture of each step.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { folder, test } from "./cases.mjs";
import { patience, run, serve, state, until } from "./program.mjs";
import { at, dragTo, figure, fits, nothingComplains, openOn, partsAreSeen, picture, press, reported, saved } from "./screens.mjs";

// The assembly of tests/mesh/step_assembly.cpp in the world: its axis lies along -y. A plate with bushings, and under a cover
// with windows a shaft ("Welle") of 19.993 mm that stands out of its bushing by 25 mm.
const shaft = { end: [0.08, 0.17, 0.3], side: [0.08 + 0.00999 * Math.SQRT1_2, 0.18, 0.3 + 0.00999 * Math.SQRT1_2], right: [0.08 + 0.00999, 0.18, 0.3], diameter: 19.993e-3 };
const cover = [0.1, 0.195, 0.322];

const selectedName = (s) => s.parts[s.selected]?.name;
const heldName = (s) => s.parts.find((part) => part.held)?.name;

async function look(page, screen, shot) {
  const first = await state(page);
  assert.equal(heldName(first), undefined, "nobody has taken a part");
  assert.equal(first.frame, null);
  assert.equal(first.up, "z", "STEP says no axis that is up");
  assert.equal(first.parts.length, 7);
  assert.equal(await page.textContent("#rest-text"), "Nothing is held: click a part to take it.");
  assert.equal(await page.isVisible("#right"), false, "there are no values");
  await fits(page, screen);
  await partsAreSeen(page);
  await nothingComplains(page);
  await shot("look");
  await page.keyboard.press("e");
  await until(page, (s) => s.places[0].some((v, k) => Math.abs(v - first.places[0][k]) > 1e-3));
  await partsAreSeen(page);
  await page.keyboard.press("e");
  await page.panel("left");
  await partsAreSeen(page);
  assert.match(await page.textContent("#parts"), /Träger3.*Grundplatte.*Buchse links.*Deckel3/);
  await press(page, "#section [data-kind=z]");
  await until(page, (s) => s.section !== null);
  await page.panel("");
  await partsAreSeen(page);
  await shot("section");
  await page.panel("left");
  await press(page, "#section [data-kind=off]");
  await page.panel("");
  await page.focus("#stage canvas");
  await page.keyboard.press("7");
}

async function measure(page, shot) {
  await press(page, "#measure");
  await page.tapAt(await at(page, shaft.side));
  const round = await until(page, (s) => s.picked.length === 1);
  assert.deepEqual(round.picked, ["cylinder"]);
  assert.ok(Math.abs(figure(round, "Diameter") - shaft.diameter) < 2e-6, `${figure(round, "Diameter")} m`);
  await page.keyboard.press("Escape");
  await press(page, "#measure");
  await page.tapAt(await at(page, shaft.end));
  await page.tapAt(await at(page, cover));
  const gap = await until(page, (s) => s.picked.length === 2);
  assert.ok(Math.abs(figure(gap, "Gap along the normal") - 0.025) < 1e-6, `${figure(gap, "Gap along the normal")} m`);
  await shot("measure");
  await page.keyboard.press("Escape");
}

// Picked in the picture and taken where it is said.
async function hold(page, shot) {
  await page.tapAt(await at(page, shaft.side));
  const picked = await until(page, (s) => s.selected !== null);
  assert.equal(selectedName(picked), "Welle");
  assert.equal(await page.textContent("#rest-text"), "Welle");
  await shot("hold");
  await press(page, "#take-selected");
  const held = await until(page, (s) => heldName(s) === "Welle" && s.frame?.generation === s.status.generation);
  assert.ok(Math.hypot(...held.frame.x.slice(0, 3).map((v, k) => v - held.places[held.selected][k])) < 1e-5, "it is where it was");
  assert.equal(await page.isVisible("#rest"), false);
  assert.match(await page.textContent("#hand"), /^Drag the blue part/);
  return held.frame.x[1];
}

async function move(page, context, from, shot) {
  await page.keyboard.press("4"); // from the right: the shaft's axis lies across the screen
  await until(page, (s) => Math.abs(s.camera[1] - s.target[1]) < 1e-6 && s.frame.forceOn);
  const letGo = await dragTo(page, context, shaft.right, [shaft.right[0], shaft.right[1] - 0.02, shaft.right[2]]);
  await until(page, (s) => s.frame.x[1] < from - 0.015);
  const out = await state(page);
  for (const k of [0, 2]) assert.ok(Math.abs(out.frame.x[k] - shaft.end[k]) < 1e-3, "along its bushing");
  await page.keyboard.press("7");
  await shot("move");
  await letGo();
  return out;
}

// The part is put down where it is, and taken again by Undo.
async function putDown(page) {
  await page.panel("left");
  assert.equal(await page.textContent("#hold"), "Put down");
  await press(page, "#hold");
  const down = await until(page, (s) => heldName(s) === undefined);
  assert.equal(down.frame, null);
  await press(page, "#undo");
  const again = await until(page, (s) => heldName(s) === "Welle" && s.frame?.generation === s.status.generation);
  const place = down.places[down.parts.findIndex(({ name }) => name === "Welle")];
  assert.ok(Math.hypot(...again.frame.x.slice(0, 3).map((v, k) => v - place[k])) < 1e-4, "where it was put down");
  await press(page, "#restart");
  await until(page, (s) => heldName(s) === undefined);
  await page.panel("");
}

async function review(browser, page, screen, name) {
  const file = join(folder, `${name}.html`);
  const html = await saved(page, "#review", file);
  const about = reported(html);
  assert.ok(about.includes('"headline"') && about.includes("Welle"), "a report on the part that was moved");
  const told = await until(page, (s) => s.message.endsWith(".review.html."));
  const context = await browser.newContext({ viewport: { width: screen.width, height: screen.height }, colorScheme: screen.dark ? "dark" : "light" });
  const report = await context.newPage();
  await report.goto(`file://${file}`, { timeout: patience });
  await report.waitForSelector("#tables table", { timeout: patience });
  assert.ok(await report.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "nothing sticks out of the report");
  // Of 25 mm some 20 are gone: it is not out. The page has said so too.
  const verdict = await report.textContent("#verdict h2");
  assert.ok(told.message.startsWith(verdict), told.message);
  assert.match(verdict, /^It gets to its goal, [12]\d(\.\d)? mm on the way out; still inside Buchse links$/);
  await picture(report, `${name}-review`);
  await context.close();
}

const step = join(folder, "assembly.step");
const sizes = [{ width: 1366, height: 768 }, { width: 768, height: 1024 }, { width: 390, height: 844, touch: true }];

for (const screen of process.env.TEGOTAE_WRITE_ASSEMBLY ? sizes.flatMap((size) => [false, true].map((dark) => ({ ...size, dark }))) : []) {
  const name = `${screen.width}-${screen.dark ? "dark" : "light"}`;
  test(`a STEP file, ${name}`, async (browser) => {
    await run(process.env.TEGOTAE_WRITE_ASSEMBLY, step);
    const program = await serve("tegotae", "view", step);
    const { page, context } = await openOn(browser, program.url, screen, { runs: false });
    const shot = (what) => picture(page, `${name}-${what}`);
    await look(page, screen, shot);
    await measure(page, shot);
    const from = await hold(page, shot);
    await move(page, context, from, shot);
    await review(browser, page, screen, name);
    for (const panel of page.narrow ? ["left", "right"] : []) {
      await page.panel(panel);
      await fits(page, screen);
      await shot(panel);
    }
    await putDown(page);
    assert.deepEqual(page.complaints, []);
    await context.close();
    assert.equal(await program.stop(), 0);
  });
}

test("a glTF file is shown with y up, and another axis is chosen", async (browser) => {
  const gltf = join(folder, "box.gltf");
  writeGltf(gltf);
  const program = await serve("tegotae", "view", gltf);
  const { page, context } = await openOn(browser, program.url, { width: 1366, height: 768 }, { runs: false });
  const first = await until(page, (s) => s.up === "y");
  assert.equal(await page.inputValue("#up"), "y");
  // The box is 30 mm high along y: its upper corners are above its lower ones on the screen.
  const height = async (axis) => {
    const end = (s) => [0, 1, 2].map((k) => (k === axis ? s * 0.01 : 0));
    const [low, high] = [await at(page, end(-1)), await at(page, end(1))];
    return [low[1] - high[1], Math.abs(low[0] - high[0])];
  };
  const [up, across] = await height(1);
  assert.ok(up > 0 && across < 1, "y points up");
  assert.ok(first.camera[1] > first.target[1], "one looks from above");
  await page.selectOption("#up", "z");
  await until(page, (s) => s.up === "z");
  const [turned, aside] = await height(2);
  assert.ok(turned > 0 && aside < 1, "now z does");
  assert.deepEqual(page.complaints, []);
  await context.close();
  assert.equal(await program.stop(), 0);
});

// A box of 20 x 30 x 20 mm, as glTF.
function writeGltf(file) {
  const [x, y, z] = [0.01, 0.015, 0.01];
  const positions = Float32Array.from([0, 1, 2, 3, 4, 5, 6, 7].flatMap((i) => [i & 1 ? x : -x, i & 2 ? y : -y, i & 4 ? z : -z]));
  const indices = Uint32Array.from([0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5]);
  const data = Buffer.concat([Buffer.from(positions.buffer), Buffer.from(indices.buffer)]);
  const views = [{ buffer: 0, byteOffset: 0, byteLength: positions.byteLength }, { buffer: 0, byteOffset: positions.byteLength, byteLength: indices.byteLength }];
  const accessors = [
    { bufferView: 0, componentType: 5126, count: 8, type: "VEC3", min: [-x, -y, -z], max: [x, y, z] },
    { bufferView: 1, componentType: 5125, count: 36, type: "SCALAR" },
  ];
  writeFileSync(file, JSON.stringify({
    asset: { version: "2.0" }, scene: 0, scenes: [{ nodes: [0] }], nodes: [{ name: "box", mesh: 0 }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0 }, indices: 1 }] }], accessors, bufferViews: views,
    buffers: [{ byteLength: data.length, uri: `data:application/octet-stream;base64,${data.toString("base64")}` }],
  }));
}
