// Measuring in the picture: two clicks, what was met, and what lies between.
import * as THREE from "three";
import { element } from "../common/dom.js";
import { disk } from "../common/disk.js";
import { cssColor } from "../common/theme.js";
import { featureAt, Surface } from "./feature.js";
import { measuresBetween, nameOf, ownMeasures, placed } from "./measures.js";
import { project } from "./picking.js";

const reachPixels = 7; // how near to a corner or an edge one must click
const over = { depthTest: false, depthWrite: false, transparent: true };

export class Measure {
  constructor(stage, viewpoint, place, onMode) {
    Object.assign(this, { stage, viewpoint, place, onMode, on: false, picked: [], rows: [] });
    this.points = new THREE.Points(new THREE.BufferGeometry(), new THREE.PointsMaterial({ size: 9, map: disk(), sizeAttenuation: false, ...over }));
    this.line = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial(over));
    for (const object of [this.points, this.line]) {
      object.frustumCulled = false;
      object.renderOrder = 30;
      stage.scene.add(object);
    }
    this.label = element("span", "", "measured");
    this.label.hidden = true;
    stage.canvas.parentElement.append(this.label);
    this.show();
  }

  toggle(on = !this.on) {
    this.on = on;
    if (!on) this.picked = [];
    this.onMode(on);
    this.show();
  }

  // The feature under the pointer becomes the first or the second one; a third begins anew.
  click(hit) {
    if (!hit) return;
    if (this.picked.length === 2) this.picked = [];
    this.picked.push({ ...this.featureOf(hit), part: hit.part });
    this.show();
  }

  featureOf(hit) {
    const point = hit.point.toArray();
    if (hit.cut) return { kind: "plane", normal: hit.normal.toArray(), point, cut: true };
    const shape = this.stage.geometry[hit.part.mesh];
    shape.features ??= new Surface(shape.positions, shape.indices);
    const matrix = hit.part.group.matrixWorld;
    const local = hit.point.clone().applyMatrix4(matrix.clone().invert()).toArray();
    const reach = (reachPixels * this.viewpoint.viewHeight(this.stage.camera.position.distanceTo(hit.point))) / this.stage.canvas.clientHeight;
    return placed(featureAt(shape.features, hit.face, local, reach), {
      point: (v) => new THREE.Vector3(...v).applyMatrix4(matrix).toArray(),
      direction: (v) => new THREE.Vector3(...v).transformDirection(matrix).toArray(),
    });
  }

  show() {
    const { picked } = this;
    const [a, b] = picked;
    this.rows = b ? measuresBetween(a, b) : a ? ownMeasures(a) : [];
    this.place.hidden = !this.on;
    this.place.replaceChildren(
      element("p", b ? "" : a ? "Pick the second face, edge or corner." : "Pick a face, an edge or a corner.", "muted"),
      ...picked.map((f) => element("p", `${f.cut ? "Cut" : nameOf(f)} of ${f.part.name}${ownMeasures(f).slice(0, 1).map(([, text]) => `, ${f.radius === undefined ? "" : "⌀ "}${text}`).join("")}`)),
      b ? this.table() : "",
    );
    this.draw();
  }
  table() {
    const table = element("table", "", "numbers");
    for (const [name, text] of this.rows) {
      const row = element("tr");
      row.append(element("th", name), element("td", this.approximate() + text, "value"));
      table.append(row);
    }
    return table;
  }
  // A mesh that is shown with fewer triangles is a little off.
  approximate() {
    const thinned = ({ part }) => this.stage.about.meshes[part.mesh].shown < this.stage.about.meshes[part.mesh].triangles;
    return this.picked.some(thinned) ? "≈ " : "";
  }

  draw() {
    const ends = this.picked.map((f) => new THREE.Vector3(...f.point));
    const color = cssColor("--accent");
    // A geometry of points keeps its size: each gets a new one.
    for (const object of [this.points, this.line]) {
      object.geometry.dispose();
      object.geometry = new THREE.BufferGeometry().setFromPoints(object === this.points || ends.length === 2 ? ends : []);
      object.material.color.set(color);
      object.visible = this.on;
    }
    this.follow();
    this.stage.draw();
  }

  // The first figure beside the middle of the line, wherever that is on the screen now.
  follow() {
    const [a, b] = this.picked;
    this.label.hidden = !this.on || !b;
    if (this.label.hidden) return;
    const rect = this.stage.canvas.getBoundingClientRect();
    const [x, y] = project(this.stage, a.point.map((v, i) => (v + b.point[i]) / 2));
    this.label.textContent = this.approximate() + this.rows[0][1];
    this.label.style.transform = `translate(${Math.round(x - rect.left + 8)}px, ${Math.round(y - rect.top - 24)}px)`;
  }
}
