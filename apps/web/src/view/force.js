// Whether the force is on, and if not, why and what to do.
// Reasons that explain nothing: none was seen; nobody had asked for a force yet, as when a run begins.
const [none, software] = [0, 4];
const patienceMs = 400; // every run begins without a force, for some milliseconds

// In a few words, for the numbers.
export function forceState(frame, reasons) {
  if (frame.forceOn) return "Force is on";
  return `Force is off: ${frame.waiting ? "waiting for a small force" : reasons[frame.reason] ?? "unknown"}`;
}

// What to do, over the parts; hidden while the force is on.
export class ForceNotice {
  constructor(place) {
    this.place = place;
    this.off = null; // since when
  }

  show(frame, { reasons, led }, now = performance.now()) {
    if (frame.forceOn || !reasons) this.off = null;
    else this.off ??= now;
    const text = this.off === null || now - this.off < patienceMs ? "" : this.text(frame, reasons, led);
    if (this.place.textContent !== text) this.place.textContent = text;
  }

  text(frame, reasons, led) {
    const why = frame.waiting && (frame.reason === none || frame.reason === software) ? "" : `: ${reasons[frame.reason] ?? "unknown"}`;
    const what = led ? "Let go, or move it back until the part meets its ghost." : "Move the pen back until the part meets its ghost.";
    return `${frame.waiting ? "The force went off" : "The force is off"}${why}.${frame.waiting ? ` ${what} Then the force comes on again.` : ""}`;
  }
}
