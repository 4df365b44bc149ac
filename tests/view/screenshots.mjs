// Makes the pictures of docs/view.md and docs/review.md:
//   TEGOTAE_BIN_DIR=build/release/bin node tests/view/screenshots.mjs
// A recording where the tilted peg jams: whole (light), cut open (dark), on a narrow screen.
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { launch, open, run, serve, until } from "./program.mjs";

const root = new URL("../..", import.meta.url).pathname;
const scene = `${root}models/peg_in_hole_0.94.toml`;
const folder = mkdtempSync(join(tmpdir(), "tegotae_pictures_"));
const browser = await launch();

const jam = 5300; // ms, where it jams

// Seen from in front and a little from above; cut: through the peg's middle.
async function aim(page, cut) {
  await page.keyboard.press("1");
  if (cut) for (const key of ["s", "s"]) await page.keyboard.press(key);
  for (const key of ["ArrowUp", "ArrowUp", "ArrowUp", "ArrowRight", "ArrowRight", "ArrowRight", "f"]) await page.keyboard.press(key);
}

async function picture(page, name) {
  await page.waitForTimeout(1500);
  await page.evaluate(() => document.activeElement.blur()); // no ring, no cross
  await page.waitForTimeout(200);
  await page.screenshot({ path: `${root}docs/${name}` });
  await page.close();
}

// The same run as in docs/replay.html, with the contacts' forces, which only MCAP has.
async function record() {
  const recording = join(folder, "peg.mcap");
  await run("peg_in_hole", "--fast", "--record", recording);
  await run("tegotae", "replay", recording, "--html", join(folder, "peg.html"));
}

async function openAt(t, options) {
  const page = await open(browser, `file://${join(folder, "peg.html")}`, options);
  await page.evaluate((at) => {
    const bar = document.getElementById("scrub");
    bar.value = at;
    bar.dispatchEvent(new Event("input"));
  }, t);
  return page;
}

async function wide(name, dark) {
  const page = await openAt(jam, { dark, height: 700 });
  await aim(page, dark);
  await picture(page, name);
}

async function narrow() {
  const page = await openAt(jam, { width: 390, height: 700 });
  await page.click('#tabs [data-panel="right"]');
  await page.keyboard.press("f");
  await picture(page, "view-narrow.png");
}

// The peg at rest over its hole, and the way that a guide would draw it.
async function guide() {
  const program = await serve("tegotae", "run", scene, "--guide", `${root}models/insert_0.94.csv`, "--view", "--fast");
  const page = await browser.newPage({ viewport: { width: 1100, height: 620 }, colorScheme: "light" });
  await page.goto(program.url);
  await page.click("#step"); // which begins a run that stands
  await until(page, (s) => s.frame);
  await page.focus("#stage canvas");
  await page.keyboard.press("1");
  for (const key of ["ArrowUp", "ArrowUp", "ArrowRight", "ArrowRight", "f"]) await page.keyboard.press(key);
  await picture(page, "view-guide.png");
  await program.stop();
}

async function review() {
  const recording = join(folder, "peg.csv"), file = join(folder, "review.html");
  await run("tegotae", "run", scene, "--fast", "--record", recording);
  await run("tegotae", "review", recording, "--out", file);
  const page = await browser.newPage({ viewport: { width: 1100, height: 1180 }, colorScheme: "light" });
  await page.goto(`file://${file}`);
  await page.waitForSelector("#tables table");
  await page.locator("#views button", { hasText: "Front" }).click();
  await picture(page, "review.png");
}

await record();
await wide("view-light.png", false);
await wide("view-dark.png", true);
await narrow();
await guide();
await review();
await browser.close();
rmSync(folder, { recursive: true });
