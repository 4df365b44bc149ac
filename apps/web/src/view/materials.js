// What a part's surface, inner side and lines are drawn with.
import * as THREE from "three";
import { cssColor } from "../common/theme.js";

export const fadedOpacity = 0.22;
// Lines lie on the surface: it steps back a little, so that they win.
const behind = { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 };

// Inner sides have one flat color, like the face that a section plane makes: what lies behind it is inside the part.
// Hatched as in a drawing, by the part's number in another direction or at another pitch.
const cutVertex = `
#include <clipping_planes_pars_vertex>
void main() {
  #include <begin_vertex>
  #include <project_vertex>
  #include <clipping_planes_vertex>
}`;
const cutFragment = `
uniform vec3 color, ink;
uniform float pitch, slope, hatched, opacity;
#include <clipping_planes_pars_fragment>
void main() {
  #include <clipping_planes_fragment>
  float across = (gl_FragCoord.x + slope * gl_FragCoord.y) / sqrt(1.0 + slope * slope);
  float line = clamp(1.2 - abs(mod(across, pitch) - 0.5 * pitch), 0.0, 1.0);
  gl_FragColor = vec4(mix(color, ink, hatched * line), opacity);
  #include <colorspace_fragment>
}`;

function cutMaterial(number) {
  return new THREE.ShaderMaterial({
    vertexShader: cutVertex,
    fragmentShader: cutFragment,
    clipping: true,
    side: THREE.BackSide,
    uniforms: {
      color: { value: new THREE.Color() }, ink: { value: new THREE.Color() }, hatched: { value: 0 }, opacity: { value: 1 },
      pitch: { value: 8 + 3 * (number % 3) }, slope: { value: number % 2 ? -1 : 1 },
    },
    ...behind,
  });
}

export function partMaterials(number) {
  return {
    surface: new THREE.MeshStandardMaterial({ roughness: 0.62, metalness: 0, ...behind }),
    cut: cutMaterial(number),
    lines: new THREE.LineBasicMaterial({ transparent: true, opacity: 0.6, depthWrite: false }),
  };
}

// color: of the part; held, selected: its lines say so; faded: one sees through it; cut: the section plane, or null.
export function dress({ surface, cut, lines }, { color, held, selected, faded, section }) {
  surface.color.set(color);
  surface.emissive.set(selected ? cssColor("--selected") : "#000000");
  lines.color.set(cssColor(held || selected ? "--ghost" : "--edge"));
  lines.opacity = selected ? 1 : faded ? 0.35 : 0.6;
  cut.uniforms.color.value.set(color).lerp(new THREE.Color(cssColor("--cut")), 0.25);
  cut.uniforms.ink.value.set(cssColor("--edge"));
  cut.uniforms.hatched.value = section ? 0.55 : 0;
  cut.uniforms.opacity.value = faded ? fadedOpacity : 1;
  surface.opacity = faded ? fadedOpacity : 1;
  surface.transparent = faded;
  surface.depthWrite = cut.depthWrite = !faded;
  cut.transparent = faded || section !== null; // only such are drawn after the lines
  for (const material of [surface, cut, lines]) {
    material.clippingPlanes = section ? [section] : null;
    material.needsUpdate = true;
  }
}
