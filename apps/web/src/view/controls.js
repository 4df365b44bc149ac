// Buttons, lists and keys around the parts.
import { element } from "../common/dom.js";
import { views } from "./camera.js";
import { help, isTyping } from "./keys.js";

const $ = (id) => document.getElementById(id);

function toggle(label, pressed, click) {
  const button = element("button", label);
  button.setAttribute("aria-pressed", String(pressed));
  button.addEventListener("click", click);
  return button;
}

function checkbox(label, checked, change) {
  const line = element("label");
  const box = element("input");
  box.type = "checkbox";
  box.checked = checked;
  box.addEventListener("change", () => change(box.checked));
  line.append(box, label);
  return line;
}

export function showLayers(overlay) {
  const names = { contacts: "Contacts and normals", pairs: "Nearest features", forces: "Contact forces", arrows: "Force and torque" };
  $("layers").replaceChildren(...Object.entries(names).map(([layer, name]) => checkbox(name, overlay.enabled[layer], (on) => overlay.enable(layer, on))));
}

export class Section {
  constructor(stage) {
    this.stage = stage;
    this.axis = null;
    this.buttons = ["Off", "x", "y", "z"].map((label, i) => toggle(label, i === 0, () => this.set(i === 0 ? null : i - 1)));
    document.querySelector("#section .group").append(...this.buttons);
    $("cut").addEventListener("input", () => this.apply());
    $("flip").addEventListener("change", () => this.apply());
  }
  set(axis) {
    this.axis = axis;
    this.apply();
  }
  next() {
    this.set(this.axis === null ? 0 : this.axis === 2 ? null : this.axis + 1);
  }
  apply() {
    const on = this.axis !== null;
    $("cut").disabled = $("flip").disabled = !on;
    this.buttons.forEach((button, i) => button.setAttribute("aria-pressed", String(i === (on ? this.axis + 1 : 0))));
    this.stage.setSection(this.axis, Number($("cut").value), $("flip").checked);
  }
}

export function addViews(viewpoint) {
  const short = { Isometric: "Iso" };
  $("views").append(...views.map(([name], i) => {
    const button = element("button", short[name] ?? name);
    button.title = `${name} view (${i + 1})`;
    button.addEventListener("click", () => viewpoint.look(i));
    return button;
  }));
}

export function addHelp() {
  const dialog = $("help");
  for (const [title, lines] of help) {
    dialog.append(element("h2", title));
    const table = element("table");
    for (const [key, what] of lines) {
      const row = element("tr");
      const head = element("th");
      head.append(element("kbd", key));
      row.append(head, element("td", what));
      table.append(row);
    }
    dialog.append(table);
  }
  const close = element("button", "Close");
  close.addEventListener("click", () => dialog.close());
  dialog.append(element("p"), close);
  return () => (dialog.open ? dialog.close() : dialog.showModal());
}

// actions: key -> function. Arrow keys go to the camera unless the hand wants them.
export function listenToKeys({ actions, viewpoint, hand }) {
  addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey || isTyping(event) || $("help").open) return;
    const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    const by = arrows[event.key];
    if (hand.key(event)) {
      // it was the hand's
    } else if (by) {
      event.shiftKey ? viewpoint.pan(...by) : viewpoint.orbit(...by);
    } else if (event.key === "+" || event.key === "=" || event.key === "-") {
      viewpoint.zoom(event.key === "-" ? 1.1 : 1 / 1.1);
    } else {
      const action = actions[event.key.toLowerCase()];
      if (!action) return;
      action();
    }
    event.preventDefault();
  });
}
