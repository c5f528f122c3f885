// SPDX-License-Identifier: Apache-2.0
import { firstValue, type Value, valuesOfRobot } from "../data/channels";
import { none, type SceneEntity, type SceneModel, type SceneRobot } from "../data/messages";
import { numberText } from "../data/numbers";
import { element } from "../element";
import { rayLength } from "../picture/overlays";

const dialRadius = 54;
const drawInterval = 100; // [ms]; fast enough to read
const mostRows = 80;

/** Kind, pose, sensor readings and commands of the selected entity. */
export class Inspector {
  /** Called with the name of a value that the user wants to plot. */
  onPlot: (name: string) => void = () => undefined;

  private model: SceneModel | undefined;
  private robot: SceneRobot | undefined; // latest state
  private next: number | undefined; // timer of the next drawing
  private values: readonly Value[] = [];
  private numbers: HTMLTableCellElement[] = []; // table cells of the first values
  private readonly panel = element("inspector");
  private readonly title = element("inspected");
  private readonly pose = element("pose");
  private readonly dial = element("dial");
  private readonly chooser = element("channel") as HTMLSelectElement;
  private readonly table = document.createElement("details");

  constructor(close: () => void) {
    element("deselect").addEventListener("click", close);
    this.chooser.addEventListener("change", () => {
      if (this.chooser.value) this.onPlot(this.chooser.value);
      this.chooser.value = "";
    });
    this.table.id = "values";
    this.table.open = true;
    this.table.addEventListener("toggle", () => this.drawValues());
    this.dial.after(this.table);
  }

  select(entity: SceneEntity | undefined, model: SceneModel | undefined): void {
    this.model = model;
    this.robot = undefined;
    this.panel.hidden = entity === undefined;
    this.dial.replaceChildren();
    this.values = entity && model ? valuesOfRobot(model.observation, model.command) : [];
    this.chooser.hidden = this.values.length === 0;
    this.chooser.replaceChildren(
      new Option("plot a channel …", ""),
      ...this.values.map(({ name, unit }) => new Option(unit === "1" ? name : `${name} [${unit}]`, name)),
    );
    this.buildTable();
    if (!entity || !model) return;
    const robot = entity.robot === none ? "" : ` · robot ${entity.robot}`;
    this.title.textContent = entity.name;
    element("kind").textContent = `${model.name}${robot}${entity.team ? ` · team ${entity.team}` : ""}`;
  }

  showPose(text: string): void {
    this.pose.textContent = text;
  }

  take(robot: SceneRobot): void {
    if (!this.model) return;
    this.robot = robot;
    this.next ??= window.setTimeout(() => this.draw(), drawInterval);
  }

  private draw(): void {
    this.next = undefined;
    if (!this.model || !this.robot) return;
    this.drawValues();
    this.drawDial(this.model, this.robot);
  }

  // Makes a row for each value: its name, which plots it when clicked, the number and the unit.
  private buildTable(): void {
    const summary = document.createElement("summary");
    summary.textContent = "values";
    const table = document.createElement("table");
    this.numbers = this.values.slice(0, mostRows).map(({ name, unit }) => {
      const row = table.insertRow();
      const button = document.createElement("button");
      button.textContent = name;
      button.title = `Plot ${name}`;
      button.addEventListener("click", () => this.onPlot(name));
      row.insertCell().append(button);
      const number = row.insertCell();
      number.textContent = "–";
      row.insertCell().textContent = unit === "1" ? "" : unit;
      return number;
    });
    const left = this.values.length - this.numbers.length;
    if (left > 0) table.createCaption().textContent = `the first ${mostRows}; ${left} more can be plotted`;
    this.table.hidden = this.values.length === 0;
    this.table.replaceChildren(summary, table);
  }

  private drawValues(): void {
    const { robot } = this;
    if (!robot || !this.table.open) return;
    this.numbers.forEach((cell, i) => {
      const { isCommanded, index } = this.values[i];
      const text = numberText((isCommanded ? robot.command : robot.observation)[index]);
      if (cell.textContent !== text) cell.textContent = text;
    });
  }

  // Draws the sensors as a ring seen from above, with the robot's front upwards. A nearer obstacle gives a longer bar.
  private drawDial(model: SceneModel, robot: SceneRobot): void {
    const ring = model.sensors.find(({ kind }) => kind === "proximity_ring" || kind === "lidar");
    const first = ring && firstValue(model.observation, ring.channel);
    if (!ring || first === undefined) return;
    const count = ring.directions.length / 3;
    const bars = Array.from({ length: count }, (_, i) => {
      const angle = Math.atan2(ring.directions[3 * i + 1], ring.directions[3 * i]);
      const nearness = 1 - rayLength(ring, robot.observation[first + i]) / ring.range;
      const inner = 22;
      const outer = inner + 2 + (dialRadius - inner - 2) * nearness;
      const x = -Math.sin(angle);
      const y = -Math.cos(angle);
      const hue = 150 * (1 - nearness);
      return `<line x1="${inner * x}" y1="${inner * y}" x2="${outer * x}" y2="${outer * y}" stroke="hsl(${hue} 65% 45%)" stroke-width="5"/>`;
    });
    this.dial.innerHTML = `<circle r="20" class="rim"/><circle r="${dialRadius}" class="rim"/><path d="M0-15 6-5H-6z" class="front"/>${bars.join("")}`;
  }
}
