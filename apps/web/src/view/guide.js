// The path along which the hand is pulled: the way of the held part's center of mass, dashed, with a square at its end.
// In a color and a shape of its own, so that it is not taken for contacts.
import * as THREE from "three";
import { cssColor } from "../common/theme.js";

const over = { depthTest: false, depthWrite: false, transparent: true };
const dash = 0.12; // of the held part's radius

export class GuideLine {
  constructor(stage) {
    Object.assign(this, { stage, wanted: true, points: 0, group: new THREE.Group() });
    stage.scene.add(this.group);
  }

  // points: three numbers each; part: the one that the path is of.
  setScene(points, part) {
    this.points = points.length / 3;
    this.part = part;
    const dashes = dash * part.radius;
    const geometry = new THREE.BufferGeometry().setAttribute("position", new THREE.BufferAttribute(points, 3));
    this.line = new THREE.Line(geometry, new THREE.LineDashedMaterial({ dashSize: dashes, gapSize: 0.6 * dashes, ...over }));
    this.line.computeLineDistances();
    const last = new THREE.BufferGeometry().setAttribute("position", new THREE.BufferAttribute(points.slice(-3), 3));
    this.end = new THREE.Points(last, new THREE.PointsMaterial({ size: 9, sizeAttenuation: false, ...over }));
    for (const object of [this.line, this.end]) {
      object.renderOrder = 9;
      object.frustumCulled = false;
    }
    this.group.add(this.line, this.end);
    this.applyTheme();
    this.show();
  }

  applyTheme() {
    for (const object of [this.line, this.end]) object?.material.color.set(cssColor("--guide"));
  }

  enable(on) {
    this.wanted = on;
    this.show();
  }

  // It pulls only while the part that it is of is held, and lies where the parts are together.
  show() {
    this.group.visible = this.wanted && this.points > 0 && this.part.held && this.stage.explosion === 0;
    this.stage.draw();
  }

  get shown() {
    return this.group.visible ? this.points : 0;
  }
}
