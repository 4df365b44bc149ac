// The section plane in a real browser: what it cuts away, how it is moved and tilted, and what its cut looks like.
import assert from "node:assert/strict";
import { test } from "./cases.mjs";
import { writeBoxes } from "./floor.mjs";
import { open, serve, state, until } from "./program.mjs";
import { at, press } from "./screens.mjs";

const dot = (a, b) => a.reduce((sum, v, k) => sum + v * b[k], 0);
const sub = (a, b) => a.map((v, k) => v - b[k]);
const plus = (a, b, s) => a.map((v, k) => v + s * b[k]);
const unit = (v) => v.map((c) => c / Math.hypot(...v));
// Less than 0: the plane cuts away what is there.
const side = ({ section }, point) => dot(section.normal, point) + section.constant;
const place = ({ section }) => -section.constant; // along its normal

// Two boxes that touch at x = 0, in triangles of different sizes.
async function openBoxes(browser) {
  const program = await serve("tegotae", "view", writeBoxes("touching", [[[-10, -20, -20], [0, 20, 20]], [[0, -10, -10], [10, 10, 10]]]));
  const page = await open(browser, program.url, { runs: false });
  return { program, page };
}

async function done(program, page) {
  assert.deepEqual(page.complaints, []);
  await page.close();
  assert.equal(await program.stop(), 0);
}

const cut = async (page, kind) => {
  await press(page, `#section [data-kind=${kind}]`);
  return state(page);
};

// Drags the handle by so many pixels; what the page says then.
async function dragHandle(page, [dx, dy], key = null) {
  const from = await at(page, (await state(page)).handle);
  await page.mouse.move(...from);
  await page.mouse.down();
  if (key) await page.keyboard.down(key);
  for (let i = 1; i <= 8; ++i) await page.mouse.move(from[0] + (dx * i) / 8, from[1] + (dy * i) / 8);
  if (key) await page.keyboard.up(key);
  await page.mouse.up();
  return state(page);
}

test("a section is seen from where one looks first, and from everywhere where it is chosen", async (browser) => {
  const { program, page } = await openBoxes(browser);
  for (const view of ["7", "2", "3", "6"]) {
    await page.keyboard.press(view);
    for (const kind of ["x", "y", "z", "screen"]) {
      const s = await cut(page, kind);
      const eye = unit(sub(s.camera, s.target));
      // An eye in the plane sees no cut, whichever half is away.
      if (Math.abs(dot(s.section.normal, eye)) > 0.01) assert.ok(side(s, s.camera) < 0, `view ${view}, ${kind}: the half before the eye is away`);
    }
  }
  await page.keyboard.press("7");
  const s = await cut(page, "y");
  assert.deepEqual((await until(page, (now) => now.caps.length === 2)).caps, ["box 0", "box 1"]);
  await press(page, "#flip");
  assert.ok(side(await state(page), s.camera) > 0, "the other side");
  assert.ok(side(await cut(page, "z"), s.camera) < 0, "the next one is seen again");
  // Along the face that was clicked on, also when one has gone to its other side.
  await cut(page, "off");
  await page.mouse.click(...(await at(page, [0.01, 0.002, 0.003])));
  for (const view of ["7", "3"]) {
    await page.keyboard.press(view);
    const face = await cut(page, "face");
    assert.deepEqual(face.section.normal.map((v) => Math.round(Math.abs(v) * 1e6) / 1e6), [1, 0, 0]);
    assert.ok(side(face, face.camera) < 0, `the face's half before the eye is away in view ${view}`);
  }
  await done(program, page);
});

test("the section's handle goes with the mouse, also where one looks along it, and tilts about its place", async (browser) => {
  const { program, page } = await openBoxes(browser);
  const crosswise = await cut(page, "x");
  const way = sub(await at(page, plus(crosswise.handle, [1, 0, 0], 0.004)), await at(page, crosswise.handle));
  const dragged = await dragHandle(page, way);
  assert.ok(Math.abs(dragged.handle[0] - crosswise.handle[0] - 0.004) < 2e-4, `4 mm, and went ${dragged.handle[0] - crosswise.handle[0]} m`);

  for (const parallel of [false, true]) {
    if (parallel) await press(page, "#parallel");
    const begin = await cut(page, "screen");
    const eye = unit(sub(begin.camera, begin.target));
    const right = unit([-eye[1], eye[0], 0]);
    const pixels = Math.hypot(...sub(await at(page, plus(begin.handle, right, 1e-3)), await at(page, begin.handle))); // of a mm
    const up = await dragHandle(page, [0, -40]);
    const gone = place(up) - place(begin);
    assert.ok(Math.abs(gone * 1e3 * pixels - 40) < 2, `40 pixels away from the eye, and went ${gone * 1e3 * pixels}`);
    const back = await dragHandle(page, [0, 40]);
    assert.ok(Math.abs(place(back) - place(begin)) < 0.05 * gone, "and back");

    const handle = back.handle;
    const tilted = await dragHandle(page, [50, 0], "Shift");
    const angle = Math.acos(dot(tilted.section.normal, back.section.normal));
    assert.ok(Math.abs(angle - 50 * 0.006) < 1e-3, `${angle} rad`);
    assert.ok(Math.hypot(...sub(tilted.handle, handle)) < 1e-6, "about the handle");
    assert.ok(Math.abs(side(tilted, handle)) < 1e-5, "where the plane stays");
  }
  await done(program, page);
});

