// What a point of a mesh belongs to, as a person sees it: a corner, an edge (straight or round), a flat face, a cylinder.
import { add, cross, dot, size, sub, unit } from "./vector.js";

const flat = Math.cos((0.3 * Math.PI) / 180); // faces in one plane
const smooth = Math.cos((40 * Math.PI) / 180); // neighbors on one round surface
const sharp = Math.cos((20 * Math.PI) / 180); // an edge that one sees
const roundness = 2e-3; // of the radius: how far points of a round thing may be off
const minFacets = 4; // of a cylinder
const minChords = 8; // of a circle

// A mesh, and which face lies across each of its edges.
export class Surface {
  constructor(positions, indices) {
    Object.assign(this, { positions, indices, count: indices.length / 3 });
    this.across = new Int32Array(indices.length).fill(-1);
    const open = new Map();
    const vertices = positions.length / 3;
    for (let i = 0; i < indices.length; ++i) {
      const [a, b] = [indices[i], indices[i - (i % 3) + ((i + 1) % 3)]];
      const key = Math.min(a, b) * vertices + Math.max(a, b);
      const other = open.get(key);
      if (other === undefined) open.set(key, i);
      else {
        this.across[i] = Math.floor(other / 3);
        this.across[other] = Math.floor(i / 3);
        open.delete(key);
      }
    }
  }
  vertex(v) {
    return [this.positions[3 * v], this.positions[3 * v + 1], this.positions[3 * v + 2]];
  }
  corners(f) {
    return [0, 1, 2].map((k) => this.vertex(this.indices[3 * f + k]));
  }
  normal(f) {
    const [a, b, c] = this.corners(f);
    return unit(cross(sub(b, a), sub(c, a)));
  }
  // All faces that are reached from `face` over those that `belongs(g, f)` lets in from their neighbor f.
  grow(face, belongs) {
    const region = new Set([face]);
    for (const f of region)
      for (let k = 0; k < 3; ++k) {
        const g = this.across[3 * f + k];
        if (g >= 0 && !region.has(g) && belongs(g, f)) region.add(g);
      }
    return region;
  }
}

// The part of the segment that is nearest to `p`.
function nearestOn([a, b], p) {
  const along = sub(b, a);
  const t = Math.min(1, Math.max(0, dot(sub(p, a), along) / (dot(along, along) || 1)));
  return add(a, along, t);
}

// Edges of the region beyond which the surface bends sharply, or ends: [vertex, vertex].
function rim(surface, region) {
  const edges = [];
  for (const f of region)
    for (let k = 0; k < 3; ++k) {
      const g = surface.across[3 * f + k];
      if (g >= 0 && dot(surface.normal(f), surface.normal(g)) > sharp) continue;
      edges.push([surface.indices[3 * f + k], surface.indices[3 * f + ((k + 1) % 3)]]);
    }
  return edges;
}

// The edges that go on from `edge` without a corner: [edges in a row, whether they close].
function chain(edges, edge) {
  const at = new Map();
  for (const e of edges) for (const v of e) at.set(v, [...(at.get(v) ?? []), e]);
  const row = [edge];
  const follow = (v, put) => {
    for (let last = edge; ; ) {
      const next = (at.get(v) ?? []).filter((e) => e !== last);
      if (next.length !== 1 || row.includes(next[0])) return row.length > 2 && next[0] === edge;
      last = next[0];
      put(last);
      v = last[0] === v ? last[1] : last[0];
    }
  };
  const closed = follow(edge[1], (e) => row.push(e));
  if (!closed) follow(edge[0], (e) => row.unshift(e));
  return [row, closed];
}

// The circle through three points: {center, axis, radius}, or null when they lie on a line.
export function circleThrough(a, b, c) {
  const [u, v] = [sub(b, a), sub(c, a)];
  const w = cross(u, v);
  const ww = dot(w, w);
  if (ww < 1e-12 * dot(u, u) * dot(v, v)) return null;
  const to = add(cross(w, u).map((x) => x * dot(v, v)), cross(v, w), dot(u, u)).map((x) => x / (2 * ww));
  return { center: add(a, to), axis: unit(w), radius: size(to) };
}

