import { commandText } from "./command.js";

// Builds elements. Text goes in as text, never as markup: names come from files.
export function element(tag, text = "", className = "") {
  const e = document.createElement(tag);
  if (text) e.textContent = text;
  if (className) e.className = className;
  return e;
}

// A value that is nothing but rounding is shown as small, without its digits.
function cellText(value) {
  const rounding = typeof value === "number" && value !== 0 && Math.abs(value) < 1e-6;
  // A number and its unit stay on one line.
  return rounding ? "< 0.000001" : String(value ?? "–").replace(/(\d) (?=[^\d ]+$)/, "$1\u00a0");
}

// A table of {caption?, head: [...], rows: [[cell, ...], ...], text?: [...]}; a cell is text, a number, {text, class?,
// href?} or a command (see command.js). Columns of the places in `text` are of words, and begin at the left.
export function tableOf({ caption, head, rows, text = [] }) {
  const table = element("table");
  if (caption) table.append(element("caption", caption));
  const headRow = element("tr");
  const align = (place) => (text.includes(place) ? "text" : "");
  head.forEach((cell, place) => headRow.append(element("th", String(cell), align(place))));
  table.append(headRow);
  for (const row of rows) {
    const tr = element("tr");
    row.forEach((cell, place) => {
      const rich = cell !== null && typeof cell === "object";
      const td = element("td", rich ? "" : cellText(cell), (rich && cell.class) || align(place));
      if (rich) {
        const inside = element(cell.href ? "a" : cell.command ? "code" : "span", cell.command ? commandText(cell) : cell.text);
        if (cell.href) inside.href = cell.href;
        td.append(inside);
      }
      tr.append(td);
    });
    table.append(tr);
  }
  const frame = element("div", "", "table");
  frame.append(table);
  return frame;
}
