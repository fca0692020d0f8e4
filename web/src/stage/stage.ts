/** The lit, empty world: renderer, lights, sky and floor. Other modules hang their things into `scene`. */

import {
  AmbientLight, Color, DirectionalLight, Fog, HemisphereLight, NeutralToneMapping, PCFShadowMap, PerspectiveCamera,
  PMREMGenerator, Scene, Vector3, WebGLRenderer, type Texture,
} from "three";
import { RoomEnvironment } from "three/addons/environments/RoomEnvironment.js";
import { HAZE } from "./field";
import { PALETTES, type Palette, type Theme } from "./palette";
import type { Quality } from "./quality";
import { Sky } from "./sky";

const SUN_DIRECTION = new Vector3(0.52, 1, -0.42).normalize();
const SUN_DISTANCE = 24;
const SHADOW_EXTENT = 7.5;
const SHADOW_PIXELS = 2048;
const FIELD_OF_VIEW = 50;
/** An upright picture has room enough below the feet: it is shifted up by this share of what is asked for. */
const LIFT_UPRIGHT = 0.25;

/** A part of the picture, in CSS pixels from its upper left corner. */
export type Part = Readonly<Record<"left" | "top" | "width" | "height", number>>;

export class Stage {
  readonly scene = new Scene();
  readonly camera = new PerspectiveCamera(FIELD_OF_VIEW, 1, 0.05, 250);
  palette: Palette = PALETTES.light;
  private renderer: WebGLRenderer;
  private quality: Quality;
  private readonly sky = new Sky();
  private readonly sun = new DirectionalLight();
  private readonly hemisphere = new HemisphereLight();
  private readonly fill = new AmbientLight(0xffffff, 0.12);
  private room: Texture | null = null;
  private coveredRight = 0;
  private lift = 0;

  /** @param host the element that holds the canvas */
  constructor(private readonly host: HTMLElement, quality: Quality) {
    this.quality = quality;
    this.renderer = this.createRenderer(quality);
    this.scene.add(this.sky.mesh, this.sun, this.sun.target, this.hemisphere, this.fill);
    this.setUpShadows();
    this.apply(quality);
    new ResizeObserver(() => this.resize()).observe(host);
    this.resize();
  }

  /** What draws: the graphics card's name, as far as the browser tells. */
  get rendererName(): string {
    const context = this.renderer.getContext();
    const extension = context.getExtension("WEBGL_debug_renderer_info");
    return String(context.getParameter(extension ? extension.UNMASKED_RENDERER_WEBGL : context.RENDERER));
  }

  /** What the picture is drawn on; another one after a change of smooth edges. */
  get canvas(): HTMLCanvasElement {
    return this.renderer.domElement;
  }

  get currentQuality(): Quality {
    return this.quality;
  }

  /** Changes the level; a change of smooth edges needs a new canvas. */
  setQuality(quality: Quality): void {
    if (quality.antialias !== this.quality.antialias) {
      const old = this.renderer;
      this.room?.dispose();
      this.room = null;
      this.renderer = this.createRenderer(quality);
      old.domElement.remove();
      old.dispose();
    }
    this.quality = quality;
    this.apply(quality);
    this.resize();
  }

  paint(theme: Theme): void {
    const palette = PALETTES[theme];
    this.palette = palette;
    this.sky.paint(palette);
    this.scene.fog = new Fog(new Color(palette.horizon), ...HAZE);
    this.sun.color.set(palette.keyLight);
    this.sun.intensity = palette.keyIntensity;
    this.hemisphere.color.set(palette.skyLight);
    this.hemisphere.groundColor.set(palette.groundLight);
    this.hemisphere.intensity = palette.ambientIntensity;
    this.scene.environmentIntensity = palette.environmentIntensity;
    this.renderer.toneMappingExposure = palette.exposure;
  }

