import { plain } from "../common/number.js";

// From a clearance to a color: red is close, blue is as far as was looked, logarithmic; gray is farther.
const stops = [[165, 0, 38], [244, 109, 67], [254, 224, 144], [116, 173, 209], [49, 54, 149]];
const beyond = [150, 156, 163];
// Below, inside and above a band of clearances that was asked for.
const zones = [[200, 38, 38], [240, 178, 50], [44, 123, 182]];
const tickMargin = 0.24; // of the scale, for a label

// Red, green, blue from 0 to 255.
export const zoneColor = (zone) => zones[zone];

export class ClearanceScale {
  // `band`: {low, high} of three colors in place of the many, or undefined.
  constructor(clearances, reach, band) {
    let least = reach;
    for (const c of clearances) if (c > 0 && c < least) least = c;
    this.low = Math.max(1e-6, Math.min(10 ** Math.floor(Math.log10(least)), reach / 10));
    this.high = reach;
    this.band = band;
    if (band?.low > 0) this.low = Math.min(this.low, band.low / 2);
  }
  at(clearance) {
    return Math.log(Math.max(clearance, this.low) / this.low) / Math.log(this.high / this.low);
  }
  // Red, green, blue from 0 to 255.
  color(clearance) {
    if (this.band) return zones[clearance < this.band.low ? 0 : clearance <= this.band.high ? 1 : 2];
    if (clearance >= this.high * (1 - 1e-6)) return beyond;
    const x = this.at(clearance) * (stops.length - 1);
    const i = Math.min(Math.floor(x), stops.length - 2);
    return stops[i].map((c, k) => c + (x - i) * (stops[i + 1][k] - c));
  }
  // Both ends, and powers of ten with space between.
  ticks() {
    if (this.band) return [this.band.low, this.band.high].filter((v) => v >= this.low && v <= this.high);
    const out = [this.low];
    for (let v = 10 * this.low; this.at(v) < 1 - tickMargin; v *= 10) if (this.at(v) - this.at(out.at(-1)) > tickMargin) out.push(v);
    return [...out, this.high];
  }
}

export function lengthText(meters) {
  const [value, unit] = meters < 0.999e-3 ? [1e6 * meters, "µm"] : [1e3 * meters, "mm"];
  return `${plain(value, 2)} ${unit}`;
}

export function showLegend(figure, scale) {
  const canvas = figure.querySelector("canvas");
  const context = canvas.getContext("2d");
  for (let i = 0; i < canvas.width; ++i) {
    const clearance = scale.low * (scale.high / scale.low) ** (i / canvas.width);
    context.fillStyle = `rgb(${scale.color(clearance).map(Math.round).join(" ")})`;
    context.fillRect(i, 0, 1, 1);
  }
  for (const tick of scale.ticks()) {
    const label = document.createElement("span");
    label.textContent = lengthText(tick);
    label.style.left = `${100 * scale.at(tick)}%`;
    if (scale.at(tick) < 0.05) label.style.transform = "none";
    if (scale.at(tick) > 0.95) label.style.transform = "translateX(-100%)";
    figure.querySelector("div").append(label);
  }
}
