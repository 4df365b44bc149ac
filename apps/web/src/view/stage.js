// The parts in 3-D. Draws only when something changed.
import * as THREE from "three";
import { cssColor } from "../common/theme.js";
import { Cap } from "./cap.js";
import { coarseMesh } from "./lod.js";
import { dress, partMaterials } from "./materials.js";
import { pick } from "./picking.js";
import { Quality } from "./quality.js";
import { shadedSurface } from "./surface.js";

const maxPixelRatio = 1.5;
const fixedColors = 5;
const heavyTriangles = 30_000; // more of them are drawn coarsely while things move
const coarseTriangles = 9_000; // then, all together
const restMs = 160; // after the last motion
const longestGapMs = 1500; // between two pictures of one motion
// How long (ms) a picture waits for its turn where edges are no longer smoothed while things move, and where they are
// again. The browser gives turns as fast as pictures get done.
const slowMs = 45, fastMs = 22;

export function setPose(object, pose) {
  object.position.set(pose[0], pose[1], pose[2]);
  object.quaternion.set(pose[4], pose[5], pose[6], pose[3]);
}

const geometryOf = (attributes) => {
  const geometry = new THREE.BufferGeometry();
  for (const [name, array] of Object.entries(attributes)) geometry.setAttribute(name, new THREE.BufferAttribute(array, 3));
  geometry.computeBoundingSphere();
  return geometry;
};

