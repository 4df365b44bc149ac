// The parts as a tree of the assembly's groups, with a search; shows and hides them.
import { element } from "../common/dom.js";

const maxOpen = 60; // rows; a larger tree begins with its groups closed
const separator = "\u0000";

// [{key, name, depth, parts: [numbers]}] and parts between them, in the order of the file: what stands where in the list.
export function treeRows(parts) {
  const root = { groups: new Map(), parts: [] };
  parts.forEach(({ path = [] }, i) => {
    let at = root;
    path.forEach((name, depth) => {
      const key = path.slice(0, depth + 1).join(separator);
      if (!at.groups.has(name)) at.groups.set(name, { key, name, depth, groups: new Map(), parts: [] });
      at = at.groups.get(name);
    });
    at.parts.push(i);
  });
  const rows = [];
  const all = (group) => [...group.parts, ...[...group.groups.values()].flatMap(all)];
  const walk = (group, depth, above) => {
    for (const child of group.groups.values()) {
      rows.push({ group: child, depth, above, parts: all(child) });
      walk(child, depth + 1, [...above, child.key]);
    }
    for (const i of group.parts) rows.push({ part: i, depth, above });
  };
  walk(root, 0, []);
  return rows;
}

export class Tree {
  // item(part, i): the row of a part. onShow(numbers, visible).
  constructor(list, search, { item, onShow }) {
    Object.assign(this, { list, search, item, onShow, closed: null });
    search.addEventListener("input", () => this.show(this.parts));
  }

  show(parts) {
    this.parts = parts;
    const rows = treeRows(parts);
    this.closed ??= new Set(rows.length > maxOpen ? rows.filter((r) => r.group).map((r) => r.group.key) : []);
    this.search.parentElement.hidden = parts.length < 8 && !rows.some((r) => r.group);
    const wanted = this.search.value.trim().toLowerCase();
    const found = (row) => parts[row.part].name.toLowerCase().includes(wanted) || parts[row.part].path.some((name) => name.toLowerCase().includes(wanted));
    const shown = wanted ? rows.filter((r) => r.part !== undefined && found(r)) : rows.filter((r) => !r.above.some((key) => this.closed.has(key)));
    const items = shown.map((row) => {
      const item = row.group ? this.groupItem(row) : this.item(parts[row.part], row.part);
      item.style.setProperty("--depth", wanted ? 0 : row.depth);
      return item;
    });
    if (wanted && items.length === 0) items.push(element("li", "No part has that in its name", "muted"));
    this.list.replaceChildren(...items);
  }

  groupItem({ group, parts: numbers }) {
    const item = element("li", "", "group-row");
    const visible = numbers.filter((i) => this.parts[i].visible).length;
    const box = element("input");
    Object.assign(box, { type: "checkbox", checked: visible > 0, indeterminate: visible > 0 && visible < numbers.length });
    box.setAttribute("aria-label", `Show all of ${group.name}`);
    box.addEventListener("change", () => this.onShow(numbers, box.checked));
    const open = !this.closed.has(group.key);
    const name = element("button", `${open ? "▾" : "▸"} ${group.name}`, "name");
    name.setAttribute("aria-expanded", String(open));
    name.title = `${group.name}, ${numbers.length} parts`;
    name.addEventListener("click", () => {
      open ? this.closed.add(group.key) : this.closed.delete(group.key);
      this.show(this.parts);
    });
    item.append(box, name, element("span", String(numbers.length), "count"));
    return item;
  }

  // So that part `i` is in the list.
  reveal(i) {
    let key = "";
    for (const name of this.parts[i].path) {
      key = key ? key + separator + name : name;
      this.closed.delete(key);
    }
  }
}
