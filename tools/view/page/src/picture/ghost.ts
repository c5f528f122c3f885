// SPDX-License-Identifier: Apache-2.0
import { Group, Mesh, MeshStandardMaterial, Quaternion, Vector3 } from "three";
import { type Scene, ShapeRole } from "../data/messages";
import { linkGeometry, matrixOf } from "./shapes";

/** A translucent preview of an object at its future place. */
export class Ghost {
  readonly group = new Group();
  private readonly material = new MeshStandardMaterial({
    color: 0x1f8fff,
    transparent: true,
    opacity: 0.45,
    depthWrite: false,
  });
  private model = -1;
  private scene: Scene | undefined;

  constructor() {
    this.hide();
  }

  /** Shows the model with its origin at `place`, turned about the vertical by `heading` [rad]. */
  show(scene: Scene, model: number, place: readonly number[], heading: number): void {
    if (scene !== this.scene || model !== this.model) this.build(scene, model);
    this.group.position.set(place[0], place[1], place[2]);
    this.group.rotation.set(0, 0, heading);
    this.group.visible = true;
  }
  hide(): void {
    this.group.visible = false;
  }

  private build(scene: Scene, model: number): void {
    for (const child of this.group.children as Mesh[]) child.geometry.dispose();
    this.group.clear();
    for (const link of scene.models[model].links) {
      const geometry = linkGeometry(
        scene,
        link.shapes.filter(({ role }) => role !== ShapeRole.collision),
        1,
      );
      if (!geometry) continue;
      geometry.deleteAttribute("color");
      this.group.add(new Mesh(geometry.applyMatrix4(matrixOf(link.pose)), this.material));
    }
    this.scene = scene;
    this.model = model;
  }
}

/** Returns the height of a model's origin above the ground when it stands upright [m]. */
export function standingHeight(scene: Scene, model: number): number {
  let lowest = Infinity;
  for (const link of scene.models[model].links) {
    const geometry = linkGeometry(
      scene,
      link.shapes.filter(({ role }) => role !== ShapeRole.visual),
      1,
    );
    if (!geometry) continue;
    geometry.applyMatrix4(matrixOf(link.pose)).computeBoundingBox();
    lowest = Math.min(lowest, geometry.boundingBox?.min.z ?? Infinity);
    geometry.dispose();
  }
  return Number.isFinite(lowest) ? -lowest : 0;
}

/** Returns the position of a model's origin and its heading, given the pose of its root link. */
export function originOf(
  scene: Scene,
  model: number,
  position: Vector3,
  turn: Quaternion,
): { place: number[]; heading: number } {
  const [x, y, z, ...part] = scene.models[model].links[0].pose;
  const ofModel = turn.clone().multiply(new Quaternion(...(part as [number, number, number, number])).invert());
  const origin = position.clone().sub(new Vector3(x, y, z).applyQuaternion(ofModel));
  const forward = new Vector3(1, 0, 0).applyQuaternion(ofModel);
  return { place: origin.toArray(), heading: Math.atan2(forward.y, forward.x) };
}
