// SPDX-License-Identifier: Apache-2.0
import uPlot from "uplot";
import { commandedPrefix } from "../data/channels";
import { numberText, unitAfter } from "../data/numbers";
import { type Curve, valueAt } from "./curve";

// The palette of Okabe and Ito, which colour-blind users can distinguish on light and dark backgrounds. Further lines
// are dashed.
const palette = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8a8a8a"];
const dashes = [[], [6, 3], [2, 3]];
const clickSlack = 4; // [pixels] by which the mouse may move during a click
const doubleClick = 250; // [ms] to wait for a second click
const retainNulls = 1; // mode of uPlot.join
const mostEntries = 8; // in a legend
const mostEntriesIfNarrow = 4;
const narrow = 700; // [pixels]

export interface Line {
  key: string;
  label: string;
  name: string;
  unit: string;
  curve: Curve;
}
export interface ChartActions {
  seek(time: number, isDeliberate: boolean): void;
  zoom(interval: [number, number] | undefined): void;
  hover(time: number | undefined): void;
  remove(line: Line): void;
  add(name: string): void;
}

export const colorOf = (index: number): string => palette[index % palette.length];
export const dashOf = (index: number): number[] => dashes[Math.floor(index / palette.length) % dashes.length];

/** Returns a range slightly larger than that of the values; for a constant value, 1 to each side. */
export function rangeAround(low: number | null, high: number | null): [number, number] {
  if (low === null || high === null) return [-1, 1];
  if (low === high) return [low - 1, high + 1];
  return [low - 0.08 * (high - low), high + 0.08 * (high - low)];
}

/** Returns the units of lines, for their common axis; `1` if dimensionless. */
export const unitsOf = (lines: readonly Line[]): string => [...new Set(lines.map(({ unit }) => unit))].join(", ");

/** Makes an element with properties and children. */
export function make<Kind extends keyof HTMLElementTagNameMap>(
  kind: Kind,
  properties: Partial<HTMLElementTagNameMap[Kind]>,
  ...children: (Node | string)[]
): HTMLElementTagNameMap[Kind] {
  const made = Object.assign(document.createElement(kind), properties);
  made.append(...children);
  return made;
}

/** One chart: lines of one unit over the common time axis, and a legend with values. */
export class PlotChart {
  readonly root = make("section", { className: "plot" });
  private readonly legend = make("ul", { className: "plot-legend" });
  private readonly adder = make("select", { className: "plot-add" });
  private readonly place = make("div", { className: "plot-place" });
  private readonly now = make("div", { className: "plot-now" });
  private readonly head = make("header", {}, this.legend, this.adder);
  private readonly outputs: HTMLOutputElement[] = [];
  private lines: Line[] = [];
  private plot: uPlot | undefined;
  private size = { width: 0, height: 0 };
  private range: [number, number] = [0, 1];
  private clicked: number | undefined; // timer

  constructor(private readonly actions: ChartActions) {
    this.adder.setAttribute("aria-label", "Add a channel to this plot");
    this.adder.addEventListener("change", () => {
      if (this.adder.value) actions.add(this.adder.value);
      this.adder.value = "";
    });
    this.root.append(this.head, this.place);
  }

  /**
   * Shows these lines, and returns whether they differ from the former ones. `addable` are the names of further values.
   */
  show(lines: Line[], addable: readonly string[]): boolean {
    const isSame = lines.length === this.lines.length && lines.every(({ key }, i) => key === this.lines[i].key);
    this.lines = lines;
    this.adder.hidden = addable.length === 0;
    this.adder.replaceChildren(new Option("+ add to plot", ""), ...addable.map((name) => new Option(name, name)));
    this.root.setAttribute("aria-label", `Plot of ${lines.map(({ label }) => label).join(", ")}`);
    if (!isSame || !this.plot) {
      this.buildLegend();
      this.build();
    } else this.plot.setData(this.data(), false);
    this.setRange(this.range);
    return !isSame;
  }

  /** Height of the area above the chart [pixels]. */
  get headHeight(): number {
    return this.head.offsetHeight;
  }

  resize(width: number, height: number): void {
    const isSame = width === this.size.width && height === this.size.height;
    const wasNarrow = this.size.width < narrow;
    this.size = { width, height };
    if (wasNarrow !== width < narrow) this.buildLegend();
    if (this.plot && !isSame) this.plot.setSize(this.size);
  }

  setRange(range: [number, number]): void {
    this.range = range;
    this.plot?.setScale("x", { min: range[0], max: range[1] });
  }

  /** Moves the vertical line to the present time. */
  setNow(time: number): void {
    const [from, to] = this.range;
    this.now.hidden = !(time >= from && time <= to);
    this.now.style.left = `${(100 * (time - from)) / (to - from)}%`;
  }

  /** Shows the values at a time in the legend. */
  read(time: number): void {
    this.outputs.forEach((output, i) => {
      const { curve, unit } = this.lines[i];
      const value = valueAt(curve, time);
      const text = numberText(value) + (value === undefined ? "" : unitAfter(unit));
      if (output.textContent !== text) output.textContent = text;
    });
  }

