// What a part's surface, inner side and lines are drawn with.
import * as THREE from "three";
import { cssColor } from "../common/theme.js";
import { whereCounted } from "./cap.js";

// Where a triangle covers less than a pixel, whether the plane cuts it off is asked of a place on the triangle, not of the
// pixel's middle beside it: walls that end at the plane would leave dots there.
for (const chunk of ["clipping_planes_pars_vertex", "clipping_planes_pars_fragment"])
  THREE.ShaderChunk[chunk] = THREE.ShaderChunk[chunk].replace("varying vec3 vClipPosition", "centroid $&");

export const fadedOpacity = 0.22;
// Lines lie on the surface: it steps back a little, so that they win.
const behind = { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 };

// The face that a section plane makes (cap.js) has one flat color, hatched as in a drawing, by the part's number in another
// direction or at another pitch. Of a part that is not closed no face can be made: its inner sides are drawn like one.
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

function cutMaterial(number, closed) {
  return new THREE.ShaderMaterial({
    vertexShader: cutVertex,
    fragmentShader: cutFragment,
    uniforms: {
      color: { value: new THREE.Color() }, ink: { value: new THREE.Color() }, hatched: { value: 0 }, opacity: { value: 1 },
      pitch: { value: 8 + 3 * (number % 3) }, slope: { value: number % 2 ? -1 : 1 },
    },
    ...(closed ? whereCounted(number) : { clipping: true, side: THREE.BackSide, ...behind }),
  });
}

export function partMaterials(number, closed) {
  return {
    surface: new THREE.MeshStandardMaterial({ roughness: 0.62, metalness: 0, ...behind }),
    cut: cutMaterial(number, closed),
    lines: new THREE.LineBasicMaterial({ transparent: true, opacity: 0.6, depthWrite: false }),
  };
}

// color: of the part; held, selected: its lines say so; faded: one sees through it; section: the plane, or null.
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
  cut.transparent = cut.clipping && (faded || section !== null); // only such are drawn after the lines
  for (const material of cut.clipping ? [surface, cut, lines] : [surface, lines]) {
    material.clippingPlanes = section ? [section] : null;
    material.needsUpdate = true;
  }
}
