// Plots beside the parts: the last seconds of a live run, or a whole recording with a line at the time that is shown.
import uPlot from "uplot";
import { element } from "../common/dom.js";
import { cssColor } from "../common/theme.js";

const [leastHeight, mostHeight] = [52, 150];
const captionHeight = 17, axisHeight = 16; // px; only the last plot has the axis of time
const windowSeconds = 15;
const mostPoints = 1200; // of a live plot; a frame comes every 33 ms
const redrawMs = 80;
const xyz = [["x", "--series-1"], ["y", "--series-2"], ["z", "--series-0"]];

const finite = (v) => (Number.isFinite(v) ? v : null);

// values: one a series, from a frame; null: a gap in the line. least: the smallest range, so that noise does not fill a
// plot; zero: the range begins there.
const plots = [
  { name: "Position", unit: "mm", series: xyz, values: (f) => f.x.slice(0, 3).map((v) => 1e3 * v), least: 1 },
  { name: "Force", unit: "N", series: xyz, values: (f) => f.force, least: 0.2 },
  { name: "Torque", unit: "N·mm", series: xyz, values: (f) => f.torque.map((v) => 1e3 * v), least: 2 },
  { name: "Gap", unit: "µm", series: [["", "--series-4"]], values: (f) => [finite(1e6 * f.gap)], least: 5 },
  { name: "Tick time", unit: "µs", series: [["", "--series-3"]], values: (f) => [f.tickUs > 0 ? f.tickUs : null], zero: true },
  { name: "Servo lateness", unit: "µs", series: [["", "--series-5"]], values: (f) => [finite(f.lateUs)], zero: true },
];

export class Plots {
  // seek(t): where somebody clicks into a plot of a recording; null in a live run.
  // without: names of plots for which there are no values.
  constructor(parent, seek, without) {
    this.parent = parent;
    this.seek = seek;
    this.times = [];
    this.t = 0;
    const shown = plots.filter((plot) => !without.includes(plot.name));
    this.frames = shown.map((plot) => {
      const frame = element("figure", "", "plot");
      const caption = element("figcaption");
      caption.append(element("span", `${plot.name} (${plot.unit})`));
      for (const [name, color] of plot.series) {
        if (!name) continue;
        const key = element("span", name, "key");
        key.style.color = `var(${color})`;
        caption.append(key);
      }
      frame.append(caption);
      parent.append(frame);
      return { ...plot, frame, columns: plot.series.map(() => []), canvas: null };
    });
    this.build();
    new ResizeObserver(() => this.fit()).observe(parent.parentElement);
  }

  // As wide as the place, and so high that all of them fit where that is possible.
  size(p) {
    const place = this.parent.parentElement;
    const room = place.clientHeight - this.parent.offsetTop - 8 - axisHeight;
    const height = Math.min(mostHeight, Math.max(leastHeight, Math.floor(room / this.frames.length) - captionHeight));
    return { width: p.frame.clientWidth || 300, height: height + (p === this.frames.at(-1) ? axisHeight : 0) };
  }
  fit() {
    for (const p of this.frames) {
      const { width, height } = this.size(p);
      if (p.canvas.width !== width || p.canvas.height !== height) p.canvas.setSize({ width, height });
    }
  }

  build() {
    for (const p of this.frames) {
      p.canvas?.destroy();
      const axis = { stroke: cssColor("--muted"), grid: { stroke: cssColor("--line"), width: 1 }, ticks: { show: false }, font: `10px ${cssColor("--font")}` };
      p.canvas = new uPlot({
        ...this.size(p),
        legend: { show: false },
        cursor: { show: this.seek !== null, x: true, y: false, points: { show: false }, drag: { x: false, y: false }, sync: { key: "time" } },
        scales: { x: { time: false, range: () => this.span() }, y: { range: (u, low, high) => this.range(p, low, high) } },
        axes: [p === this.frames.at(-1) ? { ...axis, size: axisHeight, gap: 1 } : { ...axis, size: 0, values: () => [] }, { ...axis, size: 44, gap: 3, space: 18 }],
        series: [{}, ...p.series.map(([, color]) => ({ stroke: cssColor(color), width: 1.25, points: { show: false } }))],
        padding: [4, 6, p === this.frames.at(-1) ? 0 : 6, 0],
        hooks: { draw: [(u) => this.drawNow(u)] },
      }, this.data(p), p.frame);
      if (this.seek) p.canvas.over.addEventListener("click", (event) => this.seek(p.canvas.posToVal(event.offsetX, "x")));
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
    if (p.zero) low = 0;
    const middle = (low + high) / 2;
    const half = Math.max((high - low) / 2, p.least / 2) * 1.1;
    return p.zero ? [0, Math.max(high, 1) * 1.1] : [middle - half, middle + half];
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

  clear() {
    this.times = [];
    for (const p of this.frames) p.columns = p.series.map(() => []);
  }

  append(frame) {
    this.times.push(frame.t);
    for (const p of this.frames) p.values(frame).forEach((v, i) => p.columns[i].push(v));
  }

  // The newest frame of a live run.
  push(frame) {
    if (frame.t < this.t) this.clear();
    this.t = frame.t;
    this.append(frame);
    if (this.times.length > mostPoints) for (const list of [this.times, ...this.frames.flatMap((p) => p.columns)]) list.shift();
    this.redraw();
  }

  // All of a recording, thinned.
  setRecording(replay) {
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
      for (const p of this.frames) p.canvas.setData(this.data(p));
    }, redrawMs);
  }

  // For tests: points of the plots and the last values.
  state() {
    return this.frames.map((p) => ({ name: p.name, unit: p.unit, points: this.times.length, last: p.columns.map((c) => c.at(-1) ?? null) }));
  }
}
