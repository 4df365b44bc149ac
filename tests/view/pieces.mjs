// Pieces of the page that need no browser: features and measures on meshes of known sizes, numbers, the tree of groups.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { fixed, length, plain, written } from "../../apps/web/src/common/number.js";
import { ForceNotice } from "../../apps/web/src/view/force.js";
import { featureAt, Surface } from "../../apps/web/src/view/feature.js";
import { measuresBetween } from "../../apps/web/src/view/measures.js";
import { stylusScript } from "../../apps/web/src/view/review.js";
import { treeRows } from "../../apps/web/src/view/tree.js";
import { test } from "./cases.mjs";

function readObj(name) {
  const positions = [], indices = [];
  for (const line of readFileSync(`${process.env.TEGOTAE_MODELS_DIR}/${name}`, "utf8").split("\n")) {
    const words = line.split(/\s+/);
    if (words[0] === "v") positions.push(...words.slice(1, 4).map((v) => Number(v) / 1000));
    if (words[0] === "f") indices.push(...words.slice(1, 4).map((v) => parseInt(v) - 1));
  }
  return new Surface(Float32Array.from(positions), Uint32Array.from(indices));
}

// The features of all faces, each asked for at its middle.
const ofFaces = (surface) => Array.from({ length: surface.count }, (_, f) => {
  const c = surface.corners(f);
  return featureAt(surface, f, [0, 1, 2].map((k) => (c[0][k] + c[1][k] + c[2][k]) / 3), 1e-9);
});

test("pieces: every facet of a peg and of its hole is told as a cylinder of their diameters, and nothing else is", () => {
  const peg = ofFaces(readObj("peg_0.94.obj")), hole = ofFaces(readObj("hole_20.obj"));
  const [shafts, bores] = [peg, hole].map((features) => features.filter((f) => f.kind === "cylinder"));
  assert.equal(shafts.length, 1024);
  assert.equal(bores.length, 1024);
  // The peg's vertices lie on 0.94 · 20 mm. The hole's facets touch 20 mm from outside: 64 of them are seen around.
  for (const f of shafts) assert.ok(Math.abs(f.radius - 0.0094) < 1e-6 && !f.inner, `${f.radius}`);
  for (const f of bores) assert.ok(Math.abs(f.radius - 0.01 / Math.cos(Math.PI / 64)) < 1e-6 && f.inner, `${f.radius}`);
  for (const f of [...shafts, ...bores]) assert.ok(Math.abs(Math.abs(f.axis[2]) - 1) < 1e-6);
  const between = Object.fromEntries(measuresBetween(shafts[0], bores[0]).map(([name, , value]) => [name, value]));
  assert.ok(between["Axis to axis"] < 1e-7);
  assert.ok(Math.abs(between["Play in the diameter"] - 2 * (0.01 / Math.cos(Math.PI / 64) - 0.0094)) < 2e-6);
});

test("pieces: corners and edges of a cube", () => {
  const cube = readObj("cube.obj");
  const reach = 1e-5;
  const all = Array.from({ length: cube.count }, (_, f) => cube.corners(f).map((corner) => featureAt(cube, f, corner, reach))).flat();
  assert.ok(all.every((f) => f.kind === "corner"));
  const side = Math.max(...cube.positions) - Math.min(...cube.positions);
  let edges = 0;
  for (let f = 0; f < cube.count; ++f)
    for (const [a, b] of [[0, 1], [1, 2], [2, 0]]) {
      const c = cube.corners(f);
      const found = featureAt(cube, f, c[a].map((v, k) => (v + c[b][k]) / 2), reach);
      const long = Math.hypot(...c[a].map((v, k) => v - c[b][k]));
      if (long > 1.1 * side) assert.equal(found.kind, "plane", "a diagonal is no edge");
      else {
        ++edges;
        assert.equal(found.kind, "edge");
        assert.ok(Math.abs(Math.hypot(...found.from.map((v, k) => v - found.to[k])) - side) < 1e-8);
      }
    }
  assert.equal(edges, 24);
});

