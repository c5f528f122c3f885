// SPDX-License-Identifier: Apache-2.0
import { type Box3, type PerspectiveCamera, Quaternion, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { Keeper, type Lens, lensOf, unionOf } from "./framing";
import type { Poses } from "./poses";

export type CameraMode = "orbit" | "follow" | "top" | "eye" | "fly";
export interface Viewpoint {
  position: number[];
  target: number[];
}

const eyeHeight = 0.05; // [m] above the root link's origin
const flySpeed = 1.5; // [m/s]
const longestFlight = 0.1; // [s] between two pictures
const fromAbove = new Vector3(0, 1e-3, -1);
const heading = 0.35; // [rad] of the first view, to the left of the y axis
const elevations = [15, 22]; // [degrees] of the first view, for tall and for flat worlds
const hasReducedMotion = matchMedia("(prefers-reduced-motion: reduce)");

/** The camera and its modes. */
export class Cameras {
  readonly controls: OrbitControls;
  mode: CameraMode = "orbit";
  /** Keys that are held and fly the camera: forward, back, left, right, up, down. */
  readonly held = new Set<string>();
  /** Returns true while the camera must not move, such as while the user aims. */
  isHeld: () => boolean = () => false;
  private followed: number | undefined;
  private group: readonly number[] = []; // further entities that are followed
  private readonly at = new Vector3();
  private readonly before = new Vector3();
  private readonly turn = new Quaternion();
  private isFirst = true;
  private readonly keeper = new Keeper();
  private boxes: readonly Box3[] = [];
  private grabbed: Vector3[] | undefined; // the positions of the camera and its target when the user grabbed it

  constructor(
    private readonly camera: PerspectiveCamera,
    canvas: HTMLCanvasElement,
  ) {
    this.controls = new OrbitControls(camera, canvas);
    this.controls.enableDamping = true;
    this.controls.dampingFactor = 0.12;
    this.controls.maxPolarAngle = Math.PI * 0.495;
    this.controls.minDistance = 0.05;
    this.controls.maxDistance = 2000;
    this.controls.zoomToCursor = true;
    this.controls.addEventListener("start", () => {
      this.grabbed = [camera.position.clone(), this.target.clone()];
    });
    this.controls.addEventListener("end", () => {
      this.letGo();
      this.grabbed = undefined;
    });
    canvas.addEventListener("wheel", () => this.keeper.end(), { passive: true });
  }

  /** Returns true while the camera keeps everything in the picture. */
  get keepsAll(): boolean {
    return this.keeper.isOn;
  }

  get target(): Vector3 {
    return this.controls.target;
  }
  get followedEntity(): number | undefined {
    return this.mode === "follow" || this.mode === "eye" ? this.followed : undefined;
  }

  /** Chooses the mode. The camera follows the centre of the entities of `group`; by default, `entity` alone. */
  choose(mode: CameraMode, entity?: number, group: readonly number[] = []): void {
    const before = this.mode;
    this.mode = mode;
    this.followed = entity;
    this.group = group;
    this.isFirst = true;
    this.controls.enabled = mode !== "eye";
    this.controls.enableRotate = mode !== "top";
    if (mode !== "orbit" && mode !== "top") this.keeper.end();
    else if (this.keeper.isOn && mode !== before) this.home(this.boxes);
    else if (mode === "top") {
      const height = Math.max(1, this.camera.position.distanceTo(this.target));
      this.camera.position.copy(this.target).add(new Vector3(0, -1e-3, height));
    }
  }

  /**
   * Shows all boxes, from above if the camera looks from above, and keeps them in the picture until the user moves the
   * camera.
   */
  home(boxes: readonly Box3[]): void {
    if (boxes.length === 0) return;
    this.boxes = boxes;
    if (this.mode !== "top" && this.mode !== "orbit") this.choose("orbit");
    const direction = this.mode === "top" ? fromAbove : firstDirection(boxes);
    const { position, target } = this.keeper.begin(boxes, direction, this.lens);
    this.camera.position.copy(position);
    this.target.copy(target);
    this.controls.update();
  }

  /** Called with the present boxes, and when the shape of the picture has changed. */
  watch(boxes: readonly Box3[]): void {
    this.boxes = boxes;
    this.keeper.watch(boxes, { position: this.camera.position, target: this.target }, this.lens);
  }

  viewpoint(): Viewpoint {
    return { position: this.camera.position.toArray(), target: this.target.toArray() };
  }
  look({ position, target }: Viewpoint): void {
    this.keeper.end();
    this.choose("orbit");
    this.camera.position.fromArray(position);
    this.target.fromArray(target);
    this.controls.update();
  }

  advance(poses: Poses | undefined, elapsed: number): void {
    if (poses?.frame && this.followedEntity !== undefined) this.move(poses, this.followedEntity);
    if (this.mode === "fly") this.fly(Math.min(longestFlight, elapsed));
    this.letGo();
    if (this.grabbed === undefined && !this.isHeld())
      this.keeper.follow({ position: this.camera.position, target: this.target }, elapsed, !hasReducedMotion.matches);
    if (this.mode !== "eye") this.controls.update();
  }

  private get lens(): Lens {
    return lensOf(this.camera.fov, this.camera.aspect);
  }

  // If the user has not moved the camera, it stays in its automatic mode.
  private letGo(): void {
    if (!this.grabbed) return;
    const [position, target] = this.grabbed;
    if (position.distanceTo(this.camera.position) + target.distanceTo(this.target) > 1e-6) this.keeper.end();
  }

  private move(poses: Poses, entity: number): void {
    poses.read(poses.placeOf(entity), this.at, this.turn);
    if (this.mode === "eye") {
      const forward = new Vector3(1, 0, 0).applyQuaternion(this.turn);
      this.camera.position
        .copy(this.at)
        .add(new Vector3(0, 0, eyeHeight))
        .addScaledVector(forward, 0.06);
      this.camera.lookAt(this.camera.position.clone().add(forward));
      this.target.copy(this.at);
      return;
    }
    this.takeMiddle(poses);
    if (!this.isFirst) this.camera.position.add(this.at).sub(this.before);
    else this.camera.position.add(this.at).sub(this.target);
    this.target.copy(this.at);
    this.before.copy(this.at);
    this.isFirst = false;
  }

  private takeMiddle(poses: Poses): void {
    const present = this.group.filter((each) => !poses.absent.has(each));
    if (present.length < 2) return;
    const [each, sum] = [new Vector3(), new Vector3()];
    for (const entity of present) {
      poses.read(poses.placeOf(entity), each, this.turn);
      sum.add(each);
    }
    this.at.copy(sum.divideScalar(present.length));
  }

  private fly(elapsed: number): void {
    const forward = this.target.clone().sub(this.camera.position).normalize();
    const right = forward.clone().cross(this.camera.up).normalize();
    const step = new Vector3();
    const along = (key: string, direction: Vector3, sign: number): void => {
      if (this.held.has(key)) step.addScaledVector(direction, sign);
    };
    along("forward", forward, 1);
    along("back", forward, -1);
    along("right", right, 1);
    along("left", right, -1);
    along("up", this.camera.up, 1);
    along("down", this.camera.up, -1);
    step.multiplyScalar(flySpeed * elapsed);
    this.camera.position.add(step);
    this.target.add(step);
  }
}

// Returns the direction of the first view: from higher up for flat worlds, and with the horizon behind tall ones.
function firstDirection(boxes: readonly Box3[]): Vector3 {
  const { x, y, z } = unionOf(boxes).getSize(new Vector3());
  const flatness = Math.min(1, Math.hypot(x, y) / Math.max(1e-6, 12 * z));
  const elevation = (Math.PI / 180) * (elevations[0] + flatness * (elevations[1] - elevations[0]));
  const ahead = Math.cos(elevation);
  return new Vector3(-ahead * Math.sin(heading), ahead * Math.cos(heading), -Math.sin(elevation));
}
