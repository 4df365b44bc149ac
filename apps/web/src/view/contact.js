// A contact that was clicked on: its part, features, gap and force, as long as it is there.
import { length, written } from "../common/number.js";
import { element } from "../common/dom.js";
import { norm, distance } from "./frame.js";
import { project } from "./picking.js";

const reachPixels = 14;
const followed = 0.15; // of the held part's radius: how far the same contact may have gone in a frame

export class ContactCard {
  constructor(stage, place) {
    Object.assign(this, { stage, place, at: null, part: null });
    this.mark = element("span", "", "mark");
    stage.canvas.parentElement.append(this.mark);
    place.querySelector("button").addEventListener("click", () => this.close());
    this.close();
  }

  close() {
    this.at = null;
    this.place.hidden = this.mark.hidden = true;
  }

  // The ring around it goes with the picture.
  follow() {
    if (!this.at) return;
    const rect = this.stage.canvas.getBoundingClientRect();
    const [x, y] = project(this.stage, this.at);
    this.mark.style.transform = `translate(${x - rect.left}px, ${y - rect.top}px)`;
  }

  // Whether a contact was under the pointer: those that touch before those that are near.
  click(x, y, frame) {
    const from = (pair) => {
      const [px, py] = project(this.stage, pair.point);
      return Math.hypot(px - x, py - y);
    };
    const near = (pairs) => pairs.map((pair) => [from(pair), pair]).sort((a, b) => a[0] - b[0]).find(([pixels]) => pixels < reachPixels)?.[1];
    const pair = near(frame.pairs.filter((p) => p.touching)) ?? near(frame.pairs);
    if (!pair) return false;
    this.open(pair, frame);
    return true;
  }

  // Of those that touch, or where none does of all, the next one to the right in the picture; after the last the first.
  next(frame) {
    const touching = frame.pairs.filter((p) => p.touching);
    const pairs = (touching.length > 0 ? touching : [...frame.pairs]).map((pair) => [...project(this.stage, pair.point).map(Math.round), pair]).sort((a, b) => a[0] - b[0] || a[1] - b[1]).map(([, , pair]) => pair);
    if (pairs.length === 0) return;
    this.open(pairs[(pairs.indexOf(this.nearest(pairs)) + 1) % pairs.length], frame);
  }

  open(pair, frame) {
    [this.at, this.part] = [pair.point, pair.part];
    this.place.hidden = this.mark.hidden = false;
    this.show(frame);
    this.follow();
  }

  // The one that was shown last, as it is now.
  nearest(pairs) {
    if (!this.at) return undefined;
    const pair = pairs.filter((p) => p.part === this.part).sort((a, b) => distance(a.point, this.at) - distance(b.point, this.at))[0];
    return pair && distance(pair.point, this.at) < followed * this.stage.held.radius ? pair : undefined;
  }

  show(frame) {
    if (!this.at) return;
    const pair = this.nearest(frame.pairs);
    const list = this.place.querySelector("dl");
    if (pair) this.at = pair.point;
    const lines = pair ? this.lines(pair, frame) : [["", "It is no longer there."]];
    const text = lines.flat().join("|");
    if (text === this.shown) return;
    this.shown = text;
    list.replaceChildren(...lines.flatMap(([name, value]) => [element("dt", name), element("dd", value)]));
  }

  lines(pair, frame) {
    const [own, other] = pair.features;
    const force = frame.forces.filter((f) => distance(f.point, pair.point) < 0.01 * this.stage.held.radius).sort((a, b) => distance(a.point, pair.point) - distance(b.point, pair.point))[0];
    return [
      ["Part", this.stage.parts[pair.part]?.name ?? ""],
      ["Feature", `${own} of ${this.stage.held.name} on ${other}`],
      ["Gap", length(pair.gap)],
      ["Force", force ? `${written(norm(force.force), 3)}\u00a0N` : pair.touching ? "none" : "does not touch"],
    ];
  }
}
