// SPDX-License-Identifier: Apache-2.0
import { parse } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import type { Answer, Connection, Handlers, ViewRequest } from "./connection";
import type { SceneRobot, Topic, ViewStatus } from "./messages";
import { RecordedFrames } from "./recorded_frames";

const interval = 16; // [ms] between checks of the clock
const greatestSpeed = 1e6;
const mostSteps = 1e6;
const smoothing = 0.05;

/** Plays the recording that the document contains, with the same requests as RecordingSource. */
export class FileConnection implements Connection {
  readonly received: ReadonlyMap<Topic, bigint> = new Map();
  private readonly wanted = new Set<Topic>();
  private readonly readers = new Map<string, MessageReader>();
  private frames: RecordedFrames | undefined;
  private problem = "";
  private watched: number[] = [];
  private isPlaying = true;
  private speed = 1;
  private factor = 1; // simulated seconds per second, measured
  private time = 0; // log time [ns]
  private at = 0; // index of the frame to show
  private lastLook = performance.now();
  // State of the page.
  private shownFrame = -1;
  private shownScene = -1;
  private shownSignals: Uint8Array | undefined;
  private sent = new Set<Topic>(); // topics to which this frame was passed
  private isShowing = false;

  constructor(
    blocks: readonly HTMLElement[],
    private readonly handlers: Handlers,
    private readonly changed: (isConnected: boolean) => void,
  ) {
    void this.open(blocks);
  }

  want(topic: Topic, isWanted = true): void {
    if (isWanted) this.wanted.add(topic);
    else this.wanted.delete(topic);
    this.sent.delete(topic);
    if (topic === "/cohort/scene") this.shownScene = -1;
    if (topic === "/cohort/signals") this.shownSignals = undefined;
  }

  ask(request: ViewRequest): Promise<Answer> {
    return Promise.resolve(this.take(request));
  }

  private take({ operation, number = 0, numbers = [] }: ViewRequest): Answer {
    const { frames } = this;
    const done = (text: string): Answer => ({ done: true, text });
    const refused = (text: string): Answer => ({ done: false, text });
    if (!frames) return refused(this.problem || "the recording is not read yet");
    switch (operation) {
      case "play":
        if (this.isAtEnd) this.goTo(0);
        this.isPlaying = true;
        return done("playing");
      case "pause":
        this.isPlaying = false;
        this.goTo(this.at);
        return done("paused");
      case "step":
        if (!(Math.abs(number) <= mostSteps)) return refused("a step has at most a million ticks");
        this.step(Math.trunc(number));
        return done("stepped");
      case "speed":
        if (!(number >= 0 && number <= greatestSpeed))
          return refused("expected a speed from 0 (as fast as possible) to a million");
        this.speed = number;
        this.factor = number;
        return done(number > 0 ? `at ${number} times real time` : "as fast as possible");
      case "seek":
        if (!(number >= 0)) return refused("expected a time in seconds, 0 or more");
        this.goTo(frames.notBefore(Math.round(number * 1e9)));
        return done(`at ${number.toFixed(3)} s`);
      case "watch":
        this.watched = numbers;
        this.sent.delete("/cohort/robots");
        return done("");
      default:
        return refused(`'${operation}': unknown operation; a recording offers play, pause, step, seek and speed`);
    }
  }

  private get isAtEnd(): boolean {
    return this.frames !== undefined && this.at === this.frames.times.length - 1;
  }

  private goTo(frame: number): void {
    this.at = frame;
    this.time = this.frames?.times[frame] ?? 0;
  }

  // Goes to the nearest frame that is at least this many ticks away. Ticks restart with each world of a recording.
  private step(ticks: number): void {
    const { frames } = this;
    this.isPlaying = false;
    if (!frames || ticks === 0) return;
    const goal = frames.ticks[this.at] + ticks;
    const last = frames.ticks.length - 1;
    const direction = Math.sign(ticks);
    let at = this.at;
    do at += direction;
    while (at > 0 && at < last && direction * (goal - frames.ticks[at]) > 0);
    this.goTo(Math.min(last, Math.max(0, at)));
  }

  private async open(blocks: readonly HTMLElement[]): Promise<void> {
    try {
      this.frames = await RecordedFrames.read(blocks);
      this.goTo(0);
      this.changed(true);
      const events = await this.frames.single(this.frames.table.events);
      this.pass("/cohort/events", events);
    } catch (error) {
      this.fail(error);
    }
    this.lastLook = performance.now();
    setInterval(() => this.look(), interval);
  }

