// What is under the pointer.
import * as THREE from "three";

// A ray from the eye through a point of the screen.
export function rayAt({ canvas, camera }, clientX, clientY) {
  const rect = canvas.getBoundingClientRect();
  camera.updateMatrixWorld(); // it may have moved since the last picture
  const ray = new THREE.Raycaster();
  ray.setFromCamera(new THREE.Vector2((2 * (clientX - rect.left)) / rect.width - 1, 1 - (2 * (clientY - rect.top)) / rect.height), camera);
  return ray;
}

// Where a point of the world is on the screen.
export function project({ canvas, camera }, point) {
  camera.updateMatrixWorld();
  const rect = canvas.getBoundingClientRect();
  const p = new THREE.Vector3(...point).project(camera);
  return [rect.left + ((p.x + 1) / 2) * rect.width, rect.top + ((1 - p.y) / 2) * rect.height];
}

// Of `parts`: {part, point, normal, face, cut} (world; face: number of the triangle; cut: the section plane was hit,
// where it cuts the part) or null. Parts that one sees through count where nothing else is.
export function pick(stage, clientX, clientY, parts) {
  stage.world.updateMatrixWorld();
  const ray = rayAt(stage, clientX, clientY);
  const of = (faded) => nearest(stage, ray, parts.filter((part) => part.group.visible && (part.materials.surface.transparent === faded)));
  return of(false) ?? of(true);
}

function nearest({ section, geometry }, ray, parts) {
  let best = null;
  for (const part of parts) {
    const mesh = new THREE.Mesh(geometry[part.mesh].surface, sides); // also while coarse ones are drawn
    mesh.matrixWorld.copy(part.mesh3d.matrixWorld);
    for (const hit of ray.intersectObject(mesh, false)) {
      if (section && section.distanceToPoint(hit.point) < 0) continue;
      const normal = hit.face.normal.clone().transformDirection(mesh.matrixWorld);
      const inner = normal.dot(ray.ray.direction) > 0;
      const found = { part, point: hit.point, normal, face: hit.faceIndex, distance: hit.distance, cut: false };
      if (inner && section) cutAt(found, ray.ray, section);
      // Another part's outer side may lie on this one's inner side, behind the cut.
      if (!best || found.distance < best.distance) best = found;
      break;
    }
  }
  return best;
}

const sides = new THREE.MeshBasicMaterial({ side: THREE.DoubleSide });

// An inner side is seen because the plane has opened the part: what is pointed at is the cut.
function cutAt(hit, ray, section) {
  const point = ray.intersectPlane(section, new THREE.Vector3());
  if (!point) return;
  Object.assign(hit, { point, normal: section.normal.clone().negate(), cut: true, distance: point.distanceTo(ray.origin) });
}
