/** A value over time: times [s] ascend, values that there are not are NaN. */
export interface Curve {
  times: number[];
  values: number[];
}

/** Index of the first time that is not before `time`. */
export function firstAt(times: readonly number[], time: number): number {
  let low = 0;
  let high = times.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] < time) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** The value that is nearest in time; nothing far beyond the ends of the curve. */
export function valueAt({ times, values }: Curve, time: number): number | undefined {
  if (times.length === 0) return undefined;
  const spacing = times.length > 1 ? (times[times.length - 1] - times[0]) / (times.length - 1) : 0;
  const slack = 5 * spacing + 1e-6;
  if (time < times[0] - slack || time > times[times.length - 1] + slack) return undefined;
  const after = Math.min(firstAt(times, time), times.length - 1);
  const before = Math.max(0, after - 1);
  return values[time - times[before] < times[after] - time ? before : after];
}

/** The part from one time to another one, both in it. */
export function between({ times, values }: Curve, from: number, to: number): Curve {
  const begin = firstAt(times, from);
  let end = firstAt(times, to);
  if (times[end] === to) ++end;
  return { times: times.slice(begin, end), values: values.slice(begin, end) };
}

/** One curve before another one that begins later; where both have a time, the later one counts. */
export function joined(a: Curve, b: Curve): Curve {
  const end = b.times.length > 0 ? firstAt(a.times, b.times[0]) : a.times.length;
  return { times: a.times.slice(0, end).concat(b.times), values: a.values.slice(0, end).concat(b.values) };
}

/** At most so many samples: the least and the greatest of equally long parts, as tools/view/history/reduction.hpp. */
export function reduced(curve: Curve, most: number): Curve {
  const { times, values } = curve;
  if (times.length <= most) return curve;
  const parts = Math.floor((most - 2) / 2);
  const [from, to] = [times[0], times[times.length - 1]];
  const kept = new Set([0, times.length - 1]);
  let begin = 0;
  for (let part = 1; part <= parts; ++part) {
    const end = part === parts ? times.length : firstAt(times, from + ((to - from) * part) / parts);
    let [least, greatest] = [begin, begin];
    for (let i = begin; i < end; ++i) {
      if (!(values[least] <= values[i])) least = i;
      if (!(values[greatest] >= values[i])) greatest = i;
    }
    if (begin < end) kept.add(least).add(greatest);
    begin = end;
  }
  const order = [...kept].sort((a, b) => a - b);
  return { times: order.map((i) => times[i]), values: order.map((i) => values[i]) };
}
