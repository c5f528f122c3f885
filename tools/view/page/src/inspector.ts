import uPlot from "uplot";
import { firstValue, valueNames } from "./channels";
import { element } from "./element";
import { none, type SceneEntity, type SceneModel, type SceneRobot } from "./messages";
import { rayLength } from "./overlays";

const plotSeconds = 20;
const palette = ["#1f8fff", "#e5484d", "#30a46c", "#d9a11f", "#8e4ec6", "#0f9ba8"];
const dialRadius = 54;
const drawInterval = 100; // [ms]; nobody reads faster, and without a graphics processor a plot takes longer than the scene

// A little more than the values; around one that never changes, 1 to each side.
function rangeAround(low: number | null, high: number | null): uPlot.Range.MinMax {
  if (low === null || high === null) return [-1, 1];
  return low === high ? [low - 1, high + 1] : uPlot.rangeNum(low, high, 0.1, true);
}

interface Plot {
  plot: uPlot;
  values: number[];
  data: number[][];
}

/** Kind, pose, sensor readings and commands of the selected entity. */
export class Inspector {
  private model: SceneModel | undefined;
  private robot: SceneRobot | undefined; // as it was last
  private next: number | undefined; // drawing
  private names: string[] = [];
  private readonly plots = new Map<string, Plot>();
  private lastTime = -Infinity;
  private readonly panel = element("inspector");
  private readonly title = element("inspected");
  private readonly pose = element("pose");
  private readonly dial = element("dial");
  private readonly plotted = element("plots");
  private readonly chooser = element("channel") as HTMLSelectElement;

  constructor(close: () => void) {
    element("deselect").addEventListener("click", close);
    this.chooser.addEventListener("change", () => {
      if (this.chooser.value) this.plot(this.chooser.value);
      this.chooser.value = "";
    });
  }

  select(entity: SceneEntity | undefined, model: SceneModel | undefined): void {
    this.model = model;
    this.robot = undefined;
    this.panel.hidden = entity === undefined;
    for (const name of [...this.plots.keys()]) this.unplot(name);
    this.dial.replaceChildren();
    if (!entity || !model) return;
    const robot = entity.robot === none ? "" : ` · robot ${entity.robot}`;
    this.title.textContent = entity.name;
    element("kind").textContent = `${model.name}${robot}${entity.team ? ` · team ${entity.team}` : ""}`;
    const observed = valueNames(model.observation);
    this.names = [...observed, ...valueNames(model.command).map((name) => `→ ${name}`)];
    const option = (name: string): HTMLOptionElement => new Option(name, name);
    this.chooser.replaceChildren(new Option("plot a channel …", ""), ...this.names.map(option));
    this.chooser.hidden = this.names.length === 0;
    for (const name of this.names.filter((each) => each.startsWith("→ ")).slice(0, 2)) this.plot(name);
  }

  /** Also from the console. False if the robot has no such channel. */
  plot(name: string): boolean {
    const index = this.names.indexOf(name);
    if (index < 0) return false;
    if (this.plots.has(name)) return true;
    const color = palette[this.plots.size % palette.length];
    const grid = { stroke: "rgba(128,128,128,0.18)", width: 1 };
    const axis = { stroke: getComputedStyle(document.body).color, grid, ticks: grid, font: "10px system-ui", size: 38 };
    const plot = new uPlot(
      {
        width: 272,
        height: 96,
        title: name,
        legend: { show: false },
        cursor: { show: false },
        scales: { x: { time: false }, y: { range: (_, low, high) => rangeAround(low, high) } },
        axes: [{ ...axis, size: 22, gap: 2, ticks: { ...grid, size: 4 } }, axis],
        series: [{}, { stroke: color, width: 1.5 }],
      },
      [[], []],
      this.plotted,
    );
    plot.root.title = "click to remove";
    plot.root.addEventListener("click", () => this.unplot(name));
    this.plots.set(name, { plot, values: [index], data: [[], []] });
    return true;
  }

  showPose(text: string): void {
    this.pose.textContent = text;
  }

  take(robot: SceneRobot, time: number): void {
    if (!this.model) return;
    if (time < this.lastTime) for (const each of this.plots.values()) each.data = [[], []];
    this.lastTime = time;
    const count = robot.observation.length;
    for (const each of this.plots.values()) {
      const [index] = each.values;
      const [times, values] = each.data;
      if (times[times.length - 1] === time) continue;
      times.push(time);
      values.push(index < count ? robot.observation[index] : robot.command[index - count]);
      while (times.length > 0 && times[0] < time - plotSeconds) {
        times.shift();
        values.shift();
      }
    }
    this.robot = robot;
    this.next ??= window.setTimeout(() => this.draw(), drawInterval);
  }

  private draw(): void {
    this.next = undefined;
    if (!this.model || !this.robot) return;
    for (const { plot, data } of this.plots.values()) plot.setData(data as uPlot.AlignedData);
    this.drawDial(this.model, this.robot);
  }

  private unplot(name: string): void {
    this.plots.get(name)?.plot.destroy();
    this.plots.delete(name);
  }

  // Sensors as a ring seen from above, the robot's front upwards: the nearer something is, the longer the bar.
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
