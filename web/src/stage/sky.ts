/** What lies behind everything: a dome with three colours by height, and two ridges of far hills along the horizon. */

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
  uniform vec3 hills;
  varying vec3 vDirection;

  /* Whole waves round the horizon, so that the ridge closes upon itself. */
  float ridge(float a, vec3 phase) {
    return 0.5 + 0.27 * sin(2.0 * a + phase.x) + 0.16 * sin(5.0 * a + phase.y) + 0.07 * sin(13.0 * a + phase.z);
  }

  /* Hills stand out against the sky and vanish in the haze at their feet. */
  vec3 behind(vec3 colour, float height, float crest, float strength) {
    float haze = smoothstep(0.0, crest, height);
    float inside = 1.0 - smoothstep(crest - 0.0025, crest, height);
    return mix(colour, mix(horizon, hills, strength * (0.25 + 0.75 * haze)), inside);
  }

  void main() {
    vec3 direction = normalize(vDirection);
    float height = direction.y;
    vec3 colour = mix(horizon, top, smoothstep(0.0, 0.65, height));
    if (height > -0.01 && height < 0.12) {
      float a = atan(direction.x, direction.z);
      colour = behind(colour, height, 0.032 + 0.062 * ridge(a, vec3(0.6, 2.1, 4.0)), 0.55);
      colour = behind(colour, height, 0.012 + 0.038 * ridge(a, vec3(3.4, 0.3, 1.7)), 1.0);
    }
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
      uniforms: Object.fromEntries(["top", "horizon", "below", "hills"].map((name) => [name, { value: new Color() }])),
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
    (uniforms["hills"]?.value as Color).set(palette.hills);
  }
}
