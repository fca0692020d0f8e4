/** The gradient behind everything: a dome with three colours by height. */

import { BackSide, Color, Mesh, ShaderMaterial, SphereGeometry } from "three";
import type { Palette } from "./palette";

const VERTEX = /* glsl */ `
  varying vec3 vDirection;
  void main() {
    vDirection = position;
    vec4 clip = projectionMatrix * vec4(mat3(modelViewMatrix) * position, 1.0);
    gl_Position = clip.xyww;
  }
`;

const FRAGMENT = /* glsl */ `
  uniform vec3 top;
  uniform vec3 horizon;
  uniform vec3 below;
  varying vec3 vDirection;
  void main() {
    float height = normalize(vDirection).y;
    vec3 colour = mix(horizon, top, smoothstep(0.0, 0.65, height));
    colour = mix(colour, below, smoothstep(0.0, -0.25, height));
    gl_FragColor = vec4(colour, 1.0);
    #include <colorspace_fragment>
  }
`;

export class Sky {
  readonly mesh: Mesh<SphereGeometry, ShaderMaterial>;

  constructor() {
    const material = new ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      side: BackSide,
      depthWrite: false,
      uniforms: { top: { value: new Color() }, horizon: { value: new Color() }, below: { value: new Color() } },
    });
    this.mesh = new Mesh(new SphereGeometry(1, 24, 12), material);
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = 1; // last of the solid things: only where nothing else is
  }

  paint(palette: Palette): void {
    const { uniforms } = this.mesh.material;
    (uniforms["top"]?.value as Color).set(palette.skyTop);
    (uniforms["horizon"]?.value as Color).set(palette.horizon);
    (uniforms["below"]?.value as Color).set(palette.skyGround);
  }
}
