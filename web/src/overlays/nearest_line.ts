/** The shortest line between the body and the obstacles, with its length in a label on the page. */

import { CylinderGeometry, Group, Mesh, MeshBasicMaterial, SphereGeometry, Vector3, type PerspectiveCamera } from "three";
import { nearestOnBox, type PreparedBox } from "../camera/spring_arm";
import { lengthWords } from "../texts/length";
import { worded } from "../texts/worded";
import { nearestOnSegment } from "./touching";

const UP = new Vector3(0, 1, 0);
const FAR_FROM_VIEW = 1;

export class NearestLine {
  readonly group = new Group();
  private readonly material: MeshBasicMaterial;
  private readonly bar: Mesh;
  private readonly dots: [Mesh, Mesh];
  private readonly middle = new Vector3();

  constructor(color: number, private readonly label: HTMLElement) {
    this.material = new MeshBasicMaterial({ color, depthTest: false, transparent: true, toneMapped: false });
    this.bar = new Mesh(new CylinderGeometry(0.006, 0.006, 1, 8), this.material);
    const dot = new SphereGeometry(0.016, 12, 8);
    this.dots = [new Mesh(dot, this.material), new Mesh(dot, this.material)];
    this.group.renderOrder = 7;
    this.group.add(this.bar, ...this.dots);
    this.hide();
  }

  hide(): void {
    this.group.visible = false;
    this.label.hidden = true;
  }

  /** Shows the line between capsule `i` of `segments` and the box. */
  show(box: PreparedBox, segments: ArrayLike<number>, i: number, radius: number): void {
    const at = 6 * i;
    const { share } = nearestOnSegment(box, segments, at);
    const along = (k: number) => (segments[at + k] ?? 0) + ((segments[at + k + 3] ?? 0) - (segments[at + k] ?? 0)) * share;
    const core = new Vector3(along(0), along(1), along(2));
    const onBox = new Vector3(...nearestOnBox(box, core.x, core.y, core.z));
    const toBox = onBox.clone().sub(core);
    const gap = toBox.length() - radius;
    const onBody = core.clone().add(toBox.setLength(Math.min(radius, toBox.length())));
    this.dots[0].position.copy(onBody);
    this.dots[1].position.copy(onBox);
    this.middle.addVectors(onBody, onBox).multiplyScalar(0.5);
    this.bar.position.copy(this.middle);
    const line = onBox.sub(onBody);
    const length = line.length();
    this.bar.quaternion.setFromUnitVectors(UP, length > 1e-6 ? line.divideScalar(length) : UP);
    this.bar.scale.y = Math.max(length, 1e-4);
    this.group.visible = true;
    this.label.textContent = gap < 0 ? worded("touching") : lengthWords(gap, gap < 0.1 ? 1 : 0);
    this.label.classList.toggle("touching", gap < 0);
  }

  /** Moves the label to where the line is on the screen. */
  placeLabel(camera: PerspectiveCamera, width: number, height: number): void {
    const seen = this.middle.clone().project(camera);
    this.label.hidden = !this.group.visible || seen.z > FAR_FROM_VIEW;
    this.label.style.translate = `${((seen.x + 1) / 2) * width}px ${((1 - seen.y) / 2) * height}px`;
  }

  dispose(): void {
    this.hide();
    this.group.removeFromParent();
    this.bar.geometry.dispose();
    this.dots[0].geometry.dispose();
    this.material.dispose();
  }
}
