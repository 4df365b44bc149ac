// The path in 3-D: the parts, the held one in the colors of its clearance, its ghosts along the path, and what happened where.
import * as THREE from "three";
import { disk } from "../common/disk.js";
import { cssColor } from "../common/theme.js";
import { setPose, Stage } from "../view/stage.js";
import { shadedSurface } from "../view/surface.js";
import { zoneColor } from "./colors.js";

const rowFloats = 8; // t and pose

export class PathView {
  constructor(canvas, bundle, scale) {
    this.stage = new Stage(canvas);
    this.stage.setScene(bundle);
    this.stage.ghost.visible = false;
    this.rows = bundle.floats(bundle.about.path);
    this.count = this.rows.length / rowFloats;
    this.center = new THREE.Vector3(...bundle.about.center);
    this.layers = {};
    this.addColors(bundle, scale);
    this.addGhosts(bundle);
    this.addPath(bundle);
    for (const kind of ["contact", "two-sided", "stall"]) this.addPlaces(kind, bundle.about.places);
    this.applyTheme();
    this.show(this.count - 1);
  }

  time(i) {
    return this.rows[i * rowFloats];
  }
  pose(i) {
    return this.rows.subarray(i * rowFloats + 1, (i + 1) * rowFloats);
  }

  addColors(bundle, scale) {
    const { positions, indices, clearance } = bundle.about.surface;
    const corners = bundle.integers(indices), values = bundle.floats(clearance);
    const shaded = shadedSurface(bundle.floats(positions), corners);
    const colors = new Float32Array(3 * corners.length);
    const color = new THREE.Color();
    for (let i = 0; i < corners.length; ++i) {
      const [r, g, b] = scale.color(values[corners[i]]);
      color.setRGB(r / 255, g / 255, b / 255, THREE.SRGBColorSpace).toArray(colors, 3 * i);
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(shaded.positions, 3));
    geometry.setAttribute("normal", new THREE.BufferAttribute(shaded.normals, 3));
    geometry.setAttribute("color", new THREE.BufferAttribute(colors, 3));
    const behind = { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 };
    const material = new THREE.MeshStandardMaterial({ vertexColors: true, roughness: 0.8, metalness: 0, side: THREE.DoubleSide, ...behind });
    this.colored = new THREE.Mesh(geometry, material);
    this.stage.held.group.add(this.colored);
    this.layers.colors = (on) => {
      this.colored.visible = on;
      this.stage.held.mesh3d.visible = !on;
    };
  }

  addGhosts(bundle) {
    const group = new THREE.Group();
    this.ghostMaterial = new THREE.MeshBasicMaterial({ transparent: true, opacity: 0.04, depthWrite: false, side: THREE.DoubleSide });
    this.ghostLines = new THREE.LineBasicMaterial({ transparent: true, opacity: 0.35, depthWrite: false });
    const lines = this.stage.held.lines3d;
    for (const i of bundle.integers(bundle.about.ghosts)) {
      const ghost = new THREE.Group();
      ghost.add(new THREE.Mesh(this.stage.held.mesh3d.geometry, this.ghostMaterial), new THREE.LineSegments(lines.geometry, this.ghostLines));
      setPose(ghost, this.pose(i));
      group.add(ghost);
    }
    group.renderOrder = 2;
    this.addLayer("ghosts", group);
  }

  addPath(bundle) {
    const points = [];
    const turn = new THREE.Quaternion();
    for (let i = 0; i < this.count; ++i) {
      const [x, y, z, qw, qx, qy, qz] = this.pose(i);
      points.push(this.center.clone().applyQuaternion(turn.set(qx, qy, qz, qw)).add(new THREE.Vector3(x, y, z)));
    }
    const geometry = new THREE.BufferGeometry().setFromPoints(points);
    const { band } = bundle.about;
    if (band) {
      const color = new THREE.Color();
      const colors = Array.from(bundle.integers(band.zones)).flatMap((zone) => {
        const [r, g, b] = zoneColor(zone);
        return color.setRGB(r / 255, g / 255, b / 255, THREE.SRGBColorSpace).toArray();
      });
      geometry.setAttribute("color", new THREE.Float32BufferAttribute(colors, 3));
    }
    this.line = new THREE.Line(geometry, new THREE.LineBasicMaterial({ depthTest: false, transparent: true, vertexColors: Boolean(band) }));
    this.line.renderOrder = 5;
    this.addLayer("path", this.line);
  }

  addPlaces(kind, places) {
    const here = places.filter((place) => place.kind === kind).map((place) => new THREE.Vector3(...place.at));
    if (here.length === 0) return;
    const size = { contact: 6, "two-sided": 8, stall: 11 }[kind];
    const material = new THREE.PointsMaterial({ size, map: disk(), sizeAttenuation: false, depthTest: false, transparent: true, opacity: 0.9 });
    const dots = new THREE.Points(new THREE.BufferGeometry().setFromPoints(here), material);
    dots.renderOrder = 6;
    dots.frustumCulled = false;
    this.dots = { ...this.dots, [kind]: material };
    this.addLayer(kind, dots);
  }

  addLayer(name, object) {
    this.stage.world.add(object);
    this.layers[name] = (on) => (object.visible = on);
  }

  enable(name, on) {
    if (name === "see-through") this.seeThrough(on);
    else this.layers[name](on);
    this.stage.draw();
  }

  seeThrough(on) {
    for (const part of this.stage.parts) if (!part.held) this.stage.fade(part, on);
  }

  applyTheme() {
    this.stage.applyTheme();
    this.ghostMaterial.color.set(cssColor("--ghost"));
    this.ghostLines.color.set(cssColor("--ghost"));
    this.line.material.color.set(this.line.material.vertexColors ? "#ffffff" : cssColor("--path"));
    for (const [kind, material] of Object.entries(this.dots ?? {})) material.color.set(cssColor(`--${kind}`));
    this.stage.draw();
  }

  show(i) {
    this.at = i;
    setPose(this.stage.held.group, this.pose(i));
    this.stage.draw();
  }

  // All that the part passes through.
  box() {
    const box = new THREE.Box3();
    for (const part of this.stage.parts) if (!part.held) box.expandByObject(part.group);
    const held = this.at;
    for (let k = 0; k <= 16; ++k) {
      setPose(this.stage.held.group, this.pose(Math.round((k / 16) * (this.count - 1))));
      this.stage.held.group.updateMatrixWorld(true);
      box.expandByObject(this.stage.held.group);
    }
    this.show(held);
    return box;
  }
}
