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
