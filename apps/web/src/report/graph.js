// Draws a graph of {nodes: [{text, layer}], arrows: [[from, to], ...]}: a column for each layer, from left to right.
const kHeight = 28, kGap = 14, kBetween = 72, kLetter = 8, kMaxLetters = 28, kPad = 12, kEdge = 8;

function shape(tag, attributes, text = "") {
  const e = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) e.setAttribute(name, value);
  if (text) e.textContent = text;
  return e;
}

const shortened = (text) => (text.length > kMaxLetters ? text.slice(0, kMaxLetters - 1) + "…" : text);

// Where each node stands; columns are as wide as their longest text, and stand in the middle of the height.
function placed(nodes) {
  const columns = [];
  nodes.forEach((node, i) => (columns[node.layer] ??= []).push(i));
  const tallest = Math.max(...columns.map((column) => column?.length ?? 0));
  const height = tallest * (kHeight + kGap) - kGap + 2 * kEdge;
  const places = [];
  let x = kEdge;
  for (const column of columns) {
    if (!column) continue;
    const width = 2 * kPad + kLetter * Math.max(...column.map((i) => shortened(nodes[i].text).length));
    let y = (height - (column.length * (kHeight + kGap) - kGap)) / 2;
    for (const i of column) {
      places[i] = { x, y, width };
      y += kHeight + kGap;
    }
    x += width + kBetween;
  }
  return { places, width: x - kBetween + kEdge, height };
}

// From side to side; between nodes of one column out to the right and back.
function curve(from, to) {
  const y0 = from.y + kHeight / 2, y1 = to.y + kHeight / 2, bend = kBetween / 2;
  if (from.x === to.x) {
    const x = from.x + from.width;
    return `M${x},${y0} C${x + bend},${y0} ${x + bend},${y1} ${x},${y1}`;
  }
  const back = to.x < from.x;
  const x0 = back ? from.x : from.x + from.width, x1 = back ? to.x + to.width : to.x, side = back ? -bend : bend;
  return `M${x0},${y0} C${x0 + side},${y0} ${x1 - side},${y1} ${x1},${y1}`;
}

export function graphOf({ nodes, arrows }) {
  const { places, width, height } = placed(nodes);
  const svg = shape("svg", { width, height, viewBox: `0 0 ${width} ${height}`, class: "graph", role: "img" });
  const marker = { id: "arrow", viewBox: "0 0 8 8", refX: 8, refY: 4, markerWidth: 8, markerHeight: 8, orient: "auto" };
  const head = shape("marker", marker);
  head.append(shape("path", { d: "M0,0 L8,4 L0,8 z" }));
  svg.append(head);
  for (const [from, to] of arrows) {
    const line = shape("path", { d: curve(places[from], places[to]), class: "arrow", "marker-end": "url(#arrow)" });
    line.append(shape("title", {}, `${nodes[from].text} → ${nodes[to].text}`));
    svg.append(line);
  }
  nodes.forEach((node, i) => {
    const { x, y, width: wide } = places[i];
    svg.append(shape("rect", { x, y, width: wide, height: kHeight, rx: 4 }));
    const text = shape("text", { x: x + kPad, y: y + kHeight / 2, "dominant-baseline": "central" }, shortened(node.text));
    text.append(shape("title", {}, node.text));
    svg.append(text);
  });
  const frame = document.createElement("div");
  frame.className = "table";
  frame.append(svg);
  return frame;
}
