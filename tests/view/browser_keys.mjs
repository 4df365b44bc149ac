// By keys alone: measuring and contacts; what stands before contacts; the script of what the hand did; a file that is dropped.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { folder, test } from "./cases.mjs";
import { drag, pushesBack, writeFloor } from "./floor.mjs";
import { open, run, serve, state, until } from "./program.mjs";
import { figure, saved } from "./screens.mjs";

async function openFloor(browser) {
  const program = await serve("tegotae", "run", writeFloor(), "--view", "--fast");
  return { program, page: await open(browser, program.url, { play: true }) };
}

async function done(program, page) {
  assert.deepEqual(page.complaints, []);
  await page.close();
  assert.equal(await program.stop(), 0);
}

// The block is pressed straight down onto the floor, and rests there.
async function pressByKeys(page) {
  await page.keyboard.press("1");
  await page.keyboard.press("h");
  for (let i = 0; i < 90 && !pushesBack(await state(page)); ++i) await page.keyboard.press("ArrowDown");
  for (let i = 0; i < 8; ++i) await page.keyboard.press("ArrowDown"); // so that it still does when the hand has come to rest
  let last = await state(page);
  return until(page, (s) => {
    if (s.frame.t < last.frame.t + 0.3) return false;
    const still = s.frame.y.every((v, k) => Math.abs(v - last.frame.y[k]) < 1e-6);
    last = s;
    return still && pushesBack(s) && s.shown.contacts === 4;
  });
}

test("keys: what is in the picture's middle is measured and selected", async (browser) => {
  const { program, page } = await openFloor(browser);
  await page.keyboard.press("5"); // from above: the block's top is in the middle, its middle is at the reported pose
  await page.keyboard.press("m");
  assert.equal(await page.isVisible("#cross"), true);
  const cross = await page.evaluate(() => [document.getElementById("cross"), document.querySelector("#stage canvas")].map((e) => e.getBoundingClientRect().toJSON()));
  for (const [from, to] of [["left", "right"], ["top", "bottom"]]) assert.ok(Math.abs(cross[0][from] + cross[0][to] - cross[1][from] - cross[1][to]) <= 2, "the cross is in the middle");
  await page.keyboard.press("Enter");
  const top = await until(page, (s) => s.picked.length === 1);
  assert.deepEqual(top.picked, ["plane"]);
  for (let i = 0; i < 3; ++i) await page.keyboard.press("Shift+ArrowRight");
  await page.keyboard.press("Enter");
  const gap = await until(page, (s) => s.picked.length === 2);
  assert.ok(Math.abs(figure(gap, "Gap along the normal") - top.frame.x[2] - 0.005) < 1e-6, `${figure(gap, "Gap along the normal")} m to the floor`);
  await page.keyboard.press("Escape");
  await page.keyboard.press("Enter");
  assert.equal((await state(page)).selected, 0, "the floor");
  await done(program, page);
});

test("keys: contacts are gone through one after the other, each tells what it is", async (browser) => {
  const { program, page } = await openFloor(browser);
  await page.keyboard.press("n");
  assert.equal(await page.isVisible("#contact"), false, "there is none yet");
  const pressed = await pressByKeys(page);
  const seen = [];
  for (let i = 0; i < 5; ++i) {
    await page.keyboard.press("n");
    seen.push((await state(page)).contact);
    assert.match(await page.textContent("#contact dl"), /^PartfloorFeature(corner|edge|face) of block <b>1<\/b> on (corner|edge|face)Gap[\d.]+\u00a0[µm]mForce/);
    // The ring is where the contact is.
    const [ring, place] = await page.evaluate(() => [document.querySelector(".mark").getBoundingClientRect().toJSON(), window.__tegotae.project(window.__tegotae.state.contact)]);
    assert.ok(Math.hypot((ring.left + ring.right) / 2 - place[0], (ring.top + ring.bottom) / 2 - place[1]) < 3);
  }
  const corner = (point) => [0, 1].map((k) => point[k] - pressed.frame.x[k]).map((v) => (Math.abs(Math.abs(v) - 0.005) < 2e-4 ? Math.sign(v) : 0)).join();
  assert.deepEqual(seen.slice(0, 4).map(corner).sort(), ["-1,-1", "-1,1", "1,-1", "1,1"], JSON.stringify([seen, pressed.frame.pairs]));
  assert.equal(corner(seen[4]), corner(seen[0]), "and from the first one again");
  await page.keyboard.press("Escape"); // lets go of the part
  await page.keyboard.press("Escape");
  assert.equal(await page.isVisible("#contact"), false);
  await done(program, page);
});

