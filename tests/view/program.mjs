// Programs that serve a page, and the browser that opens it.
import { spawn } from "node:child_process";
import { createInterface } from "node:readline";
import { chromium } from "playwright-core";

const bin = process.env.TEGOTAE_BIN_DIR;
export const patience = 60_000; // ms; software rendering on a busy machine

export function launch() {
  return chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  });
}

// What still runs when a test fails ends with it.
const children = [];
process.on("exit", () => children.forEach((child) => child.kill("SIGKILL")));

// A running program: {url, stop(), stall(ms)}.
export async function serve(program, ...options) {
  const child = spawn(`${bin}/${program}`, options, { stdio: ["ignore", "pipe", "inherit"] });
  children.push(child);
  const ended = new Promise((resolve) => child.on("exit", (code, signal) => resolve(signal ?? code)));
  const lines = createInterface({ input: child.stdout });
  const url = await new Promise((resolve, reject) => {
    lines.on("line", (line) => line.match(/http:\S+/) && resolve(line.match(/http:\S+/)[0]));
    ended.then((code) => reject(new Error(`${program} ended with ${code}`)));
  });
  const stop = () => (child.kill("SIGINT"), ended);
  // Stands still for so many ms, all threads of it.
  const stall = (ms) => {
    child.kill("SIGSTOP");
    setTimeout(() => child.kill("SIGCONT"), ms);
  };
  return { url, stop, stall };
}

export async function run(program, ...options) {
  const child = spawn(program.includes("/") ? program : `${bin}/${program}`, options, { stdio: ["ignore", "ignore", "inherit"] });
  const code = await new Promise((resolve) => child.on("exit", resolve));
  if (code !== 0) throw new Error(`${program} ${options.join(" ")} ended with ${code}`);
}

// A page that notes every complaint in `page.complaints`. `play`: a run in virtual time goes on. `runs`: there is a run,
// or a recording of one.
export async function open(browser, url, { dark = false, width = 1366, height = 680, play = false, runs = true } = {}) {
  const page = await browser.newPage({ viewport: { width, height }, colorScheme: dark ? "dark" : "light" });
  page.setDefaultTimeout(patience);
  page.complaints = [];
  page.on("console", (message) => ["error", "warning"].includes(message.type()) && page.complaints.push(message.text()));
  page.on("pageerror", (error) => page.complaints.push(String(error.stack)));
  await page.addInitScript(noteWhatIsSaid);
  await page.goto(url);
  if (play) await page.click("#play");
  await until(page, (s) => (runs ? s.frame : s.status.generation));
  return page;
}

// Runs in the page: every text that has stood over the parts about the force, in order.
function noteWhatIsSaid() {
  window.__said = [];
  addEventListener("DOMContentLoaded", () => {
    const place = document.getElementById("force");
    new MutationObserver(() => place.textContent && window.__said.push(place.textContent)).observe(place, { childList: true, characterData: true, subtree: true });
  });
}
export const said = (page) => page.evaluate(() => window.__said);

// The last values of the plot with this name.
export const plotted = (s, name) => s.plots.find((plot) => plot.name === name).last;

export const state = (page) => page.evaluate(() => window.__tegotae.state);
// Waits until the page's state fulfils `test`, and returns that state. (Playwright's own waiting evaluates text in the
// page, which the page's security policy forbids.)
export async function until(page, test) {
  for (const end = Date.now() + patience; ; await page.waitForTimeout(30)) {
    const now = await state(page);
    if (test(now)) return now;
    if (Date.now() > end) throw new Error(`waited in vain for ${test}; the page says ${JSON.stringify(now)}`);
  }
}
