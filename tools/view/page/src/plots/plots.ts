// SPDX-License-Identifier: Apache-2.0
import "./plots.css";
import { download } from "../capture";
import { commandedPrefix, type Value, valuesMeant, valuesOfRobot } from "../data/channels";
import type { Answer, ViewRequest } from "../data/connection";
import { none, type Scene, type SceneRobot, seconds, type ViewStatus } from "../data/messages";
import { fixed } from "../data/numbers";
import { element } from "../element";
import { Histories, keyOf, shownCurve } from "./histories";
import { type Line, make, PlotChart } from "./plot_chart";
import { csvOf, svgOf } from "./plot_export";

const mostRobots = 16;
const mostCharts = 12;
const mostLines = 24; // in a chart
const mostAddable = 400; // names
const leastHeight = 110; // per chart [pixels]
const drawInterval = 100; // [ms]; without a graphics card, drawing a plot takes longer than drawing the scene
const detailDelay = 200; // [ms] from the last zoom to the request for detail

interface Robot {
  name: string;
  values: readonly Value[];
  byName: ReadonlyMap<string, Value>;
}
interface Shown {
  names: string[];
  chart: PlotChart;
  lines: Line[];
}
export interface PlotsOptions {
  ask: (request: ViewRequest) => Promise<Answer>;
  seek: (time: number) => void;
}

/** Plots of values of robots over all known time, with a common time axis and cursor. */
export class Plots {
  private readonly container = element("plots");
  private readonly told = make("output", {});
  private readonly all = make("button", { textContent: "whole time", title: "Show the whole time (double click)" });
  private readonly list = make("div", {});
  private readonly histories: Histories;
  private readonly robotOf = new Map<number, Robot>();
  private robots: number[] = [];
  private charts: Shown[] = [];
  private wanted: string[][] | undefined; // names in each plot, once the user has chosen
  private readonly removed = new Set<string>(); // lines of single robots
  private status: ViewStatus | undefined;
  private now = 0;
  private first = 0; // time of the first value from a server
  private zoomed: [number, number] | undefined;
  private hovered: number | undefined;
  private drawing: number | undefined;
  private asking: number | undefined;
  private world = "";

  constructor(private readonly options: PlotsOptions) {
    // A view of a program's own world has no histories.
    const ask = (request: ViewRequest): Promise<Answer> =>
      this.status?.source === "program" ? Promise.resolve({ done: true, text: "" }) : options.ask(request);
    this.histories = new Histories(ask, () => this.drawSoon());
    const button = (text: string, label: string, run: () => void): HTMLButtonElement => {
      const made = make("button", { textContent: text, title: label });
      made.setAttribute("aria-label", label);
      made.addEventListener("click", run);
      return made;
    };
    this.all.addEventListener("click", () => this.zoom(undefined));
    const csv = button("CSV", "Export the plotted values as CSV", () =>
      download(new Blob([this.csv()], { type: "text/csv" }), "plots.csv"),
    );
    const svg = button("SVG", "Export the plots as SVG", () =>
      download(new Blob([this.svg()], { type: "image/svg+xml" }), "plots.svg"),
    );
    this.container.replaceChildren(make("div", { className: "plot-tools" }, this.told, this.all, csv, svg), this.list);
    new ResizeObserver(() => this.resize()).observe(this.container);
    new MutationObserver(() => this.redraw()).observe(document.documentElement, {
      attributeFilter: ["data-theme"],
    });
    this.arrange();
  }

  // Data from the server.

  setScene(scene: Scene): void {
    if (scene.world !== this.world) this.forget();
    this.world = scene.world;
    const ofModel = scene.models.map(({ observation, command }) => valuesOfRobot(observation, command));
    const byName = ofModel.map((values) => new Map(values.map((each) => [each.name, each])));
    this.robotOf.clear();
    for (const { name, robot, model } of scene.entities)
      if (robot !== none) this.robotOf.set(robot, { name, values: ofModel[model], byName: byName[model] });
  }

  takeStatus(status: ViewStatus): void {
    const { status: before } = this;
    if (before && (before.source !== status.source || before.name !== status.name)) this.forget();
    this.status = status;
    this.setNow(seconds(status.time_ns));
    if (!before || before.end_ns !== status.end_ns || before.begin_ns !== status.begin_ns) this.drawSoon();
  }

  /** Takes the present values of a server's robots. A recording has them in its history. */
  take(robots: readonly SceneRobot[]): void {
    if (this.status === undefined || this.status.source === "recording") return;
    for (const { robot, time_ns, observation, command } of robots) {
      const byName = this.robotOf.get(robot)?.byName;
      if (!byName) continue;
      const time = Number(time_ns) / 1e9;
      this.histories.append(robot, time, observation, command, (name) => byName.get(name)?.index);
      this.setNow(time);
    }
    if (robots.length > 0) this.drawSoon();
  }

