// What the view costs the loops: real-time runs without it, with one page watching and with eight, in turns.
//   TEGOTAE_BIN_DIR=build/release/bin node tests/view/measure.mjs [ROUNDS]
// Prints the table and puts it into docs/performance.md.
// The pages are plain clients that read the stream: what a browser does with it is another process's time.
import { spawn } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";

const bin = process.env.TEGOTAE_BIN_DIR;
const scene = new URL("../../models/peg_in_hole_0.94.toml", import.meta.url).pathname;
const rounds = Number(process.argv[2] ?? 4);
const seconds = 8;

async function watch(url) {
  const token = url.searchParams.get("token");
  const answer = await fetch(new URL("/stream", url), { headers: { "X-Tegotae-Token": token } });
  let bytes = 0;
  try {
    for await (const chunk of answer.body) bytes += chunk.length;
  } catch {
    // the run has ended
  }
  return bytes;
}

function run(watchers) {
  const view = watchers === null ? [] : ["--view"];
  const child = spawn(`${bin}/tegotae`, ["run", scene, "--json", "--seconds", String(seconds), ...view], { stdio: ["ignore", "pipe", "pipe"] });
  let out = "";
  const watching = [];
  child.stdout.on("data", (data) => (out += data));
  child.stderr.on("data", (data) => {
    const url = String(data).match(/http:\S+/);
    for (let i = 0; url && i < watchers; ++i) watching.push(watch(new URL(url[0])));
  });
  return new Promise((resolve) => child.on("exit", async () => {
    const bytes = await Promise.all(watching);
    resolve({ ...JSON.parse(out), bytes: bytes[0] ?? 0 });
  }));
}

const kinds = [["off", null], ["on, nobody watches", 0], ["on, one page", 1], ["on, eight pages", 8]];
const results = new Map(kinds.map(([name]) => [name, []]));
for (let i = 0; i < rounds; ++i) for (const [name, watchers] of kinds) results.get(name).push(await run(watchers));

const median = (values) => values.sort((a, b) => a - b)[Math.floor(values.length / 2)];
const lines = [`Medians of ${rounds} rounds of ${seconds} s:`, "", "| view | tick p50 / p99 / p99.9, µs | servo late p50 / p99 / p99.9, µs | servo periods missed | contact ticks a second | KB/s a page |", "|---|---|---|---|---|---|"];
for (const [name, runs] of results) {
  const of = (pick) => median(runs.map(pick));
  const row = (what) => ["p50", "p99", "p999"].map((p) => Math.round(of((r) => what(r)[p]))).join(" / ");
  lines.push(`| ${name} | ${row((r) => r.tick_us)} | ${row((r) => r.servo.late_us)} | ${of((r) => r.servo.missed)} | ${Math.round(of((r) => r.ticks / r.seconds))} | ${Math.round(of((r) => r.bytes / r.seconds) / 1024)} |`);
}
const table = lines.join("\n");
console.log(table);

const file = new URL("../../docs/performance.md", import.meta.url);
const [begin, end] = ["<!-- begin view -->\n", "\n<!-- end view -->"];
const text = readFileSync(file, "utf8");
if (!text.includes(begin) || !text.includes(end)) throw new Error("docs/performance.md has no place for the table");
writeFileSync(file, text.slice(0, text.indexOf(begin) + begin.length) + table + text.slice(text.indexOf(end)));
