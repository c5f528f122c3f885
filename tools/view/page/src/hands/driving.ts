// SPDX-License-Identifier: Apache-2.0
import { type Command, type Commands, command } from "../commands";
import { valueNames } from "../data/channels";
import type { Connection } from "../data/connection";
import { none, type SceneChannel } from "../data/messages";
import { element } from "../element";
import type { ConsolePanel } from "../panels/console";
import type { Viewer } from "../viewer";
import { commandOf, type Drive, neutralOf, padOf, readSteer, type Steer, sliderEnds, steerOfPad } from "./steering";

const interval = 50; // [ms] between requests, at least
const longestSilence = 200; // [ms]; after 500 ms without a request, the robot gets its neutral command

interface Driven {
  name: string;
  channels: SceneChannel[];
  drives: Drive[];
  base: number[];
}

/** Drives one robot of a server by keys, a game pad and sliders. */
export class Driving {
  private driven: Driven | undefined;
  private readonly held = new Map<string, string>(); // keys by their position on the keyboard
  private isAsking = false;
  private isClaiming = false;
  private sent: number[] = [];
  private sentAt = -Infinity;
  private readonly button = element("drive") as HTMLButtonElement;

  constructor(
    private readonly viewer: Viewer,
    private readonly connection: Connection,
    private readonly commands: Commands,
    private readonly console: ConsolePanel,
    canvas: HTMLCanvasElement,
  ) {
    setInterval(() => void this.advance(), interval);
    addEventListener("blur", () => this.held.clear());
    this.button.addEventListener("click", () => {
      canvas.focus();
      void console.run(this.driven && this.driven.name === this.selectedRobot() ? "release" : "drive");
    });
  }

  get name(): string | undefined {
    return this.driven?.name;
  }

  consoleCommands(): Command[] {
    const robots = (): string[] =>
      this.viewer.poses?.scene.entities.flatMap(({ name, robot }) => (robot === none ? [] : [name])) ?? [];
    return [
      command(
        "drive [NAME]",
        "claims a robot and drives it by keys (see steer) or a game pad",
        ([name]) => this.drive(name),
        robots,
      ),
      command("release", "releases the driven robot", () => this.release()),
    ];
  }

  /** Claims a robot. Throws Error with the server's message if the robot cannot be driven. */
  async drive(name?: string): Promise<string> {
    const scene = this.viewer.poses?.scene;
    const entity = name === undefined ? this.viewer.chosen.selected : this.viewer.find(name);
    const robot = entity === undefined ? undefined : scene?.entities[entity];
    if (!scene || !robot || robot.robot === none)
      throw new Error(name === undefined ? "select a robot first" : `there is no robot '${name}'`);
    if (this.driven?.name === robot.name) return `drives ${robot.name}`;
    if (this.isClaiming) throw new Error("a robot is already being claimed");
    if (this.driven) await this.release();
    this.isClaiming = true;
    this.show();
    const answer = await this.connection.ask({ operation: "drive", name: robot.name, numbers: [] });
    this.isClaiming = false;
    if (answer.done) {
      const { command } = scene.models[robot.model];
      const drives = scene.drives.filter(({ model }) => model === robot.model);
      this.driven = { name: robot.name, channels: command, drives, base: neutralOf(command) };
      this.sentAt = -Infinity;
      this.viewer.chosen.select(this.viewer.find(robot.name));
    }
    this.show();
    if (!answer.done) throw new Error(answer.text);
    return answer.text;
  }

  async release(): Promise<string> {
    const { driven } = this;
    if (!driven) throw new Error("no robot is driven");
    this.end();
    const { text } = await this.connection.ask({ operation: "release", name: driven.name });
    return text;
  }

  /** Returns whether it was a driving key. */
  keyDown({ key, code }: KeyboardEvent): boolean {
    if (!this.driven) return false;
    if (key === "Escape") {
      void this.console.run("release");
      return true;
    }
    if (this.steerOf(key) === undefined) return false;
    this.held.set(code, key);
    return true;
  }
  keyUp({ code }: KeyboardEvent): void {
    this.held.delete(code);
  }

