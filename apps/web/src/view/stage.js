// The parts in 3-D. Draws only when something changed.
import * as THREE from "three";
import { cssColor } from "../common/theme.js";
import { shadedSurface } from "./surface.js";

const mostPixelRatio = 1.5;
const fixedColors = 5;

export function setPose(object, pose) {
  object.position.set(pose[0], pose[1], pose[2]);
  object.quaternion.set(pose[4], pose[5], pose[6], pose[3]);
}

export class Stage {
  constructor(canvas) {
    this.canvas = canvas;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: false });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, mostPixelRatio));
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(30, 1, 0.001, 10);
    this.camera.up.set(0, 0, 1);
    this.light = new THREE.DirectionalLight(0xffffff, 2.1);
    this.light.position.set(-0.4, 0.7, 1);
    this.camera.add(this.light);
    this.sky = new THREE.HemisphereLight(0xffffff, 0x8a8f98, 1.5);
    this.sky.position.set(0, 0, 1);
    this.scene.add(this.camera, this.sky);
    this.world = new THREE.Group();
    this.scene.add(this.world);
    this.section = new THREE.Plane(new THREE.Vector3(-1, 0, 0), 0);
    this.drawn = 0; // frames drawn, for tests
    this.scheduled = false;
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
  }

  // The parts of a bundle.
  setScene(bundle) {
    this.geometry = bundle.about.meshes.map((mesh) => this.geometries(bundle, mesh));
    this.parts = bundle.about.parts.map((about) => {
      const part = { name: about.name, mesh: about.mesh, group: new THREE.Group(), visible: true };
      this.addSurface(part, this.geometry[about.mesh]);
      this.world.add(part.group);
      return part;
    });
    this.setParts(bundle.about.parts);
    this.radius = this.box.getBoundingSphere(new THREE.Sphere()).radius;
  }

  // Where the parts are, which of them is held and which were removed: [{held, pose, removed?}], as in the bundle.
  // Returns whether another one is held.
  setParts(parts) {
    let color = 0;
    parts.forEach(({ held, pose, removed = false }, i) => {
      const part = this.parts[i];
      Object.assign(part, { held, removed, colorName: held ? "--part-held" : `--part-${color++ % fixedColors}` });
      setPose(part.group, pose);
      part.group.visible = part.visible && !removed;
    });
    const held = this.parts.find((part) => part.held);
    const another = held !== this.held;
    if (another) {
      this.held = held;
      held.radius = this.geometry[held.mesh].surface.boundingSphere.radius;
      if (this.ghost) this.world.remove(this.ghost);
      this.addGhost(this.geometry[held.mesh]);
    }
    setPose(this.ghost, parts[this.parts.indexOf(held)].pose);
    this.ghost.visible = held.visible;
    this.measure();
    this.applyTheme();
    return another;
  }

  // Part number `i`, or none for null, in another light.
  highlight(i) {
    this.parts.forEach((part, k) => part.material.emissive.set(k === i ? cssColor("--selected") : "#000000"));
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

  geometries(bundle, mesh) {
    const shaded = shadedSurface(bundle.floats(mesh.positions), bundle.integers(mesh.indices));
    const surface = new THREE.BufferGeometry();
    surface.setAttribute("position", new THREE.BufferAttribute(shaded.positions, 3));
    surface.setAttribute("normal", new THREE.BufferAttribute(shaded.normals, 3));
    surface.computeBoundingSphere();
    const edges = new THREE.BufferGeometry();
    edges.setAttribute("position", new THREE.BufferAttribute(shaded.edges, 3));
    return { surface, edges };
  }

  addSurface(part, { surface, edges }) {
    // Lines lie on the surface: it steps back a little, so that they win.
    const behind = { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 };
    part.material = new THREE.MeshStandardMaterial({ roughness: 0.75, metalness: 0, ...behind });
    part.inside = new THREE.MeshBasicMaterial({ side: THREE.BackSide, ...behind });
    part.lines = new THREE.LineBasicMaterial({ transparent: true, opacity: 0.55, depthWrite: false });
    part.mesh3d = new THREE.Mesh(surface, part.material);
    // Inner sides in one flat color look like the cut that a section plane makes, if they come after the lines on them.
    const inside = new THREE.Mesh(surface, part.inside);
    inside.renderOrder = 2;
    part.group.add(part.mesh3d, inside, new THREE.LineSegments(edges, part.lines));
  }

  addGhost({ surface, edges }) {
    this.ghost = new THREE.Group();
    this.ghostMaterial = new THREE.MeshBasicMaterial({ transparent: true, opacity: 0.13, depthWrite: false });
    this.ghostLines = new THREE.LineBasicMaterial({ transparent: true, opacity: 0.7 });
    this.ghost.add(new THREE.Mesh(surface, this.ghostMaterial), new THREE.LineSegments(edges, this.ghostLines));
    this.ghost.renderOrder = 1;
    this.world.add(this.ghost);
  }

  applyTheme() {
    this.scene.background = new THREE.Color(cssColor("--stage"));
    for (const part of this.parts ?? []) {
      const color = new THREE.Color(cssColor(part.colorName));
      part.material.color.copy(color);
      part.inside.color.copy(color).lerp(new THREE.Color(cssColor("--cut")), 0.3);
      part.lines.color.set(cssColor("--edge"));
    }
    this.ghostMaterial?.color.set(cssColor("--ghost"));
    this.ghostLines?.color.set(cssColor("--ghost"));
    this.draw();
  }

  showPoses(x, y) {
    setPose(this.held.group, x);
    setPose(this.ghost, y);
    this.draw();
  }

  setVisible(part, visible) {
    part.visible = visible;
    part.group.visible = visible && !part.removed;
    if (part.held) this.ghost.visible = visible;
    this.draw();
  }

  // axis: 0, 1, 2 or null for none; at: 0..1 of the scene's box.
  setSection(axis, at, flipped) {
    const on = axis !== null;
    if (on) {
      const sign = flipped ? 1 : -1;
      const place = this.box.min.getComponent(axis) + at * (this.box.max.getComponent(axis) - this.box.min.getComponent(axis));
      this.section.normal.set(0, 0, 0).setComponent(axis, sign);
      this.section.constant = -sign * place;
    }
    this.renderer.localClippingEnabled = on;
    for (const part of this.parts) {
      part.inside.transparent = on; // only such are drawn after the lines
      for (const material of [part.material, part.inside, part.lines]) {
        material.clippingPlanes = on ? [this.section] : null;
        material.needsUpdate = true;
      }
    }
    this.draw();
  }

  // The part under the pointer: {part, point} or null.
  pick(clientX, clientY) {
    const rect = this.canvas.getBoundingClientRect();
    // They may have moved since the last picture.
    this.camera.updateMatrixWorld();
    this.world.updateMatrixWorld();
    const ray = new THREE.Raycaster();
    ray.setFromCamera(
      new THREE.Vector2((2 * (clientX - rect.left)) / rect.width - 1, 1 - (2 * (clientY - rect.top)) / rect.height), this.camera);
    const shown = this.parts.filter((part) => part.group.visible);
    const cut = this.renderer.localClippingEnabled ? this.section : null;
    for (const hit of ray.intersectObjects(shown.map((part) => part.mesh3d), false)) {
      if (cut && cut.distanceToPoint(hit.point) < 0) continue;
      return { part: shown.find((part) => part.mesh3d === hit.object), point: hit.point };
    }
    return null;
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (width === 0 || height === 0) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  draw() {
    if (this.scheduled) return;
    this.scheduled = true;
    requestAnimationFrame(() => {
      this.scheduled = false;
      ++this.drawn;
      this.renderer.render(this.scene, this.camera);
    });
  }
}
