// The report on a recording: verdict, path in 3-D, plots and tables.
import { addPlot } from "../common/plot.js";
import { element, tableOf } from "../common/dom.js";
import { embeddedBundle } from "../view/bundle.js";
import { views, Viewpoint } from "../view/camera.js";
import { ClearanceScale, showLegend } from "./colors.js";
import { PathView } from "./path_view.js";

const $ = (id) => document.getElementById(id);
const bundle = embeddedBundle();
const { about } = bundle;

const layers = [
  ["colors", "Clearance", true], ["see-through", "See through", true], ["ghosts", "Ghosts", true], ["path", "Path", true],
  ["contact", "Contacts", true], ["two-sided", "Two-sided", true], ["stall", "Stalls", true],
];

function showVerdict({ outcome, headline, evidence }) {
  const box = $("verdict");
  if (outcome !== "open") box.classList.add(outcome === "goes" ? "goes" : "fails");
  box.querySelector("h2").textContent = headline;
  for (const { kind, text } of evidence) box.querySelector("ul").append(element("li", text, kind));
}

function addButtons(path, viewpoint) {
  for (const [i, [name]] of views.entries()) {
    const button = element("button", name);
    button.addEventListener("click", () => viewpoint.look(i, path.box()));
    $("views").append(button);
  }
  for (const [name, label, on] of layers) {
    if (name !== "see-through" && !path.layers[name]) continue;
    const button = element("button");
    if (["contact", "two-sided", "stall"].includes(name)) {
      const dot = element("span", "", "dot");
      dot.style.background = `var(--${name})`;
      button.append(dot);
    }
    button.append(label);
    const set = (value) => {
      button.setAttribute("aria-pressed", String(value));
      path.enable(name, value);
      if (name === "colors") $("legend").hidden = !value;
    };
    button.addEventListener("click", () => set(button.getAttribute("aria-pressed") !== "true"));
    set(on);
    $("layers").append(button);
  }
}

function showPath() {
  const scale = new ClearanceScale(bundle.floats(about.surface.clearance), about.surface.reach, about.band);
  const path = new PathView(document.querySelector("#stage > canvas"), bundle, scale);
  const viewpoint = new Viewpoint(path.stage);
  showLegend($("legend"), scale);
  addButtons(path, viewpoint);
  const box = path.box();
  path.stage.radius = Math.max(path.stage.radius, 0.5 * box.max.distanceTo(box.min));
  viewpoint.look(6, box);
  const show = (i) => {
    path.show(i);
    $("clock").textContent = `${path.time(i).toFixed(3)} s`;
  };
  $("scrub").max = path.count - 1;
  $("scrub").value = path.count - 1;
  $("scrub").addEventListener("input", () => show(Number($("scrub").value)));
  show(path.count - 1);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => path.applyTheme());
  return path;
}

function addTable({ title, text, ...table }) {
  $("tables").append(element("h2", title));
  if (text) $("tables").append(element("p", text, "muted"));
  $("tables").append(tableOf(table));
}

document.title = `${about.title} – review`;
$("title").textContent = about.title;
$("subtitle").textContent = about.subtitle;
showVerdict(about.verdict);
const path = showPath();
for (const plot of about.plots) addPlot($("plots"), plot);
for (const table of about.tables) addTable(table);
for (const note of about.notes) $("notes").append(element("p", note, "muted"));

// What a test may ask the page.
window.__tegotae = {
  get state() {
    return {
      headline: about.verdict.headline, rows: path.count, at: path.at, drawn: path.stage.drawn,
      layers: Object.keys(path.layers), tables: about.tables.map(({ title, rows }) => ({ title, rows: rows.length })),
      zones: about.band && Array.from(bundle.integers(about.band.zones)),
      held: path.stage.held.group.position.toArray(),
    };
  },
};
