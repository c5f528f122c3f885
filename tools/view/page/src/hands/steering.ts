// SPDX-License-Identifier: Apache-2.0
import { valueNames } from "../data/channels";
import type { SceneChannel, SceneDrive } from "../data/messages";

// Pure functions that convert held keys and a game pad's state to a robot's command.

/** The effect of a held key: drives on the ground, as fractions of full speed, or sets a channel to a value. */
export type Steer = { ahead: number; turn: number } | { channel: string; value: number };

const directions: Record<string, { ahead: number; turn: number }> = {
  ahead: { ahead: 1, turn: 0 },
  back: { ahead: -1, turn: 0 },
  left: { ahead: 0, turn: 1 },
  right: { ahead: 0, turn: -1 },
};
export const defaultSteering: Readonly<Record<string, string>> = {
  ArrowUp: "ahead",
  ArrowDown: "back",
  ArrowLeft: "left",
  ArrowRight: "right",
  w: "ahead",
  s: "back",
  a: "left",
  d: "right",
};
const turningShare = 0.5; // fraction of full speed for turning on the spot
const deadZone = 0.15;

/** Parses a line of a profile. Throws Error with a message to the user if it is invalid. */
export function readSteer(line: string): Steer {
  const direction = directions[line];
  if (direction) return direction;
  const [channel, value, ...more] = line.split(/\s+/);
  if (!channel || !value || more.length > 0 || !Number.isFinite(Number(value)))
    throw new Error(`expected ${Object.keys(directions).join(", ")}, or a channel and its value, not '${line}'`);
  return { channel, value: Number(value) };
}

/**
 * A command value that drives on the ground, with its values at full speed forward and at full speed counter-clockwise.
 */
export type Drive = Pick<SceneDrive, "value" | "ahead" | "turn">;

export const neutralOf = (channels: readonly SceneChannel[]): number[] =>
  channels.flatMap(({ size, neutral }) => Array.from({ length: size }, () => neutral));

/** Returns the ends of a channel's slider: its limits, or half a turn to each side for an angle without limits. */
export const sliderEnds = (unit: string, lower: number, upper: number): [number, number] =>
  unit === "rad" && !Number.isFinite(lower) && !Number.isFinite(upper) ? [-Math.PI, Math.PI] : [lower, upper];

/** Returns the command of a robot. Values that no input sets are those of `base`. */
export function commandOf(
  channels: readonly SceneChannel[],
  drives: readonly Drive[],
  base: readonly number[],
  steers: readonly Steer[],
): number[] {
  const values = [...base];
  const names = valueNames(channels);
  let [ahead, turn] = [0, 0];
  for (const steer of steers) {
    if ("ahead" in steer) {
      ahead += steer.ahead;
      turn += steer.turn;
    } else {
      const at = names.indexOf(steer.channel);
      if (at >= 0) values[at] = steer.value;
    }
  }
  if (ahead === 0 && turn === 0) return values;
  const driven = drives.map((each) => ahead * each.ahead + turningShare * turn * each.turn);
  const most = drives.map((each, i) => Math.abs(driven[i]) / Math.max(Math.abs(each.ahead), Math.abs(each.turn)));
  const share = Math.max(1, ...most.filter(Number.isFinite)); // within the limits, and on the same arc
  drives.forEach(({ value }, i) => {
    values[value] = driven[i] / share;
  });
  return values;
}

const beyondDeadZone = (axis: number | undefined): number => {
  if (axis === undefined || Math.abs(axis) < deadZone) return 0;
  return (Math.sign(axis) * (Math.min(1, Math.abs(axis)) - deadZone)) / (1 - deadZone);
};

/** Returns the first connected game pad. */
export const padOf = (pads: readonly (Gamepad | null)[]): Gamepad | undefined =>
  pads.find((each) => each?.connected) ?? undefined;

/** Returns the effect of the left stick; undefined while the stick is at rest. */
export function steerOfPad({ axes }: Pick<Gamepad, "axes">): Steer | undefined {
  const [turn, ahead] = [-beyondDeadZone(axes[0]), -beyondDeadZone(axes[1])];
  return turn === 0 && ahead === 0 ? undefined : { ahead, turn };
}
