// Plots beside the parts: the last seconds of a live run, or a whole recording with a line at the time that is shown.
import uPlot from "uplot";
import { element } from "../common/dom.js";
import { fixed, written } from "../common/number.js";
import { cssColor } from "../common/theme.js";
import { distance, norm } from "./frame.js";

const [minHeight, maxHeight] = [52, 150];
const captionHeight = 17, axisHeight = 16; // px; only the last plot has the axis of time
const windowSeconds = 15;
const maxPoints = 1200; // of a live plot; a frame comes every 33 ms
const redrawMs = 80;
const xyz = [["x", "--series-1"], ["y", "--series-2"], ["z", "--series-0"]];

const finite = (v) => (Number.isFinite(v) ? v : null);

// values: one a series, from a frame; null: a gap in the line. least: the smallest range, so that noise does not fill a
// plot; zero: the range begins there. peak: the largest value is kept, as a line. technical: only for who looks at the
// program itself.
const plots = [
  { name: "Force", unit: "N", series: [["", "--series-0"]], values: (f) => [norm(f.force)], zero: true, least: 0.5, peak: 2 },
  { name: "Torque", unit: "N·mm", series: [["", "--series-3"]], values: (f) => [1e3 * norm(f.torque)], zero: true, least: 2, peak: 1 },
  { name: "Gap", unit: "µm", series: [["", "--series-4"]], values: (f) => [finite(1e6 * f.gap)], zero: true, least: 5 },
  { name: "To the goal", unit: "mm", series: [["", "--series-2"]], values: (f, goal) => [goal ? 1e3 * distance(f.x, goal) : null], zero: true, least: 1 },
  { name: "Position", unit: "mm", series: xyz, values: (f) => f.x.slice(0, 3).map((v) => 1e3 * v), least: 1 },
  { name: "Force along", unit: "N", series: xyz, values: (f) => f.force, least: 0.2, technical: true },
  { name: "Torque about", unit: "N·mm", series: xyz, values: (f) => f.torque.map((v) => 1e3 * v), least: 2, technical: true },
  { name: "Tick time", unit: "µs", series: [["", "--series-3"]], values: (f) => [f.tickUs > 0 ? f.tickUs : null], zero: true, least: 1, technical: true },
  { name: "Servo lateness", unit: "µs", series: [["", "--series-5"]], values: (f) => [finite(f.lateUs)], zero: true, least: 1, technical: true },
];

export class Plots {
  // seek(t): where somebody clicks into a plot of what is played back; null in a live run.
  // without: names of plots for which there are no values. goal: where the held part is to go, a pose or null.
  constructor(parent, seek, without, goal) {
    Object.assign(this, { parent, seek, goal, technical: false });
    this.times = [];
    this.t = 0;
    const shown = plots.filter((plot) => !without.includes(plot.name));
    this.frames = shown.map((plot) => {
      const frame = element("figure", "", plot.technical ? "plot technical" : "plot");
      frame.setAttribute("aria-label", `${plot.name} over time`);
      const caption = element("figcaption");
      caption.append(element("span", `${plot.name} (${plot.unit})`));
      for (const [name, color] of plot.series) {
        if (!name) continue;
        const key = element("span", name, "key");
        key.style.color = `var(${color})`;
        caption.append(key);
      }
      const p = { ...plot, frame, columns: plot.series.map(() => []), canvas: null, highest: null };
      if (plot.peak !== undefined) caption.append(this.peakOf(p));
      frame.append(caption);
      parent.append(frame);
      return p;
    });
    this.build();
    new ResizeObserver(() => this.fit()).observe(parent.parentElement);
  }

  // The largest value so far; a click forgets it.
  peakOf(p) {
    p.label = element("button", "", "peak");
    p.label.title = "The largest so far; click to begin anew";
    p.label.addEventListener("click", () => {
      p.highest = p.columns[0].at(-1) ?? null;
      this.showPeak(p);
      this.redraw();
    });
    this.showPeak(p);
    return p.label;
  }
  showPeak(p) {
    const text = p.highest === null ? "peak –" : `peak ${fixed(p.highest, p.peak)}`;
    if (p.label.textContent === text) return;
    p.label.textContent = text;
    p.label.setAttribute("aria-label", `${p.name}: ${text} ${p.unit}, begin anew`);
  }

  // Those that are to be seen.
  get seen() {
    return this.frames.filter((p) => this.technical || !p.technical);
  }
  showTechnical(on) {
    this.technical = on;
    this.build();
  }

  // As wide as the place, and so high that all of them fit where that is possible.
  size(p) {
    const place = this.parent.parentElement;
    const room = place.clientHeight - this.parent.offsetTop - 8 - axisHeight;
    const height = Math.min(maxHeight, Math.max(minHeight, Math.floor(room / this.seen.length) - captionHeight));
    return { width: p.frame.clientWidth || 300, height: height + (p === this.seen.at(-1) ? axisHeight : 0) };
  }
  fit() {
    for (const p of this.seen) {
      const { width, height } = this.size(p);
      if (p.canvas.width !== width || p.canvas.height !== height) p.canvas.setSize({ width, height });
    }
  }

