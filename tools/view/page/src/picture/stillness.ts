// SPDX-License-Identifier: Apache-2.0
import { type Camera, Matrix4 } from "three";
import type { Poses } from "./poses";

const afterInput = 500; // [ms] during which an input may change the picture
const invisible = 1e-6; // [m], or change of a unit vector: the camera's rounding errors differ in each picture
const betweenPictures = 250; // [ms] while nothing seems to move

/** Detects that nothing moves, so that most pictures, which would equal the shown one, need not be drawn. */
export class Stillness {
  private lastInput = performance.now();
  private isMoving = true;
  private lastFrame: Poses["frame"];
  private readonly lastView = new Matrix4();

  /** Records an input, or a change of the size. */
  touch(): void {
    this.lastInput = performance.now();
  }

  /**
   * Returns whether a picture is due `now`, if the last one was drawn at `lastDrawn`. An image that has been decoded
   * appears with the next picture, because it changes neither poses nor the camera.
   */
  isDue(now: number, lastDrawn: number, poses: Poses | undefined): boolean {
    const isNew = this.isMoving || poses?.frame !== this.lastFrame || now - this.lastInput < afterInput;
    return isNew || Math.abs(now - lastDrawn) >= betweenPictures;
  }

  /** Records the drawn poses and the camera. */
  take(poses: Poses | undefined, camera: Camera): void {
    const view = camera.matrixWorld.elements;
    const isTurning = this.lastView.elements.some((each, i) => Math.abs(each - view[i]) > invisible);
    this.isMoving = (poses?.blend ?? 1) < 1 || isTurning;
    this.lastFrame = poses?.frame;
    this.lastView.copy(camera.matrixWorld);
  }
}
