import { firstValue, valueNames } from "../data/channels";
import type { SceneChannel } from "../data/messages";

// Plain functions that turn held keys and a game pad into a robot's command.

/** The effect of a held key: drives two tracks or wheels, as shares of full speed, or gives a channel a value. */
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
const turningShare = 0.5; // share of full speed for turning on the spot
const deadZone = 0.15;

/** Parses a line of a profile. Throws Error with a sentence if it is invalid. */
export function readSteer(line: string): Steer {
  const direction = directions[line];
  if (direction) return direction;
  const [channel, value, ...more] = line.split(/\s+/);
  if (!channel || !value || more.length > 0 || !Number.isFinite(Number(value)))
    throw new Error(`expected ${Object.keys(directions).join(", ")}, or a channel and its value, not '${line}'`);
  return { channel, value: Number(value) };
}

/** Two tracks or wheels: where their velocities stand in the command, and the greatest that both have. */
export interface Wheels {
  left: number;
  right: number;
  speed: number;
}

export function wheelsOf(channels: readonly SceneChannel[]): Wheels | undefined {
  const ending = (end: string): SceneChannel | undefined => channels.find(({ name }) => name.endsWith(end));
  const left = ending("/left/velocity");
  const right = ending("/right/velocity");
  const [atLeft, atRight] = [left, right].map((each) => each && firstValue(channels, each.name));
  if (!left || !right || atLeft === undefined || atRight === undefined) return undefined;
  return { left: atLeft, right: atRight, speed: Math.min(left.upper, right.upper) };
}

export const neutralOf = (channels: readonly SceneChannel[]): number[] =>
  channels.flatMap(({ size, neutral }) => Array.from({ length: size }, () => neutral));

/** The ends of a channel's slider: its limits, or half a turn to each side for an angle without limits. */
export const sliderEnds = (unit: string, lower: number, upper: number): [number, number] =>
  unit === "rad" && !Number.isFinite(lower) && !Number.isFinite(upper) ? [-Math.PI, Math.PI] : [lower, upper];

/** The command of a robot: `base` where nothing else says anything. */
export function commandOf(
  channels: readonly SceneChannel[],
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
  const wheels = wheelsOf(channels);
  if (!wheels || (ahead === 0 && turn === 0)) return values;
  const [left, right] = [ahead - turningShare * turn, ahead + turningShare * turn];
  const most = Math.max(1, Math.abs(left), Math.abs(right)); // neither goes faster than it can, and the curve stays
  values[wheels.left] = (wheels.speed * left) / most;
  values[wheels.right] = (wheels.speed * right) / most;
  return values;
}

const beyondDeadZone = (axis: number | undefined): number => {
  if (axis === undefined || Math.abs(axis) < deadZone) return 0;
  return (Math.sign(axis) * (Math.min(1, Math.abs(axis)) - deadZone)) / (1 - deadZone);
};

/** The first game pad that is there. */
export const padOf = (pads: readonly (Gamepad | null)[]): Gamepad | undefined =>
  pads.find((each) => each?.connected) ?? undefined;

/** Returns the command of its left stick; nothing while the stick is at rest. */
export function steerOfPad({ axes }: Pick<Gamepad, "axes">): Steer | undefined {
  const [turn, ahead] = [-beyondDeadZone(axes[0]), -beyondDeadZone(axes[1])];
  return turn === 0 && ahead === 0 ? undefined : { ahead, turn };
}
