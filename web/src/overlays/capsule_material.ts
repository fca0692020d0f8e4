/** The look of capsules that are marks and no bodies: edges clear, the middle open, so that what they enclose stays in sight. */

import { MeshBasicMaterial, type IUniform } from "three";

/** What stands before the avatar keeps this share of its opacity. */
const IN_FRONT = 0.1;

/** How see-through capsules are drawn. */
export interface MarkLook {
  readonly color: number;
  /** Of the edges, 0 to 1. */
  readonly opacity: number;
  /** Share of that opacity that is left in the middle, where the surface faces the viewer; 1 is flat. */
  readonly middle: number;
  /** Drawn over everything. */
  readonly onTop?: boolean;
  /** Gives way in front of the avatar, and each capsule has an opacity of its own. */
  readonly ghost?: boolean;
}

export class MarkMaterial extends MeshBasicMaterial {
  /** Metres from the viewer to the avatar, along the line of sight. */
  private readonly avatarDepth: IUniform<number> = { value: 0 };

  constructor(look: MarkLook) {
    super({
      color: look.color, transparent: true, opacity: look.opacity, depthWrite: false, depthTest: !look.onTop, toneMapped: false,
    });
    if (look.ghost) this.defines = { GHOST: "" };
    this.onBeforeCompile = (shader) => {
      shader.uniforms["avatarDepth"] = this.avatarDepth;
      shader.uniforms["middle"] = { value: look.middle };
      shader.vertexShader = shader.vertexShader
        .replace("void main() {", `${VERTEX_HEAD}\nvoid main() {`)
        .replace("#include <project_vertex>", `#include <project_vertex>\n${VERTEX}`);
      shader.fragmentShader = shader.fragmentShader
        .replace("void main() {", "varying float vShare;\nvoid main() {")
        .replace("#include <opaque_fragment>", "diffuseColor.a *= vShare;\n#include <opaque_fragment>");
    };
  }

  /** Says how far away the avatar is. */
  setAvatarDepth(metres: number): void {
    this.avatarDepth.value = metres;
  }
}

const VERTEX_HEAD = /* glsl */ `
  varying float vShare;
  uniform float middle;
  #ifdef GHOST
    attribute float share;
    uniform float avatarDepth;
  #endif
`;

const VERTEX = /* glsl */ `
  vec3 outwards = normalize(mat3(modelViewMatrix) * mat3(instanceMatrix) * normal);
  float facing = abs(dot(outwards, normalize(mvPosition.xyz)));
  vShare = mix(1.0, middle, smoothstep(0.25, 0.95, facing));
  #ifdef GHOST
    vShare *= share * mix(${IN_FRONT.toFixed(3)}, 1.0, smoothstep(-0.3, 0.4, -mvPosition.z - avatarDepth));
  #endif
`;
