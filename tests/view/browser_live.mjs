// Live runs in a real browser.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { folder, scene, test } from "./cases.mjs";
import { drag, pushesBack, writeFloor } from "./floor.mjs";
import { orbit, ringTriangles, writeRings } from "./rings.mjs";
import { open, patience, plotted, said, serve, state, until } from "./program.mjs";

async function lookFromFront(page) {
  await page.keyboard.press("1"); // front: the screen is the plane of x and z
  await until(page, (s) => Math.abs(s.camera[0]) < 1e-6);
}

// It rests a little over the floor and nothing presses any more. (It may hop first: the hand's spring lets go.)
const restsOnFloor = (page) => until(page, (s) => s.frame.forceOn && s.force < 0.1 && s.frame.x[2] < 0.006 && s.lag < 2e-4);

// The hand has come to rest as well: its lag and its spring take some tenths of a second after the mouse lets go.
async function handRests(page) {
  let last = await until(page, (s) => s.frame.forceOn && s.force < 0.1);
  await until(page, (s) => {
    if (s.frame.tick < last.frame.tick + 300) return false;
    const still = Math.abs(s.frame.y[2] - last.frame.y[2]) < 4e-5 && s.frame.forceOn && s.force < 0.1;
    last = s;
    return still;
  });
  return last;
}

// In virtual time, at the pace of real time: servo and contact loop take turns, so that however busy the machine is, the
// force does not go off for a loop that was held up.
async function openPaced(browser) {
  const program = await serve("tegotae", "run", writeFloor(), "--view", "--fast");
  const page = await open(browser, program.url, { play: true });
  return { program, page };
}

test("a live run: parts, arrows, plots that move", async (browser) => {
  // Down to 2 mm into the floor and up again, for ten minutes.
  const keys = Array.from({ length: 300 }, (_, i) => `${2 * i},0,0,${i % 2 ? 0.003 : 0.008},1,0,0,0\n`);
  const program = await serve("tegotae", "run", writeFloor(keys.join("")), "--view");
  const page = await open(browser, program.url);
  const first = await until(page, (s) => s.plots[0].points > 5);
  assert.deepEqual(first.parts, [{ name: "floor", held: false, visible: true, removed: false }, { name: "block <b>1</b>", held: true, visible: true, removed: false }]);
  const touching = await until(page, (s) => s.arrows.force > 0 && s.shown.contacts > 0);
  assert.ok(touching.frame.forceOn);
  assert.ok(touching.frame.force[2] > 0, "the floor pushes up");
  const higher = plotted(touching, "Position")[2] + 0.5; // mm
  const away = await until(page, (s) => plotted(s, "Position")[2] > higher && s.arrows.force === 0 && s.shown.contacts === 0);
  assert.ok(plotted(away, "Force along")[2] < plotted(touching, "Force along")[2], "that of the force down");
  assert.ok(away.plots[0].peak >= touching.force, "the peak is held");
  for (const plot of touching.plots) assert.ok(plot.last.every(Number.isFinite), plot.name);
  assert.ok(plotted(touching, "Tick time")[0] > 0 && plotted(touching, "Servo lateness")[0] > 0, "a tick takes time, the servo wakes up late");
  assert.equal(await page.isVisible("tr[data-id=tick]"), false, "what only a programmer reads is behind a switch");
  await page.check("#technical");
  assert.equal(await page.isVisible("tr[data-id=tick]"), true);
  assert.match(await page.textContent("tr[data-id=force]"), /\d\.\d\d\s*N/);
  assert.deepEqual(page.complaints, []);
  await page.close();
  assert.equal(await program.stop(), 0);
});

