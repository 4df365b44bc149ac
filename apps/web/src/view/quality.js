// How well a picture is drawn: with smooth edges where there is time for them, and of large scenes coarser while things
// move. Everything goes through a target of its own, because the page's canvas cannot change its number of samples.
import * as THREE from "three";
import { FullScreenQuad } from "three/addons/postprocessing/Pass.js";

const samples = 4;
const movingPixelRatio = 0.6;

export class Quality {
  constructor(renderer) {
    this.renderer = renderer;
    // Eight bits as the screen has them, written and read as what they mean, so that blending is as light is.
    const options = { colorSpace: THREE.SRGBColorSpace, minFilter: THREE.LinearFilter };
    this.fine = new THREE.WebGLRenderTarget(1, 1, { ...options, samples });
    this.coarse = new THREE.WebGLRenderTarget(1, 1, options);
    this.copy = new THREE.ShaderMaterial({
      uniforms: { picture: { value: null } },
      vertexShader: "varying vec2 at; void main() { at = uv; gl_Position = vec4(position.xy, 0.0, 1.0); }",
      fragmentShader: "uniform sampler2D picture; varying vec2 at; void main() { gl_FragColor = texture2D(picture, at);\n#include <colorspace_fragment>\n}",
      depthTest: false, depthWrite: false, toneMapped: false,
    });
    this.quad = new FullScreenQuad(this.copy);
  }

  resize(width, height, pixelRatio) {
    const size = (ratio) => [Math.max(1, Math.round(width * ratio)), Math.max(1, Math.round(height * ratio))];
    this.fine.setSize(...size(pixelRatio));
    this.coarse.setSize(...size(Math.min(1, pixelRatio) * movingPixelRatio));
  }

  draw(scene, camera, coarse) {
    const target = coarse ? this.coarse : this.fine;
    this.renderer.setRenderTarget(target);
    this.renderer.render(scene, camera);
    this.renderer.setRenderTarget(null);
    this.copy.uniforms.picture.value = target.texture;
    this.quad.render(this.renderer);
  }
}
