import { type PerspectiveCamera, Quaternion, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import type { Poses } from "./poses";

export type CameraMode = "orbit" | "follow" | "top" | "eye" | "fly";
export interface Viewpoint {
  position: number[];
  target: number[];
}

const eyeHeight = 0.05; // [m] above the root link's origin
const flySpeed = 1.5; // [m/s]

/** Where people look from. */
export class Cameras {
  readonly controls: OrbitControls;
  mode: CameraMode = "orbit";
  /** Keys that are held and fly the camera: forward, back, left, right, up, down. */
  readonly held = new Set<string>();
  private followed: number | undefined;
  private readonly at = new Vector3();
  private readonly before = new Vector3();
  private readonly turn = new Quaternion();
  private isFirst = true;

  constructor(
    private readonly camera: PerspectiveCamera,
    canvas: HTMLCanvasElement,
  ) {
    this.controls = new OrbitControls(camera, canvas);
    this.controls.enableDamping = true;
    this.controls.dampingFactor = 0.12;
    this.controls.maxPolarAngle = Math.PI * 0.495;
    this.controls.minDistance = 0.05;
    this.controls.maxDistance = 400;
    this.controls.zoomToCursor = true;
  }

  get target(): Vector3 {
    return this.controls.target;
  }
  get followedEntity(): number | undefined {
    return this.mode === "follow" || this.mode === "eye" ? this.followed : undefined;
  }

  choose(mode: CameraMode, entity?: number): void {
    this.mode = mode;
    this.followed = entity;
    this.isFirst = true;
    this.controls.enabled = mode !== "eye";
    this.controls.enableRotate = mode !== "top";
    if (mode === "top") {
      const height = Math.max(1, this.camera.position.distanceTo(this.target));
      this.camera.position.copy(this.target).add(new Vector3(0, -1e-3, height));
    }
  }

  /** Looks at everything that is there. */
  frame(centre: Vector3, radius: number): void {
    const distance = (0.86 * radius) / Math.tan((this.camera.fov * Math.PI) / 360);
    this.target.copy(centre);
    this.camera.position.copy(centre).add(new Vector3(0.28, -0.78, 0.62).normalize().multiplyScalar(distance));
    this.controls.update();
  }

  viewpoint(): Viewpoint {
    return { position: this.camera.position.toArray(), target: this.target.toArray() };
  }
  look({ position, target }: Viewpoint): void {
    this.choose("orbit");
    this.camera.position.fromArray(position);
    this.target.fromArray(target);
    this.controls.update();
  }

  advance(poses: Poses | undefined, elapsed: number): void {
    if (poses?.frame && this.followedEntity !== undefined) this.move(poses, this.followedEntity);
    if (this.mode === "fly") this.fly(elapsed);
    if (this.mode !== "eye") this.controls.update();
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
    if (!this.isFirst) this.camera.position.add(this.at).sub(this.before);
    else this.camera.position.add(this.at).sub(this.target);
    this.target.copy(this.at);
    this.before.copy(this.at);
    this.isFirst = false;
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