  /** Drops all values, because another run is shown or the connection was lost. */
  forget(): void {
    this.histories.forget();
    this.zoomed = undefined;
    this.arrange();
  }

  // User input.

  /** Plots the values of the robots with these ids. */
  show(robots: readonly number[]): void {
    const known = robots.filter((robot) => this.robotOf.has(robot)).slice(0, mostRobots);
    if (known.length !== this.robots.length || known.some((robot, i) => robot !== this.robots[i])) this.removed.clear();
    this.robots = known;
    this.arrange();
  }

  /**
   * Plots a value by its name, optionally followed by its unit, or all values with a unit. Returns false if there is
   * none.
   */
  add(text: string): boolean {
    const meant = valuesMeant(this.values(), text);
    for (const { name, unit } of meant.slice(0, mostLines)) {
      for (const robot of this.robots) this.removed.delete(keyOf(robot, name));
      const plots = this.choose();
      if (plots.some((names) => names.includes(name))) continue;
      const ofUnit = plots.find((names) => names.every((each) => this.unitOf(each) === unit));
      if (ofUnit) ofUnit.push(name);
      else plots.push([name]);
    }
    this.arrange();
    return meant.length > 0;
  }

  csv(): string {
    return csvOf(
      this.charts.flatMap(({ lines }) => lines),
      this.range(),
    );
  }

  svg(): string {
    return svgOf(
      this.charts.map(({ lines }) => lines),
      this.range(),
    );
  }

  /** Returns the plotted lines. */
  lines(): Line[] {
    return this.charts.flatMap(({ lines }) => lines);
  }

  /** Returns the names of the values that can be plotted. */
  names(): string[] {
    return this.values().map(({ name }) => name);
  }

  // Returns the values that any of the robots have, each once.
  private values(): Value[] {
    const found = new Map<string, Value>();
    for (const robot of this.robots)
      for (const value of this.robotOf.get(robot)?.values ?? [])
        if (!found.has(value.name)) found.set(value.name, value);
    return [...found.values()];
  }

  private valueOf(name: string): Value | undefined {
    for (const robot of this.robots) {
      const found = this.robotOf.get(robot)?.byName.get(name);
      if (found) return found;
    }
    return undefined;
  }

  private unitOf(name: string): string | undefined {
    return this.valueOf(name)?.unit;
  }

  // Returns the names in each plot; by default, the first two commands.
  private plots(): string[][] {
    const chosen = this.wanted?.map((names) => names.filter((name) => this.valueOf(name)));
    const plots = chosen?.filter((names) => names.length > 0) ?? [];
    if (plots.length > 0 || this.wanted?.length === 0) return plots;
    const ofUnits = new Map<string, string[]>();
    for (const { name, unit } of this.values()
      .filter((each) => each.name.startsWith(commandedPrefix))
      .slice(0, 2))
      ofUnits.set(unit, [...(ofUnits.get(unit) ?? []), name]);
    return [...ofUnits.values()];
  }

  private choose(): string[][] {
    const shown = this.plots();
    const others = this.wanted?.filter((names) => !names.some((name) => this.valueOf(name))) ?? [];
    this.wanted = [...shown, ...others];
    return this.wanted;
  }

  private linesOf(names: readonly string[]): { robot: number; value: Value }[] {
    const lines = names.flatMap((name) =>
      this.robots.flatMap((robot) => {
        const value = this.robotOf.get(robot)?.byName.get(name);
        return value && !this.removed.has(keyOf(robot, name)) ? [{ robot, value }] : [];
      }),
    );
    return lines.slice(0, mostLines);
  }

  // Makes the charts and requests their data.
  private arrange(): void {
    const plots = this.plots()
      .filter((names) => this.linesOf(names).length > 0)
      .slice(0, mostCharts);
    while (this.charts.length > plots.length) this.charts.pop()?.chart.destroy();
    while (this.charts.length < plots.length) {
      const chart: PlotChart = new PlotChart({
        seek: (time, isDeliberate) => this.seek(time, isDeliberate),
        zoom: (interval) => this.zoom(interval),
        hover: (time) => this.hover(time),
        remove: (line) => this.remove(line),
        add: (name) => this.addTo(chart, name),
      });
      this.list.append(chart.root);
      this.charts.push({ names: [], chart, lines: [] });
    }
    this.charts.forEach((shown, i) => {
      shown.names = plots[i];
    });
    const wanted = plots.flatMap((names) => this.linesOf(names));
    this.histories.want(wanted.map(({ robot, value: { name, unit } }) => ({ robot, name, unit })));
    this.resize();
    this.draw();
  }

