// SPDX-License-Identifier: Apache-2.0
import { seconds, type ViewEvent, type ViewStatus } from "../data/messages";
import { element } from "../element";

export interface Playback {
  play(): void;
  pause(): void;
  step(ticks: number): void;
  seek(time: number): void;
  speed(factor: number): void;
}

export const clockText = (time: number): string =>
  `${Math.floor(time / 60)}:${(time % 60).toFixed(2).padStart(5, "0")}`;

/** Play, pause, step, speed, and the bar to scrub. */
export class TimeBar {
  private readonly bar = element("scrub") as HTMLInputElement;
  private readonly button = element("play") as HTMLButtonElement;
  private readonly speed = element("speed") as HTMLSelectElement;
  private readonly marks = element("marks");
  private isScrubbing = false;
  private marked: readonly ViewEvent[] = [];
  private markedEnd = -1;
  status: ViewStatus | undefined;

  constructor(private readonly playback: Playback) {
    this.button.addEventListener("click", () => this.toggle());
    element("back").addEventListener("click", () => playback.step(-1));
    element("ahead").addEventListener("click", () => playback.step(1));
    this.speed.addEventListener("change", () => playback.speed(Number(this.speed.value)));
    this.bar.addEventListener("input", () => {
      this.isScrubbing = true;
      if (this.status && !this.status.loses_what_follows) playback.seek(this.chosen(this.status));
    });
    this.bar.addEventListener("change", () => {
      this.isScrubbing = false;
      if (this.status?.loses_what_follows) playback.seek(this.chosen(this.status));
    });
  }

  private chosen(status: ViewStatus): number {
    const [from, to] = [status.seekable_from_ns, status.seekable_to_ns].map(seconds);
    return Math.min(to, Math.max(from, Number(this.bar.value)));
  }

  toggle(): void {
    if (this.status?.is_playing) this.playback.pause();
    else this.playback.play();
  }

  take(status: ViewStatus): void {
    this.status = status;
    const [begin, end, now] = [status.begin_ns, status.end_ns, status.time_ns].map(seconds);
    document.body.classList.toggle("can-seek", status.can_seek);
    document.body.classList.toggle("can-control", status.may_control);
    this.button.classList.toggle("playing", status.is_playing);
    this.button.title = status.is_playing ? "Pause (space)" : "Play (space)";
    this.bar.min = String(begin);
    this.bar.max = String(end);
    if (!this.isScrubbing) this.bar.value = String(now);
    const share = (time: number): string => `${(100 * (time - begin)) / Math.max(1e-9, end - begin)}%`;
    this.bar.style.setProperty("--done", share(now));
    this.bar.style.setProperty("--from", share(status.can_seek ? seconds(status.seekable_from_ns) : begin));
    this.bar.title =
      status.can_seek && status.loses_what_follows ? "Going back discards the later part of the run" : "";
    element("now").textContent = clockText(now);
    element("whole").textContent = end > 0 ? clockText(end) : "";
    const speed = String(status.speed);
    if (![...this.speed.options].some(({ value }) => value === speed)) this.speed.add(new Option(`${speed} ×`, speed));
    if (document.activeElement !== this.speed) this.speed.value = speed;
    if (end !== this.markedEnd) this.mark(this.marked);
  }

  mark(events: readonly ViewEvent[]): void {
    this.marked = events;
    if (!this.status) return;
    const [begin, end] = [seconds(this.status.begin_ns), seconds(this.status.end_ns)];
    this.markedEnd = end;
    this.marks.replaceChildren(
      ...events.map(({ time_ns, kind, text }) => {
        const mark = document.createElement("i");
        mark.style.left = `${(100 * (seconds(time_ns) - begin)) / Math.max(1e-9, end - begin)}%`;
        mark.title = `${kind}: ${text}`;
        return mark;
      }),
    );
  }
}
