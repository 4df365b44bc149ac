// The parts and what can be done to them while a run goes on: hold, move, remove, add back.
import { element } from "../common/dom.js";

const $ = (id) => document.getElementById(id);
const clickSlop = 4; // pixels that the pointer may move in a click

export class Parts {
  // edit(command): a promise that throws what the program says against it; null where nothing can be changed.
  constructor(stage, edit, onMessage) {
    Object.assign(this, { stage, onMessage, selected: null, busy: false, edit });
    if (!edit) return;
    $("hold").addEventListener("click", () => this.send({ do: "hold", part: this.selected }));
    $("remove").addEventListener("click", () => this.send({ do: this.stage.parts[this.selected].removed ? "add" : "remove", part: this.selected }));
    $("move").addEventListener("submit", (event) => {
      event.preventDefault();
      this.move();
    });
    this.listenToClicks();
  }

  // A click on a part in the picture selects it, one beside all parts nothing.
  listenToClicks() {
    const { canvas } = this.stage;
    let down = null;
    canvas.addEventListener("pointerdown", (event) => (down = event.button === 0 ? event : null));
    canvas.addEventListener("pointerup", (event) => {
      const still = down && Math.hypot(event.clientX - down.clientX, event.clientY - down.clientY) < clickSlop;
      down = null;
      if (!still) return;
      const hit = this.stage.pick(event.clientX, event.clientY);
      this.select(hit ? this.stage.parts.indexOf(hit.part) : null);
    });
  }

  // The list and the selected part, as the stage has them.
  show() {
    $("parts").replaceChildren(...this.stage.parts.map((part, i) => this.row(part, i)));
    this.showSelected();
  }

  row(part, i) {
    const item = element("li", "", `${part.removed ? "removed" : ""} ${i === this.selected ? "selected" : ""}`);
    const box = element("input");
    Object.assign(box, { type: "checkbox", checked: part.visible, disabled: part.removed, title: "Show it. A hidden part is still felt." });
    box.setAttribute("aria-label", `Show ${part.name}`);
    box.addEventListener("change", () => this.stage.setVisible(part, box.checked));
    const swatch = element("span", "", "swatch");
    swatch.style.background = `var(${part.colorName})`;
    const name = element(this.edit ? "button" : "span", part.name, "name");
    name.title = part.name;
    item.append(box, swatch, name);
    if (part.held) item.append(element("span", "held", "badge"));
    if (!this.edit) return item;
    name.addEventListener("click", () => this.select(i === this.selected ? null : i));
    if (part.held) return item;
    const [label, title, command] = part.removed ? ["Add back", `Put ${part.name} back where it was`, "add"] : ["Hold", `Take ${part.name} into the hand`, "hold"];
    const button = element("button", label, "do");
    button.title = title;
    button.disabled = this.busy;
    button.addEventListener("click", () => this.send({ do: command, part: i }));
    item.append(button);
    return item;
  }

  select(i) {
    if (i !== this.selected && !this.busy) {
      $("move").reset();
      this.tell("");
    }
    this.selected = i;
    this.stage.highlight(i);
    this.show();
  }

  showSelected() {
    const part = this.stage.parts[this.selected];
    $("selected").hidden = !part;
    if (!part) return;
    $("selected-name").textContent = part.name;
    $("selected-note").textContent = part.held ? "The pen moves it. Hold another part to move or remove it here." :
      part.removed ? "Removed: neither shown nor felt." : "Hidden parts are still felt; removed ones are not.";
    $("remove").textContent = part.removed ? "Add back" : "Remove";
    $("hold").disabled = part.held || part.removed || this.busy;
    $("remove").disabled = part.held || this.busy;
    for (const field of $("move").elements) field.disabled = part.held || part.removed || this.busy;
  }

  move() {
    const numbers = (name, unit) => ["x", "y", "z"].map((axis) => unit * (Number($("move").elements[name + axis].value) || 0));
    this.send({ do: "move", part: this.selected, by: numbers("by-", 1e-3), turn: numbers("turn-", Math.PI / 180) });
  }

  async send(command) {
    this.setBusy(true);
    try {
      await this.edit(command);
      this.tell("");
    } catch (error) {
      this.tell(error.message);
    }
    this.setBusy(false);
  }

  // "" takes back what this has told, and nothing else.
  tell(text) {
    if (text || this.told) this.onMessage(text);
    this.told = text !== "";
  }

  setBusy(on) {
    this.busy = on;
    this.show();
  }
}