// The straight or round edge of the face's rim that is nearest to `point`, within `reach`; or null.
function edgeNear(surface, region, point, reach) {
  const edges = rim(surface, region);
  let best = null, least = reach;
  for (const edge of edges) {
    const d = size(sub(point, nearestOn(edge.map((v) => surface.vertex(v)), point)));
    if (d < least) [best, least] = [edge, d];
  }
  if (!best) return null;
  const [row, closed] = chain(edges, best);
  const points = row.map(([a]) => surface.vertex(a));
  if (closed && points.length >= minChords) {
    const third = Math.floor(points.length / 3);
    const circle = circleThrough(points[0], points[third], points[2 * third]);
    if (circle && points.every((p) => Math.abs(size(sub(p, circle.center)) - circle.radius) < roundness * circle.radius))
      return { kind: "circle", ...circle, point };
  }
  return straight(surface, row, best, point);
}

function straight(surface, row, best, point) {
  const [a, b] = best.map((v) => surface.vertex(v));
  const direction = unit(sub(b, a));
  const on = (v) => size(cross(sub(surface.vertex(v), a), direction)) < 1e-4 * size(sub(b, a)) + 1e-7;
  const ends = row.filter((e) => e.every(on)).flat().map((v) => surface.vertex(v));
  const along = ends.map((p) => dot(sub(p, a), direction));
  const [low, high] = [Math.min(...along), Math.max(...along)];
  return { kind: "edge", from: add(a, direction, low), to: add(a, direction, high), direction, point: nearestOn([a, b], point) };
}

// The cylinder of which the flat piece `region` is one facet, or null.
function cylinderAt(surface, face, region) {
  const n = surface.normal(face);
  const own = [...region].flatMap((f) => surface.corners(f));
  for (const f of region)
    for (let k = 0; k < 3; ++k) {
      const g = surface.across[3 * f + k];
      if (g < 0 || region.has(g)) continue;
      const m = surface.normal(g);
      const bend = dot(n, m);
      if (bend < smooth || bend > flat) continue;
      const found = cylinderThrough(surface, face, own, unit(cross(n, m)), surface.corners(g));
      if (found) return found;
    }
  return null;
}

// The axis is along where two facets meet; seen along it their corners are three points of a circle.
function cylinderThrough(surface, face, own, axis, beside) {
  const across = (p) => add(p, axis, -dot(p, axis));
  const places = [];
  const scale = Math.max(...own.map((p) => size(sub(p, own[0]))));
  for (const p of [...own, ...beside].map(across)) if (places.every((q) => size(sub(p, q)) > 1e-4 * scale)) places.push(p);
  if (places.length !== 3) return null;
  const circle = circleThrough(...places);
  if (!circle) return null;
  const { center, radius } = circle;
  const off = (p) => Math.abs(size(sub(across(p), center)) - radius);
  const on = surface.grow(face, (g, f) => dot(surface.normal(f), surface.normal(g)) > smooth && surface.corners(g).every((p) => off(p) < roundness * radius));
  const normals = new Set([...on].map((f) => surface.normal(f).map((v) => Math.round(v * 100)).join()));
  if (normals.size < minFacets) return null;
  const heights = [...on].flatMap((f) => surface.corners(f)).map((p) => dot(p, axis));
  const [low, high] = [Math.min(...heights), Math.max(...heights)];
  const inner = dot(surface.normal(face), sub(across(own[0]), center)) < 0;
  return { kind: "cylinder", center: add(center, axis, (low + high) / 2), axis, radius, length: high - low, inner };
}

// Of the face with this number, at `point` on it; corners and edges count within `reach` of it. Everything in the mesh's
// own frame, m: {kind: "corner" | "edge" | "circle" | "plane" | "cylinder" | "surface", point, ...}.
export function featureAt(surface, face, point, reach) {
  const region = surface.grow(face, (g, f) => dot(surface.normal(f), surface.normal(g)) > flat);
  const cylinder = cylinderAt(surface, face, region);
  const whole = cylinder ? surface.grow(face, (g, f) => dot(surface.normal(f), surface.normal(g)) > sharp) : region;
  const edge = edgeNear(surface, whole, point, reach);
  if (edge?.kind === "edge") {
    const end = [edge.from, edge.to].find((p) => size(sub(p, point)) < reach);
    if (end) return { kind: "corner", point: end };
  }
  if (edge) return edge;
  if (cylinder) return { ...cylinder, point };
  const bent = [0, 1, 2].some((k) => {
    const g = surface.across[3 * face + k];
    const bend = g < 0 ? 1 : dot(surface.normal(face), surface.normal(g));
    return bend < flat && bend > sharp;
  });
  return { kind: bent && region.size < 3 ? "surface" : "plane", normal: surface.normal(face), point };
}
