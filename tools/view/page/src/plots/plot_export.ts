// SPDX-License-Identifier: Apache-2.0
import { commandedPrefix } from "../data/channels";
import { numberText } from "../data/numbers";
import { between } from "./curve";
import { colorOf, dashOf, type Line, rangeAround, unitsOf } from "./plot_chart";

/**
 * Returns a CSV table (RFC 4180): a row for each time in the range, and a column for each line, empty where it has no
 * value.
 */
export function csvOf(lines: readonly Line[], [from, to]: readonly [number, number]): string {
  const cell = (text: string): string => (/[",\n\r]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text);
  const parts = lines.map(({ curve }) => between(curve, from, to));
  const times = [...new Set(parts.flatMap((each) => each.times))].sort((a, b) => a - b);
  const next = parts.map(() => 0);
  const rows = times.map((time) => {
    const cells = parts.map(({ times: own, values }, i) => {
      if (own[next[i]] !== time) return "";
      const value = values[next[i]++];
      return Number.isNaN(value) ? "" : String(value + 0);
    });
    return [String(time + 0), ...cells].join(",");
  });
  const names = lines.map(({ label, unit }) => cell(`${label} [${unit}]`));
  return `${[["time [s]", ...names].join(","), ...rows].join("\r\n")}\r\n`;
}

const width = 900;
const height = 230; // per plot
const margin = { left: 70, right: 20, top: 10, bottom: 36 };
const rowHeight = 16; // in a legend
const columns = 3;
const ticks = 6;

const escaped = (text: string): string => text.replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/"/g, "&quot;");

// Returns round numbers in a range.
function roundTicks([low, high]: readonly [number, number]): number[] {
  const rough = (high - low) / ticks;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * ([1, 2, 5].find((each) => each * power >= rough) ?? 10);
  const first = Math.ceil(low / step);
  const count = Math.floor(high / step) - first + 1;
  return Array.from(
    { length: Math.max(0, Math.min(20, count)) },
    (_, i) => Number(((first + i) * step).toPrecision(10)) + 0,
  );
}

function linePath(
  line: Line,
  range: readonly [number, number],
  x: (time: number) => number,
  y: (value: number) => number,
): string {
  const { times, values } = between(line.curve, range[0], range[1]);
  const isStepped = line.name.startsWith(commandedPrefix);
  let path = "";
  let isDown = false;
  for (let i = 0; i < times.length; ++i) {
    if (!Number.isFinite(values[i])) {
      isDown = false;
      continue;
    }
    const [left, top] = [x(times[i]).toFixed(1), y(values[i]).toFixed(1)];
    path += !isDown ? `M${left} ${top}` : isStepped ? `V${top}H${left}` : `L${left} ${top}`;
    isDown = true;
  }
  return path;
}

const legendHeight = (lines: readonly Line[]): number => rowHeight * Math.ceil(lines.length / columns);
const heightOf = (lines: readonly Line[]): number => height + legendHeight(lines);

function plotOf(lines: readonly Line[], range: readonly [number, number], top: number): string {
  const above = legendHeight(lines);
  const finite = lines.flatMap(({ curve }) => between(curve, range[0], range[1]).values.filter(Number.isFinite));
  const least = finite.reduce((a, b) => Math.min(a, b), Infinity);
  const greatest = finite.reduce((a, b) => Math.max(a, b), -Infinity);
  const [low, high] = finite.length === 0 ? rangeAround(null, null) : rangeAround(least, greatest);
  const right = width - margin.right;
  const bottom = height - margin.bottom;
  const x = (time: number): number => margin.left + ((time - range[0]) / (range[1] - range[0])) * (right - margin.left);
  const y = (value: number): number => bottom - ((value - low) / (high - low)) * (bottom - margin.top);
  const text = (at: readonly [number, number], content: string, more = ""): string =>
    `<text x="${at[0].toFixed(1)}" y="${at[1].toFixed(1)}" ${more}>${escaped(content)}</text>`;
  const rule = (x1: number, y1: number, x2: number, y2: number): string =>
    `<path d="M${x1.toFixed(1)} ${y1.toFixed(1)}L${x2.toFixed(1)} ${y2.toFixed(1)}" stroke="#ddd"/>`;
  const parts: string[] = [];
  for (const time of roundTicks(range)) {
    parts.push(rule(x(time), margin.top, x(time), bottom));
    parts.push(text([x(time), bottom + 14], `${time} s`, 'text-anchor="middle"'));
  }
  for (const value of roundTicks([low, high])) {
    parts.push(rule(margin.left, y(value), right, y(value)));
    const shown = Math.abs(value) < 1e6 ? String(value) : numberText(value);
    parts.push(text([margin.left - 6, y(value) + 4], shown, 'text-anchor="end"'));
  }
  const middle = 0.5 * (margin.top + bottom);
  parts.push(text([16, middle], unitsOf(lines), `text-anchor="middle" transform="rotate(-90 16 ${middle})"`));
  const share = (right - margin.left) / columns;
  const legend = lines.map((line, i) => {
    const at = [margin.left + (i % columns) * share, 4 - above + rowHeight * Math.floor(i / columns)];
    return `<path d="M${at[0].toFixed(1)} ${at[1]}h16" ${penOf(i)}/>${text([at[0] + 22, at[1] + 4], line.label)}`;
  });
  const curves = lines.map(
    (line, i) => `<path d="${linePath(line, range, x, y)}" ${penOf(i)} clip-path="url(#inside)"/>`,
  );
  parts.push(...curves, ...legend);
  return `<g transform="translate(0 ${top + above})">${parts.join("")}</g>`;
}

function penOf(index: number): string {
  const dash = dashOf(index).length > 0 ? ` stroke-dasharray="${dashOf(index).join(" ")}"` : "";
  return `fill="none" stroke="${colorOf(index)}" stroke-width="1.5"${dash}`;
}

/** Returns a picture of all plots, one below the other, for papers. */
export function svgOf(plots: readonly (readonly Line[])[], range: readonly [number, number]): string {
  const inside = `<clipPath id="inside"><rect x="${margin.left}" y="${margin.top}" width="${width - margin.left - margin.right}" height="${height - margin.top - margin.bottom}"/></clipPath>`;
  let top = rowHeight;
  const drawn = plots.map((lines) => {
    top += heightOf(lines);
    return plotOf(lines, range, top - heightOf(lines));
  });
  const size = `width="${width}" height="${top}" viewBox="0 0 ${width} ${top}"`;
  return `<svg xmlns="http://www.w3.org/2000/svg" ${size} font-family="sans-serif" font-size="11">
${inside}<rect width="100%" height="100%" fill="white"/>
${drawn.join("\n")}
</svg>
`;
}
