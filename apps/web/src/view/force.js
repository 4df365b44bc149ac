// Whether the force is on, and if not, why and what to do; and what holds the part back that is no contact.
import { lagReasons } from "./frame.js";

// Reasons that explain nothing: none was seen; nobody had asked for a force yet, as when a run begins.
const [none, software] = [0, 4];
const patienceMs = 400; // every run begins without a force, for some milliseconds
const firstPatienceMs = 4000; // nobody is to meet a page that complains
const backMs = 3000; // how long it is said that the force is on again
const contact = 1; // of lagReasons

// In a few words, for the numbers.
export function forceState(frame, reasons) {
  if (frame.forceOn) return "Force is on";
  return `Force is off: ${frame.waiting ? "waiting for a small force" : reasons[frame.reason] ?? "unknown"}`;
}

// What to do, over the parts; hidden while the force is on and nothing but contacts holds the part back.
export class ForceNotice {
  constructor(place) {
    Object.assign(this, { place, off: null, late: null, back: null, seenOn: false }); // since when; seenOn: ever
  }

  // hand: what leads the part from here (hand.js).
  show(frame, reasons, hand, now = performance.now()) {
    const lasts = (since, ms) => since !== null && now - since >= ms;
    const patience = this.seenOn ? patienceMs : firstPatienceMs;
    if (frame.forceOn || !reasons) {
      if (this.seenOn && lasts(this.off, patienceMs)) this.back = now;
      this.off = null;
      this.seenOn = true;
    } else this.off ??= now;
    if (frame.lagReason > contact) this.late ??= now;
    else this.late = null;
    if (lasts(this.back, backMs)) this.back = null;
    const late = lasts(this.late, patience) ? `The part is held back, and not by a contact: ${lagReasons[frame.lagReason]}.` : "";
    const text = lasts(this.off, patience) ? this.text(frame, reasons, hand) : late || (this.back !== null ? "The force is on again." : "");
    if (this.place.textContent !== text) this.place.textContent = text;
    // What nobody can mend from here is a fault; that it waits for a small force is not.
    this.place.classList.toggle("bad", !frame.forceOn && !frame.waiting);
  }

  // There is none to speak of; the next run begins anew.
  rest() {
    Object.assign(this, { off: null, late: null, back: null, seenOn: false });
    this.place.textContent = "";
  }

  text(frame, reasons, hand) {
    const why = frame.waiting && (frame.reason === none || frame.reason === software) ? "" : `: ${reasons[frame.reason] ?? "unknown"}`;
    if (!frame.waiting) return `The force is off${why}.`;
    const what = hand.leads ? "Let go of the part, or move it back until it meets its ghost: then the force comes on again." :
      "It comes on again by itself when the part meets its ghost.";
    return `The force went off${why}. ${what}`;
  }
}