  private fail(error: unknown): void {
    this.problem = `the recording in this file cannot be read: ${error instanceof Error ? error.message : String(error)}`;
    this.isPlaying = false;
    this.handlers["/cohort/status"]?.(this.status(), 0);
  }

  private look(): void {
    const now = performance.now();
    const elapsed = now - this.lastLook;
    this.lastLook = now;
    if (!this.frames || this.isShowing) return; // lost time is not caught up
    const before = this.time;
    if (this.isPlaying && !this.isAtEnd) this.advance(this.frames, elapsed);
    if (elapsed > 0 && this.isPlaying)
      this.factor += smoothing * ((1e-6 * (this.time - before)) / elapsed - this.factor);
    this.isShowing = true;
    this.show(this.frames)
      .catch((error: unknown) => this.fail(error))
      .finally(() => {
        this.isShowing = false;
      });
  }

  private advance(frames: RecordedFrames, elapsed: number): void {
    if (this.speed === 0) {
      this.goTo(this.at + 1);
      return;
    }
    this.time = Math.min(this.time + 1e6 * elapsed * this.speed, frames.times[frames.times.length - 1]);
    this.at = frames.notAfter(this.time);
  }

  // Passes on the messages that the page does not show yet.
  private async show(frames: RecordedFrames): Promise<void> {
    const index = this.at;
    const scene = frames.sceneOf(index);
    const frame = await frames.frame(index);
    if (scene !== this.shownScene && this.wanted.has("/cohort/scene")) {
      const data = await frames.single(scene);
      this.shownScene = scene;
      this.shownSignals = undefined;
      this.sent.clear();
      this.pass("/cohort/scene", data);
    }
    if (index !== this.shownFrame) this.sent.clear();
    this.shownFrame = index;
    for (const topic of ["/cohort/frame", "/cohort/contacts", "/cohort/robots"] as const) {
      const data = frame.get(topic);
      if (data && this.isDue(topic)) this.pass(topic, data);
    }
    const signals = frame.get("/cohort/signals");
    if (signals && signals !== this.shownSignals && this.wanted.has("/cohort/signals")) {
      this.shownSignals = signals;
      this.pass("/cohort/signals", signals);
    }
    this.handlers["/cohort/status"]?.(this.status(), 0);
  }

  private isDue(topic: Topic): boolean {
    if (!this.wanted.has(topic) || this.sent.has(topic)) return false;
    this.sent.add(topic);
    return true;
  }

  // The message is decoded from a copy, because handlers may change it.
  private pass(topic: Topic, data: Uint8Array): void {
    let reader = this.readers.get(topic);
    if (!reader) {
      reader = new MessageReader(parse(this.frames?.schemaOf(topic) ?? "", { ros2: true }));
      this.readers.set(topic, reader);
    }
    const message = reader.readMessage(data.slice());
    if (topic === "/cohort/robots") {
      const { robots } = message as { robots: SceneRobot[] };
      this.handlers[topic]?.({ robots: robots.filter(({ robot }) => this.watched.includes(robot)) }, data.length);
      return;
    }
    (this.handlers[topic] as ((message: unknown, bytes: number) => void) | undefined)?.(message, data.length);
  }

  private status(): ViewStatus {
    const { table, times } = this.frames ?? { table: undefined, times: [0] };
    const [begin, end] = [times[0], times[times.length - 1]].map(BigInt);
    const isPlaying = this.isPlaying && !this.isAtEnd;
    return {
      source: "recording",
      name: table?.name ?? "",
      may_control: true,
      can_seek: true,
      loses_what_follows: false,
      is_playing: isPlaying,
      speed: this.speed,
      real_time_factor: isPlaying ? this.factor : 0,
      time_ns: BigInt(times[this.at]),
      begin_ns: begin,
      end_ns: end,
      seekable_from_ns: begin,
      seekable_to_ns: end,
      note: this.note(),
      awaited: [],
      phase: "running",
      end: "",
      end_text: "",
      to_type: "",
      recording: "",
      seed: table?.seed ?? "",
      can_run_again: false,
    };
  }

  private note(): string {
    const table = this.frames?.table;
    if (!table || this.problem) return this.problem;
    const notes = [table.note];
    if (this.wanted.has("/cohort/contacts") && !table.contacts)
      notes.push("this file has no contacts: 'cohort page --contacts' adds them");
    if (this.watched.some((robot) => !table.robots.includes(robot)))
      notes.push("this file has no channels of this robot: 'cohort page --robots' adds them");
    return notes.filter((each) => each !== "").join(" · ");
  }
}
