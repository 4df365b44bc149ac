// Buttons, lists and keys around the parts.
import { element } from "../common/dom.js";
import { views } from "./camera.js";
import { help, isTyping } from "./keys.js";

const $ = (id) => document.getElementById(id);

export function toggle(label, pressed, click) {
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

// guide: null where none pulls.
export function showLayers(overlay, behind, guide) {
  const names = { contacts: "Contacts and normals", pairs: "Nearest features", forces: "Contact forces", arrows: "Force and torque" };
  $("layers").replaceChildren(
    ...Object.entries(names).map(([layer, name]) => checkbox(name, overlay.enabled[layer], (on) => overlay.enable(layer, on))),
    checkbox("Contacts through parts", behind.on, (on) => behind.set(on)),
    ...(guide ? [checkbox("Guide", guide.wanted, (on) => guide.enable(on))] : []),
  );
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

// On which sides of the tools there are more of them than one sees.
export function showMore(tools) {
  const show = () => {
    const left = tools.scrollLeft > 1, right = tools.scrollLeft + tools.clientWidth < tools.scrollWidth - 1;
    tools.dataset.more = [left && "left", right && "right"].filter(Boolean).join(" ");
  };
  tools.addEventListener("scroll", show);
  new ResizeObserver(show).observe(tools);
}

// On a narrow page one panel at a time, or none.
export function addPanels() {
  const buttons = [...$("tabs").querySelectorAll("button")];
  for (const button of buttons)
    button.addEventListener("click", () => {
      const { panel } = button.dataset;
      if (panel) document.body.dataset.panel = panel;
      else delete document.body.dataset.panel;
      for (const b of buttons) b.setAttribute("aria-pressed", String(b === button));
    });
}

export function addHelp() {
  const dialog = $("help"), top = element("div", "", "top");
  const close = element("button", "Close");
  close.addEventListener("click", () => dialog.close());
  top.append(element("h2", "Mouse, fingers and keys"), close);
  dialog.append(top);
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
  return () => (dialog.open ? dialog.close() : dialog.showModal());
}

// actions: key -> function; "ctrl+z" and its like with that key. movers: the hand, the section plane; what they do not want
// of the arrow keys goes to the camera.
export function listenToKeys({ actions, viewpoint, movers }) {
  addEventListener("keydown", (event) => {
    if (event.altKey || isTyping(event) || $("help").open) return;
    const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    const command = event.ctrlKey || event.metaKey;
    const by = arrows[event.key];
    if (!command && movers.some((mover) => mover.key(event))) {
      // it was theirs
    } else if (!command && by) {
      event.shiftKey ? viewpoint.pan(...by) : viewpoint.orbit(...by);
    } else if (!command && (event.key === "+" || event.key === "=" || event.key === "-")) {
      viewpoint.zoom(event.key === "-" ? 1.1 : 1 / 1.1);
    } else {
      const action = actions[(command ? "ctrl+" : "") + event.key.toLowerCase()];
      if (!action) return;
      action();
    }
    event.preventDefault();
  });
}

const clickSlop = 5; // pixels that the pointer may move in a click

// click(x, y): where a pointer went down and up again without moving. Before who drags sees it.
export function listenToClicks(canvas, click) {
  const place = canvas.parentElement;
  let down = null;
  const still = (event) => Math.hypot(event.clientX - down.clientX, event.clientY - down.clientY) < clickSlop;
  place.addEventListener("pointerdown", (event) => (down = event.button === 0 && event.isPrimary && event.target === canvas ? event : null), { capture: true });
  place.addEventListener("pointerup", (event) => {
    if (down && event.isPrimary && still(event)) click(event.clientX, event.clientY);
    down = null;
  });
}
