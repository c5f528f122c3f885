// SPDX-License-Identifier: Apache-2.0
import type { Quaternion, Vector3 } from "three";
import type { Scene, SceneFrame } from "../data/messages";

const full = 32767;
const farAway = 1e9; // [m]; place of hidden entities, which is never drawn
const longestBlend = 250; // [ms]

/** The poses of a scene's links, interpolated between the last two frames. */
export class Poses {
  positions: Float32Array = new Float32Array();
  orientations: Int16Array = new Int16Array();
  positionsBefore: Float32Array = new Float32Array();
  orientationsBefore: Int16Array = new Int16Array();
  /** Entities that are not drawn because they are not in the world or are hidden. */
  absent = new Set<number>();
  frame: SceneFrame | undefined;
  /** 0 at the previous frame, 1 at the last one. */
  blend = 1;

  private hidden: ReadonlySet<number> = new Set();
  private readonly firstOfLink: number[][] = [];
  private readonly placeInModel: number[] = [];
  private readonly entitiesOfModel: number[][];
  private readonly linkCount: number;
  private arrival = 0;
  private interval = 33;

  constructor(readonly scene: Scene) {
    this.entitiesOfModel = scene.models.map(() => []);
    scene.entities.forEach(({ model }, entity) => {
      this.placeInModel.push(this.entitiesOfModel[model].length);
      this.entitiesOfModel[model].push(entity);
    });
    let next = 0;
    scene.models.forEach((model, index) => {
      this.firstOfLink.push(
        model.links.map(() => {
          const first = next;
          next += this.entitiesOfModel[index].length;
          return first;
        }),
      );
    });
    this.linkCount = next;
  }

  entitiesOf(model: number): readonly number[] {
    return this.entitiesOfModel[model];
  }
  firstPlace(model: number, link: number): number {
    return this.firstOfLink[model][link];
  }
  /** Returns the index of an entity's link among all links of a frame. */
  placeOf(entity: number, link = 0): number {
    return this.firstOfLink[this.scene.entities[entity].model][link] + this.placeInModel[entity];
  }

  /** Takes a frame. Returns false if the frame belongs to another scene. */
  take(frame: SceneFrame, now: number): boolean {
    if (frame.revision !== this.scene.revision || frame.positions.length !== 3 * this.linkCount) return false;
    const elapsed = now - this.arrival;
    const goesOn = this.frame !== undefined && frame.tick > this.frame.tick && elapsed < longestBlend;
    this.arrival = now;
    if (goesOn) this.interval += 0.2 * (elapsed - this.interval);
    const positions = this.withoutAbsent(frame);
    this.positionsBefore = goesOn ? this.positions : positions;
    this.orientationsBefore = goesOn ? this.orientations : frame.orientations;
    this.positions = positions;
    this.orientations = frame.orientations;
    this.frame = frame;
    this.blend = 1;
    return true;
  }

  advance(now: number): void {
    // The time of a picture may be earlier than the arrival of the frame.
    this.blend = Math.min(1, Math.max(0, now - this.arrival) / Math.max(1, this.interval));
  }

  /** Reads the drawn pose of a link by its index; with a `blend` of 1, the server's last pose. */
  read(place: number, position: Vector3, orientation: Quaternion, blend = this.blend): void {
    const p = 3 * place;
    const q = 4 * place;
    const { positions: a, positionsBefore: b, orientations: c, orientationsBefore: d } = this;
    const mix = (now: number, before: number): number => before + blend * (now - before);
    position.set(mix(a[p], b[p]), mix(a[p + 1], b[p + 1]), mix(a[p + 2], b[p + 2]));
    const dot = c[q] * d[q] + c[q + 1] * d[q + 1] + c[q + 2] * d[q + 2] + c[q + 3] * d[q + 3];
    const sign = dot < 0 ? -1 : 1;
    orientation
      .set(
        mix(sign * c[q], d[q]) / full,
        mix(sign * c[q + 1], d[q + 1]) / full,
        mix(sign * c[q + 2], d[q + 2]) / full,
        mix(sign * c[q + 3], d[q + 3]) / full,
      )
      .normalize();
  }

  /** Hides these entities from now on. */
  hide(entities: ReadonlySet<number>): void {
    this.hidden = entities;
    if (this.frame) this.positions = this.positionsBefore = this.withoutAbsent(this.frame);
  }

  private withoutAbsent(frame: SceneFrame): Float32Array {
    this.absent = new Set([...frame.absent, ...this.hidden]);
    if (this.absent.size === 0) return frame.positions;
    const positions = frame.positions.slice();
    for (const entity of this.absent) {
      const links = this.scene.models[this.scene.entities[entity].model].links.length;
      for (let link = 0; link < links; ++link)
        positions.fill(farAway, 3 * this.placeOf(entity, link), 3 * this.placeOf(entity, link) + 3);
    }
    return positions;
  }
}
