// Whether the force is on, and if not, why and what to do; and what holds the part back that is no contact.
import { lagReasons } from "./frame.js";

// Reasons that explain nothing: none was seen; nobody had asked for a force yet, as when a run begins.
const [none, software] = [0, 4];
const patienceMs = 400; // every run begins without a force, for some milliseconds
const contact = 1; // of lagReasons

// In a few words, for the numbers.
export function forceState(frame, reasons) {
  if (frame.forceOn) return "Force is on";
  return `Force is off: ${frame.waiting ? "waiting for a small force" : reasons[frame.reason] ?? "unknown"}`;
}

// What to do, over the parts; hidden while the force is on and nothing but contacts holds the part back.
export class ForceNotice {
  constructor(place) {
    this.place = place;
    this.off = null; // since when
    this.late = null;
  }

  // hand: what leads the part from here (hand.js).
  show(frame, reasons, hand, now = performance.now()) {
    if (frame.forceOn || !reasons) this.off = null;
    else this.off ??= now;
    if (frame.lagReason > contact) this.late ??= now;
    else this.late = null;
    const lasts = (since) => since !== null && now - since >= patienceMs;
    const late = lasts(this.late) ? `The part is held back, and not by a contact: ${lagReasons[frame.lagReason]}.` : "";
    const text = lasts(this.off) ? this.text(frame, reasons, hand) : late;
    if (this.place.textContent !== text) this.place.textContent = text;
  }

  text(frame, reasons, hand) {
    const why = frame.waiting && (frame.reason === none || frame.reason === software) ? "" : `: ${reasons[frame.reason] ?? "unknown"}`;
    if (!frame.waiting) return `The force is off${why}.`;
    const what = hand.leads ? "Let go of the part, or move it back until it meets its ghost" :
      hand.enabled ? "Take the part with the mouse and let go of it" : "Move the pen back until the part meets its ghost";
    return `The force went off${why}. ${what}: then the force comes on again.`;
  }
}
