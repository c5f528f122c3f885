// SPDX-License-Identifier: Apache-2.0
import { Box3, type Matrix4, Vector3 } from "three";

/** The position of a camera, and the point at which it looks. */
export interface View {
  position: Vector3;
  target: Vector3;
}

/** The shape of a camera's picture: tangents of half the angles of view. */
export interface Lens {
  horizontal: number;
  vertical: number;
}

export const lensOf = (fov: number, aspect: number): Lens => {
  const vertical = Math.tan((fov * Math.PI) / 360);
  return { vertical, horizontal: vertical * aspect };
};

const narrowings = 14; // number of bisections, for a precision of 1e-4 of the picture

/** The unit vectors of a camera that looks along a direction. */
interface Axes {
  right: Vector3;
  up: Vector3;
  ahead: Vector3;
}

function axesAlong(direction: Vector3): Axes {
  const ahead = direction.clone().normalize();
  const right = ahead.clone().cross(new Vector3(0, 0, 1));
  if (right.lengthSq() < 1e-12) right.set(1, 0, 0);
  right.normalize();
  return { right, up: right.clone().cross(ahead), ahead };
}

// Returns the maximum coordinate of boxes along a direction.
function reach(boxes: readonly Box3[], { x, y, z }: Vector3): number {
  let most = -Infinity;
  for (const { min, max } of boxes)
    most = Math.max(most, x * (x > 0 ? max.x : min.x) + y * (y > 0 ? max.y : min.y) + z * (z > 0 ? max.z : min.z));
  return most;
}

/**
 * The distance before the origin at which two opposite edges of the picture touch the boxes, and the middle between the
 * edges.
 */
interface Touch {
  depth: number;
  middle: number;
}

function touch(boxes: readonly Box3[], axis: Vector3, ahead: Vector3, tangent: number): Touch {
  const edge = (sign: number): number =>
    reach(boxes, axis.clone().multiplyScalar(sign).addScaledVector(ahead, -tangent));
  const [high, low] = [edge(1), edge(-1)];
  return { depth: -(high + low) / (2 * tangent), middle: 0.5 * (high - low) };
}

// Returns the middle for a camera that is farther back than where the edges touch: that between narrower edges, which
// touch there.
function middleAt(boxes: readonly Box3[], axis: Vector3, ahead: Vector3, tangent: number, depth: number): number {
  let [low, high] = [0, tangent];
  for (let i = 0; i < narrowings; ++i) {
    const between = 0.5 * (low + high);
    if (touch(boxes, axis, ahead, between).depth < depth) low = between;
    else high = between;
  }
  return touch(boxes, axis, ahead, high).middle;
}

/**
 * Returns the nearest view along `direction` that shows all boxes in the middle of the picture. `margin` is the
 * fraction of each half of the picture that stays free, from 0 to less than 1.
 *
 * Let x, y and z be coordinates to the right, upwards and ahead. A camera at (a, b, c) sees a point if |x - a| and
 * |y - b| are at most (z - c) times the tangent of half the angle of view. So each edge of the picture is a plane with
 * a fixed normal. The box that reaches farthest beyond it places the plane, and opposite planes meet at the camera.
 */
export function fit(boxes: readonly Box3[], direction: Vector3, lens: Lens, margin: number): View {
  const { right, up, ahead } = axesAlong(direction);
  const across = lens.horizontal * (1 - margin);
  const along = lens.vertical * (1 - margin);
  const depth = Math.min(touch(boxes, right, ahead, across).depth, touch(boxes, up, ahead, along).depth);
  const position = ahead
    .clone()
    .multiplyScalar(depth)
    .addScaledVector(right, middleAt(boxes, right, ahead, across, depth))
    .addScaledVector(up, middleAt(boxes, up, ahead, along, depth));
  const centre = unionOf(boxes).getCenter(new Vector3());
  const distance = Math.max(0.1, centre.sub(position).dot(ahead));
  return { position, target: position.clone().addScaledVector(ahead, distance) };
}

