// The newest values as text, slower than frames come, so that one can read them.
import { element } from "../common/dom.js";
import { forceState } from "./force.js";
import { distance, lagReasons, norm } from "./frame.js";

const periodMs = 120;
const signed = (v, digits) => (Number(v.toFixed(digits)) < 0 ? "−" : "\u2007") + Math.abs(v).toFixed(digits);
const triple = (v, scale, digits) => v.map((c) => signed(c * scale, digits)).join(" ");

const rows = [
  ["force", "Force", "N", (f) => norm(f.force).toFixed(2), (f) => triple(f.force, 1, 2)],
  ["torque", "Torque", "N·mm", (f) => norm(f.torque.map((v) => 1e3 * v)).toFixed(1), (f) => triple(f.torque, 1e3, 1)],
  ["position", "Part at", "mm", () => "", (f) => triple(f.x.slice(0, 3), 1e3, 2)],
  ["lag", "Pen to part", "mm", (f) => (1e3 * distance(f.x, f.y)).toFixed(2), (f) => lagReasons[f.lagReason] ?? ""],
  ["gap", "Smallest gap", "µm", (f) => (Number.isFinite(f.gap) ? (1e6 * f.gap).toFixed(1) : "–"), () => ""],
  ["contacts", "Contacts", "", (f) => String(f.contacts), (f) => `of ${f.limits} near pairs`],
  ["tick", "Tick", "µs", (f) => (f.tickUs > 0 ? f.tickUs.toFixed(0) : "–"), (f) => (f.cut ? "cut short" : "")],
  ["late", "Servo late", "µs", (f) => (Number.isFinite(f.lateUs) ? f.lateUs.toFixed(0) : "–"), () => ""],
];

export class Numbers {
  constructor(parent) {
    const table = element("table", "", "numbers");
    this.rows = rows.map(([id, name, unit, value, detail]) => {
      const row = element("tr");
      const head = element("th", name);
      head.scope = "row";
      const cells = ["value", "unit", "detail"].map((kind) => element("td", "", kind));
      cells[1].textContent = unit;
      row.dataset.id = id;
      row.append(head, ...cells);
      table.append(row);
      return { cells, value, detail };
    });
    this.state = element("p", "", "force-state");
    parent.append(table, this.state);
  }

  show(frame, reasons, now = performance.now()) {
    this.frame = frame;
    if (this.waiting) return;
    this.waiting = true;
    setTimeout(() => {
      this.waiting = false;
      for (const { cells, value, detail } of this.rows) {
        cells[0].textContent = value(this.frame);
        cells[2].textContent = detail(this.frame);
      }
      this.state.textContent = reasons ? forceState(this.frame, reasons) : "";
      this.state.classList.toggle("off", !this.frame.forceOn);
    }, Math.max(0, periodMs - (now - (this.last ?? 0))));
    this.last = now;
  }
}
