// The report on a recording in a real browser, and the button that saves it.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { folder, scene, test } from "./cases.mjs";
import { open, patience, run, serve, state } from "./program.mjs";

const recording = join(folder, "review_me.csv"), report = join(folder, "review_me.html");
let made = null;
const record = () => (made ??= (async () => {
  await run("tegotae", "run", scene, "--fast", "--record", recording);
  await run("tegotae", "review", recording, "--out", report);
})());

async function openReport(browser, dark) {
  const page = await browser.newPage({ viewport: { width: 1160, height: 900 }, colorScheme: dark ? "dark" : "light" });
  page.setDefaultTimeout(patience);
  page.complaints = [];
  page.on("console", (message) => message.type() === "error" && page.complaints.push(message.text()));
  page.on("pageerror", (error) => page.complaints.push(String(error.stack)));
  await page.goto(`file://${report}`);
  await page.waitForSelector("#tables table");
  return page;
}

for (const dark of [false, true]) {
  test(`a review, ${dark ? "dark" : "light"}: verdict, path, plots, tables`, async (browser) => {
    await record();
    const page = await openReport(browser, dark);
    assert.equal(await page.textContent("#verdict h2"), "It goes in");
    assert.ok((await page.locator("#verdict li").count()) >= 5);
    assert.equal(await page.locator("#plots canvas").count(), 4);
    assert.deepEqual((await state(page)).tables.map((t) => t.title), ["Closest parts", "Force and torque", "Contacts", "Held from two sides"]);
    // The time line moves the part: it starts 45 mm over where it ends.
    const end = (await state(page)).held[2];
    await page.focus("#scrub");
    await page.keyboard.press("Home");
    assert.ok((await state(page)).held[2] > end + 0.04);
    assert.equal((await state(page)).at, 0);
    for (const name of ["Ghosts", "See through", "Clearance", "Contacts", "Path"]) {
      const button = page.locator("#layers button", { hasText: name });
      assert.equal(await button.getAttribute("aria-pressed"), "true");
      await button.click();
      assert.equal(await button.getAttribute("aria-pressed"), "false");
    }
    assert.equal(await page.isVisible("#legend"), false);
    await page.locator("#views button", { hasText: "Front" }).click();
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), true);
    assert.deepEqual(page.complaints, []);
    await page.close();
  });
}

test("a review on a narrow page: nothing is wider than the page", async (browser) => {
  await record();
  const page = await openReport(browser, false);
  await page.setViewportSize({ width: 600, height: 900 });
  await page.waitForFunction(() => [...document.querySelectorAll(".uplot")].every((plot) => plot.clientWidth <= innerWidth));
  const wide = await page.evaluate(() => [...document.querySelectorAll("#tables .table")].filter((t) => t.scrollWidth > t.clientWidth).map((t) => t.textContent.slice(0, 40)));
  assert.deepEqual(wide, []);
  assert.equal(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), true);
  assert.deepEqual(page.complaints, []);
  await page.close();
});

test("the review button of a replay saves the report", async (browser) => {
  await record();
  const program = await serve("tegotae", "replay", recording);
  const page = await open(browser, program.url);
  const saving = page.waitForEvent("download", { timeout: 4 * patience });
  await page.click("#review");
  const download = await saving;
  assert.equal(download.suggestedFilename(), "review_me.review.html");
  const saved = join(folder, "saved.html");
  await download.saveAs(saved);
  assert.equal(readFileSync(saved, "utf8"), readFileSync(report, "utf8"));
  assert.deepEqual(page.complaints, []);
  // Nobody gets it without the token.
  assert.equal((await fetch(new URL("/review", program.url))).status, 403);
  await page.close();
  await program.stop();
});
