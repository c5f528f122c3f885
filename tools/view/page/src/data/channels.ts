import type { SceneChannel } from "./messages";

/** Where a channel's values begin among those of all channels. */
export function firstValue(channels: readonly SceneChannel[], name: string): number | undefined {
  let first = 0;
  for (const channel of channels) {
    if (channel.name === name) return first;
    first += channel.size;
  }
  return undefined;
}

/** Each value with a name of its own: that of its channel, and its place if there are several. */
export function valueNames(channels: readonly SceneChannel[]): string[] {
  return channels.flatMap(({ name, size }) =>
    size === 1 ? [name] : Array.from({ length: size }, (_, i) => `${name}[${i}]`),
  );
}

/** The names of commanded values begin with this. */
export const commandedPrefix = "→ ";

/** A value of a robot. */
export interface Value {
  name: string; // name of its channel, with its place if there are several
  unit: string;
  isCommanded: boolean;
  index: number; // among the observed or the commanded ones
}

function valuesOf(channels: readonly SceneChannel[], isCommanded: boolean): Value[] {
  const units = channels.flatMap(({ unit, size }) => Array.from({ length: size }, () => unit));
  const prefix = isCommanded ? commandedPrefix : "";
  return valueNames(channels).map((name, index) => ({ name: prefix + name, unit: units[index], isCommanded, index }));
}

/** All values of a robot: the observed ones, then the commanded ones. */
export function valuesOfRobot(observation: readonly SceneChannel[], command: readonly SceneChannel[]): Value[] {
  return [...valuesOf(observation, false), ...valuesOf(command, true)];
}

/**
 * The values that a text of the console means: one by its name, which its unit may follow (`motor/0/velocity [rad/s]`),
 * or all those of a unit.
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
