// SPDX-License-Identifier: Apache-2.0
import { Quaternion, Vector3 } from "three";
import { valuesOfRobot } from "../data/channels";
import { none, type SceneModel, type SceneRobot } from "../data/messages";
import { fixed } from "../data/numbers";
import { element } from "../element";
import type { Poses } from "../picture/poses";

const drawInterval = 150; // [ms]
const mostRows = 200;

export interface Statistics {
  count: number;
  mean: number;
  spread: number; // standard deviation
  sum: number;
}

/** Returns mean, population standard deviation and sum; undefined if there are no values. */
export function statisticsOf(values: readonly number[]): Statistics | undefined {
  if (values.length === 0) return undefined;
  const sum = values.reduce((total, each) => total + each, 0);
  const mean = sum / values.length;
  const variance = values.reduce((total, each) => total + (each - mean) ** 2, 0) / values.length;
  return { count: values.length, mean, spread: Math.sqrt(variance), sum };
}

/** Returns a number with three significant digits, never "-0". */
export function shortNumber(value: number): string {
  if (!Number.isFinite(value)) return String(value);
  const size = Math.abs(value);
  const isLong = size >= 1e6 || (size > 0 && size < 1e-3);
  const text = isLong ? value.toExponential(2).replace("e+", "e") : String(Number(value.toPrecision(3)));
  return text === "-0" ? "0" : text;
}

const withUnit = (name: string, unit: string): string => (unit === "1" || unit === "" ? name : `${name} [${unit}]`);

/** Mean, spread and sum of the channels of several selected robots. */
export class GroupPanel {
  private entities: readonly number[] = [];
  private models: readonly SceneModel[] = []; // by robot
  private modelOf = new Map<number, SceneModel>();
  private robots: readonly SceneRobot[] = []; // latest states
  private next: ReturnType<typeof setTimeout> | undefined; // timer of the next drawing
  private readonly panel = element("group");
  private readonly title = document.createElement("h2");
  private readonly place = document.createElement("p");
  private readonly table = document.createElement("table");

  constructor() {
    this.panel.append(this.title, this.place, this.table);
  }

  select(entities: readonly number[], poses: Poses | undefined): void {
    this.entities = entities;
    this.panel.hidden = entities.length === 0 || !poses;
    this.table.replaceChildren();
    this.robots = [];
    this.modelOf = new Map();
    if (!poses || entities.length === 0) return;
    const { scene } = poses;
    for (const entity of entities) {
      const { robot, model } = scene.entities[entity];
      if (robot !== none) this.modelOf.set(robot, scene.models[model]);
    }
    this.models = [...new Set(this.modelOf.values())];
    const robots = this.modelOf.size;
    const kinds = this.models.map(({ name }) => name).join(", ");
    this.title.textContent =
      robots === entities.length
        ? `${robots} robots (${kinds})`
        : `${entities.length} objects, ${robots} of them robots`;
  }

  /** Shows the centre of the robots and their spread. */
  showPoses(poses: Poses | undefined): void {
    if (!poses || this.panel.hidden) return;
    const [at, turn, sum] = [new Vector3(), new Quaternion(), new Vector3()];
    const shown = this.entities.filter((each) => !poses.absent.has(each));
    for (const entity of shown) {
      poses.read(poses.placeOf(entity), at, turn);
      sum.add(at);
    }
    if (shown.length === 0) return;
    sum.divideScalar(shown.length);
    let squares = 0;
    for (const entity of shown) {
      poses.read(poses.placeOf(entity), at, turn);
      squares += at.distanceToSquared(sum);
    }
    const [x, y, z] = sum.toArray().map((each) => fixed(each, 3));
    this.place.textContent = `mean x ${x} y ${y} z ${z} m · spread ${fixed(Math.sqrt(squares / shown.length), 3)} m`;
  }

  take(robots: readonly SceneRobot[]): void {
    this.robots = robots;
    this.next ??= setTimeout(() => this.draw(), drawInterval);
  }

  private draw(): void {
    this.next = undefined;
    const { robots } = this;
    if (this.panel.hidden) return;
    const values = new Map<string, { unit: string; values: number[] }>();
    for (const robot of robots) {
      const model = this.modelOf.get(robot.robot);
      if (!model) continue;
      for (const { name, unit, isCommanded, index } of valuesOfRobot(model.observation, model.command)) {
        const found = values.get(name) ?? { unit, values: [] };
        found.values.push((isCommanded ? robot.command : robot.observation)[index]);
        values.set(name, found);
      }
    }
    const head = rowOf("th", ["channel", "mean", "spread", "sum"]);
    const rows = [...values].slice(0, mostRows).flatMap(([name, { unit, values: all }]) => {
      const found = statisticsOf(all);
      if (!found) return [];
      const { mean, spread, sum } = found;
      const numbers = [mean, spread, sum];
      const row = rowOf("td", [withUnit(name, unit), ...numbers.map(shortNumber)]);
      numbers.forEach((number, i) => {
        row.cells[i + 1].title = String(number);
      });
      return [row];
    });
    this.table.replaceChildren(head, ...rows);
    const missing = this.modelOf.size - robots.length;
    this.table.title = missing > 0 ? `of ${robots.length} of ${this.modelOf.size} robots` : "";
  }
}

function rowOf(kind: "td" | "th", texts: readonly string[]): HTMLTableRowElement {
  const row = document.createElement("tr");
  row.append(
    ...texts.map((text) => {
      const cell = document.createElement(kind);
      // Long names may break after a slash.
      cell.append(...text.split(/(?<=\/)/).flatMap((part) => [part, document.createElement("wbr")]));
      return cell;
    }),
  );
  return row;
}
