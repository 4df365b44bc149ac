// The first hour at the page: open it, look, measure, hold, move, report; on three widths, light and dark, the narrowest
// with a finger. With TEGOTAE_PICTURES=FOLDER it leaves a picture of each.
import assert from "node:assert/strict";
import { join } from "node:path";
import { folder, test } from "./cases.mjs";
import { pushesBack, writeFloor } from "./floor.mjs";
import { open, serve, state, until } from "./program.mjs";
import { at, dragTo, figure, fits, nothingComplains, openOn, picture, press, reported, saved, size, toolsAreSeen } from "./screens.mjs";

const screens = [
  { width: 1366, height: 768, dark: false },
  { width: 768, height: 1024, dark: true },
  { width: 390, height: 844, dark: false, touch: true },
];

async function look(page) {
  await page.click("#views button:nth-child(2)");
  await until(page, (s) => Math.abs(s.camera[0] - s.target[0]) < 1e-6 && s.camera[1] > s.target[1]);
  await press(page, "#parallel");
  assert.equal((await state(page)).parallel, true);
  await page.selectOption("#up", "y");
  const turned = await until(page, (s) => s.up === "y");
  assert.ok(turned.camera[1] > turned.target[1], "from above, where that is along y");
  await page.selectOption("#up", "z");
  await press(page, "#parallel");
  await page.panel("left");
  await press(page, "#section [data-kind=x]");
  assert.deepEqual((await state(page)).section.normal.map(Math.abs), [1, 0, 0]);
  await page.focus("#stage canvas");
  const before = (await state(page)).section.constant;
  await page.keyboard.press("]");
  assert.notEqual((await state(page)).section.constant, before);
  await press(page, "#section [data-kind=off]");
  await page.panel("");
  const places = (await state(page)).places;
  await page.keyboard.press("e");
  assert.notDeepEqual((await state(page)).places, places, "parts go away from each other");
  await page.keyboard.press("e");
  await page.keyboard.press("7");
  await page.keyboard.press("f");
}

// The block is a cube of 10 mm whose middle is at the pose that the program reports; the floor's top is at z = 0.
async function measure(page) {
  await press(page, "#measure");
  await page.tapAt(await at(page, [0.001, -0.001, 0.013]));
  await page.tapAt(await at(page, [0.016, -0.016, 0]));
  const gap = await until(page, (s) => s.picked.length === 2);
  assert.deepEqual(gap.picked, ["plane", "plane"]);
  const top = gap.frame.x[2] + 0.005;
  assert.ok(Math.abs(top - 0.013) < 1e-4);
  assert.ok(Math.abs(figure(gap, "Gap along the normal") - top) < 1e-6, `${figure(gap, "Gap along the normal")} m`);
  assert.equal(figure(gap, "Angle"), 0);
  assert.match(await page.textContent("#measured"), /Gap along the normal1[23][\d.]*\u00a0mm/);
  await page.tapAt(await at(page, [0.001, -0.005, 0.008]));
  await page.tapAt(await at(page, [0.005, 0.001, 0.008]));
  const corner = await until(page, (s) => s.picked.length === 2 && Math.abs(figure(s, "Angle") - Math.PI / 2) < 1e-6);
  assert.deepEqual(corner.picked, ["plane", "plane"]);
  await page.tapAt(await at(page, [0.005, -0.005, 0.008]));
  const edge = await until(page, (s) => s.picked.length === 1);
  assert.deepEqual(edge.picked, ["edge"]);
  assert.ok(Math.abs(figure(edge, "Length") - 0.01) < 1e-6);
  await page.keyboard.press("Escape");
}

async function hold(page) {
  await page.tapAt(await at(page, [0.016, -0.016, 0]));
  await until(page, (s) => s.selected === 0);
  await page.panel("left");
  await press(page, "#fade");
  assert.ok((await state(page)).faded.includes("floor"));
  await press(page, "#fade");
  await press(page, "#isolate");
  assert.deepEqual((await state(page)).parts.map((part) => part.visible), [true, false]);
  await press(page, "#show-all");
  await press(page, "#hold");
  await until(page, (s) => s.parts[0].held && s.frame.generation === s.status.generation);
  await press(page, "#undo");
  await until(page, (s) => s.parts[1].held && s.frame.generation === s.status.generation);
  await page.panel("");
}

