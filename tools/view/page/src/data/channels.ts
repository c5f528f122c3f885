// SPDX-License-Identifier: Apache-2.0
import type { SceneChannel } from "./messages";

/** Returns the index of a channel's first value among the values of all channels. */
export function firstValue(channels: readonly SceneChannel[], name: string): number | undefined {
  let first = 0;
  for (const channel of channels) {
    if (channel.name === name) return first;
    first += channel.size;
  }
  return undefined;
}

/** Returns a unique name for each value: that of its channel, with its index if the channel has several values. */
export function valueNames(channels: readonly SceneChannel[]): string[] {
  return channels.flatMap(({ name, size }) =>
    size === 1 ? [name] : Array.from({ length: size }, (_, i) => `${name}[${i}]`),
  );
}

/** The names of commanded values begin with this. */
export const commandedPrefix = "→ ";

/** A value of a robot. */
export interface Value {
  name: string; // name of its channel, with its index if there are several
  unit: string;
  isCommanded: boolean;
  index: number; // among the observed or the commanded values
}

function valuesOf(channels: readonly SceneChannel[], isCommanded: boolean): Value[] {
  const units = channels.flatMap(({ unit, size }) => Array.from({ length: size }, () => unit));
  const prefix = isCommanded ? commandedPrefix : "";
  return valueNames(channels).map((name, index) => ({ name: prefix + name, unit: units[index], isCommanded, index }));
}

/** Returns all values of a robot: the observed ones, then the commanded ones. */
export function valuesOfRobot(observation: readonly SceneChannel[], command: readonly SceneChannel[]): Value[] {
  return [...valuesOf(observation, false), ...valuesOf(command, true)];
}

/**
 * Returns the values that a text of the console selects: one by its name, optionally followed by its unit
 * (`motor/0/velocity [rad/s]`), or all values with a unit.
 */
export function valuesMeant(values: readonly Value[], text: string): Value[] {
  const wanted = text.trim().replace(/\s+/g, " ");
  const isMeant = ({ name, unit }: Value): boolean =>
    [name, `${name} ${unit}`, `${name} [${unit}]`].some((each) => each === wanted || each === commandedPrefix + wanted);
  const named = values.filter(isMeant);
  if (named.length > 0) return named.slice(0, 1);
  const unit = wanted.replace(/^\[(.*)\]$/, "$1");
  return values.filter((each) => each.unit === unit);
}