test("the section plane by keys", async (browser) => {
  const { program, page } = await openBoxes(browser);
  await page.keyboard.press("p");
  assert.equal(await page.textContent("#hand"), "", "without a plane there is none to tilt");
  const begin = await cut(page, "screen");
  await page.focus("#cut"); // which has keys of its own
  await page.keyboard.press("p");
  assert.match(await page.textContent("#hand"), /^The section plane by keys/);
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("ArrowRight");
  const turned = await state(page);
  assert.ok(Math.abs(Math.acos(dot(turned.section.normal, begin.section.normal)) - (6 * Math.PI) / 180) < 1e-6);
  assert.deepEqual(turned.camera, begin.camera);
  await page.keyboard.press("PageUp");
  const away = await state(page);
  assert.deepEqual(away.section.normal, turned.section.normal);
  assert.ok(Math.abs(side(away, away.camera)) > Math.abs(side(turned, turned.camera)), "away from the eye");
  await page.keyboard.press("Escape");
  assert.equal(await page.textContent("#hand"), "");
  await page.keyboard.press("ArrowRight");
  const left = await state(page);
  assert.deepEqual(left.section, away.section);
  assert.notDeepEqual(left.camera, away.camera, "the arrows are the camera's again");
  await done(program, page);
});

// The colors of a picture at these places of the screen. The page itself may read no picture, another one may.
async function colorsAt(browser, png, places) {
  const reader = await browser.newPage();
  const colors = await reader.evaluate(async ([url, all]) => {
    const image = new Image();
    image.src = url;
    await image.decode();
    const context = Object.assign(document.createElement("canvas"), { width: image.width, height: image.height }).getContext("2d");
    context.drawImage(image, 0, 0);
    return all.map(([x, y]) => [...context.getImageData(Math.round(x), Math.round(y), 1, 1).data].slice(0, 3));
  }, [`data:image/png;base64,${png.toString("base64")}`, places]);
  await reader.close();
  return colors;
}

// What lies behind the second part's cut is the face at which they touch, which the first part has as well. One is blue,
// the other red, and the hatching neither.
test("the cut of a part has that part's color all over, also where another part touches it", async (browser) => {
  const { program, page } = await openBoxes(browser);
  await page.evaluate(() => Object.entries({ "--part-0": "#0000c0", "--part-1": "#c00000", "--edge": "#000000" }).forEach((color) => document.documentElement.style.setProperty(...color)));
  for (const parallel of [false, true]) {
    if (parallel) await press(page, "#parallel");
    await cut(page, "y");
    await until(page, (s) => s.caps.length === 2 && s.last && !s.last.coarse);
    await page.waitForTimeout(500);
    const points = [1, 0].flatMap((second) => Array.from({ length: 9 * 19 }, (_, i) => [(second ? 1 : -1) * (1 + (i % 9)) * 1e-3, 0, ((i / 9 | 0) - 9) * 1e-3]));
    const places = [];
    for (const point of points) places.push(await page.evaluate((p) => window.__tegotae.project(p), point));
    const handle = await at(page, (await state(page)).handle);
    const colors = await colorsAt(browser, await page.screenshot(), places);
    colors.forEach(([r, g, b], i) => {
      if (Math.hypot(...sub(places[i], handle)) < 40) return;
      const own = points[i][0] > 0 ? r - b : b - r;
      assert.ok(own > 30, `rgb ${[r, g, b]} at ${points[i]}`);
    });
    // And what is clicked there is that part.
    await page.mouse.click(...(await at(page, [0.005, 0, -0.006])));
    await until(page, (s) => s.selected === 1);
    await page.mouse.click(...(await at(page, [-0.005, 0, -0.006])));
    await until(page, (s) => s.selected === 0);
    await page.mouse.click(...(await at(page, [0, -0.03, 0])));
    await until(page, (s) => s.selected === null);
  }
  await done(program, page);
});