  private remove({ key, name }: Line): void {
    const plots = this.choose();
    this.removed.add(key);
    const isGone = this.linesOf([name]).length === 0;
    if (isGone) {
      for (const robot of this.robots) this.removed.delete(keyOf(robot, name));
      this.wanted = plots.map((names) => names.filter((each) => each !== name)).filter((names) => names.length > 0);
    }
    this.arrange();
  }

  private addTo(chart: PlotChart, name: string): void {
    const names = this.charts.find((each) => each.chart === chart)?.names;
    const plots = this.choose();
    if (!names) return;
    const target = plots.find((each) => each.includes(names[0]));
    target?.push(name);
    this.arrange();
  }

  private seek(time: number, isDeliberate: boolean): void {
    const { status } = this;
    if (!status?.can_seek || (status.loses_what_follows && !isDeliberate)) return;
    this.options.seek(Math.min(seconds(status.seekable_to_ns), Math.max(seconds(status.seekable_from_ns), time)));
  }

  private zoom(interval: [number, number] | undefined): void {
    this.zoomed = interval;
    window.clearTimeout(this.asking);
    this.asking = window.setTimeout(() => this.histories.zoom(interval), interval ? detailDelay : 0);
    this.draw();
  }

  private hover(time: number | undefined): void {
    if (time === this.hovered) return;
    this.hovered = time;
    this.read();
  }

  private setNow(time: number): void {
    if (time === this.now) return;
    this.now = time;
    for (const { chart } of this.charts) chart.setNow(time);
    if (this.hovered === undefined) this.drawSoon();
  }

  // Drawing.

  private range(): [number, number] {
    if (this.zoomed) return this.zoomed;
    const { status } = this;
    if (status?.source === "recording") {
      const [begin, end] = [seconds(status.begin_ns), seconds(status.end_ns)];
      return [begin, Math.max(end, begin + 1e-3)];
    }
    return [this.first, Math.max(this.now, this.first + 1e-3)];
  }

  private redraw(): void {
    for (const { chart } of this.charts) chart.redraw();
  }

  private drawSoon(): void {
    this.drawing ??= window.setTimeout(() => this.draw(), drawInterval);
  }

  private draw(): void {
    window.clearTimeout(this.drawing);
    this.drawing = undefined;
    const known = this.names();
    const label = (robot: number, name: string): string =>
      this.robots.length > 1 ? `${this.robotOf.get(robot)?.name.split("/").pop()} ${name}` : name;
    let first = Infinity;
    for (const shown of this.charts) {
      shown.lines = this.linesOf(shown.names).flatMap(({ robot, value: { name, unit } }) => {
        const track = this.histories.get(robot, name);
        if (!track) return [];
        const curve = shownCurve(track);
        first = Math.min(first, curve.times[0] ?? Infinity);
        return [{ key: keyOf(robot, name), label: label(robot, name), name, unit, curve }];
      });
    }
    this.first = Number.isFinite(first) ? first : this.now;
    const range = this.range();
    const plotted = new Set(this.charts.flatMap(({ names }) => names));
    const addable = known.filter((name) => !plotted.has(name)).slice(0, mostAddable);
    let isOther = false;
    for (const { chart, lines } of this.charts) {
      chart.setRange(range);
      isOther = chart.show(lines, addable) || isOther;
      chart.setNow(this.now);
    }
    this.read();
    if (isOther) this.resize();
  }

  // Shows the values at the time under the mouse, or otherwise at the present time.
  private read(): void {
    const time = this.hovered ?? this.now;
    for (const { chart } of this.charts) chart.read(time);
    const { isReading, problem } = this.histories;
    this.told.classList.toggle("wrong", problem !== "");
    this.told.textContent =
      this.robots.length === 0
        ? "Select a robot to plot its channels."
        : [`${fixed(time, 3)} s`, isReading ? "reading the history …" : "", problem].filter((each) => each).join(" · ");
    this.all.hidden = this.zoomed === undefined;
  }

  // Charts share the height of a fixed container; in a container that grows with them, each has the minimum height.
  private resize(): void {
    const { container, list, charts } = this;
    if (charts.length === 0) return;
    list.hidden = true;
    const free = container.clientHeight - (container.firstElementChild as HTMLElement).offsetHeight;
    list.hidden = false;
    const width = Math.floor(list.clientWidth);
    if (width === 0) return;
    const heads = charts.reduce((sum, { chart }) => sum + chart.headHeight, 0);
    const height = Math.max(leastHeight, Math.floor((free - heads) / charts.length) - 2);
    for (const { chart } of charts) chart.resize(width, height);
  }
}