/** Returns whether a view shows all boxes with a margin, as defined in `fit`. */
export function shows(boxes: readonly Box3[], { position, target }: View, lens: Lens, margin: number): boolean {
  const { right, up, ahead } = axesAlong(target.clone().sub(position));
  const isWithin = (axis: Vector3, sign: number, tangent: number): boolean => {
    const normal = axis.clone().multiplyScalar(sign).addScaledVector(ahead, -tangent);
    return reach(boxes, normal) <= normal.dot(position) + 1e-9;
  };
  const across = lens.horizontal * (1 - margin);
  const along = lens.vertical * (1 - margin);
  return isWithin(right, 1, across) && isWithin(right, -1, across) && isWithin(up, 1, along) && isWithin(up, -1, along);
}

export function unionOf(boxes: readonly Box3[]): Box3 {
  const whole = new Box3();
  for (const each of boxes) whole.union(each);
  return whole;
}

/** Grows `box` by a link's box, which is transformed by a matrix. */
export function growBy(box: Box3, part: Box3, matrix: Matrix4): void {
  const { elements: e } = matrix;
  const { min, max } = part;
  const [x, y, z] = [0.5 * (min.x + max.x), 0.5 * (min.y + max.y), 0.5 * (min.z + max.z)];
  const [a, b, c] = [0.5 * (max.x - min.x), 0.5 * (max.y - min.y), 0.5 * (max.z - min.z)];
  for (let axis = 0; axis < 3; ++axis) {
    const middle = e[axis] * x + e[4 + axis] * y + e[8 + axis] * z + e[12 + axis];
    const half = Math.abs(e[axis]) * a + Math.abs(e[4 + axis]) * b + Math.abs(e[8 + axis]) * c;
    box.min.setComponent(axis, Math.min(box.min.getComponent(axis), middle - half));
    box.max.setComponent(axis, Math.max(box.max.getComponent(axis), middle + half));
  }
}

const marginOf = (count: number): number => (count <= 2 ? 0.35 : 0.08); // margin of a new view
const leastMargin = 0.03; // with a smaller margin, a new view is chosen
const mostRoom = 1.6; // above this ratio of distances, a new view is chosen too
const easing = 0.35; // [s]
const hurriedEasing = 0.08; // [s] while something is outside the picture

/** Keeps boxes in the picture until the user moves the camera. */
export class Keeper {
  isOn = false;
  private goal: View | undefined;
  private direction = new Vector3(0, 1, -1);
  private isOut = false;

  /** Returns the view that shows all boxes now, and keeps them in it from now on. */
  begin(boxes: readonly Box3[], direction: Vector3, lens: Lens): View {
    this.isOn = true;
    this.isOut = false;
    this.direction = direction.clone();
    this.goal = fit(boxes, direction, lens, marginOf(boxes.length));
    return this.goal;
  }
  end(): void {
    this.isOn = false;
    this.goal = undefined;
  }

  /** Chooses a new view if the boxes leave the present one or become small in it. */
  watch(boxes: readonly Box3[], now: View, lens: Lens): void {
    if (!this.isOn || !this.goal) return;
    this.isOut = !shows(boxes, now, lens, 0);
    const wanted = fit(boxes, this.direction, lens, marginOf(boxes.length));
    const centre = unionOf(boxes).getCenter(new Vector3());
    const room = this.goal.position.distanceTo(centre) / Math.max(1e-6, wanted.position.distanceTo(centre));
    if (!shows(boxes, this.goal, lens, leastMargin) || room > mostRoom) this.goal = wanted;
  }

  /** Moves a view towards the chosen one; returns whether it has moved. */
  follow(view: View, elapsed: number, isGradual: boolean): boolean {
    if (!this.isOn || !this.goal) return false;
    const apart = view.position.distanceTo(this.goal.position);
    if (apart < 1e-6) return false;
    const isThere = apart < 1e-4 * this.goal.position.distanceTo(this.goal.target);
    const share = isGradual && !isThere ? 1 - Math.exp(-elapsed / (this.isOut ? hurriedEasing : easing)) : 1;
    view.position.lerp(this.goal.position, share);
    view.target.lerp(this.goal.target, share);
    return true;
  }
}
