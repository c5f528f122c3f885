// SPDX-License-Identifier: Apache-2.0
import { commandedPrefix } from "../data/channels";
import type { Answer, ViewRequest } from "../data/connection";
import { between, type Curve, firstAt, joined, reduced } from "./curve";

const mostPoints = 4000; // in a series
const mostAnswered = 16_000; // in all series of a request: HistoryRequest::most_points
const gathering = 20; // [ms] during which requests are collected into one
const mostRobots = 16;
const mostNames = 32;
const mostSeries = 128;

/** A value of a robot, and its known samples. */
export interface Track {
  robot: number;
  name: string;
  unit: string;
  whole: Curve;
  isReduced: boolean;
  detail: { from: number; to: number; curve: Curve } | undefined; // samples of the zoomed interval
}

export const keyOf = (robot: number, name: string): string => `${robot} ${name}`;

/** Returns the curve to show: all known samples, with the zoomed part in detail. */
export function shownCurve({ whole, detail }: Track): Curve {
  if (!detail) return whole;
  const before = between(whole, -Infinity, detail.from);
  const after = between(whole, detail.to, Infinity);
  return joined(joined(before, detail.curve), after);
}

/** The histories of values: requested once, then continued with arriving values. */
export class Histories {
  private readonly tracks = new Map<string, Track>();
  private generation = 0;
  private pending = 0;
  private readonly missing = new Set<Track>(); // to be requested together soon
  problem = "";

  constructor(
    private readonly ask: (request: ViewRequest) => Promise<Answer>,
    private readonly changed: () => void,
  ) {}

  get isReading(): boolean {
    return this.pending > 0 || this.missing.size > 0;
  }

  get(robot: number, name: string): Track | undefined {
    return this.tracks.get(keyOf(robot, name));
  }

  /** Drops all histories, because another run or recording is shown. */
  forget(): void {
    ++this.generation;
    this.tracks.clear();
    this.problem = "";
  }

  /** Requests the wanted histories that are not known yet, and drops all others. */
  want(wanted: readonly { robot: number; name: string; unit: string }[]): void {
    const keys = new Set(wanted.map(({ robot, name }) => keyOf(robot, name)));
    for (const key of [...this.tracks.keys()]) if (!keys.has(key)) this.tracks.delete(key);
    for (const { robot, name, unit } of wanted) {
      if (this.tracks.has(keyOf(robot, name))) continue;
      const track = { robot, name, unit, whole: { times: [], values: [] }, isReduced: false, detail: undefined };
      this.tracks.set(keyOf(robot, name), track);
      if (this.missing.size === 0) window.setTimeout(() => this.readMissing(), gathering);
      this.missing.add(track);
    }
  }

  /** Requests the detail of an interval in which values were left out. Without an interval, drops the details. */
  zoom(interval: [number, number] | undefined): void {
    for (const track of this.tracks.values()) track.detail = undefined;
    if (!interval) return;
    const [from, to] = interval;
    const coarse = [...this.tracks.values()].filter(({ isReduced }) => isReduced);
    if (coarse.length === 0) return;
    void this.read(coarse, interval, (track, part) => {
      const before = track.detail?.from === from && track.detail.to === to ? track.detail.curve : undefined;
      track.detail = { from, to, curve: reduced(before ? joined(before, part) : part, 2 * mostPoints) };
    });
  }

  /** Appends arriving values. If time goes back, drops later values. */
  append(
    robot: number,
    time: number,
    observation: ArrayLike<number>,
    command: ArrayLike<number>,
    indexOf: IndexOf,
  ): void {
    for (const track of this.tracks.values()) {
      if (track.robot !== robot) continue;
      const index = indexOf(track.name);
      if (index === undefined) continue;
      const value = (track.name.startsWith(commandedPrefix) ? command : observation)[index];
      const { times, values } = track.whole;
      const end = firstAt(times, time);
      times.length = end;
      values.length = end;
      times.push(time);
      values.push(value + 0);
      if (times.length <= 2 * mostPoints) continue;
      track.whole = reduced(track.whole, mostPoints);
      track.isReduced = true;
    }
  }

  private readMissing(): void {
    const tracks = [...this.missing].filter((track) => this.isWanted(track));
    this.missing.clear();
    void this.read(tracks, undefined, (track, part, isReduced) => {
      track.whole = reduced(insertedInto(track.whole, part), 2 * mostPoints);
      track.isReduced ||= isReduced;
    });
  }

  private isWanted(track: Track): boolean {
    return this.tracks.get(keyOf(track.robot, track.name)) === track;
  }

  // Requests series of the same values together, in as many parts as the server answers.
  private async read(
    tracks: readonly Track[],
    interval: [number, number] | undefined,
    put: (track: Track, part: Curve, isReduced: boolean) => void,
  ): Promise<void> {
    const { generation } = this;
    ++this.pending;
    this.problem = "";
    this.changed();
    for (const group of groupsOf(tracks)) {
      let from = interval?.[0];
      const points = Math.min(mostPoints, Math.floor(mostAnswered / (group.robots.length * group.names.length)));
      do {
        const request = { numbers: group.robots, names: group.names, number: points, from, to: interval?.[1] };
        const answer = await this.ask({ operation: "history", ...request });
        if (generation !== this.generation) break;
        if (!answer.done || answer.text !== "") this.problem = answer.text;
        for (const { robot, name, times, values } of answer.series ?? []) {
          const track = this.tracks.get(keyOf(robot, name));
          const part = { times, values: values.map((value) => value ?? Number.NaN) };
          if (track && tracks.includes(track)) put(track, part, answer.reduced === true);
        }
        from = answer.next;
        this.changed();
      } while (from !== undefined && tracks.some((track) => this.isWanted(track)));
    }
    --this.pending;
    this.changed();
  }
}

type IndexOf = (name: string) => number | undefined;

// Inserts a part of a history into a known curve, whose later values arrived while the history was requested.
function insertedInto(known: Curve, part: Curve): Curve {
  if (part.times.length === 0) return known;
  const [from, to] = [part.times[0], part.times[part.times.length - 1]];
  return joined(joined(between(known, -Infinity, from), part), between(known, to, Infinity));
}

// Returns groups of robots with the same wanted values, within the limits of a request.
function groupsOf(tracks: readonly Track[]): { robots: number[]; names: string[] }[] {
  const namesOf = new Map<number, string[]>();
  for (const { robot, name } of tracks) namesOf.set(robot, [...(namesOf.get(robot) ?? []), name]);
  const robotsOf = new Map<string, number[]>();
  for (const [robot, names] of namesOf) {
    for (let first = 0; first < names.length; first += mostNames) {
      const key = JSON.stringify(names.slice(first, first + mostNames));
      robotsOf.set(key, [...(robotsOf.get(key) ?? []), robot]);
    }
  }
  return [...robotsOf].flatMap(([key, robots]) => {
    const names = JSON.parse(key) as string[];
    const most = Math.min(mostRobots, Math.max(1, Math.floor(mostSeries / names.length)));
    const groups: { robots: number[]; names: string[] }[] = [];
    for (let first = 0; first < robots.length; first += most)
      groups.push({ robots: robots.slice(first, first + most), names });
    return groups;
  });
}
