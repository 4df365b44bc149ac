// The parts: which are shown and how, and what can be done to them while a run goes on: hold, move, remove, add back,
// and all of it taken back.
import * as THREE from "three";
import { element } from "../common/dom.js";
import { Tree } from "./tree.js";

const $ = (id) => document.getElementById(id);

// What takes a command back, given what was before.
function inverse(command, held) {
  if (command.do === "hold" && held < 0) return { do: "put_down" };
  if (command.do === "hold" || command.do === "put_down") return { do: "hold", part: held };
  if (command.do === "remove") return { do: "add", part: command.part };
  if (command.do === "add") return { do: "remove", part: command.part };
  const [x, y, z] = command.turn;
  // Turned about x, then y, then z; back again is another such three.
  const turn = new THREE.Quaternion().setFromEuler(new THREE.Euler(x, y, z, "ZYX")).invert();
  const { x: a, y: b, z: c } = new THREE.Euler().setFromQuaternion(turn, "ZYX");
  return { do: "move", part: command.part, by: command.by.map((v) => -v), turn: [a, b, c] };
}

export class Parts {
  // edit(command): a promise that throws what the program says against it; null where nothing can be changed.
  // loose: parts can be put down. onShow(): something of what this shows has changed.
  constructor(stage, edit, { loose = false, onMessage, onShow }) {
    Object.assign(this, { stage, onMessage, onShow, loose, selected: null, busy: false, edit, undoable: [], isolated: null });
    this.tree = new Tree($("parts"), $("search"), {
      item: (part, i) => this.row(part, i),
      onShow: (numbers, visible) => this.setVisible(numbers, visible),
    });
    $("isolate").addEventListener("click", () => this.isolate());
    $("fade").addEventListener("click", () => this.fade());
    $("show-all").addEventListener("click", () => this.showAll());
    for (const id of ["hold", "remove", "move", "undo"]) $(id).hidden = !edit;
    if (!edit) return;
    $("hold").addEventListener("click", () => this.hold());
    $("remove").addEventListener("click", () => this.send({ do: this.stage.parts[this.selected].removed ? "add" : "remove", part: this.selected }));
    $("undo").addEventListener("click", () => this.undo());
    $("move").addEventListener("submit", (event) => {
      event.preventDefault();
      this.move();
    });
  }

  // The list and the selected part, as the stage has them.
  show() {
    this.tree.show(this.stage.parts);
    $("undo").disabled = this.busy || this.undoable.length === 0;
    $("show-all").disabled = this.stage.parts.every((part) => part.visible && !part.faded);
    this.showSelected();
    this.onShow();
  }

  // The selected part is taken, or put down when it is held.
  hold() {
    const { held, removed } = this.stage.parts[this.selected] ?? { removed: true };
    if (!this.edit || this.busy || removed || (held && !this.loose)) return;
    this.send(held ? { do: "put_down" } : { do: "hold", part: this.selected });
  }

  setVisible(numbers, visible) {
    for (const i of numbers) this.stage.setVisible(this.stage.parts[i], visible);
    this.show();
  }

  row(part, i) {
    const item = element("li", "", `${part.removed ? "removed" : ""} ${i === this.selected ? "selected" : ""}`);
    const box = element("input");
    Object.assign(box, { type: "checkbox", checked: part.visible, disabled: part.removed, title: "Show it. A hidden part is still felt." });
    box.setAttribute("aria-label", `Show ${part.name}`);
    box.addEventListener("change", () => this.setVisible([i], box.checked));
    const swatch = element("span", "", "swatch");
    swatch.style.background = `#${this.stage.colorOf(part).getHexString()}`;
    const name = element("button", part.name, "name");
    name.title = part.name;
    name.setAttribute("aria-pressed", String(i === this.selected));
    name.addEventListener("click", () => this.select(i === this.selected ? null : i));
    item.append(box, swatch, name);
    if (part.held) item.append(element("span", "held", "badge"));
    if (!this.edit || part.held) return item;
    const [label, title, command] = part.removed ? ["Add back", `Put ${part.name} back where it was`, "add"] : ["Hold", `Take ${part.name} into the hand`, "hold"];
    const button = element("button", label, "do");
    button.title = title;
    button.setAttribute("aria-label", `${label} ${part.name}`);
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
    if (i !== null) this.tree.reveal(i);
    this.stage.highlight(i);
    this.show();
    this.tree.list.querySelector(".selected")?.scrollIntoView({ block: "nearest" });
  }

  showSelected() {
    const part = this.stage.parts[this.selected];
    $("selected").hidden = !part;
    if (!part) return;
    $("selected-name").textContent = [...part.path, part.name].join(" › ");
    $("isolate").setAttribute("aria-pressed", String(this.isolated === this.selected));
    $("fade").setAttribute("aria-pressed", String(part.faded));
    $("selected-note").textContent = !this.edit ? "" : part.held ? `The pen moves it. ${this.loose ? "Put it down" : "Hold another part"} to move or remove it here.` :
      part.removed ? "Removed: neither shown nor felt." : "Hidden parts are still felt; removed ones are not.";
    $("remove").textContent = part.removed ? "Add back" : "Remove";
    $("hold").textContent = part.held && this.loose ? "Put down" : "Hold";
    $("hold").disabled = (part.held && !this.loose) || part.removed || this.busy;
    $("remove").disabled = part.held || this.busy;
    for (const field of $("move").elements) field.disabled = part.held || part.removed || this.busy;
  }

  // Only the selected part is shown; once more: all are.
  isolate() {
    if (this.selected === null) return;
    const alone = this.isolated !== this.selected;
    this.isolated = alone ? this.selected : null;
    this.stage.parts.forEach((part, i) => this.stage.setVisible(part, !alone || i === this.selected));
    this.show();
  }
  // The selected part is seen through, or no longer.
  fade() {
    const part = this.stage.parts[this.selected];
    if (!part) return;
    this.stage.fade(part, !part.faded);
    this.show();
  }
  toggleVisible() {
    if (this.selected !== null) this.setVisible([this.selected], !this.stage.parts[this.selected].visible);
  }
  showAll() {
    this.isolated = null;
    for (const part of this.stage.parts) {
      this.stage.setVisible(part, true);
      this.stage.fade(part, false);
    }
    this.show();
  }

  move() {
    const numbers = (name, unit) => ["x", "y", "z"].map((axis) => unit * (Number($("move").elements[name + axis].value) || 0));
    this.send({ do: "move", part: this.selected, by: numbers("by-", 1e-3), turn: numbers("turn-", Math.PI / 180) });
  }

  async send(command) {
    const back = inverse(command, this.stage.parts.findIndex((part) => part.held));
    if (await this.ask(command)) this.undoable.push(back);
    this.show();
  }

  // Takes the last change back; where that cannot be, the program says why, and the change stays.
  async undo() {
    const command = this.undoable.at(-1);
    if (!command || this.busy) return;
    if (await this.ask(command)) this.undoable.pop();
    this.show();
  }
  // What was done belongs to a run that is over.
  forget() {
    this.undoable = [];
    this.show();
  }

  async ask(command) {
    this.setBusy(true);
    try {
      await this.edit(command);
      this.tell("");
      return true;
    } catch (error) {
      this.tell(error.message);
      return false;
    } finally {
      this.setBusy(false);
    }
  }

  // "" removes the message that this has shown, and no other.
  tell(text) {
    if (text || this.told) this.onMessage(text);
    this.told = text !== "";
  }

  setBusy(on) {
    this.busy = on;
    this.show();
  }
}