  redraw(): void {
    this.plot?.redraw(false);
  }

  destroy(): void {
    window.clearTimeout(this.clicked);
    this.plot?.destroy();
    this.root.remove();
  }

  private data(): uPlot.AlignedData {
    const curves = this.lines.map(({ curve }) => curve);
    const [first] = curves;
    const values = ({ values: all }: Curve): (number | null)[] =>
      all.map((value) => (Number.isFinite(value) ? value : null));
    const isSame = ({ times }: Curve): boolean =>
      times.length === first.times.length && times.every((time, i) => time === first.times[i]);
    if (!first) return [[]];
    if (curves.every(isSame)) return [first.times, ...curves.map(values)];
    const tables = curves.map((curve): uPlot.AlignedData => [curve.times, values(curve)]);
    return uPlot.join(
      tables,
      tables.map((table) => table.map(() => retainNulls)),
    );
  }

  // Shows the names of the first lines, and the number of further lines.
  private buildLegend(): void {
    this.outputs.length = 0;
    const most = this.size.width < narrow ? mostEntriesIfNarrow : mostEntries;
    const unnamed = this.lines.slice(most).map(({ label }) => label);
    this.legend.replaceChildren(
      ...this.lines.slice(0, most).map((line, i) => {
        const swatch = make("i", {});
        swatch.style.background = colorOf(i);
        const output = make("output", {});
        this.outputs.push(output);
        const remove = make("button", { textContent: "×", title: "Remove" });
        remove.setAttribute("aria-label", `Remove ${line.label}`);
        remove.addEventListener("click", () => this.actions.remove(line));
        return make("li", {}, swatch, make("span", { textContent: line.label, title: line.label }), output, remove);
      }),
    );
    if (unnamed.length === 0) return;
    const names = make("span", { className: "unseen", textContent: `: ${unnamed.join(", ")}` });
    const title = this.lines.map(({ label }) => label).join("\n");
    this.legend.append(make("li", { className: "plot-more", title }, `and ${unnamed.length} more`, names));
  }

  private build(): void {
    this.plot?.destroy();
    const color = (): string => getComputedStyle(document.body).color;
    const grid = { stroke: "rgba(128,128,128,0.2)", width: 1 };
    const axis = { stroke: color, grid, ticks: { ...grid, size: 4 }, font: "10px system-ui" };
    const label = { label: unitsOf(this.lines), labelSize: 14, labelFont: "11px system-ui", labelGap: 0 };
    const texts = (_: uPlot, splits: number[]): string[] =>
      splits.map((each) => String(Number(each.toPrecision(8)) + 0));
    this.plot = new uPlot(
      {
        ...this.size,
        legend: { show: false },
        cursor: {
          sync: { key: "plots", scales: ["x", null] },
          drag: { x: true, y: false, dist: clickSlack, setScale: false },
          points: { size: 6 },
          bind: { dblclick: () => () => this.reset() },
        },
        scales: { x: { time: false }, y: { range: (_, low, high) => rangeAround(low, high) } },
        axes: [
          { ...axis, size: 24, gap: 2, values: (u, splits) => texts(u, splits).map((each) => `${each} s`) },
          { ...axis, ...label, size: 50, gap: 2, values: texts },
        ],
        series: [{}, ...this.lines.map((line, i) => seriesOf(line, i))],
        hooks: {
          setSelect: [(u) => this.selected(u)],
          setCursor: [(u) => this.cursorMoved(u)],
          ready: [(u) => this.listen(u)],
        },
      },
      this.data(),
      this.place,
    );
  }

  private listen(u: uPlot): void {
    u.over.append(this.now);
    let pressedAt = 0;
    u.over.addEventListener("mousedown", ({ clientX }) => {
      pressedAt = clientX;
    });
    u.over.addEventListener("click", ({ clientX, detail, shiftKey }) => {
      window.clearTimeout(this.clicked);
      if (detail > 1 || Math.abs(clientX - pressedAt) > clickSlack) return;
      const time = u.posToVal(clientX - u.over.getBoundingClientRect().left, "x");
      this.clicked = window.setTimeout(() => this.actions.seek(time, shiftKey), doubleClick);
    });
  }

  private reset(): null {
    window.clearTimeout(this.clicked);
    this.actions.zoom(undefined);
    return null;
  }

  private selected(u: uPlot): void {
    const { left, width } = u.select;
    if (width <= clickSlack) return;
    u.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
    this.actions.zoom([u.posToVal(left, "x"), u.posToVal(left + width, "x")]);
  }

  private cursorMoved(u: uPlot): void {
    const { left, idx } = u.cursor;
    const isOver = left !== undefined && left !== null && left >= 0;
    this.actions.hover(!isOver ? undefined : typeof idx === "number" ? u.data[0][idx] : u.posToVal(left, "x"));
  }
}

function seriesOf({ label, name }: Line, index: number): uPlot.Series {
  // A command is constant from one tick to the next.
  const paths = name.startsWith(commandedPrefix) ? uPlot.paths.stepped?.({ align: -1 }) : undefined;
  return { label, stroke: colorOf(index), width: 1.5, dash: dashOf(index), paths, points: { show: false } };
}
