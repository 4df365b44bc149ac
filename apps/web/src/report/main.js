// Shows a report: the JSON that the program put into the page (see web/page.hpp).
import { addPlot } from "../common/plot.js";
import { element, tableOf } from "../common/dom.js";
import { graphOf } from "./graph.js";

const report = JSON.parse(document.getElementById("data").textContent);
const root = document.getElementById("report");

function claimsTable(claims) {
  const number = (v) => (typeof v === "number" ? Number(v.toPrecision(4)) : v);
  return tableOf({
    head: ["claim", "value", "target", "unit", "verdict"],
    rows: claims.map((c) => [
      c.name, number(c.value), c.target, c.unit ?? "",
      { text: c.holds ? "holds" : "does not hold", class: c.holds ? "holds" : "fails" },
    ]),
  });
}

function addSection(section) {
  root.append(element("h2", section.title));
  if (section.text) root.append(element("p", section.text));
  if (section.plots?.length) {
    const row = element("div", "", "plots");
    root.append(row);
    for (const plot of section.plots) addPlot(row, plot);
  }
  if (section.graph) root.append(graphOf(section.graph));
  for (const table of section.tables ?? []) root.append(tableOf(table));
}

document.title = report.title;
root.append(element("h1", report.title));
if (report.subtitle) root.append(element("p", report.subtitle, "muted"));
if (report.intro) root.append(element("p", report.intro));
if (report.claims?.length) {
  root.append(element("h2", "What holds"));
  root.append(claimsTable(report.claims));
}
for (const section of report.sections ?? []) addSection(section);