test("the mouse is the pen: dragged onto the floor, the part pushes back", async (browser) => {
  const { program, page } = await openPaced(browser);
  assert.equal(await page.textContent("#parts li:nth-child(2) .name"), "block <b>1</b>", "names are text");
  await lookFromFront(page);
  const before = await until(page, (s) => s.frame.forceOn);
  assert.ok(before.force < 0.05, `a resting hand feels ${before.force} N`);
  await drag(page, 0.008); // 3 mm to the floor and 5 mm more
  const pressed = await until(page, pushesBack);
  assert.ok(pressed.frame.force[2] > 5 * Math.abs(pressed.frame.force[0]), "the floor pushes up");
  assert.ok(pressed.frame.force[2] < 8.5 + 1e-3, "no more than the pen's limit");
  assert.ok(pressed.frame.x[2] >= 0.005, "the part stays over the floor");
  assert.ok(pressed.frame.y[2] < pressed.frame.x[2] - 3e-4, "the pen is below it");
  for (const pair of pressed.frame.pairs.filter((p) => p.touching)) assert.ok(pair.normal[2] > 0.99, "normals point up");
  assert.ok(pressed.frame.forces.length > 0 && pressed.shown.forces > 0, "contacts that carry have arrows");
  for (const { point, force } of pressed.frame.forces) {
    assert.ok(force[2] > 0 && Math.abs(force[0]) < 1e-3 * force[2], "the floor pushes up");
    assert.ok(point[2] >= 0 && point[2] < 1e-4, "where it is");
  }
  assert.equal(await page.textContent("#force"), "");
  await page.mouse.up();
  await restsOnFloor(page);

  // The same by keys; Esc lets go.
  await page.focus("#stage canvas");
  await page.keyboard.press("h");
  for (let i = 0; i < 30; ++i) await page.keyboard.press("ArrowDown");
  await until(page, pushesBack);
  await page.keyboard.press("Escape");
  await restsOnFloor(page);

  // Another part in the hand.
  await page.click("#parts li:nth-child(1) .do");
  const other = await until(page, (s) => s.parts[0].held && s.status.generation === 2);
  assert.equal(other.parts[1].held, false);
  await page.click("#restart");
  await until(page, (s) => s.parts[1].held && s.status.generation === 3);
  assert.deepEqual(page.complaints, []);
  await page.close();
  assert.equal(await program.stop(), 0);
});

test("parts are moved, removed, added back and another one is held while the run goes on", async (browser) => {
  const { program, page } = await openPaced(browser);
  await lookFromFront(page);
  const before = await until(page, (s) => s.frame.forceOn);
  const going = (s) => s.frame.tick > before.frame.tick;

  // A click on the floor selects it; 7 mm down it is 10 mm under the block.
  const at = await page.evaluate(() => window.__tegotae.project([0.015, -0.02, -0.002]));
  await page.mouse.click(...at);
  await until(page, (s) => s.selected === 0);
  assert.equal(await page.textContent("#selected-name"), "floor");
  await page.fill("#move input[name=by-z]", "-7");
  await page.press("#move input[name=by-z]", "Enter");
  const down = (s) => Math.abs(s.places[0][2] + 0.007) < 1e-9;
  await until(page, (s) => going(s) && s.frame.generation === 2 && down(s));
  await drag(page, 0.02);
  const pressed = await until(page, pushesBack);
  assert.ok(pressed.frame.x[2] < 0 && pressed.frame.x[2] > -0.002, "the block rests on the floor that was moved");
  await page.mouse.up();
  await until(page, (s) => s.frame.forceOn && s.force < 0.1);

  // Up again by 10 mm it would be in the block: the program says why not, and nothing changes.
  await page.fill("#move input[name=by-z]", "10");
  await page.click("#move button");
  const refused = await until(page, (s) => s.message !== "");
  assert.match(refused.message, /^Nothing was changed: parts "block <b>1<\/b>" and "floor" intersect/);
  assert.ok(down(refused));
  await until(page, (s) => s.frame.tick > refused.frame.tick && s.status.generation === 2);

  // Removed, it is not drawn and not felt.
  await page.click("#remove");
  const removed = await until(page, (s) => s.parts[0].removed && s.message === "");
  assert.equal(await page.textContent("#remove"), "Add back");
  await drag(page, 0.008);
  await until(page, (s) => Math.abs(s.frame.x[2] + 0.01) < 0.002 && s.shown.contacts === 0);
  await page.mouse.up();

  // Not where the block is now, but where it was when that is away again.
  await page.click("#parts li:nth-child(1) .do");
  await until(page, (s) => s.message.includes("intersect"));
  await drag(page, -0.02);
  await until(page, (s) => s.frame.x[2] > 0.005);
  await page.mouse.up();
  await page.click("#parts li:nth-child(1) .do");
  await until(page, (s) => !s.parts[0].removed && s.message === "");

  // A hidden part is still felt.
  await page.click("#parts li:nth-child(1) input");
  await drag(page, 0.03);
  await until(page, (s) => pushesBack(s) && !s.parts[0].visible);
  await page.mouse.up();
  await page.click("#parts li:nth-child(1) input");

  // Another part in the hand: nothing jumps, the force comes on again, and the run is the same.
  const last = await handRests(page);
  await page.click("#hold");
  const held = await until(page, (s) => s.parts[0].held && s.frame.generation === s.status.generation && s.frame.forceOn);
  assert.ok(held.frame.tick > last.frame.tick && held.frame.tick > removed.frame.tick);
  assert.ok(Math.abs(held.frame.x[2] + 0.007) < 1e-4, `the floor stays where it was, not at ${held.frame.x[2]}`);
  assert.ok(held.lag < 2e-4 && held.force < 0.2);
  // And the mouse leads it from there, straight down. (Its front, where the mouse holds it, is nearer than its center.)
  await drag(page, 0.02);
  await until(page, (s) => s.frame.x[2] < -0.02 && s.frame.x[2] > -0.027 && Math.hypot(s.frame.x[0], s.frame.x[1]) < 1e-3);
  await page.mouse.up();
  assert.equal(await page.textContent("#selected-note"), "The pen moves it. Hold another part to move or remove it here.");
  assert.deepEqual(page.complaints.filter((text) => !text.includes("400 (Bad Request)")), []);
  await page.close();
  assert.equal(await program.stop(), 0);
});