  /** Keeps the sun's shadow where the action is. */
  follow(x: number, floor: number, z: number): void {
    const texel = (2 * SHADOW_EXTENT) / SHADOW_PIXELS;
    const snap = (v: number) => Math.round(v / (texel * 8)) * texel * 8;
    this.sun.target.position.set(snap(x), snap(floor) + 0.9, snap(z));
    this.sun.position.copy(SUN_DIRECTION).multiplyScalar(SUN_DISTANCE).add(this.sun.target.position);
  }

  render(): void {
    this.renderer.render(this.scene, this.camera);
  }

  /** Draws once more, by another camera, into a part of the picture: CSS pixels from its upper left corner. */
  renderInto(camera: PerspectiveCamera, { left, top, width, height }: Part, shadowsAnew = false): void {
    const { renderer } = this;
    const bottom = this.host.clientHeight - top - height;
    renderer.setScissorTest(true);
    renderer.setScissor(left, bottom, width, height);
    renderer.setViewport(left, bottom, width, height);
    renderer.shadowMap.autoUpdate = shadowsAnew;
    renderer.render(this.scene, camera);
    renderer.shadowMap.autoUpdate = true;
    renderer.setScissorTest(false);
    renderer.setViewport(0, 0, this.host.clientWidth, this.host.clientHeight);
  }

  /** Shifts the picture up by a share of its height. */
  setLift(share: number): void {
    if (share === this.lift) return;
    this.lift = share;
    this.frame();
    this.camera.updateProjectionMatrix();
  }

  private createRenderer(quality: Quality): WebGLRenderer {
    const renderer = new WebGLRenderer({ antialias: quality.antialias, powerPreference: "high-performance" });
    renderer.toneMapping = NeutralToneMapping;
    renderer.localClippingEnabled = true;
    renderer.shadowMap.type = PCFShadowMap;
    renderer.domElement.className = "view";
    renderer.domElement.setAttribute("aria-hidden", "true");
    this.host.prepend(renderer.domElement);
    return renderer;
  }

  private setUpShadows(): void {
    const { shadow } = this.sun;
    shadow.mapSize.set(SHADOW_PIXELS, SHADOW_PIXELS);
    shadow.camera.left = shadow.camera.bottom = -SHADOW_EXTENT;
    shadow.camera.right = shadow.camera.top = SHADOW_EXTENT;
    shadow.camera.near = 4;
    shadow.camera.far = SUN_DISTANCE * 2;
    shadow.bias = -0.0004;
    shadow.normalBias = 0.02;
    shadow.radius = 4;
  }

  private apply(quality: Quality): void {
    this.renderer.setPixelRatio(quality.pixelRatio);
    this.renderer.shadowMap.enabled = quality.shadows;
    this.sun.castShadow = quality.shadows;
    if (quality.rich && !this.room) this.room = roomTexture(this.renderer);
    this.scene.environment = quality.rich ? this.room : null;
    this.renderer.toneMappingExposure = this.palette.exposure;
    this.fill.intensity = quality.rich ? 0.05 : 0.75;
  }

  /** Keeps the middle of the picture clear of a panel that covers `pixels` at the right. */
  setCoveredRight(pixels: number): void {
    this.coveredRight = pixels;
    this.resize();
  }

  private resize(): void {
    const width = Math.max(1, this.host.clientWidth);
    const height = Math.max(1, this.host.clientHeight);
    this.frame();
    this.camera.aspect = width / height;
    this.camera.fov = width < height ? FIELD_OF_VIEW + 14 : FIELD_OF_VIEW;
    this.camera.updateProjectionMatrix();
    this.renderer.setSize(width, height, false);
  }

  private frame(): void {
    const width = Math.max(1, this.host.clientWidth);
    const height = Math.max(1, this.host.clientHeight);
    const lift = this.lift * (width < height ? LIFT_UPRIGHT : 1) * height;
    this.camera.setViewOffset(width, height, this.coveredRight / 2, lift, width, height);
  }
}

function roomTexture(renderer: WebGLRenderer): Texture {
  const generator = new PMREMGenerator(renderer);
  const { texture } = generator.fromScene(new RoomEnvironment(), 0.04);
  generator.dispose();
  return texture;
}