async function move(page, context) {
  await page.keyboard.press("1");
  await until(page, (s) => Math.abs(s.camera[0]) < 1e-6 && s.frame.forceOn);
  const center = await page.evaluate(() => window.__tegotae.center());
  const letGo = await dragTo(page, context, center, [center[0], center[1], center[2] - 0.008]);
  const pressed = await until(page, pushesBack);
  assert.ok(pressed.frame.x[2] >= 0.005, "the block stays over the floor");
  await letGo();
  await until(page, (s) => s.frame.forceOn && s.force < 0.1);
}

// A contact says what it is.
async function askContact(page) {
  await page.focus("#stage canvas");
  await page.keyboard.press("h");
  for (let i = 0; i < 90 && !pushesBack(await state(page)); ++i) await page.keyboard.press("ArrowDown");
  const pressed = await until(page, pushesBack);
  await page.mouse.click(...(await at(page, pressed.frame.pairs.find((pair) => pair.touching).point)));
  const card = await page.textContent("#contact dl");
  assert.match(card, /^PartfloorFeature(corner|edge|face) of block <b>1<\/b> on (corner|edge|face)Gap[\d.]+\u00a0[µm]mForce/);
  await press(page, "#contact .close");
  await page.keyboard.press("Escape");
  await until(page, (s) => s.frame.forceOn && s.force < 0.1);
}

for (const screen of screens) {
  const name = `${screen.width}-${screen.dark ? "dark" : "light"}`;
  test(`the first hour, ${name}`, async (browser) => {
    const program = await serve("tegotae", "run", writeFloor(), "--view", "--fast");
    const { page, context } = await openOn(browser, program.url, screen, { play: true });
    await fits(page, screen);
    await toolsAreSeen(page, screen);
    await nothingComplains(page);
    await look(page);
    await measure(page);
    await hold(page);
    await move(page, context);
    if (!page.narrow) await askContact(page);
    await picture(page, `page-${name}`);
    // The other light, and the panels.
    const light = (await state(page)).background;
    await press(page, "#theme");
    assert.notEqual((await state(page)).background, light);
    for (const panel of page.narrow ? ["left", "right"] : []) {
      await page.panel(panel);
      assert.ok((await size(page, `#${panel}`)).width > 0.9 * screen.width);
      await fits(page, screen);
    }
    assert.deepEqual(page.complaints, []);
    if (!page.narrow) await report(page);
    await context.close();
    assert.equal(await program.stop(), 0);
  });
}

// What the mouse did, as a script and as a report.
async function report(page) {
  const rows = (await saved(page, "#save", join(folder, "hand.csv"))).trim().split("\n");
  assert.equal(rows[0], "t,px,py,pz,qw,qx,qy,qz");
  const heights = rows.slice(1).map((row) => Number(row.split(",")[3]));
  assert.ok(Math.min(...heights) < 0.005, "the hand was led below where the block can be");
  const html = await saved(page, "#review", join(folder, "hand.html"));
  const about = reported(html);
  assert.ok(about.includes('"headline"') && about.includes('"clearance"'), "a report with a verdict");
}

test("when the script has ended, the page offers the part, a replay and a new start", async (browser) => {
  const program = await serve("tegotae", "run", writeFloor("0,0,0,0.008,1,0,0,0\n1,0,0,0.004,1,0,0,0\n"), "--view", "--fast");
  const page = await open(browser, program.url, { play: true });
  await page.waitForSelector("#ended:not([hidden])");
  const last = await state(page);
  assert.ok(last.frame.t > 1);
  await press(page, "#again");
  const playing = await until(page, (s) => s.count > 1 && s.frame.t < 1);
  assert.ok(playing.playing);
  await until(page, (s) => s.frame.t > 1 && !s.playing);
  await press(page, "#live");
  await until(page, (s) => s.count === undefined && s.frame.t >= last.frame.t);
  await press(page, "#restart");
  await until(page, (s) => s.frame.t < 1);
  await page.waitForSelector("#ended:not([hidden])");
  await press(page, "#take");
  assert.match(await page.textContent("#hand"), /^Drag the blue part/);
  assert.equal(await page.isVisible("#ended"), false);
  assert.deepEqual(page.complaints, []);
  await page.close();
  assert.equal(await program.stop(), 0);
});
