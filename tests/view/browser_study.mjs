// The report on a study in a real browser: its links, and the commands that make what they lead to.
import assert from "node:assert/strict";
import { existsSync, mkdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { folder, scene, test } from "./cases.mjs";
import { patience, run } from "./program.mjs";

test("a study: links lead to replays, and commands can be pasted into any shell", async (browser) => {
  const home = join(folder, "it's a study"), out = join(home, "not beside it", "out"), file = join(home, "peg.toml");
  mkdirSync(home);
  writeFileSync(file, `scenes = ["${scene}"]\nseconds = 1\nrepeats = 3\n`);
  await run("tegotae", "study", file, "--out", out);
  await run("tegotae", "study", "merge", file, "--replays", "1", "--out", out);
  const page = await browser.newPage();
  page.setDefaultTimeout(patience);
  const complaints = [];
  page.on("pageerror", (error) => complaints.push(String(error.stack)));
  await page.goto(`file://${encodeURI(join(out, "report.html"))}`);
  await page.waitForSelector("code");
  const rows = await page.locator("tr:has(code)").evaluateAll((all) =>
    all.map((row) => ({ href: row.querySelector("a").href, command: row.querySelector("code").textContent })));
  assert.equal(rows.length, 3);
  const there = (row) => existsSync(fileURLToPath(row.href));
  assert.equal(rows.filter(there).length, 1);
  const other = rows.find((row) => !there(row));
  assert.match(other.command, /^tegotae study case /);
  // From another folder.
  await run("/bin/sh", "-c", `PATH="$TEGOTAE_BIN_DIR:$PATH"; ${other.command}`);
  assert.ok(there(other), "the command makes what the link leads to");
  for (const row of rows.filter(there)) {
    await page.goto(row.href);
    await page.waitForFunction(() => window.__tegotae?.state.frame, null, { timeout: patience });
  }
  assert.deepEqual(complaints, []);
  await page.close();
});
