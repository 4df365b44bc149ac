// What a test may ask the page.
import { cssColor } from "../common/theme.js";
import { distance, norm } from "./frame.js";
import { project } from "./picking.js";

export function addTestDoor(page) {
  const { stage, viewpoint, overlay, guide, hand, section, measure, contact } = page;
  const length = (arrow) => (arrow.group.visible ? arrow.length : 0);
  window.__tegotae = {
    get state() {
      const { about, parts, plots, player, frame, frames, status } = page.now;
      return {
        mode: about?.mode, frame, frames, status, shown: overlay.shown, plots: plots?.state(), selected: parts?.selected ?? null,
        parts: stage.parts?.map(({ name, held, visible, removed }) => ({ name, held, visible, removed })),
        places: stage.parts?.map(({ group }) => group.position.toArray()),
        faded: stage.parts?.filter((part) => part.materials.surface.transparent).map((part) => part.name),
        guide: { points: guide.shown, color: cssColor("--guide"), others: ["--contact", "--pair", "--force", "--torque", "--ghost"].map(cssColor) }, drawn: stage.drawn, coarse: stage.drawnCoarse, last: stage.last, background: cssColor("--stage"),
        arrows: { force: length(overlay.force), torque: length(overlay.torque) },
        force: frame ? norm(frame.force) : 0, lag: frame ? distance(frame.x, frame.y) : 0,
        camera: stage.camera.position.toArray(), target: viewpoint.controls.target.toArray(), up: viewpoint.up, parallel: viewpoint.parallel,
        section: stage.section && { normal: stage.section.normal.toArray(), constant: stage.section.constant }, handle: section.handle.position.toArray(), caps: stage.parts?.filter(({ cap }) => cap?.face.visible).map(({ name }) => name),
        contact: contact.at, measured: measure.rows, picked: measure.picked.map(({ kind }) => kind),
        count: player?.count, playing: player?.playing ?? false, message: document.getElementById("message").textContent, touched: document.getElementById("touched").textContent,
      };
    },
    project: (point) => project(stage, point),
    // Of all parts together, on the screen.
    corners() {
      const { min, max } = stage.measure();
      return [0, 1, 2, 3, 4, 5, 6, 7].map((i) => project(stage, [i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z]));
    },
    // Where the mouse holds the part.
    grip: () => hand.grip && [hand.grip.x, hand.grip.y],
    center: () => overlay.center.clone().applyMatrix4(stage.held.group.matrixWorld).toArray(),
  };
}