  build() {
    for (const p of this.frames) {
      p.canvas?.destroy();
      p.canvas = null;
    }
    for (const p of this.seen) {
      const last = p === this.seen.at(-1);
      const axis = { stroke: cssColor("--muted"), grid: { stroke: cssColor("--line"), width: 1 }, ticks: { show: false }, font: `10px ${cssColor("--font")}` };
      p.canvas = new uPlot({
        ...this.size(p),
        legend: { show: false },
        cursor: { show: true, x: true, y: false, points: { show: false }, drag: { x: false, y: false }, sync: { key: "time" } },
        scales: { x: { time: false, range: () => this.span() }, y: { range: (u, low, high) => this.range(p, low, high) } },
        axes: [last ? { ...axis, size: axisHeight, gap: 1 } : { ...axis, size: 0, values: () => [] }, { ...axis, size: 44, gap: 3, space: 18, values: (u, ticks) => ticks.map((v) => (v === null ? "" : written(v, 4))) }],
        series: [{}, ...p.series.map(([, color]) => ({ stroke: cssColor(color), width: 1.25, points: { show: false } }))],
        padding: [4, 6, last ? 0 : 6, 0],
        hooks: { draw: [(u) => this.drawNow(u), (u) => this.drawPeak(u, p)] },
      }, this.data(p), p.frame);
      p.canvas.root.setAttribute("aria-hidden", "true"); // its newest value is in the table
      p.canvas.over.addEventListener("click", (event) => this.seek?.(p.canvas.posToVal(event.offsetX, "x")));
    }
  }

  data(p) {
    return [this.times, ...p.columns];
  }
  span() {
    if (this.seek) return [this.times[0] ?? 0, this.times.at(-1) ?? 1];
    return [Math.max(0, this.t - windowSeconds), Math.max(windowSeconds, this.t)];
  }
  range(p, low, high) {
    if (low === null) return [0, 1];
    if (p.zero) return [0, 1.1 * Math.max(high, p.highest ?? 0, p.least)];
    const middle = (low + high) / 2;
    const half = Math.max((high - low) / 2, p.least / 2) * 1.1;
    return [middle - half, middle + half];
  }

  drawNow(u) {
    if (!this.seek) return;
    const x = Math.round(u.valToPos(this.t, "x", true)) + 0.5;
    u.ctx.save();
    u.ctx.strokeStyle = cssColor("--accent");
    u.ctx.beginPath();
    u.ctx.moveTo(x, u.bbox.top);
    u.ctx.lineTo(x, u.bbox.top + u.bbox.height);
    u.ctx.stroke();
    u.ctx.restore();
  }

  drawPeak(u, p) {
    if (!(p.highest > 0)) return;
    const y = Math.round(u.valToPos(p.highest, "y", true)) + 0.5;
    u.ctx.save();
    u.ctx.strokeStyle = cssColor("--muted");
    u.ctx.setLineDash([4 * devicePixelRatio, 3 * devicePixelRatio]);
    u.ctx.beginPath();
    u.ctx.moveTo(u.bbox.left, y);
    u.ctx.lineTo(u.bbox.left + u.bbox.width, y);
    u.ctx.stroke();
    u.ctx.restore();
  }

  clear() {
    this.times = [];
    for (const p of this.frames) {
      p.columns = p.series.map(() => []);
      p.highest = null;
      if (p.label) this.showPeak(p);
    }
  }

  append(frame) {
    this.times.push(frame.t);
    for (const p of this.frames) {
      const values = p.values(frame, this.goal);
      values.forEach((v, i) => p.columns[i].push(v));
      if (p.label && values[0] > (p.highest ?? -1)) {
        p.highest = values[0];
        this.showPeak(p);
      }
    }
  }

  // The newest frame of a live run.
  push(frame) {
    if (frame.t < this.t) this.clear();
    this.t = frame.t;
    this.append(frame);
    if (this.times.length > maxPoints) for (const list of [this.times, ...this.frames.flatMap((p) => p.columns)]) list.shift();
    this.redraw();
  }

  // All of what is played back, thinned.
  setRecording(replay) {
    this.clear();
    const step = Math.max(1, Math.ceil(replay.count / 4000));
    for (let i = 0; i < replay.count; i += step) this.append(replay.frame(i));
    this.redraw();
  }
  showTime(t) {
    this.t = t;
    this.redraw();
  }

  redraw() {
    if (this.waiting) return;
    this.waiting = true;
    setTimeout(() => {
      this.waiting = false;
      for (const p of this.seen) p.canvas.setData(this.data(p));
    }, redrawMs);
  }

  // For tests: points of the plots and the last values.
  state() {
    return this.frames.map((p) => ({ name: p.name, unit: p.unit, points: this.times.length, last: p.columns.map((c) => c.at(-1) ?? null), peak: p.highest }));
  }
}
