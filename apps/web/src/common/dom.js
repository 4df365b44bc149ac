// Builds elements. Text goes in as text, never as markup: names come from files.
export function element(tag, text = "", className = "") {
  const e = document.createElement(tag);
  if (text) e.textContent = text;
  if (className) e.className = className;
  return e;
}

// A table of {caption?, head: [...], rows: [[cell, ...], ...]}; a cell is text, a number or {text, class}.
export function tableOf({ caption, head, rows }) {
  const table = element("table");
  if (caption) table.append(element("caption", caption));
  const headRow = element("tr");
  for (const cell of head) headRow.append(element("th", String(cell)));
  table.append(headRow);
  for (const row of rows) {
    const tr = element("tr");
    for (const cell of row) {
      const rich = cell !== null && typeof cell === "object";
      tr.append(element("td", String(rich ? cell.text : cell ?? "–"), rich ? cell.class : ""));
    }
    table.append(tr);
  }
  const frame = element("div", "", "table");
  frame.append(table);
  return frame;
}
