// While nothing is held: what one can do, and the part that would be taken.
const $ = (id) => document.getElementById(id);

export class Rest {
  constructor(place, parts) {
    Object.assign(this, { place, parts });
    $("take-selected").addEventListener("click", () => parts.hold());
  }

  // on: nothing is held.
  show(on) {
    this.place.hidden = !on;
    if (!on) return;
    const { stage, selected, busy } = this.parts;
    const part = stage.parts[selected];
    const takeable = part !== undefined && !part.removed;
    $("rest-text").textContent = busy ? "One moment …" : takeable ? part.name : "Nothing is held: click a part to take it.";
    $("take-selected").hidden = !takeable;
    $("take-selected").disabled = busy;
  }
}
