import { type Camera, Matrix4 } from "three";
import type { Poses } from "./poses";

const afterInput = 500; // [ms] for which an input may change the picture
const invisible = 1e-6; // [m], or change of a unit vector: the camera's rounding errors differ in each picture
const betweenPictures = 250; // [ms] while nothing seems to move

/** Tells when the next picture would be the one that is shown, so that drawing it again is left out mostly. */
export class Stillness {
  private lastInput = performance.now();
  private isMoving = true;
  private lastFrame: Poses["frame"];
  private readonly lastView = new Matrix4();

  /** Takes note of an input, or of another size. */
  touch(): void {
    this.lastInput = performance.now();
  }

  /**
   * Returns whether a picture is due `now`, if the last one was drawn at `lastDrawn`. An image that has arrived shows
   * with the next picture of a still page, since neither poses nor the camera nor an input tell of it.
   */
  isDue(now: number, lastDrawn: number, poses: Poses | undefined): boolean {
    const isNew = this.isMoving || poses?.frame !== this.lastFrame || now - this.lastInput < afterInput;
    return isNew || Math.abs(now - lastDrawn) >= betweenPictures;
  }

  /** Takes note of what was drawn. */
  take(poses: Poses | undefined, camera: Camera): void {
    const view = camera.matrixWorld.elements;
    const isTurning = this.lastView.elements.some((each, i) => Math.abs(each - view[i]) > invisible);
    this.isMoving = (poses?.blend ?? 1) < 1 || isTurning;
    this.lastFrame = poses?.frame;
    this.lastView.copy(camera.matrixWorld);
  }
}
