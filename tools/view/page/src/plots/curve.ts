// SPDX-License-Identifier: Apache-2.0

/** A value over time, with ascending times [s]. Missing values are NaN. */
export interface Curve {
  times: number[];
  values: number[];
}

/** Returns the index of the first time that is not before `time`. */
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

/** Returns the value that is nearest in time; undefined far beyond the ends of the curve. */
export function valueAt({ times, values }: Curve, time: number): number | undefined {
  if (times.length === 0) return undefined;
  const spacing = times.length > 1 ? (times[times.length - 1] - times[0]) / (times.length - 1) : 0;
  const slack = 5 * spacing + 1e-6;
  if (time < times[0] - slack || time > times[times.length - 1] + slack) return undefined;
  const after = Math.min(firstAt(times, time), times.length - 1);
  const before = Math.max(0, after - 1);
  return values[time - times[before] < times[after] - time ? before : after];
}

/** Returns the part from one time to another one, both inclusive. */
export function between({ times, values }: Curve, from: number, to: number): Curve {
  const begin = firstAt(times, from);
  let end = firstAt(times, to);
  if (times[end] === to) ++end;
  return { times: times.slice(begin, end), values: values.slice(begin, end) };
}

/** Returns curve `a` followed by curve `b`, which begins later. Where they overlap, `b` counts. */
export function joined(a: Curve, b: Curve): Curve {
  const end = b.times.length > 0 ? firstAt(a.times, b.times[0]) : a.times.length;
  return { times: a.times.slice(0, end).concat(b.times), values: a.values.slice(0, end).concat(b.values) };
}

/**
 * Reduces a curve to at most this many samples: minimum and maximum of equal parts, as in
 * tools/view/history/reduction.hpp.
 */
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
