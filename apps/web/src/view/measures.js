// What can be said about one feature or two (feature.js), in the world, m.
import { length, written } from "../common/number.js";
import { add, cross, dot, lineAngle, size, sub } from "./vector.js";

const parallel = (0.1 * Math.PI) / 180; // nearer than this are parallel
const degrees = (rad) => `${written((180 * rad) / Math.PI, 4)}°`;
const names = { corner: "Corner", edge: "Edge", circle: "Round edge", plane: "Flat face", cylinder: "Cylinder", surface: "Point of a surface" };

export function nameOf(feature) {
  if (feature.kind === "cylinder") return feature.inner ? "Bore" : "Cylinder";
  return names[feature.kind];
}

// The feature's own figures: [name, text, value].
export function ownMeasures(f) {
  if (f.kind === "edge") return [figure("Length", size(sub(f.to, f.from)))];
  if (f.kind === "circle") return [figure("Diameter", 2 * f.radius)];
  if (f.kind === "cylinder") return [figure("Diameter", 2 * f.radius), figure("Length", f.length)];
  return [];
}

const figure = (name, value) => [name, length(value), value];
const line = (f) => ({ edge: { at: f.from, along: f.direction }, cylinder: { at: f.center, along: f.axis }, circle: { at: f.center, along: f.axis } })[f.kind];
const fromPlane = (plane, p) => dot(sub(p, plane.point), plane.normal);

// Between two features: [name, text, value], what says most first.
export function measuresBetween(a, b) {
  const out = [];
  if (a.kind === "plane" && b.kind === "plane") planes(a, b, out);
  else if (a.kind === "plane" || b.kind === "plane") planeAnd(...(a.kind === "plane" ? [a, b] : [b, a]), out);
  else if (line(a) && line(b)) lines(a, b, out);
  const between = sub(b.point, a.point);
  out.push(figure("Distance of the points", size(between)));
  ["x", "y", "z"].forEach((axis, k) => out.push(figure(`Along ${axis}`, between[k])));
  return out;
}

function planes(a, b, out) {
  const angle = lineAngle(a.normal, b.normal);
  if (angle < parallel) out.push(figure("Gap along the normal", Math.abs(fromPlane(a, b.point))));
  out.push(["Angle", degrees(angle), angle]);
}

function planeAnd(plane, other, out) {
  const axis = line(other);
  if (!axis) return out.push(figure("Gap along the normal", Math.abs(fromPlane(plane, other.point))));
  const angle = Math.PI / 2 - lineAngle(plane.normal, axis.along);
  if (angle < parallel) {
    const distance = Math.abs(fromPlane(plane, axis.at));
    if (other.kind === "cylinder") out.push(figure("Gap along the normal", distance - other.radius), figure("Axis to face", distance));
    else out.push(figure("Gap along the normal", distance));
  } else if (other.kind === "circle" && Math.PI / 2 - angle < parallel) out.push(figure("Gap along the normal", Math.abs(fromPlane(plane, axis.at))));
  out.push(["Angle", degrees(angle), angle]);
}

function lines(a, b, out) {
  const [p, q] = [line(a), line(b)];
  const angle = lineAngle(p.along, q.along);
  const between = sub(q.at, p.at);
  const round = a.radius !== undefined && b.radius !== undefined;
  const name = round ? "Axis to axis" : a.radius !== undefined || b.radius !== undefined ? "Axis to edge" : "Distance of the lines";
  if (angle < parallel) {
    const apart = size(add(between, p.along, -dot(between, p.along)));
    out.push(figure(name, apart));
    if (a.kind === "cylinder" && b.kind === "cylinder") {
      const one = a.inner !== b.inner;
      out.push(one ? figure("Play in the diameter", 2 * (a.inner ? a.radius - b.radius : b.radius - a.radius)) : figure("Gap along the normal", apart - a.radius - b.radius));
    }
  } else {
    const common = cross(p.along, q.along);
    out.push(figure(name, Math.abs(dot(between, common)) / size(common)));
  }
  out.push(["Angle", degrees(angle), angle]);
}

// A feature of a mesh that stands at `pose` (THREE.Matrix4-like: point(v), direction(v)).
export function placed(feature, { point, direction }) {
  const out = { ...feature };
  for (const key of ["point", "center", "from", "to"]) if (feature[key]) out[key] = point(feature[key]);
  for (const key of ["normal", "axis", "direction"]) if (feature[key]) out[key] = direction(feature[key]);
  return out;
}