test("pieces: numbers as people write them", () => {
  assert.equal(length(0.01), "10\u00a0mm");
  assert.equal(length(-1.4e-17), "0\u00a0mm");
  assert.equal(length(2.5e-6), "2.5\u00a0µm");
  assert.equal(length(1.25), "1250\u00a0mm");
  assert.equal(written(-0.5), "−0.5");
  assert.equal(written(NaN), "–");
  assert.equal(fixed(-0.001, 2), "0.00");
  for (const v of [1e-8, 1e-5, 123456, 1e7, -3e-7]) assert.doesNotMatch(written(v), /e/);
  // Of any size, in reports.
  assert.deepEqual([0, -0, 0.00025, -12.5, 1e-6, 3e8].map((v) => plain(v)), ["0", "0", "0.00025", "−12.5", "0.000001", "300000000"]);
  assert.deepEqual([1e-8, -1e-12, 2.5e-7, 1e10, -3.25e21].map((v) => plain(v)), ["10⁻⁸", "−10⁻¹²", "2.5 × 10⁻⁷", "10¹⁰", "−3.25 × 10²¹"]);
});

test("pieces: the tree of groups", () => {
  const parts = [{ path: ["a", "b"] }, { path: [] }, { path: ["a"] }, { path: ["a", "b"] }, { path: ["b"] }];
  const rows = treeRows(parts).map((row) => (row.group ? `${row.group.name}:${row.parts.sort().join("")}@${row.depth}` : `${row.part}@${row.depth}`));
  assert.deepEqual(rows, ["a:023@0", "b:03@1", "0@2", "3@2", "2@1", "b:4@0", "4@1", "1@0"]);
});

test("pieces: what stands over the parts about the force, and when", () => {
  const place = { textContent: "", classList: { toggle: () => {} } };
  const notice = new ForceNotice(place);
  const reasons = ["none", "a", "b", "c", "software", "the heartbeat"];
  const at = (ms, frame) => {
    notice.show({ forceOn: false, waiting: true, reason: 4, lagReason: 0, ...frame }, reasons, { leads: true }, ms);
    return place.textContent;
  };
  const on = { forceOn: true, waiting: false };
  // A run begins without a force: that is no news, unless it lasts.
  for (const ms of [0, 300, 1000, 3900]) assert.equal(at(ms), "");
  assert.match(at(4100), /^The force went off\. Let go of the part/);
  assert.equal(at(4200, on), "", "it has never been on before");
  // Then it is news sooner, with its reason, and so is that it is back, in passing.
  assert.equal(at(10_000, { reason: 5 }), "");
  assert.equal(at(10_300, { reason: 5 }), "");
  assert.match(at(10_500, { reason: 5 }), /^The force went off: the heartbeat\. Let go of the part/);
  assert.equal(at(11_000, on), "The force is on again.");
  assert.equal(at(13_900, on), "The force is on again.");
  assert.equal(at(14_100, on), "");
  // What was too short to be told is not told afterwards.
  assert.equal(at(20_000, { reason: 5 }), "");
  assert.equal(at(20_100, on), "");
  // What holds the part back, where it is no contact, and lasts.
  assert.equal(at(30_000, { ...on, lagReason: 1 }), "");
  assert.equal(at(31_000, { ...on, lagReason: 2 }), "");
  assert.equal(at(31_500, { ...on, lagReason: 2 }), "The part is held back, and not by a contact: out of time.");
  assert.equal(at(31_600, { ...on, lagReason: 1 }), "");
});

test("pieces: a script of what the hand did begins at 0 and goes on", () => {
  const y = [0.1, 0, 0, 1, 0, 0, 0];
  assert.equal(stylusScript([{ t: 5, y }, { t: 5, y }, { t: 5.5, y }]), "t,px,py,pz,qw,qx,qy,qz\n0,0.1,0,0,1,0,0,0\n0.5,0.1,0,0,1,0,0,0\n");
});
