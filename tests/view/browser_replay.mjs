// Recordings in a real browser, and what the page does with its picture.
import assert from "node:assert/strict";
import { join } from "node:path";
import { folder, scene, test } from "./cases.mjs";
import { open, run, serve, state, until } from "./program.mjs";

const recording = join(folder, "peg.csv"), file = join(folder, "peg.html");
// A run recorded there, and its page in a file; once.
let made = null;
const record = () => (made ??= (async () => {
  await run("tegotae", "run", scene, "--fast", "--record", recording);
  await run("tegotae", "replay", recording, scene, "--html", file);
})());

async function lookAtReplay(page) {
  const first = await state(page);
  assert.equal(first.mode, "replay");
  assert.ok(first.count > 7000);
  assert.equal(first.plots[0].points > 1000, true);
  // Two thirds in, the tilted peg jams: contacts, and a force.
  const deepest = await page.evaluate(() => {
    const bar = document.getElementById("scrub");
    for (let i = 0; i <= Number(bar.max); i += 20) {
      bar.value = i;
      bar.dispatchEvent(new Event("input"));
      const s = window.__tegotae.state;
      if (s.shown.contacts >= 2 && s.force > 0.2 && s.frame.t > 5) return s;
    }
    return null;
  });
  assert.ok(deepest, "a frame with contacts and a force");
  assert.ok(deepest.arrows.force > 0);
  const t = deepest.frame.t;
  await page.focus("#stage canvas");
  await page.keyboard.press(".");
  assert.ok((await state(page)).frame.t > t);
  await page.keyboard.press(",");
  await page.keyboard.press(",");
  assert.ok((await state(page)).frame.t < t);
  // The timeline by its keys, and a click into a plot.
  await page.focus("#scrub");
  await page.keyboard.press("End");
  const last = (await state(page)).frame.t;
  await page.keyboard.press("Home");
  assert.ok((await state(page)).frame.t < 1e-3 && last > 7);
  const plot = await page.locator(".plot .u-over").first().boundingBox();
  await page.mouse.click(plot.x + plot.width / 2, plot.y + plot.height / 2);
  assert.ok(Math.abs((await state(page)).frame.t / last - 0.5) < 0.02);
  await page.evaluate((at) => {
    const bar = document.getElementById("scrub");
    bar.value = at;
    bar.dispatchEvent(new Event("input"));
    document.activeElement.blur();
  }, deepest.frame.tick);
  await page.keyboard.press(" ");
  await until(page, (s) => s.frame.t > t + 0.2);
  await page.keyboard.press(" ");
  assert.deepEqual(page.complaints, []);
}

test("a recording, served", async (browser) => {
  await record();
  const program = await serve("tegotae", "replay", recording, scene);
  const page = await open(browser, program.url);
  await lookAtReplay(page);
  await page.close();
  assert.equal(await program.stop(), 0);
});

test("a recording in a file, without a server and without a network", async (browser) => {
  await record();
  const context = await browser.newContext({ offline: true, viewport: { width: 1366, height: 680 } });
  const page = await open({ newPage: () => context.newPage() }, `file://${file}`);
  await lookAtReplay(page);
  await context.close();
});

