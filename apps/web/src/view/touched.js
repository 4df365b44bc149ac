// Tells those who hear the page what the held part touches, when that has changed and stays so.
const settleMs = 600;

export class Touched {
  constructor(place) {
    Object.assign(this, { place, next: "", since: null });
  }

  // parts: names by number, as in the frame's pairs.
  show(frame, parts, now = performance.now()) {
    const names = [...new Set(frame.pairs.filter((pair) => pair.touching).map((pair) => parts[pair.part]?.name))].sort();
    const text = names.length > 0 ? `Touches ${names.join(", ")}` : this.place.textContent && "Touches nothing";
    if (text !== this.next) [this.next, this.since] = [text, now];
    if (now - this.since >= settleMs && this.place.textContent !== text) this.place.textContent = text;
  }

  // There is no held part, or another one.
  rest() {
    this.next = this.place.textContent = "";
  }
}
