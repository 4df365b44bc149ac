// The newest values as text, slower than frames come, so that one can read them.
import { element } from "../common/dom.js";
import { fixed } from "../common/number.js";
import { forceState } from "./force.js";
import { distance, lagReasons, norm } from "./frame.js";

const periodMs = 120;
// A figure space in the place of the sign keeps columns in line.
const column = (v, places) => (fixed(v, places).startsWith("−") ? "" : "\u2007") + fixed(v, places);
const triple = (v, scale, places) => v.map((c) => column(c * scale, places)).join(" ");

// [id, name, unit, value, detail, only for who looks at the program itself]
const rows = [
  ["force", "Force", "N", (f) => fixed(norm(f.force), 2), (f) => triple(f.force, 1, 2)],
  ["torque", "Torque", "N·mm", (f) => fixed(1e3 * norm(f.torque), 1), (f) => triple(f.torque, 1e3, 1)],
  ["position", "Part at", "mm", () => "", (f) => triple(f.x.slice(0, 3), 1e3, 2)],
  ["lag", "Pen to part", "mm", (f) => fixed(1e3 * distance(f.x, f.y), 2), (f) => lagReasons[f.lagReason] ?? ""],
  ["gap", "Smallest gap", "µm", (f) => fixed(1e6 * f.gap, 1), () => ""],
  ["contacts", "Contacts", "", (f) => String(f.contacts), () => ""],
  ["near", "Near pairs", "", (f) => String(f.limits), () => "", true],
  ["tick", "Tick", "µs", (f) => (f.tickUs > 0 ? fixed(f.tickUs, 0) : "–"), (f) => (f.cut ? "cut short" : ""), true],
  ["late", "Servo late", "µs", (f) => fixed(f.lateUs, 0), () => "", true],
];

export class Numbers {
  constructor(parent) {
    const table = element("table", "", "numbers");
    this.rows = rows.map(([id, name, unit, value, detail, technical = false]) => {
      const row = element("tr", "", technical ? "technical" : "");
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
