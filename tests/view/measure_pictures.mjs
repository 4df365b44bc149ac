// What a picture of 300 000 triangles costs in a browser that renders in software: processor time of all its processes, and
// pictures a second, while one orbits and of a page that draws nothing.
//   TEGOTAE_BIN_DIR=build/release/bin node tests/view/measure_pictures.mjs [ROUNDS]
// A busy machine shows fewer pictures a second; the processor time of one tells what two idle processors would show.
import { mkdtempSync, readFileSync, readdirSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { launch, open, serve, state } from "./program.mjs";
import { orbit, ringTriangles, writeRings } from "./rings.mjs";

const rounds = Number(process.argv[2] ?? 3), ms = 4000, ticksPerSecond = 100;

// s, of this process's children and theirs: the browser has renderers and a process that draws.
function processorTime() {
  const all = new Map();
  for (const pid of readdirSync("/proc").filter((name) => /^\d+$/.test(name))) {
    try {
      const text = readFileSync(`/proc/${pid}/stat`, "utf8");
      const name = text.slice(text.indexOf("(") + 1, text.lastIndexOf(")"));
      const fields = text.slice(text.lastIndexOf(")") + 2).split(" ");
      all.set(Number(pid), { name, parent: Number(fields[1]), time: (Number(fields[11]) + Number(fields[12])) / ticksPerSecond });
    } catch {
      // it has ended
    }
  }
  const ours = (pid) => pid === process.pid || (all.has(pid) && ours(all.get(pid).parent));
  return [...all].filter(([pid, { name }]) => name.startsWith("chrom") && ours(pid)).reduce((sum, [, { time }]) => sum + time, 0);
}

const folder = mkdtempSync(join(tmpdir(), "tegotae_pictures_"));
const program = await serve("tegotae", "view", writeRings(folder));
const browser = await launch();
const page = await open(browser, program.url, { height: 768, runs: false });
await page.waitForTimeout(3000);
console.log(`${ringTriangles} triangles, 1366 x 768`);
for (let i = 0; i < rounds; ++i) {
  const [before, spent] = [await state(page), processorTime()];
  const begin = Date.now();
  await orbit(page, ms);
  const seconds = (Date.now() - begin) / 1000, after = await state(page);
  const pictures = after.drawn - before.drawn, each = (1000 * (processorTime() - spent)) / pictures;
  console.log(`${(pictures / seconds).toFixed(1)} pictures a second, ${each.toFixed(0)} ms of processor each: two could show ${(2000 / each).toFixed(0)}`);
}
await browser.close();
await program.stop();
rmSync(folder, { recursive: true });
