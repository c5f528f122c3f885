// SPDX-License-Identifier: Apache-2.0
import {
  BufferAttribute,
  BufferGeometry,
  Group,
  Line,
  LineBasicMaterial,
  LineSegments,
  Points,
  PointsMaterial,
  Quaternion,
  Vector3,
} from "three";
import { firstValue } from "../data/channels";
import type { SceneContacts, SceneRobot, SceneSensor } from "../data/messages";
import type { Poses } from "./poses";

const metresPerNewton = 0.02;
const trailLength = 1500; // points
const trailSpacing = 0.01; // [m]
const leastHit = 0.05; // fraction of the range; less may be sensor noise

/** Colours of the overlays, which the legend explains. */
export const overlayColors = { contact: 0xe5484d, grip: 0x30a46c, rayFree: 0x2f8f6b, rayHit: 0xe5484d, lamp: 0xd9a11f };

function segments(color: number, opacity = 1): LineSegments<BufferGeometry, LineBasicMaterial> {
  const lines = new LineSegments(
    new BufferGeometry(),
    new LineBasicMaterial({ color, transparent: opacity < 1, opacity, toneMapped: false }),
  );
  lines.frustumCulled = false;
  return lines;
}

// Reuses the present buffer as long as the points fit.
function setPoints(geometry: BufferGeometry, points: ArrayLike<number>): void {
  let attribute = geometry.getAttribute("position") as BufferAttribute | undefined;
  if (!attribute || attribute.array.length < points.length) {
    geometry.dispose();
    attribute = new BufferAttribute(new Float32Array(2 * points.length + 3 * 64), 3);
    geometry.setAttribute("position", attribute);
  }
  (attribute.array as Float32Array).set(points);
  attribute.needsUpdate = true;
  geometry.setDrawRange(0, points.length / 3);
}

// Draws dots in front of everything, because touching bodies hide their contact points.
function dots(color: number, size: number): Points<BufferGeometry, PointsMaterial> {
  const material = new PointsMaterial({
    color,
    size,
    sizeAttenuation: false,
    depthTest: false,
    transparent: true,
    toneMapped: false,
  });
  return new Points(new BufferGeometry(), material);
}

/** Contact points, contact forces, and grips. */
export class Contacts {
  readonly group = new Group();
  private readonly points = dots(overlayColors.contact, 5);
  private readonly grips = dots(overlayColors.grip, 9);
  private readonly forces = segments(overlayColors.contact);

  constructor() {
    this.points.frustumCulled = this.grips.frustumCulled = false;
    this.group.add(this.points, this.grips, this.forces);
  }

  take({ positions, forces, grips }: SceneContacts): void {
    setPoints(this.points.geometry, positions);
    const lines = new Float32Array(2 * positions.length);
    for (let i = 0; i < positions.length; i += 3) {
      lines.set(positions.subarray(i, i + 3), 2 * i);
      for (let axis = 0; axis < 3; ++axis)
        lines[2 * i + 3 + axis] = positions[i + axis] + metresPerNewton * forces[i + axis];
    }
    setPoints(this.forces.geometry, lines);
    const jaws = new Float32Array((3 * grips.length) / 4);
    for (let i = 0; 4 * i < grips.length; ++i) jaws.set(grips.subarray(4 * i, 4 * i + 3), 3 * i);
    setPoints(this.grips.geometry, jaws);
  }
}

/** Rays of the selected robot's sensors, to the first hit or to their range. */
export class Rays {
  readonly group = new Group();
  private readonly free = segments(overlayColors.rayFree, 0.55);
  private readonly hit = segments(overlayColors.rayHit);

  constructor() {
    this.group.add(this.free, this.hit);
  }

  draw(poses: Poses, robot: SceneRobot | undefined): void {
    const entity = poses.scene.entities.findIndex(({ robot: id }) => id === robot?.robot);
    this.group.visible = robot !== undefined && entity >= 0;
    if (!robot || entity < 0) return;
    const free: number[] = [];
    const hit: number[] = [];
    const model = poses.scene.models[poses.scene.entities[entity].model];
    for (const sensor of model.sensors) {
      if (!(sensor.range > 0)) continue;
      const first = firstValue(model.observation, sensor.channel);
      addRays(
        poses,
        poses.placeOf(entity, sensor.link),
        sensor,
        first === undefined ? [] : robot.observation.subarray(first),
        free,
        hit,
      );
    }
    setPoints(this.free.geometry, free);
    setPoints(this.hit.geometry, hit);
  }
}

/** Returns the length of a ray, given the sensor's reading; the sensor's range if nothing was detected. */
export function rayLength({ kind, range }: Pick<SceneSensor, "kind" | "range">, reading: number | undefined): number {
  if (reading === undefined) return range;
  if (kind === "lidar") return Math.min(range, reading);
  return range * (1 - Math.min(1, Math.max(0, reading)));
}

function addRays(
  poses: Poses,
  place: number,
  sensor: SceneSensor,
  readings: ArrayLike<number>,
  free: number[],
  hit: number[],
): void {
  const origin = new Vector3();
  const turn = new Quaternion();
  poses.read(place, origin, turn);
  const count = sensor.origins.length / 3;
  for (let i = 0; i < count; ++i) {
    const from = new Vector3()
      .fromArray(sensor.origins, 3 * i)
      .applyQuaternion(turn)
      .add(origin);
    const direction = new Vector3().fromArray(sensor.directions, 3 * i).applyQuaternion(turn);
    const length = rayLength(sensor, readings[i]);
    const isHit = length < (1 - leastHit) * sensor.range;
    const to = from.clone().addScaledVector(direction, length);
    (isHit ? hit : free).push(...from.toArray(), ...to.toArray());
  }
}

/** The paths of the selected entity, or of all robots. */
export class Trails {
  readonly group = new Group();
  private readonly trails = new Map<number, { line: Line; points: number[]; last: Vector3 }>();

  clear(): void {
    for (const { line } of this.trails.values()) line.geometry.dispose();
    this.group.clear();
    this.trails.clear();
  }

  add(poses: Poses, entities: readonly number[]): void {
    const at = new Vector3();
    const turn = new Quaternion();
    for (const entity of entities) {
      if (poses.absent.has(entity)) continue;
      poses.read(poses.placeOf(entity), at, turn);
      const trail = this.trails.get(entity) ?? this.begin(entity, entities.length);
      if (trail.last.distanceTo(at) < trailSpacing) continue;
      trail.last.copy(at);
      trail.points.push(at.x, at.y, Math.max(at.z, 0.004));
      if (trail.points.length > 3 * trailLength) trail.points.splice(0, 3);
      setPoints(trail.line.geometry, trail.points);
    }
  }

  private begin(entity: number, count: number): { line: Line; points: number[]; last: Vector3 } {
    const material = new LineBasicMaterial({ transparent: true, opacity: 0.8, toneMapped: false });
    material.color.setHSL((entity % Math.max(1, count)) / Math.max(1, count), 0.6, 0.5);
    const line = new Line(new BufferGeometry(), material);
    line.frustumCulled = false;
    this.group.add(line);
    const trail = { line, points: [], last: new Vector3(Infinity, 0, 0) };
    this.trails.set(entity, trail);
    return trail;
  }
}