test("parts before the contacts are seen through; on the far side of the held part contacts are hollow", async (browser) => {
  const { program, page } = await openFloor(browser);
  await pressByKeys(page);
  await page.keyboard.press("6"); // from below the floor is before them, and the block's lower side is its near one
  const below = await until(page, (s) => s.faded.includes("floor") && s.shown.contacts === 4 && s.shown.far === 0);
  assert.deepEqual(below.faded, ["floor"], "the block is not in the way");
  await page.uncheck("#layers label:last-child input");
  await until(page, (s) => s.faded.length === 0);
  await page.check("#layers label:last-child input");
  await until(page, (s) => s.faded.includes("floor"));
  await page.keyboard.press("5"); // from above the block itself is before all of them
  await until(page, (s) => s.faded.length === 0 && s.shown.contacts === 4 && s.shown.far === 4);
  await page.keyboard.press("7"); // only the corner that is away from the eye
  await until(page, (s) => s.faded.length === 0 && s.shown.contacts === 4 && s.shown.far === 1);
  await page.keyboard.press("s"); // cut open there is nothing before them
  await until(page, (s) => s.shown.far === 0);
  await done(program, page);
});

test("the script that the page saves carries the part where the mouse did", async (browser) => {
  const { program, page } = await openFloor(browser);
  await page.keyboard.press("1");
  await until(page, (s) => Math.abs(s.camera[0]) < 1e-6 && s.frame.forceOn);
  await drag(page, 0.008); // onto the floor
  const low = await until(page, pushesBack);
  await page.mouse.up();
  await until(page, (s) => s.frame.forceOn && s.force < 0.1);
  await drag(page, -0.01);
  await page.mouse.up();
  let high = await state(page);
  await until(page, (s) => {
    const still = s.frame.t > high.frame.t + 0.5 && s.frame.x.every((v, k) => Math.abs(v - high.frame.x[k]) < 1e-6);
    if (s.frame.t > high.frame.t + 0.5) high = s;
    return still && s.frame.x[2] > 0.01;
  });
  const script = join(folder, "mouse.csv"), recording = join(folder, "mouse.recording.csv");
  await saved(page, "#save", script);
  await done(program, page);
  await run("tegotae", "run", join(folder, "floor.toml"), "--script", script, "--fast", "--record", recording);
  const lines = readFileSync(recording, "utf8").split("\n").filter((line) => line && !line.startsWith("#"));
  const column = lines[0].split(",").indexOf("x_pz");
  assert.ok(column > 0, lines[0]);
  const heights = lines.slice(1).map((line) => Number(line.split(",")[column]));
  assert.ok(Math.abs(Math.min(...heights) - low.frame.x[2]) < 1e-4, `onto the floor: ${Math.min(...heights)}`);
  assert.ok(Math.abs(heights.at(-1) - high.frame.x[2]) < 2e-4, `up to ${high.frame.x[2]}, and went to ${heights.at(-1)}`);
});

test("a file that is dropped on the page: the page stays, and says how it is opened", async (browser) => {
  const { program, page } = await openFloor(browser);
  const drop = (name) => page.evaluate((file) => {
    const dataTransfer = new DataTransfer();
    dataTransfer.items.add(new File(["solid"], file));
    return ["dragover", "drop"].map((type) => {
      const event = new DragEvent(type, { bubbles: true, cancelable: true, dataTransfer });
      document.querySelector("#stage canvas").dispatchEvent(event);
      return event.defaultPrevented;
    });
  }, name);
  assert.deepEqual(await drop("pump.step"), [true, true], "the browser does not leave the page for it");
  assert.equal((await state(page)).message, "This page shows what the program has opened. To open the file: tegotae view pump.step");
  await drop("my pump's.step");
  assert.match((await state(page)).message, /tegotae view 'my pump'\\''s\.step'$/);
  await page.mouse.click(640, 400);
  assert.equal(await page.isVisible("#message"), false);
  await done(program, page);
});
