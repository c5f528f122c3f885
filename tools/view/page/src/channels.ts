import type { SceneChannel, SceneModel, SceneRobot } from "./messages";

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

export interface ChannelValue {
  name: string;
  unit: string;
  value: number;
}

/** Returns all observed and commanded (`→ `) values of a robot, with their names and units. */
export function channelValues(model: SceneModel, robot: SceneRobot): ChannelValue[] {
  const unitsOf = (channels: readonly SceneChannel[]): string[] =>
    channels.flatMap(({ unit, size }) => Array.from({ length: size }, () => unit));
  const named = (channels: readonly SceneChannel[], values: ArrayLike<number>, prefix: string): ChannelValue[] => {
    const units = unitsOf(channels);
    return valueNames(channels).map((name, i) => ({ name: `${prefix}${name}`, unit: units[i], value: values[i] }));
  };
  return [...named(model.observation, robot.observation, ""), ...named(model.command, robot.command, "→ ")];
}