test("views, section, parts, theme, help, by keyboard and on a laptop's screen", async (browser) => {
  await record();
  const page = await open(browser, `file://${file}`);
  const seen = [];
  for (let i = 1; i <= 7; ++i) {
    await page.keyboard.press(String(i));
    seen.push((await state(page)).camera.map((v) => v.toFixed(4)).join());
  }
  assert.equal(new Set(seen).size, 7);
  await page.keyboard.press("ArrowLeft");
  assert.notEqual((await state(page)).camera.map((v) => v.toFixed(4)).join(), seen[6]);
  const light = (await state(page)).background;
  await page.keyboard.press("t");
  assert.notEqual((await state(page)).background, light);
  await page.keyboard.press("s");
  assert.equal(await page.isEnabled("#cut"), true);
  await page.click("#parts li:nth-child(1) input");
  assert.equal((await state(page)).parts[0].visible, false);
  await page.keyboard.press("?");
  assert.equal(await page.isVisible("#help"), true);
  await page.keyboard.press("Escape");
  assert.equal(await page.isVisible("#help"), false);
  // Everything that can be operated has a name, and is reached by Tab.
  const controls = await page.evaluate(() => {
    const all = [...document.querySelectorAll("button, input, select, #stage canvas")].filter((e) => e.offsetParent !== null && !e.disabled);
    all.forEach((e, i) => (e.dataset.number = i));
    const nameless = (e) => !(e.textContent.trim() || e.getAttribute("aria-label") || e.labels?.[0]?.textContent.trim());
    return { count: all.length, nameless: all.filter(nameless).map((e) => e.outerHTML) };
  });
  assert.deepEqual(controls.nameless, []);
  const reached = new Set();
  for (let i = 0; i < controls.count + 5; ++i) {
    await page.keyboard.press("Tab");
    const number = await page.evaluate(() => document.activeElement.dataset.number);
    if (number !== undefined) reached.add(number);
  }
  assert.equal(reached.size, controls.count);
  const fits = await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth && document.documentElement.scrollHeight <= innerHeight);
  assert.ok(fits, "no scroll bars on 1366 × 680");
  assert.deepEqual(page.complaints, []);
  await page.close();
});

test("orbit, pan and zoom with the mouse, as in CAD programs", async (browser) => {
  await record();
  const page = await open(browser, `file://${file}`, { height: 768 });
  const look = async () => {
    const { camera, target } = await state(page);
    const arm = camera.map((v, i) => v - target[i]);
    const distance = Math.hypot(...arm);
    return { target, distance, direction: arm.map((v) => v / distance) };
  };
  const apart = (a, b) => Math.hypot(...a.map((v, i) => v - b[i]));
  const center = await page.evaluate(() => window.__tegotae.project(window.__tegotae.center()));
  const dragged = async (button, from, by) => {
    await page.mouse.move(...from);
    await page.mouse.down({ button });
    await page.mouse.move(from[0] + by[0], from[1] + by[1], { steps: 4 });
    await page.mouse.up({ button });
    return look();
  };
  const begin = await look();
  const background = [center[0] - 300, center[1] + 250];
  const orbited = await dragged("left", background, [120, 40]);
  assert.ok(apart(orbited.target, begin.target) < 1e-9 && Math.abs(orbited.distance / begin.distance - 1) < 1e-6 && apart(orbited.direction, begin.direction) > 0.1);
  const again = await dragged("middle", center, [-120, -40]);
  assert.ok(apart(again.target, begin.target) < 1e-9 && apart(again.direction, orbited.direction) > 0.1);
  const at = await page.evaluate(() => window.__tegotae.project(window.__tegotae.center()));
  const panned = await dragged("right", background, [60, -30]);
  assert.ok(apart(panned.direction, again.direction) < 1e-6 && Math.abs(panned.distance / again.distance - 1) < 1e-6);
  const moved = await page.evaluate(() => window.__tegotae.project(window.__tegotae.center()));
  assert.ok(apart(moved, [at[0] + 60, at[1] - 30]) < 8, `what one pans goes with the pointer: ${at} to ${moved}`);
  // What is under the pointer stays there.
  await page.mouse.move(...moved);
  await page.mouse.wheel(0, -240);
  const zoomed = await look();
  assert.ok(zoomed.distance < 0.95 * panned.distance);
  assert.ok(apart(await page.evaluate(() => window.__tegotae.project(window.__tegotae.center())), moved) < 8);
  // Show everything: all corners are in the picture, and they fill it.
  await page.keyboard.press("f");
  const [box, corners] = await page.evaluate(() => [document.querySelector("#stage canvas").getBoundingClientRect().toJSON(), window.__tegotae.corners()]);
  for (const [x, y] of corners) assert.ok(x > box.left && x < box.right && y > box.top && y < box.bottom);
  const extent = (k) => Math.max(...corners.map((c) => c[k])) - Math.min(...corners.map((c) => c[k]));
  assert.ok(extent(0) > 0.7 * box.width || extent(1) > 0.7 * box.height, "it fills the picture");
  assert.deepEqual(page.complaints, []);
  await page.close();
});