test("the same in real time; after a stall the page says why the force is off, and moving back brings it on again", async (browser) => {
  const program = await serve("tegotae", "run", writeFloor(), "--view");
  const page = await open(browser, program.url);
  // What stands over the parts before there is anything to say about the force.
  await until(page, (s) => s.frame.forceOn);
  assert.deepEqual(await said(page), [], "nothing is wrong on the first page of a run");
  assert.equal(await page.isVisible("#message"), false);
  await lookFromFront(page);
  // A machine too busy for the loops may turn the force off here too: then once more, from a small force.
  for (let attempt = 1; ; ++attempt) {
    await until(page, (s) => s.frame.forceOn);
    await drag(page, 0.008);
    if (pushesBack(await until(page, (s) => pushesBack(s) || !s.frame.forceOn))) break;
    assert.ok(attempt < 10, "the force goes off whenever one presses");
    await page.mouse.up();
  }
  // The program stands still for longer than the servo waits for the contact loop's heartbeat. Which of the two wakes up
  // first is chance: until it was the servo.
  for (let attempt = 1; (await state(page)).frame.forceOn; ++attempt) {
    assert.ok(attempt < 100, "the force stays on");
    program.stall(100);
    await page.waitForTimeout(300);
  }
  await page.waitForTimeout(1000);
  assert.equal((await state(page)).frame.forceOn, false, "it does not come on again while one presses");
  assert.match(await page.textContent("#force"), /^The force went off: the (contact loop's heartbeat is too old|pen .*)\. Let go of the part, or move it back until it meets its ghost: then the force comes on again\.$/);
  assert.equal(await page.textContent(".force-state"), "Force is off: waiting for a small force");
  const grip = await page.evaluate(() => window.__tegotae.grip());
  for (let i = 1; i <= 60 && !(await state(page)).frame.forceOn; ++i) {
    await page.mouse.move(grip[0], grip[1] - 3 * i);
    await page.waitForTimeout(60);
  }
  await until(page, (s) => s.frame.forceOn);
  for (const end = Date.now() + patience; !(await said(page)).includes("The force is on again."); await page.waitForTimeout(30))
    assert.ok(Date.now() < end, `it is said that the force is on again: ${await said(page)}`);
  await page.mouse.up();
  assert.deepEqual(page.complaints, []);
  await page.close();
  assert.equal(await program.stop(), 0);
});

test("virtual time: stands, steps, goes on", async (browser) => {
  const program = await serve("tegotae", "run", scene, "--view", "--fast");
  const page = await browser.newPage({ viewport: { width: 1366, height: 680 } });
  await page.goto(program.url);
  await page.click("#step");
  assert.equal((await until(page, (s) => s.frame)).frame.tick, 0);
  await page.keyboard.press(".");
  assert.equal((await until(page, (s) => s.frame?.tick > 0)).frame.tick, 1);
  await page.selectOption("#speed", "null");
  await page.click("#play");
  await until(page, (s) => s.frame.t > 3 && !s.status.paused);
  await page.click("#play");
  await until(page, (s) => s.status.paused);
  await page.waitForTimeout(500);
  const stood = await state(page);
  await page.waitForTimeout(500);
  const still = await state(page);
  assert.equal(still.frame.tick, stood.frame.tick);
  assert.equal(still.drawn, stood.drawn, "nothing is drawn while nothing changes");
  await page.close();
  assert.equal(await program.stop(), 0);
});

test("the path of a guide is drawn in a color of its own while its part is held", async (browser) => {
  const path = join(folder, "way.csv");
  writeFileSync(path, "t,px,py,pz,qw,qx,qy,qz\n0,0,0,0.008,1,0,0,0\n1,0,0,0.02,1,0,0,0\n2,0.01,0,0.02,1,0,0,0\n");
  const program = await serve("tegotae", "run", writeFloor(), "--guide", path, "--view", "--fast");
  const page = await open(browser, program.url, { play: true });
  const drawn = await until(page, (s) => s.guide.points === 3);
  assert.equal(new Set([drawn.guide.color, ...drawn.guide.others]).size, 1 + new Set(drawn.guide.others).size, "no contact, pair, force or torque has it");
  await page.uncheck("#layers label:last-child input");
  await until(page, (s) => s.guide.points === 0);
  await page.check("#layers label:last-child input");
  await page.click("#parts li:nth-child(1) .do");
  await until(page, (s) => s.parts[0].held && s.guide.points === 0);
  await page.click("#undo");
  await until(page, (s) => s.parts[1].held && s.guide.points === 3);
  assert.deepEqual(page.complaints, []);
  await page.close();
  assert.equal(await program.stop(), 0);
});

test("300 000 triangles: while one orbits fewer triangles and pixels are drawn, at rest all of them", async (browser) => {
  const program = await serve("tegotae", "view", writeRings(folder));
  const page = await open(browser, program.url, { runs: false });
  const rest = (s) => s.last && !s.last.coarse;
  const fine = await until(page, rest);
  assert.ok(fine.last.triangles >= ringTriangles, `${fine.last.triangles} triangles`);
  await orbit(page, 2000);
  const moving = await state(page);
  const drawn = moving.drawn - fine.drawn;
  assert.ok(drawn > 2 && moving.coarse - fine.coarse >= drawn - 1, `${moving.coarse} of ${moving.drawn} pictures are coarse`);
  const coarse = await page.evaluate(() => new Promise((done) => {
    dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowRight" }));
    requestAnimationFrame(() => requestAnimationFrame(() => done(window.__tegotae.state.last)));
  }));
  assert.ok(coarse.coarse && coarse.triangles < 0.04 * ringTriangles, `${coarse.triangles} triangles while it moves`);
  assert.ok(coarse.pixels < 0.37 * fine.last.pixels, `${coarse.pixels} of ${fine.last.pixels} pixels while it moves`);
  assert.deepEqual((await until(page, rest)).last, fine.last, "at rest all of it again");
  assert.deepEqual(page.complaints, []);
  await page.close();
  assert.equal(await program.stop(), 0);
});

test("without the token there is no page", async (browser) => {
  const program = await serve("peg_in_hole", "--view");
  const page = await browser.newPage();
  assert.equal((await page.goto(program.url.replace(/token=.*/, "token=0"))).status(), 403);
  await page.close();
  assert.equal(await program.stop(), 0);
});
