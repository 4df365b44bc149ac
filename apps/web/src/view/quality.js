// How well a picture is drawn: with smooth edges where there is time for them, and of large scenes coarser while things
// move. What is smooth goes through a target of its own, because the page's canvas cannot change its number of samples. What
// is coarse goes to a canvas of fewer pixels, which the browser enlarges as it shows it: in software a copy through a
// target would cost more than the scene does.
import * as THREE from "three";
import { FullScreenQuad } from "three/addons/postprocessing/Pass.js";

const samples = 4;
const movingPixelRatio = 0.6;

export class Quality {
  constructor(renderer) {
    this.renderer = renderer;
    this.width = 0; // until the page is laid out
    // Eight bits as the screen has them, written and read as what they mean, so that blending is as light is. The copy has
    // the canvas's own pixels: there is nothing to filter.
    this.fine = new THREE.WebGLRenderTarget(1, 1, { colorSpace: THREE.SRGBColorSpace, minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter, stencilBuffer: true, samples });
    this.copy = new THREE.ShaderMaterial({
      uniforms: { picture: { value: this.fine.texture } },
      vertexShader: "varying vec2 at; void main() { at = uv; gl_Position = vec4(position.xy, 0.0, 1.0); }",
      fragmentShader: "uniform sampler2D picture; varying vec2 at; void main() { gl_FragColor = texture2D(picture, at);\n#include <colorspace_fragment>\n}",
      depthTest: false, depthWrite: false, toneMapped: false,
    });
    this.quad = new FullScreenQuad(this.copy);
  }

  resize(width, height, pixelRatio) {
    Object.assign(this, { width, height, pixelRatio, drawn: null });
    this.fine.setSize(Math.floor(width * pixelRatio), Math.floor(height * pixelRatio)); // as the canvas rounds
  }

  // The canvas loses its picture, so that one has to be drawn in the same turn.
  useRatio(ratio) {
    if (ratio === this.drawn) return;
    this.drawn = ratio;
    this.renderer.setDrawingBufferSize(this.width, this.height, ratio);
  }

  // Returns how many triangles that took.
  draw(scene, camera, coarse) {
    if (this.width === 0) return 0;
    this.useRatio(coarse ? Math.min(1, this.pixelRatio) * movingPixelRatio : this.pixelRatio);
    this.renderer.setRenderTarget(coarse ? null : this.fine);
    this.renderer.render(scene, camera);
    const { triangles } = this.renderer.info.render;
    if (coarse) return triangles;
    this.renderer.setRenderTarget(null);
    this.quad.render(this.renderer);
    return triangles;
  }
}