  /** Called when the inspector shows another entity or another scene. */
  show(): void {
    const robot = this.selectedRobot();
    const driven = robot === this.driven?.name ? this.driven : undefined;
    this.button.hidden = robot === undefined;
    this.button.textContent = this.isClaiming ? "claiming …" : driven ? "release" : "drive";
    this.button.disabled = this.isClaiming;
    this.button.classList.toggle("on", driven !== undefined);
    element("sliders").replaceChildren(...(driven ? this.sliders(driven) : []));
    this.showDriven();
  }

  private selectedRobot(): string | undefined {
    const entity = this.viewer.chosen.selectedEntity;
    return entity && entity.robot !== none ? entity.name : undefined;
  }

  private steerOf(key: string): Steer | undefined {
    const line = this.commands.steeringOfKey(key) ?? this.commands.steeringOfKey(key.toLowerCase());
    return line === undefined ? undefined : readSteer(line);
  }

  private async advance(): Promise<void> {
    const { driven } = this;
    if (!driven || this.isAsking) return;
    const pad = padOf(navigator.getGamepads());
    const steers = [...this.held.values()].map((key) => this.steerOf(key)).concat(pad && steerOfPad(pad));
    const values = commandOf(
      driven.channels,
      driven.drives,
      driven.base,
      steers.filter((each) => each !== undefined),
    );
    const now = performance.now();
    const isNews = values.some((value, i) => value !== this.sent[i]);
    if (!isNews && now - this.sentAt < longestSilence) return;
    this.showDriven(pad);
    this.sent = values;
    this.sentAt = now;
    this.isAsking = true;
    const { done, text } = await this.connection.ask({ operation: "drive", name: driven.name, numbers: values });
    this.isAsking = false;
    if (done || this.driven !== driven) return;
    this.end();
    this.console.say(text, "wrong");
  }

  private end(): void {
    this.driven = undefined;
    this.held.clear();
    this.sent = [];
    this.show();
  }

  private showDriven(pad = padOf(navigator.getGamepads())): void {
    const line = element("driven");
    line.hidden = !this.driven;
    if (!this.driven) return;
    const by = this.driven.drives.length > 0 ? "arrows or w a s d" : "sliders";
    const text = [
      `drives ${this.driven.name}`,
      pad ? `${by}, or the left stick of ${pad.id}` : by,
      "Escape releases",
    ].join(" · ");
    if (line.textContent !== text) line.textContent = text;
  }

  // Returns sliders for all values except those that the arrow keys drive.
  private sliders(driven: Driven): HTMLElement[] {
    const byArrows = new Set(driven.drives.map(({ value }) => value));
    const owners = driven.channels.flatMap((channel) => Array.from({ length: channel.size }, () => channel));
    return valueNames(driven.channels).flatMap((name, at) =>
      byArrows.has(at) ? [] : [this.slider(driven, name, at, owners[at])],
    );
  }

  private slider(driven: Driven, name: string, at: number, { unit, lower, upper }: SceneChannel): HTMLElement {
    const label = document.createElement("label");
    const input = document.createElement("input");
    const output = document.createElement("output");
    const [least, most] = sliderEnds(unit, lower, upper);
    const isBounded = Number.isFinite(least) && Number.isFinite(most);
    Object.assign(input, { type: isBounded ? "range" : "number", min: String(least), max: String(most), step: "any" });
    const say = (): void => {
      output.textContent = `${Number(driven.base[at].toFixed(3)) + 0}${unit === "1" ? "" : ` ${unit}`}`;
    };
    input.value = String(driven.base[at]);
    input.dataset.channel = name;
    input.addEventListener("input", () => {
      if (Number.isFinite(input.valueAsNumber)) driven.base[at] = input.valueAsNumber;
      say();
    });
    say();
    label.append(name, output, input);
    return label;
  }
}
