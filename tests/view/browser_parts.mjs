// The list of parts in a real browser: search, what is shown of them and how, and changes that are taken back.
import assert from "node:assert/strict";
import { test } from "./cases.mjs";
import { writeBoxes, writeFloor } from "./floor.mjs";
import { open, serve, state, until } from "./program.mjs";
import { at } from "./screens.mjs";

// Twelve cubes of 10 mm in a row along x, 20 mm from middle to middle.
const row = Array.from({ length: 12 }, (_, i) => [[20 * i - 5, -5, -5], [20 * i + 5, 5, 5]]);

test("parts are searched, hidden, isolated, seen through and shown again by keys; U turns up", async (browser) => {
  const program = await serve("tegotae", "view", writeBoxes("row", row));
  const page = await open(browser, program.url, { runs: false });
  const names = () => page.locator("#parts .name").allTextContents();
  assert.equal((await names()).length, 12);
  await page.keyboard.press("/");
  await page.keyboard.type("BOX 1");
  assert.deepEqual(await names(), ["box 1", "box 10", "box 11"]);
  await page.keyboard.type("xiv");
  assert.equal(await page.textContent("#parts"), "No part has that in its name");
  assert.equal((await state(page)).up, "z", "letters are the field's");
  await page.fill("#search", "7");
  assert.deepEqual(await names(), ["box 7"]);
  await page.click("#parts .name");
  assert.equal((await state(page)).selected, 7);
  await page.fill("#search", "");
  assert.equal((await names()).length, 12);

  await page.focus("#stage canvas");
  const visible = async () => (await state(page)).parts.flatMap((part, i) => (part.visible ? [i] : []));
  const all = row.map((_, i) => i), others = all.filter((i) => i !== 7);
  await page.keyboard.press("v");
  assert.deepEqual(await visible(), others);
  await page.keyboard.press("v");
  assert.deepEqual(await visible(), all);
  await page.keyboard.press("i");
  assert.deepEqual(await visible(), [7]);
  await page.keyboard.press("i");
  assert.deepEqual(await visible(), all);
  await page.keyboard.press("x");
  assert.deepEqual((await state(page)).faded, ["box 7"]);
  await page.keyboard.press("v");
  await page.keyboard.press("a");
  assert.deepEqual(await visible(), all);
  assert.deepEqual((await state(page)).faded, []);

  // Which way is up on the screen, for each axis in turn.
  for (const axis of [1, 0, 2]) {
    await page.keyboard.press("u");
    assert.equal((await state(page)).up, "xyz"[axis]);
    assert.equal(await page.inputValue("#up"), "xyz"[axis]);
    const end = (s) => [0, 1, 2].map((k) => (k === axis ? 0.005 * s : 0));
    const [low, high] = [await at(page, end(-1)), await at(page, end(1))];
    assert.ok(high[1] < low[1] - 1, `${"xyz"[axis]} points up`);
  }
  assert.deepEqual(page.complaints, []);
  await page.close();
  assert.equal(await program.stop(), 0);
});

test("a move, a turn and a removal are taken back, the last one first", async (browser) => {
  const program = await serve("tegotae", "run", writeFloor(), "--view", "--fast");
  const page = await open(browser, program.url, { play: true });
  const changed = (generation, test = () => true) => until(page, (s) => s.frame.generation === generation && test(s));
  assert.equal(await page.isDisabled("#undo"), true);
  await page.click("#parts li:nth-child(1) .name");
  // A corner of the floor tells its place and how it is turned.
  const corners = () => page.evaluate(() => window.__tegotae.corners());
  const far = (a, b) => Math.max(...a.map((p, i) => Math.hypot(p[0] - b[i][0], p[1] - b[i][1]))); // pixels
  const first = await corners();
  await page.fill("#move input[name=by-x]", "4");
  await page.fill("#move input[name=by-z]", "-7");
  for (const [axis, degrees] of [["x", 10], ["y", -20], ["z", 30]]) await page.fill(`#move input[name=turn-${axis}]`, String(degrees));
  await page.click("#move button");
  const moved = await changed(2, (s) => Math.abs(s.places[0][2]) > 1e-3);
  assert.ok(far(await corners(), first) > 20);
  await page.click("#remove");
  await changed(3, (s) => s.parts[0].removed);
  await page.focus("#stage canvas");
  await page.keyboard.press("Control+z");
  const back = await changed(4, (s) => !s.parts[0].removed);
  assert.deepEqual(back.places[0], moved.places[0], "back where it was moved to");
  await page.click("#undo");
  await changed(5, (s) => s.places[0].every((v) => Math.abs(v) < 1e-9));
  assert.ok(far(await corners(), first) < 0.01, "and back to where it was, turned back");
  assert.equal(await page.isDisabled("#undo"), true);
  await page.keyboard.press("Control+z");
  assert.equal((await state(page)).status.generation, 5, "there is nothing left to take back");
  assert.deepEqual(page.complaints, []);
  await page.close();
  assert.equal(await program.stop(), 0);
});
