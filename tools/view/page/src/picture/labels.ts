// SPDX-License-Identifier: Apache-2.0
import { type PerspectiveCamera, Quaternion, Vector3 } from "three";
import type { Poses } from "./poses";

export const mostLabels = 30;
const above = 0.12; // [m]; height of a label above an entity
const gap = 2; // [pixels] between labels
const newGap = 8; // [pixels] around a new label, so that labels do not flicker
const keeping = 0.6; // factor of the rank of labels that are already shown

/** A name that may be shown, at a place of the picture in pixels: the middle of its lower edge. */
export interface Candidate {
  entity: number;
  x: number;
  y: number;
  /** Candidates with a smaller rank are shown first. */
  rank: number;
  isShown: boolean;
}

/** The size of a label [pixels]. */
export interface Size {
  width: number;
  height: number;
}

/**
 * Chooses labels that do not overlap, in the order of their ranks and at most `most`. Labels that are shown already are
 * preferred, and others need more free space, so that the choice is stable while things move.
 */
export function chooseLabels(
  candidates: readonly Candidate[],
  sizeOf: (entity: number) => Size,
  most = mostLabels,
): Candidate[] {
  const chosen: (Candidate & Size)[] = [];
  const order = [...candidates].sort((a, b) => preferred(a) - preferred(b) || a.entity - b.entity);
  for (const each of order) {
    if (chosen.length >= most) break;
    const free = each.isShown ? gap : newGap;
    const label = { ...each, ...sizeOf(each.entity) };
    if (!chosen.some((other) => overlap(label, other, free))) chosen.push(label);
  }
  return chosen;
}

const preferred = ({ rank, isShown }: Candidate): number => (isShown ? keeping * rank : rank);

function overlap(a: Candidate & Size, b: Candidate & Size, free: number): boolean {
  const isBeside = Math.abs(a.x - b.x) >= 0.5 * (a.width + b.width) + free;
  const isAbove = a.y + free <= b.y - b.height || b.y + free <= a.y - a.height;
  return !isBeside && !isAbove;
}

/** Names beside entities, as elements over the picture. */
export class Labels {
  private readonly shown = new Map<number, HTMLElement>();
  private readonly spare: HTMLElement[] = [];
  private readonly sizes = new Map<string, Size>();
  private readonly measure: HTMLElement;
  private readonly at = new Vector3();
  private readonly turn = new Quaternion();

  constructor(private readonly parent: HTMLElement) {
    this.measure = parent.appendChild(document.createElement("span"));
    this.measure.hidden = true;
    this.measure.style.visibility = "hidden";
  }

  /** Draws the labels. `first` is always shown. */
  draw(
    poses: Poses | undefined,
    entities: readonly number[],
    camera: PerspectiveCamera,
    width: number,
    height: number,
    first?: number,
  ): void {
    const candidates = poses ? this.candidates(poses, entities, camera, width, height, first) : [];
    const chosen = chooseLabels(candidates, (entity) => this.sizeOf(poses?.scene.entities[entity].name ?? ""));
    const kept = new Set(chosen.map(({ entity }) => entity));
    for (const [entity, label] of this.shown) {
      if (kept.has(entity)) continue;
      label.hidden = true;
      this.spare.push(label);
      this.shown.delete(entity);
    }
    for (const { entity, x, y } of chosen) {
      const label = this.shown.get(entity) ?? this.take(entity);
      const name = poses?.scene.entities[entity].name ?? "";
      if (label.textContent !== name) label.textContent = name;
      label.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px) translate(-50%, -100%)`;
    }
  }

  private candidates(
    poses: Poses,
    entities: readonly number[],
    camera: PerspectiveCamera,
    width: number,
    height: number,
    first: number | undefined,
  ): Candidate[] {
    const found: Candidate[] = [];
    for (const entity of entities) {
      if (poses.absent.has(entity)) continue;
      poses.read(poses.placeOf(entity), this.at, this.turn);
      this.at.z += above;
      const distance = this.at.distanceTo(camera.position);
      const { x, y, z } = this.at.project(camera);
      if (z > 1 || Math.abs(x) > 1 || Math.abs(y) > 1) continue;
      const isShown = this.shown.has(entity);
      const rank = entity === first ? 0 : distance * (0.4 + x ** 2 + y ** 2);
      found.push({
        entity,
        x: 0.5 * (x + 1) * width,
        y: 0.5 * (1 - y) * height,
        rank,
        isShown,
      });
    }
    return found;
  }

  private take(entity: number): HTMLElement {
    const label = this.spare.pop() ?? this.parent.appendChild(document.createElement("span"));
    label.hidden = false;
    this.shown.set(entity, label);
    return label;
  }

  // Returns the size of a label, which is measured once for each name. All digits have the same width.
  private sizeOf(entityName: string): Size {
    const name = entityName.replace(/\d/g, "0");
    const known = this.sizes.get(name);
    if (known) return known;
    this.measure.textContent = name;
    this.measure.hidden = false;
    const size = { width: this.measure.offsetWidth, height: this.measure.offsetHeight };
    this.measure.hidden = true;
    this.sizes.set(name, size);
    return size;
  }
}
