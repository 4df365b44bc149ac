// The cases of the browser test, and the folder in which they work.
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { launch } from "./program.mjs";

export const folder = mkdtempSync(join(tmpdir(), "tegotae_browser_"));
export const scene = `${process.env.TEGOTAE_MODELS_DIR}/peg_in_hole_0.94.toml`;

const cases = [];
export const test = (name, body) => cases.push({ name, body });

// Runs those whose name contains `part`; how many failed.
export async function runCases(part) {
  const chosen = cases.filter((c) => c.name.includes(part));
  if (chosen.length === 0) throw new Error(`no case has "${part}" in its name`);
  const browser = await launch();
  let failed = 0;
  for (const { name, body } of chosen) {
    const begin = Date.now();
    try {
      await body(browser);
      console.log(`ok: ${name} (${Math.round((Date.now() - begin) / 1000)} s)`);
    } catch (error) {
      ++failed;
      console.log(`FAILED: ${name}\n${error.stack}`);
      // A page that goes on drawing would take the next case's time.
      for (const context of browser.contexts()) await context.close();
    }
  }
  await browser.close();
  rmSync(folder, { recursive: true });
  return failed;
}