export class Stage {
  constructor(canvas) {
    this.canvas = canvas;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: false, preserveDrawingBuffer: false, stencil: true });
    this.quality = new Quality(this.renderer);
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(30, 1, 0.001, 10);
    this.camera.up.set(0, 0, 1);
    this.addLights();
    this.world = new THREE.Group();
    this.scene.add(this.world);
    this.section = null; // a plane: what is behind it is not drawn
    this.seesThrough = new Set(); // numbers of parts that something must be seen behind
    this.selected = null; // number of the part in another light
    this.explosion = 0;
    this.drawn = 0; // pictures drawn, for tests
    this.drawnCoarse = 0; // of them
    this.last = null; // what the newest one was of
    this.scheduled = false;
    Object.assign(this, { moving: false, movedAt: -Infinity, coarseAt: -Infinity, wait: slowMs, slow: true });
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
  }

  // Soft light from all around, more from above, and two lamps that go with the eye.
  addLights() {
    this.sky = new THREE.HemisphereLight(0xffffff, 0x9a9ea6, 1.35);
    this.sky.position.copy(this.camera.up);
    for (const [x, y, z, strength] of [[-0.5, 0.8, 1, 1.7], [0.9, -0.3, 0.6, 0.55]]) {
      const lamp = new THREE.DirectionalLight(0xffffff, strength);
      lamp.position.set(x, y, z);
      this.camera.add(lamp);
    }
    this.scene.add(this.camera, this.sky);
  }

  // The parts of a bundle.
  setScene(bundle) {
    this.about = bundle.about;
    this.geometry = bundle.about.meshes.map((mesh) => this.geometries(bundle, mesh));
    this.parts = bundle.about.parts.map((about, i) => this.addPart(about, i));
    const triangles = this.parts.reduce((sum, part) => sum + this.geometry[part.mesh].indices.length / 3, 0);
    this.heavy = triangles > heavyTriangles;
    if (this.heavy) this.addCoarse(coarseTriangles / triangles);
    this.setParts(bundle.about.parts);
    this.radius = this.box.getBoundingSphere(new THREE.Sphere()).radius;
  }

  geometries(bundle, mesh) {
    const positions = bundle.floats(mesh.positions), indices = bundle.integers(mesh.indices);
    const { edges, closed, ...surface } = shadedSurface(positions, indices);
    return {
      positions, indices, closed,
      surface: geometryOf({ position: surface.positions, normal: surface.normals }),
      edges: geometryOf({ position: edges }),
    };
  }

  addPart({ name, mesh, path = [], color = null }, number) {
    const { surface, edges, closed } = this.geometry[mesh];
    const materials = partMaterials(number, closed);
    const part = {
      name, mesh, path, fileColor: color && new THREE.Color().setRGB(...color.slice(0, 3), THREE.SRGBColorSpace), group: new THREE.Group(),
      pose: null, visible: true, faded: color !== null && color[3] < 0.99, materials,
      mesh3d: new THREE.Mesh(surface, materials.surface), lines3d: new THREE.LineSegments(edges, materials.lines),
    };
    part.radius = surface.boundingSphere.radius;
    part.group.add(part.mesh3d, part.lines3d);
    this.world.add(part.group);
    this.addInside(part, number);
    return part;
  }

  // What is seen of a part where it is cut open.
  addInside(part, number) {
    const { surface, closed } = this.geometry[part.mesh];
    if (closed) {
      part.cap = new Cap(surface, part.materials.cut, number);
      this.scene.add(part.cap.face);
    } else {
      part.inside = new THREE.Mesh(surface, part.materials.cut);
      part.inside.renderOrder = 2;
    }
    part.insides = part.cap?.counters ?? [part.inside];
    part.group.add(...part.insides);
  }

  addCoarse(share) {
    for (const shape of this.geometry) {
      const { positions, indices } = shape;
      const coarse = coarseMesh(positions, indices, Math.max(40, Math.round((share * indices.length) / 3)));
      const { positions: position, normals: normal } = shadedSurface(coarse.positions, coarse.indices);
      shape.coarse = geometryOf({ position, normal });
    }
  }

  // Where the parts are, which of them is held and which were removed: [{held, pose, removed?}], as in the bundle.
  // Returns whether another one is held.
  setParts(parts) {
    let color = 0;
    parts.forEach(({ held, pose, removed = false }, i) => {
      const part = this.parts[i];
      Object.assign(part, { held, removed, pose, colorName: held ? "--part-held" : `--part-${color++ % fixedColors}` });
      part.group.visible = part.visible && !removed;
    });
    const held = this.parts.find((part) => part.held) ?? null;
    const another = held !== this.held;
    this.held = held;
    if (another && this.ghost) this.world.remove(this.ghost);
    if (another) this.ghost = this.shownY = null;
    if (another && held) this.addGhost(this.geometry[held.mesh]);
    if (held) {
      setPose(this.ghost, held.pose);
      this.ghost.visible = held.visible;
    }
    this.explode(this.explosion);
    this.applyTheme();
    return another;
  }

  addGhost({ surface, edges }) {
    this.ghost = new THREE.Group();
    this.ghostMaterial = new THREE.MeshBasicMaterial({ transparent: true, opacity: 0.13, depthWrite: false });
    this.ghostLines = new THREE.LineBasicMaterial({ transparent: true, opacity: 0.7 });
    this.ghost.add(new THREE.Mesh(surface, this.ghostMaterial), new THREE.LineSegments(edges, this.ghostLines));
    this.ghost.renderOrder = 1;
    this.world.add(this.ghost);
  }

  // Part number `i`, or none for null, in another light.
  highlight(i) {
    const changed = [this.parts[this.selected], this.parts[i]];
    this.selected = i;
    for (const part of changed) if (part) this.dress(part);
    this.draw();
  }

  // The box of the parts that are shown, as they are now.
  measure() {
    this.box = new THREE.Box3();
    for (const part of this.parts) {
      part.group.updateMatrixWorld(true);
      if (part.group.visible) this.box.expandByObject(part.group);
    }
    return this.box;
  }

  // Parts go away from the middle of all, by so many times their distance from it.
  explode(factor) {
    this.explosion = factor;
    for (const part of this.parts) setPose(part.group, part.pose);
    this.measure();
    if (factor > 0) {
      const middle = this.box.getCenter(new THREE.Vector3());
      for (const part of this.parts) {
        const own = this.geometry[part.mesh].surface.boundingSphere.center.clone().applyMatrix4(part.group.matrixWorld);
        part.group.position.addScaledVector(own.sub(middle), factor);
      }
      this.measure();
    }
    if (this.ghost) this.ghost.visible = factor === 0 && this.held.visible;
    this.draw();
  }

  colorOf(part) {
    return part.fileColor ?? new THREE.Color(cssColor(part.colorName));
  }

  applyTheme() {
    this.scene.background = new THREE.Color(cssColor("--stage"));
    for (const part of this.parts ?? []) this.dress(part);
    this.ghostMaterial?.color.set(cssColor("--ghost"));
    this.ghostLines?.color.set(cssColor("--ghost"));
    this.draw();
  }

  dress(part) {
    const faded = part.faded || this.seesThrough.has(this.parts.indexOf(part));
    const selected = part === this.parts[this.selected];
    dress(part.materials, { color: this.colorOf(part), held: part.held, selected, faded, section: this.section });
    part.cap?.cut(faded ? null : this.section);
    part.mesh3d.renderOrder = faded ? 3 : 0;
  }

  fade(part, faded) {
    part.faded = faded;
    this.dress(part);
    this.draw();
  }

  // Numbers of the parts that something must be seen behind.
  seeThrough(numbers) {
    const changed = [...numbers, ...this.seesThrough].filter((i) => numbers.has(i) !== this.seesThrough.has(i));
    this.seesThrough = new Set(numbers);
    for (const i of changed) if (this.parts[i]) this.dress(this.parts[i]);
    if (changed.length > 0) this.draw();
  }

  // changed: something else than the poses has, too.
  showPoses(x, y, changed) {
    const near = (a, b) => a.every((v, i) => Math.abs(v - b[i]) < 1e-6 * (i < 3 ? this.radius : 1));
    if (this.explosion > 0) return;
    const still = near(x, this.held.pose) && this.shownY && near(y, this.shownY);
    this.held.pose = x;
    this.shownY = y;
    setPose(this.held.group, x);
    setPose(this.ghost, y);
    if (!still || changed) this.draw(!still);
  }

  setVisible(part, visible) {
    part.visible = visible;
    part.group.visible = visible && !part.removed;
    if (part.held) this.ghost.visible = visible && this.explosion === 0;
    this.draw();
  }

  // A plane that cuts what is behind it off, or null.
  setSection(plane) {
    this.section = plane;
    this.renderer.localClippingEnabled = plane !== null;
    for (const part of this.parts) this.dress(part);
    this.draw();
  }

  // The part under the pointer: {part, point, normal, face, cut} or null.
  pick(clientX, clientY, parts = this.parts) {
    return pick(this, clientX, clientY, parts);
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (width === 0 || height === 0) return;
    this.quality.resize(width, height, Math.min(devicePixelRatio, maxPixelRatio));
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.onResize?.();
    this.draw();
  }

  // moving: what is drawn now will not be for long.
  draw(moving = false) {
    if (moving) this.movedAt = performance.now();
    this.moving ||= moving; // also when the picture comes late
    if (this.scheduled) return;
    this.scheduled = true;
    const asked = performance.now();
    requestAnimationFrame(() => {
      this.scheduled = false;
      const moving = this.moving || performance.now() - this.movedAt < restMs;
      this.moving = false;
      if (moving) this.pace(performance.now() - asked);
      const coarse = moving && (this.heavy === true || this.slow);
      if (this.heavy) this.useCoarse(coarse);
      this.onDraw?.();
      this.placeCaps();
      const triangles = this.quality.draw(this.scene, this.camera, coarse);
      ++this.drawn;
      this.last = { coarse, triangles, pixels: this.canvas.width * this.canvas.height };
      if (!coarse) return;
      ++this.drawnCoarse;
      this.rests();
    });
  }

  placeCaps() {
    for (const { cap, group, mesh } of this.parts ?? []) {
      if (!cap?.section) continue;
      group.updateMatrixWorld();
      cap.place(this.geometry[mesh].surface.boundingSphere.clone().applyMatrix4(group.matrixWorld), group.visible);
    }
  }

  // The fine picture comes when no coarse one has followed for twice the time between the last two: a slow machine must not
  // draw it in the middle of a motion.
  rests() {
    const now = performance.now(), gap = now - this.coarseAt;
    this.coarseAt = now;
    clearTimeout(this.rest);
    this.rest = setTimeout(() => this.draw(), Math.max(restMs + 20, gap < longestGapMs ? 2 * gap : 0));
  }

  // Whether this machine is too slow for smooth edges while things move. It is until it has shown that it is not.
  pace(waited) {
    this.wait += (Math.min(waited, 4 * slowMs) - this.wait) / 8;
    if (this.wait > slowMs) this.slow = true;
    if (this.wait < fastMs) this.slow = false;
  }

  useCoarse(on) {
    if (on === this.coarse) return;
    this.coarse = on;
    for (const part of this.parts) {
      const { surface, coarse } = this.geometry[part.mesh];
      for (const mesh of [part.mesh3d, ...part.insides]) mesh.geometry = on ? coarse : surface;
      part.lines3d.visible = !on;
    }
  }
}
