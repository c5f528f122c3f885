// SPDX-License-Identifier: Apache-2.0
import { Box3, Matrix4, Quaternion, Vector3 } from "three";
import { none } from "../data/messages";
import { growBy, unionOf } from "./framing";
import type { Instances } from "./instances";
import type { Poses } from "./poses";

const mostOfStatic = 4; // largest ratio of the world's size to its movable part's, at which all is shown

/** Boxes around the bodies of a scene, computed from the drawn geometry. */
export class Bounds {
  /** The boxes of all bodies at the last call of `boxes`. */
  all: readonly Box3[] = [];
  private readonly boxesOfModel = new Map<number, { link: number; box: Box3 }[]>();
  private readonly matrix = new Matrix4();
  private readonly position = new Vector3();
  private readonly orientation = new Quaternion();

  constructor(
    private readonly poses: Poses,
    instances: Instances,
  ) {
    for (const { model, link, geometry } of instances.links) {
      if (!geometry.boundingBox) geometry.computeBoundingBox();
      if (!geometry.boundingBox) continue;
      const known = this.boxesOfModel.get(model) ?? [];
      known.push({ link, box: geometry.boundingBox });
      this.boxesOfModel.set(model, known);
    }
  }

  /** Returns the box around an entity as it is drawn; undefined if it is absent or has no shapes. */
  boxOf(entity: number): Box3 | undefined {
    const { poses } = this;
    const parts = this.boxesOfModel.get(poses.scene.entities[entity].model);
    if (!parts || poses.absent.has(entity)) return undefined;
    const box = new Box3();
    for (const { link, box: part } of parts) {
      poses.read(poses.placeOf(entity, link), this.position, this.orientation, 1);
      growBy(box, part, this.matrix.compose(this.position, this.orientation, unit));
    }
    return box;
  }

  /** Returns boxes around robots, movable objects and lamps, and around static objects unless these are much larger. */
  boxes(): Box3[] {
    const { scene, absent } = this.poses;
    const moving: Box3[] = [];
    const standing: Box3[] = [];
    scene.entities.forEach(({ model, robot }, entity) => {
      const box = this.boxOf(entity);
      if (box) (robot !== none || !scene.models[model].is_static ? moving : standing).push(box);
    });
    for (const { entity, link } of scene.lamps) {
      if (absent.has(entity)) continue;
      this.poses.read(link, this.position, this.orientation, 1);
      moving.push(new Box3(this.position.clone(), this.position.clone()));
    }
    const all = [...moving, ...standing];
    this.all = all;
    if (moving.length === 0 || standing.length === 0) return all;
    const size = (boxes: readonly Box3[]): number => unionOf(boxes).getSize(new Vector3()).length();
    return size(all) > mostOfStatic * size(moving) ? moving : all;
  }
}

const unit = new Vector3(1, 1, 1);
