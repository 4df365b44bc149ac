// Makes the pictures of docs/view.md and docs/review.md:
//   TEGOTAE_BIN_DIR=build/release/bin node tests/view/screenshots.mjs
// A live run in virtual time, stopped where the tilted peg jams (light), a recording at the rim (dark), and jammed on a narrow screen.
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { launch, open, run, serve, state, until } from "./program.mjs";

const root = new URL("../..", import.meta.url).pathname;
const scene = `${root}models/peg_in_hole_0.94.toml`;
const folder = mkdtempSync(join(tmpdir(), "tegotae_pictures_"));
const browser = await launch();

// A cut through the peg, seen from in front and a little from above.
async function aim(page) {
  await page.keyboard.press("1");
  await page.keyboard.press("s");
  await page.keyboard.press("s");
  await page.evaluate(() => {
    document.getElementById("flip").click();
    document.activeElement.blur();
  });
  for (const key of ["ArrowUp", "ArrowUp", "ArrowUp", "ArrowRight", "ArrowRight", "ArrowRight", "f"]) await page.keyboard.press(key);
}

async function picture(page, name) {
  await page.waitForTimeout(1500);
  await page.screenshot({ path: `${root}docs/${name}` });
  await page.close();
}

async function stepTo(page, url, t) {
  await page.waitForTimeout(500);
  const ticks = Math.round((t - (await state(page)).frame.t) * 1000);
  const token = new URL(url).searchParams.get("token");
  await fetch(new URL("/command", url), { method: "POST", headers: { "X-Tegotae-Token": token }, body: JSON.stringify({ do: "step", ticks }) });
  await until(page, (s) => Math.abs(s.frame.t - t) < 2e-3);
}

async function light() {
  const program = await serve("tegotae", "run", scene, "--view", "--fast");
  const page = await browser.newPage({ viewport: { width: 1366, height: 700 }, colorScheme: "light" });
  await page.goto(program.url);
  await page.waitForSelector("#parts li");
  await page.selectOption("#speed", "0.5");
  await page.click("#play");
  await until(page, (s) => s.frame?.t > 4);
  await page.click("#play");
  await until(page, (s) => s.status.paused);
  await stepTo(page, program.url, 5.25); // the first jam
  await aim(page);
  await picture(page, "view-light.png");
  await program.stop();
}

async function dark() {
  const recording = join(folder, "peg.csv"), file = join(folder, "peg.html");
  await run("tegotae", "run", scene, "--fast", "--record", recording);
  await run("tegotae", "replay", recording, scene, "--html", file);
  const page = await open(browser, `file://${file}`, { dark: true, height: 700 });
  await page.evaluate(() => {
    const bar = document.getElementById("scrub");
    bar.value = 5800;
    bar.dispatchEvent(new Event("input"));
  });
  await aim(page);
  await picture(page, "view-dark.png");
}

async function narrow() {
  const page = await open(browser, `file://${join(folder, "peg.html")}`, { width: 390, height: 700 });
  await page.evaluate(() => {
    const bar = document.getElementById("scrub");
    bar.value = 5300;
    bar.dispatchEvent(new Event("input"));
  });
  await page.click('#tabs [data-panel="right"]');
  await page.keyboard.press("f");
  await picture(page, "view-narrow.png");
}

// The peg at rest over its hole, and the way that a guide would draw it.
async function guide() {
  const program = await serve("tegotae", "run", scene, "--guide", `${root}models/insert_0.94.csv`, "--view", "--fast");
  const page = await open(browser, program.url, { width: 1100, height: 620, play: true });
  await page.click("#play");
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

await light();
await dark();
await narrow();
await guide();
await review();
await browser.close();
rmSync(folder, { recursive: true });
