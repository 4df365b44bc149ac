// Draws one plot of a report with uPlot.
//
// plot: {title, x: {label, log?, whole?}, y: {label, log?, percent?}, kind?, gaps?: true, series: [{name, x: [...], y: [...], low?: [...], high?: [...],
//        points?: true, dash?: true}], marks?: [{x, label}]}
// kind "time" (the default): x ascends in every series; the legend follows the pointer. kind "trace": x may go back and
// forth (a path in a plane). low and high are the ends of error bars. With gaps a line breaks where its y is null.
import uPlot from "uplot";
import { element } from "./dom.js";
import { plain } from "./number.js";

const kHeight = 280;

function color(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}
const seriesColor = (i) => color(`--series-${i % 6}`);

// As many digits as a tick needs: uPlot's own labels stop at three decimals. On a log axis it leaves out some (null).
const tickText = (u, ticks) => ticks.map((v) => (v == null ? "" : plain(v)));

// Over many decades only powers of ten; uPlot would draw nine lines in each.
const kMaxDecades = 4;
function decades(u, axisIndex, low, high) {
  const [first, last] = [Math.ceil(Math.log10(low) - 1e-9), Math.floor(Math.log10(high) + 1e-9)];
  const step = last - first > 2 * kMaxDecades ? 3 : 1;
  return Array.from({ length: Math.floor((last - first) / step) + 1 }, (_, i) => 10 ** (first + i * step));
}

function wholeNumbers(u, axisIndex, low, high) {
  return Array.from({ length: Math.floor(high) - Math.ceil(low) + 1 }, (_, i) => Math.ceil(low) + i);
}

function axis(spec, [low, high]) {
  return {
    label: spec.label,
    values: tickText,
    ...(spec.log && Math.log10(high / low) > kMaxDecades ? { splits: decades, filter: (u, ticks) => ticks } : {}),
    ...(spec.whole ? { splits: wholeNumbers } : {}),
    stroke: color("--muted"),
    grid: { stroke: color("--line"), width: 1 },
    ticks: { stroke: color("--line"), width: 1 },
    labelSize: 22,
  };
}

const scale = (spec) => (spec.log ? { time: false, distr: 3 } : { time: false });

// A margin on both sides, so that points at the ends are not cut off.
const padded = (u, low, high) => (low == null ? [0, 1] : uPlot.rangeNum(low, high, { min: { pad: 0.04 }, max: { pad: 0.04 } }));

function eachDrawn(u, series, draw) {
  const { ctx } = u;
  ctx.save();
  ctx.beginPath();
  ctx.rect(u.bbox.left, u.bbox.top, u.bbox.width, u.bbox.height);
  ctx.clip();
  series.forEach((s, i) => {
    if (!u.series[i + 1].show) return;
    ctx.strokeStyle = ctx.fillStyle = seriesColor(i);
    ctx.lineWidth = 1.5 * devicePixelRatio;
    draw(ctx, s, (k) => u.valToPos(s.x[k], "x", true), (v) => u.valToPos(v, "y", true));
  });
  ctx.restore();
}

function drawErrorBars(u, series) {
  eachDrawn(u, series, (ctx, s, x, y) => {
    if (!s.low || !s.high) return;
    const cap = 4 * devicePixelRatio;
    ctx.beginPath();
    for (let k = 0; k < s.x.length; ++k) {
      if (s.low[k] == null || s.high[k] == null) continue;
      const [px, lo, hi] = [x(k), y(s.low[k]), y(s.high[k])];
      ctx.moveTo(px, lo);
      ctx.lineTo(px, hi);
      for (const end of [lo, hi]) {
        ctx.moveTo(px - cap, end);
        ctx.lineTo(px + cap, end);
      }
    }
    ctx.stroke();
  });
}

function drawTraces(u, series) {
  eachDrawn(u, series, (ctx, s, x, y) => {
    ctx.setLineDash(s.dash ? [6 * devicePixelRatio, 4 * devicePixelRatio] : []);
    ctx.beginPath();
    let pen = false;
    for (let k = 0; k < s.x.length; ++k) {
      const hole = s.x[k] == null || s.y[k] == null;
      if (!hole) (pen ? ctx.lineTo : ctx.moveTo).call(ctx, x(k), y(s.y[k]));
      pen = !hole;
    }
    ctx.stroke();
  });
}

