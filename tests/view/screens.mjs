// Screens of several widths, what one does on each of them, and pictures of it.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { open, patience } from "./program.mjs";

// A page on a screen: page.narrow says whether panels are behind tabs, page.touch whether fingers do what the mouse does.
export async function openOn(browser, url, { width, height, dark, touch = false }, options) {
  const context = await browser.newContext({ viewport: { width, height }, colorScheme: dark ? "dark" : "light", hasTouch: touch, acceptDownloads: true });
  const page = await open({ newPage: () => context.newPage() }, url, options);
  Object.assign(page, { touch, narrow: width <= 1000, tapAt: (at) => (touch ? page.touchscreen.tap(...at) : page.mouse.click(...at)) });
  page.panel = async (name) => page.narrow && (await press(page, `#tabs [data-panel="${name}"]`));
  return { page, context };
}

// Without Playwright's waiting for two pictures in which a button stands still: software rendering on a busy machine may
// take longer than its patience.
export const press = (page, selector) => page.click(selector, { force: true });

// Where a point of the world is on the screen. A panel that has just come takes its width from the picture at once, but the
// camera learns of it with the next frame.
export const at = (page, point) =>
  page.evaluate(async (p) => {
    for (let frames = 0; frames < 2; ++frames) await new Promise(requestAnimationFrame);
    return window.__tegotae.project(p);
  }, point);
export const size = (page, selector) => page.evaluate((s) => document.querySelector(s).getBoundingClientRect().toJSON(), selector);

export async function nothingComplains(page) {
  assert.equal(await page.isVisible("#message"), false, "no error is the first thing one sees");
  assert.equal(await page.textContent("#force"), "");
  assert.deepEqual(page.complaints, []);
}

// The picture has the width, and nothing sticks out.
export async function fits(page, screen) {
  const canvas = await size(page, "#stage canvas");
  assert.ok(canvas.width >= (page.narrow ? 0.99 : 0.55) * screen.width, `the picture is ${canvas.width} px wide`);
  assert.ok(canvas.height >= 0.4 * screen.height, `and ${canvas.height} px high`);
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth && document.documentElement.scrollHeight <= innerHeight));
}

// All of the parts is in the picture, also in one that has just become another size.
export async function partsAreSeen(page) {
  const out = async () => {
    const [corners, canvas] = [await page.evaluate(() => window.__tegotae.corners()), await size(page, "#stage canvas")];
    return corners.filter(([x, y]) => x < canvas.left || x > canvas.right || y < canvas.top || y > canvas.bottom);
  };
  for (const end = Date.now() + 5000; Date.now() < end && (await out()).length > 0; ) await page.waitForTimeout(50);
  assert.deepEqual(await out(), []);
}

// No tool is out of sight without a hint: they wrap, and on the narrowest screens the row fades where it goes on.
export async function toolsAreSeen(page, screen) {
  const tools = (left) => page.evaluate(async (to) => {
    const row = document.getElementById("tools");
    row.scrollLeft = to;
    for (let frames = 0; frames < 3; ++frames) await new Promise(requestAnimationFrame);
    return { over: row.scrollWidth - row.clientWidth, more: row.dataset.more, mask: getComputedStyle(row).maskImage };
  }, left);
  const first = await tools(0);
  if (screen.width > 480) assert.ok(first.over <= 1, `${first.over} px of the tools are cut off`);
  if (first.over <= 1) return assert.deepEqual([first.more, first.mask], ["", "none"]);
  assert.equal(first.more, "right");
  const end = await tools(first.over);
  assert.equal(end.more, "left");
  const masks = [first.mask, end.mask];
  assert.ok(masks.every((mask) => mask.includes("gradient")) && masks[0] !== masks[1], `${masks}`);
  await tools(0);
}

export const figure = (s, name) => s.measured.find(([what]) => what === name)?.[2];

// Drags from one point of the world to another, with the mouse or a finger; what lets go.
export async function dragTo(page, context, from, to) {
  const [a, b] = [await at(page, from), await at(page, to)];
  const places = Array.from({ length: 12 }, (_, i) => a.map((v, k) => v + ((b[k] - v) * (i + 1)) / 12));
  if (!page.touch) {
    await page.mouse.move(...a);
    await page.mouse.down();
    for (const place of places) {
      await page.mouse.move(...place);
      await page.waitForTimeout(30);
    }
    return () => page.mouse.up();
  }
  const session = await context.newCDPSession(page);
  const touch = (type, points) => session.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y]) => ({ x, y })) });
  await touch("touchStart", [a]);
  for (const place of places) {
    await touch("touchMove", [place]);
    await page.waitForTimeout(30);
  }
  return () => touch("touchEnd", []);
}

// What the page saves when `button` is pressed, as text.
export async function saved(page, button, file) {
  const saving = page.waitForEvent("download", { timeout: 4 * patience });
  await press(page, button);
  const download = await saving;
  await download.saveAs(file);
  return readFileSync(file, "utf8");
}

// The report's data.
export const reported = (html) => Buffer.from(html.match(/id="data">([^<]+)</)[1], "base64").toString("latin1");

// With TEGOTAE_PICTURES=FOLDER a picture of the page as it is now.
export async function picture(page, name) {
  if (!process.env.TEGOTAE_PICTURES) return;
  await page.evaluate(() => document.activeElement.blur()); // no ring, no cross
  await page.waitForTimeout(1500);
  await page.screenshot({ path: join(process.env.TEGOTAE_PICTURES, `${name}.png`), timeout: patience });
}