function drawMarks(u, marks) {
  const { ctx } = u;
  ctx.save();
  ctx.strokeStyle = ctx.fillStyle = color("--muted");
  ctx.lineWidth = devicePixelRatio;
  ctx.font = `${12 * devicePixelRatio}px ${color("--font")}`;
  ctx.textAlign = "left";
  for (const mark of marks) {
    const x = Math.round(u.valToPos(mark.x, "x", true));
    if (x < u.bbox.left || x > u.bbox.left + u.bbox.width) continue;
    ctx.setLineDash([3 * devicePixelRatio, 3 * devicePixelRatio]);
    ctx.beginPath();
    ctx.moveTo(x, u.bbox.top);
    ctx.lineTo(x, u.bbox.top + u.bbox.height);
    ctx.stroke();
    ctx.fillText(mark.label, x + 4 * devicePixelRatio, u.bbox.top + 12 * devicePixelRatio);
  }
  ctx.restore();
}

// uPlot wants one ascending x for all series.
function aligned(series) {
  if (series.length === 1) return [series[0].x, series[0].y];
  return uPlot.join(series.map((s) => [s.x, s.y]));
}

// A trace is drawn by hand; uPlot sees its bounding box, for the scales.
function boxes(series) {
  const xs = series.flatMap((s) => s.x.filter((v) => v != null));
  let [low, high] = [Infinity, -Infinity];
  for (const v of xs) [low, high] = [Math.min(low, v), Math.max(high, v)];
  return [[low, high], ...series.map(() => [null, null])];
}

function yRange(spec, series) {
  let [low, high] = [Infinity, -Infinity];
  for (const s of series) {
    for (const list of [s.y, s.low, s.high]) {
      for (const v of list ?? []) if (v != null) [low, high] = [Math.min(low, v), Math.max(high, v)];
    }
  }
  if (!(low <= high)) return [0, 1];
  if (spec.percent) return [0, 105];
  return spec.log ? uPlot.rangeLog(low, high, 10, true) : uPlot.rangeNum(low, high, 0.1, true);
}

function options(plot, width) {
  const trace = plot.kind === "trace";
  const draw = [(u) => drawErrorBars(u, plot.series)];
  if (trace) draw.push((u) => drawTraces(u, plot.series));
  if (plot.marks) draw.push((u) => drawMarks(u, plot.marks));
  return {
    title: plot.title,
    width,
    height: kHeight,
    scales: { x: plot.series.some((s) => s.points) && !plot.x.log ? { ...scale(plot.x), range: padded } : scale(plot.x), y: { ...scale(plot.y), range: () => yRange(plot.y, plot.series) } },
    padding: [null, 24, null, null],
    axes: [axis(plot.x, [1, 1]), { ...axis(plot.y, yRange(plot.y, plot.series)), size: 64 }],
    cursor: { show: !trace, drag: { x: true, y: false } },
    legend: { live: !trace },
    series: [
      { label: plot.x.label },
      ...plot.series.map((s, i) => ({
        label: s.name,
        stroke: seriesColor(i),
        width: s.points ? 0 : 1.5,
        dash: s.dash ? [6, 4] : undefined,
        spanGaps: !plot.gaps,
        points: s.points ? { show: true, size: 6, fill: seriesColor(i) } : { show: false },
        value: (u, v) => (v == null ? "–" : plain(v, 4)),
      })),
    ],
    hooks: { draw },
  };
}

// Adds the plot to `parent`; it follows the width of its place and the light or dark scheme.
export function addPlot(parent, plot) {
  const frame = element("div", "", "plot");
  parent.append(frame);
  const data = plot.kind === "trace" ? boxes(plot.series) : aligned(plot.series);
  let shown = null;
  const show = () => {
    shown?.destroy();
    shown = new uPlot(options(plot, frame.clientWidth), data, frame);
    shown.ctx.canvas.setAttribute("role", "img");
    shown.ctx.canvas.setAttribute("aria-label", `${plot.title}: ${plot.y.label} over ${plot.x.label}`);
  };
  show();
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", show);
  new ResizeObserver(() => {
    if (Math.abs(shown.width - frame.clientWidth) > 1) shown.setSize({ width: frame.clientWidth, height: kHeight });
  }).observe(frame);
}
